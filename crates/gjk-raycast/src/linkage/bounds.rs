//! How fast, and how unevenly, points that joints carry may move at most, whatever the joint values are.

use convex_support::{Scalar, Vector};

use super::route::{Arm, Route};
use super::stage::StageMotion;

/// A bound for points at a distance `r` from the origin of the last joint that moves: `at_origin + per_length·r`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Linear<S> {
    at_origin: S,
    per_length: S,
}

/// Bounds on the first three derivatives, by time, of the place of a point along an edge, on which all joint values
/// change at constant rates.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bounds<S> {
    pub(super) speed: Linear<S>,
    pub(super) acceleration: Linear<S>,
    pub(super) jerk: Linear<S>,
    /// The sum of the rates of the joints that turn: no angular velocity is larger.
    pub(super) spin: S,
}

impl<S: Scalar> Linear<S> {
    pub(super) fn of(self, r: S) -> S {
        self.at_origin + self.per_length * r
    }

    fn plus(self, other: Self, factor: S) -> Self {
        Self {
            at_origin: self.at_origin + other.at_origin * factor,
            per_length: self.per_length + other.per_length * factor,
        }
    }
}

impl<S: Scalar> Bounds<S> {
    /// The bounds for a route whose joints change at these rates, and slide no farther than `slides`.
    ///
    /// Let `y` be a point as the joints beyond joint `k` have moved it, with the bounds `s`, `a` and `j`. Joint `k`
    /// turns it, `R(wt)·y`, and the derivatives of a product are
    ///
    /// > s′ = w·l + s,   a′ = w²·l + 2w·s + a,   j′ = w³·l + 3w²·s + 3w·a + j,
    ///
    /// where `l` is the distance of `y` from the axis, which is at most the part across it of the vector to the next
    /// joint's origin, and the distance of `y` from there. A joint that slides adds its rate to `s` alone.
    pub(super) fn of<V: Vector<Scalar = S>>(
        route: &Route<V>,
        rates: impl Fn(usize) -> S,
        slides: impl Fn(usize) -> S,
    ) -> Self {
        let (one, two, three) = (S::ONE, S::from_f64(2.0), S::from_f64(3.0));
        let Self { mut speed, mut acceleration, mut jerk, mut spin } = Self::default();
        let mut reach = Linear { at_origin: S::ZERO, per_length: one };
        for (stage, &Arm { length, across }) in route.stages.iter().zip(&route.arms).rev() {
            let w = rates(stage.column);
            match stage.motion {
                StageMotion::Turn { .. } => {
                    let lever = Linear { at_origin: reach.at_origin + across, ..reach };
                    jerk = jerk.plus(acceleration, three * w).plus(speed, three * w * w).plus(lever, w * w * w);
                    acceleration = acceleration.plus(speed, two * w).plus(lever, w * w);
                    speed = speed.plus(lever, w);
                    spin += w;
                }
                StageMotion::Slide { .. } => {
                    speed.at_origin += w;
                    reach.at_origin += slides(stage.column);
                }
            }
            reach.at_origin += length;
        }
        Self { speed, acceleration, jerk, spin }
    }
}
