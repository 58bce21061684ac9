//! The affine hull of up to four points.

use convex_support::{Scalar, Vector};

use crate::simplex::MAX_POINTS;

/// The affine hull of a few points, by an orthogonal basis of it.
///
/// With the last point `y` and edges `e_i = y_i − y`, the edges are made orthogonal by Gram–Schmidt:
///
/// ```text
/// f_i = e_i − Σ_{j<i} c_ij·f_j,   c_ij = e_i·f_j / f_j·f_j.
/// ```
///
/// Every projection is done twice. After that it is orthogonal to rounding even where nearly everything cancels, so that
/// a short vector from a far simplex keeps its direction; and only squares of lengths occur, no products of four.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flat<V: Vector> {
    y: V,
    f: [V; 3],
    c: [[V::Scalar; 3]; 3],
    squared: [V::Scalar; 3],
    /// The number of edges.
    n: usize,
}

/// A vector split into a part along a flat and a part across it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projection<V: Vector> {
    pub(crate) across: V,
    /// The barycentric coordinates of `y` plus the part along the flat, in the order of the points.
    pub(crate) coordinates: [V::Scalar; MAX_POINTS],
}

impl<V: Vector> Flat<V> {
    /// The affine hull of one to four points.
    pub(crate) fn new(points: &[V]) -> Self {
        let zero = V::Scalar::ZERO;
        let n = points.len() - 1;
        let y = points[n];
        let (mut f, mut c, mut squared) = ([V::ZERO; 3], [[zero; 3]; 3], [zero; 3]);
        for i in 0..n {
            let mut fi = points[i] - y;
            for _ in 0..2 {
                for j in 0..i {
                    let cij = fi.dot(f[j]) / squared[j];
                    fi -= f[j] * cij;
                    c[i][j] += cij;
                }
            }
            f[i] = fi;
            squared[i] = fi.length_squared();
        }
        Self { y, f, c, squared, n }
    }

    /// The last of its points.
    pub(crate) fn corner(&self) -> V {
        self.y
    }

    /// Splits a vector. The coordinates follow from `v = Σ t_i·f_i + across` by back-substitution: with
    /// `v = Σ b_i·e_i + across`, `b_i = t_i − Σ_{k>i} b_k·c_ki`.
    ///
    /// Coordinates are NaN or infinite where the points are affinely dependent.
    pub(crate) fn project(&self, v: V) -> Projection<V> {
        let zero = V::Scalar::ZERO;
        let mut across = v;
        let mut t = [zero; 3];
        for _ in 0..2 {
            for (ti, (&fi, &squared)) in t.iter_mut().zip(self.f.iter().zip(&self.squared)).take(self.n) {
                let part = across.dot(fi) / squared;
                across -= fi * part;
                *ti += part;
            }
        }
        let mut b = [zero; MAX_POINTS];
        let mut rest = V::Scalar::ONE;
        for i in (0..self.n).rev() {
            b[i] = t[i];
            for k in i + 1..self.n {
                b[i] -= b[k] * self.c[k][i];
            }
            rest -= b[i];
        }
        b[self.n] = rest;
        Projection { across, coordinates: b }
    }
}
