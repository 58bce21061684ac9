//! The farthest of a list of points by a scan that compilers turn into vector instructions.

use num_traits::Float as _;

use alloc::vec::Vec;

use crate::{Scalar, Vector};

/// Points side by side: a multiple of what a vector register holds on every target.
const WIDTH: usize = 4;

/// Blocks of which only the farthest reach is kept, before it is looked up which of them it was.
const BLOCKS: usize = 16;

/// Up to [`WIDTH`] points, coordinate by coordinate.
type Block<S> = [[S; WIDTH]; 3];

/// Points stored coordinate by coordinate.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Lanes<V: Vector> {
    blocks: Vec<Block<V::Scalar>>,
    count: usize,
}

impl<V: Vector> Lanes<V> {
    /// A non-empty list of points.
    pub(super) fn new(points: &[V]) -> Self {
        let coordinate = |p: V, i: usize| if i < V::DIM { p.get(i) } else { V::Scalar::ZERO };
        // The last block is filled up with the last point.
        let lane = |chunk: &[V], l: usize| chunk[l.min(chunk.len() - 1)];
        let block = |chunk: &[V]| core::array::from_fn(|i| core::array::from_fn(|l| coordinate(lane(chunk, l), i)));
        Self { blocks: points.chunks(WIDTH).map(block).collect(), count: points.len() }
    }

    /// The index of a point farthest along the direction `(dx, dy, dz)`; any index where that is not a number.
    ///
    /// Twice: first how far the farthest point of each lane reaches, which is a multiplication, an addition and a maximum
    /// for each coordinate; then which point of the best lane it was, among the few blocks where it is. Both times the
    /// same operations are rounded alike, so that the reach is found again exactly.
    #[inline(never)]
    pub(super) fn farthest(&self, dx: V::Scalar, dy: V::Scalar, dz: V::Scalar) -> usize {
        let (mut best, mut first, mut best_of_lanes) = (-V::Scalar::infinity(), 0, [V::Scalar::ZERO; WIDTH]);
        for (k, blocks) in self.blocks.chunks(BLOCKS).enumerate() {
            let of_lanes = farthest_reaches(blocks, dx, dy, dz);
            let [a, b, c, d] = of_lanes;
            let [a, b] = [if a > b { a } else { b }, if c > d { c } else { d }];
            let most = if a > b { a } else { b };
            if most > best {
                (best, first, best_of_lanes) = (most, k * BLOCKS, of_lanes);
            }
        }
        let lane = best_of_lanes.iter().position(|&reach| reach == best).unwrap_or(0);
        let is_best = |&[x, y, z]: &Block<V::Scalar>| dx * x[lane] + dy * y[lane] + dz * z[lane] == best;
        let found = self.blocks[first..].iter().position(is_best);
        found.map_or(0, |block| ((first + block) * WIDTH + lane).min(self.count - 1))
    }
}

/// How far the farthest point of each lane reaches along a direction.
///
/// Apart from its caller the loop is one that compilers turn into vector instructions; within it, it is not. And an array
/// for the direction would be written number by number and read in pairs, which takes longer than a dozen points.
#[inline(never)]
fn farthest_reaches<S: Scalar>(blocks: &[Block<S>], dx: S, dy: S, dz: S) -> [S; WIDTH] {
    let mut best = [-S::infinity(); WIDTH];
    for [x, y, z] in blocks {
        for l in 0..WIDTH {
            let reach = dx * x[l] + dy * y[l] + dz * z[l];
            best[l] = if reach > best[l] { reach } else { best[l] };
        }
    }
    best
}
