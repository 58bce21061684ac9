//! The next direction of GJK for curved bodies. For polytopes, whose support points do not move with the plane, there
//! is nothing to predict.

use convex_support::numerics::angular::cross;
use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::Gjk;
use crate::body::TracedSupport;
use crate::curvature::{LARGEST_TURN, SAME_PIECE, Turned, between, share_of_second, turned};
use crate::symmetric::{Symmetric, dot};

/// Newton's method on the plane ([`curvature`](crate::curvature)), if the support map returns its curvature.
///
/// Among the unit vectors `n`, the distance of `C = A − B` from zero is the maximum of `f(n) = n·p(n)`, with `p(n)` the
/// point of `C` lowest along `n`: all of `C` lies beyond the plane through it. There `p` points along `n`. With the
/// Hessian `H` of the support value at `−n`, with `δ` the turn of `−n`, `P = p − f·n` and `ρ` the distance,
///
/// ```text
/// f(n − δ) ≈ f − P·δ − δ·(H + ρ)·δ/2,   largest where   (H + ρ)·δ = −P.
/// ```
///
/// `H` has no negative eigenvalue, so that the matrix is definite. The length of the shortest known vector is taken for
/// `ρ`; it is too large at first, which shortens the first steps. Newton's steps double the digits, and then the bounds
/// `f` and `|p|` meet, as long as `p` moves on one smooth piece of the surface.
///
/// If a known point of `C` lies before the predicted plane, it is on another piece, and the closest point is between
/// both. Three pieces that meet fix a plane by themselves: there GJK's own steps suffice. They are also taken if steps
/// by curvature do not shrink the bracket.
pub(super) struct Newton<V: Vector> {
    noise: V::Scalar,
    /// The support point found before the last one, and its direction.
    last: Option<(V, V)>,
    /// The width of the bracket before the last turn, if the last step was one.
    before: Option<V::Scalar>,
    /// Turns in a row that did not shrink the bracket, and whether there have once been as many as are allowed.
    failures: usize,
    failed: bool,
}

/// Turns that fail to halve the bracket before the next step is one of GJK.
const IDLE_TURNS: usize = 2;

/// How much lower than the first of two pieces the second is made, so that it is found next, relative to the bracket:
/// more than the error of the model, by the number of failures before.
const MODEL_ERROR: [f64; IDLE_TURNS] = [0.01, 0.2];

/// A point contradicts the model if it takes away this part of the gain.
const CONTRADICTION: f64 = 0.1;

impl<V: Vector> Newton<V> {
    pub(super) fn new(noise: V::Scalar) -> Self {
        Self { noise, last: None, before: None, failures: 0, failed: false }
    }

    /// Whether the last direction was turned by curvature.
    pub(super) fn has_turned(&self) -> bool {
        self.before.is_some()
    }

    /// The next unit direction, after `p` was found as the lowest point along the unit vector `n`, with `reach = n·p`.
    /// `None` if the next should be that of the shortest vector.
    #[inline(never)]
    pub(super) fn next<B: TracedSupport<Vector = V>>(
        &mut self,
        body: &B,
        state: &Gjk<V>,
        p: V,
        n: V,
        reach: V::Scalar,
    ) -> Option<V> {
        let last = self.last.replace((p, -n));
        let gap = state.length - state.lower;
        if let Some(before) = self.before.take() {
            if gap <= before * V::Scalar::from_f64(0.5) {
                self.failures = 0;
            } else {
                self.failures += 1;
                if self.failures >= IDLE_TURNS {
                    (self.failures, self.failed) = (0, true);
                    return None;
                }
            }
        }
        // If the plane is as far below zero as the point is above, overlap is as likely. But a vector of length `ℓ` is
        // off by the angle `ν/ℓ`, and the plane across it low by the square of that: by more than `ν` if `ℓ² < ν`.
        let is_short = !self.failed && state.length * state.length < self.noise;
        if !(reach > -state.length || is_short) {
            return None;
        }
        let model_error = self.noise + gap * V::Scalar::from_f64(MODEL_ERROR[self.failures]);
        let to = self.turn(body, state, last, LastPiece::new(body, p, -n, reach)?, model_error)?;
        self.before = Some(gap);
        Some(-to)
    }

    /// The direction of the last piece, turned.
    #[inline(always)]
    fn turn<B: TracedSupport<Vector = V>>(
        &self,
        body: &B,
        state: &Gjk<V>,
        last: Option<(V, V)>,
        piece: LastPiece<V>,
        model_error: V::Scalar,
    ) -> Option<V> {
        // One piece: (H + ρ)·δ = −P, within the largest turn, and the predicted gain of f.
        let h = piece.hessian.plus(state.length);
        let d = h.solve((-piece.aside, V::Scalar::ZERO));
        let size = dot(d, d).sqrt();
        if !size.is_finite() {
            return None;
        }
        let largest = V::Scalar::from_f64(LARGEST_TURN);
        let d = if size > largest { (d.0 * (largest / size), d.1 * (largest / size)) } else { d };
        let gain = -(piece.aside * d.0) - dot(d, h.times(d)) * V::Scalar::from_f64(0.5);
        let to = piece.turned_by(d)?;

        // The known point that lies farthest before the predicted plane.
        let mut least = piece.reach + gain * V::Scalar::from_f64(1.0 - CONTRADICTION) - self.noise;
        let mut second = None;
        let corners = state.simplex.points().iter().zip(state.simplex.along());
        for (&point, &along) in corners.chain(last.iter().map(|(point, along)| (point, along))) {
            let level = -to.dot(point);
            if level < least && point != piece.point {
                least = level;
                second = Some((point, along));
            }
        }
        match second {
            None => Some(to),
            Some(_) if V::DIM == 2 => None,
            Some((point, along)) => self.turn_between(body, &piece, point, along, state.length, model_error),
        }
    }

    /// The direction along which the last piece and that of another point, found along `from`, support one plane.
    #[inline(always)]
    fn turn_between<B: TracedSupport<Vector = V>>(
        &self,
        body: &B,
        piece: &LastPiece<V>,
        point: V,
        from: V,
        distance: V::Scalar,
        model_error: V::Scalar,
    ) -> Option<V> {
        // The other piece, turned to the direction of the last; a vertex stays, however far the turn.
        let from = from / from.dot(piece.along);
        let [u, w] = piece.basis;
        let change = piece.along - from;
        let change = (u.dot(change), w.dot(change));
        let hessian = body.hessian(from, piece.basis);
        let is_vertex = hessian.is_zero();
        let largest = V::Scalar::from_f64(LARGEST_TURN * LARGEST_TURN);
        // NaN fails this too.
        if !(is_vertex || dot(change, change) <= largest) {
            return None;
        }
        let Turned { shift, rise, hessian } = turned(hessian, (-change.0, -change.1), change);
        let apart = (u.dot(point) - piece.aside, w.dot(point));
        let e = (apart.0 + shift.0, apart.1 + shift.1);
        let foretold = V::Scalar::from_f64(SAME_PIECE) * dot(apart, apart).sqrt() + self.noise;
        if dot(e, e) <= foretold * foretold {
            return None;
        }
        let higher = -(piece.along.dot(point) + rise) - piece.reach;
        let g = if is_vertex { higher - model_error } else { higher + model_error };
        let p = (piece.aside, V::Scalar::ZERO);
        let h = piece.hessian.blend(hessian, share_of_second(p, e)).plus(distance);
        let d = between(h, p, e, g);
        // NaN fails this too.
        if dot(d, d) <= largest { piece.turned_by(d) } else { None }
    }
}

/// The piece of the surface at the last support point.
struct LastPiece<V: Vector> {
    point: V,
    /// The unit vector it was found along, and the distance of zero from its plane.
    along: V,
    reach: V::Scalar,
    /// Unit vectors across it, the first along the point's part across it, and the length of that part.
    basis: [V; 2],
    aside: V::Scalar,
    hessian: Symmetric<V::Scalar>,
}

impl<V: Vector> LastPiece<V> {
    /// `None` if the surface is not curved there.
    #[inline(always)]
    fn new<B: TracedSupport<Vector = V>>(body: &B, point: V, along: V, reach: V::Scalar) -> Option<Self> {
        let across = point + along * reach;
        let aside = across.length();
        let u = across / aside;
        let basis = [u, if V::DIM == 2 { V::ZERO } else { cross(along, u) }];
        let hessian = body.hessian(along, basis);
        (!hessian.is_zero()).then_some(Self { point, along, reach, basis, aside, hessian })
    }

    #[inline(always)]
    fn turned_by(&self, d: (V::Scalar, V::Scalar)) -> Option<V> {
        (self.along + self.basis[0] * d.0 + self.basis[1] * d.1).unit()
    }
}
