//! The input of every method for the enclosing ellipsoid, and observers.

use crate::options::EnclosingOptions;
use crate::points::Points;

/// What an observer of [`enclosing_with`](crate::enclosing_with) sees after every pass over the points.
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

/// Who sees the iterates. The solvers are compiled once for all observers: a call costs little beside the step it
/// reports.
pub(crate) type Observer<'a> = dyn FnMut(EnclosingIterate<'_>) + 'a;

/// The input of every method.
pub(crate) struct Problem<'a, P: Points> {
    pub(crate) points: &'a P,
    /// The dimension of their affine hull.
    pub(crate) rank: P::Dim,
    pub(crate) options: EnclosingOptions,
}
