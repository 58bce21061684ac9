//! The dimension of the points: a constant the compiler unrolls over, or a number known at run time.

use std::fmt::Debug;

/// The number of points in a block: passes over many points work on blocks, coordinate by coordinate, which the
/// compiler turns into vector instructions of whatever width the target has.
pub(crate) const LANES: usize = 4;

/// The dimension, for the numerical kernels. Every loop runs to `get()`, which is a constant for [`Const`] after
/// monomorphisation: the one implementation is unrolled for N = 2, 3 and also works for any N at run time.
pub(crate) trait Dimension: Copy {
    /// Room for one point: an array, or a vector if the length is known only at run time.
    type Point: AsRef<[f64]> + AsMut<[f64]> + Clone + Debug + PartialEq + Send + Sync;

    /// Room for a square matrix, row by row.
    type Matrix: AsRef<[f64]> + AsMut<[f64]> + Clone + Debug + PartialEq + Send + Sync;

    /// Room for one index per coordinate.
    type Indices: AsRef<[usize]> + AsMut<[usize]> + Clone + Debug + Send;

    /// Room for [`LANES`] points, coordinate by coordinate.
    type Block: AsRef<[[f64; LANES]]> + AsMut<[[f64; LANES]]>;

    /// The number of coordinates of a point.
    fn get(self) -> usize;

    /// The origin.
    fn zero(self) -> Self::Point;

    /// The matrix of zeros.
    fn zero_matrix(self) -> Self::Matrix;

    /// One `index` per coordinate.
    fn indices(self, index: usize) -> Self::Indices;

    /// A block of origins.
    fn zero_block(self) -> Self::Block;

    /// The point with these coordinates; those that are missing are zero.
    #[inline(always)]
    fn point(self, coordinates: impl Iterator<Item = f64>) -> Self::Point {
        let mut point = self.zero();
        point.as_mut().iter_mut().zip(coordinates).for_each(|(to, x)| *to = x);
        point
    }

    /// The matrix with these entries, row by row; those that are missing are zero.
    #[inline(always)]
    fn matrix(self, entries: impl Iterator<Item = f64>) -> Self::Matrix {
        let mut matrix = self.zero_matrix();
        matrix.as_mut().iter_mut().zip(entries).for_each(|(to, x)| *to = x);
        matrix
    }
}

/// A square matrix as an array of rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Square<const N: usize>(pub(crate) [[f64; N]; N]);

impl<const N: usize> AsRef<[f64]> for Square<N> {
    #[inline(always)]
    fn as_ref(&self) -> &[f64] {
        self.0.as_flattened()
    }
}

impl<const N: usize> AsMut<[f64]> for Square<N> {
    #[inline(always)]
    fn as_mut(&mut self) -> &mut [f64] {
        self.0.as_flattened_mut()
    }
}

/// A dimension known at compile time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Const<const N: usize>;

impl<const N: usize> Dimension for Const<N> {
    type Point = [f64; N];
    type Matrix = Square<N>;
    type Indices = [usize; N];
    type Block = [[f64; LANES]; N];

    #[inline(always)]
    fn get(self) -> usize {
        N
    }

    #[inline(always)]
    fn zero(self) -> [f64; N] {
        [0.0; N]
    }

    #[inline(always)]
    fn zero_matrix(self) -> Square<N> {
        Square([[0.0; N]; N])
    }

    #[inline(always)]
    fn indices(self, index: usize) -> [usize; N] {
        [index; N]
    }

    #[inline(always)]
    fn zero_block(self) -> Self::Block {
        [[0.0; LANES]; N]
    }
}

/// A dimension known at run time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Dynamic(pub(crate) usize);

impl Dimension for Dynamic {
    type Point = Vec<f64>;
    type Matrix = Vec<f64>;
    type Indices = Vec<usize>;
    type Block = Vec<[f64; LANES]>;

    #[inline(always)]
    fn get(self) -> usize {
        self.0
    }

    #[inline(always)]
    fn zero(self) -> Vec<f64> {
        vec![0.0; self.0]
    }

    #[inline(always)]
    fn zero_matrix(self) -> Vec<f64> {
        vec![0.0; self.0 * self.0]
    }

    #[inline(always)]
    fn indices(self, index: usize) -> Vec<usize> {
        vec![index; self.0]
    }

    #[inline(always)]
    fn zero_block(self) -> Self::Block {
        vec![[0.0; LANES]; self.0]
    }
}
