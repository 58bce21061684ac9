//! A look at two moving bodies by the closest points of their cores, where those are known in closed form, as of balls
//! and capsules.
//!
//! One support point proves that a plane between the points keeps the bodies apart. Far from contact that is all. Near
//! contact the same point tells the distance as well as it can be known; and where the bodies overlap but their cores
//! do not, the points prove that.

use convex_support::{Scalar, SupportMap as _, Vector};
use num_traits::Float;

use super::instant::{IN_PLANE, Instant, LONG, Limits, NEAR};
use super::moving_pair::MovingPair;
use crate::body::{Pair, TracedSupport as _};
use crate::gjk::rounding;
use crate::separation::{Uncertainty, slack};

impl<V: Vector> MovingPair<'_, V> {
    /// The pair at a time by the closest points of its cores; `None` where they do not tell as much as is wanted. What
    /// is seen closely is to be on the side of `axis`.
    ///
    /// All is compiled into one function, so that what is known of the bodies at the time need not be written to memory
    /// and read again.
    #[inline(never)]
    pub(super) fn by_closest_points(
        &self,
        time: V::Scalar,
        axis: V,
        limits: Limits<V::Scalar>,
        is_close: bool,
    ) -> Option<Instant<V>> {
        let placed = self.placed_here(time);
        let mut pair = Pair::new(&placed);
        let offset = placed.offset;
        let size = pair.size(offset);
        let points = pair.closest_points(offset, size)?;
        let v = pair.vector_between(points, offset);
        let length = v.length();
        let unit = v / length;
        // NaN is not apart.
        if !(length > Scalar::ZERO) {
            return None;
        }
        let (w, _) = pair.support(-unit);
        self.count(1);
        let (lower, radius) = (unit.dot(w + offset), pair.radius());
        let distance = lower - radius;
        let roughly = rounding(size) + pair.error();
        if !is_close && distance > roughly * Scalar::from_f64(NEAR) {
            return Some(self.across(&placed, unit, points, [distance, roughly]));
        }
        // Not where they have passed through one another.
        let is_known = length > size * Scalar::from_f64(LONG) && unit.dot(axis) > Scalar::ZERO;
        if !is_known || limits.depth > Scalar::ZERO {
            return None;
        }
        // The origin of `b` is at zero, so that nothing is lost of their difference.
        let known = Uncertainty::of_exact_offset([placed.a.rounding(), placed.b.rounding()], offset);
        let error_along = known.along(unit);
        let error = error_along + slack(lower, radius);
        // NaN is not in the plane.
        if !(unit.dot(v) - lower <= error * Scalar::from_f64(IN_PLANE)) {
            return None;
        }
        let mut upper: V::Scalar = Float::infinity();
        if !(distance > error) {
            // Points of segments are rounded by a product and a sum more than support points.
            let lost = V::Scalar::EPSILON * pair.extent();
            upper = known.greatest_length(length, error_along) - radius + slack(length, radius) + lost;
            if !(upper < Scalar::ZERO) {
                return None;
            }
        }
        Some(Instant { upper, is_close: true, ..self.across(&placed, unit, points, [distance, error]) })
    }
}
