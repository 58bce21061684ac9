//! What can be asked of a contact query beside its shapes.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::options::setters;

/// Support points after which a signed distance is given up. Polytopes need some dozens, smooth shapes about a hundred;
/// the cap bounds the time that ties take, such as an ellipsoid of revolution within another about the same axis.
const MAX_ITERATIONS: usize = 500;

/// Options of [`signed_distance`](crate::signed_distance).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct SignedDistanceOptions<V: Vector> {
    /// The width of the bracket at which to stop in overlap, relative to the size of what is compared. It concerns
    /// curved shapes; of polytopes the facet that decides is found exactly. Default: 1e-9 in `f64`, 8ε in `f32`.
    pub tolerance: V::Scalar,
    /// Stop as soon as the shapes are certain to be farther apart than this. NaN is no limit. Default: infinity.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub limit: V::Scalar,
    /// Stop as soon as the shapes are certain to be deeper in one another than this. NaN is no limit. Default:
    /// infinity.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub depth_limit: V::Scalar,
    /// The support points of each shape after which to give up. The points of both shapes at the ends of a depth that
    /// is not known better may take a sixteenth more. Default: 500.
    pub max_iterations: usize,
    /// A first guess of the direction from `b` to `a`, such as the normal of the last answer. Default: none.
    pub axis: Option<V>,
}

impl<V: Vector> SignedDistanceOptions<V> {
    /// The default options.
    #[must_use]
    pub fn new() -> Self {
        let least = V::Scalar::from_f64(8.0) * V::Scalar::EPSILON;
        Self {
            tolerance: V::Scalar::from_f64(1e-9).max(least),
            limit: V::Scalar::infinity(),
            depth_limit: V::Scalar::infinity(),
            max_iterations: MAX_ITERATIONS,
            axis: None,
        }
    }

    setters!(tolerance, limit, max_iterations, axis);

    /// With a [`depth_limit`](Self::depth_limit).
    #[must_use]
    pub const fn with_depth_limit(mut self, depth_limit: V::Scalar) -> Self {
        self.depth_limit = depth_limit;
        self
    }
}

impl<V: Vector> Default for SignedDistanceOptions<V> {
    fn default() -> Self {
        Self::new()
    }
}
