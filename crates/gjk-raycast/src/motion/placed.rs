//! Two moving bodies where they are at a time.

use convex_support::{Scalar, Vector};

use super::moved::Moved;
use super::moving_body::length_bound;
use super::moving_pair::MovingPair;

/// Two bodies at one time; `b` has its origin at zero, which is `place` in the world.
pub(super) struct Placed<'s, V: Vector> {
    pub(super) a: Moved<'s, V>,
    pub(super) b: Moved<'s, V>,
    /// The origin of `a` as seen from that of `b`.
    pub(super) offset: V,
    pub(super) place: V,
}

impl<V: Vector> MovingPair<'_, V> {
    /// The bodies where they are at a time.
    #[inline(never)]
    pub(super) fn placed(&self, time: V::Scalar) -> Placed<'_, V> {
        self.placed_here(time)
    }

    /// The same, compiled into its caller.
    #[inline(always)]
    pub(super) fn placed_here(&self, time: V::Scalar) -> Placed<'_, V> {
        let (a, b) = (self.a.place(time), self.b.place(time));
        // What lies between is of the order of the bodies, however far from the world's origin they are.
        let between = self.a.core.origin - self.b.core.origin;
        let (shifts, swings) = (a.shift - b.shift, a.swing - b.swing);
        let offset = between + shifts + swings;

        // A rounding for each difference and sum.
        let magnitude = length_bound(between.abs() + shifts.abs() + swings.abs());
        let rounding = V::Scalar::from_f64(1.5) * V::Scalar::EPSILON * magnitude;
        Placed {
            a: self.a.moved(&a, offset, rounding + (a.error + b.error)),
            b: self.b.moved(&b, V::ZERO, Scalar::ZERO),
            offset,
            place: self.b.core.origin + b.shift + b.swing,
        }
    }
}
