//! Passes over all points, in blocks of lanes.

use std::ops::Range;

use crate::dimension::{Dimension, LANES};
use crate::frame::Frame;
use crate::points::Points;

/// Calls `visit(i, q)` for the points in `range` with qᵢ = |T·(vᵢ − o)|² at least the cutoff that the last visit answered
/// (at first `cutoff`). Points below cost arithmetic only.
#[inline(always)]
pub(crate) fn beyond<P: Points, R: Dimension>(
    points: &P,
    range: Range<usize>,
    rank: R,
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
        // The last block repeats the last point: a maximum does not mind, and no visit is beyond the range.
        for lane in 0..LANES {
            points.read((at + lane).min(range.end - 1), v.as_mut());
            let (v, block) = (v.as_ref(), block.as_mut());
            for k in 0..n {
                block[k][lane] = v[k] - origin[k];
            }
        }
        let block = block.as_ref();
        let mut q = [0.0; LANES];
        for i in 0..r {
            let mut y = [0.0; LANES];
            for k in 0..n {
                let t = map[i * n + k];
                for lane in 0..LANES {
                    y[lane] += t * block[k][lane];
                }
            }
            for lane in 0..LANES {
                q[lane] += y[lane] * y[lane];
            }
        }
        let largest = q.iter().fold(0.0, |m: f64, &q| if q > m { q } else { m });
        if largest >= cutoff {
            for lane in 0..LANES.min(range.end - at) {
                if q[lane] >= cutoff {
                    cutoff = visit(at + lane, q[lane]);
                }
            }
        }
        at += LANES;
    }
}
