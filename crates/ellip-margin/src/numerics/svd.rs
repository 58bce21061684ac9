//! The singular values of a small matrix `D₁·M·D₂` with diagonal `D₁`, `D₂` of any grading, to high relative accuracy.
//!
//! Householder's QR factorisation with rows sorted and columns pivoted makes small errors in *every row and column*
//! (Cox and Higham 1998), leaving a triangle that is a diagonal times a well-conditioned matrix; rotations of pairs of
//! its rows until they are orthogonal then find each singular value to its own last digits (Demmel and Veselić 1992;
//! Drmač and Veselić, *New fast and accurate Jacobi SVD algorithm*, 2008). Forming BᵀB first would lose all of
//! those below 1e-8 of the largest.

use convex_support::numerics::elementary::sqrt;

use super::{Vec, dot};

/// `B = Σₖ σₖ·uₖ·vₖᵀ`; the vectors are unit and mutually orthogonal, the values in no particular order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Svd<const N: usize> {
    pub(crate) sigma: Vec<N>,
    pub(crate) u: [Vec<N>; N],
    pub(crate) v: [Vec<N>; N],
}

impl<const N: usize> Svd<N> {
    /// ĉ = Vᵀc = Σ⁻¹Uᵀg of two vectors with g = Bc: each coordinate from the side with the smaller rounding error.
    pub(crate) fn coordinates(&self, c: Vec<N>, g: Vec<N>) -> Vec<N> {
        let Self { sigma, u, v } = self;
        let (norm_c, norm_g) = (sqrt(dot(c, c)), sqrt(dot(g, g)));
        core::array::from_fn(|i| if norm_g < sigma[i] * norm_c { dot(u[i], g) / sigma[i] } else { dot(v[i], c) })
    }
}

/// Jacobi's method converges quadratically; after the pivoted factorisation it needs three sweeps or so.
const MAX_SWEEPS: usize = 30;

/// The singular value decomposition of `b`, given by its rows.
pub(crate) fn svd<const N: usize>(b: [Vec<N>; N]) -> Svd<N> {
    // Squares must stay in range.
    let largest = b.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let scale = if (1e-100..1e100).contains(&largest) { 1.0 } else { largest };

    let size = |i: &usize| b[*i].iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let mut rows: [usize; N] = core::array::from_fn(|i| i);
    rows.sort_unstable_by(|i, j| size(j).total_cmp(&size(i)));
    let mut a: [Vec<N>; N] = core::array::from_fn(|i| b[rows[i]].map(|x| x / scale));

    let mut columns: [usize; N] = core::array::from_fn(|i| i);
    let mut reflectors = [[0.0; N]; N]; // H = I − h·hᵀ
    for k in 0..N - 1 {
        let rest = |a: &[Vec<N>; N], j: usize| (k..N).map(|i| a[i][j] * a[i][j]).sum::<f64>();
        let pivot = (k + 1..N).fold(k, |p, j| if rest(&a, j) > rest(&a, p) { j } else { p });
        columns.swap(k, pivot);
        for row in &mut a {
            row.swap(k, pivot);
        }
        let norm = sqrt(rest(&a, k));
        if norm == 0.0 {
            break;
        }
        let mut h: Vec<N> = core::array::from_fn(|i| if i < k { 0.0 } else { a[i][k] });
        h[k] += norm.copysign(h[k]);
        // ‖h‖²/2 = norm·|h_k|
        let root = sqrt(norm * h[k].abs());
        h = h.map(|x| x / root);
        for j in k..N {
            let along: f64 = (k..N).map(|i| h[i] * a[i][j]).sum();
            for i in k..N {
                a[i][j] -= along * h[i];
            }
        }
        for row in a.iter_mut().skip(k + 1) {
            row[k] = 0.0;
        }
        reflectors[k] = h;
    }

    // J·R = W with orthogonal rows: R = Jᵀ·W.
    let mut turn: [Vec<N>; N] = core::array::from_fn(|i| core::array::from_fn(|j| f64::from(u8::from(i == j))));
    for _ in 0..MAX_SWEEPS {
        let mut rotated = false;
        for i in 0..N {
            for j in i + 1..N {
                rotated |= orthogonalise(&mut a, &mut turn, i, j);
            }
        }
        if !rotated {
            break;
        }
    }

    let norms = a.map(|row| sqrt(dot(row, row)));
    Svd {
        sigma: norms.map(|s| s * scale),
        u: turn.map(|row| {
            let mut u = row;
            for h in reflectors.iter().rev() {
                let along = dot(*h, u);
                u = core::array::from_fn(|i| u[i] - along * h[i]);
            }
            unpermuted(u, rows)
        }),
        v: core::array::from_fn(|k| unpermuted(a[k].map(|x| x / norms[k]), columns)),
    }
}

/// Rotates rows `i` and `j` of `a` within their plane until they are orthogonal, and those of `turn` alike. Returns
/// whether they were not.
fn orthogonalise<const N: usize>(a: &mut [Vec<N>; N], turn: &mut [Vec<N>; N], i: usize, j: usize) -> bool {
    let (p, q, pq) = (dot(a[i], a[i]), dot(a[j], a[j]), dot(a[i], a[j]));
    if pq.is_nan() || pq.abs() <= f64::EPSILON * (sqrt(p) * sqrt(q)) {
        return false;
    }
    // tan 2θ = 2pq/(q − p); t is the smaller of the two tangents of θ.
    let zeta = (q - p) / (2.0 * pq);
    let t = zeta.signum() / (zeta.abs() + sqrt(1.0 + zeta * zeta));
    let cosine = 1.0 / sqrt(1.0 + t * t);
    let sine = cosine * t;
    for m in [a, turn] {
        let (x, y) = (m[i], m[j]);
        m[i] = core::array::from_fn(|k| cosine * x[k] - sine * y[k]);
        m[j] = core::array::from_fn(|k| sine * x[k] + cosine * y[k]);
    }
    true
}

fn unpermuted<const N: usize>(x: Vec<N>, order: [usize; N]) -> Vec<N> {
    let mut result = [0.0; N];
    for (value, place) in x.into_iter().zip(order) {
        result[place] = value;
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn graded_on_both_sides() {
        // D₁·M·D₂ with M orthogonal: the product of the singular values is that of the diagonals, over 40 decades.
        let (c, s) = (0.8, 0.6);
        let m = [[c, -s * c, s * s], [s, c * c, -c * s], [0.0, s, c]];
        for (d1, d2) in [([1.0, 1e-7, 1e-14], [1e7, 1.0, 1e-7]), ([1e-14, 1.0, 1e-3], [1e-7, 1e7, 1e3])] {
            let b: [[f64; 3]; 3] = core::array::from_fn(|i| core::array::from_fn(|j| d1[i] * m[i][j] * d2[j]));
            let Svd { sigma, u, v } = svd(b);
            let product = d1.iter().chain(&d2).product::<f64>();
            assert!((sigma.iter().product::<f64>() / product - 1.0).abs() < 1e-14, "{sigma:?}");
            for i in 0..3 {
                for j in 0..3 {
                    let entry: f64 = (0..3).map(|k| u[k][i] * sigma[k] * v[k][j]).sum();
                    let row = b[i].iter().fold(0.0f64, |m, x| m.max(x.abs()));
                    assert!((entry - b[i][j]).abs() <= 2e-15 * row, "entry ({i}, {j}): {entry} for {}", b[i][j]);
                }
            }
        }
    }
}
