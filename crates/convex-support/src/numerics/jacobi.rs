//! Principal axes of a small symmetric positive definite matrix.

use super::coordinates::dot;
use super::double_double::DoubleDouble;
use super::elementary::{hypot, sqrt};
use super::range::power_of_two_below;
use crate::InvalidShape;

/// The eigenvectors (unit, one per row of `directions`, right-handed) of a symmetric positive definite matrix, and the
/// roots of its eigenvalues.
#[derive(Clone, Copy, Debug)]
pub struct Axes {
    pub directions: [[f64; 3]; 3],
    pub roots: [f64; 3],
}

/// One-sided Jacobi converges quadratically; a 3×3 matrix needs five sweeps or so.
const MAX_SWEEPS: usize = 40;

/// Axes of the leading `n`×`n` block of `x`, symmetric up to relative rounding errors of `epsilon`.
///
/// First `X = G·Gᵀ` by Cholesky's method, always pivoting on the largest remaining diagonal entry, so that column `k`
/// of `G` is the rest of the pivot column over the root of the pivot. A thin ellipsoid turned out of the coordinate
/// axes has its long axis in the last digits of the entries, where pivots cancel. So they are kept to twice the digits:
/// the matrix counts as given, and is refused only if it is not positive definite. Then rotations of pairs of columns
/// make them orthogonal, which leaves `G·Gᵀ` as it is; in the end the columns are `√λᵢ·vᵢ`. Unlike the QR method this
/// finds small eigenvalues to high relative accuracy (Demmel and Veselić, *Jacobi's method is more accurate than
/// QR*, 1992).
pub fn axes(mut x: [[f64; 3]; 3], n: usize, epsilon: f64) -> Result<Axes, InvalidShape> {
    // In units of an even power of two near the largest entry, neither products nor roots leave the range of numbers.
    let root = power_of_two_below(sqrt(x.iter().flatten().fold(0.0f64, |a, b| a.max(b.abs()))));
    x = x.map(|row| row.map(|entry| entry / root / root));
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

    let mut x = x.map(|row| row.map(DoubleDouble::from));
    let mut g = [[0.0; 3]; 3];
    let mut left: [bool; 3] = core::array::from_fn(|i| i < n);
    for column in g.iter_mut().take(n) {
        let pivot = (0..n).filter(|&i| left[i]).fold(None, |best: Option<usize>, i| match best {
            Some(b) if x[b][b].high >= x[i][i].high => Some(b),
            _ => Some(i),
        });
        let Some(p) = pivot else { break };
        if x[p][p].high.is_nan() || x[p][p].high <= 0.0 {
            return Err(InvalidShape::NotPositiveDefinite);
        }
        left[p] = false;
        let pivot_root = sqrt(x[p][p].high);
        *column = core::array::from_fn(|i| if i == p || (i < n && left[i]) { x[i][p].high / pivot_root } else { 0.0 });
        let pivot_row = x[p];
        for i in 0..n {
            let factor = pivot_row[i] / pivot_row[p];
            for j in 0..n {
                x[i][j] = x[i][j] - factor * pivot_row[j];
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

    let lengths: [f64; 3] = core::array::from_fn(|k| sqrt(dot(g[k], g[k])));
    let mut directions: [[f64; 3]; 3] = core::array::from_fn(|k| g[k].map(|c| c / lengths[k]));
    if lengths[..n].iter().any(|&l| !(l > 0.0 && l.is_finite())) {
        return Err(InvalidShape::NotPositiveDefinite);
    }
    if handedness(&directions, n) < 0.0 {
        directions[n - 1] = directions[n - 1].map(|c| -c);
    }
    Ok(Axes { directions, roots: lengths.map(|length| length * root) })
}

/// Rotates columns `i` and `j` of `g` within their plane until they are orthogonal. Returns whether they were not.
fn orthogonalise(g: &mut [[f64; 3]; 3], i: usize, j: usize) -> bool {
    let (a, b, c) = (dot(g[i], g[i]), dot(g[j], g[j]), dot(g[i], g[j]));
    if c.abs() <= f64::EPSILON * sqrt(a * b) {
        return false;
    }
    // tan 2θ = 2c/(b − a); t is the smaller of the two tangents of θ.
    let zeta = (b - a) / (2.0 * c);
    let t = zeta.signum() / (zeta.abs() + hypot(zeta, 1.0));
    let cosine = 1.0 / hypot(t, 1.0);
    let sine = cosine * t;
    let (p, q) = (g[i], g[j]);
    g[i] = core::array::from_fn(|k| cosine * p[k] - sine * q[k]);
    g[j] = core::array::from_fn(|k| sine * p[k] + cosine * q[k]);
    true
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
        let product: f64 = axes.roots.iter().product();
        assert!((product / (2.0 * s.powi(3)) - 1.0).abs() < 1e-13, "{product}");
    }

    #[test]
    fn rebuilds_the_matrix() {
        let x = [[4.0, 1.0, -2.0], [1.0, 3.0, 0.5], [-2.0, 0.5, 6.0]];
        let Axes { directions, roots } = axes(x, 3, f64::EPSILON).expect("positive definite");
        for i in 0..3 {
            for j in 0..3 {
                let entry: f64 = (0..3).map(|k| roots[k] * roots[k] * directions[k][i] * directions[k][j]).sum();
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
