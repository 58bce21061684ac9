//! The planes of a polytope's facets, side by side.

use super::lanes::WIDTH;
use crate::Vector;

/// [`WIDTH`] planes, each a unit outward normal by coordinates and the polytope's support value along it from the
/// middle.
pub(crate) type Planes<S> = [[S; WIDTH]; 4];

/// The normal of a facet, and the polytope's support value along it from the middle.
pub(crate) fn facet<V: Vector>(planes: &[Planes<V::Scalar>], index: usize) -> (V, V::Scalar) {
    let (planes, l) = (&planes[index / WIDTH], index % WIDTH);
    (V::from_fn(|i| planes[i][l]), planes[3][l])
}
