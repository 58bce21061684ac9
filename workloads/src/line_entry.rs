//! Where a line enters a shape, in closed form: the true answers of the ray casts.

use crate::convex_hull::{Plane, planes};
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
        let from_closest = match *self.shape {
            Shape::Ball { radius } => ball(p, d, radius * size),
            Shape::Cuboid { half_extents } => cuboid(p, d, scale(half_extents, size)),
            Shape::Cylinder { half_height, radius } => cylinder(p, d, 1, half_height * size, radius * size),
            Shape::Cone { half_height, radius } => cone(p, d, half_height * size, radius * size),
            Shape::Capsule { half_height, radius } => capsule(p, d, half_height * size, radius * size),
            Shape::Ellipsoid { semi_axes } => {
                let [a, b, c] = scale(semi_axes, size);
                ball([p[0] / a, p[1] / b, p[2] / c], [d[0] / a, d[1] / b, d[2] / c], 1.0)
            }
            Shape::Hull { .. } => hull(p, d, &self.facets, size),
            Shape::RoundBox { half_extents, radius } => round_box(p, d, scale(half_extents, size), radius * size),
        }?;
        Some(closest + from_closest)
    }
}

/// From the point of the line closest to the centre, half a chord back.
fn ball(p: Vec3, d: Vec3, radius: f64) -> Option<f64> {
    let a = dot(d, d);
    let closest = -dot(p, d) / a;
    let q = add(p, scale(d, closest));
    let square = radius * radius - dot(q, q);
    (square >= 0.0).then(|| closest - (square / a).sqrt())
}

/// The latest entry into the three slabs, if it precedes the earliest exit.
fn cuboid(p: Vec3, d: Vec3, half: Vec3) -> Option<f64> {
    let slabs = [0, 1, 2].map(|i| slab(p[i], d[i], half[i]));
    let entry = slabs.iter().fold(f64::NEG_INFINITY, |latest, slab| latest.max(slab.0));
    let exit = slabs.iter().fold(f64::INFINITY, |earliest, slab| earliest.min(slab.1));
    (entry <= exit).then_some(entry)
}

/// Where `|p + λ·d| ≤ half` begins and ends.
fn slab(p: f64, d: f64, half: f64) -> (f64, f64) {
    let (low, high) = ((-half - p) / d, (half - p) / d);
    (low.min(high), low.max(high))
}

/// Both roots of `aλ² + 2bλ + c`, the smaller first if `a > 0`, neither by a difference of like numbers.
fn roots(a: f64, b: f64, c: f64) -> Option<(f64, f64)> {
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    Some(if b > 0.0 { ((-b - root) / a, c / (-b - root)) } else { (c / (-b + root), (-b + root) / a) })
}

/// The cylinder about the given coordinate axis.
fn cylinder(p: Vec3, d: Vec3, axis: usize, half_height: f64, radius: f64) -> Option<f64> {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let round =
        roots(d[i] * d[i] + d[j] * d[j], p[i] * d[i] + p[j] * d[j], p[i] * p[i] + p[j] * p[j] - radius * radius)?;
    let flat = slab(p[axis], d[axis], half_height);
    let (entry, exit) = (round.0.max(flat.0), round.1.min(flat.1));
    (entry <= exit).then_some(entry)
}

/// The first of the points on the side and on the base.
///
/// With `w` the depth below the apex and `k` the slope of the side, the double cone is `x² + z² = k²w²`; of its two roots
/// only those between base and apex belong to the cone.
fn cone(p: Vec3, d: Vec3, half_height: f64, radius: f64) -> Option<f64> {
    let slope = radius / (half_height + half_height);
    let (k2, w) = (slope * slope, half_height - p[1]);
    let side = roots(
        d[0] * d[0] + d[2] * d[2] - k2 * d[1] * d[1],
        p[0] * d[0] + p[2] * d[2] + k2 * w * d[1],
        p[0] * p[0] + p[2] * p[2] - k2 * w * w,
    );
    let on_side = side.into_iter().flat_map(|(s, t)| [s, t]).filter(|t| (p[1] + t * d[1]).abs() <= half_height);
    let base = (-half_height - p[1]) / d[1];
    let [x, _, z] = add(p, scale(d, base));
    let on_base = (x * x + z * z <= radius * radius).then_some(base);
    on_side.chain(on_base).reduce(f64::min)
}

/// The union of a cylinder and two balls.
fn capsule(p: Vec3, d: Vec3, half_height: f64, radius: f64) -> Option<f64> {
    let end = |y: f64| ball(sub(p, [0.0, y, 0.0]), d, radius);
    [cylinder(p, d, 1, half_height, radius), end(half_height), end(-half_height)].into_iter().flatten().reduce(f64::min)
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

/// The union of three boxes, twelve cylinders and eight balls.
fn round_box(p: Vec3, d: Vec3, half: Vec3, radius: f64) -> Option<f64> {
    const SIGNS: [[f64; 2]; 4] = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let mut parts = Vec::with_capacity(23);
    for axis in 0..3 {
        let mut widened = half;
        widened[axis] += radius;
        parts.push(cuboid(p, d, widened));
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        for [s, t] in SIGNS {
            let mut edge = [0.0; 3];
            (edge[i], edge[j]) = (s * half[i], t * half[j]);
            parts.push(cylinder(sub(p, edge), d, axis, half[axis], radius));
        }
    }
    for side in [1.0, -1.0] {
        for [s, t] in SIGNS {
            parts.push(ball(sub(p, [side * half[0], s * half[1], t * half[2]]), d, radius));
        }
    }
    parts.into_iter().flatten().reduce(f64::min)
}
