//! The ellipsoid algorithm on the lifted problem, after Rimon and Boyd, corrected.
//!
//! In n = N + 1 dimensions, with qᵢ = (yᵢ; 1): minimise f(X) = −ln det X over symmetric X ≻ 0 with qᵢᵀXqᵢ ≤ 1. The
//! slice of the optimal { q : qᵀXq ≤ 1 } at height one is the enclosing ellipsoid (their Lemma B.1). X lives in D =
//! n(n + 1)/2 variables, as svec(X): the diagonal, and √2 times what is above it, so that inner products are traces.
//!
//! Where we deviate: D is the number of variables in the update (the paper's text leaves it as the dimension); the
//! gradients weigh off-diagonal entries twice, by svec; a cut for X ⋡ 0 takes a direction of negative curvature from
//! the failed Cholesky factorisation in place of the eigenvector of the *least* (not "maximal") eigenvalue; the best
//! feasible iterate is returned, not the one after the test. And the frame is first made such that Σuᵢqᵢqᵢᵀ = I for
//! some weights: then the hull of ±qᵢ contains the unit ball, 0 ≺ X* ≼ I, and the start |X − I/2|_F ≤ √n/2 holds the
//! optimum, whatever the condition of the points (the paper's radius grows with (R/r)²).
//!
//! # References
//! E. Rimon, S. P. Boyd, *Obstacle collision detection using best ellipsoid fit*, J. Intell. Robot. Syst. 18 (1997),
//! Section 2 and Appendix A.

use crate::enclosing::frame::Frame;
use crate::enclosing::iterate::Iterate;
use crate::enclosing::problem::{EnclosingIterate, Observer, Problem};
use crate::enclosing::solution::{Certificate, Ending, Solution, finish};
use crate::enclosing::start::Start;
use crate::enclosing::working_set::WorkingSet;
use crate::error::EnclosingError;
use crate::numerics::dimension::{Dimension, Dynamic};
use crate::numerics::linalg::{cholesky, cholesky_log_det, dot, solve_factored};
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
    let max_iterations = options.max_iterations.unwrap_or(DEFAULT_ITERATIONS);
    let Start { frame, working, scans, .. } = start;
    let mut at = Iterate::new(points, rank, frame, WorkingSet::new(working, None), scans)?;
    at.recenter(points);
    let mut all = WorkingSet::new((0..points.len()).collect(), None);
    all.locate(points, rank, &at.frame);

    let mut forms = Forms::new(rank.get());
    let mut lower_bound = f64::NEG_INFINITY;
    let mut gap = f64::INFINITY;
    let ended = loop {
        let (gradient, objective) = forms.gradient(&all.y);
        let ag = forms.times(&gradient);
        let width = dot(&gradient, &ag).sqrt();
        if let Some(objective) = objective {
            // f(X*) ≥ f(X_k) − √(gᵀA_kg): the minimum of the linearisation over the ellipsoid that holds X*.
            lower_bound = lower_bound.max(objective - width);
            gap = forms.least - lower_bound;
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
        forms.cut(&ag, width);
    };
    let (frame, certificate) = if gap.is_finite() {
        all.u.fill(1.0);
        let error = all.coordinate_error(points, &at.frame);
        slice(points, &mut at, &forms.best, lower_bound, error)?
    } else {
        // No feasible iterate yet: the unit ball of the frame grown around the points still encloses, with the bound of
        // the starting weights.
        let certificate = Certificate { weights: Vec::new(), ..at.certificate(points) };
        (at.frame.clone(), certificate)
    };
    let ending = Ending { certificate, status: ended, iterations: at.iterations, scans: at.scans };
    finish(points, rank, &frame, options.epsilon, ending)
}

/// An ellipsoid in the space of quadratic forms that holds the optimum, as svec: its centre X and its shape A.
struct Forms {
    /// n = r + 1.
    n: usize,
    /// X, in D = n(n + 1)/2 variables.
    x: Vec<f64>,
    /// A, D × D.
    a: Vec<f64>,
    /// The feasible form of least f found so far, and its f.
    best: Vec<f64>,
    least: f64,
}

impl Forms {
    /// The ball |X − I/2|_F ≤ √n/2.
    fn new(r: usize) -> Self {
        let n = r + 1;
        let variables = n * (n + 1) / 2;
        let mut x = vec![0.0; variables];
        (0..n).for_each(|i| x[svec_index(n, i, i)] = 0.5);
        let mut a = vec![0.0; variables * variables];
        a.iter_mut().step_by(variables + 1).for_each(|a| *a = 0.25 * n as f64);
        Self { n, x, a, best: Vec::new(), least: f64::INFINITY }
    }

    /// The gradient of what X violates, or else of f, and then f(X).
    fn gradient(&mut self, y: &[f64]) -> (Vec<f64>, Option<f64>) {
        let n = self.n;
        let mut matrix = vec![0.0; n * n];
        unpack(n, &self.x, &mut matrix);
        let mut factor = matrix.clone();
        // G = −vvᵀ for v with vᵀXv ≤ 0.
        if let Some(v) = negative_curvature(n, &mut factor) {
            return (rank_one(n, &v, -1.0), None);
        }
        let (worst, level) = furthest(n - 1, y, &matrix);
        let log_det: f64 = (0..n).map(|i| 2.0 * libm::log(factor[i * n + i])).sum();
        // X/level is feasible and no worse than X where level ≤ 1; where level > 1 it is a candidate all the same.
        let value = -log_det + n as f64 * libm::log(level);
        if value < self.least {
            self.least = value;
            self.best = matrix.iter().map(|x| x / level).collect();
        }
        if level > 1.0 {
            let mut q = y[worst * (n - 1)..(worst + 1) * (n - 1)].to_vec();
            q.push(1.0);
            return (rank_one(n, &q, 1.0), None);
        }
        (negative_inverse(n, &factor), Some(-log_det))
    }

    /// A·g.
    fn times(&self, gradient: &[f64]) -> Vec<f64> {
        self.a.chunks_exact(gradient.len()).map(|row| dot(row, gradient)).collect()
    }

    /// X ← X − Ag̃/(D + 1), A ← D²/(D² − 1)·(A − 2/(D + 1)·Ag̃g̃ᵀA), g̃ = g/√(gᵀAg), of which A·g and the root are
    /// given.
    fn cut(&mut self, ag: &[f64], width: f64) {
        let d = ag.len() as f64;
        let (growth, share) = (d * d / (d * d - 1.0), 2.0 / (d + 1.0));
        let step: Vec<f64> = ag.iter().map(|x| x / width).collect();
        self.x.iter_mut().zip(&step).for_each(|(x, s)| *x -= s / (d + 1.0));
        for (row, &s) in self.a.chunks_exact_mut(step.len()).zip(&step) {
            // The product of the steps is formed first, so that A stays symmetric to the last bit.
            row.iter_mut().zip(&step).for_each(|(a, t)| *a = growth * (*a - share * (s * t)));
        }
    }
}

/// The slice of the form P at height one, and what the lower bound on f proves of it: its centre is −P₁₁⁻¹P₁₂ (eq. 17),
/// its shape proportional to P₁₁.
fn slice(
    points: &Copied<Dynamic>,
    at: &mut Iterate<Dynamic>,
    p: &[f64],
    lower_bound: f64,
    coordinate_error: f64,
) -> Result<(Frame<Dynamic>, Certificate), EnclosingError> {
    let rank = at.rank;
    let r = rank.get();
    let n = r + 1;
    let mut p11: Vec<f64> = (0..r).flat_map(|i| p[i * n..i * n + r].iter().copied()).collect();
    let mut center: Vec<f64> = (0..r).map(|i| -p[i * n + r]).collect();
    let log_det = cholesky_log_det(rank, &mut p11).ok_or(EnclosingError::OutOfRange)?;
    solve_factored(rank, &p11, &mut center);
    // det X*₍N₎ follows from min f = n·ln n + ln det S* and ln det X*₍N₎ = −ln det S* − N·ln N.
    let r_float = r as f64;
    let bound =
        -lower_bound + n as f64 * libm::log(n as f64) - r_float * libm::log(r_float) + 4.0 * r_float * coordinate_error;
    let certificate = Certificate { log_det_bound: bound - log_det, weights: Vec::new() };
    // As Σuᵢyᵢyᵢᵀ = I and Σuᵢyᵢ = 0 on the starting set, c = Σuᵢ(yᵢᵀc)yᵢ: its preimage is the same combination of
    // points.
    for (u, y) in at.set.u.iter_mut().zip(at.set.y.chunks_exact(r)) {
        *u *= dot(y, &center);
    }
    let origin = at.set.mean(points, &at.frame);
    // T ← CᵀT with P₁₁ = C·Cᵀ: there the slice is a ball.
    let dim = points.dim().get();
    let map = at.frame.map();
    let rows =
        (0..r * dim).map(|entry| (entry / dim..r).map(|j| p11[j * r + entry / dim] * map[j * dim + entry % dim]).sum());
    Ok((Frame::new(origin, points.dim().matrix(rows), r), certificate))
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
        solve_factored(Dynamic(n), factor, &mut column);
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
    let given = matrix.to_vec();
    if cholesky(Dynamic(n), matrix) {
        return None;
    }
    let leading = |j: usize| -> Vec<f64> { (0..j).flat_map(|i| given[i * n..i * n + j].iter().copied()).collect() };
    // The last pivot fails if none before it does.
    let k = (0..n - 1).find(|k| !cholesky(Dynamic(k + 1), &mut leading(k + 1))).unwrap_or(n - 1);
    let mut v: Vec<f64> = (0..k).map(|i| -given[i * n + k]).collect();
    let mut sound = leading(k);
    cholesky(Dynamic(k), &mut sound);
    solve_factored(Dynamic(k), &sound, &mut v);
    v.push(1.0);
    v.resize(n, 0.0);
    Some(v)
}
