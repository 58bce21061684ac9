//! The heights of boxes above a half-space.

use convex_support::glam::Vec4;
use convex_support::{Aabb, Bound, Boxes, CoarseBound, CoarseUnit, Frame, Scalar, Vector};
use num_traits::Float as _;

use crate::HalfSpace;

/// A lower bound on the distance of a box from a half-space: that of its lowest corner.
pub(super) struct HeightBound<V: Vector> {
    /// The unit normal.
    normal: V,
    /// The offset with room for its rounding.
    offset: V::Scalar,
}

impl<V: Vector> HeightBound<V> {
    pub(super) fn new(half_space: &HalfSpace<V>) -> Self {
        let offset = half_space.offset() / half_space.length;
        Self {
            normal: half_space.normal() / half_space.length,
            offset: offset + V::Scalar::from_f64(32.0) * V::Scalar::EPSILON * offset.abs(),
        }
    }
}

impl<V: Vector> Bound<V> for HeightBound<V> {
    type Coarse = CoarseHeight;

    fn bound(&self, around: &Aabb<V>) -> V::Scalar {
        let mut height = -self.offset;
        for i in 0..V::DIM {
            let n = self.normal.get(i);
            height += n * if n < V::Scalar::ZERO { around.max } else { around.min }.get(i);
        }
        let deflate = V::Scalar::ONE - V::Scalar::from_f64(8.0) * V::Scalar::EPSILON;
        // A sum that overflows proves nothing.
        (height.max(V::Scalar::ZERO) * deflate).min(V::Scalar::max_value())
    }

    /// In the frame of a tree, `x = o + ξ/k`, a height is `(n·ξ + k(n·o − c))/k`, whose second part is one number. Both
    /// bounds are sums, which rounding moves by a few ε of their terms.
    fn coarse(&self, frame: &Frame<V>) -> CoarseHeight {
        let (unit, epsilon) = (frame.unit(), V::Scalar::EPSILON.as_f64());
        let (mut rest, mut terms) = (-self.offset.as_f64(), self.offset.as_f64().abs());
        let mut coarse = CoarseHeight { normal: [Vec4::ZERO; 3], nearest: [0; 3], rest: 0.0, unit };
        for i in 0..V::DIM {
            let n = self.normal.get(i).as_f64();
            let term = n * frame.origin().get(i).as_f64();
            (rest, terms) = (rest + term, terms + term.abs());
            coarse.normal[i] = Vec4::splat(n as f32);
            coarse.nearest[i] = usize::from(n < 0.0);
        }
        coarse.rest = CoarseUnit::down((rest - 16.0 * epsilon * terms) * unit.per_unit());
        coarse
    }
}

/// A [`HeightBound`] in the frame of a tree.
pub(super) struct CoarseHeight {
    /// Unused coordinates are zero.
    normal: [Vec4; 3],
    /// The nearest side of a box.
    nearest: [usize; 3],
    /// The part that is the same for all boxes, rounded down.
    rest: f32,
    unit: CoarseUnit,
}

impl CoarseBound for CoarseHeight {
    fn bounds(&self, boxes: &Boxes) -> Vec4 {
        let (mut height, mut terms) = (Vec4::splat(self.rest), Vec4::splat(self.rest.abs()));
        for i in 0..3 {
            let term = self.normal[i] * if self.nearest[i] == 0 { boxes.min(i) } else { boxes.max(i) };
            (height, terms) = (height + term, terms + term.abs());
        }
        height -= terms * (16.0 * f32::EPSILON);
        // NaN proves nothing.
        Vec4::select(height.cmpgt(Vec4::ZERO), height.min(Vec4::MAX), Vec4::ZERO)
    }

    fn limit(&self, limit: f64) -> f32 {
        self.unit.limit(limit)
    }
}
