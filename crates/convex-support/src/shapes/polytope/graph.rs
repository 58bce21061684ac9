//! The farthest vertex of a convex polytope among the few that can be, or by climbing along its edges.

#![cfg_attr(not(feature = "hull"), allow(dead_code, reason = "only the feature `hull` finds the edges"))]

use num_traits::Float as _;

use alloc::vec;
use alloc::vec::Vec;

use crate::{Scalar, Vector};

/// The vertices and edges of a convex polytope, and for each of many directions the vertices that can be farthest.
///
/// The directions are sorted into the cells of a grid on the faces of a cube, which is stretched as the polytope is, so
/// that a needle's cells are filled as evenly as a ball's. Each cell lists all vertices that are farthest along any
/// of its directions: with a few cells for each vertex these are a handful, whatever their number.
///
/// If they are more, as at a corner of many tiny edges, the cell keeps a vertex to climb from. If no neighbour of a
/// corner is farther along the direction than the corner, it is farthest of all: its neighbours span a cone that
/// contains the whole polytope. This does not hold for a vertex in the middle of a facet, whose neighbours are all in
/// its plane: it can also be the nearest of all. But a climb begins at a vertex that is farthest along a direction
/// less than 60° away, which such a nearest vertex is not.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Graph<V: Vector> {
    /// Sorted by their cells, relative to the middle, so that neighbours are near in memory too.
    vertices: Vec<V>,
    /// Their places in the list that was given.
    names: Vec<u32>,
    /// The neighbours of vertex `i` are `neighbours[first[i]..first[i + 1]]`.
    first: Vec<u32>,
    neighbours: Vec<u32>,
    /// The size of the polytope along each axis, in units of the largest: it stretches the cube.
    sizes: V,
    /// By face, then row, then column.
    cells: Vec<Cell>,
    /// The vertices for which there was no place in their cells.
    further: Vec<u32>,
    resolution: usize,
    half_resolution: V::Scalar,
}

/// The vertices that are farthest along some direction of the cell, those that come first in the list that was given
/// first.
///
/// Four are always tested: how many are needed cannot be predicted, and to guess wrong takes a processor longer.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cell {
    /// The first four; where there are fewer, the first again.
    vertices: [u32; HELD],
    rest: Rest,
}

/// The vertices that a cell does not hold itself.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Rest {
    None,
    /// `further[begin..end]`.
    Further {
        begin: u32,
        end: u32,
    },
    /// They are too many, and the first held is one of them, to climb from.
    Climbed,
}

/// Vertices of a feature that are found along edges; of more, all points are looked at.
pub(super) const FOLLOWED: usize = 32;

/// Vertices that a cell holds.
const HELD: usize = 4;

/// Vertices for each cell of the grid. With so many cells, nine in ten need no more than [`HELD`] vertices (measured:
/// docs/support-maps.md).
const VERTICES_PER_CELL: f64 = 0.25;

/// The longest list that is looked through rather than climbed.
const LISTED: usize = 24;

/// Vertices that a cell is searched for before it is left to be climbed.
const MANY: usize = 2 * LISTED;

impl<V: Vector> Graph<V> {
    /// A graph of vertices, whose largest coordinate is near 1, and of undirected edges, given once in each direction
    /// and in any order.
    pub(super) fn new(vertices: &[V], edges: &[[u32; 2]]) -> Self {
        let cells = vertices.len() as f64 / VERTICES_PER_CELL / (2 * V::DIM) as f64;
        let side = if V::DIM == 3 { num_traits::Float::sqrt(cells) } else { cells };
        let resolution = (side as usize).max(1);
        let size = vertices.iter().fold(V::ZERO, |size, v| size.max(v.abs()));
        // A polytope that is flat, or nearly so, is no reason for a cube that is.
        let thinnest = (size.max_element() * V::Scalar::EPSILON).max(V::Scalar::min_positive_value());
        let mut graph = Self {
            vertices: Vec::new(),
            names: Vec::new(),
            first: vec![],
            neighbours: vec![],
            sizes: size.max(V::splat(thinnest)),
            cells: vec![],
            further: vec![],
            resolution,
            half_resolution: V::Scalar::from_f64(0.5 * resolution as f64),
        };

        let count = vertices.len() as u32;
        let mut names: Vec<u32> = (0..count).collect();
        names.sort_by_cached_key(|&name| graph.cell_of_unstretched(vertices[name as usize] / graph.sizes));
        graph.names = names;
        let mut number = vec![0; vertices.len()];
        for (i, &name) in (0..).zip(&graph.names) {
            number[name as usize] = i;
        }
        graph.vertices = graph.names.iter().map(|&name| vertices[name as usize]).collect();
        let mut edges: Vec<[u32; 2]> = edges.iter().map(|edge| edge.map(|name| number[name as usize])).collect();
        edges.sort_unstable();
        edges.dedup();
        graph.first = vec![0; vertices.len() + 1];
        for &[from, _] in &edges {
            graph.first[from as usize + 1] += 1;
        }
        for i in 0..vertices.len() {
            graph.first[i + 1] += graph.first[i];
        }
        graph.neighbours = edges.into_iter().map(|[_, to]| to).collect();
        graph.fill_cells();
        graph
    }

    /// Finds the candidates of every cell.
    fn fill_cells(&mut self) {
        let mut seen_by = vec![u32::MAX; self.vertices.len()];
        let mut found = Vec::new();
        let (mut start, mut last) = (0, 0);
        let cells_of_face = if V::DIM == 3 { self.resolution * self.resolution } else { self.resolution };
        for index in 0..2 * V::DIM * cells_of_face {
            if index % cells_of_face == 0 {
                let (axis, is_negative) = (index / cells_of_face / 2, index / cells_of_face % 2 == 1);
                start = self.farthest_along_axis(axis, is_negative);
            } else if index % cells_of_face >= self.resolution {
                // The cell next to it in the row before. From the end of that row, a climb could lead half around the
                // polytope.
                start = self.cells[index - self.resolution].vertices[0];
            }
            let cone = self.cone(index);
            let farthest = self.climb_from_nearer(cone.middle, start, last);
            last = farthest;
            let all_are_found = self.collect(&cone, farthest, index as u32, &mut seen_by, &mut found);
            if all_are_found {
                let all = found.clone();
                found.retain(|&v| all.iter().all(|&u| cone.can_be_farther(self.vertex(v), self.vertex(u))));
            }
            let cell = if all_are_found && found.len() <= LISTED {
                found.sort_unstable_by_key(|&v| self.name(v));
                let (begin, rest) = (self.further.len() as u32, found.get(HELD..).unwrap_or(&[]));
                self.further.extend(rest);
                Cell {
                    vertices: core::array::from_fn(|i| *found.get(i).unwrap_or(&found[0])),
                    rest: match rest.len() as u32 {
                        0 => Rest::None,
                        count => Rest::Further { begin, end: begin + count },
                    },
                }
            } else {
                Cell { vertices: [farthest; HELD], rest: Rest::Climbed }
            };
            self.cells.push(cell);
        }
    }

    fn farthest_along_axis(&self, axis: usize, is_negative: bool) -> u32 {
        let reach = |&i: &u32| if is_negative { -self.vertex(i).get(axis) } else { self.vertex(i).get(axis) };
        (0..self.vertices.len() as u32).reduce(|best, i| if reach(&i) > reach(&best) { i } else { best }).unwrap_or(0)
    }

    /// Finds all vertices that are farthest along some direction of the cone, and perhaps others, from the one that is
    /// along its middle. Gives up where they are many, and says so by `false`.
    ///
    /// As the direction moves through the cone, the farthest vertex passes along edges, over vertices that are farthest
    /// too: they are connected. And such a vertex is farther than its neighbours somewhere in the cone.
    fn collect(
        &self,
        cone: &DirectionCone<V>,
        farthest: u32,
        cell: u32,
        seen_by: &mut [u32],
        found: &mut Vec<u32>,
    ) -> bool {
        found.clear();
        found.push(farthest);
        seen_by[farthest as usize] = cell;
        let mut visited = 0;
        while let Some(&at) = found.get(visited) {
            if found.len() > MANY {
                return false;
            }
            visited += 1;
            for &next in self.around(at) {
                if core::mem::replace(&mut seen_by[next as usize], cell) != cell {
                    let mut others = self.around(next).iter().chain([&farthest]);
                    if others.all(|&other| cone.can_be_farther(self.vertex(next), self.vertex(other))) {
                        found.push(next);
                    }
                }
            }
        }
        true
    }

    /// The neighbours of a vertex.
    #[inline]
    fn around(&self, vertex: u32) -> &[u32] {
        &self.neighbours[self.first[vertex as usize] as usize..self.first[vertex as usize + 1] as usize]
    }

    /// Vertex `index` as the search counts them.
    #[inline]
    pub(super) fn vertex(&self, index: u32) -> V {
        self.vertices[index as usize]
    }

    /// The index of a vertex in the list that the graph was made of.
    #[inline]
    pub(super) fn name(&self, index: u32) -> usize {
        self.names[index as usize] as usize
    }

    /// The index of a vertex farthest along the direction `(dx, dy, dz)`: the one that came first in the list that was
    /// given, where they are not too many to be listed. `hint` may be that of a vertex to climb from, or anything.
    ///
    /// The coordinates come one by one because a vector would pass through memory, written in other pieces than it is
    /// read in, which takes as long as all the rest.
    #[inline(never)]
    pub(super) fn farthest(&self, dx: V::Scalar, dy: V::Scalar, dz: V::Scalar, hint: u32) -> u32 {
        let direction = V::from_fn(|i| {
            if i == 0 {
                dx
            } else if i == 1 {
                dy
            } else {
                dz
            }
        });
        let Cell { vertices, rest } = &self.cells[self.cell(direction)];
        let held = |i: usize| (vertices[i], direction.dot(self.vertex(vertices[i])));
        let farther = |a: (u32, V::Scalar), b: (u32, V::Scalar)| if b.1 > a.1 { b } else { a };
        let best = farther(farther(held(0), held(1)), farther(held(2), held(3)));
        match rest {
            Rest::None => best.0,
            &Rest::Further { begin, end } => {
                let further = self.further[begin as usize..end as usize].iter();
                further.map(|&vertex| (vertex, direction.dot(self.vertex(vertex)))).fold(best, farther).0
            }
            Rest::Climbed => self.climb_from_nearer(direction, best.0, hint),
        }
    }

    /// The vertices no farther than `depth` behind the farthest one along a direction, as numbers in the list that the
    /// graph was made of and in their order; `None` where they are more than there is room for.
    ///
    /// From any vertex an edge leads up, unless it is a farthest one: those above a plane are connected.
    pub(super) fn near<'r>(
        &self,
        farthest: u32,
        direction: V,
        depth: V::Scalar,
        room: &'r mut [u32; FOLLOWED],
    ) -> Option<&'r [u32]> {
        let least = direction.dot(self.vertex(farthest)) - depth;
        *room.first_mut()? = farthest;
        let (mut looked_at, mut len) = (0, 1);
        while looked_at < len {
            for &next in self.around(room[looked_at]) {
                if direction.dot(self.vertex(next)) >= least && !room[..len].contains(&next) {
                    *room.get_mut(len)? = next;
                    len += 1;
                }
            }
            looked_at += 1;
        }
        let found = &mut room[..len];
        found.iter_mut().for_each(|vertex| *vertex = self.names[*vertex as usize]);
        found.sort_unstable();
        Some(found)
    }

    #[cold]
    #[inline(never)]
    fn climb_from_nearer(&self, direction: V, start: u32, hint: u32) -> u32 {
        let start = match self.vertices.get(hint as usize) {
            Some(&vertex) if direction.dot(vertex - self.vertex(start)) > V::Scalar::ZERO => hint,
            _ => start,
        };
        self.climb(direction, start)
    }

    /// Climbs to the best neighbour for as long as it is farther.
    ///
    /// Gains are dot products with the edges, not differences of dot products, so that they are as accurate as the
    /// edges are short: vertices that are close to one another do not stop the climb. But three corners of a facet that
    /// faces the direction can each seem a rounding farther than the one before. A climb that comes back to where it
    /// was ends there. It is watched by Brent's method: the vertex it has reached after each power of two of steps.
    fn climb(&self, direction: V, start: u32) -> u32 {
        let (mut at, mut landmark) = (start, start);
        // A path and a circle of n vertices together are closed, and found to be, within 4n steps.
        for step in 1..=4 * self.vertices.len() {
            let here = self.vertex(at);
            let mut best = (V::Scalar::ZERO, at);
            for &neighbour in self.around(at) {
                let gain = direction.dot(self.vertex(neighbour) - here);
                best = if gain > best.0 { (gain, neighbour) } else { best };
            }
            if best.1 == at || best.1 == landmark {
                return best.1;
            }
            at = best.1;
            if step.is_power_of_two() {
                landmark = at;
            }
        }
        at
    }

    /// The cell of a direction.
    #[inline(always)]
    fn cell(&self, direction: V) -> usize {
        // The polytope stretched to a cube, v/s, is seen along d∘s: d·v = (d∘s)·(v/s).
        self.cell_of_unstretched(direction * self.sizes)
    }

    /// The face of the cube that a direction leaves through, and where.
    #[inline(always)]
    fn cell_of_unstretched(&self, direction: V) -> usize {
        // Looked up rather than asked for by `get`, which would branch.
        let wrapped: [V::Scalar; 5] = core::array::from_fn(|i| direction.get(i % V::DIM));
        let (mut axis, mut largest) = (0, wrapped[0].abs());
        for i in 1..V::DIM {
            let candidate = direction.get(i).abs();
            axis = if candidate > largest { i } else { axis };
            largest = if candidate > largest { candidate } else { largest };
        }
        let mut cell = 2 * axis + usize::from(wrapped[axis] < V::Scalar::ZERO);
        let half = self.half_resolution;
        let scale = half / largest;
        for i in 1..V::DIM {
            let place = wrapped[axis + i] * scale + half;
            cell = cell * self.resolution + whole_part(place.as_f64()).min(self.resolution - 1);
        }
        cell
    }

    /// The directions of a cell, seen by the polytope as it is.
    fn cone(&self, mut cell: usize) -> DirectionCone<V> {
        let width = 1.0 / self.resolution as f64;
        let mut places = [0.0; 2];
        for i in (0..V::DIM - 1).rev() {
            places[i] = ((cell % self.resolution) as f64 + 0.5) * width * 2.0 - 1.0;
            cell /= self.resolution;
        }
        let (axis, sign) = (cell / 2, if cell.is_multiple_of(2) { 1.0 } else { -1.0 });
        let thinnest = self.sizes.min_element();
        let stretched = |on_axis: f64, across: &dyn Fn(usize) -> f64| {
            V::from_fn(|i| {
                let steps = (i + V::DIM - axis) % V::DIM;
                V::Scalar::from_f64(if steps == 0 { on_axis } else { across(steps - 1) })
                    * (thinnest / self.sizes.get(i))
            })
        };
        DirectionCone {
            middle: stretched(sign, &|i| places[i]),
            spread: stretched(0.0, &|_| width),
            // Each of three products d·v is at most 1 in the stretched cube. The reaches that are compared later, and
            // the place of a direction in its cell, are each rounded a few times.
            rounding: thinnest * V::Scalar::EPSILON * V::Scalar::from_f64(64.0),
        }
    }
}

/// The whole part of a number below 2³¹, or either neighbour of a whole one; 0 of one that is negative by rounding, and
/// anything of a NaN.
///
/// From 2⁵² to 2⁵³ the doubles are a unit apart: moved there, a number is rounded to its last bits. A cast takes twice
/// as long, since it saturates.
#[inline(always)]
fn whole_part(x: f64) -> usize {
    const AMONG_WHOLE_NUMBERS: f64 = 1.5 * (1_u64 << 52) as f64;
    let bits = (x - 0.5 + AMONG_WHOLE_NUMBERS).to_bits();
    (bits as i32).max(0) as usize
}

/// The directions `d` with `|d − middle| ≤ spread`, coordinate by coordinate.
struct DirectionCone<V: Vector> {
    middle: V,
    spread: V,
    rounding: V::Scalar,
}

impl<V: Vector> DirectionCone<V> {
    /// Whether `v` can come out as far as `u` along some direction of the cone, rounding included.
    fn can_be_farther(&self, v: V, u: V) -> bool {
        let difference = v - u;
        let most = self.middle.dot(difference) + self.spread.dot(difference.abs());
        most >= -self.rounding
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec2, DVec3, Vec3};

    fn cells_know_their_middles<V: Vector>(vertices: usize, size: V) {
        let graph = Graph::new(&vec![size; vertices], &[]);
        for cell in 0..graph.cells.len() {
            let DirectionCone { middle, .. } = graph.cone(cell);
            assert_eq!(graph.cell(middle), cell, "{middle:?}");
        }
    }

    #[test]
    fn every_cell_contains_its_middle() {
        for vertices in [1, 100, 5000] {
            cells_know_their_middles(vertices, DVec2::ONE);
            cells_know_their_middles(vertices, DVec3::ONE);
            cells_know_their_middles(vertices, Vec3::ONE);
            cells_know_their_middles(vertices, DVec3::new(1.0, 1e-12, 0.0));
            cells_know_their_middles(vertices, Vec3::new(1.0, 0.0, 1e-5));
        }
    }

    /// Three vertices that a rounding each makes a circle of, in a plane that faces the direction.
    #[test]
    fn a_climb_around_a_facet_ends() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let edges = [[0, 1], [1, 0], [1, 2], [2, 1], [2, 0], [0, 2]];
        let mut circles = 0;
        for _ in 0..1000 {
            let [a, b, c] = core::array::from_fn(|_| DVec3::new(random(), random(), random()));
            let graph = Graph::new(&[a, b, c], &edges);
            let [a, b, c] = [0, 1, 2].map(|i| graph.vertex(i));
            let normal = (b - a).cross(c - a);
            let gains = [b - a, c - b, a - c].map(|edge| normal.dot(edge) > 0.0);
            circles += usize::from(gains == [true; 3] || gains == [false; 3]);
            let reach = normal.dot(graph.vertex(graph.climb(normal, 0)));
            assert!((reach - normal.dot(a)).abs() <= 1e-15, "any corner is as far as another");
        }
        assert!(circles > 10, "{circles} circles are too few to test by");
    }
}
