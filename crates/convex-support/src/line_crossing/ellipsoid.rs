//! Where a line is in an ellipsoid: in the unit ball, in the coordinates that make it one.

use super::ball::ball;
use super::{Crossed, Crossing};
use crate::{Matrix, Scalar, Vector};

/// In the coordinates where the ellipsoid is the unit ball; a normal `n` there is along `R·(n/a)` here.
#[inline(always)]
pub(crate) fn ellipsoid<V: Vector>(axes: &V::Matrix, inverse_semi_axes: V, source: V, direction: V) -> Crossed<V> {
    let local = axes.transpose_mul(source) * inverse_semi_axes;
    let along = axes.transpose_mul(direction) * inverse_semi_axes;
    match ball(V::Scalar::ONE, local, along) {
        Ok(crossing) => {
            let normal = *axes * (crossing.normal * inverse_semi_axes).unit().unwrap_or(crossing.normal);
            Ok(Crossing { normal, ..crossing })
        }
        Err(axis) => Err(*axes * (axis * inverse_semi_axes)),
    }
}
