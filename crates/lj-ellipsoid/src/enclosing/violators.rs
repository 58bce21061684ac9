//! One pass over all points from the frame of an iterate: the largest distance, the farthest points, and those to drop.

use std::ops::Range;

use crate::enclosing::frame::Frame;
use crate::enclosing::scan::beyond;
use crate::numerics::dimension::Dimension;
use crate::numerics::linalg::dot;
use crate::points::parallel::in_parts;
use crate::points::{Copied, Points};

/// Violators are sought per orthant of at most this many leading coordinates, so that those of one pass spread out.
const ORTHANT_COORDINATES: usize = 5;

/// Violations below this share of the worst one mostly vanish once that is repaired.
const WORTH_ADDING: f64 = 0.1;

/// Points tested to estimate how many survive: at most so many, and at most one in so many.
const SAMPLE: usize = 512;
const SAMPLED: usize = 8;

/// The result of a pass.
pub(crate) struct Violators {
    /// κ = max |y|².
    pub(crate) furthest: f64,
    /// Points with |y|² > r, the furthest of each orthant, if their violation is worth adding.
    pub(crate) found: Vec<usize>,
}

/// The points that may still touch the ellipsoid: a part of the input, copied together.
pub(crate) struct Survivors<D> {
    pub(crate) index: Vec<usize>,
    pub(crate) points: Copied<D>,
}

/// The |y|² below which no point can touch the optimal ellipsoid, if the weights leave max |y|² at `furthest`.
///
/// Harman and Pronzato: with ε = max ω − n ≥ 0 every point with ω < n(1 + ε/2 − ½√(ε(4 + ε − 4/n))) has no weight at
/// the optimum. Here ω = 1 + |y|², n = r + 1 and ε = κ − r; a relative 1e-10 guards against rounding.
///
/// R. Harman, L. Pronzato, *Improvements on removing nonoptimal support points in D-optimum design algorithms*,
/// Stat. Probab. Lett. 77 (2007).
pub(crate) fn elimination_threshold(r: usize, furthest: f64) -> f64 {
    let n = r as f64 + 1.0;
    let epsilon = (furthest - r as f64).max(0.0);
    let omega = n * (1.0 + 0.5 * epsilon - 0.5 * (epsilon * (4.0 + epsilon - 4.0 / n)).sqrt());
    omega * (1.0 - 1e-10) - 1.0
}

/// The result of a pass over a part of the points.
struct Part {
    furthest: f64,
    /// The furthest point of each orthant, with |y|².
    champions: Vec<(usize, f64)>,
    /// Points beyond the elimination threshold, unless they are too many.
    kept: Option<Vec<usize>>,
}

impl Part {
    /// The results of both parts together.
    fn merge(mut self, part: Self, capacity: usize) -> Self {
        self.furthest = self.furthest.max(part.furthest);
        for (champion, other) in self.champions.iter_mut().zip(part.champions) {
            if other.1 > champion.1 {
                *champion = other;
            }
        }
        self.kept = self.kept.zip(part.kept).map(|(mut all, mut part)| {
            all.append(&mut part);
            all
        });
        self.kept = self.kept.filter(|all| all.len() <= capacity);
        self
    }
}

/// The least |y|² that matters: of a violation worth adding, or at least the largest |y|².
fn worth(r: f64, furthest: f64) -> f64 {
    if furthest > r { r + WORTH_ADDING * (furthest - r) } else { furthest }
}

/// Tests all points from `frame`, in which the weights have scatter I and mean 0 up to rounding.
///
/// If κ turns out at most `expected`, and no more than `capacity` points lie beyond the elimination threshold of
/// `expected`, these survivors are returned too: the threshold falls as κ grows, so theirs is on the safe side.
pub(crate) fn look<P: Points>(
    points: &P,
    rank: P::Dim,
    frame: &Frame<P::Dim>,
    expected: f64,
    capacity: usize,
) -> (Violators, Option<Survivors<P::Dim>>) {
    let r = rank.get();
    let keep_from = elimination_threshold(r, expected);
    let keeping = capacity > 0 && keep_from > 0.0 && few_beyond(points, rank, frame, keep_from, capacity);
    let keep = keeping.then_some((keep_from, capacity));
    let Part { furthest, champions, kept } =
        in_parts(points.len(), |range| part(points, range, rank, frame, keep), |all, part| all.merge(part, capacity));
    let cutoff = worth(r as f64, furthest);
    let found = champions.iter().filter(|(_, q)| *q > r as f64 && *q >= cutoff).map(|(i, _)| *i).collect();
    let survivors = kept
        .filter(|_| furthest <= expected)
        .map(|index| Survivors { points: Copied::new(points.dim(), points, index.iter().copied()), index });
    (Violators { furthest, found }, survivors)
}

/// Whether a sample suggests that at most `capacity` points lie beyond `threshold`: collecting survivors only to find
/// them too many is costly.
fn few_beyond<P: Points>(points: &P, rank: P::Dim, frame: &Frame<P::Dim>, threshold: f64, capacity: usize) -> bool {
    let mut v = points.dim().zero();
    let mut y = rank.zero();
    let step = (points.len() / SAMPLE).max(SAMPLED);
    let sampled = (0..points.len()).step_by(step).filter(|&i| {
        points.read(i, v.as_mut());
        frame.apply(points.dim(), rank, v.as_mut(), y.as_mut());
        dot(y.as_ref(), y.as_ref()) >= threshold
    });
    sampled.count() * step * 10 <= capacity * 9
}

/// One range of a pass; `keep` is the elimination threshold and the most survivors wanted.
fn part<P: Points>(
    points: &P,
    range: Range<usize>,
    rank: P::Dim,
    frame: &Frame<P::Dim>,
    keep: Option<(f64, usize)>,
) -> Part {
    let r = rank.get();
    let coordinates = r.min(ORTHANT_COORDINATES);
    let mut champions = vec![(usize::MAX, f64::NEG_INFINITY); 1 << coordinates];
    let mut furthest: f64 = 0.0;
    let (keep_from, capacity) = keep.unwrap_or((f64::INFINITY, 0));
    let mut kept = keep.map(|_| Vec::new());
    let mut v = points.dim().zero();
    let mut y = rank.zero();
    let mut cutoff = 0.0;
    beyond(points, range, rank, frame, 0.0, |i, q| {
        if q >= keep_from
            && let Some(list) = &mut kept
        {
            list.push(i);
            if list.len() > capacity {
                kept = None;
            }
        }
        if q >= cutoff {
            furthest = furthest.max(q);
            cutoff = worth(r as f64, furthest);
            points.read(i, v.as_mut());
            frame.apply(points.dim(), rank, v.as_mut(), y.as_mut());
            let mut orthant = 0;
            for k in 0..coordinates {
                orthant |= usize::from(y.as_ref()[k] > 0.0) << k;
            }
            if q > champions[orthant].1 {
                champions[orthant] = (i, q);
            }
        }
        if kept.is_some() { cutoff.min(keep_from) } else { cutoff }
    });
    Part { furthest, champions, kept }
}
