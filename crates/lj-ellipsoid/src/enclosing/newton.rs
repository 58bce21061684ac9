//! Newton's method for the weights of a working set.
//!
//! Maximise φ(u) = ln det M(u) − n·Σu over u ≥ 0, n = N + 1; the maximum has Σu = 1. With Gᵢⱼ = qᵢᵀM⁻¹qⱼ the gradient
//! is ω − n·1 and the Hessian −H, H = G∘G (entry by entry), and H·u = ω. The step to v = u + d maximises the model
//!
//! > rᵀv − ½vᵀHv over v ≥ 0, r = ω − n·1 + H·u = 2ω − n·1,
//!
//! a non-negative least-squares problem: it decides by itself which weights become zero. φ is self-concordant, so a
//! step damped by 1/(1 + δ), δ = √(dᵀHd), always ascends; longer steps are tried first.
//!
//! H is singular where the matrices qᵢqᵢᵀ are dependent: rectangles, boxes, regular polygons, points on a sphere, more
//! than n(n + 1)/2 points. M is still unique, u is not. A proximal term ½τ|v − u|² with τ some 1e-13 of H chooses the v
//! nearest to u; it vanishes at the solution, so it moves no answer.

use crate::enclosing::iterate::Iterate;
use crate::enclosing::moments::Moments;
use crate::enclosing::violators::elimination_threshold;
use crate::enclosing::working_set::WorkingSet;
use crate::numerics::dimension::{Const, Dimension, Dynamic};
use crate::numerics::linalg::{cholesky, solve_factored};

/// The proximal term relative to the largest diagonal of H: far above the rounding of its Cholesky factor, far below
/// what ω could tell.
const PROXIMAL: f64 = 1e-13;

/// What [`thin_out`] takes to be left of the excess of κ when it forgets members: a step of Newton's method mostly
/// leaves less. Should one that was needed go, a look at all points brings it back.
const EAGER: f64 = 0.1;

/// Steps of [`thin_out`].
const MULTIPLICATIVE_STEPS: usize = 4;

/// Room for the quadratic model, reused from step to step.
pub(crate) struct Workspace<D: Dimension> {
    h: Vec<f64>,
    r: Vec<f64>,
    v: Vec<f64>,
    /// The members with v > 0, and the optimum over them.
    free: Vec<usize>,
    factor: Vec<f64>,
    solution: Vec<f64>,
    /// Weights a part of the way from u to v, and what follows from them.
    trial: Vec<f64>,
    trial_moments: Moments<D>,
    /// The iterate of least gap.
    best: WorkingSet,
}

impl<D: Dimension> Workspace<D> {
    pub(crate) fn new(rank: D) -> Self {
        let [h, r, v, factor, solution, trial] = Default::default();
        let (free, best) = Default::default();
        Self { h, r, v, free, factor, solution, trial, trial_moments: Moments::new(rank), best }
    }
}

/// Improves the weights until the gap over the working set is at most `gap`, or rounding stops the ascent. Answers the
/// number of steps.
pub(crate) fn solve<D: Dimension>(at: &mut Iterate<D>, work: &mut Workspace<D>, gap: f64, max_steps: usize) -> usize {
    let Iterate { rank, set, moments, .. } = at;
    let rank = *rank;
    let mut steps = 0;
    let mut best_gap = f64::INFINITY;
    let mut without_progress = 0;
    thin_out(rank, set, moments, &mut work.best);
    loop {
        lift_far_points(rank, set, moments, &mut work.trial);
        let now = moments.log_det_gap();
        if now <= gap {
            return steps;
        }
        if now < best_gap {
            // Quadratic convergence at least halves the gap; slower than that is rounding or a hard start.
            without_progress = if now < 0.5 * best_gap { 0 } else { without_progress + 1 };
            best_gap = now;
            work.best.copy_from(set);
        } else {
            without_progress += 1;
            if steps == 0 {
                // A gap that is no number: there is nothing better to come back to.
                work.best.copy_from(set);
            }
        }
        // None of these has weight at the optimum of this set (Harman and Pronzato). Where rounding says that they
        // have, it is not to be trusted.
        let threshold = elimination_threshold(rank.get(), moments.furthest().1);
        if !forget(rank, set, moments, threshold)
            || steps >= max_steps
            || (without_progress >= 3 && best_gap < 1e-9)
            || (without_progress >= 1 && best_gap < 1e-13)
            || without_progress >= 12
            || !step(rank, set, moments, work)
        {
            break;
        }
        steps += 1;
    }
    std::mem::swap(set, &mut work.best);
    moments.compute(&set.y, &set.u);
    steps
}

/// Where every member has weight, as at the start, most will lose it, and Newton's model takes them out one by one. A
/// few multiplicative steps u ← u·ω/n, which always ascend, tell them from the others, and they are forgotten together.
fn thin_out<D: Dimension>(rank: D, set: &mut WorkingSet, moments: &mut Moments<D>, before: &mut WorkingSet) {
    let r = rank.get() as f64;
    for _ in 0..MULTIPLICATIVE_STEPS {
        if set.len() <= rank.get() + 3 || set.u.contains(&0.0) || moments.furthest().1 <= r * (1.0 + 1e-9) {
            break;
        }
        set.u.iter_mut().zip(&moments.q).for_each(|(u, q)| *u *= (1.0 + q) / (r + 1.0));
        let total: f64 = set.u.iter().sum();
        set.u.iter_mut().for_each(|u| *u /= total);
        before.copy_from(set);
        let sound = moments.compute(&set.y, &set.u) && {
            let expected = r + EAGER * (moments.furthest().1 - r);
            forget(rank, set, moments, elimination_threshold(rank.get(), expected))
        };
        if !sound {
            // The members left do not span the space.
            std::mem::swap(set, before);
            moments.compute(&set.y, &set.u);
            break;
        }
    }
}

/// The model of a point far outside with little weight is poor: Newton would only double its weight each step. The
/// exact line search of the first-order method (Todd and Yıldırım), β = (ω − n)/(n(ω − 1)), brings such points in.
fn lift_far_points<D: Dimension>(rank: D, set: &mut WorkingSet, moments: &mut Moments<D>, before: &mut Vec<f64>) {
    let n = rank.get() as f64 + 1.0;
    for _ in 0..set.len() {
        let (j, q) = moments.furthest();
        let omega = q + 1.0;
        if !(omega > 4.0 * n) {
            break;
        }
        let beta = (omega - n) / (n * (omega - 1.0));
        before.clone_from(&set.u);
        set.u.iter_mut().for_each(|u| *u *= 1.0 - beta);
        set.u[j] += beta;
        if !moments.compute(&set.y, &set.u) {
            // So far out that beside it the others seem to be one point.
            std::mem::swap(&mut set.u, before);
            moments.compute(&set.y, &set.u);
            break;
        }
    }
}

/// One damped Newton step; false where no ascent is left.
fn step<D: Dimension>(rank: D, set: &mut WorkingSet, moments: &mut Moments<D>, work: &mut Workspace<D>) -> bool {
    let r = rank.get();
    let n = r as f64 + 1.0;
    quadratic_model(rank, set, moments, work);
    non_negative_quadratic(n, &set.u, work);

    // N + 1 points are a simplex: equal weights, whatever their places.
    if work.v.iter().filter(|v| **v > 0.0).count() == r + 1 {
        work.v.iter_mut().filter(|v| **v > 0.0).for_each(|v| *v = 1.0 / n);
    }

    // The predicted ascent gᵀd, g = ω − n·1, and the decrement δ² = dᵀHd, d = v − u: with H·u = ω, Σuω = n and
    // vᵀHv = rᵀv at the optimum of the model, they are ωᵀv − n·Σv and n·(1 − Σv).
    let sum: f64 = work.v.iter().sum();
    let slope = moments.q.iter().zip(&work.v).map(|(q, v)| (q + 1.0) * v).sum::<f64>() - n * sum;
    let guaranteed = 1.0 / (1.0 + (n * (1.0 - sum)).max(0.0).sqrt());
    let mut t = 1.0;
    // φ after normalising Σu = 1 is ln det S − n, so ln det S is the merit. Where the ascent is beyond what it resolves
    // the full step is right anyway.
    for _ in 0..60 {
        work.trial.clear();
        let (u, v) = (&set.u, &work.v);
        work.trial.extend(u.iter().zip(v).map(|(u, v)| (u + t * (v - u)).max(0.0)));
        let total: f64 = work.trial.iter().sum();
        work.trial.iter_mut().for_each(|u| *u /= total);
        if total > 0.0 && work.trial_moments.compute_scatter(&set.y, &work.trial) {
            let ascent = work.trial_moments.log_det_scatter - moments.log_det_scatter;
            if ascent >= 1e-4 * t * slope || slope < 1e-11 {
                std::mem::swap(&mut set.u, &mut work.trial);
                moments.take_scatter(&work.trial_moments);
                moments.compute_distances(&set.y);
                return true;
            }
        }
        t = if t > guaranteed && 0.5 * t < guaranteed { guaranteed } else { 0.5 * t };
    }
    false
}

/// Writes H = G∘G, Gᵢⱼ = 1 + zᵢ·zⱼ, and r = 2ω − n·1, both with the proximal term.
fn quadratic_model<D: Dimension>(rank: D, set: &WorkingSet, moments: &Moments<D>, work: &mut Workspace<D>) {
    let r = rank.get();
    let n = r as f64 + 1.0;
    let k = set.len();
    let proximal = PROXIMAL * moments.q.iter().fold(0.0, |m: f64, q| m.max((1.0 + q) * (1.0 + q)));
    work.h.resize(k * k, 0.0);
    let h = &mut work.h[..k * k];
    for (i, zi) in moments.z.chunks_exact(r).enumerate() {
        for (j, zj) in moments.z.chunks_exact(r).take(i + 1).enumerate() {
            let mut g = 1.0;
            for l in 0..r {
                g += zi[l] * zj[l];
            }
            h[i * k + j] = g * g;
            h[j * k + i] = g * g;
        }
        h[i * k + i] += proximal;
    }
    work.r.clear();
    work.r.extend(moments.q.iter().zip(&set.u).map(|(q, u)| 2.0 * (q + 1.0) - n + proximal * u));
}

/// Forgets the members with |z|² below `threshold`; false where the others do not span the space.
fn forget<D: Dimension>(rank: D, set: &mut WorkingSet, moments: &mut Moments<D>, threshold: f64) -> bool {
    let q = &moments.q;
    if !q.iter().any(|q| *q < threshold) {
        return true;
    }
    let mut weighted = false;
    set.retain(rank.get(), |i, u| {
        let goes = q[i] < threshold;
        weighted |= goes && u > 0.0;
        !goes
    });
    if !weighted {
        moments.retain(|q| !(q < threshold));
        return true;
    }
    let total: f64 = set.u.iter().sum();
    set.u.iter_mut().for_each(|u| *u /= total);
    moments.compute(&set.y, &set.u)
}

/// Maximises rᵀv − ½vᵀHv over v ≥ 0 by the active-set method of Lawson and Hanson, from v = u.
///
/// Leaves the result in `work.v`. Every pass either moves to a better v with fewer free members or to the optimum of
/// the free ones, so it ends; should rounding make it cycle it stops with a v at least as good as u.
fn non_negative_quadratic<D: Dimension>(n: f64, u: &[f64], work: &mut Workspace<D>) {
    let k = u.len();
    let Workspace { h, r, v, free, factor, solution, .. } = work;
    v.clear();
    v.extend_from_slice(u);
    free.clear();
    free.reserve(k);
    free.extend((0..k).filter(|&i| u[i] > 0.0));
    for _ in 0..3 * k + 10 {
        if !solve_free(k, h, r, free, factor, solution) {
            return;
        }
        // As far as v ≥ 0 allows towards the optimum of the free members.
        let mut alpha = 1.0;
        let mut blocking = None;
        for (&i, &s) in free.iter().zip(&*solution) {
            if s < 0.0 {
                let limit = v[i] / (v[i] - s);
                if limit < alpha {
                    (alpha, blocking) = (limit, Some(i));
                }
            }
        }
        for (&i, &s) in free.iter().zip(&*solution) {
            v[i] = if alpha == 1.0 { s } else { (v[i] + alpha * (s - v[i])).max(0.0) };
        }
        if let Some(blocking) = blocking {
            v[blocking] = 0.0;
            free.retain(|&i| v[i] > 0.0);
            continue;
        }
        // Optimal over the free: bring in the member whose multiplier is furthest from optimal.
        let mut enter = None;
        let mut largest = 1e-13 * n;
        for j in 0..k {
            if v[j] == 0.0 && !free.contains(&j) {
                let hv: f64 = free.iter().map(|&i| h[j * k + i] * v[i]).sum();
                let multiplier = r[j] - hv;
                // A multiplier among the rounding of the terms it is the difference of says nothing.
                if multiplier > largest.max(1e-14 * (r[j].abs() + hv.abs())) {
                    (largest, enter) = (multiplier, Some(j));
                }
            }
        }
        match enter {
            Some(j) => free.push(j),
            None => return,
        }
    }
}

/// Solves H·s = r over the free members by Cholesky; false where their H is not numerically positive definite.
fn solve_free(k: usize, h: &[f64], r: &[f64], free: &[usize], factor: &mut Vec<f64>, solution: &mut Vec<f64>) -> bool {
    let f = free.len();
    factor.clear();
    factor.reserve(k * k);
    solution.clear();
    solution.reserve(k);
    for &i in free {
        let row = &h[i * k..i * k + k];
        factor.extend(free.iter().map(|&j| row[j]));
        solution.push(r[i]);
    }
    // A support has at most N(N + 3)/2 members, 5 in the plane and 9 in space: sizes worth unrolling.
    match f {
        3 => solve_definite(Const::<3>, factor, solution),
        4 => solve_definite(Const::<4>, factor, solution),
        5 => solve_definite(Const::<5>, factor, solution),
        6 => solve_definite(Const::<6>, factor, solution),
        _ => solve_definite(Dynamic(f), factor, solution),
    }
}

fn solve_definite<D: Dimension>(dim: D, matrix: &mut [f64], x: &mut [f64]) -> bool {
    cholesky(dim, matrix) && {
        solve_factored(dim, matrix, x);
        true
    }
}
