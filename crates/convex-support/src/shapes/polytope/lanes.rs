//! The farthest of a list of points by a scan that compilers turn into vector instructions.

use num_traits::{Float as _, ToPrimitive as _};

use alloc::vec::Vec;

use crate::{Scalar, Vector};

/// Points side by side: a multiple of what a vector register holds, and few enough that the best of each lane and where
/// it was stay in registers on every target.
const WIDTH: usize = 4;

/// Up to [`WIDTH`] points, coordinate by coordinate.
type Block<S> = [[S; WIDTH]; 3];

/// Points stored coordinate by coordinate.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Lanes<V: Vector> {
    blocks: Vec<Block<V::Scalar>>,
    count: usize,
}

/// The number of a block is kept as a scalar, so that one comparison selects both value and number; this many are
/// numbered exactly, with all their points, even in `f32`.
const BLOCKS_AT_ONCE: usize = 1 << 20;

impl<V: Vector> Lanes<V> {
    /// A non-empty list of points.
    pub(super) fn new(points: &[V]) -> Self {
        let coordinate = |p: V, i: usize| if i < V::DIM { p.get(i) } else { V::Scalar::ZERO };
        // The last block is filled up with the last point.
        let lane = |chunk: &[V], l: usize| chunk[l.min(chunk.len() - 1)];
        let block = |chunk: &[V]| core::array::from_fn(|i| core::array::from_fn(|l| coordinate(lane(chunk, l), i)));
        Self { blocks: points.chunks(WIDTH).map(block).collect(), count: points.len() }
    }

    /// The index of a point farthest along `direction`; any index where that is not a number.
    #[inline]
    pub(super) fn farthest(&self, direction: V) -> usize {
        let mut best = (-V::Scalar::infinity(), 0);
        for (k, blocks) in self.blocks.chunks(BLOCKS_AT_ONCE).enumerate() {
            let (reach, index) = farthest_of(blocks, direction);
            if reach > best.0 {
                best = (reach, k * BLOCKS_AT_ONCE * WIDTH + index);
            }
        }
        best.1.min(self.count - 1)
    }
}

#[inline]
fn farthest_of<V: Vector>(blocks: &[Block<V::Scalar>], direction: V) -> (V::Scalar, usize) {
    let d: [V::Scalar; 3] = core::array::from_fn(|i| if i < V::DIM { direction.get(i) } else { V::Scalar::ZERO });
    let mut best = [-V::Scalar::infinity(); WIDTH];
    let mut found = [V::Scalar::ZERO; WIDTH];
    let mut number = V::Scalar::ZERO;
    for [x, y, z] in blocks {
        for l in 0..WIDTH {
            let mut reach = d[0] * x[l] + d[1] * y[l];
            if V::DIM == 3 {
                reach += d[2] * z[l];
            }
            let farther = reach > best[l];
            best[l] = if farther { reach } else { best[l] };
            found[l] = if farther { number } else { found[l] };
        }
        number += V::Scalar::ONE;
    }
    // The number of a point from the number of its block; then the better halves, down to one.
    for (l, n) in found.iter_mut().enumerate() {
        *n = *n * V::Scalar::from_f64(WIDTH as f64) + V::Scalar::from_f64(l as f64);
    }
    let mut half = WIDTH / 2;
    while half > 0 {
        for l in 0..half {
            let farther = best[l + half] > best[l];
            best[l] = if farther { best[l + half] } else { best[l] };
            found[l] = if farther { found[l + half] } else { found[l] };
        }
        half /= 2;
    }
    (best[0], found[0].to_usize().unwrap_or(0))
}
