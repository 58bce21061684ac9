//! The box of a shape as a tree needs it: with room for rounding.

use num_traits::Float as _;

use crate::{Aabb, Scalar, SupportMap, Vector, bounding_box};

/// A box that contains the shape and every point that a query computes of it: the [`bounding_box`] grown by 32 ε of the
/// numbers that the shape is computed from. `None` if a number is not finite.
///
/// A query's answer is that of a shape which is off by its rounding, a few ε of the origin, the core's extent and the radius.
/// Since the box has room for that, a body whose box shows it to be farther than an answer is also farther by its own
/// query, not only in truth.
#[must_use]
pub fn outer_box<S: SupportMap + ?Sized>(shape: &S) -> Option<Aabb<S::Vector>> {
    let tight = bounding_box(shape);
    let size = shape.origin().abs().dot(S::Vector::ONE) + shape.core_extent() + shape.radius();
    outer_box_of(tight, size)
}

/// `tight` grown by 32 ε of `size` and the least normal number.
fn outer_box_of<V: Vector>(tight: Aabb<V>, size: V::Scalar) -> Option<Aabb<V>> {
    let room = V::Scalar::from_f64(32.0) * V::Scalar::EPSILON * size + V::Scalar::min_positive_value();
    let outer = Aabb { min: tight.min - V::splat(room), max: tight.max + V::splat(room) };
    (outer.min.is_finite() && outer.max.is_finite()).then_some(outer)
}
