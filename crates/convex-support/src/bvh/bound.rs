//! Lower bounds of a question for boxes: the least value for anything in a box.

use core::marker::PhantomData;

use num_traits::Float as _;

use super::frame::{CoarseUnit, Frame};
use super::node::Boxes;
use super::outer_box::outer_core_box;
use crate::glam::{Vec3A, Vec4};
use crate::numerics::range::{is_comfortable, power_of_two_below};
use crate::{Aabb, Scalar, SupportMap, Vector};

/// A question to a tree of boxes: a lower bound on a quantity, such as a distance, for everything that lies in a box.
///
/// The bound of an item's own box decides whether the item is [visited](super::Bvh::search). [Coarser](CoarseBound)
/// bounds of the nodes' boxes, in single precision and for four boxes at once, decide which nodes the search goes
/// into. An implementor must obey one law, whatever the rounding: *if the bound of a box is at most a limit, so is
/// the coarse bound of every box around it.* Then the items that a search leaves out depend on the items' boxes
/// alone, not on the tree.
pub trait Bound<V: Vector> {
    /// The bound in single precision.
    type Coarse: CoarseBound;

    /// The bound of one box; infinity if nothing in it concerns the question.
    fn bound(&self, around: &Aabb<V>) -> V::Scalar;

    /// The bound for the boxes of a tree, in this frame.
    fn coarse(&self, frame: &Frame<V>) -> Self::Coarse;
}

/// A bound for four boxes in single precision.
pub trait CoarseBound {
    /// Numbers, none of them negative or NaN, in the order of the bounds of four boxes, in any unit and on any scale;
    /// infinity if nothing in a box concerns the question. The numbers of places without a child do not matter.
    fn bounds(&self, boxes: &Boxes) -> Vec4;

    /// The finite number of that kind that bounds of boxes do not exceed if they are at most `limit`.
    fn limit(&self, limit: f64) -> f32;
}

/// The rounding of the few operations that a bound is made of, relative to the bound.
fn rounding<S: Scalar>() -> S {
    S::from_f64(8.0) * S::EPSILON
}

/// A lower bound on the time λ ≥ 0 at which a box that moves along a ray meets another box. The moving box has the
/// given half extents, and its centre is at `source + λ·direction`. With half extents of zero this is a ray cast.
///
/// The moving box touches a box B where its centre is in B grown by the half extents, so that coordinate by coordinate
///
/// > B.min − h ≤ s + λ·d ≤ B.max + h,
///
/// an interval of λ each. The answer is where all have begun, if none has ended by then (the slab method).
///
/// Operations are rounded towards an earlier time, relatively; rounding of the coordinates themselves has to be in the
/// boxes or the half extents (see [`outer_box`](super::outer_box)).
#[derive(Clone, Copy, Debug)]
pub struct SweptBox<V: Vector> {
    /// The numbers that the smallest and the largest coordinate of a box are compared with: s + h and s − h.
    from: [V; 2],
    /// The reciprocal 1/d, in the unit of d: for the beginning of a box, and for its end.
    inverse: [V; 2],
    /// A power of two about as large as the largest coordinate of d.
    unit: V::Scalar,
}

impl<V: Vector> SweptBox<V> {
    /// The box of these half extents about `source`, moving along `direction`.
    #[must_use]
    pub fn new(half_extents: V, source: V, direction: V) -> Self {
        let unit = power_of_two_below(direction.abs().max_element());
        let inverse = V::from_fn(|i| V::Scalar::ONE / (direction.get(i) / unit));
        Self { from: [source + half_extents, source - half_extents], inverse: [inverse; 2], unit }
    }

    /// A bound for this moving box and another one, at most that of either. `None` if they move in opposite directions
    /// along a coordinate, or if one moves more than 2¹⁶ times as fast as the other.
    ///
    /// Along each coordinate, a box begins as for the one that is there first and is fastest, and ends as for the last
    /// and slowest. The smallest normal number is room for products that are smaller, whose rounding depends on the
    /// unit.
    #[must_use]
    pub fn and(&self, other: &Self) -> Option<Self> {
        let (per_unit, most) = (self.unit / other.unit, V::Scalar::from_f64(f64::from(1 << 16)));
        let is_back = |v: &Self, i: usize| v.inverse[0].get(i).is_sign_negative();
        let is_as_fast = per_unit <= most && per_unit * most >= V::Scalar::ONE;
        if !is_as_fast || (0..V::DIM).any(|i| is_back(self, i) != is_back(other, i)) {
            return None;
        }
        let least = V::splat(V::Scalar::min_positive_value());
        let from = [self.from[0].max(other.from[0]) + least, self.from[1].min(other.from[1]) - least];
        let [[fast, slow], others] = [self.inverse, other.inverse.map(|inverse| inverse * per_unit)];
        let pick = |is_second: bool, a: V::Scalar, b: V::Scalar| if is_second { b } else { a };
        let inverse = [
            V::from_fn(|i| pick(others[0].get(i).abs() < fast.get(i).abs(), fast.get(i), others[0].get(i))),
            V::from_fn(|i| pick(others[1].get(i).abs() > slow.get(i).abs(), slow.get(i), others[1].get(i))),
        ];
        Some(Self { from, inverse, unit: self.unit })
    }
}

impl<V: Vector> Bound<V> for SweptBox<V> {
    type Coarse = CoarseSweptBox<V>;

    #[inline(always)]
    fn bound(&self, around: &Aabb<V>) -> V::Scalar {
        let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
        let (after, before) = (around.min - self.from[0], around.max - self.from[1]);
        let (mut entry, mut exit) = (zero, V::Scalar::infinity());
        for i in 0..V::DIM {
            let [begin, end] = self.inverse.map(|inverse| inverse.get(i));
            let (near, far) = (after.get(i), before.get(i));
            let (near, far) = if begin.is_sign_negative() { (far, near) } else { (near, far) };
            // If d is zero, the quotient is ±∞ by the side of the plane, and NaN on it, which then changes nothing.
            let (begins, ends) = (near * begin, far * end);
            entry = if begins > entry { begins } else { entry };
            exit = if ends < exit { ends } else { exit };
        }
        if entry <= exit * (one + rounding::<V::Scalar>()) {
            (entry * ((one - rounding::<V::Scalar>()) / self.unit)).min(V::Scalar::max_value())
        } else {
            V::Scalar::infinity()
        }
    }

    /// Coordinates are rounded so that the box begins earlier and ends later, the end is later by all rounding, and the
    /// limit has room for the rounding of the beginning.
    #[inline]
    fn coarse(&self, frame: &Frame<V>) -> CoarseSweptBox<V> {
        let mut coarse = CoarseSweptBox {
            from: [[Vec4::ZERO; 2]; 3],
            inverse: [[Vec4::ONE; 2]; 3],
            first: [0; 3],
            unit: CoarseUnit::new::<V::Scalar>(self.unit.as_f64() * frame.unit().per_unit()),
            space: PhantomData,
        };
        let largest = f64::from(f32::MAX);
        for i in 0..V::DIM {
            let [begin, end] = self.inverse.map(|inverse| inverse.get(i).as_f64());
            // Along a plane a box that has begun never ends, and one that has not begins at the largest number.
            let inverse = [begin.clamp(-largest, largest), end * (1.0 + 2.0 * CoarseUnit::ROUNDING)];
            coarse.inverse[i] = inverse.map(|inverse| Vec4::splat(inverse as f32));
            let first = usize::from(begin.is_sign_negative());
            let from = [frame.up(i, self.from[0].get(i)), frame.down(i, self.from[1].get(i))];
            coarse.from[i] = [from[first], from[1 - first]].map(Vec4::splat);
            coarse.first[i] = first;
        }
        coarse
    }
}

/// A [`SweptBox`] in the frame of a tree, with λ in a unit in which the largest coordinate of the direction
/// is between 1 and 2.
#[derive(Clone, Copy, Debug)]
pub struct CoarseSweptBox<V> {
    /// The numbers that the near side of a box is compared with, and the far one.
    from: [[Vec4; 2]; 3],
    /// For the beginning of a box, and for its end.
    inverse: [[Vec4; 2]; 3],
    /// The near side of a box.
    first: [usize; 3],
    unit: CoarseUnit,
    space: PhantomData<V>,
}

impl<V> CoarseSweptBox<V> {
    /// The unit of λ.
    #[must_use]
    pub fn unit(&self) -> CoarseUnit {
        self.unit
    }
}

impl<V: Vector> CoarseBound for CoarseSweptBox<V> {
    #[inline(always)]
    fn bounds(&self, boxes: &Boxes) -> Vec4 {
        let (mut entry, mut exit) = (Vec4::ZERO, Vec4::INFINITY);
        for i in 0..V::DIM {
            let (near, far) = (self.first[i], 1 - self.first[i]);
            // NaN, on a plane along the direction, is outside, and may be ignored or not.
            entry = ((boxes.side(i, near) - self.from[i][0]) * self.inverse[i][0]).max(entry);
            exit = ((boxes.side(i, far) - self.from[i][1]) * self.inverse[i][1]).min(exit);
        }
        Vec4::select(entry.cmple(exit), entry.min(Vec4::MAX), Vec4::INFINITY)
    }

    #[inline]
    fn limit(&self, limit: f64) -> f32 {
        self.unit.limit(limit)
    }
}

/// A lower bound of the distance between two boxes, of which one may be swept by a ball.
///
/// In each coordinate the gap is how far one begins after the other ends, or 0; the distance is the length of the gaps,
/// less the radius of the ball.
#[derive(Clone, Copy, Debug)]
pub struct BoxDistance<V: Vector> {
    of: Aabb<V>,
    radius: V::Scalar,
}

impl<V: Vector> BoxDistance<V> {
    /// The distance from this box.
    #[inline]
    #[must_use]
    pub fn new(of: Aabb<V>) -> Self {
        Self::rounded(of, V::Scalar::ZERO)
    }

    /// The distance from this box swept by a ball of the `radius`, which is neither negative nor NaN.
    #[inline]
    #[must_use]
    pub fn rounded(of: Aabb<V>, radius: V::Scalar) -> Self {
        Self { of, radius }
    }

    /// The distance from the box of a shape's [core](crate::Core), swept by its ball, with the room for rounding that
    /// [`outer_box`](super::outer_box) has. `None` if a number is not finite.
    #[inline]
    #[must_use]
    pub fn of_shape<S: SupportMap<Vector = V> + ?Sized>(shape: &S) -> Option<Self> {
        outer_core_box(shape).map(|(of, radius)| Self::rounded(of, radius))
    }

    /// The box that distances are from.
    #[must_use]
    pub fn of(&self) -> Aabb<V> {
        self.of
    }

    /// The radius of the ball that sweeps the box.
    #[must_use]
    pub fn radius(&self) -> V::Scalar {
        self.radius
    }
}

impl<V: Vector> Bound<V> for BoxDistance<V> {
    type Coarse = CoarseBoxDistance<V>;

    #[inline(always)]
    fn bound(&self, around: &Aabb<V>) -> V::Scalar {
        let gaps = (around.min - self.of.max).max(self.of.min - around.max).max(V::ZERO);
        // Whether boxes overlap cannot be predicted, so there is no branch on it: only a gap whose square is out of
        // range takes another way.
        let squared = gaps.length_squared();
        let is_plain = is_comfortable(squared) | (gaps.max_element() == V::Scalar::ZERO);
        let length = if is_plain { squared.sqrt() } else { gaps.norm() };
        let least = length * (V::Scalar::ONE - rounding::<V::Scalar>()) - self.radius;
        least.max(V::Scalar::ZERO).min(V::Scalar::max_value())
    }

    #[inline]
    fn coarse(&self, frame: &Frame<V>) -> CoarseBoxDistance<V> {
        let radius = self.radius.as_f64();
        CoarseBoxDistance { radius, ..CoarseBoxDistance::seen(&frame.outwards(&self.of), frame.unit()) }
    }
}

/// A [`BoxDistance`] in the frame of a tree: the bounds are the squares of distances, and the radius of the ball and
/// all rounding are in the limit.
#[derive(Clone, Copy, Debug)]
pub struct CoarseBoxDistance<V> {
    /// For each coordinate, the smallest and the largest.
    of: [[Vec4; 2]; 3],
    /// In the question's unit.
    radius: f64,
    unit: CoarseUnit,
    space: PhantomData<V>,
}

impl<V> CoarseBoxDistance<V> {
    /// The distance from a box in the frame of the tree.
    #[inline(always)]
    pub(super) fn seen(of: &Aabb<Vec3A>, unit: CoarseUnit) -> Self {
        let of = core::array::from_fn(|i| [of.min[i], of.max[i]].map(Vec4::splat));
        Self { of, radius: 0.0, unit, space: PhantomData }
    }
}

impl<V: Vector> CoarseBound for CoarseBoxDistance<V> {
    #[inline(always)]
    fn bounds(&self, boxes: &Boxes) -> Vec4 {
        let mut squared = Vec4::ZERO;
        for i in 0..V::DIM {
            let gap = (boxes.min(i) - self.of[i][1]).max(self.of[i][0] - boxes.max(i)).max(Vec4::ZERO);
            squared += gap * gap;
        }
        squared.min(Vec4::MAX)
    }

    #[inline]
    fn limit(&self, limit: f64) -> f32 {
        self.unit.limit_of_squares(limit + self.radius)
    }
}
