//! Where a line enters a shape, in closed form, in doubles or in sums of two doubles.

use crate::convex_hull::{Plane, planes};
use crate::real::Real;
use crate::shapes::Shape;
use crate::vec3::{Vec3, add, dot, scale, sub};

/// A shape prepared for [`entry`](Self::entry).
#[derive(Debug)]
pub(crate) struct LineEntry<'a> {
    shape: &'a Shape,
    /// The facets of a hull, empty for the other shapes.
    facets: Vec<Plane>,
}

impl<'a> LineEntry<'a> {
    pub(crate) fn new(shape: &'a Shape) -> Self {
        let facets = if let Shape::Hull { points } = shape { planes(points) } else { Vec::new() };
        Self { shape, facets }
    }

    /// The smallest `λ` with `o + λ·d` in the shape scaled by `size`; `None` if the line misses it.
    ///
    /// The line is first moved to its point closest to the shape's centre, `p = o + λ₀·d`: the formulas then subtract
    /// numbers of the size of the shape, not of the distance to it.
    pub(crate) fn entry(&self, o: Vec3, d: Vec3, size: f64) -> Option<f64> {
        let closest = -dot(o, d) / dot(d, d);
        let p = add(o, scale(d, closest));
        let from_closest = match self.shape {
            Shape::Hull { .. } => hull(p, d, &self.facets, size),
            shape => entry(shape, p, d, size),
        }?;
        Some(closest + from_closest)
    }
}

/// The smallest `λ` with `p + λ·d` in the shape scaled by `size`; `None` if the line misses it, and for hulls, whose
/// planes are not part of them.
pub fn entry<R: Real>(shape: &Shape, p: Vec3<R>, d: Vec3<R>, size: f64) -> Option<R> {
    let g = |x: f64| R::from(x) * R::from(size);
    match *shape {
        Shape::Ball { radius } => ball(p, d, g(radius)),
        Shape::Cuboid { half_extents } => cuboid(p, d, half_extents.map(g)),
        Shape::Cylinder { half_height, radius } => cylinder(p, d, 1, g(half_height), g(radius)),
        Shape::Cone { half_height, radius } => cone(p, d, g(half_height), g(radius)),
        Shape::Capsule { half_height, radius } => capsule(p, d, 1, g(half_height), g(radius)),
        Shape::Ellipsoid { semi_axes } => {
            let unit = |v: Vec3<R>| [0, 1, 2].map(|i| v[i] / g(semi_axes[i]));
            ball(unit(p), unit(d), R::from(1.0))
        }
        Shape::RoundBox { half_extents, radius } => round_box(p, d, half_extents.map(g), g(radius)),
        Shape::Hull { .. } => None,
    }
}

/// From the point of the line closest to the centre, half a chord back.
fn ball<R: Real>(p: Vec3<R>, d: Vec3<R>, radius: R) -> Option<R> {
    let a = dot(d, d);
    let closest = -dot(p, d) / a;
    let q = add(p, scale(d, closest));
    let square = radius * radius - dot(q, q);
    (square >= R::from(0.0)).then(|| closest - (square / a).sqrt())
}

/// Where `|p + λ·d| ≤ half` begins and ends.
fn slab<R: Real>(p: R, d: R, half: R) -> (R, R) {
    if d == R::from(0.0) {
        let everywhere = R::from(f64::MAX);
        return if p.abs() <= half { (-everywhere, everywhere) } else { (everywhere, -everywhere) };
    }
    let (low, high) = ((-half - p) / d, (half - p) / d);
    (low.min(high), low.max(high))
}

/// The box about the origin: the latest entry into the three slabs, if it precedes the earliest exit.
#[must_use]
pub fn cuboid<R: Real>(p: Vec3<R>, d: Vec3<R>, half: Vec3<R>) -> Option<R> {
    let [x, y, z] = [0, 1, 2].map(|i| slab(p[i], d[i], half[i]));
    let (entry, exit) = (x.0.max(y.0).max(z.0), x.1.min(y.1).min(z.1));
    (entry <= exit).then_some(entry)
}

/// Both roots of `aλ² + 2bλ + c`, the smaller first if `a > 0`, neither by a difference of like numbers.
fn roots<R: Real>(a: R, b: R, c: R) -> Option<(R, R)> {
    let zero = R::from(0.0);
    let discriminant = b * b - a * c;
    if discriminant < zero {
        return None;
    }
    let root = discriminant.sqrt();
    Some(if b > zero { ((-b - root) / a, c / (-b - root)) } else { (c / (root - b), (root - b) / a) })
}

/// The cylinder about the given coordinate axis.
fn cylinder<R: Real>(p: Vec3<R>, d: Vec3<R>, axis: usize, half_height: R, radius: R) -> Option<R> {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let (a, c) = (d[i] * d[i] + d[j] * d[j], p[i] * p[i] + p[j] * p[j] - radius * radius);
    let flat = slab(p[axis], d[axis], half_height);
    if a == R::from(0.0) {
        return (c <= a).then_some(flat.0);
    }
    let round = roots(a, p[i] * d[i] + p[j] * d[j], c)?;
    let (entry, exit) = (round.0.max(flat.0), round.1.min(flat.1));
    (entry <= exit).then_some(entry)
}

/// The first of the points on the side and on the base.
///
/// With `w` the depth below the apex and `k` the slope of the side, the double cone is `x² + z² = k²w²`; of its two
/// roots only those between base and apex belong to the cone.
fn cone<R: Real>(p: Vec3<R>, d: Vec3<R>, half_height: R, radius: R) -> Option<R> {
    let slope = radius / (half_height + half_height);
    let (k2, w) = (slope * slope, half_height - p[1]);
    let side = roots(
        d[0] * d[0] + d[2] * d[2] - k2 * d[1] * d[1],
        p[0] * d[0] + p[2] * d[2] + k2 * w * d[1],
        p[0] * p[0] + p[2] * p[2] - k2 * w * w,
    );
    let on_side = side.into_iter().flat_map(|(s, t)| [s, t]).filter(|&t| (p[1] + t * d[1]).abs() <= half_height);
    let base = (-half_height - p[1]) / d[1];
    let [x, _, z] = add(p, scale(d, base));
    let on_base = (x * x + z * z <= radius * radius).then_some(base);
    on_side.chain(on_base).reduce(Real::min)
}

/// The union of a cylinder and two balls, about the given coordinate axis.
#[must_use]
pub fn capsule<R: Real>(p: Vec3<R>, d: Vec3<R>, axis: usize, half_height: R, radius: R) -> Option<R> {
    let end = |height: R| {
        let mut center = [R::from(0.0); 3];
        center[axis] = height;
        ball(sub(p, center), d, radius)
    };
    let parts = [cylinder(p, d, axis, half_height, radius), end(half_height), end(-half_height)];
    parts.into_iter().flatten().reduce(Real::min)
}

/// The latest entry into the half-spaces, if it precedes the earliest exit.
fn hull(p: Vec3, d: Vec3, facets: &[Plane], size: f64) -> Option<f64> {
    let (mut entry, mut exit) = (f64::NEG_INFINITY, f64::INFINITY);
    for facet in facets {
        let (height, speed) = (facet.offset * size - dot(facet.normal, p), dot(facet.normal, d));
        if speed < 0.0 {
            entry = entry.max(height / speed);
        } else if speed > 0.0 {
            exit = exit.min(height / speed);
        } else if height < 0.0 {
            return None;
        }
    }
    (entry <= exit).then_some(entry)
}

/// The union of three boxes and twelve capsules.
fn round_box<R: Real>(p: Vec3<R>, d: Vec3<R>, half: Vec3<R>, radius: R) -> Option<R> {
    let mut parts = Vec::with_capacity(15);
    for axis in 0..3 {
        let mut widened = half;
        widened[axis] = widened[axis] + radius;
        parts.push(cuboid(p, d, widened));
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        for (s, t) in [(half[i], half[j]), (half[i], -half[j]), (-half[i], half[j]), (-half[i], -half[j])] {
            let mut edge = [R::from(0.0); 3];
            (edge[i], edge[j]) = (s, t);
            parts.push(capsule(sub(p, edge), d, axis, half[axis], radius));
        }
    }
    parts.into_iter().flatten().reduce(Real::min)
}
