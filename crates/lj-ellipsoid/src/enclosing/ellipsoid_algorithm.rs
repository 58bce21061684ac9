//! The ellipsoid algorithm on the lifted problem, after Rimon and Boyd, corrected.
//!
//! In n = N + 1 dimensions, with qᵢ = (yᵢ; 1): minimise f(X) = −ln det X over symmetric X ≻ 0 with qᵢᵀXqᵢ ≤ 1. The slice of
//! the optimal { q : qᵀXq ≤ 1 } at height one is the enclosing ellipsoid (their Lemma B.1). X lives in D = n(n + 1)/2
//! variables, as svec(X): the diagonal, and √2 times what is above it, so that inner products are traces.
//!
//! Where we deviate: D is the number of variables in the update (the paper's text leaves it as the dimension); the
//! gradients weigh off-diagonal entries twice, by svec; a cut for X ⋡ 0 takes a direction of negative curvature from the failed
//! Cholesky factorisation in place of the eigenvector of the *least* (not "maximal") eigenvalue; the best feasible iterate
//! is returned, not the one after the test. And the frame is first made such that Σuᵢqᵢqᵢᵀ = I for some weights: then
//! the hull of ±qᵢ contains the unit ball, 0 ≺ X* ≼ I, and the start |X − I/2|_F ≤ √n/2 holds the optimum, whatever the
//! condition of the points (the paper's radius grows with (R/r)²).
//!
//! # References
//! E. Rimon, S. P. Boyd, *Obstacle collision detection using best ellipsoid fit*, J. Intell. Robot. Syst. 18 (1997),
//! Section 2 and Appendix A.

use crate::enclosing::frame::Frame;
use crate::enclosing::iterate::Iterate;
use crate::enclosing::solution::{Certificate, Ending, Solution, finish};
use crate::enclosing::start::Start;
use crate::enclosing::working_set::WorkingSet;
use crate::enclosing::{EnclosingIterate, Observer, Problem};
use crate::error::EnclosingError;
use crate::numerics::dimension::{Dimension, Dynamic};
use crate::numerics::linalg::{cholesky, cholesky_log_det, dot, solve_lower, solve_lower_transpose};
use crate::options::Status;
use crate::points::{Copied, Points};

/// The most cuts, unless the caller says otherwise.
const DEFAULT_ITERATIONS: usize = 200_000;

/// Cuts the space of quadratic forms until f is known to `epsilon`.
pub(crate) fn solve(
    problem: &Problem<'_, Copied<Dynamic>>,
    start: Start<Dynamic>,
    observer: &mut Observer<'_>,
) -> Result<Solution<Dynamic>, EnclosingError> {
    let Problem { points, rank, options } = *problem;
    let r = rank.get();
    let n = r + 1;
    let max_iterations = options.max_iterations.unwrap_or(DEFAULT_ITERATIONS);
    let Start { frame, working, scans, .. } = start;
    let mut at = Iterate::new(points, rank, frame, WorkingSet::new(working, None), scans)?;
    at.recenter(points);
    let mut all = WorkingSet::new((0..points.len()).collect(), None);
    all.locate(points, rank, &at.frame);

    let variables = n * (n + 1) / 2;
    let mut x = vec![0.0; variables];
    (0..n).for_each(|i| x[svec_index(n, i, i)] = 0.5);
    let mut a = vec![0.0; variables * variables];
    (0..variables).for_each(|i| a[i * variables + i] = 0.25 * n as f64);

    let mut lower_bound = f64::NEG_INFINITY;
    let mut best = (f64::INFINITY, Vec::new());
    let mut gap = f64::INFINITY;
    let mut factor = vec![0.0; n * n];
    let ended = loop {
        unpack(n, &x, &mut factor);
        let matrix = factor.clone();
        let (gradient, objective) = match negative_curvature(n, &mut factor) {
            // G = −vvᵀ for v with vᵀXv ≤ 0.
            Some(v) => (rank_one(n, &v, -1.0), None),
            None => {
                let (worst, level) = furthest(r, &all.y, &matrix);
                let log_det: f64 = (0..n).map(|i| 2.0 * factor[i * n + i].ln()).sum();
                // X/level is feasible and no worse than X where level ≤ 1; where level > 1 it is a candidate all the same.
                let value = -log_det + n as f64 * level.ln();
                if value < best.0 {
                    best = (value, matrix.iter().map(|x| x / level).collect());
                }
                if level > 1.0 {
                    let mut q = all.y[worst * r..(worst + 1) * r].to_vec();
                    q.push(1.0);
                    (rank_one(n, &q, 1.0), None)
                } else {
                    (negative_inverse(n, &factor), Some(-log_det))
                }
            }
        };
        let ag: Vec<f64> = a.chunks_exact(variables).map(|row| dot(row, &gradient)).collect();
        let width = dot(&gradient, &ag).sqrt();
        if let Some(objective) = objective {
            // f(X*) ≥ f(X_k) − √(gᵀA_kg): the minimum of the linearisation over the ellipsoid that holds X*.
            lower_bound = lower_bound.max(objective - width);
            gap = best.0 - lower_bound;
            observer(EnclosingIterate {
                iteration: at.iterations,
                scans: at.scans,
                log_det_gap: gap.max(0.0),
                indices: &all.index,
                weights: &[],
            });
            if gap <= 0.5 * options.epsilon {
                break Status::Converged;
            }
        }
        if !(width > 0.0 && width.is_finite()) {
            break Status::Stalled;
        }
        if at.iterations >= max_iterations {
            break Status::IterationLimit;
        }
        at.iterations += 1;
        at.scans += 1;
        // X ← X − Ag̃/(D + 1), A ← D²/(D² − 1)·(A − 2/(D + 1)·Ag̃g̃ᵀA), g̃ = g/√(gᵀAg).
        let d = variables as f64;
        for i in 0..variables {
            x[i] -= ag[i] / width / (d + 1.0);
            for j in 0..=i {
                let updated = d * d / (d * d - 1.0)
                    * (a[i * variables + j] - 2.0 / (d + 1.0) * (ag[i] / width) * (ag[j] / width));
                a[i * variables + j] = updated;
                a[j * variables + i] = updated;
            }
        }
    };
    if best.1.is_empty() || !gap.is_finite() {
        // No feasible iterate yet: the unit ball of the frame grown around the points still encloses, with the bound of
        // the starting weights.
        let certificate = Certificate { weights: Vec::new(), ..at.certificate(points) };
        let ending = Ending { certificate, status: ended, iterations: at.iterations, scans: at.scans };
        return finish(points, rank, &at.frame, options.epsilon, ending);
    }

    // The slice of P at height one: centre −P₁₁⁻¹P₁₂ (eq. 17), shape proportional to P₁₁.
    let p = &best.1;
    let mut p11: Vec<f64> = (0..r).flat_map(|i| p[i * n..i * n + r].iter().copied()).collect();
    let mut center: Vec<f64> = (0..r).map(|i| -p[i * n + r]).collect();
    let log_det = cholesky_log_det(rank, &mut p11).ok_or(EnclosingError::OutOfRange)?;
    solve_lower(rank, &p11, &mut center);
    solve_lower_transpose(rank, &p11, &mut center);
    // det X*₍N₎ follows from min f = n·ln n + ln det S* and ln det X*₍N₎ = −ln det S* − N·ln N.
    let r_float = r as f64;
    all.u.fill(1.0);
    let rounding = 4.0 * r_float * all.coordinate_error(points, &at.frame);
    let bound = -lower_bound + n as f64 * (n as f64).ln() - r_float * r_float.ln() + rounding;
    let certificate = Certificate { log_det_bound: bound - log_det, weights: Vec::new() };
    // As Σuᵢyᵢyᵢᵀ = I and Σuᵢyᵢ = 0 on the starting set, c = Σuᵢ(yᵢᵀc)yᵢ: its preimage is the same combination of points.
    for (u, y) in at.set.u.iter_mut().zip(at.set.y.chunks_exact(r)) {
        *u *= dot(y, &center);
    }
    let origin = at.set.mean(points, &at.frame);
    // T ← CᵀT with P₁₁ = C·Cᵀ: there the slice is a ball.
    let dim = points.dim().get();
    let map = at.frame.map();
    let rows =
        (0..r * dim).map(|entry| (entry / dim..r).map(|j| p11[j * r + entry / dim] * map[j * dim + entry % dim]).sum());
    let frame = Frame::new(origin, points.dim().matrix(rows), r);
    let ending = Ending { certificate, status: ended, iterations: at.iterations, scans: at.scans };
    finish(points, rank, &frame, options.epsilon, ending)
}

/// The place of entry (i, j), i ≤ j, in svec.
fn svec_index(n: usize, i: usize, j: usize) -> usize {
    i * n - i * (i + 1) / 2 + j
}

fn unpack(n: usize, x: &[f64], matrix: &mut [f64]) {
    for i in 0..n {
        matrix[i * n + i] = x[svec_index(n, i, i)];
        for j in i + 1..n {
            let entry = x[svec_index(n, i, j)] * std::f64::consts::FRAC_1_SQRT_2;
            matrix[i * n + j] = entry;
            matrix[j * n + i] = entry;
        }
    }
}

/// svec(sign·vvᵀ).
fn rank_one(n: usize, v: &[f64], sign: f64) -> Vec<f64> {
    let mut g = Vec::with_capacity(n * (n + 1) / 2);
    for i in 0..n {
        g.push(sign * v[i] * v[i]);
        g.extend((i + 1..n).map(|j| sign * std::f64::consts::SQRT_2 * v[i] * v[j]));
    }
    g
}

/// svec(−X⁻¹) from the Cholesky factor of X.
fn negative_inverse(n: usize, factor: &[f64]) -> Vec<f64> {
    let mut g = vec![0.0; n * (n + 1) / 2];
    for j in 0..n {
        let mut column = vec![0.0; n];
        column[j] = 1.0;
        solve_lower(Dynamic(n), factor, &mut column);
        solve_lower_transpose(Dynamic(n), factor, &mut column);
        for i in 0..=j {
            g[svec_index(n, i, j)] = if i == j { -column[i] } else { -std::f64::consts::SQRT_2 * column[i] };
        }
    }
    g
}

/// The point of largest qᵀXq, and that value.
fn furthest(r: usize, y: &[f64], matrix: &[f64]) -> (usize, f64) {
    let n = r + 1;
    let mut worst = (0, f64::NEG_INFINITY);
    for (index, y) in y.chunks_exact(r).enumerate() {
        let mut level = matrix[r * n + r];
        for i in 0..r {
            let mut row = 2.0 * matrix[i * n + r];
            for j in 0..r {
                row += matrix[i * n + j] * y[j];
            }
            level += row * y[i];
        }
        if level > worst.1 {
            worst = (index, level);
        }
    }
    worst
}

/// Factors X = C·Cᵀ in place, or answers v with vᵀXv ≤ 0: where pivot j fails, v = (−L⁻ᵀl, 1, 0…) with l the part of
/// column j above the diagonal has vᵀXv equal to that pivot.
fn negative_curvature(n: usize, matrix: &mut [f64]) -> Option<Vec<f64>> {
    for j in 1..=n {
        let mut leading: Vec<f64> = (0..j).flat_map(|i| matrix[i * n..i * n + j].iter().copied()).collect();
        if cholesky(Dynamic(j), &mut leading) {
            continue;
        }
        let k = j - 1;
        let mut v: Vec<f64> = (0..k).map(|i| -matrix[i * n + k]).collect();
        let mut sound: Vec<f64> = (0..k).flat_map(|i| matrix[i * n..i * n + k].iter().copied()).collect();
        cholesky(Dynamic(k), &mut sound);
        solve_lower(Dynamic(k), &sound, &mut v);
        solve_lower_transpose(Dynamic(k), &sound, &mut v);
        v.push(1.0);
        v.resize(n, 0.0);
        return Some(v);
    }
    cholesky(Dynamic(n), matrix);
    None
}
