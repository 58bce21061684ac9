//! The coordinates in which an iterate is computed.

use crate::numerics::dimension::{Dimension, Dynamic};
use crate::numerics::linalg::solve_lower;

/// The affine map y = T·(v − o) from the N coordinates of the points to the r coordinates of an iterate; r = N unless
/// the points are flat, and then r is the dimension of their affine hull.
///
/// The problem is affine invariant, so every step is taken in coordinates in which the current ellipsoid is the unit
/// ball: the condition of the data does not matter to any iterate.
#[derive(Clone, Debug)]
pub(crate) struct Frame<N: Dimension> {
    /// o, in the coordinates of the points.
    pub(crate) origin: N::Point,
    /// T, in r rows of N; the rest of the matrix is not used.
    rows: N::Matrix,
    rank: usize,
}

impl<N: Dimension> Frame<N> {
    /// The frame with this origin and these rows.
    pub(crate) fn new(origin: N::Point, rows: N::Matrix, rank: usize) -> Self {
        Self { origin, rows, rank }
    }

    /// The same with a dimension known only at run time.
    pub(crate) fn at_run_time(&self) -> Frame<Dynamic> {
        Frame { origin: self.origin.as_ref().to_vec(), rows: self.rows.as_ref().to_vec(), rank: self.rank }
    }

    pub(crate) fn rank(&self) -> usize {
        self.rank
    }

    /// T, row by row.
    #[inline(always)]
    pub(crate) fn map(&self) -> &[f64] {
        &self.rows.as_ref()[..self.rank * self.origin.as_ref().len()]
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.map().iter().chain(self.origin.as_ref()).all(|x| x.is_finite())
    }

    /// y = T·(v − o); overwrites `v` by v − o.
    #[inline(always)]
    pub(crate) fn apply(&self, ambient: N, rank: N, v: &mut [f64], y: &mut [f64]) {
        let (n, r) = (ambient.get(), rank.get());
        let (origin, map) = (&self.origin.as_ref()[..n], &self.rows.as_ref()[..r * n]);
        let (v, y) = (&mut v[..n], &mut y[..r]);
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

    /// Moves to the frame in which this one's ellipsoid (y − c)ᵀ(L·Lᵀ)⁻¹(y − c) ≤ 1 is the unit ball: T ← L⁻¹·T, and o
    /// ← o + Tᵀ(T·Tᵀ)⁻¹c, given by the caller as the combination of points equal to c.
    pub(crate) fn recenter(&mut self, rank: N, origin: N::Point, l: &[f64]) {
        self.origin = origin;
        let n = self.origin.as_ref().len();
        let r = rank.get();
        let rows = self.rows.as_mut();
        let mut column = rank.zero();
        let column = column.as_mut();
        for k in 0..n {
            for i in 0..r {
                column[i] = rows[i * n + k];
            }
            solve_lower(rank, l, column);
            for i in 0..r {
                rows[i * n + k] = column[i];
            }
        }
    }
}
