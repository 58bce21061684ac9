//! The questions that the search for a first contact asks about two moving bodies, what is known of the bodies at one
//! time, and the level from which their distances are measured.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::trajectory::{BentPlane, TurningPlane};
use crate::Distance;
use crate::unit::length_bound;

/// The closing speeds at both ends of a step predict how the distance changes. The step counts as smooth if the
/// distance differs from that by no more than this part of what the change of the speeds makes of it.
const KINK: f64 = 0.1;

/// The width, relative to the distance, that the bracket of a rough distance may have. The time to look at next hardly
/// depends on it, and the gap is proved however wide it is. A narrower bracket takes more support points, and a wider
/// one more looks.
const ROUGH: f64 = 0.2;

/// Bodies whose distance, or overlap, is less than this many errors of it are looked at exactly.
pub(super) const NEAR_IN_MOTION: f64 = 64.0;

/// By how much a level is lowered for bodies that touch, in units of the rounding of their places at the time.
pub(super) const ROUNDED: f64 = 6.0;

/// What is known of two bodies at one time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instant<V: Vector> {
    pub(super) time: V::Scalar,
    /// The unit vector from `b` to `a` along which they are nearest to one another, or, if they overlap, along which
    /// the shortest way apart goes.
    pub(super) normal: V,
    /// The distance by which a plane across the normal certainly separates the bodies. It is not positive if they may
    /// touch.
    pub(super) gap: V::Scalar,
    /// The signed distance as computed, and a certain upper bound of it.
    pub(super) distance: V::Scalar,
    pub(super) upper: V::Scalar,
    /// The difference between the computed distance and the gap.
    pub(super) error: V::Scalar,
    /// How fast the closest points come nearer to one another.
    pub(super) closing: V::Scalar,
    /// The point of `b` that is closest to `a`, or deepest in it, in the world.
    pub(super) point: V,
    /// Whether this is as exact as it can be known. If not, it is rough.
    pub(super) is_close: bool,
}

impl<V: Vector> Instant<V> {
    /// The instant with its distances measured from a level instead of from contact.
    #[inline(always)]
    pub(super) fn above(self, level: V::Scalar) -> Self {
        Self { gap: self.gap - level, distance: self.distance - level, upper: self.upper - level, ..self }
    }

    /// Whether the bodies certainly have a point in common.
    pub(super) fn overlaps(&self) -> bool {
        self.upper < V::Scalar::ZERO
    }

    /// Whether the distance has changed without a kink from here to another time: by the mean of the closing speeds
    /// times the duration, up to a part of what the change of the speeds makes of it.
    pub(super) fn goes_smoothly_to(&self, to: &Self) -> bool {
        let (half, duration) = (V::Scalar::from_f64(0.5), to.time - self.time);
        let foretold = (self.closing + to.closing) * half * duration;
        let sped_up = (to.closing - self.closing).abs() * duration;
        let off = (self.distance - to.distance - foretold).abs();
        off <= sped_up * V::Scalar::from_f64(KINK) + self.error + to.error
    }
}

/// Bounds beyond which a distance or depth need not be known exactly.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits<S> {
    /// If the bodies are certainly farther apart than this, it is enough to know that.
    pub(super) distance: S,
    /// If they are certainly deeper in one another than this, it is enough to know that.
    pub(super) depth: S,
    /// The width, relative to the distance, that the bracket of a rough distance may have. If it is zero, the distance
    /// is known to rounding, and not only the level of one plane between the bodies.
    pub(super) rough: S,
}

impl<S: Scalar> Limits<S> {
    pub(super) fn new(distance: S, depth: S) -> Self {
        Self { distance, depth, rough: S::from_f64(ROUGH) }
    }
}

/// The level from which distances are measured. By default this is contact.
#[derive(Clone, Copy, Default)]
pub(super) struct Base<S> {
    /// The signed distance that counts as contact, before the allowance for the [rounding](Self::loose) of the bodies'
    /// places.
    pub(super) level: S,
    pub(super) stage: Stage,
    /// The signed distance at the start, its upper bound, and the width of its bracket.
    pub(super) start: S,
    pub(super) highest: S,
    pub(super) width: S,
    pub(super) slack: S,
    /// The time when the bodies became too shallow for their overlap to be certain.
    pub(super) since: S,
    /// The tolerance that was asked for. It holds again once the bodies are apart; until then the tolerance is 0, since
    /// they are as near to contact as the slack from the start on.
    pub(super) tolerance: S,
}

/// What the bodies have done since the start.
#[derive(Clone, Copy, Default, PartialEq)]
pub(super) enum Stage {
    /// They have been apart, or a contact counts whatever was before.
    #[default]
    Apart,
    /// They have touched since the start, to rounding.
    Touching,
    /// They have overlapped since the start, and are not known to be less deep than they began.
    Deep,
    /// They overlap, less deep than they began.
    Risen,
    /// They overlapped, and now touch, to rounding. They may have been apart in between.
    Surfaced,
}

impl<S: Scalar> Base<S> {
    /// By how much the level is lowered, in units of the rounding of the bodies' places at the time.
    pub(super) fn loose(&self) -> S {
        let is_exact = matches!(self.stage, Stage::Apart | Stage::Risen);
        if is_exact { S::ZERO } else { S::from_f64(ROUNDED) }
    }

    /// Whether every interval has to prove that the bodies stay in contact.
    pub(super) fn overlaps(&self) -> bool {
        matches!(self.stage, Stage::Deep | Stage::Risen)
    }
}

/// Two bodies, `a` and `b`, in motion: how far apart they are at any time, and how unevenly that may change in between.
pub(super) trait Approach<V: Vector> {
    /// Measures all distances from `target` on, instead of from contact. [`Instant`]s that are known are not changed.
    fn aim(&mut self, target: V::Scalar);

    /// The distance of the bodies at a time and their closest points, with all that is certain of it. The first guess
    /// of the normal may be given.
    fn distance(&self, time: V::Scalar, axis: Option<V>) -> Distance<V>;

    /// A bound on the size of both bodies together.
    fn size(&self) -> V::Scalar;

    /// The support points computed of each body so far.
    fn iterations(&self) -> usize;

    /// A direction from `b` to `a` at the start, of any length, which takes no query to know.
    fn between(&self) -> V;

    /// What is known of the bodies at a time, with `axis` as the first guess of the normal. It is as exact as it can be
    /// known, or if this is not asked for and the bodies are well apart, rough.
    fn at(&self, time: V::Scalar, axis: V, limits: Limits<V::Scalar>, is_close: bool) -> Instant<V>;

    /// How far apart the plane across a unit vector keeps the bodies at a time, and a bound on the error of that.
    fn level(&self, time: V::Scalar, normal: V) -> (V::Scalar, V::Scalar);

    /// An upper bound of the second derivative, throughout an interval, of the distance of any point of `a` from any
    /// point of `b` along a normal that changes at a constant rate.
    fn acceleration_along(&self, plane: TurningPlane<V>, interval: [V::Scalar; 2]) -> V::Scalar;

    /// `G` and `J` of a [bent plane](super::bent_plane); `None` if they are not known.
    fn leaning_level(&self, _plane: &BentPlane<V>) -> Option<[V::Scalar; 2]> {
        None
    }

    /// The sum of the radii of the cores and the target distance.
    fn reach(&self) -> V::Scalar;

    /// The direction from `b` to `a`, at the time when they are closest, of balls around the bodies that move at
    /// constant velocities, if these certainly stay apart throughout an interval. The interval may be infinite.
    fn stays_far_apart(&self, interval: [V::Scalar; 2]) -> Option<V>;

    /// Whether the bodies, which overlap by `depth` at least at two times, certainly have a point in common at all
    /// times between.
    fn stay_in_contact(&self, from: &Instant<V>, to: &Instant<V>, depth: V::Scalar) -> bool;

    /// The velocities, at a time, of the points of both that are at `point` then.
    fn velocities(&self, time: V::Scalar, point: V) -> [V; 2];

    /// A bound on the speed of the closest points against one another.
    fn speed_at(&self, there: &Instant<V>) -> V::Scalar {
        let [a, b] = self.velocities(there.time, there.point);
        length_bound(a) + length_bound(b)
    }

    /// Whether bodies that a plane separates at the time of `near` certainly have a point in common at some time until
    /// the given one, because they have no inside and have passed through one another.
    fn pass_through(&self, _near: &Instant<V>, _time: V::Scalar) -> bool {
        false
    }

    /// A point in both bodies, which overlap at a time.
    fn common_point(&self, there: &Instant<V>) -> V {
        there.point
    }
}
