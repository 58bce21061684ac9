//! An ellipsoid by its axes: from a linear map to semi-axes, rotation and matrix.

use crate::dimension::Dimension;
use crate::linalg::{dot, orthogonalize_rows, power_of_two_inverse, sum_of_logarithms, triangularize};

/// An ellipsoid of any dimension: what [`Ellipsoid`](crate::Ellipsoid) holds.
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

/// Axes, semi-axes (longest first) and matrix of { v : |T·v| ≤ 1 }, T the first r rows of `map`; the centre is zero.
pub(crate) fn principal_axes<N: Dimension>(dim: N, r: usize, mut map: N::Matrix) -> Shape<N> {
    let n = dim.get();
    let rows = &mut map.as_mut()[..r * n];
    // A power of two keeps the squares in range and moves no bit.
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
    // By insertion, which keeps the order of equals.
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

/// Replaces the rows from `r` on by ones that make all of them orthonormal, and the determinant +1.
fn complete_rotation<N: Dimension>(dim: N, r: usize, axes: &mut [f64]) {
    let n = dim.get();
    for k in r..n {
        let (done, rest) = axes.split_at_mut(k * n);
        let mut best = (dim.zero(), -1.0);
        for j in 0..n {
            let mut e = dim.zero();
            e.as_mut()[j] = 1.0;
            for _ in 0..2 {
                for row in done.chunks_exact(n) {
                    let along = dot(row, e.as_ref());
                    e.as_mut().iter_mut().zip(row).for_each(|(x, y)| *x -= along * y);
                }
            }
            let length = dot(e.as_ref(), e.as_ref()).sqrt();
            if length > best.1 {
                best = (e, length);
            }
        }
        rest.iter_mut().zip(best.0.as_ref()).for_each(|(to, x)| *to = x / best.1);
    }
    if determinant_sign(dim, axes) < 0.0 {
        axes[(n - 1) * n..].iter_mut().for_each(|x| *x = -*x);
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
    let mut volume = if n.is_multiple_of(2) { 1.0f64 } else { 2.0 }.ln();
    let mut k = if n.is_multiple_of(2) { 2 } else { 3 };
    while k <= n {
        volume += (std::f64::consts::TAU / k as f64).ln();
        k += 2;
    }
    volume
}
