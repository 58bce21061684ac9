//! The plane where the least of several quadratic models of `τ` is greatest.

use convex_support::{Scalar, Vector};

use super::pieces::{MAX_PIECES, QuadraticModel, RayPiece};
use crate::cast::ray_frame::Alpha;
use crate::curvature::{between, is_stiff_across, share_of_second};
use crate::symmetric::{Across, cross, dot, way};

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
