//! The secular equation as the paper's polynomial (9): fast where the condition is moderate.
//!
//! With C = BᵀB the nearest point of the ball is y(ν) = (C + ν)⁻¹b, b = Cc = Bᵀg. By cofactors
//!
//! > y(ν) = p(ν)/D(ν), D(ν) = det(C + ν), p(ν) = adj(C + ν)·b = det C·c + … + νᴺ⁻¹b,
//!
//! and in 3D the term between is ν(tr C·b − Cb). The coefficients of D are det C = Π(a₂/a₁)², tr C = ‖B‖² and det C·‖B⁻¹‖²,
//! sums and products of positive terms that keep their digits at any condition. All terms of p point the same way in
//! each eigendirection of C, so that ‖p‖ has the relative accuracy of its terms. What is lost, at most, are the
//! cancellations in Bᵀg and Cb: a factor of the condition of B. φ(ν) = ‖p‖/D = 1 is then an equation in one number,
//!
//! > N(ν) = D(ν)², N(ν) = ‖p(ν)‖², the paper's polynomial of degree 2N,
//!
//! to be solved by Newton's method for D/√N = 1 (Hebden), some thirty operations a step. (Halley's method takes fewer
//! steps, 2.3 for 2.9, and measures slower for it.)

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use crate::pair::{Pair, Vec, dot};
use crate::secular::{self, Solution};
use crate::{MarginOptions, Status};

/// The largest factor by which a sum of the coefficients may cancel: the relative errors of ν and y stay below this times
/// a few ε, 1e-12. Beyond it the singular basis is worth its price.
const MAX_LOSS: f64 = 2048.0;

/// Sizes of ‖B‖² and ‖c‖² up to which sixth powers stay far from the range of `f64`.
const MAX_SIZE: f64 = 1e20;

/// Solves from `start` (0 for none known), reporting each iterate (ν, φ); `None` where digits would be lost or x₁ is near
/// the boundary of E₂.
#[inline]
pub(crate) fn solve<const N: usize>(
    pair: &Pair<N>,
    start: f64,
    options: MarginOptions,
    mut observer: impl FnMut(f64, f64),
) -> Option<Solution<N>> {
    let (a1, a2) = (pair.a1, pair.a2);
    let (i1, i2): (Vec<N>, Vec<N>) = (core::array::from_fn(|i| 1.0 / a1[i]), core::array::from_fn(|j| 1.0 / a2[j]));
    let r = pair.r();
    let c: Vec<N> = core::array::from_fn(|j| dot(pair.axes2[j], r) * i2[j]);
    let cc = dot(c, c);
    if cc < 0.75 {
        return Some(Solution::inside(c));
    }
    let g: Vec<N> = core::array::from_fn(|i| dot(pair.axes1[i], r) * i1[i]);
    // B = diag(i₁)·M·diag(a₂), B⁻ᵀ = diag(a₁)·M·diag(i₂), with M = R₁ᵀR₂
    let m: [Vec<N>; N] = core::array::from_fn(|i| core::array::from_fn(|j| dot(pair.axes1[i], pair.axes2[j])));
    let norms = |outer: Vec<N>, inner: Vec<N>| {
        let squares = times(inner, inner);
        (0..N).fold(0.0, |sum, i| sum + outer[i] * outer[i] * dot(times(m[i], m[i]), squares))
    };
    let (norm_b, norm_a) = (norms(i1, a2), norms(a1, i2));
    let root_det = (0..N).fold(1.0, |product, i| product * (a2[i] * i1[i]));
    let det = root_det * root_det;

    let b = times(a2, transposed_times(&m, times(i1, g)));
    let bb = dot(b, b);
    let forward = times(i1, apply(&m, times(a2, b))); // Bb
    let low: Vec<N> = core::array::from_fn(|j| det * c[j]);
    let middle = if N == 3 {
        let cb = times(a2, transposed_times(&m, times(i1, forward)));
        core::array::from_fn(|j| norm_b * b[j] - cb[j])
    } else {
        [0.0; N]
    };
    let (gg, mm) = (dot(g, g), dot(middle, middle));

    let fits = cc > 1.25
        && cc < MAX_SIZE
        && norm_b < MAX_SIZE
        && norm_b > 1.0 / MAX_SIZE
        && norm_b * gg < MAX_LOSS * MAX_LOSS * bb
        && (N == 2 || norm_b * norm_b * bb < MAX_LOSS * MAX_LOSS * mm);
    if !fits {
        return None;
    }

    let equation = if N == 2 {
        Equation { n: [dot(low, low), 2.0 * dot(low, b), bb, 0.0, 0.0], d: [det, norm_b, 1.0, 0.0] }
    } else {
        Equation {
            n: [dot(low, low), 2.0 * dot(low, middle), mm + 2.0 * dot(low, b), 2.0 * dot(middle, b), bb],
            d: [det, det * norm_a, norm_b, 1.0],
        }
    };
    let mut nu = if start > 0.0 {
        start
    } else {
        // A step of Newton's method from infinity, ‖b‖ − bᵀCb/bᵀb, or from 0: both end below the root.
        (bb.sqrt() - dot(forward, forward) / bb).max(equation.step_from_zero())
    };
    let (mut status, mut iterations) = (Status::IterationLimit, 0);
    while iterations < options.max_iterations {
        iterations += 1;
        let (phi, step) = equation.step::<N>(nu);
        observer(nu, phi);
        let next = (nu + step).max(0.0);
        let change = (next - nu).abs();
        nu = next;
        // Newton's method squares the error.
        if change * change <= options.tolerance * (nu * nu) {
            status = Status::Converged;
            break;
        }
        if change.is_nan() {
            return None;
        }
    }

    let y: Vec<N> =
        core::array::from_fn(|j| if N == 2 { low[j] + nu * b[j] } else { low[j] + nu * (middle[j] + nu * b[j]) });
    let norm = dot(y, y).sqrt().recip();
    let y: Vec<N> = core::array::from_fn(|j| y[j] * norm);
    let margin = secular::margin(pair, y, nu);
    // The margin's error is ‖Bδ‖² for an error δ of y, here up to 1e-12: it must stay below the last digit.
    (norm_b < 1e9 * (1.0 + margin)).then_some(Solution { nu, y, margin, status, iterations })
}

/// N(ν) = D(ν)², by its coefficients from the constant one up.
struct Equation {
    n: [f64; 5],
    d: [f64; 4],
}

impl Equation {
    /// φ(ν) = √N/D, and Newton's step (1 − h)/h′ for h = 1/φ, where h′ = (D′ − DN′/2N)/√N.
    #[inline]
    fn step<const N: usize>(&self, nu: f64) -> (f64, f64) {
        let Self { n, d } = self;
        let square = nu * nu;
        // N, N′ and D, D′
        let ([n0, n1], [d0, d1]) = if N == 2 {
            ([n[0] + nu * n[1] + square * n[2], n[1] + 2.0 * nu * n[2]], [d[0] + nu * d[1] + square, d[1] + 2.0 * nu])
        } else {
            (
                [
                    (n[0] + nu * n[1]) + square * (n[2] + nu * n[3] + square * n[4]),
                    (n[1] + 2.0 * nu * n[2]) + square * (3.0 * n[3] + 4.0 * nu * n[4]),
                ],
                [(d[0] + nu * d[1]) + square * (d[2] + nu), d[1] + nu * (2.0 * d[2] + 3.0 * nu)],
            )
        };
        let root = n0.sqrt();
        (root / d0, (root - d0) * (2.0 * n0 / (2.0 * n0 * d1 - d0 * n1)))
    }

    /// Newton's step from ν = 0.
    #[inline]
    fn step_from_zero(&self) -> f64 {
        let ([n0, n1, ..], [d0, d1, ..]) = (self.n, self.d);
        (n0.sqrt() - d0) * (2.0 * n0 / (2.0 * n0 * d1 - d0 * n1))
    }
}

/// Coordinate by coordinate.
#[inline]
fn times<const N: usize>(a: Vec<N>, b: Vec<N>) -> Vec<N> {
    core::array::from_fn(|i| a[i] * b[i])
}

/// `m·x`, for the rows of `m`.
#[inline]
fn apply<const N: usize>(m: &[Vec<N>; N], x: Vec<N>) -> Vec<N> {
    core::array::from_fn(|i| dot(m[i], x))
}

/// `mᵀ·x`, for the rows of `m`.
#[inline]
fn transposed_times<const N: usize>(m: &[Vec<N>; N], x: Vec<N>) -> Vec<N> {
    core::array::from_fn(|j| {
        let mut sum = m[0][j] * x[0];
        for i in 1..N {
            sum += m[i][j] * x[i];
        }
        sum
    })
}
