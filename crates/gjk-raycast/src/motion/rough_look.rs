//! A look at two moving bodies by GJK alone, which is all that the search needs of bodies that are well apart.

use convex_support::{Scalar, ScalarOf, SupportMap, Vector};
use num_traits::Float;

use super::instant::{Instant, NEAR};
use super::moved::Moved;
use super::moving_pair::MovingPair;
use super::placed::Placed;
use super::trajectory::Trajectory;
use crate::SignedDistanceOptions;
use crate::body::{Pair, PointPair, TracedSupport as _};
use crate::gjk::{self, Frame, Gjk, GjkOptions, gjk};
use crate::simplex::MAX_POINTS;

/// How wide a bracket on the distance of bodies that are well apart may stay, relative to it: where they are looked at next hardly
/// depends on it, and their gap is proved however wide it is. A narrower one takes more support points, a wider one more looks.
const ROUGH: f64 = 0.2;

/// Corners of a simplex, of which some are none, each relative to its body's origin and turned back to time 0.
#[derive(Clone, Copy)]
pub(super) struct Corners<V>([Option<PointPair<V>>; MAX_POINTS]);

impl<V> Corners<V> {
    /// No corner.
    pub(super) const NONE: Self = Self([const { None }; MAX_POINTS]);
}

impl<A, MA, B, MB> MovingPair<'_, A, MA, B, MB>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
    MA: Trajectory<Vector = A::Vector>,
    MB: Trajectory<Vector = A::Vector>,
{
    /// The pair at a time by GJK alone, which begins with the simplex of the last time; `None` where the bodies are nearly in contact or
    /// overlap.
    ///
    /// Where they overlap by more than rounding, the best plane known tells about how much, which is all that the search needs.
    pub(super) fn roughly(
        &self,
        time: ScalarOf<A>,
        Placed { a, b, offset, place }: &Placed<'_, A, B>,
        axis: A::Vector,
        limit: ScalarOf<A>,
    ) -> Option<Instant<A::Vector>> {
        let mut pair = Pair::new(a, b);
        let size = pair.size(*offset);
        let frame = Frame::new(&mut pair, *offset, size);
        let Frame { scale, per_unit, radius, error, .. } = frame;
        let mut state = Gjk::new(axis);
        match state.begin_at_closest(&pair, &frame, size) {
            Some(true) => return None,
            Some(false) => {}
            None => {
                let moved = |points: PointPair<A::Vector>| PointPair {
                    a: a.turned(points.a) * per_unit,
                    b: b.turned(points.b) * per_unit,
                };
                let corners = self.closest.get().0.into_iter().flatten().map(moved);
                state.begin_with(corners.map(|points| (points.a - points.b + frame.offset, points)), &frame);
                if state.normal.dot(axis) < Scalar::ZERO {
                    // They have passed through one another, and their plane is the other way round.
                    state = Gjk::new(-state.normal);
                }
            }
        }
        let options = GjkOptions {
            limit: limit * per_unit + radius,
            tolerance: Scalar::from_f64(ROUGH),
            ..GjkOptions::new(state.normal, SignedDistanceOptions::<A::Vector>::new().max_iterations)
        };
        let end = gjk(&mut state, &mut pair, frame, options, None, |_| {});
        self.count(state.iterations);
        let (distance, near) = (state.lower - radius, error * Scalar::from_f64(NEAR));
        // NaN is neither.
        let is_apart = end == gjk::End::Separated && distance > near;
        let seem_to_overlap = end == gjk::End::Overlap && distance < -near;
        let normal = state.axis.unit().filter(|_| is_apart || seem_to_overlap)?;
        let points = if is_apart {
            state.ensure_measured();
            state.simplex.weighted_witness()
        } else {
            self.count(1);
            pair.support(-normal).1
        };
        let point_a = *place + *offset + points.a * scale - normal * self.a.core.radius;
        let point = *place + points.b * scale + normal * self.b.core.radius;
        // Of curved bodies the corners would be others.
        if is_apart && !pair.is_curved() {
            self.keep_corners(&state, a, b, scale);
        }
        let (distance, error) = (distance * scale, error * scale);
        Some(Instant {
            time,
            normal,
            gap: distance - error,
            distance,
            upper: Float::infinity(),
            error,
            closing: self.closing(time, normal, [point_a, point]),
            point,
            is_close: false,
        })
    }

    /// Keeps the corners of a simplex for the next look.
    fn keep_corners(
        &self,
        state: &Gjk<A::Vector, PointPair<A::Vector>>,
        a: &Moved<'_, A>,
        b: &Moved<'_, B>,
        scale: ScalarOf<A>,
    ) {
        let mut closest = Corners::NONE;
        for (corner, (_, points)) in closest.0.iter_mut().zip(state.simplex.weighted()) {
            *corner = Some(PointPair { a: a.before(points.a * scale), b: b.before(points.b * scale) });
        }
        self.closest.set(closest);
    }
}
