//! How deep a shape is in a body of a scene, and in which points they touch.

use convex_support::{ScalarOf, SupportMap};

use super::Body;
use crate::{Contact, SignedDistance, SignedDistanceOptions, contact, signed_distance};

impl<S: SupportMap> Body<S> {
    /// How far a shape, `a`, is from this body, `b`, or how deep in it, by
    /// [`signed_distance`](crate::signed_distance()) or, for a half-space, by
    /// [`HalfSpace::signed_distance`](crate::HalfSpace::signed_distance), which needs no options.
    pub fn signed_distance<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        options: SignedDistanceOptions<S::Vector>,
    ) -> SignedDistance<S::Vector> {
        match self {
            Self::Convex(body) => signed_distance(shape, body, options),
            Self::HalfSpace(half_space) => half_space.signed_distance(shape),
        }
    }

    /// The contact of a shape, `a`, with this body, `b`, by [`contact`](crate::contact()) or, for a half-space, by
    /// [`HalfSpace::contact`](crate::HalfSpace::contact), which needs no options; `None` if they are farther apart than
    /// `within`. [`Scene::contacts_of`](crate::Scene::contacts_of) asks all bodies that are near.
    pub fn contact<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        within: ScalarOf<S>,
        options: SignedDistanceOptions<S::Vector>,
    ) -> Option<Contact<S::Vector>> {
        match self {
            Self::Convex(body) => contact(shape, body, within, options),
            Self::HalfSpace(half_space) => half_space.contact(shape, within),
        }
    }
}
