//! Where a line is in a box: in all of its slabs at once.

use num_traits::Float as _;

use super::{Crossed, Crossing, across_two_axes, axis_of, comfortable};
use crate::{Scalar, Vector};

/// The line is in the box while it is in all of its slabs.
///
/// A line that is parallel to a slab divides by zero: it is then in the slab from `−∞` to `∞`, or from `±∞` to `±∞`,
/// and the other slabs decide; and `0/0`, in the plane of a face, compares false and changes nothing.
#[inline(always)]
pub(crate) fn cuboid<V: Vector>(half_extents: V, source: V, direction: V) -> Crossed<V> {
    let per_unit = V::ONE / direction;
    let near = half_extents.copysign(-direction);
    let (enters, leaves) = ((near - source) * per_unit, (-near - source) * per_unit);
    let (mut entry, mut exit) = (-V::Scalar::infinity(), V::Scalar::infinity());
    for i in 0..V::DIM {
        entry = if enters.get(i) > entry { enters.get(i) } else { entry };
        exit = if leaves.get(i) < exit { leaves.get(i) } else { exit };
    }
    // Either no coordinate crosses a slab, or the reciprocals of all that do are infinite.
    if !(entry > -V::Scalar::infinity() && exit < V::Scalar::infinity()) {
        return along_no_axis(half_extents, source, direction);
    }
    let known = !(source + direction).is_nan();
    let face = axis_of(enters, entry);
    if (entry <= exit) & known {
        Ok(Crossing { entry, exit, normal: face * V::ONE.copysign(-direction) })
    } else {
        // The line leaves one slab before it enters the other: projected along both of them, it passes a rectangle.
        Err(across_two_axes([face, axis_of(leaves, exit)], source, direction))
    }
}

/// A direction whose coordinates are zero, or have infinite reciprocals, or are `NaN`.
#[cold]
#[inline(never)]
fn along_no_axis<V: Vector>(half_extents: V, source: V, direction: V) -> Crossed<V> {
    // A zero direction cannot be lengthened; if it is long already, a `NaN` in it or in the source is the cause.
    let largest = direction.abs().max_element();
    if largest == V::Scalar::ZERO || !(largest.recip() == V::Scalar::infinity()) {
        return Err(V::ZERO);
    }
    let (direction, _, unit) = comfortable(direction);
    cuboid(half_extents, source, direction)?.shifted(V::Scalar::ZERO, unit, || V::ZERO)
}
