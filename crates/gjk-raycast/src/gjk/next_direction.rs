//! The next direction of GJK: along its shortest vector, or along one that is turned from it by curvature or towards
//! the best plane known.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::state::in_range;
use super::{Direction, Gjk};
use crate::body::TracedSupport;
use crate::curvature::{LARGEST_TURN, SAME_PIECE, Turned, between, share_of_second, turned};
use crate::simplex::cross;
use crate::symmetric::{Symmetric, dot};

/// Chooses the next direction.
pub(super) struct NextDirection<V: Vector> {
    curved: bool,
    newton: Newton<V>,
    /// Whether the last direction was chosen between the shortest vector and the best plane.
    levelled: bool,
}

impl<V: Vector> NextDirection<V> {
    /// `curved` if steps by curvature are worthwhile.
    pub(super) fn new(curved: bool, noise: V::Scalar) -> Self {
        Self { curved, newton: Newton::new(noise), levelled: false }
    }

    /// Whether the last direction is not that of the shortest vector.
    pub(super) fn has_turned(&self) -> bool {
        self.levelled || self.newton.before.is_some()
    }

    /// The direction after a turned one, whose support point `w`, with `reach` along it, brings the simplex no nearer.
    #[inline(always)]
    pub(super) fn turn_again<B: TracedSupport<Vector = V>>(
        &mut self,
        body: &B,
        state: &Gjk<V>,
        looked: Direction<V>,
        w: V,
        reach: V::Scalar,
    ) -> Direction<V> {
        let turned =
            if self.levelled { None } else { self.newton.next(body, state, w, looked.n / looked.length, reach) };
        self.levelled = false;
        turned.map_or_else(|| state.along_normal(), |n| Direction { n, length: Scalar::ONE })
    }

    /// The direction after a step to the shortest vector, by the support point `w` with `reach` along the last
    /// direction.
    #[inline(always)]
    pub(super) fn after<B: TracedSupport<Vector = V>>(
        &mut self,
        body: &B,
        state: &Gjk<V>,
        looked: Direction<V>,
        w: V,
        reach: V::Scalar,
    ) -> Direction<V> {
        let v = state.along_normal();
        if self.curved {
            let turned = self.newton.next(body, state, w, looked.n / looked.length, reach);
            return turned.map_or(v, |n| Direction { n, length: Scalar::ONE });
        }
        let levelled = if leaves_open(state) { in_range(level(state, v)) } else { None };
        // The two directions may cancel. If bodies overlap deeply, the axis is opposite to the shortest vector, and a
        // direction between them is the axis again: the same support point would come back forever.
        let levelled = levelled
            .filter(|direction| direction.n.dot(v.n) > -(direction.length * v.length) * V::Scalar::from_f64(OPPOSITE));
        self.levelled = levelled.is_some();
        levelled.unwrap_or(v)
    }
}

/// The shortest vector of a vertex or an edge is not trusted while the lower bound is below this part of its length.
const TRUSTED: f64 = 0.5;

/// The weight of the lower bound's axis in a direction between it and the shortest vector. Among 1.5, 2 and 3 it takes
/// the fewest support points on average, for polytopes of 8 to 1024 vertices.
const AXIS_WEIGHT: f64 = 2.0;

/// The cosine of the angle to the opposite of the shortest vector, above which a direction between that and the axis is
/// the axis again.
const OPPOSITE: f64 = 0.6;

/// Whether the simplex does not determine the next direction, and its shortest vector is a poor guess. A triangle
/// determines it, and polygons in the plane need few steps anyway.
#[inline(always)]
fn leaves_open<V: Vector>(state: &Gjk<V>) -> bool {
    let is_open = V::DIM == 3 && state.simplex.points().len() < V::DIM;
    is_open && state.lower < state.length * V::Scalar::from_f64(TRUSTED)
}

/// A direction between the shortest vector `v` and the axis of the lower bound.
///
/// Among unit vectors, the distance of `C = A − B` from zero is the maximum of `f(n) = min n·x` over all `x` of `C`.
/// The known points of `C` bound `f` from above, and this bound is largest along the shortest vector of their simplex.
/// With few points it is far from the maximum of `f`, and moves from side to side, as with cutting planes. So, as in
/// level bundle methods (Lemaréchal, Nemirovskii, Nesterov, 1995), the step from the best direction known goes only
/// part of the way. If an edge is closest, both its ends should stay equally far: the step is across the edge.
#[inline(always)]
fn level<V: Vector>(state: &Gjk<V>, v: Direction<V>) -> V {
    let mut axis = state.axis;
    if let &[p, q] = state.simplex.points() {
        let e = q - p;
        axis -= e * (axis.dot(e) / e.length_squared());
    }
    // The sum of the unit vectors, times both lengths. Otherwise it may become shorter and shorter from one such
    // direction to the next.
    v.n * state.axis_length + axis * (V::Scalar::from_f64(AXIS_WEIGHT) * v.length)
}

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
struct Newton<V: Vector> {
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
    fn new(noise: V::Scalar) -> Self {
        Self { noise, last: None, before: None, failures: 0, failed: false }
    }

    /// The next unit direction, after `p` was found as the lowest point along the unit vector `n`, with `reach = n·p`.
    /// `None` if the next should be that of the shortest vector.
    #[inline(never)]
    fn next<B: TracedSupport<Vector = V>>(
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
