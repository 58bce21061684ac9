//! Weighted points: the dual of the enclosing ellipsoid.
//!
//! Weights u ≥ 0 with Σu = 1 on k points yᵢ give the mean c = Σuᵢyᵢ and the scatter S = Σuᵢ(yᵢ − c)(yᵢ − c)ᵀ. In the
//! lifted problem, with qᵢ = (yᵢ; 1) and M = Σuᵢqᵢqᵢᵀ, the quantities of every method follow without forming M:
//!
//! > det M = det S, qᵢᵀM⁻¹qⱼ = 1 + zᵢ·zⱼ, ωᵢ = qᵢᵀM⁻¹qᵢ = 1 + |zᵢ|², where z = L⁻¹(y − c), S = L·Lᵀ.
//!
//! All weights certify: an ellipsoid that contains the points has ln det X ≤ −ln det S − N·ln N. (Averaging (yᵢ −
//! c')ᵀX(yᵢ − c') ≤ 1 with u gives tr(X·S) ≤ 1, and det(X·S) ≤ (tr(X·S)/N)^N by the inequality of the means.)

use crate::numerics::dimension::Dimension;
use crate::numerics::linalg::{cholesky_log_det, dot, solve_lower};

/// The least remainder of a diagonal entry of the scatter, relative to it, that is more than rounding: some ninety
/// units of the last place. If less remains, all points with weight may lie in one plane.
const PLANE: f64 = 1e-14;

/// The quantities that follow from the weights of a working set.
#[derive(Clone, Debug)]
pub(crate) struct Moments<D: Dimension> {
    rank: D,
    /// c, the weighted mean.
    mean: D::Point,
    /// L, the Cholesky factor of the scatter S; its upper triangle is not used.
    pub(crate) factor: D::Matrix,
    pub(crate) log_det_scatter: f64,
    /// zᵢ = L⁻¹(yᵢ − c).
    pub(crate) z: Vec<f64>,
    /// |zᵢ|² = ωᵢ − 1.
    pub(crate) q: Vec<f64>,
}

impl<D: Dimension> Moments<D> {
    /// The moments before the first computation.
    pub(crate) fn new(rank: D) -> Self {
        let (z, q) = (Vec::new(), Vec::new());
        Self { rank, mean: rank.zero(), factor: rank.zero_matrix(), log_det_scatter: 0.0, z, q }
    }

    /// Computes everything from the points `y` and weights `u`; false if the points with weight span no volume, to
    /// rounding.
    pub(crate) fn compute(&mut self, y: &[f64], u: &[f64]) -> bool {
        self.compute_scatter(y, u) && {
            self.compute_distances(y);
            true
        }
    }

    /// Mean, scatter and determinant only.
    #[inline(always)]
    pub(crate) fn compute_scatter(&mut self, y: &[f64], u: &[f64]) -> bool {
        let rank = self.rank;
        let r = rank.get();
        let (mean, factor) = (&mut self.mean.as_mut()[..r], &mut self.factor.as_mut()[..r * r]);
        mean.fill(0.0);
        factor.fill(0.0);
        let share = 1.0 / u.iter().sum::<f64>();
        for (y, &u) in y.chunks_exact(r).zip(u) {
            for k in 0..r {
                mean[k] += u * share * y[k];
            }
        }
        let mut d = rank.zero();
        let d = &mut d.as_mut()[..r];
        for (y, &u) in y.chunks_exact(r).zip(u) {
            if u == 0.0 {
                continue;
            }
            for k in 0..r {
                d[k] = y[k] - mean[k];
            }
            for i in 0..r {
                let weighted = u * share * d[i];
                for k in 0..=i {
                    factor[i * r + k] += weighted * d[k];
                }
            }
        }
        let log_det = cholesky_log_det(rank, factor).filter(|_| spans_volume(r, mean, factor));
        self.log_det_scatter = log_det.unwrap_or(f64::NEG_INFINITY);
        log_det.is_some()
    }

    #[inline(always)]
    pub(crate) fn compute_distances(&mut self, y: &[f64]) {
        let rank = self.rank;
        let r = rank.get();
        let (mean, factor) = (&self.mean.as_ref()[..r], &self.factor.as_ref()[..r * r]);
        self.z.resize(y.len(), 0.0);
        self.q.resize(y.len() / r, 0.0);
        for ((z, y), q) in self.z.chunks_exact_mut(r).zip(y.chunks_exact(r)).zip(&mut self.q) {
            for k in 0..r {
                z[k] = y[k] - mean[k];
            }
            solve_lower(rank, factor, z);
            *q = dot(z, z);
        }
    }

    /// Copies mean, scatter and determinant.
    pub(crate) fn take_scatter(&mut self, other: &Self) {
        self.mean.clone_from(&other.mean);
        self.factor.clone_from(&other.factor);
        self.log_det_scatter = other.log_det_scatter;
    }

    /// Drops the members for which `keep(|z|²)` does not hold; they have no weight, so nothing else changes.
    pub(crate) fn retain(&mut self, mut keep: impl FnMut(f64) -> bool) {
        let r = self.rank.get();
        let mut kept = 0;
        for i in 0..self.q.len() {
            if keep(self.q[i]) {
                self.q[kept] = self.q[i];
                self.z.copy_within(i * r..(i + 1) * r, kept * r);
                kept += 1;
            }
        }
        self.q.truncate(kept);
        self.z.truncate(kept * r);
    }

    /// max |zᵢ|², and the index of the point that attains it.
    pub(crate) fn furthest(&self) -> (usize, f64) {
        self.q.iter().enumerate().fold((0, f64::NEG_INFINITY), |best, (i, &q)| if q > best.1 { (i, q) } else { best })
    }

    /// N·ln(κ/N), κ = max |zᵢ|²: a bound on ln det X* − ln det X for the ellipsoid X = E(c, S⁻¹/κ) and the points of
    /// the working set. Below zero only by rounding.
    pub(crate) fn log_det_gap(&self) -> f64 {
        let r = self.rank.get() as f64;
        r * libm::log(self.furthest().1 / r)
    }
}

/// Whether each pivot Lᵢᵢ² of S = L·Lᵀ is more than the rounding of its diagonal entry, Sᵢᵢ = Σₖ Lᵢₖ², which is itself
/// a sum of squares of differences of coordinates as large as the mean.
fn spans_volume(r: usize, mean: &[f64], factor: &[f64]) -> bool {
    factor.chunks_exact(r).zip(mean).enumerate().all(|(i, (row, mean))| {
        let diagonal = dot(&row[..=i], &row[..=i]);
        row[i] * row[i] > PLANE * (diagonal + PLANE * mean * mean)
    })
}
