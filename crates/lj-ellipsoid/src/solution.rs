//! From the last iterate to the ellipsoid that is returned: outward rounding, certified gap, contact points.

use std::ops::Range;

use crate::design::{Moments, WorkingSet};
use crate::dimension::{Dimension, Dynamic};
use crate::ellipsoid::radius_at;
use crate::error::EnclosingError;
use crate::frame::Frame;
use crate::linalg::{UNIT_ROUNDOFF, dot, sum_of_logarithms};
use crate::options::Status;
use crate::parallel::in_parts;
use crate::points::Points;
use crate::scan::beyond;
use crate::shape::{Shape, principal_axes, shape_from_axes};

/// The weight of a point in the certificate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weight {
    /// Which point.
    pub index: usize,
    /// Its weight, positive; the weights sum to one up to rounding.
    pub weight: f64,
}

/// A solved enclosing problem of any dimension.
#[derive(Clone, Debug)]
pub(crate) struct Solution<N: Dimension> {
    pub(crate) shape: Shape<N>,
    pub(crate) log_det_gap: f64,
    pub(crate) weights: Vec<Weight>,
    pub(crate) contacts: Vec<usize>,
    pub(crate) status: Status,
    pub(crate) iterations: usize,
    pub(crate) scans: usize,
}

impl<N: Dimension> Solution<N> {
    /// The ellipsoid around `count` points that all are `center`.
    pub(crate) fn point(dim: N, center: N::Point, count: usize, scans: usize) -> Self {
        Self {
            shape: Shape { center, ..shape_from_axes(dim, 0, dim.zero(), dim.zero_matrix()) },
            log_det_gap: 0.0,
            weights: vec![Weight { index: 0, weight: 1.0 }],
            contacts: (0..count).collect(),
            status: Status::Converged,
            iterations: 0,
            scans,
        }
    }
}

/// The upper bound on ln det X* that a method proves, in the coordinates of its frame, and what proves it.
pub(crate) struct Certificate {
    /// Every ellipsoid that contains the points has ln det X ≤ this, X in the frame.
    pub(crate) log_det_bound: f64,
    pub(crate) weights: Vec<Weight>,
}

impl Certificate {
    /// From weights: ln det X ≤ −ln det S − r·ln r, loosened by what the rounding of the coordinates can do to ln det S:
    /// 2·tr(S⁻¹Σuᵢyᵢδyᵢᵀ) ≤ 2√r·max|L⁻¹δyᵢ|.
    pub(crate) fn from_weights<P: Points, R: Dimension>(
        points: &P,
        rank: R,
        frame: &Frame<P::Dim>,
        set: &WorkingSet,
        moments: &Moments<R>,
    ) -> Self {
        let r = rank.get() as f64;
        // |L⁻¹| ≤ |L⁻¹|_F; L is near the identity in the last frame.
        let mut inverse_norm: f64 = 0.0;
        for k in 0..rank.get() {
            let mut e = rank.zero();
            e.as_mut()[k] = 1.0;
            crate::linalg::solve_lower(rank, moments.factor.as_ref(), e.as_mut());
            inverse_norm += dot(e.as_ref(), e.as_ref());
        }
        let rounding = 2.0 * r.sqrt() * inverse_norm.sqrt() * set.coordinate_error(points, frame)
            + 4.0 * (r + 2.0) * r * UNIT_ROUNDOFF;
        let weighted = set.index.iter().zip(&set.u).filter(|(_, u)| **u > 0.0);
        let mut weights = Vec::with_capacity(set.len());
        weights.extend(weighted.map(|(&index, &weight)| Weight { index, weight }));
        Self { log_det_bound: -moments.log_det_scatter - r * r.ln() + rounding, weights }
    }
}

/// How far the points reach in an ellipsoid, with the rounding of the evaluation added.
struct Reach<N: Dimension> {
    /// Where the ellipsoid is the unit ball.
    frame: Frame<N>,
    /// At least max |diag(1/a)·R·(x − c)|, in whatever order it is evaluated.
    axes: f64,
    /// max (x − c)ᵀX(x − c).
    matrix: f64,
    /// The points that may be contacts, with |diag(1/a)·R·(x − c)|²; `None` where they are a large part of all.
    candidates: Option<Vec<(usize, f64)>>,
    /// The points that may be the furthest, unless they are many.
    leaders: Option<Vec<usize>>,
    /// Passes over the points.
    passes: usize,
}

/// What a pass found in a part of the points.
struct Found {
    /// max |diag(1/a)·R·(x − c)|².
    furthest: f64,
    /// The points near the furthest, unless they are too many.
    list: Option<Vec<(usize, f64)>>,
    /// No part had too many.
    complete: bool,
}

impl Found {
    /// What both parts found, at most `room` points within `near` of the furthest.
    fn merge(self, part: Self, near: f64, room: usize) -> Self {
        let furthest = self.furthest.max(part.furthest);
        let list = self.list.zip(part.list).and_then(|(mut all, part)| {
            all.extend(part);
            all.retain(|(_, q)| *q >= near * furthest);
            (all.len() <= room).then_some(all)
        });
        Self { furthest, list, complete: self.complete && part.complete }
    }
}

/// Points whose rounding is bounded one by one.
const MANY: usize = 256;

/// Candidates that are mostly enough.
const SOME: usize = 16;

/// Turns the unit ball of `frame` into the ellipsoid that contains every point as evaluated in `f64`, with its gap.
pub(crate) fn finish<P: Points>(
    points: &P,
    frame: &Frame<P::Dim>,
    certificate: Certificate,
    epsilon: f64,
    ended: Status,
    iterations: usize,
    scans: usize,
) -> Result<Solution<P::Dim>, EnclosingError> {
    let dim = points.dim();
    let r = frame.rank();
    let mut shape = principal_axes(dim, r, dim.matrix(frame.map().iter().copied()));
    shape.center.clone_from(&frame.origin);
    // A point with weight lies within the gap of the surface.
    let tolerance = (certificate.log_det_bound + r as f64 * (r as f64).ln()).max(1e-9);
    let reach = reach(points, r, &shape, tolerance);
    let growth = touch(points, &mut shape, &reach);
    let shrink = (1.0 - 4.0 * UNIT_ROUNDOFF) / reach.matrix.max(growth * growth);
    shape.matrix.as_mut().iter_mut().for_each(|x| *x *= shrink);
    let semi_axes = &shape.semi_axes.as_ref()[..r];
    shape.log_det = -2.0 * sum_of_logarithms(semi_axes.iter().copied());
    if !shape.log_det.is_finite() || semi_axes.iter().any(|a| !a.is_finite()) {
        return Err(EnclosingError::OutOfRange);
    }
    // ln det X* − ln det X: the transformation into the frame cancels, and with it its size.
    let logarithms: f64 = semi_axes.iter().map(|a| a.ln().abs()).sum();
    let log_det_gap =
        (certificate.log_det_bound + 2.0 * r as f64 * growth.ln() + 4.0 * UNIT_ROUNDOFF * logarithms).max(0.0);
    let status = match ended {
        Status::IterationLimit if log_det_gap > epsilon => Status::IterationLimit,
        _ if log_det_gap <= epsilon => Status::Converged,
        _ => Status::Stalled,
    };
    let nearest = growth * (1.0 - log_det_gap.max(1e-9));
    let contacts = match &reach.candidates {
        Some(candidates) => {
            let mut contacts = Vec::with_capacity(candidates.len().min(SOME));
            contacts.extend(candidates.iter().filter(|(_, q)| q.sqrt() >= nearest).map(|(i, _)| *i));
            contacts
        }
        None => beyond_radius(points, r, &reach.frame, nearest),
    };
    let scans = scans + reach.passes + usize::from(reach.candidates.is_none());
    Ok(Solution { shape, log_det_gap, weights: certificate.weights, contacts, status, iterations, scans })
}

/// One pass over the points.
///
/// The rounding of an evaluation, whatever the order of its sums, is bounded for each point that could be the furthest.
/// Where these are many (points on a sphere) the bound that holds for all serves instead.
fn reach<P: Points>(points: &P, r: usize, shape: &Shape<P::Dim>, tolerance: f64) -> Reach<P::Dim> {
    let dim = points.dim();
    let n = dim.get();
    let gamma = (n + 3) as f64 * UNIT_ROUNDOFF;
    let (axes, semi_axes) = (&shape.axes.as_ref()[..n * n], &shape.semi_axes.as_ref()[..n]);
    let mut map = dim.zero_matrix();
    for ((to, axis), a) in map.as_mut().chunks_exact_mut(n).zip(axes.chunks_exact(n)).zip(&semi_axes[..r]) {
        to.iter_mut().zip(axis).for_each(|(to, x)| *to = x / a);
    }
    let frame = Frame::new(shape.center.clone(), map, r);
    // Of e = x − c: |T·e| and eᵀXe, each with a bound on the rounding of its evaluation.
    let errors = |e: &[f64]| {
        let e = &e[..n];
        let (mut square, mut error) = (0.0, 0.0);
        for row in frame.map().chunks_exact(n) {
            let (mut along, mut size) = (0.0, 0.0);
            for k in 0..n {
                let term = row[k] * e[k];
                along += term;
                size += term.abs();
            }
            square += along * along;
            error += (gamma * size) * (gamma * size);
        }
        let (mut value, mut size) = (0.0, 0.0);
        let matrix = &shape.matrix.as_ref()[..n * n];
        for i in 0..n {
            for j in 0..n {
                let term = matrix[i * n + j] * e[i] * e[j];
                value += term;
                size += term.abs();
            }
        }
        (error.sqrt(), square.sqrt(), 2.0 * gamma * size, value)
    };
    // The half-extents of the ellipsoid along the coordinates bound |e| of every point in it. X itself is AᵀA only up to
    // rounding of the same size.
    let extent =
        dim.point((0..n).map(|k| (0..r).map(|j| (semi_axes[j] * axes[j * n + k]).powi(2)).sum::<f64>().sqrt()));
    let (error, _, error_matrix, _) = errors(extent.as_ref());
    let largest_error = 2.0 * error + 2.0 * error_matrix;
    let near = 1.0 - (2.0 * largest_error).max(4.0 * tolerance);

    // Candidates take as much room as the points themselves where all are on the surface: then rather look once more.
    let room = MANY.max(points.len() / 8);
    let mut furthest: f64 = 0.0;
    // While the furthest is not known too many may seem near it; the second look knows it.
    let mut passes = 0;
    let candidates = loop {
        passes += 1;
        let collect = |range: Range<usize>| {
            let mut furthest = furthest;
            let mut list = Some(Vec::with_capacity(range.len().min(SOME)));
            in_rank(points, range, r, &frame, near * furthest, |i, q| {
                furthest = furthest.max(q);
                if let Some(found) = &mut list {
                    found.push((i, q));
                    if found.len() > room {
                        list = None;
                    }
                }
                if list.is_some() { near * furthest } else { furthest }
            });
            Found { furthest, complete: list.is_some(), list }
        };
        let mut found = in_parts(points.len(), collect, |all, part| all.merge(part, near, room));
        furthest = found.furthest;
        if let Some(list) = &mut found.list {
            list.retain(|(_, q)| *q >= near * furthest);
        }
        if found.complete || passes == 2 {
            break found.list;
        }
    };

    let least = furthest * (1.0 - 2.0 * largest_error);
    let leaders: Option<Vec<usize>> = candidates.as_ref().and_then(|candidates| {
        let mut leaders = candidates.iter().filter(|(_, q)| *q >= least).map(|(i, _)| *i);
        let mut found = Vec::with_capacity(candidates.len().min(SOME));
        found.extend(leaders.by_ref().take(MANY));
        leaders.next().is_none().then_some(found)
    });
    let (mut axes, mut matrix) = (furthest.sqrt() * (1.0 + error), furthest * (1.0 + largest_error));
    if let Some(leaders) = &leaders {
        let mut v = dim.zero();
        (axes, matrix) = (0.0, 0.0);
        for &i in leaders {
            points.read(i, v.as_mut());
            let e = v.as_mut();
            for k in 0..n {
                e[k] -= frame.origin.as_ref()[k];
            }
            let (error, radius, error_matrix, value) = errors(e);
            axes = axes.max(radius + error);
            matrix = matrix.max(value + error_matrix);
        }
    }
    Reach { frame, axes, matrix, candidates, leaders, passes }
}

/// Scales the semi-axes so that the furthest point touches, and answers by how much: the least that holds every point as
/// evaluated by [`radius_at`].
///
/// A scaling that makes the largest radius one may, by its own rounding, leave one a rounding beyond: then once more.
/// Where points are many, or rounding does not settle, the scaling is what holds them in any order of evaluation.
fn touch<P: Points>(points: &P, shape: &mut Shape<P::Dim>, reach: &Reach<P::Dim>) -> f64 {
    let mut v = points.dim().zero();
    let mut growth = 1.0;
    for attempt in 0..if reach.leaders.is_some() { 8 } else { 0 } {
        let mut furthest: f64 = 0.0;
        for &i in reach.leaders.iter().flatten() {
            points.read(i, v.as_mut());
            let (center, axes, semi_axes) = (shape.center.as_ref(), shape.axes.as_ref(), shape.semi_axes.as_ref());
            furthest = furthest.max(radius_at(center, axes, semi_axes, v.as_ref()));
        }
        if attempt > 0 && furthest <= 1.0 {
            return growth;
        }
        shape.semi_axes.as_mut().iter_mut().for_each(|a| *a *= furthest);
        growth *= furthest;
    }
    let rest = reach.axes / growth * (1.0 + 6.0 * UNIT_ROUNDOFF);
    shape.semi_axes.as_mut().iter_mut().for_each(|a| *a *= rest);
    growth * rest
}

/// The points at least `radius` from the origin of the frame.
fn beyond_radius<P: Points>(points: &P, r: usize, frame: &Frame<P::Dim>, radius: f64) -> Vec<usize> {
    let look = |range| {
        let mut found = Vec::new();
        in_rank(points, range, r, frame, 0.0, |i, q| {
            if q.sqrt() >= radius {
                found.push(i);
            }
            0.999_999 * radius * radius
        });
        found
    };
    in_parts(points.len(), look, |mut all, mut part| {
        all.append(&mut part);
        all
    })
}

/// [`beyond`], with the rank as constant as the dimension where they are equal.
fn in_rank<P: Points>(
    points: &P,
    range: Range<usize>,
    r: usize,
    frame: &Frame<P::Dim>,
    cutoff: f64,
    visit: impl FnMut(usize, f64) -> f64,
) {
    if r == points.dim().get() {
        beyond(points, range, points.dim(), frame, cutoff, visit);
    } else {
        beyond(points, range, Dynamic(r), frame, cutoff, visit);
    }
}
