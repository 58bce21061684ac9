//! The contact of a shape and a half-space.

use convex_support::{SupportMap, Vector};

use super::HalfSpace;
use crate::Contact;
use crate::contact::manifold_over_plane;

impl<V: Vector> HalfSpace<V> {
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

    /// [`contact`](Self::contact) of a shape that was in contact before: of the points of the `last` contact those are
    /// kept that still hold, as by [`contact_after`](crate::contact_after).
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
