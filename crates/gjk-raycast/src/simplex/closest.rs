//! The point of a simplex closest to zero, found by looking at every face.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::simplex::affine_hull::project;
use crate::simplex::{Face, MAX_POINTS, faces};

/// The point of a simplex closest to zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closest<V: Vector> {
    /// The point; zero where the simplex has full dimension and contains it.
    pub(crate) v: V,
    /// The smallest face that contains it.
    pub(crate) face: Face,
    /// Its barycentric coordinates there, one for each corner of the face.
    pub(crate) weights: [V::Scalar; MAX_POINTS],
}

/// The closest point found by looking at every face, and taking the nearest of those whose affine hull comes closest
/// to zero within the face. `None` where no comparison holds, as with NaN.
///
/// The points lie in a space of `dimension` dimensions: that of the vectors, or one less for points seen along a ray.
///
/// A new support point brings the simplex nearer, if by less than rounding; so a face with the last point for a corner
/// is preferred to one that without it is no nearer than that. Near contact the share that the last point has of zero's
/// foot is as small as the square of the distance, and may be lost in rounding; it turns the plane all the same, so
/// that a share of no less than minus a rounding counts as none.
pub(crate) fn nearest_face<V: Vector>(points: &[V], dimension: usize) -> Option<Closest<V>> {
    let newest = points.len().checked_sub(1)?;
    let longest = points.iter().map(|p| p.length_squared()).fold(V::Scalar::ZERO, V::Scalar::max).sqrt();
    let share = V::Scalar::from_f64(8.0) * V::Scalar::EPSILON;
    let rounding = share * longest;
    let mut best = None;
    let mut least = V::Scalar::infinity();
    // In the order of faces those without the newest point come first.
    for face in faces(points.len(), dimension + 1) {
        let mut corners = [V::ZERO; MAX_POINTS];
        let foot = project(face.of(points, &mut corners), |corner| -corner);
        let least_share = if face.has(newest) && face.len() <= dimension { -share } else { V::Scalar::ZERO };
        if !foot.coordinates[..face.len()].iter().all(|&b| b > least_share) {
            continue;
        }
        // A simplex of full dimension leaves nothing across, or else it is flat, and what spans it is rounding.
        let full = face.len() > dimension && foot.across.length() <= rounding;
        let v = if full { V::ZERO } else { -foot.across };
        let length = v.length();
        let known: Option<Closest<V>> = best;
        let bonus =
            if face.has(newest) && known.is_some_and(|b| !b.face.has(newest)) { rounding } else { V::Scalar::ZERO };
        if length < least + bonus {
            least = length;
            best = Some(Closest { v, face, weights: foot.coordinates.map(|b| b.max(V::Scalar::ZERO)) });
        }
    }
    best
}

/// The closest point of the affine hull of a face, if it is in the face.
#[cfg(feature = "paper")]
pub(crate) fn closest_in_face<V: Vector>(points: &[V], face: Face, dimension: usize) -> Option<Closest<V>> {
    let mut corners = [V::ZERO; MAX_POINTS];
    let foot = project(face.of(points, &mut corners), |corner| -corner);
    let inside = foot.coordinates[..face.len()].iter().all(|&b| b > V::Scalar::ZERO);
    let v = if face.len() > dimension { V::ZERO } else { -foot.across };
    inside.then_some(Closest { v, face, weights: foot.coordinates })
}

#[cfg(test)]
mod tests {
    use convex_support::glam::DVec3;

    use super::*;

    /// The newest point brings the simplex nearer, if by less than rounding: where faces are equally near, as those of
    /// points in a row, one that it is a corner of is kept.
    #[test]
    fn of_equally_near_faces_one_with_the_newest_point_is_kept() {
        let points = [DVec3::new(-1.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let closest = nearest_face(&points, 3).expect("numbers");
        assert_eq!((closest.v, closest.face), (DVec3::Y, Face::of_corners(&[2])));
    }

    #[test]
    fn every_kind_of_face_may_be_the_nearest() {
        let tetrahedron = |at: DVec3| [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| p + at);
        for (at, corners, v) in [
            (DVec3::ONE, &[0][..], DVec3::ONE),
            (DVec3::new(-0.5, 1.0, 1.0), &[0, 1], DVec3::new(0.0, 1.0, 1.0)),
            (DVec3::new(-0.25, -0.25, 1.0), &[0, 1, 2], DVec3::Z),
            (DVec3::splat(-0.125), &[0, 1, 2, 3], DVec3::ZERO),
        ] {
            let closest = nearest_face(&tetrahedron(at), 3).expect("numbers");
            assert_eq!((closest.v, closest.face), (v, Face::of_corners(corners)), "at {at}");
        }
        assert!(nearest_face(&[DVec3::NAN], 3).is_none());
    }
}
