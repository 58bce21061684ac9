//! What a question says of a box: the least value that anything in it can have.

use num_traits::Float as _;

use super::node::{Boxes, WIDTH, greater, lesser};
use crate::vector::comfortable_unit_of_length;
use crate::{Aabb, Scalar, Vector};

/// A lower bound on a quantity, such as a distance, of everything that lies in a box.
///
/// An implementor must obey one law, *to the last bit*: the bound of a box is not greater than that of any box within it.
/// Bounds computed by the same monotone operations (sums, differences, products with a constant, minima and maxima, as
/// rounded by IEEE 754) obey it. Then which items a [search](super::Bvh::search) leaves out depends on their boxes alone, not on
/// the tree.
pub trait Bound<V: Vector> {
    /// The bounds of four boxes; infinity where nothing in a box concerns the question. Those of places without a child do
    /// not matter.
    fn bounds(&self, boxes: &Boxes<V>) -> [V::Scalar; WIDTH];
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
/// Operations are rounded towards an earlier time, relatively; rounding of the coordinates themselves has to be in the boxes
/// or the half extents (see [`outer_box`](super::outer_box)).
#[derive(Clone, Copy, Debug)]
pub struct SweptBox<V: Vector> {
    /// By coordinate, what the smallest and the largest of a box are compared with: s + h and s − h.
    from: [[V::Scalar; 2]; 3],
    /// 1/d, in a unit of d in which its square is an ordinary number.
    inverse: [V::Scalar; 3],
    /// The side of a box that is met first.
    first: [usize; 3],
    /// From the unit of d to λ, rounded down.
    deflate: V::Scalar,
}

impl<V: Vector> SweptBox<V> {
    /// The box of these half extents about `source`, moving along `direction`.
    #[must_use]
    pub fn new(half_extents: V, source: V, direction: V) -> Self {
        let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
        let unit = comfortable_unit_of_length(direction.abs().max_element());
        let mut swept = Self {
            from: [[zero; 2]; 3],
            inverse: [one; 3],
            first: [0; 3],
            deflate: (one - rounding::<V::Scalar>()) / unit,
        };
        for i in 0..V::DIM {
            swept.from[i] = [source.get(i) + half_extents.get(i), source.get(i) - half_extents.get(i)];
            swept.inverse[i] = (direction.get(i) / unit).recip();
            swept.first[i] = usize::from(swept.inverse[i].is_sign_negative());
        }
        swept
    }
}

impl<V: Vector> Bound<V> for SweptBox<V> {
    #[inline]
    fn bounds(&self, boxes: &Boxes<V>) -> [V::Scalar; WIDTH] {
        let mut entry = [V::Scalar::ZERO; WIDTH];
        let mut exit = [V::Scalar::infinity(); WIDTH];
        for i in 0..V::DIM {
            let (near, far) = (self.first[i], 1 - self.first[i]);
            for lane in 0..WIDTH {
                // Where d is zero, the quotient is ±∞ by the side of the plane, and NaN on it, which is then passed over.
                let begins = (boxes.side(i, near)[lane] - self.from[i][near]) * self.inverse[i];
                let ends = (boxes.side(i, far)[lane] - self.from[i][far]) * self.inverse[i];
                entry[lane] = greater(begins, entry[lane]);
                exit[lane] = lesser(ends, exit[lane]);
            }
        }
        let inflate = V::Scalar::ONE + rounding::<V::Scalar>();
        core::array::from_fn(|lane| {
            if entry[lane] <= exit[lane] * inflate {
                lesser(entry[lane] * self.deflate, V::Scalar::max_value())
            } else {
                V::Scalar::infinity()
            }
        })
    }
}

/// The distance from a box to a box, from below.
///
/// Coordinate by coordinate the gap is what one begins after the other ends, or 0; the distance is the length of the gaps.
#[derive(Clone, Copy, Debug)]
pub struct BoxDistance<V: Vector> {
    of: Aabb<V>,
}

impl<V: Vector> BoxDistance<V> {
    /// The distance from this box.
    #[must_use]
    pub fn new(of: Aabb<V>) -> Self {
        Self { of }
    }
}

impl<V: Vector> Bound<V> for BoxDistance<V> {
    #[inline]
    fn bounds(&self, boxes: &Boxes<V>) -> [V::Scalar; WIDTH] {
        let (zero, huge) = (V::Scalar::ZERO, V::Scalar::max_value());
        let mut squared = [zero; WIDTH];
        let mut largest = [zero; WIDTH];
        for i in 0..V::DIM {
            for lane in 0..WIDTH {
                let before = boxes.min(i)[lane] - self.of.max.get(i);
                let behind = self.of.min.get(i) - boxes.max(i)[lane];
                let gap = greater(greater(before, behind), zero);
                squared[lane] = squared[lane] + gap * gap;
                largest[lane] = greater(gap, largest[lane]);
            }
        }
        // A length is at least its largest coordinate, which is what remains where squares under- or overflow.
        let deflate = V::Scalar::ONE - rounding::<V::Scalar>();
        core::array::from_fn(|lane| lesser(greater(lesser(squared[lane], huge).sqrt(), largest[lane]) * deflate, huge))
    }
}
