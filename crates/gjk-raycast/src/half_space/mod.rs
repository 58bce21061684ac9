//! Half-spaces: infinite floors and walls.
//!
//! A half-space has no support points, since it has no farthest point along most directions. But the point of a shape
//! that is nearest to it, or deepest in it, is the support point of the shape along `−n`. So its queries are closed
//! forms of the [height](plane) of this point and the speed at which it sinks.

mod plane;
mod straight_casts;

use convex_support::{InvalidShape, Scalar, SupportMap, Vector};
use num_traits::Float;

use crate::contact::manifold_over_plane;
use crate::{Contact, Distance, SignedDistance};

pub(crate) use self::plane::{Lowest, Plane};

/// The points x with n·x ≤ offset: everything on one side of a plane.
///
/// It is no [`SupportMap`](convex_support::SupportMap), as it is unbounded, and has its own queries:
/// [`ray_cast`](Self::ray_cast), [`linear_cast`](Self::linear_cast), [`motion_cast`](Self::motion_cast),
/// [`distance_from`](Self::distance_from), [`signed_distance`](Self::signed_distance) and [`contact`](Self::contact).
/// It can be a body of a [`Scene`](crate::Scene).
#[doc(alias("plane", "floor", "ground"))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace<V: Vector> {
    normal: V,
    offset: V::Scalar,
    pub(crate) length: V::Scalar,
}

impl<V: Vector> HalfSpace<V> {
    /// The half-space of the points x with `normal·x ≤ offset`. The normal points out of it and need not be of unit
    /// length.
    ///
    /// # Errors
    /// [`InvalidShape::NonFinite`] if a number is not finite, [`InvalidShape::NoDirection`] if the normal is zero or so
    /// long or short that its length is not a number of full precision.
    pub fn new(normal: V, offset: V::Scalar) -> Result<Self, InvalidShape> {
        if let Some(index) = (0..V::DIM).find(|&i| !normal.get(i).is_finite()) {
            return Err(InvalidShape::NonFinite { parameter: "normal", index });
        }
        if !offset.is_finite() {
            return Err(InvalidShape::NonFinite { parameter: "offset", index: 0 });
        }
        let length = normal.norm();
        if !(length >= V::Scalar::min_positive_value() / V::Scalar::EPSILON && length.is_finite()) {
            return Err(InvalidShape::NoDirection { parameter: "normal" });
        }
        Ok(Self { normal, offset, length })
    }

    /// The normal as it was given.
    #[must_use]
    pub fn normal(&self) -> V {
        self.normal
    }

    /// The offset as it was given.
    #[must_use]
    pub fn offset(&self) -> V::Scalar {
        self.offset
    }

    pub(crate) fn plane(&self) -> Plane<V> {
        Plane::new(self.normal, self.offset, self.length)
    }

    /// The distance of a shape, `a`, from the half-space, `b`, or minus its depth if it overlaps.
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
    /// It is the height of the shape's lowest point. Its error is a few roundings of the height itself, and the
    /// [rounding](SupportMap::rounding) of the shape, however far along the plane the shape is.
    pub fn signed_distance<A: SupportMap<Vector = V> + ?Sized>(&self, shape: &A) -> SignedDistance<V> {
        let plane = self.plane();
        plane.lowest(shape, Scalar::ZERO).signed_distance(plane.unit)
    }

    /// The distance from a shape, `a`, to the half-space, `b`; 0 if they overlap, where
    /// [`signed_distance`](Self::signed_distance) finds the depth.
    pub fn distance_from<A: SupportMap<Vector = V> + ?Sized>(&self, shape: &A) -> Distance<V> {
        let plane = self.plane();
        plane.lowest(shape, Scalar::ZERO).distance(plane.unit)
    }

    /// The contact of a shape, `a`, with the half-space, `b`; `None` if the shape is farther than `within` from it.
    ///
    /// ```
    /// use convex_support::{Cuboid, Posed, glam::DVec3};
    /// use gjk_raycast::HalfSpace;
    ///
    /// // A box of half extent 0.5 stands on the floor.
    /// let floor = HalfSpace::new(DVec3::Y, 0.0)?;
    /// let parcel = Posed::translated(Cuboid::new(DVec3::splat(0.5))?, DVec3::new(5.0, 0.5, 0.0))?;
    /// let contact = floor.contact(&parcel, 0.01).expect("they touch");
    /// assert_eq!(contact.normal, DVec3::Y);
    /// assert_eq!(contact.points().len(), 4);
    /// assert!(contact.points().iter().all(|p| p.point_b.y == 0.0 && p.signed_distance == 0.0));
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    ///
    /// The points are corners of the shape's feature that faces the half-space. If there are more than four, in 2D two,
    /// they are those that span the feature best.
    pub fn contact<A: SupportMap<Vector = V> + ?Sized>(&self, shape: &A, within: V::Scalar) -> Option<Contact<V>> {
        self.contact_of(shape, within, None)
    }

    /// [`contact`](Self::contact) of a shape that was in contact before. It keeps those points of the `last` contact
    /// that are still valid, as [`contact_after`](crate::contact_after) does.
    pub fn contact_after<A: SupportMap<Vector = V> + ?Sized>(
        &self,
        last: &Contact<V>,
        shape: &A,
        within: V::Scalar,
    ) -> Option<Contact<V>> {
        self.contact_of(shape, within, Some(last))
    }

    /// `contact_after`, if there was a contact before.
    pub(crate) fn contact_of<A: SupportMap<Vector = V> + ?Sized>(
        &self,
        shape: &A,
        within: V::Scalar,
        last: Option<&Contact<V>>,
    ) -> Option<Contact<V>> {
        let answer = self.signed_distance(shape);
        // NaN is farther than anything.
        if !(answer.signed_distance <= within) {
            return None;
        }
        Some(manifold_over_plane(shape, &answer, within, last.map_or(&[], Contact::points)))
    }
}
