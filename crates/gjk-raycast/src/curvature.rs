//! Newton's method on the plane, where a support map tells how its support point moves.
//!
//! A distance is the largest `f(n)` over all unit vectors `n`, with `f` how far the plane across `n` that supports the
//! body is from zero; the entry of a ray is the largest `τ(α)` over all planes that the ray approaches. Both are
//! concave, and every plane is a bound. The unknown is the change `δ` of the normal `n` across an axis `a`, the normal
//! itself or the ray: two numbers in space, by two unit vectors across the axis. With `P` the part of the support point
//! across the axis, and `H` the Hessian of the support value, `P` moves to `P + H·δ`. It is to vanish, where the
//! support point is to be on a ray along the axis; or to be `−ρ·δ`, where it is to point to zero, at the distance `ρ`,
//! along the normal:
//!
//! ```text
//! (H + ρ)·δ = −P,   ρ = 0 for a ray.
//! ```
//!
//! That is one smooth piece of the surface. Where the answer is between two, as on the side of a cylinder between its
//! rims, both have to support one plane. With `Q` and `H_Q` those of the second piece at the same normal, `g` how much
//! farther the first one reaches there, and `β` the weight of the second,
//!
//! ```text
//! (H_β + ρ)·δ + β·e = −P,   e·δ = g,   e = Q − P,   H_β = (1 − β)·H_P + β·H_Q.
//! ```
//!
//! Along `e` the change is given by the second equation ([`between`]), and across it the first one tells the rest.
//! Three pieces fix a plane by themselves.

use convex_support::Scalar;

use crate::symmetric::{Across, Symmetric, dot, turned_left};

/// Two support points are of one smooth piece if the curvature at one predicts the way to the other but for this part.
pub(crate) const SAME_PIECE: f64 = 0.25;

/// The largest tangent of an angle by which a prediction turns a normal.
pub(crate) const LARGEST_TURN: f64 = 0.5;

/// The weight `β` of the second of two points `P` and `P + e` in the point between them that is closest to zero.
pub(crate) fn share_of_second<S: Scalar>(p: Across<S>, e: Across<S>) -> S {
    (-dot(e, p) / dot(e, e)).max(S::ZERO).min(S::ONE)
}

/// The `δ` with `e·δ = g` and `e⊥·(P + H·δ) = 0`: `δ = (g/e²)·e + s·e⊥`, `s = −e⊥·(P + (g/e²)·H·e) / e⊥·H·e⊥`. In the
/// plane there is nothing across `e`.
pub(crate) fn between<S: Scalar>(h: Symmetric<S>, p: Across<S>, e: Across<S>, g: S) -> Across<S> {
    let across = turned_left(e);
    let pulled = h.times(across);
    let t = g / dot(e, e);
    let (left, stiffness) = (dot(across, p) + t * dot(e, pulled), dot(across, pulled));
    let s = if left == S::ZERO { left } else { -left / stiffness };
    (e.0 * t + across.0 * s, e.1 * t + across.1 * s)
}

/// Whether the part of `H` across `e` is more than rounding for [`between`].
pub(crate) fn is_stiff_across<S: Scalar>(h: Symmetric<S>, e: Across<S>) -> bool {
    let across = turned_left(e);
    dot(across, h.times(across)) > S::EPSILON.sqrt() * dot(e, e) * (h.a + h.d)
}

/// The Hessian of a body swept by a ball, across an axis, at the normal whose part across it is given and whose squared
/// length is `squared`: that of a ball is `(ρ/|n|)·(1 − n·nᵀ/|n|²)`.
pub(crate) fn swept<S: Scalar>(core: Symmetric<S>, radius: S, across: Across<S>, squared: S) -> Symmetric<S> {
    let per_length = radius / squared.sqrt();
    Symmetric {
        a: core.a + per_length * (S::ONE - across.0 * across.0 / squared),
        b: core.b - per_length * (across.0 * across.1 / squared),
        d: core.d + per_length * (S::ONE - across.1 * across.1 / squared),
    }
}

/// A smooth piece of the surface at another normal than the one it was found along; see [`turned`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turned<S> {
    /// How far the support point moves across the axis.
    pub(crate) shift: Across<S>,
    /// How much farther along the new normal the new support point is than the old one.
    pub(crate) rise: S,
    /// The Hessian at the new normal.
    pub(crate) hessian: Symmetric<S>,
}

/// The piece whose Hessian is `H` at the normal `n₀`, turned to `n = n₀ + δ`. Both normals have length one along the
/// axis, and `m` is the part of `n₀` across it.
///
/// The support value `h` is homogeneous, so that `H·n₀ = 0`, and the part of `H` across the axis tells all of it.
/// Scaled to `n/s` with `s = n·n₀/|n₀|²`, the normal differs from `n₀` by a vector across `n₀`; there `h` is quadratic
/// to third order on a ball or a circle, and not only to second as in `n`. With `g = H·δ` and `p₀` the support point at
/// `n₀`,
///
/// ```text
/// h(n) = s·h(n/s) ≈ n·p₀ + δ·g/(2s).
/// ```
///
/// Its derivatives are the point and its Hessian:
///
/// ```text
/// p = p₀ + g/s − δ·g/(2s²|n₀|²)·m,   H' = H/s − (g·mᵀ + m·gᵀ)/(s²|n₀|²) + δ·g/(s³|n₀|⁴)·m·mᵀ.
/// ```
pub(crate) fn turned<S: Scalar>(hessian: Symmetric<S>, m: Across<S>, change: Across<S>) -> Turned<S> {
    let squared = S::ONE + dot(m, m);
    // 1/s, and 1/(s|n₀|²).
    let per_s = squared / (squared + dot(m, change));
    let share = per_s / squared;
    let g = hessian.times(change);
    let rise = S::from_f64(0.5) * dot(change, g) * per_s;
    let shift = (g.0 * per_s - m.0 * (rise * share), g.1 * per_s - m.1 * (rise * share));
    // H' = H/s − (k·mᵀ + m·kᵀ), with half of the last term in each of the products.
    let k = (shift.0 * share, shift.1 * share);
    let hessian = Symmetric {
        a: hessian.a * per_s - (k.0 * m.0 + k.0 * m.0),
        b: hessian.b * per_s - (k.0 * m.1 + k.1 * m.0),
        d: hessian.d * per_s - (k.1 * m.1 + k.1 * m.1),
    };
    Turned { shift, rise, hessian }
}
