//! Which of two bodies a search takes first, whichever is given first.
//!
//! Where bodies touch, rounding decides what is found, and the difference `A − B` is not rounded as `B − A` is. So that
//! all queries about one pair decide alike, the larger body comes first.

use convex_support::{Core, Vector};

/// Whether a body is looked at before another: it is larger, or as large and elsewhere.
#[inline(always)]
pub(crate) fn comes_first<V: Vector>(a: &Core<V>, b: &Core<V>) -> bool {
    if a.extent != b.extent {
        return a.extent > b.extent;
    }
    if a.radius != b.radius {
        return a.radius > b.radius;
    }
    let other = (0..V::DIM).find(|&i| a.origin.get(i) != b.origin.get(i));
    other.is_some_and(|i| a.origin.get(i) > b.origin.get(i))
}
