//! The outcome of a cast: a hit, a miss, or neither; or why it was refused.

use core::error::Error;
use core::fmt::{self, Display, Formatter};

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::{Status, WarmStart};

/// How a cast ended: with a hit, with a miss, or with neither.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Outcome<H, V> {
    /// A hit. It is certain if the upper bound of the answer is finite; otherwise the status is not
    /// [`Status::Converged`].
    Hit(H),
    /// A miss, which is certain: a plane proves it.
    Miss(Miss<V>),
    /// The iteration ended, for the reason given by the status, before a hit or a miss was certain. Nothing is hit
    /// before the lower bound of the answer. So if a program has to choose, it is safe to take the lower bound for the
    /// hit.
    Undecided,
}

impl<H, V> Outcome<H, V> {
    /// The hit, if there is one.
    #[must_use]
    pub fn hit(self) -> Option<H> {
        match self {
            Self::Hit(hit) => Some(hit),
            Self::Miss(_) | Self::Undecided => None,
        }
    }

    pub(crate) fn map<G>(self, of: impl FnOnce(H) -> G) -> Outcome<G, V> {
        match self {
            Self::Hit(hit) => Outcome::Hit(of(hit)),
            Self::Miss(miss) => Outcome::Miss(miss),
            Self::Undecided => Outcome::Undecided,
        }
    }

    /// Whether this is a hit.
    #[must_use]
    pub const fn is_hit(&self) -> bool {
        matches!(self, Self::Hit(_))
    }

    /// Whether this is certain: every miss is, and a hit with an upper bound.
    pub(crate) const fn is_certain(&self, is_bounded: bool) -> bool {
        match self {
            Self::Hit(_) => is_bounded,
            Self::Miss(_) => true,
            Self::Undecided => false,
        }
    }

    /// Ends a cast of which no plane proves that it ends before the hit, and returns the upper bound that is left.
    /// Where the hit may be after the end, by rounding, it has none, so that neither a hit nor a miss is certain; and
    /// where the `time` of the hit is after the end, or no number, it is no hit.
    pub(crate) fn until<S: Scalar>(&mut self, end: S, upper: S, time: impl FnOnce(&H) -> S) -> S {
        if let Self::Hit(hit) = self {
            let time = time(hit);
            if !(time <= end && time.is_finite()) {
                *self = Self::Undecided;
            }
        }
        if upper <= end { upper } else { S::infinity() }
    }

    /// Whether neither a hit nor a miss is certain.
    #[must_use]
    pub const fn is_undecided(&self) -> bool {
        matches!(self, Self::Undecided)
    }

    /// Whether this is a certain miss.
    #[must_use]
    pub const fn is_miss(&self) -> bool {
        matches!(self, Self::Miss(_))
    }
}

impl<H, V: Vector> Outcome<H, V> {
    /// The warm start for the next frame, from this outcome and the warm start of this frame.
    pub(crate) fn warm_start(
        &self,
        before: Option<WarmStart<V>>,
        normal: impl FnOnce(&H) -> Option<V>,
    ) -> Option<WarmStart<V>> {
        match self {
            Self::Hit(hit) => normal(hit).map(|normal| WarmStart::after(before, normal)).or(before),
            Self::Miss(miss) => Some(WarmStart::new(miss.axis)),
            Self::Undecided => before,
        }
    }
}

impl Status {
    /// The status of an outcome: a search that converged to a hit without an upper bound has stalled.
    pub(crate) fn of<H, V>(self, outcome: &Outcome<H, V>, is_bounded: bool) -> Self {
        if !outcome.is_certain(is_bounded) && self == Self::Converged { Self::Stalled } else { self }
    }
}

/// Why a cast misses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Miss<V> {
    /// A unit vector along which a plane separates the shape from the whole ray (up to its end, if it has one),
    /// pointing from the shape to the ray; a good [first axis](crate::WarmStart::new) for a similar query.
    ///
    /// Its components are rounded, so that at a distance `L` along the ray the plane is off by `L` times half an ulp.
    /// In `f32`, a point of the ray at a distance of a million sizes from the shape may be on the wrong side of the
    /// plane.
    pub axis: V,
}

/// The answer of [`ray_cast`](crate::ray_cast), [`linear_cast`](crate::linear_cast) or
/// [`motion_cast`](crate::motion_cast). Its *time* is the parameter of the ray or of the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "H: serde::Serialize, V: crate::data::VectorData")))]
#[cfg_attr(feature = "serde", serde(bound(deserialize = "H: serde::Deserialize<'de>, V: crate::data::VectorData")))]
pub struct Cast<H, V: Vector> {
    /// Hit, miss, or undecided. The axis of a miss of two bodies points from `b` to `a`. For a motion that turns it is
    /// the normal of the last separating plane.
    pub outcome: Outcome<H, V>,
    /// The bodies, or the ray and its target, have no point in common before this time. For a miss it is infinite, or
    /// the end of a motion that turns. If bodies may [begin in contact](crate::StartInContact::IfDeeper), no hit in
    /// that sense happens before.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub lower: V::Scalar,
    /// They have had a point in common by this time, which is not after the end of the cast. If they graze one another
    /// within rounding, or have no inside, they may have parted again. It is infinite if no such time is known: for
    /// a miss, and for a hit that may be a miss, since the bodies graze each other, touch at the start, or first touch
    /// at the end, within rounding. Bodies that may [begin in contact](crate::StartInContact::IfDeeper) get deeper from
    /// then on at the latest, or have touched again.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub upper: V::Scalar,
    /// How the search ended.
    pub status: Status,
    /// The number of support points computed of each shape. If bodies that move straight overlap at the start, those of
    /// [`distance`](crate::distance) and [`signed_distance`](crate::signed_distance) are included.
    pub iterations: usize,
}

impl<H, V: Vector> Cast<H, V> {
    /// With no upper bound.
    pub(crate) fn without_upper(outcome: Outcome<H, V>, lower: V::Scalar, status: Status, iterations: usize) -> Self {
        Self { outcome, lower, upper: V::Scalar::infinity(), status, iterations }
    }

    /// Whether the outcome is certain: a hit is if the upper bound is finite, and a miss always.
    #[must_use]
    pub fn is_certain(&self) -> bool {
        self.outcome.is_certain(self.upper < V::Scalar::infinity())
    }
}

/// The first contact of two moving bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Impact<V: Vector> {
    /// The time of first contact; 0 if the bodies touch or overlap at the start, unless only a motion that [goes
    /// deeper](crate::StartInContact::IfDeeper) counts.
    pub time: V::Scalar,
    /// A point of contact, in the world, at that time. With a [target
    /// distance](crate::LinearCastOptions::target_distance) it is a point of `b`. If the bodies overlap at the start,
    /// it is a point in both but for rounding, as in [`distance`](crate::distance).
    pub point: V,
    /// The unit normal of contact, out of `b` towards `a`. If the bodies overlap at the start by more than rounding
    /// (16ε of their sizes, 4ε of their distances from the origin, and four times the errors that they state), it is
    /// `None`; with [`StartInContact::IfDeeper`](crate::StartInContact::IfDeeper), it is the shortest way out.
    pub normal: Option<V>,
}

/// What a cast answers if the bodies touch at the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum StartInContact {
    /// A hit at time 0, whatever the motion.
    #[default]
    Report,
    /// A hit is the first time from which the bodies get deeper into one another than they began, or at which they
    /// touch again after they were apart. Sliding, rolling or turning at the same depth is no hit, and neither is
    /// moving apart. Bodies that move straight get deeper at once, a hit at time 0, or never: a miss.
    ///
    /// Deeper means deeper by more than a slack. The slack is the sum of 16ε of the bodies' sizes and a few times the
    /// rounding of their places and of their support points. Either answer about bodies that move straight is proved;
    /// if their depth at the start is not known to the slack, it may be undecided. For bodies that turn, the
    /// uncertainty of that depth adds to the slack. While they stay as deep as they began, to this slack, the time when
    /// they begin to sink cannot be known. So the lower bound of their hit is 0, and if they may have sunk from the
    /// start on, its time is 0 too.
    ///
    /// The answer is undecided if bodies come up from an overlap until they only touch, to rounding, and go down again.
    /// It is also undecided if a body rolls on its own edge or its own round face, unless it is a ball: its support
    /// points tell nothing of the points between them.
    IfDeeper,
}

/// Why a ray or a motion was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum RayCastError {
    /// The direction of the ray is the zero vector, so that it has no hit parameter. To ask whether a point is in a
    /// shape, use [`intersects`](crate::intersects).
    ZeroDirection,
    /// A coordinate is NaN or infinite.
    NonFinite {
        /// The name of the vector, such as `"source"`, `"velocity_a"` or `"motion_a"`, or of the option.
        parameter: &'static str,
        /// Which coordinate, counted from 0.
        index: usize,
    },
    /// The closest point of the set, which [`iterative_ray_cast`](crate::iterative_ray_cast) works with, is not known:
    /// the shape has no closed form of it. [`ray_cast`](crate::ray_cast) needs only support points.
    NoClosestPoint,
}

impl Display for RayCastError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::ZeroDirection => f.write_str("the direction of the ray is the zero vector"),
            Self::NonFinite { parameter, index } => write!(f, "{parameter} is NaN or infinite at index {index}"),
            Self::NoClosestPoint => {
                f.write_str("the shape has no closed form of its closest point: use `ray_cast`, which needs none")
            }
        }
    }
}

impl Error for RayCastError {}

/// The error of options that are NaN, in which every comparison would be as false as its opposite.
pub(crate) fn check_numbers<S: Scalar>(options: [(&'static str, S); 2]) -> Result<(), RayCastError> {
    let nan = options.iter().find(|(_, value)| value.is_nan());
    nan.map_or(Ok(()), |&(parameter, _)| Err(RayCastError::NonFinite { parameter, index: 0 }))
}

pub(crate) fn check_finite<V: Vector>(parameter: &'static str, vector: V) -> Result<(), RayCastError> {
    let index = (0..V::DIM).find(|&i| !vector.get(i).is_finite());
    index.map_or(Ok(()), |index| Err(RayCastError::NonFinite { parameter, index }))
}

/// The error of limits that are invalid for a cast of two bodies. With an infinite target distance any two bodies
/// would touch at any time, and a body swept by it would not be a body.
pub(crate) fn check_limits<S: Scalar>(max_time: S, target_distance: S) -> Result<(), RayCastError> {
    let target = if target_distance < S::infinity() { target_distance } else { S::nan() };
    check_numbers([("max_time", max_time), ("target_distance", target)])
}
