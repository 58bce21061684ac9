//! glam's square matrices behind one trait.

use core::fmt::Debug;
use core::ops::{Add, Mul, Sub};

use crate::Vector;
use crate::sealed::Sealed;

/// A square matrix acting on [`Vector`]s by `matrix * vector`.
pub trait Matrix:
    Copy
    + Debug
    + Default
    + PartialEq
    + Mul<Self::Vector, Output = Self::Vector>
    + Mul<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Send
    + Sync
    + 'static
    + Sealed
{
    /// The vectors it acts on.
    type Vector: Vector<Matrix = Self>;

    /// The identity.
    const IDENTITY: Self;

    /// The matrix whose column `j` is `f(j)`.
    fn from_cols_fn(f: impl FnMut(usize) -> Self::Vector) -> Self;
    /// Column `index`, counted from 0.
    ///
    /// # Panics
    /// If `index >= DIM`.
    fn col(&self, index: usize) -> Self::Vector;
    /// The transpose.
    #[must_use]
    fn transpose(&self) -> Self;
    /// The transpose times `rhs`, without forming the transpose.
    fn transpose_mul(&self, rhs: Self::Vector) -> Self::Vector;
    /// The determinant.
    fn determinant(&self) -> <Self::Vector as Vector>::Scalar;
    /// The inverse; its entries are not finite where the matrix is singular.
    #[must_use]
    fn inverse(&self) -> Self;

    /// The diagonal matrix with the given diagonal.
    #[inline]
    #[must_use]
    fn from_diagonal(diagonal: Self::Vector) -> Self {
        Self::from_cols_fn(|j| Self::Vector::axis(j) * diagonal.get(j))
    }

    /// Whether all entries are finite.
    #[inline]
    fn is_finite(&self) -> bool {
        (0..Self::Vector::DIM).all(|j| self.col(j).is_finite())
    }
}
