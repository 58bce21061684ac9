//! Ellipsoids.

use super::Crossing;
use super::ball::ball;
use crate::{Matrix, Scalar, Vector};

/// In the coordinates where the ellipsoid is the unit ball; a normal `n` there is along `R·(n/a)` here.
#[inline(always)]
pub(crate) fn ellipsoid<V: Vector>(
    axes: &V::Matrix,
    inverse_semi_axes: V,
    source: V,
    direction: V,
) -> Option<Crossing<V>> {
    let local = axes.transpose_mul(source) * inverse_semi_axes;
    let along = axes.transpose_mul(direction) * inverse_semi_axes;
    let crossing = ball(V::Scalar::ONE, local, along)?;
    let normal = *axes * (crossing.normal * inverse_semi_axes).unit().unwrap_or(crossing.normal);
    Some(Crossing { normal, ..crossing })
}
