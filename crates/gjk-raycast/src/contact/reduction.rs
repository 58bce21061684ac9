//! Which corners of an overlap are kept.

use convex_support::Scalar;
use smallvec::SmallVec;

use super::manifold::Candidate;
use super::result::MAX_POINTS;
use crate::symmetric::{Across, cross, dot};

/// The part of the area that may be lost, so that of corners that do as well the same are kept, whichever rounding prefers; four times as much to keep
/// those of the last manifold.
const WORTHWHILE: f64 = 1.0 / 64.0;

/// Corners of an overlap are numbered in their order around it. The least of what they are of both shapes begins, which does not jitter; those
/// that were `kept` before are less than others.
type Rank = (bool, [u32; 2]);

/// At most so many of the candidates: of the first `corners`, which are those of a convex polygon, some that span it well; and the deepest of
/// all, if none of them is as deep but for `slack`.
pub(super) fn reduced<S: Scalar>(
    candidates: &[Candidate<S>],
    corners: usize,
    most: usize,
    slack: S,
    kept: impl Fn(&Candidate<S>) -> bool,
    has_kept: bool,
) -> SmallVec<[Candidate<S>; MAX_POINTS]> {
    if candidates.len() <= most {
        return SmallVec::from_slice(candidates);
    }
    let rank = |i: usize| -> Rank { (!kept(&candidates[i]), candidates[i].codes()) };
    let margin = if has_kept { WORTHWHILE * 4.0 } else { WORTHWHILE };
    let mut chosen: SmallVec<[usize; MAX_POINTS]> = if corners <= most {
        (0..corners).collect()
    } else {
        SmallVec::from_slice(&spanning(candidates, corners, margin, rank))
    };
    chosen.truncate(most);
    let depth = |i: usize| -candidates[i].gap();
    let deepest = (0..candidates.len()).fold(0, |best, i| if depth(i) > depth(best) { i } else { best });
    if chosen.iter().all(|&i| depth(i) + slack < depth(deepest)) {
        let at = candidates[deepest].at;
        let squared = |i: usize| {
            let e = from(candidates[i].at, at);
            dot(e, e)
        };
        let nearest = chosen.iter().map(|&i| squared(i)).fold(S::infinity(), S::min);
        let limit = nearest * S::from_f64(1.0 + WORTHWHILE);
        let place = (0..chosen.len()).filter(|&k| squared(chosen[k]) <= limit).min_by_key(|&k| rank(chosen[k]));
        if let Some(place) = place {
            chosen[place] = deepest;
        }
    }
    chosen.iter().map(|&i| candidates[i]).collect()
}

fn from<S: Scalar>(a: Across<S>, b: Across<S>) -> Across<S> {
    (b.0 - a.0, b.1 - a.1)
}

/// Four corners of a convex polygon of more, counterclockwise, that span as much as any but for a part of that, the `margin`: of those that do, the
/// ones of least rank.
///
/// A diagonal and the corners farthest from it on either side make the most of it. As the diagonal turns, these go on around the polygon.
fn spanning<S: Scalar>(
    polygon: &[Candidate<S>],
    count: usize,
    margin: f64,
    rank: impl Fn(usize) -> Rank,
) -> [usize; 4] {
    let at = |i: usize| polygon[i % count].at;
    let twice = |i: usize, j: usize, k: usize| cross(from(at(i), at(j)), from(at(i), at(k)));
    let diagonals = |visit: &mut dyn FnMut(usize, usize, [S; 2])| {
        for i in 0..count - 2 {
            let (mut j, mut l) = (i + 1, i + 3);
            for k in i + 2..count.min(i + count - 1) {
                while j + 1 < k && twice(i, j + 1, k) >= twice(i, j, k) {
                    j += 1;
                }
                l = l.max(k + 1);
                while l + 1 < i + count && twice(k, l + 1, i) >= twice(k, l, i) {
                    l += 1;
                }
                visit(i, k, [twice(i, j, k), twice(k, l, i)]);
            }
        }
    };
    let mut most = S::ZERO;
    diagonals(&mut |_, _, [right, left]| most = most.max(right + left));
    let lost = most * S::from_f64(margin);
    let mut best: Option<([Rank; 4], [usize; 4])> = None;
    diagonals(&mut |i, k, [right, left]| {
        if right + left < most - lost {
            return;
        }
        let j = (i + 1..k).filter(|&j| twice(i, j, k) >= right - lost).min_by_key(|&j| rank(j));
        let l = (k + 1..i + count).filter(|&l| twice(k, l, i) >= left - lost).min_by_key(|&l| rank(l % count));
        let (Some(j), Some(l)) = (j, l) else { return };
        let corners = [i, k, j, l % count];
        let mut ranks = corners.map(&rank);
        ranks.sort_unstable();
        if best.is_none_or(|(least, _)| ranks < least) {
            best = Some((ranks, corners));
        }
    });
    best.map_or([0, 2, 1, 3], |(_, corners)| corners)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::outline::ContactPart;

    fn polygon(corners: impl Iterator<Item = (f64, f64)>) -> Vec<Candidate<f64>> {
        let corner = |(i, at)| Candidate {
            at,
            levels: [0.0; 2],
            error: 0.0,
            parts: [ContactPart::Vertex(i), ContactPart::Face],
        };
        (0..).zip(corners).map(corner).collect()
    }

    fn area(polygon: &[Candidate<f64>], [i, j, k, l]: [usize; 4]) -> f64 {
        let at = |i: usize| polygon[i].at;
        0.5 * cross(from(at(i), at(k)), from(at(j), at(l)))
    }

    /// Of all quadrilaterals of random polygons none spans more than a thirtieth more. Exchanging one corner at a time ended at 0.83 of the most.
    #[test]
    fn four_corners_span_nearly_as_much_as_any() {
        let mut state = 1_u64;
        let mut number = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for round in 0..400 {
            let count = 5 + round % 12;
            let mut angles: Vec<f64> = (0..count).map(|_| number() * core::f64::consts::TAU).collect();
            angles.sort_by(f64::total_cmp);
            let flat = number();
            let polygon = polygon(angles.iter().map(|angle| (angle.cos(), flat * angle.sin())));
            let [a, c, b, d] = spanning(&polygon, count, WORTHWHILE, |i| (false, polygon[i].codes()));
            let mut most = 0.0_f64;
            for i in 0..count {
                for j in i + 1..count {
                    for k in j + 1..count {
                        (k + 1..count).for_each(|l| most = most.max(area(&polygon, [i, j, k, l])));
                    }
                }
            }
            let kept = area(&polygon, [a, b, c, d]).abs();
            assert!(kept >= most * (1.0 - 2.5 * WORTHWHILE), "{round}: {kept} of {most}");
        }
    }

    /// Of a regular polygon many quadrilaterals span as much, and rounding would tell which spans most.
    #[test]
    fn what_spans_as_much_stays() {
        for count in 5..20_u32 {
            let corners = |jitter: f64| {
                polygon((0..count).map(move |i| {
                    let (sine, cosine) = (f64::from(i) * core::f64::consts::TAU / f64::from(count)).sin_cos();
                    (cosine + jitter * f64::from(i * i % 7), sine + jitter * f64::from(i * i % 5))
                }))
            };
            let chosen = |jitter: f64| {
                let polygon = corners(jitter);
                spanning(&polygon, polygon.len(), WORTHWHILE, |i| (false, polygon[i].codes()))
            };
            let still = chosen(0.0);
            for jitter in [1e-16, -1e-15, 1e-9, -1e-6, 1e-4] {
                assert_eq!(chosen(jitter), still, "{count} corners, {jitter}");
            }
        }
    }
}
