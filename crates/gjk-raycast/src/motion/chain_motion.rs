//! The motion of a body that several joints carry, such as a link of a robot, and bounds on the speed and unevenness
//! of its points, for any joint values.

use convex_support::numerics::angular;
use convex_support::{BoundingSphere, Matrix, Scalar, Vector};

use super::trajectory::{Displacement, RigidMotion, Trajectory, TurningPlane};
use crate::JointBounds;

/// The motion of a body at the end of a chain of joints, each of which moves at a constant rate: a link of a robot
/// along a straight edge in joint space.
///
/// Each joint is given by the motion that it alone would give to the links beyond it, from their places in the world
/// at time 0. For a revolute joint this is the [rotation](RigidMotion::rotation) at its rate about a point of its
/// axis, for a prismatic joint the [translation](RigidMotion::translation), and for a helical joint a screw. Together
/// they move the body by
///
/// > x(t) = J₁(t)∘J₂(t)∘…∘Jₙ(t) (x),
///
/// the first joint being the one nearest to the base (Brockett's product of exponentials, Murray, Li and Sastry, *A
/// Mathematical Introduction to Robotic Manipulation*, 1994, section 3.2). If the base moves too, its motion is one
/// more joint in front of the others. The joints are borrowed, so that the links of one arm can share them: the first
/// `k` joints carry link `k`.
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

    /// Bounds until the time `end` for points of a ball, as functions of their distance from its centre. The distance
    /// from a joint to the centre of the next one is the distance at time 0, plus what a joint may have slid until
    /// `end`.
    fn bounds(&self, ball: BoundingSphere<V>, end: V::Scalar) -> Bounds<V::Scalar> {
        let (mut bounds, mut near) = (Bounds::REST, ball.center);
        for joint in self.joints.iter().rev() {
            let (v, w) = (joint.velocity.norm(), angular::vector::<V>(joint.angular_velocity).norm());
            // For a joint that does not turn the centre means nothing.
            if w > V::Scalar::ZERO {
                bounds.lengthen((near - joint.center).norm());
                near = joint.center;
                bounds.turn(JointBounds::constant(w), V::Scalar::ZERO);
            }
            bounds.slide(JointBounds { value: v * end, ..JointBounds::constant(v) });
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
            // The next joint takes p + s + (1 + T)(x − p) to p + s + s' + T'(p + s − p') + (1 + T')(1 + T)(x − p). The
            // difference of the pivots is taken first, so that no more digits are lost far from the world's origin than
            // near it.
            let arm = whole.pivot - next.pivot + whole.shift;
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
        plane: TurningPlane<V>,
        interval: [V::Scalar; 2],
    ) -> V::Scalar {
        self.bounds(ball, interval[1]).along(plane, interval, ball.radius)
    }
}

/// A bound for points at a distance `r` from the origin of the last joint that moves: `at_origin + per_length·r`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Linear<S> {
    at_origin: S,
    per_length: S,
}

/// Bounds on the first three derivatives, by time, of the position of a point, where all joint values change at
/// constant rates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds<S> {
    pub(crate) speed: Linear<S>,
    pub(crate) acceleration: Linear<S>,
    pub(crate) jerk: Linear<S>,
    /// The sum of the rates of the joints that turn: no angular velocity is larger.
    pub(crate) spin: S,
    /// The sums of the bounds on the acceleration and the jerk of the values of the joints that turn.
    pub(crate) spin_up: [S; 2],
    /// How far a point may be from the origin of the joint that was added last.
    reach: Linear<S>,
}

impl<S: Scalar> Linear<S> {
    const ZERO: Self = Self { at_origin: S::ZERO, per_length: S::ZERO };

    pub(crate) fn of(self, r: S) -> S {
        self.at_origin + self.per_length * r
    }

    fn plus(self, other: Self, factor: S) -> Self {
        Self {
            at_origin: self.at_origin + other.at_origin * factor,
            per_length: self.per_length + other.per_length * factor,
        }
    }
}

/// Joints are added from the last one to the first. Let `y` be a point as the joints so far have moved it, with the
/// bounds `s`, `a` and `j` on its speed, acceleration and jerk. A joint that turns by `q(t)` takes it to `R(q)·y`. With
/// `A·y = axis × y` the derivatives of `R` are
///
/// > R′ = q′·A·R,   R″ = (q″·A + q′²·A²)·R,   R‴ = (q‴·A + 3q′·q″·A² + q′³·A³)·R.
///
/// `A` makes nothing longer. So if `w`, `α` and `β` bound `|q′|`, `|q″|` and `|q‴|`, these take `y` to vectors no
/// longer than `w₁·l`, `w₂·l` and `w₃·l`, where `l` is the distance of `y` from the axis, and
///
/// > w₁ = w,   w₂ = w² + α,   w₃ = w³ + 3w·α + β.
///
/// The derivatives of the product `R·y` are then bounded by
///
/// > s′ = w₁·l + s,   a′ = w₂·l + 2w₁·s + a,   j′ = w₃·l + 3w₂·s + 3w₁·a + j.
///
/// A joint that slides adds `w`, `α` and `β` to `s`, `a` and `j`.
impl<S: Scalar> Bounds<S> {
    /// The bounds for points that no joint moves.
    pub(crate) const REST: Self = Self {
        speed: Linear::ZERO,
        acceleration: Linear::ZERO,
        jerk: Linear::ZERO,
        spin: S::ZERO,
        spin_up: [S::ZERO; 2],
        reach: Linear { per_length: S::ONE, ..Linear::ZERO },
    };

    /// An upper bound of `2·r·ẋ + n·ẍ` for points within this distance, at any time, as of
    /// [`Trajectory::acceleration_along`].
    pub(crate) fn along<V: Vector<Scalar = S>>(&self, plane: TurningPlane<V>, [start, end]: [S; 2], r: S) -> S {
        let TurningPlane { from, to } = plane;
        let rate = if from == to { S::ZERO } else { (to - from).norm() / (end - start) };
        S::from_f64(2.0) * rate * self.speed.of(r) + from.norm().max(to.norm()) * self.acceleration.of(r)
    }

    /// Adds the distance from the origin of the next joint to the origin from which distances were measured so far.
    pub(crate) fn lengthen(&mut self, arm: S) {
        self.reach.at_origin += arm;
    }

    /// Adds a joint that turns, and from whose axis the joint that was added before is `across` away.
    pub(crate) fn turn(&mut self, JointBounds { rate: w, acceleration, jerk, .. }: JointBounds<S>, across: S) {
        let (two, three) = (S::from_f64(2.0), S::from_f64(3.0));
        let lever = Linear { at_origin: self.reach.at_origin + across, ..self.reach };
        let (second, third) = (w * w + acceleration, w * w * w + (three * w * acceleration + jerk));
        let by_speed = three * w * w + three * acceleration;
        self.jerk = self.jerk.plus(self.acceleration, three * w).plus(self.speed, by_speed).plus(lever, third);
        self.acceleration = self.acceleration.plus(self.speed, two * w).plus(lever, second);
        self.speed = self.speed.plus(lever, w);
        self.spin += w;
        self.spin_up = [self.spin_up[0] + acceleration, self.spin_up[1] + jerk];
    }

    /// Adds a joint that slides.
    pub(crate) fn slide(&mut self, JointBounds { value, rate, acceleration, jerk }: JointBounds<S>) {
        self.speed.at_origin += rate;
        self.acceleration.at_origin += acceleration;
        self.jerk.at_origin += jerk;
        self.lengthen(value);
    }
}

#[cfg(test)]
mod tests {
    use convex_support::glam::{DVec2, Vec2};

    use super::{Bounds, ChainMotion, JointBounds};
    use crate::{RigidMotion, Trajectory as _};

    /// The way from joint to joint is short, however far away both are. If the pivot of one were added to how far it
    /// has moved, and that of the next subtracted, the sum would have lost digits of the place, of which no error
    /// tells.
    #[test]
    fn joints_far_from_the_origin_lose_no_more_than_is_said() {
        let (centers, rates) = ([(0.0, 0.0), (1.0, 0.25), (1.5, 1.0)], [0.75, 1.25, -0.5]);
        let at = |i: usize, x: f64| DVec2::new(x + centers[i].0, centers[i].1);
        let exact: [_; 3] = core::array::from_fn(|i| RigidMotion::rotation(rates[i], at(i, 0.0)));
        let far: [_; 3] = core::array::from_fn(|i| RigidMotion::rotation(rates[i] as f32, at(i, 4096.0).as_vec2()));
        let (exact, far) = (ChainMotion::new(&exact).displacement(1.0), ChainMotion::new(&far).displacement(1.0));
        assert_eq!(far.pivot, Vec2::new(4096.0, 0.0) + exact.pivot.as_vec2());
        let off = (far.shift.as_dvec2() - exact.shift).length();
        assert!(off <= f64::from(far.shift_error), "{off} {}", far.shift_error);
        assert!(far.shift_error < 1e-5, "{}", far.shift_error);
    }

    /// A point at the distance `r` from an axis that it turns about at the rate `w` is as fast as `w·r`, and its
    /// acceleration and jerk are `w²·r` and `w³·r`; a joint that slides before adds its rate.
    #[test]
    fn bounds_of_one_turning_joint_are_those_of_a_circle() {
        let mut bounds = Bounds::<f64>::REST;
        bounds.turn(JointBounds::constant(3.0), 0.0);
        assert_eq!([bounds.speed.of(2.0), bounds.acceleration.of(2.0), bounds.jerk.of(2.0)], [6.0, 18.0, 54.0]);
        assert_eq!(bounds.spin, 3.0);
        bounds.slide(JointBounds::constant(0.5));
        assert_eq!([bounds.speed.of(2.0), bounds.acceleration.of(2.0)], [6.5, 18.0]);
    }
}
