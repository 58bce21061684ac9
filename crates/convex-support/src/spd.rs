//! Principal axes of a small symmetric positive definite matrix.

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use crate::InvalidShape;

/// The eigenvectors (unit, one per row of `directions`, right-handed) and eigenvalues of a symmetric matrix.
pub(crate) struct Axes {
    pub(crate) directions: [[f64; 3]; 3],
    pub(crate) eigenvalues: [f64; 3],
}

/// One-sided Jacobi converges quadratically; a 3×3 matrix needs five sweeps or so.
const MAX_SWEEPS: usize = 40;

/// Axes of the leading `n`×`n` block of `x`, whose entries carry relative rounding errors of `epsilon`.
///
/// First `X = G·Gᵀ` by Cholesky's method, always pivoting on the largest remaining diagonal entry, so that column `k`
/// of `G` is what is left of the pivot column over the root of the pivot. Then rotations of pairs of columns make them
/// orthogonal, which leaves `G·Gᵀ` as it is; in the end the columns are `√λᵢ·vᵢ`. Unlike the QR method this finds small
/// eigenvalues to high relative accuracy (Demmel and Veselić, *Jacobi's method is more accurate than QR*, 1992).
pub(crate) fn axes(mut x: [[f64; 3]; 3], n: usize, epsilon: f64) -> Result<Axes, InvalidShape> {
    let largest = x.iter().flatten().fold(0.0f64, |a, b| a.max(b.abs()));
    for (row, column) in [(1, 0), (2, 0), (2, 1)] {
        if row < n {
            if (x[row][column] - x[column][row]).abs() > 64.0 * epsilon * largest {
                return Err(InvalidShape::NotSymmetric { row, column });
            }
            let mean = 0.5 * x[row][column] + 0.5 * x[column][row];
            (x[row][column], x[column][row]) = (mean, mean);
        }
    }

    let diagonal = [x[0][0], x[1][1], x[2][2]];
    let mut g = [[0.0; 3]; 3];
    let mut left: [bool; 3] = core::array::from_fn(|i| i < n);
    for column in g.iter_mut().take(n) {
        let pivot = (0..n).filter(|&i| left[i]).fold(None, |best: Option<usize>, i| match best {
            Some(b) if x[b][b] >= x[i][i] => Some(b),
            _ => Some(i),
        });
        let Some(p) = pivot else { break };
        // A pivot that has cancelled down to the rounding of its own entry cannot be told from zero.
        if x[p][p].is_nan() || x[p][p] <= 4.0 * epsilon * diagonal[p].abs() {
            return Err(InvalidShape::NotPositiveDefinite);
        }
        left[p] = false;
        let root = x[p][p].sqrt();
        *column = core::array::from_fn(|i| if i == p || (i < n && left[i]) { x[i][p] / root } else { 0.0 });
        for i in 0..n {
            for j in 0..n {
                x[i][j] -= column[i] * column[j];
            }
        }
    }

    for _ in 0..MAX_SWEEPS {
        let mut rotated = false;
        for i in 0..n {
            for j in i + 1..n {
                rotated |= orthogonalise(&mut g, i, j);
            }
        }
        if !rotated {
            break;
        }
    }

    let eigenvalues: [f64; 3] = core::array::from_fn(|k| dot(g[k], g[k]));
    let mut directions: [[f64; 3]; 3] = core::array::from_fn(|k| {
        let norm = eigenvalues[k].sqrt();
        g[k].map(|c| c / norm)
    });
    if eigenvalues[..n].iter().any(|&l| !(l > 0.0 && l.is_finite())) {
        return Err(InvalidShape::NotPositiveDefinite);
    }
    if handedness(&directions, n) < 0.0 {
        directions[n - 1] = directions[n - 1].map(|c| -c);
    }
    Ok(Axes { directions, eigenvalues })
}

/// Rotates columns `i` and `j` of `g` within their plane until they are orthogonal; says whether it had to.
fn orthogonalise(g: &mut [[f64; 3]; 3], i: usize, j: usize) -> bool {
    let (a, b, c) = (dot(g[i], g[i]), dot(g[j], g[j]), dot(g[i], g[j]));
    if c.abs() <= f64::EPSILON * (a * b).sqrt() {
        return false;
    }
    // tan 2θ = 2c/(b − a); t is the smaller of the two tangents of θ.
    let zeta = (b - a) / (2.0 * c);
    let t = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
    let cosine = 1.0 / t.hypot(1.0);
    let sine = cosine * t;
    let (p, q) = (g[i], g[j]);
    g[i] = core::array::from_fn(|k| cosine * p[k] - sine * q[k]);
    g[j] = core::array::from_fn(|k| sine * p[k] + cosine * q[k]);
    true
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The determinant of the leading block of unit rows, by its sign.
fn handedness(d: &[[f64; 3]; 3], n: usize) -> f64 {
    let minor = |i: usize, j: usize| d[0][i] * d[1][j] - d[0][j] * d[1][i];
    if n == 2 { minor(0, 1) } else { d[2][2] * minor(0, 1) - d[2][1] * minor(0, 2) + d[2][0] * minor(1, 2) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_eigenvalues_keep_their_digits() {
        // diag(1, s, s²)·[[2,1,0],[1,2,1],[0,1,2]]·diag(1, s, s²) is graded: its determinant is exactly 4·s⁶.
        let s = 1e-5;
        let d = [1.0, s, s * s];
        let t = [[2.0, 1.0, 0.0], [1.0, 2.0, 1.0], [0.0, 1.0, 2.0]];
        let x = core::array::from_fn(|i| core::array::from_fn(|j| d[i] * t[i][j] * d[j]));
        let axes = axes(x, 3, f64::EPSILON).expect("positive definite");
        let product: f64 = axes.eigenvalues.iter().product();
        assert!((product / (4.0 * s.powi(6)) - 1.0).abs() < 1e-13, "{product}");
    }

    #[test]
    fn rebuilds_the_matrix() {
        let x = [[4.0, 1.0, -2.0], [1.0, 3.0, 0.5], [-2.0, 0.5, 6.0]];
        let Axes { directions, eigenvalues } = axes(x, 3, f64::EPSILON).expect("positive definite");
        for i in 0..3 {
            for j in 0..3 {
                let entry: f64 = (0..3).map(|k| eigenvalues[k] * directions[k][i] * directions[k][j]).sum();
                assert!((entry - x[i][j]).abs() < 1e-14, "entry ({i}, {j}): {entry}");
            }
        }
        assert!(handedness(&directions, 3) > 0.0, "right-handed");
    }

    #[test]
    fn refuses_what_is_not_positive_definite() {
        let e = f64::EPSILON;
        let diagonal = |a, b, c| [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]];
        assert!(matches!(axes(diagonal(1.0, 0.0, 1.0), 3, e), Err(InvalidShape::NotPositiveDefinite)), "singular");
        assert!(matches!(axes(diagonal(1.0, -1.0, 1.0), 3, e), Err(InvalidShape::NotPositiveDefinite)), "indefinite");
        let lopsided = [[1.0, 0.5, 0.0], [0.0, 1.0, 0.0], [0.0; 3]];
        assert!(matches!(axes(lopsided, 2, e), Err(InvalidShape::NotSymmetric { row: 1, column: 0 })), "not symmetric");
    }
}
