//! What the search for a first contact asks of two moving bodies.

use convex_support::Vector;

use super::instant::{Instant, Limits};
use super::trajectory::TurningPlane;

/// Two bodies, `a` and `b`, in motion: how far apart they are at any time, and how unevenly that may change in between.
pub(super) trait Approach<V: Vector> {
    /// A bound on the size of both bodies together.
    fn size(&self) -> V::Scalar;

    /// The support points computed of each body so far.
    fn iterations(&self) -> usize;

    /// The direction from `b` to `a` at the start, as far as it can be told without looking; of any length.
    fn between(&self) -> V;

    /// The bodies at a time, looked at first along `axis`: roughly where they are well apart.
    fn at(&self, time: V::Scalar, axis: V, limits: Limits<V::Scalar>) -> Instant<V>;

    /// The bodies at a time as well as it can be known.
    fn closely(&self, time: V::Scalar, axis: V, limits: Limits<V::Scalar>) -> Instant<V>;

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

    /// The speed of the closest points against one another, where they are.
    fn speed_at(&self, there: &Instant<V>) -> V::Scalar;

    /// Whether bodies that a plane separates at the time of `near` certainly have a point in common at some time until
    /// the given one, because they have no inside and have passed through one another.
    fn pass_through(&self, near: &Instant<V>, time: V::Scalar) -> bool;

    /// A point in both bodies, which overlap at a time.
    fn common_point(&self, there: &Instant<V>) -> V {
        there.point
    }

    /// The velocity, at a time, of the point of `b` that is at `point` then.
    fn velocity_of_b(&self, time: V::Scalar, point: V) -> V;
}
