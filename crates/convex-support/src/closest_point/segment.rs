//! The point of a segment nearest a given one.

use crate::{Scalar, Vector};

/// The point of a segment nearest `x`.
#[inline]
pub(crate) fn clamp_to_segment<V: Vector>([a, b]: [V; 2], x: V) -> V {
    let edge = b - a;
    let Some(unit) = edge.unit() else { return a };
    // From the nearer end, so that the point is as accurate as that end is close.
    let (from_a, from_b) = (unit.dot(x - a), unit.dot(b - x));
    if from_a <= V::Scalar::ZERO {
        a
    } else if from_b <= V::Scalar::ZERO {
        b
    } else if from_a <= from_b {
        a + unit * from_a
    } else {
        b - unit * from_b
    }
}
