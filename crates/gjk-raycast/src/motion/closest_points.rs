//! A look at two moving bodies by the closest points of their cores, where those are known in closed form, as of balls
//! and capsules.
//!
//! One support point proves that a plane between the points keeps the bodies apart. Far from contact that is all. Near
//! contact the same point tells the distance as well as it can be known; and where the bodies overlap but their cores
//! do not, the points prove that.

use convex_support::{Rounding, Scalar, SupportMap as _, Vector};
use num_traits::Float;

use super::instant::{Closeness, IN_PLANE, Instant, LONG, NEAR};
use super::moving_pair::MovingPair;
use crate::body::{Pair, TracedSupport as _};
use crate::gjk::rounding;
use crate::separation::Uncertainty;

/// A plane between the closest points of two cores, lengths in the world's unit.
struct Between<V: Vector> {
    /// The unit vector across it.
    unit: V,
    /// How far the points are from one another, and how far along the unit vector.
    length: V::Scalar,
    along: V::Scalar,
    /// How far the plane keeps the cores apart.
    lower: V::Scalar,
    /// The radii of both bodies, the extents of both cores, and the offset of their origins.
    radius: V::Scalar,
    extent: V::Scalar,
    offset: V,
}

impl<V: Vector> MovingPair<'_, V> {
    /// The pair at a time by the closest points of its cores; `None` where they do not tell as much as is wanted. What
    /// is seen closely is to be on the side of `axis`.
    ///
    /// All is compiled into one function, so that what is known of the bodies at the time need not be written to memory
    /// and read again.
    #[inline(never)]
    pub(super) fn by_closest_points(&self, time: V::Scalar, axis: V, closeness: Closeness) -> Option<Instant<V>> {
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
        let is_rough = closeness != Closeness::Close && distance > roughly * Scalar::from_f64(NEAR);
        let (error, upper) = if is_rough {
            (roughly, Float::infinity())
        } else {
            // Not where they have passed through one another.
            let is_known = closeness != Closeness::Rough
                && length > size * Scalar::from_f64(LONG)
                && unit.dot(axis) > Scalar::ZERO;
            if !is_known {
                return None;
            }
            let shapes = [placed.a.rounding(), placed.b.rounding()];
            let (along, extent) = (unit.dot(v), pair.extent());
            Between { unit, length, along, lower, radius, extent, offset }.closely(shapes)?
        };
        let point_a = placed.place + offset + points.a - unit * self.a.core.radius;
        let point = placed.place + points.b + unit * self.b.core.radius;
        let closing = self.closing(time, unit, [point_a, point]);
        let gap = distance - error;
        Some(Instant { time, normal: unit, gap, distance, upper, error, closing, point, is_close: !is_rough })
    }
}

impl<V: Vector> Between<V> {
    /// How well the distance of shapes that round like that is known, and what it is certainly not more than; `None`
    /// where that tells neither that they are apart nor that they overlap.
    #[inline(always)]
    fn closely(self, shapes: [Rounding<V>; 2]) -> Option<(V::Scalar, V::Scalar)> {
        let Self { unit, length, along, lower, radius, extent, offset } = self;
        // The origin of `b` is at zero, so that nothing is lost of their difference.
        let known = Uncertainty::of_exact_offset(shapes, offset);
        // As in an answer: the unit vector, the radii and the sums.
        let slack = |length: V::Scalar| V::Scalar::EPSILON * V::Scalar::from_f64(3.0) * (length + radius);
        let error_along = known.along(unit);
        let error = error_along + slack(lower.abs());
        let distance = lower - radius;
        // NaN is not in the plane.
        if !(along - lower <= error * V::Scalar::from_f64(IN_PLANE)) {
            return None;
        }
        if distance > error {
            return Some((error, V::Scalar::infinity()));
        }
        // Points of segments are rounded by a product and a sum more than support points.
        let lost = V::Scalar::EPSILON * extent;
        let upper = known.greatest_length(length, error_along) - radius + slack(length) + lost;
        (upper < V::Scalar::ZERO).then_some((error, upper))
    }
}
