//! A shape swept by a ball.

use crate::error::{InvalidShape, non_negative};
use crate::support::{ScalarOf, support_of_parts};
use crate::{Hint, SupportMap, Vector};

/// The Minkowski sum of a shape and a ball: the shape grown by a radius, its edges and corners rounded.
///
/// The radius is kept apart from the core, so that rounding costs the algorithms nothing.
///
/// ```
/// use convex_support::{Rounded, SupportMap, Triangle, glam::DVec2};
///
/// let triangle = Triangle::new([DVec2::ZERO, DVec2::X, DVec2::Y])?;
/// assert_eq!(Rounded::new(triangle, 0.5)?.support(DVec2::X), DVec2::new(1.5, 0.0));
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounded<S: SupportMap> {
    shape: S,
    radius: ScalarOf<S>,
}

impl<S: SupportMap> Rounded<S> {
    /// The shape swept by a ball of the given radius, which may be 0.
    ///
    /// # Errors
    /// [`InvalidShape`] if the radius is negative or not finite.
    pub fn new(shape: S, radius: ScalarOf<S>) -> Result<Self, InvalidShape> {
        Ok(Self { shape, radius: non_negative("radius", radius)? })
    }

    /// The shape before it is rounded.
    #[must_use]
    pub const fn shape(&self) -> &S {
        &self.shape
    }

    /// The radius of the ball that is added to the shape, which may have a [`radius`](SupportMap::radius) of its own.
    #[must_use]
    pub fn rounding(&self) -> ScalarOf<S> {
        self.radius
    }
}

impl<S: SupportMap> SupportMap for Rounded<S> {
    type Vector = S::Vector;

    #[inline]
    fn support(&self, direction: S::Vector) -> S::Vector {
        support_of_parts(self, direction)
    }

    #[inline]
    fn support_value(&self, direction: S::Vector) -> ScalarOf<S> {
        self.shape.support_value(direction) + direction.norm() * self.radius
    }

    #[inline]
    fn origin(&self) -> S::Vector {
        self.shape.origin()
    }

    #[inline(always)]
    fn core_support(&self, direction: S::Vector, hint: &mut Hint) -> S::Vector {
        self.shape.core_support(direction, hint)
    }

    #[inline]
    fn core_support_derivative(&self, direction: S::Vector, change: S::Vector) -> S::Vector {
        self.shape.core_support_derivative(direction, change)
    }

    #[inline]
    fn core_support_hessian(&self, direction: S::Vector, changes: [S::Vector; 2]) -> [ScalarOf<S>; 3] {
        self.shape.core_support_hessian(direction, changes)
    }

    #[inline]
    fn radius(&self) -> ScalarOf<S> {
        self.shape.radius() + self.radius
    }

    #[inline]
    fn is_core_polyhedral(&self) -> bool {
        self.shape.is_core_polyhedral()
    }

    #[inline]
    fn core_point(&self) -> Option<S::Vector> {
        self.shape.core_point()
    }

    #[inline]
    fn core_closest_point(&self, x: S::Vector) -> Option<S::Vector> {
        self.shape.core_closest_point(x)
    }

    #[inline]
    fn core_extent(&self) -> ScalarOf<S> {
        self.shape.core_extent()
    }
}
