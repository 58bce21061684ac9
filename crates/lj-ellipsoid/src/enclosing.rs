//! The minimum-volume ellipsoid that contains given points.

use crate::dimension::{Const, Dimension, Dynamic};
use crate::ellipsoid::Ellipsoid;
use crate::error::EnclosingError;
use crate::options::{EnclosingMethod, EnclosingOptions, FlatPolicy, Status};
use crate::points::{PointSlice, Points};
use crate::solution::{Solution, Weight};
use crate::start::{Start, start};
use crate::working_set;
use crate::{ellipsoid_algorithm, khachiyan};

/// The minimum-volume ellipsoid around points, and the proof of how near to minimal it is.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Enclosing<const N: usize> {
    /// The ellipsoid. It contains every input point as evaluated in `f64`.
    pub ellipsoid: Ellipsoid<N>,
    /// A certified bound: ln det X of the true optimum exceeds that of `ellipsoid` by at most this, rounding included.
    /// It is twice the bound on the excess of the log-volume, [`log_volume_gap`](Self::log_volume_gap). Never negative.
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

/// What an observer of [`enclosing_with`] sees after every pass over the points.
#[derive(Clone, Copy, Debug)]
pub struct EnclosingIterate<'a> {
    /// Iterations so far.
    pub iteration: usize,
    /// Passes over all points so far.
    pub scans: usize,
    /// The bound on ln det X* − ln det X of this iterate, before outward rounding.
    pub log_det_gap: f64,
    /// The points of the working set; for methods without one, all points.
    pub indices: &'a [usize],
    /// Their weights; empty for the ellipsoid algorithm.
    pub weights: &'a [f64],
}

/// The ellipsoid of least volume that contains `points` (Löwner and John).
///
/// Points are anything that converts into `[f64; N]`. The answer is affine equivariant: scale, aspect and offset of the
/// points do not matter, as far as `f64` represents them.
///
/// # Errors
/// [`EnclosingError::Empty`] without points, [`NonFinite`](EnclosingError::NonFinite) for NaN and infinities,
/// [`Flat`](EnclosingError::Flat) where the points span no volume (unless
/// [`FlatPolicy::AffineHull`] is asked for), [`OutOfRange`](EnclosingError::OutOfRange) where `f64` cannot hold the answer.
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
pub fn enclosing<P: Into<[f64; N]> + Copy + Sync, const N: usize>(
    points: &[P],
    options: EnclosingOptions,
) -> Result<Enclosing<N>, EnclosingError> {
    enclosing_with(points, options, |_| {})
}

/// [`enclosing`](enclosing()), showing every iterate to `observer`.
///
/// # Errors
/// As [`enclosing`](enclosing()).
pub fn enclosing_with<P: Into<[f64; N]> + Copy + Sync, const N: usize>(
    points: &[P],
    options: EnclosingOptions,
    observer: impl FnMut(EnclosingIterate<'_>),
) -> Result<Enclosing<N>, EnclosingError> {
    solve(&PointSlice(points), options, observer).map(Enclosing::from_solution)
}

/// The dimension-free body of [`enclosing`](enclosing()).
pub(crate) fn solve<P: Points>(
    points: &P,
    options: EnclosingOptions,
    observer: impl FnMut(EnclosingIterate<'_>),
) -> Result<Solution<P::Dim>, EnclosingError> {
    let dim = points.dim();
    let dimension = dim.get();
    let start = start(points, options.flat_tolerance)?;
    let rank = start.frame.rank();
    if rank == dimension {
        return solve_from(points, dim, start, options, observer);
    }
    match options.flat {
        FlatPolicy::Error => Err(EnclosingError::Flat { rank, dimension }),
        FlatPolicy::AffineHull if rank == 0 => Ok(Solution::point(dim, start.frame.origin, points.len(), start.scans)),
        FlatPolicy::AffineHull => solve_from(points, Dynamic(rank), start, options, observer),
    }
}

/// Solves in the `rank` coordinates of a starting frame.
pub(crate) fn solve_from<P: Points, R: Dimension + Sync>(
    points: &P,
    rank: R,
    start: Start<P::Dim>,
    options: EnclosingOptions,
    observer: impl FnMut(EnclosingIterate<'_>),
) -> Result<Solution<P::Dim>, EnclosingError> {
    match options.method {
        EnclosingMethod::Newton | EnclosingMethod::DualReducedNewton => {
            working_set::solve(points, rank, start, options, observer)
        }
        EnclosingMethod::Khachiyan => khachiyan::solve(points, rank, start, options, observer),
        EnclosingMethod::EllipsoidAlgorithm => ellipsoid_algorithm::solve(points, rank, start, options, observer),
    }
}
