//! The point of a set nearest a given point, if it has a closed form or nearly one.

mod cone;
mod ellipsoid;
mod segment;
mod triangle;

pub(crate) use cone::closest_of_cone;
pub(crate) use ellipsoid::closest_of_ellipsoid;
pub(crate) use segment::clamp_to_segment;
pub(crate) use triangle::closest_of_triangle;

use crate::{Core, SupportMap, Vector};

/// The point of a shape nearest to `x`, or `x` itself if it is in the shape; `None` if the shape has no closed form.
///
/// The nearest point `P(x)` is unique. It is characterised by `(x − P(x))·(y − P(x)) ≤ 0` for every `y` of the set:
/// the vector from it to `x` is an outward normal. Van den Bergen's Algorithm 1, a ray cast that moves along the ray
/// by the supporting planes at nearest points, needs nothing else of a shape.
///
/// Points, segments, triangles, balls, boxes, capsules, cylinders and cones have closed forms. For ellipsoids
/// Newton's method solves one equation in one unknown to rounding. It also works through poses, uniform scalings,
/// roundings and sums with a point, and behind any pointer.
///
/// ```
/// use convex_support::{Cuboid, Rounded, closest_point, glam::DVec2};
///
/// let rounded = Rounded::new(Cuboid::new(DVec2::ONE)?, 0.5)?;
/// assert_eq!(closest_point(&rounded, DVec2::new(4.0, 5.0)), Some(DVec2::new(1.3, 1.4)));
/// assert_eq!(closest_point(&rounded, DVec2::new(0.9, 1.2)), Some(DVec2::new(0.9, 1.2))); // inside
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
///
/// # Accuracy
/// The error is a few units in the last place of the larger of the distance of `x` from the shape's own centre and the
/// shape's size, also for aspect ratios of 1e6 and beyond. Coordinates at which squares of lengths leave the range of
/// the scalar are handled by scaling. A `NaN` in `x` gives some vector, possibly of `NaN`s.
#[doc(alias("project_point", "nearest_point"))]
#[must_use]
pub fn closest_point<S: SupportMap + ?Sized>(shape: &S, x: S::Vector) -> Option<S::Vector> {
    let Core { origin, radius, .. } = shape.core();
    let from_origin = x - origin;
    let closest = closest_of_ball(from_origin, shape.core_closest_point(from_origin)?, radius);
    Some(if closest == from_origin { x } else { origin + closest })
}

/// The point of the ball of `radius` about `center` nearest `x`.
///
/// If `center` is the point of a set nearest `x`, this is the nearest point of the set swept by the ball.
#[inline]
pub(crate) fn closest_of_ball<V: Vector>(x: V, center: V, radius: V::Scalar) -> V {
    let out = x - center;
    if out.norm() <= radius {
        return x;
    }
    out.unit().map_or(x, |n| center + n * radius)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Point, Posed, Rounded, Segment, Triangle, support_value,
    };
    use glam::{DQuat, DVec3};
    use std::{boxed::Box, vec::Vec};

    /// Whether `p` is the point of `shape` nearest `x`: every support plane contains it, and the one across `x − p`
    /// touches it there.
    fn assert_closest(i: usize, shape: &dyn SupportMap<Vector = DVec3>, x: DVec3, size: f64) {
        let p = closest_point(shape, x).expect("a closed form");
        let tolerance = 1e-14 * (size + (x - shape.core().origin).length());
        for direction in directions() {
            assert!(
                direction.dot(p) <= support_value(shape, direction) + tolerance,
                "shape {i}: {p} sticks out along {direction}"
            );
        }
        // (x − p)·y ≤ (x − p)·p for every y of the set; an error e of p costs e·size.
        let out = x - p;
        let excess = support_value(shape, out) - out.dot(p);
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
        let shapes: Vec<Box<dyn SupportMap<Vector = DVec3>>> = std::vec![
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
                    assert_closest(i, &**shape, x * s, 2.0);
                }
            }
        }
    }
}
