//! The choice among the ways to find the point of a simplex closest to zero.

use convex_support::Vector;

use crate::simplex::closest::{Closest, nearest_face};
#[cfg(feature = "paper")]
use crate::simplex::paper::{johnson, signed_volumes};

/// How the point of a simplex closest to zero, and the smallest face that contains it, are found.
///
/// All variants share the orthogonal projection that computes the point once its face is known, and the back-up for
/// inconsistent signs; they differ in how they find the face. All but the default need the feature `paper`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum SubAlgorithm {
    /// The fastest: it tests only the faces with the newest point as a corner, and every face if this leaves a doubt.
    /// Casts test every face at once.
    #[default]
    Regions,
    /// The most robust: zero is projected on every face, and the nearest of the faces that contain their projection is
    /// taken.
    #[cfg(feature = "paper")]
    NearestFace,
    /// Johnson's determinants, as in the paper.
    #[cfg(feature = "paper")]
    Johnson,
    /// The signs of volumes, after Montanari, Petrinic and Barbieri.
    #[cfg(feature = "paper")]
    SignedVolumes,
}

impl SubAlgorithm {
    /// The closest point of the points, in a space of `dimension` dimensions: that of the vectors, or one less for
    /// points projected along a ray, where only [`nearest_face`] applies.
    pub(crate) fn closest<V: Vector>(self, points: &[V], dimension: usize) -> Option<Closest<V>> {
        match self {
            #[cfg(feature = "paper")]
            Self::Johnson if dimension == V::DIM => johnson(points, dimension),
            #[cfg(feature = "paper")]
            Self::SignedVolumes if dimension == V::DIM => signed_volumes(points, dimension),
            _ => nearest_face(points, dimension),
        }
    }
}
