//! How a frame at the end of some joints moves, at one moment.

use convex_support::Vector;
use convex_support::numerics::elementary::sin_cos;

use super::frame::{LinkFrame, epsilons};
use super::stage::{JointStage, StageMotion};
use crate::axial;

/// What a rotation about an axis is wrong by as an operator, in ε, beside what its angle is. The unit axis is wrong by
/// 1.5, which counts twice. The term of the sine loses 3 and that of `1 − cos ≤ 2` twice 6; sine and cosine themselves 3,
/// and the sum of the terms 5. The product with the rotation before it loses 4.5.
const OF_TURN: f64 = 31.0;

/// A value of a joint at a moment, and how fast it changes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Value<S> {
    pub(super) value: S,
    pub(super) rate: S,
    /// What rounding has done to the value.
    pub(super) error: S,
}

/// A frame that moves, with the first two derivatives of its place by time, where all joint values change at constant
/// rates. Only the frame has a bound on its error; derivatives are as they are computed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moving<V: Vector> {
    pub(super) frame: LinkFrame<V>,
    /// The angular velocity, as of [`axial`], and its derivative.
    pub(super) spin: V,
    pub(super) spin_rate: V,
    /// The velocity and the acceleration of the frame's origin.
    velocity: V,
    acceleration: V,
}

impl<V: Vector> Moving<V> {
    /// The world, at rest.
    pub(super) const WORLD: Self =
        Self { frame: LinkFrame::WORLD, spin: V::ZERO, spin_rate: V::ZERO, velocity: V::ZERO, acceleration: V::ZERO };

    /// The velocity of the point of the frame that is at `point`.
    #[inline]
    pub(super) fn velocity_at(&self, point: V) -> V {
        self.velocity + axial::turning(self.spin, point - self.frame.translation)
    }

    /// The acceleration of that point.
    #[inline]
    pub(super) fn acceleration_at(&self, point: V) -> V {
        let arm = point - self.frame.translation;
        let turning = axial::turning(self.spin, axial::turning(self.spin, arm));
        self.acceleration + axial::turning(self.spin_rate, arm) + turning
    }

    /// The frame beyond a stage.
    ///
    /// Its origin is a point of this frame, or slides along it. It has the angular velocity `ω + w` with the joint's own
    /// `w`, which this frame turns, so that its derivative is `ω′ + ω × w`; and what slides at `d` has the acceleration
    /// `2ω × d` more than a point of this frame (Coriolis).
    #[inline]
    pub(super) fn beyond(&self, stage: &JointStage<V>, Value { value, rate, error }: Value<V::Scalar>) -> Self {
        let fixed = &stage.fixed;
        match &stage.motion {
            StageMotion::Turn { sine, versine } => {
                let rotation = self.frame.rotation * stage.rotation(sine, versine, sin_cos(value));
                let moved = self.frame.moved(fixed.translation, stage.arm, fixed.shift_error);
                let turn_error = moved.turn_error + fixed.turn_error + error + epsilons(OF_TURN);
                let spin = axial::turned(&rotation, stage.axis) * rate;
                Self {
                    velocity: self.velocity_at(moved.translation),
                    acceleration: self.acceleration_at(moved.translation),
                    spin: self.spin + spin,
                    spin_rate: self.spin_rate + axial::product(self.spin, spin),
                    frame: LinkFrame { rotation, turn_error, ..moved },
                }
            }
            StageMotion::Slide { along } => {
                let (way, length) = (*along * value, num_traits::Float::abs(value));
                // The axis is turned, and wrong by 1.5ε before; the product and the sum are rounded.
                let lost = (fixed.turn_error + epsilons(6.0)) * (length + stage.arm);
                let arm = fixed.translation + way;
                let moved = self.frame.moved(arm, stage.arm + length, fixed.shift_error + error + lost);
                let turn_error = moved.turn_error + fixed.turn_error + epsilons(4.5);
                let slide = self.frame.rotation * *along * rate;
                let coriolis = axial::turning(self.spin, slide);
                Self {
                    velocity: self.velocity_at(moved.translation) + slide,
                    acceleration: self.acceleration_at(moved.translation) + coriolis + coriolis,
                    frame: LinkFrame { rotation: self.frame.rotation * fixed.rotation, turn_error, ..moved },
                    ..*self
                }
            }
        }
    }
}
