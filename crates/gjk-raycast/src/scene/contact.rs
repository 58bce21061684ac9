//! How deep a shape is in a body of a scene, and in which points they touch.

use convex_support::{ScalarOf, SupportMap};

use super::Body;
use crate::{Contact, SignedDistance, SignedDistanceOptions, contact, signed_distance};

impl<S: SupportMap> Body<S> {
    /// How far a shape, `a`, is from this body, `b`, or how deep in it, by [`signed_distance`](crate::signed_distance()) or, for a
    /// half-space, by [`HalfSpace::signed_distance`](crate::HalfSpace::signed_distance), which needs no options.
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
    /// [`HalfSpace::contact`](crate::HalfSpace::contact), which needs no options; `None` if they are farther apart than `within`.
    ///
    /// ```
    /// use convex_support::{Ball, Cuboid, Posed, glam::DVec3};
    /// use gjk_raycast::{DistanceOptions, HalfSpace, Scene, SignedDistanceOptions};
    ///
    /// // A ball rests on the floor in front of a box. What does it touch, and which way out?
    /// let wall = Posed::translated(Cuboid::new(DVec3::ONE)?, DVec3::new(2.0, 1.0, 0.0))?;
    /// let mut scene = Scene::new([wall])?;
    /// scene.insert_half_space(HalfSpace::new(DVec3::Y, 0.0)?);
    /// let ball = Posed::translated(Ball::new(0.5)?, DVec3::new(0.5, 0.5, 0.0))?;
    ///
    /// let (mut near, mut normals) = (Vec::new(), Vec::new());
    /// let _ = scene.all_within(&ball, 0.01, DistanceOptions::default(), &mut near);
    /// for found in near {
    ///     let body = scene.get(found.body).ok_or("it was just found")?;
    ///     let contact = body.contact(&ball, 0.01, SignedDistanceOptions::default());
    ///     normals.push(contact.ok_or("it is near")?.normal);
    /// }
    /// assert_eq!(normals, [DVec3::NEG_X, DVec3::Y]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
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
