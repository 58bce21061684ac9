//! Functions that every platform's mathematical library rounds in its own way, by one implementation for all: that of
//! the libm crate. It adds, multiplies, divides and takes roots in a fixed order, so that its results are the same bits
//! on every machine.
//!
//! It is a translation of musl's functions, most of them FreeBSD's and before that Sun's, whose sources derive an error
//! of less than one unit in the last place for each of those used here. In single precision they are computed in double
//! and rounded once. `clippy.toml` forbids the libraries to call those of the standard library and of num-traits.

use super::range::is_comfortable;
use crate::Scalar;

/// √x: by the processor's instruction, or without the standard library by libm, to the same bits.
#[inline]
pub fn sqrt<S: Scalar>(x: S) -> S {
    num_traits::Float::sqrt(x)
}

/// Sine and cosine.
#[inline]
pub fn sin_cos<S: Scalar>(angle: S) -> (S, S) {
    let (sin, cos) = libm::sincos(angle.as_f64());
    (S::from_f64(sin), S::from_f64(cos))
}

/// Tangent.
#[inline]
pub fn tan<S: Scalar>(angle: S) -> S {
    S::from_f64(libm::tan(angle.as_f64()))
}

/// The angle of the vector `(x, y)` from the axis of `x`.
#[inline]
pub fn atan2<S: Scalar>(y: S, x: S) -> S {
    S::from_f64(libm::atan2(y.as_f64(), x.as_f64()))
}

/// `√(x² + y²)`, to two units in the last place. The library's is asked only if a square would over- or underflow: it
/// takes several times as long.
#[inline]
pub fn hypot<S: Scalar>(x: S, y: S) -> S {
    let (x, y) = (x.as_f64(), y.as_f64());
    let squared = x * x + y * y;
    S::from_f64(if is_comfortable(squared) { sqrt(squared) } else { libm::hypot(x, y) })
}

/// The natural logarithm.
#[inline]
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// The exponential.
#[inline]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::*;

    /// Two functions with errors of less than a unit in the last place differ by no more than two; a wrong one differs
    /// by many.
    #[test]
    fn the_standard_library_says_the_same_but_for_rounding() {
        let mut x: f64 = 1e-3;
        while x < 700.0 {
            let (sin, cos) = sin_cos(x);
            let pairs = [
                (sin, x.sin()),
                (cos, x.cos()),
                (tan(x), x.tan()),
                (atan2(x, 3.0), x.atan2(3.0)),
                (hypot(x, -3.0), x.hypot(-3.0)),
                (ln(x), x.ln()),
                (exp(-x), (-x).exp()),
            ];
            for (i, (ours, theirs)) in pairs.into_iter().enumerate() {
                assert!((ours - theirs).abs() <= 2.0 * f64::EPSILON * theirs.abs(), "{i} of {x}: {ours} and {theirs}");
            }
            x *= 1.01;
        }
    }
}
