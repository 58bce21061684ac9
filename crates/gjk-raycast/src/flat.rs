//! The affine hull of up to four points.

use core::cmp::Ordering;

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::simplex::MAX_POINTS;

/// The affine hull of a few points, by an orthogonal basis of it.
///
/// With the point `y` nearest to zero and edges `e_i = y_i − y`, nearer ones first, the edges are made orthogonal by
/// Gram–Schmidt:
///
/// ```text
/// f_i = e_i − Σ_{j<i} c_ij·f_j,   c_ij = e_i·f_j / f_j·f_j.
/// ```
///
/// Every projection is done twice. After that it is orthogonal to rounding even where nearly everything cancels, so that
/// a short vector from a far simplex keeps its direction; and only squares of lengths occur, no products of four.
///
/// The order is for simplices with a side that zero is near to and a corner far away, as near contact. That corner's share of
/// zero's foot is as small as the square of the distance, yet it turns the shortest vector. Being last, it is the one
/// coordinate that nothing is subtracted from; from the far corner itself it would be one less the others, and lost.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flat<V: Vector> {
    y: V,
    /// The places of `y` and of the ends of the edges among the points.
    order: [usize; MAX_POINTS],
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
    /// The barycentric coordinates of `y` plus the part along the flat, in the order that the points were given in.
    pub(crate) coordinates: [V::Scalar; MAX_POINTS],
}

impl<V: Vector> Flat<V> {
    /// The affine hull of one to four points.
    pub(crate) fn new(points: &[V]) -> Self {
        let zero = V::Scalar::ZERO;
        let n = points.len() - 1;
        let mut order = [0, 1, 2, 3];
        let distance = |i: usize| points[i].length_squared();
        order[..=n].sort_unstable_by(|&i, &j| distance(i).partial_cmp(&distance(j)).unwrap_or(Ordering::Equal));
        let y = points[order[0]];
        let (mut f, mut c, mut squared) = ([V::ZERO; 3], [[zero; 3]; 3], [zero; 3]);
        for i in 0..n {
            let mut fi = points[order[i + 1]] - y;
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
        Self { y, order, f, c, squared, n }
    }

    /// The point of it that is nearest to zero.
    pub(crate) fn corner(&self) -> V {
        self.y
    }

    /// The least height of a segment or triangle: its length; twice its area over its longest edge. No meaning otherwise.
    pub(crate) fn width(&self) -> V::Scalar {
        let [first, height, _] = self.squared;
        if self.n < 2 {
            return first.sqrt();
        }
        // The second edge, and the one from the first's end to the second's, are this far along the first.
        let share = self.c[1][0];
        let beyond = share - V::Scalar::ONE;
        let longest = first.max(height + first * share * share).max(height + first * beyond * beyond);
        (first * height / longest).sqrt()
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
        let mut b = [zero; 3];
        let mut coordinates = [zero; MAX_POINTS];
        let mut rest = V::Scalar::ONE;
        for i in (0..self.n).rev() {
            b[i] = t[i];
            for k in i + 1..self.n {
                b[i] -= b[k] * self.c[k][i];
            }
            coordinates[self.order[i + 1]] = b[i];
            rest -= b[i];
        }
        coordinates[self.order[0]] = rest;
        Projection { across, coordinates }
    }
}
