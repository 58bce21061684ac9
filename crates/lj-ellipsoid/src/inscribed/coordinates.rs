//! Coordinates in which a body is round, however thin it is.
//!
//! x = o + M·z, and the body { x : aᵢ·x ≤ bᵢ } is { z : pᵢ·z ≤ sᵢ } with pᵢ = Mᵀaᵢ and sᵢ = bᵢ − aᵢ·o. For a body t
//! thick and one wide, turned against the axes, the components of p and s are of size t and differences of products of
//! size one. So o and M are taken to be *exactly* their doubles, and p and s are computed in twice the precision: then
//! the problem in z is that of the given body, and its data are as good as doubles can be, at any thickness.
//!
//! M is kept as M = Rᵀ·diag(a), R orthonormal to rounding: a product with a general matrix on the right would lose its
//! short columns in the long ones.

use crate::inscribed::polyhedron::Polyhedron;
use crate::numerics::dimension::Dimension;
use crate::numerics::linalg::{
    UNIT_ROUNDOFF, dot, logarithms, orthogonalize_rows, power_of_two_inverse, triangularize,
};
use crate::numerics::twofold;

/// If terms are this many times as large as their sum, they cancel: then twice the precision is worth its cost.
const CANCELLING: f64 = 8.0;

/// Rounds of single moves to a point inside with coordinates in doubles.
const MOST_MOVES: usize = 16;

/// The map x = o + Rᵀ·diag(a)·z.
#[derive(Clone, Debug)]
pub(crate) struct Coordinates {
    /// o.
    pub(crate) origin: Vec<f64>,
    /// R, row by row: row k is the direction of the length aₖ.
    pub(crate) axes: Vec<f64>,
    /// a, longest first after a stretch.
    pub(crate) lengths: Vec<f64>,
}

/// A body { z : pᵢ·z ≤ sᵢ } in some coordinates.
#[derive(Clone, Debug)]
pub(crate) struct Rows {
    pub(crate) n: usize,
    pub(crate) p: Vec<f64>,
    pub(crate) s: Vec<f64>,
    /// Bounds on the errors of pᵢ and sᵢ, relative to their own sizes, beyond a rounding of each.
    pub(crate) error: Vec<f64>,
}

impl Rows {
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&[f64], f64)> {
        self.p.chunks_exact(self.n).zip(self.s.iter().copied())
    }
}

impl Coordinates {
    /// x = z, in n dimensions.
    pub(crate) fn identity(n: usize) -> Self {
        let axes = (0..n * n).map(|at| if at % (n + 1) == 0 { 1.0 } else { 0.0 }).collect();
        Self { origin: vec![0.0; n], axes, lengths: vec![1.0; n] }
    }

    /// The half-spaces in these coordinates.
    pub(crate) fn rows<D: Dimension>(&self, dim: D, polyhedron: &Polyhedron) -> Rows {
        let (n, m) = (dim.get(), polyhedron.len());
        let columns = self.columns();
        let mut rows = Rows { n, p: vec![0.0; n * m], s: Vec::with_capacity(m), error: Vec::with_capacity(m) };
        for (p, (a, b)) in rows.p.chunks_exact_mut(n).zip(polyhedron.rows()) {
            let (s, error) = self.row(dim, &columns, a, b, p);
            rows.s.push(s);
            rows.error.push(error);
        }
        rows
    }

    /// Writes pᵢ, and returns sᵢ with a bound on the relative errors of both.
    #[inline(always)]
    fn row<D: Dimension>(&self, dim: D, columns: &[f64], a: &[f64], b: f64, p: &mut [f64]) -> (f64, f64) {
        let n = dim.get();
        let (columns, origin, a, p) = (&columns[..n * n], &self.origin[..n], &a[..n], &mut p[..n]);
        let plain = (n as f64 + 2.0) * UNIT_ROUNDOFF;
        // The largest |pₖ|, a lower bound of |p|, and the largest Σᵢ|Mᵢₖaᵢ|: √n times that is an upper bound of the
        // error.
        let (mut largest, mut size): (f64, f64) = (0.0, 0.0);
        let (mut s, mut size_of_s) = (b, b.abs());
        for k in 0..n {
            let column = &columns[k * n..(k + 1) * n];
            let (mut along, mut sum) = (0.0, 0.0);
            for i in 0..n {
                let term = column[i] * a[i];
                along += term;
                sum += term.abs();
            }
            p[k] = along;
            (largest, size) = (largest.max(along.abs()), size.max(sum));
            let term = a[k] * origin[k];
            s -= term;
            size_of_s += term.abs();
        }
        let (mut error, mut error_of_s) = (plain, plain);
        if !(size <= CANCELLING * largest) {
            for (p, column) in p.iter_mut().zip(columns.chunks_exact(n)) {
                *p = twofold::dot(column.iter().copied().zip(a.iter().copied()));
            }
            largest = p.iter().fold(0.0, |m: f64, p| m.max(p.abs()));
            error = plain * plain;
        }
        if !(size_of_s <= CANCELLING * s.abs()) {
            let against = a.iter().zip(origin).map(|(a, o)| (*a, -o));
            s = twofold::dot([(b, 1.0)].into_iter().chain(against));
            error_of_s = plain * plain;
        }
        (s, error * (n as f64).sqrt() * (size / largest) + error_of_s * (size_of_s / s.abs()))
    }

    /// No less than ln|det M|, or than −ln|det M⁻¹| for M⁻¹ = diag(1/a)·R, with the lengths a in a unit.
    ///
    /// With R·Rᵀ = I + D, |D| ≤ δ the largest sum of a row, |det R| is within N·δ of one; so is that of R with entries
    /// rounded.
    pub(crate) fn log_det_at_most(&self, per_unit: f64) -> f64 {
        let n = self.origin.len();
        let defect = |i: usize, j: usize| {
            let (a, b) = (&self.axes[i * n..(i + 1) * n], &self.axes[j * n..(j + 1) * n]);
            let product = a.iter().copied().zip(b.iter().copied());
            twofold::dot(product.chain([(if i == j { -1.0 } else { 0.0 }, 1.0)])).abs()
        };
        let delta = (0..n).map(|i| (0..n).map(|j| defect(i, j)).sum::<f64>()).fold(0.0, f64::max);
        let [sum, size] = logarithms(&self.lengths, per_unit);
        sum + n as f64 * delta + (n * n) as f64 * UNIT_ROUNDOFF + 2.0 * UNIT_ROUNDOFF * (size + n as f64)
    }

    /// The columns aₖ·rₖ of M, one after the other.
    fn columns(&self) -> Vec<f64> {
        let n = self.origin.len();
        self.axes.chunks_exact(n).zip(&self.lengths).flat_map(|(axis, a)| axis.iter().map(move |x| a * x)).collect()
    }

    /// o ← o + M·z, rounded once: an intermediate sum may be far larger than the result across a thin body.
    pub(crate) fn shift(&mut self, z: &[f64]) {
        let n = z.len();
        let columns = self.columns();
        for (i, o) in self.origin.iter_mut().enumerate() {
            let terms = columns.iter().skip(i).step_by(n).copied().zip(z.iter().copied());
            *o = twofold::dot([(*o, 1.0)].into_iter().chain(terms));
        }
    }

    /// The shortest length over the longest.
    pub(crate) fn aspect(&self) -> f64 {
        let least = self.lengths.iter().copied().fold(f64::INFINITY, f64::min);
        least / self.lengths.iter().copied().fold(0.0, f64::max)
    }

    /// M·z, to rounding.
    pub(crate) fn image(&self, z: &[f64]) -> Vec<f64> {
        let columns = self.columns();
        let along = |i: usize| columns.iter().skip(i).step_by(z.len()).copied().zip(z.iter().copied());
        (0..z.len()).map(|i| twofold::dot(along(i))).collect()
    }

    /// Moves the origin, from where it is or from `earlier`, by single spacings of its doubles to where the least slack
    /// is largest. A body may be so thin that it contains few points of doubles, and the one nearest to its centre need
    /// not be one of them.
    pub(crate) fn settle<D: Dimension>(&mut self, dim: D, polyhedron: &Polyhedron, earlier: &[f64]) {
        let least = |coordinates: &Self| {
            coordinates
                .rows(dim, polyhedron)
                .s
                .into_iter()
                .zip(polyhedron.rows())
                .fold(f64::INFINITY, |m, (s, (a, _))| m.min(s / dot(a, a).sqrt()))
        };
        let mut best = least(self);
        let mut consider = |this: &mut Self, origin: Vec<f64>| {
            let before = std::mem::replace(&mut this.origin, origin);
            let now = least(this);
            let better = now > best;
            if better {
                best = now;
            } else {
                this.origin = before;
            }
            better
        };
        consider(self, earlier.to_vec());
        let n = self.origin.len();
        for _ in 0..MOST_MOVES {
            let mut moved = false;
            for (i, j) in (0..n).flat_map(|i| (i..n).map(move |j| (i, j))) {
                for (up, other) in [(true, true), (true, false), (false, true), (false, false)] {
                    let mut origin = self.origin.clone();
                    let step = |x: f64, up: bool| if up { x.next_up() } else { x.next_down() };
                    origin[i] = step(origin[i], up);
                    if j != i {
                        origin[j] = step(origin[j], other);
                    }
                    moved |= consider(self, origin);
                }
            }
            if !moved {
                break;
            }
        }
    }

    /// M ← M·C up to a rotation from the right: the unit ball of the new coordinates is the image under C of the unit
    /// ball of the old ones.
    ///
    /// diag(a)·C = U·Σ·Vᵀ. For T = Cᵀ·diag(a), whose columns are graded, Householder's and Jacobi's methods find Σ and
    /// Uᵀ to high relative accuracy, and M·C·V = (Rᵀ·U)·Σ.
    pub(crate) fn stretch<D: Dimension>(&mut self, dim: D, c: &[f64]) {
        let n = dim.get();
        let mut t = dim.matrix((0..n * n).map(|at| c[at % n * n + at / n] * self.lengths[at % n]));
        let t = &mut t.as_mut()[..n * n];
        // A power of two keeps the squares in range and changes no mantissa.
        let unit = power_of_two_inverse(t.iter().fold(0.0, |m: f64, x| m.max(x.abs())));
        t.iter_mut().for_each(|x| *x *= unit);
        triangularize(dim, t);
        orthogonalize_rows(dim, t);
        let mut sigma = dim.point(t.chunks_exact(n).map(|row| dot(row, row).sqrt()));
        let sigma = &mut sigma.as_mut()[..n];
        let mut axes = dim.zero_matrix();
        for k in 0..n {
            // The longest first: the direction of a long axis matters to a thin body, that of a short one does not.
            let longest = (1..n).fold(0, |best, j| if sigma[j] > sigma[best] { j } else { best });
            let (earlier, rest) = axes.as_mut()[..n * n].split_at_mut(k * n);
            let axis = &mut rest[..n];
            for (u, r) in t[longest * n..(longest + 1) * n].iter().zip(self.axes.chunks_exact(n)) {
                axis.iter_mut().zip(r).for_each(|(x, r)| *x += u / sigma[longest] * r);
            }
            for earlier in earlier.chunks_exact(n) {
                let along = dot(earlier, axis);
                axis.iter_mut().zip(earlier).for_each(|(x, e)| *x -= along * e);
            }
            let norm = dot(axis, axis).sqrt();
            axis.iter_mut().for_each(|x| *x /= norm);
            self.lengths[k] = sigma[longest] / unit;
            sigma[longest] = -1.0;
        }
        self.axes.copy_from_slice(&axes.as_ref()[..n * n]);
    }

    /// The ellipsoid of this centre, these axes and semi-axes in the coordinates y = diag(1/a)·R·(x − o): its centre,
    /// and E such that the ellipsoid is { d + Eᵀ·u : |u| ≤ 1 }, both with bounds on their errors beyond three roundings
    /// of each number.
    #[expect(clippy::type_complexity, reason = "two arrays of numbers with errors")]
    pub(crate) fn seen(&self, center: &[f64], axes: &[f64], semi_axes: &[f64]) -> (Vec<(f64, f64)>, Vec<(f64, f64)>) {
        let n = center.len();
        let rows = || self.axes.chunks_exact(n).zip(&self.lengths);
        let scaled = |(x, error): (f64, f64), factor: f64, length: f64| (factor * x / length, factor * error / length);
        let along = |r: &[f64], x: &[f64]| r.iter().copied().zip(x.iter().copied()).collect::<Vec<_>>();
        let d = rows().map(|(r, length)| {
            let from_origin = r.iter().zip(&self.origin).map(|(r, o)| (*r, -o));
            scaled(twofold::dot_with_error(along(r, center).into_iter().chain(from_origin)), 1.0, *length)
        });
        let e = axes.chunks_exact(n).zip(semi_axes).flat_map(|(axis, a)| {
            rows().map(move |(r, length)| scaled(twofold::dot_with_error(along(r, axis)), *a, *length))
        });
        (d.collect(), e.collect())
    }
}
