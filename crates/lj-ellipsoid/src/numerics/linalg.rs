//! Small dense kernels on row-major `n × n` slices. Matrices here are at most some tens wide, so plain loops win.

use crate::numerics::dimension::Dimension;

/// The unit roundoff of `f64`, 2⁻⁵³.
pub(crate) const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

#[inline(always)]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// The power of two that brings `extent` near one, so that scaling by it is exact.
pub(crate) fn power_of_two_inverse(extent: f64) -> f64 {
    if extent == 0.0 {
        return 1.0;
    }
    // Exponents are kept to where the power and its inverse are normal numbers.
    let exponent = ((extent.to_bits() >> 52) as i64 - 1023).clamp(-1000, 1000);
    f64::from_bits(((1023 - exponent) as u64) << 52)
}

/// Σ ln xᵢ of positive numbers, as the logarithm of their product: one rounding of a logarithm in the common case, none
/// of whose products is extreme.
#[inline(always)]
pub(crate) fn sum_of_logarithms(numbers: impl Iterator<Item = f64>) -> f64 {
    let mut sum = 0.0;
    let mut product = 1.0;
    for x in numbers {
        if !(1e-150..=1e150).contains(&x) {
            sum += libm::log(x);
            continue;
        }
        product *= x;
        if !(1e-150..=1e150).contains(&product) {
            sum += libm::log(product);
            product = 1.0;
        }
    }
    sum + libm::log(product)
}

/// Σ ln xᵢ, and Σ |ln xᵢ|, of which its rounding is a part, of lengths in a unit: the same bits whatever unit they
/// were in before.
pub(crate) fn logarithms(lengths: &[f64], per_unit: f64) -> [f64; 2] {
    let numbers = lengths.iter().map(|a| a * per_unit);
    [sum_of_logarithms(numbers.clone()), numbers.map(|a| libm::log(a).abs()).sum()]
}

/// x − a·b.
#[inline(always)]
fn reduced(x: f64, a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(x, |x, (a, b)| x - a * b)
}

/// Overwrites the lower triangle of the symmetric `a` by its Cholesky factor L, A = L·Lᵀ.
/// False if a pivot is not positive (or NaN): then `a` is not numerically positive definite.
#[inline(always)]
pub(crate) fn cholesky<D: Dimension>(dim: D, a: &mut [f64]) -> bool {
    let n = dim.get();
    let a = &mut a[..n * n];
    for i in 0..n {
        let (above, row) = a.split_at_mut(i * n);
        for (j, other) in above.chunks_exact(n).enumerate() {
            row[j] = reduced(row[j], &row[..j], &other[..j]) / other[j];
        }
        let pivot = reduced(row[i], &row[..i], &row[..i]);
        if !(pivot > 0.0 && pivot.is_finite()) {
            return false;
        }
        row[i] = pivot.sqrt();
    }
    true
}

/// As [`cholesky`], answering ln det A; `None` where `a` is not numerically positive definite.
#[inline(always)]
pub(crate) fn cholesky_log_det<D: Dimension>(dim: D, a: &mut [f64]) -> Option<f64> {
    let n = dim.get();
    cholesky(dim, a).then(|| 2.0 * sum_of_logarithms((0..n).map(|k| a[k * n + k])))
}

/// Solves L·x = b in place, `l` lower triangular.
#[inline(always)]
pub(crate) fn solve_lower<D: Dimension>(dim: D, l: &[f64], x: &mut [f64]) {
    let n = dim.get();
    let (l, x) = (&l[..n * n], &mut x[..n]);
    for i in 0..n {
        let row = &l[i * n..i * n + n];
        x[i] = reduced(x[i], &row[..i], &x[..i]) / row[i];
    }
}

/// Solves Lᵀ·x = b in place, `l` lower triangular.
#[inline(always)]
pub(crate) fn solve_lower_transpose<D: Dimension>(dim: D, l: &[f64], x: &mut [f64]) {
    let n = dim.get();
    let (l, x) = (&l[..n * n], &mut x[..n]);
    for i in (0..n).rev() {
        let mut s = x[i];
        for k in i + 1..n {
            s -= l[k * n + i] * x[k];
        }
        x[i] = s / l[i * n + i];
    }
}

/// Solves L·Lᵀ·x = b in place, `l` lower triangular: A·x = b for the factor of [`cholesky`].
#[inline(always)]
pub(crate) fn solve_factored<D: Dimension>(dim: D, l: &[f64], x: &mut [f64]) {
    solve_lower(dim, l, x);
    solve_lower_transpose(dim, l, x);
}

/// Brings `t` (rows of length `n`, at most `n` of them) to triangular form by reflections from the left, up to the
/// order of its columns: T ← H·T, so that `TᵀT` is unchanged.
///
/// Householder's QR with column pivoting and rows sorted by size: its error is small row by row and column by column
/// (Cox & Higham 1998), so axes of wildly different size survive, wherever the grading stands.
pub(crate) fn triangularize<D: Dimension>(dim: D, t: &mut [f64]) {
    let n = dim.get();
    let rows = t.len() / n;
    let mut eliminated = dim.indices(0);
    let mut v = dim.zero();
    let (eliminated, v) = (eliminated.as_mut(), v.as_mut());
    for k in 0..rows {
        let size = |t: &[f64], i: usize| t[i * n..i * n + n].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let mut largest = (k, size(t, k));
        for i in k + 1..rows {
            let size = size(t, i);
            if size > largest.1 {
                largest = (i, size);
            }
        }
        for j in 0..n {
            t.swap(k * n + j, largest.0 * n + j);
        }
        let mut pivot = (0, -1.0);
        for j in 0..n {
            let length: f64 = (k..rows).map(|i| t[i * n + j] * t[i * n + j]).sum();
            if eliminated[j] == 0 && length > pivot.1 {
                pivot = (j, length);
            }
        }
        eliminated[pivot.0] = 1;
        let head = t[k * n + pivot.0];
        let alpha = -pivot.1.sqrt().copysign(head);
        for i in k..rows {
            v[i] = t[i * n + pivot.0];
        }
        v[k] -= alpha;
        // |v|² = 2·|x|² + 2·|x||head| for x the pivot column.
        let half_square = pivot.1 + alpha.abs() * head.abs();
        if !(half_square > 0.0) {
            continue;
        }
        for j in 0..n {
            let along: f64 = (k..rows).map(|i| v[i] * t[i * n + j]).sum::<f64>() / half_square;
            for i in k..rows {
                t[i * n + j] -= along * v[i];
            }
        }
        for i in k + 1..rows {
            t[i * n + pivot.0] = 0.0;
        }
    }
}

/// Makes the rows of `t` mutually orthogonal by rotations from the left: T ← J·T with `JᵀJ = I`, so that `TᵀT` is
/// unchanged.
///
/// This is one-sided Jacobi (Hestenes 1958) on Tᵀ. With T = diag·(well conditioned) it finds every singular value, a
/// row norm at the end, to high *relative* accuracy however graded the diagonal (Demmel & Veselić 1992), which an
/// eigen-decomposition of `TᵀT` cannot. Rows count as orthogonal at |tᵢ·tⱼ| ≤ 4u·|tᵢ||tⱼ|.
///
/// `t` holds rows of length `n`, at most `n` of them.
pub(crate) fn orthogonalize_rows<D: Dimension>(dim: D, t: &mut [f64]) {
    let n = dim.get();
    let rows = t.len() / n;
    // Convergence is quadratic after a few sweeps; thirty bound it for NaN and nothing else.
    for _ in 0..30 {
        let mut rotated = false;
        for i in 0..rows {
            for j in i + 1..rows {
                let (head, tail) = t.split_at_mut(j * n);
                let a = &mut head[i * n..i * n + n];
                let b = &mut tail[..n];
                let (aa, bb, ab) = (dot(a, a), dot(b, b), dot(a, b));
                if !(ab.abs() > 4.0 * UNIT_ROUNDOFF * aa.sqrt() * bb.sqrt()) {
                    continue;
                }
                rotated = true;
                // The rotation (c, s) with (c·a − s·b)·(s·a + c·b) = 0, t = s/c the root of least size of t² + 2ζt −
                // 1 = 0.
                let zeta = (bb - aa) / (2.0 * ab);
                let tangent = zeta.signum() / (zeta.abs() + (zeta * zeta + 1.0).sqrt());
                let c = 1.0 / (tangent * tangent + 1.0).sqrt();
                let s = c * tangent;
                for (x, y) in a.iter_mut().zip(b) {
                    (*x, *y) = (c * *x - s * *y, s * *x + c * *y);
                }
            }
        }
        if !rotated {
            break;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::dimension::{Const, Dynamic};

    #[test]
    fn cholesky_solves_and_gives_the_determinant() {
        let a = [4.0, 2.0, 1.0, 2.0, 5.0, 3.0, 1.0, 3.0, 6.0];
        let mut l = a;
        let log_det = cholesky_log_det(Const::<3>, &mut l).expect("positive definite");
        assert!((log_det - 67f64.ln()).abs() < 1e-15, "ln det = {log_det}");
        let mut x = [1.0, 2.0, 3.0];
        solve_factored(Const::<3>, &l, &mut x);
        for (row, want) in a.chunks(3).zip([1.0, 2.0, 3.0]) {
            assert!((dot(row, &x) - want).abs() < 1e-14, "residual of row {row:?}");
        }
    }

    #[test]
    fn cholesky_refuses_the_indefinite_and_nan() {
        assert!(!cholesky(Dynamic(2), &mut [1.0, 2.0, 2.0, 1.0]), "indefinite");
        assert!(!cholesky(Dynamic(2), &mut [1.0, f64::NAN, f64::NAN, 1.0]), "NaN");
    }

    #[test]
    fn graded_columns_keep_every_singular_value() {
        // W·diag(1e12, 1, 1e-12): the product of the row norms is the determinant.
        let w = [[0.6, 0.8, 0.1], [-0.8, 0.6, 0.3], [0.2, 0.4, 0.9]];
        let det = 0.6 * (0.54 - 0.12) - 0.8 * (-0.72 - 0.06) + 0.1 * (-0.32 - 0.12);
        let d = [1e12, 1.0, 1e-12];
        let mut t: Vec<f64> = w.iter().flat_map(|row| row.iter().zip(d).map(|(w, d)| w * d)).collect();
        triangularize(Dynamic(3), &mut t);
        orthogonalize_rows(Dynamic(3), &mut t);
        let product: f64 = t.chunks(3).map(|row| dot(row, row).sqrt()).product();
        assert!((product - det).abs() < 1e-14, "{product} against {det}");
    }

    #[test]
    fn orthogonalized_rows_keep_the_gram_matrix_of_columns() {
        let t = [1e8, 2e8, -1e8, 1.0, 3.0, 1.0, 1e-9, 0.0, 2e-9];
        let mut r = t;
        triangularize(Const::<3>, &mut r);
        orthogonalize_rows(Const::<3>, &mut r);
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            let (a, b) = (&r[3 * i..3 * i + 3], &r[3 * j..3 * j + 3]);
            let cosine = dot(a, b) / (dot(a, a).sqrt() * dot(b, b).sqrt());
            assert!(cosine.abs() < 1e-15, "rows {i} and {j}: cosine {cosine}");
        }
        for i in 0..3 {
            for j in 0..3 {
                let gram = |t: &[f64]| (0..3).map(|k| t[3 * k + i] * t[3 * k + j]).sum::<f64>();
                assert!((gram(&r) - gram(&t)).abs() <= 1e-14 * 6e16, "entry {i},{j}");
            }
        }
    }
}
