//! The dimension of the points: a constant the compiler unrolls over, or a number known at run time.

/// What the numerical kernels know about the dimension. Every loop runs to `get()`: for [`Const`] that is a constant
/// after monomorphisation, so the one implementation is unrolled for N = 2, 3 and serves any N at run time.
pub(crate) trait Dimension: Copy {
    /// Room for one point: an array, or a vector where the length is not known.
    type Point: AsRef<[f64]> + AsMut<[f64]> + Clone;

    /// The number of coordinates of a point.
    fn get(self) -> usize;

    /// The origin.
    fn zero(self) -> Self::Point;
}

/// A dimension known at compile time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Const<const N: usize>;

impl<const N: usize> Dimension for Const<N> {
    type Point = [f64; N];

    #[inline(always)]
    fn get(self) -> usize {
        N
    }

    #[inline(always)]
    fn zero(self) -> [f64; N] {
        [0.0; N]
    }
}

/// A dimension known at run time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dynamic(pub(crate) usize);

impl Dimension for Dynamic {
    type Point = Vec<f64>;

    #[inline(always)]
    fn get(self) -> usize {
        self.0
    }

    #[inline(always)]
    fn zero(self) -> Vec<f64> {
        vec![0.0; self.0]
    }
}
