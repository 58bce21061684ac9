//! The farthest vertex of a convex polytope by climbing along its edges.

#![cfg_attr(not(feature = "hull"), allow(dead_code, reason = "only the feature `hull` finds the edges"))]

use alloc::vec;
use alloc::vec::Vec;

use crate::{Scalar, Vector};

/// The vertices and edges of a convex polytope, and for each of many directions a vertex to begin at.
///
/// On a convex polytope a vertex that no neighbour is farther along than is farthest of all: its neighbours span the
/// cone that the whole polytope is in. What remains is to begin near. The directions are sorted into the cells of a grid
/// on the faces of a cube, each with a vertex that is farthest along the middle of the cell; with about as many cells as
/// vertices a climb from there takes a step or two, whatever their number.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Graph<V: Vector> {
    /// Sorted by the cell that they are in as seen from the middle, so that neighbours are near in memory too.
    vertices: Vec<V>,
    /// Where they were in the list that was given.
    names: Vec<u32>,
    /// The neighbours of vertex `i` are `neighbours[first[i]..first[i + 1]]`.
    first: Vec<u32>,
    neighbours: Vec<u32>,
    /// A vertex for each cell: by face, then row, then column.
    starts: Vec<u32>,
    resolution: usize,
}

/// Vertices for each cell of the grid. Fewer cells mean longer climbs; more of them, that the grid leaves the cache.
const VERTICES_PER_CELL: f64 = 1.0;

impl<V: Vector> Graph<V> {
    /// A graph of vertices and undirected edges, given once in each direction and in any order.
    pub(super) fn new(vertices: &[V], edges: &[[u32; 2]]) -> Self {
        let cells = vertices.len() as f64 / VERTICES_PER_CELL / (2 * V::DIM) as f64;
        let side = if V::DIM == 3 { num_traits::Float::sqrt(cells) } else { cells };
        let resolution = (side as usize).max(1);
        let mut graph = Self {
            vertices: Vec::new(),
            names: Vec::new(),
            first: vec![],
            neighbours: vec![],
            starts: vec![],
            resolution,
        };

        let count = vertices.len() as u32;
        let mut names: Vec<u32> = (0..count).collect();
        names.sort_by_cached_key(|&name| graph.cell(vertices[name as usize]));
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

        let mut at = 0;
        let columns = if V::DIM == 3 { resolution } else { 1 };
        for cell in 0..2 * V::DIM * resolution * columns {
            at = graph.climb(graph.middle(cell), at);
            graph.starts.push(at);
        }
        graph
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

    /// The index of a vertex farthest along `direction`; `hint` may be that of a vertex to begin at, or anything.
    #[inline]
    pub(super) fn farthest(&self, direction: V, hint: u32) -> u32 {
        let start = self.starts[self.cell(direction)];
        let start = match self.vertices.get(hint as usize) {
            Some(&vertex) if direction.dot(vertex - self.vertices[start as usize]) > V::Scalar::ZERO => hint,
            _ => start,
        };
        self.climb(direction, start)
    }

    /// Climbs to the best neighbour for as long as it is farther.
    ///
    /// Gains are dot products with the edges, not differences of dot products, so that they are as accurate as the
    /// edges are short: vertices that are close to one another do not stop the climb.
    #[inline]
    fn climb(&self, direction: V, start: u32) -> u32 {
        let mut at = start;
        for _ in 0..self.vertices.len() {
            let here = self.vertices[at as usize];
            let mut best = (V::Scalar::ZERO, at);
            let range = self.first[at as usize] as usize..self.first[at as usize + 1] as usize;
            for &neighbour in &self.neighbours[range] {
                let gain = direction.dot(self.vertices[neighbour as usize] - here);
                best = if gain > best.0 { (gain, neighbour) } else { best };
            }
            if best.1 == at {
                return at;
            }
            at = best.1;
        }
        self.scan(direction)
    }

    /// Should rounding ever lead a climb around in a circle.
    #[cold]
    fn scan(&self, direction: V) -> u32 {
        let reach = |i: usize| direction.dot(self.vertices[i]);
        (1..self.vertices.len()).fold(0, |best, i| if reach(i) > reach(best) { i } else { best }) as u32
    }

    /// The cell of a direction: the face of the cube it leaves through, and where.
    #[inline]
    fn cell(&self, direction: V) -> usize {
        let magnitude = direction.abs();
        let mut axis = 0;
        for i in 1..V::DIM {
            if magnitude.get(i) > magnitude.get(axis) {
                axis = i;
            }
        }
        let mut cell = 2 * axis + usize::from(direction.get(axis) < V::Scalar::ZERO);
        let half = V::Scalar::from_f64(0.5 * self.resolution as f64);
        let scale = half / magnitude.get(axis);
        for i in 1..V::DIM {
            let place = direction.get((axis + i) % V::DIM) * scale + half;
            // A cast saturates, and makes 0 of a NaN.
            cell = cell * self.resolution + (place.as_f64() as usize).min(self.resolution - 1);
        }
        cell
    }

    /// The direction of the middle of a cell.
    fn middle(&self, mut cell: usize) -> V {
        let mut places = [0.0; 2];
        for i in (0..V::DIM - 1).rev() {
            places[i] = ((cell % self.resolution) as f64 + 0.5) / self.resolution as f64 * 2.0 - 1.0;
            cell /= self.resolution;
        }
        let (axis, sign) = (cell / 2, if cell.is_multiple_of(2) { 1.0 } else { -1.0 });
        V::from_fn(|i| {
            let steps = (i + V::DIM - axis) % V::DIM;
            V::Scalar::from_f64(if steps == 0 { sign } else { places[steps - 1] })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec2, DVec3, Vec3};

    fn cells_know_their_middles<V: Vector>(vertices: usize) {
        let graph = Graph::new(&vec![V::ZERO; vertices], &[]);
        for cell in 0..graph.starts.len() {
            assert_eq!(graph.cell(graph.middle(cell)), cell, "{}", graph.middle(cell).get(0));
        }
    }

    #[test]
    fn every_cell_contains_its_middle() {
        for vertices in [1, 100, 5000] {
            cells_know_their_middles::<DVec2>(vertices);
            cells_know_their_middles::<DVec3>(vertices);
            cells_know_their_middles::<Vec3>(vertices);
        }
    }
}
