//! A shape under an affine map.

use num_traits::Float as _;

use crate::error::{InvalidShape, finite, finite_matrix};
use crate::support::{ScalarOf, lost_in_sum, swept, swept_derivative};
use crate::vector::power_of_two_below;
use crate::{Hint, Matrix, Scalar, SupportMap, Vector};

/// The image `M·C + t` of a shape under an affine map: scaled, sheared, mirrored, or flattened where `M` is singular.
///
/// ```
/// use convex_support::{Affine, Ball, SupportMap, glam::{DMat2, DVec2}};
///
/// let disc = Ball::<DVec2>::new(1.0)?;
/// let ellipse = Affine::new(disc, DMat2::from_diagonal(DVec2::new(3.0, 1.0)), DVec2::ZERO)?;
/// assert_eq!(ellipse.support(DVec2::X), DVec2::new(3.0, 0.0));
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine<S: SupportMap> {
    shape: S,
    matrix: <S::Vector as Vector>::Matrix,
    /// The transpose in units of a power of two near the largest entry: directions stay in range.
    onto_shape: <S::Vector as Vector>::Matrix,
    translation: S::Vector,
    /// What the rounding of the origin `M·c + t` loses; it stays with the core.
    lost: S::Vector,
    /// The factor `s` where the matrix is `s` times a rotation or reflection: a ball then stays a ball.
    scale: Option<ScalarOf<S>>,
    /// The inverse of the matrix; `None` where it is singular.
    inverse: Option<<S::Vector as Vector>::Matrix>,
}

impl<S: SupportMap> Affine<S> {
    /// The image of the shape under `x ↦ matrix·x + translation`. The matrix may be singular.
    ///
    /// # Errors
    /// [`InvalidShape::NonFinite`] if a number is not finite.
    pub fn new(shape: S, matrix: <S::Vector as Vector>::Matrix, translation: S::Vector) -> Result<Self, InvalidShape> {
        let matrix = finite_matrix("matrix", matrix)?;
        let translation = finite("translation", translation)?;
        let inverse = Some(matrix.inverse()).filter(Matrix::is_finite);
        let largest = S::Vector::from_fn(|j| matrix.col(j).abs().max_element()).max_element();
        let unit = power_of_two_below(largest);
        let transpose = matrix.transpose();
        let onto_shape = Matrix::from_cols_fn(|j| transpose.col(j) / unit);
        let lost = lost_in_sum(matrix * shape.origin(), translation);
        Ok(Self { shape, matrix, onto_shape, translation, lost, scale: uniform_scale(matrix), inverse })
    }

    /// The shape before it is mapped.
    #[must_use]
    pub const fn shape(&self) -> &S {
        &self.shape
    }

    /// The linear part, applied first.
    #[must_use]
    pub fn matrix(&self) -> <S::Vector as Vector>::Matrix {
        self.matrix
    }

    /// The inverse of the matrix; `None` where it is singular.
    pub(crate) fn inverse(&self) -> Option<<S::Vector as Vector>::Matrix> {
        self.inverse
    }

    /// The translation, applied last.
    #[must_use]
    pub fn translation(&self) -> S::Vector {
        self.translation
    }
}

impl<S: SupportMap> SupportMap for Affine<S> {
    type Vector = S::Vector;

    #[inline]
    fn support(&self, direction: S::Vector) -> S::Vector {
        // max d·(Mx + t) = max (Mᵀd)·x + d·t, and the length of Mᵀd does not matter.
        self.matrix * self.shape.support(self.onto_shape * direction) + self.translation
    }

    #[inline]
    fn origin(&self) -> S::Vector {
        self.matrix * self.shape.origin() + self.translation
    }

    #[inline(always)]
    fn core_support(&self, direction: S::Vector, hint: &mut Hint) -> S::Vector {
        let direction = self.onto_shape * direction;
        let core = self.shape.core_support(direction, hint);
        match self.scale {
            Some(_) => self.matrix * core + self.lost,
            // A ball does not stay a ball, so it becomes part of the core.
            None => self.matrix * (core + swept(self.shape.radius(), direction)) + self.lost,
        }
    }

    #[inline]
    fn core_support_derivative(&self, direction: S::Vector, change: S::Vector) -> S::Vector {
        let (direction, change) = (self.onto_shape * direction, self.onto_shape * change);
        let core = self.shape.core_support_derivative(direction, change);
        match self.scale {
            Some(_) => self.matrix * core,
            None => self.matrix * (core + swept_derivative(self.shape.radius(), direction, change)),
        }
    }

    #[inline]
    fn radius(&self) -> ScalarOf<S> {
        self.scale.map_or(ScalarOf::<S>::ZERO, |scale| scale * self.shape.radius())
    }

    #[inline]
    fn is_core_polyhedral(&self) -> bool {
        self.shape.is_core_polyhedral() && (self.scale.is_some() || self.shape.radius() == ScalarOf::<S>::ZERO)
    }

    #[inline]
    fn core_point(&self) -> Option<S::Vector> {
        self.scale?;
        Some(self.matrix * self.shape.core_point()? + self.lost)
    }

    /// A map that keeps angles keeps which point is closest.
    #[inline]
    fn core_closest_point(&self, x: S::Vector) -> Option<S::Vector> {
        self.scale?;
        let closest = self.shape.core_closest_point(self.inverse? * (x - self.lost))?;
        Some(self.matrix * closest + self.lost)
    }

    fn core_extent(&self) -> ScalarOf<S> {
        let extent = match self.scale {
            Some(scale) => scale * self.shape.core_extent(),
            // |M·x| and every product in it are bounded by the Frobenius norm of M times |x|.
            None => {
                let columns = S::Vector::from_fn(|j| self.matrix.col(j).norm());
                columns.norm() * (self.shape.core_extent() + self.shape.radius())
            }
        };
        extent + self.lost.abs().max_element() * Scalar::from_f64(2.0)
    }
}

/// The factor `s > 0` where the matrix is, to rounding, `s` times an orthogonal one.
fn uniform_scale<M: Matrix>(matrix: M) -> Option<<M::Vector as Vector>::Scalar> {
    type S<M> = <<M as Matrix>::Vector as Vector>::Scalar;
    let scale = matrix.col(0).norm();
    let tolerance = S::<M>::EPSILON * S::<M>::from_f64(4.0);
    let like = |i: usize, j: usize| {
        // The columns in units of the scale: orthonormal.
        let product = (matrix.col(i) / scale).dot(matrix.col(j) / scale);
        (product - if i == j { S::<M>::ONE } else { S::<M>::ZERO }).abs() <= tolerance
    };
    let pairs = (0..M::Vector::DIM).flat_map(|i| (0..=i).map(move |j| (i, j)));
    (scale > S::<M>::ZERO && pairs.into_iter().all(|(i, j)| like(i, j))).then_some(scale)
}
