//! The Minkowski sum of two shapes.

use crate::support::{ScalarOf, support_of_parts};
use crate::{Hint, SupportMap};

/// The set `A + B = { a + b : a ∈ A, b ∈ B }`: one shape swept by the other. Nest it for more than two.
///
/// ```
/// use convex_support::{Cuboid, MinkowskiSum, Segment, SupportMap, glam::DVec2};
///
/// let square = Cuboid::new(DVec2::ONE)?;
/// let path = Segment::new([DVec2::ZERO, DVec2::new(5.0, 0.0)])?;
/// assert_eq!(MinkowskiSum::new(square, path).support(DVec2::ONE), DVec2::new(6.0, 1.0));
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MinkowskiSum<A, B> {
    a: A,
    b: B,
}

impl<A: SupportMap, B: SupportMap<Vector = A::Vector>> MinkowskiSum<A, B> {
    /// The sum of the two shapes.
    pub const fn new(a: A, b: B) -> Self {
        Self { a, b }
    }

    /// The first shape.
    #[must_use]
    pub const fn a(&self) -> &A {
        &self.a
    }

    /// The second shape.
    #[must_use]
    pub const fn b(&self) -> &B {
        &self.b
    }
}

impl<A: SupportMap, B: SupportMap<Vector = A::Vector>> SupportMap for MinkowskiSum<A, B> {
    type Vector = A::Vector;

    #[inline]
    fn support(&self, direction: A::Vector) -> A::Vector {
        support_of_parts(self, direction)
    }

    #[inline]
    fn support_value(&self, direction: A::Vector) -> ScalarOf<A> {
        self.a.support_value(direction) + self.b.support_value(direction)
    }

    #[inline]
    fn origin(&self) -> A::Vector {
        self.a.origin() + self.b.origin()
    }

    #[inline(always)]
    fn core_support(&self, direction: A::Vector, hint: &mut Hint) -> A::Vector {
        self.a.core_support(direction, hint) + self.b.core_support(direction, hint)
    }

    #[inline]
    fn core_support_derivative(&self, direction: A::Vector, change: A::Vector) -> A::Vector {
        self.a.core_support_derivative(direction, change) + self.b.core_support_derivative(direction, change)
    }

    #[inline]
    fn core_support_hessian(&self, direction: A::Vector, changes: [A::Vector; 2]) -> [ScalarOf<A>; 3] {
        let a = self.a.core_support_hessian(direction, changes);
        let b = self.b.core_support_hessian(direction, changes);
        [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
    }

    #[inline]
    fn radius(&self) -> ScalarOf<A> {
        self.a.radius() + self.b.radius()
    }

    #[inline]
    fn is_core_polyhedral(&self) -> bool {
        self.a.is_core_polyhedral() && self.b.is_core_polyhedral()
    }

    #[inline]
    fn core_point(&self) -> Option<A::Vector> {
        Some(self.a.core_point()? + self.b.core_point()?)
    }

    /// Where one of the cores is a point.
    #[inline]
    fn core_closest_point(&self, x: A::Vector) -> Option<A::Vector> {
        match (self.a.core_point(), self.b.core_point()) {
            (Some(a), _) => Some(a + self.b.core_closest_point(x - a)?),
            (None, Some(b)) => Some(self.a.core_closest_point(x - b)? + b),
            (None, None) => None,
        }
    }

    #[inline]
    fn core_extent(&self) -> ScalarOf<A> {
        self.a.core_extent() + self.b.core_extent()
    }
}
