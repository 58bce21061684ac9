//! The rotations of a space: an angle in 2D, a quaternion in 3D.

use glam::{DMat2, DMat3, DQuat, DVec2, DVec3, DVec4, Mat2, Mat3, Mat3A, Quat, Vec2, Vec3, Vec3A};

use crate::Rotation;
use crate::error::InvalidShape;
use crate::numerics::elementary::{atan2, sin_cos};
use crate::numerics::range::is_comfortable;

/// Rotations of the plane, whose sines and cosines are right to less than an ulp.
macro_rules! angle {
    ($S:ident rotates $V:ident by $M:ident) => {
        impl Rotation<$V> for $S {
            const MATRIX_ERROR: f64 = 1.0;
            const OPERATOR_ERROR: f64 = 1.5;

            #[inline]
            fn from_xyzw([_, _, z, w]: [$S; 4]) -> Self {
                2.0 * atan2(z, w)
            }

            #[inline(always)]
            fn matrix(self) -> $M {
                let (sin, cos) = sin_cos(self);
                $M::from_cols($V::new(cos, sin), $V::new(-sin, cos))
            }

            #[inline]
            fn checked(self, parameter: &'static str) -> Result<Self, InvalidShape> {
                if self.is_finite() { Ok(self) } else { Err(InvalidShape::NonFinite { parameter, index: 0 }) }
            }
        }
    };
}

angle!(f32 rotates Vec2 by Mat2);
angle!(f64 rotates DVec2 by DMat2);

/// With `u = ε/2`: the length is right to `3u`, and `1 − 2(y² + z²)`, with `2(y² + z²) ≤ 2`, loses `4·3u` of that, `4u`
/// by the rounding of the quotients, and `5u` by its own operations; the other entries lose half as much.
///
/// As an operator, the matrix is `1` and a part that is linear in the squared length, at most `2` long, which loses
/// `4·3u`; the rounding of the quotients turns by `4u`; and its own operations leave `8u`, the root of the sum of their
/// squares, because `Σ 2(y² + z²) ≤ 4`.
impl Rotation<DVec3> for DQuat {
    const MATRIX_ERROR: f64 = 11.0;
    const OPERATOR_ERROR: f64 = 12.0;

    #[inline]
    fn from_xyzw(quaternion: [f64; 4]) -> Self {
        Self::from_array(quaternion)
    }

    #[inline(always)]
    fn matrix(self) -> DMat3 {
        DMat3::from_quat(unit(self))
    }

    #[inline]
    fn checked(self, parameter: &'static str) -> Result<Self, InvalidShape> {
        let largest = DVec4::from(self).abs().max_element();
        if self.is_finite() && largest > 0.0 { Ok(self) } else { Err(what_is_wrong(parameter, self.to_array())) }
    }
}

/// Rotations in single precision, whose matrices are found in double precision and rounded once.
macro_rules! quaternion {
    ($V:ident by $M:ident, $rounded:expr) => {
        impl Rotation<$V> for Quat {
            const MATRIX_ERROR: f64 = 0.501;
            const OPERATOR_ERROR: f64 = 0.87;

            #[inline]
            fn from_xyzw(quaternion: [f32; 4]) -> Self {
                Self::from_array(quaternion)
            }

            #[inline(always)]
            fn matrix(self) -> $M {
                $rounded(DMat3::from_quat(unit(self.as_dquat())))
            }

            #[inline]
            fn checked(self, parameter: &'static str) -> Result<Self, InvalidShape> {
                Rotation::<DVec3>::checked(self.as_dquat(), parameter).map(|_| self)
            }
        }
    };
}

quaternion!(Vec3 by Mat3, |matrix: DMat3| matrix.as_mat3());
quaternion!(Vec3A by Mat3A, |matrix: DMat3| Mat3A::from(matrix.as_mat3()));

/// A quaternion of any length made unit.
#[inline]
fn unit(q: DQuat) -> DQuat {
    let v = DVec4::from(q);
    let squared = v.length_squared();
    let excess = squared - 1.0;
    if excess.abs() < 1e-6 {
        // If nearly unit, as mostly: three terms of the series of 1/√(1 + x) are right to rounding, and faster.
        DQuat::from_vec4(v * (1.0 - excess * (0.5 - 0.375 * excess)))
    } else if is_comfortable(squared) {
        DQuat::from_vec4(v * num_traits::Float::sqrt(squared).recip())
    } else {
        unit_of_scaled(v.x, v.y, v.z, v.w)
    }
}

/// The same if squares could over- or underflow: division by a power of two near the largest magnitude keeps them in
/// range.
#[cold]
#[inline(never)]
fn unit_of_scaled(x: f64, y: f64, z: f64, w: f64) -> DQuat {
    let v = DVec4::new(x, y, z, w);
    let v = v / crate::numerics::range::power_of_two_below(v.abs().max_element());
    DQuat::from_vec4(v * num_traits::Float::sqrt(v.length_squared()).recip())
}

#[cold]
fn what_is_wrong(parameter: &'static str, quaternion: [f64; 4]) -> InvalidShape {
    match quaternion.iter().position(|c| !c.is_finite()) {
        Some(index) => InvalidShape::NonFinite { parameter, index },
        None => InvalidShape::ZeroRotation,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotations_are_normalised_first() {
        let q = DQuat::from_xyzw(0.0, 0.0, 3e-200, 3e-200);
        let m = q.checked("rotation").expect("not zero").matrix();
        assert!((m * DVec3::X - DVec3::Y).length() < 1e-15, "a quarter turn about z, got {m}");
        let tiny = DQuat::from_xyzw(0.0, 0.0, 5e-324, 5e-324).matrix();
        assert!((tiny * DVec3::X - DVec3::Y).length() < 1e-15, "also of subnormal numbers, got {tiny}");
    }

    #[test]
    fn what_is_wrong_with_a_rotation_is_said() {
        let zero = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);
        assert_eq!(zero.checked("rotation"), Err(InvalidShape::ZeroRotation));
        for bad in [f64::NAN, f64::INFINITY] {
            let error = InvalidShape::NonFinite { parameter: "rotation", index: 2 };
            assert_eq!(DQuat::from_xyzw(1.0, 0.0, bad, 1.0).checked("rotation"), Err(error));
            let error = InvalidShape::NonFinite { parameter: "rotation", index: 0 };
            assert_eq!(Rotation::<DVec2>::checked(bad, "rotation"), Err(error));
        }
    }
}
