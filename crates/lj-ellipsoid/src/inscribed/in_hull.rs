//! The maximum-volume ellipsoid inside the convex hull of points.
//!
//! The points are first brought to where their enclosing ellipsoid is the unit ball: there the hull lies between the balls
//! of radius 1/N and 1 (John), so facets and slacks are of unit size whatever the condition of the points.

use crate::enclosing;
use crate::error::{EnclosingError, InscribedError};
use crate::inscribed::coordinates::{Coordinates, Rows};
use crate::inscribed::hull::{hull2, hull3};
use crate::inscribed::{Inscribed, InscribedIterate, InscribedSolution, Observer, solution};
use crate::numerics::dimension::Dimension;
use crate::numerics::linalg::{UNIT_ROUNDOFF, dot};
use crate::numerics::twofold;
use crate::options::{EnclosingOptions, InscribedOptions};
use crate::points::{PointSlice, Points};
use crate::shape::Shape;

/// Heights over a plane below this many roundings of the coordinates are coplanar.
const COPLANAR: f64 = 512.0;

/// The ellipsoid of greatest volume inside the convex hull of `points`, in two or three dimensions.
///
/// The answer's `weights` count facets of the hull, in no particular order.
///
/// # Errors
/// [`InscribedError::Flat`] where the hull has no interior, [`InscribedError::HullDimension`] unless N is 2 or 3,
/// [`InscribedError::NonFinite`] and [`InscribedError::Empty`] for bad input.
///
/// # Examples
/// ```
/// use lj_ellipsoid::{InscribedOptions, inscribed_in_hull};
///
/// let triangle = [[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]];
/// let answer = inscribed_in_hull(&triangle, InscribedOptions::default())?;
/// // Steiner's inellipse touches the sides at their middles and has π/(3√3) of the area.
/// let share = std::f64::consts::PI / 27f64.sqrt();
/// assert!((answer.ellipsoid.log_volume() - share.ln()).abs() < 1e-8);
/// # Ok::<(), lj_ellipsoid::InscribedError>(())
/// ```
pub fn inscribed_in_hull<P: Into<[f64; N]> + Copy + Sync, const N: usize>(
    points: &[P],
    options: InscribedOptions,
) -> Result<Inscribed<N>, InscribedError> {
    inscribed_in_hull_with(points, options, |_| {})
}

/// [`inscribed_in_hull`](inscribed_in_hull()), showing every iterate to `observer`.
///
/// # Errors
/// As [`inscribed_in_hull`](inscribed_in_hull()).
pub fn inscribed_in_hull_with<P: Into<[f64; N]> + Copy + Sync, const N: usize>(
    points: &[P],
    options: InscribedOptions,
    mut observer: impl FnMut(InscribedIterate),
) -> Result<Inscribed<N>, InscribedError> {
    solve_points(&PointSlice(points), options, &mut observer).map(Inscribed::from_solution)
}

/// The dimension-free body of [`inscribed_in_hull`](inscribed_in_hull()).
pub(crate) fn solve_points<P: Points>(
    points: &P,
    options: InscribedOptions,
    observer: &mut Observer<'_>,
) -> Result<InscribedSolution<P::Dim>, InscribedError> {
    options.check()?;
    let dim = points.dim();
    let n = dim.get();
    if points.len() > 0 && n > 0 && !(2..=3).contains(&n) {
        return Err(InscribedError::HullDimension { dimension: n });
    }
    let shape =
        enclosing::solve(points, EnclosingOptions::new().with_epsilon(1e-2), &mut |_| {}).map_err(around_points)?.shape;
    let coordinates = Coordinates {
        origin: shape.center.as_ref().to_vec(),
        axes: shape.axes.as_ref().to_vec(),
        lengths: shape.semi_axes.as_ref().to_vec(),
    };
    let (images, error) = images(points, &shape);
    let facets = if n == 2 {
        hull2(images.as_chunks::<2>().0)
    } else {
        let tolerance = (COPLANAR * UNIT_ROUNDOFF).max(4.0 * error);
        hull3(images.as_chunks::<3>().0, tolerance).ok_or(InscribedError::Flat { rank: 2, dimension: 3 })?
    };
    let error = vec![4.0 * n as f64 * error; facets.offsets.len()];
    let rows = Rows { n, p: facets.normals, s: facets.offsets, error };
    let frame = coordinates.clone();
    let mut within = |shape: &mut Shape<P::Dim>| touch(&frame, &rows, shape);
    solution::solve(dim, coordinates, &rows, &mut within, options, observer)
}

/// What keeps points from having an enclosing ellipsoid keeps their hull from having an inscribed one.
const fn around_points(why: EnclosingError) -> InscribedError {
    match why {
        EnclosingError::Empty => InscribedError::Empty,
        EnclosingError::NonFinite { index, coordinate, value } => {
            InscribedError::NonFinite { index, coordinate, value }
        }
        EnclosingError::Flat { rank, dimension } => InscribedError::Flat { rank, dimension },
        EnclosingError::InvalidEpsilon { value } | EnclosingError::InvalidFlatTolerance { value } => {
            InscribedError::InvalidEpsilon { value }
        }
        EnclosingError::OutOfRange => InscribedError::OutOfRange,
    }
}

/// y = diag(1/a)·R·(v − c) for all points, and a bound on the error of its coordinates.
///
/// Where the terms of a coordinate cancel, as they do along the short axis of a thin body, they are summed in twice the
/// precision.
fn images<P: Points>(points: &P, shape: &Shape<P::Dim>) -> (Vec<f64>, f64) {
    let n = points.dim().get();
    let center = &shape.center.as_ref()[..n];
    let mut v = points.dim().zero();
    let mut images = Vec::with_capacity(points.len() * n);
    for i in 0..points.len() {
        points.read(i, v.as_mut());
        let v = &v.as_ref()[..n];
        for (axis, a) in shape.axes.as_ref().chunks_exact(n).zip(shape.semi_axes.as_ref()) {
            let (mut along, mut size) = (0.0, 0.0);
            for k in 0..n {
                let term = axis[k] * (v[k] - center[k]);
                along += term;
                size += term.abs();
            }
            if size > CANCELLING * a {
                let to = axis.iter().copied().zip(v.iter().copied());
                along = twofold::dot(to.chain(axis.iter().zip(center).map(|(x, c)| (*x, -c))));
            }
            images.push(along / a);
        }
    }
    (images, (n + 3) as f64 * UNIT_ROUNDOFF * CANCELLING)
}

/// Terms larger than this, of an image of at most one, cancel.
const CANCELLING: f64 = 4.0;

/// Scales the semi-axes so that the ellipsoid as it stands, its axes rounded, touches the first facet. `None` where that leaves
/// nothing.
fn touch<N: Dimension>(coordinates: &Coordinates, facets: &Rows, shape: &mut Shape<N>) -> Option<()> {
    let n = facets.n;
    let (d, e) = coordinates.seen(shape.center.as_ref(), shape.axes.as_ref(), shape.semi_axes.as_ref());
    let reach = |p: &[f64]| e.chunks_exact(n).map(|e| dot(e, p).powi(2)).sum::<f64>().sqrt();
    let room = facets.iter().map(|(p, s)| (s - dot(p, &d)) / reach(p)).fold(f64::INFINITY, f64::min);
    let scale = room * (1.0 - 4.0 * n as f64 * UNIT_ROUNDOFF);
    shape.semi_axes.as_mut().iter_mut().for_each(|a| *a *= scale);
    (scale > 0.0 && scale.is_finite()).then_some(())
}
