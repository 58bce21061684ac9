//! The outer loop: solve a small working set, test all points, add the worst violators.

use crate::enclosing::iterate::Iterate;
use crate::enclosing::newton::Workspace;
use crate::enclosing::problem::{Observer, Problem};
use crate::enclosing::solution::Solution;
use crate::enclosing::start::Start;
use crate::enclosing::violators::{Survivors, Violators, look};
use crate::enclosing::working_set::WorkingSet;
use crate::error::EnclosingError;
use crate::numerics::dimension::Dimension;
use crate::options::{EnclosingMethod, EnclosingOptions, Status};
use crate::points::Points;

/// The most Newton steps over all working sets, unless the caller says otherwise.
const DEFAULT_ITERATIONS: usize = 2_000;

/// The most passes over the points: each adds at least one violator, and in practice less than twenty are needed.
const MAX_SCANS: usize = 500;

/// Below this number of points, dropping some does not pay.
const FEW: usize = 512;

/// Below this gap Newton's method doubles the digits with each step, and two more end at rounding.
const QUADRATIC: f64 = 1e-6;

/// A gap that is certainly rounding.
const ROUNDED_GAP: f64 = 1e-14;

/// Improves the weights of a working set until their gap over it is at most this, in at most so many steps; returns the
/// number of steps.
pub(crate) type Improve<D> = fn(&mut Iterate<D>, &mut Workspace<D>, f64, usize) -> usize;

/// Solves by a working set, whose weights `improve` finds.
pub(crate) fn solve<P: Points>(
    problem: &Problem<'_, P>,
    improve: Improve<P::Dim>,
    start: Start<P::Dim>,
    observer: &mut Observer<'_>,
) -> Result<Solution<P::Dim>, EnclosingError> {
    let Problem { points, options, .. } = *problem;
    let mut search = Search::new(problem, improve, start)?;
    let newton = options.method == EnclosingMethod::Newton;
    if search.complete && newton {
        // A few points are a working set that needs no pass: they are solved to rounding, and checked at the end.
        search.improve(ROUNDED_GAP, search.max_iterations);
        observer(search.at.observed(search.at.moments.log_det_gap()));
        let solved = search.finish(Status::Converged)?;
        if solved.status == Status::Converged {
            return Ok(solved);
        }
        search.at.scans = solved.scans;
    }
    let mut polishing = newton;
    loop {
        search.improve(search.inner_gap.max(search.tight), search.iterations_left());
        let violators = search.look();
        let gap = search.gap(&violators);
        observer(search.at.observed(gap));
        let floor = search.rounding();
        if gap <= (0.5 * options.epsilon).max(floor) {
            if !polishing || gap <= floor.max(ROUNDED_GAP) || gap > QUADRATIC {
                return search.finish(Status::Converged);
            }
            // Two more steps cost little. The final check, which tests all points anyway, shows whether they helped; if
            // they did not, the loop goes on without them.
            polishing = false;
            search.at.add(points, &violators.found);
            if !search.at.update() {
                return search.finish(Status::Converged);
            }
            search.improve(ROUNDED_GAP, search.iterations_left().min(2));
            let polished = search.finish(Status::Converged)?;
            if polished.status == Status::Converged {
                return Ok(polished);
            }
            search.at.scans = polished.scans;
            search.inner_gap = search.tight;
        } else if search.iterations_left() == 0 || search.at.scans >= MAX_SCANS {
            return search.finish(Status::IterationLimit);
        } else if !search.grow(&violators, gap) {
            return search.finish(Status::Stalled);
        }
    }
}

/// The working set and the state that controls it.
struct Search<'a, P: Points> {
    points: &'a P,
    options: EnclosingOptions,
    max_iterations: usize,
    improve: Improve<P::Dim>,
    at: Iterate<P::Dim>,
    work: Workspace<P::Dim>,
    /// Whether the working set is all points.
    complete: bool,
    /// The gap required of a working set: a little below the last gap over all points…
    inner_gap: f64,
    /// …and no less than this.
    tight: f64,
    /// The expected κ of the next iterate; only the share of points dropped depends on it.
    expected: f64,
    /// The points that may still touch, once there are few.
    pool: Option<Survivors<P::Dim>>,
}

impl<'a, P: Points> Search<'a, P> {
    fn new(problem: &Problem<'a, P>, improve: Improve<P::Dim>, start: Start<P::Dim>) -> Result<Self, EnclosingError> {
        let Problem { points, rank, options } = *problem;
        let Start { frame, working, weights, scans } = start;
        let complete = working.len() == points.len();
        let mut at = Iterate::new(points, rank, frame, WorkingSet::new(working, weights), scans)?;
        // The starting frame may be skew: compute in the one in which the weights' ellipsoid is round.
        let diagonal = at.moments.factor.as_ref().iter().step_by(rank.get() + 1);
        let (least, most) = diagonal.fold((f64::INFINITY, 0.0), |(l, m): (f64, f64), &d| (l.min(d), m.max(d)));
        if least < 0.05 * most {
            at.recenter(points);
        }
        let tight = (0.1 * options.epsilon).max(1e-15);
        Ok(Self {
            points,
            options,
            max_iterations: options.max_iterations.unwrap_or(DEFAULT_ITERATIONS),
            improve,
            work: Workspace::new(rank),
            complete,
            inner_gap: if complete { tight } else { 1e-2 },
            tight,
            expected: 1.5 * rank.get() as f64,
            pool: None,
            at,
        })
    }

    fn iterations_left(&self) -> usize {
        self.max_iterations - self.at.iterations
    }

    /// Improves the weights of the working set, and moves to the frame in which their ellipsoid is the unit ball.
    fn improve(&mut self, gap: f64, max_steps: usize) {
        self.at.iterations += (self.improve)(&mut self.at, &mut self.work, gap, max_steps);
        self.at.recenter(self.points);
    }

    /// Tests all points, or the survivors of an earlier pass.
    fn look(&mut self) -> Violators {
        let Some(survivors) = &mut self.pool else {
            self.at.scans += 1;
            let capacity = capacity(self.points.len());
            let (violators, survivors) = look(self.points, self.at.rank, &self.at.frame, self.expected, capacity);
            self.pool = survivors;
            return violators;
        };
        let capacity = capacity(survivors.index.len());
        let (mut violators, fewer) = look(&survivors.points, self.at.rank, &self.at.frame, self.expected, capacity);
        violators.found.iter_mut().for_each(|i| *i = survivors.index[*i]);
        if let Some(mut fewer) = fewer {
            fewer.index.iter_mut().for_each(|i| *i = survivors.index[*i]);
            *survivors = fewer;
        }
        violators
    }

    /// The gap of the unit ball of the frame grown to κ: r·ln κ + (−ln det S − r·ln r).
    fn gap(&self, violators: &Violators) -> f64 {
        let r = self.at.rank.get() as f64;
        r * libm::log(violators.furthest / r) - self.at.moments.log_det_scatter
    }

    /// The effect of the coordinates' rounding on the gap; a smaller gap cannot be reached.
    fn rounding(&self) -> f64 {
        self.at.rank.get() as f64 * self.at.set.coordinate_error(self.points, &self.at.frame)
    }

    /// Exchanges members that are well inside for violators; false if there is nothing left to try.
    fn grow(&mut self, violators: &Violators, gap: f64) -> bool {
        let r = self.at.rank.get();
        self.expected = r as f64 + 0.3 * (violators.furthest - r as f64);
        // Points without weight that are well inside seldom return; those that do are found again.
        if !self.complete {
            let q = &self.at.moments.q;
            self.at.set.retain(r, |i, u| u > 0.0 || q[i] > 0.95 * r as f64);
        }
        let before = self.at.set.len();
        self.at.add(self.points, &violators.found);
        if !self.at.update() {
            return false;
        }
        if self.at.set.len() > before {
            self.inner_gap = 0.02 * gap;
        } else if self.inner_gap > self.tight {
            self.inner_gap = (1e-3 * self.inner_gap).max(self.tight);
        } else {
            return false;
        }
        true
    }

    fn finish(&self, ended: Status) -> Result<Solution<P::Dim>, EnclosingError> {
        self.at.finish(self.points, self.options.epsilon, ended)
    }
}

/// How many of `len` points may survive a pass for it to pay to continue with them alone: their copy stays well below
/// the size of the input.
const fn capacity(len: usize) -> usize {
    if len < FEW { 0 } else { len / 4 }
}
