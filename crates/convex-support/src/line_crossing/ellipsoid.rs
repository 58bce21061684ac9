//! Ellipsoids.

use super::ball::ball;
use super::{Crossing, LineCrossing};
use crate::{Ellipsoid, Matrix, Scalar, Vector};

/// In the coordinates where the ellipsoid is the unit ball; a normal `n` there is along `R·(n/a)` here.
impl<V: Vector> LineCrossing for Ellipsoid<V> {
    #[inline(always)]
    fn line_crossing(&self, source: V, direction: V) -> Option<Crossing<V>> {
        let inverse = self.inverse_semi_axes();
        let local = self.axes().transpose_mul(source - self.center()) * inverse;
        let along = self.axes().transpose_mul(direction) * inverse;
        let crossing = ball(V::Scalar::ONE, local, along)?;
        let normal = self.axes() * (crossing.normal * inverse).unit().unwrap_or(crossing.normal);
        Some(Crossing { normal, ..crossing })
    }
}
