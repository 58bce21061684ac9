//! An octahedron, in the plane a square, of points of the difference of two bodies that lie around zero.
//!
//! Its corners are the points of the difference nearest to places aside of zero, along three axes and both ways. It is
//! in the difference with all of its inside, so that zero meets both bodies where it has [room](super::room) there.
//! Under a plane across an axis the corner is at the plane; beside an edge or an apex, too, the corners that would be
//! outside are on the boundary. If the bodies are well apart or well in one another, a search from zero itself tells.

use core::array;

use convex_support::Vector;

use super::room::room_around_zero;
use crate::simplex::MAX_POINTS;

/// Both ends of each axis.
pub(super) struct Octahedron<V>([[V; 2]; 3]);

impl<V: Vector> Octahedron<V> {
    /// The octahedron of the places `aside` from zero along the axes and against them, of bodies with a radius around
    /// their cores; `nearest` finds the point of the difference of the cores that is nearest to a place. `None` if
    /// there is none for one of them.
    pub(super) fn around_zero<E>(
        axes: [V; 3],
        aside: V::Scalar,
        radius: V::Scalar,
        mut nearest: impl FnMut(V) -> Result<Option<V>, E>,
    ) -> Result<Option<Self>, E> {
        let (mut corners, mut is_found) = ([[V::ZERO; 2]; 3], true);
        for (ends, axis) in corners.iter_mut().zip(axes).take(V::DIM) {
            for (corner, axis) in ends.iter_mut().zip([axis, -axis]) {
                let place = axis * aside;
                let Some(point) = nearest(place)? else {
                    is_found = false;
                    continue;
                };
                let (outwards, length) = (place - point, (place - point).norm());
                // NaN is no corner.
                *corner = if length <= radius { place } else { point + outwards * (radius / length) };
            }
        }
        Ok(is_found.then_some(Self(corners)))
    }

    /// The largest coordinate of its corners, or `least` if that is larger.
    pub(super) fn extent(&self, least: V::Scalar) -> V::Scalar {
        self.0.iter().flatten().fold(least, |most, corner| num_traits::Float::max(most, corner.abs().max_element()))
    }

    /// How many times a set about zero [fits into it](room_around_zero), given the error of its corners and the reach
    /// of the set along a unit vector.
    pub(super) fn room(&self, error: impl Fn(V) -> V::Scalar, reach: impl Fn(V) -> V::Scalar) -> V::Scalar {
        room_around_zero(faces_between(&self.0), error, reach)
    }
}

/// The corners of each of its faces: all in the same orientation as seen from outside, if it is convex.
fn faces_between<V: Vector>(ends: &[[V; 2]; 3]) -> impl Iterator<Item = [V; MAX_POINTS]> {
    (0..1_usize << V::DIM).map(|side| {
        let mut corners: [V; MAX_POINTS] =
            array::from_fn(|i| if i < V::DIM { ends[i][side >> i & 1] } else { V::ZERO });
        if side.count_ones() % 2 == 1 {
            corners.swap(0, 1);
        }
        corners
    })
}
