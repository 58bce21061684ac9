//! The convex hull of points in two and three dimensions, as half-spaces.
//!
//! Which side of a facet a point lies on is decided by exact predicates (Shewchuk's, in the `robust` crate), so the
//! hull is a closed convex surface however nearly coplanar the points. Planes are then computed in floating point from
//! the largest triangle of each flat face, and moved out to the neighbouring vertices: a sliver with a poor normal
//! gives a superfluous half-space, never a cut into the hull.
//!
//! # References
//! C. B. Barber, D. P. Dobkin, H. Huhdanpaa, *The quickhull algorithm for convex hulls*, ACM Trans. Math. Softw. 22
//! (1996).

use robust::{Coord, Coord3D, orient2d, orient3d};

/// Facet planes of a hull: unit normals and offsets, n·x ≤ b.
pub(crate) struct Facets {
    pub(crate) normals: Vec<f64>,
    pub(crate) offsets: Vec<f64>,
    /// The least n·x over the corners that the facet stands for, to rounding. The edges or triangles of all facets are
    /// a closed surface, so that a set inside that is below all of these planes is within the hull.
    pub(crate) depths: Vec<f64>,
}

/// The edges of the hull of points in the plane, by Andrew's monotone chain.
pub(crate) fn hull2(points: &[[f64; 2]]) -> Facets {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&i, &j| points[i][0].total_cmp(&points[j][0]).then(points[i][1].total_cmp(&points[j][1])));
    order.dedup_by(|i, j| points[*i] == points[*j]);
    let coord = |i: usize| Coord { x: points[i][0], y: points[i][1] };
    let chain = |order: &mut dyn Iterator<Item = usize>| {
        let mut chain: Vec<usize> = Vec::new();
        for i in order {
            while let [.., a, b] = chain[..]
                && orient2d(coord(a), coord(b), coord(i)) <= 0.0
            {
                chain.pop();
            }
            chain.push(i);
        }
        chain.pop();
        chain
    };
    let mut ring = chain(&mut order.iter().copied());
    ring.extend(chain(&mut order.iter().rev().copied()));
    let m = ring.len();
    let mut facets =
        Facets { normals: Vec::with_capacity(2 * m), offsets: Vec::with_capacity(m), depths: Vec::with_capacity(m) };
    for k in 0..ring.len() {
        let (a, b) = (points[ring[k]], points[ring[(k + 1) % ring.len()]]);
        let length = libm::hypot(b[0] - a[0], b[1] - a[1]);
        let normal = [(b[1] - a[1]) / length, (a[0] - b[0]) / length];
        let next = points[ring[(k + 2) % ring.len()]];
        let previous = points[ring[(k + ring.len() - 1) % ring.len()]];
        let along = |p: [f64; 2]| normal[0] * p[0] + normal[1] * p[1];
        facets.normals.extend(normal);
        facets.offsets.push([a, b, next, previous].into_iter().map(along).fold(f64::NEG_INFINITY, f64::max));
        facets.depths.push(along(a).min(along(b)));
    }
    facets
}

/// A triangle of the growing hull, counterclockwise seen from outside.
struct Triangle {
    vertices: [usize; 3],
    /// The triangle across the edge from vertex k to vertex k + 1.
    neighbors: [usize; 3],
    normal: [f64; 3],
    offset: f64,
    /// Twice the area.
    size: f64,
    /// Points beyond this plane that are still to be added.
    outside: Vec<usize>,
    alive: bool,
}

fn subtract(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot3(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

struct Hull3<'a> {
    points: &'a [[f64; 3]],
    triangles: Vec<Triangle>,
    /// The distance within which points count as not beyond a plane.
    tolerance: f64,
}

impl Hull3<'_> {
    fn triangle(&self, vertices: [usize; 3]) -> Triangle {
        let [a, b, c] = vertices.map(|i| self.points[i]);
        let mut normal = cross(subtract(b, a), subtract(c, a));
        let size = dot3(normal, normal).sqrt();
        // A triangle too thin for a normal has no point beyond it and bounds nothing.
        let offset = if size > 0.0 {
            normal = normal.map(|x| x / size);
            dot3(normal, a)
        } else {
            f64::INFINITY
        };
        Triangle { vertices, neighbors: [usize::MAX; 3], normal, offset, size, outside: Vec::new(), alive: true }
    }

    /// Whether point `i` lies strictly beyond the plane, exactly.
    fn sees(&self, triangle: usize, i: usize) -> bool {
        let coord = |i: usize| {
            let [x, y, z] = self.points[i];
            Coord3D { x, y, z }
        };
        let [a, b, c] = self.triangles[triangle].vertices;
        orient3d(coord(a), coord(b), coord(c), coord(i)) < 0.0
    }

    fn height(&self, triangle: usize, i: usize) -> f64 {
        dot3(self.triangles[triangle].normal, self.points[i]) - self.triangles[triangle].offset
    }

    /// Assigns every point to the first of `triangles` that it is beyond; the others are inside, up to the tolerance.
    fn distribute(&mut self, points: impl Iterator<Item = usize>, triangles: &[usize]) {
        for i in points {
            for &t in triangles {
                if self.height(t, i) > self.tolerance && self.sees(t, i) {
                    self.triangles[t].outside.push(i);
                    break;
                }
            }
        }
    }

    /// Replaces the triangles that `eye` sees by the cone from `eye` over their horizon; returns the new ones.
    fn add(&mut self, seed: usize, eye: usize, orphans: &mut Vec<usize>) -> Vec<usize> {
        let mut visible = vec![seed];
        self.triangles[seed].alive = false;
        // Horizon edges a → b, with the triangle beyond.
        let mut horizon = Vec::new();
        let mut at = 0;
        while at < visible.len() {
            let t = visible[at];
            at += 1;
            for k in 0..3 {
                let other = self.triangles[t].neighbors[k];
                if !self.triangles[other].alive {
                    continue;
                }
                if self.sees(other, eye) {
                    self.triangles[other].alive = false;
                    visible.push(other);
                }
            }
        }
        for &t in &visible {
            orphans.append(&mut self.triangles[t].outside);
            for k in 0..3 {
                let other = self.triangles[t].neighbors[k];
                if self.triangles[other].alive {
                    let v = self.triangles[t].vertices;
                    horizon.push((v[k], v[(k + 1) % 3], other));
                }
            }
        }
        let first = self.triangles.len();
        let mut from = std::collections::HashMap::with_capacity(horizon.len());
        let mut to = std::collections::HashMap::with_capacity(horizon.len());
        for (k, &(a, b, beyond)) in horizon.iter().enumerate() {
            let mut triangle = self.triangle([a, b, eye]);
            triangle.neighbors[0] = beyond;
            self.triangles.push(triangle);
            let across = &mut self.triangles[beyond];
            if let Some(edge) = (0..3).find(|&e| across.vertices[e] == b && across.vertices[(e + 1) % 3] == a) {
                across.neighbors[edge] = first + k;
            }
            from.insert(a, first + k);
            to.insert(b, first + k);
        }
        for (k, &(a, b, _)) in horizon.iter().enumerate() {
            self.triangles[first + k].neighbors[1] = from[&b];
            self.triangles[first + k].neighbors[2] = to[&a];
        }
        (first..first + horizon.len()).collect()
    }
}

/// Four points of a tetrahedron of good size, or `None` if the points are flat.
fn tetrahedron(points: &[[f64; 3]]) -> Option<[usize; 4]> {
    let furthest = |measure: &dyn Fn([f64; 3]) -> f64| {
        (0..points.len()).map(|i| (i, measure(points[i]))).fold((0, -1.0), |m, now| if now.1 > m.1 { now } else { m })
    };
    let a = furthest(&|p| dot3(p, p)).0;
    let b = furthest(&|p| dot3(subtract(p, points[a]), subtract(p, points[a]))).0;
    let ab = subtract(points[b], points[a]);
    let area = |p| {
        let n = cross(ab, subtract(p, points[a]));
        dot3(n, n)
    };
    let c = furthest(&area).0;
    let normal = cross(ab, subtract(points[c], points[a]));
    let (d, height) = furthest(&|p| dot3(normal, subtract(p, points[a])).abs());
    if !(height > 0.0) {
        return None;
    }
    // Oriented so that d lies below the triangle a, b, c.
    if dot3(normal, subtract(points[d], points[a])) > 0.0 { Some([a, c, b, d]) } else { Some([a, b, c, d]) }
}

/// The faces of the hull of points in space, in coordinates in which they are of unit size; points within `tolerance`
/// of a plane are not beyond it. `None` if the points are flat.
pub(crate) fn hull3(points: &[[f64; 3]], tolerance: f64) -> Option<Facets> {
    let [a, b, c, d] = tetrahedron(points)?;
    let mut hull = Hull3 { points, triangles: Vec::new(), tolerance };
    for vertices in [[a, b, c], [a, d, b], [b, d, c], [c, d, a]] {
        let triangle = hull.triangle(vertices);
        hull.triangles.push(triangle);
    }
    // Each neighbour shares an edge in the opposite sense.
    for t in 0..4 {
        for k in 0..3 {
            let (from, to) = (hull.triangles[t].vertices[k], hull.triangles[t].vertices[(k + 1) % 3]);
            hull.triangles[t].neighbors[k] = (0..4).find(|&o| {
                let v = hull.triangles[o].vertices;
                (0..3).any(|e| v[e] == to && v[(e + 1) % 3] == from)
            })?;
        }
    }
    if (0..4)
        .any(|t| hull.sees(t, [a, b, c, d].into_iter().find(|v| !hull.triangles[t].vertices.contains(v)).unwrap_or(a)))
    {
        return None;
    }
    hull.distribute(0..points.len(), &[0, 1, 2, 3]);
    let mut next = 0;
    let mut orphans = Vec::new();
    while next < hull.triangles.len() {
        if !hull.triangles[next].alive || hull.triangles[next].outside.is_empty() {
            next += 1;
            continue;
        }
        let eye = hull.triangles[next]
            .outside
            .iter()
            .map(|&i| (i, hull.height(next, i)))
            .fold((usize::MAX, f64::NEG_INFINITY), |m, now| if now.1 > m.1 { now } else { m })
            .0;
        orphans.clear();
        let fresh = hull.add(next, eye, &mut orphans);
        orphans.retain(|&i| i != eye);
        hull.distribute(orphans.drain(..), &fresh);
    }
    Some(faces(&hull))
}

/// One half-space per flat face: triangles that share an edge and a plane are one, with the plane of the largest.
fn faces(hull: &Hull3<'_>) -> Facets {
    let mut order: Vec<usize> = (0..hull.triangles.len()).filter(|&t| hull.triangles[t].alive).collect();
    order.sort_by(|&s, &t| hull.triangles[t].size.total_cmp(&hull.triangles[s].size));
    let mut merged = vec![false; hull.triangles.len()];
    let mut facets = Facets { normals: Vec::new(), offsets: Vec::new(), depths: Vec::new() };
    for seed in order {
        let plane = &hull.triangles[seed];
        if merged[seed] || !plane.offset.is_finite() {
            continue;
        }
        let (mut offset, mut depth) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut stack = vec![seed];
        merged[seed] = true;
        while let Some(t) = stack.pop() {
            for &v in &hull.triangles[t].vertices {
                let along = dot3(plane.normal, hull.points[v]);
                (offset, depth) = (offset.max(along), depth.min(along));
            }
            for &other in &hull.triangles[t].neighbors {
                // Convexity: a plane that no neighbouring vertex is beyond bounds the hull.
                let heights = hull.triangles[other].vertices.map(|v| dot3(plane.normal, hull.points[v]) - plane.offset);
                offset = heights.iter().fold(offset, |m, h| m.max(h + plane.offset));
                if !merged[other] && heights.iter().all(|h| h.abs() <= 2.0 * hull.tolerance) {
                    merged[other] = true;
                    stack.push(other);
                }
            }
        }
        facets.normals.extend(plane.normal);
        facets.offsets.push(offset);
        facets.depths.push(depth);
    }
    facets
}
