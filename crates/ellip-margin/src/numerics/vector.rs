//! Vectors as plain arrays of `f64`, and matrices as arrays of their columns.

use convex_support::numerics::elementary::sqrt;
use convex_support::{Matrix, Scalar, Vector};

pub(crate) type Vec<const N: usize> = [f64; N];

#[inline]
pub(crate) fn load<V: Vector, const N: usize>(v: V) -> Vec<N> {
    core::array::from_fn(|i| v.get(i).as_f64())
}

#[inline]
pub(crate) fn load_columns<M: Matrix, const N: usize>(m: M) -> [Vec<N>; N] {
    core::array::from_fn(|j| load(m.col(j)))
}

#[inline]
pub(crate) fn store<V: Vector, const N: usize>(v: Vec<N>) -> V {
    V::from_fn(|i| V::Scalar::from_f64(v[i]))
}

#[inline]
pub(crate) fn dot<const N: usize>(a: Vec<N>, b: Vec<N>) -> f64 {
    let mut sum = a[0] * b[0];
    for i in 1..N {
        sum += a[i] * b[i];
    }
    sum
}

/// Σ|xᵢ|, at least the length of `x` and at most √N times that, at any scale: nothing is squared.
#[inline]
pub(crate) fn size<const N: usize>(x: Vec<N>) -> f64 {
    let mut sum = x[0].abs();
    for i in 1..N {
        sum += x[i].abs();
    }
    sum
}

#[inline]
pub(crate) fn add<const N: usize>(a: Vec<N>, b: Vec<N>) -> Vec<N> {
    core::array::from_fn(|i| a[i] + b[i])
}

#[inline]
pub(crate) fn sub<const N: usize>(a: Vec<N>, b: Vec<N>) -> Vec<N> {
    core::array::from_fn(|i| a[i] - b[i])
}

/// Σₖ eₖ·columnₖ.
#[inline]
pub(crate) fn combine<const N: usize>(columns: [Vec<N>; N], e: Vec<N>) -> Vec<N> {
    core::array::from_fn(|i| {
        let mut sum = columns[0][i] * e[0];
        for k in 1..N {
            sum += columns[k][i] * e[k];
        }
        sum
    })
}

/// The unit vector along `x`, of any magnitude.
pub(crate) fn unit<const N: usize>(x: Vec<N>) -> Vec<N> {
    let largest = x.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let x = x.map(|x| x / largest);
    let norm = sqrt(dot(x, x));
    x.map(|x| x / norm)
}
