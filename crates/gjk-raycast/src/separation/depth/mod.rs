//! The third means of the search: the depth of cores that overlap.
//!
//! For two parallelotopes it has a closed form. Of other cores the balls that roll within them are removed first, since
//! the depth of those that are apart then is a distance; of what overlaps still, the expanding polytope finds the
//! shortest way out.

mod boundary;
mod expansion;
mod newton;
mod witness;

use convex_support::{Parallelotope, Scalar, Vector};
use num_traits::Float as _;

use super::cores::{Cores, Vertex};
use super::{OfOverlap, RareInDistances, Separation, Wanted};
use crate::Status;
use crate::body::{PointPair, TracedSupport as _};
use crate::boxes::Zonotope;
use crate::gjk::{End, Frame, Gjk, GjkOptions, gjk};
use crate::observer::Observer;
use crate::pair::Pair;
use crate::symmetric::Symmetric;
use expansion::{Expanded, expand};
use witness::Ends;

/// If the boundary is smooth, a way ends at the support point to within the square root of this part of its length.
const SMOOTH: f64 = 1e-3;

/// The cosine of the angle between a facet's normal and the way out, below which the normal leans towards the way.
const NEAR_BY: f64 = 0.9;

/// The part of the way from a facet's normal to the way out by which the normal leans, for facets with a corner where
/// the way ends. With the whole of it, or with some of it at others, ellipsoids take more support points.
const LEAN: f64 = 0.8;

impl<V: Vector> RareInDistances<V> {
    /// All means of a search for depths.
    pub(crate) const WITH_DEPTH: Self = Self { reach_closely: Some(reach_closely), ..Self::TABLE };
}

/// The separation of cores that overlap or nearly touch, after a search for their closest points.
#[inline(never)]
fn reach_closely<V: Vector>(
    cores: &mut Cores<'_, V>,
    wanted: &Wanted<V>,
    state: &mut Gjk<V>,
    mut end: End,
    observer: &mut Observer<'_, V>,
) -> Separation<V> {
    let options = &wanted.options;
    let is_rounded = !cores.is_peeled() && cores.radius() > Scalar::ZERO;
    let is_deep = is_rounded && end == End::Overlap;
    let parts = if is_deep { cores.pair.parallelotopes_within_reach(cores.frame.offset) } else { None };
    let known = if let Some(known) = parts.and_then(|parts| cores.closed_form(&parts, options.axis)) {
        Separation::of_closed_form(known)
    } else {
        // Half of the allowed support points is left for a second run.
        let may_repeat =
            end == End::Overlap && state.length.is_finite() && 2 * state.iterations < options.max_iterations;
        if may_repeat && !cores.is_peeled() && cores.peel() {
            *state = cores.first_state(options.axis);
            let wanted = Wanted::new(OfOverlap::Depth, *options, wanted.rare);
            end = cores.approach(&wanted, state, None, observer);
        }
        if !cores.is_well_apart(state.length) {
            cores.sharpen();
        }
        let is_apart = end == End::Separated || !state.length.is_finite();
        let expanded = if is_apart { None } else { expand(cores, state, options, observer) };
        // If the cores are apart after all, GJK's points are nearer than those of a facet.
        let leads_out = |expanded: &&Expanded<V>| end == End::Overlap || !(expanded.way.h < Scalar::ZERO);
        let known = match expanded.as_ref().filter(leads_out) {
            Some(expanded) => Separation::of_expansion(expanded),
            None => {
                let by_gjk = Separation::of_gjk(cores, state, end);
                // A look near contact that has left more than its errors between the bounds may still know the gap
                // better. If bodies that overlap are apart without their rolling balls, it only knows that they meet.
                let near = cores.near.as_ref().filter(|near| is_apart && near.gap.is_finite());
                let is_narrower =
                    |by_look: &Separation<V>| !(by_gjk.outer - by_gjk.inner <= by_look.outer - by_look.inner);
                // However the search ended, the width tells what the look was worth.
                let by_look = near.map(|near| Separation::of_near_contact(cores, near)).filter(is_narrower);
                by_look.map_or(by_gjk, |by_look| Separation { status: end.status(), ..by_look })
            }
        };
        match expanded {
            Some(Expanded { way, .. }) => known.up_to(cores, state, way),
            None if is_apart => known,
            None => Separation { status: Status::Stalled, ..known },
        }
    };
    if cores.near.is_some() { known.with_best_plane(cores, state) } else { known }
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

impl<V: Vector> Separation<V> {
    pub(super) fn of_closed_form(ClosedForm { u, depth, inner, outer, points }: ClosedForm<V>) -> Self {
        Self { u, depth, inner, outer, axis: -u, points, overlap: None, status: Status::Converged, unexpanded: 0 }
    }

    /// By the ends of the way out that an expansion has found.
    fn of_expansion(
        &Expanded { way, ends: Ends { u, depth, points }, inner, status, unexpanded }: &Expanded<V>,
    ) -> Self {
        Self { u, depth, inner, outer: way.h, axis: -way.u(), points, overlap: None, status, unexpanded }
    }

    /// The same with the nearer one of the plane that ends a way out and the best one that GJK has come to.
    fn up_to(self, cores: &Cores<'_, V>, state: &mut Gjk<V>, way: WayOut<V>) -> Self {
        let by_way = way.h + cores.error_along(way.u());
        // NaN is no bound.
        let plane = cores.best_plane(state);
        let plane = plane.filter(|&(outer, n)| outer <= by_way && self.lies_across(n, cores.gap(outer), cores));
        let (outer, axis) = plane.unwrap_or((by_way, -way.u()));
        Self { outer, axis, ..self }
    }
}

impl<V: Vector> Cores<'_, V> {
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

    /// Whether the difference extends beyond zero along a direction.
    pub(super) fn reaches_beyond(&mut self, direction: V) -> bool {
        self.is_curved() && self.support(direction).is_some_and(|vertex| direction.dot(vertex.point) > Scalar::ZERO)
    }

    /// The entries `u·Hu`, `u·Hw`, `w·Hw` of the Hessian of the support value at a direction.
    pub(super) fn hessian(&self, direction: V, changes: [V; 2]) -> Symmetric<V::Scalar> {
        self.pair.hessian(direction, changes)
    }

    /// How wide a bracket on the depth along `n` rounding leaves.
    #[inline]
    pub(super) fn rounding_along(&self, n: V) -> V::Scalar {
        self.error_along(n) * Scalar::from_f64(2.0)
    }

    /// The way out of two parallelotopes that certainly overlap; a plane across `axis`, or across their offset, may
    /// tell them apart at once.
    #[inline(always)]
    pub(super) fn closed_form(&mut self, parts: &[Parallelotope<V>; 2], axis: Option<V>) -> Option<ClosedForm<V>> {
        let Frame { offset, per_unit, .. } = self.frame;
        let zonotope = Zonotope::new(parts, offset, per_unit);
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
        let points = nearest.points(parts, offset, per_unit);
        Some(ClosedForm { u: nearest.unit(), depth, inner: inner - error, outer: outer + error, points })
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
