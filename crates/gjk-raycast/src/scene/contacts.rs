//! The contacts of a shape with the bodies of a scene, and of these with each other; and those at
//! seams, where bodies form one surface together.

use alloc::vec::Vec;

use convex_support::{Point, Scalar, ScalarOf, SupportMap, Vector};
use num_traits::Float as _;

use super::among::Among;
use super::answers::{BodyContact, OfPair, PairContact, Work, reuse};
use super::asked::asked;
use super::instance::Id;
use super::pairs::{AskPair, Pairing};
use super::{Body, Scene};
use crate::contact::contact_of;
use crate::{Contact, SignedDistanceOptions, signed_distance};

impl<S: SupportMap> Among<'_, S> {
    /// Finds the [contacts](Body::contact) of the shape, `a`, with all bodies, `b`, that are no farther than `within`
    /// from it. Writes them into `contacts`, which is emptied first, in the order of their indices.
    ///
    /// ```
    /// use convex_support::{Ball, Cuboid, Posed, glam::DVec3};
    /// use gjk_raycast::{HalfSpace, Scene, SignedDistanceOptions};
    ///
    /// // A ball rests on the floor in front of a box. What does it touch, and which way out?
    /// let wall = Posed::translated(Cuboid::new(DVec3::ONE)?, DVec3::new(2.0, 1.0, 0.0))?;
    /// let mut scene = Scene::new([wall])?;
    /// scene.insert_half_space(HalfSpace::new(DVec3::Y, 0.0)?);
    /// let ball = Posed::translated(Ball::new(0.5)?, DVec3::new(0.5, 0.5, 0.0))?;
    ///
    /// let mut contacts = Vec::new();
    /// scene.all().contacts_of(&ball, 0.01, SignedDistanceOptions::default(), &mut contacts);
    /// let normals: Vec<_> = contacts.iter().map(|found| (found.body, found.contact.normal)).collect();
    /// assert_eq!(normals, [(0, DVec3::NEG_X), (1, DVec3::Y)]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn contacts_of<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        within: ScalarOf<S>,
        options: SignedDistanceOptions<S::Vector>,
        contacts: &mut Vec<BodyContact<S::Vector>>,
    ) -> Work {
        let work = self.near(shape, of_boxes(within), reuse(contacts), |Id { body: index, member }, body| {
            let contact = asked!(body, body => body.contact(shape, within, options))?;
            Some(BodyContact { body: index, member, contact })
        });
        contacts.sort_unstable_by_key(|found| (found.body, found.member));
        work
    }

    /// Finds the [contacts](crate::contact()) of all pairs of bodies that are no farther than `within` from each other:
    /// all that a step of a simulation has to resolve. Writes them into `contacts`, which is emptied first, in the
    /// order of their indices. Half-spaces make no contacts with each other.
    ///
    /// ```
    /// use convex_support::{Cuboid, Posed, glam::DVec3};
    /// use gjk_raycast::{HalfSpace, Scene, SignedDistanceOptions};
    ///
    /// // Two boxes are stacked on the floor, and a third one flies.
    /// let crate_at = |y| Posed::translated(Cuboid::new(DVec3::splat(0.5))?, DVec3::new(0.0, y, 0.0));
    /// let mut scene = Scene::new([crate_at(0.5)?, crate_at(1.5)?, crate_at(4.0)?])?;
    /// let floor = scene.insert_half_space(HalfSpace::new(DVec3::Y, 0.0)?);
    ///
    /// let mut contacts = Vec::new();
    /// let work = scene.all().contacts_within(0.01, SignedDistanceOptions::default(), &mut contacts);
    /// assert_eq!(contacts.iter().map(|found| (found.a, found.b)).collect::<Vec<_>>(), [(0, 1), (0, floor)]);
    /// assert!(contacts.iter().all(|found| found.contact.points().len() == 4));
    /// assert_eq!((work.tested, work.culled), (2, 4));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn contacts_within(
        &self,
        within: ScalarOf<S>,
        options: SignedDistanceOptions<S::Vector>,
        contacts: &mut Vec<PairContact<S::Vector>>,
    ) -> Work {
        Pairing::within(*self).find(&ContactWithin { within, options, last: self.last }, contacts)
    }

    /// Finds the contacts of all pairs of a body of this scene, `a`, and one of another, `b`, that are no farther than
    /// `within` from each other.
    pub fn contacts_between<T: SupportMap<Vector = S::Vector>>(
        &self,
        other: &Scene<T>,
        within: ScalarOf<S>,
        options: SignedDistanceOptions<S::Vector>,
        contacts: &mut Vec<PairContact<S::Vector>>,
    ) -> Work {
        Pairing::between(*self, other).find(&ContactWithin { within, options, last: self.last }, contacts)
    }

    /// [`contacts_within`](Self::contacts_within) on all threads of the current [rayon](https://docs.rs/rayon) pool,
    /// with the same contacts to the last bit. The nodes of the [`Work`] are those of the pieces that the search is cut
    /// into.
    #[cfg(feature = "rayon")]
    pub fn par_contacts_within(
        &self,
        within: ScalarOf<S>,
        options: SignedDistanceOptions<S::Vector>,
        contacts: &mut Vec<PairContact<S::Vector>>,
    ) -> Work
    where
        S: Sync,
    {
        Pairing::within(*self).par_find(&ContactWithin { within, options, last: self.last }, contacts)
    }
}

/// The limit for the distance of boxes. Boxes have no depth, so that a negative `within` becomes zero.
fn of_boxes<N: Scalar>(within: N) -> N {
    within.max(N::ZERO)
}

/// The query for the contact of two bodies, if they are no farther than `within` from each other.
struct ContactWithin<'l, V: Vector> {
    within: V::Scalar,
    options: SignedDistanceOptions<V>,
    /// The contacts of the last step.
    last: &'l [PairContact<V>],
}

impl<V: Vector> AskPair<V> for ContactWithin<'_, V> {
    type Answer = PairContact<V>;

    fn within(&self) -> V::Scalar {
        of_boxes(self.within)
    }

    fn ask<S: SupportMap<Vector = V>, T: SupportMap<Vector = V>>(
        &self,
        pair: [Id; 2],
        a: &Body<S>,
        b: &Body<T>,
    ) -> Option<PairContact<V>> {
        let &Self { within, options, last } = self;
        let last = last.binary_search_by_key(&pair, OfPair::ids).ok().map(|found| &last[found].contact);
        let contact = match (a, b) {
            (Body::Convex(a), Body::Convex(b)) => contact_of(a, b, within, options, last)?,
            (Body::Convex(a), Body::HalfSpace(b)) => b.contact_of(a, within, last)?,
            (Body::HalfSpace(a), Body::Convex(b)) => {
                a.contact_of(b, within, last.map(|last| last.reversed()).as_ref())?.reversed()
            }
            (Body::HalfSpace(_), Body::HalfSpace(_)) => return None,
        };
        Some(PairContact::of(pair, contact))
    }
}

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
        leave_out(contacts, |contacts, found| {
            let others = || contacts.iter().map(BodyContact::id).filter(|&other| other != found.id());
            self.is_at_seam(&found.contact, others)
        })
    }

    /// The same for the contacts of [all pairs](crate::Among::contacts_within), where either body may be one of the
    /// pieces. A contact is removed if all of its points are at seams of one of its bodies with others that touch the
    /// other one.
    pub fn leave_out_seams_of_pairs(&self, contacts: &mut Vec<PairContact<S::Vector>>) -> usize {
        leave_out(contacts, |contacts, pair| {
            let ([a, b], contact) = (pair.ids(), pair.contact);
            [(a, b, contact), (b, a, contact.reversed())].into_iter().any(|(moving, piece, contact)| {
                let touching = |found: &PairContact<_>| match found.ids() {
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
        leave_out(contacts, |contacts, pair| {
            let ([a, b], contact) = (pair.ids(), pair.contact);
            let all = || contacts.iter().map(OfPair::ids);
            let beside_a = || all().filter(|found| found[1] == b && found[0] != a).map(|found| found[0]);
            let beside_b = || all().filter(|found| found[0] == a && found[1] != b).map(|found| found[1]);
            other.is_at_seam(&contact, beside_b) || self.is_at_seam(&contact.reversed(), beside_a)
        })
    }

    /// Whether one of the others covers each point of a contact on its second body.
    fn is_at_seam<I: Iterator<Item = Id>>(&self, contact: &Contact<S::Vector>, others: impl Fn() -> I) -> bool {
        let covers = |point, other| self.reaches_beyond(other, point, contact.normal);
        contact.points().iter().all(|point| others().any(|other| covers(point.point_b, other)))
    }

    /// Whether a point is one of a convex body, to the root of rounding, and the body extends beyond it along a unit
    /// vector.
    fn reaches_beyond(&self, Id { body, member }: Id, point: S::Vector, normal: S::Vector) -> bool {
        match member {
            None => self.get(body).and_then(Body::convex).is_some_and(|body| reaches_beyond(body, point, normal)),
            Some(member) => self.member(body, member).is_some_and(|body| reaches_beyond(&body, point, normal)),
        }
    }
}

fn reaches_beyond<S: SupportMap>(body: &S, point: S::Vector, normal: S::Vector) -> bool {
    let core = body.core();
    let rounding = core.size() * ScalarOf::<S>::EPSILON.sqrt();
    let Ok(at) = Point::new(point) else { return false };
    normal.dot(body.support(normal) - point) > rounding
        && signed_distance(&at, body, SignedDistanceOptions::default().with_limit(rounding)).signed_distance <= rounding
}

/// Removes contacts one by one, each tested against the remaining ones, and returns their number.
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
