//! A lower bound on the depth of two bodies, without their whole boundary: a ball about zero within a few points of
//! their difference.

use core::array;

use convex_support::numerics::bound::{raised, roundings, roundings_of};
use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::faces::turned_right;
use super::uncertainty::Uncertainty;
use super::{begin, go_on};
use crate::body::{AnyPair, Both, Pair, PointPair, Shapes as _};
use crate::gjk::Frame;
use crate::shape::Shape;
use crate::simplex::{MAX_POINTS, cross};
use crate::symmetric::axes_across;

/// What bounds the vector from a point of the difference to zero, where zero is near the point: the vector is
/// `c − a·n`, with `a` from 0 to `along`, and with `c` no longer than `across`.
pub(crate) struct FromContact<V: Vector> {
    /// The unit vector into the difference.
    pub(crate) n: V,
    pub(crate) along: V::Scalar,
    pub(crate) across: V::Scalar,
    /// A bound on the length of the whole vector.
    pub(crate) length: V::Scalar,
}

impl<V: Vector> FromContact<V> {
    /// A bound on the component of the vector along a unit vector `u`.
    fn reach(&self, u: V) -> V::Scalar {
        let part = self.along * (-self.n.dot(u)).max(V::Scalar::ZERO) + roundings(16.0, self.along) + self.across;
        part.min(self.length)
    }
}

/// The result about two bodies, one of which has moved on from near contact; lengths in the world's unit.
pub(crate) struct After<V: Vector> {
    /// A lower bound on their distance along an axis, a unit vector from the second body to the first.
    pub(crate) lower: V::Scalar,
    pub(crate) axis: V,
    /// The factor up to which multiples of the vector from contact certainly end in the difference; not positive where
    /// zero may be outside.
    pub(crate) times: V::Scalar,
    pub(crate) iterations: usize,
}

/// Measures bodies after contact, whose places are known to `astray`. The points of the difference nearest to those
/// at a distance `aside` from zero along the normal at contact and across it, both ways, bound the depth.
///
/// These are the corners of an octahedron, which is in the difference with all of its inside. Under a plane across
/// the normal its corner is at the plane; beside an edge or an apex, too, the corners that would be outside are on
/// the boundary.
#[cold]
#[inline(never)]
pub(crate) fn look_after<V: Vector>(
    [a, b]: [Shape<'_, V>; 2],
    from: &FromContact<V>,
    [aside, astray]: [V::Scalar; 2],
    max_iterations: usize,
) -> After<V> {
    let shapes = Both::<_, _>::new(a, b);
    let cores = shapes.cores();
    let mut pair: AnyPair<'_, V> = Pair::new(&shapes, cores.each_ref());
    let offset = pair.core_a.origin - pair.core_b.origin;
    let size = pair.size(offset) + aside;
    let frame = Frame::new(&mut pair, offset, size);
    let mut state = begin(&pair, &frame, size, max_iterations);
    state.ensure_measured();
    // If the closest points are known at once, there is no plane yet.
    if state.length > frame.radius && !state.lower.is_finite() {
        let _ = go_on(&mut state, &mut pair, &frame, max_iterations);
    }
    let mut iterations = state.iterations;
    let lower = (state.lower - frame.radius - frame.error) * frame.scale - astray;
    let mut times = V::Scalar::ZERO;
    if lower <= V::Scalar::ZERO {
        let [u, w] = axes_across(from.n);
        let (mut corners, mut is_found) = ([[V::ZERO; 2]; 3], frame.error.is_finite());
        for (ends, axis) in corners.iter_mut().zip([from.n, u, w]).take(V::DIM) {
            *ends = [axis, -axis].map(|axis| {
                let target = axis * (aside * frame.per_unit);
                let seen = Frame { offset: frame.offset - target, ..frame };
                let mut found = begin(&pair, &seen, size, max_iterations.saturating_sub(iterations));
                found.ensure_measured();
                iterations += found.iterations;
                is_found &= !found.simplex.points().is_empty();
                let PointPair { a, b } = found.simplex.weighted_witness();
                let point = a - b + frame.offset;
                let (outwards, length) = (target - point, (target - point).norm());
                // NaN is no corner.
                if length <= frame.radius { target } else { point + outwards * (frame.radius / length) }
            });
        }
        if is_found {
            // In units of `ε/2`, weighted sums lose 5, the weights' own sum 4, the difference and its sum with the
            // offset one each; the offset loses 2, and the step to the surface 4.
            let known = Uncertainty::new(&pair, frame.per_unit);
            let rounded =
                roundings_of(12.0, known.extent) + roundings_of(4.0, frame.offset.abs() + V::splat(frame.radius));
            let (known, astray) = (known.with(rounded), astray * frame.per_unit);
            let error = |u: V| raised(known.along(u)).min(frame.error + frame.noise) + astray;
            times = room_around_zero(faces_of_octahedron(&corners), error, |u| from.reach(u)) * frame.scale;
        }
    }
    After { lower, axis: state.axis.unit().unwrap_or(from.n), times, iterations }
}

/// The corners of each face of an octahedron, given both ends of its axes, or of a square: all in the same
/// orientation as seen from outside, if it is convex.
pub(super) fn faces_of_octahedron<V: Vector>(ends: &[[V; 2]; 3]) -> impl Iterator<Item = [V; MAX_POINTS]> {
    (0..1_usize << V::DIM).map(|side| {
        let mut corners: [V; MAX_POINTS] =
            array::from_fn(|i| if i < V::DIM { ends[i][side >> i & 1] } else { V::ZERO });
        if side.count_ones() % 2 == 1 {
            corners.swap(0, 1);
        }
        corners
    })
}

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
