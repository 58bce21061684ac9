//! Lengths whose squares would over- or underflow, measured in units of a power of two.

use crate::Scalar;

/// Whether a squared length carries full relative precision: it did not overflow, and a coordinate whose square
/// underflowed is below its rounding error.
#[inline]
pub fn is_comfortable<S: Scalar>(squared: S) -> bool {
    squared >= S::min_positive_value() / S::EPSILON && squared < S::infinity()
}

/// Whether products of a few such numbers, and their rounding errors, are far from over- and underflow.
#[inline]
pub fn is_moderate<S: Scalar>(x: S) -> bool {
    let tiny = S::min_positive_value().sqrt().sqrt();
    x > tiny && x < tiny.recip()
}

/// A power of two in units of which the square of a quantity of size `largest` neither over- nor underflows: 1 if
/// possible.
#[inline]
pub fn comfortable_unit_of_length<S: Scalar>(largest: S) -> S {
    if is_comfortable(largest * largest) { S::ONE } else { power_of_two_below(largest) }
}

/// `2ⁿ`, exact if a number of this type is equal to it.
#[inline]
pub fn power_of_two<S: Scalar>(n: i32) -> S {
    S::from_f64(libm::ldexp(1.0, n))
}

/// The largest power of two that is not above `value`, or the smallest normal one; 1 if `value` is not positive or not
/// finite.
#[inline]
pub fn power_of_two_below<S: Scalar>(value: S) -> S {
    if !(value > S::ZERO && value.is_finite()) {
        return S::ONE;
    }
    let exponent = value.as_f64().to_bits() & f64::INFINITY.to_bits();
    S::from_f64(f64::from_bits(exponent)).max(S::min_positive_value())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_reach_from_the_least_number_to_beyond_the_greatest() {
        assert_eq!(power_of_two::<f64>(-1074), f64::from_bits(1), "the least number");
        assert_eq!((power_of_two::<f32>(127), power_of_two::<f32>(128)), (2.0f32.powi(127), f32::INFINITY));
    }
}
