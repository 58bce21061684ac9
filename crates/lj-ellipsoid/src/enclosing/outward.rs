//! Outward rounding: the largest radius of the points in an ellipsoid, and the growth that is proved to contain every
//! point, and does as evaluated in `f64`.

use std::ops::Range;

use crate::ellipsoid::{radius_at, radius_at_most};
use crate::enclosing::frame::Frame;
use crate::enclosing::scan::beyond;
use crate::numerics::dimension::Dimension;
use crate::numerics::linalg::UNIT_ROUNDOFF;
use crate::points::Points;
use crate::points::parallel::in_parts;
use crate::shape::Shape;

/// The largest radius of the points in an ellipsoid, with the rounding of the evaluation added.
pub(crate) struct Reach<N: Dimension> {
    /// The frame in which the ellipsoid is the unit ball.
    pub(crate) frame: Frame<N>,
    /// At least max |diag(1/a)·R·(x − c)|, in whatever order it is evaluated.
    pub(crate) axes: f64,
    /// At least the exact max |diag(1/a)·R·(x − c)| of the doubles.
    proved: f64,
    /// max (x − c)ᵀX(x − c).
    pub(crate) matrix: f64,
    /// The points that may be contacts, with |diag(1/a)·R·(x − c)|²; `None` if they are a large part of all.
    pub(crate) candidates: Option<Vec<(usize, f64)>>,
    /// The points that may be the farthest, unless they are many.
    leaders: Option<Vec<usize>>,
    /// Passes over the points.
    pub(crate) passes: usize,
}

/// The result of a pass over a part of the points.
struct Found {
    /// max |diag(1/a)·R·(x − c)|².
    furthest: f64,
    /// The points near the farthest, unless they are too many.
    list: Option<Vec<(usize, f64)>>,
    /// Whether no part had too many.
    complete: bool,
}

impl Found {
    /// The results of both parts together, at most `room` points within `near` of the farthest.
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

/// The most points whose rounding is bounded one by one.
const MANY: usize = 256;

/// Errors of a radius up to this are negligible rounding.
const SMALL: f64 = 1e-14;

/// The number of candidates that mostly suffices.
pub(crate) const SOME: usize = 16;

/// The rounding of both evaluations of an ellipsoid that is the unit ball of a frame, whatever the order of their sums.
struct Evaluation<'a, N: Dimension> {
    frame: &'a Frame<N>,
    matrix: &'a [f64],
    n: usize,
}

impl<N: Dimension> Evaluation<'_, N> {
    /// |T·e|, and a bound on the rounding of its evaluation: n + 2 roundings for a component (T and e are themselves
    /// rounded), and as many again for the length.
    fn radius(&self, e: &[f64]) -> (f64, f64) {
        let gamma = (2 * self.n + 5) as f64 * UNIT_ROUNDOFF;
        let (mut square, mut error) = (0.0, 0.0);
        for row in self.frame.map().chunks_exact(self.n) {
            let (mut along, mut size) = (0.0, 0.0);
            for k in 0..self.n {
                let term = row[k] * e[k];
                along += term;
                size += term.abs();
            }
            square += along * along;
            error += (gamma * size) * (gamma * size);
        }
        (square.sqrt(), error.sqrt())
    }

    /// eᵀXe, and a bound on the rounding of its evaluation: n² terms, two roundings of the products, two of the factors
    /// e and one of X when it is scaled.
    fn level(&self, e: &[f64]) -> (f64, f64) {
        let (mut value, mut size) = (0.0, 0.0);
        for i in 0..self.n {
            for j in 0..self.n {
                let term = self.matrix[i * self.n + j] * e[i] * e[j];
                value += term;
                size += term.abs();
            }
        }
        (value, (self.n * self.n + 5) as f64 * UNIT_ROUNDOFF * size)
    }
}

/// One pass over the points, or two.
///
/// The rounding of an evaluation, whatever the order of its sums, is bounded for each point that could be the farthest.
/// If there are many of them (points on a sphere), the bound for all points is taken instead.
pub(crate) fn reach<P: Points>(points: &P, rank: P::Dim, shape: &Shape<P::Dim>, tolerance: f64) -> Reach<P::Dim> {
    let dim = points.dim();
    let (n, r) = (dim.get(), rank.get());
    let (axes, semi_axes) = (&shape.axes.as_ref()[..n * n], &shape.semi_axes.as_ref()[..n]);
    let mut map = dim.zero_matrix();
    for ((to, axis), a) in map.as_mut().chunks_exact_mut(n).zip(axes.chunks_exact(n)).zip(&semi_axes[..r]) {
        to.iter_mut().zip(axis).for_each(|(to, x)| *to = x / a);
    }
    let frame = Frame::new(shape.center.clone(), map, r);
    let evaluation = Evaluation { frame: &frame, matrix: &shape.matrix.as_ref()[..n * n], n };
    // The half-extents of the ellipsoid along the coordinates bound |x − c| of every point in it.
    let extent =
        dim.point((0..n).map(|k| (0..r).map(|j| semi_axes[j] * axes[j * n + k]).map(|x| x * x).sum::<f64>().sqrt()));
    let (error, error_matrix) = (evaluation.radius(extent.as_ref()).1, evaluation.level(extent.as_ref()).1);
    let largest_error = 2.0 * error + 2.0 * error_matrix;
    let near = 1.0 - (2.0 * largest_error).max(4.0 * tolerance);
    let (furthest, candidates, passes) = furthest(points, rank, &frame, near);

    let least = furthest * (1.0 - 2.0 * largest_error);
    let leaders: Option<Vec<usize>> = candidates.as_ref().and_then(|candidates| {
        let mut leaders = candidates.iter().filter(|(_, q)| *q >= least).map(|(i, _)| *i);
        let mut found = Vec::with_capacity(candidates.len().min(SOME));
        found.extend(leaders.by_ref().take(MANY));
        leaders.next().is_none().then_some(found)
    });
    let (mut axes, mut matrix) = (furthest.sqrt() * (1.0 + error), furthest * (1.0 + largest_error));
    let mut proved = axes;
    if let Some(leaders) = &leaders {
        let mut v = dim.zero();
        (axes, matrix, proved) = (0.0, 0.0, 0.0);
        for &i in leaders {
            points.read(i, v.as_mut());
            // If terms of the sums do not cancel, a bound on their rounding is as good as sums in twice the precision.
            let (center, axes_of, semi_axes) = (frame.origin.as_ref(), shape.axes.as_ref(), shape.semi_axes.as_ref());
            if error > SMALL {
                proved = proved.max(radius_at_most(center, axes_of, semi_axes, v.as_ref()));
            }
            let e = &mut v.as_mut()[..n];
            for k in 0..n {
                e[k] -= frame.origin.as_ref()[k];
            }
            let ((radius, error), (level, error_matrix)) = (evaluation.radius(e), evaluation.level(e));
            axes = axes.max(radius + error);
            matrix = matrix.max(level + error_matrix);
        }
        if !(error > SMALL) {
            proved = axes;
        }
    }
    Reach { frame, axes, proved, matrix, candidates, leaders, passes }
}

/// max |T·(v − o)|² over the points, those within the share `near` of it unless they are a large part of all, and the
/// number of passes.
fn furthest<P: Points>(
    points: &P,
    rank: P::Dim,
    frame: &Frame<P::Dim>,
    near: f64,
) -> (f64, Option<Vec<(usize, f64)>>, usize) {
    // If all points are on the surface, the candidates fill as much memory: another pass is better.
    let room = MANY.max(points.len() / 8);
    let mut furthest: f64 = 0.0;
    // While the farthest is unknown, too many may seem near it; the second pass knows it.
    let mut passes = 0;
    loop {
        passes += 1;
        let collect = |range: Range<usize>| {
            let mut furthest = furthest;
            let mut list = Some(Vec::with_capacity(range.len().min(SOME)));
            beyond(points, range, rank, frame, near * furthest, |i, q| {
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
            return (furthest, found.list, passes);
        }
    }
}

/// Scales the semi-axes so that the farthest point touches, and returns the factor: the least that is proved to contain
/// every point, and contains it as evaluated by [`radius_at`].
///
/// In a thin ellipsoid that evaluation may exceed the exact value: then it is scaled again. If points are many, or
/// rounding does not settle, the scaling contains them in any order of evaluation.
pub(crate) fn touch<P: Points>(points: &P, shape: &mut Shape<P::Dim>, reach: &Reach<P::Dim>) -> f64 {
    let mut v = points.dim().zero();
    // The products with the scale are rounded, in it or in the semi-axes.
    let mut growth = 1.0;
    let mut scale = reach.proved * (1.0 + 4.0 * UNIT_ROUNDOFF);
    for _ in 0..8 {
        shape.semi_axes.as_mut().iter_mut().for_each(|a| *a *= scale);
        growth *= scale;
        let (center, axes, semi_axes) = (shape.center.as_ref(), shape.axes.as_ref(), shape.semi_axes.as_ref());
        let mut furthest: f64 = 0.0;
        for &i in reach.leaders.iter().flatten() {
            points.read(i, v.as_mut());
            furthest = furthest.max(radius_at(center, axes, semi_axes, v.as_ref()));
        }
        if furthest <= 1.0 {
            return growth;
        }
        scale = furthest * (1.0 + 2.0 * UNIT_ROUNDOFF);
    }
    let rest = (reach.axes / growth * (1.0 + 6.0 * UNIT_ROUNDOFF)).max(1.0);
    shape.semi_axes.as_mut().iter_mut().for_each(|a| *a *= rest);
    growth * rest
}

/// The points at least `radius` from the origin of the frame.
pub(crate) fn beyond_radius<P: Points>(points: &P, rank: P::Dim, frame: &Frame<P::Dim>, radius: f64) -> Vec<usize> {
    let look = |range| {
        let mut found = Vec::new();
        beyond(points, range, rank, frame, 0.0, |i, q| {
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
