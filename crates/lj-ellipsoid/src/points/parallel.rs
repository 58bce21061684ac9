//! Passes over many points in parts, which are split among the cores with the feature `rayon`.

use std::ops::Range;

#[cfg(feature = "rayon")]
use rayon::prelude::*;

/// Parts of this many points are worth a task.
const PART: usize = 1 << 15;

/// Applies `look` to ranges that together are `0..len`, and merges the results in the order of the ranges.
///
/// The ranges depend on `len` alone, with and without `rayon` and whatever the number of cores: so does the result.
pub(crate) fn in_parts<T: Send>(len: usize, look: impl Fn(Range<usize>) -> T + Sync, merge: impl Fn(T, T) -> T) -> T {
    if len < 2 * PART {
        return look(0..len);
    }
    let part = |k: usize| look(k * PART..((k + 1) * PART).min(len));
    let rest = 1..len.div_ceil(PART);
    #[cfg(feature = "rayon")]
    if !in_turn() {
        let (first, rest) = rayon::join(|| part(0), || rest.into_par_iter().map(part).collect::<Vec<_>>());
        return rest.into_iter().fold(first, merge);
    }
    rest.map(part).fold(part(0), merge)
}

/// Whether this thread processes the parts one after the other, as without `rayon`; tests compare the two.
#[cfg(feature = "rayon")]
fn in_turn() -> bool {
    #[cfg(test)]
    return tests::IN_TURN.get();
    #[cfg(not(test))]
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(feature = "rayon")]
    thread_local! {
        pub(super) static IN_TURN: std::cell::Cell<bool> = const { std::cell::Cell::new(false) };
    }

    #[test]
    fn the_parts_are_the_whole_in_order() {
        for len in [0, 1, PART, 2 * PART - 1, 2 * PART, 2 * PART + 1, 7 * PART + 12_345] {
            let merge = |a: Range<usize>, b: Range<usize>| {
                assert_eq!(a.end, b.start, "{len} points in parts");
                a.start..b.end
            };
            assert_eq!(in_parts(len, |range| range, merge), 0..len);
        }
    }

    /// Whole answers, with `rayon` on one to five threads and without it: not a bit differs.
    #[cfg(feature = "rayon")]
    #[test]
    fn answers_are_the_same_with_and_without_rayon() {
        use crate::{EnclosingMethod, EnclosingOptions, enclosing, inscribed_in_hull};

        let mut state = 1u64;
        let mut unit = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        // Many points nearly touch in the first cloud, few in the second, all in the third.
        let cube: Vec<[f64; 2]> = (0..5 * PART / 2).map(|_| [unit(), unit()]).collect();
        let bell: Vec<[f64; 3]> =
            (0..4 * PART).map(|_| std::array::from_fn(|_| (0..12).map(|_| unit()).sum::<f64>())).collect();
        let sphere: Vec<[f64; 3]> = (0..3 * PART)
            .map(|_| {
                let x: [f64; 3] = std::array::from_fn(|_| unit() - 0.5);
                let length = x.iter().map(|x| x * x).sum::<f64>().sqrt();
                x.map(|x| x / length)
            })
            .collect();
        let answers = || {
            let options = EnclosingOptions::new();
            let slow = options.with_method(EnclosingMethod::Khachiyan).with_epsilon(1e-2);
            (
                enclosing(&cube, options),
                enclosing(&bell, options),
                enclosing(&sphere, options),
                enclosing(&bell, slow),
                inscribed_in_hull(&cube, crate::InscribedOptions::new()),
            )
        };
        IN_TURN.set(true);
        let in_turn = answers();
        IN_TURN.set(false);
        assert!(in_turn.0.is_ok() && in_turn.1.is_ok() && in_turn.2.is_ok(), "three answers");
        for threads in [1, 2, 3, 5] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            assert_eq!(pool.install(answers), in_turn, "{threads} threads");
        }
    }
}
