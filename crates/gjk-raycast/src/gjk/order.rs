//! Which of two bodies a search takes first, whichever is given first.
//!
//! Where bodies touch, rounding decides what is found, and the difference `A − B` is not rounded as `B − A` is. So that
//! all queries about one pair decide alike, the larger body comes first.

use convex_support::{Core, SupportMap, Vector};

use crate::body::Both;

/// Whether a body is looked at before another: it is larger, or as large and elsewhere.
#[inline(always)]
fn comes_first<V: Vector>(a: &Core<V>, b: &Core<V>) -> bool {
    if a.extent != b.extent {
        return a.extent > b.extent;
    }
    if a.radius != b.radius {
        return a.radius > b.radius;
    }
    let other = (0..V::DIM).find(|&i| a.origin.get(i) != b.origin.get(i));
    other.is_some_and(|i| a.origin.get(i) > b.origin.get(i))
}

impl<A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized> Both<'_, A, B> {
    /// The two in order, and their cores, which are given as they were named.
    #[inline(always)]
    pub(crate) fn in_order(mut self, [a, b]: [Core<A::Vector>; 2]) -> (Self, [Core<A::Vector>; 2]) {
        self.is_swapped = comes_first(&b, &a);
        let cores = if self.is_swapped { [b, a] } else { [a, b] };
        (self, cores)
    }
}
