//! Two moving bodies where they are at a time.

use core::cell::Cell;

use convex_support::{Core, Hint, LineCrossing, Scalar, SupportMap as _, Vector};

use super::moved::Moved;
use super::moving_body::length_bound;
use super::moving_pair::MovingPair;
use crate::body::{Of, Shapes};
use crate::shape::Shape;

/// Two bodies at one time; `b` has its origin at zero, which is `place` in the world.
pub(super) struct Placed<'s, V: Vector> {
    /// The shapes where they were, and what was found of them at the last time, which is mostly found again.
    shapes: &'s dyn Shapes<Vector = V>,
    hints: &'s Cell<[Hint; 2]>,
    pub(super) a: Moved<'s, V>,
    pub(super) b: Moved<'s, V>,
    /// The origin of `a` as seen from that of `b`.
    pub(super) offset: V,
    pub(super) place: V,
}

impl<V: Vector> Shapes for Placed<'_, V> {
    type Vector = V;

    #[inline(always)]
    fn cores(&self) -> [Core<V>; 2] {
        [self.a.core(), self.b.core()]
    }

    #[inline(always)]
    fn support_points(&self, [along_a, along_b]: [V; 2], _: &mut [Hint; 2]) -> [V; 2] {
        let mut hints = self.hints.get();
        for hint in &mut hints {
            hint.rewind();
        }
        let [a, b] = self.shapes.support_points([self.a.before(along_a), self.b.before(along_b)], &mut hints);
        self.hints.set(hints);
        [self.a.turned(a), self.b.turned(b)]
    }

    fn support_hessian(&self, of: Of, direction: V, changes: [V; 2]) -> [V::Scalar; 3] {
        match of {
            Of::A => self.a.core_support_hessian(direction, changes),
            Of::B => self.b.core_support_hessian(direction, changes),
        }
    }

    #[inline(always)]
    fn closest_point(&self, of: Of, x: V) -> Option<V> {
        match of {
            Of::A => self.a.core_closest_point(x),
            Of::B => self.b.core_closest_point(x),
        }
    }

    fn line_crossing(&self, _: Of, _: V, _: V, _: V::Scalar) -> LineCrossing<V> {
        LineCrossing::Unknown
    }

    fn each(&self) -> [Shape<'_, V>; 2] {
        [&self.a, &self.b]
    }
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
            shapes: self.shapes,
            hints: &self.hints,
            a: self.a.moved(&a, offset, rounding + (a.error + b.error)),
            b: self.b.moved(&b, V::ZERO, Scalar::ZERO),
            offset,
            place: self.b.core.origin + b.shift + b.swing,
        }
    }
}
