//! One look at all points from the frame of an iterate: how far they reach, who reaches furthest, who can be forgotten.

use crate::dimension::Dimension;
use crate::frame::Frame;
use crate::linalg::dot;
use crate::points::Points;
use crate::scan::beyond;

/// Violators are sought per orthant of at most this many leading coordinates, so that those of one pass spread out.
const ORTHANT_COORDINATES: usize = 5;

/// Violations below this share of the worst one are mostly gone once that is repaired.
const WORTH_ADDING: f64 = 0.1;

/// Points asked to estimate how many survive.
const SAMPLE: usize = 512;

/// What a pass found.
pub(crate) struct Violators {
    /// κ = max |y|².
    pub(crate) furthest: f64,
    /// Points with |y|² > r, the furthest of each orthant, if their violation is worth adding.
    pub(crate) found: Vec<usize>,
}

/// The points that may still touch the ellipsoid: a part of the input, copied together.
pub(crate) struct Survivors<D> {
    dim: D,
    pub(crate) index: Vec<usize>,
    coordinates: Vec<f64>,
}

impl<D: Dimension> Points for Survivors<D> {
    type Dim = D;

    #[inline(always)]
    fn dim(&self) -> D {
        self.dim
    }

    #[inline(always)]
    fn len(&self) -> usize {
        self.index.len()
    }

    #[inline(always)]
    fn read(&self, i: usize, out: &mut [f64]) {
        let n = self.dim.get();
        out.copy_from_slice(&self.coordinates[i * n..(i + 1) * n]);
    }
}

/// The |y|² below which no point can touch the optimal ellipsoid, where the weights leave max |y|² at `furthest`.
///
/// Harman and Pronzato: with ε = max ω − n ≥ 0 every point with ω < n(1 + ε/2 − ½√(ε(4 + ε − 4/n))) has no weight at the
/// optimum. Here ω = 1 + |y|², n = r + 1 and ε = κ − r; a relative 1e-10 guards against rounding.
///
/// R. Harman, L. Pronzato, *Improvements on removing nonoptimal support points in D-optimum design algorithms*,
/// Stat. Probab. Lett. 77 (2007).
pub(crate) fn elimination_threshold(r: usize, furthest: f64) -> f64 {
    let n = r as f64 + 1.0;
    let epsilon = (furthest - r as f64).max(0.0);
    let omega = n * (1.0 + 0.5 * epsilon - 0.5 * (epsilon * (4.0 + epsilon - 4.0 / n)).sqrt());
    omega * (1.0 - 1e-10) - 1.0
}

/// Looks at all points from `frame`, in which the weights have scatter I and mean 0 up to rounding.
///
/// If κ turns out at most `expected`, and fewer than `capacity` points lie beyond the elimination threshold of
/// `expected`, these survivors are answered too: the threshold falls as κ grows, so theirs is on the safe side.
pub(crate) fn look<P: Points, R: Dimension>(
    points: &P,
    rank: R,
    frame: &Frame,
    expected: f64,
    capacity: usize,
) -> (Violators, Option<Survivors<P::Dim>>) {
    let r = rank.get();
    let dim = points.dim();
    let n = dim.get();
    let coordinates = r.min(ORTHANT_COORDINATES);
    let mut champions = vec![(usize::MAX, f64::NEG_INFINITY); 1 << coordinates];
    let mut furthest: f64 = 0.0;
    let mut kept: Vec<usize> = Vec::new();
    let keep_from = elimination_threshold(r, expected);
    let mut v = dim.zero();
    let mut y = rank.zero();
    let mut keeping = capacity > 0 && keep_from > 0.0 && {
        // Collecting survivors only to find them too many is dear: ask a sample first.
        let step = (points.len() / SAMPLE).max(1);
        let sampled = (0..points.len()).step_by(step).filter(|&i| {
            points.read(i, v.as_mut());
            frame.apply(dim, rank, v.as_mut(), y.as_mut());
            dot(y.as_ref(), y.as_ref()) >= keep_from
        });
        sampled.count() * points.len() <= capacity * SAMPLE * 9 / 10
    };
    // What is worth a closer look: a violation worth adding, or at least the largest |y|².
    let worth = |furthest: f64| {
        let r = r as f64;
        if furthest > r { r + WORTH_ADDING * (furthest - r) } else { furthest }
    };
    let mut cutoff = 0.0;
    let first = if keeping { 0.0f64.max(keep_from.min(cutoff)) } else { 0.0 };
    beyond(points, 0..points.len(), rank, frame, first, |i, q| {
        if keeping && q >= keep_from {
            if kept.len() == capacity {
                kept = Vec::new();
                keeping = false;
            } else {
                kept.push(i);
            }
        }
        if q >= cutoff {
            furthest = furthest.max(q);
            cutoff = worth(furthest);
            points.read(i, v.as_mut());
            frame.apply(dim, rank, v.as_mut(), y.as_mut());
            let mut orthant = 0;
            for k in 0..coordinates {
                orthant |= usize::from(y.as_ref()[k] > 0.0) << k;
            }
            if q > champions[orthant].1 {
                champions[orthant] = (i, q);
            }
        }
        if keeping { cutoff.min(keep_from) } else { cutoff }
    });
    let found = champions.iter().filter(|(_, q)| *q > r as f64 && *q >= cutoff).map(|(i, _)| *i).collect();
    let survivors = (keeping && furthest <= expected).then(|| {
        let mut coordinates = vec![0.0; kept.len() * n];
        kept.iter().zip(coordinates.chunks_exact_mut(n)).for_each(|(&i, out)| points.read(i, out));
        Survivors { dim, index: kept, coordinates }
    });
    (Violators { furthest, found }, survivors)
}
