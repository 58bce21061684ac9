//! glam's vectors behind one trait, and what turns them behind two more: the traits name one another.

mod glam;
mod matrix;

pub use matrix::Matrix;

use num_traits::Float as _;

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use crate::Scalar;
use crate::error::InvalidShape;
use crate::numerics::range::{is_comfortable, power_of_two};
use crate::sealed::Sealed;

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
    + Sealed
{
    /// The type of the coordinates.
    type Scalar: Scalar;
    /// The square matrices that act on these vectors: `Mat2`, `Mat3`, `Mat3A`, `DMat2` or `DMat3`.
    type Matrix: Matrix<Vector = Self>;
    /// The type of a rotation in this space: an angle in radians in 2D, a quaternion in 3D.
    type Rotation: Rotation<Self>;
    /// The type of an angular velocity in this space: a number in 2D, a vector in 3D.
    type AngularVelocity: AngularVelocity<Self>;

    /// The same vectors as plain numbers, of which compilers make vector instructions for several at a time: `Vec3` for
    /// `Vec3A`, and the others themselves.
    #[doc(hidden)]
    type Numbers: Vector<Scalar = Self::Scalar>;

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
    /// The Euclidean length; see [`norm`](Self::norm) if squares could over- or underflow.
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
            rarely(self, |v| scaled(v).map_or(v.length_squared(), |(v, [s, t])| v.length() * s * t))
        }
    }

    /// The unit vector along `self` for vectors of any magnitude; `None` for the zero vector and if a coordinate is not
    /// finite.
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
        let is_usual = is_comfortable(squared);
        // NaN if there is none: an optional vector of the rare case would take the usual one through memory, too.
        let unit = if is_usual {
            self / squared.sqrt()
        } else {
            let none = Self::splat(Self::Scalar::nan());
            rarely(self, |v| scaled(v).filter(|(v, _)| v.is_finite()).map_or(none, |(v, _)| v / v.length()))
        };
        (is_usual || !unit.is_nan()).then_some(unit)
    }
}

/// A vector of 3D space, which has a cross product: `Vec3`, `Vec3A` or `DVec3`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a vector of 3D space",
    note = "cylinders, cones and cross products need glam's `Vec3`, `Vec3A` or `DVec3`"
)]
pub trait Vector3: Vector {
    /// The cross product.
    fn cross(self, rhs: Self) -> Self;
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::glam::{DVec2, DVec3, Vec3A};

    #[test]
    fn unit_vectors_at_every_magnitude() {
        for s in [1e-320, 1e-300, 1e-200, 1e-160, 1e-10, 1.0, 1e10, 1e160, 1e300] {
            let u = Vector::unit(DVec3::new(3.0, -4.0, 12.0) * s).expect("not zero");
            let error = (u - DVec3::new(3.0, -4.0, 12.0) / 13.0).length();
            // The vector itself has only three digits at 1e-320, which is subnormal.
            assert!(error < if s == 1e-320 { 1e-2 } else { 1e-15 }, "{s}: {u}");
        }
        for s in [1e-40, 1e-20, 1.0, 1e20, 1e37] {
            let u = Vector::unit(Vec3A::new(3.0, -4.0, 0.0) * s).expect("not zero");
            assert!((u - Vec3A::new(0.6, -0.8, 0.0)).length() < if s == 1e-40 { 1e-4 } else { 1e-6 }, "{s}: {u}");
        }
        assert_eq!(Vector::unit(DVec2::new(f64::NAN, 1.0)), None, "NaN has no direction");
        assert_eq!(Vector::unit(DVec2::new(f64::INFINITY, 1.0)), None, "an infinite vector has no direction");
    }

    /// On processors with an instruction for it, glam's own `Vec3A::cross` fuses a product and a difference: for a
    /// vector with itself it then leaves the rounding of a product, and not zero. Registers must compute the same as
    /// three numbers.
    #[test]
    fn vectors_in_registers_compute_the_bits_of_three_numbers() {
        use ::glam::{Mat3, Mat3A, Vec3};

        let coordinate = |k: u8| (f32::from(k) * 0.7 + 0.1).sqrt() - 1.5;
        for k in 0..40 {
            let [a, b, c] = [k, k + 50, 2 * k + 100].map(|k| Vec3::from_fn(|i| coordinate(k + 3 * i as u8)));
            let crossed = Vector3::cross(Vec3A::from(a), Vec3A::from(b));
            assert_eq!(crossed.to_array(), Vector3::cross(a, b).to_array(), "{a} × {b}");
            assert_eq!(Vector3::cross(Vec3A::from(a), Vec3A::from(a)), Vec3A::ZERO, "{a} × {a}");
            let m = Mat3::from_cols(a, b, c);
            let registers = Mat3A::from(m);
            assert_eq!(Matrix::determinant(&registers), Matrix::determinant(&m), "the determinant of {m}");
            assert_eq!(Mat3::from(Matrix::inverse(&registers)), Matrix::inverse(&m), "the inverse of {m}");
            assert_eq!(registers * Vec3A::from(c), Vec3A::from(m * c), "{m} times {c}");
        }
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
}

/// A rotation of the space of `V`: an angle in radians in 2D, a quaternion of any length in 3D.
///
/// Its meaning is exact: the sine and cosine of the angle, and the quaternion divided by its length. The trait is
/// sealed; [`Vector::Rotation`] says which type rotates which vectors.
pub trait Rotation<V: Vector>: Copy + Debug + Default + PartialEq + Send + Sync + 'static + Sealed {
    /// A bound on the rounding error of each entry of [`matrix`](Self::matrix), in units of the scalar's epsilon.
    const MATRIX_ERROR: f64;

    /// A bound on how far the matrix moves a unit vector from where the rotation does, in the same units.
    const OPERATOR_ERROR: f64;

    /// The rotation of the quaternion `x·i + y·j + z·k + w`; in 2D by its angle about `z`, `2·atan2(z, w)`.
    fn from_xyzw(quaternion: [V::Scalar; 4]) -> Self;

    /// The matrix; of NaNs if there is none.
    fn matrix(self) -> V::Matrix;

    /// The rotation if it has a matrix.
    ///
    /// # Errors
    /// [`InvalidShape::NonFinite`] naming the number that is not finite, [`InvalidShape::ZeroRotation`] for the zero
    /// quaternion.
    fn checked(self, parameter: &'static str) -> Result<Self, InvalidShape>;
}

/// An angular velocity `ω` in the space of `V`, in radians per unit of time: a number in 2D, counterclockwise; in 3D a
/// vector along the axis, after the right-hand rule.
///
/// The trait is sealed; [`Vector::AngularVelocity`] says which type turns which vectors.
pub trait AngularVelocity<V: Vector>:
    Copy + Debug + Default + PartialEq + Send + Sync + 'static + Sealed + data::Data
{
    /// A bound on the error of [`turn`](Self::turn) as an operator, relative to the square root of the sum of its
    /// squared entries and in units of the scalar's epsilon.
    const TURN_ERROR: f64;

    /// The type of a rotation at this velocity.
    type Spin: Spin<V>;

    /// The matrix `W` with `W·x = ω × x`.
    fn cross_matrix(self) -> V::Matrix;

    /// The rotation at this velocity, prepared for many times.
    fn spin(self) -> Self::Spin;

    /// The matrix `R − 1` with `R` the rotation by `|ω|·time` about `ω`: what the rotation adds to a vector. It is
    /// small if the angle is small, and its error is relative to its size.
    ///
    /// The angle may be many turns, since it is computed in twice the precision. Beyond 2⁵⁰ this is not enough, and the
    /// matrix consists of NaNs.
    #[inline]
    fn turn(self, time: V::Scalar) -> V::Matrix {
        self.spin().turn(time)
    }

    /// The constant angular velocity that turns `from` into `to` within one unit of time, the short way round.
    /// Quaternions need not be unit; the result is of NaNs if one of them is no rotation.
    fn between(from: V::Rotation, to: V::Rotation) -> Self;

    /// The angular velocity `factor` times as fast.
    #[must_use]
    fn scaled(self, factor: V::Scalar) -> Self;

    /// The first coordinate that is not finite, counted from 0.
    fn non_finite(self) -> Option<usize>;

    /// The moment of a force at the end of an arm: `arm × force`, in 2D its only coordinate. So for any `ω`
    ///
    /// > moment(arm, force)·ω = force·(ω × arm).
    ///
    /// ```
    /// use convex_support::{AngularVelocity, glam::{DVec2, DVec3}};
    ///
    /// assert_eq!(<f64 as AngularVelocity<DVec2>>::moment(DVec2::X * 3.0, DVec2::Y), 3.0);
    /// let moment = <DVec3 as AngularVelocity<DVec3>>::moment(DVec3::X * 3.0, DVec3::Y);
    /// assert_eq!(moment, DVec3::Z * 3.0);
    /// ```
    fn moment(arm: V, force: V) -> Self;

    /// Coordinate `index`, counted from 0, of the one in 2D or the three in 3D.
    ///
    /// # Panics
    /// If there is no such coordinate.
    fn coordinate(self, index: usize) -> V::Scalar;

    /// The angular velocity whose coordinate `i` is `f(i)`.
    fn from_coordinates(f: impl FnMut(usize) -> V::Scalar) -> Self;
}

/// A rotation at a constant [angular velocity](AngularVelocity). Everything that does not depend on time is computed
/// once.
///
/// ```
/// use convex_support::{AngularVelocity, Spin, glam::DVec3};
///
/// // A quarter of a turn about z within a second.
/// let spin = (DVec3::Z * std::f64::consts::FRAC_PI_2).spin();
/// for (time, to) in [(0.0, DVec3::X), (1.0, DVec3::Y), (2.0, -DVec3::X)] {
///     assert!((DVec3::X + spin.turn(time) * DVec3::X - to).length() < 1e-15);
/// }
/// ```
pub trait Spin<V: Vector>: Copy + Debug + Send + Sync + 'static + Sealed {
    /// The displacement of a vector by the rotation after `time`, as by [`AngularVelocity::turn`].
    fn turn(&self, time: V::Scalar) -> V::Matrix;
}

mod data {
    /// The traits of data with serde, so that no type with an angular velocity has to name them.
    #[cfg(feature = "serde")]
    pub trait Data: serde::Serialize + serde::de::DeserializeOwned {}
    #[cfg(feature = "serde")]
    impl<T: serde::Serialize + serde::de::DeserializeOwned> Data for T {}
    #[cfg(not(feature = "serde"))]
    pub trait Data {}
    #[cfg(not(feature = "serde"))]
    impl<T> Data for T {}
}

/// A rare question about a vector, such as one whose square over- or underflows; compiled once for each question.
///
/// The coordinates are passed one by one: a vector of `f64` would go through memory. Compilers store it before they
/// branch, in other pieces than it is read in, so that the usual case would wait for it.
#[inline]
pub(crate) fn rarely<V: Vector, R>(v: V, question: impl FnOnce(V) -> R) -> R {
    #[cold]
    #[inline(never)]
    fn asked<V: Vector, R>(x: V::Scalar, y: V::Scalar, z: V::Scalar, question: impl FnOnce(V) -> R) -> R {
        question(V::from_fn(|i| [x, y, z][i]))
    }
    asked(v.get(0), v.get(1), if V::DIM == 3 { v.get(2) } else { V::Scalar::ZERO }, question)
}

/// `v` divided by a power of two near its largest magnitude, and that power as two factors; `None` for zero and NaN.
pub(crate) fn scaled<V: Vector>(v: V) -> Option<(V, [V::Scalar; 2])> {
    let largest = v.abs().max_element();
    // As for the vector across the axis of a cylinder, if the direction is along the axis.
    if largest <= V::Scalar::ZERO {
        return None;
    }
    // Two factors, because those of subnormal numbers are below the smallest number, and their reciprocals not finite.
    let (_, exponent, _) = num_traits::Float::integer_decode(largest);
    let half = power_of_two(i32::from(exponent) / 2);
    let rest = power_of_two(i32::from(exponent) - i32::from(exponent) / 2);
    (largest > V::Scalar::ZERO).then(|| (v / half / rest, [half, rest]))
}
