//! Lengths whose squares would over- or underflow, measured in units of a power of two.

use crate::{Scalar, Vector};

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

/// A rare question about a vector, such as one whose square over- or underflows; compiled once for each question.
///
/// The coordinates are passed one by one: a vector of `f64` would go through memory. Compilers store it before they
/// branch, in other pieces than it is read in, so that the usual case would wait for it.
#[inline]
pub fn rarely<V: Vector, R>(v: V, question: impl FnOnce(V) -> R) -> R {
    #[cold]
    #[inline(never)]
    fn asked<V: Vector, R>(x: V::Scalar, y: V::Scalar, z: V::Scalar, question: impl FnOnce(V) -> R) -> R {
        question(V::from_fn(|i| [x, y, z][i]))
    }
    asked(v.get(0), v.get(1), if V::DIM == 3 { v.get(2) } else { V::Scalar::ZERO }, question)
}

/// `v` divided by a power of two near its largest magnitude, and that power as two factors; `None` for zero and NaN.
pub fn scaled<V: Vector>(v: V) -> Option<(V, [V::Scalar; 2])> {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_reach_from_the_least_number_to_beyond_the_greatest() {
        assert_eq!(power_of_two::<f64>(-1074), f64::from_bits(1), "the least number");
        assert_eq!((power_of_two::<f32>(127), power_of_two::<f32>(128)), (2.0f32.powi(127), f32::INFINITY));
    }
}
