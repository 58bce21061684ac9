//! Bounds on a distance.

use convex_support::Vector;

/// Bounds on the Euclidean distance of two ellipsoids, by a slab between them and a point of each.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DistanceBracket<V: Vector> {
    /// The distance is at least this: the width of the slab between the bodies across `normal`. 0 where they overlap.
    pub lower: V::Scalar,
    /// The distance is at most this, that from `point1` to `point2`. 0 where they overlap.
    pub upper: V::Scalar,
    /// A point of E₁ (to rounding); where they overlap, a point of both.
    pub point1: V,
    /// A point of E₂ (to rounding); where they overlap, a point of both.
    pub point2: V,
    /// The unit normal of the slab, from E₁ to E₂; zero where they overlap.
    pub normal: V,
}
