//! The convex hull of two shapes.

use num_traits::Float as _;

use crate::ball_support::{swept, swept_hessian};
use crate::numerics::bound::{roundings, roundings_of};
use crate::numerics::twofold::{lost_in_sum, two_sum};
use crate::support::{ScalarOf, sum_of_hessians, support_of_parts};
use crate::{Core, CoreKind, Hint, Rounding, Scalar, SupportMap, Vector};

/// The convex hull of the union of two shapes. Nest it for more than two.
///
/// If both are swept by a ball, so is the hull, by the smaller ball: the hull of two balls of one radius has a
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
#[doc(alias("tapered_capsule", "frustum", "truncated_cone", "convex_hull", "swept_sphere"))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hull<A: SupportMap, B> {
    a: A,
    b: B,
    part_a: Part<A::Vector>,
    part_b: Part<A::Vector>,
}

/// A part of a hull that is swept by the smaller ball, relative to the hull.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Part<V: Vector> {
    /// The part's origin, relative to the hull's.
    offset: V,
    /// By how much the part's ball is larger: `hull(A ⊕ B(r), …) = hull(A ⊕ B(r − ρ), …) ⊕ B(ρ)`.
    excess: V::Scalar,
}

impl<V: Vector> Part<V> {
    #[inline]
    fn support<S: SupportMap<Vector = V>>(&self, shape: &S, direction: V, hint: &mut Hint) -> V {
        self.offset + shape.core_support(direction, hint) + swept(self.excess, direction)
    }

    #[inline]
    fn hessian<S: SupportMap<Vector = V>>(&self, shape: &S, direction: V, changes: [V; 2]) -> [V::Scalar; 3] {
        let core = shape.core_support_hessian(direction, changes);
        sum_of_hessians(core, swept_hessian(self.excess, direction, changes))
    }

    fn extent(&self, extent: V::Scalar) -> V::Scalar {
        self.offset.norm() + extent + self.excess
    }

    /// The rounding of the part, with that of its offset and its radius, and of the sum with the offset.
    fn rounding<S: SupportMap<Vector = V>>(&self, shape: &S, hull: &Core<V>) -> Rounding<V> {
        let (part, Core { origin, radius, .. }) = (shape.rounding().swept(self.excess), shape.core());
        let [_, lost] = two_sum(radius, -hull.radius);
        let extent = part.extent + self.offset.abs();
        let zero = V::Scalar::ZERO;
        let summed = V::from_fn(|i| if self.offset.get(i) == zero { zero } else { roundings(2.0, extent.get(i)) });
        let placed = Rounding { extent, ..part }.with_error(lost_in_sum(origin, -hull.origin).abs() + summed);
        placed.with_radius_error(lost.abs())
    }
}

impl<A: SupportMap, B: SupportMap<Vector = A::Vector>> Hull<A, B> {
    /// The hull of the two shapes.
    pub fn new(a: A, b: B) -> Self {
        let (core_a, core_b) = (a.core(), b.core());
        let (origin, radius) = (middle(&core_a, &core_b), core_a.radius.min(core_b.radius));
        let part = |core: Core<A::Vector>| Part { offset: core.origin - origin, excess: core.radius - radius };
        Self { part_a: part(core_a), part_b: part(core_b), a, b }
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

fn middle<V: Vector>(a: &Core<V>, b: &Core<V>) -> V {
    let half = V::Scalar::from_f64(0.5);
    a.origin * half + b.origin * half
}

impl<A: SupportMap, B: SupportMap<Vector = A::Vector>> SupportMap for Hull<A, B> {
    type Vector = A::Vector;

    #[inline]
    fn support(&self, direction: A::Vector) -> A::Vector {
        support_of_parts(self, direction)
    }

    #[inline(always)]
    fn core(&self) -> Core<A::Vector> {
        let (a, b) = (self.a.core(), self.b.core());
        let is_polytope =
            a.radius == b.radius && !matches!(a.kind, CoreKind::Curved) && !matches!(b.kind, CoreKind::Curved);
        let extent = self.part_a.extent(a.extent).max(self.part_b.extent(b.extent));
        Core {
            origin: middle(&a, &b),
            radius: a.radius.min(b.radius),
            rolling_radius: Scalar::ZERO,
            extent,
            // The offset of a part, its sums and the radius that stays with it lose 10 roundings; 4 of the difference
            // decide which part is farther.
            error: a.error.max(b.error) + roundings(18.0, extent) + roundings(1.0, a.radius.max(b.radius)),
            kind: if is_polytope { CoreKind::Polytope } else { CoreKind::Curved },
        }
    }

    #[inline]
    fn core_support(&self, direction: A::Vector, hint: &mut Hint) -> A::Vector {
        let a = self.part_a.support(&self.a, direction, hint);
        let b = self.part_b.support(&self.b, direction, hint);
        if direction.dot(b - a) > ScalarOf::<A>::ZERO { b } else { a }
    }

    fn core_support_hessian(&self, direction: A::Vector, changes: [A::Vector; 2]) -> [ScalarOf<A>; 3] {
        let a = self.part_a.support(&self.a, direction, &mut Hint::new());
        let b = self.part_b.support(&self.b, direction, &mut Hint::new());
        if direction.dot(b - a) > ScalarOf::<A>::ZERO {
            self.part_b.hessian(&self.b, direction, changes)
        } else {
            self.part_a.hessian(&self.a, direction, changes)
        }
    }

    /// The rounding of the worse part. The product of the direction with the difference decides which is farther, 4
    /// roundings.
    fn rounding(&self) -> Rounding<A::Vector> {
        let hull = self.core();
        let (a, b) = (self.part_a.rounding(&self.a, &hull), self.part_b.rounding(&self.b, &hull));
        let worse = Rounding {
            extent: a.extent.max(b.extent),
            error: a.error.max(b.error),
            error_length: a.error_length.max(b.error_length),
        };
        worse.with_error(roundings_of(4.0, a.extent + b.extent)).raised()
    }
}
