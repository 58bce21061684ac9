//! The point of a simplex closest to zero, by testing every face.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::simplex::affine_hull::project;
use crate::simplex::{Face, MAX_POINTS, faces};

/// The point of a simplex closest to zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closest<V: Vector> {
    /// The point; zero if the simplex has full dimension and contains it.
    pub(crate) v: V,
    /// The smallest face that contains it.
    pub(crate) face: Face,
    /// Its barycentric coordinates in the face, one for each corner.
    pub(crate) weights: [V::Scalar; MAX_POINTS],
}

/// The closest point found by testing every face: the nearest of the points of affine hulls closest to zero that are
/// within their face. `None` if no comparison holds, as with NaN.
///
/// The points lie in `dimension` dimensions: those of the vectors, or one less for points projected along a ray.
///
/// A new support point brings the simplex nearer, perhaps by less than rounding. So a face with the last point as a
/// corner is preferred to one without it that is nearer by rounding at most. Near contact, the last point's coordinate
/// of zero's foot is as small as the square of the distance and may be lost to rounding, yet it turns the plane. So a
/// coordinate that is negative by a rounding counts as zero.
pub(crate) fn nearest_face<V: Vector>(points: &[V], dimension: usize) -> Option<Closest<V>> {
    let newest = points.len().checked_sub(1)?;
    let longest = points.iter().map(|p| p.length_squared()).fold(V::Scalar::ZERO, V::Scalar::max).sqrt();
    let share = V::Scalar::from_f64(8.0) * V::Scalar::EPSILON;
    let rounding = share * longest;
    let mut best = None;
    let mut least = V::Scalar::infinity();
    // The faces without the newest point come first.
    for face in faces(points.len(), dimension + 1) {
        let mut corners = [V::ZERO; MAX_POINTS];
        let foot = project(face.of(points, &mut corners), |corner| -corner);
        let least_share = if face.has(newest) && face.len() <= dimension { -share } else { V::Scalar::ZERO };
        if !foot.coordinates[..face.len()].iter().all(|&b| b > least_share) {
            continue;
        }
        // A simplex of full dimension leaves nothing across; otherwise it is flat, and only rounding spans it.
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

    /// The newest point brings the simplex nearer, perhaps by less than rounding. Among equally near faces, as of
    /// points in a row, one with this corner is kept.
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
