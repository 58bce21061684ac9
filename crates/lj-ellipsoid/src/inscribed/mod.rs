//! The maximum-volume ellipsoid inside an intersection of half-spaces.

mod analytic_center;
mod body;
mod boundedness;
mod certificate;
mod chebyshev;
mod coordinates;
mod hull;
pub(crate) mod in_hull;
mod interior;
mod newton_system;
mod observer;
mod point;
mod polyhedron;
mod primal_dual;
mod solution;

use self::interior::round_coordinates;
pub use self::observer::InscribedIterate;
use self::observer::Observer;
use self::polyhedron::Polyhedron;
pub(crate) use self::solution::InscribedSolution;
use crate::ellipsoid::Ellipsoid;
use crate::error::InscribedError;
use crate::numerics::dimension::{Const, Dimension};
use crate::options::{InscribedOptions, Status};
use crate::weight::Weight;

/// The half-space { x : normal·x ≤ offset }. The normal points outward and need not be of unit length.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct HalfSpace<const N: usize> {
    /// The outward normal.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::point"))]
    pub normal: [f64; N],
    /// The value of normal·x on the boundary.
    pub offset: f64,
}

/// The maximum-volume ellipsoid inside a body, and the proof of how near to maximal it is.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Inscribed<const N: usize> {
    /// The ellipsoid, proved to be inside with the returned centre, axes and semi-axes. Its
    /// [`support_value`](Ellipsoid::support_value) along the normal of every given half-space is at most the offset.
    pub ellipsoid: Ellipsoid<N>,
    /// A certified bound: ln det X of `ellipsoid` exceeds that of the true optimum by at most this. It is twice the
    /// bound on the lack of log-volume. Never negative.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::gap"))]
    pub log_det_gap: f64,
    /// The multipliers y that prove the gap, positive ones only, with their half-spaces (facets of the hull, for
    /// points), scaled to sum to one.
    pub weights: Vec<Weight>,
    /// How the computation ended.
    pub status: Status,
    /// Newton steps.
    pub iterations: usize,
}

impl<const N: usize> Inscribed<N> {
    pub(crate) fn from_solution(solution: InscribedSolution<Const<N>>) -> Self {
        Self {
            ellipsoid: Ellipsoid::from_shape(&solution.shape),
            log_det_gap: solution.log_det_gap,
            weights: solution.weights,
            status: solution.status,
            iterations: solution.iterations,
        }
    }

    /// A certified bound on how much ln(volume) falls short of the largest possible.
    #[must_use]
    pub fn log_volume_gap(&self) -> f64 {
        0.5 * self.log_det_gap
    }
}

/// The ellipsoid of greatest volume inside the intersection of `halfspaces`.
///
/// Normals of any length, redundant and repeated half-spaces are fine, and so are thin bodies in any orientation. The
/// rounding of the answer limits thin bodies: rounding the axes of the ellipsoid to doubles takes some 1e-16 of a
/// turned body's length from its thickness, and a centre far from the origin loses as much of its own distance. The
/// gap includes this loss.
///
/// # Errors
/// [`InscribedError::Unbounded`] and [`InscribedError::EmptyInterior`] if there is no such ellipsoid;
/// [`InscribedError::NearlyUnbounded`] and [`InscribedError::NearlyEmpty`] if doubles do not tell;
/// [`InscribedError::ZeroNormal`], [`InscribedError::NonFinite`] and [`InscribedError::Empty`] for bad input,
/// [`InscribedError::InvalidEpsilon`] for a bad option.
///
/// # Examples
/// ```
/// use lj_ellipsoid::{HalfSpace, InscribedOptions, inscribed};
///
/// // A box of 4 × 2 about (1, 0).
/// let sides = [
///     HalfSpace { normal: [1.0, 0.0], offset: 3.0 },
///     HalfSpace { normal: [-1.0, 0.0], offset: 1.0 },
///     HalfSpace { normal: [0.0, 1.0], offset: 1.0 },
///     HalfSpace { normal: [0.0, -1.0], offset: 1.0 },
/// ];
/// let answer = inscribed(&sides, InscribedOptions::default())?;
/// assert!((answer.ellipsoid.center()[0] - 1.0).abs() < 1e-9);
/// assert!((answer.ellipsoid.semi_axes()[0] - 2.0).abs() < 1e-9);
/// # Ok::<(), lj_ellipsoid::InscribedError>(())
/// ```
#[doc(alias("john_ellipsoid", "max_volume_ellipsoid", "largest_ellipsoid"))]
pub fn inscribed<const N: usize>(
    halfspaces: &[HalfSpace<N>],
    options: InscribedOptions,
) -> Result<Inscribed<N>, InscribedError> {
    inscribed_with(halfspaces, options, |_| {})
}

/// [`inscribed`](inscribed()) with an `observer` that sees every iterate.
///
/// # Errors
/// Those of [`inscribed`](inscribed()).
pub fn inscribed_with<const N: usize>(
    halfspaces: &[HalfSpace<N>],
    options: InscribedOptions,
    mut observer: impl FnMut(InscribedIterate),
) -> Result<Inscribed<N>, InscribedError> {
    let halfspaces = halfspaces.iter().map(|h| (&h.normal[..], h.offset));
    solve(Const::<N>, halfspaces, options, &mut observer).map(Inscribed::from_solution)
}

/// The dimension-free body of [`inscribed`](inscribed()).
pub(crate) fn solve<'a, D: Dimension>(
    dim: D,
    halfspaces: impl ExactSizeIterator<Item = (&'a [f64], f64)>,
    options: InscribedOptions,
    observer: &mut Observer<'_>,
) -> Result<InscribedSolution<D>, InscribedError> {
    options.check()?;
    let polyhedron = Polyhedron::new(dim.get(), halfspaces)?;
    let (coordinates, rows) = round_coordinates(dim, &polyhedron)?;
    solution::solve(dim, coordinates, &rows, &polyhedron, options, observer)
}
