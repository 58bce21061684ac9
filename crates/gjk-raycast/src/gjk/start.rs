//! How a search begins.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::{Frame, Gjk, GjkOptions};
use crate::SubAlgorithm;
use crate::body::AnyPair;
use crate::unit::moderate;

/// The direction to look along first: an axis that somebody knows, or from one origin to the other.
#[inline(always)]
pub(crate) fn first_direction<V: Vector>(axis: Option<V>, offset: V) -> V {
    axis.and_then(moderate).or_else(|| moderate(offset)).unwrap_or_else(|| Vector::axis(0))
}

impl<V: Vector> Gjk<V> {
    /// Begins at the closest points of the cores of a pair of the given size, where those are known in closed form:
    /// whether the bodies meet there, to rounding. `None` where they are not known, and the state is as it was.
    #[inline(always)]
    pub(crate) fn begin_at_closest(
        &mut self,
        pair: &AnyPair<'_, V>,
        frame: &Frame<V>,
        size: V::Scalar,
    ) -> Option<bool> {
        let points = pair.closest_points(frame.offset * frame.scale, size)?;
        Some(self.begin_at(points.a - points.b + frame.offset, points, frame))
    }
}

impl<V: Vector> GjkOptions<V> {
    /// All that can be known of the closest points, beginning with a direction.
    #[inline(always)]
    pub(crate) fn new(first: V, max_iterations: usize) -> Self {
        Self {
            first,
            limit: V::Scalar::infinity(),
            tolerance: V::Scalar::ZERO,
            closest_points: true,
            max_iterations,
            sub_algorithm: SubAlgorithm::Regions,
        }
    }
}
