//! The maximum-volume ellipsoid inside the convex hull of points.
//!
//! The points are first brought to where their enclosing ellipsoid is the unit ball: there the hull lies between the balls
//! of radius 1/N and 1 (John), so facets and slacks are of unit size whatever the condition of the points.

use crate::dimension::Dimension;
use crate::error::{EnclosingError, InscribedError};
use crate::hull::{Facets, hull2, hull3};
use crate::inscribed::{Inscribed, InscribedIterate, InscribedSolution, solve};
use crate::interior::{Coordinates, Polyhedron};
use crate::linalg::{UNIT_ROUNDOFF, dot};
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
    observer: impl FnMut(InscribedIterate),
) -> Result<Inscribed<N>, InscribedError> {
    solve_points(&PointSlice(points), options, observer).map(Inscribed::from_solution)
}

/// The dimension-free body of [`inscribed_in_hull`](inscribed_in_hull()).
pub(crate) fn solve_points<P: Points>(
    points: &P,
    options: InscribedOptions,
    observer: impl FnMut(InscribedIterate),
) -> Result<InscribedSolution<P::Dim>, InscribedError> {
    let dim = points.dim();
    let n = dim.get();
    let outer =
        crate::enclosing::solve(points, EnclosingOptions::new().with_epsilon(1e-2), |_| {}).map_err(|e| match e {
            EnclosingError::NonFinite { index, coordinate, value } => {
                InscribedError::NonFinite { index, coordinate, value }
            }
            EnclosingError::Flat { rank, dimension } => InscribedError::Flat { rank, dimension },
            EnclosingError::Empty => InscribedError::Empty,
            EnclosingError::OutOfRange => InscribedError::OutOfRange,
        })?;
    if !(2..=3).contains(&n) {
        return Err(InscribedError::HullDimension { dimension: n });
    }
    let shape = outer.shape;
    // y = diag(1/a)·R·(v − c), and back x = c + Rᵀ·diag(a)·y.
    let mut v = dim.zero();
    let mut images = Vec::with_capacity(points.len() * n);
    let mut coordinate_error: f64 = 0.0;
    for i in 0..points.len() {
        points.read(i, v.as_mut());
        v.as_mut().iter_mut().zip(shape.center.as_ref()).for_each(|(v, c)| *v -= c);
        for (axis, a) in shape.axes.as_ref().chunks_exact(n).zip(shape.semi_axes.as_ref()) {
            images.push(dot(axis, v.as_ref()) / a);
            let size: f64 = axis.iter().zip(v.as_ref()).map(|(x, y)| (x * y).abs()).sum();
            coordinate_error = coordinate_error.max((n + 3) as f64 * UNIT_ROUNDOFF * size / a);
        }
    }
    let facets = if n == 2 {
        hull2(images.as_chunks::<2>().0)
    } else {
        let tolerance = (COPLANAR * UNIT_ROUNDOFF).max(4.0 * coordinate_error);
        hull3(images.as_chunks::<3>().0, tolerance).ok_or(InscribedError::Flat { rank: 2, dimension: 3 })?
    };
    let (polyhedron, coordinates) = in_space(dim, &facets, &shape);
    solve(dim, &polyhedron, coordinates, 4.0 * n as f64 * coordinate_error, options, observer)
}

/// The facets as half-spaces of the original space, and the coordinates in which they were found.
fn in_space<N: Dimension>(dim: N, facets: &Facets, shape: &Shape<N>) -> (Polyhedron, Coordinates) {
    let n = dim.get();
    let (center, axes, semi_axes) = (shape.center.as_ref(), shape.axes.as_ref(), shape.semi_axes.as_ref());
    let mut polyhedron = Polyhedron {
        n,
        normals: Vec::with_capacity(facets.normals.len()),
        offsets: Vec::with_capacity(facets.offsets.len()),
        origin: center.to_vec(),
    };
    for (normal, offset) in facets.normals.chunks_exact(n).zip(&facets.offsets) {
        let a = dim.point((0..n).map(|i| (0..n).map(|k| normal[k] / semi_axes[k] * axes[k * n + i]).sum()));
        let length = a.as_ref().iter().fold(0.0, |l: f64, x| l.hypot(*x));
        polyhedron.normals.extend(a.as_ref().iter().map(|x| x / length));
        polyhedron.offsets.push(offset / length);
    }
    let map = (0..n * n).map(|at| axes[(at % n) * n + at / n] * semi_axes[at % n]).collect();
    (polyhedron, Coordinates { origin: center.to_vec(), map })
}
