//! The source of the points: a slice of anything that converts into `[f64; N]`, or rows of a matrix.

pub(crate) mod parallel;

use crate::numerics::dimension::{Const, Dimension, LANES};

/// A finite sequence of points, read by copy.
pub(crate) trait Points: Sync {
    /// The dimension, as far as the compiler knows it.
    type Dim: Dimension + Sync;

    fn dim(&self) -> Self::Dim;

    fn len(&self) -> usize;

    /// Copies point `i` into `out`, whose length is the dimension.
    fn read(&self, i: usize, out: &mut [f64]);

    /// Copies the points from `at` on into the lanes of `block`, a row for each coordinate, by way of `v`; from `end`
    /// on the last point is repeated.
    #[inline(always)]
    fn read_block(&self, at: usize, end: usize, v: &mut [f64], block: &mut [[f64; LANES]]) {
        read_lanes(self, at, end, v, block);
    }
}

#[inline(always)]
fn read_lanes<P: Points + ?Sized>(points: &P, at: usize, end: usize, v: &mut [f64], block: &mut [[f64; LANES]]) {
    for lane in 0..LANES {
        points.read((at + lane).min(end - 1), v);
        for (row, &x) in block.iter_mut().zip(&*v) {
            row[lane] = x;
        }
    }
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

    /// The bounds of all blocks but the last are checked once.
    #[inline(always)]
    fn read_block(&self, at: usize, end: usize, v: &mut [f64], block: &mut [[f64; LANES]]) {
        let Some(points) = self.0[at..end].first_chunk::<LANES>() else {
            return read_lanes(self, at, end, v, block);
        };
        for (lane, &point) in points.iter().enumerate() {
            let point: [f64; N] = point.into();
            for k in 0..N {
                block[k][lane] = point[k];
            }
        }
    }
}

/// Points copied together, one after the other.
#[derive(Clone, Debug)]
pub(crate) struct Copied<D> {
    dim: D,
    len: usize,
    coordinates: Vec<f64>,
}

impl<D: Dimension> Copied<D> {
    /// The points `index` of `points`, whose dimension is `dim`.
    pub(crate) fn new<P: Points>(dim: D, points: &P, index: impl ExactSizeIterator<Item = usize>) -> Self {
        let (n, len) = (dim.get(), index.len());
        let mut coordinates = vec![0.0; len * n];
        if n > 0 {
            index.zip(coordinates.chunks_exact_mut(n)).for_each(|(i, out)| points.read(i, out));
        }
        Self { dim, len, coordinates }
    }

    /// `len` points with these coordinates, those of the first point first.
    pub(crate) const fn from_coordinates(dim: D, len: usize, coordinates: Vec<f64>) -> Self {
        Self { dim, len, coordinates }
    }
}

impl<D: Dimension + Sync> Points for Copied<D> {
    type Dim = D;

    #[inline(always)]
    fn dim(&self) -> D {
        self.dim
    }

    #[inline(always)]
    fn len(&self) -> usize {
        self.len
    }

    #[inline(always)]
    fn read(&self, i: usize, out: &mut [f64]) {
        let n = self.dim.get();
        out.copy_from_slice(&self.coordinates[i * n..(i + 1) * n]);
    }
}
