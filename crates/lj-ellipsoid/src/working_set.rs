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

/// The most Newton steps over all working sets, unless the caller says otherwise.
const DEFAULT_ITERATIONS: usize = 2_000;

/// The most passes over the points: each adds at least one violator, and in practice less than twenty are needed.
const MAX_SCANS: usize = 500;

/// Violators are sought per orthant of at most this many leading coordinates, so that those of one pass spread out.
const ORTHANT_COORDINATES: usize = 5;

/// Solves by Newton's method (or the dual reduced Newton method) on a working set.
pub(crate) fn solve<P: Points, R: Dimension>(
    points: &P,
    rank: R,
    start: Start,
    options: EnclosingOptions,
    mut observer: impl FnMut(EnclosingIterate<'_>),
) -> Result<Solution, EnclosingError> {
    let r = rank.get();
    let max_iterations = if options.max_iterations == 0 { DEFAULT_ITERATIONS } else { options.max_iterations };
    let Start { mut frame, working, mut scans } = start;
    let mut set = WorkingSet::uniform(working);
    let mut moments = Moments::default();
    let mut work = newton::Workspace::default();
    set.locate(points, rank, &frame);
    if !moments.compute(rank, &set.y, &set.u) {
        return Err(EnclosingError::OutOfRange);
    }
    let mut iterations = 0;
    // What is asked of a working set: a little below the gap over all points seen last, and tight once that is small.
    let tight = (0.1 * options.epsilon).max(1e-15);
    let mut inner_gap: f64 = 1e-2;
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
        let violators = scan(points, rank, &frame);
        scans += 1;
        // The unit ball of the frame grown to κ against the weights' bound: r·ln κ + (−ln det S − r·ln r).
        let gap = r as f64 * (violators.furthest / r as f64).ln() - moments.log_det_scatter;
        observer(EnclosingIterate {
            iteration: iterations,
            scans,
            log_det_gap: gap.max(0.0),
            indices: &set.index,
            weights: &set.u,
        });
        if gap <= 0.5 * options.epsilon {
            break Status::Converged;
        }
        if iterations >= max_iterations || scans >= MAX_SCANS {
            break Status::IterationLimit;
        }
        // Points without weight that are well inside will hardly come back; those that do are found again.
        let (u, q) = (set.u.clone(), moments.q.clone());
        set.retain(r, |i| u[i] > 0.0 || q[i] > 0.95 * r as f64);
        let mut added = false;
        for (index, q) in violators.found {
            // Violations far below the worst one are mostly gone once that is repaired.
            if q > r as f64 + 0.1 * (violators.furthest - r as f64) && !set.index.contains(&index) {
                let mut v = points.dim().zero();
                let mut y = rank.zero();
                points.read(index, v.as_mut());
                frame.apply(points.dim(), rank, v.as_mut(), y.as_mut());
                set.push(index, y.as_ref());
                added = true;
            }
        }
        if !moments.compute(rank, &set.y, &set.u) {
            break Status::Stalled;
        }
        if added {
            inner_gap = 0.02 * gap;
        } else if inner_gap > tight {
            inner_gap = (1e-3 * inner_gap).max(tight);
        } else {
            break Status::Stalled;
        }
    };
    let certificate = Certificate::from_weights(points, rank, &frame, &set, &moments);
    finish(points, &frame, certificate, options.epsilon, ended, iterations, scans + 2)
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

/// The furthest points from the origin of the frame.
struct Violators {
    /// κ = max |y|².
    furthest: f64,
    /// The furthest point of each orthant, with |y|².
    found: Vec<(usize, f64)>,
}

/// One pass over all points.
fn scan<P: Points, R: Dimension>(points: &P, rank: R, frame: &Frame) -> Violators {
    let dim = points.dim();
    let coordinates = rank.get().min(ORTHANT_COORDINATES);
    let mut found = vec![(usize::MAX, f64::NEG_INFINITY); 1 << coordinates];
    let mut v = dim.zero();
    let mut y = rank.zero();
    for i in 0..points.len() {
        points.read(i, v.as_mut());
        frame.apply(dim, rank, v.as_mut(), y.as_mut());
        let y = y.as_ref();
        let mut q = 0.0;
        let mut orthant = 0;
        for k in 0..rank.get() {
            q += y[k] * y[k];
            if k < coordinates {
                orthant |= usize::from(y[k] > 0.0) << k;
            }
        }
        if q > found[orthant].1 {
            found[orthant] = (i, q);
        }
    }
    found.retain(|(i, _)| *i != usize::MAX);
    Violators { furthest: found.iter().fold(0.0, |m, (_, q)| q.max(m)), found }
}
