//! How far a shape is from a half-space, or how deep in it.

use convex_support::{SupportMap, Vector};
use num_traits::Float as _;

use super::HalfSpace;
use super::plane::Lowest;
use crate::{Distance, SignedDistance, Status};

impl<V: Vector> HalfSpace<V> {
    /// How far a shape, `a`, is from the half-space, `b`, or how deep in it.
    ///
    /// ```
    /// use convex_support::{Cuboid, Posed, glam::DVec3};
    /// use gjk_raycast::HalfSpace;
    ///
    /// // A box of half extent 0.5 has sunk 0.1 into the floor.
    /// let floor = HalfSpace::new(DVec3::Y, 0.0)?;
    /// let parcel = Posed::translated(Cuboid::new(DVec3::splat(0.5))?, DVec3::new(3.0, 0.4, 0.0))?;
    /// let answer = floor.signed_distance(&parcel);
    /// assert!((answer.signed_distance + 0.1).abs() < 1e-15);
    /// assert!(answer.lower <= answer.signed_distance && answer.signed_distance <= answer.upper);
    /// assert_eq!(answer.normal, DVec3::Y); // the parcel leaves upwards
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    ///
    /// It is the height of the shape's lowest point. Its error is a few roundings of the height itself, and what the
    /// shape says of its [rounding](SupportMap::rounding), however far along the plane the shape is.
    pub fn signed_distance<A: SupportMap<Vector = V> + ?Sized>(&self, shape: &A) -> SignedDistance<V> {
        let plane = self.plane();
        let Lowest { height, point } = plane.lowest(shape, V::Scalar::default());
        let is_known = height.value.is_finite() && height.error.is_finite();
        let infinity = V::Scalar::infinity();
        SignedDistance {
            signed_distance: height.value,
            lower: if is_known { height.least() } else { -infinity },
            upper: if is_known { height.most() } else { infinity },
            normal: plane.unit,
            point_a: point,
            point_b: point - plane.unit * height.value,
            overlap: height.value <= V::Scalar::default(),
            status: if is_known { Status::Converged } else { Status::Stalled },
            iterations: 1,
            unexpanded: 0,
        }
    }

    /// The distance from a shape, `a`, to the half-space, `b`; 0 if it reaches into the half-space, where
    /// [`signed_distance`](Self::signed_distance) tells how deep.
    pub fn distance_from<A: SupportMap<Vector = V> + ?Sized>(&self, shape: &A) -> Distance<V> {
        let zero = V::Scalar::default();
        let SignedDistance { signed_distance, lower, upper, normal, point_a, point_b, status, iterations, .. } =
            self.signed_distance(shape);
        let overlap = !(signed_distance > zero);
        Distance {
            distance: signed_distance.max(zero),
            lower: lower.max(zero),
            upper: upper.max(zero),
            overlap,
            point_a,
            point_b: if overlap { point_a } else { point_b },
            normal: (!overlap).then_some(normal),
            status,
            iterations,
        }
    }

    /// The distance from the half-space, `a`, to a shape, `b`.
    pub(crate) fn distance_to<B: SupportMap<Vector = V> + ?Sized>(&self, shape: &B) -> Distance<V> {
        self.distance_from(shape).reversed()
    }
}
