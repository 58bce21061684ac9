//! A lower bound on the depth of two bodies, without their whole boundary: a ball about zero, or another set, within a
//! few points of their difference.

use core::array;

use convex_support::numerics::angular::cross;
use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::faces::turned_right;
use crate::simplex::MAX_POINTS;

/// The radius of a ball about zero that is certainly within the simplex with these corners, one more than there are
/// dimensions, given their error along a unit vector; not positive if zero may be outside.
pub(crate) fn room_within<V: Vector>(corners: &[V], error: impl Fn(V) -> V::Scalar) -> V::Scalar {
    let faces: &[[usize; 3]] =
        if V::DIM == 2 { &[[0, 1, 2], [1, 2, 0], [2, 0, 1]] } else { &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] };
    let faces = faces.iter().map(|face| array::from_fn(|i| corners[face[i % 3]]));
    room_around_zero(faces, error, |_| Scalar::ONE)
}

/// How many times a set about zero fits into a polytope with these faces, given the polytope's error along a unit
/// vector; not positive if zero may be outside. The set is given by its support value along a unit vector: one for
/// the radius of a ball.
///
/// If zero is behind all faces, or before all of them, the cones from zero to the faces fill the space, and each is
/// in the polytope up to the plane of its face. If all corners are wrong by less than that distance, zero is still
/// inside, and so are all points behind all planes.
pub(super) fn room_around_zero<V: Vector>(
    faces: impl Iterator<Item = [V; MAX_POINTS]>,
    error: impl Fn(V) -> V::Scalar,
    reach: impl Fn(V) -> V::Scalar,
) -> V::Scalar {
    let (mut sides, mut is_solid) = ([V::Scalar::infinity(); 2], false);
    for corners in faces {
        let (normal, wrong) = across_corners(&corners);
        // If corners coincide, the faces beside them are degenerate.
        if normal == V::ZERO {
            continue;
        }
        is_solid = true;
        let length = normal.length();
        for (room, normal) in sides.iter_mut().zip([normal, -normal]) {
            let height = (normal.dot(corners[0]) - wrong * corners[0].length()) / length;
            let u = normal / length;
            let times = (height - error(u)) / reach(u);
            if times.is_nan() {
                return V::Scalar::ZERO;
            }
            *room = room.min(times);
        }
    }
    let room = sides[0].max(sides[1]);
    if is_solid { room } else { V::Scalar::ZERO }
}

/// A vector across the first points, as many as there are dimensions; and the error of its product with another
/// vector, relative to the other's length.
///
/// In space, with `u = ε/2`, both edges are wrong by `u`, and a coordinate of their product is a difference of
/// products: `4u·√3` of the product of the lengths. The scalar product loses `3u`.
pub(crate) fn across_corners<V: Vector>(points: &[V; MAX_POINTS]) -> (V, V::Scalar) {
    let edge = points[1] - points[0];
    if V::DIM == 2 {
        return (turned_right(edge), V::Scalar::EPSILON * V::Scalar::from_f64(2.0) * edge.length());
    }
    let other = points[2] - points[0];
    let lengths = edge.length() * other.length();
    (cross(edge, other), V::Scalar::EPSILON * V::Scalar::from_f64(5.5) * lengths)
}
