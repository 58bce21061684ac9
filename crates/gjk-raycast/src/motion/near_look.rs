//! A look at two bodies nearly in contact, by what was closest at the last look.
//!
//! Near contact the same corners are mostly closest as a moment ago. Then a plane across them is known, and one support
//! point proves that it separates the bodies. Where they overlap, the closest points of their cores prove that if they
//! are nearer than the radii; and of cores that overlap themselves, a simplex of the corners and the point of the
//! difference farthest from them has zero inside.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::corners::CornerFace;
use super::instant::{IN_PLANE, Instant, LONG};
use super::moving_pair::MovingPair;
use super::placed::Placed;
use crate::body::{Pair, PointPair};
use crate::separation::Cores;
use crate::separation::across_corners;
use crate::simplex::{MAX_POINTS, project};
use crate::unit::is_moderate;

/// What may have been closest, lengths in the world's unit.
struct PlaneBetween<V: Vector> {
    /// Points of the cores, each relative to its body's origin, and the vector between them.
    points: PointPair<V>,
    v: V,
    /// The unit vector across the plane between them.
    unit: V,
}

impl<V: Vector> MovingPair<'_, V> {
    /// The bodies at a time as well as it can be known, if what was closest at the last look is so still, and proves
    /// that they are apart or overlap.
    pub(super) fn near_look(&self, time: V::Scalar, placed: &Placed<'_, V>, axis: V) -> Option<Instant<V>> {
        let pair = Pair::new(placed);
        let size = pair.size(placed.offset);
        if !is_moderate(size) {
            return None;
        }
        let face = self.closest.borrow().closest_face(placed)?;
        let closest = PlaneBetween::new(face.closest_points(), face.v, size);
        let PlaneBetween { points, v, unit } = closest.or_else(|| PlaneBetween::in_plane(&face, axis))?;
        // Not where they have passed through one another.
        if !(unit.dot(axis) > Scalar::ZERO) {
            return None;
        }
        let mut cores = Cores::new(placed, [pair.core_a, pair.core_b]);
        cores.sharpen();
        let (scale, radius) = (cores.scale(), cores.radius());
        // As in an answer: the unit vector, the radii and the sums.
        let slack = |length: V::Scalar| V::Scalar::EPSILON * Scalar::from_f64(3.0) * (length + radius);
        let lower = unit.dot(cores.support(-unit)?.point) * scale;
        let error = cores.error_along(unit) * scale + slack(lower.abs());
        // NaN is not in the plane.
        let is_closest = unit.dot(v) - lower <= error * Scalar::from_f64(IN_PLANE);
        let distance = lower - radius;
        let mut upper = V::Scalar::infinity();
        if is_closest && !(distance > error) {
            upper = self.overlap_of_corners(&mut cores, &face, unit)?;
        }
        self.count(cores.iterations);
        if !is_closest || !(distance > error || upper < Scalar::ZERO) {
            return None;
        }
        let point_a = placed.place + placed.offset + points.a - unit * self.a.core.radius;
        let point = placed.place + points.b + unit * self.b.core.radius;
        let closing = self.closing(time, unit, [point_a, point]);
        let gap = distance - error;
        Some(Instant { time, normal: unit, gap, distance, upper, error, closing, point, is_close: true })
    }

    /// What the signed distance is certainly not more than, if the corners of a face prove that the bodies overlap;
    /// infinity if not.
    ///
    /// Each is looked for anew, along a direction that leans away from the others: as it was kept, it is not known as
    /// well as a support point.
    fn overlap_of_corners(&self, cores: &mut Cores<'_, V>, face: &CornerFace<V>, unit: V) -> Option<V::Scalar> {
        let (zero, infinity) = (V::Scalar::ZERO, V::Scalar::infinity());
        let (scale, radius, dimension) = (cores.scale(), cores.radius(), V::DIM);
        let (corners, len) = face.points();
        let mut points = [V::ZERO; MAX_POINTS];
        for (i, point) in points[..len].iter_mut().enumerate() {
            let mut direction = -unit;
            for j in (0..len).filter(|&j| j != i) {
                let edge = corners[i] - corners[j];
                direction += edge * (V::Scalar::EPSILON.sqrt() / edge.length());
            }
            *point = cores.support(direction)?.point;
        }
        if radius > zero {
            let weights = project(&points[..len], |corner| -corner).coordinates;
            if !weights[..len].iter().all(|&weight| weight > zero) {
                return Some(infinity);
            }
            let (mut closest, mut sum) = (V::ZERO, zero);
            for (&point, &weight) in points[..len].iter().zip(&weights) {
                closest += point * weight;
                sum += weight;
            }
            let length = cores.greatest_length(closest / sum) * scale;
            return Some(length - radius + V::Scalar::EPSILON * Scalar::from_f64(3.0) * (length + radius));
        }
        if len != dimension {
            return Some(infinity);
        }
        points[len] = cores.support(unit)?.point;
        Some(-cores.room_within(&points[..=len]) * scale)
    }
}

impl<V: Vector> PlaneBetween<V> {
    /// Points that are apart by `v`, for bodies of the given size; `None` where that is too short to have a direction.
    #[inline(always)]
    fn new(points: PointPair<V>, v: V, size: V::Scalar) -> Option<Self> {
        let length = v.length();
        (length > size * Scalar::from_f64(LONG)).then(|| Self { points, v, unit: v / length })
    }

    /// The closest points of a face that spans a plane.
    fn in_plane(face: &CornerFace<V>, axis: V) -> Option<Self> {
        let (corners, len) = face.points();
        let (normal, _) = if len == V::DIM { across_corners(&corners) } else { return None };
        let unit = normal.unit()?;
        let unit = if unit.dot(axis) < V::Scalar::ZERO { -unit } else { unit };
        Some(Self { points: face.closest_points(), v: face.v, unit })
    }
}
