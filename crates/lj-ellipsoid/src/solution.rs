//! From the last iterate to the ellipsoid that is returned: axes, outward rounding, certified gap, contact points.

use std::ops::Range;

use crate::design::{Moments, WorkingSet};
use crate::dimension::{Dimension, Dynamic};
use crate::ellipsoid::radius_at;
use crate::error::EnclosingError;
use crate::frame::Frame;
use crate::linalg::{UNIT_ROUNDOFF, dot, orthogonalize_rows, sum_of_logarithms, triangularize};
use crate::options::Status;
use crate::parallel::map_ranges;
use crate::points::Points;
use crate::scan::beyond;

/// An ellipsoid of any dimension: what [`Ellipsoid`](crate::Ellipsoid) holds, in vectors.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Shape {
    pub(crate) center: Vec<f64>,
    /// Row k is the direction of semi-axis k.
    pub(crate) axes: Vec<f64>,
    pub(crate) semi_axes: Vec<f64>,
    pub(crate) matrix: Vec<f64>,
    pub(crate) log_det: f64,
}

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
pub(crate) struct Solution {
    pub(crate) shape: Shape,
    pub(crate) log_det_gap: f64,
    pub(crate) weights: Vec<Weight>,
    pub(crate) contacts: Vec<usize>,
    pub(crate) status: Status,
    pub(crate) iterations: usize,
    pub(crate) scans: usize,
}

impl Solution {
    /// The ellipsoid around `count` points that all are `center`.
    pub(crate) fn point(center: Vec<f64>, count: usize, scans: usize) -> Self {
        Self {
            shape: Shape { center: center.clone(), ..shape_from_axes(center.len(), Vec::new(), Vec::new()) },
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
        frame: &Frame,
        set: &WorkingSet,
        moments: &Moments,
    ) -> Self {
        let r = rank.get() as f64;
        // |L⁻¹| ≤ |L⁻¹|_F; L is near the identity in the last frame.
        let mut inverse_norm: f64 = 0.0;
        for k in 0..rank.get() {
            let mut e = rank.zero();
            e.as_mut()[k] = 1.0;
            crate::linalg::solve_lower(rank, &moments.factor, e.as_mut());
            inverse_norm += dot(e.as_ref(), e.as_ref());
        }
        let rounding = 2.0 * r.sqrt() * inverse_norm.sqrt() * set.coordinate_error(points, frame)
            + 4.0 * (r + 2.0) * r * UNIT_ROUNDOFF;
        let weights = set
            .index
            .iter()
            .zip(&set.u)
            .filter(|(_, u)| **u > 0.0)
            .map(|(&index, &weight)| Weight { index, weight })
            .collect();
        Self { log_det_bound: -moments.log_det_scatter - r * r.ln() + rounding, weights }
    }
}

/// How far the points reach in an ellipsoid, with the rounding of the evaluation added.
struct Reach {
    /// Where the ellipsoid is the unit ball.
    frame: Frame,
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

/// Points whose rounding is bounded one by one.
const MANY: usize = 256;

/// Turns the unit ball of `frame` into the ellipsoid that contains every point as evaluated in `f64`, with its gap.
pub(crate) fn finish<P: Points>(
    points: &P,
    frame: &Frame,
    certificate: Certificate,
    epsilon: f64,
    ended: Status,
    iterations: usize,
    scans: usize,
) -> Result<Solution, EnclosingError> {
    let n = points.dim().get();
    let r = frame.rank();
    let mut shape = principal_axes(n, &frame.map);
    shape.center.clone_from(&frame.origin);
    // A point with weight lies within the gap of the surface.
    let tolerance = (certificate.log_det_bound + r as f64 * (r as f64).ln()).max(1e-9);
    let reach = reach(points, r, &shape, tolerance);
    let growth = touch(points, &mut shape, &reach);
    let shrink = (1.0 - 4.0 * UNIT_ROUNDOFF) / reach.matrix.max(growth * growth);
    shape.matrix.iter_mut().for_each(|x| *x *= shrink);
    shape.log_det = -2.0 * sum_of_logarithms(shape.semi_axes[..r].iter().copied());
    if !shape.log_det.is_finite() || shape.semi_axes.iter().any(|a| !a.is_finite()) {
        return Err(EnclosingError::OutOfRange);
    }
    // ln det X* − ln det X: the transformation into the frame cancels, and with it its size.
    let logarithms: f64 = shape.semi_axes[..r].iter().map(|a| a.ln().abs()).sum();
    let log_det_gap =
        (certificate.log_det_bound + 2.0 * r as f64 * growth.ln() + 4.0 * UNIT_ROUNDOFF * logarithms).max(0.0);
    let status = match ended {
        Status::IterationLimit if log_det_gap > epsilon => Status::IterationLimit,
        _ if log_det_gap <= epsilon => Status::Converged,
        _ => Status::Stalled,
    };
    let nearest = growth * (1.0 - log_det_gap.max(1e-9));
    let contacts = match &reach.candidates {
        Some(candidates) => candidates.iter().filter(|(_, q)| q.sqrt() >= nearest).map(|(i, _)| *i).collect(),
        None => beyond_radius(points, r, &reach.frame, nearest),
    };
    let scans = scans + reach.passes + usize::from(reach.candidates.is_none());
    Ok(Solution { shape, log_det_gap, weights: certificate.weights, contacts, status, iterations, scans })
}

/// Axes, semi-axes (longest first) and matrix of { v : |T·v| ≤ 1 }; r rows of n.
pub(crate) fn principal_axes(n: usize, map: &[f64]) -> Shape {
    let mut rows = map.to_vec();
    // A power of two keeps the squares in range and moves no bit.
    let largest = rows.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let unit = if largest > 0.0 { f64::from_bits((largest.to_bits() >> 52).clamp(1, 2045) << 52) } else { 1.0 };
    rows.iter_mut().for_each(|x| *x /= unit);
    triangularize(n, &mut rows);
    orthogonalize_rows(n, &mut rows);
    let mut semi_axes = Vec::with_capacity(n);
    for row in rows.chunks_exact_mut(n) {
        let sigma = dot(row, row).sqrt();
        semi_axes.push(1.0 / sigma / unit);
        row.iter_mut().for_each(|x| *x /= sigma);
    }
    shape_from_axes(n, semi_axes, rows)
}

/// The shape with these semi-axes along the rows of `axes`, longest first; fewer than `n` leave the others zero.
pub(crate) fn shape_from_axes(n: usize, mut semi_axes: Vec<f64>, mut axes: Vec<f64>) -> Shape {
    let r = semi_axes.len();
    // By insertion, which keeps the order of equals.
    for k in 1..r {
        let mut at = k;
        while at > 0 && semi_axes[at].total_cmp(&semi_axes[at - 1]).is_gt() {
            semi_axes.swap(at, at - 1);
            let (above, row) = axes[(at - 1) * n..(at + 1) * n].split_at_mut(n);
            above.swap_with_slice(row);
            at -= 1;
        }
    }
    let log_det = -2.0 * sum_of_logarithms(semi_axes.iter().copied());
    let mut matrix = vec![0.0; n * n];
    let mut scaled = vec![0.0; n];
    for (axis, a) in axes.chunks_exact(n).zip(&semi_axes) {
        scaled.iter_mut().zip(axis).for_each(|(s, x)| *s = x / a);
        for i in 0..n {
            for j in 0..n {
                matrix[i * n + j] += scaled[i] * scaled[j];
            }
        }
    }
    complete_rotation(n, r, &mut axes);
    semi_axes.resize(n, 0.0);
    Shape { center: vec![0.0; n], axes, semi_axes, matrix, log_det }
}

/// Adds to the first `r` orthonormal rows of length `n` those that are missing, and makes the determinant +1.
fn complete_rotation(n: usize, r: usize, axes: &mut Vec<f64>) {
    for k in r..n {
        let mut best = (vec![0.0; n], -1.0);
        for j in 0..n {
            let mut e = vec![0.0; n];
            e[j] = 1.0;
            for _ in 0..2 {
                for row in axes.chunks_exact(n).take(k) {
                    let along = dot(row, &e);
                    e.iter_mut().zip(row).for_each(|(x, y)| *x -= along * y);
                }
            }
            let length = dot(&e, &e).sqrt();
            if length > best.1 {
                best = (e, length);
            }
        }
        axes.extend(best.0.iter().map(|x| x / best.1));
    }
    if determinant_sign(n, axes) < 0.0 {
        axes[(n - 1) * n..].iter_mut().for_each(|x| *x = -*x);
    }
}

/// The sign of the determinant, by elimination with pivoting.
fn determinant_sign(n: usize, matrix: &[f64]) -> f64 {
    let mut a = matrix.to_vec();
    let mut sign = 1.0;
    for k in 0..n {
        let pivot = (k..n).fold(k, |best, i| if a[i * n + k].abs() > a[best * n + k].abs() { i } else { best });
        if pivot != k {
            sign = -sign;
            for j in 0..n {
                a.swap(k * n + j, pivot * n + j);
            }
        }
        sign *= a[k * n + k].signum();
        for i in k + 1..n {
            let factor = a[i * n + k] / a[k * n + k];
            for j in k..n {
                a[i * n + j] -= factor * a[k * n + j];
            }
        }
    }
    sign
}

/// One pass over the points.
///
/// The rounding of an evaluation, whatever the order of its sums, is bounded for each point that could be the furthest.
/// Where these are many (points on a sphere) the bound that holds for all serves instead.
fn reach<P: Points>(points: &P, r: usize, shape: &Shape, tolerance: f64) -> Reach {
    let dim = points.dim();
    let n = dim.get();
    let gamma = (n + 3) as f64 * UNIT_ROUNDOFF;
    let map = shape.axes[..r * n].chunks_exact(n).zip(&shape.semi_axes);
    let frame = Frame {
        origin: shape.center.clone(),
        map: map.flat_map(|(axis, a)| axis.iter().map(move |x| x / a)).collect(),
    };
    // Of e = x − c: |T·e| and eᵀXe, each with a bound on the rounding of its evaluation.
    let errors = |e: &[f64]| {
        let (mut square, mut error) = (0.0, 0.0);
        for row in frame.map.chunks_exact(n) {
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
        for i in 0..n {
            for j in 0..n {
                let term = shape.matrix[i * n + j] * e[i] * e[j];
                value += term;
                size += term.abs();
            }
        }
        (error.sqrt(), square.sqrt(), 2.0 * gamma * size, value)
    };
    // The half-extents of the ellipsoid along the coordinates bound |e| of every point in it. X itself is AᵀA only up to
    // rounding of the same size.
    let extent: Vec<f64> = (0..n)
        .map(|k| (0..r).map(|j| (shape.semi_axes[j] * shape.axes[j * n + k]).powi(2)).sum::<f64>().sqrt())
        .collect();
    let (error, _, error_matrix, _) = errors(&extent);
    let largest_error = 2.0 * error + 2.0 * error_matrix;
    let near = 1.0 - (2.0 * largest_error).max(4.0 * tolerance);

    // Candidates take as much room as the points themselves where all are on the surface: then rather look once more.
    let room = MANY.max(points.len() / 8);
    let mut furthest: f64 = 0.0;
    let mut candidates = None;
    // While the furthest is not known too many may seem near it; the second look knows it.
    let mut passes = 0;
    while passes < 2 {
        passes += 1;
        let collect = |range| {
            let mut furthest = furthest;
            let mut found = Some(Vec::new());
            in_rank(points, range, r, &frame, near * furthest, |i, q| {
                furthest = furthest.max(q);
                if let Some(list) = &mut found {
                    list.push((i, q));
                    if list.len() > room {
                        found = None;
                    }
                }
                if found.is_some() { near * furthest } else { furthest }
            });
            (furthest, found)
        };
        let parts = map_ranges(points.len(), collect);
        furthest = parts.iter().fold(furthest, |m: f64, part| m.max(part.0));
        let complete = parts.iter().all(|part| part.1.is_some());
        candidates = parts.into_iter().try_fold(Vec::new(), |mut all, (_, part): (f64, Option<Vec<(usize, f64)>>)| {
            all.extend(part?.into_iter().filter(|(_, q)| *q >= near * furthest));
            (all.len() <= room).then_some(all)
        });
        if complete {
            break;
        }
    }

    let least = furthest * (1.0 - 2.0 * largest_error);
    let leaders: Option<Vec<usize>> = candidates.as_ref().and_then(|candidates| {
        let mut leaders = candidates.iter().filter(|(_, q)| *q >= least).map(|(i, _)| *i);
        let found: Vec<usize> = leaders.by_ref().take(MANY).collect();
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
                e[k] -= frame.origin[k];
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
fn touch<P: Points>(points: &P, shape: &mut Shape, reach: &Reach) -> f64 {
    let mut v = points.dim().zero();
    let mut growth = 1.0;
    for attempt in 0..if reach.leaders.is_some() { 8 } else { 0 } {
        let mut furthest: f64 = 0.0;
        for &i in reach.leaders.iter().flatten() {
            points.read(i, v.as_mut());
            furthest = furthest.max(radius_at(&shape.center, &shape.axes, &shape.semi_axes, v.as_ref()));
        }
        if attempt > 0 && furthest <= 1.0 {
            return growth;
        }
        shape.semi_axes.iter_mut().for_each(|a| *a *= furthest);
        growth *= furthest;
    }
    let rest = reach.axes / growth * (1.0 + 6.0 * UNIT_ROUNDOFF);
    shape.semi_axes.iter_mut().for_each(|a| *a *= rest);
    growth * rest
}

/// The points at least `radius` from the origin of the frame.
fn beyond_radius<P: Points>(points: &P, r: usize, frame: &Frame, radius: f64) -> Vec<usize> {
    let parts = map_ranges(points.len(), |range| {
        let mut found = Vec::new();
        in_rank(points, range, r, frame, 0.0, |i, q| {
            if q.sqrt() >= radius {
                found.push(i);
            }
            0.999_999 * radius * radius
        });
        found
    });
    parts.concat()
}

/// [`beyond`], with the rank as constant as the dimension where they are equal.
fn in_rank<P: Points>(
    points: &P,
    range: Range<usize>,
    r: usize,
    frame: &Frame,
    cutoff: f64,
    visit: impl FnMut(usize, f64) -> f64,
) {
    if r == points.dim().get() {
        beyond(points, range, points.dim(), frame, cutoff, visit);
    } else {
        beyond(points, range, Dynamic(r), frame, cutoff, visit);
    }
}

/// ln of the volume of the unit ball in n dimensions: V₀ = 1, V₁ = 2, Vₙ = Vₙ₋₂·2π/n.
pub(crate) fn log_unit_ball_volume(n: usize) -> f64 {
    let mut volume = if n.is_multiple_of(2) { 1.0f64 } else { 2.0 }.ln();
    let mut k = if n.is_multiple_of(2) { 2 } else { 3 };
    while k <= n {
        volume += (std::f64::consts::TAU / k as f64).ln();
        k += 2;
    }
    volume
}
