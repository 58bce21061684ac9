//! What a motion cast answers.

use convex_support::Vector;
use num_traits::Float as _;

use crate::{Outcome, Status};

/// The answer of [`motion_cast`](crate::motion_cast).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "V: serde::Serialize, V::Scalar: serde::Serialize")))]
#[cfg_attr(
    feature = "serde",
    serde(bound(deserialize = "V: serde::Deserialize<'de>, V::Scalar: serde::Deserialize<'de>"))
)]
pub struct MotionCast<V: Vector> {
    /// Hit, miss, or undecided. A miss is proved over the whole motion; its axis, from `b` to `a`, is the normal of the
    /// last separating plane.
    pub outcome: Outcome<MotionHit<V>, V>,
    /// The bodies have no point in common before this time. For a miss it is the end of the motion. Where bodies may
    /// [begin in contact](crate::StartInContact::IfDeeper), nothing that counts as a hit happens before.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub lower: V::Scalar,
    /// The bodies have a point in common at this time, though it need not be their first, or have had one before, if
    /// they have no inside and have passed through one another; infinite where no such time is known. Where bodies may
    /// [begin in contact](crate::StartInContact::IfDeeper), they have got deeper, or touched again, by then.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub upper: V::Scalar,
    /// How the search ended.
    pub status: Status,
    /// The number of support points computed of each shape, for all times that were looked at.
    pub iterations: usize,
}

impl<V: Vector> MotionCast<V> {
    /// Whether the outcome is certain: a hit is where the upper bound is finite, and a miss always.
    #[must_use]
    pub fn is_certain(&self) -> bool {
        self.outcome.is_certain(self.upper < V::Scalar::infinity())
    }
}

/// The first contact of two moving bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MotionHit<V: Vector> {
    /// The time of first contact; 0 where the bodies overlap at the start, unless only what
    /// [goes deeper](crate::StartInContact::IfDeeper) counts.
    pub time: V::Scalar,
    /// A point of contact, in the world, at that time: a point of `b`, if a target distance was asked for; where the
    /// bodies overlap at the start, a point in both but for rounding, as of [`distance`](crate::distance).
    pub point: V,
    /// The unit normal of contact, out of `b` towards `a`; `None` where the bodies overlap at the start. With
    /// [`StartInContact::IfDeeper`](crate::StartInContact::IfDeeper), it is the shortest way out.
    pub normal: Option<V>,
}

/// What an observer of a motion cast is shown of every time that is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionIterate<V: Vector> {
    /// Counts from 0.
    pub iteration: usize,
    /// The time looked at.
    pub time: V::Scalar,
    /// By how much a plane certainly separates the bodies then; not positive where none is known.
    pub gap: V::Scalar,
    /// The unit normal of that plane, from `b` to `a`.
    pub normal: V,
    /// The bodies have no point in common up to this time.
    pub lower: V::Scalar,
    /// The bodies have a point in common at this time; infinite where none is known.
    pub upper: V::Scalar,
}
