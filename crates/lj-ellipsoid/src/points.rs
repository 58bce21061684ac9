//! Where the points come from: a slice of anything that converts into `[f64; N]`, or rows of a matrix.

use crate::dimension::{Const, Dimension};

/// A finite sequence of points, read by copy.
pub(crate) trait Points: Sync {
    /// How much of the dimension the compiler knows.
    type Dim: Dimension + Sync;

    fn dim(&self) -> Self::Dim;

    fn len(&self) -> usize;

    /// Copies point `i` into `out`, whose length is the dimension.
    fn read(&self, i: usize, out: &mut [f64]);
}

/// Points of a dimension known at compile time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PointSlice<'a, P, const N: usize>(pub(crate) &'a [P]);

impl<P: Into<[f64; N]> + Copy + Sync, const N: usize> Points for PointSlice<'_, P, N> {
    type Dim = Const<N>;

    #[inline(always)]
    fn dim(&self) -> Const<N> {
        Const
    }

    #[inline(always)]
    fn len(&self) -> usize {
        self.0.len()
    }

    #[inline(always)]
    fn read(&self, i: usize, out: &mut [f64]) {
        out.copy_from_slice(&self.0[i].into());
    }
}
