//! The box of a shape for a tree, with room for rounding.

use num_traits::Float as _;

use crate::bounds::core_box;
use crate::{Aabb, Core, CoreKind, Scalar, ScalarOf, SupportMap, Vector};

/// A box that contains the exact set of a shape, and every point that a query computes of it: the
/// [`bounding_box`](crate::bounding_box), grown by 32 ε of the numbers that define the shape and by the
/// [error](Core::error) of its core. `None` if a number is not finite.
///
/// The answer of a query is that of a shape with rounding errors, a few ε of the origin, the core's extent and the
/// radius. The box has room for these errors. So if the box of a body is farther away than some answer, the body is
/// farther away also by its own query, not only in truth.
#[inline]
#[must_use]
pub fn outer_box<S: SupportMap + ?Sized>(shape: &S) -> Option<Aabb<S::Vector>> {
    let CoreWithRoom { core, origin, radius, room } = CoreWithRoom::of(shape);
    grown(core, origin, radius + room)
}

/// The same of the core alone, and the radius of the ball that sweeps it. Of a round shape the two are closer than a
/// box around both.
#[inline]
pub(super) fn outer_core_box<S: SupportMap + ?Sized>(shape: &S) -> Option<(Aabb<S::Vector>, ScalarOf<S>)> {
    let CoreWithRoom { core, origin, radius, room } = CoreWithRoom::of(shape);
    grown(core, origin, room).filter(|_| radius.is_finite()).map(|around| (around, radius))
}

struct CoreWithRoom<V: Vector> {
    /// Relative to the origin.
    core: Aabb<V>,
    origin: V,
    radius: V::Scalar,
    room: V::Scalar,
}

impl<V: Vector> CoreWithRoom<V> {
    #[inline]
    fn of<S: SupportMap<Vector = V> + ?Sized>(shape: &S) -> Self {
        let Core { origin, radius, extent, error, kind, .. } = shape.core();
        let core = match kind {
            CoreKind::Point(at) => Aabb { min: at, max: at },
            _ => core_box(shape),
        };
        let size = origin.abs().dot(V::ONE) + extent + radius;
        let room = V::Scalar::from_f64(32.0) * V::Scalar::EPSILON * size + V::Scalar::min_positive_value() + error;
        Self { core, origin, radius, room }
    }
}

#[inline]
fn grown<V: Vector>(core: Aabb<V>, origin: V, reach: V::Scalar) -> Option<Aabb<V>> {
    let reach = V::splat(reach);
    let outer = Aabb { min: origin + core.min - reach, max: origin + core.max + reach };
    (outer.min.is_finite() && outer.max.is_finite()).then_some(outer)
}
