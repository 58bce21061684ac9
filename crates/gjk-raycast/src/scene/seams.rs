//! Contacts at seams, where bodies of a scene form one surface together.

use alloc::vec::Vec;

use convex_support::{Point, Scalar as _, SupportMap, Vector as _};
use num_traits::Float as _;

use super::Scene;
use super::result::{BodyContact, PairContact};
use crate::{Contact, SignedDistanceOptions, signed_distance};

impl<S: SupportMap> Scene<S> {
    /// Removes the contacts at seams from the [contacts of a shape](crate::Among::contacts_of), and returns their
    /// number. If a floor is made of boxes or triangles, a body that slides over it meets the edges and sides at which
    /// these lie on one another, and would be stopped or thrown up by them.
    ///
    /// A point of a contact is at a seam if it is a point of another body too, which extends beyond it along the
    /// normal: no surface of the two together faces that way. If all points of a contact are at seams with bodies whose
    /// contacts are in the list, it is removed. Edges that stand out, at the end of a floor or of a step, are not at
    /// seams.
    ///
    /// ```
    /// use convex_support::{Ball, Cuboid, Posed, glam::DVec3};
    /// use gjk_raycast::{Scene, SignedDistanceOptions};
    ///
    /// // A floor of tiles two units wide, and a ball that has sunk into it beside a seam.
    /// let tile = |x| Posed::translated(Cuboid::new(DVec3::ONE)?, DVec3::new(x, -1.0, 0.0));
    /// let floor = Scene::new([tile(-1.0)?, tile(1.0)?])?;
    /// let ball = Posed::translated(Ball::new(0.5)?, DVec3::new(-0.05, 0.49, 0.0))?;
    ///
    /// let mut contacts = Vec::new();
    /// floor.all().contacts_of(&ball, 0.0, SignedDistanceOptions::default(), &mut contacts);
    /// assert!(contacts[1].contact.normal.x < -0.09, "the edge of the next tile pushes back");
    /// assert_eq!(floor.leave_out_seams(&mut contacts), 1);
    /// assert_eq!((contacts.len(), contacts[0].contact.normal), (1, DVec3::Y));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn leave_out_seams(&self, contacts: &mut Vec<BodyContact<S::Vector>>) -> usize {
        leave_out(contacts, |contacts, &BodyContact { body, contact }| {
            let others = || contacts.iter().map(|found| found.body).filter(|&other| other != body);
            self.is_at_seam(&contact, others)
        })
    }

    /// The same for the contacts of [all pairs](crate::Among::contacts_within), where either body may be one of the
    /// pieces. A contact is removed if all of its points are at seams of one of its bodies with others that touch the
    /// other one.
    pub fn leave_out_seams_of_pairs(&self, contacts: &mut Vec<PairContact<S::Vector>>) -> usize {
        leave_out(contacts, |contacts, &PairContact { a, b, contact }| {
            [(a, b, contact), (b, a, contact.reversed())].into_iter().any(|(moving, piece, contact)| {
                let touching = |found: &PairContact<_>| match [found.a, found.b] {
                    [other, it] | [it, other] if it == moving && other != piece => Some(other),
                    _ => None,
                };
                self.is_at_seam(&contact, || contacts.iter().filter_map(touching))
            })
        })
    }

    /// The same for the [contacts of this scene and another](crate::Among::contacts_between), where either may be made
    /// of pieces.
    pub fn leave_out_seams_between<T: SupportMap<Vector = S::Vector>>(
        &self,
        other: &Scene<T>,
        contacts: &mut Vec<PairContact<S::Vector>>,
    ) -> usize {
        leave_out(contacts, |contacts, &PairContact { a, b, contact }| {
            let beside_a = || contacts.iter().filter(|found| found.b == b && found.a != a).map(|found| found.a);
            let beside_b = || contacts.iter().filter(|found| found.a == a && found.b != b).map(|found| found.b);
            other.is_at_seam(&contact, beside_b) || self.is_at_seam(&contact.reversed(), beside_a)
        })
    }

    /// Whether all points of a contact, on its second body, are covered by one of the others.
    fn is_at_seam<I: Iterator<Item = usize>>(&self, contact: &Contact<S::Vector>, others: impl Fn() -> I) -> bool {
        let covers = |point, other| self.reaches_beyond(other, point, contact.normal);
        contact.points().iter().all(|point| others().any(|other| covers(point.point_b, other)))
    }

    /// Whether a point is one of a convex body, but for the root of rounding, and the body extends beyond it along a
    /// unit vector.
    fn reaches_beyond(&self, body: usize, point: S::Vector, normal: S::Vector) -> bool {
        let Some(body) = self.get(body).and_then(|body| body.convex()) else { return false };
        let core = body.core();
        let rounding = core.size() * convex_support::ScalarOf::<S>::EPSILON.sqrt();
        let Ok(at) = Point::new(point) else { return false };
        normal.dot(body.support(normal) - point) > rounding
            && signed_distance(&at, body, SignedDistanceOptions::default().with_limit(rounding)).signed_distance
                <= rounding
    }
}

/// Removes contacts one after the other, each by the remaining ones, and returns their number.
fn leave_out<C>(contacts: &mut Vec<C>, is_left_out: impl Fn(&[C], &C) -> bool) -> usize {
    let before = contacts.len();
    let mut i = 0;
    while let Some(contact) = contacts.get(i) {
        if is_left_out(contacts, contact) {
            contacts.remove(i);
        } else {
            i += 1;
        }
    }
    before - contacts.len()
}
