//! Symmetric matrices and vectors across an axis.

use convex_support::numerics::elementary::hypot;
use convex_support::{Scalar, Vector};
use num_traits::Float as _;

/// A symmetric matrix `(a b; b d)`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Symmetric<S> {
    pub(crate) a: S,
    pub(crate) b: S,
    pub(crate) d: S,
}

impl<S: Scalar> Symmetric<S> {
    pub(crate) const ZERO: Self = Self { a: S::ZERO, b: S::ZERO, d: S::ZERO };

    pub(crate) fn of([a, b, d]: [S; 3]) -> Self {
        Self { a, b, d }
    }

    pub(crate) fn times(self, (x, y): Across<S>) -> Across<S> {
        (self.a * x + self.b * y, self.b * x + self.d * y)
    }

    pub(crate) fn determinant(self) -> S {
        self.a * self.d - self.b * self.b
    }

    /// `x` with `self·x` the given vector.
    pub(crate) fn solve(self, (x, y): Across<S>) -> Across<S> {
        let inverse = self.determinant().recip();
        ((self.d * x - self.b * y) * inverse, (self.a * y - self.b * x) * inverse)
    }

    /// Whether the solution is more than rounding.
    pub(crate) fn is_regular(self) -> bool {
        self.determinant() > S::EPSILON.sqrt() * self.a * self.d
    }

    /// The sum with a multiple of the unit matrix.
    pub(crate) fn plus(self, diagonal: S) -> Self {
        Self { a: self.a + diagonal, b: self.b, d: self.d + diagonal }
    }

    /// `(1 − share)·self + share·other`.
    pub(crate) fn blend(self, other: Self, share: S) -> Self {
        let rest = S::ONE - share;
        Self {
            a: self.a * rest + other.a * share,
            b: self.b * rest + other.b * share,
            d: self.d * rest + other.d * share,
        }
    }

    /// The eigenvalue of a matrix of rank one, and its unit eigenvector.
    pub(crate) fn eigen_of_rank_one(self) -> Option<(S, Across<S>)> {
        let trace = self.a + self.d;
        let column = if self.a > self.d { (self.a, self.b) } else { (self.b, self.d) };
        let length = dot(column, column).sqrt();
        (trace > S::ZERO && length > S::ZERO).then(|| (trace, (column.0 / length, column.1 / length)))
    }

    /// The mean of both eigenvalues and half their difference, without a sum of squares.
    fn eigenvalues(self) -> (S, S) {
        let half = S::from_f64(0.5);
        ((self.a + self.d) * half, hypot((self.a - self.d) * half, self.b))
    }

    pub(crate) fn least_eigenvalue(self) -> S {
        let (mean, apart) = self.eigenvalues();
        // The product of both eigenvalues is the determinant.
        if mean + apart > S::ZERO { self.determinant() / (mean + apart) } else { mean - apart }
    }

    /// The greatest eigenvalue of a matrix without negative ones, and its unit eigenvector; `None` if that is NaN.
    pub(crate) fn greatest_eigen(self) -> Option<(S, Across<S>)> {
        let (mean, apart) = self.eigenvalues();
        let greatest = mean + apart;
        // (H − λ)·x = 0: by the row that cancels less.
        let x = if self.a > self.d { (greatest - self.d, self.b) } else { (self.b, greatest - self.a) };
        let length = hypot(x.0, x.1);
        (length > S::ZERO).then(|| (greatest, (x.0 / length, x.1 / length)))
    }

    /// Whether all of it is zero, for a matrix without negative eigenvalues.
    pub(crate) fn is_zero(self) -> bool {
        self.a == S::ZERO && self.d == S::ZERO
    }
}

/// A vector across an axis, by two coordinates.
pub(crate) type Across<S> = (S, S);

pub(crate) fn dot<S: Scalar>(a: Across<S>, b: Across<S>) -> S {
    a.0 * b.0 + a.1 * b.1
}

pub(crate) fn sum<S: Scalar>(a: Across<S>, b: Across<S>) -> Across<S> {
    (a.0 + b.0, a.1 + b.1)
}

pub(crate) fn scaled<S: Scalar>(a: Across<S>, factor: S) -> Across<S> {
    (a.0 * factor, a.1 * factor)
}

/// The vector turned counterclockwise by a right angle.
pub(crate) fn turned_left<S: Scalar>((x, y): Across<S>) -> Across<S> {
    (-y, x)
}

/// The unit vector from a place to another.
pub(crate) fn direction<S: Scalar>(from: Across<S>, to: Across<S>) -> Across<S> {
    let e = way(from, to);
    scaled(e, dot(e, e).sqrt().recip())
}

/// The vector from one place to another.
pub(crate) fn way<S: Scalar>(from: Across<S>, to: Across<S>) -> Across<S> {
    (to.0 - from.0, to.1 - from.1)
}

pub(crate) fn cross<S: Scalar>(a: Across<S>, b: Across<S>) -> S {
    a.0 * b.1 - a.1 * b.0
}

/// Unit vectors across a unit vector and one another, after Duff et al., *Building an orthonormal basis, revisited*
/// (2017); the second is zero in the plane.
#[inline(always)]
pub(crate) fn axes_across<V: Vector>(u: V) -> [V; 2] {
    let one = V::Scalar::ONE;
    let (x, y) = (u.get(0), u.get(1));
    if V::DIM == 2 {
        return [V::from_fn(|i| [-y, x][i]), V::ZERO];
    }
    let z = u.get(2);
    let sign = one.copysign(z);
    let a = -(sign + z).recip();
    let b = x * y * a;
    let e1 = [one + sign * x * x * a, sign * b, -sign * x];
    let e2 = [b, sign + y * y * a, -y];
    [V::from_fn(|i| e1[i]), V::from_fn(|i| e2[i])]
}
