//! A shape under an affine map.

use crate::error::{InvalidShape, finite, finite_matrix};
use crate::support::{swept, swept_derivative};
use crate::{Hint, Matrix, SupportMap, Vector};

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
    translation: S::Vector,
}

impl<S: SupportMap> Affine<S> {
    /// The image of the shape under `x ↦ matrix·x + translation`. The matrix may be singular.
    ///
    /// # Errors
    /// [`InvalidShape::NonFinite`] if a number is not finite.
    pub fn new(shape: S, matrix: <S::Vector as Vector>::Matrix, translation: S::Vector) -> Result<Self, InvalidShape> {
        Ok(Self { shape, matrix: finite_matrix("matrix", matrix)?, translation: finite("translation", translation)? })
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
        // max d·(Mx + t) = max (Mᵀd)·x + d·t
        self.matrix * self.shape.support(self.matrix.transpose_mul(direction)) + self.translation
    }

    #[inline]
    fn origin(&self) -> S::Vector {
        self.matrix * self.shape.origin() + self.translation
    }

    #[inline]
    fn core_support(&self, direction: S::Vector, hint: &mut Hint) -> S::Vector {
        // A ball does not stay a ball, so it becomes part of the core.
        let direction = self.matrix.transpose_mul(direction);
        self.matrix * (self.shape.core_support(direction, hint) + swept(self.shape.radius(), direction))
    }

    #[inline]
    fn core_support_derivative(&self, direction: S::Vector, change: S::Vector) -> S::Vector {
        let (direction, change) = (self.matrix.transpose_mul(direction), self.matrix.transpose_mul(change));
        self.matrix
            * (self.shape.core_support_derivative(direction, change)
                + swept_derivative(self.shape.radius(), direction, change))
    }
}
