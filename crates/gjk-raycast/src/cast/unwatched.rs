//! The bracket that an observer of a cast is shown where there is no allocator: that of the search alone.

use core::marker::PhantomData;

use convex_support::Vector;

use super::line::Line;

/// Nothing is kept of the support points.
pub(super) struct Watched<V: Vector>(PhantomData<V>);

impl<V: Vector> Watched<V> {
    pub(super) fn new(_: Line<V>) -> Self {
        Self(PhantomData)
    }

    /// The bounds of the search.
    pub(super) fn narrow(&mut self, bounds: [V::Scalar; 2], _: V, _: V, _: V::Scalar) -> [V::Scalar; 2] {
        bounds
    }
}
