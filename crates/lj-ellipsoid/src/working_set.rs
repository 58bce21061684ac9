//! The outer loop: solve a small working set, look at all points, add the worst violators.

use crate::design::{Moments, WorkingSet};
use crate::dimension::Dimension;
use crate::enclosing::EnclosingIterate;
use crate::error::EnclosingError;
use crate::frame::Frame;
use crate::newton;
use crate::options::{EnclosingMethod, EnclosingOptions, Status};
use crate::points::Points;
use crate::solution::{Certificate, Solution, finish};
use crate::start::Start;
use crate::violators::{Survivors, Violators, look};

/// The most Newton steps over all working sets, unless the caller says otherwise.
const DEFAULT_ITERATIONS: usize = 2_000;

/// The most passes over the points: each adds at least one violator, and in practice less than twenty are needed.
const MAX_SCANS: usize = 500;

/// Below this many points, forgetting some does not pay.
const FEW: usize = 512;

/// Below this gap Newton's method doubles the digits with each step, and two steps reach rounding.
const QUADRATIC: f64 = 1e-6;

/// A gap that is rounding in any case.
const ROUNDING: f64 = 1e-14;

/// Solves by Newton's method (or the dual reduced Newton method) on a working set.
pub(crate) fn solve<P: Points, R: Dimension + Sync>(
    points: &P,
    rank: R,
    start: Start,
    options: EnclosingOptions,
    mut observer: impl FnMut(EnclosingIterate<'_>),
) -> Result<Solution, EnclosingError> {
    let r = rank.get();
    let max_iterations = if options.max_iterations == 0 { DEFAULT_ITERATIONS } else { options.max_iterations };
    let Start { mut frame, working, weights, mut scans } = start;
    let mut set = WorkingSet::uniform(working);
    if let Some(weights) = weights {
        set.u = weights;
    }
    let mut moments = Moments::default();
    let mut work = newton::Workspace::default();
    set.locate(points, rank, &frame);
    if !moments.compute(rank, &set.y, &set.u) {
        return Err(EnclosingError::OutOfRange);
    }
    // The starting frame may be skew: rather than compute in it, move to where the weights' ellipsoid is round.
    let diagonal = (0..r).map(|k| moments.factor[k * r + k]);
    let (least, most) = diagonal.fold((f64::INFINITY, 0.0), |(l, m): (f64, f64), d| (l.min(d), m.max(d)));
    if least < 0.05 * most {
        recenter(points, rank, &mut frame, &mut set, &mut moments);
    }
    let mut iterations = 0;
    let complete = set.len() == points.len();
    if complete && options.method == EnclosingMethod::Newton {
        // A few points are a working set that needs no pass: straight to rounding, and the final check.
        iterations = newton::solve(rank, &mut set, &mut moments, &mut work, ROUNDING, max_iterations);
        recenter(points, rank, &mut frame, &mut set, &mut moments);
        observer(EnclosingIterate {
            iteration: iterations,
            scans,
            log_det_gap: moments.log_det_gap(r).max(0.0),
            indices: &set.index,
            weights: &set.u,
        });
        let certificate = Certificate::from_weights(points, rank, &frame, &set, &moments);
        let solved = finish(points, &frame, certificate, options.epsilon, Status::Converged, iterations, scans)?;
        if solved.status == Status::Converged {
            return Ok(solved);
        }
        scans = solved.scans;
    }
    // What is asked of a working set: a little below the gap over all points seen last, and tight once that is small.
    let tight = (0.1 * options.epsilon).max(1e-15);
    let mut inner_gap: f64 = if complete { tight } else { 1e-2 };
    // How far the next iterate is expected to fall short; only the share of points forgotten depends on it.
    let mut expected = 1.5 * r as f64;
    let mut pool: Option<Survivors<P::Dim>> = None;
    let mut polishing = options.method == EnclosingMethod::Newton;
    let ended = loop {
        let budget = max_iterations - iterations;
        let goal = inner_gap.max(tight);
        iterations += match options.method {
            EnclosingMethod::DualReducedNewton => {
                crate::dual_reduced::solve(rank, &mut set, &mut moments, goal, budget)
            }
            _ => newton::solve(rank, &mut set, &mut moments, &mut work, goal, budget),
        };
        recenter(points, rank, &mut frame, &mut set, &mut moments);
        let violators = match &mut pool {
            None => {
                scans += 1;
                let (violators, survivors) = look(points, rank, &frame, expected, capacity(points.len()));
                pool = survivors;
                violators
            }
            Some(survivors) => {
                let (violators, fewer) = look(survivors, rank, &frame, expected, capacity(survivors.len()));
                let violators =
                    Violators { found: violators.found.iter().map(|&i| survivors.index[i]).collect(), ..violators };
                if let Some(mut fewer) = fewer {
                    fewer.index.iter_mut().for_each(|i| *i = survivors.index[*i]);
                    *survivors = fewer;
                }
                violators
            }
        };
        // The unit ball of the frame grown to κ against the weights' bound: r·ln κ + (−ln det S − r·ln r).
        let gap = r as f64 * (violators.furthest / r as f64).ln() - moments.log_det_scatter;
        observer(EnclosingIterate {
            iteration: iterations,
            scans,
            log_det_gap: gap.max(0.0),
            indices: &set.index,
            weights: &set.u,
        });
        // Below what the rounding of the coordinates does to the gap there is nothing to gain.
        let floor = r as f64 * set.coordinate_error(points, &frame);
        if gap <= (0.5 * options.epsilon).max(floor) {
            if !polishing || gap <= floor.max(ROUNDING) || gap > QUADRATIC {
                break Status::Converged;
            }
            // Two more steps cost little. The final check, which looks at all points anyway, tells whether they served; if
            // ever they did not, the loop goes on without them.
            polishing = false;
            add(points, rank, &frame, &mut set, &violators.found);
            if !moments.compute(rank, &set.y, &set.u) {
                break Status::Converged;
            }
            let steps = max_iterations.saturating_sub(iterations).min(2);
            iterations += newton::solve(rank, &mut set, &mut moments, &mut work, ROUNDING, steps);
            recenter(points, rank, &mut frame, &mut set, &mut moments);
            let certificate = Certificate::from_weights(points, rank, &frame, &set, &moments);
            let polished = finish(points, &frame, certificate, options.epsilon, Status::Converged, iterations, scans)?;
            if polished.status == Status::Converged {
                return Ok(polished);
            }
            scans = polished.scans;
            inner_gap = tight;
            continue;
        }
        if iterations >= max_iterations || scans >= MAX_SCANS {
            break Status::IterationLimit;
        }
        expected = r as f64 + 0.3 * (violators.furthest - r as f64);
        // Points without weight that are well inside will hardly come back; those that do are found again.
        if !complete {
            let (u, q) = (set.u.clone(), moments.q.clone());
            set.retain(r, |i| u[i] > 0.0 || q[i] > 0.95 * r as f64);
        }
        let before = set.len();
        add(points, rank, &frame, &mut set, &violators.found);
        if !moments.compute(rank, &set.y, &set.u) {
            break Status::Stalled;
        }
        if set.len() > before {
            inner_gap = 0.02 * gap;
        } else if inner_gap > tight {
            inner_gap = (1e-3 * inner_gap).max(tight);
        } else {
            break Status::Stalled;
        }
    };
    let certificate = Certificate::from_weights(points, rank, &frame, &set, &moments);
    finish(points, &frame, certificate, options.epsilon, ended, iterations, scans)
}

/// How many of `len` points may survive a pass for it to pay to go on with them alone: their copy stays well below the
/// size of the input.
const fn capacity(len: usize) -> usize {
    if len < FEW { 0 } else { len / 4 }
}

/// Adds the points `found`, with weight zero.
fn add<P: Points, R: Dimension>(points: &P, rank: R, frame: &Frame, set: &mut WorkingSet, found: &[usize]) {
    let mut v = points.dim().zero();
    let mut y = rank.zero();
    for &index in found {
        if !set.index.contains(&index) {
            points.read(index, v.as_mut());
            frame.apply(points.dim(), rank, v.as_mut(), y.as_mut());
            set.push(index, y.as_ref());
        }
    }
}

/// Makes the ellipsoid of the weights, (y − c)ᵀS⁻¹(y − c) ≤ 1, the unit ball of the frame.
pub(crate) fn recenter<P: Points, R: Dimension>(
    points: &P,
    rank: R,
    frame: &mut Frame,
    set: &mut WorkingSet,
    moments: &mut Moments,
) {
    let origin = set.mean(points, frame);
    frame.recenter(rank, origin, &moments.factor);
    set.locate(points, rank, frame);
    moments.compute(rank, &set.y, &set.u);
}
