//! The minimum-volume ellipsoid that contains given points.

mod active_set;
mod dual_reduced;
mod ellipsoid_algorithm;
mod frame;
mod iterate;
mod khachiyan;
mod moments;
pub(crate) mod moving_points;
mod newton;
mod outward;
mod problem;
mod scan;
mod solution;
mod start;
mod violators;
mod working_set;

use self::active_set::Improve;
pub use self::problem::EnclosingIterate;
use self::problem::{Observer, Problem};
pub(crate) use self::solution::Solution;
use self::start::{Start, start};
use crate::ellipsoid::Ellipsoid;
use crate::error::EnclosingError;
use crate::numerics::dimension::{Const, Dimension, Dynamic};
use crate::options::{EnclosingMethod, EnclosingOptions, FlatPolicy, Status};
use crate::points::{Copied, PointSlice, Points};
use crate::weight::Weight;

/// The minimum-volume ellipsoid around points, and the proof of how near to minimal it is.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Enclosing<const N: usize> {
    /// The ellipsoid. It is proved to contain every input point, and does as evaluated in `f64`.
    pub ellipsoid: Ellipsoid<N>,
    /// A certified bound: ln det X of the true optimum exceeds that of `ellipsoid` by at most this, rounding included.
    /// It is twice the bound on the excess of the log-volume, [`log_volume_gap`](Self::log_volume_gap). Never negative.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::gap"))]
    pub log_det_gap: f64,
    /// The weights that prove the gap: positive ones only, by ascending index for a method on a working set. Empty for
    /// [`EnclosingMethod::EllipsoidAlgorithm`], whose proof is its last cut.
    pub weights: Vec<Weight>,
    /// The points on the surface, up to the gap, by ascending index.
    pub contacts: Vec<usize>,
    /// How the computation ended.
    pub status: Status,
    /// Iterations of the method: Newton steps, or moves of a weight, or cuts.
    pub iterations: usize,
    /// Passes over all points, those of the start and of the final check included.
    pub scans: usize,
}

impl<const N: usize> Enclosing<N> {
    /// A certified bound on how much ln(volume) exceeds the least possible: half of [`log_det_gap`](Self::log_det_gap).
    #[must_use]
    pub fn log_volume_gap(&self) -> f64 {
        0.5 * self.log_det_gap
    }

    pub(crate) fn from_solution(solution: Solution<Const<N>>) -> Self {
        Self {
            ellipsoid: Ellipsoid::from_shape(&solution.shape),
            log_det_gap: solution.log_det_gap,
            weights: solution.weights,
            contacts: solution.contacts,
            status: solution.status,
            iterations: solution.iterations,
            scans: solution.scans,
        }
    }
}

/// The ellipsoid of least volume that contains `points` (Löwner and John).
///
/// Points are anything that converts into `[f64; N]`. The answer is affine equivariant: scale, aspect and offset of the
/// points do not matter, as far as `f64` represents them.
///
/// # Errors
/// [`EnclosingError::Empty`] without points, [`NonFinite`](EnclosingError::NonFinite) for NaN and infinities,
/// [`Flat`](EnclosingError::Flat) if the points span no volume (unless the option is [`FlatPolicy::AffineHull`]),
/// [`OutOfRange`](EnclosingError::OutOfRange) if `f64` cannot hold the answer,
/// [`InvalidEpsilon`](EnclosingError::InvalidEpsilon) and
/// [`InvalidFlatTolerance`](EnclosingError::InvalidFlatTolerance) for options out of their range.
///
/// # Examples
/// ```
/// use lj_ellipsoid::{EnclosingOptions, enclosing};
///
/// let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
/// let answer = enclosing(&square, EnclosingOptions::default())?;
/// assert_eq!(answer.ellipsoid.center(), [1.0, 1.0]);
/// assert!((answer.ellipsoid.semi_axes()[0] - 2f64.sqrt()).abs() < 1e-14);
/// assert!(square.iter().all(|&corner| answer.ellipsoid.contains(corner)));
/// # Ok::<(), lj_ellipsoid::EnclosingError>(())
/// ```
#[doc(alias("mvee", "lowner_john", "min_volume_ellipsoid", "bounding_ellipsoid", "d_optimal"))]
pub fn enclosing<P: Into<[f64; N]> + Copy + Sync, const N: usize>(
    points: &[P],
    options: EnclosingOptions,
) -> Result<Enclosing<N>, EnclosingError> {
    enclosing_with(points, options, |_| {})
}

/// [`enclosing`](enclosing()) with an `observer` that sees every iterate.
///
/// # Errors
/// Those of [`enclosing`](enclosing()).
pub fn enclosing_with<P: Into<[f64; N]> + Copy + Sync, const N: usize>(
    points: &[P],
    options: EnclosingOptions,
    mut observer: impl FnMut(EnclosingIterate<'_>),
) -> Result<Enclosing<N>, EnclosingError> {
    solve(&PointSlice(points), options, &mut observer).map(Enclosing::from_solution)
}

/// The dimension-free body of [`enclosing`](enclosing()).
pub(crate) fn solve<P: Points>(
    points: &P,
    options: EnclosingOptions,
    observer: &mut Observer<'_>,
) -> Result<Solution<P::Dim>, EnclosingError> {
    options.check()?;
    let dim = points.dim();
    let start = start(points, options.flat_tolerance)?;
    let (rank, dimension) = (start.frame.rank(), dim.get());
    match options.flat {
        FlatPolicy::Error if rank < dimension => Err(EnclosingError::Flat { rank, dimension }),
        FlatPolicy::AffineHull if rank == 0 => Ok(Solution::point(dim, start.frame.origin, points.len(), start.scans)),
        _ => solve_from(points, start, options, observer),
    }
}

/// Solves in the coordinates of a starting frame.
///
/// If the points span the space, the methods on a working set are compiled for their dimension. All else is compiled
/// once, for a dimension known at run time, and works on a copy of the points.
pub(crate) fn solve_from<P: Points>(
    points: &P,
    start: Start<P::Dim>,
    options: EnclosingOptions,
    observer: &mut Observer<'_>,
) -> Result<Solution<P::Dim>, EnclosingError> {
    let dim = points.dim();
    if let (Some(improve), true) = (on_working_set(options.method), start.frame.rank() == dim.get()) {
        return active_set::solve(&Problem { points, rank: dim, options }, improve, start, observer);
    }
    let points = Copied::new(Dynamic(dim.get()), points, 0..points.len());
    solve_at_run_time(&points, start.at_run_time(), options, observer).map(|solution| solution.in_dimension(dim))
}

/// Solves in the rank(start) coordinates of a starting frame, by any method.
fn solve_at_run_time(
    points: &Copied<Dynamic>,
    start: Start<Dynamic>,
    options: EnclosingOptions,
    observer: &mut Observer<'_>,
) -> Result<Solution<Dynamic>, EnclosingError> {
    let problem = Problem { points, rank: Dynamic(start.frame.rank()), options };
    match (on_working_set(options.method), options.method) {
        (Some(improve), _) => active_set::solve(&problem, improve, start, observer),
        (None, EnclosingMethod::EllipsoidAlgorithm) => ellipsoid_algorithm::solve(&problem, start, observer),
        (None, _) => khachiyan::solve(&problem, start, observer),
    }
}

/// The function by which a method on a working set improves its weights; `None` for the others.
fn on_working_set<D: Dimension>(method: EnclosingMethod) -> Option<Improve<D>> {
    match method {
        EnclosingMethod::Newton => Some(newton::solve),
        EnclosingMethod::DualReducedNewton => Some(dual_reduced::solve),
        EnclosingMethod::Khachiyan | EnclosingMethod::EllipsoidAlgorithm => None,
    }
}
