//! A shape moved without deforming it.

use num_traits::Float as _;

use crate::error::{InvalidShape, finite, orthonormal};
use crate::support::{ScalarOf, lost_in_sum};
use crate::{Hint, Matrix, Scalar, SupportMap, Vector};

/// The image `R·C + t` of a shape under a rotation and then a translation.
///
/// ```
/// use convex_support::{Cuboid, Posed, SupportMap, glam::DVec2};
/// use std::f64::consts::FRAC_PI_2;
///
/// let plank = Cuboid::new(DVec2::new(3.0, 1.0))?;
/// let upright = Posed::new(plank, FRAC_PI_2, DVec2::new(10.0, 0.0))?;
/// assert!((upright.support_value(DVec2::Y) - 3.0).abs() < 1e-15);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Posed<S: SupportMap> {
    shape: S,
    rotation: <S::Vector as Vector>::Matrix,
    translation: S::Vector,
    /// What the origin `R·c + t` loses by its rounding. Far from the world's origin that is much of the shape's size, and it
    /// stays with the core.
    lost: S::Vector,
}

impl<S: SupportMap> Posed<S> {
    #[inline(always)]
    fn at(shape: S, rotation: <S::Vector as Vector>::Matrix, translation: S::Vector) -> Result<Self, InvalidShape> {
        let translation = finite("translation", translation)?;
        let lost = lost_in_sum(rotation * shape.origin(), translation);
        Ok(Self { shape, rotation, translation, lost })
    }

    /// The shape turned about the origin by `rotation` (an angle in radians in 2D, a quaternion in 3D, which is
    /// normalised first), then moved by `translation`.
    ///
    /// # Errors
    /// [`InvalidShape`] if a number is not finite or the rotation is the zero quaternion.
    #[inline(always)]
    pub fn new(
        shape: S,
        rotation: <S::Vector as Vector>::Rotation,
        translation: S::Vector,
    ) -> Result<Self, InvalidShape> {
        let unit = S::Vector::unit_rotation(rotation).ok_or(InvalidShape::ZeroRotation)?;
        Self::at(shape, S::Vector::rotation_matrix(unit), translation)
    }

    /// The shape moved by a rotation matrix, then by `translation`: for poses that come as glam's `DAffine3` or as a
    /// matrix. A matrix that has drifted from orthonormality is taken to the nearest rotation.
    ///
    /// # Errors
    /// [`InvalidShape`] if a number is not finite, the columns are not orthonormal even to half of their digits, or
    /// the matrix mirrors.
    pub fn from_matrix(
        shape: S,
        rotation: <S::Vector as Vector>::Matrix,
        translation: S::Vector,
    ) -> Result<Self, InvalidShape> {
        let rotation = orthonormal("rotation", rotation)?;
        if rotation.determinant() < ScalarOf::<S>::ZERO {
            return Err(InvalidShape::NotOrthonormal);
        }
        Self::at(shape, polished(rotation), translation)
    }

    /// The shape moved by `translation`.
    ///
    /// # Errors
    /// [`InvalidShape::NonFinite`] if a coordinate is not finite.
    #[inline]
    pub fn translated(shape: S, translation: S::Vector) -> Result<Self, InvalidShape> {
        Self::at(shape, Matrix::IDENTITY, translation)
    }

    /// The shape before it is moved.
    #[must_use]
    pub const fn shape(&self) -> &S {
        &self.shape
    }

    /// The rotation, applied first.
    #[must_use]
    pub fn rotation(&self) -> <S::Vector as Vector>::Matrix {
        self.rotation
    }

    /// The translation, applied last.
    #[must_use]
    pub fn translation(&self) -> S::Vector {
        self.translation
    }
}

/// The nearest rotation to a matrix that is one to half its digits, by one step of Newton's method for the orthogonal
/// polar factor, `R·(3 − RᵀR)/2`, which squares the error. What is a rotation to rounding stays as it is.
fn polished<M: Matrix>(matrix: M) -> M {
    type S<M> = <<M as Matrix>::Vector as Vector>::Scalar;
    let gram = M::from_cols_fn(|j| matrix.transpose_mul(matrix.col(j)));
    let off = (0..M::Vector::DIM).map(|j| (gram.col(j) - M::Vector::axis(j)).abs().max_element());
    if off.fold(S::<M>::ZERO, S::<M>::max) <= S::<M>::EPSILON * S::<M>::from_f64(8.0) {
        return matrix;
    }
    let (half, three) = (S::<M>::from_f64(0.5), S::<M>::from_f64(3.0));
    matrix * M::from_cols_fn(|j| (M::Vector::axis(j) * three - gram.col(j)) * half)
}

impl<S: SupportMap> SupportMap for Posed<S> {
    type Vector = S::Vector;

    #[inline]
    fn support(&self, direction: S::Vector) -> S::Vector {
        self.rotation * self.shape.support(self.rotation.transpose_mul(direction)) + self.translation
    }

    #[inline]
    fn origin(&self) -> S::Vector {
        self.rotation * self.shape.origin() + self.translation
    }

    #[inline(always)]
    fn core_support(&self, direction: S::Vector, hint: &mut Hint) -> S::Vector {
        self.rotation * self.shape.core_support(self.rotation.transpose_mul(direction), hint) + self.lost
    }

    #[inline(always)]
    fn core_support_derivative(&self, direction: S::Vector, change: S::Vector) -> S::Vector {
        let (direction, change) = (self.rotation.transpose_mul(direction), self.rotation.transpose_mul(change));
        self.rotation * self.shape.core_support_derivative(direction, change)
    }

    #[inline(always)]
    fn core_support_hessian(&self, direction: S::Vector, changes: [S::Vector; 2]) -> [ScalarOf<S>; 3] {
        let turned = |v| self.rotation.transpose_mul(v);
        self.shape.core_support_hessian(turned(direction), changes.map(turned))
    }

    #[inline]
    fn radius(&self) -> ScalarOf<S> {
        self.shape.radius()
    }

    #[inline]
    fn is_core_polyhedral(&self) -> bool {
        self.shape.is_core_polyhedral()
    }

    #[inline(always)]
    fn core_point(&self) -> Option<S::Vector> {
        Some(self.rotation * self.shape.core_point()? + self.lost)
    }

    #[inline(always)]
    fn core_closest_point(&self, x: S::Vector) -> Option<S::Vector> {
        let closest = self.shape.core_closest_point(self.rotation.transpose_mul(x - self.lost))?;
        Some(self.rotation * closest + self.lost)
    }

    #[inline]
    fn core_extent(&self) -> ScalarOf<S> {
        self.shape.core_extent() + self.lost.abs().max_element() * Scalar::from_f64(2.0)
    }
}
