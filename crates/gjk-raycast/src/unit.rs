//! The unit of length of the algorithms: a power of two near the size of the compared lengths.
//!
//! Numbers of magnitude about one neither over- nor underflow when they are multiplied a few times, in `f32` as in
//! `f64`; and because the unit is a power of two, scaling a scene by one changes only the unit.

pub(crate) use convex_support::numerics::range::is_moderate;
use convex_support::{Scalar, Vector};
use num_traits::Float as _;

/// A power of two near `size`, or the nearest that has a finite reciprocal; 1 if `size` is zero or not finite.
#[inline]
pub(crate) fn power_of_two_near<S: Scalar>(size: S) -> S {
    // Positive numbers are ordered like their bits. The reciprocal must be finite and not subnormal: half of the
    // largest power is near enough.
    let least = S::max_value().recip().as_f64().to_bits();
    let largest = S::max_value().as_f64().to_bits() & EXPONENT;
    let power = size.as_f64().to_bits() & EXPONENT;
    if power > least && power <= largest {
        S::from_f64(f64::from_bits(power.min(largest - EXPONENT_STEP)))
    } else {
        unusual_unit(size)
    }
}

/// The least normal number for those below it.
#[cold]
#[inline(never)]
fn unusual_unit<S: Scalar>(size: S) -> S {
    if size > S::ZERO && size.is_finite() { S::min_positive_value() } else { S::ONE }
}

/// The error of lengths of about `size`, beside relative errors: nothing, or everything if the size is so small that a
/// product with a short direction may be subnormal. A direction that matters is no shorter than `ε`, and the least
/// number must be no more than `ε` of the product.
#[inline(always)]
pub(crate) fn lost_to_underflow<S: Scalar>(size: S) -> S {
    if size >= S::min_positive_value() / S::EPSILON { S::ZERO } else { S::infinity() }
}

/// The reciprocal of the result of [`power_of_two_near`], by its exponent: all later steps wait for the unit.
#[inline]
pub(crate) fn reciprocal_of_power<S: Scalar>(power: S) -> S {
    S::from_f64(f64::from_bits(2 * 1.0_f64.to_bits() - power.as_f64().to_bits()))
}

/// The bits of the exponent of an `f64`, and the least of them.
const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
const EXPONENT_STEP: u64 = 0x0010_0000_0000_0000;

/// The same direction at a moderate length, by a power of two and so without rounding. `None` for the zero vector and
/// if a coordinate is not finite.
#[inline(always)]
pub(crate) fn moderate<V: Vector>(v: V) -> Option<V> {
    if is_moderate(v.length_squared()) {
        return Some(v);
    }
    made_moderate(v.get(0), v.get(1), if V::DIM == 3 { v.get(2) } else { V::Scalar::ZERO })
}

#[cold]
#[inline(never)]
fn made_moderate<V: Vector>(x: V::Scalar, y: V::Scalar, z: V::Scalar) -> Option<V> {
    let v = V::from_fn(|i| [x, y, z][i]);
    let near_one = v * power_of_two_near(v.abs().max_element()).recip();
    if is_moderate(near_one.length_squared()) { Some(near_one) } else { v.unit() }
}

/// A bound on the length of a vector that is no more than √3 too large.
pub(crate) fn length_bound<V: Vector>(v: V) -> V::Scalar {
    v.abs().max_element() * V::Scalar::from_f64(1.7321)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A unit has one digit, and so has its reciprocal, however large or small the size.
    #[test]
    fn a_unit_is_a_power_of_two_near_the_size() {
        for exponent in -1000..1000 {
            let size = 1.7 * f64::from(exponent).exp2();
            let unit = power_of_two_near(size);
            assert!(unit <= size && size < unit + unit, "{size:e} {unit:e}");
            assert_eq!(reciprocal_of_power(unit) * unit, 1.0);
            assert_eq!(unit.to_bits() & !EXPONENT, 0, "{unit:e}");
        }
        for odd in [0.0, f64::NAN, f64::INFINITY, -1.0] {
            assert_eq!(power_of_two_near(odd), 1.0);
        }
        // Neither the unit nor its reciprocal is subnormal.
        assert_eq!(power_of_two_near(1e-40_f32), f32::MIN_POSITIVE);
        assert!(power_of_two_near(f32::MAX).recip() >= f32::MIN_POSITIVE);
    }
}
