//! Smooth pieces of a body's surface in the frame of a ray, each a quadratic model of `τ`.

use core::iter;

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::closing::OnLine;
use crate::cast::ray_frame::{Alpha, RayPoint, weights_of_zero};
use crate::curvature::{share_of_second, turned};
use crate::symmetric::{Across, Symmetric, dot, way};

/// A support point, the plane it was found on, and how it moves from there.
#[derive(Clone, Copy, Default)]
pub(super) struct RayPiece<V: Vector> {
    pub(super) p: RayPoint<V>,
    pub(super) alpha: Alpha<V::Scalar>,
    pub(super) hessian: Symmetric<V::Scalar>,
}

/// The model of a piece at another plane: `τ(α + δ) ≈ τ − P·δ − δ·Hδ/2`.
#[derive(Clone, Copy, Debug)]
pub(super) struct QuadraticModel<S> {
    pub(super) tau: S,
    /// The `(u, v)` of its support point.
    pub(super) p: Across<S>,
    pub(super) hessian: Symmetric<S>,
}

impl<S: Scalar> QuadraticModel<S> {
    pub(super) fn at(&self, change: Across<S>) -> S {
        self.tau - dot(self.p, change) - S::from_f64(0.5) * dot(change, self.hessian.times(change))
    }
}

impl<V: Vector> RayPiece<V> {
    /// The piece [turned](turned) to another plane, where nothing is crossed before `least`.
    ///
    /// The plane through the point alone is never crossed before the body, and the body's own plane earlier. The angle
    /// that the plane turns by, and the path of the point, bound the error of the model. If they are too large, or the
    /// model predicts less than was found, the point counts as a vertex. A part `error_weight` of the error is added:
    /// if a model is wrong, its piece is then found next, with a new model.
    pub(super) fn at(
        &self,
        alpha: Alpha<V::Scalar>,
        least: V::Scalar,
        error_weight: V::Scalar,
    ) -> QuadraticModel<V::Scalar> {
        let number = V::Scalar::from_f64;
        let (through, p) = (alpha.tau(&self.p), self.p.across());
        let alone = QuadraticModel { tau: through, p, hessian: Symmetric::ZERO };
        let change = way(self.alpha.across(), alpha.across());
        let angle = dot(change, change) / alpha.length_squared();
        if angle > number(LARGEST_PIECE * LARGEST_PIECE) || self.hessian.is_zero() {
            return alone;
        }
        // τ = −h, so that it sinks where h rises.
        let turned = turned(self.hessian, self.alpha.across(), change);
        let moved = dot(turned.shift, turned.shift);
        let error = turned.rise * angle.max(number(4.0) * moved).max(number(1.0 / 64.0)).sqrt();
        // NaN fails this too.
        if !(moved <= number(LARGEST_PIECE * LARGEST_PIECE) && through - turned.rise + error >= least) {
            return alone;
        }
        let tau = ((through - turned.rise).max(least) + error_weight * error).min(through);
        QuadraticModel { tau, p: (p.0 + turned.shift.0, p.1 + turned.shift.1), hessian: turned.hessian }
    }

    /// Whether another support point is of the same piece: it moved as the mean of both Hessians says, which is right
    /// to third order, and no farther than by the body's size.
    fn is_same_as(&self, other: &Self, noise: V::Scalar) -> bool {
        let number = V::Scalar::from_f64;
        let expected =
            self.hessian.blend(other.hessian, number(0.5)).times(way(self.alpha.across(), other.alpha.across()));
        let (moved, _) = self.p.edge_to(&other.p);
        let error = (moved.0 - expected.0, moved.1 - expected.1);
        let squared = dot(moved, moved);
        let allowed = (noise * noise).max(number(OFF_PIECE * OFF_PIECE) * squared);
        squared <= V::Scalar::ONE && dot(error, error) <= allowed
    }
}

/// The largest angle of a plane, and the longest path of the point, in units of the body's size, for a piece to be a
/// quadratic model.
const LARGEST_PIECE: f64 = 0.5;

/// The most pieces that are kept.
pub(super) const MAX_PIECES: usize = 4;

/// The largest distance of a point from its prediction, as a part of its path, for it to be of the same piece.
const OFF_PIECE: f64 = 0.5;

/// Whether zero is within a triangle, farther than `by` from its sides: twice the area of zero with a side is the
/// length of the side times its distance.
#[inline(always)]
pub(super) fn is_surrounded<V: Vector>([p, q, s]: [&RayPoint<V>; 3], by: V::Scalar) -> bool {
    let weights = weights_of_zero([p.across(), q.across(), s.across()]);
    let sides = [q.edge_to(s).0, s.edge_to(p).0, p.edge_to(q).0];
    let is_beyond = |i: usize| weights[i] * weights[i] > by * by * dot(sides[i], sides[i]);
    is_beyond(0) & is_beyond(1) & is_beyond(2)
}

/// The last pieces, the newest last.
pub(super) struct RayPieces<V: Vector> {
    kept: [RayPiece<V>; MAX_PIECES],
    len: usize,
}

impl<V: Vector> RayPieces<V> {
    pub(super) fn new() -> Self {
        Self { kept: [RayPiece::default(); MAX_PIECES], len: 0 }
    }

    pub(super) fn all(&self) -> &[RayPiece<V>] {
        &self.kept[..self.len]
    }

    /// Adds a piece in place of those that are the same, or otherwise of the one that is the farthest from being
    /// active. Returns whether it is the same as the last.
    pub(super) fn push(&mut self, piece: RayPiece<V>, noise: V::Scalar) -> bool {
        let again = self.all().last().is_some_and(|last| last.is_same_as(&piece, noise));
        let mut len = 0;
        for i in 0..self.len {
            if !self.kept[i].is_same_as(&piece, noise) {
                if len < i {
                    self.kept[len] = self.kept[i];
                }
                len += 1;
            }
        }
        if len == MAX_PIECES {
            let (mut idle, mut most) = (0, -V::Scalar::infinity());
            for (i, old) in self.kept.iter().enumerate() {
                let tau = old.at(piece.alpha, -V::Scalar::infinity(), V::Scalar::ZERO).tau;
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
    pub(super) fn follow(&mut self, piece: RayPiece<V>) {
        if self.len == MAX_PIECES {
            self.kept.rotate_left(1);
        } else {
            self.len += 1;
        }
        self.kept[self.len - 1] = piece;
    }

    /// The point or segment of pieces, the newest among them, that the line passes within `noise`.
    pub(super) fn passed(&self, noise: V::Scalar) -> Option<OnLine<V>> {
        let newest = self.len.checked_sub(1)?;
        let p = &self.kept[newest].p;
        // The newest alone is a segment without length, whose second point has no share.
        iter::once(newest).chain(0..newest).find_map(|i| {
            let q = &self.kept[i].p;
            let e = way(p.across(), q.across());
            let share = share_of_second(p.across(), e);
            let rest = V::Scalar::ONE - share;
            let nearest = (p.u + e.0 * share, p.v + e.1 * share);
            let weights = [rest, share, V::Scalar::ZERO];
            let found = OnLine { corners: [*p, *q, *q], weights, high: p.t * rest + q.t * share };
            (dot(nearest, nearest) <= noise * noise).then_some(found)
        })
    }
}
