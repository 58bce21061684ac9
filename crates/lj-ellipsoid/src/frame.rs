//! The coordinates in which an iterate is computed.

use crate::dimension::Dimension;
use crate::linalg::solve_lower;

/// The affine map y = T·(v − o) from the N coordinates of the points to the r coordinates of an iterate; r = N unless
/// the points are flat, and then r is the dimension of their affine hull.
///
/// The problem is affine invariant, so every step is taken where the current ellipsoid is the unit ball: no iterate ever
/// meets the condition of the data.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    /// o, in the coordinates of the points.
    pub(crate) origin: Vec<f64>,
    /// T, r rows of N.
    pub(crate) map: Vec<f64>,
}

impl Frame {
    pub(crate) fn rank(&self) -> usize {
        self.map.len() / self.origin.len()
    }

    /// y = T·(v − o); overwrites `v` by v − o.
    #[inline(always)]
    pub(crate) fn apply<N: Dimension, R: Dimension>(&self, ambient: N, rank: R, v: &mut [f64], y: &mut [f64]) {
        let (n, r) = (ambient.get(), rank.get());
        let (origin, map) = (&self.origin[..n], &self.map[..r * n]);
        for k in 0..n {
            v[k] -= origin[k];
        }
        for i in 0..r {
            let mut sum = 0.0;
            for k in 0..n {
                sum += map[i * n + k] * v[k];
            }
            y[i] = sum;
        }
    }

    /// Moves the frame to where the ellipsoid (y − c)ᵀ(L·Lᵀ)⁻¹(y − c) ≤ 1 of this one is the unit ball:
    /// T ← L⁻¹·T, and o ← o + Tᵀ(T·Tᵀ)⁻¹c, found here as the combination of `points` with `weights` that c is.
    pub(crate) fn recenter<R: Dimension>(&mut self, rank: R, origin: Vec<f64>, l: &[f64]) {
        let n = self.origin.len();
        let r = rank.get();
        self.origin = origin;
        let mut column = vec![0.0; r];
        for k in 0..n {
            for i in 0..r {
                column[i] = self.map[i * n + k];
            }
            solve_lower(rank, l, &mut column);
            for i in 0..r {
                self.map[i * n + k] = column[i];
            }
        }
    }
}
