//! The answers of a scene.

use alloc::vec::Vec;

use convex_support::{Scalar, Vector};

use super::instance::Id;
use crate::{Cast, Contact, Distance, Impact, MotionCast, RayHit, SignedDistance, Status};

/// What was done for an answer, and what was left out. It may be ignored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Work {
    /// Nodes of the tree that were tested; for pairs, pairs of nodes.
    pub nodes: usize,
    /// Bodies, or pairs, with a single query.
    pub tested: usize,
    /// Bodies, or pairs, without one.
    pub culled: usize,
    /// Whether the closure of [`Among::until`](crate::Among::until) ended the search early: the answer is then that of
    /// the bodies tested so far, and lower bounds are 0.
    pub cancelled: bool,
}

/// The first body hit by a ray or by a moving shape.
///
/// `H` is the hit of the single query, and `S` the scalar.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SceneCast<H, S: Scalar> {
    /// The first hit; `None` if every body is missed. Of bodies hit at the same λ or time, it is the one with the
    /// lowest index.
    #[doc(alias = "hit")]
    pub first: Option<BodyHit<H, S>>,
    /// No body is hit before this λ or time; infinite if all are missed.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub lower: S,
    /// The body that may be hit earliest, among those whose cast was [undecided](crate::Outcome::Undecided) and that
    /// may be hit before the first hit.
    pub undecided: Option<usize>,
    /// What was done and what was left out.
    pub work: Work,
}

impl<H, S: Scalar> Default for SceneCast<H, S> {
    /// That of an empty scene: all is missed.
    fn default() -> Self {
        Self { first: None, lower: S::infinity(), undecided: None, work: Work::default() }
    }
}

impl<H, S: Scalar> SceneCast<H, S> {
    /// Whether the outcome is certain. A hit is certain if its upper bound is finite and no body before it is
    /// undecided, a miss if no body is.
    #[must_use]
    pub fn is_certain(&self) -> bool {
        self.undecided.is_none() && !self.work.cancelled && self.first.as_ref().is_none_or(BodyHit::is_certain)
    }
}

/// The answer of [`Among::ray_cast`](crate::Among::ray_cast).
pub type SceneRayCast<V> = SceneCast<RayHit<V>, <V as Vector>::Scalar>;

/// The answer of [`Among::linear_cast`](crate::Among::linear_cast).
pub type SceneLinearCast<V> = SceneCast<Impact<V>, <V as Vector>::Scalar>;

/// The answer of [`Among::motion_cast`](crate::Among::motion_cast).
pub type SceneMotionCast<V> = SceneCast<Impact<V>, <V as Vector>::Scalar>;

/// The body that is hit, with the hit of its single query.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BodyHit<H, S: Scalar> {
    /// The index of the body.
    pub body: usize,
    /// The number of the member that it was, if the body is an instance of a [`Group`](crate::Group).
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub member: Option<usize>,
    /// The hit.
    pub hit: H,
    /// The lower end of its bracket.
    pub lower: S,
    /// The upper end of its bracket; infinite if it is not certain that the body is hit at all.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub upper: S,
    /// How the iteration ended.
    pub status: Status,
}

impl<H: Copy, S: Scalar> BodyHit<H, S> {
    pub(super) fn of<V: Vector<Scalar = S>>(Id { body, member }: Id, cast: &Cast<H, V>) -> Option<Self> {
        let &Cast { lower, upper, status, .. } = cast;
        cast.outcome.hit().map(|hit| Self { body, member, hit, lower, upper, status })
    }
}

impl<H, S: Scalar> BodyHit<H, S> {
    /// Whether the hit is certain: whether its upper bound is finite.
    #[must_use]
    pub fn is_certain(&self) -> bool {
        self.upper < S::infinity()
    }
}

/// The answer of [`Among::ray_cast_all`](crate::Among::ray_cast_all).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SceneHits {
    /// The lowest index of a body whose cast was undecided.
    pub undecided: Option<usize>,
    /// What was done and what was left out.
    pub work: Work,
}

/// The answer of [`Among::any_hit`](crate::Among::any_hit).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SceneAnyHit {
    /// Whether a body is hit.
    pub hit: bool,
    /// If no hit is certain, the lowest index of a body whose cast was undecided, or whose hit may be a miss.
    pub undecided: Option<usize>,
    /// What was done and what was left out. It depends on which of several bodies was tested first.
    pub work: Work,
}

impl SceneAnyHit {
    /// Whether the answer is certain: a hit is if the hit of one body is, and a miss if that of every body is.
    #[must_use]
    pub const fn is_certain(&self) -> bool {
        self.undecided.is_none() && !self.work.cancelled
    }
}

/// The answer of [`Among::nearest`](crate::Among::nearest).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct SceneDistance<V: Vector> {
    /// The nearest body; `None` if none is within the limit. Of bodies equally near, it is the one with the lowest
    /// index.
    pub nearest: Option<BodyDistance<V>>,
    /// No body is nearer than this: the least of the limit and of the lower ends of all brackets.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub lower: V::Scalar,
    /// What was done and what was left out.
    pub work: Work,
}

/// A body, and its distance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct BodyDistance<V: Vector> {
    /// The index of the body.
    pub body: usize,
    /// The number of the member that it was, if the body is an instance of a [`Group`](crate::Group).
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub member: Option<usize>,
    /// The distance from the shape, `a`, to the body, `b`.
    pub distance: Distance<V>,
}

/// The answer of [`Among::least_signed_distance`](crate::Among::least_signed_distance).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct SceneSignedDistance<V: Vector> {
    /// The body with the least signed distance; `None` if none is within the limit.
    pub least: Option<BodySignedDistance<V>>,
    /// No body has a smaller one: the least of the limit and of the lower ends of all brackets.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub lower: V::Scalar,
    /// What was done and what was left out.
    pub work: Work,
}

/// A body, and its signed distance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct BodySignedDistance<V: Vector> {
    /// The index of the body.
    pub body: usize,
    /// The number of the member that it was, if the body is an instance of a [`Group`](crate::Group).
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub member: Option<usize>,
    /// The signed distance of the shape, `a`, and the body, `b`.
    pub distance: SignedDistance<V>,
}

/// Two bodies, and their distance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct PairDistance<V: Vector> {
    /// The index of the first: the lower one, or that in the first scene.
    pub a: usize,
    /// The index of the second.
    pub b: usize,
    /// The number of the member that the first was, if it is an instance of a [`Group`](crate::Group).
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub member_a: Option<usize>,
    /// The same for the second.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub member_b: Option<usize>,
    /// The distance from the first to the second.
    pub distance: Distance<V>,
}

impl<V: Vector> PairDistance<V> {
    pub(super) fn of([a, b]: [Id; 2], distance: Distance<V>) -> Self {
        Self { a: a.body, b: b.body, member_a: a.member, member_b: b.member, distance }
    }
}

/// The answer of [`Among::nearest_between`](crate::Among::nearest_between) and
/// [`Among::least_pair`](crate::Among::least_pair).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct ScenePair<V: Vector> {
    /// The nearest pair; `None` if none is within the limit. Of pairs equally near, it is the one with the lowest first
    /// index, and of these the one with the lowest second index.
    pub nearest: Option<PairDistance<V>>,
    /// No pair is nearer than this: the least of the limit and of the lower ends of all brackets.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub lower: V::Scalar,
    /// What was done and what was left out.
    pub work: Work,
}

/// Whether anything is within a distance. `I` is the index of a body, or the indices of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SceneAnyWithin<I> {
    /// Whether any body or pair is.
    pub any: bool,
    /// If none is certainly within, the lowest of those whose bracket contains the distance.
    pub undecided: Option<I>,
    /// What was done and what was left out. It depends on which of several was tested first.
    pub work: Work,
}

impl<I> SceneAnyWithin<I> {
    /// Whether the answer is certain: that there is one, if the bracket of one says so, and that there is none, if the
    /// brackets of all do.
    #[must_use]
    pub const fn is_certain(&self) -> bool {
        self.undecided.is_none() && !self.work.cancelled
    }
}

/// The answer of [`Among::first_contact`](crate::Among::first_contact) and its kin.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct SceneFirstContact<V: Vector> {
    /// The pair that meets first; `None` if none does. Of pairs that meet at the same time, it is the one with the
    /// lowest first index, and of these the one with the lowest second index.
    pub first: Option<PairImpact<V>>,
    /// No pair meets before this time; infinite if none does.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub lower: V::Scalar,
    /// The pair that may meet earliest, among those whose cast was [undecided](crate::Outcome::Undecided); if the
    /// question is about the first contact alone, among those that may meet before it.
    pub undecided: Option<[usize; 2]>,
    /// What was done and what was left out.
    pub work: Work,
}

/// Two bodies that move, and their first contact.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct PairImpact<V: Vector> {
    /// The index of the first: the lower one, or that in the first scene.
    pub a: usize,
    /// The index of the second.
    pub b: usize,
    /// The number of the member that the first was, if it is an instance of a [`Group`](crate::Group).
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub member_a: Option<usize>,
    /// The same for the second.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub member_b: Option<usize>,
    /// The first contact, with the normal out of the second. With a target distance the point is one of the second, or
    /// of the half-space if one of them is.
    pub impact: Impact<V>,
    /// The lower end of the bracket of its time.
    pub lower: V::Scalar,
    /// The upper end; infinite if it is not certain that they meet at all.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub upper: V::Scalar,
    /// How the iteration ended.
    pub status: Status,
}

impl<V: Vector> PairImpact<V> {
    pub(super) fn of([a, b]: [Id; 2], cast: &MotionCast<V>) -> Option<Self> {
        let (&Cast { outcome, lower, upper, status, .. }, [member_a, member_b]) = (cast, [a.member, b.member]);
        outcome.hit().map(|impact| Self { a: a.body, b: b.body, member_a, member_b, impact, lower, upper, status })
    }
}

/// A body, and its contact with a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct BodyContact<V: Vector> {
    /// The index of the body.
    pub body: usize,
    /// The number of the member that it was, if the body is an instance of a [`Group`](crate::Group).
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub member: Option<usize>,
    /// The contact of the shape, `a`, with the body, `b`.
    pub contact: Contact<V>,
}

impl<V: Vector> BodyContact<V> {
    pub(super) fn id(&self) -> Id {
        Id { body: self.body, member: self.member }
    }
}

/// Two bodies, and their contact.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct PairContact<V: Vector> {
    /// The index of the first: the lower one, or that in the first scene.
    pub a: usize,
    /// The index of the second.
    pub b: usize,
    /// The number of the member that the first was, if it is an instance of a [`Group`](crate::Group).
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub member_a: Option<usize>,
    /// The same for the second.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub member_b: Option<usize>,
    /// The contact of the first with the second.
    pub contact: Contact<V>,
}

impl<V: Vector> PairContact<V> {
    pub(super) fn of([a, b]: [Id; 2], contact: Contact<V>) -> Self {
        Self { a: a.body, b: b.body, member_a: a.member, member_b: b.member, contact }
    }
}

/// Empties a list of the caller and keeps its memory.
pub(super) fn reuse<T>(list: &mut Vec<T>) -> &mut Vec<T> {
    list.clear();
    list
}

/// An element of a list of pairs.
pub(super) trait OfPair {
    fn ids(&self) -> [Id; 2];
}

macro_rules! of_pair {
    ($($name:ident),*) => {$(
        impl<V: Vector> OfPair for $name<V> {
            fn ids(&self) -> [Id; 2] {
                [Id { body: self.a, member: self.member_a }, Id { body: self.b, member: self.member_b }]
            }
        }
    )*};
}
of_pair!(PairDistance, PairImpact, PairContact);
