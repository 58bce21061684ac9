//! A shape moved without deforming it.

use crate::error::{InvalidShape, finite};
use crate::support::ScalarOf;
use crate::{Hint, Matrix, SupportMap, Vector};

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
}

impl<S: SupportMap> Posed<S> {
    /// The shape turned about the origin by `rotation` (an angle in radians in 2D, a quaternion in 3D, which is
    /// normalised first), then moved by `translation`.
    ///
    /// # Errors
    /// [`InvalidShape`] if a number is not finite or the rotation is the zero quaternion.
    pub fn new(
        shape: S,
        rotation: <S::Vector as Vector>::Rotation,
        translation: S::Vector,
    ) -> Result<Self, InvalidShape> {
        let rotation = S::Vector::rotation_matrix(rotation).ok_or(InvalidShape::ZeroRotation)?;
        Ok(Self { shape, rotation, translation: finite("translation", translation)? })
    }

    /// The shape moved by `translation`.
    ///
    /// # Errors
    /// [`InvalidShape::NonFinite`] if a coordinate is not finite.
    pub fn translated(shape: S, translation: S::Vector) -> Result<Self, InvalidShape> {
        Ok(Self { shape, rotation: Matrix::IDENTITY, translation: finite("translation", translation)? })
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

    #[inline]
    fn core_support(&self, direction: S::Vector, hint: &mut Hint) -> S::Vector {
        self.rotation * self.shape.core_support(self.rotation.transpose_mul(direction), hint)
    }

    #[inline]
    fn core_support_derivative(&self, direction: S::Vector, change: S::Vector) -> S::Vector {
        let (direction, change) = (self.rotation.transpose_mul(direction), self.rotation.transpose_mul(change));
        self.rotation * self.shape.core_support_derivative(direction, change)
    }

    #[inline]
    fn radius(&self) -> ScalarOf<S> {
        self.shape.radius()
    }

    #[inline]
    fn core_extent(&self) -> ScalarOf<S> {
        self.shape.core_extent()
    }
}
