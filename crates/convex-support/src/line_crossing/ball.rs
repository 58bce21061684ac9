//! Balls, and points swept by a ball.

use num_traits::Float as _;

use super::{Chord, Crossed, Crossing, comfortable};
use crate::Vector;

/// The crossing of a ball about zero.
#[inline(always)]
pub(crate) fn ball<V: Vector>(radius: V::Scalar, source: V, direction: V) -> Crossed<V> {
    let (direction, dd, unit) = comfortable(direction);
    let recip = dd.recip();
    let first = -source.dot(direction) * recip;
    let near = source + direction * first;
    // As in `rebased`, but the second step does not need the point it leads to: by Pythagoras it is nearer by the step.
    let along = near.dot(direction);
    let second = -along * recip;
    let chord = Chord {
        middle: first + second,
        half: ((radius * radius - (near.length_squared() + along * second)) * recip).sqrt(),
        nearest: near + direction * second,
    };
    Crossing { entry: -chord.half, exit: chord.half, normal: chord.normal(radius, direction, recip) }.shifted(
        chord.middle,
        unit,
        || chord.nearest,
    )
}
