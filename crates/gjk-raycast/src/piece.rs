//! Smooth pieces of a body's surface as they are seen along a ray, each a quadratic model of `τ`.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::symmetric::{Across, Symmetric, dot};
use crate::view::{Portal, Seen, Slant};

/// A support point, where it was found, and how it moves from there.
pub(crate) struct Piece<V: Vector, W> {
    pub(crate) seen: Seen<V, W>,
    pub(crate) slant: Slant<V::Scalar>,
    pub(crate) bend: Symmetric<V::Scalar>,
}

impl<V: Vector, W: Copy> Clone for Piece<V, W> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<V: Vector, W: Copy> Copy for Piece<V, W> {}

/// A piece as it is expected at another slant, to second order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turned<S> {
    /// What is expected of `τ` there.
    pub(crate) tau: S,
    /// What is expected of `(u, v)`.
    pub(crate) at: Across<S>,
    pub(crate) bend: Symmetric<S>,
}

impl<V: Vector, W: Copy> Piece<V, W> {
    /// The piece as seen from another slant, where nothing is crossed before `least`.
    ///
    /// The plane through the point alone is crossed at `cut`, never before the body, and the point that supports the body
    /// there `½·δ·Hδ` earlier, to second order. How wrong that may be is told by the angle that the plane turns by, and by how
    /// far the point moves; where that is too far, or where it foretells less than was found, a point counts for itself
    /// alone. Of what is in doubt the larger value is expected: where it is wrong, the piece shows itself, and is known anew.
    pub(crate) fn turned(&self, slant: Slant<V::Scalar>, least: V::Scalar, caution: V::Scalar) -> Turned<V::Scalar> {
        let number = V::Scalar::from_f64;
        let zero = V::Scalar::ZERO;
        let change = (slant.a - self.slant.a, slant.b - self.slant.b);
        let shift = self.bend.times(change);
        let angle = dot(change, change).sqrt() / slant.length();
        let moved = dot(shift, shift).sqrt();
        let cut = slant.crossing(&self.seen);
        let sinks = number(0.5) * dot(change, shift);
        let doubt = sinks * angle.max(moved + moved).max(number(0.125));
        if angle.max(moved) > number(FAR) || cut - sinks + doubt < least {
            let bend = Symmetric { a: zero, b: zero, d: zero };
            return Turned { tau: cut, at: (self.seen.u, self.seen.v), bend };
        }
        let tau = ((cut - sinks).max(least) + caution * doubt).min(cut);
        Turned { tau, at: (self.seen.u + shift.0, self.seen.v + shift.1), bend: self.bend }
    }
}

impl<S: Scalar> Turned<S> {
    /// The model `m(δ)`.
    pub(crate) fn model(&self, change: Across<S>) -> S {
        self.tau - dot(self.at, change) - S::from_f64(0.5) * dot(change, self.bend.times(change))
    }
}

/// The angle that a plane may turn by, and the way that the point may move, in units of the body's size, for a piece to be a
/// quadratic model.
const FAR: f64 = 0.3;

/// As many pieces as are kept.
pub(crate) const MAX_PIECES: usize = 4;

/// How far, of the way that a point has moved, it may be from where it was expected to be the same piece's.
const FORETOLD: f64 = 0.5;

/// Up to three points of the body, and a combination of them that is on the ray.
#[derive(Clone, Copy)]
pub(crate) struct Below<V: Vector, W> {
    corners: [Seen<V, W>; 3],
    weights: [V::Scalar; 3],
    len: usize,
    /// Where on the ray it is.
    pub(crate) high: V::Scalar,
}

impl<V: Vector, W> Below<V, W> {
    pub(crate) fn corners(&self) -> &[Seen<V, W>] {
        &self.corners[..self.len]
    }

    pub(crate) fn weights(&self) -> &[V::Scalar] {
        &self.weights[..self.len]
    }
}

impl<V: Vector, W> From<Portal<V, W>> for Below<V, W> {
    fn from(portal: Portal<V, W>) -> Self {
        Self { corners: portal.corners, weights: portal.weights, len: 3, high: portal.high }
    }
}

/// The last pieces, the newest last.
pub(crate) struct Pieces<V: Vector, W> {
    kept: [Piece<V, W>; MAX_PIECES],
    len: usize,
}

impl<V: Vector, W: Copy> Pieces<V, W> {
    pub(crate) fn new(first: Piece<V, W>) -> Self {
        Self { kept: [first; MAX_PIECES], len: 1 }
    }

    pub(crate) fn all(&self) -> &[Piece<V, W>] {
        &self.kept[..self.len]
    }

    /// Adds a piece in place of those that are the same, or else of the one that is the farthest from being active. Tells
    /// whether it is the same as the last.
    ///
    /// A point is the same piece's if it moved as the mean of both derivatives says, which is right to third order.
    pub(crate) fn push(&mut self, piece: Piece<V, W>, noise: V::Scalar) -> bool {
        let number = V::Scalar::from_f64;
        let foretold = |old: &Piece<V, W>| {
            let change = (piece.slant.a - old.slant.a, piece.slant.b - old.slant.b);
            let expected = old.bend.blend(piece.bend, number(0.5)).times(change);
            let moved = (piece.seen.u - old.seen.u, piece.seen.v - old.seen.v);
            let error = (moved.0 - expected.0, moved.1 - expected.1);
            let squared = dot(moved, moved);
            let allowed = (noise * noise).max(number(FORETOLD * FORETOLD) * squared);
            squared <= number(FAR * FAR) && dot(error, error) <= allowed
        };
        let again = foretold(&self.kept[self.len - 1]);
        let mut len = 0;
        for i in 0..self.len {
            if !foretold(&self.kept[i]) {
                self.kept[len] = self.kept[i];
                len += 1;
            }
        }
        if len == MAX_PIECES {
            let (mut idle, mut most) = (0, -V::Scalar::infinity());
            for (i, old) in self.kept.iter().enumerate() {
                let tau = old.turned(piece.slant, -V::Scalar::infinity(), V::Scalar::ZERO).tau;
                if tau > most {
                    (idle, most) = (i, tau);
                }
            }
            self.kept[idle..].rotate_left(1);
            len -= 1;
        }
        self.kept[len] = piece;
        self.len = len + 1;
        again
    }

    /// Adds a piece, in place of the oldest where there are as many as are kept.
    pub(crate) fn follow(&mut self, piece: Piece<V, W>) {
        if self.len == MAX_PIECES {
            self.kept.rotate_left(1);
        } else {
            self.len += 1;
        }
        self.kept[self.len - 1] = piece;
    }

    /// The point, segment or triangle of pieces, the newest among them, that the line passes within `noise`.
    pub(crate) fn passed(&self, noise: V::Scalar) -> Option<Below<V, W>> {
        let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
        let below = |corners: [usize; 3], weights: [V::Scalar; 3], len| {
            let corners = corners.map(|i| self.kept[i].seen);
            let mut high = zero;
            for (p, &weight) in corners[..len].iter().zip(&weights) {
                high += p.t * weight;
            }
            Some(Below { corners, weights, len, high })
        };
        let newest = self.len - 1;
        let p = &self.kept[newest].seen;
        if p.u * p.u + p.v * p.v <= noise * noise {
            return below([newest; 3], [one, zero, zero], 1);
        }
        for i in 0..newest {
            let q = &self.kept[i].seen;
            let (du, dv) = (q.u - p.u, q.v - p.v);
            let share = (-(p.u * du + p.v * dv) / (du * du + dv * dv)).max(zero).min(one);
            let (u, v) = (p.u + du * share, p.v + dv * share);
            if u * u + v * v <= noise * noise {
                return below([newest, i, i], [one - share, share, zero], 2);
            }
        }
        for i in 0..newest {
            for j in 0..i {
                let (q, s) = (&self.kept[i].seen, &self.kept[j].seen);
                let weights = [q.cross(s), s.cross(p), p.cross(q)];
                let inverse = (weights[0] + weights[1] + weights[2]).recip();
                let weights = weights.map(|w| w * inverse);
                // NaN fails this too.
                if weights.iter().all(|&w| w >= zero) && inverse.is_finite() {
                    return below([newest, i, j], weights, 3);
                }
            }
        }
        None
    }
}
