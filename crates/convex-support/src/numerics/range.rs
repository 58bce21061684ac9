//! Lengths whose squares would over- or underflow, measured in units of a power of two.

use super::elementary::power_of_two;
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

/// A power of two in which a quantity of size `largest` may be measured without its square over- or underflowing: 1
/// wherever that will do.
#[inline]
pub fn comfortable_unit_of_length<S: Scalar>(largest: S) -> S {
    if is_comfortable(largest * largest) { S::ONE } else { power_of_two_below(largest) }
}

/// The largest power of two that is not above `value`, or the smallest normal one; 1 where `value` is not positive or
/// not finite.
#[inline]
pub fn power_of_two_below<S: Scalar>(value: S) -> S {
    if !(value > S::ZERO && value.is_finite()) {
        return S::ONE;
    }
    let exponent = value.as_f64().to_bits() & f64::INFINITY.to_bits();
    S::from_f64(f64::from_bits(exponent)).max(S::min_positive_value())
}

/// What is rarely asked of a vector, such as of one whose square over- or underflows; once in a program for each
/// question.
///
/// The coordinates are passed on one by one: a vector of `f64` would go through memory, and since compilers put it
/// there before they branch, written in other pieces than it is read in, those who never come here would wait for it.
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
    // As across the axis of a cylinder, along its axis.
    if largest <= V::Scalar::ZERO {
        return None;
    }
    // Two factors, since those of subnormal numbers are below the smallest number, and their reciprocals not finite.
    let (_, exponent, _) = num_traits::Float::integer_decode(largest);
    let half = power_of_two(i32::from(exponent) / 2);
    let rest = power_of_two(i32::from(exponent) - i32::from(exponent) / 2);
    (largest > V::Scalar::ZERO).then(|| (v / half / rest, [half, rest]))
}
