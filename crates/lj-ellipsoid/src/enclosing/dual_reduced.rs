//! The dual reduced Newton method of Sun and Freund for the weights of a working set.
//!
//! With weights u ≥ 0 that need not sum to one, z = Σuᵢaᵢ/Σu, yᵢ = aᵢ − z, W = Σuᵢyᵢyᵢᵀ and M² = ½W⁻¹, the optimum has
//! h(u) + t = 1 and uᵢtᵢ = 0 with slacks t ≥ 0, hᵢ = yᵢᵀM²yᵢ. The path uᵢtᵢ = θ is followed to θ = 0 by Newton's
//! method: with Σᵢⱼ = yᵢᵀM²yⱼ the Jacobian of h is −2(Σ/Σu + Σ∘Σ), so every step solves one definite system of the size
//! of the working set. The sum of u tends to N/2 and uᵀt is the gap.
//!
//! # References
//! P. Sun, R. M. Freund, *Computation of minimum-volume covering ellipsoids*, Oper. Res. 52 (2004).

use crate::enclosing::iterate::Iterate;
use crate::enclosing::newton::Workspace;
use crate::numerics::dimension::{Dimension, Dynamic};
use crate::numerics::linalg::{cholesky, dot, solve_factored};

/// Newton steps along one path; twenty is typical.
const MAX_STEPS: usize = 80;

/// Improves the weights of `set` until the gap over it is at most `gap`; answers the number of steps.
pub(crate) fn solve<D: Dimension>(at: &mut Iterate<D>, _: &mut Workspace<D>, gap: f64, max_steps: usize) -> usize {
    let Iterate { rank, set, moments, .. } = at;
    let r = rank.get();
    let k = set.len();
    let dimension = r as f64;
    // Equal weights make t positive once scaled: h is inverse to the size of u.
    let mut u = vec![dimension / (2.0 * k as f64); k];
    if !moments.compute(&set.y, &u) {
        return 0;
    }
    let grow = 1.05 * (moments.furthest().1 / dimension).max(1.0);
    u.iter_mut().for_each(|u| *u *= grow);
    let mut t: Vec<f64> = moments.q.iter().map(|q| 1.0 - q / (dimension * grow)).collect();
    let mut jacobian = vec![0.0; k * k];
    let mut factor = vec![0.0; k * k];
    let mut du = vec![0.0; k];
    let mut steps = 0;
    let (mut best, mut best_gap) = (u.clone(), f64::INFINITY);
    loop {
        if !moments.compute(&set.y, &u) {
            break;
        }
        let now = moments.log_det_gap();
        if now < best_gap {
            best_gap = now;
            best.clone_from(&u);
        }
        if now <= gap {
            break;
        }
        if steps >= max_steps.min(MAX_STEPS) {
            break;
        }
        steps += 1;
        let sum: f64 = u.iter().sum();
        let theta = 0.1 * dot(&u, &t) / k as f64;
        for i in 0..k {
            for j in 0..k {
                let sigma = dot(&moments.z[i * r..(i + 1) * r], &moments.z[j * r..(j + 1) * r]) / (2.0 * sum);
                jacobian[i * k + j] = 2.0 * (sigma / sum + sigma * sigma);
                factor[i * k + j] = jacobian[i * k + j];
            }
            factor[i * k + i] += t[i] / u[i];
        }
        // (2(Σ/Σu + Σ∘Σ) + diag(t/u))·Δu = −(r₁ − r₂/u), r₁ = 1 − t − h, r₂ = θ − u∘t.
        let r1: Vec<f64> = (0..k).map(|i| 1.0 - t[i] - moments.q[i] / (2.0 * sum)).collect();
        for i in 0..k {
            du[i] = -(r1[i] - (theta - u[i] * t[i]) / u[i]);
        }
        if !cholesky(Dynamic(k), &mut factor) {
            break;
        }
        solve_factored(Dynamic(k), &factor, &mut du);
        let dt: Vec<f64> = (0..k).map(|i| r1[i] + dot(&jacobian[i * k..(i + 1) * k], &du)).collect();
        let mut step: f64 = 1.0;
        for (x, d) in u.iter().zip(&du).chain(t.iter().zip(&dt)) {
            if *d < 0.0 {
                step = step.min(-0.99 * x / d);
            }
        }
        u.iter_mut().zip(&du).for_each(|(x, d)| *x += step * d);
        t.iter_mut().zip(&dt).for_each(|(x, d)| *x += step * d);
    }
    // The path never reaches zero: weights that cannot matter to the gap are dropped.
    let sum: f64 = best.iter().sum();
    let negligible = 1e-3 * gap / k as f64;
    set.u = best.iter().map(|u| if u / sum < negligible { 0.0 } else { u / sum }).collect();
    let sum: f64 = set.u.iter().sum();
    set.u.iter_mut().for_each(|u| *u /= sum);
    moments.compute(&set.y, &set.u);
    steps
}
