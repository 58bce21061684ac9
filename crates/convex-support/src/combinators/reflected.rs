//! A shape mirrored through zero.

use crate::support::ScalarOf;
use crate::{
    CertainCrossing, Close, CloseLine, Core, CrossedByLine, Feature, Hint, LineCrossing, LineQuery, Parallelotope,
    Rounding, SupportMap, Vector,
};

/// The set `−C = { −x : x ∈ C }`: the second term of a difference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reflected<S>(pub(super) S);

impl<S: SupportMap> SupportMap for Reflected<S> {
    type Vector = S::Vector;

    #[inline(always)]
    fn support(&self, direction: S::Vector) -> S::Vector {
        -self.0.support(-direction)
    }

    #[inline(always)]
    fn core(&self) -> Core<S::Vector> {
        let core = self.0.core();
        Core { origin: -core.origin, kind: core.kind.image(|v| -v, Vector::ZERO), ..core }
    }

    #[inline(always)]
    fn core_support(&self, direction: S::Vector, hint: &mut Hint) -> S::Vector {
        -self.0.core_support(-direction, hint)
    }

    #[inline(always)]
    fn core_support_hessian(&self, direction: S::Vector, changes: [S::Vector; 2]) -> [ScalarOf<S>; 3] {
        self.0.core_support_hessian(-direction, changes)
    }

    #[inline(always)]
    fn core_closest_point(&self, x: S::Vector) -> Option<S::Vector> {
        self.0.core_closest_point(-x).map(|closest| -closest)
    }

    #[inline(always)]
    fn certain_crossing(&self, line: LineQuery<S::Vector>) -> Option<CertainCrossing<S::Vector>> {
        let line = LineQuery { source: -line.source, direction: -line.direction, ..line };
        Some(self.0.certain_crossing(line)?.with_normal(|n| -n))
    }

    fn close_crossing(&self, line: &CloseLine) -> Close {
        Some(self.0.close_crossing(&line.reflected())?.with_normal(|n| -n))
    }

    fn core_support_feature(&self, direction: S::Vector, slab: ScalarOf<S>, feature: &mut Feature<S::Vector>) {
        self.0.core_support_feature(-direction, slab, feature);
        feature.map(|point| -point);
    }

    #[inline]
    fn core_parallelotope(&self) -> Option<Parallelotope<S::Vector>> {
        let parallelotope = self.0.core_parallelotope()?;
        Some(Parallelotope { center: -parallelotope.center, ..parallelotope })
    }

    #[inline]
    fn rounding(&self) -> Rounding<S::Vector> {
        self.0.rounding()
    }
}

impl<S: CrossedByLine> CrossedByLine for Reflected<S> {
    #[inline(always)]
    fn core_line_crossing(
        &self,
        source: S::Vector,
        direction: S::Vector,
        radius: ScalarOf<S>,
    ) -> LineCrossing<S::Vector> {
        self.0.core_line_crossing(-source, -direction, radius).with_normal(|n| -n)
    }
}
