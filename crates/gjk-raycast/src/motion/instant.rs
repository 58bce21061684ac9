//! Two moving bodies at one time.

use core::cell::Cell;

use convex_support::{BoundingSphere, Core, Hint, Rounding, Scalar, ScalarOf, SupportMap, Vector};
use num_traits::Float as _;

use super::moved::Moved;
use super::trajectory::{Displacement, Trajectory, TurningPlane};
use crate::unit::is_moderate;
use crate::{SignedDistanceOptions, signed_distance};

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
    /// The support points of each shape that it took.
    pub(super) iterations: usize,
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

impl<A, MA, B, MB> MovingPair<'_, A, MA, B, MB>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
    MA: Trajectory<Vector = A::Vector>,
    MB: Trajectory<Vector = A::Vector>,
{
    /// The pair at a time, looked at first along `axis`.
    pub(super) fn at(&self, time: ScalarOf<A>, axis: A::Vector, limits: Limits<ScalarOf<A>>) -> Instant<A::Vector> {
        let (da, db) = (self.a.motion.displacement(time), self.b.motion.displacement(time));
        // What lies between is of the order of the bodies, however far from the world's origin they are.
        let between = self.a.core.origin - self.b.core.origin;
        let (shifts, turns) = (da.shift - db.shift, da.turned(self.a.core.origin) - db.turned(self.b.core.origin));
        let offset = between + shifts + turns;

        // A rounding for each difference and sum.
        let magnitude = length_bound(between) + length_bound(shifts) + length_bound(turns);
        let placing = ScalarOf::<A>::from_f64(1.5) * ScalarOf::<A>::EPSILON * magnitude
            + (self.a.displacement_error(&da) + self.b.displacement_error(&db));
        let (a, b) = (self.a.moved(&da, offset, placing), self.b.moved(&db, A::Vector::ZERO, Scalar::ZERO));

        let wanted =
            SignedDistanceOptions::new().with_axis(axis).with_limit(limits.distance).with_depth_limit(limits.depth);
        let answer = signed_distance(&a, &b, wanted);
        let place = db.of(self.b.core.origin);
        let (point_a, point) = (answer.point_a + place, answer.point_b + place);
        let closing = answer.normal.dot(self.b.velocity(time, point) - self.a.velocity(time, point_a));
        let distance = answer.signed_distance;
        Instant {
            time,
            normal: answer.normal,
            gap: answer.lower,
            distance,
            upper: answer.upper,
            error: distance - answer.lower,
            closing,
            point,
            iterations: answer.iterations,
        }
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
