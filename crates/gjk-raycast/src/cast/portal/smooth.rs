//! The search if the body is smooth: it is replaced by the ellipsoid about its origin that osculates it, which has
//! the same support point and Hessian there.
//!
//! The support value of an ellipsoid is `h(n) = √(n·Qn)`, so its support point and Hessian are `p = Qn/h` and `H = (Q −
//! p·pᵀ)/h`, whence `Q = h·H + p·pᵀ`. Where the ray enters it is known in closed form, and the next plane is the one
//! there. An ellipsoid is its own model.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::closing::BestPlane;
use super::pieces::{RayPiece, RayPieces};
use crate::cast::bracket::Bracket;
use crate::cast::ray_frame::{Alpha, RayFrame, RayPoint};
use crate::cast::{RayContact, Stop};
use crate::symmetric::{Symmetric, dot};

/// Support points of the search.
const MAX_SMOOTH_STEPS: usize = 12;

/// Planes along the ray, between it and an ellipsoid that it misses, that do not separate it from the body.
const MAX_MISSES: usize = 2;

/// The largest error, as an angle, of a plane from a warm start, if it is of the same piece.
const WARM_ERROR: f64 = 0.3;

/// Replaces the body by the ellipsoid that osculates it, takes the plane where the ray enters that, and so on.
///
/// If a warm start gave the plane, and the point `seen` there is of another piece, no ellipsoid replaces the body.
pub(super) fn smooth<V: Vector>(
    bracket: &mut Bracket<'_, V>,
    frame: &RayFrame<V>,
    first: V,
    is_warm: bool,
    seen: &mut Option<RayPoint<V>>,
) -> Result<RayContact<V>, Stop<V>> {
    let tolerance = bracket.tolerance();
    let mut next = Next { n: first, alpha: None };
    let mut best = BestPlane::none(bracket.end());
    let mut pieces = RayPieces::new();
    let (mut last, mut misses) = (V::Scalar::infinity(), 0);
    for _ in 0..MAX_SMOOTH_STEPS {
        let Next { n, alpha } = next;
        let hessian = frame.hessian(bracket.body, n);
        // For a plane along the ray it never is, since H·n = 0 and n is across the ray.
        if (alpha.is_some() || misses == 0) && !hessian.is_regular() {
            return Err(Stop::InDoubt);
        }
        let mut p = frame.support(bracket, n)?;
        p.alpha = alpha;
        if let Some(alpha) = alpha {
            best.improve(bracket, frame, alpha, &p, Scalar::ZERO)?;
            if is_warm && let Some(found) = in_ball(bracket, frame, &best, &p, hessian) {
                return Ok(found);
            }
            pieces.follow(RayPiece { p, alpha, hessian });
            if let Some(below) = pieces.passed(bracket.noise) {
                if below.high < bracket.low() {
                    return Err(Stop::InDoubt);
                }
                if below.high - best.tau <= tolerance * best.alpha.length() {
                    return best.close(bracket, frame, &below.corners, &below.weights, below.high);
                }
            }
            // Near the end, Newton's step H·δ = −(u, v) is the same, and does not cancel.
            let (x, y) = hessian.solve(p.across());
            let gain = dot((x, y), p.across());
            if !(gain <= last * V::Scalar::from_f64(0.5)) {
                return Err(Stop::InDoubt);
            }
            last = gain;
            let small = alpha.length() * V::Scalar::from_f64(0.05);
            if x * x + y * y <= small * small {
                next = Next::crossed(frame, Alpha { a: alpha.a - x, b: alpha.b - y });
                continue;
            }
        } else {
            if let Some(n) = n.unit() {
                bracket.advance(n, p.point)?;
            }
            if is_warm && misses == 0 {
                let (x, y) = hessian.solve(p.across());
                // NaN fails this too.
                if !((x * x + y * y) * n.length_squared() <= V::Scalar::from_f64(WARM_ERROR * WARM_ERROR)) {
                    *seen = Some(p);
                    return Err(Stop::InDoubt);
                }
            }
            if misses == MAX_MISSES {
                return Err(Stop::InDoubt);
            }
        }
        next = enter_ellipsoid(bracket, frame, n, &p, hessian)?;
        misses += usize::from(next.alpha.is_none());
    }
    Err(Stop::InDoubt)
}

/// The contact at a ball that rolls within the body and touches its surface at `p`, if the line enters the ball
/// within rounding of the best plane. This takes one support point less than a point of the body on the line.
///
/// With `c = p − ρ·n` the ball's centre, `n` of unit length, the line enters it at `t_c − √(ρ² − u_c² − v_c²)`:
/// behind the plane by the square of the distance from `p`. The normal and both shapes' points are moved to where
/// Newton's step leads, `δ` with `H·δ = −(u, v)`, by each shape's part of the core's Hessian. At a ball as small as the
/// root of the noise that step may be rounding, by an angle at which far points of the body are before the plane.
#[inline(never)]
fn in_ball<V: Vector>(
    bracket: &mut Bracket<'_, V>,
    frame: &RayFrame<V>,
    best: &BestPlane<V>,
    p: &RayPoint<V>,
    hessian: Symmetric<V::Scalar>,
) -> Option<RayContact<V>> {
    let (radius, alpha) = (bracket.rolling_radius, best.alpha);
    // NaN fails this too.
    if !(radius * radius > bracket.noise) {
        return None;
    }
    let per_length = radius / alpha.length();
    let (u, v) = (p.u - alpha.a * per_length, p.v - alpha.b * per_length);
    let high = p.t + per_length - (radius * radius - (u * u + v * v)).sqrt();
    if !(p.alpha == Some(alpha) && alpha.is_within(high - best.tau, bracket.noise)) {
        return None;
    }
    let n = frame.normal(alpha.plane());
    let unit = n.unit()?;
    let (x, y) = hessian.solve(p.across());
    let change = frame.vector((-x, -y));
    let witness = frame.turned(bracket.body, n, change, p.witness);
    bracket.advance(unit, p.point).ok()?;
    let found = bracket.close(radius, p.point - unit * (radius - bracket.radius), witness, high).ok()?;
    Some(RayContact { normal: (n + change).unit(), ..found })
}

/// The normal of the next plane; by its `α`, if the ray crosses it.
struct Next<V: Vector> {
    n: V,
    alpha: Option<Alpha<V::Scalar>>,
}

impl<V: Vector> Next<V> {
    #[inline(always)]
    fn crossed(frame: &RayFrame<V>, alpha: Alpha<V::Scalar>) -> Self {
        Self { n: frame.normal(alpha.plane()), alpha: Some(alpha) }
    }
}

/// The plane where the ray enters the ellipsoid with support point `p` and this Hessian at `n`; or if the ray misses
/// the ellipsoid, the plane along the ray between them.
///
/// In the axes `e₁`, `e₂` and `−d` let `Q = (A b; bᵀ c)`, and `φ` be the line's foot. The support point is on the
/// line if `(A·α + b)/s = φ` with `s² = n·Qn`, hence
///
/// ```text
/// α = A⁻¹(s·φ − b),   s² = (c − b·A⁻¹b)/(1 − φ·A⁻¹φ).
/// ```
#[inline(always)]
fn enter_ellipsoid<V: Vector>(
    bracket: &Bracket<'_, V>,
    frame: &RayFrame<V>,
    n: V,
    p: &RayPoint<V>,
    hessian: Symmetric<V::Scalar>,
) -> Result<Next<V>, Stop<V>> {
    let zero = V::Scalar::ZERO;
    let foot = frame.split(frame.line.foot).0;
    let point = ((p.u + foot.0, p.v + foot.1), -p.t);
    let (across, facing) = frame.split(n);
    let h = dot(across, point.0) + facing * point.1;
    // The last column of H, from H·n = 0 unless the plane is nearly along the ray.
    let column = if facing * facing > n.length_squared() * V::Scalar::from_f64(0.01) {
        let (x, y) = hessian.times(across);
        let beside = (-x / facing, -y / facing);
        (beside, -dot(across, beside) / facing)
    } else {
        frame.hessian_against(bracket.body, n)
    };
    let a = Symmetric {
        a: h * hessian.a + point.0.0 * point.0.0,
        b: h * hessian.b + point.0.0 * point.0.1,
        d: h * hessian.d + point.0.1 * point.0.1,
    };
    let b = (h * column.0.0 + point.0.0 * point.1, h * column.0.1 + point.0.1 * point.1);
    let c = h * column.1 + point.1 * point.1;
    let (away, tilted) = (a.solve(foot), a.solve(b));
    let rest = V::Scalar::ONE - dot(foot, away);
    if !(h > zero) {
        Err(Stop::InDoubt)
    } else if rest > zero {
        let s = ((c - dot(b, tilted)).max(zero) / rest).sqrt();
        Ok(Next::crossed(frame, Alpha { a: s * away.0 - tilted.0, b: s * away.1 - tilted.1 }))
    } else {
        Ok(Next { n: frame.vector(away), alpha: None })
    }
}
