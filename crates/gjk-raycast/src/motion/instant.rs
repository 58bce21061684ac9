//! Two moving bodies at one time.

use core::cell::Cell;

use convex_support::{BoundingSphere, Core, Hint, Rounding, Scalar, ScalarOf, SupportMap, Vector};
use num_traits::Float;

use super::moved::Moved;
use super::trajectory::{Displacement, Trajectory, TurningPlane};
use crate::body::{Body as _, Pair, PointPair};
use crate::gjk::{self, Frame, Gjk, GjkOptions, gjk, rounding};
use crate::simplex::MAX_POINTS;
use crate::unit::is_moderate;
use crate::{SignedDistanceOptions, SubAlgorithm, signed_distance};

/// A step may change the distance by what the closing speeds do not foretell, but for this part of what they have changed.
const KINK: f64 = 0.1;

/// Bodies that are apart, or overlap, by fewer errors than this are looked at closely.
pub(super) const NEAR: f64 = 64.0;

/// How wide a bracket on the distance of bodies that are well apart may stay, relative to it: where they are looked at next hardly
/// depends on it, and their gap is proved however wide it is.
const ROUGH: f64 = 1e-3;

/// A body and its motion.
pub(super) struct MovingBody<'s, S: SupportMap + ?Sized, M> {
    shape: &'s S,
    motion: M,
    /// What the shape is split into at time 0, with its radius grown by the target distance.
    pub(super) core: Core<S::Vector>,
    /// How well its points are known.
    rounding: Rounding<S::Vector>,
    /// What was found at the last time, which is mostly found again.
    hint: Cell<Hint>,
}

impl<'s, S: SupportMap + ?Sized, M: Trajectory<Vector = S::Vector>> MovingBody<'s, S, M> {
    pub(super) fn new(shape: &'s S, motion: M, margin: ScalarOf<S>) -> Self {
        let core = shape.core();
        Self {
            shape,
            motion,
            core: Core { radius: core.radius + margin, ..core },
            rounding: shape.rounding(),
            hint: Cell::new(Hint::new()),
        }
    }

    /// The velocity, at a time, of the body's point that is at `point` then.
    pub(super) fn velocity(&self, time: ScalarOf<S>, point: S::Vector) -> S::Vector {
        self.motion.velocity(time, point)
    }

    /// A ball around the core at time 0.
    fn ball(&self) -> BoundingSphere<S::Vector> {
        BoundingSphere { center: self.core.origin, radius: self.core.extent }
    }

    /// The shape as turned by a displacement, with its origin at the given point, which is wrong by `error` at most.
    fn moved(&self, displacement: &Displacement<S::Vector>, origin: S::Vector, error: ScalarOf<S>) -> Moved<'_, S> {
        let core = Core { origin, ..self.core };
        Moved::new(self.shape, core, displacement.rotation(), self.rounding, error).with_hint(&self.hint)
    }

    /// What rounding the displacement may add to the error of a point of the core.
    fn displacement_error(&self, displacement: &Displacement<S::Vector>) -> ScalarOf<S> {
        if displacement.turn_error == Scalar::ZERO {
            return displacement.shift_error;
        }
        let lever = length_bound(self.core.origin - displacement.pivot) + self.core.extent;
        displacement.turn_error * lever + displacement.shift_error + ScalarOf::<S>::EPSILON * self.core.extent
    }
}

/// A bound on the length of a vector that is no more than √3 too large.
pub(super) fn length_bound<V: Vector>(v: V) -> V::Scalar {
    v.abs().max_element() * V::Scalar::from_f64(1.7321)
}

/// Two bodies and their motions.
pub(super) struct MovingPair<'s, A: SupportMap + ?Sized, MA, B: SupportMap + ?Sized, MB> {
    pub(super) a: MovingBody<'s, A, MA>,
    pub(super) b: MovingBody<'s, B, MB>,
    /// The corners of the faces that were closest at the last look, each relative to its body's origin and turned back to time 0.
    closest: Cell<Closest<A::Vector>>,
    /// The support points computed of each shape.
    iterations: Cell<usize>,
}

/// Corners of a simplex, of which some are none.
#[derive(Clone, Copy)]
struct Closest<V> {
    corners: [Option<PointPair<V>>; MAX_POINTS],
}

/// Two bodies at one time; `b` has its origin at zero, which is `place` in the world.
struct Placed<'s, A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized> {
    a: Moved<'s, A>,
    b: Moved<'s, B>,
    offset: A::Vector,
    place: A::Vector,
}

/// What is known of the pair at one time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instant<V: Vector> {
    pub(super) time: V::Scalar,
    /// The unit vector from `b` to `a` along which they are nearest, or along which the way out of one another is the shortest.
    pub(super) normal: V,
    /// By how much a plane across the normal certainly separates the bodies; not positive where none may.
    pub(super) gap: V::Scalar,
    /// The signed distance as measured, which is certainly not more than `upper`.
    pub(super) distance: V::Scalar,
    pub(super) upper: V::Scalar,
    /// How far the measured distance is from the gap.
    pub(super) error: V::Scalar,
    /// How fast the closest points come nearer.
    pub(super) closing: V::Scalar,
    /// The closest point of `b`, or the one deepest in `a`, in the world.
    pub(super) point: V,
    /// Whether that is as well as it can be known, and not from afar.
    pub(super) is_close: bool,
}

impl<V: Vector> Instant<V> {
    /// Whether the bodies certainly have a point in common.
    pub(super) fn overlaps(&self) -> bool {
        self.upper < V::Scalar::ZERO
    }
}

/// What need not be known exactly of an instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits<S> {
    /// How far apart the bodies are, once they are certainly farther apart than this.
    pub(super) distance: S,
    /// How deep they are in one another, once they are certainly deeper than this.
    pub(super) depth: S,
}

impl<'s, A, MA, B, MB> MovingPair<'s, A, MA, B, MB>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
    MA: Trajectory<Vector = A::Vector>,
    MB: Trajectory<Vector = A::Vector>,
{
    pub(super) fn new(a: MovingBody<'s, A, MA>, b: MovingBody<'s, B, MB>) -> Self {
        Self { a, b, closest: Cell::new(Closest { corners: [None; MAX_POINTS] }), iterations: Cell::new(0) }
    }

    /// The support points computed of each shape so far.
    pub(super) fn iterations(&self) -> usize {
        self.iterations.get()
    }

    fn count(&self, iterations: usize) {
        self.iterations.set(self.iterations.get() + iterations);
    }

    /// The bodies where they are at a time.
    #[inline]
    fn placed(&self, time: ScalarOf<A>) -> Placed<'_, A, B> {
        let (da, db) = (self.a.motion.displacement(time), self.b.motion.displacement(time));
        // What lies between is of the order of the bodies, however far from the world's origin they are.
        let between = self.a.core.origin - self.b.core.origin;
        let (shifts, turned_b) = (da.shift - db.shift, db.turned(self.b.core.origin));
        let turns = da.turned(self.a.core.origin) - turned_b;
        let offset = between + shifts + turns;

        // A rounding for each difference and sum.
        let magnitude = length_bound(between) + length_bound(shifts) + length_bound(turns);
        let placing = ScalarOf::<A>::from_f64(1.5) * ScalarOf::<A>::EPSILON * magnitude
            + (self.a.displacement_error(&da) + self.b.displacement_error(&db));
        Placed {
            a: self.a.moved(&da, offset, placing),
            b: self.b.moved(&db, A::Vector::ZERO, Scalar::ZERO),
            offset,
            place: self.b.core.origin + db.shift + turned_b,
        }
    }

    /// How far apart the plane across a unit vector keeps the bodies at a time, and what that is wrong by at most.
    pub(super) fn level(&self, time: ScalarOf<A>, normal: A::Vector) -> (ScalarOf<A>, ScalarOf<A>) {
        let Placed { a, b, offset, .. } = &self.placed(time);
        let mut pair = Pair::new(a, b);
        let size = pair.size(*offset);
        // Of numbers out of range nothing is known.
        if !is_moderate(size) {
            return (ScalarOf::<A>::nan(), Float::infinity());
        }
        let (point, _) = pair.support(-normal);
        self.count(1);
        (normal.dot(point + *offset) - pair.radius(), rounding(size) + pair.error())
    }

    /// The pair at a time, looked at first along `axis`: roughly where the bodies are well apart.
    pub(super) fn at(&self, time: ScalarOf<A>, axis: A::Vector, limits: Limits<ScalarOf<A>>) -> Instant<A::Vector> {
        let placed = self.placed(time);
        let there = self.roughly(time, &placed, axis, limits.distance);
        there.unwrap_or_else(|| self.closely_placed(time, &placed, axis, limits))
    }

    /// The pair at a time as well as it can be known.
    pub(super) fn closely(
        &self,
        time: ScalarOf<A>,
        axis: A::Vector,
        limits: Limits<ScalarOf<A>>,
    ) -> Instant<A::Vector> {
        self.closely_placed(time, &self.placed(time), axis, limits)
    }

    fn closely_placed(
        &self,
        time: ScalarOf<A>,
        Placed { a, b, place, .. }: &Placed<'_, A, B>,
        axis: A::Vector,
        limits: Limits<ScalarOf<A>>,
    ) -> Instant<A::Vector> {
        let wanted =
            SignedDistanceOptions::new().with_axis(axis).with_limit(limits.distance).with_depth_limit(limits.depth);
        let answer = signed_distance(a, b, wanted);
        self.count(answer.iterations);
        let (point_a, point) = (answer.point_a + *place, answer.point_b + *place);
        let distance = answer.signed_distance;
        Instant {
            time,
            normal: answer.normal,
            gap: answer.lower,
            distance,
            upper: answer.upper,
            error: distance - answer.lower,
            closing: self.closing(time, answer.normal, [point_a, point]),
            point,
            is_close: true,
        }
    }

    /// The pair at a time by GJK alone, which begins with the simplex of the last time; `None` where the bodies are nearly in contact or
    /// overlap.
    ///
    /// Where they overlap by more than rounding, the best plane known tells about how much, which is all that the search needs.
    fn roughly(
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
        if let Some(points) = pair.closest_points(*offset, size) {
            if state.begin_at(points.a - points.b + frame.offset, points, &frame) {
                return None;
            }
        } else {
            let moved = |points: PointPair<A::Vector>| PointPair {
                a: a.turned(points.a) * per_unit,
                b: b.turned(points.b) * per_unit,
            };
            let corners = self.closest.get().corners.into_iter().flatten().map(moved);
            state.begin_with(corners.map(|points| (points.a - points.b + frame.offset, points)), &frame);
            if state.normal.dot(axis) < Scalar::ZERO {
                // They have passed through one another, and their plane is the other way round.
                state = Gjk::new(-state.normal);
            }
        }
        let options = GjkOptions {
            first: state.normal,
            limit: limit * per_unit + radius,
            // It is relative to the distance of the cores, which says nothing of that of round bodies.
            tolerance: if radius > Scalar::ZERO { Scalar::ZERO } else { Scalar::from_f64(ROUGH) },
            closest_points: true,
            max_iterations: SignedDistanceOptions::<A::Vector>::new().max_iterations,
            sub_algorithm: SubAlgorithm::Regions,
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
        let mut closest = Closest { corners: [None; MAX_POINTS] };
        for (corner, (_, points)) in closest.corners.iter_mut().zip(state.simplex.weighted()) {
            *corner = Some(PointPair { a: a.before(points.a * scale), b: b.before(points.b * scale) });
        }
        self.closest.set(closest);
    }

    /// How fast points of both bodies come nearer to one another along a normal.
    fn closing(&self, time: ScalarOf<A>, normal: A::Vector, [point_a, point_b]: [A::Vector; 2]) -> ScalarOf<A> {
        normal.dot(self.b.velocity(time, point_b) - self.a.velocity(time, point_a))
    }

    /// Whether the distance went from one time to another without a kink: the mean of the closing speeds tells what it changed by, but
    /// for a part of what they did.
    pub(super) fn is_smooth(&self, from: &Instant<A::Vector>, to: &Instant<A::Vector>) -> bool {
        let (half, duration) = (ScalarOf::<A>::from_f64(0.5), to.time - from.time);
        let foretold = (from.closing + to.closing) * half * duration;
        let sped_up = (to.closing - from.closing).abs() * duration;
        let off = (from.distance - to.distance - foretold).abs();
        off <= sped_up * ScalarOf::<A>::from_f64(KINK) + from.error + to.error
    }

    /// A bound on the size of both shapes together.
    pub(super) fn size(&self) -> ScalarOf<A> {
        self.a.core.extent + self.a.core.radius + self.b.core.extent + self.b.core.radius
    }

    /// The speed of the closest points against one another, where they are.
    pub(super) fn speed_at(&self, there: &Instant<A::Vector>) -> ScalarOf<A> {
        let Instant { time, point, .. } = *there;
        length_bound(self.a.velocity(time, point)) + length_bound(self.b.velocity(time, point))
    }

    /// An upper bound of the second derivative, throughout an interval, of the distance of any point of `a` from any point of `b`
    /// along a normal that changes at a constant rate.
    pub(super) fn acceleration_along(&self, plane: TurningPlane<A::Vector>, interval: [ScalarOf<A>; 2]) -> ScalarOf<A> {
        let opposite = TurningPlane { from: -plane.from, to: -plane.to };
        self.a.motion.acceleration_along(self.a.ball(), plane, interval)
            + self.b.motion.acceleration_along(self.b.ball(), opposite, interval)
    }

    /// Whether balls around the bodies, which move at constant velocities, stay apart throughout an interval, which may be infinite;
    /// then the direction from `b` to `a` where they are closest.
    pub(super) fn stays_far_apart(&self, interval: [ScalarOf<A>; 2]) -> Option<A::Vector> {
        let a = self.a.motion.moving_ball(self.a.ball(), interval);
        let b = self.b.motion.moving_ball(self.b.ball(), interval);
        let (start, velocity) = (a.start - b.start, a.velocity - b.velocity);
        let duration = interval[1] - interval[0];
        // The time at which start + t·velocity is shortest.
        let (slope, squared) = (start.dot(velocity), velocity.length_squared());
        // Of velocities whose squares are out of range, that time is not known.
        if !(is_moderate(squared) || velocity == A::Vector::ZERO) {
            return None;
        }
        let nearest = if slope < Scalar::ZERO { (-slope / squared).min(duration) } else { Scalar::ZERO };
        let between = start + velocity * nearest;
        let reach = a.radius + b.radius + self.a.core.radius + self.b.core.radius;
        let moved = (length_bound(a.velocity) + length_bound(b.velocity)) * nearest;
        let margin =
            (reach + length_bound(a.start) + length_bound(b.start) + moved) * Scalar::from_f64(32.0) * Scalar::EPSILON;
        // NaN is not apart.
        if between.norm() > reach + margin { between.unit() } else { None }
    }
}
