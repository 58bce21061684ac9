//! Passes over many points in parts, which are split among the cores where the feature `rayon` is on.

use std::ops::Range;

#[cfg(feature = "rayon")]
use rayon::prelude::*;

/// Parts of this many points are worth a task.
const PART: usize = 1 << 15;

/// Applies `look` to ranges that together are `0..len`, and answers what it found in the order of the ranges.
///
/// The ranges depend on `len` alone, with and without `rayon` and whatever the number of cores: so does the result.
pub(crate) fn map_ranges<T: Send>(len: usize, look: impl Fn(Range<usize>) -> T + Sync) -> Vec<T> {
    if len < 2 * PART {
        return vec![look(0..len)];
    }
    let parts = 0..len.div_ceil(PART);
    #[cfg(feature = "rayon")]
    let parts = parts.into_par_iter();
    parts.map(|k| look(k * PART..((k + 1) * PART).min(len))).collect()
}
