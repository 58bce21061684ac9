//! The parts of a linkage, and the motion at one time of a frame that some joints carry.

use convex_support::numerics::angular;
use convex_support::numerics::elementary::sin_cos;
use convex_support::{Matrix as _, Scalar, SupportMap, Vector};
use num_traits::Float as _;

use super::frame::{LinkFrame, epsilons};
use super::joint_trajectory::JointState;
use crate::Pose;

/// A joint of a [`Linkage`](crate::Linkage): its frame in that of its parent, and its motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint<V: Vector> {
    /// The index of the joint that carries it, which has to be lower; `None` for the world.
    pub parent: Option<usize>,
    /// Its frame in its parent's, at the value 0.
    pub pose: Pose<V>,
    /// How it moves from there.
    pub kind: JointKind<V>,
}

/// How a joint moves the bodies that it carries, in its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointKind<V: Vector> {
    /// Not at all: it has no value.
    Fixed,
    /// It turns by its value, in radians, after the right-hand rule, about an axis through the origin. Only the
    /// direction of the axis counts; in 2D the axis is a number, and only its sign counts.
    Revolute(V::AngularVelocity),
    /// It slides along an axis by its value. Only the direction of the axis counts.
    Prismatic(V),
}

/// A link of a [`Linkage`](crate::Linkage): bodies that one joint carries.
#[derive(Clone, Debug, PartialEq)]
pub struct Link<S: SupportMap> {
    /// The index of the joint; `None` for the world.
    pub joint: Option<usize>,
    /// The bodies, in the frame of the joint. There may be none.
    pub bodies: alloc::vec::Vec<S>,
}

/// A bound on the error of a rotation about an axis as an operator, in ε, apart from the error of its angle. It is the
/// sum of 3 for the unit axis, which is wrong by 1.5 and occurs twice; 3 for the term of the sine; 12 for the term of
/// `1 − cos`, which is no more than 2; 3 for the sine and the cosine themselves; 5 for the sum of the terms; and 4.5
/// for the product with the rotation before it.
const OF_TURN: f64 = 31.0;

/// A moving joint as one stage of a chain: its fixed frame, as the moving joint before it sees it, and then its own
/// motion, `x ↦ fixed·motion(value)·x`.
#[derive(Clone, Debug)]
pub(super) struct JointStage<V: Vector> {
    /// Its frame in that of the moving joint before it, at the value 0.
    pub(super) fixed: LinkFrame<V>,
    /// How far its origin is from that of the joint before it.
    pub(super) arm: V::Scalar,
    /// The distance of its origin from the axis of the joint before it.
    pub(super) off_axis: V::Scalar,
    /// The unit vector, in its own frame, about which it turns or along which it slides.
    pub(super) axis: V,
    /// For a joint that turns, the matrices `F·A` and `F·A²`, where `F` is the fixed rotation and `A·x = axis × x`.
    /// Together the two rotate by `F·(1 + sin·A + (1 − cos)·A²)` (Rodrigues).
    turn: Option<[V::Matrix; 2]>,
    /// The place of its value among the joint values.
    pub(super) column: usize,
}

/// A moving frame at one time, with the first and second derivatives of its pose. The frame carries a bound on its
/// error, and the derivatives do not.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovingFrame<V: Vector> {
    pub(super) frame: LinkFrame<V>,
    /// The angular velocity, as [`axial`] writes it, and its derivative.
    pub(super) spin: V,
    pub(super) spin_rate: V,
    /// The velocity and the acceleration of the frame's origin.
    velocity: V,
    acceleration: V,
}

impl<V: Vector> JointStage<V> {
    /// The stage of a joint at `fixed`; `None` for a joint that does not move, or has no axis.
    pub(super) fn new(fixed: LinkFrame<V>, kind: JointKind<V>, column: usize) -> Option<Self> {
        match kind {
            JointKind::Fixed => None,
            JointKind::Revolute(axis) => Some(Self::about(fixed, angular::vector::<V>(axis).unit()?, true, column)),
            JointKind::Prismatic(axis) => Some(Self::about(fixed, axis.unit()?, false, column)),
        }
    }

    fn about(fixed: LinkFrame<V>, axis: V, turns: bool, column: usize) -> Self {
        let product = angular::matrix(axis);
        let sine = fixed.rotation * product;
        let turn = turns.then(|| [sine, sine * product]);
        Self { arm: fixed.translation.norm(), off_axis: V::Scalar::ZERO, fixed, axis, turn, column }
    }

    /// This stage with another fixed frame. With the sign −1 its motion is the inverse one.
    pub(super) fn from(&self, fixed: LinkFrame<V>, sign: V::Scalar) -> Self {
        Self::about(fixed, self.axis * sign, self.turns(), self.column)
    }

    pub(super) fn turns(&self) -> bool {
        self.turn.is_some()
    }

    /// Its axis and its origin in the world, if its moved frame is there.
    pub(super) fn placed(&self, frame: &LinkFrame<V>) -> [V; 2] {
        let axis = if self.turns() { angular::turned(&frame.rotation, self.axis) } else { frame.rotation * self.axis };
        [axis, frame.translation]
    }

    /// How much the height of a point along `n` grows per unit of the joint value, given the axis and the origin in the
    /// world.
    pub(super) fn rise(&self, [axis, origin]: [V; 2], n: V, point: V) -> V::Scalar {
        n.dot(if self.turns() { angular::turning(axis, point - origin) } else { axis })
    }
}

impl<V: Vector> MovingFrame<V> {
    /// The world, at rest.
    pub(super) const WORLD: Self =
        Self { frame: LinkFrame::WORLD, spin: V::ZERO, spin_rate: V::ZERO, velocity: V::ZERO, acceleration: V::ZERO };

    /// The velocity of the point of the frame that is at `point`.
    #[inline]
    pub(super) fn velocity_at(&self, point: V) -> V {
        self.velocity + angular::turning(self.spin, point - self.frame.translation)
    }

    /// The acceleration of that point.
    #[inline]
    pub(super) fn acceleration_at(&self, point: V) -> V {
        let arm = point - self.frame.translation;
        let turning = angular::turning(self.spin, angular::turning(self.spin, arm));
        self.acceleration + angular::turning(self.spin_rate, arm) + turning
    }

    /// The frame that a stage at this value leads to from this one.
    ///
    /// Its origin is a point of this frame, or slides along it. Its angular velocity is `ω + w`, where `w` is the
    /// joint's own. Since this frame turns `w`, the derivative of the sum is `ω′ + ω × w`, plus the acceleration of the
    /// joint about its axis. If the joint slides with the velocity `d`, its origin has the acceleration of a point of
    /// this frame plus `2ω × d` (Coriolis), plus that of the joint along its axis.
    #[inline]
    pub(super) fn beyond(&self, stage: &JointStage<V>, state: JointState<V::Scalar>) -> Self {
        let JointState { value, rate, acceleration, error } = state;
        let &JointStage { ref fixed, arm, axis, ref turn, .. } = stage;
        if let Some([sine, versine]) = turn {
            let (sin, cos) = sin_cos(value);
            let rest = V::Scalar::ONE - cos;
            let turned = |j| fixed.rotation.col(j) + sine.col(j) * sin + versine.col(j) * rest;
            let rotation = self.frame.rotation * V::Matrix::from_cols_fn(turned);
            let moved = self.frame.moved(fixed.translation, arm, fixed.shift_error);
            let turn_error = moved.turn_error + fixed.turn_error + error + epsilons(OF_TURN);
            let about = angular::turned(&rotation, axis);
            let spin = about * rate;
            return Self {
                velocity: self.velocity_at(moved.translation),
                acceleration: self.acceleration_at(moved.translation),
                spin: self.spin + spin,
                spin_rate: self.spin_rate + angular::product(self.spin, spin) + about * acceleration,
                frame: LinkFrame { rotation, turn_error, ..moved },
            };
        }
        let (along, length) = (fixed.rotation * axis, value.abs());
        // The axis is wrong by 1.5ε before it is turned, and the product and the sum are rounded.
        let lost = (fixed.turn_error + epsilons(6.0)) * (length + arm);
        let moved = self.frame.moved(fixed.translation + along * value, arm + length, fixed.shift_error + error + lost);
        let turn_error = moved.turn_error + fixed.turn_error + epsilons(4.5);
        let direction = self.frame.rotation * along;
        let slide = direction * rate;
        let coriolis = angular::turning(self.spin, slide);
        Self {
            velocity: self.velocity_at(moved.translation) + slide,
            acceleration: self.acceleration_at(moved.translation) + coriolis + coriolis + direction * acceleration,
            frame: LinkFrame { rotation: self.frame.rotation * fixed.rotation, turn_error, ..moved },
            ..*self
        }
    }
}
