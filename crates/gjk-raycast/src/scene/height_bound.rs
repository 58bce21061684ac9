//! How high boxes are above a half-space.

use convex_support::{Bound, Boxes, Lanes, Scalar, Vector};
use num_traits::Float as _;

use crate::HalfSpace;

/// The distance of a box from a half-space, from below: that of its lowest corner.
pub(super) struct HeightBound<V: Vector> {
    /// The unit normal; coordinates that are not used are zero.
    normal: [V::Scalar; 3],
    /// The side of a box that is nearest.
    nearest: [usize; 3],
    /// The offset with room for its rounding.
    offset: V::Scalar,
}

impl<V: Vector> HeightBound<V> {
    pub(super) fn new(half_space: &HalfSpace<V>) -> Self {
        let unit = half_space.normal() / half_space.length;
        let normal = core::array::from_fn(|i| if i < V::DIM { unit.get(i) } else { V::Scalar::ZERO });
        let offset = half_space.offset() / half_space.length;
        Self {
            normal,
            nearest: normal.map(|n| usize::from(n < V::Scalar::ZERO)),
            offset: offset + V::Scalar::from_f64(32.0) * V::Scalar::EPSILON * offset.abs(),
        }
    }
}

/// Four scalars.
type LanesOf<V> = <<V as Vector>::Scalar as Scalar>::Lanes;

impl<V: Vector> Bound<V> for HeightBound<V> {
    fn bounds(&self, boxes: &Boxes<V>) -> LanesOf<V> {
        let zero = LanesOf::<V>::splat(V::Scalar::ZERO);
        let mut height = zero - LanesOf::<V>::splat(self.offset);
        for i in 0..V::DIM {
            let side = if self.nearest[i] == 0 { boxes.min(i) } else { boxes.max(i) };
            height = height + side * LanesOf::<V>::splat(self.normal[i]);
        }
        let deflate = V::Scalar::ONE - V::Scalar::from_f64(8.0) * V::Scalar::EPSILON;
        // A sum that overflows says nothing.
        let bound = height.max(zero) * LanesOf::<V>::splat(deflate);
        bound.min(LanesOf::<V>::splat(V::Scalar::max_value()))
    }
}
