//! Steps of a descent towards the closest points of curved bodies.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::body::Body;
use crate::descent::Descent;
use crate::regions::cross;
use crate::symmetric::{Across, Symmetric, dot};
use crate::turn::Found;

/// Chooses directions to look along by curvature, where the support map knows it.
///
/// Among the unit vectors `n`, the distance of `C = A − B` from zero is the maximum of `f(n) = n·p(n)`, with `p(n)` the
/// point of `C` lowest along `n`: all of `C` lies beyond the plane through it. There `p` points along `n`. With the
/// derivative `Hδ` of the support point as its direction `−n` turns by `δ`, and with `r = p − f·n` and `ρ` the distance,
///
/// ```text
/// f(n − δ) ≈ f − r·δ − δ·(H + ρ)·δ/2,   largest where   (H + ρ)·δ = −r.
/// ```
///
/// `H` has no negative eigenvalue, so that the matrix is definite; the length of the shortest vector known is taken for
/// `ρ`, which is too large at first and so shortens the first steps. Newton's steps double the digits, and then `f` and
/// `|p|` are bounds that meet, as long as `p` moves on one smooth piece of the surface.
///
/// A known point of `C` that lies before the plane so foretold is on another piece, and tells that the closest point is
/// between both, as on the side of a cylinder between its rims. Then both have to support one plane. With `q` the point of
/// that piece at `n`, `g` how much higher it lies, `e = q − p`, and `β` the share that `q` has of the closest point,
///
/// ```text
/// (H_β + ρ)·δ + β·e = −r,   e·δ = g,   H_β = (1 − β)·H_p + β·H_q.
/// ```
///
/// Three pieces that meet fix a plane by themselves: there GJK's own steps suffice, and they are taken too where steps by
/// curvature do not shrink the bracket.
pub(crate) struct Newton<V: Vector> {
    noise: V::Scalar,
    /// The support point found before the last one.
    last: Option<Found<V>>,
    /// The width of the bracket before the last turn, if the last step was one.
    before: Option<V::Scalar>,
    /// Turns in a row that did not shrink the bracket.
    failures: usize,
}

/// Turns that fail to halve the bracket before the next step is one of GJK.
const PATIENCE: usize = 2;

/// How much lower than the first of two pieces the second is made, so that it is the one found next, relative to the
/// bracket. It is to exceed the error of what is foretold.
const LEAD: [f64; PATIENCE] = [0.01, 0.2];

/// A point contradicts what is foretold where it takes away this much of the gain.
const CONTRADICTION: f64 = 0.1;

/// Two support points are of one smooth piece if the curvature at one foretells the other but for this part.
const FORETOLD: f64 = 0.25;

/// The largest tangent of an angle to turn by.
const LARGEST: f64 = 0.5;

impl<V: Vector> Newton<V> {
    pub(crate) fn new(noise: V::Scalar) -> Self {
        Self { noise, last: None, before: None, failures: 0 }
    }

    /// Whether the last direction was chosen here.
    pub(crate) fn has_turned(&self) -> bool {
        self.before.is_some()
    }

    /// The next unit direction, after `p` was found as the lowest point along the unit vector `n`, with `reach = n·p`.
    /// `None` where the next should be that of the shortest vector.
    #[inline(never)]
    pub(crate) fn next<B: Body<Vector = V>>(
        &mut self,
        body: &B,
        descent: &Descent<V, B::Witness>,
        p: V,
        n: V,
        reach: V::Scalar,
    ) -> Option<V> {
        let last = self.last.replace(Found { point: p, along: -n });
        let gap = descent.length - descent.lower;
        if let Some(before) = self.before.take() {
            if gap <= before * V::Scalar::from_f64(0.5) {
                self.failures = 0;
            } else {
                self.failures += 1;
                if self.failures >= PATIENCE {
                    self.failures = 0;
                    return None;
                }
            }
        }
        // As far as below, the bodies are as likely to overlap.
        if !(reach > -descent.length) {
            return None;
        }
        let lead = self.noise + gap * V::Scalar::from_f64(LEAD[self.failures]);
        let to = self.turned(body, descent, last, p, -n, reach, lead)?;
        self.before = Some(gap);
        Some(-to)
    }

    /// The direction `−n` turned.
    #[inline]
    #[allow(clippy::too_many_arguments, reason = "the quantities of the derivation above")]
    fn turned<B: Body<Vector = V>>(
        &self,
        body: &B,
        descent: &Descent<V, B::Witness>,
        last: Option<Found<V>>,
        p: V,
        along: V,
        reach: V::Scalar,
        lead: V::Scalar,
    ) -> Option<V> {
        let (zero, one, half) = (V::Scalar::ZERO, V::Scalar::ONE, V::Scalar::from_f64(0.5));
        let (distance, largest) = (descent.length, V::Scalar::from_f64(LARGEST));
        let r = p + along * reach;
        let r_length = r.length();
        let u = r / r_length;
        let basis = [u, if V::DIM == 2 { V::ZERO } else { cross(along, u) }];
        let [u, w] = basis;
        let bend = body.hessian(along, basis);
        if bend.is_zero() {
            return None;
        }

        // One piece: (H + ρ)·δ = −r, no farther than is sensible, and the f foretold.
        let h = bend.plus(distance);
        let d = h.solve((-r_length, zero));
        let size = dot(d, d).sqrt();
        if !size.is_finite() {
            return None;
        }
        let d = if size > largest { (d.0 * (largest / size), d.1 * (largest / size)) } else { d };
        let gain = -(r_length * d.0) - dot(d, h.times(d)) * half;
        let to = (along + u * d.0 + w * d.1).unit()?;

        // The known point that lies farthest before the plane foretold.
        let mut least = reach + gain * V::Scalar::from_f64(1.0 - CONTRADICTION) - self.noise;
        let mut second = None;
        let corners = descent.simplex.points().iter().zip(descent.simplex.along());
        for (&point, &along) in corners.chain(last.iter().map(|last| (&last.point, &last.along))) {
            let level = -to.dot(point);
            if level < least && point != p {
                least = level;
                second = Some(Found { point, along });
            }
        }
        let Some(Found { point, along: from }) = second else { return Some(to) };
        if V::DIM == 2 {
            return None;
        }

        // Its piece, turned to n; a vertex stays, however far the turn.
        let from = from / from.dot(along);
        let change = along - from;
        let c = (u.dot(change), w.dot(change));
        let other = body.hessian(from, basis);
        let is_vertex = other.is_zero();
        // NaN fails this too.
        if !(is_vertex || dot(c, c) <= largest * largest) {
            return None;
        }
        let (other, shift, bulge) = turned(other, c);
        let p = (r_length, zero);
        let seen = (u.dot(point), w.dot(point));
        let (e, apart) = ((seen.0 + shift.0 - p.0, seen.1 + shift.1), (seen.0 - p.0, seen.1));
        let squared = dot(e, e);
        let foretold = V::Scalar::from_f64(FORETOLD) * dot(apart, apart).sqrt() + self.noise;
        if squared <= foretold * foretold {
            return None;
        }
        let level = -(along.dot(point) + bulge);
        let lead = if is_vertex { -lead } else { lead };

        // Two pieces: along e the change is given, and what it is across e follows from the first equation.
        let share = (-(e.0 * r_length) / squared).max(zero).min(one);
        let h = bend.blend(other, share).plus(distance);
        let t = (level - reach + lead) / squared;
        let across = (-e.1, e.0);
        let h_across = h.times(across);
        let s = (e.1 * r_length - dot(e, h_across) * t) / dot(across, h_across);
        let d = (e.0 * t + across.0 * s, e.1 * t + across.1 * s);
        // NaN fails this too.
        if !(dot(d, d) <= largest * largest) {
            return None;
        }
        (along + u * d.0 + w * d.1).unit()
    }
}

/// A piece turned from the direction `n₀` at which its Hessian is `A`, as seen across the unit vector `n` with `n·n₀ = 1`,
/// to `n = n₀ + c`: its Hessian, how far its point moves across `n`, and how much farther along `n` it then is than the
/// point found.
///
/// The support value `h` is homogeneous, so that `H·n₀ = 0`, and `A` tells all of `H`. Scaled to `n/s` with
/// `s = n·n₀/|n₀|² = 1/(1 + c²)`, the direction differs from `n₀` by a vector across it, and there `h` is quadratic to third
/// order on a ball, not only to second as in `n`. With `g = A·c`,
///
/// ```text
/// h = n·p₀ + c·g/(2s),   p = p₀ + g/s + c·g/(2s)·c,   H = (1 + c·cᵀ)·A·(1 + c·cᵀ)/s.
/// ```
fn turned<S: Scalar>(a: Symmetric<S>, c: Across<S>) -> (Symmetric<S>, Across<S>, S) {
    let stretch = S::ONE + dot(c, c);
    let g = a.times(c);
    let sink = dot(c, g);
    let bulge = sink * stretch * S::from_f64(0.5);
    let shift = (g.0 * stretch + c.0 * bulge, g.1 * stretch + c.1 * bulge);
    // With half of the last term in each of the products: k = g + c·g/2·c.
    let k = (g.0 + c.0 * sink * S::from_f64(0.5), g.1 + c.1 * sink * S::from_f64(0.5));
    let h = Symmetric {
        a: (a.a + k.0 * c.0 + k.0 * c.0) * stretch,
        b: (a.b + k.0 * c.1 + k.1 * c.0) * stretch,
        d: (a.d + k.1 * c.1 + k.1 * c.1) * stretch,
    };
    (h, shift, bulge)
}
