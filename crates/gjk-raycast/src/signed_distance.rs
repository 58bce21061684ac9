//! The signed distance of two shapes: how far apart they are, as for `distance`; or how deep they overlap, in closed
//! form for boxes and by an expanding polytope for others.

use convex_support::{Core, Scalar, SupportMap, Vector, compiled_once};
use num_traits::Float as _;

use crate::body::TracedSupport as _;
use crate::gjk::{Gjk, GjkOptions, first_direction};
use crate::observer::Observer;
use crate::pair::{Both, Shape, Shapes};
use crate::separation::{
    Begun, Cores, Enough, FirstSearch, OfOverlap, RareInDistances, Separation, Wanted, direct, separation,
};
use crate::{Iterate, SignedDistance, SignedDistanceOptions, Status};

/// The distance of two shapes, or minus their depth if they overlap, with the shortest way out.
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
/// supports `C`. If the cores are apart, GJK finds both as the distance of the cores, less the radii. If the cores
/// overlap, an [expanding polytope](SignedDistance::unexpanded) proves that no way out is shorter than the one found;
/// for two boxes the depth has a closed form.
// Left to the compiler, it is a call in some programs, in which a ball and a box take half as long again.
#[doc(alias("penetration_depth", "epa", "mpr", "expanding_polytope", "minimum_translation", "interference"))]
#[inline(always)]
pub fn signed_distance<A, B>(a: &A, b: &B, options: SignedDistanceOptions<A::Vector>) -> SignedDistance<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    watched(a, b, options, &mut Observer::none())
}

/// [`signed_distance`] with an observer that sees every iterate. While the cores may be apart, the iterates are those
/// of [`distance`](crate::distance). After that the simplex is the facet nearest to zero, `v` is the projection of
/// zero on it, `w` the support point along its normal or between that normal and the best way out, and the bounds are
/// those of the signed distance of the cores.
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
fn watched<A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized>(
    a: &A,
    b: &B,
    options: SignedDistanceOptions<A::Vector>,
    observer: &mut Observer<'_, A::Vector>,
) -> SignedDistance<A::Vector> {
    let shapes = Both::<_, _>::new(a, b);
    let cores = shapes.cores();
    direct(&shapes, cores, options.max_iterations, observer, |cores, points| {
        (RareInDistances::WITH_DEPTH.in_double)(&shapes, cores, points)
    })
    .unwrap_or_else(|| {
        // In variables of their own, so that the closed form has them in registers.
        let [core_a, core_b] = cores;
        let (shapes, cores) = shapes.in_order([&core_a, &core_b]);
        by_search(&shapes, cores, shapes.is_swapped, options, observer)
    })
}

compiled_once! {
    /// The signed distance by a search, for shapes that are in order or swapped.
    fn by_search<V>(
        shapes: &dyn Shapes<Vector = V>,
        cores: [&Core<V>; 2],
        is_swapped: bool,
        options: SignedDistanceOptions<V>,
        observer: &mut Observer<'_, V>,
    ) -> SignedDistance<V> {
        let axis = options.axis.map(|axis| if is_swapped { -axis } else { axis });
        let options = SignedDistanceOptions { axis, ..options };
        let wanted = Wanted::new(OfOverlap::Depth, options, Some(&RareInDistances::WITH_DEPTH));
        let mut answer = observer.of_swapped(is_swapped, |observer| searched(shapes, cores, &wanted, observer));
        // In place: a copy would wait until the answer is in the cache.
        if is_swapped {
            answer = answer.reversed();
        }
        answer
    }
}

/// The signed distance of bodies in order, with options that are theirs.
#[inline(always)]
fn searched<V: Vector>(
    shapes: &dyn Shapes<Vector = V>,
    cores: [&Core<V>; 2],
    wanted: &Wanted<V>,
    observer: &mut Observer<'_, V>,
) -> SignedDistance<V> {
    let SignedDistanceOptions { limit, max_iterations, axis, .. } = wanted.options;
    let mut search = FirstSearch::new(shapes, cores);
    // Rounded boxes are mostly apart, which only a search can tell.
    let is_rounded = search.pair.radius() > Scalar::ZERO;
    let boxes = if is_rounded { None } else { search.pair.parallelotopes_within_reach(search.frame.offset) };
    if let Some(boxes) = &boxes {
        return searched_closely(search, Begun::Boxes(boxes), wanted, observer);
    }
    // Curved bodies may be known to overlap by the normal of an earlier answer.
    if axis.is_some() && search.pair.is_curved() {
        return searched_closely(search, Begun::Nothing, wanted, observer);
    }
    let mut state = Gjk::new(first_direction(axis, search.frame.offset));
    let options = GjkOptions { limit, ..GjkOptions::new(state.normal, max_iterations) };
    let Some(end) = search.run(&mut state, Scalar::ZERO, options, observer) else {
        return searched_closely(search, Begun::Nothing, wanted, observer);
    };
    let width = search.frame.widest() * Scalar::from_f64(2.0);
    match search.apart(&state, end, Enough { width, tolerance: Scalar::ZERO, limit }) {
        Some(known) => known,
        None => searched_closely(search, Begun::Searched(&mut state, end), wanted, observer),
    }
}

/// The signed distance of bodies that are not plainly apart, after a first search for it.
#[inline(never)]
fn searched_closely<V: Vector>(
    search: FirstSearch<'_, V>,
    begun: Begun<'_, V>,
    wanted: &Wanted<V>,
    observer: &mut Observer<'_, V>,
) -> SignedDistance<V> {
    let mut cores = Cores::new(search);
    separation::<_, true>(&mut cores, wanted, begun, observer).signed_distance(&cores, wanted)
}

impl<V: Vector> Separation<V> {
    /// The answer to a question about the signed distance.
    #[inline]
    fn signed_distance(&self, cores: &Cores<'_, V>, wanted: &Wanted<V>) -> SignedDistance<V> {
        let (lower, upper, normal) = self.bounds(cores);
        // Numbers that are not finite, or contradict one another, come from an invalid support map, and bound nothing.
        let is_bounded = lower.is_finite() && upper.is_finite() && lower <= upper;
        let infinity = V::Scalar::infinity();
        let (lower, upper) = if is_bounded { (lower, upper) } else { (-infinity, infinity) };
        let SignedDistanceOptions { tolerance, limit, depth_limit, .. } = wanted.options;
        let is_beyond = is_bounded && (lower > limit || -upper > depth_limit);
        // However the search ended, the width tells.
        let status = match self.status {
            _ if is_beyond || upper - lower <= cores.enough(tolerance, lower) => Status::Converged,
            Status::Converged => Status::Stalled,
            status => status,
        };
        let signed_distance = self.value(cores).max(lower).min(upper);
        let [point_a, point_b] = self.ends(cores);
        SignedDistance {
            signed_distance,
            lower,
            upper,
            normal,
            point_a,
            point_b,
            overlap: signed_distance <= V::Scalar::ZERO,
            status,
            iterations: cores.iterations,
            unexpanded: self.unexpanded,
        }
    }
}

/// [`signed_distance`] for searches in time. Of bodies near contact its bounds have the errors of GJK, because it
/// leaves out the second measurement: a search in time asks about the same bodies again a moment later, and needs exact
/// numbers of the last of these times only.
#[inline]
pub(crate) fn rough_signed_distance<V: Vector>(
    shapes: &dyn Shapes<Vector = V>,
    options: SignedDistanceOptions<V>,
    rare: Option<&'static RareInDistances<V>>,
) -> SignedDistance<V> {
    let parts = shapes.cores();
    direct(shapes, parts, options.max_iterations, &mut Observer::none(), |_, _| None).unwrap_or_else(|| {
        let wanted = Wanted::new(OfOverlap::RoughDepth, options, rare);
        searched(shapes, parts.each_ref(), &wanted, &mut Observer::none())
    })
}

/// [`signed_distance`] of shapes behind pointers, compiled once for all callers that need it rarely.
#[cold]
#[inline(never)]
pub(crate) fn signed_distance_of_any<V: Vector>(
    a: Shape<'_, V>,
    b: Shape<'_, V>,
    options: SignedDistanceOptions<V>,
) -> SignedDistance<V> {
    signed_distance(a, b, options)
}
