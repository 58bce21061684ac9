//! A body in the frame of a ray: support points, and planes that the ray crosses.
//!
//! With `e₁`, `e₂` and the unit direction `d` of the ray for axes and the line's foot for origin, a point has
//! coordinates `(u, v, t)`, and the line is `u = v = 0`. A plane that the ray approaches has a normal `n = α₁·e₁ +
//! α₂·e₂ − d`, and the core is behind it where `t ≥ α·(u, v) + τ`. So the hit is the lower hull of the core's points,
//! taken at zero:
//!
//! ```text
//! μ* = max over α of τ(α),   τ(α) = min over the core of t − α·(u, v).
//! ```

use convex_support::{Scalar, Vector};

use super::Stop;
use super::bracket::Bracket;
use super::line::Line;
use crate::body::{CastBody, PointPair};
use crate::curvature;
use crate::symmetric::{Across, Symmetric, axes_across, cross, dot, way};

/// A support point in the frame of the ray.
#[derive(Clone, Copy, Default)]
pub(super) struct RayPoint<V: Vector> {
    pub(super) u: V::Scalar,
    pub(super) v: V::Scalar,
    pub(super) t: V::Scalar,
    /// The point of the core, and the support points of both shapes.
    pub(super) point: V,
    pub(super) witness: PointPair<V>,
    /// The plane it was found on, if the ray crosses it and the body is curved.
    pub(super) alpha: Option<Alpha<V::Scalar>>,
}

impl<V: Vector> RayPoint<V> {
    pub(super) fn across(&self) -> Across<V::Scalar> {
        (self.u, self.v)
    }

    /// Twice the area of the triangle from zero to `self` and `other`, positive if that turns left.
    pub(super) fn cross(&self, other: &Self) -> V::Scalar {
        cross(self.across(), other.across())
    }

    /// The vector from `self` to `to`, `(u, v)` and `t`.
    pub(super) fn edge_to(&self, to: &Self) -> (Across<V::Scalar>, V::Scalar) {
        (way(self.across(), to.across()), to.t - self.t)
    }
}

/// Zero's weights in a triangle, up to their sum: twice the areas of the triangles that zero and each two corners span.
pub(super) fn weights_of_zero<S: Scalar>([p, q, s]: [Across<S>; 3]) -> [S; 3] {
    [cross(q, s), cross(s, p), cross(p, q)]
}

/// A plane that the ray approaches, by the `α` of its normal `α₁·e₁ + α₂·e₂ − d`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Alpha<S> {
    pub(super) a: S,
    pub(super) b: S,
}

impl<S: Scalar> Alpha<S> {
    pub(super) const ZERO: Self = Self { a: S::ZERO, b: S::ZERO };

    /// The `τ` of the plane through a point.
    pub(super) fn tau<V: Vector<Scalar = S>>(self, p: &RayPoint<V>) -> S {
        p.t - self.a * p.u - self.b * p.v
    }

    pub(super) fn across(self) -> Across<S> {
        (self.a, self.b)
    }

    /// The length of the normal: the reciprocal of the cosine at which the ray crosses the plane.
    pub(super) fn length(self) -> S {
        self.length_squared().sqrt()
    }

    pub(super) fn length_squared(self) -> S {
        S::ONE + self.a * self.a + self.b * self.b
    }

    /// Whether planes that are crossed `gap` apart along the ray are at most `distance` apart, `gap ≤ distance·|n|`.
    pub(super) fn is_within(self, gap: S, distance: S) -> bool {
        gap * gap.abs() <= distance * distance * self.length_squared()
    }

    /// The plane tilted towards a vector across the ray.
    pub(super) fn tilted(self, toward: Across<S>, tilt: S) -> Self {
        let k = tilt * (self.length_squared() / dot(toward, toward)).sqrt();
        Self { a: self.a + toward.0 * k, b: self.b + toward.1 * k }
    }

    pub(super) fn plane(self) -> RayPlane<S> {
        RayPlane { a: self.a, b: self.b, c: S::ONE }
    }
}

/// The plane by a multiple of its normal, `a·e₁ + b·e₂ − c·d`, so that a support point need not wait for the division
/// by `c`.
#[derive(Clone, Copy)]
pub(super) struct RayPlane<S> {
    pub(super) a: S,
    pub(super) b: S,
    pub(super) c: S,
}

impl<S: Scalar> RayPlane<S> {
    /// The plane through three points: that rises by `g` along `e` and by `h` along `f`, the edges from the first one,
    /// so that `e·α = g` and `f·α = h`; `c = e×f` is twice the area of the triangle.
    #[inline(always)]
    pub(super) fn through<V: Vector<Scalar = S>>([p, q, s]: [&RayPoint<V>; 3]) -> Self {
        let ((e, g), (f, h)) = (p.edge_to(q), p.edge_to(s));
        Self { a: g * f.1 - h * e.1, b: e.0 * h - f.0 * g, c: cross(e, f) }
    }

    pub(super) fn alpha(self) -> Alpha<S> {
        let inverse = self.c.recip();
        Alpha { a: self.a * inverse, b: self.b * inverse }
    }
}

/// The axes of the ray, and the radius that is added to support points.
#[derive(Clone, Copy)]
pub(super) struct RayFrame<V: Vector> {
    pub(super) axes: [V; 2],
    /// The line; or if that only touches the body, one that is nearer to it by less than rounding.
    pub(super) line: Line<V>,
    /// The part of the body's radius that support points are moved by: zero if the search sweeps the core by itself.
    pub(super) radius: V::Scalar,
}

impl<V: Vector> RayFrame<V> {
    /// That of the core alone.
    #[inline(always)]
    pub(super) fn new(line: Line<V>) -> Self {
        Self { axes: axes_across(line.direction), line, radius: Scalar::ZERO }
    }

    /// The part of a vector across the ray, and the one against it.
    #[inline(always)]
    pub(super) fn split(&self, v: V) -> (Across<V::Scalar>, V::Scalar) {
        ((v.dot(self.axes[0]), v.dot(self.axes[1])), -v.dot(self.line.direction))
    }

    #[inline(always)]
    pub(super) fn vector(&self, across: Across<V::Scalar>) -> V {
        self.axes[0] * across.0 + self.axes[1] * across.1
    }

    #[inline(always)]
    pub(super) fn normal(&self, plane: RayPlane<V::Scalar>) -> V {
        self.axes[0] * plane.a + self.axes[1] * plane.b - self.line.direction * plane.c
    }

    #[inline(always)]
    pub(super) fn support(&self, bracket: &mut Bracket<'_, V>, n: V) -> Result<RayPoint<V>, Stop<V>> {
        let (point, witness) = bracket.support(n, n, &[])?;
        let swept = if self.radius > Scalar::ZERO { point + n * (self.radius / n.norm()) } else { point };
        Ok(self.see(swept, point, witness))
    }

    /// A point of the body, given the core's point and the support points of both shapes.
    #[inline(always)]
    pub(super) fn see(&self, swept: V, point: V, witness: PointPair<V>) -> RayPoint<V> {
        let aside = swept - self.line.foot;
        let (u, v, t) = (aside.dot(self.axes[0]), aside.dot(self.axes[1]), swept.dot(self.line.direction));
        RayPoint { u, v, t, point, witness, alpha: None }
    }

    /// The changes of both shapes' support points as the normal of a plane that the ray crosses, of length 1 against
    /// the ray, changes across it.
    ///
    /// The points move along the plane, `n·H·δ = 0`, so that the part across the ray determines the change.
    pub(super) fn turned(
        &self,
        body: &dyn CastBody<Vector = V>,
        n: V,
        change: V,
        witness: PointPair<V>,
    ) -> PointPair<V> {
        let (across, change) = (self.split(n).0, self.split(change).0);
        let moved = |hessian: Symmetric<V::Scalar>| {
            let shift = hessian.times(change);
            self.vector(shift) + self.line.direction * dot(across, shift)
        };
        let (both, a) = (moved(body.hessian(n, self.axes)), moved(body.hessian_of_first(n, self.axes)));
        PointPair { a: witness.a + a, b: witness.b - (both - a) }
    }

    #[inline(always)]
    pub(super) fn support_of(
        &self,
        bracket: &mut Bracket<'_, V>,
        plane: RayPlane<V::Scalar>,
    ) -> Result<RayPoint<V>, Stop<V>> {
        let mut seen = self.support(bracket, self.normal(plane))?;
        // Polytopes do not need the direction along which a point was found.
        seen.alpha = bracket.is_curved.then(|| plane.alpha());
        Ok(seen)
    }

    /// Whether the core's support point moves as a plane turns.
    #[inline(always)]
    pub(super) fn is_curved(&self, bracket: &Bracket<'_, V>, n: V) -> bool {
        bracket.is_curved && !bracket.body.hessian(n, self.axes).is_zero()
    }

    /// The derivative of `(u, v)` at `n`: that of the core's support point, and of the radius that it is moved by.
    #[inline(always)]
    pub(super) fn hessian(&self, body: &dyn CastBody<Vector = V>, n: V) -> Symmetric<V::Scalar> {
        let core = body.hessian(n, self.axes);
        if self.radius > Scalar::ZERO {
            curvature::swept(core, self.radius, self.split(n).0, n.length_squared())
        } else {
            core
        }
    }

    /// The part across the ray, and the one against it, of the derivative of the support point at `n` as that turns
    /// against the ray.
    #[inline(always)]
    pub(super) fn hessian_against(&self, body: &dyn CastBody<Vector = V>, n: V) -> (Across<V::Scalar>, V::Scalar) {
        let [first, second] = self.axes.map(|axis| body.hessian(n, [axis, -self.line.direction]));
        let (mut across, mut along) = ((first.b, second.b), first.d);
        if self.radius > Scalar::ZERO {
            let (per_length, squared) = (self.radius / n.norm(), n.length_squared());
            let (n_across, n_along) = self.split(n);
            across.0 -= per_length * (n_across.0 * n_along / squared);
            across.1 -= per_length * (n_across.1 * n_along / squared);
            along += per_length * (V::Scalar::ONE - n_along * n_along / squared);
        }
        (across, along)
    }
}
