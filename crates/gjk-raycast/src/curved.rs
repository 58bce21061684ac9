//! The search of `portal.rs` where the body is curved and says how.
//!
//! Near a direction where it is smooth, `τ(α) = min over the body of t − α·(u, v)` is twice differentiable: with `p(α)` the
//! support point, its gradient is `−(u, v)` of `p`, and its Hessian is `−H`, where `H` is the derivative of `(u, v)` along `α`.
//! Two models of it are used.
//!
//! A body that is smooth where it is looked at is replaced by the ellipsoid about its origin that has the same support
//! point and derivative there ([`Search::osculate`]). The support value of an ellipsoid is `h(n) = √(n·Qn)`, so its support
//! point and the derivative of that are `p = Qn/h` and `D = (Q − p·pᵀ)/h`, whence `Q = h·D + p·pᵀ`. Where the ray enters it
//! is known in closed form, and the next plane is the one there. An ellipsoid is its own model.
//!
//! Where pieces meet, such as the rims of a cylinder along its side, each is a quadratic model of its own ([`Piece`]), and
//! the next plane is where the least of the models is greatest ([`next`]): a step of sequential quadratic programming,
//! which for three pieces is the portal's own plane. Between two, both have to be looked at in turn, though only the one
//! that reaches farther shows itself; so the plane is laid by a little more than the error of the older model on its side.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::Iterate;
use crate::body::Body;
use crate::cast::{ScalarOf, Search};
use crate::portal::{Best, Exit, Frame, Portal, Seen, SeenBy, Slant};

/// A symmetric matrix `(a b; b d)` across the ray.
#[derive(Clone, Copy, Debug)]
struct Symmetric<S> {
    a: S,
    b: S,
    d: S,
}

impl<S: Scalar> Symmetric<S> {
    fn times(self, (x, y): (S, S)) -> (S, S) {
        (self.a * x + self.b * y, self.b * x + self.d * y)
    }

    fn determinant(self) -> S {
        self.a * self.d - self.b * self.b
    }

    fn solve(self, (x, y): (S, S)) -> (S, S) {
        let inverse = self.determinant().recip();
        ((self.d * x - self.b * y) * inverse, (self.a * y - self.b * x) * inverse)
    }

    /// Whether there is a solution that is more than rounding.
    fn is_regular(self) -> bool {
        self.determinant() > S::EPSILON.sqrt() * self.a * self.d
    }

    fn blend(self, other: Self, share: S) -> Self {
        let rest = S::ONE - share;
        Self {
            a: self.a * rest + other.a * share,
            b: self.b * rest + other.b * share,
            d: self.d * rest + other.d * share,
        }
    }

    /// The eigenvalue of a matrix of rank one, and its unit eigenvector.
    fn eigen_of_rank_one(self) -> Option<(S, (S, S))> {
        let trace = self.a + self.d;
        let column = if self.a > self.d { (self.a, self.b) } else { (self.b, self.d) };
        let length = dot(column, column).sqrt();
        (trace > S::ZERO && length > S::ZERO).then(|| (trace, (column.0 / length, column.1 / length)))
    }

    fn is_zero(self) -> bool {
        self.a == S::ZERO && self.d == S::ZERO
    }
}

/// A vector across the ray, or a change of the slant.
type Across<S> = (S, S);

fn dot<S: Scalar>(a: (S, S), b: (S, S)) -> S {
    a.0 * b.0 + a.1 * b.1
}

fn cross<S: Scalar>(a: (S, S), b: (S, S)) -> S {
    a.0 * b.1 - a.1 * b.0
}

/// A support point, where it was found, and how it moves from there.
struct Piece<V: Vector, W> {
    seen: Seen<V, W>,
    slant: Slant<V::Scalar>,
    bend: Symmetric<V::Scalar>,
}

impl<V: Vector, W: Copy> Clone for Piece<V, W> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<V: Vector, W: Copy> Copy for Piece<V, W> {}

/// A piece as it is expected at another slant, to second order.
#[derive(Clone, Copy, Debug)]
struct Turned<S> {
    /// What is expected of `τ` there.
    tau: S,
    /// What is expected of `(u, v)`.
    at: Across<S>,
    bend: Symmetric<S>,
}

impl<V: Vector, W: Copy> Piece<V, W> {
    /// The piece as seen from another slant, where nothing is crossed before `least`.
    ///
    /// The plane through the point alone is crossed at `cut`, never before the body, and the point that supports the body
    /// there `½·δ·Hδ` earlier, to second order. How wrong that may be is told by the angle that the plane turns by, and by how
    /// far the point moves; where that is too far, or where it foretells less than was found, a point counts for itself
    /// alone. Of what is in doubt the larger value is expected: where it is wrong, the piece shows itself, and is known anew.
    fn turned(&self, slant: Slant<V::Scalar>, least: V::Scalar, caution: V::Scalar) -> Turned<V::Scalar> {
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
    fn model(&self, change: Across<S>) -> S {
        self.tau - dot(self.at, change) - S::from_f64(0.5) * dot(change, self.bend.times(change))
    }
}

/// The angle that a plane may turn by, and the way that the point may move, in units of the body's size, for a piece to be a
/// quadratic model.
const FAR: f64 = 0.3;

/// As many pieces as are kept.
const MAX_PIECES: usize = 4;

/// Support points of a search on pieces, and on a smooth body.
const MAX_STEPS: usize = 40;
const MAX_SMOOTH_STEPS: usize = 12;

/// How far, of the way that a point has moved, it may be from where it was expected to be the same piece's.
const FORETOLD: f64 = 0.5;

/// The last pieces, the newest last.
struct Pieces<V: Vector, W> {
    kept: [Piece<V, W>; MAX_PIECES],
    len: usize,
}

impl<V: Vector, W: Copy> Pieces<V, W> {
    fn new(first: Piece<V, W>) -> Self {
        Self { kept: [first; MAX_PIECES], len: 1 }
    }

    fn all(&self) -> &[Piece<V, W>] {
        &self.kept[..self.len]
    }

    /// Adds a piece in place of those that are the same, or else of the one that is the farthest from being active. Tells
    /// whether it is the same as the last.
    ///
    /// A point is the same piece's if it moved as the mean of both derivatives says, which is right to third order.
    fn push(&mut self, piece: Piece<V, W>, noise: V::Scalar) -> bool {
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

    /// The point, segment or triangle of pieces, the newest among them, that the line passes within `noise`: its
    /// corners and their weights.
    fn passed(&self, noise: V::Scalar) -> Option<([usize; 3], [V::Scalar; 3], usize)> {
        let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
        let newest = self.len - 1;
        let p = &self.kept[newest].seen;
        if p.u * p.u + p.v * p.v <= noise * noise {
            return Some(([newest; 3], [one, zero, zero], 1));
        }
        for i in 0..newest {
            let q = &self.kept[i].seen;
            let (du, dv) = (q.u - p.u, q.v - p.v);
            let share = (-(p.u * du + p.v * dv) / (du * du + dv * dv)).max(zero).min(one);
            let (u, v) = (p.u + du * share, p.v + dv * share);
            if u * u + v * v <= noise * noise {
                return Some(([newest, i, i], [one - share, share, zero], 2));
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
                    return Some(([newest, i, j], weights, 3));
                }
            }
        }
        None
    }
}

/// Where the least of the models is greatest.
///
/// With `τᵢ`, `Pᵢ` and `Hᵢ` of the pieces turned to the last slant, and `δ` the change of the slant, `mᵢ(δ) = τᵢ − Pᵢ·δ − ½·δ·Hᵢδ`.
/// At the maximum of their minimum there are weights `wᵢ ≥ 0` with sum 1, and `W = Σ wᵢ·Hᵢ`, such that
///
/// ```text
/// Σ wᵢ·Pᵢ + W·δ = 0,   mᵢ(δ) alike where wᵢ > 0, and no lower elsewhere.
/// ```
///
/// One piece gives `δ = −H⁻¹P`, or where `H` is singular, [`along_edge`]. Of two, with `e = Pⱼ − Pᵢ`, the second condition to first order is `e·δ = τⱼ − τᵢ`, and the
/// first one across `e` gives the rest. Three are alike at one `δ`.
fn next<V: Vector, W: Copy>(
    pieces: &[Piece<V, W>],
    slant: Slant<V::Scalar>,
    noise: V::Scalar,
    caution: V::Scalar,
) -> Option<(Slant<V::Scalar>, V::Scalar)> {
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    let half = V::Scalar::from_f64(0.5);
    let length = slant.length();
    let lead = half * noise * length;
    let (last, others) = pieces.split_last()?;
    let last = last.turned(slant, -V::Scalar::infinity(), zero);
    let mut turned = [last; MAX_PIECES];
    for (t, piece) in turned.iter_mut().zip(others) {
        *t = piece.turned(slant, last.tau, caution);
    }
    let turned = &turned[..pieces.len()];
    let newest = pieces.len() - 1;
    // A vertex is known as well as it ever will be; of other pieces, those are wanted that were not looked at last.
    let led = |i: usize| {
        let t = &turned[i];
        if i == newest {
            t.tau
        } else if t.bend.is_zero() {
            t.tau - lead
        } else {
            t.tau + caution * lead
        }
    };
    let mut best: Option<(Across<V::Scalar>, V::Scalar)> = None;
    let mut offer = |change: Across<V::Scalar>, corners: &[usize]| {
        let least = |among: &dyn Fn(usize) -> bool| {
            let mut least = V::Scalar::infinity();
            for (i, t) in turned.iter().enumerate() {
                if among(i) {
                    least = least.min(t.model(change));
                }
            }
            least
        };
        // NaN fails this too.
        let angle = dot(change, change).sqrt();
        if !(angle <= length && angle > V::Scalar::EPSILON * length) {
            return;
        }
        let value = least(&|i| corners.contains(&i));
        let other = least(&|i| !corners.contains(&i));
        let slack = lead + lead + (value - led(newest)).abs() * V::Scalar::from_f64(0.1);
        if other >= value - slack && best.is_none_or(|(_, found)| value > found) && value.is_finite() {
            best = Some((change, value));
        }
    };

    for i in 0..turned.len() {
        let t = &turned[i];
        if t.bend.is_regular() {
            let (x, y) = t.bend.solve(t.at);
            offer((-x, -y), &[i]);
        } else if let Some(change) = along_edge(turned, i, noise * length, noise) {
            offer(change, &[i]);
        }
        for j in 0..i {
            let s = &turned[j];
            let e = (s.at.0 - t.at.0, s.at.1 - t.at.1);
            let squared = dot(e, e);
            if !(squared > noise * noise) {
                continue;
            }
            let across = (-e.1, e.0);
            let share = (-dot(e, t.at) / squared).max(zero).min(one);
            let bend = t.bend.blend(s.bend, share);
            let stiffness = dot(across, bend.times(across));
            if stiffness > V::Scalar::EPSILON.sqrt() * squared * (bend.a + bend.d) {
                let along = (led(j) - led(i)) / squared;
                let aside = -(dot(across, t.at) + along * dot(across, bend.times(e))) / stiffness;
                let change = (e.0 * along + across.0 * aside, e.1 * along + across.1 * aside);
                let pulled = bend.times(change);
                let share = -(dot(e, t.at) + dot(e, pulled)) / squared;
                if share >= zero && share <= one {
                    offer(change, &[i, j]);
                }
            }
            for (k, r) in turned[..j].iter().enumerate() {
                let f = (r.at.0 - t.at.0, r.at.1 - t.at.1);
                let area = cross(e, f);
                let weights = [cross(s.at, r.at) / area, cross(r.at, t.at) / area, cross(t.at, s.at) / area];
                // NaN fails this too.
                if !weights.iter().all(|&w| w >= zero) {
                    continue;
                }
                let (g, h) = (led(j) - led(i), led(k) - led(i));
                offer(((g * f.1 - h * e.1) / area, (e.0 * h - f.0 * g) / area), &[i, j, k]);
            }
        }
    }
    best.map(|(change, value)| (Slant { a: slant.a + change.0, b: slant.b + change.1 }, value))
}

/// Where the model of a piece with `H = λ·q·qᵀ` is greatest: an edge of the body, curved or straight, that the line runs through
/// when `q·P` is zero.
///
/// Across the edge, `δ = −(q·P)/λ·q`. Along it the plane is free, between those that the other pieces are on; it is laid away from
/// them, since on them it would be another piece that shows itself.
fn along_edge<S: Scalar>(turned: &[Turned<S>], edge: usize, least: S, noise: S) -> Option<Across<S>> {
    let t = &turned[edge];
    let (curvature, q) = t.bend.eigen_of_rank_one()?;
    let (beside, along) = (dot(q, t.at), cross(q, t.at));
    // Where the line is to be found along the edge rather than beside it, another piece is needed.
    if !(along.abs() <= beside.abs().max(noise)) {
        return None;
    }
    let step = -beside / curvature;
    let change = (q.0 * step, q.1 * step);
    let value = t.model(change);
    let (mut from, mut to) = (-S::infinity(), S::infinity());
    for (i, other) in turned.iter().enumerate() {
        let (spare, falls) = (other.model(change) - value, cross(q, other.at) - along);
        if i == edge {
            continue;
        } else if falls > noise {
            to = to.min(spare / falls);
        } else if falls < -noise {
            from = from.max(spare / falls);
        }
    }
    let margin = (step.abs() + least).min((to - from) * S::from_f64(0.25));
    let slide = S::ZERO.max(from + margin).min(to - margin);
    Some((change.0 - q.1 * slide, change.1 + q.0 * slide))
}

impl<B: Body, O: FnMut(Iterate<'_, B::Vector>)> Search<'_, B, O> {
    /// The derivative of the swept body's support point at `n` along `change`.
    fn moved(&self, n: B::Vector, change: B::Vector) -> B::Vector {
        let core = self.body.derivative(n, change);
        if self.radius > ScalarOf::<B>::ZERO {
            core + (change - n * (change.dot(n) / n.length_squared())) * (self.radius / n.norm())
        } else {
            core
        }
    }

    fn piece(
        &self,
        frame: &Frame<B::Vector>,
        seen: SeenBy<B>,
        slant: Slant<ScalarOf<B>>,
    ) -> Piece<B::Vector, B::Witness> {
        let n = frame.normal(self.local.line.direction, slant);
        let (m1, m2) = (self.moved(n, frame.e1), self.moved(n, frame.e2));
        let bend = Symmetric { a: m1.dot(frame.e1), b: m1.dot(frame.e2), d: m2.dot(frame.e2) };
        Piece { seen, slant, bend }
    }

    /// Brings a portal nearer, by planes that the curvature of the body suggests as long as they close the bracket fast,
    /// and by the portal's own.
    pub(crate) fn curved(
        &mut self,
        frame: &Frame<B::Vector>,
        mut portal: Portal<B::Vector, B::Witness>,
        mut best: Best<B::Vector>,
    ) -> Result<(), Exit<B>> {
        let wanted = self.noise.max(self.options.tolerance);
        let end = self.end();
        let (zero, half) = (ScalarOf::<B>::ZERO, ScalarOf::<B>::from_f64(0.5));
        let mut pieces: Option<Pieces<B::Vector, B::Witness>> = None;
        let mut slant = if portal.high.is_finite() { portal.slant() } else { best.slant };
        for seen in &portal.corners {
            // A point found on a plane along the ray counts for itself alone.
            let piece = match seen.slant {
                Some(found_at) => self.piece(frame, *seen, found_at),
                None => Piece { seen: *seen, slant, bend: Symmetric { a: zero, b: zero, d: zero } },
            };
            match &mut pieces {
                Some(pieces) => _ = pieces.push(piece, self.noise),
                None => pieces = Some(Pieces::new(piece)),
            }
        }
        let start = self.low;
        let (mut gap, mut stuck) = (ScalarOf::<B>::infinity(), 0);
        let mut caution = ScalarOf::<B>::ONE;
        for _ in 0..MAX_STEPS {
            let seen = self.look_slanted(frame, slant)?;
            let tau = slant.crossing(&seen);
            if tau > best.tau {
                best = Best { tau, slant, point: seen.point };
                if tau > end {
                    self.separate(frame.normal(self.local.line.direction, slant), &seen)?;
                }
            }
            let piece = self.piece(frame, seen, slant);
            let pieces = match &mut pieces {
                Some(pieces) => {
                    let again = pieces.push(piece, self.noise);
                    caution = if again { caution * ScalarOf::<B>::from_f64(8.0) } else { ScalarOf::<B>::ONE };
                    pieces
                }
                None => pieces.insert(Pieces::new(piece)),
            };
            let floor = best.tau - self.noise * best.slant.length();
            portal.exchange(&seen, floor);
            if portal.high < floor {
                // Nothing of the body is before the plane: zero was in the triangle by rounding alone.
                portal.high = ScalarOf::<B>::infinity();
            } else if portal.high < start {
                return Err(None);
            }
            let within = wanted * best.slant.length();
            // A segment first, since the weights in a flat triangle may be nothing but rounding.
            if let Some((corners, weights, len)) = pieces.passed(self.noise) {
                let corners = corners.map(|i| pieces.kept[i].seen);
                let mut high = zero;
                for (p, &weight) in corners[..len].iter().zip(&weights) {
                    high += p.t * weight;
                }
                if high - best.tau <= within && high >= start {
                    match self.close(frame, &corners[..len], &weights[..len], high, &best) {
                        Err(None) => {}
                        end => return end,
                    }
                }
            }
            if portal.high - best.tau <= within {
                match self.close(frame, &portal.corners, &portal.weights, portal.high, &best) {
                    Err(None) => {}
                    end => return end,
                }
            }
            let suggested = if stuck < 3 || portal.high.is_infinite() {
                next(pieces.all(), slant, self.noise, caution)
            } else {
                None
            };
            let gone = suggested.map_or(portal.high, |(_, value)| value.min(portal.high)) - best.tau;
            stuck = if gone <= gap * half || stuck >= 3 { 0 } else { stuck + 1 };
            gap = gone;
            if suggested.is_none() && portal.high.is_infinite() {
                return Err(None);
            }
            let to = suggested.map_or_else(|| portal.slant(), |(slant, _)| slant);
            // What is looked at twice tells nothing new.
            if to.a == slant.a && to.b == slant.b {
                return Err(None);
            }
            slant = to;
        }
        Err(None)
    }

    /// Replaces a smooth body by the ellipsoid that osculates it, takes the plane where the ray enters that, and so on.
    pub(crate) fn osculate(&mut self, frame: &Frame<B::Vector>, first: B::Vector) -> Result<(), Exit<B>> {
        let (zero, one) = (ScalarOf::<B>::ZERO, ScalarOf::<B>::ONE);
        let direction = self.local.line.direction;
        let foot = (self.local.line.foot.dot(frame.e1), self.local.line.foot.dot(frame.e2));
        let wanted = self.noise.max(self.options.tolerance);
        let end = self.end();
        let (mut n, mut slant): (_, Option<Slant<ScalarOf<B>>>) = (first, None);
        let mut best: Option<Best<B::Vector>> = None;
        let mut pieces: Option<Pieces<B::Vector, B::Witness>> = None;
        let mut last = ScalarOf::<B>::infinity();
        for _ in 0..MAX_SMOOTH_STEPS {
            let moved = [frame.e1, frame.e2, -direction].map(|e| self.moved(n, e));
            let bend = Symmetric { a: moved[0].dot(frame.e1), b: moved[0].dot(frame.e2), d: moved[1].dot(frame.e2) };
            if !bend.is_regular() {
                return Err(None);
            }
            let mut seen = self.look(frame, n)?;
            seen.slant = slant;
            match slant {
                None => self.separate(n, &seen)?,
                Some(slant) => {
                    let tau = slant.crossing(&seen);
                    if best.is_none_or(|best| tau > best.tau) {
                        best = Some(Best { tau, slant, point: seen.point });
                        if tau > end {
                            self.separate(n, &seen)?;
                        }
                    }
                    let piece = Piece { seen, slant, bend };
                    match &mut pieces {
                        Some(pieces) if pieces.len == MAX_PIECES => {
                            pieces.kept.rotate_left(1);
                            pieces.kept[MAX_PIECES - 1] = piece;
                        }
                        Some(pieces) => {
                            pieces.kept[pieces.len] = piece;
                            pieces.len += 1;
                        }
                        None => pieces = Some(Pieces::new(piece)),
                    }
                }
            }
            if let (Some(best), Some(pieces), Some(at)) = (&best, &pieces, slant) {
                if let Some((corners, weights, len)) = pieces.passed(self.noise) {
                    let corners = corners.map(|i| pieces.kept[i].seen);
                    let mut high = zero;
                    for (p, &weight) in corners[..len].iter().zip(&weights) {
                        high += p.t * weight;
                    }
                    if high < self.low {
                        return Err(None);
                    }
                    if high - best.tau <= wanted * best.slant.length() {
                        return self.close(frame, &corners[..len], &weights[..len], high, best);
                    }
                }
                // Near the end, Newton's step is the same, and does not cancel.
                let (x, y) = bend.solve((seen.u, seen.v));
                let rest = x * seen.u + y * seen.v;
                if !(rest <= last * ScalarOf::<B>::from_f64(0.5)) {
                    return Err(None);
                }
                last = rest;
                let small = at.length() * ScalarOf::<B>::from_f64(0.05);
                if x * x + y * y <= small * small {
                    let to = Slant { a: at.a - x, b: at.b - y };
                    (n, slant) = (frame.normal(direction, to), Some(to));
                    continue;
                }
            }
            // Q in the axes e₁, e₂ and −d: (A b; b·ᵀ c). With α = A⁻¹(s·φ − b) for the line's foot φ, and
            // s² = n·Qn = (c − b·A⁻¹b)/(1 − φ·A⁻¹φ), the support point of the ellipsoid is on the line.
            let touch = [seen.u + foot.0, seen.v + foot.1, -seen.t];
            let value = n.dot(frame.e1) * touch[0] + n.dot(frame.e2) * touch[1] - n.dot(direction) * touch[2];
            let across = Symmetric {
                a: value * bend.a + touch[0] * touch[0],
                b: value * bend.b + touch[0] * touch[1],
                d: value * bend.d + touch[1] * touch[1],
            };
            let b = (
                value * moved[2].dot(frame.e1) + touch[0] * touch[2],
                value * moved[2].dot(frame.e2) + touch[1] * touch[2],
            );
            let c = -value * moved[2].dot(direction) + touch[2] * touch[2];
            let (away, tilted) = (across.solve(foot), across.solve(b));
            let rest = one - dot(foot, away);
            if !(value > zero) {
                return Err(None);
            }
            if rest > zero {
                let s = ((c - dot(b, tilted)).max(zero) / rest).sqrt();
                let to = Slant { a: s * away.0 - tilted.0, b: s * away.1 - tilted.1 };
                (n, slant) = (frame.normal(direction, to), Some(to));
            } else {
                // The line misses the ellipsoid, and the plane between is along it.
                (n, slant) = (frame.e1 * away.0 + frame.e2 * away.1, None);
            }
        }
        Err(None)
    }
}
