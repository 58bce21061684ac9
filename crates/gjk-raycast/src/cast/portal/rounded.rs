//! The search for the entry into a core swept by a ball of radius `ρ`, where the core is not curved.
//!
//! The support value of a ball is `ρ·|n|`, so in the coordinates of the ray
//!
//! ```text
//! μ* = max over α of τ(α),   τ(α) = min over the core of t − α·(u, v), less ρ·√(1 + α²),
//! ```
//!
//! which is still concave. If the minimum is over one, two or three points alone, its maximum has a closed form: it
//! is where the ray enters the sphere about the point, the cylinder about the edge, or the plane at distance `ρ` from
//! the triangle. So the search keeps the corner, edge or triangle that the ray enters above, takes the support point
//! there, and goes on to the earliest of the corners, edges and triangles with that point.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::closing::BestPlane;
use super::triangle::MAX_EXCHANGES;
use crate::cast::bracket::Bracket;
use crate::cast::ray_frame::{Alpha, RayFrame, RayPlane, RayPoint};
use crate::cast::{RayContact, Stop};
use crate::symmetric::{Across, cross, dot};

/// Where the line enters the swept hull of some points.
#[derive(Clone, Copy)]
struct RoundedEntry<S> {
    tau: S,
    alpha: Alpha<S>,
    /// The points, and the weights of the core's point below.
    corners: [usize; 3],
    weights: [S; 3],
    len: usize,
}

/// Support points of the search.
const MAX_ROUNDED_STEPS: usize = 32;

/// Closes the bracket, or finds a plane that the whole ray is before; beginning across `first`, and with planes tilted
/// by `tilt` until the line enters the swept points.
#[inline(never)]
pub(super) fn rounded<V: Vector>(
    bracket: &mut Bracket<'_, V>,
    frame: &RayFrame<V>,
    first: V,
    tilt: V::Scalar,
) -> Result<RayContact<V>, Stop<V>> {
    let (radius, noise) = (bracket.radius, bracket.noise);
    let tolerance = bracket.tolerance();
    let mut p = frame.support(bracket, first)?;
    let mut best = BestPlane::none(bracket.end());
    if !bracket.is_point {
        best.begin(bracket, frame, first, &mut p, radius)?;
    }
    let mut alpha = best.alpha;
    let (mut last, mut exchanges) = (V::Scalar::infinity(), MAX_EXCHANGES);
    let mut kept = Kept { points: [p; 4], len: 1 };
    for _ in 0..MAX_ROUNDED_STEPS {
        let Some(at) = enter(kept.points(), radius, noise) else {
            kept.approach(bracket, frame, &mut best, &mut alpha, tilt)?;
            continue;
        };
        let high = at.tau;
        if !(high < last) {
            exchanges -= 1;
            if exchanges == 0 {
                return Err(Stop::InDoubt);
            }
        }
        last = high;
        if high < bracket.low() {
            return Err(Stop::InDoubt);
        }
        kept.keep(at.corners, at.len);
        alpha = at.alpha;
        if bracket.is_point {
            best.set(high, alpha, &p);
        }
        if !best.alpha.is_within(high - best.tau, tolerance) {
            if frame.is_curved(bracket, frame.normal(alpha.plane())) {
                return Err(Stop::InDoubt);
            }
            let next = frame.support_of(bracket, alpha.plane())?;
            let is_better = best.improve(bracket, frame, alpha, &next, radius)?;
            if !(is_better && high - best.tau <= tolerance * alpha.length()) {
                kept.push(next);
                continue;
            }
        }
        return best.close(bracket, frame, kept.points(), &at.weights, at.tau);
    }
    Err(Stop::InDoubt)
}

/// The points that are kept, the newest last.
struct Kept<V: Vector> {
    points: [RayPoint<V>; 4],
    len: usize,
}

impl<V: Vector> Kept<V> {
    #[inline(always)]
    fn points(&self) -> &[RayPoint<V>] {
        &self.points[..self.len]
    }

    #[inline(always)]
    fn push(&mut self, p: RayPoint<V>) {
        self.points[self.len] = p;
        self.len += 1;
    }

    #[inline(always)]
    fn keep(&mut self, [i, j, k]: [usize; 3], len: usize) {
        let p = &self.points;
        self.points = [p[i], p[j], p[k], p[0]];
        self.len = len;
    }

    /// The line passes all of them: a point is added on its side of the nearest edge or corner.
    #[inline(always)]
    fn approach(
        &mut self,
        bracket: &mut Bracket<'_, V>,
        frame: &RayFrame<V>,
        best: &mut BestPlane<V>,
        alpha: &mut Alpha<V::Scalar>,
        tilt: V::Scalar,
    ) -> Result<(), Stop<V>> {
        let NearestFeature { distance, toward, corners: [i, j], len } = nearest(self.points());
        if !(distance > bracket.noise) {
            return Err(Stop::InDoubt);
        }
        self.keep([i, j, j], len);
        let across = frame.vector(toward);
        let radius = bracket.radius;
        let beyond = |p: &RayPoint<V>| dot(toward, p.across()) + radius > Scalar::ZERO;
        if bracket.is_point {
            if let Some(across) = across.unit() {
                bracket.advance(across, self.points[0].point)?;
            }
            return Err(Stop::InDoubt);
        }
        let mut base = *alpha;
        if self.len == 2 {
            // The plane through both that is tilted like the last one.
            let (e, rise) = self.points[0].edge_to(&self.points[1]);
            let along = rise / dot(e, e);
            let aside = dot(alpha.across(), toward);
            base = Alpha { a: e.0 * along + toward.0 * aside, b: e.1 * along + toward.1 * aside };
        }
        let more = tilt * base.length();
        *alpha = Alpha { a: base.a + toward.0 * more, b: base.b + toward.1 * more };
        let mut next = frame.support_of(bracket, alpha.plane())?;
        best.improve(bracket, frame, *alpha, &next, radius)?;
        if !beyond(&next) {
            next = frame.support(bracket, across)?;
            if let Some(across) = across.unit() {
                bracket.advance(across, next.point)?;
            }
            if !beyond(&next) {
                return Err(Stop::InDoubt);
            }
        }
        self.push(next);
        Ok(())
    }
}

/// The first entry of the line into the swept hull of the points through a corner, an edge or a triangle that has the
/// last one for a corner.
fn enter<V: Vector>(points: &[RayPoint<V>], radius: V::Scalar, noise: V::Scalar) -> Option<RoundedEntry<V::Scalar>> {
    let newest = points.len() - 1;
    let mut best = about_corner(&points[newest], newest, radius);
    let mut offer = |entry: Option<RoundedEntry<V::Scalar>>| {
        if let Some(entry) = entry
            && best.is_none_or(|best| entry.tau < best.tau)
        {
            best = Some(entry);
        }
    };
    for i in 0..newest {
        offer(about_edge(points, [newest, i], radius, noise));
        for j in 0..i {
            offer(above_triangle(points, [newest, i, j], radius, noise));
        }
    }
    best
}

/// The entry into the sphere about a corner: `τ = t − √(ρ² − u² − v²)`, with `α = −(u, v)/√…`.
fn about_corner<V: Vector>(p: &RayPoint<V>, index: usize, radius: V::Scalar) -> Option<RoundedEntry<V::Scalar>> {
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    let rest = radius * radius - (p.u * p.u + p.v * p.v);
    if !(rest > zero) {
        return None;
    }
    let half = rest.sqrt();
    let alpha = Alpha { a: -p.u / half, b: -p.v / half };
    Some(RoundedEntry { tau: p.t - half, alpha, corners: [index; 3], weights: [one, zero, zero], len: 1 })
}

/// The entry into the cylinder about an edge, if the core's point below is on the edge.
///
/// In the projection along the ray, the edge from `p` is the vector `w` and rises by `dt`; zero is at distance `c`
/// from its line, beside the point `p + b·w`, and `k = −p − b·w` leads there from the line. With `σ² = ρ² − c²`, the
/// plane that contains the edge's direction and is crossed last has
///
/// ```text
/// α = dt/|w|²·w + k·√(w² + dt²)/(|w|·σ),   τ = t_p + b·dt − σ·√(w² + dt²)/|w|,
/// ```
///
/// and touches the cylinder above the edge's point at `b − dt·σ/(|w|·√(w² + dt²))`.
fn about_edge<V: Vector>(
    points: &[RayPoint<V>],
    [i, j]: [usize; 2],
    radius: V::Scalar,
    noise: V::Scalar,
) -> Option<RoundedEntry<V::Scalar>> {
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    let (p, q) = (&points[i], &points[j]);
    let (du, dv, dt) = (q.u - p.u, q.v - p.v, q.t - p.t);
    let squared = du * du + dv * dv;
    // An edge along the ray adds nothing to its corners.
    if !(squared > noise * noise) {
        return None;
    }
    let inverse = squared.recip();
    let b = -(p.u * du + p.v * dv) * inverse;
    let (ku, kv) = (-p.u - du * b, -p.v - dv * b);
    let rest = radius * radius - (ku * ku + kv * kv);
    if !(rest > zero) {
        return None;
    }
    let rise = squared + dt * dt;
    let root = (rest * inverse / rise).sqrt();
    let weight = b - dt * root;
    if !(weight >= -noise && weight <= one + noise) {
        return None;
    }
    let weight = weight.max(zero).min(one);
    let (along, aside) = (dt * inverse, rise * root / rest);
    let alpha = Alpha { a: du * along + ku * aside, b: dv * along + kv * aside };
    let tau = p.t + b * dt - rise * root;
    Some(RoundedEntry { tau, alpha, corners: [i, j, j], weights: [one - weight, weight, zero], len: 2 })
}

/// The crossing of the plane at distance `ρ` from a triangle, `τ = Σ wᵢ·tᵢ − ρ·√(1 + α²)` with the weights `w` of
/// zero, if the core's point below, projected at `−ρ·α/√(1 + α²)`, is in the triangle.
fn above_triangle<V: Vector>(
    points: &[RayPoint<V>],
    corners: [usize; 3],
    radius: V::Scalar,
    noise: V::Scalar,
) -> Option<RoundedEntry<V::Scalar>> {
    let [p, q, s] = corners.map(|i| &points[i]);
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    let plane = RayPlane::through([p, q, s]);
    let (alpha, inverse) = (plane.alpha(), plane.c.recip());
    let length = alpha.length();
    let below = -radius / length;
    let at = (below * alpha.a - p.u, below * alpha.b - p.v);
    let (wq, ws) = (cross(at, p.edge_to(s).0) * inverse, cross(p.edge_to(q).0, at) * inverse);
    let wp = one - wq - ws;
    // NaN fails this too.
    if !(wp >= -noise && wq >= -noise && ws >= -noise) {
        return None;
    }
    let tau = alpha.tau(p) - radius * length;
    Some(RoundedEntry { tau, alpha, corners, weights: [wp.max(zero), wq.max(zero), ws.max(zero)], len: 3 })
}

/// The corner or edge nearest to the line.
struct NearestFeature<S> {
    distance: S,
    /// The unit vector from there to the line.
    toward: Across<S>,
    corners: [usize; 2],
    len: usize,
}

/// The nearest of the last point and the edges that it is a corner of.
fn nearest<V: Vector>(points: &[RayPoint<V>]) -> NearestFeature<V::Scalar> {
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    let newest = points.len() - 1;
    let p = &points[newest];
    let mut best = (p.u * p.u + p.v * p.v, p.u, p.v, [newest; 2], 1);
    for (i, q) in points[..newest].iter().enumerate() {
        let (du, dv) = (q.u - p.u, q.v - p.v);
        let b = -(p.u * du + p.v * dv) / (du * du + dv * dv);
        if b > zero {
            let b = b.min(one);
            let (u, v) = (p.u + du * b, p.v + dv * b);
            let squared = u * u + v * v;
            if squared < best.0 {
                best = if b < one { (squared, u, v, [i, newest], 2) } else { (squared, u, v, [i; 2], 1) };
            }
        }
    }
    let (squared, u, v, corners, len) = best;
    let distance = squared.sqrt();
    NearestFeature { distance, toward: (-u / distance, -v / distance), corners, len }
}
