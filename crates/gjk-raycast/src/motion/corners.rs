//! The corners that were closest at the last look, which mostly are so still.

use convex_support::{Scalar, Vector};

use super::placed::Placed;
use crate::body::PointPair;
use crate::simplex::{MAX_POINTS, project};

/// Corners of both cores, each relative to its body's origin and turned back to time 0.
#[derive(Clone, Copy)]
pub(super) struct Corners<V> {
    pairs: [PointPair<V>; MAX_POINTS],
    len: usize,
}

/// The face of some corners of the difference that has their point closest to zero, where the bodies are at a time.
pub(super) struct CornerFace<V: Vector> {
    points: [V; MAX_POINTS],
    pairs: [PointPair<V>; MAX_POINTS],
    pub(super) weights: [V::Scalar; MAX_POINTS],
    len: usize,
    /// The closest point.
    pub(super) v: V,
}

impl<V: Vector> Corners<V> {
    /// No corner.
    pub(super) fn none() -> Self {
        Self { pairs: [PointPair { a: V::ZERO, b: V::ZERO }; MAX_POINTS], len: 0 }
    }

    /// Takes the given corners, where the bodies are at a time, instead.
    pub(super) fn keep(&mut self, corners: impl Iterator<Item = PointPair<V>>, Placed { a, b, .. }: &Placed<'_, V>) {
        self.len = 0;
        for (to, corner) in self.pairs.iter_mut().zip(corners) {
            *to = PointPair { a: a.before(corner.a), b: b.before(corner.b) };
            self.len += 1;
        }
    }

    /// The corners of the difference, where the bodies are at a time; zero beyond the last.
    pub(super) fn differences(&self, Placed { a, b, offset, .. }: &Placed<'_, V>) -> [V; MAX_POINTS] {
        let mut points = [V::ZERO; MAX_POINTS];
        for (point, kept) in points.iter_mut().zip(&self.pairs[..self.len.min(MAX_POINTS)]) {
            *point = a.turned(kept.a) - b.turned(kept.b) + *offset;
        }
        points
    }

    /// The face closest to zero, where the bodies are at a time. Corners that leave the point closest to zero of their
    /// hull outside are dropped, which finds a face that is near if not the nearest; `None` where no face is found.
    #[inline(always)]
    pub(super) fn closest_face(&self, Placed { a, b, offset, .. }: &Placed<'_, V>) -> Option<CornerFace<V>> {
        let mut len = self.len.min(MAX_POINTS);
        let zero = PointPair { a: V::ZERO, b: V::ZERO };
        let (mut pairs, mut points) = ([zero; MAX_POINTS], [V::ZERO; MAX_POINTS]);
        for (i, kept) in self.pairs[..len].iter().enumerate() {
            pairs[i] = PointPair { a: a.turned(kept.a), b: b.turned(kept.b) };
            points[i] = pairs[i].a - pairs[i].b + *offset;
        }
        while len > 0 {
            let foot = project(&points[..len], |corner| -corner);
            let weights = foot.coordinates;
            let is_inside = |i: usize| weights[i] > V::Scalar::ZERO;
            if (0..len).all(is_inside) {
                return Some(CornerFace { points, pairs, weights, len, v: -foot.across });
            }
            // One weight at least is not positive, or NaN.
            let before = len;
            len = 0;
            for i in (0..before).filter(|&i| is_inside(i)) {
                (points[len], pairs[len]) = (points[i], pairs[i]);
                len += 1;
            }
        }
        None
    }
}

impl<V: Vector> CornerFace<V> {
    /// The points of both cores that its closest point is made of.
    #[inline(always)]
    pub(super) fn closest_points(&self) -> PointPair<V> {
        let zero = PointPair { a: V::ZERO, b: V::ZERO };
        self.corners().zip(&self.weights).fold(zero, |sum, ((_, pair), &weight)| sum.plus(pair, weight))
    }

    /// The corners, and how many they are.
    #[inline(always)]
    pub(super) fn points(&self) -> ([V; MAX_POINTS], usize) {
        (self.points, self.len)
    }

    /// The corners, and what they are made of.
    #[inline(always)]
    pub(super) fn corners(&self) -> impl Iterator<Item = (V, PointPair<V>)> + '_ {
        self.points.iter().copied().zip(self.pairs.iter().copied()).take(self.len)
    }
}
