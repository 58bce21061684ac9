//! The bound that the multipliers of an iterate prove, with the rounding of the proof.
//!
//! The multipliers y ≥ 0, the vectors vᵢ and the computed pᵢ are taken to be exactly their doubles. The body is { z :
//! Pᵢ·z ≤ 1 + βᵢ } with |Pᵢ − pᵢ| ≤ εᵢ|pᵢ|, and it lies in the ball of radius R about zero. With S = Σyᵢ·sym(pᵢvᵢᵀ)
//! every (B', d') in it has
//!
//! > tr(B'S) = Σyᵢ vᵢᵀB'pᵢ ≤ max|vᵢ|·Σyᵢ|B'pᵢ| ≤ max|vᵢ|·(Σyᵢ(1 + βᵢ) + |Σyᵢpᵢ|R + Σyᵢεᵢ|pᵢ|R) = T,
//!
//! since |B'pᵢ| + pᵢ·d', the most that pᵢ·x is in the ellipsoid, is at most 1 + βᵢ + εᵢ|pᵢ|R. So ln det B' ≤ N·ln(T/N)
//! − ln det S.
//!
//! *R.* Let vᵢ = B·pᵢ/hᵢ be of unit length, z = Bζ a point of the body, and G = Σyᵢhᵢvᵢvᵢᵀ = B·S. From 1 − pᵢ·z ≥ 0 and
//! vᵢ·ζ ≥ −|ζ| follows
//!
//! > 0 ≤ Σyᵢ(1 − pᵢ·z)(|ζ| + vᵢ·ζ) ≤ |ζ|(1 + |Σyᵢvᵢ|) − ζᵀGζ, so that |ζ| ≤ (1 + |Σyᵢvᵢ|)/λ_min(G)
//!
//! (at the optimum G = I/N, and if Σyᵢvᵢ = 0 this is John's N). A tenth more covers errors of the pᵢ and Σyᵢpᵢ that are
//! small as below.

use crate::inscribed::point::Point;
use crate::numerics::dimension::Dimension;
use crate::numerics::linalg::{UNIT_ROUNDOFF, cholesky, cholesky_log_det, dot, solve_factored};
use crate::numerics::twofold::Sum;

/// The largest share of one by which errors may move the constraints with weight if the proof is to hold.
const MOVED_SHARE: f64 = 0.01;

/// An upper bound of ln det B' for every ellipsoid { d' + B'u : |u| ≤ 1 } in { z : Pᵢ·z ≤ 1 + βᵢ }; infinite if the
/// multipliers prove nothing.
///
/// `error` contains the εᵢ, and `beyond(i, yᵢ)` returns βᵢ ≥ 0.
pub(crate) fn log_det_at_most<D: Dimension>(
    dim: D,
    p: &[f64],
    point: &Point,
    y: &[f64],
    error: &[f64],
    beyond: &dyn Fn(usize, f64) -> f64,
) -> f64 {
    let n = dim.get();
    let mut entries = vec![Sum::default(); n * n];
    let mut residual = vec![Sum::default(); n];
    let (mut total, mut size, mut moved) = (Sum::default(), 0.0, 0.0);
    let (mut mean, mut gram) = (dim.zero(), dim.zero_matrix());
    let gram = &mut gram.as_mut()[..n * n];
    let rows = p.chunks_exact(n).zip(point.v.chunks_exact(n)).zip(&point.h);
    for (i, ((p, v), h)) in rows.enumerate().filter(|(i, _)| y[*i] > 0.0) {
        let length = y[i] * dot(p, p).sqrt();
        size += length;
        moved += error[i] * length;
        total.add(y[i]);
        total.add(y[i] * beyond(i, y[i]));
        for j in 0..n {
            residual[j].add_product(y[i], p[j]);
            mean.as_mut()[j] += y[i] * v[j];
            for k in 0..=j {
                entries[j * n + k].add(0.5 * y[i] * (p[j] * v[k] + p[k] * v[j]));
                gram[j * n + k] += y[i] * h * v[j] * v[k];
            }
        }
    }
    let mut s = dim.matrix(entries.iter().map(Sum::total));
    let s = &mut s.as_mut()[..n * n];
    if !cholesky(dim, gram) {
        return f64::INFINITY;
    }
    let Some(log_det) = cholesky_log_det(dim, s) else { return f64::INFINITY };
    let mean = dot(mean.as_ref(), mean.as_ref()).sqrt();
    let radius = 1.1 * (1.0 + mean) * dot(&point.b, &point.b).sqrt() * norm_of_inverse(dim, gram);
    let residual = residual.iter().map(|r| r.total()).map(|r| r * r).sum::<f64>().sqrt();
    let unit = n as f64 * UNIT_ROUNDOFF;
    // The rounding of Σyᵢpᵢ = 0 is at least that of its own evaluation.
    let bent = (residual + moved + UNIT_ROUNDOFF * size) * radius;
    // Entries of S, and its factor, are rounded: ln det(S + E) ≥ ln det S − 1.1·|S⁻¹||E| for small errors E.
    let loosened = (unit + 8.0 * UNIT_ROUNDOFF) * size * norm_of_inverse(dim, s);
    if !(bent < MOVED_SHARE && loosened < MOVED_SHARE) {
        return f64::INFINITY;
    }
    let trace = (total.total() + bent) * (1.0 + 2.0 * unit + 8.0 * UNIT_ROUNDOFF);
    n as f64 * libm::log(trace / n as f64) - log_det + 1.1 * loosened + 4.0 * (unit + UNIT_ROUNDOFF)
}

/// |(L·Lᵀ)⁻¹|, by the sum of the squares of its entries: no less than its largest eigenvalue.
fn norm_of_inverse<D: Dimension>(dim: D, l: &[f64]) -> f64 {
    let column = |k: usize| {
        let mut e = dim.zero();
        e.as_mut()[k] = 1.0;
        solve_factored(dim, l, e.as_mut());
        dot(e.as_ref(), e.as_ref())
    };
    (0..dim.get()).map(column).sum::<f64>().sqrt()
}
