//! The affine hull of up to four points.

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
/// Every projection is done twice. Then it is orthogonal to rounding even if nearly everything cancels, so that a short
/// vector from a far simplex keeps its direction. Only squares of lengths occur, no products of four.
///
/// The order is for simplices with a side near zero and a corner far away, as near contact. That corner's coordinate of
/// zero's foot is as small as the square of the distance, yet it turns the shortest vector. As the last, it is the one
/// coordinate that nothing is subtracted from; seen from the far corner it would be one less the others, and lost.
pub(crate) struct AffineHull<V: Vector, const EDGES: usize> {
    y: V,
    /// The indices of `y` and of the ends of the edges among the points.
    order: [usize; MAX_POINTS],
    f: [V; EDGES],
    c: [[V::Scalar; EDGES]; EDGES],
    squared: [V::Scalar; EDGES],
}

/// A vector split into a part along the affine hull of some points and a part across it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projection<V: Vector> {
    pub(crate) across: V,
    /// The barycentric coordinates of the starting point of the vector plus the part along the hull, in the order of
    /// the given points.
    pub(crate) coordinates: [V::Scalar; MAX_POINTS],
}

/// Splits the vector that `v` returns for a point of the affine hull of one to four points: the one nearest to zero.
///
/// Coordinates are NaN or infinite if the points are affinely dependent.
#[inline]
pub(crate) fn project<V: Vector>(points: &[V], v: impl FnOnce(V) -> V) -> Projection<V> {
    match points.len() {
        1 => AffineHull::<V, 0>::new(points).project(v),
        2 => AffineHull::<V, 1>::new(points).project(v),
        3 => AffineHull::<V, 2>::new(points).project(v),
        _ => AffineHull::<V, 3>::new(points).project(v),
    }
}

/// The same, compiled once for all who ask rarely.
#[inline(never)]
pub(crate) fn project_rarely<V: Vector>(points: &[V], v: &dyn Fn(V) -> V) -> Projection<V> {
    project(points, v)
}

impl<V: Vector, const EDGES: usize> AffineHull<V, EDGES> {
    /// The hull of one more point than there are edges.
    #[inline(always)]
    pub(crate) fn new(points: &[V]) -> Self {
        let zero = V::Scalar::ZERO;
        let mut order = [0, 1, 2, 3];
        let mut distances = [zero; MAX_POINTS];
        for (distance, point) in distances.iter_mut().zip(&points[..=EDGES]) {
            *distance = point.length_squared();
        }
        for sorted in (1..=EDGES).rev() {
            for i in 0..sorted {
                let (first, second) = (distances[i], distances[i + 1]);
                let swapped = first > second;
                (distances[i], distances[i + 1]) = if swapped { (second, first) } else { (first, second) };
                let (first, second) = (order[i], order[i + 1]);
                (order[i], order[i + 1]) = if swapped { (second, first) } else { (first, second) };
            }
        }
        let y = points[order[0]];
        let (mut f, mut c, mut squared) = ([V::ZERO; EDGES], [[zero; EDGES]; EDGES], [zero; EDGES]);
        for i in 0..EDGES {
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
        Self { y, order, f, c, squared }
    }

    /// The least height of a segment or triangle: its length; twice its area over its longest edge. Zero for a point.
    pub(crate) fn width(&self) -> V::Scalar {
        let squared = |edge: usize| self.squared[edge];
        match EDGES {
            0 => V::Scalar::ZERO,
            1 => squared(0).sqrt(),
            _ => {
                let (first, height) = (squared(0), squared(1));
                // How far the two other edges go along the first.
                let share = self.c[1][0];
                let beyond = share - V::Scalar::ONE;
                let longest = first.max(height + first * share * share).max(height + first * beyond * beyond);
                (first * height / longest).sqrt()
            }
        }
    }

    /// Splits the vector that `v` returns for the point nearest to zero.
    ///
    /// The coordinates follow from `v = Σ t_i·f_i + across` by back-substitution: with `v = Σ b_i·e_i + across`,
    /// `b_i = t_i − Σ_{k>i} b_k·c_ki`.
    #[inline(always)]
    pub(crate) fn project(&self, v: impl FnOnce(V) -> V) -> Projection<V> {
        let zero = V::Scalar::ZERO;
        let mut across = v(self.y);
        let mut t = [zero; EDGES];
        for _ in 0..2 {
            for (ti, (&fi, &squared)) in t.iter_mut().zip(self.f.iter().zip(&self.squared)) {
                let part = across.dot(fi) / squared;
                across -= fi * part;
                *ti += part;
            }
        }
        let mut b = [zero; EDGES];
        let mut coordinates = [zero; MAX_POINTS];
        let mut rest = V::Scalar::ONE;
        for i in (0..EDGES).rev() {
            b[i] = t[i];
            for k in i + 1..EDGES {
                b[i] -= b[k] * self.c[k][i];
            }
            coordinates[self.order[i + 1]] = b[i];
            rest -= b[i];
        }
        coordinates[self.order[0]] = rest;
        Projection { across, coordinates }
    }
}
