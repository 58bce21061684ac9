//! Passes over all points, in blocks of lanes.

use std::ops::Range;

use crate::enclosing::frame::Frame;
use crate::numerics::dimension::{Dimension, LANES};
use crate::points::Points;

/// Calls `visit(i, q)` for the points in `range` with qᵢ = |T·(vᵢ − o)|² at least the cutoff that the last visit
/// returned (at first `cutoff`). Points below cost arithmetic only.
#[inline(always)]
pub(crate) fn beyond<P: Points>(
    points: &P,
    range: Range<usize>,
    rank: P::Dim,
    frame: &Frame<P::Dim>,
    mut cutoff: f64,
    mut visit: impl FnMut(usize, f64) -> f64,
) {
    let dim = points.dim();
    let (n, r) = (dim.get(), rank.get());
    let (origin, map) = (&frame.origin.as_ref()[..n], &frame.map()[..r * n]);
    let mut v = dim.zero();
    let mut block = dim.zero_block();
    let mut at = range.start;
    while at < range.end {
        // The last block repeats the last point: a maximum is unaffected, and no visit is beyond the range.
        let block = &mut block.as_mut()[..n];
        points.read_block(at, range.end, v.as_mut(), block);
        for k in 0..n {
            for lane in 0..LANES {
                block[k][lane] -= origin[k];
            }
        }
        let mut q = [0.0; LANES];
        for i in 0..r {
            let mut y = block[0];
            y.iter_mut().for_each(|x| *x *= map[i * n]);
            for k in 1..n {
                let t = map[i * n + k];
                for lane in 0..LANES {
                    y[lane] += t * block[k][lane];
                }
            }
            for lane in 0..LANES {
                q[lane] += y[lane] * y[lane];
            }
        }
        if q.iter().fold(false, |any, &q| any | (q >= cutoff)) {
            for lane in 0..LANES {
                if q[lane] >= cutoff && at + lane < range.end {
                    cutoff = visit(at + lane, q[lane]);
                }
            }
        }
        at += LANES;
    }
}
