//! A look at two moving bodies that are well apart, of which the search needs to know their distance only roughly.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::instant::{Instant, NEAR};
use super::moving_pair::MovingPair;
use super::placed::{CornerFace, Placed};
use crate::SignedDistanceOptions;
use crate::body::{Pair, PointPair, TracedSupport as _};
use crate::gjk::{self, Frame, Gjk, GjkOptions, gjk, rounding};
use crate::observer::Observer;
use crate::unit::is_moderate;

/// How wide a bracket on the distance of bodies that are well apart may stay, relative to it: where they are looked at
/// next hardly depends on it, and their gap is proved however wide it is. A narrower one takes more support points, a
/// wider one more looks.
const ROUGH: f64 = 0.2;

/// Points in another unit.
pub(super) fn times<V: Vector>(points: PointPair<V>, factor: V::Scalar) -> PointPair<V> {
    PointPair { a: points.a * factor, b: points.b * factor }
}

impl<V: Vector> MovingPair<'_, V> {
    /// The pair at a time; `None` where the bodies are nearly in contact, or overlap and nobody can tell by how much.
    ///
    /// Where the corners that were closest at the last time are so still, one support point proves it. Otherwise GJK
    /// goes on from there. Where the bodies overlap by more than rounding, the best plane known tells about how much,
    /// which is all that the search needs.
    pub(super) fn roughly(&self, placed: &Placed<'_, V>, axis: V, limit: V::Scalar) -> Option<Instant<V>> {
        let pair = &mut Pair::new(placed);
        let size = pair.size(placed.offset);
        let face = if is_moderate(size) { self.closest.borrow().closest_face(placed) } else { None };
        match face {
            Some(face) => self.at_face(placed, pair, &face, axis, limit),
            None => self.searched(placed, pair, axis, None, None, limit),
        }
    }

    /// The same by the face that was closest at the last time, or if it is no longer, by GJK.
    fn at_face(
        &self,
        placed: &Placed<'_, V>,
        pair: &mut Pair<'_, Placed<'_, V>>,
        face: &CornerFace<V>,
        axis: V,
        limit: V::Scalar,
    ) -> Option<Instant<V>> {
        let (zero, radius, length) = (V::Scalar::ZERO, pair.radius(), face.v.length());
        let error = rounding(pair.size(placed.offset)) + pair.error();
        // NaN is not.
        let is_well_off = |distance: V::Scalar| distance.abs() > error * Scalar::from_f64(NEAR);
        // Where the cores have passed through one another, its plane is the other way round.
        let (v, signed) = if face.v.dot(axis) > zero { (face.v, length) } else { (-face.v, -length) };
        // They are no farther apart than that.
        if !is_well_off(signed - radius) {
            return None;
        }
        let known = pair.support(-v);
        let lower = v.dot(known.0 + placed.offset) / length;
        let distance = lower - radius;
        if is_well_off(distance) {
            let is_closest = signed - lower <= distance.abs() * Scalar::from_f64(ROUGH);
            // A body may be thinner than cores would be in one another, and left behind.
            let mut is_between = || v.dot(pair.support(v).0 + placed.offset) > zero;
            if is_closest && (signed > zero || is_between()) || distance > limit + error {
                self.count(if signed > zero { 1 } else { 2 });
                return Some(self.across(placed, v / length, face.closest_points(), [distance, error]));
            }
        }
        let begins_there = signed > radius;
        self.searched(placed, pair, axis, begins_there.then_some(face), begins_there.then_some(known), limit)
    }

    /// The same by GJK, which begins along an axis, or with a face and the support point across the vector to it.
    fn searched(
        &self,
        placed: &Placed<'_, V>,
        pair: &mut Pair<'_, Placed<'_, V>>,
        axis: V,
        face: Option<&CornerFace<V>>,
        known: Option<(V, PointPair<V>)>,
        limit: V::Scalar,
    ) -> Option<Instant<V>> {
        let size = pair.size(placed.offset);
        let frame = Frame::new(pair, placed.offset, size);
        let Frame { scale, per_unit, radius, error, .. } = frame;
        let in_unit = |(point, points): (V, PointPair<V>)| (point * per_unit, times(points, per_unit));
        let mut state = match face {
            None => Gjk::new(axis),
            Some(face) => Gjk::at_face(face.corners().map(in_unit), face.weights, face.v * per_unit),
        };
        let options = GjkOptions {
            limit: limit * per_unit + radius,
            tolerance: Scalar::from_f64(ROUGH),
            ..GjkOptions::new(state.normal, SignedDistanceOptions::<V>::new().max_iterations)
        };
        let end = gjk(&mut state, pair, frame, options, known.map(in_unit), &mut Observer::none());
        self.count(state.iterations);
        let (distance, near) = (state.lower - radius, error * Scalar::from_f64(NEAR));
        let unit = state.axis.unit()?;
        let known = [state.lower * scale - pair.radius(), error * scale];
        // NaN is neither.
        if end == gjk::End::Separated && distance > near {
            state.ensure_measured();
            // Of curved bodies the corners would be others.
            if !pair.is_curved() {
                let corners = state.simplex.weighted().map(|(_, corner)| times(corner, scale));
                self.closest.borrow_mut().keep(corners, placed);
            }
            return Some(self.across(placed, unit, times(state.simplex.weighted_witness(), scale), known));
        }
        if end == gjk::End::Overlap && distance < -near {
            self.count(1);
            let (_, points) = pair.support(-unit);
            return Some(self.across(placed, unit, times(points, scale), known));
        }
        None
    }
}
