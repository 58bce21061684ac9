//! From the last iterate to the ellipsoid that is returned, with its certified gap and contact points.

use crate::enclosing::frame::Frame;
use crate::enclosing::moments::Moments;
use crate::enclosing::outward::{SOME, beyond_radius, reach, touch};
use crate::enclosing::working_set::WorkingSet;
use crate::error::EnclosingError;
use crate::numerics::dimension::{Dimension, Dynamic};
use crate::numerics::linalg::{UNIT_ROUNDOFF, dot, logarithms, power_of_two_inverse, sum_of_logarithms};
use crate::options::Status;
use crate::points::Points;
use crate::shape::{Shape, principal_axes, shape_from_axes};
use crate::weight::Weight;

/// A solved enclosing problem of any dimension.
#[derive(Clone, Debug)]
pub(crate) struct Solution<N: Dimension> {
    pub(crate) shape: Shape<N>,
    pub(crate) log_det_gap: f64,
    pub(crate) weights: Vec<Weight>,
    pub(crate) contacts: Vec<usize>,
    pub(crate) status: Status,
    pub(crate) iterations: usize,
    pub(crate) scans: usize,
}

impl Solution<Dynamic> {
    /// The same solution in the dimension of `dim`.
    pub(crate) fn in_dimension<N: Dimension>(self, dim: N) -> Solution<N> {
        let Self { shape, log_det_gap, weights, contacts, status, iterations, scans } = self;
        Solution { shape: shape.in_dimension(dim), log_det_gap, weights, contacts, status, iterations, scans }
    }
}

impl<N: Dimension> Solution<N> {
    /// The ellipsoid around `count` points that all are `center`.
    pub(crate) fn point(dim: N, center: N::Point, count: usize, scans: usize) -> Self {
        Self {
            shape: Shape { center, ..shape_from_axes(dim, 0, dim.zero(), dim.zero_matrix()) },
            log_det_gap: 0.0,
            weights: vec![Weight { index: 0, weight: 1.0 }],
            contacts: (0..count).collect(),
            status: Status::Converged,
            iterations: 0,
            scans,
        }
    }
}

/// The upper bound on ln det X* that a method proves, in the coordinates of its frame, and its proof.
pub(crate) struct Certificate {
    /// Every ellipsoid that contains the points has ln det X ≤ this, X in the frame.
    pub(crate) log_det_bound: f64,
    pub(crate) weights: Vec<Weight>,
}

impl Certificate {
    /// From weights: ln det X ≤ −ln det S − r·ln r, increased by the effect of the coordinates' rounding on ln det
    /// S: 2·tr(S⁻¹Σuᵢyᵢδyᵢᵀ) ≤ 2√r·max|L⁻¹δyᵢ|.
    pub(crate) fn from_weights<P: Points>(
        points: &P,
        rank: P::Dim,
        frame: &Frame<P::Dim>,
        set: &WorkingSet,
        moments: &Moments<P::Dim>,
    ) -> Self {
        let r = rank.get() as f64;
        // |L⁻¹| ≤ |L⁻¹|_F; L is near the identity in the last frame.
        let mut inverse_norm: f64 = 0.0;
        for k in 0..rank.get() {
            let mut e = rank.zero();
            e.as_mut()[k] = 1.0;
            crate::numerics::linalg::solve_lower(rank, moments.factor.as_ref(), e.as_mut());
            inverse_norm += dot(e.as_ref(), e.as_ref());
        }
        let rounding = 2.0 * r.sqrt() * inverse_norm.sqrt() * set.coordinate_error(points, frame)
            + 4.0 * (r + 2.0) * r * UNIT_ROUNDOFF;
        let weighted = set.index.iter().zip(&set.u).filter(|(_, u)| **u > 0.0);
        let mut weights = Vec::with_capacity(set.len());
        weights.extend(weighted.map(|(&index, &weight)| Weight { index, weight }));
        Self { log_det_bound: -moments.log_det_scatter - r * libm::log(r) + rounding, weights }
    }
}

/// The result of a method, beside its frame.
pub(crate) struct Ending {
    pub(crate) certificate: Certificate,
    pub(crate) status: Status,
    pub(crate) iterations: usize,
    pub(crate) scans: usize,
}

/// Turns the unit ball of `frame` into the ellipsoid that is proved to contain every point, with its gap.
pub(crate) fn finish<P: Points>(
    points: &P,
    rank: P::Dim,
    frame: &Frame<P::Dim>,
    epsilon: f64,
    ending: Ending,
) -> Result<Solution<P::Dim>, EnclosingError> {
    let Ending { certificate, status: ended, iterations, scans } = ending;
    let dim = points.dim();
    let r = rank.get();
    let mut shape = principal_axes(dim, r, dim.matrix(frame.map().iter().copied()));
    shape.center.clone_from(&frame.origin);
    // A point with weight lies within the gap of the surface.
    let tolerance = (certificate.log_det_bound + r as f64 * libm::log(r as f64)).max(1e-9);
    let reach = reach(points, rank, &shape, tolerance);
    let growth = touch(points, &mut shape, &reach);
    let shrink = (1.0 - 4.0 * UNIT_ROUNDOFF) / reach.matrix.max(growth * growth);
    shape.matrix.as_mut().iter_mut().for_each(|x| *x *= shrink);
    let semi_axes = &shape.semi_axes.as_ref()[..r];
    shape.log_det = -2.0 * sum_of_logarithms(semi_axes.iter().copied());
    if !shape.log_det.is_finite() || semi_axes.iter().any(|a| !a.is_finite()) {
        return Err(EnclosingError::OutOfRange);
    }
    // ln det X* − ln det X: the transformation into the frame cancels, and so does its size.
    let [_, logarithms] = logarithms(semi_axes, power_of_two_inverse(semi_axes.first().copied().unwrap_or(1.0)));
    let log_det_gap = certificate.log_det_bound + 2.0 * r as f64 * libm::log(growth) + 4.0 * UNIT_ROUNDOFF * logarithms;
    // The points are proved to be inside, and the bound holds for all ellipsoids that contain them. A negative
    // difference, or NaN, would only prove that numbers left the range in which the errors are bounded.
    let log_det_gap = if log_det_gap >= 0.0 { log_det_gap } else { f64::INFINITY };
    let status = match ended {
        Status::IterationLimit if log_det_gap > epsilon => Status::IterationLimit,
        _ if log_det_gap <= epsilon => Status::Converged,
        _ => Status::Stalled,
    };
    let nearest = growth * (1.0 - log_det_gap.max(1e-9));
    let contacts = match &reach.candidates {
        Some(candidates) => {
            let mut contacts = Vec::with_capacity(candidates.len().min(SOME));
            contacts.extend(candidates.iter().filter(|(_, q)| q.sqrt() >= nearest).map(|(i, _)| *i));
            contacts
        }
        None => beyond_radius(points, rank, &reach.frame, nearest),
    };
    let scans = scans + reach.passes + usize::from(reach.candidates.is_none());
    Ok(Solution { shape, log_det_gap, weights: certificate.weights, contacts, status, iterations, scans })
}
