//! The farthest of a list of points by a scan that compilers turn into vector instructions.

use num_traits::Float as _;

use alloc::vec::Vec;

use crate::{Scalar, Vector};

/// Points side by side: a multiple of the width of a vector register on every target.
pub(crate) const PLANES: usize = 4;

/// Longer lists are searched in chunks of this many blocks, at first for the farthest support value alone.
const BLOCKS: usize = 16;

/// Up to [`PLANES`] points, coordinate by coordinate.
type Block<S> = [[S; PLANES]; 3];

/// Points stored coordinate by coordinate.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Lanes<V: Vector> {
    blocks: Vec<Block<V::Scalar>>,
    count: usize,
}

impl<V: Vector> Lanes<V> {
    /// A non-empty list of points.
    pub(super) fn new(points: &[V]) -> Self {
        Self { blocks: side_by_side(points, coordinate), count: points.len() }
    }

    /// The index of the first point farthest along the direction `(dx, dy, dz)`; any index if that is NaN.
    ///
    /// The point cannot be predicted, so nothing branches on it. To keep the index beside the support value costs half
    /// as much again; for long lists it is done only for the chunk with the farthest point. Both times the same
    /// operations are rounded alike, so that the support value is found again exactly.
    #[inline(never)]
    pub(super) fn farthest(&self, dx: V::Scalar, dy: V::Scalar, dz: V::Scalar) -> usize {
        let (mut first, mut most) = (0, -V::Scalar::infinity());
        if self.blocks.len() > BLOCKS {
            for (k, blocks) in self.blocks.chunks(BLOCKS).enumerate() {
                let [a, b, c, d] = farthest_reaches(blocks, dx, dy, dz);
                let reach = a.max(b).max(c.max(d));
                if reach > most {
                    (first, most) = (k * BLOCKS, reach);
                }
            }
        }
        let chunk = &self.blocks[first..self.blocks.len().min(first + BLOCKS)];
        let place = place_of_farthest(chunk, dx, dy, dz).as_f64();
        (first * PLANES + place as usize).min(self.count - 1)
    }
}

/// A coordinate of a vector, of which the plane has two.
pub(super) fn coordinate<V: Vector>(v: V, i: usize) -> V::Scalar {
    if i < V::DIM { v.get(i) } else { V::Scalar::ZERO }
}

/// The numbers of each of a list, [`PLANES`] of the list side by side; the last block is filled up with the last of the
/// list.
pub(super) fn side_by_side<T: Copy, S, const NUMBERS: usize>(
    list: &[T],
    number: impl Fn(T, usize) -> S,
) -> Vec<[[S; PLANES]; NUMBERS]> {
    let lane = |chunk: &[T], l: usize| chunk[l.min(chunk.len() - 1)];
    let block = |chunk: &[T]| core::array::from_fn(|i| core::array::from_fn(|l| number(lane(chunk, l), i)));
    list.chunks(PLANES).map(block).collect()
}

/// The support value of the points of each lane along a direction.
///
/// Compilers turn this loop into vector instructions only apart from its caller. And an array for the direction would
/// be written number by number and read in pairs, which takes longer than a dozen points.
#[inline(never)]
fn farthest_reaches<S: Scalar>(blocks: &[Block<S>], dx: S, dy: S, dz: S) -> [S; PLANES] {
    let mut best = [-S::infinity(); PLANES];
    for [x, y, z] in blocks {
        for l in 0..PLANES {
            let reach = dx * x[l] + dy * y[l] + dz * z[l];
            best[l] = if reach > best[l] { reach } else { best[l] };
        }
    }
    best
}

/// The place of the first point farthest along a direction, point by point and block by block, as an integer in the
/// points' own type: then support value and place are chosen by the same vector instructions.
#[inline(never)]
fn place_of_farthest<S: Scalar>(blocks: &[Block<S>], dx: S, dy: S, dz: S) -> S {
    let width = S::from_f64(PLANES as f64);
    let mut here: [S; PLANES] = core::array::from_fn(|l| S::from_f64(l as f64));
    let (mut best, mut place) = ([-S::infinity(); PLANES], here);
    for [x, y, z] in blocks {
        for l in 0..PLANES {
            let reach = dx * x[l] + dy * y[l] + dz * z[l];
            place[l] = if reach > best[l] { here[l] } else { place[l] };
            best[l] = if reach > best[l] { reach } else { best[l] };
            here[l] += width;
        }
    }
    let first = |a: (S, S), b: (S, S)| {
        let is_second = (b.0 > a.0) | ((b.0 == a.0) & (b.1 < a.1));
        (if is_second { b.0 } else { a.0 }, if is_second { b.1 } else { a.1 })
    };
    let [a, b, c, d] = core::array::from_fn(|l| (best[l], place[l]));
    first(first(a, b), first(c, d)).1
}
