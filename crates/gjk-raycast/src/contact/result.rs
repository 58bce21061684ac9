//! What contact queries answer.

use convex_support::Vector;

use crate::Status;

/// As many points as a manifold has.
pub(super) const MAX_POINTS: usize = 4;

/// The answer of [`signed_distance`](crate::signed_distance).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SignedDistance<V: Vector> {
    /// The distance where the shapes are apart; where they overlap, minus the penetration depth: the length of the
    /// shortest translation of `a` after which they have no interior point in common.
    pub signed_distance: V::Scalar,
    /// The signed distance is certainly not less: this is proved by a plane across [`normal`](Self::normal), or across
    /// a vector near it that closest points give. Minus infinity where a support map returned numbers that are not
    /// finite.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_minus_infinity"))]
    pub lower: V::Scalar,
    /// The signed distance is certainly not more: two points of the shapes are this far apart, or a polytope within the
    /// difference `A − B` reaches this far around zero. Infinity where a support map returned numbers that are not
    /// finite.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub upper: V::Scalar,
    /// The unit vector from `b` to `a`. If `a` is moved along it by the depth, the shapes no longer overlap. Where
    /// several ways out are equally short, it is the direction of one of them.
    pub normal: V,
    /// The point of `a` closest to `b`, or deepest in it. It is in `a` but for rounding, 8ε of the sizes of both shapes
    /// and their offset, however the search ended: what is not known of the way out is in the bounds.
    pub point_a: V,
    /// The point of `b` such that `point_a − point_b` is the signed distance times the normal, in the same way.
    pub point_b: V,
    /// Whether the shapes have a point in common, touching included: whether `signed_distance` is not positive. It is
    /// certain where `lower` and `upper` have the same sign.
    pub overlap: bool,
    /// How the search ended. The bounds hold in every case.
    pub status: Status,
    /// The number of support points computed of each shape.
    pub iterations: usize,
    /// The number of facets of the last polytope that did not have to be expanded, since no way out through them is
    /// shorter. 0 where no polytope was needed.
    pub unexpanded: usize,
}

impl<V: Vector> SignedDistance<V> {
    /// The same of the shapes in the other order: from `b` to `a`.
    pub fn reversed(self) -> Self {
        Self { normal: -self.normal, point_a: self.point_b, point_b: self.point_a, ..self }
    }
}

/// The answer of [`contact`](crate::contact).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Contact<V: Vector> {
    /// The unit vector from `b` to `a`.
    pub normal: V,
    /// The signed distance of the shapes, with its bounds and closest points.
    pub distance: SignedDistance<V>,
    pub(super) points: [ContactPoint<V>; MAX_POINTS],
    pub(super) len: usize,
}

impl<V: Vector> Contact<V> {
    /// As many points as a manifold has.
    #[cfg(feature = "serde")]
    pub(crate) const MAX_POINTS: usize = MAX_POINTS;

    /// With the first of the points, as many as a manifold has.
    pub(crate) fn new(normal: V, distance: SignedDistance<V>, found: &[ContactPoint<V>]) -> Self {
        let mut points = [ContactPoint::default(); MAX_POINTS];
        let len = found.len().min(MAX_POINTS);
        points[..len].copy_from_slice(&found[..len]);
        Self { normal, distance, points, len }
    }

    /// The same of the shapes in the other order: of `b` with `a`.
    pub fn reversed(self) -> Self {
        let points = self.points.map(ContactPoint::reversed);
        Self { normal: -self.normal, distance: self.distance.reversed(), points, len: self.len }
    }

    /// The points of the manifold: one to four, in 2D one or two.
    #[must_use]
    pub fn points(&self) -> &[ContactPoint<V>] {
        &self.points[..self.len]
    }
}

/// A point of a contact manifold. Its points are on the surfaces of both shapes, on a line along the normal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ContactPoint<V: Vector> {
    /// The point of `a`.
    pub point_a: V,
    /// The point of `b` before or behind it along the normal.
    pub point_b: V,
    /// How far `point_a` is before `point_b` along the normal; negative where the shapes overlap.
    pub signed_distance: V::Scalar,
    /// What that is wrong by at most: the surfaces are not nearer to one another along this line than the signed
    /// distance less this, and the points are of the shapes to rounding. Of polytopes it is rounding.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub error: V::Scalar,
    /// The vertex, edge or face of `a` that the point is on, as a number. It stays the same from frame to frame as long
    /// as the point is on the same feature, so that a solver can find its impulses of the last frame again.
    pub feature_a: u32,
    /// The vertex, edge or face of `b` that the point is on, in the same way.
    pub feature_b: u32,
}

impl<V: Vector> ContactPoint<V> {
    /// The same of the shapes in the other order.
    #[must_use]
    pub fn reversed(self) -> Self {
        Self {
            point_a: self.point_b,
            point_b: self.point_a,
            feature_a: self.feature_b,
            feature_b: self.feature_a,
            ..self
        }
    }
}
