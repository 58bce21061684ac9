//! Sums and products without rounding: as the nearest number and its error.

use num_traits::Float as _;

use crate::{Scalar, Vector};

/// The exact rounding error of `a + b` (Knuth's two-sum).
#[inline]
pub fn lost_in_sum<V: Vector>(a: V, b: V) -> V {
    let sum = a + b;
    let seen = sum - a;
    (a - (sum - seen)) + (b - seen)
}

/// The parameter of the point of a line that is closest to an origin, and the point relative to the origin. However far
/// the source, the point is right to two roundings of its own length: the rounding error of the difference from the
/// origin is added to a fused multiply-add, which rounds once.
#[inline(always)]
pub fn foot_from<V: Vector>(origin: V, source: V, direction: V) -> (V::Scalar, V) {
    let seen = source - origin;
    let base = -seen.dot(direction) / direction.length_squared();
    let moved = V::from_fn(|i| base.mul_add(direction.get(i), seen.get(i)));
    (base, moved + lost_in_sum(source, -origin))
}

/// `a + b` and its rounding error.
#[inline]
pub fn two_sum<S: Scalar>(a: S, b: S) -> [S; 2] {
    let sum = a + b;
    let seen = sum - a;
    [sum, (a - (sum - seen)) + (b - seen)]
}

/// `a·b` and its rounding error, unless that is subnormal.
#[inline]
pub fn two_product<S: Scalar>(a: S, b: S) -> [S; 2] {
    let product = a * b;
    [product, a.mul_add(b, -product)]
}

/// `Σ aᵢ·bᵢ − subtracted`, as if computed in twice the precision and rounded once (Ogita, Rump and Oishi, *Accurate sum
/// and dot product*, 2005): the error is at most `ε/2` of the result and, for `n` pairs, `(n + 1)²·ε²/4` of `Σ
/// |aᵢ·bᵢ| + |subtracted|`.
pub fn dot_minus<S: Scalar>(pairs: impl IntoIterator<Item = (S, S)>, subtracted: S) -> S {
    // Products of two `f32` are exact in `f64`, and the sums there lose less than that.
    if S::EPSILON.as_f64() * S::EPSILON.as_f64() > f64::EPSILON {
        let add = |sum: f64, (a, b): (S, S)| sum + a.as_f64() * b.as_f64();
        return S::from_f64(pairs.into_iter().fold(-subtracted.as_f64(), add));
    }
    let (mut sum, mut lost) = (-subtracted, S::ZERO);
    for (a, b) in pairs {
        let [product, lost_in_product] = two_product(a, b);
        let [next, lost_in_sum] = two_sum(sum, product);
        sum = next;
        lost += lost_in_product + lost_in_sum;
    }
    sum + lost
}
