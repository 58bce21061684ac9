//! Lines as a shape sees them that was turned.

use super::{LineQuery, NearLine};
use crate::{Matrix, Vector};

/// How a shape was turned about its origin and moved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turned<V: Vector> {
    pub(crate) rotation: V::Matrix,
    /// Where the origin is now.
    pub(crate) center: V,
    /// The size of the shape, and the error that it is known to.
    pub(crate) size: V::Scalar,
    pub(crate) error: V::Scalar,
    /// Where the origin is not zero for the shape: what was lost of its image, as the shape sees it; the origin; and
    /// the error of taking the one off and putting the other on.
    pub(crate) from: Option<(V, V, V::Scalar)>,
}

impl<V: Vector> Turned<V> {
    /// A line near the shape, from its foot, as the shape sees it.
    #[inline(always)]
    pub(crate) fn before(&self, near: &NearLine<V>, asked: LineQuery<V>) -> LineQuery<V> {
        let [source, direction] = [near.source, near.direction].map(|v| self.rotation.transpose_mul(v));
        let before = LineQuery { source, direction, error: near.error, ..asked };
        match self.from {
            Some((lost, origin, error)) => LineQuery { source: source - lost + origin, ..before.within(error) },
            None => before,
        }
    }
}
