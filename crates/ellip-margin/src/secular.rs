//! The secular equation in the singular basis: right at any condition.
//!
//! With B = UΣVᵀ, ĉ = Vᵀc and rᵢ = (σ_max/σᵢ)² ≥ 1, the point of E₂ nearest to x₁ in the norm of P has the coordinates
//! x̂ᵢ = ĉᵢ/(1 + τrᵢ) in the basis V of the ball, where τ = ν/σ_max² ≥ 0 solves
//!
//! > φ(τ)² = Σ ĉᵢ²/(1 + τrᵢ)² = 1.
//!
//! No term cancels, and nothing over- or underflows before the answer does. 1/φ is concave in τ, so that Newton's
//! method for 1/φ(τ) = 1 (Hebden 1973; Moré and Sorensen 1983) rises to the root from any τ below it, and comes back
//! below in one step from above.

use convex_support::numerics::elementary::{hypot, sqrt};

use crate::numerics::{Svd, Vec, combine, dot, size, sub, svd};
use crate::pair::Pair;
use crate::{MarginOptions, Status};

/// The nearest point of E₂ in coordinates of the ball, with ν, m, and how they were found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Solution<const N: usize> {
    pub(crate) nu: f64,
    /// x* = x₂ + R₂·diag(a₂)·y.
    pub(crate) y: Vec<N>,
    pub(crate) margin: f64,
    pub(crate) status: Status,
    pub(crate) iterations: usize,
}

impl<const N: usize> Solution<N> {
    /// x₁ lies in E₂: x* = x₁.
    pub(crate) fn inside(c: Vec<N>) -> Self {
        Self { nu: 0.0, y: c, margin: -1.0, status: Status::Converged, iterations: 0 }
    }
}

/// `‖c‖² − 1`, compensated if it is small.
#[inline]
pub(crate) fn excess<const N: usize>(pair: &Pair<N>, c: Vec<N>) -> f64 {
    let plain = dot(c, c) - 1.0;
    if plain.abs() < 0.25 { pair.compensated_excess() } else { plain }
}

/// Solves from `nu` (0 if unknown), reporting each iterate (ν, φ).
#[cold]
#[inline(never)]
pub(crate) fn solve<const N: usize>(
    pair: Pair<N>,
    start: f64,
    options: MarginOptions,
    mut observer: impl FnMut(f64, f64),
) -> Solution<N> {
    let (c, g) = pair.c_and_g();
    let excess = excess(&pair, c);
    if excess <= 0.0 {
        return Solution::inside(c);
    }

    let basis = svd(pair.b());
    let Svd { sigma, v, .. } = basis;
    let largest = sigma.iter().fold(0.0f64, |m, s| m.max(*s));
    let ratio = sigma.map(|s| (largest / s) * (largest / s));
    let ball = basis.coordinates(c, g);

    // Below the root: where one term alone would be 1; where φ would be 1 if all rᵢ were their mean, with the weights
    // of ĉ² (a step of Newton's method from τ = 0) or of (ĉᵢ/rᵢ)² (a step from infinity).
    let squares = ball.map(|x| x * x);
    let mut low = (0..N).fold(0.0f64, |m, i| m.max((ball[i].abs() - 1.0) / ratio[i]));
    let b: Vec<N> = core::array::from_fn(|i| ball[i] / ratio[i]);
    let (bb, mean) = (dot(b, b), (0..N).map(|i| b[i] * b[i] / ratio[i]).sum::<f64>());
    low = low.max(sqrt(bb) - mean / bb);
    let norm_c = sqrt(dot(c, c));
    let newton = excess / (1.0 + norm_c) * (norm_c * norm_c) / (0..N).map(|i| squares[i] * ratio[i]).sum::<f64>();
    low = low.max(newton);

    let scale = largest * largest;
    let mut tau = low.max(start / scale);
    let (mut status, mut iterations) = (Status::IterationLimit, 0);
    let (mut x, mut rises) = (ball, false);
    while iterations < options.max_iterations {
        iterations += 1;
        let (mut phi2, mut slope, mut above) = (0.0, 0.0, excess);
        for i in 0..N {
            let denominator = 1.0 + tau * ratio[i];
            x[i] = ball[i] / denominator;
            let square = x[i] * x[i];
            phi2 += square;
            slope += square * ratio[i] / denominator;
            above -= square * (tau * ratio[i]) * (1.0 + denominator);
        }
        // φ² − 1, by the difference that cancels less.
        let above = if excess < 1.0 { above } else { phi2 - 1.0 };
        let phi = sqrt(phi2);
        observer(tau * scale, phi);
        // (φ − 1)·φ²/t
        let step = above / (1.0 + phi) * phi2 / slope;
        let next = (tau + step).max(low);
        let change = (next - tau).abs();
        if !change.is_finite() {
            status = Status::Stalled;
            break;
        }
        tau = next;
        // Newton's method squares the error. From below it rises to the root, and only rounding takes it back: where φ
        // is flat, there are no more digits of τ. (A start far above the root may take two steps back, because ε times
        // it is large.)
        if change * change <= options.tolerance() * (tau * tau) || (rises && step <= 0.0) {
            status = Status::Converged;
            break;
        }
        rises = step > 0.0;
    }
    for i in 0..N {
        x[i] = ball[i] / (1.0 + tau * ratio[i]);
    }
    // The last rounding errors of τ go into the length; the unit vector is a point of E₂.
    let norm = sqrt(dot(x, x));
    let x = x.map(|x| x / norm);
    let nu = tau * scale;
    let y = combine(v, x);
    let margin = plain_margin(&pair, y).unwrap_or_else(|| refined_margin(&pair, &basis, y, nu));
    // Sizes beyond the square root of the range of `f64`: x₁ is outside, so that ν is positive.
    let status = if margin.is_finite() && nu.is_finite() && nu > 0.0 { status } else { Status::Stalled };
    Solution { nu, y, margin, status, iterations }
}

/// m = ‖w‖² − 1 for the unit vector y, with w = diag(a₁)⁻¹R₁ᵀ(v − r), v = x* − x₂ = R₂·diag(a₂)y; by the compensated
/// Lagrangian if rounding could show in m.
#[cfg(feature = "paper")]
#[inline]
pub(crate) fn margin<const N: usize>(pair: &Pair<N>, y: Vec<N>, nu: f64) -> f64 {
    plain_margin(pair, y).unwrap_or_else(|| pair.compensated_margin(y, nu))
}

/// ‖w‖² − 1; `None` if rounding could show.
///
/// The nearest of the points of E₂ is stationary, so that the rounding errors of y enter squared, and those of ν not at
/// all. There remain errors of about ε(‖v‖ + ‖r‖) in the units of space, which are divided by E₁'s least semi-axis in
/// w.
#[inline]
fn plain_margin<const N: usize>(pair: &Pair<N>, y: Vec<N>) -> Option<f64> {
    let (v, r) = (pair.out_of_ball(y), pair.r());
    let p = sub(v, r);
    let w: Vec<N> = core::array::from_fn(|i| dot(pair.axes1[i], p) / pair.a1[i]);
    let squared = dot(w, w);
    let plain = squared - 1.0;
    let least = (1..N).fold(pair.a1[0], |m, i| m.min(pair.a1[i]));
    // (‖v‖ + ‖r‖)‖w‖/a₁ against 64·m
    let sure = (size(v) + size(r)) * sqrt(squared) < 64.0 * (plain.abs() * least);
    (sure || !squared.is_finite()).then_some(plain)
}

/// The compensated Lagrangian less the contribution of the rounding of y.
///
/// If E₁ is thinner than the rounding of E₂'s points, y is not resolved to E₁'s size: `‖B‖²ε²` is no longer small. But
/// the Lagrangian is quadratic in y, so that with h = Bᵀw + νy, half its gradient, its least value for this ν is
///
/// > L(y) − hᵀ(C + ν)⁻¹h = L(y) − Σ (σᵢ·(uᵢ·w) + ν·(vᵢ·y))²/(σᵢ² + ν),
///
/// in the singular basis: the margin to the square of the error of ν.
#[inline(never)]
fn refined_margin<const N: usize>(pair: &Pair<N>, basis: &Svd<N>, y: Vec<N>, nu: f64) -> f64 {
    let (lagrangian, w) = pair.compensated_lagrangian(y, nu);
    let mut excess = 0.0;
    for i in 0..N {
        let sigma = basis.sigma[i];
        let root = hypot(sigma, sqrt(nu));
        let part = (sigma / root) * dot(basis.u[i], w) + (nu / root) * dot(basis.v[i], y);
        excess += part * part;
    }
    if excess.is_finite() { lagrangian - excess } else { lagrangian }
}
