//! Coordinates in which a body is round, however thin it is.
//!
//! x = o + M·z, and the body { x : aᵢ·x ≤ bᵢ } is { z : pᵢ·z ≤ sᵢ } with pᵢ = Mᵀaᵢ and sᵢ = bᵢ − aᵢ·o. Of a body t thick and one
//! wide, turned against the axes, the components of p and s are t in size and differences of products of size one. So o and M
//! are taken to be *exactly* the doubles that stand for them, and p and s are computed in twice the precision: then the
//! problem in z is that of the body as given, and its data are as good as doubles can be, at any thickness.
//!
//! M is kept as M = Rᵀ·diag(a), R orthonormal to rounding: as a product with a general matrix on the right it would
//! lose its short columns in the long ones.

use crate::inscribed::polyhedron::Polyhedron;
use crate::numerics::dimension::Dynamic;
use crate::numerics::linalg::{UNIT_ROUNDOFF, dot, orthogonalize_rows, power_of_two_inverse, triangularize};
use crate::numerics::twofold;

/// Terms this many times as large as their sum cancel: then twice the precision is worth its price.
const CANCELLING: f64 = 8.0;

/// The map x = o + Rᵀ·diag(a)·z.
#[derive(Clone, Debug)]
pub(crate) struct Coordinates {
    /// o.
    pub(crate) origin: Vec<f64>,
    /// R, row by row: row k is the direction of the length aₖ.
    pub(crate) axes: Vec<f64>,
    /// a, longest first once they were stretched.
    pub(crate) lengths: Vec<f64>,
}

/// A body { z : pᵢ·z ≤ sᵢ } in some coordinates.
#[derive(Clone, Debug)]
pub(crate) struct Rows {
    pub(crate) n: usize,
    pub(crate) p: Vec<f64>,
    pub(crate) s: Vec<f64>,
    /// A bound on the error of every pᵢ and sᵢ, relative to their own size, beyond a rounding of each.
    pub(crate) error: f64,
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
    pub(crate) fn rows(&self, polyhedron: &Polyhedron) -> Rows {
        let n = polyhedron.n;
        let columns = self.columns();
        let mut rows = Rows {
            n,
            p: Vec::with_capacity(polyhedron.normals.len()),
            s: Vec::with_capacity(polyhedron.len()),
            error: 0.0,
        };
        let twofold_error = ((n + 2) as f64 * UNIT_ROUNDOFF).powi(2);
        for (a, b) in polyhedron.rows() {
            let (mut largest, mut size): (f64, f64) = (0.0, 0.0);
            for column in columns.chunks_exact(n) {
                let (mut along, mut terms) = (0.0, 0.0);
                for (m, a) in column.iter().zip(a) {
                    along += m * a;
                    terms += (m * a).abs();
                }
                rows.p.push(along);
                largest = largest.max(along.abs());
                size += terms;
            }
            let mut error = (n as f64 + 1.0) * UNIT_ROUNDOFF * (size / largest);
            if !(size <= CANCELLING * largest) {
                let start = rows.p.len() - n;
                for (p, column) in rows.p[start..].iter_mut().zip(columns.chunks_exact(n)) {
                    *p = twofold::dot(column.iter().copied().zip(a.iter().copied()));
                }
                error = size / rows.p[start..].iter().fold(0.0, |m: f64, p| m.max(p.abs())) * twofold_error;
            }
            let against = a.iter().zip(&self.origin).map(|(a, o)| (*a, -o));
            let s = twofold::dot([(b, 1.0)].into_iter().chain(against));
            let size = b.abs() + a.iter().zip(&self.origin).map(|(a, o)| (a * o).abs()).sum::<f64>();
            rows.s.push(s);
            rows.error = rows.error.max(error + size / s.abs() * twofold_error);
        }
        rows
    }

    /// The columns aₖ·rₖ of M, one after the other.
    fn columns(&self) -> Vec<f64> {
        let n = self.origin.len();
        self.axes.chunks_exact(n).zip(&self.lengths).flat_map(|(axis, a)| axis.iter().map(move |x| a * x)).collect()
    }

    /// o ← o + M·z, rounded once: an intermediate sum may be far larger than what is left of it across a thin body.
    pub(crate) fn shift(&mut self, z: &[f64]) {
        let n = z.len();
        let columns = self.columns();
        for (i, o) in self.origin.iter_mut().enumerate() {
            let terms = columns.iter().skip(i).step_by(n).copied().zip(z.iter().copied());
            *o = twofold::dot([(*o, 1.0)].into_iter().chain(terms));
        }
    }

    /// M ← M·C up to a rotation from the right: the unit ball of the new coordinates is the image of what C makes of the unit
    /// ball of the old ones.
    ///
    /// diag(a)·C = U·Σ·Vᵀ. Of T = Cᵀ·diag(a), whose columns are graded, Householder's and Jacobi's methods find Σ and Uᵀ to high
    /// relative accuracy, and M·C·V = (Rᵀ·U)·Σ.
    pub(crate) fn stretch(&mut self, c: &[f64]) {
        let n = self.lengths.len();
        let mut t: Vec<f64> = (0..n * n).map(|at| c[at % n * n + at / n] * self.lengths[at % n]).collect();
        // A power of two keeps the squares in range and moves no bit.
        let unit = power_of_two_inverse(t.iter().fold(0.0, |m: f64, x| m.max(x.abs())));
        t.iter_mut().for_each(|x| *x *= unit);
        triangularize(Dynamic(n), &mut t);
        orthogonalize_rows(Dynamic(n), &mut t);
        let mut rows: Vec<(f64, &[f64])> = t.chunks_exact(n).map(|row| (dot(row, row).sqrt(), row)).collect();
        rows.sort_by(|x, y| y.0.total_cmp(&x.0));
        let mut axes: Vec<f64> = Vec::with_capacity(n * n);
        for (k, (length, row)) in rows.iter().enumerate() {
            self.lengths[k] = length / unit;
            let mut axis: Vec<f64> = (0..n)
                .map(|i| row.iter().zip(self.axes.chunks_exact(n)).map(|(u, r)| u / length * r[i]).sum())
                .collect();
            // The longest first: the direction of a long axis matters to a thin body, that of a short one does not.
            for earlier in axes.chunks_exact(n) {
                let along = dot(earlier, &axis);
                axis.iter_mut().zip(earlier).for_each(|(x, e)| *x -= along * e);
            }
            let norm = dot(&axis, &axis).sqrt();
            axes.extend(axis.iter().map(|x| x / norm));
        }
        self.axes = axes;
    }

    /// The ellipsoid of this centre, these axes and semi-axes in these coordinates: its centre, and E with the ellipsoid being
    /// { d + Eᵀ·u : |u| ≤ 1 }.
    pub(crate) fn seen(&self, center: &[f64], axes: &[f64], semi_axes: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let n = center.len();
        let along = |axis: &[f64], a: f64| {
            self.axes
                .chunks_exact(n)
                .zip(&self.lengths)
                .map(|(r, length)| a * twofold::dot(r.iter().copied().zip(axis.iter().copied())) / length)
                .collect::<Vec<f64>>()
        };
        let d = self
            .axes
            .chunks_exact(n)
            .zip(&self.lengths)
            .map(|(r, length)| {
                let to = r.iter().copied().zip(center.iter().copied());
                twofold::dot(to.chain(r.iter().zip(&self.origin).map(|(r, o)| (*r, -o)))) / length
            })
            .collect();
        (d, axes.chunks_exact(n).zip(semi_axes).flat_map(|(axis, a)| along(axis, *a)).collect())
    }
}
