//! The configuration space obstacle of two shapes.

use crate::support::{ScalarOf, support_of_parts};
use crate::{Hint, SupportMap};

/// The set `A − B = { a − b : a ∈ A, b ∈ B }`, called the configuration space obstacle (CSO) of `A` and `B`.
///
/// Two shapes meet exactly where their difference contains zero; their distance is its distance from zero; and the
/// translations of `B` that make it touch `A` are the boundary of the difference. So one moving shape against another
/// becomes one ray against their difference.
///
/// ```
/// use convex_support::{Ball, Cuboid, Difference, SupportMap, glam::DVec3};
///
/// let cso = Difference::new(Cuboid::new(DVec3::ONE)?, Ball::new(0.5)?);
/// assert_eq!(cso.support_value(DVec3::X), 1.5);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[doc = include_str!("../../doc/cso.svg")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference<A, B> {
    a: A,
    b: B,
}

impl<A: SupportMap, B: SupportMap<Vector = A::Vector>> Difference<A, B> {
    /// The difference of the two shapes.
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

impl<A: SupportMap, B: SupportMap<Vector = A::Vector>> SupportMap for Difference<A, B> {
    type Vector = A::Vector;

    #[inline]
    fn support(&self, direction: A::Vector) -> A::Vector {
        support_of_parts(self, direction)
    }

    #[inline]
    fn support_value(&self, direction: A::Vector) -> ScalarOf<A> {
        self.a.support_value(direction) + self.b.support_value(-direction)
    }

    #[inline]
    fn origin(&self) -> A::Vector {
        self.a.origin() - self.b.origin()
    }

    #[inline(always)]
    fn core_support(&self, direction: A::Vector, hint: &mut Hint) -> A::Vector {
        self.a.core_support(direction, hint) - self.b.core_support(-direction, hint)
    }

    #[inline]
    fn core_support_derivative(&self, direction: A::Vector, change: A::Vector) -> A::Vector {
        self.a.core_support_derivative(direction, change) - self.b.core_support_derivative(-direction, -change)
    }

    #[inline]
    fn core_support_hessian(&self, direction: A::Vector, changes: [A::Vector; 2]) -> [ScalarOf<A>; 3] {
        let a = self.a.core_support_hessian(direction, changes);
        let b = self.b.core_support_hessian(-direction, changes);
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
        Some(self.a.core_point()? - self.b.core_point()?)
    }

    /// Where one of the cores is a point.
    #[inline]
    fn core_closest_point(&self, x: A::Vector) -> Option<A::Vector> {
        match (self.a.core_point(), self.b.core_point()) {
            (Some(a), _) => Some(a - self.b.core_closest_point(a - x)?),
            (None, Some(b)) => Some(self.a.core_closest_point(x + b)? - b),
            (None, None) => None,
        }
    }

    #[inline]
    fn core_extent(&self) -> ScalarOf<A> {
        self.a.core_extent() + self.b.core_extent()
    }
}
