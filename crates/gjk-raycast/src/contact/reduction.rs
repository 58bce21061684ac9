//! Which corners of an overlap are kept: four that span it well, those of the last contact before others.

use convex_support::Scalar;
use smallvec::SmallVec;

use super::MANIFOLD_POINTS;
use super::outline::ROOM;
use crate::symmetric::{Across, cross, way};

/// The part of the area that may be lost, so that among equally good corners the same are kept, whatever the rounding;
/// four times as much to keep those of the last manifold.
pub(super) const WORTHWHILE: f64 = 1.0 / 64.0;

/// Among equally good corners, those of the least rank are kept: those of the last manifold, and then the least codes
/// of the parts of both shapes, which do not jitter.
pub(super) type Rank = (bool, [u32; 2]);

/// A point of contact in the plane: its place, the levels of both shapes there, and the [code](ContactPart::code) of
/// the part of each that it is on.
#[derive(Clone, Copy)]
pub(super) struct Candidate<S> {
    pub(super) at: Across<S>,
    pub(super) levels: [S; 2],
    pub(super) error: S,
    pub(super) codes: [u32; 2],
    /// Whether it is that of the closest points, which are more accurate than places in the plane.
    pub(super) is_closest: bool,
}

impl<S: Scalar> Candidate<S> {
    pub(super) fn gap(&self) -> S {
        -(self.levels[0] + self.levels[1])
    }
}

/// The indices of four of the candidates, which are the corners of a convex polygon, that span it well. In the plane
/// there are no more than two.
pub(super) fn reduced<S: Scalar>(
    candidates: &[Candidate<S>],
    has_last: bool,
    rank: impl Fn(usize) -> Rank,
) -> SmallVec<[usize; MANIFOLD_POINTS]> {
    let count = candidates.len();
    if count <= MANIFOLD_POINTS {
        return (0..count).collect();
    }
    let margin = if has_last { WORTHWHILE * 4.0 } else { WORTHWHILE };
    SmallVec::from_buf(spanning(candidates, margin, rank))
}

/// Four corners of a convex polygon with more, counterclockwise, that span as much as any but for the part `margin`;
/// among those, the ones of least rank.
///
/// For a given diagonal, the corners farthest from it on either side span most. As the diagonal turns, these go on
/// around the polygon.
fn spanning<S: Scalar>(polygon: &[Candidate<S>], margin: f64, rank: impl Fn(usize) -> Rank) -> [usize; 4] {
    let count = polygon.len();
    // Twice around.
    let mut at: SmallVec<[Across<S>; 2 * ROOM]> = SmallVec::new();
    at.extend(polygon.iter().chain(polygon).map(|corner| corner.at));
    let mut ranks: SmallVec<[Rank; ROOM]> = SmallVec::new();
    ranks.extend((0..count).map(rank));
    let (at, ranks) = (at.as_slice(), ranks.as_slice());
    let twice = |i: usize, j: usize, k: usize| cross(way(at[i], at[j]), way(at[i], at[k]));
    // The corner farthest from a diagonal, from one corner on and before another, and twice the area spanned with it.
    let farthest = |from: usize, to: usize, mut corner: usize, end: usize| {
        let mut most = twice(from, corner, to);
        while corner + 1 < end {
            let next = twice(from, corner + 1, to);
            if !(next >= most) {
                break;
            }
            (corner, most) = (corner + 1, next);
        }
        (corner, most)
    };
    let lost = |most: S| most * S::from_f64(margin);
    // Only diagonals that may still be good enough are kept, for which there is room.
    let mut diagonals: SmallVec<[_; 4 * ROOM]> = SmallVec::new();
    let mut most = S::ZERO;
    for i in 0..count - 2 {
        let (mut j, mut l) = (i + 1, i + 3);
        for k in i + 2..count.min(i + count - 1) {
            let (right, left);
            (j, right) = farthest(i, k, j, k);
            (l, left) = farthest(k, i, l.max(k + 1), i + count);
            most = most.max(right + left);
            let least = most - lost(most);
            // NaN is kept.
            if right + left < least {
                continue;
            }
            if diagonals.len() == diagonals.inline_size() {
                diagonals.retain(|&mut (_, _, right, left)| !(right + left < least));
            }
            diagonals.push((i, k, right, left));
        }
    }
    let lost = lost(most);
    let mut best: Option<([Rank; 4], [usize; 4])> = None;
    for (i, k, right, left) in diagonals {
        if right + left < most - lost {
            continue;
        }
        let j = (i + 1..k).filter(|&j| twice(i, j, k) >= right - lost).min_by_key(|&j| ranks[j]);
        let l = (k + 1..i + count).filter(|&l| twice(k, l, i) >= left - lost).min_by_key(|&l| ranks[l % count]);
        let (Some(j), Some(l)) = (j, l) else { continue };
        let corners = [i, k, j, l % count];
        let mut least = corners.map(|i| ranks[i]);
        least.sort_unstable();
        if best.is_none_or(|(known, _)| least < known) {
            best = Some((least, corners));
        }
    }
    best.map_or([0, 2, 1, 3], |(_, corners)| corners)
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use super::*;

    fn polygon(corners: impl Iterator<Item = (f64, f64)>) -> Vec<Candidate<f64>> {
        let corner = |(i, at)| Candidate { at, levels: [0.0; 2], error: 0.0, codes: [i, 0], is_closest: false };
        (0..).zip(corners).map(corner).collect()
    }

    fn area(polygon: &[Candidate<f64>], [i, j, k, l]: [usize; 4]) -> f64 {
        let at = |i: usize| polygon[i].at;
        0.5 * cross(way(at(i), at(k)), way(at(j), at(l)))
    }

    /// No quadrilateral of a random polygon spans more than a thirtieth more. Exchanging one corner at a time ended
    /// at 0.83 of the most.
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
            let [a, c, b, d] = spanning(&polygon, WORTHWHILE, |i| (false, polygon[i].codes));
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

    /// Many quadrilaterals of a regular polygon span equally much, and rounding would decide which spans most.
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
                spanning(&polygon, WORTHWHILE, |i| (false, polygon[i].codes))
            };
            let still = chosen(0.0);
            for jitter in [1e-16, -1e-15, 1e-9, -1e-6, 1e-4] {
                assert_eq!(chosen(jitter), still, "{count} corners, {jitter}");
            }
        }
    }
}
