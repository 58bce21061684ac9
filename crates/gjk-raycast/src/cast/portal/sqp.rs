//! The search where the body is curved in pieces.
//!
//! Near a direction where it is smooth, `τ(α) = min over the body of t − α·(u, v)` is twice differentiable: with `p(α)`
//! the support point, its gradient is `−(u, v)` of `p`, and its Hessian is `−H`, where `H` is the derivative of `(u,
//! v)` along `α`.
//!
//! Where pieces meet, such as the rims of a cylinder along its side, each is a quadratic model of its own
//! (`pieces.rs`), and the next plane is where the least of the models is greatest ([`best_plane`]): a step of
//! sequential quadratic programming (Nocedal and Wright, *Numerical Optimization*, ch. 18), which for three pieces is
//! the portal's own plane. Of two pieces, both have to be found in turn, though a plane finds only the one that
//! extends farther; so the plane is moved by a little more than the error of the older model to its side.

use convex_support::numerics::range::power_of_two;
use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::closing::{BestPlane, OnLine};
use super::pieces::{MAX_PIECES, QuadraticModel, RayPiece, RayPieces};
use crate::cast::bracket::Bracket;
use crate::cast::ray_frame::{Alpha, RayFrame, RayPlane, RayPoint, weights_of_zero};
use crate::cast::{RayContact, Stop};
use crate::curvature::{between, is_stiff_across, share_of_second};
use crate::symmetric::{Across, Symmetric, cross, dot, way};

/// Support points of the search.
const MAX_SQP_STEPS: usize = 40;

/// Steps of the models that do not halve the bracket before the next one is the portal's own plane.
const IDLE_MODELS: i32 = 3;

/// The largest tilt of the next plane from pieces that do not enclose the line, in units of the tilt of the last
/// planes.
const OPEN_TILT: f64 = 8.0;

/// Brings a portal nearer, by planes that the curvature of the body suggests as long as they close the bracket fast,
/// and by the portal's own. The points were found by planes tilted from one another by `tilt`.
pub(super) fn sqp<V: Vector>(
    bracket: &mut Bracket<'_, V>,
    frame: &RayFrame<V>,
    mut portal: OnLine<V>,
    mut best: BestPlane<V>,
    tilt: V::Scalar,
) -> Result<RayContact<V>, Stop<V>> {
    let mut alpha = if portal.high.is_finite() { portal.alpha() } else { best.alpha };
    let mut pieces = RayPieces::new();
    for p in &portal.corners {
        pieces.push(piece(bracket, frame, *p, alpha), bracket.noise);
    }
    // The plane of a warm start is near enough for models, and too near for the plane through the points.
    if tilt < Scalar::ONE
        && let Some(newest) = pieces.all().last()
    {
        let is_enclosed = portal.high.is_finite();
        let far = tilt * V::Scalar::from_f64(OPEN_TILT) * newest.alpha.length();
        let is_near = |(x, y): Across<_>| x * x + y * y <= far * far;
        match best_plane(pieces.all(), newest.alpha, bracket.noise, Scalar::ONE) {
            Some((to, _)) if is_enclosed || is_near(way(newest.alpha.across(), to.across())) => alpha = to,
            _ if is_enclosed => {}
            _ => return Err(Stop::InDoubt),
        }
    }
    let start = bracket.low();
    let mut steps = Steps { gap: V::Scalar::infinity(), failures: 0, error_weight: V::Scalar::ONE };
    for _ in 0..MAX_SQP_STEPS {
        let p = frame.support_of(bracket, alpha.plane())?;
        best.improve(bracket, frame, alpha, &p, Scalar::ZERO)?;
        let same = pieces.push(piece(bracket, frame, p, alpha), bracket.noise);
        steps.weigh_error(same);
        let floor = best.tau - bracket.noise * best.alpha.length();
        portal.exchange(&p, floor);
        if portal.high < floor {
            // No part of the body is before the plane: zero was in the triangle by rounding alone.
            portal.high = V::Scalar::infinity();
        } else if portal.high < start {
            break;
        }
        // A segment first, since the weights in a flat triangle may be nothing but rounding.
        let passed = pieces.passed(bracket.noise).filter(|below| below.high >= start);
        for below in passed.into_iter().chain([portal]) {
            if best.alpha.is_within(below.high - best.tau, bracket.tolerance()) {
                match best.close(bracket, frame, &below.corners, &below.weights, below.high) {
                    Err(Stop::InDoubt) => {}
                    found => return found,
                }
            }
        }
        let Some(to) = steps.next(bracket, &pieces, &portal, &best, alpha) else { break };
        alpha = to;
    }
    Err(Stop::InDoubt)
}

/// A point's piece at the plane it was found on. A point found on a plane along the ray is a vertex.
#[inline(always)]
fn piece<V: Vector>(
    bracket: &Bracket<'_, V>,
    frame: &RayFrame<V>,
    p: RayPoint<V>,
    alpha: Alpha<V::Scalar>,
) -> RayPiece<V> {
    match p.alpha {
        Some(alpha) => RayPiece { p, alpha, hessian: frame.hessian(bracket.body, frame.normal(alpha.plane())) },
        None => RayPiece { p, alpha, hessian: Symmetric::ZERO },
    }
}

struct Steps<S> {
    /// The bracket that the last step predicted.
    gap: S,
    /// Steps in a row that did not halve it.
    failures: i32,
    /// How much of its error is added to an older model.
    error_weight: S,
}

impl<S: Scalar> Steps<S> {
    /// Too little of the error finds the same piece again; too much goes back and forth between two.
    #[inline(always)]
    fn weigh_error(&mut self, same_piece: bool) {
        self.error_weight =
            if same_piece { self.error_weight * S::from_f64(8.0) } else { power_of_two(-self.failures) };
    }

    #[inline(always)]
    fn next<V: Vector<Scalar = S>>(
        &mut self,
        bracket: &Bracket<'_, V>,
        pieces: &RayPieces<V>,
        portal: &OnLine<V>,
        best: &BestPlane<V>,
        alpha: Alpha<S>,
    ) -> Option<Alpha<S>> {
        let suggested = if self.failures < IDLE_MODELS || portal.high.is_infinite() {
            best_plane(pieces.all(), alpha, bracket.noise, self.error_weight)
        } else {
            None
        };
        let gap = suggested.map_or(portal.high, |(_, value)| value.min(portal.high)) - best.tau;
        let halved = gap <= self.gap * S::from_f64(0.5);
        let restarts = self.failures >= IDLE_MODELS && portal.high.is_finite();
        self.failures = if halved || restarts { 0 } else { self.failures + 1 };
        self.gap = gap;
        let to = match suggested {
            Some((to, _)) => to,
            None if portal.high.is_finite() => portal.alpha(),
            None => return None,
        };
        // The same plane again gives nothing new.
        (to != alpha).then_some(to)
    }
}

impl<V: Vector> OnLine<V> {
    /// Points of the body that form no portal.
    pub(super) fn unknown(corners: [RayPoint<V>; 3]) -> Self {
        Self { corners, weights: [V::Scalar::ZERO; 3], high: V::Scalar::infinity() }
    }

    fn alpha(&self) -> Alpha<V::Scalar> {
        let [p, q, s] = &self.corners;
        RayPlane::through([p, q, s]).alpha()
    }

    /// Puts a point in the place of one corner, if the line still runs through the triangle, and earlier; but no
    /// earlier than `floor`, before which there is no part of the body: a triangle that is as flat as rounding may not
    /// contain zero.
    fn exchange(&mut self, r: &RayPoint<V>, floor: V::Scalar) {
        let zero = V::Scalar::ZERO;
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let (p, q) = (&self.corners[j], &self.corners[k]);
            let weights = weights_of_zero([r.across(), p.across(), q.across()]);
            let sum = weights[0] + weights[1] + weights[2];
            // Where no portal is known yet, the corners that are kept may be on the wrong side.
            if weights.iter().all(|&weight| weight >= zero) && sum > zero {
                let inverse = sum.recip();
                let high = (weights[0] * r.t + weights[1] * p.t + weights[2] * q.t) * inverse;
                if high < self.high && high >= floor {
                    (self.corners[i], self.high) = (*r, high);
                    (self.weights[i], self.weights[j]) = (weights[0] * inverse, weights[1] * inverse);
                    self.weights[k] = weights[2] * inverse;
                }
                return;
            }
        }
    }
}

/// The change where the least of the models is greatest, and the models' value there.
///
/// With `τᵢ`, `Pᵢ` and `Hᵢ` of the pieces turned to the last plane, and `δ` the change of `α`, `mᵢ(δ) = τᵢ − Pᵢ·δ −
/// ½·δ·Hᵢδ`. At the maximum of their minimum there are weights `wᵢ ≥ 0` with sum 1, and `W = Σ wᵢ·Hᵢ`, such that
///
/// ```text
/// Σ wᵢ·Pᵢ + W·δ = 0,   mᵢ(δ) alike where wᵢ > 0, and no lower elsewhere.
/// ```
///
/// One piece gives `δ = −H⁻¹P`, or if `H` is singular, [`along_edge`]. For two, with `e = Pⱼ − Pᵢ`, the second
/// condition to first order is `e·δ = τⱼ − τᵢ`, and the first one [across](between) `e` gives the rest. For three,
/// the plane where all are alike is the portal's own.
///
/// The newest piece is the lowest where it was found, and mostly active. So combinations without it are tried only if
/// none with it is the least.
fn best_plane<V: Vector>(
    pieces: &[RayPiece<V>],
    alpha: Alpha<V::Scalar>,
    noise: V::Scalar,
    error_weight: V::Scalar,
) -> Option<(Alpha<V::Scalar>, V::Scalar)> {
    let mut models = Models::new(pieces, alpha, noise, error_weight)?;
    let newest = models.len - 1;
    for i in (0..models.len).rev() {
        if i < newest && models.best.is_some() {
            break;
        }
        models.offer_one(i);
        (0..i).for_each(|j| models.offer_two(i, j));
    }
    models.best.map(|((x, y), value)| (Alpha { a: alpha.a + x, b: alpha.b + y }, value))
}

struct Models<S> {
    turned: [QuadraticModel<S>; MAX_PIECES],
    len: usize,
    /// The `τ` of each, with a margin such that the right pieces are found next.
    tau: [S; MAX_PIECES],
    noise: S,
    /// The length of the normal that the models are turned to.
    length: S,
    /// The error of `τ` from the rounding of the planes.
    margin: S,
    /// The best change so far, and the least of the models there.
    best: Option<(Across<S>, S)>,
}

impl<S: Scalar> Models<S> {
    #[inline(always)]
    fn new<V: Vector<Scalar = S>>(pieces: &[RayPiece<V>], alpha: Alpha<S>, noise: S, error_weight: S) -> Option<Self> {
        let (last, others) = pieces.split_last()?;
        let last = last.at(alpha, -S::infinity(), S::ZERO);
        let mut turned = [last; MAX_PIECES];
        for (t, piece) in turned.iter_mut().zip(others) {
            *t = piece.at(alpha, last.tau, error_weight);
        }
        let length = alpha.length();
        let margin = S::from_f64(0.5) * noise * length;
        // A vertex is exact; of other pieces, those that were not found last are to be found next.
        let mut tau = turned.map(|t| if t.hessian.is_zero() { t.tau - margin } else { t.tau + error_weight * margin });
        tau[others.len()] = last.tau;
        Some(Self { turned, len: pieces.len(), tau, noise, length, margin, best: None })
    }

    /// Takes a change where some of the models are alike, if they are the least ones there. `active` has a bit for each
    /// of them.
    #[inline(always)]
    fn offer(&mut self, change: Across<S>, active: usize) {
        let squared = dot(change, change);
        let least = S::EPSILON * self.length;
        // NaN fails this too.
        if !(squared <= self.length * self.length && squared > least * least) {
            return;
        }
        let (mut value, mut other) = (S::infinity(), S::infinity());
        for (i, t) in self.turned[..self.len].iter().enumerate() {
            let model = t.at(change);
            if active >> i & 1 == 1 {
                value = value.min(model);
            } else {
                other = other.min(model);
            }
        }
        let slack = self.margin + self.margin + (value - self.turned[self.len - 1].tau).abs() * S::from_f64(0.1);
        if other >= value - slack && self.best.is_none_or(|(_, found)| value > found) && value.is_finite() {
            self.best = Some((change, value));
        }
    }

    #[inline(always)]
    fn offer_one(&mut self, i: usize) {
        let t = &self.turned[i];
        if t.hessian.is_regular() {
            let (x, y) = t.hessian.solve(t.p);
            self.offer((-x, -y), 1 << i);
        } else if let Some(change) = along_edge(&self.turned[..self.len], i, self.noise * self.length, self.noise) {
            self.offer(change, 1 << i);
        }
    }

    #[inline(always)]
    fn offer_two(&mut self, i: usize, j: usize) {
        let (t, s) = (&self.turned[i], &self.turned[j]);
        let e = way(t.p, s.p);
        let squared = dot(e, e);
        let hessian = t.hessian.blend(s.hessian, share_of_second(t.p, e));
        // Points no farther apart than rounding are one.
        if squared > self.noise * self.noise && is_stiff_across(hessian, e) {
            let change = between(hessian, t.p, e, self.tau[j] - self.tau[i]);
            let share = -dot(e, t.p) - dot(e, hessian.times(change));
            if share >= S::ZERO && share <= squared {
                self.offer(change, 1 << i | 1 << j);
            }
        }
    }
}

/// Where the model of a piece with `H = κ·q·qᵀ` is greatest: an edge of the body, curved or straight, that the line
/// runs through when `q·P` is zero.
///
/// Across the edge, `δ = −(q·P)/κ·q`. Along it the plane is free, between those of the other pieces; it is turned
/// away from them, since otherwise it would find another piece.
fn along_edge<S: Scalar>(models: &[QuadraticModel<S>], edge: usize, least: S, noise: S) -> Option<Across<S>> {
    let t = &models[edge];
    let (curvature, q) = t.hessian.eigen_of_rank_one()?;
    let (beside, along) = (dot(q, t.p), cross(q, t.p));
    // If the line is along the edge rather than beside it, another piece is needed.
    if !(along.abs() <= beside.abs().max(noise)) {
        return None;
    }
    let step = -beside / curvature;
    let change = (q.0 * step, q.1 * step);
    let value = t.at(change);
    let (mut from, mut to) = (-S::infinity(), S::infinity());
    for (i, other) in models.iter().enumerate() {
        let (spare, falls) = (other.at(change) - value, cross(q, other.p) - along);
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
