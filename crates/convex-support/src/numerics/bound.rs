//! Upper bounds on magnitudes, which rounding must not reduce.
//!
//! Bounds are sums of products of non-negative numbers. A dozen such operations lose a dozen halves of `ε` at most, for
//! which [`raised`] compensates once at the end. A product that underflows is the exception; [`product`] compensates
//! for it at once. Exact zeros stay zero.

use crate::{Matrix, Scalar, Vector};

/// The smallest positive number: the largest error of a subnormal product or quotient.
#[inline]
pub fn least<S: Scalar>() -> S {
    S::min_positive_value() * S::EPSILON
}

/// A bound on the product of two magnitudes, except for its relative rounding.
#[inline]
pub fn product<S: Scalar>(a: S, b: S) -> S {
    if a == S::ZERO || b == S::ZERO { S::ZERO } else { a * b + least::<S>() }
}

/// `count` half units in the last place of a number of at most the given magnitude: the error of so many roundings.
#[inline]
pub fn roundings<S: Scalar>(count: f64, magnitude: S) -> S {
    product(S::from_f64(0.5 * count) * S::EPSILON, magnitude)
}

/// [`roundings`] for each coordinate.
#[inline]
pub fn roundings_of<V: Vector>(count: f64, magnitudes: V) -> V {
    magnitudes * (V::Scalar::from_f64(0.5 * count) * V::Scalar::EPSILON) + least_of(magnitudes)
}

/// A bound on the coordinates of `matrix·x` for all `x` whose coordinates are at most as large as those of
/// `magnitudes`.
#[inline]
pub fn image<M: Matrix>(matrix: &M, magnitudes: M::Vector) -> M::Vector {
    if magnitudes == M::Vector::ZERO {
        return magnitudes;
    }
    let term = |j: usize| {
        let (column, magnitude) = (matrix.col(j).abs(), magnitudes.get(j));
        column * magnitude + column.min(least_of(M::Vector::splat(magnitude)))
    };
    (1..M::Vector::DIM).fold(term(0), |sum, j| sum + term(j))
}

/// A bound that makes up for the rounding of up to 60 operations on non-negative numbers.
#[inline]
pub fn raised<S: Scalar>(bound: S) -> S {
    bound + roundings(64.0, bound)
}

/// [`raised`] for each coordinate.
#[inline]
pub fn raised_vector<V: Vector>(bounds: V) -> V {
    bounds + roundings_of(64.0, bounds)
}

/// The smallest positive number for each coordinate of `magnitudes` that is not zero: no other number is less, so that
/// it is their minimum.
#[inline]
fn least_of<V: Vector>(magnitudes: V) -> V {
    magnitudes.min(V::splat(least()))
}
