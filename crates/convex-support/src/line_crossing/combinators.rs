//! Poses, affine maps and roundings pass the capability through.

use super::{Crossing, LineCrossing, RoundedLineCrossing};
use crate::{Affine, Matrix, Posed, Rounded, ScalarOf, Vector};

impl<S: LineCrossing> LineCrossing for Posed<S> {
    #[inline(always)]
    fn line_crossing(&self, source: S::Vector, direction: S::Vector) -> Option<Crossing<S::Vector>> {
        let rotation = self.rotation();
        let local = rotation.transpose_mul(source - self.translation());
        let crossing = self.shape().line_crossing(local, rotation.transpose_mul(direction))?;
        Some(Crossing { normal: rotation * crossing.normal, ..crossing })
    }
}

/// Where the matrix is singular the image is flat, a line meets it in at most a point or along itself, and the answer is
/// `None`.
impl<S: LineCrossing> LineCrossing for Affine<S> {
    #[inline(always)]
    fn line_crossing(&self, source: S::Vector, direction: S::Vector) -> Option<Crossing<S::Vector>> {
        let inverse = self.inverse()?;
        let local = inverse * (source - self.translation());
        let crossing = self.shape().line_crossing(local, inverse * direction)?;
        let normal = inverse.transpose_mul(crossing.normal);
        Some(Crossing { normal: normal.unit().unwrap_or(normal), ..crossing })
    }
}

impl<S: RoundedLineCrossing> LineCrossing for Rounded<S> {
    #[inline(always)]
    fn line_crossing(&self, source: S::Vector, direction: S::Vector) -> Option<Crossing<S::Vector>> {
        self.shape().rounded_line_crossing(self.rounding(), source, direction)
    }
}

impl<S: RoundedLineCrossing> RoundedLineCrossing for Posed<S> {
    #[inline(always)]
    fn rounded_line_crossing(
        &self,
        radius: ScalarOf<S>,
        source: S::Vector,
        direction: S::Vector,
    ) -> Option<Crossing<S::Vector>> {
        let rotation = self.rotation();
        let local = rotation.transpose_mul(source - self.translation());
        let direction = rotation.transpose_mul(direction);
        let crossing = self.shape().rounded_line_crossing(radius, local, direction)?;
        Some(Crossing { normal: rotation * crossing.normal, ..crossing })
    }
}

impl<S: RoundedLineCrossing> RoundedLineCrossing for Rounded<S> {
    #[inline(always)]
    fn rounded_line_crossing(
        &self,
        radius: ScalarOf<S>,
        source: S::Vector,
        direction: S::Vector,
    ) -> Option<Crossing<S::Vector>> {
        self.shape().rounded_line_crossing(self.rounding() + radius, source, direction)
    }
}
