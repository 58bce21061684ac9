//! How the time of a first contact changes: bodies that move and turn.

use convex_support::numerics::elementary::sin_cos;
use convex_support::{AngularVelocity, Matrix, MotionGradient, Scalar, Vector};

use super::at_contact::at_contact;
use crate::{MotionHit, RigidMotion, Trajectory};

/// The derivatives of the time of first contact of two bodies that move and turn.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct MotionCastGradient<V: Vector> {
    /// By the pose of `a` at the start. Its motion stays what it is, the centre included.
    pub pose_a: MotionGradient<V>,
    /// By the pose of `b` at the start.
    pub pose_b: MotionGradient<V>,
    /// By the place of `a` at the time of contact. With it the time can be derived by any parameter of the motion: find
    /// how the parameter displaces the body at that time. [`RigidMotion::gradient`] does so for the parameters of a
    /// rigid motion.
    pub contact_a: MotionGradient<V>,
    /// By the place of `b` at the time of contact.
    pub contact_b: MotionGradient<V>,
    /// By the radius of either body, that is, as the body is grown all around, and by the target distance: never
    /// positive.
    pub radius: V::Scalar,
}

/// The derivatives of a number by the parameters of a rigid motion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RigidMotionGradient<V: Vector> {
    /// By the velocity.
    pub velocity: V,
    /// By the angular velocity.
    pub angular_velocity: V::AngularVelocity,
    /// By the centre.
    pub center: V,
}

impl<V: Vector> MotionHit<V> {
    /// The derivatives of the time of first contact, for the motions of the cast that it is the answer of. `None` where
    /// the bodies overlap at the start, or touch and do not approach one another.
    ///
    /// With `n` the normal at the time `t`, `p` the point of contact and `w` the velocity there of `a` as seen from
    /// `b`, a displacement `δ` of `a` at that time changes it by `−n·δ/(n·w)`. A displacement of the start pose is
    /// turned by the motion until then: the force on it is `Rᵀ(−n/(n·w))`, at the point of the body that will be in
    /// contact, where that is at the start.
    ///
    /// Where there is only one point of contact they are derivatives, and elsewhere one-sided derivatives;
    /// [`closest_features`](Self::closest_features) tells which.
    ///
    /// ```
    /// use convex_support::{Ball, Capsule, Posed, glam::DVec3};
    /// use gjk_raycast::{MotionCastOptions, RigidMotion, motion_cast};
    ///
    /// // A thin blade turns about z. It touches a ball of radius 1/2 at x = 1 where it comes within
    /// // 30° of x.
    /// let blade = Capsule::new(1.0, 0.0)?; // along y
    /// let ball = Posed::translated(Ball::new(0.5)?, DVec3::X)?;
    /// let turning = RigidMotion::rotation(DVec3::Z * 2.0, DVec3::ZERO);
    /// let options = MotionCastOptions::new().with_max_time(1.0);
    /// let cast = motion_cast(&blade, turning, &ball, RigidMotion::default(), options)?;
    /// let hit = cast.outcome.hit().ok_or("they meet")?;
    /// let gradient = hit.gradient(&turning, &RigidMotion::default()).ok_or("they approach")?;
    ///
    /// // Turned ahead by an angle at the start, it is there sooner by half as much time; and
    /// // t = (angle)/ω.
    /// assert!((gradient.pose_a.revolute(DVec3::ZERO, DVec3::Z) + 0.5).abs() < 1e-14);
    /// let by_motion = turning.gradient(hit.time, gradient.contact_a);
    /// assert!((by_motion.angular_velocity.z + hit.time / 2.0).abs() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn gradient<A, B>(&self, motion_a: &A, motion_b: &B) -> Option<MotionCastGradient<V>>
    where
        A: Trajectory<Vector = V> + ?Sized,
        B: Trajectory<Vector = V> + ?Sized,
    {
        let velocity = motion_a.velocity(self.time, self.point) - motion_b.velocity(self.time, self.point);
        let contact_a = at_contact(self.normal, velocity, self.point)?;
        let contact_b = contact_a.reversed();
        Some(MotionCastGradient {
            pose_a: at_start(motion_a, self.time, contact_a),
            pose_b: at_start(motion_b, self.time, contact_b),
            contact_a,
            contact_b,
            radius: -contact_a.translation.length(),
        })
    }
}

/// What a force at the given time is to the pose at the start. The motion takes `x₀` to `x = P + s + R·(x₀ − P)`, with
/// `P` the pivot and `s` its shift, so that `δx = R·δx₀`.
fn at_start<M: Trajectory + ?Sized>(
    motion: &M,
    time: <M::Vector as Vector>::Scalar,
    force: MotionGradient<M::Vector>,
) -> MotionGradient<M::Vector> {
    let displacement = motion.displacement(time);
    let back = |v| displacement.rotation().transpose_mul(v);
    let arm = force.point - displacement.pivot - displacement.shift;
    MotionGradient::force(back(force.translation), displacement.pivot + back(arm))
}

impl<V: Vector> RigidMotion<V> {
    /// The change per unit of time of a number with this derivative, as the body begins to move. If the motion is what
    /// a joint does per radian, it is the change per radian of the joint.
    #[must_use]
    pub fn rate_of(&self, gradient: MotionGradient<V>) -> V::Scalar {
        gradient.prismatic(self.velocity) + gradient.revolute(self.center, self.angular_velocity)
    }

    /// The derivatives of a number by the parameters of this motion, given `force`, its derivative by the pose that the
    /// body has at `time`; such as [`MotionCastGradient::contact_a`] and the time of the hit.
    ///
    /// With `x = c + t·v + y`, `y = R(tω)·(x₀ − c)`, the parameters displace a point by
    ///
    /// > δx = δc + t·δv − R·δc + (t·J(tω)·δω) × y,
    ///
    /// where `J` is the left Jacobian of the rotations, 1 in 2D; in 3D, with `θ = tω`, its transpose is
    ///
    /// > Jᵀ = 1 − (1 − cos|θ|)/|θ|²·θ× + (|θ| − sin|θ|)/|θ|³·(θ×)².
    pub fn gradient(&self, time: V::Scalar, force: MotionGradient<V>) -> RigidMotionGradient<V> {
        let moment = force.rotation_about(self.center + self.velocity * time);
        // δc − R·δc, by what the rotation adds.
        let turn = self.angular_velocity.turn(time);
        RigidMotionGradient {
            velocity: force.translation * time,
            angular_velocity: pulled_back::<V>(moment, self.angular_velocity, time).scaled(time),
            center: -turn.transpose_mul(force.translation),
        }
    }
}

/// `Jᵀ` times a moment.
fn pulled_back<V: Vector>(
    moment: V::AngularVelocity,
    velocity: V::AngularVelocity,
    time: V::Scalar,
) -> V::AngularVelocity {
    if V::DIM == 2 {
        return moment;
    }
    let theta = velocity.scaled(time);
    let cross = theta.cross_matrix();
    let angle = V::from_fn(|i| theta.coordinate(i)).norm();
    let m = V::from_fn(|i| moment.coordinate(i));
    let once = cross * m;
    let [first, second] = jacobian_coefficients(angle);
    let pulled = m - once * first + cross * once * second;
    V::AngularVelocity::from_coordinates(|i| pulled.get(i))
}

/// `(1 − cos x)/x² = ½·(sin(x/2)/(x/2))²` and `(x − sin x)/x³`, which is summed where the difference would cancel.
fn jacobian_coefficients<S: Scalar>(x: S) -> [S; 2] {
    let (half, one) = (S::from_f64(0.5), S::ONE);
    let sinc = if x > S::ZERO { sin_cos(x * half).0 / (x * half) } else { one };
    let first = half * sinc * sinc;
    if x > one {
        return [first, (x - sin_cos(x).0) / (x * x * x)];
    }
    // Σ (−x²)ᵏ/(2k + 3)!, of which the first term left out is 1/17!.
    let mut sum = S::ZERO;
    for k in (1..8).rev() {
        let factor = f64::from((2 * k + 2) * (2 * k + 3));
        sum = (one + sum) * (-(x * x) / S::from_f64(factor));
    }
    [first, (one + sum) / S::from_f64(6.0)]
}
