//! Smooth pieces of a body's surface as they are seen along a ray, each a quadratic model of `τ`, and the plane where the
//! least of several models is greatest.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::bracket::Bracket;
use super::ray_frame::{Alpha, RayFrame, RayPoint, weights_of_zero};
use crate::curvature::{between, is_stiff_across, share_of_second, turned};
use crate::symmetric::{Across, Symmetric, cross, dot};

/// A support point, the plane it was found on, and how it moves from there.
#[derive(Clone, Copy, Default)]
pub(super) struct RayPiece<V: Vector> {
    pub(super) p: RayPoint<V>,
    pub(super) alpha: Alpha<V::Scalar>,
    pub(super) hessian: Symmetric<V::Scalar>,
}

/// A piece as it is expected at another plane: `τ(α + δ) ≈ τ − P·δ − δ·Hδ/2`.
#[derive(Clone, Copy, Debug)]
struct QuadraticModel<S> {
    tau: S,
    /// The `(u, v)` of its support point.
    p: Across<S>,
    hessian: Symmetric<S>,
}

impl<S: Scalar> QuadraticModel<S> {
    fn at(&self, change: Across<S>) -> S {
        self.tau - dot(self.p, change) - S::from_f64(0.5) * dot(change, self.hessian.times(change))
    }
}

impl<V: Vector> RayPiece<V> {
    /// A point's piece at the plane it was found on. A point found on a plane along the ray counts for itself alone.
    #[inline(always)]
    pub(super) fn new(bracket: &Bracket<'_, V>, frame: &RayFrame<V>, p: RayPoint<V>, alpha: Alpha<V::Scalar>) -> Self {
        match p.alpha {
            Some(alpha) => Self { p, alpha, hessian: frame.hessian(bracket.body, frame.normal(alpha.plane())) },
            None => Self { p, alpha, hessian: Symmetric::ZERO },
        }
    }

    /// The piece [turned](turned) to another plane, where nothing is crossed before `least`.
    ///
    /// The plane through the point alone is never crossed before the body, and the body's own plane earlier. How wrong
    /// the model may be is told by the angle that the plane turns by, and by how far the point moves; where that is too
    /// far, or where it foretells less than was found, a point counts for itself alone. So much of its error as
    /// `error_weight` is added: where a model is wrong, its piece then shows itself, and is known anew.
    fn at(&self, alpha: Alpha<V::Scalar>, least: V::Scalar, error_weight: V::Scalar) -> QuadraticModel<V::Scalar> {
        let number = V::Scalar::from_f64;
        let (through, p) = (alpha.tau(&self.p), self.p.across());
        let alone = QuadraticModel { tau: through, p, hessian: Symmetric::ZERO };
        let change = self.alpha.change_to(alpha);
        let angle = dot(change, change) / alpha.length_squared();
        if angle > number(FAR * FAR) || self.hessian.is_zero() {
            return alone;
        }
        // τ = −h, so that it sinks where h rises.
        let turned = turned(self.hessian, self.alpha.across(), change);
        let moved = dot(turned.shift, turned.shift);
        let error = turned.rise * angle.max(number(4.0) * moved).max(number(1.0 / 64.0)).sqrt();
        // NaN fails this too.
        if !(moved <= number(FAR * FAR) && through - turned.rise + error >= least) {
            return alone;
        }
        let tau = ((through - turned.rise).max(least) + error_weight * error).min(through);
        QuadraticModel { tau, p: (p.0 + turned.shift.0, p.1 + turned.shift.1), hessian: turned.hessian }
    }

    /// Whether another support point is of the same piece: it moved as the mean of both Hessians says, which is right
    /// to third order, and no farther than by the body's size.
    fn is_same_as(&self, other: &Self, noise: V::Scalar) -> bool {
        let number = V::Scalar::from_f64;
        let expected = self.hessian.blend(other.hessian, number(0.5)).times(self.alpha.change_to(other.alpha));
        let (moved, _) = self.p.edge_to(&other.p);
        let error = (moved.0 - expected.0, moved.1 - expected.1);
        let squared = dot(moved, moved);
        let allowed = (noise * noise).max(number(SAME_PIECE * SAME_PIECE) * squared);
        squared <= V::Scalar::ONE && dot(error, error) <= allowed
    }
}

/// The angle that a plane may turn by, and the way that the point may move, in units of the body's size, for a piece to
/// be a quadratic model.
const FAR: f64 = 0.5;

/// As many pieces as are kept.
const MAX_PIECES: usize = 4;

/// How far, of the way that a point has moved, it may be from where it was expected to be the same piece's.
const SAME_PIECE: f64 = 0.5;

/// Three points of the body, one of them perhaps more than once, and a combination of them that is on the line.
#[derive(Clone, Copy)]
pub(super) struct OnLine<V: Vector> {
    pub(super) corners: [RayPoint<V>; 3],
    /// With sum 1.
    pub(super) weights: [V::Scalar; 3],
    /// Where on the line it is.
    pub(super) high: V::Scalar,
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

    /// Adds a piece in place of those that are the same, or else of the one that is the farthest from being active.
    /// Tells whether it is the same as the last.
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

    /// The point, segment or triangle of pieces, the newest among them, that the line passes within `noise`.
    pub(super) fn passed(&self, noise: V::Scalar) -> Option<OnLine<V>> {
        let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
        let newest = self.len.checked_sub(1)?;
        let p = self.kept[newest].p.across();
        if dot(p, p) <= noise * noise {
            return Some(self.on_line([newest; 3], [one, zero, zero]));
        }
        for i in 0..newest {
            let (e, _) = self.kept[newest].p.edge_to(&self.kept[i].p);
            let share = (-dot(p, e) / dot(e, e)).max(zero).min(one);
            let nearest = (p.0 + e.0 * share, p.1 + e.1 * share);
            if dot(nearest, nearest) <= noise * noise {
                return Some(self.on_line([newest, i, i], [one - share, share, zero]));
            }
        }
        for i in 0..newest {
            for j in 0..i {
                let across = |i: usize| self.kept[i].p.across();
                let weights = weights_of_zero([across(newest), across(i), across(j)]);
                let sum = weights[0] + weights[1] + weights[2];
                // NaN fails this too.
                if weights.iter().all(|&w| w * sum >= zero) && sum.recip().is_finite() {
                    return Some(self.on_line([newest, i, j], weights.map(|w| w * sum.recip())));
                }
            }
        }
        None
    }

    fn on_line(&self, corners: [usize; 3], weights: [V::Scalar; 3]) -> OnLine<V> {
        let corners = corners.map(|i| self.kept[i].p);
        let mut high = V::Scalar::ZERO;
        for (p, &weight) in corners.iter().zip(&weights) {
            high += p.t * weight;
        }
        OnLine { corners, weights, high }
    }
}

/// Where the least of the models is greatest, and how great it is there.
///
/// With `τᵢ`, `Pᵢ` and `Hᵢ` of the pieces turned to the last plane, and `δ` the change of `α`, `mᵢ(δ) = τᵢ − Pᵢ·δ −
/// ½·δ·Hᵢδ`. At the maximum of their minimum there are weights `wᵢ ≥ 0` with sum 1, and `W = Σ wᵢ·Hᵢ`, such that
///
/// ```text
/// Σ wᵢ·Pᵢ + W·δ = 0,   mᵢ(δ) alike where wᵢ > 0, and no lower elsewhere.
/// ```
///
/// One piece gives `δ = −H⁻¹P`, or where `H` is singular, [`along_edge`]. Of two, with `e = Pⱼ − Pᵢ`, the second
/// condition to first order is `e·δ = τⱼ − τᵢ`, and the first one [across](between) `e` gives the rest. Where three are
/// alike, so is the plane of their points, which needs no model.
///
/// The newest piece is the lowest where it was looked at, and mostly one of those. So those without it are tried only
/// where none with it will do.
#[inline(never)]
pub(super) fn best_plane<V: Vector>(
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
        for j in 0..i {
            models.offer_two(i, j);
        }
    }
    models.best.map(|((x, y), value)| (Alpha { a: alpha.a + x, b: alpha.b + y }, value))
}

struct Models<S> {
    turned: [QuadraticModel<S>; MAX_PIECES],
    len: usize,
    /// The `τ` of each, with a margin such that the pieces wanted are those found next.
    tau: [S; MAX_PIECES],
    noise: S,
    /// The length of the normal that the models are turned to.
    length: S,
    /// What rounding of the planes leaves open of `τ`.
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
        // A vertex is known as well as it ever will be; of other pieces, those are wanted that were not looked at last.
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
        let e = (s.p.0 - t.p.0, s.p.1 - t.p.1);
        let squared = dot(e, e);
        // Points no farther apart than rounding are one.
        if !(squared > self.noise * self.noise) {
            return;
        }
        let hessian = t.hessian.blend(s.hessian, share_of_second(t.p, e));
        if is_stiff_across(hessian, e) {
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
/// Across the edge, `δ = −(q·P)/κ·q`. Along it the plane is free, between those that the other pieces are on; it is
/// laid away from them, since on them it would be another piece that shows itself.
fn along_edge<S: Scalar>(models: &[QuadraticModel<S>], edge: usize, least: S, noise: S) -> Option<Across<S>> {
    let t = &models[edge];
    let (curvature, q) = t.hessian.eigen_of_rank_one()?;
    let (beside, along) = (dot(q, t.p), cross(q, t.p));
    // Where the line is to be found along the edge rather than beside it, another piece is needed.
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
