//! Where a line is in a box swept by a ball: no farther from the box, by a distance that is quadratic in parts.

use num_traits::Float as _;

use super::{Chord, Crossed, Crossing, across_two_axes, axis_of, comfortable, rebased};
use crate::{Scalar, Vector};

/// The squared distance from a box is `φ(λ) = Σ max(|xᵢ| − hᵢ, 0)²` along the line: convex, and one quadratic between
/// any two neighbouring crossings of the planes `xᵢ = ±hᵢ`. The line enters the rounded box where `φ` falls to
/// `radius²`, and not before it enters the box of half extents `hᵢ + radius`: from there the parts are searched in
/// order. Most lines enter through one of the flat sides, in the first part. They leave where the reversed line enters.
#[inline]
pub(crate) fn rounded_cuboid<V: Vector>(h: V, radius: V::Scalar, source: V, direction: V) -> Crossed<V> {
    let (direction, dd, unit) = comfortable(direction);
    let (base, source) = rebased(source, direction, dd.recip());
    let per_unit = V::ONE / direction;
    let near = h.copysign(-direction);
    let (enters, leaves) = ((near - source) * per_unit, (-near - source) * per_unit);
    let margin = per_unit.abs() * radius;
    let begin = largest(enters - margin);
    let end = -largest(-(leaves + margin));
    if !(begin <= end) {
        let slabs = [axis_of(enters - margin, begin), axis_of(leaves + margin, end)];
        return Err(across_two_axes(slabs, source, direction));
    }
    let line = Line { source, direction, near, enters, leaves };
    let entry = line.entry(radius, begin, end)?;
    let reversed = Line { source, direction: -direction, near: -near, enters: -leaves, leaves: -enters };
    let exit = reversed.entry(radius, -end, -begin).map_or(entry, |exit| -exit);

    let at = source + direction * entry;
    let excess = at - at.max(-h).min(h);
    let normal = excess.unit().unwrap_or_else(|| -direction * dd.sqrt().recip());
    Crossing { entry, exit: if exit > entry { exit } else { entry }, normal }.shifted(base, unit, || V::ZERO)
}

/// The largest coordinate; `NaN` (of a line in a plane) is passed over.
#[inline(always)]
fn largest<V: Vector>(v: V) -> V::Scalar {
    (0..V::DIM).fold(-V::Scalar::infinity(), |most, i| if v.get(i) > most { v.get(i) } else { most })
}

/// A line, and its crossings with the sides of a box: the slab of coordinate `i` from the side at `nearᵢ`, at
/// `entersᵢ`, to the side at `−nearᵢ`, at `leavesᵢ`.
struct Line<V: Vector> {
    source: V,
    direction: V,
    near: V,
    enters: V,
    leaves: V,
}

impl<V: Vector> Line<V> {
    /// The parameter between `begin` and `end` where the line enters the rounded box; the shortest vector to the line
    /// if it misses.
    #[inline(always)]
    fn entry(&self, radius: V::Scalar, begin: V::Scalar, end: V::Scalar) -> Result<V::Scalar, V> {
        let (mut lambda, mut nearest) = (begin, None);
        // Each coordinate changes its part at most twice.
        for _ in 0..=2 * V::DIM {
            let QuadraticPart { outside, speed, beyond, next } = self.part_from(lambda);
            let dd = speed.length_squared();
            if beyond == 0 {
                return Ok(lambda);
            }
            if beyond == 1 && lambda == begin {
                // Opposite a flat side, where the boxes of half extents hᵢ + radius and the rounded one agree.
                return Ok(lambda);
            }
            let recip = dd.recip();
            let middle = -outside.dot(speed) * recip;
            let chord = Chord::about(middle, outside + speed * middle, recip, radius);
            // The distance is least where the middle of a quadratic lies within its part.
            nearest = if (lambda <= middle) & (middle <= next) { Some(chord.nearest) } else { nearest };
            let (enters, leaves) = chord.ends();
            if dd == V::Scalar::ZERO {
                if outside.length_squared() <= radius * radius {
                    return Ok(lambda);
                }
            } else if chord.is_some() {
                if leaves < lambda {
                    break;
                }
                if enters <= next {
                    return Ok(if enters > lambda { enters } else { lambda });
                }
            }
            if !(next < end) {
                break;
            }
            lambda = next;
        }
        Err(nearest.unwrap_or_else(|| self.nearest()))
    }

    /// The shortest vector from the box to the line, which misses it.
    fn nearest(&self) -> V {
        let mut lambda = -V::Scalar::infinity();
        for _ in 0..=2 * V::DIM {
            let QuadraticPart { outside, speed, next, .. } = self.part_from(lambda);
            let middle = -outside.dot(speed) / speed.length_squared();
            if middle <= next {
                return outside + speed * middle;
            }
            lambda = next;
        }
        V::ZERO
    }

    /// The part that begins at a parameter.
    #[inline(always)]
    fn part_from(&self, lambda: V::Scalar) -> QuadraticPart<V> {
        let (mut outside, mut speed, mut beyond, mut next) = (V::ZERO, V::ZERO, 0, V::Scalar::infinity());
        for i in 0..V::DIM {
            let (enters, leaves) = (self.enters.get(i), self.leaves.get(i));
            let before = lambda < enters;
            if before | !(lambda < leaves) {
                let side = if before { self.near.get(i) } else { -self.near.get(i) };
                outside += V::axis(i) * (self.source.get(i) - side);
                speed += V::axis(i) * self.direction.get(i);
                beyond += 1;
            }
            let change = if before { enters } else { leaves };
            next = if (lambda < change) & (change < next) { change } else { next };
        }
        QuadraticPart { outside, speed, beyond, next }
    }
}

/// A part of a line in which its distance from a box is one quadratic.
struct QuadraticPart<V: Vector> {
    /// By how much the line is outside of the box, at its source.
    outside: V,
    /// The rate of change of `outside`.
    speed: V,
    /// The number of coordinates in which it is outside.
    beyond: usize,
    /// Where the part ends.
    next: V::Scalar,
}
