//! The box of a shape as a tree needs it: with room for rounding.

use num_traits::Float as _;

use crate::bounds::core_box;
use crate::{Aabb, Core, CoreKind, Scalar, ScalarOf, SupportMap, Vector};

/// A box that contains the set that the shape stands for, and every point that a query computes of it: the
/// [`bounding_box`](crate::bounding_box) grown by 32 ε of the numbers that the shape is computed from, and by what its core is
/// [known](Core::error) to. `None` if a number is not finite.
///
/// A query's answer is that of a shape which is off by its rounding, a few ε of the origin, the core's extent and the
/// radius. Since the box has room for that, a body whose box shows it to be farther than an answer is also farther by its
/// own query, not only in truth.
#[inline]
#[must_use]
pub fn outer_box<S: SupportMap + ?Sized>(shape: &S) -> Option<Aabb<S::Vector>> {
    let Core { origin, radius, extent, error, kind, .. } = shape.core();
    let core = match kind {
        CoreKind::Point(at) => Aabb { min: at, max: at },
        _ => core_box(shape),
    };
    let size = origin.abs().dot(S::Vector::ONE) + extent + radius;
    let room =
        ScalarOf::<S>::from_f64(32.0) * ScalarOf::<S>::EPSILON * size + ScalarOf::<S>::min_positive_value() + error;
    let reach = S::Vector::splat(radius + room);
    let outer = Aabb { min: origin + core.min - reach, max: origin + core.max + reach };
    (outer.min.is_finite() && outer.max.is_finite()).then_some(outer)
}
