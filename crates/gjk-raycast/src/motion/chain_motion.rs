//! The motion of what several joints carry, such as a link of a robot.

use convex_support::{BoundingSphere, Matrix, Scalar, Vector};
use num_traits::Float as _;

use super::chain_bounds::Bounds;
use super::rigid_motion::RigidMotion;
use super::trajectory::{Displacement, Trajectory, TurningPlane};
use crate::axial;

/// The motion of a body at the end of a chain of joints, each of which moves at a constant rate: a link of a robot
/// along a straight edge in joint space.
///
/// Each joint is given by the motion that it alone would give to the links beyond it, starting from where they are in
/// the world at time 0. For a revolute joint this is the [rotation](RigidMotion::rotation) at its rate about a point of
/// its axis, for a prismatic joint the [translation](RigidMotion::translation), and for a helical joint a screw.
/// Together they move the body by
///
/// > x(t) = J₁(t)∘J₂(t)∘…∘Jₙ(t) (x),
///
/// the first joint being the one nearest to the base (Brockett's product of exponentials, Murray, Li and Sastry, *A
/// Mathematical Introduction to Robotic Manipulation*, 1994, section 3.2). If the base moves too, its motion is one
/// more joint in front of the others. The joints are borrowed, so that the links of one arm can share them: link `k` is
/// carried by the first `k` joints.
///
/// ```
/// use convex_support::{Ball, Posed, Rounded, Segment, glam::DVec3};
/// use gjk_raycast::{ChainMotion, MotionCastOptions, RigidMotion, motion_cast};
///
/// // An arm of two links of length 1 lies along x. Within a unit of time its shoulder turns by 90°
/// // about z, and its elbow by 30°.
/// let (shoulder, elbow, hand) = (DVec3::ZERO, DVec3::X, 2.0 * DVec3::X);
/// let joints = [
///     RigidMotion::rotation(DVec3::Z * 90f64.to_radians(), shoulder),
///     RigidMotion::rotation(DVec3::Z * 30f64.to_radians(), elbow),
/// ];
/// let forearm = Rounded::new(Segment::new([elbow, hand])?, 0.05)?;
/// let obstacle = Posed::translated(Ball::new(0.1)?, DVec3::new(0.0, 1.5, 0.0))?;
/// let (motion, rest) = (ChainMotion::new(&joints), RigidMotion::default());
/// let options = MotionCastOptions::new().with_max_time(1.0);
/// let cast = motion_cast(&forearm, motion, &obstacle, rest, options)?;
/// assert!(cast.outcome.hit().is_some_and(|hit| 0.7 < hit.time && hit.time < 0.9));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChainMotion<'j, V: Vector> {
    joints: &'j [RigidMotion<V>],
}

impl<'j, V: Vector> ChainMotion<'j, V> {
    /// The motion by the given joints, from the base to the body.
    #[must_use]
    pub const fn new(joints: &'j [RigidMotion<V>]) -> Self {
        Self { joints }
    }

    /// Bounds for all points of a ball, by its radius, until `end`. A joint is as far from the next one's centre as at
    /// time 0, and what that may have moved until `end`.
    fn bounds(&self, ball: BoundingSphere<V>, end: V::Scalar) -> Bounds<V::Scalar> {
        let (mut bounds, mut near) = (Bounds::REST, ball.center);
        for joint in self.joints.iter().rev() {
            let (v, w) = (joint.velocity.norm(), axial::vector::<V>(joint.angular_velocity).norm());
            // A joint that does not turn has no centre.
            if w > V::Scalar::ZERO {
                bounds.lengthen((near - joint.center).norm());
                near = joint.center;
                bounds.turn(w, V::Scalar::ZERO);
            }
            bounds.slide(v, v * end);
        }
        bounds
    }
}

impl<V: Vector> Trajectory for ChainMotion<'_, V> {
    type Vector = V;

    fn displacement(&self, time: V::Scalar) -> Displacement<V> {
        let mut whole = Displacement::shifted(V::ZERO);
        let mut reach = V::Scalar::ZERO;
        for joint in self.joints.iter().rev() {
            let next = joint.displacement(time);
            if whole.turn_error == V::Scalar::ZERO {
                whole.pivot = next.pivot;
            }
            // x ↦ p + s + (1 + T)(x − p) comes to p + s + s' + T'(p + s − p') + (1 + T')(1 + T)(x − p).
            let arm = whole.pivot + whole.shift - next.pivot;
            let turned = next.turn * arm;
            let units = V::Scalar::EPSILON * V::Scalar::from_f64(4.0);
            reach += arm.norm() + next.shift.norm();
            whole.shift_error += next.shift_error + next.turn_error * arm.norm() + units * reach;
            whole.turn_error += next.turn_error + units;
            whole.shift += next.shift + turned;
            whole.turn = whole.turn + next.turn + next.turn * whole.turn;
        }
        whole
    }

    fn velocity(&self, time: V::Scalar, point: V) -> V {
        let mut velocity = V::ZERO;
        let mut rotation = <V::Matrix as Matrix>::IDENTITY;
        // The point as the joints from here on have moved it.
        let mut point = point;
        for joint in self.joints {
            let displacement = joint.displacement(time);
            velocity += rotation * joint.velocity(time, point);
            let local = point - displacement.pivot - displacement.shift;
            point = displacement.pivot + displacement.rotation().transpose_mul(local);
            rotation = rotation * displacement.rotation();
        }
        velocity
    }

    fn acceleration_along(
        &self,
        ball: BoundingSphere<V>,
        TurningPlane { from, to }: TurningPlane<V>,
        [start, end]: [V::Scalar; 2],
    ) -> V::Scalar {
        let bounds = self.bounds(ball, end);
        let rate = if from == to { V::Scalar::ZERO } else { (to - from).norm() / (end - start) };
        let longest = from.norm().max(to.norm());
        V::Scalar::from_f64(2.0) * rate * bounds.speed.of(ball.radius) + longest * bounds.acceleration.of(ball.radius)
    }
}
