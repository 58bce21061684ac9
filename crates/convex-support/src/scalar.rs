//! The two floating-point types.

use core::fmt::{Debug, Display};

use crate::sealed::Sealed;

/// A floating-point number: `f32` or `f64`.
///
/// Arithmetic and functions come from [`num_traits::Float`]; this trait adds what generic geometry needs beside
/// them. It is sealed, so that methods may be added without breaking anybody.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a scalar of this crate",
    note = "the scalars are `f32` and `f64`"
)]
pub trait Scalar:
    num_traits::Float + num_traits::NumAssign + Debug + Display + Default + Send + Sync + 'static + Sealed
{
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// The distance from 1 to the next larger number, 2⁻²³ or 2⁻⁵².
    const EPSILON: Self;

    /// The nearest number of this type; a constant argument folds away.
    fn from_f64(value: f64) -> Self;

    /// The same number as an `f64`, exactly.
    fn as_f64(self) -> f64;
}

impl Scalar for f32 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const EPSILON: Self = Self::EPSILON;

    #[inline]
    #[allow(clippy::cast_possible_truncation, reason = "rounding to the nearest f32 is the purpose")]
    fn from_f64(value: f64) -> Self {
        value as Self
    }

    #[inline]
    fn as_f64(self) -> f64 {
        f64::from(self)
    }
}

impl Scalar for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const EPSILON: Self = Self::EPSILON;

    #[inline]
    fn from_f64(value: f64) -> Self {
        value
    }

    #[inline]
    fn as_f64(self) -> f64 {
        self
    }
}
