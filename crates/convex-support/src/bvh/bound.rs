//! What a question says of a box: the least value that anything in it can have.

use num_traits::Float as _;

use super::lanes::Lanes;
use super::node::{Boxes, LanesOf};
use crate::numerics::range::comfortable_unit_of_length;
use crate::{Aabb, Scalar, Vector};

/// A lower bound on a quantity, such as a distance, of everything that lies in a box.
///
/// An implementor must obey one law, *to the last bit*: the bound of a box is not greater than that of any box within it.
/// Bounds computed by the same monotone operations (sums, differences, products with a constant, minima and maxima, as
/// rounded by IEEE 754) obey it. Then which items a [search](super::Bvh::search) leaves out depends on their boxes alone,
/// not on the tree.
pub trait Bound<V: Vector> {
    /// The bounds of four boxes; infinity where nothing in a box concerns the question. Those of places without a child do
    /// not matter.
    fn bounds(&self, boxes: &Boxes<V>) -> LanesOf<V>;

    /// A bit for each of four boxes, the lowest for the first: for those with a bound of at most `limit`, and perhaps for others whose
    /// bound rounding cannot tell from it. It obeys the same law: with a bit for a box there is one for every box around it. Provided: by
    /// the bounds.
    #[inline]
    fn near(&self, boxes: &Boxes<V>, limit: V::Scalar) -> u32 {
        self.bounds(boxes).at_most(limit)
    }
}

/// The rounding of the few operations that a bound is made of, relative to the bound.
fn rounding<S: Scalar>() -> S {
    S::from_f64(8.0) * S::EPSILON
}

/// When a box that moves along a ray meets another: λ ≥ 0, from below, for the box with the given half extents whose centre
/// is at `source + λ·direction`. With half extents of zero this is a ray cast.
///
/// The moving box touches a box B where its centre is in B grown by the half extents, so that coordinate by coordinate
///
/// > B.min − h ≤ s + λ·d ≤ B.max + h,
///
/// an interval of λ each, and the answer is where they all have begun, if none has ended by then (the slab method).
///
/// Operations are rounded towards an earlier time, relatively; rounding of the coordinates themselves has to be in the
/// boxes or the half extents (see [`outer_box`](super::outer_box)).
#[derive(Clone, Copy, Debug)]
pub struct SweptBox<V: Vector> {
    /// By coordinate, what the smallest and the largest of a box are compared with: s + h and s − h.
    from: [[LanesOf<V>; 2]; 3],
    /// 1/d, in a unit of d in which its square is an ordinary number.
    inverse: [LanesOf<V>; 3],
    /// The side of a box that is met first.
    first: [usize; 3],
    /// From the unit of d to λ, rounded down.
    deflate: LanesOf<V>,
}

impl<V: Vector> SweptBox<V> {
    /// The box of these half extents about `source`, moving along `direction`.
    #[must_use]
    pub fn new(half_extents: V, source: V, direction: V) -> Self {
        let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
        let unit = comfortable_unit_of_length(direction.abs().max_element());
        let mut swept = Self {
            from: [[Lanes::splat(zero); 2]; 3],
            inverse: [Lanes::splat(one); 3],
            first: [0; 3],
            deflate: Lanes::splat((one - rounding::<V::Scalar>()) / unit),
        };
        for i in 0..V::DIM {
            let (s, h) = (source.get(i), half_extents.get(i));
            let inverse = (direction.get(i) / unit).recip();
            swept.from[i] = [Lanes::splat(s + h), Lanes::splat(s - h)];
            swept.inverse[i] = Lanes::splat(inverse);
            swept.first[i] = usize::from(inverse.is_sign_negative());
        }
        swept
    }
}

impl<V: Vector> Bound<V> for SweptBox<V> {
    #[inline]
    fn bounds(&self, boxes: &Boxes<V>) -> LanesOf<V> {
        let infinity = Lanes::splat(V::Scalar::infinity());
        let (mut entry, mut exit): (LanesOf<V>, LanesOf<V>) = (Lanes::splat(V::Scalar::ZERO), infinity);
        for i in 0..V::DIM {
            let (near, far) = (self.first[i], 1 - self.first[i]);
            let (from, inverse) = (self.from[i], self.inverse[i]);
            // Where d is zero, the quotient is ±∞ by the side of the plane, and NaN on it, which is then passed over.
            let begins: LanesOf<V> = (boxes.side(i, near) - from[near]) * inverse;
            let ends: LanesOf<V> = (boxes.side(i, far) - from[far]) * inverse;
            (entry, exit) = (begins.max(entry), ends.min(exit));
        }
        let latest = exit * Lanes::splat(V::Scalar::ONE + rounding::<V::Scalar>());
        let bound = (entry * self.deflate).min(Lanes::splat(V::Scalar::max_value()));
        entry.if_at_most(latest, bound, infinity)
    }
}

/// The distance from a box to a box, from below.
///
/// Coordinate by coordinate the gap is what one begins after the other ends, or 0; the distance is the length of the gaps.
#[derive(Clone, Copy, Debug)]
pub struct BoxDistance<V: Vector> {
    /// By coordinate, the smallest and the largest.
    of: [[LanesOf<V>; 2]; 3],
}

impl<V: Vector> BoxDistance<V> {
    /// The distance from this box.
    #[inline]
    #[must_use]
    pub fn new(of: Aabb<V>) -> Self {
        let mut sides = [[Lanes::splat(V::Scalar::ZERO); 2]; 3];
        for (i, side) in sides.iter_mut().enumerate().take(V::DIM) {
            *side = [Lanes::splat(of.min.get(i)), Lanes::splat(of.max.get(i))];
        }
        Self { of: sides }
    }

    /// The squared length of the gaps, and the largest of them.
    #[inline(always)]
    fn gaps(&self, boxes: &Boxes<V>) -> (LanesOf<V>, LanesOf<V>) {
        let zero: LanesOf<V> = Lanes::splat(V::Scalar::ZERO);
        let (mut squared, mut largest) = (zero, zero);
        for i in 0..V::DIM {
            let before = boxes.min(i) - self.of[i][1];
            let behind = self.of[i][0] - boxes.max(i);
            let gap = before.max(behind).max(zero);
            (squared, largest) = (squared + gap * gap, gap.max(largest));
        }
        (squared, largest)
    }
}

impl<V: Vector> Bound<V> for BoxDistance<V> {
    #[inline(always)]
    fn bounds(&self, boxes: &Boxes<V>) -> LanesOf<V> {
        let huge: LanesOf<V> = Lanes::splat(V::Scalar::max_value());
        let (squared, largest) = self.gaps(boxes);
        // A length is at least its largest coordinate, which is what remains where squares under- or overflow.
        let length = squared.min(huge).sqrt().max(largest);
        (length * Lanes::splat(V::Scalar::ONE - rounding::<V::Scalar>())).min(huge)
    }

    /// By the squares, which takes no root, where that of a positive limit is an ordinary number: what underflows of a gap is nothing to
    /// it, and what overflows is beyond it.
    #[inline(always)]
    fn near(&self, boxes: &Boxes<V>, limit: V::Scalar) -> u32 {
        let end = limit * limit;
        let is_ordinary = end > V::Scalar::min_positive_value() / V::Scalar::EPSILON && end.is_finite();
        if !(is_ordinary && limit > V::Scalar::ZERO) {
            return self.bounds(boxes).at_most(limit);
        }
        let deflate = V::Scalar::ONE - rounding::<V::Scalar>() - rounding::<V::Scalar>();
        (self.gaps(boxes).0 * Lanes::splat(deflate)).at_most(end)
    }
}
