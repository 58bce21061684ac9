//! The maximum-volume ellipsoid inside the convex hull of points.
//!
//! The points are first mapped so that their enclosing ellipsoid is the unit ball: then the hull lies between the balls
//! of radius 1/N and 1 (John), so that facets and slacks are of unit size whatever the condition of the points.

use crate::enclosing;
use crate::error::{EnclosingError, InscribedError};
use crate::inscribed::body::Body;
use crate::inscribed::coordinates::{Coordinates, Rows};
use crate::inscribed::hull::{Facets, hull2, hull3};
use crate::inscribed::observer::{InscribedIterate, Observer};
use crate::inscribed::{Inscribed, InscribedSolution, solution};
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
/// The indices of the answer's `weights` count facets of the hull, in no particular order.
///
/// # Errors
/// [`InscribedError::Flat`] if the hull has no interior, [`InscribedError::HullDimension`] unless N is 2 or 3,
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

/// [`inscribed_in_hull`](inscribed_in_hull()) with an `observer` that sees every iterate.
///
/// # Errors
/// Those of [`inscribed_in_hull`](inscribed_in_hull()).
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
    let (images, error_of_image) = images(points, &shape);
    let tolerance = (COPLANAR * UNIT_ROUNDOFF).max(4.0 * error_of_image);
    let Facets { normals, offsets, depths } = if n == 2 {
        hull2(images.as_chunks::<2>().0)
    } else {
        hull3(images.as_chunks::<3>().0, tolerance).ok_or(InscribedError::Flat { rank: 2, dimension: 3 })?
    };
    // The planes are exactly their doubles; how far the hull extends beyond them is added by weight.
    let error = vec![0.0; offsets.len()];
    let rows = Rows { n, p: normals, s: offsets, error };
    // The rounding of coordinates of images, and along a unit normal, where they are at most √n in size.
    let root = (n as f64).sqrt();
    let rounding = root * error_of_image + (n + 2) as f64 * UNIT_ROUNDOFF * root;
    let hull = Hull { coordinates: coordinates.clone(), rows: &rows, depths, images: &images, rounding, tolerance };
    solution::solve(dim, coordinates, &rows, &hull, options, observer)
}

/// If points have no enclosing ellipsoid, their hull has no inscribed one, for the same reason.
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
/// If the terms of a coordinate cancel, as along the short axis of a thin body, they are summed in twice the precision.
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
            if size > TERMS_CANCEL * a {
                let to = axis.iter().copied().zip(v.iter().copied());
                along = twofold::dot(to.chain(axis.iter().zip(center).map(|(x, c)| (*x, -c))));
            }
            images.push(along / a);
        }
    }
    (images, (n + 3) as f64 * UNIT_ROUNDOFF * TERMS_CANCEL)
}

/// Terms larger than this, in a coordinate of an image of at most one, cancel.
const TERMS_CANCEL: f64 = 4.0;

/// The hull of points, in the coordinates of their images.
struct Hull<'a> {
    coordinates: Coordinates,
    rows: &'a Rows,
    /// A lower bound of the distances of each facet's corners.
    depths: Vec<f64>,
    images: &'a [f64],
    /// A bound on the rounding of p·y for an image.
    rounding: f64,
    /// The distance from the hull within which points count as in it.
    tolerance: f64,
}

/// Multipliers below this do not pay for a pass over all points: their terms are as small as the tolerance of the hull.
const WEIGHTY: f64 = 1e-8;

impl<D: Dimension> Body<D> for Hull<'_> {
    /// The largest scale that is proved to keep the ellipsoid below the corners of every facet. The facets of these
    /// corners are a closed surface of points of the hull around the centre of the ellipsoid, so that the ellipsoid
    /// stays in the hull.
    fn touch(&self, shape: &mut Shape<D>) -> Option<()> {
        let n = self.rows.n;
        let (d, e) = self.coordinates.seen(shape.center.as_ref(), shape.axes.as_ref(), shape.semi_axes.as_ref());
        let unit = (n + 8) as f64 * UNIT_ROUNDOFF;
        // Σxᵢ of products with a unit vector, and a bound on its rounding.
        let along = |p: &[f64], x: &[(f64, f64)]| {
            let terms = p.iter().zip(x).map(|(p, (x, error))| (p * x, p.abs() * (unit * x.abs() + error)));
            terms.fold((0.0, 0.0), |(sum, error), (x, e)| (sum + x, error + e))
        };
        let mut scale = f64::INFINITY;
        for ((p, _), depth) in self.rows.iter().zip(&self.depths) {
            let (center, error) = along(p, &d);
            let room = depth - center - (error + self.rounding + unit * depth.abs());
            let components = e.chunks_exact(n).map(|e| along(p, e)).map(|(x, error)| x.abs() + error);
            scale = scale.min(room / components.map(|x| x * x).sum::<f64>().sqrt());
        }
        scale *= 1.0 - 2.0 * unit;
        shape.semi_axes.as_mut().iter_mut().for_each(|a| *a *= scale);
        (scale > 0.0 && scale.is_finite()).then_some(())
    }

    /// By a pass over all points.
    fn beyond(&self, i: usize, weight: f64) -> f64 {
        let n = self.rows.n;
        let (p, s) = (&self.rows.p[i * n..(i + 1) * n], self.rows.s[i]);
        let furthest = if weight < WEIGHTY {
            s + 64.0 * self.tolerance
        } else {
            self.images.chunks_exact(n).map(|y| dot(p, y)).fold(s, f64::max)
        };
        (furthest - s + self.rounding) / s
    }
}
