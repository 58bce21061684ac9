//! Weighted points: the dual of the enclosing ellipsoid.
//!
//! Weights u ≥ 0 with Σu = 1 on k points yᵢ give the mean c = Σuᵢyᵢ and the scatter S = Σuᵢ(yᵢ − c)(yᵢ − c)ᵀ. In the
//! lifted problem, with qᵢ = (yᵢ; 1) and M = Σuᵢqᵢqᵢᵀ, the quantities of every method follow without forming M:
//!
//! > det M = det S, qᵢᵀM⁻¹qⱼ = 1 + zᵢ·zⱼ, ωᵢ = qᵢᵀM⁻¹qᵢ = 1 + |zᵢ|², where z = L⁻¹(y − c), S = L·Lᵀ.
//!
//! Any weights whatever certify: an ellipsoid that contains the points has ln det X ≤ −ln det S − N·ln N. (Averaging
//! (yᵢ − c')ᵀX(yᵢ − c') ≤ 1 with u gives tr(X·S) ≤ 1, and det(X·S) ≤ (tr(X·S)/N)^N by the inequality of the means.)

use crate::dimension::Dimension;
use crate::frame::Frame;
use crate::linalg::{UNIT_ROUNDOFF, cholesky, dot, solve_lower};
use crate::points::Points;

/// The points an iterate works on, with their weights, in the coordinates of a frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct WorkingSet {
    pub(crate) index: Vec<usize>,
    pub(crate) u: Vec<f64>,
    /// The coordinates, `r` numbers a point.
    pub(crate) y: Vec<f64>,
}

impl WorkingSet {
    pub(crate) fn len(&self) -> usize {
        self.index.len()
    }

    /// Puts the points `index` with equal weights.
    pub(crate) fn uniform(index: Vec<usize>) -> Self {
        let weight = 1.0 / index.len() as f64;
        Self { u: vec![weight; index.len()], y: Vec::new(), index }
    }

    /// Computes the coordinates in `frame` afresh from the points.
    pub(crate) fn locate<P: Points, R: Dimension>(&mut self, points: &P, rank: R, frame: &Frame) {
        let dim = points.dim();
        let r = rank.get();
        self.y.resize(self.len() * r, 0.0);
        let mut v = dim.zero();
        for (&i, y) in self.index.iter().zip(self.y.chunks_exact_mut(r)) {
            points.read(i, v.as_mut());
            frame.apply(dim, rank, v.as_mut(), y);
        }
    }

    /// Appends point `i`, with weight zero.
    pub(crate) fn push(&mut self, i: usize, y: &[f64]) {
        self.index.push(i);
        self.u.push(0.0);
        self.y.extend_from_slice(y);
    }

    /// Keeps the members for which `keep(position)` holds.
    pub(crate) fn retain(&mut self, r: usize, mut keep: impl FnMut(usize) -> bool) {
        let mut kept = 0;
        for i in 0..self.len() {
            if keep(i) {
                self.index[kept] = self.index[i];
                self.u[kept] = self.u[i];
                self.y.copy_within(i * r..(i + 1) * r, kept * r);
                kept += 1;
            }
        }
        self.index.truncate(kept);
        self.u.truncate(kept);
        self.y.truncate(kept * r);
    }

    /// The weighted mean of the points themselves, formed from differences to the frame's origin.
    pub(crate) fn mean<P: Points>(&self, points: &P, frame: &Frame) -> Vec<f64> {
        let dim = points.dim();
        let n = dim.get();
        let mut v = dim.zero();
        let mut shift = vec![0.0; n];
        for (&i, &u) in self.index.iter().zip(&self.u) {
            if u > 0.0 {
                points.read(i, v.as_mut());
                for k in 0..n {
                    shift[k] += u * (v.as_ref()[k] - frame.origin[k]);
                }
            }
        }
        frame.origin.iter().zip(&shift).map(|(o, s)| o + s).collect()
    }

    /// A bound on |δy| over the weighted members, y + δy being the exact image of the point: each coordinate is a
    /// subtraction and a dot product of `n` terms, so |δyᵢ| ≤ (n + 2)u·Σₖ|Tᵢₖ||vₖ − oₖ|.
    pub(crate) fn coordinate_error<P: Points>(&self, points: &P, frame: &Frame) -> f64 {
        let dim = points.dim();
        let n = dim.get();
        let mut v = dim.zero();
        let mut worst: f64 = 0.0;
        for (&i, _) in self.index.iter().zip(&self.u).filter(|(_, u)| **u > 0.0) {
            points.read(i, v.as_mut());
            let error: f64 = frame
                .map
                .chunks_exact(n)
                .map(|row| (0..n).map(|k| row[k].abs() * (v.as_ref()[k] - frame.origin[k]).abs()).sum::<f64>().powi(2))
                .sum();
            worst = worst.max(error);
        }
        (n + 2) as f64 * UNIT_ROUNDOFF * worst.sqrt()
    }
}

/// What follows from the weights of a working set.
#[derive(Debug, Default)]
pub(crate) struct Moments {
    /// c, the weighted mean.
    pub(crate) mean: Vec<f64>,
    /// L, the Cholesky factor of the scatter S; its upper triangle is not used.
    pub(crate) factor: Vec<f64>,
    pub(crate) log_det_scatter: f64,
    /// zᵢ = L⁻¹(yᵢ − c).
    pub(crate) z: Vec<f64>,
    /// |zᵢ|² = ωᵢ − 1.
    pub(crate) q: Vec<f64>,
}

impl Moments {
    /// Computes everything from the points `y` and weights `u`; false where the scatter is not positive definite.
    pub(crate) fn compute<R: Dimension>(&mut self, rank: R, y: &[f64], u: &[f64]) -> bool {
        self.compute_scatter(rank, y, u) && {
            self.compute_distances(rank, y);
            true
        }
    }

    /// Mean, scatter and determinant only.
    #[inline(always)]
    pub(crate) fn compute_scatter<R: Dimension>(&mut self, rank: R, y: &[f64], u: &[f64]) -> bool {
        let r = rank.get();
        self.mean.clear();
        self.mean.resize(r, 0.0);
        self.factor.clear();
        self.factor.resize(r * r, 0.0);
        let total: f64 = u.iter().sum();
        for (y, &u) in y.chunks_exact(r).zip(u) {
            for k in 0..r {
                self.mean[k] += u / total * y[k];
            }
        }
        let mut d = rank.zero();
        let d = d.as_mut();
        for (y, &u) in y.chunks_exact(r).zip(u) {
            if u == 0.0 {
                continue;
            }
            for k in 0..r {
                d[k] = y[k] - self.mean[k];
            }
            for i in 0..r {
                let weighted = u / total * d[i];
                for k in 0..=i {
                    self.factor[i * r + k] += weighted * d[k];
                }
            }
        }
        match cholesky(rank, &mut self.factor) {
            Some(log_det) => {
                self.log_det_scatter = log_det;
                true
            }
            None => false,
        }
    }

    #[inline(always)]
    pub(crate) fn compute_distances<R: Dimension>(&mut self, rank: R, y: &[f64]) {
        let r = rank.get();
        self.z.resize(y.len(), 0.0);
        self.q.clear();
        self.q.reserve(y.len() / r);
        for (z, y) in self.z.chunks_exact_mut(r).zip(y.chunks_exact(r)) {
            for k in 0..r {
                z[k] = y[k] - self.mean[k];
            }
            solve_lower(rank, &self.factor, z);
            self.q.push(dot(z, z));
        }
    }

    /// max |zᵢ|², and who attains it.
    pub(crate) fn furthest(&self) -> (usize, f64) {
        self.q.iter().enumerate().fold((0, f64::NEG_INFINITY), |best, (i, &q)| if q > best.1 { (i, q) } else { best })
    }

    /// N·ln(κ/N), κ = max |zᵢ|²: a bound on ln det X* − ln det X where E(c, S⁻¹/κ) is the ellipsoid X and the points are
    /// those of the working set. Below zero only by rounding.
    pub(crate) fn log_det_gap(&self, r: usize) -> f64 {
        r as f64 * (self.furthest().1 / r as f64).ln()
    }
}
