//! The search of `portal.rs` for a core swept by a ball of radius `ρ`.
//!
//! The support value of a ball is `ρ·|n|`, so in the coordinates of the ray
//!
//! ```text
//! μ* = max over α of τ(α),   τ(α) = min over the core of t − α·(u, v), less ρ·√(1 + α²),
//! ```
//!
//! which is still concave. Where the minimum is taken over one, two or three points alone, its maximum is known in closed
//! form: it is where the ray enters the sphere about the point, the cylinder about the edge, or the plane at distance `ρ`
//! from the triangle. So the search keeps the corner, edge or triangle that the ray enters above, takes the support point
//! there, and goes on to the earliest of the corners, edges and triangles with that point.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::Iterate;
use crate::body::Body;
use crate::cast::{ScalarOf, Search};
use crate::portal::{Exit, PATIENCE, SeenBy};
use crate::view::{Best, Frame, Seen, Slant};

/// Where the ray enters the swept hull of some points.
#[derive(Clone, Copy)]
struct Entry<S> {
    tau: S,
    slant: Slant<S>,
    /// The points, and the weights of the core's point below.
    corners: [usize; 3],
    weights: [S; 3],
    len: usize,
}

/// Support points of the search.
const MAX_STEPS: usize = 32;

impl<B: Body, O: FnMut(Iterate<'_, B::Vector>)> Search<'_, B, O> {
    /// Closes the bracket, or finds a plane that the whole ray is before; beginning across `first`, and with planes tilted
    /// by `reach` until the line enters the swept points.
    ///
    /// Within its caller it would be slower, for want of registers.
    #[inline(never)]
    pub(crate) fn swept(
        &mut self,
        frame: &Frame<B::Vector>,
        first: B::Vector,
        reach: ScalarOf<B>,
    ) -> Result<(), Exit<B>> {
        let number = ScalarOf::<B>::from_f64;
        let zero = ScalarOf::<B>::ZERO;
        let (radius, noise) = (self.radius, self.noise);
        let direction = self.local.line.direction;
        let p = self.look(frame, first)?;
        let mut slant = Slant { a: zero, b: zero };
        let mut best = Best { tau: -ScalarOf::<B>::infinity(), slant, point: p.point };
        let end = self.end();
        if !self.is_point {
            let facing = -first.dot(direction);
            let is_faced = facing > first.length() * number(0.125);
            if is_faced {
                let per_facing = facing.recip();
                slant = Slant { a: frame.e1.dot(first) * per_facing, b: frame.e2.dot(first) * per_facing };
                best = Best { tau: slant.crossing(&p) - radius * slant.length(), slant, point: p.point };
            }
            if !is_faced || best.tau > end {
                self.separate_end(first, p.point)?;
            }
        }

        let wanted = noise.max(self.options.tolerance);
        let (mut last, mut patience) = (ScalarOf::<B>::infinity(), PATIENCE);
        // The points that are kept, the newest last.
        let mut kept = [p; 4];
        let mut len = 1;
        for _ in 0..MAX_STEPS {
            let Some(at) = enter(&kept[..len], radius, noise) else {
                // The line passes all of them: a point is wanted on its side of the nearest edge or corner.
                let near = nearest(&kept[..len]);
                let distance = near.distance;
                if !(distance > noise) {
                    return Err(None);
                }
                let toward = near.toward;
                kept = [kept[near.corners[0]], kept[near.corners[1]], p, p];
                len = near.len;
                let across = frame.e1 * toward.0 + frame.e2 * toward.1;
                if self.is_point {
                    self.separate(across, &kept[0])?;
                    return Err(None);
                }
                let mut base = slant;
                if len == 2 {
                    // The plane through both that is tilted like the last one.
                    let [p, q] = [kept[0], kept[1]];
                    let (du, dv, dt) = (q.u - p.u, q.v - p.v, q.t - p.t);
                    let along = dt / (du * du + dv * dv);
                    let tilt = slant.a * toward.0 + slant.b * toward.1;
                    base = Slant { a: du * along + toward.0 * tilt, b: dv * along + toward.1 * tilt };
                }
                let tilt = reach * base.length();
                slant = Slant { a: base.a + toward.0 * tilt, b: base.b + toward.1 * tilt };
                let mut next = self.look_slanted(frame, slant)?;
                let tau = slant.crossing(&next) - radius * slant.length();
                if tau > end {
                    self.separate_end(frame.normal(direction, slant), next.point)?;
                }
                if tau > best.tau {
                    best = Best { tau, slant, point: next.point };
                }
                let reached = |p: &SeenBy<B>| toward.0 * p.u + toward.1 * p.v + radius > zero;
                if !reached(&next) {
                    next = self.look(frame, across)?;
                    self.separate(across, &next)?;
                    if !reached(&next) {
                        return Err(None);
                    }
                }
                kept[len] = next;
                len += 1;
                continue;
            };
            let high = at.tau;
            if !(high < last) {
                patience -= 1;
                if patience == 0 {
                    return Err(None);
                }
            }
            last = high;
            if high < self.low {
                return Err(None);
            }
            kept = [kept[at.corners[0]], kept[at.corners[1]], kept[at.corners[2]], p];
            len = at.len;
            slant = at.slant;
            let length = slant.length();
            if self.is_point {
                best = Best { tau: high, slant, point: p.point };
            }
            if best.slant.is_within(high - best.tau, wanted) {
                return self.close(frame, &kept[..len], &at.weights, high, &best);
            }
            let n = frame.normal(direction, slant);
            if self.is_curved(frame, n) {
                return Err(None);
            }
            let next = self.look_slanted(frame, slant)?;
            let tau = slant.crossing(&next) - radius * length;
            if tau > best.tau {
                best = Best { tau, slant, point: next.point };
                if tau > end {
                    self.separate_end(n, next.point)?;
                }
                if high - best.tau <= wanted * length {
                    return self.close(frame, &kept[..len], &at.weights, high, &best);
                }
            }
            kept[len] = next;
            len += 1;
        }
        Err(None)
    }
}

/// The first entry of the line into the swept hull of the points through a corner, an edge or a triangle that has the last
/// one for a corner.
fn enter<V: Vector, W: Copy>(points: &[Seen<V, W>], radius: V::Scalar, noise: V::Scalar) -> Option<Entry<V::Scalar>> {
    let newest = points.len() - 1;
    let mut best = about_corner(&points[newest], newest, radius);
    let mut offer = |entry: Option<Entry<V::Scalar>>| {
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
fn about_corner<V: Vector, W>(p: &Seen<V, W>, index: usize, radius: V::Scalar) -> Option<Entry<V::Scalar>> {
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    let rest = radius * radius - (p.u * p.u + p.v * p.v);
    if !(rest > zero) {
        return None;
    }
    let half = rest.sqrt();
    let slant = Slant { a: -p.u / half, b: -p.v / half };
    Some(Entry { tau: p.t - half, slant, corners: [index; 3], weights: [one, zero, zero], len: 1 })
}

/// The entry into the cylinder about an edge, if the core's point below is on the edge.
///
/// Seen along the ray, the edge from `p` is the vector `w` and rises by `dt`; zero is at distance `c` from its line,
/// beside the point `p + b·w`, and `k = −p − b·w` leads there from the line. With `σ² = ρ² − c²`, the plane that contains
/// the edge's direction and is crossed last has
///
/// ```text
/// α = dt/|w|²·w + k·√(w² + dt²)/(|w|·σ),   τ = t_p + b·dt − σ·√(w² + dt²)/|w|,
/// ```
///
/// and touches the cylinder above the edge's point at `b − dt·σ/(|w|·√(w² + dt²))`.
fn about_edge<V: Vector, W>(
    points: &[Seen<V, W>],
    [i, j]: [usize; 2],
    radius: V::Scalar,
    noise: V::Scalar,
) -> Option<Entry<V::Scalar>> {
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    let (p, q) = (&points[i], &points[j]);
    let (du, dv, dt) = (q.u - p.u, q.v - p.v, q.t - p.t);
    let squared = du * du + dv * dv;
    // An edge along the ray has nothing that its corners do not have.
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
    let slant = Slant { a: du * along + ku * aside, b: dv * along + kv * aside };
    let tau = p.t + b * dt - rise * root;
    Some(Entry { tau, slant, corners: [i, j, j], weights: [one - weight, weight, zero], len: 2 })
}

/// The crossing of the plane at distance `ρ` from a triangle, `τ = Σ wᵢ·tᵢ − ρ·√(1 + α²)` with the weights `w` of zero, if the
/// core's point below, seen at `−ρ·α/√(1 + α²)`, is in the triangle.
fn above_triangle<V: Vector, W>(
    points: &[Seen<V, W>],
    corners: [usize; 3],
    radius: V::Scalar,
    noise: V::Scalar,
) -> Option<Entry<V::Scalar>> {
    let [p, q, s] = corners.map(|i| &points[i]);
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    let (pu, pv, pt) = (q.u - p.u, q.v - p.v, q.t - p.t);
    let (qu, qv, qt) = (s.u - p.u, s.v - p.v, s.t - p.t);
    let inverse = (pu * qv - pv * qu).recip();
    let slant = Slant { a: (pt * qv - qt * pv) * inverse, b: (pu * qt - qu * pt) * inverse };
    let length = slant.length();
    let below = -radius / length;
    let (u, v) = (below * slant.a - p.u, below * slant.b - p.v);
    let (wq, ws) = ((u * qv - v * qu) * inverse, (pu * v - pv * u) * inverse);
    let wp = one - wq - ws;
    // NaN fails this too.
    if !(wp >= -noise && wq >= -noise && ws >= -noise) {
        return None;
    }
    let tau = p.t - slant.a * p.u - slant.b * p.v - radius * length;
    Some(Entry { tau, slant, corners, weights: [wp, wq, ws].map(|w| w.max(zero)), len: 3 })
}

/// The corner or edge nearest to the line.
struct Nearest<S> {
    distance: S,
    /// The unit vector from there to the line.
    toward: (S, S),
    corners: [usize; 2],
    len: usize,
}

/// The nearest of the last point and the edges that it is a corner of.
fn nearest<V: Vector, W>(points: &[Seen<V, W>]) -> Nearest<V::Scalar> {
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
    Nearest { distance, toward: (-u / distance, -v / distance), corners, len }
}
