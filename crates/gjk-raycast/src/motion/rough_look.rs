//! A look at two moving bodies that are well apart, of which the search needs to know their distance only roughly.

use convex_support::{Scalar, Vector};
use num_traits::Float;

use super::corners::CornerFace;
use super::instant::{Instant, NEAR};
use super::moving_pair::MovingPair;
use super::placed::Placed;
use crate::SignedDistanceOptions;
use crate::body::{Pair, PointPair, TracedSupport as _};
use crate::gjk::{self, Frame, Gjk, GjkOptions, gjk, rounding};
use crate::observer::Observer;
use crate::unit::is_moderate;

/// How wide a bracket on the distance of bodies that are well apart may stay, relative to it: where they are looked at
/// next hardly depends on it, and their gap is proved however wide it is. A narrower one takes more support points, a
/// wider one more looks.
const ROUGH: f64 = 0.2;

/// What was seen of two cores: how far apart the plane across a unit vector keeps them, what that may be wrong by, and
/// points of them that are nearly the closest, each relative to its body's origin.
struct SeenCores<V: Vector> {
    unit: V,
    lower: V::Scalar,
    error: V::Scalar,
    points: PointPair<V>,
}

impl<V: Vector> SeenCores<V> {
    /// The points whose difference is `v`, and the plane through the support point `w` across that.
    #[inline(always)]
    fn new(v: V, length: V::Scalar, w: V, points: PointPair<V>, error: V::Scalar) -> Self {
        Self { unit: v / length, lower: v.dot(w) / length, error, points }
    }
}

/// Where a search begins.
enum Begin<'f, V: Vector> {
    /// Along an axis.
    Along(V),
    /// At a face, with the support point across the vector to it and what that is made of.
    At(&'f CornerFace<V>, (V, PointPair<V>)),
}

/// Points in units of the scale, in the world's unit.
fn in_world<V: Vector>(points: PointPair<V>, scale: V::Scalar) -> PointPair<V> {
    PointPair { a: points.a * scale, b: points.b * scale }
}

impl<V: Vector> MovingPair<'_, V> {
    /// The pair at a time; `None` where the bodies are nearly in contact, or overlap and nobody can tell by how much.
    ///
    /// Where the corners that were closest at the last time are so still, one support point proves it. Otherwise GJK
    /// goes on from there. Where the bodies overlap by more than rounding, the best plane known tells about how much,
    /// which is all that the search needs.
    pub(super) fn roughly(
        &self,
        time: V::Scalar,
        placed: &Placed<'_, V>,
        axis: V,
        limit: V::Scalar,
    ) -> Option<Instant<V>> {
        let mut pair = Pair::new(placed);
        let size = pair.size(placed.offset);
        let face = if is_moderate(size) { self.closest.borrow().closest_face(placed) } else { None };
        match face {
            Some(face) => self.at_face(time, placed, &mut pair, &face, axis, limit),
            None => self.searched(time, placed, &mut pair, Begin::Along(axis), limit),
        }
    }

    /// The same by the face that was closest at the last time, or if it is no longer, by GJK.
    fn at_face(
        &self,
        time: V::Scalar,
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
        let seen = SeenCores::new(v, length, known.0 + placed.offset, face.closest_points(), error);
        let distance = seen.lower - radius;
        if is_well_off(distance) {
            let is_closest = signed - seen.lower <= distance.abs() * Scalar::from_f64(ROUGH);
            // A body may be thinner than cores would be in one another, and left behind.
            let mut is_between = || v.dot(pair.support(v).0 + placed.offset) > zero;
            if is_closest && (signed > zero || is_between()) || distance > limit + error {
                self.count(if signed > zero { 1 } else { 2 });
                return Some(self.instant(time, placed, &seen));
            }
        }
        let begin = if signed > radius { Begin::At(face, known) } else { Begin::Along(axis) };
        self.searched(time, placed, pair, begin, limit)
    }

    /// The same by GJK, which begins with a face and the support point across the vector to it, or along an axis.
    fn searched(
        &self,
        time: V::Scalar,
        placed: &Placed<'_, V>,
        pair: &mut Pair<'_, Placed<'_, V>>,
        begin: Begin<'_, V>,
        limit: V::Scalar,
    ) -> Option<Instant<V>> {
        let size = pair.size(placed.offset);
        let frame = Frame::new(pair, placed.offset, size);
        let Frame { scale, per_unit, radius, error, .. } = frame;
        let in_unit = |points: PointPair<V>| PointPair { a: points.a * per_unit, b: points.b * per_unit };
        let (mut state, known) = match begin {
            Begin::Along(axis) => (Gjk::new(axis), None),
            Begin::At(face, (point, witness)) => {
                let corners = face.corners().map(|(point, pair)| (point * per_unit, in_unit(pair)));
                let state = Gjk::at_face(corners, face.weights, face.v * per_unit);
                (state, Some((point * per_unit, in_unit(witness))))
            }
        };
        let options = GjkOptions {
            limit: limit * per_unit + radius,
            tolerance: Scalar::from_f64(ROUGH),
            ..GjkOptions::new(state.normal, SignedDistanceOptions::<V>::new().max_iterations)
        };
        let end = gjk(&mut state, pair, frame, options, known, &mut Observer::none());
        self.count(state.iterations);
        let (distance, near) = (state.lower - radius, error * Scalar::from_f64(NEAR));
        let unit = state.axis.unit()?;
        let lower = state.lower;
        let seen =
            |points| SeenCores { unit, lower: lower * scale, error: error * scale, points: in_world(points, scale) };
        // NaN is neither.
        if end == gjk::End::Separated && distance > near {
            state.ensure_measured();
            // Of curved bodies the corners would be others.
            if !pair.is_curved() {
                let corners = state.simplex.weighted().map(|(_, corner)| in_world(corner, scale));
                self.closest.borrow_mut().keep(corners, placed);
            }
            return Some(self.instant(time, placed, &seen(state.simplex.weighted_witness())));
        }
        if end == gjk::End::Overlap && distance < -near {
            self.count(1);
            let (_, points) = pair.support(-unit);
            return Some(self.instant(time, placed, &seen(points)));
        }
        None
    }

    /// What is known of a time by what was seen of the cores.
    #[inline(always)]
    fn instant(
        &self,
        time: V::Scalar,
        placed: &Placed<'_, V>,
        &SeenCores { unit, lower, error, points }: &SeenCores<V>,
    ) -> Instant<V> {
        let (radius_a, radius_b) = (self.a.core.radius, self.b.core.radius);
        let point_a = placed.place + placed.offset + points.a - unit * radius_a;
        let point = placed.place + points.b + unit * radius_b;
        let distance = lower - (radius_a + radius_b);
        Instant {
            time,
            normal: unit,
            gap: distance - error,
            distance,
            upper: Float::infinity(),
            error,
            closing: self.closing(time, unit, [point_a, point]),
            point,
            is_close: false,
        }
    }
}
