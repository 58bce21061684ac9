//! What is known of two moving bodies at one time by points that are known to be closest, or that were so at the last
//! look.
//!
//! For balls and capsules the closest points of the cores are known in closed form. One support point proves that a
//! plane between the points keeps the bodies apart. Far from contact this is enough. Near contact the same support
//! point tells the distance as exactly as it can be known. If the bodies overlap but their cores do not, the closest
//! points prove the overlap.
//!
//! For other bodies near contact the corners that were closest a moment ago are mostly closest still. Then a plane
//! across them is known, and one support point proves that it separates the bodies. If the bodies overlap but their
//! cores do not, the closest points of the cores prove the overlap, since they are nearer than the radii. If the cores
//! overlap, the simplex of the corners and the farthest point of the difference behind them has zero inside, which
//! proves it.

use convex_support::{Scalar, Vector};
use num_traits::Float;

use super::instant::{Instant, Limits, NEAR_IN_MOTION};
use super::moving_pair::MovingPair;
use super::placed::{CornerFace, Placed};
use crate::body::{PointPair, TracedSupport as _};
use crate::gjk::{rounding, slack};
use crate::separation::{Uncertainty, room_within};
use crate::simplex::{MAX_POINTS, project_rarely};
use crate::unit::is_moderate;

/// How far the closest points of both cores may be from the support points across their plane, in errors, for them to
/// count as closest.
const POINT_IN_PLANE: f64 = 4.0;

/// If closest points are apart by this part of the size of both bodies, the direction between them is known to
/// rounding.
const WELL_APART: f64 = 1.0 / 16.0;

impl<V: Vector> MovingPair<'_, V> {
    /// The bodies at a time, by the closest points of their cores. `None` if these do not tell enough, or, near
    /// contact, if the bodies are not on the side of `axis`.
    ///
    /// All of it is compiled into one function, so that the places of the bodies need not be written to memory and read
    /// again.
    #[inline(never)]
    pub(super) fn by_closest_points(
        &self,
        time: V::Scalar,
        axis: V,
        limits: Limits<V::Scalar>,
        is_close: bool,
    ) -> Option<Instant<V>> {
        let placed = self.placed_here(time);
        let mut pair = placed.pair();
        let offset = placed.offset;
        let size = pair.size(offset);
        let points = pair.closest_points(offset, size)?;
        let v = pair.vector_between(points, offset);
        let length = v.length();
        let unit = v / length;
        // If a number is NaN, the bodies are not known to be apart.
        if !(length > Scalar::ZERO) {
            return None;
        }
        let (w, _) = pair.support(-unit);
        self.count(1);
        let (lower, radius) = (unit.dot(w + offset), pair.radius());
        let distance = lower - radius;
        let roughly = rounding(size) + pair.error();
        if !is_close && distance > roughly * Scalar::from_f64(NEAR_IN_MOTION) {
            return Some(self.across(&placed, unit, points, [distance, roughly]));
        }
        // Not where they have passed through one another.
        let is_known = length > size * Scalar::from_f64(WELL_APART) && unit.dot(axis) > Scalar::ZERO;
        if !is_known || limits.depth > Scalar::ZERO {
            return None;
        }
        // Points of segments are rounded by one product and one sum more than support points.
        let lost = V::Scalar::EPSILON * pair.extent();
        let known = placed.uncertainty();
        let reached = |along| Some(length + known.beyond_length(length, along) - radius + slack(length, radius) + lost);
        self.known_closely(&placed, &known, unit, (v, points), lower, reached)
    }

    /// The bodies as exactly as they can be known, whose cores a plane across a unit vector keeps apart by `lower`, if
    /// their points that are apart by `v` are closest, and prove that the bodies are apart or, by an upper bound of
    /// their distance, that they overlap.
    #[inline(always)]
    fn known_closely(
        &self,
        placed: &Placed<'_, V>,
        known: &Uncertainty<V>,
        unit: V,
        (v, points): (V, PointPair<V>),
        lower: V::Scalar,
        upper: impl FnOnce(V::Scalar) -> Option<V::Scalar>,
    ) -> Option<Instant<V>> {
        let radius = self.a.core.radius + self.b.core.radius;
        let along = known.along(unit);
        let (distance, error) = (lower - radius, along + slack(lower, radius));
        // If a number is NaN, the points do not count as closest.
        if !(unit.dot(v) - lower <= error * Scalar::from_f64(POINT_IN_PLANE)) {
            return None;
        }
        let is_apart = distance > error;
        let upper = if is_apart { Float::infinity() } else { upper(along)? };
        let is_known = is_apart || upper < Scalar::ZERO;
        is_known.then(|| Instant { upper, is_close: true, ..self.across(placed, unit, points, [distance, error]) })
    }

    /// The bodies at a time, as exactly as they can be known, if the corners that were closest at the last look are so
    /// still and prove that the bodies are apart or that they overlap.
    pub(super) fn near_look(&self, placed: &Placed<'_, V>, axis: V) -> Option<Instant<V>> {
        let mut pair = placed.pair();
        let size = pair.size(placed.offset);
        if !is_moderate(size) {
            return None;
        }
        let face = self.closest.borrow().closest_face(placed)?;
        let (points, length) = (face.closest_points(), face.v.length());
        let is_long = length > size * Scalar::from_f64(WELL_APART);
        let unit = if is_long { face.v / length } else { face.unit_across(axis)? };
        // Not where they have passed through one another.
        if !(unit.dot(axis) > Scalar::ZERO) {
            return None;
        }
        let known = placed.uncertainty();
        let lower = unit.dot(pair.support(-unit).0 + placed.offset);
        self.count(1);
        let reached = |_| self.overlap_of_corners(placed, &known, &face, unit);
        self.known_closely(placed, &known, unit, (face.v, points), lower, reached)
    }

    /// An upper bound of the signed distance, if the corners of a face prove that the bodies overlap; `None` if they
    /// do not.
    ///
    /// A corner that was kept is less exact than a support point. So each corner is computed anew as a support point,
    /// along a direction that leans from the other corners towards it.
    fn overlap_of_corners(
        &self,
        placed: &Placed<'_, V>,
        known: &Uncertainty<V>,
        face: &CornerFace<V>,
        unit: V,
    ) -> Option<V::Scalar> {
        let (zero, mut pair) = (V::Scalar::ZERO, placed.pair());
        let radius = pair.radius();
        let mut support = |direction| {
            self.count(1);
            pair.support(direction).0 + placed.offset
        };
        let &CornerFace { points: corners, len, .. } = face;
        let mut points = [V::ZERO; MAX_POINTS];
        for (i, point) in points[..len].iter_mut().enumerate() {
            let mut direction = -unit;
            for j in (0..len).filter(|&j| j != i) {
                let edge = corners[i] - corners[j];
                direction += edge * (V::Scalar::EPSILON.sqrt() / edge.length());
            }
            *point = support(direction);
        }
        if radius > zero {
            let weights = project_rarely(&points[..len], &|corner| -corner).coordinates;
            if !weights[..len].iter().all(|&weight| weight > zero) {
                return None;
            }
            let (mut closest, mut sum) = (V::ZERO, zero);
            for (&point, &weight) in points[..len].iter().zip(&weights) {
                closest += point * weight;
                sum += weight;
            }
            let closest = closest / sum;
            let length = closest.norm() + known.beyond(closest);
            return Some(length - radius + slack(length, radius));
        }
        if len != V::DIM {
            return None;
        }
        points[len] = support(unit);
        Some(-room_within(&points, |n| known.along(n)))
    }
}
