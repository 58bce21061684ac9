//! What the search for a first contact asks of two moving bodies, and what is known of them at one time.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::trajectory::TurningPlane;
use crate::unit::length_bound;

/// A step may change the distance by what the closing speeds do not predict, but for this part of what they have
/// changed.
const KINK: f64 = 0.1;

/// Bodies that are apart, or overlap, by fewer errors than this are looked at closely.
pub(super) const NEAR: f64 = 64.0;

/// What is known of the pair at one time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instant<V: Vector> {
    pub(super) time: V::Scalar,
    /// The unit vector from `b` to `a` along which they are nearest, or along which the way out of one another is the
    /// shortest.
    pub(super) normal: V,
    /// By how much a plane across the normal certainly separates the bodies; not positive where none may.
    pub(super) gap: V::Scalar,
    /// The signed distance as measured, which is certainly not more than `upper`.
    pub(super) distance: V::Scalar,
    pub(super) upper: V::Scalar,
    /// How far the measured distance is from the gap.
    pub(super) error: V::Scalar,
    /// How fast the closest points come nearer.
    pub(super) closing: V::Scalar,
    /// The closest point of `b`, or the one deepest in `a`, in the world.
    pub(super) point: V,
    /// Whether that is as well as it can be known, and not from afar.
    pub(super) is_close: bool,
}

impl<V: Vector> Instant<V> {
    /// The same with distances measured from a level, instead of from contact.
    #[inline(always)]
    pub(super) fn above(self, level: V::Scalar) -> Self {
        Self { gap: self.gap - level, distance: self.distance - level, upper: self.upper - level, ..self }
    }

    /// Whether the bodies certainly have a point in common.
    pub(super) fn overlaps(&self) -> bool {
        self.upper < V::Scalar::ZERO
    }

    /// Whether the distance went from here to another time without a kink: the mean of the closing speeds tells what it
    /// changed by, but for a part of what they did.
    pub(super) fn goes_smoothly_to(&self, to: &Self) -> bool {
        let (half, duration) = (V::Scalar::from_f64(0.5), to.time - self.time);
        let foretold = (self.closing + to.closing) * half * duration;
        let sped_up = (to.closing - self.closing).abs() * duration;
        let off = (self.distance - to.distance - foretold).abs();
        off <= sped_up * V::Scalar::from_f64(KINK) + self.error + to.error
    }
}

/// What need not be known exactly of an instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits<S> {
    /// How far apart the bodies are, once they are certainly farther apart than this.
    pub(super) distance: S,
    /// How deep they are in one another, once they are certainly deeper than this.
    pub(super) depth: S,
}

/// Two bodies, `a` and `b`, in motion: how far apart they are at any time, and how unevenly that may change in between.
pub(super) trait Approach<V: Vector> {
    /// A bound on the size of both bodies together.
    fn size(&self) -> V::Scalar;

    /// The support points computed of each body so far.
    fn iterations(&self) -> usize;

    /// The direction from `b` to `a` at the start, as far as it can be told without looking; of any length.
    fn between(&self) -> V;

    /// The bodies at a time, looked at first along `axis`: as well as it can be known, or roughly where they are well
    /// apart and are not to be looked at closely.
    fn at(&self, time: V::Scalar, axis: V, limits: Limits<V::Scalar>, is_close: bool) -> Instant<V>;

    /// How far apart the plane across a unit vector keeps the bodies at a time, and what that is wrong by at most.
    fn level(&self, time: V::Scalar, normal: V) -> (V::Scalar, V::Scalar);

    /// An upper bound of the second derivative, throughout an interval, of the distance of any point of `a` from any
    /// point of `b` along a normal that changes at a constant rate.
    fn acceleration_along(&self, plane: TurningPlane<V>, interval: [V::Scalar; 2]) -> V::Scalar;

    /// Whether balls around the bodies, which move at constant velocities, stay apart throughout an interval, which may
    /// be infinite; then the direction from `b` to `a` where they are closest.
    fn stays_far_apart(&self, interval: [V::Scalar; 2]) -> Option<V>;

    /// Whether the bodies, which overlap by `depth` at least at two times, certainly have a point in common at all
    /// times between.
    fn stay_in_contact(&self, from: &Instant<V>, to: &Instant<V>, depth: V::Scalar) -> bool;

    /// The velocities, at a time, of the points of both that are at `point` then.
    fn velocities(&self, time: V::Scalar, point: V) -> [V; 2];

    /// The speed of the closest points against one another, where they are.
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
