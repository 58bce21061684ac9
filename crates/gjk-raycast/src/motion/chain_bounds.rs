//! How fast, and how unevenly, points that joints carry may move at most, whatever the joint values are.

use convex_support::Scalar;

/// A bound for points at a distance `r` from the origin of the last joint that moves: `at_origin + per_length·r`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Linear<S> {
    at_origin: S,
    per_length: S,
}

/// Bounds on the first three derivatives, by time, of the place of a point along an edge, on which all joint values
/// change at constant rates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds<S> {
    pub(crate) speed: Linear<S>,
    pub(crate) acceleration: Linear<S>,
    pub(crate) jerk: Linear<S>,
    /// The sum of the rates of the joints that turn: no angular velocity is larger.
    pub(crate) spin: S,
    /// How far a point may be from the origin of the joint that was taken last.
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

/// Joints are taken from the last one on. Let `y` be a point as those so far have moved it, with the bounds `s`, `a` and
/// `j`. A joint that turns at the rate `w` takes it to `R(wt)·y`, and the derivatives of a product are
///
/// > s′ = w·l + s,   a′ = w²·l + 2w·s + a,   j′ = w³·l + 3w²·s + 3w·a + j,
///
/// where `l` is the distance of `y` from the axis. A joint that slides adds its rate to `s` alone.
impl<S: Scalar> Bounds<S> {
    /// Of points that no joint moves.
    pub(crate) const REST: Self = Self {
        speed: Linear::ZERO,
        acceleration: Linear::ZERO,
        jerk: Linear::ZERO,
        spin: S::ZERO,
        reach: Linear { per_length: S::ONE, ..Linear::ZERO },
    };

    /// With the way from the origin of another joint to where it was measured from.
    pub(crate) fn lengthen(&mut self, arm: S) {
        self.reach.at_origin += arm;
    }

    /// With a joint that turns, from whose axis the one before is as far as this.
    pub(crate) fn turn(&mut self, w: S, across: S) {
        let (two, three) = (S::from_f64(2.0), S::from_f64(3.0));
        let lever = Linear { at_origin: self.reach.at_origin + across, ..self.reach };
        self.jerk = self.jerk.plus(self.acceleration, three * w).plus(self.speed, three * w * w).plus(lever, w * w * w);
        self.acceleration = self.acceleration.plus(self.speed, two * w).plus(lever, w * w);
        self.speed = self.speed.plus(lever, w);
        self.spin += w;
    }

    /// With one that slides, by no more than `way`.
    pub(crate) fn slide(&mut self, rate: S, way: S) {
        self.speed.at_origin += rate;
        self.lengthen(way);
    }
}

#[cfg(test)]
mod tests {
    use super::Bounds;

    /// A point at the distance `r` from an axis that it turns about at the rate `w` is as fast as `w·r`, and its
    /// acceleration and jerk are `w²·r` and `w³·r`; a joint that slides before adds its rate.
    #[test]
    fn bounds_of_one_turning_joint_are_those_of_a_circle() {
        let mut bounds = Bounds::<f64>::REST;
        bounds.turn(3.0, 0.0);
        assert_eq!([bounds.speed.of(2.0), bounds.acceleration.of(2.0), bounds.jerk.of(2.0)], [6.0, 18.0, 54.0]);
        assert_eq!(bounds.spin, 3.0);
        bounds.slide(0.5, 0.0);
        assert_eq!([bounds.speed.of(2.0), bounds.acceleration.of(2.0)], [6.5, 18.0]);
    }
}
