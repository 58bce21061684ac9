//! The support point of a ball about zero and its Hessian, of which shapes swept by a ball are made.

use num_traits::Float as _;

use crate::numerics::range::is_comfortable;
use crate::{Scalar, Vector};

/// The point of the ball of the given radius about zero farthest along `direction`.
#[inline]
pub(crate) fn swept<V: Vector>(radius: V::Scalar, direction: V) -> V {
    if radius == V::Scalar::ZERO {
        return V::ZERO;
    }
    direction.unit().unwrap_or_else(|| V::axis(0)) * radius
}

/// The Hessian of the support value of a ball of the given radius about zero, applied to two changes: with `e` the
/// unit direction and `c` the length of the direction, `r/c·(u·w − (u·e)·(w·e))`.
#[inline(always)]
pub(crate) fn swept_hessian<V: Vector>(radius: V::Scalar, direction: V, changes: [V; 2]) -> [V::Scalar; 3] {
    if radius == V::Scalar::ZERO {
        return [V::Scalar::ZERO; 3];
    }
    let (mut direction, mut radius, mut squared) = (direction, radius, direction.length_squared());
    if !is_comfortable(squared) {
        // Of a unit direction, and once for its length.
        let Some(e) = direction.unit() else { return [V::Scalar::ZERO; 3] };
        (radius, direction, squared) = (radius / direction.norm(), e, e.length_squared());
    }
    let across = |change: V| change - direction * (change.dot(direction) / squared);
    let (u, w) = (across(changes[0]), across(changes[1]));
    let bend = radius / squared.sqrt();
    [u.dot(u) * bend, u.dot(w) * bend, w.dot(w) * bend]
}
