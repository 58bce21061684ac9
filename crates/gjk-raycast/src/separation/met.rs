//! The point of the difference of two cores that GJK ended with.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::cores::Cores;
use crate::body::PointPair;
use crate::gjk::Gjk;

/// The point of the difference next to zero of those that GJK knows. Where cores are well in one another nothing asks
/// for it.
#[derive(Clone, Copy, Debug)]
pub(super) struct MetPoint<V: Vector> {
    pub(super) point: V,
    /// The points of both cores that it is made of.
    pub(super) points: PointPair<V>,
    /// Zero is certain to be no farther from the difference than this.
    pub(super) reached: V::Scalar,
}

impl<V: Vector> MetPoint<V> {
    #[inline(never)]
    pub(super) fn new(cores: &Cores<'_, V>, state: &mut Gjk<V>) -> Self {
        state.ensure_measured();
        let (mut point, mut points, mut sum) = (V::ZERO, PointPair::default(), V::Scalar::ZERO);
        for (&corner, (weight, pair)) in state.simplex.points().iter().zip(state.simplex.weighted()) {
            points = points.plus(pair, weight);
            point += corner * weight;
            sum += weight;
        }
        let point = point / sum;
        let is_known = state.length.is_finite() && sum > V::Scalar::ZERO;
        Self { point, points, reached: if is_known { cores.greatest_length(point) } else { V::Scalar::infinity() } }
    }
}
