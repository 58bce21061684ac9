//! Polytopes as tables of planes.

use workloads::convex_hull::facets;
use workloads::real::{DoubleDouble, Real};
use workloads::vec3::{Vec3, cross, dot, narrow, norm, scale, sub, wide};

/// A half-space `normal·y ≤ offset` that touches a polytope, with a unit normal but for rounding.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    normal: Vec3<DoubleDouble>,
    offset: DoubleDouble,
}

impl Plane {
    pub(super) fn new(normal: Vec3<DoubleDouble>, support_value: impl Fn(Vec3<DoubleDouble>) -> DoubleDouble) -> Self {
        let normal = scale(normal, DoubleDouble::from(1.0) / norm(normal));
        Self { normal, offset: support_value(normal) }
    }
}

/// A convex polytope as the half-spaces it is the intersection of. Any that touches it may be among them.
#[derive(Clone, Debug)]
pub(super) struct Planes {
    exact: Vec<Plane>,
    rounded: Vec<(Vec3, f64)>,
    size: f64,
}

impl From<Vec<Plane>> for Planes {
    fn from(exact: Vec<Plane>) -> Self {
        let rounded: Vec<_> = exact.iter().map(|plane| (narrow(plane.normal), plane.offset.f64())).collect();
        let size = rounded.iter().map(|plane| plane.1.abs()).fold(0.0, f64::max);
        Self { exact, rounded, size }
    }
}

impl Planes {
    /// How far `p` is before the plane that it is farthest before.
    pub(super) fn beyond(&self, p: Vec3<DoubleDouble>) -> DoubleDouble {
        let least = DoubleDouble::from(f64::NEG_INFINITY);
        self.exact.iter().map(|plane| dot(plane.normal, p) - plane.offset).fold(least, Real::max)
    }

    /// The latest entry of the line `p + λ·d` into a half-space, if it precedes the earliest exit from one.
    ///
    /// Doubles tell which planes can be the first or the last, and only those are looked at exactly.
    pub(super) fn entry(&self, p: Vec3<DoubleDouble>, d: Vec3<DoubleDouble>, growth: f64) -> Option<DoubleDouble> {
        // From the point nearest to zero, where doubles have digits to spare.
        let base = -(dot(p, d) / dot(d, d));
        let near = [0, 1, 2].map(|i| p[i] + d[i] * base);
        let (x, r) = (narrow(near), narrow(d));
        let speed = norm(r);
        let (mut entry, mut exit) = (f64::NEG_INFINITY, f64::INFINITY);
        for &(normal, offset) in &self.rounded {
            let (height, slope) = (offset * growth - dot(normal, x), dot(normal, r));
            let crossing = height / slope;
            if slope < 0.0 {
                entry = entry.max(crossing);
            } else if slope > 0.0 {
                exit = exit.min(crossing);
            }
        }
        let slack = 1e-9 * self.size;
        if (entry - exit) * speed > slack {
            return None;
        }
        let (at_entry, at_exit) = ([0, 1, 2].map(|i| x[i] + r[i] * entry), [0, 1, 2].map(|i| x[i] + r[i] * exit));
        let (mut first, mut last) = (DoubleDouble::from(f64::NEG_INFINITY), DoubleDouble::from(f64::INFINITY));
        for (plane, &(normal, offset)) in self.exact.iter().zip(&self.rounded) {
            let is_near = |at: Vec3| (offset * growth - dot(normal, at)).abs() <= slack;
            if !(is_near(at_entry) || is_near(at_exit)) {
                continue;
            }
            let height = plane.offset * DoubleDouble::from(growth) - dot(plane.normal, near);
            let slope = dot(plane.normal, d);
            let zero = DoubleDouble::from(0.0);
            if slope < zero {
                first = first.max(height / slope);
            } else if slope > zero {
                last = last.min(height / slope);
            } else if height < zero {
                return None;
            }
        }
        (first <= last).then_some(base + first)
    }
}

/// The convex hull of points in general position.
#[derive(Clone, Debug)]
pub(super) struct Hull {
    pub(super) skeleton: Skeleton,
    pub(super) planes: Planes,
}

impl Hull {
    pub(super) fn of(points: &[Vec3]) -> Self {
        let facets = facets::<DoubleDouble>(points);
        let vertices: Vec<_> = points.iter().map(|&v| wide(v)).collect();
        let normals: Vec<_> = facets.iter().map(|facet| normal(points, *facet)).collect();
        let edges = facets.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).filter(|(a, b)| a < b);
        let edges = edges.map(|(a, b)| [vertices[a], sub(vertices[b], vertices[a])]).collect();
        let planes: Vec<_> = normals.iter().map(|&n| Plane::new(n, |n| support_value(&vertices, n))).collect();
        Self { skeleton: Skeleton { vertices, normals, edges }, planes: Planes::from(planes) }
    }

    pub(super) fn support_value(&self, n: Vec3<DoubleDouble>) -> DoubleDouble {
        self.skeleton.support_value(n)
    }
}

/// Doubles choose the vertices that can be farthest; those are compared exactly.
fn support_value(vertices: &[Vec3<DoubleDouble>], n: Vec3<DoubleDouble>) -> DoubleDouble {
    let rounded = narrow(n);
    let reach = |v: Vec3<DoubleDouble>| dot(narrow(v), rounded);
    let (farthest, size) = vertices
        .iter()
        .fold((f64::NEG_INFINITY, 0.0), |(farthest, size), &v| (reach(v).max(farthest), norm(narrow(v)).max(size)));
    let close = vertices.iter().filter(|&&v| reach(v) >= farthest - 1e-12 * size * norm(rounded));
    close.map(|&v| dot(v, n)).fold(DoubleDouble::from(f64::NEG_INFINITY), Real::max)
}

fn normal(vertices: &[Vec3], facet: [usize; 3]) -> Vec3<DoubleDouble> {
    let [a, b, c] = facet.map(|i| wide(vertices[i]));
    cross(sub(b, a), sub(c, a))
}

/// A polytope as seen from the world: what spans its boundary.
#[derive(Clone, Debug)]
pub(super) struct Skeleton {
    pub(super) vertices: Vec<Vec3<DoubleDouble>>,
    pub(super) normals: Vec<Vec3<DoubleDouble>>,
    /// Each by the vertex it begins at, and what leads from there to its end.
    pub(super) edges: Vec<[Vec3<DoubleDouble>; 2]>,
}

impl Skeleton {
    fn support_value(&self, n: Vec3<DoubleDouble>) -> DoubleDouble {
        support_value(&self.vertices, n)
    }
}

/// The half-spaces of the difference of two polytopes.
///
/// A facet of `A − B` has the normal of a facet of `A`, or of `−B`, or is spanned by an edge of each that both are
/// farthest along its normal.
pub(super) fn difference(a: &Skeleton, b: &Skeleton) -> Planes {
    let minus = |n: Vec3<DoubleDouble>| n.map(|c| -c);
    let value = |n| a.support_value(n) + b.support_value(minus(n));
    let mut planes: Vec<Plane> = a.normals.iter().map(|&n| Plane::new(n, value)).collect();
    planes.extend(b.normals.iter().map(|&n| Plane::new(minus(n), value)));
    let vertices = |s: &Skeleton| s.vertices.iter().map(|&v| narrow(v)).collect::<Vec<_>>();
    let (of_a, of_b) = (vertices(a), vertices(b));
    let size = of_a.iter().chain(&of_b).map(|&v| norm(v)).fold(0.0, f64::max);
    let is_farthest = |start: Vec3<DoubleDouble>, n: Vec3, all: &[Vec3]| {
        let reach = dot(narrow(start), n) + 1e-9 * size * norm(n);
        all.iter().all(|&v| dot(v, n) <= reach)
    };
    for &[start_a, edge_a] in &a.edges {
        for &[start_b, edge_b] in &b.edges {
            let n = cross(edge_a, edge_b);
            for n in [n, minus(n)] {
                let rounded = narrow(n);
                let is_facet = norm(rounded) > 0.0
                    && is_farthest(start_a, rounded, &of_a)
                    && is_farthest(start_b, rounded.map(|c| -c), &of_b);
                if is_facet {
                    planes.push(Plane::new(n, value));
                }
            }
        }
    }
    Planes::from(planes)
}
