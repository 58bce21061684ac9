//! Passes over many points, split among the cores where the feature `rayon` is on.

use std::ops::Range;

/// Parts of at least this many points are worth a task.
#[cfg(feature = "rayon")]
const PART: usize = 1 << 15;

/// Applies `look` to ranges that together are `0..len`, and answers what it found in the order of the ranges.
///
/// Callers merge the parts such that the way of splitting does not show in the result.
#[cfg(not(feature = "rayon"))]
pub(crate) fn map_ranges<T>(len: usize, look: impl Fn(Range<usize>) -> T) -> Vec<T> {
    vec![look(0..len)]
}

/// Applies `look` to ranges that together are `0..len`, and answers what it found in the order of the ranges.
///
/// Callers merge the parts such that the way of splitting does not show in the result.
#[cfg(feature = "rayon")]
pub(crate) fn map_ranges<T: Send>(len: usize, look: impl Fn(Range<usize>) -> T + Sync) -> Vec<T> {
    use rayon::prelude::*;

    if len < 2 * PART {
        return vec![look(0..len)];
    }
    (0..len.div_ceil(PART)).into_par_iter().map(|k| look(k * PART..((k + 1) * PART).min(len))).collect()
}
