//! glam's vectors and square matrices behind one pair of traits.

use num_traits::Float as _;

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use crate::Scalar;

/// A vector of 2D or 3D space: glam's `Vec2`, `Vec3`, `Vec3A`, `DVec2` or `DVec3`.
///
/// The vector type is the only type parameter of this workspace: it fixes the dimension ([`DIM`](Self::DIM)) and the
/// precision ([`Scalar`](Self::Scalar)). Methods keep glam's names and meanings, so that a generic body reads like a
/// body written for one of glam's types.
///
/// The trait is sealed, so that methods may be added without breaking anybody.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a vector of this crate",
    note = "the vectors are glam's `Vec2`, `Vec3`, `Vec3A`, `DVec2` and `DVec3`"
)]
pub trait Vector:
    Copy
    + Debug
    + Default
    + PartialEq
    + Add<Output = Self>
    + AddAssign
    + Sub<Output = Self>
    + SubAssign
    + Neg<Output = Self>
    + Mul<Output = Self>
    + Mul<Self::Scalar, Output = Self>
    + Div<Output = Self>
    + Div<Self::Scalar, Output = Self>
    + Send
    + Sync
    + 'static
    + sealed::Sealed
{
    /// The type of the coordinates.
    type Scalar: Scalar;
    /// The square matrices that act on these vectors: `Mat2`, `Mat3`, `Mat3A`, `DMat2` or `DMat3`.
    type Matrix: Matrix<Vector = Self>;
    /// How glam says *rotation* in this space: an angle in radians in 2D, a quaternion in 3D.
    type Rotation: Copy + Debug + Default + PartialEq + Send + Sync + 'static;

    /// The dimension of the space, 2 or 3.
    const DIM: usize;
    /// The zero vector.
    const ZERO: Self;
    /// The vector of ones.
    const ONE: Self;

    /// The vector whose coordinates are all `value`.
    fn splat(value: Self::Scalar) -> Self;
    /// The vector whose coordinate `i` is `f(i)`.
    fn from_fn(f: impl FnMut(usize) -> Self::Scalar) -> Self;
    /// Coordinate `index`, counted from 0.
    ///
    /// # Panics
    /// If `index >= DIM`.
    fn get(self, index: usize) -> Self::Scalar;
    /// The dot product.
    fn dot(self, rhs: Self) -> Self::Scalar;
    /// The squared Euclidean length.
    fn length_squared(self) -> Self::Scalar;
    /// The Euclidean length; see [`norm`](Self::norm) where squares could over- or underflow.
    fn length(self) -> Self::Scalar;
    /// Absolute values, coordinate by coordinate.
    fn abs(self) -> Self;
    /// Minima, coordinate by coordinate.
    fn min(self, rhs: Self) -> Self;
    /// Maxima, coordinate by coordinate.
    fn max(self, rhs: Self) -> Self;
    /// The magnitudes of `self` with the signs of `sign`, coordinate by coordinate.
    fn copysign(self, sign: Self) -> Self;
    /// The largest coordinate.
    fn max_element(self) -> Self::Scalar;
    /// The smallest coordinate.
    fn min_element(self) -> Self::Scalar;
    /// Whether all coordinates are finite.
    fn is_finite(self) -> bool;
    /// Whether any coordinate is `NaN`.
    fn is_nan(self) -> bool;
    /// The same rotation by a unit quaternion; `None` where it is not finite or is the zero quaternion.
    ///
    /// This and the matrix are apart because an `Option` of a matrix is copied in pieces that are not its columns, and a column
    /// of `Vec3A` that is then read whole waits for them to be written.
    fn unit_rotation(rotation: Self::Rotation) -> Option<Self::Rotation>;
    /// The matrix of a rotation, which is by a unit quaternion in 3D.
    fn rotation_matrix(unit: Self::Rotation) -> Self::Matrix;
    /// The rotation that the quaternion `x·i + y·j + z·k + w` stands for; in 2D by its angle about `z`, `2·atan2(z, w)`.
    fn rotation_from_xyzw(quaternion: [Self::Scalar; 4]) -> Self::Rotation;

    /// The unit vector along coordinate axis `index`.
    #[inline]
    #[must_use]
    fn axis(index: usize) -> Self {
        Self::from_fn(|i| if i == index { Self::Scalar::ONE } else { Self::Scalar::ZERO })
    }

    /// The Euclidean length for vectors of any magnitude: squares that would over- or underflow are avoided by
    /// scaling with a power of two, so that the result is right to a few ulps wherever it is representable.
    ///
    /// ```
    /// use convex_support::{Vector, glam::DVec3};
    ///
    /// assert_eq!(Vector::norm(DVec3::new(3e-200, 4e-200, 0.0)), 5e-200);
    /// ```
    #[inline]
    #[must_use]
    fn norm(self) -> Self::Scalar {
        let squared = self.length_squared();
        if is_comfortable(squared) {
            squared.sqrt()
        } else {
            scaled(self).map_or(squared, |(v, [s, t])| v.length() * s * t)
        }
    }

    /// The unit vector along `self` for vectors of any magnitude; `None` for the zero vector and where a coordinate
    /// is not finite.
    ///
    /// ```
    /// use convex_support::{Vector, glam::DVec2};
    ///
    /// assert_eq!(Vector::unit(DVec2::new(0.0, -1e-300)), Some(DVec2::NEG_Y));
    /// assert_eq!(Vector::unit(DVec2::ZERO), None);
    /// ```
    #[inline]
    #[must_use]
    fn unit(self) -> Option<Self> {
        let squared = self.length_squared();
        if is_comfortable(squared) {
            Some(self / squared.sqrt())
        } else {
            scaled(self).filter(|(v, _)| v.is_finite()).map(|(v, _)| v / v.length())
        }
    }
}

/// Whether a squared length carries full relative precision: it did not overflow, and a coordinate whose square
/// underflowed is below its rounding error.
#[inline]
pub(crate) fn is_comfortable<S: Scalar>(squared: S) -> bool {
    squared >= S::min_positive_value() / S::EPSILON && squared < S::infinity()
}

/// A power of two in which a quantity of size `largest` may be measured without its square over- or underflowing: 1
/// wherever that will do.
#[inline]
pub(crate) fn comfortable_unit_of_length<S: Scalar>(largest: S) -> S {
    if is_comfortable(largest * largest) { S::ONE } else { power_of_two_below(largest) }
}

/// The largest power of two that is not above `value`, or the smallest normal one; 1 where `value` is not positive or
/// not finite.
#[cold]
pub(crate) fn power_of_two_below<S: Scalar>(value: S) -> S {
    if value <= S::ZERO || !value.is_finite() {
        return S::ONE;
    }
    let (_, exponent, _) = num_traits::Float::integer_decode(value);
    // The mantissa is an integer of as many bits as EPSILON says.
    let unit = num_traits::Float::powi(S::from_f64(2.0), i32::from(exponent)) / S::EPSILON;
    if unit > S::ZERO { unit } else { S::min_positive_value() }
}

/// `v` divided by a power of two near its largest magnitude, and that power as two factors; `None` for zero and NaN.
///
/// The coordinates are passed on one by one: a vector of `f64` would go through memory, and since compilers put it there
/// before they branch, written in other pieces than it is read in, those who never come here would wait for it.
#[inline]
pub(crate) fn scaled<V: Vector>(v: V) -> Option<(V, [V::Scalar; 2])> {
    let z = if V::DIM == 3 { v.get(2) } else { V::Scalar::ZERO };
    scaled_coordinates(v.get(0), v.get(1), z)
}

#[cold]
#[inline(never)]
fn scaled_coordinates<V: Vector>(x: V::Scalar, y: V::Scalar, z: V::Scalar) -> Option<(V, [V::Scalar; 2])> {
    let v = V::from_fn(|i| [x, y, z][i]);
    let largest = v.abs().max_element();
    // Two factors, since those of subnormal numbers are below the smallest number, and their reciprocals not finite.
    let (_, exponent, _) = num_traits::Float::integer_decode(largest);
    let half = num_traits::Float::powi(V::Scalar::from_f64(2.0), i32::from(exponent) / 2);
    let rest = num_traits::Float::powi(V::Scalar::from_f64(2.0), i32::from(exponent) - i32::from(exponent) / 2);
    (largest > V::Scalar::ZERO).then(|| (v / half / rest, [half, rest]))
}

/// A vector of 3D space, where there is a cross product: `Vec3`, `Vec3A` or `DVec3`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a vector of 3D space",
    note = "cylinders, cones and cross products need glam's `Vec3`, `Vec3A` or `DVec3`"
)]
pub trait Vector3: Vector {
    /// The cross product.
    fn cross(self, rhs: Self) -> Self;
}

/// A square matrix acting on [`Vector`]s by `matrix * vector`.
pub trait Matrix:
    Copy
    + Debug
    + Default
    + PartialEq
    + Mul<Self::Vector, Output = Self::Vector>
    + Mul<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Send
    + Sync
    + 'static
    + sealed::Sealed
{
    /// The vectors it acts on.
    type Vector: Vector<Matrix = Self>;

    /// The identity.
    const IDENTITY: Self;

    /// The matrix whose column `j` is `f(j)`.
    fn from_cols_fn(f: impl FnMut(usize) -> Self::Vector) -> Self;
    /// Column `index`, counted from 0.
    ///
    /// # Panics
    /// If `index >= DIM`.
    fn col(&self, index: usize) -> Self::Vector;
    /// The transpose.
    #[must_use]
    fn transpose(&self) -> Self;
    /// The transpose times `rhs`, without forming the transpose.
    fn transpose_mul(&self, rhs: Self::Vector) -> Self::Vector;
    /// The determinant.
    fn determinant(&self) -> <Self::Vector as Vector>::Scalar;
    /// The inverse; its entries are not finite where the matrix is singular.
    #[must_use]
    fn inverse(&self) -> Self;

    /// The diagonal matrix with the given diagonal.
    #[inline]
    #[must_use]
    fn from_diagonal(diagonal: Self::Vector) -> Self {
        Self::from_cols_fn(|j| Self::Vector::axis(j) * diagonal.get(j))
    }

    /// Whether all entries are finite.
    #[inline]
    fn is_finite(&self) -> bool {
        (0..Self::Vector::DIM).all(|j| self.col(j).is_finite())
    }
}

mod sealed {
    // Sealed because algorithms rely on these being plain Euclidean vectors, and because methods will be added.
    pub trait Sealed {}
}

/// Forwards the traits to one of glam's types.
macro_rules! glam_vector {
    ($V:ident, $M:ident, $S:ident, $R:ty, $dim:literal, $transpose_mul:ident, [$($i:literal),+], $unit:expr, $matrix:expr, $from_xyzw:expr) => {
        impl sealed::Sealed for glam::$V {}
        impl sealed::Sealed for glam::$M {}

        impl Vector for glam::$V {
            type Scalar = $S;
            type Matrix = glam::$M;
            type Rotation = $R;

            const DIM: usize = $dim;
            const ZERO: Self = Self::ZERO;
            const ONE: Self = Self::ONE;

            #[inline]
            fn splat(value: $S) -> Self { Self::splat(value) }
            #[inline]
            fn from_fn(mut f: impl FnMut(usize) -> $S) -> Self { Self::new($(f($i)),+) }
            #[inline]
            fn get(self, index: usize) -> $S { self[index] }
            #[inline]
            fn dot(self, rhs: Self) -> $S { self.dot(rhs) }
            #[inline]
            fn length_squared(self) -> $S { self.length_squared() }
            #[inline]
            fn length(self) -> $S { self.length() }
            #[inline]
            fn abs(self) -> Self { self.abs() }
            #[inline]
            fn min(self, rhs: Self) -> Self { self.min(rhs) }
            #[inline]
            fn max(self, rhs: Self) -> Self { self.max(rhs) }
            #[inline]
            fn copysign(self, sign: Self) -> Self { self.copysign(sign) }
            #[inline]
            fn max_element(self) -> $S { self.max_element() }
            #[inline]
            fn min_element(self) -> $S { self.min_element() }
            #[inline]
            fn is_finite(self) -> bool { self.is_finite() }
            #[inline]
            fn is_nan(self) -> bool { self.is_nan() }
            #[inline]
            fn unit_rotation(rotation: $R) -> Option<$R> { ($unit)(rotation) }
            #[inline(always)]
            fn rotation_matrix(unit: $R) -> glam::$M { ($matrix)(unit) }
            #[inline]
            fn rotation_from_xyzw(quaternion: [$S; 4]) -> $R { ($from_xyzw)(quaternion) }
        }

        impl Matrix for glam::$M {
            type Vector = glam::$V;

            const IDENTITY: Self = Self::IDENTITY;

            #[inline]
            fn from_cols_fn(mut f: impl FnMut(usize) -> glam::$V) -> Self { Self::from_cols($(f($i)),+) }
            #[inline]
            fn col(&self, index: usize) -> glam::$V { self.col(index) }
            #[inline]
            fn transpose(&self) -> Self { self.transpose() }
            #[inline]
            fn transpose_mul(&self, rhs: glam::$V) -> glam::$V { self.$transpose_mul(rhs) }
            #[inline]
            fn determinant(&self) -> $S { self.determinant() }
            #[inline]
            fn inverse(&self) -> Self { self.inverse() }
        }
    };
}

glam_vector!(Vec2, Mat2, f32, f32, 2, transpose_mul_vec2, [0, 1], finite_angle, glam::Mat2::from_angle, angle_about_z);
glam_vector!(
    DVec2,
    DMat2,
    f64,
    f64,
    2,
    transpose_mul_vec2,
    [0, 1],
    finite_angle,
    glam::DMat2::from_angle,
    angle_about_z
);
glam_vector!(
    Vec3,
    Mat3,
    f32,
    glam::Quat,
    3,
    transpose_mul_vec3,
    [0, 1, 2],
    unit_quat,
    glam::Mat3::from_quat,
    glam::Quat::from_array
);
glam_vector!(
    Vec3A,
    Mat3A,
    f32,
    glam::Quat,
    3,
    transpose_mul_vec3a,
    [0, 1, 2],
    unit_quat,
    glam::Mat3A::from_quat,
    glam::Quat::from_array
);
glam_vector!(
    DVec3,
    DMat3,
    f64,
    glam::DQuat,
    3,
    transpose_mul_vec3,
    [0, 1, 2],
    unit_dquat,
    glam::DMat3::from_quat,
    glam::DQuat::from_array
);

/// `None` where the angle is not finite.
fn finite_angle<S: Scalar>(angle: S) -> Option<S> {
    angle.is_finite().then_some(angle)
}

/// The angle of a turn about `z` from its quaternion.
fn angle_about_z<S: Scalar>([_, _, z, w]: [S; 4]) -> S {
    S::from_f64(2.0) * z.atan2(w)
}

impl Vector3 for glam::Vec3 {
    #[inline]
    fn cross(self, rhs: Self) -> Self {
        self.cross(rhs)
    }
}

impl Vector3 for glam::Vec3A {
    #[inline]
    fn cross(self, rhs: Self) -> Self {
        self.cross(rhs)
    }
}

impl Vector3 for glam::DVec3 {
    #[inline]
    fn cross(self, rhs: Self) -> Self {
        self.cross(rhs)
    }
}

/// A quaternion of any magnitude made unit; `None` for zero and where not finite.
#[inline]
fn unit_quat(q: glam::Quat) -> Option<glam::Quat> {
    unit_dquat(q.as_dquat()).map(|q| q.as_quat())
}

/// A quaternion of any magnitude made unit; `None` for zero and where not finite.
#[inline]
fn unit_dquat(q: glam::DQuat) -> Option<glam::DQuat> {
    let v = glam::DVec4::from(q);
    let squared = v.length_squared();
    let excess = squared - 1.0;
    if excess.abs() < 1e-6 {
        // Nearly unit, as most are: three terms of the series of 1/√(1 + x) are right to rounding, and quicker.
        Some(glam::DQuat::from_vec4(v * (1.0 - excess * (0.5 - 0.375 * excess))))
    } else if is_comfortable(squared) {
        Some(glam::DQuat::from_vec4(v * squared.sqrt().recip()))
    } else {
        unit_of_scaled(v.x, v.y, v.z, v.w)
    }
}

/// The same where squares could over- or underflow: dividing by the largest magnitude first keeps them in range.
#[cold]
#[inline(never)]
fn unit_of_scaled(x: f64, y: f64, z: f64, w: f64) -> Option<glam::DQuat> {
    let v = glam::DVec4::new(x, y, z, w);
    let v = v / v.abs().max_element();
    v.is_finite().then(|| glam::DQuat::from_vec4(v.normalize()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, DVec2, DVec3, Vec3A};

    #[test]
    fn unit_vectors_at_every_magnitude() {
        for s in [1e-320, 1e-300, 1e-200, 1e-160, 1e-10, 1.0, 1e10, 1e160, 1e300] {
            let u = Vector::unit(DVec3::new(3.0, -4.0, 12.0) * s).expect("not zero");
            let error = (u - DVec3::new(3.0, -4.0, 12.0) / 13.0).length();
            // 1e-320 is subnormal: the vector itself carries only three digits there.
            assert!(error < if s == 1e-320 { 1e-2 } else { 1e-15 }, "{s}: {u}");
        }
        for s in [1e-40, 1e-20, 1.0, 1e20, 1e37] {
            let u = Vector::unit(Vec3A::new(3.0, -4.0, 0.0) * s).expect("not zero");
            assert!((u - Vec3A::new(0.6, -0.8, 0.0)).length() < if s == 1e-40 { 1e-4 } else { 1e-6 }, "{s}: {u}");
        }
        assert_eq!(Vector::unit(DVec2::new(f64::NAN, 1.0)), None, "NaN has no direction");
        assert_eq!(Vector::unit(DVec2::new(f64::INFINITY, 1.0)), None, "an infinite vector has no direction");
    }

    #[test]
    fn norms_at_every_magnitude() {
        for s in [1e-300, 1e-160, 1.0, 1e160, 1e300] {
            let n = Vector::norm(DVec2::new(3.0, 4.0) * s);
            assert!((n / s - 5.0).abs() < 1e-14, "{s}: {n}");
        }
        assert_eq!(Vector::norm(DVec2::ZERO), 0.0, "the zero vector");
        assert_eq!(Vector::norm(DVec2::new(3.0, 4.0) * 5e-324), 5.0 * 5e-324, "subnormal");
        assert_eq!(Vector::norm(Vec3A::new(3.0, 0.0, 4.0) * 1e-45), 5.0 * 1e-45, "subnormal");
    }

    #[test]
    fn rotations_are_normalised_first() {
        let q = DQuat::from_xyzw(0.0, 0.0, 3e-200, 3e-200);
        let m = DVec3::rotation_matrix(DVec3::unit_rotation(q).expect("not zero"));
        assert!((m * DVec3::X - DVec3::Y).length() < 1e-15, "a quarter turn about z, got {m}");
        assert_eq!(DVec3::unit_rotation(DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0)), None, "the zero quaternion");
        assert_eq!(DVec3::unit_rotation(DQuat::from_xyzw(f64::NAN, 0.0, 0.0, 1.0)), None, "NaN");
    }
}
