//! An ellipsoid by its axes: from a linear map to semi-axes, rotation and matrix.

use crate::numerics::dimension::{Dimension, Dynamic};
use crate::numerics::linalg::{
    UNIT_ROUNDOFF, dot, orthogonalize_rows, power_of_two_inverse, sum_of_logarithms, triangularize,
};
use crate::numerics::twofold;

/// An ellipsoid of any dimension: the data of [`Ellipsoid`](crate::Ellipsoid).
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shape<N: Dimension> {
    pub(crate) center: N::Point,
    /// Row k is the direction of semi-axis k.
    pub(crate) axes: N::Matrix,
    /// Longest first; those across the affine hull of a flat set are zero.
    pub(crate) semi_axes: N::Point,
    pub(crate) matrix: N::Matrix,
    pub(crate) log_det: f64,
}

impl Shape<Dynamic> {
    /// The same shape in the dimension of `dim`.
    pub(crate) fn in_dimension<N: Dimension>(self, dim: N) -> Shape<N> {
        Shape {
            center: dim.point(self.center.into_iter()),
            axes: dim.matrix(self.axes.into_iter()),
            semi_axes: dim.point(self.semi_axes.into_iter()),
            matrix: dim.matrix(self.matrix.into_iter()),
            log_det: self.log_det,
        }
    }
}

/// Axes, semi-axes (longest first) and matrix of { v : |T·v| ≤ 1 }, T the first r rows of `map`; the centre is zero.
pub(crate) fn principal_axes<N: Dimension>(dim: N, r: usize, mut map: N::Matrix) -> Shape<N> {
    let n = dim.get();
    let rows = &mut map.as_mut()[..r * n];
    // A power of two keeps the squares in range and changes no mantissa.
    let unit = power_of_two_inverse(rows.iter().fold(0.0, |m: f64, x| m.max(x.abs())));
    rows.iter_mut().for_each(|x| *x *= unit);
    triangularize(dim, rows);
    orthogonalize_rows(dim, rows);
    let mut semi_axes = dim.zero();
    for (row, a) in rows.chunks_exact_mut(n).zip(semi_axes.as_mut()) {
        let sigma = dot(row, row).sqrt();
        *a = 1.0 / sigma * unit;
        row.iter_mut().for_each(|x| *x /= sigma);
    }
    shape_from_axes(dim, r, semi_axes, map)
}

/// The shape with `r` semi-axes along the first rows of `axes`, sorted to longest first; the others are zero.
pub(crate) fn shape_from_axes<N: Dimension>(
    dim: N,
    r: usize,
    mut semi_axes: N::Point,
    mut axes: N::Matrix,
) -> Shape<N> {
    let n = dim.get();
    let (a, rows) = (&mut semi_axes.as_mut()[..n], &mut axes.as_mut()[..n * n]);
    // By insertion, which keeps the order of equal ones.
    for k in 1..r {
        let mut at = k;
        while at > 0 && a[at].total_cmp(&a[at - 1]).is_gt() {
            a.swap(at, at - 1);
            for j in 0..n {
                rows.swap(at * n + j, (at - 1) * n + j);
            }
            at -= 1;
        }
    }
    let mut matrix = dim.zero_matrix();
    let x = &mut matrix.as_mut()[..n * n];
    for (row, a) in rows.chunks_exact(n).zip(&a[..r]) {
        let scaled = dim.point(row.iter().map(|x| x / a));
        let scaled = &scaled.as_ref()[..n];
        for i in 0..n {
            for j in 0..n {
                x[i * n + j] += scaled[i] * scaled[j];
            }
        }
    }
    complete_rotation(dim, r, rows);
    let log_det = -2.0 * sum_of_logarithms(a[..r].iter().copied());
    Shape { center: dim.zero(), axes, semi_axes, matrix, log_det }
}

/// Scales the matrix so that { x : (x − c)ᵀX(x − c) ≤ 1 } is proved to be within the ellipsoid of the axes, unless
/// rounding makes it meaningless.
///
/// With D = diag(a) that is so exactly if D·R·X·Rᵀ·D = I + F is no less than I. Its entries are sums in twice the
/// precision, and |F| ≤ f < 1, the rounding of the scaled entries of X included, bounds it below by 1 − f.
pub(crate) fn round_inward<N: Dimension>(dim: N, shape: &mut Shape<N>) {
    let n = dim.get();
    let (axes, a) = (&shape.axes.as_ref()[..n * n], &shape.semi_axes.as_ref()[..n]);
    let x = &mut shape.matrix.as_mut()[..n * n];
    let pairs = |u: &[f64], v: &[f64]| u.iter().copied().zip(v.iter().copied()).collect::<Vec<_>>();
    let (mut square, mut rounding) = (0.0, 0.0);
    for (right, b) in axes.chunks_exact(n).zip(a) {
        let image: Vec<f64> = x.chunks_exact(n).map(|row| twofold::dot(pairs(row, right)) * b).collect();
        let size: Vec<f64> =
            x.chunks_exact(n).map(|row| row.iter().zip(right).map(|(x, r)| (x * r).abs()).sum()).collect();
        for (left, a) in axes.chunks_exact(n).zip(a) {
            let unit = if std::ptr::eq(left, right) { -1.0 } else { 0.0 };
            let scaled: Vec<f64> = left.iter().map(|r| a * r).collect();
            let entry = twofold::dot(pairs(&scaled, &image).into_iter().chain([(unit, 1.0)]));
            square += entry * entry;
            // A rounding each for the image, its factor, the row and the scaled entries of X, which is symmetric.
            rounding += 8.0 * UNIT_ROUNDOFF * a * b * left.iter().zip(&size).map(|(r, s)| (r * s).abs()).sum::<f64>();
        }
    }
    let left = 1.0 - (square.sqrt() + rounding) * (1.0 + 1e-12);
    if left > 0.5 {
        x.iter_mut().for_each(|x| *x /= left);
    }
}

/// Replaces the rows from `r` on by ones that make all of them orthonormal, and the determinant +1.
fn complete_rotation<N: Dimension>(dim: N, r: usize, axes: &mut [f64]) {
    let n = dim.get();
    if r < n {
        complete_basis(dim, r, axes);
    }
    if determinant_sign(dim, axes) < 0.0 {
        axes[(n - 1) * n..].iter_mut().for_each(|x| *x = -*x);
    }
}

/// Replaces the rows from `r` on by ones that make all of them orthonormal.
///
/// Householder's reflections I − 2vvᵀ/|v|², one for each present row, take row k to ±eₖ. In reverse they take the unit
/// vectors from eᵣ on to the missing rows.
fn complete_basis<N: Dimension>(dim: N, r: usize, axes: &mut [f64]) {
    let n = dim.get();
    let reflect = |v: &N::Point, x: &mut [f64]| {
        let v = v.as_ref();
        let twice = 2.0 * dot(v, x) / dot(v, v);
        x.iter_mut().zip(v).for_each(|(x, v)| *x -= twice * v);
    };
    let (given, missing) = axes.split_at_mut(r * n);
    let mut reflections: Vec<N::Point> = Vec::with_capacity(r);
    for (k, row) in given.chunks_exact(n).enumerate() {
        let mut reflected = dim.point(row.iter().copied());
        reflections.iter().for_each(|earlier| reflect(earlier, reflected.as_mut()));
        let v = reflected.as_mut();
        v[..k].fill(0.0);
        v[k] += dot(v, v).sqrt().copysign(v[k]);
        reflections.push(reflected);
    }
    for (k, row) in missing.chunks_exact_mut(n).enumerate() {
        row.fill(0.0);
        row[r + k] = 1.0;
        reflections.iter().rev().for_each(|v| reflect(v, row));
    }
}

/// The sign of the determinant, by elimination with pivoting.
fn determinant_sign<N: Dimension>(dim: N, matrix: &[f64]) -> f64 {
    let n = dim.get();
    let mut a = dim.matrix(matrix.iter().copied());
    let a = &mut a.as_mut()[..n * n];
    let mut sign = 1.0;
    for k in 0..n {
        let pivot = (k..n).fold(k, |best, i| if a[i * n + k].abs() > a[best * n + k].abs() { i } else { best });
        if pivot != k {
            sign = -sign;
            for j in 0..n {
                a.swap(k * n + j, pivot * n + j);
            }
        }
        sign *= a[k * n + k].signum();
        for i in k + 1..n {
            let factor = a[i * n + k] / a[k * n + k];
            for j in k..n {
                a[i * n + j] -= factor * a[k * n + j];
            }
        }
    }
    sign
}

/// ln of the volume of the unit ball in n dimensions: V₀ = 1, V₁ = 2, Vₙ = Vₙ₋₂·2π/n.
pub(crate) fn log_unit_ball_volume(n: usize) -> f64 {
    let mut volume = libm::log(if n.is_multiple_of(2) { 1.0 } else { 2.0 });
    let mut k = if n.is_multiple_of(2) { 2 } else { 3 };
    while k <= n {
        volume += libm::log(std::f64::consts::TAU / k as f64);
        k += 2;
    }
    volume
}
