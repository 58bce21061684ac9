//! The boundary of a polytope that grows point by point.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;
use smallvec::SmallVec;

use super::cores::Vertex;
use super::orientation::is_beyond;
use crate::simplex::MAX_POINTS;
use crate::simplex::nearest_face;

/// Corners of a facet, of which a polygon's has two and a polyhedron's three.
const MAX_CORNERS: usize = MAX_POINTS - 1;

/// No facet.
const NONE: u16 = u16::MAX;

/// A facet: an edge of a polygon or a triangle of a polyhedron, its corners counterclockwise as seen from outside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facet<V: Vector> {
    corners: [u16; MAX_CORNERS],
    /// The facets across the ridges opposite to each corner.
    across: [u16; MAX_CORNERS],
    /// The unit outward normal.
    pub(super) normal: V,
    /// How far, by the rounding of the normal, a point at unit distance may seem above or below the facet.
    tilt: V::Scalar,
    /// The insertion that last looked at this facet, and whether its point was beyond.
    looked: u32,
    seen: bool,
}

/// The convex hull of support points, by its vertices and facets.
///
/// A new point replaces the facets that it is beyond by those between it and their horizon. Since that is decided exactly, the
/// facets bound a convex polytope at any time, however thin, and there is nothing to repair: a point in a facet's plane is not
/// beyond it, and none of the new facets is without area.
///
/// # What it proves
/// The facets are a closed surface by construction. Where zero is below all of them, each covers a part of the directions about
/// zero, with one orientation, so that they cover them all; and so the ball about zero that is nowhere above them lies within the
/// polytope. Any unit vector `n` proves of a facet with corners `p` that none of its points is nearer to zero than `min n·p`.
#[derive(Debug)]
pub(super) struct Boundary<V: Vector> {
    vertices: SmallVec<[Vertex<V>; 64]>,
    facets: SmallVec<[Facet<V>; 128]>,
    /// A lower bound on the distance of zero from each facet, negative where zero is beyond it; infinite for what is no facet any more.
    inner: SmallVec<[V::Scalar; 128]>,
    insertions: u32,
    /// The facets that the last point was beyond, and those that take their place.
    seen: SmallVec<[u16; 32]>,
    fresh: SmallVec<[Fresh; 32]>,
}

/// A facet that is to be, between the new vertex and a ridge of the horizon.
#[derive(Clone, Copy, Debug)]
struct Fresh {
    corners: [u16; MAX_CORNERS],
    /// Which of the corners is the new vertex.
    apex: usize,
    /// The facet beyond the horizon, and the entry of its `across` that is to lead here.
    outer: (u16, usize),
    /// Which of the fresh facets are across the ridges at the new vertex.
    across: [u16; MAX_CORNERS],
}

impl<V: Vector> Boundary<V> {
    /// No polytope yet.
    pub(super) fn new() -> Self {
        Self {
            vertices: SmallVec::new(),
            facets: SmallVec::new(),
            inner: SmallVec::new(),
            insertions: 0,
            seen: SmallVec::new(),
            fresh: SmallVec::new(),
        }
    }

    /// Begins with the simplex of `DIM + 1` points; `false` where it has no volume.
    pub(super) fn begin(&mut self, points: &[Vertex<V>]) -> bool {
        self.vertices.extend_from_slice(points);
        // Facet k is the one without vertex k, seen from outside where the last point is behind the last facet.
        let faces: &[[u16; MAX_CORNERS]] = if V::DIM == 2 {
            &[[1, 2, NONE], [2, 0, NONE], [0, 1, NONE]]
        } else {
            &[[2, 1, 3], [0, 2, 3], [1, 0, 3], [0, 1, 2]]
        };
        let is_beyond_base = |order: [usize; MAX_CORNERS]| {
            let corners = order.map(|i| points[i].point);
            is_beyond(&corners[..V::DIM], points[V::DIM].point)
        };
        if is_beyond_base([0, 1, 2]) {
            self.vertices.swap(0, 1);
        } else if !is_beyond_base([1, 0, 2]) {
            return false;
        }
        for &corners in faces {
            let facet = self.facet(corners, corners);
            self.set(self.facets.len(), facet);
        }
        true
    }

    /// The facet that comes nearest to zero by its plane, or that zero is farthest beyond, and that bound.
    #[inline]
    pub(super) fn nearest(&self) -> (usize, V::Scalar) {
        let mut nearest = (0, V::Scalar::infinity());
        for (i, &inner) in self.inner.iter().enumerate() {
            if inner < nearest.1 {
                nearest = (i, inner);
            }
        }
        nearest
    }

    pub(super) fn facet_at(&self, index: usize) -> &Facet<V> {
        &self.facets[index]
    }

    /// The vertices of a facet.
    pub(super) fn corners(&self, index: usize) -> [Vertex<V>; MAX_CORNERS] {
        let corners = self.facets[index].corners;
        core::array::from_fn(|i| self.vertices[usize::from(corners[i.min(V::DIM - 1)])])
    }

    /// The number of facets.
    pub(super) fn len(&self) -> usize {
        self.inner.iter().filter(|inner| inner.is_finite()).count()
    }

    /// The facet across the ridge opposite to a corner.
    pub(super) fn across(&self, index: usize, corner: usize) -> usize {
        usize::from(self.facets[index].across[corner])
    }

    /// The least distance of zero from the planes of all facets, where each is less than computed by what `error` says of its
    /// normal.
    pub(super) fn certain_inner(&self, error: impl Fn(V) -> V::Scalar) -> V::Scalar {
        let certain = |(facet, &inner): (&Facet<V>, &V::Scalar)| inner - error(facet.normal);
        self.facets.iter().zip(&self.inner).map(certain).fold(V::Scalar::infinity(), V::Scalar::min)
    }

    /// Takes a facet for what it is and not for its plane, of which rounding leaves too little where it is a sliver: the direction of
    /// its point nearest to zero bounds its distance as well. Whether that is more than what was known.
    pub(super) fn measure(&mut self, index: usize) -> bool {
        let corners = self.corners(index).map(|v| v.point);
        let corners = &corners[..V::DIM];
        if is_beyond(corners, V::ZERO) {
            return false;
        }
        let Some(n) = nearest_face(corners, V::DIM).and_then(|nearest| nearest.v.unit()) else { return false };
        let inner = corners.iter().map(|&p| n.dot(p)).fold(V::Scalar::infinity(), V::Scalar::min);
        let is_more = inner > self.inner[index];
        if is_more {
            (self.facets[index].normal, self.inner[index]) = (n, inner);
            self.facets[index].tilt = V::Scalar::infinity();
        }
        is_more
    }

    /// Adds a point beyond some facet; whether there was one.
    pub(super) fn insert_anywhere(&mut self, vertex: Vertex<V>) -> bool {
        let found = (0..self.facets.len()).find(|&i| self.inner[i].is_finite() && self.is_seen(i, vertex.point));
        found.is_some_and(|facet| self.insert(facet, vertex))
    }

    /// Adds a point beyond the given facet. `false`, and nothing is changed, where it is not beyond it, or there are too many.
    pub(super) fn insert(&mut self, facet: usize, vertex: Vertex<V>) -> bool {
        if self.vertices.len() >= usize::from(NONE / 4) || !self.is_seen(facet, vertex.point) {
            return false;
        }
        self.look(facet, vertex.point);
        if !self.link() {
            return false;
        }
        self.vertices.push(vertex);
        let first_free = self.facets.len();
        for k in 0..self.fresh.len() {
            let new = self.fresh[k];
            let mut across = new.across.map(|k| if k == NONE { NONE } else { self.place(usize::from(k), first_free) });
            across[new.apex] = new.outer.0;
            let facet = self.facet(new.corners, across);
            self.set(usize::from(self.place(k, first_free)), facet);
        }
        for k in 0..self.fresh.len() {
            let (outer, back) = self.fresh[k].outer;
            self.facets[usize::from(outer)].across[back] = self.place(k, first_free);
        }
        for &old in self.seen.iter().skip(self.fresh.len()) {
            self.inner[usize::from(old)] = V::Scalar::infinity();
        }
        true
    }

    /// Where a fresh facet goes: in the place of an old one as long as there are any.
    fn place(&self, fresh: usize, first_free: usize) -> u16 {
        self.seen.get(fresh).copied().unwrap_or_else(|| (first_free + fresh - self.seen.len()) as u16)
    }

    /// Finds the facets that a point is beyond, beginning with one, and those that are to be between it and their horizon.
    fn look(&mut self, facet: usize, point: V) {
        let apex = self.vertices.len() as u16;
        self.insertions += 1;
        let round = self.insertions;
        self.fresh.clear();
        self.seen.clear();
        self.seen.push(facet as u16);
        (self.facets[facet].looked, self.facets[facet].seen) = (round, true);
        let mut visited = 0;
        while let Some(&index) = self.seen.get(visited) {
            visited += 1;
            let Facet { corners, across, .. } = self.facets[usize::from(index)];
            for i in 0..V::DIM {
                let next = usize::from(across[i]);
                if self.facets[next].looked != round {
                    let is_seen = self.is_seen(next, point);
                    (self.facets[next].looked, self.facets[next].seen) = (round, is_seen);
                    if is_seen {
                        self.seen.push(across[i]);
                    }
                }
                if !self.facets[next].seen {
                    let back = (0..V::DIM).find(|&j| self.facets[next].across[j] == index).unwrap_or(0);
                    let mut corners = corners;
                    corners[i] = apex;
                    self.fresh.push(Fresh { corners, apex: i, outer: (across[i], back), across: [NONE; MAX_CORNERS] });
                }
            }
        }
    }

    /// Finds for each fresh facet which of the others are across its ridges at the new vertex; `false` where the horizon is not one
    /// cycle, to which only numbers that underflow can lead.
    fn link(&mut self) -> bool {
        let count = self.fresh.len();
        for k in 0..count {
            let new = self.fresh[k];
            if V::DIM == 2 {
                if count != 2 {
                    return false;
                }
                self.fresh[k].across[1 - new.apex] = 1 - k as u16;
                continue;
            }
            // Along the horizon from one corner to the other. Opposite to the first is the facet that begins at the other.
            let [from, to] = [(new.apex + 1) % 3, (new.apex + 2) % 3];
            let begins = |f: &Fresh| f.corners[(f.apex + 1) % 3] == new.corners[to];
            let ends = |f: &Fresh| f.corners[(f.apex + 2) % 3] == new.corners[from];
            let (Some(next), Some(last)) = (self.fresh.iter().position(begins), self.fresh.iter().position(ends))
            else {
                return false;
            };
            self.fresh[k].across[from] = next as u16;
            self.fresh[k].across[to] = last as u16;
        }
        true
    }

    /// Whether a point is beyond a facet: by its plane where rounding leaves no doubt, else exactly.
    #[inline]
    fn is_seen(&self, index: usize, point: V) -> bool {
        let facet = &self.facets[index];
        let from = point - self.vertices[usize::from(facet.corners[0])].point;
        let height = facet.normal.dot(from);
        let doubt = facet.tilt * (from.abs().dot(V::ONE));
        if height.abs() > doubt {
            return height > V::Scalar::ZERO;
        }
        let corners = self.corners(index).map(|v| v.point);
        is_beyond(&corners[..V::DIM], point)
    }

    fn set(&mut self, index: usize, facet: Facet<V>) {
        let corners = &facet.corners[..V::DIM];
        let levels = corners.iter().map(|&i| facet.normal.dot(self.vertices[usize::from(i)].point));
        let inner = levels.fold(V::Scalar::infinity(), V::Scalar::min);
        if index < self.facets.len() {
            (self.facets[index], self.inner[index]) = (facet, inner);
        } else {
            self.facets.push(facet);
            self.inner.push(inner);
        }
    }

    /// A facet with its normal.
    fn facet(&self, corners: [u16; MAX_CORNERS], across: [u16; MAX_CORNERS]) -> Facet<V> {
        let at = |i: usize| self.vertices[usize::from(corners[i])].point;
        let normal = if V::DIM == 2 {
            let edge = at(1) - at(0);
            let turned = [edge.get(1), -edge.get(0)];
            V::from_fn(|i| turned[i]).unit().unwrap_or(V::ZERO)
        } else {
            triangle_normal([at(0), at(1), at(2)])
        };
        // Of a facet that is nearly without area no more is known than that its corners are near to one another, or to a line:
        // the direction of one of them bounds its distance well enough, and tells nothing of what is beyond.
        let unit = normal.unit().or_else(|| at(0).unit()).unwrap_or_else(|| V::axis(0));
        let tilt = V::Scalar::from_f64(8.0) * V::Scalar::EPSILON / normal.length();
        Facet { corners, across, normal: unit, tilt, looked: 0, seen: false }
    }
}

/// The normal of a triangle, counterclockwise as seen from where it points to, divided by the product of the lengths of two edges:
/// its rounding is relative to one. The two shortest edges leave least of it, and double precision leaves none to `f32`.
fn triangle_normal<V: Vector>(corners: [V; 3]) -> V {
    let [a, b, c] = corners.map(|p| [p.get(0), p.get(1), p.get(V::DIM - 1)].map(Scalar::as_f64));
    let edge = |from: [f64; 3], to: [f64; 3]| [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
    let edges = [edge(a, b), edge(b, c), edge(c, a)];
    let squared = edges.map(|[x, y, z]| x * x + y * y + z * z);
    let longest = (1..3).fold(0, |longest, i| if squared[i] > squared[longest] { i } else { longest });
    let (i, j) = ((longest + 1) % 3, (longest + 2) % 3);
    let per = (squared[i] * squared[j]).sqrt().recip();
    let ([ux, uy, uz], [vx, vy, vz]) = (edges[i], edges[j]);
    let normal = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    V::from_fn(|i| V::Scalar::from_f64(normal[i] * per))
}
