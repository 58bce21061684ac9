//! The point of a simplex closest to zero.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::flat::project;
use crate::johnson::johnson;
use crate::signed_volumes::signed_volumes;
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

/// How the point of a simplex closest to zero, and the smallest face that contains it, are found.
///
/// All share the orthogonal projection that computes the point once its face is known, and the back-up where signs
/// are inconsistent; they differ in how they find the face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SubAlgorithm {
    /// The regions of the faces that the newest point is a corner of; every face where that leaves a doubt: the fastest.
    /// Casts look at every face at once.
    #[default]
    Regions,
    /// Every face is projected upon, and the nearest taken that zero projects into: the most robust.
    NearestFace,
    /// Johnson's determinants, as in the paper.
    Johnson,
    /// The signs of volumes, after Montanari, Petrinic and Barbieri.
    SignedVolumes,
}

impl SubAlgorithm {
    /// The closest point of the points, in a space of `dimension` dimensions: that of the vectors, or one less for points
    /// seen along a ray, where only [`nearest_face`] applies.
    pub(crate) fn closest<V: Vector>(self, points: &[V], dimension: usize) -> Option<Closest<V>> {
        match self {
            Self::Johnson if dimension == V::DIM => johnson(points, dimension),
            Self::SignedVolumes if dimension == V::DIM => signed_volumes(points, dimension),
            _ => nearest_face(points, dimension),
        }
    }
}

/// The closest point found by looking at every face, and taking the nearest of those whose affine hull comes closest
/// to zero within the face. `None` where no comparison holds, as with NaN.
///
/// The points lie in a space of `dimension` dimensions: that of the vectors, or one less for points seen along a ray.
///
/// A new support point brings the simplex nearer, if by less than rounding; so a face with the last point for a corner
/// is preferred to one that without it is no nearer than that.
pub(crate) fn nearest_face<V: Vector>(points: &[V], dimension: usize) -> Option<Closest<V>> {
    let newest = points.len().checked_sub(1)?;
    let longest = points.iter().map(|p| p.length_squared()).fold(V::Scalar::ZERO, V::Scalar::max).sqrt();
    let rounding = V::Scalar::from_f64(8.0) * V::Scalar::EPSILON * longest;
    let mut best = None;
    let mut least = V::Scalar::infinity();
    // In the order of faces those without the newest point come first.
    for face in faces(points.len(), dimension + 1) {
        let mut corners = [V::ZERO; MAX_POINTS];
        let foot = project(face.of(points, &mut corners), |corner| -corner);
        if !foot.coordinates[..face.len()].iter().all(|&b| b > V::Scalar::ZERO) {
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
            best = Some(Closest { v, face, weights: foot.coordinates });
        }
    }
    best
}
