//! The answers of contact queries.

use convex_support::{Matrix, Posed, Scalar, SupportMap, Vector};

use crate::symmetric::axes_across;
use crate::{SignedDistance, Trajectory};

/// As many points as a manifold has.
pub(crate) const MANIFOLD_POINTS: usize = 4;

/// The answer of [`contact`](crate::contact).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Contact<V: Vector> {
    /// The unit vector from `b` to `a`.
    pub normal: V,
    /// The signed distance of the shapes, with its bounds and closest points.
    pub distance: SignedDistance<V>,
    pub(super) points: [ContactPoint<V>; MANIFOLD_POINTS],
    pub(super) len: usize,
}

impl<V: Vector> Contact<V> {
    /// With the first of the points, as many as a manifold has.
    pub(crate) fn new(
        normal: V,
        distance: SignedDistance<V>,
        found: impl IntoIterator<Item = ContactPoint<V>>,
    ) -> Self {
        let mut contact = Self { normal, distance, points: [ContactPoint::default(); MANIFOLD_POINTS], len: 0 };
        for (slot, point) in contact.points.iter_mut().zip(found) {
            *slot = point;
            contact.len += 1;
        }
        contact
    }

    /// The contact of the shapes in the other order: of `b` with `a`.
    pub fn reversed(self) -> Self {
        let points = self.points.map(ContactPoint::reversed);
        Self { normal: -self.normal, distance: self.distance.reversed(), points, len: self.len }
    }

    /// Two unit vectors across the normal and each other, along which friction acts; in 2D the second is zero. They
    /// follow from the normal alone, so that impulses along them keep their meaning while bodies rest.
    #[must_use]
    pub fn tangents(&self) -> [V; 2] {
        axes_across(self.normal)
    }

    /// The points of the manifold: one to four, in 2D one or two.
    #[must_use]
    pub fn points(&self) -> &[ContactPoint<V>] {
        &self.points[..self.len]
    }
}

/// A point of a contact manifold: a point on the surface of each shape, both on one line along the normal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ContactPoint<V: Vector> {
    /// The point of `a`.
    pub point_a: V,
    /// The point of `b` before or behind it along the normal.
    pub point_b: V,
    /// How far `point_a` is before `point_b` along the normal; negative where the shapes overlap.
    pub signed_distance: V::Scalar,
    /// A bound on the error of the signed distance: the surfaces are not nearer to one another along this line than the
    /// signed distance less this. The points are on the surfaces to rounding, or to this error where a side is nearly
    /// along the normal. For polytopes it is rounding.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub error: V::Scalar,
    /// The vertex, edge or face of `a` that the point is on, as a number. It stays the same from frame to frame as long
    /// as the point is on the same feature, so that a solver can find its impulses of the last frame again.
    pub feature_a: u32,
    /// The vertex, edge or face of `b` that the point is on, in the same way.
    pub feature_b: u32,
}

impl<V: Vector> ContactPoint<V> {
    /// The points of both bodies in the frames of their unposed shapes, which stay the same as the bodies move on.
    #[must_use]
    pub fn anchors<A, B>(&self, a: &Posed<A>, b: &Posed<B>) -> [V; 2]
    where
        A: SupportMap<Vector = V>,
        B: SupportMap<Vector = V>,
    {
        let of_a = a.rotation().transpose_mul(self.point_a - a.translation());
        [of_a, b.rotation().transpose_mul(self.point_b - b.translation())]
    }

    /// The velocity of the point of `a` relative to that of `b`, for bodies that begin these motions now. Its part
    /// along the normal is negative if they approach.
    #[must_use]
    pub fn relative_velocity<A, B>(&self, motion_a: &A, motion_b: &B) -> V
    where
        A: Trajectory<Vector = V>,
        B: Trajectory<Vector = V>,
    {
        motion_a.velocity(Scalar::ZERO, self.point_a) - motion_b.velocity(Scalar::ZERO, self.point_b)
    }

    /// The point for the shapes in the other order.
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
