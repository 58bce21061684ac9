//! Points as rows of a faer matrix, for dimensions known only at run time.

use faer::{Mat, MatRef};

use crate::ellipsoid::{radius_at, reach_along};
use crate::enclosing::{EnclosingIterate, Solution};
use crate::error::{EnclosingError, InscribedError};
use crate::inscribed::InscribedSolution;
use crate::numerics::dimension::Dynamic;
use crate::numerics::linalg::dot;
use crate::options::{EnclosingOptions, InscribedOptions, Status};
use crate::points::Copied;
use crate::shape::Shape;
use crate::weight::Weight;

/// The ellipsoid E(c, X) = { x : (x − c)ᵀX(x − c) ≤ 1 } in a dimension known at run time; see
/// [`Ellipsoid`](crate::Ellipsoid).
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

    /// The orthonormal directions of the semi-axes: row k is that of `semi_axes()[k]`; the determinant is +1.
    #[must_use]
    pub fn axes(&self) -> MatRef<'_, f64> {
        let n = self.dimension();
        MatRef::from_row_major_slice(&self.shape.axes, n, n)
    }

    /// The lengths of the semi-axes, longest first.
    #[must_use]
    pub fn semi_axes(&self) -> &[f64] {
        &self.shape.semi_axes
    }

    /// X; see [`Ellipsoid::matrix`](crate::Ellipsoid::matrix).
    #[must_use]
    pub fn matrix(&self) -> MatRef<'_, f64> {
        let n = self.dimension();
        MatRef::from_row_major_slice(&self.shape.matrix, n, n)
    }

    /// ln det X = −2·Σ ln semi-axis, over the semi-axes that are not zero.
    #[must_use]
    pub fn log_det(&self) -> f64 {
        self.shape.log_det
    }

    /// |diag(1/a)·Rᵀ(x − c)|: 1 on the surface, less inside.
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

    /// max direction·x over the ellipsoid; see [`Ellipsoid::support_value`](crate::Ellipsoid::support_value).
    ///
    /// # Panics
    /// If `direction` has not as many coordinates as the ellipsoid.
    #[must_use]
    pub fn support_value(&self, direction: &[f64]) -> f64 {
        let n = self.dimension();
        assert_eq!(direction.len(), n, "the direction has {} coordinates, the ellipsoid {n}", direction.len());
        dot(direction, &self.shape.center) + reach_along(&self.shape.axes, &self.shape.semi_axes, direction)
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
pub struct EnclosingDyn {
    /// The ellipsoid. It contains every input point as evaluated in `f64`.
    pub ellipsoid: EllipsoidDyn,
    /// A certified bound on ln det X* − ln det X, rounding included; never negative.
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

/// The rows of a matrix as points.
fn copied(points: MatRef<'_, f64>) -> Copied<Dynamic> {
    let (m, n) = (points.nrows(), points.ncols());
    let rows = (0..m).flat_map(|i| (0..n).map(move |k| points[(i, k)]));
    Copied::from_coordinates(Dynamic(n), m, rows.collect())
}

/// [`enclosing`](crate::enclosing()) for points of a dimension known at run time: one point per row of `points`.
///
/// # Errors
/// As [`enclosing`](crate::enclosing()).
///
/// # Examples
/// ```
/// use lj_ellipsoid::{EnclosingOptions, enclosing_dyn, faer::Mat};
///
/// // The eight points ±eₖ in four dimensions: the unit ball.
/// let cross = Mat::from_fn(8, 4, |i, k| if i % 4 == k { if i < 4 { 1.0 } else { -1.0 } } else { 0.0 });
/// let answer = enclosing_dyn(cross.as_ref(), EnclosingOptions::default())?;
/// assert!(answer.ellipsoid.log_det().abs() < 1e-13);
/// # Ok::<(), lj_ellipsoid::EnclosingError>(())
/// ```
pub fn enclosing_dyn(points: MatRef<'_, f64>, options: EnclosingOptions) -> Result<EnclosingDyn, EnclosingError> {
    enclosing_dyn_with(points, options, |_| {})
}

/// [`enclosing_dyn`], showing every iterate to `observer`.
///
/// # Errors
/// As [`enclosing`](crate::enclosing()).
pub fn enclosing_dyn_with(
    points: MatRef<'_, f64>,
    options: EnclosingOptions,
    mut observer: impl FnMut(EnclosingIterate<'_>),
) -> Result<EnclosingDyn, EnclosingError> {
    let Solution { shape, log_det_gap, weights, contacts, status, iterations, scans } =
        crate::enclosing::solve(&copied(points), options, &mut observer)?;
    let ellipsoid = EllipsoidDyn::from_shape(shape);
    Ok(EnclosingDyn { ellipsoid, log_det_gap, weights, contacts, status, iterations, scans })
}

/// [`Inscribed`](crate::Inscribed) in a dimension known at run time; the fields mean the same.
#[derive(Clone, Debug)]
#[must_use]
pub struct InscribedDyn {
    /// The ellipsoid; it lies in every half-space, the rounding of the evaluation taken into account.
    pub ellipsoid: EllipsoidDyn,
    /// A certified bound on ln det X − ln det X*; never negative.
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

/// [`inscribed`](crate::inscribed()) in a dimension known at run time: the half-spaces normalsᵢ·x ≤ offsetsᵢ, one normal
/// per row.
///
/// # Errors
/// As [`inscribed`](crate::inscribed()).
///
/// # Panics
/// If there are not as many offsets as normals.
pub fn inscribed_dyn(
    normals: MatRef<'_, f64>,
    offsets: &[f64],
    options: InscribedOptions,
) -> Result<InscribedDyn, InscribedError> {
    let (m, n) = (normals.nrows(), normals.ncols());
    assert_eq!(m, offsets.len(), "{m} normals but {} offsets", offsets.len());
    let rows: Vec<f64> = (0..m * n).map(|at| normals[(at / n, at % n)]).collect();
    let halfspaces = rows.chunks_exact(n.max(1)).zip(offsets.iter().copied());
    crate::inscribed::solve(Dynamic(n), halfspaces, options, &mut |_| {}).map(InscribedDyn::from_solution)
}

/// [`inscribed_in_hull`](crate::inscribed_in_hull()) for points given as rows of a matrix; of 2 or 3 columns.
///
/// # Errors
/// As [`inscribed_in_hull`](crate::inscribed_in_hull()).
pub fn inscribed_in_hull_dyn(
    points: MatRef<'_, f64>,
    options: InscribedOptions,
) -> Result<InscribedDyn, InscribedError> {
    crate::inscribed::in_hull::solve_points(&copied(points), options, &mut |_| {}).map(InscribedDyn::from_solution)
}

/// `rows` as a matrix, one row each; for callers that hold vectors of run-time length.
///
/// # Panics
/// If the rows differ in length.
#[must_use]
pub fn rows_to_matrix(rows: &[Vec<f64>]) -> Mat<f64> {
    let columns = rows.first().map_or(0, Vec::len);
    assert!(rows.iter().all(|row| row.len() == columns), "all rows must be of the length of the first, {columns}");
    Mat::from_fn(rows.len(), columns, |i, k| rows[i][k])
}
