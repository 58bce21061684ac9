//! The plane where the least of several quadratic models of `τ` is greatest.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::piece::{MAX_PIECES, Piece, Turned};
use crate::symmetric::{Across, cross, dot};
use crate::view::Slant;

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
///
/// The newest piece is the lowest where it was looked at, and mostly one of those. So those without it are tried only where none
/// with it will do.
pub(crate) fn summit<V: Vector, W: Copy>(
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
    let newest = pieces.len() - 1;
    // A vertex is known as well as it ever will be; of other pieces, those are wanted that were not looked at last.
    let mut led = turned.map(|t| if t.bend.is_zero() { t.tau - lead } else { t.tau + caution * lead });
    led[newest] = last.tau;
    let turned = &turned[..pieces.len()];
    // Where some of the models are alike counts if they are the least ones there. `active` has a bit for each of them.
    let mut best: Option<(Across<V::Scalar>, V::Scalar)> = None;
    let offer = |best: &mut Option<(Across<V::Scalar>, V::Scalar)>, (x, y): Across<V::Scalar>, active: usize| {
        let squared = x * x + y * y;
        let least = V::Scalar::EPSILON * length;
        // NaN fails this too.
        if !(squared <= length * length && squared > least * least) {
            return;
        }
        let (mut value, mut other) = (V::Scalar::infinity(), V::Scalar::infinity());
        for (i, t) in turned.iter().enumerate() {
            let model = t.model((x, y));
            if active >> i & 1 == 1 {
                value = value.min(model);
            } else {
                other = other.min(model);
            }
        }
        let slack = lead + lead + (value - last.tau).abs() * V::Scalar::from_f64(0.1);
        if other >= value - slack && best.is_none_or(|(_, found)| value > found) && value.is_finite() {
            *best = Some(((x, y), value));
        }
    };

    for (i, t) in turned.iter().enumerate().rev() {
        if i < newest && best.is_some() {
            break;
        }
        if t.bend.is_regular() {
            let (x, y) = t.bend.solve(t.at);
            offer(&mut best, (-x, -y), 1 << i);
        } else if let Some(change) = along_edge(turned, i, noise * length, noise) {
            offer(&mut best, change, 1 << i);
        }
        for (j, s) in turned[..i].iter().enumerate() {
            let e = (s.at.0 - t.at.0, s.at.1 - t.at.1);
            let squared = dot(e, e);
            if !(squared > noise * noise) {
                continue;
            }
            let inverse = squared.recip();
            let across = (-e.1, e.0);
            let share = (-dot(e, t.at) * inverse).max(zero).min(one);
            let bend = t.bend.blend(s.bend, share);
            let pulled = bend.times(across);
            let stiffness = dot(across, pulled);
            if stiffness > V::Scalar::EPSILON.sqrt() * squared * (bend.a + bend.d) {
                let along = (led[j] - led[i]) * inverse;
                let aside = -(dot(across, t.at) + along * dot(e, pulled)) / stiffness;
                let change = (e.0 * along + across.0 * aside, e.1 * along + across.1 * aside);
                let share = -dot(e, t.at) - dot(e, bend.times(change));
                if share >= zero && share <= squared {
                    offer(&mut best, change, 1 << i | 1 << j);
                }
            }
            for (k, r) in turned[..j].iter().enumerate() {
                let f = (r.at.0 - t.at.0, r.at.1 - t.at.1);
                let area = cross(e, f);
                let turn = one.copysign(area);
                let weights = [cross(s.at, r.at) * turn, cross(r.at, t.at) * turn, cross(t.at, s.at) * turn];
                // NaN fails this too.
                if !weights.iter().all(|&w| w >= zero) {
                    continue;
                }
                let (g, h) = (led[j] - led[i], led[k] - led[i]);
                let change = ((g * f.1 - h * e.1) / area, (e.0 * h - f.0 * g) / area);
                offer(&mut best, change, 1 << i | 1 << j | 1 << k);
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
