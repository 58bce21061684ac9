//! Points whose dimension is known only at run time.

use crate::ellipsoid::{Ellipsoid, radius_at, support_value};
use crate::enclosing::{EnclosingIterate, Solution};
use crate::error::{EnclosingError, InscribedError};
use crate::inscribed::InscribedSolution;
use crate::numerics::dimension::{Const, Dynamic};
use crate::options::{EnclosingOptions, InscribedOptions, Status};
use crate::points::Copied;
use crate::shape::Shape;
use crate::weight::Weight;

/// An ellipsoid in a dimension known at run time; see [`Ellipsoid`](crate::Ellipsoid).
#[derive(Clone, Debug, PartialEq)]
pub struct EllipsoidDyn {
    shape: Shape<Dynamic>,
}

impl EllipsoidDyn {
    pub(crate) fn from_shape(shape: Shape<Dynamic>) -> Self {
        Self { shape }
    }

    /// The number of coordinates.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.shape.center.len()
    }

    /// The centre c.
    #[must_use]
    pub fn center(&self) -> &[f64] {
        &self.shape.center
    }

    /// The orthonormal directions of the semi-axes, row by row: row k is that of `semi_axes()[k]`; the determinant
    /// is +1.
    #[must_use]
    pub fn axes(&self) -> &[f64] {
        &self.shape.axes
    }

    /// The lengths of the semi-axes, longest first.
    #[must_use]
    pub fn semi_axes(&self) -> &[f64] {
        &self.shape.semi_axes
    }

    /// X, row by row; see [`Ellipsoid::matrix`](crate::Ellipsoid::matrix).
    #[must_use]
    pub fn matrix(&self) -> &[f64] {
        &self.shape.matrix
    }

    /// The ellipsoid in `N` dimensions, if it has as many.
    #[must_use]
    pub fn in_dimension<const N: usize>(&self) -> Option<Ellipsoid<N>> {
        (self.dimension() == N).then(|| Ellipsoid::from_shape(&self.shape.clone().in_dimension(Const::<N>)))
    }

    /// The logarithm of the determinant of X; see [`Ellipsoid::log_det`](crate::Ellipsoid::log_det).
    #[must_use]
    pub fn log_det(&self) -> f64 {
        self.shape.log_det
    }

    /// 1 on the surface, less inside; see [`Ellipsoid::radius_at`](crate::Ellipsoid::radius_at).
    ///
    /// # Panics
    /// If `x` has not as many coordinates as the ellipsoid.
    #[must_use]
    pub fn radius_at(&self, x: &[f64]) -> f64 {
        let n = self.dimension();
        assert_eq!(x.len(), n, "the point has {} coordinates, the ellipsoid {n}", x.len());
        radius_at(&self.shape.center, &self.shape.axes, &self.shape.semi_axes, x)
    }

    /// Whether `x` lies in the ellipsoid, boundary included, as evaluated in `f64` by [`radius_at`](Self::radius_at).
    ///
    /// # Panics
    /// If `x` has not as many coordinates as the ellipsoid.
    #[must_use]
    pub fn contains(&self, x: &[f64]) -> bool {
        self.radius_at(x) <= 1.0
    }

    /// The largest direction·x over the ellipsoid; see [`Ellipsoid::support_value`](crate::Ellipsoid::support_value).
    ///
    /// # Panics
    /// If `direction` has not as many coordinates as the ellipsoid.
    #[must_use]
    pub fn support_value(&self, direction: &[f64]) -> f64 {
        let n = self.dimension();
        assert_eq!(direction.len(), n, "the direction has {} coordinates, the ellipsoid {n}", direction.len());
        support_value(&self.shape.center, &self.shape.axes, &self.shape.semi_axes, direction)
    }

    /// The logarithm of the volume; see [`Ellipsoid::log_volume`](crate::Ellipsoid::log_volume).
    #[must_use]
    pub fn log_volume(&self) -> f64 {
        let rank = self.shape.semi_axes.iter().filter(|a| **a > 0.0).count();
        crate::shape::log_unit_ball_volume(rank) - 0.5 * self.shape.log_det
    }
}

/// [`Enclosing`](crate::Enclosing) in a dimension known at run time; the fields mean the same.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EnclosingDyn {
    /// The ellipsoid. It is proved to contain every input point, and does as evaluated in `f64`.
    pub ellipsoid: EllipsoidDyn,
    /// A certified bound on ln det X* − ln det X, rounding included; never negative.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::gap"))]
    pub log_det_gap: f64,
    /// The weights that prove the gap.
    pub weights: Vec<Weight>,
    /// The points on the surface, up to the gap, by ascending index.
    pub contacts: Vec<usize>,
    /// How the computation ended.
    pub status: Status,
    /// Iterations of the method.
    pub iterations: usize,
    /// Passes over all points.
    pub scans: usize,
}

/// The number of coordinates, which must be the same for all points.
fn dimension<P: AsRef<[f64]>>(points: &[P]) -> usize {
    let n = points.first().map_or(0, |p| p.as_ref().len());
    assert!(points.iter().all(|p| p.as_ref().len() == n), "all points must have as many coordinates as the first, {n}");
    n
}

/// Slices of one length as points.
fn copied<P: AsRef<[f64]>>(points: &[P]) -> Copied<Dynamic> {
    let coordinates = points.iter().flat_map(AsRef::as_ref).copied().collect();
    Copied::from_coordinates(Dynamic(dimension(points)), points.len(), coordinates)
}

/// [`enclosing`](crate::enclosing()) for points of a dimension known at run time: slices of one length.
///
/// # Errors
/// Those of [`enclosing`](crate::enclosing()).
///
/// # Panics
/// If the points differ in length.
///
/// # Examples
/// ```
/// use lj_ellipsoid::{EnclosingOptions, enclosing_dyn};
///
/// // The eight points ±eₖ in four dimensions: the unit ball.
/// let coordinate = |i: usize, k: usize| if i % 4 != k { 0.0 } else if i < 4 { 1.0 } else { -1.0 };
/// let point = |i: usize| (0..4).map(|k| coordinate(i, k)).collect();
/// let cross: Vec<Vec<f64>> = (0..8).map(point).collect();
/// let answer = enclosing_dyn(&cross, EnclosingOptions::default())?;
/// assert!(answer.ellipsoid.log_det().abs() < 1e-13);
/// # Ok::<(), lj_ellipsoid::EnclosingError>(())
/// ```
pub fn enclosing_dyn<P: AsRef<[f64]>>(points: &[P], options: EnclosingOptions) -> Result<EnclosingDyn, EnclosingError> {
    enclosing_dyn_with(points, options, |_| {})
}

/// [`enclosing_dyn`] with an `observer` that sees every iterate.
///
/// # Errors
/// Those of [`enclosing`](crate::enclosing()).
///
/// # Panics
/// If the points differ in length.
pub fn enclosing_dyn_with<P: AsRef<[f64]>>(
    points: &[P],
    options: EnclosingOptions,
    mut observer: impl FnMut(EnclosingIterate<'_>),
) -> Result<EnclosingDyn, EnclosingError> {
    let Solution { shape, log_det_gap, weights, contacts, status, iterations, scans } =
        crate::enclosing::solve(&copied(points), options, &mut observer)?;
    let ellipsoid = EllipsoidDyn::from_shape(shape);
    Ok(EnclosingDyn { ellipsoid, log_det_gap, weights, contacts, status, iterations, scans })
}

/// [`Inscribed`](crate::Inscribed) in a dimension known at run time; the fields mean the same.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct InscribedDyn {
    /// The ellipsoid; it lies in every half-space, the rounding of the evaluation taken into account.
    pub ellipsoid: EllipsoidDyn,
    /// A certified bound on ln det X − ln det X*; never negative.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::gap"))]
    pub log_det_gap: f64,
    /// The multipliers that prove the gap, with their half-spaces, scaled to sum to one.
    pub weights: Vec<Weight>,
    /// How the computation ended.
    pub status: Status,
    /// Newton steps.
    pub iterations: usize,
}

impl InscribedDyn {
    fn from_solution(solution: InscribedSolution<Dynamic>) -> Self {
        let InscribedSolution { shape, log_det_gap, weights, status, iterations } = solution;
        Self { ellipsoid: EllipsoidDyn::from_shape(shape), log_det_gap, weights, status, iterations }
    }
}

/// [`inscribed`](crate::inscribed()) in a dimension known at run time: the half-spaces normalsᵢ·x ≤ offsetsᵢ.
///
/// # Errors
/// Those of [`inscribed`](crate::inscribed()).
///
/// # Panics
/// If there are not as many offsets as normals, or the normals differ in length.
pub fn inscribed_dyn<P: AsRef<[f64]>>(
    normals: &[P],
    offsets: &[f64],
    options: InscribedOptions,
) -> Result<InscribedDyn, InscribedError> {
    assert_eq!(normals.len(), offsets.len(), "{} normals but {} offsets", normals.len(), offsets.len());
    let halfspaces = normals.iter().map(AsRef::as_ref).zip(offsets.iter().copied());
    crate::inscribed::solve(Dynamic(dimension(normals)), halfspaces, options, &mut |_| {})
        .map(InscribedDyn::from_solution)
}

/// [`inscribed_in_hull`](crate::inscribed_in_hull()) for slices of one length as points; of 2 or 3 coordinates.
///
/// # Errors
/// Those of [`inscribed_in_hull`](crate::inscribed_in_hull()).
///
/// # Panics
/// If the points differ in length.
pub fn inscribed_in_hull_dyn<P: AsRef<[f64]>>(
    points: &[P],
    options: InscribedOptions,
) -> Result<InscribedDyn, InscribedError> {
    crate::inscribed::in_hull::solve_points(&copied(points), options, &mut |_| {}).map(InscribedDyn::from_solution)
}
