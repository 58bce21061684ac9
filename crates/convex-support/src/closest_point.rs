//! The point of a set nearest a given point, where there is a closed form or nearly one.

use num_traits::Float as _;

use crate::shapes::{Frame, across, clamp_to_segment};
use crate::vector::comfortable_unit_of_length;
use crate::{
    Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Matrix, Point, Posed, Rounded, Scalar, ScalarOf, Segment,
    SupportMap, Triangle, Vector, Vector3,
};

/// A convex set that knows which of its points is nearest to any given point.
///
/// The nearest point `P(x)` is unique, and `x` is `P(x)` exactly where `x` is in the set. It is characterised by
/// `(x − P(x))·(y − P(x)) ≤ 0` for every `y` of the set: the vector from it to `x` is an outward normal.
///
/// This is what van den Bergen's Algorithm 1 asks of a shape: its ray cast marches along the ray by supporting planes
/// at nearest points. Implemented for the shapes that have a closed form, and for the ellipsoid, where one
/// equation in one unknown is solved by Newton's method to rounding. Poses and [`Rounded`] pass it through.
///
/// ```
/// use convex_support::{ClosestPoint, Cuboid, Rounded, glam::DVec2};
///
/// let rounded = Rounded::new(Cuboid::new(DVec2::ONE)?, 0.5)?;
/// assert_eq!(rounded.closest_point(DVec2::new(4.0, 5.0)), DVec2::new(1.3, 1.4));
/// assert_eq!(rounded.closest_point(DVec2::new(0.9, 1.2)), DVec2::new(0.9, 1.2)); // inside
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
///
/// # Accuracy
/// The error is a few units in the last place of the larger of the distance of `x` from the shape's own centre and the
/// shape's size, also for aspect ratios of 1e6 and beyond. Coordinates at which squares of lengths leave the range of
/// the scalar are handled by scaling. A `NaN` in `x` gives some vector, possibly of `NaN`s.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no closed form of its nearest point",
    note = "implement `ClosestPoint` for it, or use the GJK distance, which needs only `SupportMap`"
)]
pub trait ClosestPoint: SupportMap {
    /// The point of the set nearest `x`; `x` itself where it is in the set.
    fn closest_point(&self, x: Self::Vector) -> Self::Vector;
}

impl<V: Vector> ClosestPoint for Point<V> {
    #[inline]
    fn closest_point(&self, _x: V) -> V {
        self.at()
    }
}

impl<V: Vector> ClosestPoint for Segment<V> {
    #[inline]
    fn closest_point(&self, x: V) -> V {
        clamp_to_segment(self.points(), x)
    }
}

impl<V: Vector> ClosestPoint for Triangle<V> {
    /// Outside, the answer is the foot on an edge that has the point on its outer side, or else a corner. Comparing the
    /// distances of all three edges instead would lose half the digits, since a distance is flat at its minimum.
    fn closest_point(&self, x: V) -> V {
        let Some(Frame { corners: [a, b, c], axes: [u, v], length, along, height }) = self.frame() else {
            let [a, b, _] = self.longest_edge_first();
            return clamp_to_segment([a, b], x);
        };
        let (p, q) = (u.dot(x - a), v.dot(x - a));
        let beyond_ab = q < V::Scalar::ZERO;
        let beyond_bc = (length - p) * height < q * (length - along);
        let beyond_ca = p * height < q * along;
        let mut corner: Option<V> = None;
        for (beyond, edge) in [(beyond_ab, [a, b]), (beyond_bc, [b, c]), (beyond_ca, [c, a])] {
            if beyond {
                let foot = clamp_to_segment(edge, x);
                if foot != edge[0] && foot != edge[1] {
                    return foot;
                }
                corner = Some(corner.map_or(foot, |other| nearer(x, other, foot)));
            }
        }
        corner.unwrap_or(if V::DIM == 2 { x } else { a + u * p + v * q })
    }
}

/// Whichever of two points is nearer to `x`.
#[inline]
fn nearer<V: Vector>(x: V, p: V, q: V) -> V {
    if (x - q).norm() < (x - p).norm() { q } else { p }
}

impl<V: Vector> ClosestPoint for Ball<V> {
    #[inline]
    fn closest_point(&self, x: V) -> V {
        swept_point(x, V::ZERO, self.radius())
    }
}

/// The point of the ball of `radius` about `center` nearest `x`.
///
/// Where `center` is the point of a set nearest `x`, this is the nearest point of the set swept by the ball.
#[inline]
fn swept_point<V: Vector>(x: V, center: V, radius: V::Scalar) -> V {
    let out = x - center;
    if out.norm() <= radius {
        return x;
    }
    out.unit().map_or(x, |n| center + n * radius)
}

impl<V: Vector> ClosestPoint for Cuboid<V> {
    #[inline]
    fn closest_point(&self, x: V) -> V {
        x.max(-self.half_extents()).min(self.half_extents())
    }
}

impl<V: Vector> ClosestPoint for Capsule<V> {
    #[inline]
    fn closest_point(&self, x: V) -> V {
        let h = self.half_height();
        swept_point(x, V::axis(1) * x.get(1).max(-h).min(h), self.radius())
    }
}

impl<V: Vector3> ClosestPoint for Cylinder<V> {
    #[inline]
    fn closest_point(&self, x: V) -> V {
        let h = self.half_height();
        let y = x.get(1);
        swept_point(across(x), V::ZERO, self.disc_radius()) + V::axis(1) * y.max(-h).min(h)
    }
}

impl<V: Vector3> ClosestPoint for Cone<V> {
    /// In the half plane through the axis and `x`, with `ρ` the distance from the axis, the cone is the triangle
    /// `(0, h), (r, −h), (0, −h)`, and its slanted edge is `2h·ρ + r·(y − h) = 0`.
    fn closest_point(&self, x: V) -> V {
        let (h, r) = (self.half_height(), self.disc_radius());
        let (out, y) = (across(x), x.get(1));
        let rho = out.norm();
        let slant = (h + h) * rho + r * (y - h);
        if rho <= r && y.abs() <= h && slant <= V::Scalar::ZERO {
            return x;
        }
        let radial = out.unit().unwrap_or(V::ZERO);
        if y <= -h {
            return radial * rho.min(r) - V::axis(1) * h;
        }
        let (apex, rim) = (V::axis(1) * h, radial * r - V::axis(1) * h);
        clamp_to_segment([apex, rim], x)
    }
}

impl<V: Vector> ClosestPoint for Ellipsoid<V> {
    fn closest_point(&self, x: V) -> V {
        match closest_point_of_centred(self, x - self.center()) {
            Some(z) => self.center() + z,
            None => x,
        }
    }
}

/// The point of an ellipsoid nearest `x`, both relative to its centre; `None` where `x` is inside.
pub(crate) fn closest_point_of_centred<V: Vector>(ellipsoid: &Ellipsoid<V>, x: V) -> Option<V> {
    let axes = ellipsoid.axes();
    closest_point_of_axis_aligned(ellipsoid.semi_axes(), axes.transpose_mul(x)).map(|z| axes * z)
}

/// Newton's iteration below climbs through the scales of the semi-axes one after another and then doubles its digits:
/// about twelve steps at an aspect of 1e6, and never more than a few dozen.
const MAX_SECULAR_STEPS: usize = 100;

/// The point of `{ z : Σ(zᵢ/aᵢ)² ≤ 1 }` nearest `y`; `None` where `y` is inside.
///
/// Outside, `y − z` is a normal at `z`, so there is a `t > 0` with `yᵢ − zᵢ = t·zᵢ/aᵢ²`, that is
/// `zᵢ/aᵢ = wᵢ(t) = aᵢyᵢ/(t + aᵢ²)` where `|w(t)| = 1`: the secular equation. As a function of `t`, `1/|w| − 1` is
/// increasing, concave and, far out, a straight line, so that Newton's iterates from below the root increase towards it
/// and never pass it (Reinsch; Moré and Sorensen, *Computing a trust region step*, 1983). Two lower bounds on the root to
/// start from: `|wᵢ(t)| ≤ 1` for each `i`, and `|w(t)| ≥ |a∘y|/(t + a²ₘₐₓ)`.
fn closest_point_of_axis_aligned<V: Vector>(a: V, y: V) -> Option<V> {
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    if V::from_fn(|i| y.get(i) / a.get(i)).norm() <= one {
        return None;
    }
    let unit = comfortable_unit_of_length(a.max(y.abs()).max_element());
    let (a, y) = (a / unit, y / unit);
    let squares = a * a;
    let products = a * y;
    let mut t = (products.abs() - squares).max_element().max(products.norm() - squares.max_element()).max(zero);
    let w = |t: V::Scalar| V::from_fn(|i| ratio(products.get(i), t + squares.get(i)));
    for _ in 0..MAX_SECULAR_STEPS {
        // φ(t) = 1/|w| − 1 and φ′ = Σ wᵢ²/(t + aᵢ²)/|w|³, so −φ/φ′ = |w|²(|w| − 1)/Σ wᵢ²/(t + aᵢ²).
        let w = w(t);
        let norm = w.norm();
        let slope = w.dot(V::from_fn(|i| ratio(w.get(i), t + squares.get(i))));
        let next = t + norm * norm / slope * (norm - one);
        // Also ends where the step is lost to rounding, and for a NaN.
        if !(next > t && next.is_finite()) {
            break;
        }
        t = next;
    }
    // The last factor puts the point on the surface, which t alone does only to its own rounding.
    let w = w(t);
    let z = a * (w / w.norm().max(one)) * unit;
    Some(z)
}

/// `p/q`, and 0 where `p` is.
#[inline]
fn ratio<S: Scalar>(p: S, q: S) -> S {
    if p == S::ZERO { S::ZERO } else { p / q }
}

impl<S: ClosestPoint> ClosestPoint for Posed<S> {
    #[inline]
    fn closest_point(&self, x: S::Vector) -> S::Vector {
        let local = self.rotation().transpose_mul(x - self.translation());
        let closest = self.shape().closest_point(local);
        if closest == local { x } else { self.rotation() * closest + self.translation() }
    }
}

impl<S: ClosestPoint> ClosestPoint for Rounded<S> {
    #[inline]
    fn closest_point(&self, x: S::Vector) -> S::Vector {
        let rounding: ScalarOf<S> = self.rounding();
        swept_point(x, self.shape().closest_point(x), rounding)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, DVec3};
    use std::{boxed::Box, vec::Vec};

    /// Whether `p` is what `shape` should answer for `x`: every support plane contains it, and the one across `x − p`
    /// touches it there.
    fn assert_closest(i: usize, shape: &dyn ClosestPoint<Vector = DVec3>, x: DVec3, size: f64) {
        let p = shape.closest_point(x);
        let tolerance = 1e-14 * (size + (x - shape.origin()).length());
        for direction in directions() {
            assert!(
                direction.dot(p) <= shape.support_value(direction) + tolerance,
                "shape {i}: {p} sticks out along {direction}"
            );
        }
        // (x − p)·y ≤ (x − p)·p for every y of the set; an error e of p costs e·size.
        let out = x - p;
        let excess = shape.support_value(out) - out.dot(p);
        assert!(excess <= tolerance * (size + out.length()), "shape {i}: {p} for {x}, off by {excess:e}");
    }

    fn directions() -> Vec<DVec3> {
        let grid = [-1.0, -0.6, -1e-3, 0.0, 0.3, 1.0];
        let digit = |n: usize| grid[n % grid.len()];
        (0..216).map(|n| DVec3::new(digit(n), digit(n / 6), digit(n / 36))).collect()
    }

    #[test]
    fn nearest_points_satisfy_their_variational_inequality() {
        let turned = DQuat::from_xyzw(0.1, 0.2, 0.3, 0.9);
        let shapes: Vec<Box<dyn ClosestPoint<Vector = DVec3>>> = std::vec![
            Box::new(Point::new(DVec3::new(1.0, 2.0, 3.0)).unwrap()),
            Box::new(Segment::new([DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.0, -2.0, 1.0)]).unwrap()),
            Box::new(Triangle::new([DVec3::X, DVec3::Y, DVec3::Z]).unwrap()),
            Box::new(Triangle::new([DVec3::X, DVec3::Y, DVec3::new(0.5, 0.5 + 1e-9, 0.0)]).unwrap()),
            Box::new(Triangle::new([DVec3::X, DVec3::Y, DVec3::new(0.5, 0.5, 0.0)]).unwrap()),
            Box::new(Ball::new(1.5).unwrap()),
            Box::new(Cuboid::new(DVec3::new(1.0, 0.5, 0.0)).unwrap()),
            Box::new(Capsule::new(1.0, 0.5).unwrap()),
            Box::new(Cylinder::new(0.5, 1.0).unwrap()),
            Box::new(Cone::new(0.75, 0.6).unwrap()),
            Box::new(Cone::new(0.0, 0.6).unwrap()),
            Box::new(Cone::new(0.75, 0.0).unwrap()),
            Box::new(Ellipsoid::new(DVec3::X, DVec3::new(1.0, 0.5, 0.1), turned).unwrap()),
            Box::new(Ellipsoid::new(DVec3::X, DVec3::new(1.0, 1e-3, 1e-6), turned).unwrap()),
            Box::new(Ellipsoid::new(DVec3::ZERO, DVec3::new(1e-7, 1.0, 1.0), DQuat::IDENTITY).unwrap()),
            Box::new(Rounded::new(Cone::new(0.75, 0.6).unwrap(), 0.2).unwrap()),
            Box::new(Posed::new(Cylinder::new(0.5, 1.0).unwrap(), turned, DVec3::NEG_ONE).unwrap()),
        ];
        for (i, shape) in shapes.iter().enumerate() {
            for x in directions() {
                for s in [1e-3, 0.7, 1.0, 3.0, 1e6] {
                    assert_closest(i, shape, x * s, 2.0);
                }
            }
        }
    }
}
