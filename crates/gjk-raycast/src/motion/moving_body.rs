//! A body and its motion.

use core::cell::Cell;

use convex_support::{AngularVelocity, BoundingSphere, Core, Hint, Rounding, Scalar, ScalarOf, SupportMap, Vector};

use super::moved::Moved;
use super::rigid_motion::{RigidMotion, SpinOf};
use super::trajectory::{Displacement, Trajectory, TurningPlane};

/// A rigid motion of a body, with its spin and the reach of the body's core.
struct Rigid<V: Vector> {
    motion: RigidMotion<V>,
    spin: SpinOf<V>,
    reach: V::Scalar,
}

/// A body and its motion.
pub(super) struct MovingBody<'s, S: SupportMap + ?Sized, M> {
    shape: &'s S,
    pub(super) motion: M,
    /// The motion once more, if it is a rigid one, with what of it does not depend on time.
    rigid: Option<Rigid<S::Vector>>,
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
        let ball = BoundingSphere { center: core.origin, radius: core.extent };
        let rigid = motion.as_rigid_motion().map(|motion| Rigid {
            motion,
            spin: motion.angular_velocity.spin(),
            reach: motion.reach(ball),
        });
        Self {
            shape,
            motion,
            rigid,
            core: Core { radius: core.radius + margin, ..core },
            rounding: shape.rounding(),
            hint: Cell::new(Hint::new()),
        }
    }

    /// Where the body is at a time, as of [`Trajectory::displacement`].
    #[inline(always)]
    pub(super) fn displacement(&self, time: ScalarOf<S>) -> Displacement<S::Vector> {
        match &self.rigid {
            Some(Rigid { motion, spin, .. }) => motion.displacement_by(spin, time),
            None => self.motion.displacement(time),
        }
    }

    /// A bound on the acceleration of points of the core, as of [`Trajectory::acceleration_along`].
    pub(super) fn acceleration_along(&self, plane: TurningPlane<S::Vector>, interval: [ScalarOf<S>; 2]) -> ScalarOf<S> {
        match &self.rigid {
            Some(Rigid { motion, reach, .. }) => motion.acceleration_within(*reach, plane, interval),
            None => self.motion.acceleration_along(self.ball(), plane, interval),
        }
    }

    /// The velocity, at a time, of the body's point that is at `point` then.
    pub(super) fn velocity(&self, time: ScalarOf<S>, point: S::Vector) -> S::Vector {
        self.motion.velocity(time, point)
    }

    /// A ball around the core at time 0.
    pub(super) fn ball(&self) -> BoundingSphere<S::Vector> {
        BoundingSphere { center: self.core.origin, radius: self.core.extent }
    }

    /// The shape as turned by a displacement, with its origin at the given point, which is wrong by `error` at most.
    #[inline(always)]
    pub(super) fn moved(
        &self,
        displacement: &Displacement<S::Vector>,
        origin: S::Vector,
        error: ScalarOf<S>,
    ) -> Moved<'_, S> {
        let core = Core { origin, ..self.core };
        Moved::new(self.shape, core, displacement.rotation(), self.rounding, error).with_hint(&self.hint)
    }

    /// What rounding the displacement may add to the error of a point of the core.
    pub(super) fn displacement_error(&self, displacement: &Displacement<S::Vector>) -> ScalarOf<S> {
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
