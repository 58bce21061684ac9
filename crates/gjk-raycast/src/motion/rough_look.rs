//! What is known of two moving bodies at one time, if they are well apart and a rough distance is enough.

use convex_support::{Scalar, Vector};

use super::instant::{Instant, Limits, NEAR_IN_MOTION};
use super::moving_pair::MovingPair;
use super::placed::Placed;
use crate::SignedDistanceOptions;
use crate::body::{PointPair, TracedSupport as _};
use crate::gjk::{self, Frame, Gjk, GjkOptions, gjk};
use crate::observer::Observer;
use crate::unit::is_moderate;

/// Points in another unit.
pub(super) fn times<V: Vector>(points: PointPair<V>, factor: V::Scalar) -> PointPair<V> {
    PointPair { a: points.a * factor, b: points.b * factor }
}

impl<V: Vector> MovingPair<'_, V> {
    /// The bodies at a time, by GJK; `None` if they are nearly in contact, or overlap by an unknown depth.
    ///
    /// The search begins with the face that was closest at the last time. Mostly it still is, and one support point
    /// ends the search. If the bodies overlap by more than rounding, the best plane known tells roughly how deep, which
    /// is enough for the search of the motion.
    pub(super) fn roughly(&self, placed: &Placed<'_, V>, axis: V, limits: Limits<V::Scalar>) -> Option<Instant<V>> {
        let pair = &mut placed.pair();
        let size = pair.size(placed.offset);
        let kept = if is_moderate(size) { self.closest.borrow().closest_face(placed) } else { None };
        // If the cores have passed through one another, the vector to the face points the other way.
        let face = kept.filter(|face| face.v.dot(axis) > Scalar::ZERO && face.v.length() > pair.radius());
        let frame = Frame::new(pair, placed.offset, size);
        let Frame { scale, per_unit, radius, error, .. } = frame;
        let in_unit = |(point, points): (V, PointPair<V>)| (point * per_unit, times(points, per_unit));
        let mut state = match &face {
            None => Gjk::new(axis),
            Some(face) => Gjk::at_face(face.corners().map(in_unit), face.weights, face.v * per_unit),
        };
        let options = GjkOptions {
            limit: limits.distance * per_unit + radius,
            tolerance: limits.rough,
            ..GjkOptions::new(state.normal, SignedDistanceOptions::<V>::new().max_iterations)
        };
        let end = gjk(&mut state, pair, frame, options, None, &mut Observer::none());
        self.count(state.iterations);
        let (distance, near) = (state.lower - radius, error * Scalar::from_f64(NEAR_IN_MOTION));
        let unit = state.axis.unit()?;
        let known = [state.lower * scale - pair.radius(), error * scale];
        // If the distance is NaN, neither holds.
        if end == gjk::End::Separated && distance > near {
            state.ensure_measured();
            // On a curved body other points will be the closest ones.
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
