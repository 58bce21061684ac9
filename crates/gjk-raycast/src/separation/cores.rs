//! The difference of two cores: its support points, their errors, and the result of GJK on it.

use convex_support::numerics::twofold::lost_in_sum;
use convex_support::{Core, Scalar, Vector};
use num_traits::Float as _;

use super::near_contact::{NEAR, NearContact, is_near_contact, near_contact};
use super::uncertainty::{Uncertainty, error_of_points};
use super::{OfOverlap, Wanted};
use crate::body::{AnyPair, Pair, PointPair, Shapes, TracedSupport as _};
use crate::boxes::Zonotope;
use crate::gjk::{End, Frame, Gjk, GjkOptions, first_direction, gjk};
use crate::observer::Observer;
use crate::symmetric::Symmetric;
use crate::unit::lost_to_underflow;

/// If the boundary is smooth, a way ends at the support point to within the square root of this part of its length.
const SMOOTH: f64 = 1e-3;

/// The cosine of the angle between a facet's normal and the way out, below which the normal leans towards the way.
const NEAR_BY: f64 = 0.9;

/// The part of the way from a facet's normal to the way out by which the normal leans, for facets with a corner where
/// the way ends. With the whole of it, or with some of it at others, ellipsoids take more support points.
const LEAN: f64 = 0.8;

/// A support point of the difference, and its points of both cores.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex<V> {
    pub(crate) point: V,
    /// The direction it was found along.
    pub(super) along: V,
    pub(super) pair: PointPair<V>,
}

/// A plane that supports the difference, by the support point, which knows the outward unit normal that it was found
/// along.
#[derive(Clone, Copy, Debug)]
pub(super) struct WayOut<V: Vector> {
    /// The support value along it, which is negative where its plane separates the cores.
    pub(super) h: V::Scalar,
    pub(super) vertex: Vertex<V>,
}

impl<V: Vector> WayOut<V> {
    pub(super) fn new(vertex: Vertex<V>) -> Self {
        Self { h: vertex.along.dot(vertex.point), vertex }
    }

    /// The unit vector out of the difference.
    pub(super) fn u(&self) -> V {
        self.vertex.along
    }

    /// From the support point to the end of the way, along the plane.
    pub(super) fn rest(&self) -> V {
        self.u() * self.h - self.vertex.point
    }

    /// The unit normal of a facet with these corners, leaned towards the way if that ends at one of them and at a
    /// smooth place.
    ///
    /// At a distance `x` from such a place, the ball of radius `h` about zero is `x²·(1/h − 1/R)/2` below the boundary
    /// of `K`, whose radius of curvature is `R`, and a facet of size `s` at most `s²/8R`. So the facets that the proof
    /// needs may grow in proportion to `x`. The support point along a facet's normal is above its middle, and halves
    /// it; one nearer to the way leaves a larger facet outside, so that fewer lie between the way and the first facets.
    /// To second order a support point is beyond the facet if it is within the circle through its corners, whose centre
    /// the normal leads to. Where the way ends at a corner, all of the way towards it is.
    pub(super) fn leaned(&self, normal: V, corners: &[V]) -> V {
        let (u, point) = (self.u(), self.vertex.point);
        let aside = self.rest().length_squared();
        let is_smooth = aside < self.h * self.h * V::Scalar::from_f64(SMOOTH);
        if !(is_smooth && normal.dot(u) > V::Scalar::from_f64(NEAR_BY) && corners.contains(&point)) {
            return normal;
        }
        (normal + (u - normal) * V::Scalar::from_f64(LEAN)).unit().unwrap_or(normal)
    }
}

/// The difference `K = K_A − K_B` of two cores relative to zero, in units of a power of two near its size.
pub(crate) struct Cores<'a, V: Vector> {
    pub(super) pair: AnyPair<'a, V>,
    /// The radii of both bodies around their cores, in the world's unit.
    pub(super) radii: [V::Scalar; 2],
    frame: Frame<V>,
    /// The sizes of both cores, their radii and their offset, in the unit.
    pub(super) size: V::Scalar,
    /// The rounding of removing the balls from the cores.
    peeled_error: V::Scalar,
    /// A bound on the error of points of the difference, as a length, in the unit.
    error: V::Scalar,
    /// The same coordinate by coordinate; `None` as long as the length suffices.
    uncertainty: Option<Uncertainty<V>>,
    /// What the offset of the origins has lost, if that is asked.
    lost_in_offset: V,
    /// The second measurement of both bodies near contact.
    pub(super) near: Option<NearContact<V>>,
    /// The support points computed.
    pub(crate) iterations: usize,
}

/// The depth of cores, or minus their distance, in closed form, in the unit.
pub(super) struct ClosedForm<V: Vector> {
    /// The unit vector out of their difference.
    pub(super) u: V,
    pub(super) depth: V::Scalar,
    /// Bounds on the depth.
    pub(super) inner: V::Scalar,
    pub(super) outer: V::Scalar,
    pub(super) points: PointPair<V>,
}

impl<'a, V: Vector> Cores<'a, V> {
    #[inline(always)]
    pub(crate) fn new(shapes: &'a (dyn Shapes<Vector = V> + 'a), cores: [&'a Core<V>; 2]) -> Self {
        let mut pair = Pair::new(shapes, cores);
        let offset = pair.core_a.origin - pair.core_b.origin;
        let size = pair.size(offset);
        let radii = [pair.core_a.radius, pair.core_b.radius];
        let frame = Frame::new(&mut pair, offset, size);
        let error = error_of_points(&pair, size) * frame.per_unit + lost_to_underflow(frame.scale);
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

    /// Whether bodies whose cores are so far apart are nearer to contact than a few errors.
    #[inline(always)]
    pub(super) fn is_near(&self, length: V::Scalar) -> bool {
        (length - self.frame.radius).abs() < self.frame.error * Scalar::from_f64(NEAR)
    }

    /// The same for the result of a search.
    pub(super) fn are_near(&self, state: &mut Gjk<V>) -> bool {
        // Rounded bodies whose cores overlap are in deep overlap.
        let is_full = state.simplex.points().len() > V::DIM;
        let are_deep = is_full && self.frame.radius > self.frame.error * Scalar::from_f64(NEAR);
        !are_deep && is_near_contact(state, &self.frame)
    }

    /// Measures bodies near contact once more, perhaps after a search. Whether this is final.
    pub(super) fn look_near(&mut self, wanted: &Wanted<V>, state: Option<&Gjk<V>>) -> bool {
        if wanted.of_overlap == OfOverlap::RoughDepth {
            return false;
        }
        // A search that ended at the limit might have gone on.
        let limit = self.limit(wanted) + self.frame.error;
        let begun = state.filter(|state| wanted.is_plain() && !(state.lower > limit));
        let before = begun.map_or(0, |state| state.iterations);
        let left = before + wanted.options.max_iterations.saturating_sub(self.iterations);
        // The cores may have lost their rolling balls, which are in their radii then.
        let frame = Frame { radius: self.pair.radius() * self.frame.per_unit, ..self.frame };
        let size = self.size * self.frame.scale;
        let peeled = core::mem::take(&mut self.pair.peeled);
        self.near = near_contact(&mut self.pair, &frame, size, begun, left);
        self.pair.peeled = peeled;
        let Some(near) = &self.near else { return false };
        self.iterations += near.iterations.saturating_sub(before);
        if wanted.is_depth() { near.is_closed() } else { near.is_settled() }
    }

    /// Whether the present error suffices for cores at this distance: it is small beside the distance, and beside the
    /// distance without the radii.
    pub(super) fn is_well_apart(&self, length: V::Scalar) -> bool {
        let gap = (length - self.frame.radius).abs();
        length.min(gap) > self.greatest_error() * Scalar::from_f64(NEAR)
    }

    /// Makes the cores smaller by the balls that roll within them, which become a part of their radii; whether there
    /// are any.
    ///
    /// Cores that overlap by less than those radii are apart then, and their depth is a distance.
    pub(super) fn peel(&mut self) -> bool {
        let Pair { core_a, core_b, .. } = &self.pair;
        let radii = [core_a.rolling_radius, core_b.rolling_radius];
        let sum = radii[0] + radii[1];
        if !(sum > Scalar::ZERO && sum.is_finite()) {
            return false;
        }
        for (whole, radius) in self.radii.iter_mut().zip(radii) {
            *whole += radius;
        }
        let per_unit = self.frame.per_unit;
        self.pair.peeled = radii.map(|radius| radius * per_unit);
        self.frame.radius = self.radius() * per_unit;
        // The unit vector is right to 6 roundings and the product to one; a sum of radii loses one more.
        self.peeled_error = self.frame.radius * (V::Scalar::EPSILON * Scalar::from_f64(4.0));
        true
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
    pub(super) fn enough(&self, tolerance: V::Scalar, lower: V::Scalar) -> V::Scalar {
        let may_overlap = self.is_curved() && !(lower > Scalar::ZERO);
        let part = if may_overlap { tolerance.max(Scalar::ZERO) } else { Scalar::ZERO };
        (self.frame.error * Scalar::from_f64(6.0) + self.size * part) * self.scale()
    }

    /// The signed distance of bodies whose cores are so deep in one another, in the world's unit.
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

    /// Whether the difference extends beyond zero along a direction.
    pub(super) fn reaches_beyond(&mut self, direction: V) -> bool {
        self.is_curved() && self.support(direction).is_some_and(|vertex| direction.dot(vertex.point) > Scalar::ZERO)
    }

    /// The entries `u·Hu`, `u·Hw`, `w·Hw` of the Hessian of the support value at a direction.
    pub(super) fn hessian(&self, direction: V, changes: [V; 2]) -> Symmetric<V::Scalar> {
        self.pair.hessian(direction, changes)
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

    /// How wide the bracket on a distance may be at most that rounding alone has left, in the world's unit: the bounds
    /// that end a search differ by the noise, and each is wrong by no more than the error.
    #[inline(always)]
    pub(super) fn widest(&self) -> V::Scalar {
        self.frame.error * self.frame.scale * Scalar::from_f64(3.0)
    }

    /// What GJK moves points by as it compares them.
    pub(super) fn noise(&self) -> V::Scalar {
        self.frame.noise
    }

    /// How wide a bracket on the depth along `n` rounding leaves.
    #[inline]
    pub(super) fn rounding_along(&self, n: V) -> V::Scalar {
        self.error_along(n) * Scalar::from_f64(2.0)
    }

    /// The way out of two parallelotopes that certainly overlap; a plane across `axis`, or across their offset, may
    /// tell them apart at once.
    #[inline(always)]
    pub(super) fn closed_form(&mut self, axis: Option<V>) -> Option<ClosedForm<V>> {
        let reach = self.pair.extent() * self.frame.per_unit;
        if self.frame.offset.length_squared() > reach * reach {
            // Balls about the cores are apart.
            return None;
        }
        let parts = self.pair.parallelotopes()?;
        let Frame { offset, per_unit, .. } = self.frame;
        let zonotope = Zonotope::new(&parts, offset, per_unit);
        if zonotope.is_beyond(axis.unwrap_or(offset)) {
            return None;
        }
        let nearest = zonotope.nearest_facet::<V>()?;
        // Computed in double precision, of edges and an offset that are wrong by what the shapes say.
        self.sharpen();
        let stated = self.uncertainty.as_ref()?.stated_length;
        // The length is right to a few ulps.
        let error = stated + self.lost_in_offset.norm() * Scalar::from_f64(1.01);
        let half_ulp = V::Scalar::EPSILON * Scalar::from_f64(0.5 * nearest.depth);
        let [depth, inner, outer] = [nearest.depth, nearest.inner, nearest.outer].map(Scalar::from_f64);
        let error = error + half_ulp;
        let points = nearest.points(&parts, offset, per_unit);
        Some(ClosedForm { u: nearest.unit(), depth, inner: inner - error, outer: outer + error, points })
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
        let points = self.pair.closest_points(offset * scale, self.size * scale)?;
        Some((points, points.a - points.b + offset))
    }

    /// How far apart the cores are of bodies that are as far apart as is asked for.
    fn limit(&self, wanted: &Wanted<V>) -> V::Scalar {
        wanted.options.limit * self.frame.per_unit + self.frame.radius
    }

    /// GJK, from the closest points where they are known, until what is wanted of the distance of the cores is known,
    /// or they meet to rounding: of those who ask for the depth even where the radii overlap. The shortest vector is
    /// measured, unless it is no vector, since zero is within a simplex of full dimension.
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
            limit: self.limit(wanted),
            tolerance: wanted.tolerance,
            sub_algorithm: wanted.sub_algorithm,
            ..GjkOptions::new(state.normal, wanted.options.max_iterations.saturating_sub(self.iterations))
        };
        let end = gjk(state, &mut self.pair, frame, options, None, observer);
        if end != End::Overlap || state.simplex.points().len() <= V::DIM {
            state.ensure_measured();
        }
        self.iterations += state.iterations;
        end
    }

    /// The point of the difference nearest to a `target`, as seen from there: that of the face with these corners, and
    /// where it is farther than rounding, the one that GJK comes to from there.
    pub(super) fn nearest_to(
        &mut self,
        target: V,
        corners: impl Iterator<Item = Vertex<V>>,
        max_iterations: usize,
    ) -> Gjk<V> {
        let mut state = Gjk::new(target);
        for Vertex { point, along, pair } in corners {
            state.simplex.push(point - target, along, pair);
        }
        state.ensure_measured();
        let max_iterations = max_iterations.saturating_sub(self.iterations);
        if state.length > self.frame.noise && max_iterations > 0 {
            // A sixteenth of the noise is as near as a point can be told to be.
            let Frame { offset, noise, .. } = self.frame;
            let noise = noise * Scalar::from_f64(0.0625);
            let frame = Frame { offset: offset - target, radius: Scalar::ZERO, noise, ..self.frame };
            let options = GjkOptions::new(state.normal, max_iterations);
            let _ = gjk(&mut state, &mut self.pair, frame, options, None, &mut Observer::none());
            state.ensure_measured();
            self.iterations += state.iterations;
        }
        state
    }
}
