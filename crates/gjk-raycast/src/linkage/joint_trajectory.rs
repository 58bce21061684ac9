//! How joint values change with time, as a caller states it.

use convex_support::Scalar;

/// The joint values of a [`Linkage`](crate::Linkage) along one edge of a path, at the times from 0 to 1, and bounds on
/// how they change: a piece of a spline, or of a planner's time parametrisation.
///
/// A piece that takes the time `T`, in whatever unit, is one in `t/T`: its rates are then `T` times as large, its
/// accelerations `T²` times, and its jerks `T³` times. [`Linkage::path_along`](crate::Linkage::path_along) takes such
/// edges, and has an example.
///
/// # What an implementor must obey
/// The values have to be twice differentiable in an edge, with an acceleration whose differences the jerk bounds. The
/// bounds must hold at all times from 0 to 1, since they alone prove that nothing happens between two times that are
/// examined. A larger bound costs time; a smaller one may let bodies pass through one another. An edge whose rates vary
/// much is answered faster in several parts, each with its own bounds.
///
/// For a cubic, let `a`, `b`, `c` and `d` be the absolute values of the coefficients of 1, `t`, `t²` and `t³`. The
/// bounds are `a + b + c + d`, `b + 2c + 3d`, `2c + 6d` and `6d`. By Horner's rule the error is at most
/// `4ε(a + b + c + d)`: no coefficient passes through more than six roundings of `ε/2` each, with `ε` the machine
/// epsilon, and `t` is at most 1.
pub trait JointTrajectory {
    /// The type of numbers.
    type Scalar: Scalar;

    /// The value of a joint at a time, by its index among the joints that move.
    fn state(&self, joint: usize, time: Self::Scalar) -> JointState<Self::Scalar>;

    /// Bounds for that joint, at all times from 0 to 1.
    fn bounds(&self, joint: usize) -> JointBounds<Self::Scalar>;
}

/// The value of a joint at one time, with its derivatives. Only the value needs an error bound: the derivatives may be
/// wrong by a few ε of their bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointState<S> {
    /// The value.
    pub value: S,
    /// Its first derivative.
    pub rate: S,
    /// Its second derivative.
    pub acceleration: S,
    /// A bound on the rounding error of the value.
    pub error: S,
}

/// Bounds on the absolute value of a joint value and its derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointBounds<S> {
    /// A bound on the value. It only counts for a joint that slides.
    pub value: S,
    /// A bound on the first derivative.
    pub rate: S,
    /// A bound on the second derivative.
    pub acceleration: S,
    /// A bound on the third derivative.
    pub jerk: S,
}

impl<S: Scalar> JointBounds<S> {
    /// Those of a value around 0 that changes at this constant rate.
    pub(crate) const fn constant(rate: S) -> Self {
        Self { value: S::ZERO, rate, acceleration: S::ZERO, jerk: S::ZERO }
    }

    /// Whether they are finite, and none is negative.
    pub(super) fn are_valid(&self) -> bool {
        let Self { value, rate, acceleration, jerk } = *self;
        [value, rate, acceleration, jerk].iter().all(|bound| *bound >= S::ZERO && bound.is_finite())
    }
}

impl<T: JointTrajectory + ?Sized> JointTrajectory for &T {
    type Scalar = T::Scalar;

    fn state(&self, joint: usize, time: T::Scalar) -> JointState<T::Scalar> {
        (**self).state(joint, time)
    }

    fn bounds(&self, joint: usize) -> JointBounds<T::Scalar> {
        (**self).bounds(joint)
    }
}
