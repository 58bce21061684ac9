//! The one search for the distance or depth of two bodies.
//!
//! All questions about two bodies at rest take parts of one answer, so that they cannot contradict one another. The
//! search has three means, in this order, and ends at the first that answers the question: GJK on the cores, a second
//! measurement [near contact](near), which decides whether bodies overlap, and for a [depth](depth) an expanding
//! polytope. For a depth, the closed form for two boxes comes before them. A plain distance needs no more than this
//! file and GJK.

mod apart;
mod cores;
#[cfg(feature = "alloc")]
mod depth;
mod distances;
mod near;

use convex_support::numerics::bound::least;
use convex_support::{Core, Parallelotope, Scalar, Vector};
use num_traits::Float as _;

use crate::body::PointPair;
use crate::gjk::{End, Gjk, slack};
use crate::observer::Observer;
use crate::pair::{Pair, Shapes};
use crate::{Status, SubAlgorithm};
pub(crate) use apart::{Enough, FirstSearch, direct};
pub(crate) use cores::Cores;
pub(crate) use distances::MAX_DEPTH_ITERATIONS;
pub use distances::{Distance, SignedDistance, SignedDistanceOptions};
pub(crate) use near::{FromContact, NearContact, ProjectedFace, Uncertainty, across_corners};
pub(crate) use near::{in_double, look_after, near_contact_of, room_within};

/// The question about two bodies, and when the search may stop.
pub(crate) struct Wanted<V: Vector> {
    pub(crate) of_overlap: OfOverlap,
    /// Where to begin and when to stop. Options of the depth only count if it is sought.
    pub(crate) options: SignedDistanceOptions<V>,
    /// How wide a bracket on the distance may stay, relative to it.
    pub(crate) tolerance: V::Scalar,
    pub(crate) sub_algorithm: SubAlgorithm,
    pub(crate) rare: Option<&'static RareInDistances<V>>,
}

/// What a lean distance leaves out: the second and the third means of the search. Without them the answer is that of
/// GJK.
#[allow(clippy::type_complexity, reason = "the type is written once")]
pub(crate) struct RareInDistances<V: Vector> {
    look_near: fn(&mut Cores<'_, V>, &Wanted<V>, Option<&Gjk<V>>) -> bool,
    pub(crate) in_double: fn(&dyn Shapes<Vector = V>, [&Core<V>; 2], &PointPair<V>) -> Option<SignedDistance<V>>,
    /// The depth, where it is asked for.
    reach_closely: Option<fn(&mut Cores<'_, V>, &Wanted<V>, &mut Gjk<V>, End, &mut Observer<'_, V>) -> Separation<V>>,
}

impl<V: Vector> RareInDistances<V> {
    pub(crate) const TABLE: Self = Self {
        look_near: |cores, wanted, state| cores.look_near(wanted, state),
        in_double: |shapes, cores, points| in_double(shapes, cores, points),
        reach_closely: None,
    };
}

/// The question about bodies that overlap.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum OfOverlap {
    /// Only whether they do.
    Known,
    Depth,
    /// The depth, and near contact only as exactly as the search itself gives it.
    RoughDepth,
}

impl<V: Vector> Wanted<V> {
    #[inline(always)]
    pub(crate) fn new(
        of_overlap: OfOverlap,
        options: SignedDistanceOptions<V>,
        rare: Option<&'static RareInDistances<V>>,
    ) -> Self {
        Self { of_overlap, options, tolerance: Scalar::ZERO, sub_algorithm: SubAlgorithm::Regions, rare }
    }

    /// Whether there is a further question about bodies that overlap.
    #[inline(always)]
    fn is_depth(&self) -> bool {
        self.of_overlap != OfOverlap::Known
    }

    /// Whether the search is the one of any query.
    fn is_plain(&self) -> bool {
        !self.is_depth()
            && self.options.axis.is_none()
            && self.sub_algorithm == SubAlgorithm::Regions
            && !(self.tolerance > Scalar::ZERO)
    }

    /// The same question for the search of any query.
    fn plain(&self) -> Self {
        Self::new(self.of_overlap, SignedDistanceOptions { axis: None, ..self.options }, self.rare)
    }
}

/// The result about the cores; lengths in their unit.
pub(crate) struct Separation<V: Vector> {
    /// The unit vector out of their difference from one closest point to the other, and the difference's support value
    /// along it: minus their signed distance, or infinity if they certainly overlap and no depth was asked for.
    u: V,
    depth: V::Scalar,
    /// Bounds on the depth.
    inner: V::Scalar,
    outer: V::Scalar,
    /// The unit vector into the difference across which a plane proves the outer one.
    pub(crate) axis: V,
    points: PointPair<V>,
    /// Whether the bodies have a point in common, to its own error, if the depth does not tell.
    overlap: Option<bool>,
    pub(crate) status: Status,
    pub(crate) unexpanded: usize,
}

/// What is known before the search for a separation.
pub(crate) enum Begun<'s, V: Vector> {
    Nothing,
    /// The cores of two boxes without radii that may overlap.
    Boxes(&'s [Parallelotope<V>; 2]),
    /// The state of a [first search](FirstSearch::run), and how it ended.
    Searched(&'s mut Gjk<V>, End),
}

/// The depth of two boxes, if it has a closed form. Of other cores those are peeled that overlapped in the last frame:
/// they do so still, if no plane across its normal tells them apart.
#[cfg(feature = "alloc")]
#[inline(always)]
fn known_before_search<V: Vector>(
    cores: &mut Cores<'_, V>,
    begun: &Begun<'_, V>,
    axis: Option<V>,
) -> Option<Separation<V>> {
    if let Begun::Boxes(parts) = begun
        && let Some(known) = cores.closed_form(parts, axis)
        && known.inner > Scalar::ZERO
    {
        return Some(Separation::of_closed_form(known));
    }
    let is_warm = axis.and_then(|axis| axis.unit()).is_some_and(|axis| cores.reaches_beyond(-axis));
    if is_warm {
        let _ = cores.peel();
    }
    None
}

/// The separation of two cores, and their depth. Both are compiled once for all callers, so that a program without
/// depths has no code for them.
#[inline(never)]
pub(crate) fn separation<V: Vector, const IS_DEPTH: bool>(
    cores: &mut Cores<'_, V>,
    wanted: &Wanted<V>,
    begun: Begun<'_, V>,
    observer: &mut Observer<'_, V>,
) -> Separation<V> {
    debug_assert_eq!(IS_DEPTH, wanted.is_depth(), "the constant must agree with the wanted answer");
    let (options, rare) = (&wanted.options, wanted.rare);
    let tells_all = |cores: &mut Cores<'_, V>, state: Option<&Gjk<V>>| {
        rare.is_some_and(|rare| (rare.look_near)(cores, wanted, state))
    };
    let (mut closest, mut is_near) = (None, false);
    let mut first;
    let (state, end) = if let Begun::Searched(state, end) = begun {
        cores.iterations += state.iterations;
        (state, end)
    } else {
        #[cfg(feature = "alloc")]
        if IS_DEPTH && let Some(known) = known_before_search(cores, &begun, options.axis) {
            return known;
        }
        closest = cores.closest_points();
        // If the closest points are known, there is nothing to search near contact.
        is_near = closest.is_some_and(|(_, v)| cores.is_near(v.length()));
        if is_near
            && tells_all(cores, None)
            && let Some(near) = &cores.near
        {
            return Separation::of_near_contact(cores, near);
        }
        first = cores.first_state(options.axis);
        let end = cores.approach(wanted, &mut first, closest, observer);
        (&mut first, end)
    };
    is_near |= closest.is_none() && cores.are_near(state);
    // Where support points alone made no progress, a distance is measured again, however far apart the bodies are.
    let is_stalled = !IS_DEPTH && end == End::Stalled && state.length.is_finite();
    is_near |= is_stalled;
    if is_near && !IS_DEPTH && rare.is_some() && !wanted.is_plain() {
        // Where rounding decides, it has to decide alike wherever a query begins.
        return separation::<V, IS_DEPTH>(cores, &wanted.plain(), Begun::Nothing, observer);
    }
    if is_near
        && (closest.is_none() || is_stalled)
        && tells_all(cores, Some(state))
        && let Some(near) = &cores.near
    {
        return Separation::of_near_contact(cores, near).with_best_plane(cores, state);
    }
    let is_known = if IS_DEPTH {
        end == End::Separated && cores.is_well_apart(state.length)
    } else {
        end != End::Stalled && !(is_near && rare.is_none())
    };
    if !is_known && let Some(reach) = rare.and_then(|rare| rare.reach_closely) {
        return reach(cores, wanted, state, end, observer);
    }
    let mut known = Separation::of_gjk(cores, state, end);
    let is_full = end == End::Overlap && state.simplex.points().len() > V::DIM;
    if IS_DEPTH {
        if !is_known && is_full {
            known.inner = known.inner.max(room_within(state.simplex.points(), |_| cores.greatest_error()));
        }
    } else {
        // A simplex of full dimension certainly has zero inside, or a second measurement would have been made.
        if is_known && is_full {
            (known.depth, known.inner) = (V::Scalar::infinity(), Scalar::ZERO);
        }
        known.overlap = (end != End::Stalled).then_some(end == End::Overlap);
    }
    // If no plane keeps the cores apart, they can be measured more exactly.
    if !is_known && end != End::Separated {
        known.status = Status::Stalled;
    }
    known
}

impl<V: Vector> Separation<V> {
    #[inline(always)]
    fn of_gjk(cores: &Cores<'_, V>, state: &mut Gjk<V>, end: End) -> Self {
        let MetPoint { points, reached, .. } = MetPoint::new(cores, state);
        // From one closest point to the other; or across the best plane, if rounding may have made up that vector, or
        // rounded bodies overlap: the vector between their cores is short then, and leans by the rounding.
        let is_apart = state.length * cores.scale() > cores.radius();
        let direction = if is_apart && state.length > cores.noise() { state.normal } else { state.axis };
        let n = direction.unit().or_else(|| state.normal.unit()).unwrap_or_else(|| V::axis(0));
        let plane = cores.best_plane(state);
        Self {
            u: -n,
            depth: -state.length,
            inner: -reached,
            outer: plane.map_or(V::Scalar::infinity(), |(outer, _)| outer),
            axis: plane.map_or(n, |(_, axis)| axis),
            points,
            overlap: None,
            status: end.status(),
            unexpanded: 0,
        }
    }

    /// Whether the points of the bodies are apart across a plane, by its axis into the difference and the lower bound
    /// that it proves: if it keeps the bodies apart, or else to rounding. Of ways out that are equally short, another
    /// plane may end another one.
    pub(super) fn lies_across(&self, axis: V, lower: V::Scalar, cores: &Cores<'_, V>) -> bool {
        lower > Scalar::ZERO || (self.u + axis).norm() * self.value(cores).abs() <= cores.noise() * cores.scale()
    }

    /// The signed distance of the bodies along the normal, in the world's unit, as it is measured.
    #[inline(always)]
    pub(crate) fn value(&self, cores: &Cores<'_, V>) -> V::Scalar {
        cores.gap(self.depth)
    }

    /// Bounds on it, with the axis of the plane that proves the lower one.
    #[inline(always)]
    pub(crate) fn bounds(&self, cores: &Cores<'_, V>) -> (V::Scalar, V::Scalar, V) {
        let (scale, radius) = (cores.scale(), cores.radius());
        let (lower, upper) = (cores.gap(self.outer), cores.gap(self.inner));
        // A product with the unit may be subnormal.
        let lost = |length: V::Scalar| if length == Scalar::ZERO { length } else { least() };
        let lower = lower - (slack(lower, radius) + lost(self.outer));
        let upper = upper + (slack(upper, radius) + lost(self.inner));
        // A measurement near contact needs no slack.
        match &cores.near {
            Some(near) => {
                let by_look = near.lower * scale - lost(near.lower);
                let is_better = by_look > lower && self.lies_across(near.normal, by_look, cores);
                let (lower, axis) = if is_better { (by_look, near.normal) } else { (lower, self.axis) };
                (lower, upper.min(near.upper * scale + lost(near.upper)), axis)
            }
            None => (lower, upper, self.axis),
        }
    }

    /// The points of both bodies at the ends of the way out.
    #[inline(always)]
    pub(crate) fn ends(&self, cores: &Cores<'_, V>) -> [V; 2] {
        let (PointPair { a, b }, scale, [from, to]) = (self.points, cores.scale(), cores.radii);
        let Pair { core_a, core_b, .. } = &cores.pair;
        [core_a.origin + a * scale + self.u * from, core_b.origin + b * scale - self.u * to]
    }

    /// The distance, which is zero if the bodies overlap.
    #[inline]
    pub(crate) fn distance(&self, cores: &Cores<'_, V>, wanted: &Wanted<V>) -> Distance<V> {
        let zero = V::Scalar::ZERO;
        let (signed_lower, upper, axis) = self.bounds(cores);
        // The support points of an invalid shape may contradict one another, or be no numbers: nothing is known.
        let is_bounded = signed_lower <= upper && upper.is_finite();
        let (lower, upper) = match is_bounded {
            true if self.inner >= zero => (zero, zero),
            true => (signed_lower.max(zero), upper.max(zero)),
            false => (zero, V::Scalar::infinity()),
        };
        let (allowed, three) = (cores.frame.widest(), V::Scalar::from_f64(3.0));
        let enough = Enough { width: allowed, tolerance: wanted.tolerance, limit: wanted.options.limit };
        let value = self.value(cores);
        // Bodies touch if their points are as near as their error, and a second measurement that was not cut short has
        // not found a plane between them.
        let is_cut_short = self.status == Status::IterationLimit || cores.iterations >= wanted.options.max_iterations;
        let is_decided =
            lower > zero || upper <= zero || cores.near.is_some() && !is_cut_short && value * three <= allowed;
        let status = match is_bounded && enough.is(lower, upper) && is_decided {
            true => Status::Converged,
            false if is_cut_short => Status::IterationLimit,
            false => Status::Stalled,
        };
        let is_met = upper <= zero || status == Status::Converged || self.overlap.unwrap_or(value <= zero);
        let overlap = is_met && !(lower > zero);
        let is_deep = overlap && !(value >= -upper);
        let separates = signed_lower >= -allowed;
        let [point_a, point_b] = if overlap { self.common_points(cores) } else { self.ends(cores) };
        Distance {
            distance: value.max(lower).min(upper),
            lower,
            upper,
            overlap,
            point_a,
            point_b,
            normal: if separates && !is_deep { Some(axis) } else { None },
            status,
            iterations: cores.iterations,
        }
    }

    /// Points of both bodies that coincide but for rounding: between the points of their cores, which are no farther
    /// apart than both radii.
    fn common_points(&self, cores: &Cores<'_, V>) -> [V; 2] {
        let (scale, radius, Pair { core_a, core_b, .. }) = (cores.scale(), cores.radius(), &cores.pair);
        let (a, b) = (core_a.origin + self.points.a * scale, core_b.origin + self.points.b * scale);
        // Without radii the cores themselves meet.
        if radius <= Scalar::ZERO {
            return [a, b];
        }
        let v = a - b;
        let share = |of: V::Scalar| v * (of / radius).min(Scalar::ONE);
        [a - share(cores.radii[0]), b + share(cores.radii[1])]
    }
}

/// The point of the difference next to zero of those that GJK knows. Where cores are well in one another nothing asks
/// for it.
#[derive(Clone, Copy, Debug)]
pub(super) struct MetPoint<V: Vector> {
    pub(super) point: V,
    /// The points of both cores that it is made of.
    pub(super) points: PointPair<V>,
    /// Zero is certain to be no farther from the difference than this.
    pub(super) reached: V::Scalar,
}

impl<V: Vector> MetPoint<V> {
    #[inline(never)]
    pub(super) fn new(cores: &Cores<'_, V>, state: &mut Gjk<V>) -> Self {
        state.ensure_measured();
        let (points, sum) = (state.simplex.weighted_witness(), state.simplex.weight());
        let point = state.simplex.weighted_point() / sum;
        let is_known = state.length.is_finite() && sum > V::Scalar::ZERO;
        Self { point, points, reached: if is_known { cores.greatest_length(point) } else { V::Scalar::infinity() } }
    }
}
