//! The errors of the constructors of shapes.

use core::fmt;

/// Why a shape could not be built.
///
/// Every constructor checks its numbers once, so that support mappings never have to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum InvalidShape {
    /// A number is NaN or infinite.
    NonFinite {
        /// The parameter, as the constructor names it.
        parameter: &'static str,
        /// The index of the coordinate, point or matrix column within the parameter; 0 for a lone number.
        index: usize,
    },
    /// A length that must be at least zero is negative.
    Negative {
        /// The parameter, as the constructor names it.
        parameter: &'static str,
        /// The index of the coordinate within the parameter; 0 for a lone number.
        index: usize,
        /// The value, converted to `f64`.
        value: f64,
    },
    /// A length that must be greater than zero is not. An ellipsoid has no flat axes.
    NotPositive {
        /// The parameter, as the constructor names it.
        parameter: &'static str,
        /// The index of the coordinate within the parameter; 0 for a lone number.
        index: usize,
        /// The value, converted to `f64`.
        value: f64,
    },
    /// A vector that must have a direction is zero, or so short or long that its length is not a number of full
    /// precision.
    NoDirection {
        /// The parameter, as the constructor names it.
        parameter: &'static str,
    },
    /// A list of points is empty.
    NoPoints,
    /// Numbers are finite, but the shape they make is larger than the largest number.
    TooLarge {
        /// The parameter, as the constructor names it.
        parameter: &'static str,
    },
    /// The matrix of an ellipsoid is not symmetric to rounding.
    NotSymmetric {
        /// The row of the entry that differs from its mirror image.
        row: usize,
        /// Its column.
        column: usize,
    },
    /// The matrix of an ellipsoid is not positive definite to rounding.
    NotPositiveDefinite,
    /// A rotation is the zero quaternion.
    ZeroRotation,
    /// The columns of a matrix that should be a rotation or a set of axes are not orthonormal, to half the digits of
    /// the scalar.
    NotOrthonormal,
    /// The columns of a matrix that should be a rotation are orthonormal, but left-handed: it mirrors.
    Mirrors,
}

impl fmt::Display for InvalidShape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NonFinite { parameter, index } => {
                write!(f, "{parameter} must be finite, but is NaN or infinite at index {index}")
            }
            Self::Negative { parameter, index, value } => {
                write!(f, "{parameter} must not be negative, but is {value} at index {index}")
            }
            Self::NotPositive { parameter, index, value } => {
                write!(f, "{parameter} must be greater than zero, but is {value} at index {index}")
            }
            Self::NoDirection { parameter } => write!(
                f,
                "{parameter} must have a direction, but is zero, or too short or long for its floating-point type"
            ),
            Self::NoPoints => f.write_str("at least one point is needed, but the list is empty"),
            Self::NotSymmetric { row, column } => {
                write!(f, "the matrix must be symmetric, but entries ({row}, {column}) and ({column}, {row}) differ")
            }
            Self::NotPositiveDefinite => f.write_str("the matrix must be positive definite, but it is not"),
            Self::NotOrthonormal => f.write_str("the columns of the matrix must be orthonormal, but they are not"),
            Self::TooLarge { parameter } => {
                write!(f, "{parameter} makes the shape too large for the range of its floating-point type")
            }
            Self::Mirrors => {
                f.write_str("the matrix must be a rotation, but its determinant is negative, so that it mirrors")
            }
            Self::ZeroRotation => f.write_str("the rotation must not be the zero quaternion"),
        }
    }
}

impl core::error::Error for InvalidShape {}

/// `value` if it is finite and at least zero.
pub(crate) fn non_negative<S: crate::Scalar>(parameter: &'static str, value: S) -> Result<S, InvalidShape> {
    if !value.is_finite() {
        Err(InvalidShape::NonFinite { parameter, index: 0 })
    } else if value < S::ZERO {
        Err(InvalidShape::Negative { parameter, index: 0, value: value.as_f64() })
    } else {
        Ok(value)
    }
}

/// The least of some known bounds on the error of a matrix that is no less than the one in data.
///
/// # Errors
/// If that is no bound, or larger than any.
#[cfg(feature = "serde")]
pub(crate) fn known_error(parameter: &'static str, error: f64, known: &[f64]) -> Result<f64, InvalidShape> {
    let error = non_negative(parameter, error)?;
    let enough = known.iter().copied().filter(|&known| error <= known).reduce(f64::min);
    enough.ok_or(InvalidShape::NotOrthonormal)
}

/// The size of a shape if it did not overflow.
pub(crate) fn measurable<S: crate::Scalar>(parameter: &'static str, size: S) -> Result<S, InvalidShape> {
    if size.is_finite() { Ok(size) } else { Err(InvalidShape::TooLarge { parameter }) }
}

/// `vector` if its coordinates are finite.
#[inline]
pub(crate) fn finite<V: crate::Vector>(parameter: &'static str, vector: V) -> Result<V, InvalidShape> {
    if vector.is_finite() {
        return Ok(vector);
    }
    let index = (0..V::DIM).find(|&i| !num_traits::Float::is_finite(vector.get(i))).unwrap_or(0);
    Err(InvalidShape::NonFinite { parameter, index })
}

/// `matrix` if its columns are orthonormal to half the digits of the scalar: enough to find a blunder, and not so
/// strict as to refuse a matrix that has drifted.
pub(crate) fn orthonormal<M: crate::Matrix>(parameter: &'static str, matrix: M) -> Result<M, InvalidShape> {
    use crate::{Scalar, Vector};
    use num_traits::Float as _;
    type S<M> = <<M as crate::Matrix>::Vector as Vector>::Scalar;
    let matrix = finite_matrix(parameter, matrix)?;
    let unit = |i, j| if i == j { S::<M>::ONE } else { S::<M>::ZERO };
    let off = |i, j| (matrix.col(i).dot(matrix.col(j)) - unit(i, j)).abs();
    let all = (0..M::Vector::DIM).all(|i| (0..=i).all(|j| off(i, j) <= S::<M>::EPSILON.sqrt()));
    if all { Ok(matrix) } else { Err(InvalidShape::NotOrthonormal) }
}

/// `matrix` if its entries are finite.
pub(crate) fn finite_matrix<M: crate::Matrix>(parameter: &'static str, matrix: M) -> Result<M, InvalidShape> {
    use crate::Vector;
    match (0..M::Vector::DIM).find(|&j| !matrix.col(j).is_finite()) {
        Some(index) => Err(InvalidShape::NonFinite { parameter, index }),
        None => Ok(matrix),
    }
}
