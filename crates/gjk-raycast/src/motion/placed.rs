//! Two moving bodies where they are at a time.

use core::cell::Cell;

use convex_support::{Core, Hint, SupportMap as _, Vector};

use super::moved::Moved;
use crate::body::{Of, Shapes};
use crate::shape::Shape;

/// Two bodies at one time; `b` has its origin at zero, which is `place` in the world.
pub(super) struct Placed<'s, V: Vector> {
    /// The shapes where they were, and what was found of them at the last time, which is mostly found again.
    pub(super) shapes: &'s dyn Shapes<Vector = V>,
    pub(super) hints: &'s Cell<[Hint; 2]>,
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

    fn each(&self) -> [Shape<'_, V>; 2] {
        [&self.a, &self.b]
    }
}
