//! The difference of two cores: its support points, their errors, and the result of GJK on it.

use convex_support::numerics::twofold::lost_in_sum;
use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::Wanted;
use super::apart::{FirstSearch, measured};
use super::near::{NearContact, Uncertainty};
use crate::body::{PointPair, TracedSupport as _};
use crate::gjk::{End, Frame, Gjk, GjkOptions, NEAR, first_direction};
use crate::observer::Observer;
use crate::pair::{AnyPair, Pair};

/// A support point of the difference, and its points of both cores.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex<V> {
    pub(crate) point: V,
    /// The direction it was found along.
    pub(super) along: V,
    pub(super) pair: PointPair<V>,
}

/// The difference `K = K_A − K_B` of two cores relative to zero, in units of a power of two near its size.
pub(crate) struct Cores<'a, V: Vector> {
    pub(super) pair: AnyPair<'a, V>,
    /// The radii of both bodies around their cores, in the world's unit.
    pub(super) radii: [V::Scalar; 2],
    pub(super) frame: Frame<V>,
    /// The sizes of both cores, their radii and their offset, in the unit.
    pub(super) size: V::Scalar,
    /// The rounding of removing the balls from the cores.
    pub(super) peeled_error: V::Scalar,
    /// A bound on the error of points of the difference, as a length, in the unit.
    error: V::Scalar,
    /// The same coordinate by coordinate; `None` as long as the length suffices.
    pub(super) uncertainty: Option<Uncertainty<V>>,
    /// What the offset of the origins has lost, if that is asked.
    pub(super) lost_in_offset: V,
    /// The second measurement of both bodies near contact.
    pub(super) near: Option<NearContact<V>>,
    /// The support points computed.
    pub(crate) iterations: usize,
}

impl<'a, V: Vector> Cores<'a, V> {
    #[inline(always)]
    pub(crate) fn new(search: FirstSearch<'a, V>) -> Self {
        let error = search.error();
        let FirstSearch { pair, frame, size } = search;
        let radii = [pair.core_a.radius, pair.core_b.radius];
        let (zero, lost_in_offset, size) = (Scalar::ZERO, V::ZERO, size * frame.per_unit);
        Self {
            pair,
            radii,
            frame,
            size,
            peeled_error: zero,
            error,
            uncertainty: None,
            lost_in_offset,
            near: None,
            iterations: 0,
        }
    }

    /// Gets the errors of the shapes' points, coordinate by coordinate, which takes longer than many a distance. For a
    /// horizontal floor they do not depend on its width.
    #[inline(never)]
    pub(super) fn sharpen(&mut self) {
        // Nothing is known about numbers out of range, whatever the shapes state.
        if self.uncertainty.is_some() || !self.error.is_finite() {
            return;
        }
        let (Pair { core_a, core_b, .. }, Frame { offset, per_unit, .. }) = (&self.pair, self.frame);
        self.lost_in_offset = lost_in_sum(core_a.origin, -core_b.origin) * per_unit;
        let known = Uncertainty::new(&self.pair, per_unit).of_sums(offset);
        self.uncertainty = Some(known.with(self.lost_in_offset.abs()));
    }

    /// Whether bodies are within a few errors of contact, if the distance of their cores is `length`.
    #[inline(always)]
    pub(super) fn is_near(&self, length: V::Scalar) -> bool {
        (length - self.frame.radius).abs() < self.frame.error * Scalar::from_f64(NEAR)
    }

    /// The same for the result of a search.
    pub(super) fn are_near(&self, state: &mut Gjk<V>) -> bool {
        // Rounded bodies whose cores overlap are in deep overlap.
        let is_full = state.simplex.points().len() > V::DIM;
        let are_deep = is_full && self.frame.radius > self.frame.error * Scalar::from_f64(NEAR);
        !are_deep && state.is_near_contact(&self.frame)
    }

    /// Whether the present error suffices for cores at this distance: it is small beside the distance, and beside the
    /// distance without the radii.
    pub(super) fn is_well_apart(&self, length: V::Scalar) -> bool {
        let gap = (length - self.frame.radius).abs();
        length.min(gap) > self.greatest_error() * Scalar::from_f64(NEAR)
    }

    #[inline(always)]
    pub(super) fn is_peeled(&self) -> bool {
        self.pair.peeled != [Scalar::ZERO; 2]
    }

    /// The factor from lengths in the unit to the world's.
    pub(crate) fn scale(&self) -> V::Scalar {
        self.frame.scale
    }

    /// The radii of both, in the world's unit.
    pub(crate) fn radius(&self) -> V::Scalar {
        self.radii[0] + self.radii[1]
    }

    /// The width of the bracket that [converged](crate::SignedDistance::status) promises of a signed distance that is
    /// no less than `lower`, in the world's unit.
    ///
    /// Rounding takes no more than 5.5 errors: an expansion goes on while the bounds are two apart, both are widened by
    /// one, and by the rounding of the radii and the sum with them, which is three quarters of one.
    pub(crate) fn enough(&self, tolerance: V::Scalar, lower: V::Scalar) -> V::Scalar {
        let may_overlap = self.is_curved() && !(lower > Scalar::ZERO);
        let part = if may_overlap { tolerance.max(Scalar::ZERO) } else { Scalar::ZERO };
        (self.frame.error * Scalar::from_f64(6.0) + self.size * part) * self.scale()
    }

    /// The signed distance of the bodies, in the world's unit, if the depth of their cores is `depth`. The depth of
    /// cores that are apart is minus their distance.
    #[inline(always)]
    pub(super) fn gap(&self, depth: V::Scalar) -> V::Scalar {
        -(depth * self.scale()) - self.radius()
    }

    /// The support point along a direction; `None` if it is not finite.
    #[inline]
    pub(crate) fn support(&mut self, direction: V) -> Option<Vertex<V>> {
        self.iterations += 1;
        let (point, pair) = self.pair.support(direction);
        let point = point + self.frame.offset;
        point.is_finite().then_some(Vertex { point, along: direction, pair })
    }

    /// GJK's best plane: an upper bound on how far the difference extends beyond zero, and the unit vector across it
    /// into the difference.
    #[inline]
    pub(super) fn best_plane(&self, state: &Gjk<V>) -> Option<(V::Scalar, V)> {
        state.axis.unit().map(|n| (self.error_along(n) - state.lower, n))
    }

    /// Whether the support point may move without jumping.
    pub(super) fn is_curved(&self) -> bool {
        self.pair.is_curved()
    }

    /// A bound on the error of `n·p`, for a unit vector `n` and a point `p` of the difference; and on how much a
    /// support point along `n` falls short of the support value.
    #[inline]
    pub(super) fn error_along(&self, n: V) -> V::Scalar {
        self.uncertainty.as_ref().map_or(self.error, |known| known.along(n)) + self.peeled_error
    }

    /// A bound on [`error_along`](Self::error_along) in any direction.
    pub(super) fn greatest_error(&self) -> V::Scalar {
        self.uncertainty.as_ref().map_or(self.error, Uncertainty::length) + self.peeled_error
    }

    /// A bound on the length of what a point `p` of the difference stands for.
    #[inline(always)]
    pub(super) fn greatest_length(&self, p: V) -> V::Scalar {
        p.norm() + self.uncertainty.as_ref().map_or(self.error, |known| known.beyond(p)) + self.peeled_error
    }

    /// What GJK moves points by as it compares them.
    pub(super) fn noise(&self) -> V::Scalar {
        self.frame.noise
    }

    /// GJK before its first step, along an axis if there is one.
    #[inline(always)]
    pub(super) fn first_state(&self, axis: Option<V>) -> Gjk<V> {
        Gjk::new(first_direction(axis, self.frame.offset))
    }

    /// The closest points of the cores, where those are known in closed form, and the vector between them.
    #[inline(always)]
    pub(super) fn closest_points(&self) -> Option<(PointPair<V>, V)> {
        let Frame { offset, scale, .. } = self.frame;
        if self.is_peeled() {
            return None;
        }
        let points = self.pair.closest_points_for_search(offset * scale, self.size * scale)?;
        Some((points, points.a - points.b + offset))
    }

    /// GJK on the cores, from their closest points where these are known, until their distance is known as well as is
    /// wanted. The search also ends where the bodies meet to rounding. But where the depth is wanted, bodies whose
    /// radii overlap have it by the distance of their cores, so that only cores which meet end the search.
    #[inline]
    pub(super) fn approach(
        &mut self,
        wanted: &Wanted<V>,
        state: &mut Gjk<V>,
        closest: Option<(PointPair<V>, V)>,
        observer: &mut Observer<'_, V>,
    ) -> End {
        let radius = if wanted.is_depth() { Scalar::ZERO } else { self.frame.radius };
        let frame = Frame { radius, ..self.frame };
        if let Some((points, v)) = closest
            && state.begin_at(v, points, &frame)
        {
            return End::Overlap;
        }
        let options = GjkOptions {
            limit: self.frame.between_cores(wanted.options.limit),
            tolerance: wanted.tolerance,
            sub_algorithm: wanted.sub_algorithm,
            ..GjkOptions::new(state.normal, wanted.options.max_iterations.saturating_sub(self.iterations))
        };
        let end = measured(state, &mut self.pair, frame, options, observer);
        self.iterations += state.iterations;
        end
    }
}
