//! The rounding of a set that is mapped and moved.

use core::array;

use num_traits::Float as _;

use crate::error::InvalidShape;
use crate::numerics::bound::{image, raised, raised_vector, roundings, roundings_of};
use crate::numerics::twofold::{dot_minus, lost_in_sum};
use crate::{Core, Matrix, Rounding, Scalar, Vector};

/// What the rounding of `matrix·origin + translation` loses, for a shape of the given size. If the shape is
/// [near](is_near) zero, the roundings of the product are not included.
///
/// # Errors
/// [`InvalidShape::TooLarge`] if that overflows.
#[inline(always)]
pub(super) fn lost_in_origin<V: Vector>(
    matrix: &V::Matrix,
    origin: V,
    size: V::Scalar,
    translation: V,
) -> Result<V, InvalidShape> {
    // Most shapes are about zero, and then nothing is lost.
    if origin == V::ZERO {
        return Ok(V::ZERO);
    }
    if !is_near(origin, size) {
        return lost_in_far_origin(matrix, origin, translation);
    }
    let turned = *matrix * origin;
    if (turned + translation).is_finite() {
        Ok(lost_in_sum(turned, translation))
    } else {
        Err(InvalidShape::TooLarge { parameter: "translation" })
    }
}

/// Whether a shape of the given size is so near zero that the roundings of its origin are no more than those of its
/// points.
#[inline(always)]
pub(super) fn is_near<V: Vector>(origin: V, size: V::Scalar) -> bool {
    origin.abs().max_element() <= size
}

/// A bound on how far rounding moves the image of a set.
///
/// With `u = ε/2` and `n` dimensions, a product with a matrix of norm `scale` loses `n·√n·u·scale` of the length of the
/// vector. The direction in the shape's frame loses as much, so that the point found along it is short of the farthest
/// by twice that times the extent.
#[inline(always)]
pub(super) fn length_of_error<V: Vector>(
    core: &Core<V>,
    scale: V::Scalar,
    operator_error: V::Scalar,
    translation: V,
    lost: V,
) -> V::Scalar {
    // The matrix itself is wrong twice, as a map of points and of directions.
    let units = scale * V::Scalar::from_f64(3.0 * of_product::<V>() + 1.0) + operator_error * V::Scalar::from_f64(2.0);
    let turned = scale * core.error + roundings(1.0, units * core.extent);
    // Most shapes are about zero, and then nothing else is lost.
    if core.origin == V::ZERO {
        return raised(turned);
    }
    let placed = error_of_origin(core.origin, core.size(), scale, translation);
    raised(turned + placed + roundings(2.0, operator_error * core.origin.norm()) + roundings(2.0, lost.norm()))
}

/// What rounding moves the image of an origin by that is not zero, of a set of some size about it, beside what the
/// matrix is wrong by.
#[inline(never)]
fn error_of_origin<V: Vector>(origin: V, size: V::Scalar, scale: V::Scalar, translation: V) -> V::Scalar {
    let moved = scale * origin.norm();
    // What was lost is known to a rounding of itself, if it is of the product too, and to 16ε² of what it comes of.
    if is_near(origin, size) {
        roundings(of_product::<V>(), moved)
    } else {
        roundings(32.0, V::Scalar::EPSILON * (moved + translation.norm()))
    }
}

/// What a product with a matrix loses, in `u` times the norm of both.
#[inline(always)]
fn of_product<V: Vector>() -> f64 {
    V::DIM as f64 * if V::DIM == 2 { 1.42 } else { 1.74 }
}

#[inline(never)]
fn lost_in_far_origin<V: Vector>(matrix: &V::Matrix, origin: V, translation: V) -> Result<V, InvalidShape> {
    let moved = *matrix * origin + translation;
    if !moved.is_finite() {
        return Err(InvalidShape::TooLarge { parameter: "translation" });
    }
    let of_exact_rows = lost_in_sum(*matrix * origin, translation);
    Ok(V::from_fn(|i| {
        let row = (0..V::DIM).map(|j| (matrix.col(j).get(i), origin.get(j)));
        if is_signed_unit(row.clone().map(|(entry, _)| entry)) {
            return of_exact_rows.get(i);
        }
        dot_minus(row.chain([(V::Scalar::ONE, translation.get(i))]), moved.get(i))
    }))
}

/// Whether the entries of a row or column are those of `±eⱼ`, so that products with it are exact.
fn is_signed_unit<S: Scalar>(entries: impl Iterator<Item = S>) -> bool {
    let mut others = entries.filter(|&entry| entry != S::ZERO);
    others.next().is_some_and(|entry| num_traits::Float::abs(entry) == S::ONE) && others.next().is_none()
}

/// Which rows and columns of a matrix are those of `±eⱼ`; `None` where none is.
struct Exact {
    rows: Option<[bool; 3]>,
    columns: Option<[bool; 3]>,
}

impl Exact {
    fn of<M: Matrix>(m: &M) -> Self {
        let dim = M::Vector::DIM;
        // Hardly a matrix has an entry of zero, unless it is made by hand.
        if (0..dim).all(|j| m.col(j).abs().min_element() > <M::Vector as Vector>::Scalar::ZERO) {
            return Self { rows: None, columns: None };
        }
        let entry = |i: usize, j: usize| m.col(j).get(i);
        let rows = array::from_fn(|i| i < dim && is_signed_unit((0..dim).map(|j| entry(i, j))));
        let columns = array::from_fn(|j| j < dim && is_signed_unit((0..dim).map(|i| entry(i, j))));
        Self { rows: Some(rows), columns: Some(columns) }
    }
}

/// The vector without some of its coordinates.
fn without<V: Vector>(v: V, left_out: [bool; 3]) -> V {
    V::from_fn(|i| if left_out[i] { V::Scalar::ZERO } else { v.get(i) })
}

/// A linear map and a translation, with bounds on their rounding.
pub(super) struct Placement<'a, V: Vector> {
    pub(super) matrix: &'a V::Matrix,
    /// A bound on the error of every entry of the matrix, except in rows `±eⱼ`, which are exact.
    pub(super) matrix_error: V::Scalar,
    /// If the matrix multiplies all lengths by one factor, to rounding: a bound on that factor.
    pub(super) scale: Option<V::Scalar>,
    pub(super) translation: V,
    /// What the rounding of the origin lost.
    pub(super) lost: V,
    /// Whether that is without the roundings of the product.
    pub(super) is_near: bool,
}

impl<V: Vector> Placement<'_, V> {
    /// Bounds on the rounding of the image `matrix·k(matrixᵀd) + lost` of a core about `origin`, whose points are at
    /// most `length` long.
    ///
    /// With `u = ε/2`, and with rows and columns `±eⱼ` exact, since a row has two exact zeros only if the rotation has:
    /// - the product of a row with `k` is wrong by `3u·Σ|mᵢⱼ|·extentⱼ`, and the sum with what was lost by `u`;
    /// - the direction in the shape's frame is wrong by `3u·|matrixᵀ|·|d|`, so that a point found along it may be short
    ///   of the farthest by that times twice the extent: `|d|·(6u·|matrix|·extent)`;
    /// - the error of the matrix itself moves the core and its origin;
    /// - what was lost is known to `u` of itself and to `16ε²` of the numbers that it was computed from.
    #[inline(never)]
    pub(super) fn image(&self, shape: Rounding<V>, origin: V, length: V::Scalar) -> Rounding<V> {
        let (zero, m) = (V::Scalar::ZERO, self.matrix);
        let Exact { rows, columns } = Exact::of(m);

        let reached = image(m, shape.extent);
        let within = self.scale.map_or(V::Scalar::infinity(), |scale| raised(scale * length));
        let extent = raised_vector(reached.min(V::splat(within)) + self.lost.abs());
        let sum = |v: V| (1..V::DIM).fold(v.get(0), |sum, i| sum + v.get(i));
        let moved = roundings(2.0, sum(shape.extent) + sum(shape.error) + sum(origin.abs())) * self.matrix_error;
        let short = match columns {
            None => reached,
            Some(is_exact) => image(m, without(shape.extent, is_exact)),
        };
        let mut inexact = roundings_of(3.0, reached) + V::splat(moved);
        if origin != V::ZERO {
            let turned_origin = image(m, origin.abs());
            let squared = V::Scalar::EPSILON * V::Scalar::EPSILON * V::Scalar::from_f64(16.0);
            inexact += roundings_of(1.0, self.lost.abs()) + (turned_origin + self.translation.abs()) * squared;
            if self.is_near {
                inexact += roundings_of(3.0, turned_origin);
            }
        }
        let mut error = roundings_of(6.0, short) + rows.map_or(inexact, |is_exact| without(inexact, is_exact));
        if self.lost != V::ZERO {
            let is_nothing = |i: usize| self.lost.get(i) == zero;
            error += roundings_of(1.0, without(extent, [is_nothing(0), is_nothing(1), V::DIM > 2 && is_nothing(2)]));
        }
        // Of a map that keeps lengths, what was wrong before is no longer than it was.
        let (before, length) = match self.scale {
            Some(scale) => (raised(scale * shape.error_length), scale * shape.error_length),
            None => {
                let columns = V::from_fn(|j| m.col(j).norm());
                (V::Scalar::infinity(), columns.norm() * shape.error_length)
            }
        };
        let before = image(m, shape.error).min(V::splat(before));
        Rounding { extent, error: before, error_length: raised(length) }.with_error(error)
    }
}
