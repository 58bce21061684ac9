//! The dimension of the points: a constant the compiler unrolls over, or a number known at run time.

/// Points looked at together: passes over many points work on blocks of this many, coordinate by coordinate, which the
/// compiler turns into vector instructions of whatever width the target has.
pub(crate) const LANES: usize = 4;

/// What the numerical kernels know about the dimension. Every loop runs to `get()`: for [`Const`] that is a constant
/// after monomorphisation, so the one implementation is unrolled for N = 2, 3 and serves any N at run time.
pub(crate) trait Dimension: Copy {
    /// Room for one point: an array, or a vector where the length is not known.
    type Point: AsRef<[f64]> + AsMut<[f64]> + Clone + Send;

    /// Room for [`LANES`] points, coordinate by coordinate.
    type Block: AsRef<[[f64; LANES]]> + AsMut<[[f64; LANES]]>;

    /// The number of coordinates of a point.
    fn get(self) -> usize;

    /// The origin.
    fn zero(self) -> Self::Point;

    /// A block of origins.
    fn zero_block(self) -> Self::Block;
}

/// A dimension known at compile time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Const<const N: usize>;

impl<const N: usize> Dimension for Const<N> {
    type Point = [f64; N];
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
    fn zero_block(self) -> Self::Block {
        [[0.0; LANES]; N]
    }
}

/// A dimension known at run time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dynamic(pub(crate) usize);

impl Dimension for Dynamic {
    type Point = Vec<f64>;
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
    fn zero_block(self) -> Self::Block {
        vec![[0.0; LANES]; self.0]
    }
}
