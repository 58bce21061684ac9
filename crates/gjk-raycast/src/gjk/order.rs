//! Which of two bodies a search takes first, whichever is given first.
//!
//! Where bodies touch, rounding decides what is found, and the difference `A − B` is not rounded as `B − A` is. So that all queries
//! about one pair decide alike, the larger body comes first.

use convex_support::{Core, Vector};

use crate::body::{AnyPair, PointPair, TracedSupport};
use crate::symmetric::Symmetric;

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

/// A pair of which the larger body is the first: its support points are those of the pair given in that order, to the last bit. What they
/// are made of is told of the pair as it is given.
pub(crate) struct InOrder<'p, 'a, V: Vector> {
    pair: &'p mut AnyPair<'a, V>,
    /// Whether the pair is given in the other order.
    is_reversed: bool,
}

impl<'p, 'a, V: Vector> InOrder<'p, 'a, V> {
    #[inline(always)]
    pub(crate) fn new(pair: &'p mut AnyPair<'a, V>) -> Self {
        let is_reversed = comes_first(&pair.core_b, &pair.core_a);
        Self { pair, is_reversed }
    }

    /// The pair as it is given.
    #[inline(always)]
    pub(crate) fn as_given(&self) -> &AnyPair<'a, V> {
        self.pair
    }

    /// Leaves the pair in the order that it is given in.
    #[inline(always)]
    pub(crate) fn set_as_given(&mut self) {
        self.is_reversed = false;
    }

    /// Whether the pair is given in the other order.
    #[inline(always)]
    pub(crate) fn is_reversed(&self) -> bool {
        self.is_reversed
    }

    /// A vector from the second body to the first, given one from `b` to `a`.
    #[inline(always)]
    pub(crate) fn in_order(&self, from_b_to_a: V) -> V {
        if self.is_reversed { -from_b_to_a } else { from_b_to_a }
    }

    /// The difference of a point of `a` and one of `b`. What is zero is so without a sign, whatever the order.
    #[inline(always)]
    pub(crate) fn difference(&self, a: V, b: V) -> V {
        if self.is_reversed { b - a } else { a - b }
    }
}

impl<V: Vector> TracedSupport for InOrder<'_, '_, V> {
    type Vector = V;

    #[inline(always)]
    fn support(&mut self, direction: V) -> (V, PointPair<V>) {
        let (_, pair) = self.pair.support(self.in_order(direction));
        (self.difference(pair.a, pair.b), pair)
    }

    #[inline(always)]
    fn hessian(&self, direction: V, changes: [V; 2]) -> Symmetric<V::Scalar> {
        self.pair.hessian(self.in_order(direction), changes)
    }

    #[inline]
    fn is_curved(&self) -> bool {
        self.pair.is_curved()
    }
}
