//! The Minkowski sum of two shapes.

use num_traits::Float as _;

use crate::line_crossing::crossed_by_line::closely;
use crate::numerics::bound::{roundings, roundings_of};
use crate::numerics::twofold::{lost_in_sum, two_sum};
use crate::support::{ScalarOf, sum_of_hessians, support_of_parts};
use crate::{
    CertainCrossing, Close, CloseLine, Core, CoreKind, CrossedByLine, Hint, LineCrossing, LineQuery, Parallelotope,
    Rounding, Scalar, SupportMap, Vector,
};

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
#[doc(alias("swept_volume", "sweep", "dilation"))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MinkowskiSum<A: SupportMap, B> {
    a: A,
    b: B,
    /// The rounding error of the sum of the origins, which stays with the core.
    lost: A::Vector,
}

impl<A: SupportMap, B: SupportMap<Vector = A::Vector>> MinkowskiSum<A, B> {
    /// The sum of the two shapes.
    pub fn new(a: A, b: B) -> Self {
        let lost = lost_in_sum(a.core().origin, b.core().origin);
        Self { a, b, lost }
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

    #[inline(always)]
    fn core(&self) -> Core<A::Vector> {
        let (a, b) = (self.a.core(), self.b.core());
        let (radius, extent) =
            (a.radius + b.radius, a.extent + b.extent + self.lost.abs().max_element() * Scalar::from_f64(2.0));
        Core {
            origin: a.origin + b.origin,
            radius,
            rolling_radius: a.rolling_radius + b.rolling_radius,
            extent,
            // Two sums of points, and one of radii.
            error: a.error + b.error + roundings(2.0, extent) + roundings(1.0, radius),
            kind: a.kind.plus(b.kind, |a, b| a + b + self.lost),
        }
    }

    #[inline(always)]
    fn core_support(&self, direction: A::Vector, hint: &mut Hint) -> A::Vector {
        self.a.core_support(direction, hint) + self.b.core_support(direction, hint) + self.lost
    }

    #[inline]
    fn core_support_hessian(&self, direction: A::Vector, changes: [A::Vector; 2]) -> [ScalarOf<A>; 3] {
        let a = self.a.core_support_hessian(direction, changes);
        sum_of_hessians(a, self.b.core_support_hessian(direction, changes))
    }

    /// Known if one of the cores is a point.
    #[inline]
    fn core_closest_point(&self, x: A::Vector) -> Option<A::Vector> {
        let x = x - self.lost;
        let closest = match (self.a.core().kind, self.b.core().kind) {
            (CoreKind::Point(a), _) => a + self.b.core_closest_point(x - a)?,
            (_, CoreKind::Point(b)) => self.a.core_closest_point(x - b)? + b,
            _ => return None,
        };
        Some(closest + self.lost)
    }

    /// Known if one of the cores is a point.
    #[inline]
    fn certain_crossing(&self, line: LineQuery<A::Vector>) -> Option<CertainCrossing<A::Vector>> {
        if line.is_close {
            return closely(self, line);
        }
        let (a, b) = (self.a.core(), self.b.core());
        // The point has an error.
        let from =
            |point: Core<A::Vector>, at| line.seen_from([point.origin, at]).within(point.error).sweeping(point.radius);
        match (a.kind, b.kind) {
            (CoreKind::Point(at), _) => self.b.certain_crossing(from(a, at)),
            (_, CoreKind::Point(at)) => self.a.certain_crossing(from(b, at)),
            _ => None,
        }
    }

    fn close_crossing(&self, line: &CloseLine) -> Close {
        let (a, b) = (self.a.core(), self.b.core());
        let from = |point: Core<A::Vector>, at| {
            line.seen_from(point.origin).seen_from(at).within(point.error).sweeping(point.radius)
        };
        match (a.kind, b.kind) {
            (CoreKind::Point(at), _) => self.b.close_crossing(&from(a, at)),
            (_, CoreKind::Point(at)) => self.a.close_crossing(&from(b, at)),
            _ => None,
        }
    }

    /// Known if one of the cores is a point.
    #[inline]
    fn core_parallelotope(&self) -> Option<Parallelotope<A::Vector>> {
        match (self.a.core().kind, self.b.core().kind) {
            (CoreKind::Point(a), _) => Some(self.b.core_parallelotope()?.mapped(|v| v, a + self.lost)),
            (_, CoreKind::Point(b)) => Some(self.a.core_parallelotope()?.mapped(|v| v, b + self.lost)),
            _ => None,
        }
    }

    /// The errors add up; the sum of the points is rounded, and again if a lost part is added.
    fn rounding(&self) -> Rounding<A::Vector> {
        let (a, b) = (self.a.rounding(), self.b.rounding());
        let sum = Rounding {
            extent: a.extent + b.extent + self.lost.abs(),
            error: a.error + b.error,
            error_length: a.error_length + b.error_length,
        };
        let zero = ScalarOf::<A>::ZERO;
        let summands = |i: usize| [a.extent, b.extent, self.lost].into_iter().filter(|v| v.get(i) != zero).count();
        let rounded = A::Vector::from_fn(|i| ScalarOf::<A>::from_f64(summands(i).saturating_sub(1) as f64));
        let [_, radius] = two_sum(self.a.core().radius, self.b.core().radius);
        sum.with_error(rounded * roundings_of(1.0, sum.extent)).with_radius_error(radius.abs()).raised()
    }
}

impl<A: CrossedByLine, B: CrossedByLine<Vector = A::Vector>> CrossedByLine for MinkowskiSum<A, B> {
    /// Known if one of the cores is a point.
    #[inline]
    fn core_line_crossing(
        &self,
        source: A::Vector,
        direction: A::Vector,
        radius: ScalarOf<A>,
    ) -> LineCrossing<A::Vector> {
        let source = source - self.lost;
        match (self.a.core().kind, self.b.core().kind) {
            (CoreKind::Point(a), _) => self.b.core_line_crossing(source - a, direction, radius),
            (_, CoreKind::Point(b)) => self.a.core_line_crossing(source - b, direction, radius),
            _ => LineCrossing::Unknown,
        }
    }
}
