//! What a measurement near contact says of the separation of two bodies.

use convex_support::Vector;

use super::{NearContact, near_contact};
use crate::Status;
use crate::body::PointPair;
use crate::gjk::{Frame, Gjk};
use crate::pair::Pair;
use crate::separation::cores::Cores;
use crate::separation::{OfOverlap, Separation, Wanted};

impl<V: Vector> Separation<V> {
    /// By a measurement near contact. The points of the surfaces are between those of the cores, from which the plane
    /// may lean by the root of the rounding.
    #[cold]
    pub(crate) fn of_near_contact(cores: &Cores<'_, V>, near: &NearContact<V>) -> Self {
        let &NearContact { ref frame, points, normal, gap, lower, upper, .. } = near;
        let between = (points.a - points.b + frame.offset).unit().unwrap_or(normal);
        // Both cores may have lost their rolling balls, which are in their radii then.
        let Pair { core_a, core_b, .. } = &cores.pair;
        let aside = |whole: V::Scalar, part: V::Scalar| (normal * part - between * whole) * frame.per_unit;
        let radius = cores.radius() * frame.per_unit;
        Self {
            u: -normal,
            depth: -gap - radius,
            inner: -upper - radius,
            outer: -lower - radius,
            axis: normal,
            points: PointPair {
                a: points.a + aside(core_a.radius, cores.radii[0]),
                b: points.b - aside(core_b.radius, cores.radii[1]),
            },
            overlap: Some(near.overlap() == Some(true)),
            status: Status::Converged,
            unexpanded: 0,
        }
    }

    /// The same with the plane of the measurement near contact, and then GJK's best one, if they prove more and have
    /// the points across them.
    #[cold]
    pub(crate) fn with_best_plane(mut self, cores: &Cores<'_, V>, state: &Gjk<V>) -> Self {
        let Some(near) = &cores.near else { return self };
        let radius = cores.radius() * near.frame.per_unit;
        let by_near = (-near.lower - radius, near.normal);
        for (outer, axis) in [by_near].into_iter().chain(cores.best_plane(state)) {
            // NaN is no bound.
            if outer < self.outer && self.lies_across(axis, cores.gap(outer), cores) {
                (self.outer, self.axis) = (outer, axis);
            }
        }
        self
    }
}

impl<V: Vector> Cores<'_, V> {
    /// Measures bodies near contact once more, perhaps after a search. Whether this is final.
    pub(crate) fn look_near(&mut self, wanted: &Wanted<V>, state: Option<&Gjk<V>>) -> bool {
        if wanted.of_overlap == OfOverlap::RoughDepth {
            return false;
        }
        // A search that ended at the limit might have gone on.
        let limit = self.frame.between_cores(wanted.options.limit) + self.frame.error;
        let begun = state.filter(|state| wanted.is_plain() && !(state.lower > limit));
        let before = begun.map_or(0, |state| state.iterations);
        let left = before + wanted.options.max_iterations.saturating_sub(self.iterations);
        // The cores may have lost their rolling balls, which are in their radii then.
        let frame = Frame { radius: self.pair.radius() * self.frame.per_unit, ..self.frame };
        let size = self.size * self.frame.scale;
        let peeled = core::mem::take(&mut self.pair.peeled);
        self.near = near_contact(&mut self.pair, &frame, size, begun, left, true);
        self.pair.peeled = peeled;
        let Some(near) = &self.near else { return false };
        self.iterations += near.iterations.saturating_sub(before);
        // No depth is asked of a distance, which ends here.
        !wanted.is_depth() || near.is_closed()
    }
}
