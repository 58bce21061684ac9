//! A body as it is seen along a ray: support points, planes, and triangles that the line runs through.
//!
//! With `e₁`, `e₂` and the unit direction `d` of the ray for axes and the line's foot for origin, a support point has
//! coordinates `(u, v, t)`, and the line is `u = v = 0`. A plane that the ray approaches has a normal `n = α₁·e₁ + α₂·e₂ − d`,
//! and the core is behind it where `t ≥ α·(u, v) + τ`. So the hit is the lower hull of the core's points, taken at zero:
//!
//! ```text
//! μ* = max over α of τ(α),   τ(α) = min over the core of t − α·(u, v).
//! ```

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::line::Line;

/// A support point as it is seen along the ray.
#[derive(Clone, Copy)]
pub(crate) struct Seen<V: Vector, W> {
    pub(crate) u: V::Scalar,
    pub(crate) v: V::Scalar,
    pub(crate) t: V::Scalar,
    pub(crate) point: V,
    pub(crate) witness: W,
    /// The plane it was found on; one along the ray has no slant.
    pub(crate) slant: Option<Slant<V::Scalar>>,
}

impl<V: Vector, W> Seen<V, W> {
    /// Twice the area of the triangle from zero to `self` and `other`, positive if that turns left.
    pub(crate) fn cross(&self, other: &Self) -> V::Scalar {
        self.u * other.v - self.v * other.u
    }
}

/// A plane that the ray approaches, by its normal `α₁·e₁ + α₂·e₂ − d`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slant<S> {
    pub(crate) a: S,
    pub(crate) b: S,
}

impl<S: Scalar> Slant<S> {
    /// The `τ` of the plane through a point.
    pub(crate) fn crossing<V: Vector<Scalar = S>, W>(self, p: &Seen<V, W>) -> S {
        p.t - self.a * p.u - self.b * p.v
    }

    /// The length of the normal: the reciprocal of the cosine at which the ray crosses the plane.
    pub(crate) fn length(self) -> S {
        self.length_squared().sqrt()
    }

    /// Whether planes that are crossed `gap` apart along the ray are at most `distance` apart, `gap ≤ distance·|n|`.
    pub(crate) fn is_within(self, gap: S, distance: S) -> bool {
        gap * gap.abs() <= distance * distance * self.length_squared()
    }

    pub(crate) fn length_squared(self) -> S {
        S::ONE + self.a * self.a + self.b * self.b
    }
}

/// The same plane by a multiple of its normal, `a·e₁ + b·e₂ − c·d`. A support point does not wait for the division by `c`.
#[derive(Clone, Copy)]
pub(crate) struct Multiple<S> {
    pub(crate) a: S,
    pub(crate) b: S,
    pub(crate) c: S,
}

impl<S: Scalar> Multiple<S> {
    pub(crate) fn slant(self) -> Slant<S> {
        let inverse = self.c.recip();
        Slant { a: self.a * inverse, b: self.b * inverse }
    }

    pub(crate) fn normal<V: Vector<Scalar = S>>(self, frame: &Frame<V>, direction: V) -> V {
        frame.e1 * self.a + frame.e2 * self.b - direction * self.c
    }
}

/// The axes across the ray, where they cross, and the radius that is added to what is seen.
#[derive(Clone, Copy)]
pub(crate) struct Frame<V: Vector> {
    pub(crate) e1: V,
    pub(crate) e2: V,
    /// The line's foot; or where the line only touches the body, a point nearer the body by less than rounding.
    pub(crate) foot: V,
    pub(crate) lift: V::Scalar,
}

impl<V: Vector> Frame<V> {
    /// The unit vectors are across the line's `d` and one another, after Duff et al., *Building an orthonormal basis,
    /// revisited* (2017).
    #[inline(always)]
    pub(crate) fn new(line: Line<V>) -> Self {
        let d = line.direction;
        let one = V::Scalar::ONE;
        let (x, y, z) = (d.get(0), d.get(1), d.get(2));
        let sign = one.copysign(z);
        let a = -(sign + z).recip();
        let b = x * y * a;
        let e1 = [one + sign * x * x * a, sign * b, -sign * x];
        let e2 = [b, sign + y * y * a, -y];
        Self { e1: V::from_fn(|i| e1[i]), e2: V::from_fn(|i| e2[i]), foot: line.foot, lift: V::Scalar::ZERO }
    }

    /// The normal of a plane.
    #[inline(always)]
    pub(crate) fn normal(&self, direction: V, slant: Slant<V::Scalar>) -> V {
        self.e1 * slant.a + self.e2 * slant.b - direction
    }
}

/// The plane that is crossed last, of those known, and a point of the core on it.
#[derive(Clone, Copy)]
pub(crate) struct Best<V: Vector> {
    pub(crate) tau: V::Scalar,
    pub(crate) slant: Slant<V::Scalar>,
    pub(crate) point: V,
}

/// Three points of the body, in anticlockwise order, whose triangle the line runs through; or where none is known, any, and
/// `high` infinite.
#[derive(Clone, Copy)]
pub(crate) struct Portal<V: Vector, W> {
    pub(crate) corners: [Seen<V, W>; 3],
    /// The weights of the point where the line runs through, with sum 1.
    pub(crate) weights: [V::Scalar; 3],
    /// Where the line runs through.
    pub(crate) high: V::Scalar,
}

impl<V: Vector, W: Copy> Portal<V, W> {
    /// Its plane.
    pub(crate) fn slant(&self) -> Slant<V::Scalar> {
        let [p, q, s] = &self.corners;
        let (pu, pv, pt) = (q.u - p.u, q.v - p.v, q.t - p.t);
        let (qu, qv, qt) = (s.u - p.u, s.v - p.v, s.t - p.t);
        let inverse = (pu * qv - pv * qu).recip();
        Slant { a: (pt * qv - qt * pv) * inverse, b: (pu * qt - qu * pt) * inverse }
    }

    /// Puts a point in the place of one corner, if the line still runs through, and earlier; but no earlier than `floor`,
    /// before which nothing of the body is: a triangle that is as flat as rounding may not contain zero.
    pub(crate) fn exchange(&mut self, r: &Seen<V, W>, floor: V::Scalar) {
        let zero = V::Scalar::ZERO;
        for i in 0..3 {
            let (p, q) = (&self.corners[(i + 1) % 3], &self.corners[(i + 2) % 3]);
            // With r for corner i: the areas beyond p and beyond q, and the one that r and both span.
            let areas = [p.cross(q), q.cross(r), r.cross(p)];
            let sum = areas[0] + areas[1] + areas[2];
            if areas[1] >= zero && areas[2] >= zero && sum > zero {
                let inverse = sum.recip();
                let high = (areas[0] * r.t + areas[1] * p.t + areas[2] * q.t) * inverse;
                if high < self.high && high >= floor {
                    (self.corners[i], self.high) = (*r, high);
                    self.weights[i] = areas[0] * inverse;
                    self.weights[(i + 1) % 3] = areas[1] * inverse;
                    self.weights[(i + 2) % 3] = areas[2] * inverse;
                }
                return;
            }
        }
    }
}
