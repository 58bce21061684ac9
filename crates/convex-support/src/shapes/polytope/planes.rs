//! The planes of a polytope's facets, side by side.

use super::lanes::PLANES;
use crate::Vector;

/// [`PLANES`] planes, each a unit outward normal by coordinates and the polytope's support value along it from the
/// middle.
pub(crate) type Planes<S> = [[S; PLANES]; 4];

/// The normal of a facet, and the polytope's support value along it from the middle.
pub(crate) fn facet<V: Vector>(planes: &[Planes<V::Scalar>], index: usize) -> (V, V::Scalar) {
    let (planes, l) = (&planes[index / PLANES], index % PLANES);
    (V::from_fn(|i| planes[i][l]), planes[3][l])
}
