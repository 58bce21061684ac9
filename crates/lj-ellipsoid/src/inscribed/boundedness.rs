//! Is an intersection of half-spaces bounded?

use crate::inscribed::coordinates::Rows;
use crate::numerics::dimension::Dimension;
use crate::numerics::linalg::{cholesky, dot, solve_factored};

/// Whether half-spaces are open in some direction.
pub(crate) enum Opening {
    /// They are open in none.
    None,
    /// The caller has proved one.
    Proved,
    /// The rows are as nearly open as rounding can resolve: in some direction none of them rises by more than this
    /// share of the others' fall.
    Nearly { ratio: f64 },
}

/// The most Newton steps. Each can change the logarithm of a multiplier by one or more, so that ratios can span the
/// range of `f64`.
const MOST_BARRIER_STEPS: usize = 1000;

/// If the ascent of a row is this small against the descents of others, it is tested exactly.
const LITTLE: f64 = 1e-9;

/// Searches for a direction z with aᵢ·z ≤ 0 for all rows, which span the space and are of unit length.
///
/// The least of g(z) = Σexp(aᵢ·z) exists exactly if there is none: there yᵢ = exp(aᵢ·z) has Σyᵢaᵢ = 0, so that the rows
/// span the space with positive combinations (Stiemke's lemma). A Newton step Δ gives multipliers yᵢ(1 + aᵢ·Δ) with the
/// same sum of zero. If none of them is negative, they prove it, whatever the ratios of the yᵢ, which are those of the
/// faces of a needle or plate, down to zero. Otherwise Δ turns towards an open direction, which `is_open` tests with
/// the half-spaces themselves.
pub(crate) fn opening<D: Dimension>(dim: D, rows: &Rows, is_open: &dyn Fn(&[f64]) -> bool) -> Opening {
    let n = dim.get();
    let mut exponents = vec![0.0; rows.s.len()];
    let mut ratio = 0.0;
    for _ in 0..MOST_BARRIER_STEPS {
        let most = exponents.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let y: Vec<f64> = exponents.iter().map(|e| libm::exp(e - most)).collect();
        let (mut step, mut hessian) = (dim.zero(), dim.zero_matrix());
        let (step, hessian) = (&mut step.as_mut()[..n], &mut hessian.as_mut()[..n * n]);
        for ((a, _), y) in rows.iter().zip(&y) {
            for i in 0..n {
                step[i] -= y * a[i];
                for j in 0..=i {
                    hessian[i * n + j] += y * a[i] * a[j];
                }
            }
        }
        if !cholesky(dim, hessian) {
            break;
        }
        solve_factored(dim, hessian, step);
        let changes: Vec<f64> = rows.iter().map(|(a, _)| dot(a, step)).collect();
        if changes.iter().zip(&y).all(|(x, y)| *y == 0.0 || *x > -0.5) {
            return Opening::None;
        }
        let highest = changes.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let largest = changes.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        if highest <= LITTLE * largest && is_open(step) {
            return Opening::Proved;
        }
        ratio = highest.max(0.0) / largest;
        // A whole step, or one that changes no exponent by more than one: g always descends along it.
        let at =
            |length: f64| exponents.iter().zip(&changes).map(|(e, x)| libm::exp(e + length * x - most)).sum::<f64>();
        let (now, slope) = (y.iter().sum::<f64>(), dot(&y, &changes));
        let mut length = 1.0;
        while length * largest > 1.0 && !(at(length) <= now + 0.1 * length * slope) {
            length *= 0.5;
        }
        exponents.iter_mut().zip(&changes).for_each(|(e, x)| *e += length * x);
    }
    Opening::Nearly { ratio }
}
