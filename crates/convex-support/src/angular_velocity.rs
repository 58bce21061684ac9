//! Angular velocities: a number in 2D, a vector in 3D.

use core::marker::PhantomData;

use glam::{DMat2, DMat3, DQuat, DVec2, DVec3, Mat2, Mat3, Mat3A, Quat, Vec2, Vec3, Vec3A};

use crate::numerics::elementary::{atan2, sin_cos};
use crate::numerics::range::comfortable_unit_of_length;
use crate::numerics::twofold::{dot_minus, two_product};
use crate::sealed::Sealed;
use crate::{AngularVelocity, Scalar, Spin, Vector, Vector3};

/// Angular velocities of the plane, where with `h` half the angle `R − 1 = 2·sin h·(−sin h, −cos h; cos h, −sin h)`.
///
/// With `u = ε/2`, sine and cosine of an angle known to twice the digits are right to `3u`, so that each entry is to
/// `7u` of `2·sin h`, which is the norm of a column. Those of `f32` are rounded once.
macro_rules! number {
    ($S:ident turns $V:ident by $M:ident, $error:literal, $rounded:expr) => {
        impl AngularVelocity<$V> for $S {
            const TURN_ERROR: f64 = $error;

            type Spin = Self;

            #[inline]
            fn cross_matrix(self) -> $M {
                $M::from_cols($V::new(0.0, self), $V::new(-self, 0.0))
            }

            #[inline]
            fn spin(self) -> Self {
                self
            }

            fn between(from: $S, to: $S) -> Self {
                let turn = core::f64::consts::TAU;
                // Exact, after Sterbenz, if the angles are near one another; whole turns are subtracted before.
                let angle = (to.as_f64() % turn) - (from.as_f64() % turn);
                Self::from_f64(angle - turn * num_traits::Float::round(angle / turn))
            }

            #[inline]
            fn scaled(self, factor: $S) -> Self {
                self * factor
            }

            #[inline]
            fn non_finite(self) -> Option<usize> {
                if self.is_finite() { None } else { Some(0) }
            }

            #[inline]
            fn moment(arm: $V, force: $V) -> Self {
                arm.perp_dot(force)
            }

            #[inline]
            fn coordinate(self, index: usize) -> $S {
                [self][index]
            }

            #[inline]
            fn from_coordinates(mut f: impl FnMut(usize) -> $S) -> Self {
                f(0)
            }
        }

        impl Spin<$V> for $S {
            #[inline]
            fn turn(&self, time: $S) -> $M {
                let [sin, cos] = sin_cos_of_sum(two_product(0.5 * self.as_f64(), time.as_f64()));
                let (x, y) = (-2.0 * sin * sin, 2.0 * sin * cos);
                $rounded(DMat2::from_cols(DVec2::new(x, y), DVec2::new(-y, x)))
            }
        }
    };
}

number!(f32 turns Vec2 by Mat2, 0.6, |matrix: DMat2| matrix.as_mat2());
number!(f64 turns DVec2 by DMat2, 6.0, |matrix| matrix);

/// Angular velocities of space.
macro_rules! vector {
    ($V:ident by $M:ident, $Q:ident, $error:literal, $double:expr, $rounded:expr, $matrix_rounded:expr) => {
        impl AngularVelocity<$V> for $V {
            const TURN_ERROR: f64 = $error;

            type Spin = SpinInSpace<Self>;

            #[inline]
            fn cross_matrix(self) -> $M {
                let [x, y, z] = self.to_array();
                $M::from_cols($V::new(0.0, z, -y), $V::new(-z, 0.0, x), $V::new(y, -x, 0.0))
            }

            #[inline]
            fn spin(self) -> SpinInSpace<Self> {
                SpinInSpace::new($double(self))
            }

            fn between(from: $Q, to: $Q) -> Self {
                let double = |q: $Q| DQuat::from_array(q.to_array().map(Scalar::as_f64));
                $rounded(turn_between(double(from), double(to)))
            }

            #[inline]
            fn scaled(self, factor: <$V as Vector>::Scalar) -> Self {
                self * factor
            }

            #[inline]
            fn non_finite(self) -> Option<usize> {
                self.to_array().iter().position(|c| !c.is_finite())
            }

            #[inline]
            fn moment(arm: $V, force: $V) -> Self {
                Vector3::cross(arm, force)
            }

            #[inline]
            fn coordinate(self, index: usize) -> <$V as Vector>::Scalar {
                self.get(index)
            }

            #[inline]
            fn from_coordinates(f: impl FnMut(usize) -> <$V as Vector>::Scalar) -> Self {
                <$V as Vector>::from_fn(f)
            }
        }

        impl Spin<$V> for SpinInSpace<$V> {
            #[inline]
            fn turn(&self, time: <$V as Vector>::Scalar) -> $M {
                $matrix_rounded(self.after(time.as_f64()))
            }
        }
    };
}

vector!(Vec3 by Mat3, Quat, 0.6, |v: Vec3| v.as_dvec3(), |v: DVec3| v.as_vec3(), |m: DMat3| m.as_mat3());
vector!(
    Vec3A by Mat3A, Quat, 0.6, |v: Vec3A| v.as_dvec3(), |v: DVec3| v.as_vec3a(), |m: DMat3| Mat3A::from(m.as_mat3())
);
vector!(DVec3 by DMat3, DQuat, 10.0, |v| v, |v| v, |m| m);

/// A rotation about an axis in space.
#[derive(Clone, Copy, Debug)]
pub struct SpinInSpace<V> {
    /// The unit vector along it, or zero if nothing turns.
    axis: DVec3,
    /// The rate in two parts, in a unit that is a power of two.
    rate: f64,
    lost: f64,
    unit: f64,
    /// The vectors that it turns.
    space: PhantomData<V>,
}

impl<V: Vector> Sealed for SpinInSpace<V> {}

impl<V> SpinInSpace<V> {
    fn new(angular_velocity: DVec3) -> Self {
        if angular_velocity == DVec3::ZERO {
            return Self { axis: DVec3::ZERO, rate: 0.0, lost: 0.0, unit: 1.0, space: PhantomData };
        }
        // A power of two keeps squares from over- and underflow.
        let unit = comfortable_unit_of_length(angular_velocity.abs().max_element());
        let w = angular_velocity / unit;
        let rate = w.length();
        // What the square root loses of |w|: |w| = rate + (|w|² − rate²)/(2·rate), with the squares to twice the
        // digits.
        let [square, rest] = two_product(rate, rate);
        let lost = (dot_minus(w.to_array().map(|c| (c, c)), square) - rest) / (2.0 * rate);
        Self { axis: w / rate, rate, lost, unit, space: PhantomData }
    }

    /// `R − 1` for the rotation by `|ω|·time` about `ω` (Rodrigues): with the unit axis `a` and half the angle `h`,
    ///
    /// > R − 1 = sin 2h·[a]× + (1 − cos 2h)·[a]×² = 2·sin h·(cos h·[a]× + sin h·(a·aᵀ − 1)).
    ///
    /// With `u = ε/2`, the axis is right to `3u`, sine and cosine to `3u`. So the first matrix in the parentheses is
    /// wrong by `7u`, the second by `11u`, and they are rounded by `3u` more, where their norm is 1; that of the
    /// entries of the whole is `√2` times larger.
    fn after(&self, time: f64) -> DMat3 {
        let Self { axis: a, rate, lost, unit, .. } = *self;
        // Not even after an infinite time, whose product with zero is NaN.
        if rate == 0.0 {
            return DMat3::ZERO;
        }
        let half = 0.5 * unit * time;
        let [angle, rest] = two_product(rate, half);
        let [sin, cos] = sin_cos_of_sum([angle, rest + lost * half]);
        let (c, s) = (a * (2.0 * sin * cos), 2.0 * sin * sin);
        let v = a * s;
        // [a]×² = a·aᵀ − 1, whose diagonal is minus the sum of two squares.
        let (xx, yy, zz) = (v.x * a.x, v.y * a.y, v.z * a.z);
        let (xy, yz, zx) = (v.x * a.y, v.y * a.z, v.z * a.x);
        DMat3::from_cols(
            DVec3::new(-(yy + zz), xy + c.z, zx - c.y),
            DVec3::new(xy - c.z, -(zz + xx), yz + c.x),
            DVec3::new(zx + c.y, yz - c.x, -(xx + yy)),
        )
    }
}

/// The shorter of the two turns from one rotation to another.
fn turn_between(from: DQuat, to: DQuat) -> DVec3 {
    let unit = |q: DQuat| q / num_traits::Float::sqrt(q.length_squared());
    let turn = unit(to) * unit(from).conjugate();
    let turn = if turn.w < 0.0 { -turn } else { turn };
    let half = turn.xyz().length();
    // The sine and cosine of half the angle; where it is small, twice the sine is the angle to rounding.
    let per_sine = if half > 0.0 { 2.0 * atan2(half, turn.w) / half } else { 2.0 };
    turn.xyz() * per_sine
}

/// Sine and cosine of an angle in two parts, of which the second is below the rounding of the first. NaNs beyond
/// [`LARGEST_ANGLE`].
#[inline]
fn sin_cos_of_sum([angle, rest]: [f64; 2]) -> [f64; 2] {
    if angle.is_nan() || angle.abs() > LARGEST_ANGLE {
        return [f64::NAN; 2];
    }
    let (sin, cos) = sin_cos(angle);
    // If the angle is below 2²⁶, as most are, 1 − cos(rest) is below rounding.
    let (s, c) = if rest.abs() < 7e-9 { (rest, 1.0) } else { sin_cos(rest) };
    [sin * c + cos * s, cos * c - sin * s]
}

/// Angles up to this are known to less than rounding in two parts.
const LARGEST_ANGLE: f64 = (1_u64 << 50) as f64;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_is_right_after_many_turns() {
        // |ω| = 13 exactly.
        let w = DVec3::new(3.0, 4.0, 12.0);
        let (sin, cos) = sin_cos(13.0 * 7_777_777.0);
        let v = DVec3::new(4.0, -3.0, 0.0);
        let expected = v * cos + w.cross(v) / 13.0 * sin;
        let turned = v + w.turn(7_777_777.0) * v;
        assert!((turned - expected).length() < 8.0 * f64::EPSILON * 5.0, "{turned} is not {expected}");
        assert!((w.cross_matrix() * DVec3::X - w.cross(DVec3::X)).length() == 0.0, "the matrix of the cross product");
    }

    #[test]
    fn what_is_at_rest_never_turns() {
        for time in [0.0, 1.0, f64::INFINITY] {
            assert_eq!(DVec3::ZERO.turn(time), DMat3::ZERO, "after {time}");
        }
    }

    #[test]
    fn small_turns_are_right_relative_to_themselves() {
        for angle in [1e-4, 1e-9, 1e-30] {
            let v = DVec3::new(0.3, -0.7, 0.2);
            let turned = DVec3::new(0.0, 0.0, 3.0).turn(angle / 3.0) * v;
            // To the third order, where that is below rounding.
            let expected = DVec3::Z.cross(v) * (angle - angle * angle * angle / 6.0)
                + DVec3::Z.cross(DVec3::Z.cross(v)) * (angle * angle / 2.0 - angle * angle * angle * angle / 24.0);
            assert!((turned - expected).length() < 1e-15 * angle, "{angle}: {turned} is not {expected}");
        }
    }

    #[test]
    fn angles_are_known_to_twice_the_digits() {
        let rotation = |t: f64| DMat2::IDENTITY + AngularVelocity::<DVec2>::turn(1.1, t);
        // The product of 1.1 and a quarter of the time rounds elsewhere.
        for time in [1e3, 1e9, 1e12 / 3.0] {
            let quarter = rotation(time / 4.0);
            let error = (quarter * quarter * quarter * quarter * DVec2::X - rotation(time) * DVec2::X).length();
            assert!(error < 16.0 * f64::EPSILON, "{time}: {error}");
        }
        assert!(rotation(4e15).is_nan(), "unknown beyond 2⁵⁰");
    }

    #[test]
    fn turns_between_rotations_go_the_short_way() {
        let about = |angle: f64| DQuat::from_axis_angle(DVec3::Z, angle);
        for (from, to, turn) in [(0.1, 0.4, 0.3), (3.0, -3.0, core::f64::consts::TAU - 6.0), (0.0, 1e-9, 1e-9)] {
            let w = <DVec3 as AngularVelocity<DVec3>>::between(about(from) * 3.0, about(to));
            assert!((w - DVec3::Z * turn).length() < 1e-15, "from {from} to {to}: {w}");
            let w = <f64 as AngularVelocity<DVec2>>::between(from, to);
            assert!((w - turn).abs() < 1e-15, "from {from} to {to}: {w}");
        }
    }
}
