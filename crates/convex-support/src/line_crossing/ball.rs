//! Where a line is in a ball, or in a point swept by one: about its place nearest the centre.

use num_traits::Float as _;

use super::{Chord, Crossed, Crossing, comfortable};
use crate::Vector;

/// The crossing of a ball about zero.
#[inline(always)]
pub(crate) fn ball<V: Vector>(radius: V::Scalar, source: V, direction: V) -> Crossed<V> {
    let (direction, dd, unit) = comfortable(direction);
    let recip = dd.recip();
    let chord = chord(radius, source, direction, recip);
    Crossing { entry: -chord.half, exit: chord.half, normal: chord.normal(radius, direction, recip) }.shifted(
        chord.middle,
        unit,
        || chord.nearest,
    )
}

/// The chord that a ball about zero cuts out of a line; `recip` is `1/|direction|²`.
#[inline(always)]
pub(super) fn chord<V: Vector>(radius: V::Scalar, source: V, direction: V, recip: V::Scalar) -> Chord<V> {
    let first = -source.dot(direction) * recip;
    let near = source + direction * first;
    // As in `rebased`, but the second step needs no point: by Pythagoras it is nearer by the step.
    let along = near.dot(direction);
    let second = -along * recip;
    let inside = radius * radius - (near.length_squared() + along * second);
    Chord { middle: first + second, half: (inside * recip).sqrt(), nearest: near + direction * second, inside }
}
