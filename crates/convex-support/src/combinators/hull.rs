//! The convex hull of two shapes.

use num_traits::Float as _;

use crate::support::{ScalarOf, support_of_parts, swept, swept_derivative};
use crate::{Hint, Scalar, SupportMap, Vector};

/// The convex hull of the union of two shapes. Nest it for more than two.
///
/// Where both are swept by a ball, so is the hull, by the smaller ball: the hull of two balls of one radius has a
/// segment for its core.
///
/// ```
/// use convex_support::{Ball, Hull, Point, SupportMap, glam::DVec2};
///
/// let teardrop = Hull::new(Ball::new(1.0)?, Point::new(DVec2::new(0.0, 4.0))?);
/// assert_eq!(teardrop.support(DVec2::Y), DVec2::new(0.0, 4.0));
/// assert_eq!(teardrop.support(DVec2::NEG_Y), DVec2::new(0.0, -1.0));
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hull<A, B> {
    a: A,
    b: B,
}

impl<A: SupportMap, B: SupportMap<Vector = A::Vector>> Hull<A, B> {
    /// The hull of the two shapes.
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

/// The support point, relative to `origin`, of a part of a hull that is swept by `radius` as a whole.
#[inline]
fn part<S: SupportMap + ?Sized>(
    shape: &S,
    direction: S::Vector,
    hint: &mut Hint,
    origin: S::Vector,
    radius: ScalarOf<S>,
) -> S::Vector {
    // hull(A ⊕ B(r), …) = hull(A ⊕ B(r − ρ), …) ⊕ B(ρ)
    (shape.origin() - origin) + shape.core_support(direction, hint) + swept(shape.radius() - radius, direction)
}

impl<A: SupportMap, B: SupportMap<Vector = A::Vector>> SupportMap for Hull<A, B> {
    type Vector = A::Vector;

    #[inline]
    fn support(&self, direction: A::Vector) -> A::Vector {
        support_of_parts(self, direction)
    }

    #[inline]
    fn origin(&self) -> A::Vector {
        let half = ScalarOf::<A>::from_f64(0.5);
        self.a.origin() * half + self.b.origin() * half
    }

    #[inline]
    fn core_support(&self, direction: A::Vector, hint: &mut Hint) -> A::Vector {
        let (origin, radius) = (self.origin(), self.radius());
        let a = part(&self.a, direction, hint, origin, radius);
        let b = part(&self.b, direction, hint, origin, radius);
        if direction.dot(b - a) > ScalarOf::<A>::ZERO { b } else { a }
    }

    fn core_support_derivative(&self, direction: A::Vector, change: A::Vector) -> A::Vector {
        let (origin, radius) = (self.origin(), self.radius());
        let a = part(&self.a, direction, &mut Hint::new(), origin, radius);
        let b = part(&self.b, direction, &mut Hint::new(), origin, radius);
        if direction.dot(b - a) > ScalarOf::<A>::ZERO {
            self.b.core_support_derivative(direction, change)
                + swept_derivative(self.b.radius() - radius, direction, change)
        } else {
            self.a.core_support_derivative(direction, change)
                + swept_derivative(self.a.radius() - radius, direction, change)
        }
    }

    #[inline]
    fn radius(&self) -> ScalarOf<A> {
        self.a.radius().min(self.b.radius())
    }

    #[inline]
    fn is_core_polyhedral(&self) -> bool {
        self.a.radius() == self.b.radius() && self.a.is_core_polyhedral() && self.b.is_core_polyhedral()
    }

    fn core_extent(&self) -> ScalarOf<A> {
        let origin = self.origin();
        let a = (self.a.origin() - origin).norm() + self.a.core_extent() + self.a.radius();
        let b = (self.b.origin() - origin).norm() + self.b.core_extent() + self.b.radius();
        a.max(b)
    }
}
