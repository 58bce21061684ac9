//! Where a line certainly enters a shape, in twice the precision.
//!
//! If a line is nearly along a surface, or grazes it, errors as small as roundings of the shape's size move the
//! crossing far. But the given numbers of shape and line are exact: with all of them in twice the precision, only the
//! error that comes with the shape is left. A shape is a union of pieces, each the intersection of slabs and quadrics,
//! and the line is in each for a stretch with bounds on both ends. To hold for every line that passes within the error,
//! the shape is once made larger and once smaller by it.
//!
//! The arithmetic is that of `f64` whatever the precision of the shape, and is compiled once.

use num_traits::Float as _;

use super::certain::cone_reach;
use super::{CertainCrossing, Crossed, LineQuery, NearLine, Spine, axis_of};
use crate::numerics::bounded::Bounded;
use crate::numerics::elementary::hypot;
use crate::numerics::range::power_of_two_below;
use crate::shapes::axial::{ConeMeasures, across};
use crate::{Scalar, Vector, Vector3};

/// A segment about an origin along the second axis, swept by a ball, or a ball.
#[cold]
#[inline(never)]
pub(crate) fn capsule<V: Vector>(line: LineQuery<V>, origin: V, half_height: V::Scalar) -> Option<CertainCrossing<V>> {
    let (end, radius) = (V::axis(1) * half_height, line.radius);
    let outward = |at: V| (at - at.max(-end).min(end)).unit().unwrap_or(-line.direction);
    let crossed = |source, direction| Spine::upright(half_height).crossing(radius, source, direction);
    let reach = |axis: V| half_height * axis.get(1).abs();
    let solid = |f: InUnits<'_, V>| Solid::upright(CloseLine::capsule, f(half_height), f(radius));
    closely(line, origin, half_height + radius, solid, outward, crossed, reach)
}

/// A box about zero, swept by a ball or not.
#[cold]
#[inline(never)]
pub(crate) fn cuboid<V: Vector>(line: LineQuery<V>, half_extents: V) -> Option<CertainCrossing<V>> {
    let radius = line.radius;
    let is_swept = radius > V::Scalar::ZERO;
    let outward = |at: V| {
        let beyond = at.abs() - half_extents;
        let face = axis_of(beyond, beyond.max_element()) * V::ONE.copysign(at);
        let excess = if is_swept { at - at.max(-half_extents).min(half_extents) } else { face };
        excess.unit().unwrap_or(face)
    };
    let solid = |f: InUnits<'_, V>| Solid {
        union: CloseLine::rounded_box,
        half_extents: core::array::from_fn(|i| if i < V::DIM { f(half_extents.get(i)) } else { f64::INFINITY }),
        radius: f(radius),
    };
    let crossed = |source, direction| {
        if is_swept {
            super::rounded_cuboid(half_extents, radius, source, direction)
        } else {
            super::cuboid(half_extents, source, direction)
        }
    };
    let reach = |axis: V| axis.abs().dot(half_extents);
    closely(line, V::ZERO, half_extents.norm() + radius, solid, outward, crossed, reach)
}

/// A cone about the second axis.
#[cold]
#[inline(never)]
pub(crate) fn cone<V: Vector3>(line: LineQuery<V>, shape: &ConeMeasures<V::Scalar>) -> Option<CertainCrossing<V>> {
    let ConeMeasures { half_height, radius, extent, slant: (cosine, sine) } = *shape;
    // A disc and a segment have no opening angle.
    if !(half_height.min(radius) > V::Scalar::ZERO) {
        return None;
    }
    let outward = |at: V| {
        let beyond_slant = across(at).length() * cosine - (half_height - at.get(1)) * sine;
        let out = across(at).unit().unwrap_or_else(|| across(-line.direction).unit().unwrap_or(V::ZERO));
        if -half_height - at.get(1) > beyond_slant { -V::axis(1) } else { out * cosine + V::axis(1) * sine }
    };
    let crossed = |source, direction| super::cone(shape, source, direction);
    let solid = |f: InUnits<'_, V>| Solid::upright(CloseLine::cone, f(half_height), f(radius));
    closely(line, V::ZERO, extent, solid, outward, crossed, |axis| cone_reach(shape, axis))
}

/// A cylinder about the second axis.
#[cold]
#[inline(never)]
pub(crate) fn cylinder<V: Vector3>(
    line: LineQuery<V>,
    half_height: V::Scalar,
    radius: V::Scalar,
) -> Option<CertainCrossing<V>> {
    let outward = |at: V| {
        let is_beyond_lid = at.get(1).abs() - half_height > across(at).length() - radius;
        let lid = V::axis(1) * V::Scalar::ONE.copysign(at.get(1));
        across(at).unit().filter(|_| !is_beyond_lid).unwrap_or(lid)
    };
    let crossed = |source, direction| super::cylinder(half_height, radius, source, direction);
    let reach = |axis: V| half_height * axis.get(1).abs() + radius * across(axis).length();
    let solid = |f: InUnits<'_, V>| Solid::upright(CloseLine::cylinder, f(half_height), f(radius));
    closely(line, V::ZERO, hypot(half_height, radius), solid, outward, crossed, reach)
}

/// A length in units of a power of two.
type InUnits<'a, V> = &'a dyn Fn(<V as Vector>::Scalar) -> f64;

/// Only the error that came with the line counts. `outward` is the unit normal at a point of the surface. For a line
/// that misses, the closed form gives an axis, along which the core `reaches` so far. The line is measured along it,
/// and if it misses only by rounding, that is left to a search.
fn closely<V: Vector>(
    line: LineQuery<V>,
    origin: V,
    size: V::Scalar,
    solid: impl FnOnce(InUnits<'_, V>) -> Solid,
    outward: impl FnOnce(V) -> V,
    crossed: impl FnOnce(V, V) -> Crossed<V>,
    reaches: impl FnOnce(V) -> V::Scalar,
) -> Option<CertainCrossing<V>> {
    let near = NearLine::new(line, origin, size)?;
    let length = power_of_two_below(size).as_f64();
    let speed = power_of_two_below(line.direction.abs().max_element()).as_f64();
    let in_units = |x: V::Scalar| x.as_f64() / length;
    let coordinate = |v: V, i: usize| if i < V::DIM { v.get(i) } else { V::Scalar::ZERO };
    let seen = |i| Bounded::sum(in_units(coordinate(line.source, i)), -in_units(coordinate(origin, i)));
    let direction = core::array::from_fn(|i| coordinate(line.direction, i).as_f64() / speed);
    let close = CloseLine { source: core::array::from_fn(seen), direction };
    match close.crossing(solid(&in_units), in_units(line.error))? {
        Known::Misses => {
            let axis = crossed(near.source, near.direction).err()?;
            near.passes(axis, reaches(axis), line.radius)
        }
        Known::Enters(bounds) => {
            let [earliest, latest] = bounds.map(|at| at * (length / speed));
            let entry = V::Scalar::from_f64(earliest + (latest - earliest) * 0.5);
            let bounds = [earliest, latest].map(V::Scalar::from_f64);
            let normal = outward(near.source + near.direction * (entry - near.base));
            Some(NearLine { base: V::Scalar::ZERO, ..near }.enters([bounds[0], entry, bounds[1]], normal))
        }
    }
}

/// A shape about zero, in units of about its size; upright ones are about the second axis.
#[derive(Clone, Copy)]
pub(super) struct Solid {
    /// The first entry of a line into its pieces, made larger by a length, or smaller if the length is negative. A
    /// pointer, so that a program contains only the pieces of its own shapes.
    union: fn(&CloseLine, &Self, f64) -> First,
    /// Those of a box beyond the dimension are infinite; the second one of an upright shape is half its height.
    half_extents: [f64; 3],
    radius: f64,
}

impl Solid {
    fn upright(union: fn(&CloseLine, &Self, f64) -> First, half_height: f64, radius: f64) -> Self {
        Self { union, half_extents: [0.0, half_height, 0.0], radius }
    }
}

/// A line: its source relative to the shape's origin, exactly, and its direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct CloseLine {
    pub(super) source: [Bounded; 3],
    pub(super) direction: [f64; 3],
}

/// A certain answer for a line and a shape.
#[derive(Clone, Copy, Debug)]
pub(super) enum Known {
    Misses,
    /// The line enters between these parameters.
    Enters([f64; 2]),
}

impl CloseLine {
    /// The certain answer for every line that passes within `error` near the shape.
    pub(super) fn crossing(&self, solid: Solid, error: f64) -> Option<Known> {
        let union = |by| (solid.union)(self, &solid, by);
        let larger = union(error);
        let smaller = if error > 0.0 { union(-error) } else { larger };
        if larger.earliest == f64::INFINITY {
            return Some(Known::Misses);
        }
        // NaN and infinity prove nothing.
        let is_known = larger.earliest > f64::NEG_INFINITY && smaller.latest < f64::INFINITY;
        is_known.then_some(Known::Enters([larger.earliest, smaller.latest]))
    }

    fn cylinder(&self, solid: &Solid, by: f64) -> First {
        let Solid { half_extents: [_, half_height, _], radius, .. } = *solid;
        let mut first = First::NONE;
        let disc = self.disc([true, false, true], [0.0; 3], Bounded::sum(radius, by));
        first.take(self.slab(1, Bounded::sum(half_height, by)).and(disc));
        first
    }

    fn capsule(&self, solid: &Solid, by: f64) -> First {
        let Solid { half_extents: [_, half_height, _], radius, .. } = *solid;
        let mut first = First::NONE;
        let radius = Bounded::sum(radius, by);
        first.take(self.slab(1, half_height.into()).and(self.disc([true, false, true], [0.0; 3], radius)));
        for end in [half_height, -half_height] {
            first.take(self.disc([true; 3], [0.0, end, 0.0], radius));
        }
        first
    }

    /// The stretch where `|x·eᵢ| ≤ half`.
    fn slab(&self, axis: usize, half: Bounded) -> Stretch {
        self.between(axis, -half, half)
    }

    /// The stretch where the coordinate is between two numbers.
    fn between(&self, axis: usize, low: Bounded, high: Bounded) -> Stretch {
        let (at, speed) = (self.source[axis], self.direction[axis]);
        let (below, above) = (at - low, high - at);
        if speed == 0.0 {
            return if below.is_negative() || above.is_negative() {
                Stretch::NOWHERE
            } else if below.is_positive() && above.is_positive() {
                Stretch::EVERYWHERE
            } else {
                Stretch::UNKNOWN
            };
        }
        let (enters, leaves) = if speed > 0.0 { (-below, above) } else { (above, -below) };
        Stretch { enters: (enters / speed.into()).bounds(), leaves: (leaves / speed.into()).bounds() }
    }

    /// The stretch where the meant coordinates are within a distance of a centre.
    fn disc(&self, is_meant: [bool; 3], centre: [f64; 3], radius: Bounded) -> Stretch {
        if radius.is_negative() {
            return Stretch::NOWHERE;
        }
        let zero = Bounded::from(0.0);
        let [mut a, mut b, mut c] = [zero, zero, -radius.squared()];
        for i in (0..3).filter(|&i| is_meant[i]) {
            let (at, d) = (self.source[i] - centre[i].into(), Bounded::from(self.direction[i]));
            (a, b, c) = (a + d.squared(), b + at * d, c + at.squared());
        }
        match quadric(a, b, c) {
            Quadric::Within(stretch) => stretch,
            Quadric::Outside { .. } => Stretch::UNKNOWN,
        }
    }

    /// The cone is behind its base and below its apex, where `4h²·(x² + z²) ≤ r²·(h − y)²`. Each of its planes is moved
    /// by `by`: the base by `by`, and the apex by `by/sinα`, with `α` half the opening angle.
    fn cone(&self, solid: &Solid, by: f64) -> First {
        let Solid { half_extents: [_, half_height, _], radius, .. } = *solid;
        let height = half_height + half_height;
        let lift = if by == 0.0 { 0.0 } else { by * hypot(height / radius, 1.0) };
        // The product and the length are wrong by a few roundings.
        let lift = lift + lift * (8.0 * f64::EPSILON);
        let (apex, base) = (Bounded::sum(half_height, lift), Bounded::sum(-half_height, -by));
        let (along, fall) = (apex - self.source[1], -Bounded::from(self.direction[1]));
        let (tall, wide) = (Bounded::from(height).squared(), Bounded::from(radius).squared());
        let zero = Bounded::from(0.0);
        let [mut a, mut b, mut c] = [zero; 3];
        for i in [0, 2] {
            let (at, d) = (self.source[i], Bounded::from(self.direction[i]));
            (a, b, c) = (a + d.squared(), b + at * d, c + at.squared());
        }
        let a = a * tall - fall.squared() * wide;
        let b = b * tall - along * fall * wide;
        let c = c * tall - along.squared() * wide;
        let slant = match quadric(a, b, c) {
            Quadric::Within(stretch) => stretch,
            // A line steeper than the slant is below the apex after both roots if it falls, and before both if it
            // rises.
            Quadric::Outside { high, .. } if self.direction[1] < 0.0 => {
                Stretch { enters: high, leaves: [f64::INFINITY; 2] }
            }
            Quadric::Outside { low, .. } => Stretch { enters: [f64::NEG_INFINITY; 2], leaves: low },
        };
        let mut first = First::NONE;
        first.take(slant.and(self.between(1, base, apex)));
        first
    }

    /// A box swept by a ball: the boxes that are longer by the radius along one axis, the edges swept by a ball, and
    /// the balls about the corners. A box without a radius is itself made larger, or smaller.
    fn rounded_box(&self, solid: &Solid, by: f64) -> First {
        let Solid { half_extents, radius, .. } = *solid;
        let mut first = First::NONE;
        let is_swept = radius > 0.0;
        let radius = Bounded::sum(radius, by);
        let axes = || (0..3).filter(|&i| half_extents[i] < f64::INFINITY);
        for long in axes() {
            let half = |i: usize| {
                if !is_swept {
                    Bounded::sum(half_extents[i], by)
                } else if i == long {
                    radius + half_extents[i].into()
                } else {
                    half_extents[i].into()
                }
            };
            first.take(axes().fold(Stretch::EVERYWHERE, |all, i| all.and(self.slab(i, half(i)))));
            if !is_swept {
                return first;
            }
        }
        // For each axis the lower end, the upper end, or the part between.
        for place in 0..27_usize {
            let sides = [place % 3, place / 3 % 3, place / 9].map(|side| [-1.0, 0.0, 1.0][side]);
            let is_meant = core::array::from_fn(|i| sides[i] != 0.0);
            let count = is_meant.iter().filter(|&&is_meant| is_meant).count();
            if count < 2 || (0..3).any(|i| is_meant[i] && half_extents[i] == f64::INFINITY) {
                continue;
            }
            let centre = core::array::from_fn(|i| if is_meant[i] { sides[i] * half_extents[i] } else { 0.0 });
            let between = axes().filter(|&i| !is_meant[i]).map(|i| self.slab(i, half_extents[i].into()));
            first.take(between.fold(self.disc(is_meant, centre, radius), Stretch::and));
        }
        first
    }
}

/// The stretch of a line in a set, with bounds on both ends.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    enters: [f64; 2],
    leaves: [f64; 2],
}

impl Stretch {
    const EVERYWHERE: Self = Self { enters: [f64::NEG_INFINITY; 2], leaves: [f64::INFINITY; 2] };
    const NOWHERE: Self = Self { enters: [f64::INFINITY; 2], leaves: [f64::NEG_INFINITY; 2] };
    const UNKNOWN: Self =
        Self { enters: [f64::NEG_INFINITY, f64::INFINITY], leaves: [f64::NEG_INFINITY, f64::INFINITY] };

    /// The stretch in both.
    fn and(self, other: Self) -> Self {
        let (p, q) = (self, other);
        Self {
            enters: [p.enters[0].max(q.enters[0]), p.enters[1].max(q.enters[1])],
            leaves: [p.leaves[0].min(q.leaves[0]), p.leaves[1].min(q.leaves[1])],
        }
    }
}

/// Bounds on the first entry into one of several pieces; infinite if unknown or if there is none.
#[derive(Clone, Copy)]
struct First {
    earliest: f64,
    latest: f64,
}

impl First {
    const NONE: Self = Self { earliest: f64::INFINITY, latest: f64::INFINITY };

    fn take(&mut self, Stretch { enters, leaves }: Stretch) {
        if enters[0] <= leaves[1] {
            self.earliest = self.earliest.min(enters[0]);
        }
        if enters[1] <= leaves[0] {
            self.latest = self.latest.min(enters[1]);
        }
    }
}

/// The part where `aλ² + 2bλ + c ≤ 0`: between its roots, or, if `a` is negative, outside of them.
enum Quadric {
    Within(Stretch),
    Outside { low: [f64; 2], high: [f64; 2] },
}

/// The larger root in magnitude is a sum without cancellation, and the other one is their product, `c/a`, over it.
fn quadric(a: Bounded, b: Bounded, c: Bounded) -> Quadric {
    if !(a.is_positive() || a.is_negative()) {
        // A line along the axis: in the disc everywhere or nowhere.
        let is_level = a.bounds() == [0.0; 2] && b.bounds() == [0.0; 2];
        return Quadric::Within(match (is_level && c.is_negative(), is_level && c.is_positive()) {
            (true, _) => Stretch::EVERYWHERE,
            (_, true) => Stretch::NOWHERE,
            _ => Stretch::UNKNOWN,
        });
    }
    let discriminant = b.squared() - a * c;
    if !discriminant.is_positive() {
        let is_outside = discriminant.is_negative() && a.is_positive();
        return Quadric::Within(if is_outside { Stretch::NOWHERE } else { Stretch::UNKNOWN });
    }
    let root = discriminant.sqrt();
    let q = if b.is_positive() { -(b + root) } else { root - b };
    let [one, other] = [(q / a).bounds(), (c / q).bounds()];
    // With `a > 0` the first is the greater one exactly if `q` is positive.
    let (low, high) = if a.is_positive() != b.is_positive() { (other, one) } else { (one, other) };
    if a.is_positive() {
        Quadric::Within(Stretch { enters: low, leaves: high })
    } else {
        Quadric::Outside { low, high }
    }
}
