//! The primal–dual iteration for the maximum-volume ellipsoid in { z : pᵢ·z ≤ 1 }.
//!
//! With pᵢ the normals divided by their slacks at an interior point, in coordinates centred there, the body is
//! { z : pᵢ·z ≤ 1 } and the ellipsoid { d + B·u : |u| ≤ 1 } lies in it if
//!
//! > maximise ln det B over B ≻ 0 and d, subject to cᵢ = 1 − pᵢ·d − hᵢ ≥ 0, hᵢ = |B·pᵢ|.
//!
//! Primal–dual Newton on the conditions B⁻¹ = Σyᵢ·sym(vᵢpᵢᵀ) with vᵢ = B·pᵢ/hᵢ, Σyᵢpᵢ = 0, cᵢyᵢ = μ, μ → 0, in the
//! N(N + 3)/2 unknowns of (B, d): the multipliers are eliminated, so a step costs time linear in the number of
//! half-spaces.
//!
//! Certificate: for y ≥ 0 with Σyᵢpᵢ = 0 and unit gᵢ, S = Σyᵢ·sym(pᵢgᵢᵀ) ≻ 0, any feasible (B, d) has tr(B·S) ≤ Σyᵢhᵢ ≤
//! Σyᵢ, so by the inequality of the means ln det B ≤ N·ln(Σy/N) − ln det S.
//!
//! # References
//! Y. Zhang, L. Gao, *On numerical solution of the maximum volume ellipsoid problem*, SIAM J. Optim. 14 (2003), treat
//! the same conditions with m × m systems.

use crate::error::InscribedError;
use crate::inscribed::newton_system::{Direction, System};
use crate::inscribed::observer::{InscribedIterate, Observer};
use crate::inscribed::point::Point;
use crate::numerics::dimension::Dimension;
use crate::numerics::linalg::{cholesky, cholesky_log_det, dot, solve_factored};
use crate::options::{InscribedOptions, Status};

/// The bound on ln det B that multipliers prove.
pub(crate) struct Dual {
    pub(crate) log_det_bound: f64,
    /// Multipliers with Σyᵢpᵢ = 0, scaled to sum to one.
    pub(crate) y: Vec<f64>,
}

/// Corrects y to Σyᵢpᵢ = 0 in so many passes, in proportion to y so that no sign changes, and evaluates the bound.
fn dual_bound<D: Dimension>(dim: D, p: &[f64], v: &[f64], y: &[f64], passes: usize) -> Option<Dual> {
    let n = dim.get();
    // y'ᵢ = yᵢ(1 − pᵢ·λ), (Σyᵢpᵢpᵢᵀ)λ = Σyᵢpᵢ.
    let mut y = y.to_vec();
    for _ in 0..passes {
        let (mut residual, mut gram) = (dim.zero(), dim.zero_matrix());
        let (residual, gram) = (&mut residual.as_mut()[..n], &mut gram.as_mut()[..n * n]);
        for (p, &y) in p.chunks_exact(n).zip(&y) {
            for i in 0..n {
                residual[i] += y * p[i];
                for j in 0..=i {
                    gram[i * n + j] += y * p[i] * p[j];
                }
            }
        }
        if !cholesky(dim, gram) {
            return None;
        }
        solve_factored(dim, gram, residual);
        for (p, y) in p.chunks_exact(n).zip(&mut y) {
            *y *= 1.0 - dot(p, residual);
            if !(*y >= 0.0) {
                return None;
            }
        }
    }
    let total: f64 = y.iter().sum();
    y.iter_mut().for_each(|y| *y /= total);
    let mut s = dim.zero_matrix();
    let s = &mut s.as_mut()[..n * n];
    for ((p, v), &y) in p.chunks_exact(n).zip(v.chunks_exact(n)).zip(&y) {
        for i in 0..n {
            for j in 0..=i {
                s[i * n + j] += 0.5 * y * (p[i] * v[j] + p[j] * v[i]);
            }
        }
    }
    let log_det = cholesky_log_det(dim, s)?;
    Some(Dual { log_det_bound: -(n as f64) * libm::log(n as f64) - log_det, y })
}

/// The complementarity below which the dual bound is evaluated.
const WORTH_BOUNDING: f64 = 1e-3;

/// Steps taken beyond the required gap, each of which shrinks it by two to three orders, and the gap they aim at.
const POLISHING_STEPS: usize = 3;
const POLISHED_GAP: f64 = 1e-13;

/// Below this gap steps are full ones, and polishing is worth its cost.
const NEAR: f64 = 1e-6;

/// The result of the iteration.
pub(crate) struct Maximum {
    /// The best point.
    pub(crate) point: Point,
    /// The bound that its multipliers prove.
    pub(crate) dual: Option<Dual>,
    pub(crate) ended: Status,
    /// Newton steps.
    pub(crate) iterations: usize,
}

/// The primal–dual iteration over { z : pᵢ·z ≤ 1 }.
pub(crate) fn maximize<D: Dimension>(
    dim: D,
    p: &[f64],
    options: InscribedOptions,
    observer: &mut Observer<'_>,
) -> Result<Maximum, InscribedError> {
    let mut at = PrimalDualIterate::start(dim, p).ok_or(InscribedError::OutOfRange)?;
    let m = at.y.len() as f64;
    // Σyᵢhᵢ = N at the solution.
    let mut mu = dim.get() as f64 / m;
    let mut centring = 0.3;
    let mut record = Record::new();
    let mut iteration = 0;
    let ended = loop {
        // The complementarity Σyᵢcᵢ is about half the gap.
        let complementarity = dot(&at.point.c, &at.y);
        let (gap, dual) = at.bound(complementarity);
        observer(InscribedIterate { iteration, mu, log_det_gap: gap.max(0.0) });
        if let Some(ended) = record.judge(gap, dual, &mut at.point, iteration, options) {
            break ended;
        }
        iteration += 1;
        mu = centring * complementarity / m;
        // The share of the way to the boundary that no step takes, and near the end that of the products cᵢyᵢ to aim
        // at. Values below 1e-3 leave the products so uneven that the next steps are poor.
        let boundary = complementarity.clamp(1e-3, 0.03);
        let Some(length) = at.step(mu, boundary) else { break Status::Stalled };
        // Near the end full steps are taken and μ may fall fast; a bold step from afar costs several to recover.
        centring = match length {
            length if length > 0.95 && dot(&at.point.c, &at.y) < 0.1 => boundary,
            length if length > 0.7 => 0.05,
            length if length > 0.3 => 0.3,
            // Products yᵢcᵢ too uneven for progress: even them out.
            _ => 1.0,
        };
    };
    Ok(Maximum { point: at.point, dual: record.dual, ended, iterations: iteration })
}

/// The unknowns (B, d, y) of the iteration, and room for a step.
struct PrimalDualIterate<'a, D> {
    dim: D,
    p: &'a [f64],
    point: Point,
    y: Vec<f64>,
    trial: Point,
    system: System,
    direction: Direction,
}

impl<'a, D: Dimension> PrimalDualIterate<'a, D> {
    /// A ball about the origin half as large as fits; `None` if it is out of the range of `f64`.
    fn start(dim: D, p: &'a [f64]) -> Option<Self> {
        let n = dim.get();
        let m = p.len() / n;
        let reach = p.chunks_exact(n).fold(0.0, |r: f64, p| r.max(dot(p, p).sqrt()));
        let mut point = Point::new(n, m);
        (0..n).for_each(|k| point.b[k * n + k] = 0.5 / reach);
        if !point.evaluate(dim, p) {
            return None;
        }
        let y = point.c.iter().map(|c| n as f64 / m as f64 / c).collect();
        let trial = point.clone();
        Some(Self { dim, p, point, y, trial, system: System::new(n, m), direction: Direction::new(n, m) })
    }

    /// The gap that the multipliers prove, and its proof; infinite while it is too large to be worth its cost.
    fn bound(&self, complementarity: f64) -> (f64, Option<Dual>) {
        let Self { dim, p, point, y, .. } = self;
        let n = dim.get() as f64;
        if !(complementarity < WORTH_BOUNDING) {
            return (f64::INFINITY, None);
        }
        // The correction is exact except for rounding, which a second one removes.
        let passes = if complementarity < NEAR { 2 } else { 1 };
        let Some(dual) = dual_bound(*dim, p, &point.v, y, passes) else { return (f64::INFINITY, None) };
        let growth = point.h.iter().zip(&point.c).fold(f64::INFINITY, |g: f64, (h, c)| g.min((h + c) / h));
        (2.0 * (dual.log_det_bound - point.log_det - n * libm::log(growth)), Some(dual))
    }

    /// One Newton step that aims at the products cᵢyᵢ = μ and leaves the share `boundary` of the way to the boundary.
    /// Returns the shorter of its two lengths; `None` if there is no step to take.
    fn step(&mut self, mu: f64, boundary: f64) -> Option<f64> {
        let Self { dim, p, point, y, trial, system, direction } = self;
        if !system.assemble(*dim, p, point, y) {
            return None;
        }
        system.solve(&point.c, y, mu, direction);
        let dual_length = ((1.0 - boundary) * length(y, &direction.dy)).min(1.0);
        let mut primal_length = ((1.0 - boundary) * direction.reach(*dim, p, point)).min(1.0);
        loop {
            direction.advance(dim.get(), primal_length, point, trial);
            if trial.evaluate(*dim, p) {
                break;
            }
            // B + ΔB is not definite.
            primal_length *= 0.6;
            if !(primal_length >= 1e-9) {
                return None;
            }
        }
        std::mem::swap(point, trial);
        y.iter_mut().zip(&direction.dy).for_each(|(y, d)| *y += dual_length * d);
        Some(primal_length.min(dual_length))
    }
}

/// The best iterate so far, and the state that decides whether to go on.
struct Record {
    gap: f64,
    dual: Option<Dual>,
    without_progress: usize,
    /// Steps left beyond the required gap, and the point before the last of them: a step of rounding may lead anywhere.
    polishing: usize,
    kept: Option<Point>,
}

impl Record {
    const fn new() -> Self {
        Self { gap: f64::INFINITY, dual: None, without_progress: 0, polishing: POLISHING_STEPS, kept: None }
    }

    /// Records an iterate, and returns how the iteration ended if it did; `point` is then the best.
    fn judge(
        &mut self,
        gap: f64,
        dual: Option<Dual>,
        point: &mut Point,
        iteration: usize,
        options: InscribedOptions,
    ) -> Option<Status> {
        let out_of_steps = iteration >= options.max_iterations;
        if gap < self.gap {
            self.without_progress = 0;
            (self.gap, self.dual) = (gap, dual);
        } else {
            self.without_progress += 1;
            if let Some(kept) = self.kept.take() {
                *point = kept;
                return Some(Status::Converged);
            }
        }
        if gap <= 0.5 * options.epsilon {
            if gap <= POLISHED_GAP || gap > NEAR || self.polishing == 0 || out_of_steps {
                return Some(Status::Converged);
            }
            self.polishing -= 1;
            self.kept = Some(point.clone());
        }
        if out_of_steps {
            return Some(Status::IterationLimit);
        }
        let stuck = self.without_progress > 10 && self.gap < 1e-3 || self.without_progress > 60;
        stuck.then_some(Status::Stalled)
    }
}

/// How far y + length·Δy stays positive; infinite if it always does.
fn length(y: &[f64], dy: &[f64]) -> f64 {
    let limits = y.iter().zip(dy).filter(|(_, dy)| **dy < 0.0).map(|(y, dy)| -y / dy);
    limits.fold(f64::INFINITY, f64::min)
}
