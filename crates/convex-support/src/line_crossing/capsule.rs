//! Where a line is in a capsule: in the tube around its segment, or in the ball at an end of it.

use num_traits::Float as _;

use super::{Chord, Crossed, Crossing, comfortable, rebased};
use crate::{Scalar, Vector};

/// A segment, by its middle, the unit vector along it and half its length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spine<V: Vector> {
    pub(super) middle: V,
    pub(super) axis: V,
    pub(super) half_height: V::Scalar,
    /// The axis is the second one, so that vectors are split without arithmetic.
    pub(super) is_upright: bool,
}

impl<V: Vector> Spine<V> {
    /// The segment between `±half_height` on the second axis.
    #[inline(always)]
    pub(crate) fn upright(half_height: V::Scalar) -> Self {
        Self { middle: V::ZERO, axis: V::axis(1), half_height, is_upright: true }
    }

    /// The segment between two points.
    #[inline(always)]
    pub(crate) fn between([a, b]: [V; 2]) -> Self {
        let to_b = (b - a) * V::Scalar::from_f64(0.5);
        let axis = to_b.unit().unwrap_or_else(|| V::axis(0));
        Self { middle: a + to_b, axis, half_height: to_b.norm(), is_upright: false }
    }

    /// A point relative to the middle.
    #[inline(always)]
    pub(super) fn seen(&self, point: V) -> V {
        if self.is_upright { point } else { point - self.middle }
    }

    /// The parts of a vector along and across the axis.
    #[inline(always)]
    pub(super) fn split(&self, v: V) -> (V::Scalar, V) {
        if self.is_upright {
            return (v.get(1), V::from_fn(|i| if i == 1 { V::Scalar::ZERO } else { v.get(i) }));
        }
        let along = v.dot(self.axis);
        let out = v - self.axis * along;
        // Once more, because the part across may be small against the subtracted one: for a line nearly along the axis,
        // the place where it leaves the side is the difference of two large numbers.
        (along, out - self.axis * out.dot(self.axis))
    }

    /// The crossing of the segment, swept by a ball.
    #[inline(always)]
    pub(crate) fn crossing(&self, radius: V::Scalar, source: V, direction: V) -> Crossed<V> {
        let (direction, dd, unit) = comfortable(direction);
        let recip = dd.recip();
        let (base, source) = rebased(self.seen(source), direction, recip);
        let (source, direction) = ((source, self.split(source)), (direction, self.split(direction)));
        capsule(self.axis, self.half_height, radius, source, direction, recip)?.shifted(base, unit, || V::ZERO)
    }
}

/// A vector and its parts along and across an axis.
type Split<V> = (V, (<V as Vector>::Scalar, V));

/// The crossing of the segment between `±half_height·axis`, swept by a ball; `axis` is a unit vector, `source` the
/// point of the line nearest the middle, and `recip` is `1/|direction|²`.
///
/// A line enters the infinite cylinder about the axis through the side of the capsule, which is then its entry, or
/// beyond one of the ends, and then it can enter only through the ball at that end. The same holds where it leaves.
#[inline(always)]
fn capsule<V: Vector>(
    axis: V,
    half_height: V::Scalar,
    radius: V::Scalar,
    (source, (along, out)): Split<V>,
    (direction, (rise, across)): Split<V>,
    recip: V::Scalar,
) -> Crossed<V> {
    let slope = across.length_squared();
    let per_slope = slope.recip();
    let middle = -out.dot(across) * per_slope;
    // In the plane a line meets the axis itself, even if by rounding it passes at some distance.
    let nearest = if V::DIM == 2 { V::ZERO } else { out + across * middle };
    let side = Chord::about(middle, nearest, per_slope, radius);
    let (mut entry, mut exit) = side.ends();
    let (mut enters, mut leaves) = (along + rise * entry, along + rise * exit);
    // A direction that is along the axis to rounding meets the side only far away.
    if slope * recip <= V::Scalar::EPSILON * V::Scalar::EPSILON {
        if out.length_squared() > radius * radius {
            return Err(out);
        }
        (enters, leaves) = (-rise * V::Scalar::infinity(), rise * V::Scalar::infinity());
    } else if !side.is_some() {
        return Err(side.nearest);
    }
    let cap = |y: V::Scalar| {
        // From the end on the side of y; (source − end)·direction, with source ⟂ direction, is −height·rise.
        let height = half_height.copysign(y);
        let middle = height * rise * recip;
        Chord::about(middle, source - axis * height + direction * middle, recip, radius)
    };
    let mut normal = side.normal(radius, across, per_slope);
    if !(enters.abs() <= half_height) {
        let cap = cap(enters);
        if !cap.is_some() {
            return Err(cap.nearest);
        }
        entry = cap.middle - cap.half;
        normal = cap.normal(radius, direction, recip);
    }
    if !(leaves.abs() <= half_height) {
        exit = cap(leaves).ends().1;
    }
    // By rounding the exit may be NaN or before the entry.
    Ok(Crossing { entry, exit: if exit > entry { exit } else { entry }, normal })
}
