//! The signed distance of two shapes: how far apart, or how deep in one another.

use convex_support::numerics::bound::least;
use convex_support::{Core, Scalar, SupportMap, Vector};
use num_traits::Float as _;

use super::cores::{ClosedForm, Cores, slack};
use super::direct::direct;
use super::expansion::{Expanded, expand};
use super::met::Met;
use super::witness::Ends;
use super::{SignedDistance, SignedDistanceOptions};
use crate::body::{Both, Pair, PointPair, Shapes};
use crate::compiled_once::compiled_once;
use crate::gjk::{End, Gjk, NearContact};
use crate::observer::Observer;
use crate::shape::Shape;
use crate::{Iterate, Status};

/// How far apart two shapes are, or how deep in one another, and which way out is the shortest.
///
/// ```
/// use convex_support::{Cuboid, Posed, glam::DVec3};
/// use gjk_raycast::{SignedDistanceOptions, signed_distance};
///
/// // A box of half extent 0.5 has sunk 0.1 into the floor.
/// let floor = Cuboid::new(DVec3::new(50.0, 1.0, 50.0))?;
/// let parcel = Posed::translated(Cuboid::new(DVec3::splat(0.5))?, DVec3::new(3.0, 1.4, 0.0))?;
/// let answer = signed_distance(&parcel, &floor, SignedDistanceOptions::default());
/// assert!((answer.signed_distance + 0.1).abs() < 1e-15);
/// assert!(answer.lower <= answer.signed_distance && answer.signed_distance <= answer.upper);
/// assert_eq!(answer.normal, DVec3::Y); // the parcel leaves upwards
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
///
/// With `C = A − B` and its support value `h`, the signed distance is `−min h(u)` over all unit vectors `u`, and the
/// normal is `−u`. If the shapes are apart, zero is outside `C`, and this is the distance of the farthest plane that
/// separates zero from `C`. If they overlap, zero is inside, and it is minus the distance of the nearest plane that
/// supports `C`. Where the cores are apart, GJK finds both as the distance of the cores, less the radii. Where the
/// cores overlap, an [expanding polytope](SignedDistance::unexpanded) proves that no way out is shorter than the one
/// found; for two boxes the depth has a closed form.
// Left to the compiler, it is a call in some programs, in which a ball and a box take half as long again.
#[inline(always)]
pub fn signed_distance<A, B>(a: &A, b: &B, options: SignedDistanceOptions<A::Vector>) -> SignedDistance<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    watched(a, b, options, &mut Observer::none())
}

/// [`signed_distance`], showing an observer every iterate: those of [`distance`](crate::distance) as long as the cores
/// may be apart. After that the simplex is the facet nearest to zero, `v` its foot, `w` the support point along its
/// normal or between that and the best way out, and the bounds are those of the signed distance of the cores.
#[inline(always)]
pub fn signed_distance_with<A, B>(
    a: &A,
    b: &B,
    options: SignedDistanceOptions<A::Vector>,
    mut observer: impl FnMut(Iterate<'_, A::Vector>),
) -> SignedDistance<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    watched(a, b, options, &mut Observer::new(&mut observer))
}

#[inline(always)]
fn watched<A, B>(
    a: &A,
    b: &B,
    options: SignedDistanceOptions<A::Vector>,
    observer: &mut Observer<'_, A::Vector>,
) -> SignedDistance<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    let shapes = Both::<_, _>::new(a, b);
    let parts = shapes.cores();
    direct(&shapes, parts, options.max_iterations, observer)
        .unwrap_or_else(|| by_search(&shapes, parts, options, observer))
}

compiled_once! {
    /// The signed distance by a search.
    fn by_search<V>(
        shapes: &dyn Shapes<Vector = V>,
        parts: [Core<V>; 2],
        options: SignedDistanceOptions<V>,
        observer: &mut Observer<'_, V>,
    ) -> SignedDistance<V> {
        let mut cores = Cores::new(shapes, parts);
        reach(&mut cores, options, true, observer).answer(&cores)
    }
}

/// [`signed_distance`], and the unit vector from `b` to `a` of the plane that proves its lower bound. Near contact it
/// is known to what the search itself leaves, since a search in time looks again a moment later.
#[inline]
pub(crate) fn signed_distance_and_axis<V: Vector>(
    shapes: &dyn Shapes<Vector = V>,
    options: SignedDistanceOptions<V>,
) -> (SignedDistance<V>, V) {
    let parts = shapes.cores();
    if let Some(answer) = direct(shapes, parts, options.max_iterations, &mut Observer::none()) {
        return (answer, answer.normal);
    }
    let mut cores = Cores::new(shapes, parts);
    let reached = reach(&mut cores, options, false, &mut Observer::none());
    (reached.answer(&cores), reached.axis)
}

/// [`signed_distance`] of shapes behind pointers: compiled once for all that rarely ask it.
#[cold]
#[inline(never)]
pub(crate) fn signed_distance_of_any<V: Vector>(
    a: Shape<'_, V>,
    b: Shape<'_, V>,
    options: SignedDistanceOptions<V>,
) -> SignedDistance<V> {
    signed_distance(a, b, options)
}

/// What can be known of the cores; near contact by a look of its own, if that is asked for.
#[inline(always)]
fn reach<V: Vector>(
    cores: &mut Cores<'_, V>,
    options: SignedDistanceOptions<V>,
    looks_near: bool,
    observer: &mut Observer<'_, V>,
) -> Reached<V> {
    // Rounded cores are mostly apart, which takes a search to know.
    let is_rounded = cores.radius() > Scalar::ZERO;
    if !is_rounded
        && let Some(known) = cores.closed_form(options.axis)
        && known.inner > Scalar::ZERO
    {
        return Reached::of_closed_form(known);
    }
    // Cores that overlapped in the last frame do so still, if no plane across its normal tells them apart.
    let is_warm = options.axis.and_then(|axis| axis.unit()).is_some_and(|axis| cores.reaches_beyond(-axis));
    let is_peeled = is_warm && cores.peel();
    let mut state = cores.first_state(&options);
    let end = cores.approach(&options, &mut state, observer);
    if looks_near && let Some(known) = cores.look_near(&mut state, options.max_iterations) {
        return Reached::of_near_contact(cores, &known);
    }
    if end == End::Separated && cores.is_well_apart(state.length) {
        return Reached::of_gjk(cores, &mut state, end);
    }
    reach_closely(cores, options, &mut state, end, is_peeled, observer)
}

/// What can be known of cores that overlap or nearly touch, after a search for the points that are closest.
#[inline(never)]
fn reach_closely<V: Vector>(
    cores: &mut Cores<'_, V>,
    options: SignedDistanceOptions<V>,
    state: &mut Gjk<V>,
    mut end: End,
    is_peeled: bool,
    observer: &mut Observer<'_, V>,
) -> Reached<V> {
    let is_rounded = !is_peeled && cores.radius() > Scalar::ZERO;
    if is_rounded
        && end == End::Overlap
        && let Some(known) = cores.closed_form(options.axis)
    {
        return Reached::of_closed_form(known);
    }
    // Half of what may be asked for is left for a second run.
    let may_repeat = end == End::Overlap && state.length.is_finite() && 2 * state.iterations < options.max_iterations;
    if may_repeat && !is_peeled && cores.peel() {
        *state = cores.first_state(&options);
        end = cores.approach(&options, state, observer);
    }
    if !cores.is_well_apart(state.length) {
        cores.sharpen();
    }
    let is_apart = end == End::Separated || !state.length.is_finite();
    let expanded = if is_apart { None } else { expand(cores, state, &options, observer) };
    match expanded {
        Some(expanded) => Reached::of_expansion(cores, &expanded, state, end),
        None => {
            let known = Reached::of_gjk(cores, state, end);
            Reached { status: if is_apart { known.status } else { Status::Stalled }, ..known }
        }
    }
}

/// What is known of the cores; lengths in their unit.
struct Reached<V: Vector> {
    /// The unit vector out of their difference, and how far that reaches along it: minus their signed distance.
    u: V,
    depth: V::Scalar,
    /// Bounds on the depth.
    inner: V::Scalar,
    outer: V::Scalar,
    /// The unit vector into the difference across which a plane proves the outer one.
    axis: V,
    points: PointPair<V>,
    status: Status,
    unexpanded: usize,
}

impl<V: Vector> Reached<V> {
    /// By GJK alone.
    #[inline(always)]
    fn of_gjk(cores: &Cores<'_, V>, state: &mut Gjk<V>, end: End) -> Self {
        let Met { points, reached, .. } = Met::new(cores, state);
        // Across the face that the closest points are on; where rounding may have made that up, across the best plane.
        let direction = if state.length > cores.noise() { state.normal } else { state.axis };
        let n = direction.unit().or_else(|| state.normal.unit()).unwrap_or_else(|| V::axis(0));
        let plane = cores.best_plane(state);
        Self {
            u: -n,
            depth: -state.length,
            inner: -reached,
            outer: plane.map_or(V::Scalar::infinity(), |(outer, _)| outer),
            axis: plane.map_or(n, |(_, axis)| axis),
            points,
            status: end.status(),
            unexpanded: 0,
        }
    }

    /// By a look near contact. The points of the surfaces are between those of the cores, from which the plane may lean
    /// by the root of the rounding.
    #[cold]
    fn of_near_contact(cores: &Cores<'_, V>, near: &NearContact<V>) -> Self {
        let &NearContact { ref frame, points, normal, gap, lower, upper, .. } = near;
        let between = (points.a - points.b + frame.offset).unit().unwrap_or(normal);
        // Both cores may be without balls, which are in their radii then.
        let Pair { core_a, core_b, .. } = &cores.pair;
        let [from, to] = &cores.parts;
        let aside = |whole: V::Scalar, part: V::Scalar| (normal * part - between * whole) * frame.per_unit;
        let radius = cores.radius() * frame.per_unit;
        Self {
            u: -normal,
            depth: -gap - radius,
            inner: -upper - radius,
            outer: -lower - radius,
            axis: normal,
            points: PointPair {
                a: points.a + aside(core_a.radius, from.radius),
                b: points.b - aside(core_b.radius, to.radius),
            },
            status: Status::Converged,
            unexpanded: 0,
        }
    }

    /// In closed form.
    fn of_closed_form(ClosedForm { u, depth, inner, outer, points }: ClosedForm<V>) -> Self {
        Self { u, depth, inner, outer, axis: -u, points, status: Status::Converged, unexpanded: 0 }
    }

    /// By an expansion, after GJK had come to an end.
    #[inline]
    fn of_expansion(cores: &Cores<'_, V>, expanded: &Expanded<V>, state: &mut Gjk<V>, end: End) -> Self {
        let &Expanded { way, ends, inner, status, unexpanded } = expanded;
        let by_way = way.h + cores.error_along(way.u());
        // NaN is no bound.
        let plane = cores.best_plane(state).filter(|(outer, _)| *outer <= by_way);
        let (outer, axis) = plane.unwrap_or((by_way, -way.u()));
        // Where the cores turn out to be apart, GJK's points are nearer than those of a facet.
        if way.h < Scalar::ZERO && end != End::Overlap {
            return Self { outer, axis, ..Self::of_gjk(cores, state, end) };
        }
        let Ends { u, depth, points } = ends;
        Self { u, depth, inner, outer, axis, points, status, unexpanded }
    }

    /// The answer in the world's unit, with the radii.
    #[inline]
    fn answer(&self, cores: &Cores<'_, V>) -> SignedDistance<V> {
        let scale = cores.scale();
        let [a, b] = &cores.parts;
        let radius = cores.radius();
        let world = |depth: V::Scalar| -(depth * scale) - radius;
        let (lower, upper) = (world(self.outer), world(self.inner));
        // A product with the unit may be subnormal.
        let outwards = |bound| slack(bound, radius) + least();
        let (lower, upper) = (lower - outwards(lower), upper + outwards(upper));
        // What is known near contact is known without the slack.
        let (lower, upper, is_narrow) = match &cores.near {
            Some(near) => {
                let (lower, upper) = (lower.max(near.lower * scale - least()), upper.min(near.upper * scale + least()));
                (lower, upper, upper - lower <= near.frame.error * (scale + scale))
            }
            None => (lower, upper, false),
        };
        // Numbers that are not finite, or contradict one another, are of a support map that is none, and bound nothing.
        let is_bounded = lower.is_finite() && upper.is_finite() && lower <= upper;
        let infinity = V::Scalar::infinity();
        let (lower, upper) = if is_bounded { (lower, upper) } else { (-infinity, infinity) };
        let status = match self.status {
            Status::Converged if !is_bounded => Status::Stalled,
            Status::Stalled if is_bounded && is_narrow => Status::Converged,
            status => status,
        };
        let signed_distance = world(self.depth).max(lower).min(upper);
        SignedDistance {
            signed_distance,
            lower,
            upper,
            normal: -self.u,
            point_a: a.origin + self.points.a * scale + self.u * a.radius,
            point_b: b.origin + self.points.b * scale - self.u * b.radius,
            overlap: signed_distance <= V::Scalar::ZERO,
            status,
            iterations: cores.iterations,
            unexpanded: self.unexpanded,
        }
    }
}
