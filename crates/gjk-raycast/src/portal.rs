//! The ray cast as it is seen along the ray (`view.rs`), where it is a search for a triangle that contains a point.
//!
//! Three points whose triangle contains zero in the plane of `(u, v)`, a *portal*, bound the hit from above: the ray crosses the
//! triangle at `Σ wᵢ·tᵢ`. With the portal's own plane for `α`, the support point either is on that plane, and `τ(α)` is as
//! high; or it is before it, and of the three triangles that it spans with the edges of the portal one contains zero,
//! and is crossed earlier. That is the simplex method for a linear programme in the two unknowns `α`, whose constraints
//! are the support points.
//!
//! All that is decided here by signs, and by planes in the coordinates `(u, v, t)`, is where to look next. A miss and a
//! lower bound come from [`Search::advance`] alone, and the upper bound is a point of the triangle that is measured to lie
//! on the ray. Where either is in doubt, so is the answer, and the search of `cast.rs` takes over.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::Iterate;
use crate::body::{Body, Witness};
use crate::cast::{End, ScalarOf, Search};
use crate::view::{Best, Frame, Multiple, Portal, Seen, Slant};

/// Why the search ends: decided, or in doubt.
pub(crate) type Exit<B> = Option<End<<B as Body>::Vector>>;

pub(crate) type SeenBy<B> = Seen<<B as Body>::Vector, <B as Body>::Witness>;

/// Support points until the portal has to be found; half as many where curvature may tell more.
const MAX_OUTSIDE: usize = 16;

/// Exchanges of a point that bring the portal no nearer.
pub(crate) const PATIENCE: usize = 12;

impl<B: Body, O: FnMut(Iterate<'_, B::Vector>)> Search<'_, B, O> {
    /// Closes the bracket, or finds a plane that the whole ray is before. `None` where that is in doubt.
    #[inline(always)]
    pub(crate) fn look_through(&mut self) -> Option<Result<(), End<B::Vector>>> {
        let mut frame = Frame::new(self.local.line);
        // The first plane: the one given, or the tangent plane of the ball about the body where the ray enters it; and how
        // far it is tilted next.
        let (first, reach) = match self.options.axis.and_then(Vector::unit) {
            Some(axis) => (axis, ScalarOf::<B>::from_f64(0.03)),
            None => (self.local.line.at(self.low), ScalarOf::<B>::ONE),
        };
        let curved = self.is_curved(&frame, first);
        let found = if !curved && self.radius > ScalarOf::<B>::ZERO {
            self.swept(&frame, first, reach)
        } else {
            let mut found = Err(None);
            if curved {
                frame.lift = self.radius;
                found = self.osculate(&frame, first);
            }
            // A second time where the line was found to touch the body, and is moved inward.
            for _ in 0..2 {
                if matches!(found, Err(None)) {
                    found = self.portal(&frame, first, reach);
                    let Some(foot) = self.inward.take() else { break };
                    frame.foot = foot;
                }
            }
            found
        };
        match found {
            Ok(()) => Some(Ok(())),
            Err(exit) => exit.map(Err),
        }
    }

    fn portal(&mut self, frame: &Frame<B::Vector>, first: B::Vector, mut reach: ScalarOf<B>) -> Result<(), Exit<B>> {
        let zero = ScalarOf::<B>::ZERO;
        let one = ScalarOf::<B>::ONE;
        let facing = -first.dot(self.local.line.direction);
        let mut p = self.look(frame, first)?;
        let mut slant = Slant { a: zero, b: zero };
        let mut best = Best { tau: -ScalarOf::<B>::infinity(), slant, point: p.point };
        let end = self.end();
        let is_faced = facing > first.length() * ScalarOf::<B>::from_f64(0.125);
        if is_faced {
            let per_facing = facing.recip();
            slant = Slant { a: frame.e1.dot(first) * per_facing, b: frame.e2.dot(first) * per_facing };
            p.slant = Some(slant);
            best = Best { tau: slant.crossing(&p), slant, point: p.point };
        }
        if !is_faced || best.tau > end {
            self.separate_end(first, p.point)?;
        }

        // A second point on the other side of the line, of a plane that is tilted towards it.
        let squared = p.u * p.u + p.v * p.v;
        if !(squared > self.noise * self.noise) {
            // The line runs through the first one.
            let found = best.tau > -ScalarOf::<B>::infinity();
            return if found { self.close(frame, &[p], &[one], p.t, &best) } else { Err(None) };
        }
        let toward = (-p.u, -p.v);
        let rise = reach * (slant.length_squared() * squared).sqrt();
        let plane =
            Multiple { a: slant.a * squared + toward.0 * rise, b: slant.b * squared + toward.1 * rise, c: squared };
        let mut q = self.look_along(frame, plane)?;
        slant = plane.slant();
        let tau = slant.crossing(&q);
        if tau > end {
            self.separate_end(frame.normal(self.local.line.direction, slant), q.point)?;
        }
        if tau > best.tau {
            best = Best { tau, slant, point: q.point };
        }
        if !(toward.0 * q.u + toward.1 * q.v > zero) {
            q = self.look_across(frame, toward)?;
            reach = reach.max(one);
        }

        // A third such that the triangle contains zero.
        let mut outside = if self.body.is_curved() { MAX_OUTSIDE / 2 } else { MAX_OUTSIDE };
        // The sign of the order in which p, q and the third go round: cheaper to keep than to put them in order.
        let mut turn;
        let (mut s, mut weights) = loop {
            let w = p.cross(&q);
            turn = one.copysign(w);
            let (du, dv, dt) = (q.u - p.u, q.v - p.v, q.t - p.t);
            let squared = du * du + dv * dv;
            // The plane through both points that is tilted from the last one, towards the line: with w = (−dv, du) across
            // the edge, α = (dt·e + k·w)/|e|², k = α·w + reach·√(|e|² + (α·w)²).
            let toward = (-dv * turn, du * turn);
            let tilt = slant.a * toward.0 + slant.b * toward.1;
            let rise = tilt + reach * (squared + tilt * tilt).sqrt();
            let plane = Multiple { a: du * dt + toward.0 * rise, b: dv * dt + toward.1 * rise, c: squared };
            let mut s = self.look_along(frame, plane)?;
            slant = plane.slant();
            let tau = slant.crossing(&s);
            if tau > end {
                self.separate_end(frame.normal(self.local.line.direction, slant), s.point)?;
            }
            if tau > best.tau {
                best = Best { tau, slant, point: s.point };
            }
            if !(toward.0 * s.u + toward.1 * s.v > zero) {
                s = self.look_across(frame, toward)?;
                reach = reach.max(one);
            }
            let weights = [q.cross(&s) * turn, s.cross(&p) * turn, w.abs()];
            if weights[0] >= zero && weights[1] >= zero {
                break (s, weights);
            }
            if weights[0] < weights[1] {
                p = s;
            } else {
                q = s;
            }
            outside -= 1;
            if outside == 0 {
                // The line passes near where the body is seen to end, too near to be enclosed by points; but an edge or a
                // smooth piece may be found that it runs through.
                let found = best.tau > -ScalarOf::<B>::infinity()
                    && self.is_curved(frame, frame.normal(self.local.line.direction, best.slant));
                if !found {
                    return Err(None);
                }
                let portal = Portal { corners: [p, q, q], weights: [zero; 3], high: ScalarOf::<B>::infinity() };
                return self.curved(frame, portal, best);
            }
        };

        // The portal is brought nearer.
        let wanted = self.noise.max(self.options.tolerance);
        let mut last = ScalarOf::<B>::infinity();
        let mut patience = PATIENCE;
        let (high, inverse) = loop {
            let sum = weights[0] + weights[1] + weights[2];
            if !(sum > zero) {
                return Err(None);
            }
            let (pu, pv, pt) = ((q.u - p.u) * turn, (q.v - p.v) * turn, (q.t - p.t) * turn);
            let (qu, qv, qt) = (s.u - p.u, s.v - p.v, s.t - p.t);
            let plane = Multiple { a: pt * qv - qt * pv, b: pu * qt - qu * pt, c: sum };
            let inverse = sum.recip();
            let high = (weights[0] * p.t + weights[1] * q.t + weights[2] * s.t) * inverse;
            if !(high < last) {
                patience -= 1;
                if patience == 0 || !(high < ScalarOf::<B>::infinity()) {
                    return Err(None);
                }
            }
            last = high;
            if high < self.low - self.low_error {
                // The ray begins behind the portal, in the body or past it.
                return Err(None);
            }
            slant = plane.slant();
            // The bracket closes between the best plane, at its own cosine, and the portal.
            if best.slant.is_within(high - best.tau, wanted) {
                break (high, inverse);
            }
            if self.body.is_curved() && self.is_curved(frame, plane.normal(frame, self.local.line.direction)) {
                let weights = weights.map(|w| w * inverse);
                let (corners, weights) =
                    if turn > zero { ([p, q, s], weights) } else { ([q, p, s], [weights[1], weights[0], weights[2]]) };
                return self.curved(frame, Portal { corners, weights, high }, best);
            }
            let r = self.look_along(frame, plane)?;
            let tau = slant.crossing(&r);
            if tau > best.tau {
                best = Best { tau, slant, point: r.point };
                if tau > end {
                    self.separate_end(frame.normal(self.local.line.direction, slant), r.point)?;
                }
                if slant.is_within(high - best.tau, wanted) {
                    break (high, inverse);
                }
            }
            let (kp, kq, ks) = (p.cross(&r) * turn, q.cross(&r) * turn, s.cross(&r) * turn);
            if kq >= zero && kp <= zero {
                (s, weights) = (r, [kq, -kp, weights[2]]);
            } else if ks >= zero && kq <= zero {
                (p, weights) = (r, [weights[0], ks, -kq]);
            } else if kp >= zero && ks <= zero {
                (q, weights) = (r, [-ks, weights[1], kp]);
            } else {
                return Err(None);
            }
        };
        let [w0, w1, w2] = weights.map(|w| w * inverse);
        let passed = p.point * w0 + q.point * w1 + s.point * w2;
        let witness = B::Witness::default().plus(p.witness, w0).plus(q.witness, w1).plus(s.witness, w2);
        self.close_at(frame, passed, witness, high, &best)
    }

    /// Whether the core's support point moves as a plane turns.
    pub(crate) fn is_curved(&self, frame: &Frame<B::Vector>, n: B::Vector) -> bool {
        self.body.is_curved() && !self.body.hessian(n, [frame.e1, frame.e2]).is_zero()
    }

    /// The next support point along any vector.
    ///
    /// This, and what it calls, is compiled into its callers: vectors of `f64` that pass through memory are waited for.
    #[inline(always)]
    pub(crate) fn look(&mut self, frame: &Frame<B::Vector>, n: B::Vector) -> Result<SeenBy<B>, Exit<B>> {
        let (point, witness) = self.sight(n).map_err(Some)?;
        let touch = if frame.lift > ScalarOf::<B>::ZERO { point + n * (frame.lift / n.norm()) } else { point };
        let seen = touch - frame.foot;
        let t = touch.dot(self.local.line.direction);
        Ok(Seen { u: seen.dot(frame.e1), v: seen.dot(frame.e2), t, point, witness, slant: None })
    }

    /// The next support point along a vector across the ray, if the plane there does not separate and the point is beyond
    /// the line. Where the line touches the body there, to rounding, it is to pass a little farther inside.
    #[cold]
    #[inline(never)]
    fn look_across(
        &mut self,
        frame: &Frame<B::Vector>,
        (a, b): (ScalarOf<B>, ScalarOf<B>),
    ) -> Result<SeenBy<B>, Exit<B>> {
        let across = (frame.e1 * a + frame.e2 * b).unit().ok_or(None)?;
        let seen = self.look(frame, across)?;
        self.separate(across, &seen)?;
        let beyond = (seen.point - frame.foot).dot(across) + frame.lift;
        if beyond > ScalarOf::<B>::ZERO {
            return Ok(seen);
        }
        let inward = self.noise * ScalarOf::<B>::from_f64(0.5);
        if self.radius == ScalarOf::<B>::ZERO && frame.foot == self.local.line.foot && beyond > -inward {
            self.inward = Some(frame.foot - across * inward);
        }
        Err(None)
    }

    /// The next support point of a plane.
    #[inline(always)]
    fn look_along(&mut self, frame: &Frame<B::Vector>, plane: Multiple<ScalarOf<B>>) -> Result<SeenBy<B>, Exit<B>> {
        let mut seen = self.look(frame, plane.normal(frame, self.local.line.direction))?;
        // No polytope is asked where it was looked at along.
        seen.slant = self.body.is_curved().then(|| plane.slant());
        Ok(seen)
    }

    #[inline(always)]
    pub(crate) fn look_slanted(
        &mut self,
        frame: &Frame<B::Vector>,
        slant: Slant<ScalarOf<B>>,
    ) -> Result<SeenBy<B>, Exit<B>> {
        self.look_along(frame, Multiple { a: slant.a, b: slant.b, c: Scalar::ONE })
    }

    /// Where on the line the ray ends, or leaves the ball about the body.
    pub(crate) fn end(&self) -> ScalarOf<B> {
        self.half_chord.min(self.local.mu(self.options.max_lambda))
    }

    /// The search ends if the plane across `n` that supports the body at a point leaves nothing of the ray.
    #[inline(always)]
    pub(crate) fn separate(&mut self, n: B::Vector, p: &SeenBy<B>) -> Result<(), Exit<B>> {
        match n.unit() {
            Some(n) => self.advance(n, p.point).map_err(Some),
            None => Ok(()),
        }
    }

    /// The same for a plane that leaves something of the ray otherwise: then nothing changes. By rounding alone, the end of the
    /// ray may be where the hit is, and a ray that ends there finds the hit where a longer one does.
    ///
    /// It takes the point alone: a support point that is lent to a function has to stay in memory.
    #[cold]
    #[inline(never)]
    pub(crate) fn separate_end(&self, n: B::Vector, point: B::Vector) -> Result<(), Exit<B>> {
        match n.unit() {
            Some(n) => self.crossing(n, point).map(drop).map_err(Some),
            None => Ok(()),
        }
    }

    /// Certifies that the bracket has closed: from the last plane to the point at `high`, which is no farther than the
    /// radius from the core's point with these weights.
    pub(crate) fn close(
        &mut self,
        frame: &Frame<B::Vector>,
        corners: &[SeenBy<B>],
        weights: &[ScalarOf<B>],
        high: ScalarOf<B>,
        best: &Best<B::Vector>,
    ) -> Result<(), Exit<B>> {
        let (mut passed, mut witness) = (B::Vector::ZERO, B::Witness::default());
        for (p, &weight) in corners.iter().zip(weights) {
            passed += p.point * weight;
            witness = witness.plus(p.witness, weight);
        }
        self.close_at(frame, passed, witness, high, best)
    }

    /// The same, given the core's point and what it is made of.
    #[inline(always)]
    fn close_at(
        &mut self,
        frame: &Frame<B::Vector>,
        passed: B::Vector,
        witness: B::Witness,
        high: ScalarOf<B>,
        best: &Best<B::Vector>,
    ) -> Result<(), Exit<B>> {
        let n = frame.normal(self.local.line.direction, best.slant).unit().ok_or(None)?;
        self.advance(n, best.point).map_err(Some)?;
        let off = passed - self.local.line.at(high);
        let within = self.radius + self.noise;
        // Where no plane is crossed, as by a ray within the plane of a face, the bracket begins where the ray does.
        let slope = if self.low_slope > ScalarOf::<B>::ZERO { self.low_slope } else { ScalarOf::<B>::ONE };
        let gap = (high - self.low) * slope;
        let closed = gap <= self.noise.max(self.options.tolerance) && gap >= -self.noise;
        if !(closed && off.length_squared() <= within * within) {
            return Err(None);
        }
        let error = if self.low_slope > ScalarOf::<B>::ZERO { self.low_error } else { self.noise };
        (self.high, self.high_error, self.witness) = (high.max(self.low), error, witness);
        Ok(())
    }
}
