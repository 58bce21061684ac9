//! Lines in the frame of a turned shape.

use super::{LineQuery, NearLine};
use crate::{Matrix, Vector};

/// How a shape was turned about its origin and moved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turned<V: Vector> {
    pub(crate) rotation: V::Matrix,
    /// The new position of the origin.
    pub(crate) center: V,
    /// The size of the shape, and its error.
    pub(crate) size: V::Scalar,
    pub(crate) error: V::Scalar,
    /// If the origin is not zero for the shape: the lost part of its image, in the frame of the shape; the origin; and
    /// the error of subtracting the one and adding the other.
    pub(crate) from: Option<(V, V, V::Scalar)>,
}

impl<V: Vector> Turned<V> {
    /// A line near the shape, from its foot, in the frame of the shape.
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
