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
    /// With `n₀` the normal at which the point `p₀` was found, and `δ = n − n₀`, the plane through the point alone is crossed at
    /// `−n·p₀`, never before the body, and the body's own plane earlier. The support value `h = −τ` is homogeneous. Scaled to
    /// `n/s` with `s = n·n₀/|n₀|²`, the normal differs from `n₀` by a vector across it; there `h` is quadratic to third order on
    /// a ball or a circle, and not only to second as in `n`. As `H·n₀ = 0`, with `g = Hδ`,
    ///
    /// ```text
    /// h = s·h(n/s) ≈ n·p₀ + δ·g/(2s).
    /// ```
    ///
    /// Its derivatives are the point and its own derivative. With `m` the part of `n₀` across the ray,
    ///
    /// ```text
    /// p = p₀ + g/s − δ·g/(2s²|n₀|²)·m,   H' = H/s − (g·mᵀ + m·gᵀ)/(s²|n₀|²) + δ·g/(s³|n₀|⁴)·m·mᵀ.
    /// ```
    ///
    /// How wrong that may be is told by the angle that the plane turns by, and by how far the point moves; where that is too
    /// far, or where it foretells less than was found, a point counts for itself alone. Of what is in doubt the larger value is
    /// expected: where it is wrong, the piece shows itself, and is known anew.
    pub(crate) fn turned(&self, slant: Slant<V::Scalar>, least: V::Scalar, caution: V::Scalar) -> Turned<V::Scalar> {
        let number = V::Scalar::from_f64;
        let zero = V::Scalar::ZERO;
        let m = (self.slant.a, self.slant.b);
        let (cut, at) = (slant.crossing(&self.seen), (self.seen.u, self.seen.v));
        let alone = Turned { tau: cut, at, bend: Symmetric { a: zero, b: zero, d: zero } };
        let change = (slant.a - m.0, slant.b - m.1);
        let angle = dot(change, change) / slant.length_squared();
        if angle > number(FAR * FAR) || self.bend.is_zero() {
            return alone;
        }
        let squared = self.slant.length_squared();
        // 1/s, and 1/(s|n₀|²).
        let shrink = squared / (squared + dot(m, change));
        let share = shrink / squared;
        let g = self.bend.times(change);
        let sinks = number(0.5) * dot(change, g) * shrink;
        let lean = sinks * share;
        let shift = (g.0 * shrink - m.0 * lean, g.1 * shrink - m.1 * lean);
        let moved = dot(shift, shift);
        let doubt = sinks * angle.max(number(4.0) * moved).max(number(1.0 / 64.0)).sqrt();
        // NaN fails this too.
        if !(moved <= number(FAR * FAR) && cut - sinks + doubt >= least) {
            return alone;
        }
        let tau = ((cut - sinks).max(least) + caution * doubt).min(cut);
        // H' = H/s − (k·mᵀ + m·kᵀ) with half of the last term in each of the products.
        let k = (shift.0 * share, shift.1 * share);
        let bend = Symmetric {
            a: self.bend.a * shrink - (k.0 * m.0 + k.0 * m.0),
            b: self.bend.b * shrink - (k.0 * m.1 + k.1 * m.0),
            d: self.bend.d * shrink - (k.1 * m.1 + k.1 * m.1),
        };
        Turned { tau, at: (at.0 + shift.0, at.1 + shift.1), bend }
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
const FAR: f64 = 0.5;

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
    /// A point is the same piece's if it moved as the mean of both derivatives says, which is right to third order, and no
    /// farther than by the body's size.
    pub(crate) fn push(&mut self, piece: Piece<V, W>, noise: V::Scalar) -> bool {
        let number = V::Scalar::from_f64;
        let foretold = |old: &Piece<V, W>| {
            let change = (piece.slant.a - old.slant.a, piece.slant.b - old.slant.b);
            let expected = old.bend.blend(piece.bend, number(0.5)).times(change);
            let moved = (piece.seen.u - old.seen.u, piece.seen.v - old.seen.v);
            let error = (moved.0 - expected.0, moved.1 - expected.1);
            let squared = dot(moved, moved);
            let allowed = (noise * noise).max(number(FORETOLD * FORETOLD) * squared);
            squared <= V::Scalar::ONE && dot(error, error) <= allowed
        };
        let again = foretold(&self.kept[self.len - 1]);
        let mut len = 0;
        for i in 0..self.len {
            if !foretold(&self.kept[i]) {
                if len < i {
                    self.kept[len] = self.kept[i];
                }
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
                let sum = weights[0] + weights[1] + weights[2];
                // NaN fails this too.
                if weights.iter().all(|&w| w * sum >= zero) && sum.recip().is_finite() {
                    return below([newest, i, j], weights.map(|w| w * sum.recip()), 3);
                }
            }
        }
        None
    }
}
