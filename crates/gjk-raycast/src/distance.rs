//! How far apart two shapes are: by closed forms, or by GJK (the paper's Algorithm 2); near contact, where rounding
//! would decide, by a second measurement. How deep shapes are in one another is another question, `signed_distance`.

use convex_support::numerics::bound::raised;
use convex_support::{Core, Scalar, SupportMap, Vector, compiled_once, compiled_table};
use num_traits::Float as _;

use crate::gjk::{Gjk, GjkOptions, first_direction};
use crate::observer::Observer;
use crate::options::{MAX_ITERATIONS, MayBeLean, Rare, options};
use crate::pair::{Both, Shape, Shapes};
use crate::separation::{Begun, Cores, Enough, FirstSearch, OfOverlap, RareInDistances, Wanted, direct, separation};
use crate::{Distance, Iterate, SignedDistance, SignedDistanceOptions, SubAlgorithm};

/// The distance of two shapes, and their closest points.
///
/// ```
/// use convex_support::{Ball, Cuboid, Posed, glam::DVec3};
/// use gjk_raycast::{DistanceOptions, distance};
///
/// let table = Cuboid::new(DVec3::new(2.0, 0.1, 1.0))?;
/// let ball = Posed::translated(Ball::new(0.25)?, DVec3::new(0.5, 1.0, 0.0))?;
/// let answer = distance(&ball, &table, DistanceOptions::default());
/// assert!((answer.distance - 0.65).abs() < 1e-15);
/// assert!(answer.lower <= answer.distance && answer.distance <= answer.upper);
/// assert_eq!(answer.normal, Some(DVec3::Y)); // from the table to the ball
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
///
/// Two points of the shapes bound the distance from above, and a slab between the shapes bounds it from below. The
/// iteration ends when these bounds meet. If the shapes overlap, the distance is 0, and
/// [`signed_distance`](crate::signed_distance) finds the depth.
///
#[doc(alias("gjk", "closest_points", "clearance", "separation", "gap"))]
#[doc = include_str!("../doc/bracket.svg")]
#[inline]
pub fn distance<A, B>(a: &A, b: &B, options: DistanceOptions<A::Vector>) -> Distance<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    watched(a, b, options, &mut Observer::none())
}

/// [`distance`] with an observer that sees every iterate.
#[inline]
pub fn distance_with<A, B>(
    a: &A,
    b: &B,
    options: DistanceOptions<A::Vector>,
    mut observer: impl FnMut(Iterate<'_, A::Vector>),
) -> Distance<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    watched(a, b, options, &mut Observer::new(&mut observer))
}

/// Options of [`distance`](crate::distance).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct DistanceOptions<V: Vector> {
    /// The width of the bracket at which to stop, relative to the distance. A bracket at the level of rounding,
    /// relative to the size of the shapes and their distance, always ends the iteration. A negative value and NaN are
    /// taken for zero. Default: 0.
    pub tolerance: V::Scalar,
    /// Stop as soon as the distance is certain to exceed this limit; the bracket may then still be wide. NaN is no
    /// limit. Default: infinity.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub limit: V::Scalar,
    /// The iterations after which to give up. Default: 200.
    pub max_iterations: usize,
    /// A first guess of the direction from `b` to `a`, such as the normal of the last answer. Default: none.
    pub axis: Option<V>,
    /// How the closest point of a simplex is found. Default: [`SubAlgorithm::Regions`].
    pub sub_algorithm: SubAlgorithm,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) rare: Rare<Self>,
}

impl<V: Vector> Default for DistanceOptions<V> {
    fn default() -> Self {
        Self { rare: Self::rare(), ..Self::lean() }
    }
}

impl<V: Vector> DistanceOptions<V> {
    /// The default options, with no machine code besides GJK: a program in which all options are lean has a third
    /// of the code for distances.
    ///
    /// The second measurement near contact is left out: of bodies that are apart, or overlap, by no more than a few
    /// roundings of their sizes. There the bracket is as wide as the errors of the largest number in the query, and if
    /// GJK alone does not decide whether they are apart, the status is [`Status::Stalled`](crate::Status::Stalled). All
    /// other answers are the same to the last bit.
    #[must_use]
    pub fn lean() -> Self {
        Self {
            tolerance: V::Scalar::ZERO,
            limit: V::Scalar::infinity(),
            max_iterations: MAX_ITERATIONS,
            axis: None,
            sub_algorithm: SubAlgorithm::Regions,
            rare: Rare(None),
        }
    }
}

impl<V: Vector> MayBeLean for DistanceOptions<V> {
    type Table = RareInDistances<V>;
    const TABLE: Self::Table = RareInDistances::TABLE;

    fn rare() -> Rare<Self> {
        Rare(Some(compiled_table!(RareInDistances<V> of DistanceOptions)))
    }
}

options! {
    DistanceOptions: with_limit(limit: V::Scalar), with_tolerance(tolerance: V::Scalar),
    with_max_iterations(max_iterations: usize), with_axis(axis: V => axis = Some(axis)),
    with_sub_algorithm(sub_algorithm: SubAlgorithm)
}

/// [`distance`] of shapes behind pointers, compiled once for all callers that need it rarely.
#[cold]
#[inline(never)]
pub(crate) fn distance_of_any<V: Vector>(a: Shape<'_, V>, b: Shape<'_, V>, options: DistanceOptions<V>) -> Distance<V> {
    distance(a, b, options)
}

#[inline(always)]
fn watched<A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized>(
    a: &A,
    b: &B,
    options: DistanceOptions<A::Vector>,
    observer: &mut Observer<'_, A::Vector>,
) -> Distance<A::Vector> {
    let shapes = Both::<_, _>::new(a, b);
    let cores = shapes.cores();
    let mut near = None;
    // What is deep is left to the search.
    let known = direct(&shapes, cores, options.max_iterations, observer, |cores, points| {
        near = options.rare.0.and_then(|rare| (rare.in_double)(&shapes, cores, points));
        near
    })
    .filter(|known| !known.overlap);
    if let Some(near) = near.filter(|near| near.upper > Scalar::ZERO) {
        return near_distance(near, cores.map(|core| core.radius));
    }
    if let Some(known) = known {
        return Distance::of_apart(known);
    }
    // In variables of their own, so that the closed form has them in registers.
    let [core_a, core_b] = cores;
    let (shapes, cores) = shapes.in_order([&core_a, &core_b]);
    by_search(&shapes, cores, shapes.is_swapped, options, observer)
}

/// The distance of shapes near contact that are not certain to overlap. If they may touch, their points are moved to
/// where they coincide but for rounding, each by the share of its own radius.
#[inline(never)]
fn near_distance<V: Vector>(near: SignedDistance<V>, [a, b]: [V::Scalar; 2]) -> Distance<V> {
    let SignedDistance { signed_distance, lower, upper, normal, point_a, point_b, status, iterations, .. } = near;
    let zero = V::Scalar::ZERO;
    let overlap = !(lower > zero);
    let between = if overlap { normal * (signed_distance / (a + b)) } else { V::ZERO };
    Distance {
        distance: signed_distance.max(zero),
        lower: lower.max(zero),
        upper,
        overlap,
        point_a: point_a - between * a,
        point_b: point_b + between * b,
        normal: Some(normal),
        status,
        iterations,
    }
}

compiled_once! {
    /// The distance by a search, for shapes that are in order or swapped.
    fn by_search<V>(
        shapes: &dyn Shapes<Vector = V>,
        cores: [&Core<V>; 2],
        is_swapped: bool,
        options: DistanceOptions<V>,
        observer: &mut Observer<'_, V>,
    ) -> Distance<V> {
        let axis = options.axis.map(|axis| if is_swapped { -axis } else { axis });
        // No distance is negative. NaN is no limit.
        let limit = if options.limit < Scalar::ZERO { Scalar::ZERO } else { options.limit };
        let begin = (axis, limit);
        let mut answer = observer.of_swapped(is_swapped, |observer| searched(shapes, cores, begin, &options, observer));
        // In place: a copy would wait until the answer is in the cache.
        if is_swapped {
            answer = answer.reversed();
        }
        answer
    }
}

/// The distance of bodies in order, with their own axis and limit in place of those of the options.
#[inline(always)]
fn searched<V: Vector>(
    shapes: &dyn Shapes<Vector = V>,
    cores: [&Core<V>; 2],
    (axis, limit): (Option<V>, V::Scalar),
    options: &DistanceOptions<V>,
    observer: &mut Observer<'_, V>,
) -> Distance<V> {
    let &DistanceOptions { tolerance, max_iterations, sub_algorithm, .. } = options;
    let mut search = FirstSearch::new(shapes, cores);
    let mut state = Gjk::new(first_direction(axis, search.frame.offset));
    let gjk_options = GjkOptions { limit, tolerance, sub_algorithm, ..GjkOptions::new(state.normal, max_iterations) };
    let touching = search.frame.radius;
    let end = search.run(&mut state, touching, gjk_options, observer);
    let enough = Enough { width: search.frame.widest(), tolerance, limit };
    if let Some(end) = end
        && let Some(known) = search.apart(&state, end, enough)
    {
        return Distance::of_apart(known);
    }
    let begun = end.map_or(Begun::Nothing, |end| Begun::Searched(&mut state, end));
    searched_closely(search, begun, (axis, limit), options, observer)
}

/// The distance of bodies that are not plainly apart, after a first search for it.
#[cold]
#[inline(never)]
fn searched_closely<V: Vector>(
    search: FirstSearch<'_, V>,
    begun: Begun<'_, V>,
    (axis, limit): (Option<V>, V::Scalar),
    &DistanceOptions { tolerance, max_iterations, sub_algorithm, rare, .. }: &DistanceOptions<V>,
    observer: &mut Observer<'_, V>,
) -> Distance<V> {
    // How deep bodies are that certainly overlap is not asked.
    let depth_limit = Scalar::ZERO;
    let of_separation = SignedDistanceOptions { limit, depth_limit, max_iterations, axis, ..Default::default() };
    let wanted = Wanted { tolerance, sub_algorithm, ..Wanted::new(OfOverlap::Known, of_separation, rare.0) };
    let mut cores = Cores::new(search);
    separation::<_, false>(&mut cores, &wanted, begun, observer).distance(&cores, &wanted)
}

/// Calls `ask` with the distance of `a[k]` and `b[k]`, and writes what it returns into `answers[k]`, for each k.
/// Nothing is allocated.
///
/// Each distance is the answer of [`distance`] to the last bit, whatever its neighbours are, so that a table may be
/// cut into parts anywhere. If a list has a single shape, that shape is used for every answer. `ask` chooses what to
/// keep: a number for a column of a data frame, the bracket, or the whole answer.
///
/// ```
/// use convex_support::{Ball, Cuboid, Posed, glam::DVec3};
/// use gjk_raycast::{DistanceOptions, map_distances_into};
///
/// // Columns as a data frame has them: where the balls are, and the distances to be found.
/// let (x, y, z) = ([1.5, 3.0, 0.0], [0.0, 0.0, 2.0], [0.0, 4.0, 0.0]);
/// let mut distances = [0.0; 3];
///
/// let table = Cuboid::new(DVec3::ONE)?;
/// let ball = Ball::new(0.25)?;
/// let balls = [0, 1, 2].map(|k| Posed::translated(ball, DVec3::new(x[k], y[k], z[k])));
/// let [first, second, third] = balls;
/// map_distances_into(
///     &[table],
///     &[first?, second?, third?],
///     DistanceOptions::default(),
///     &mut distances,
///     |d| d.distance,
/// );
///
/// assert_eq!(distances, [0.25, f64::sqrt(13.0) - 0.25, 0.75]);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
///
/// # Panics
/// If a list has neither one shape nor as many as there are answers.
pub fn map_distances_into<A, B, T>(
    a: &[A],
    b: &[B],
    options: DistanceOptions<A::Vector>,
    answers: &mut [T],
    mut ask: impl FnMut(Distance<A::Vector>) -> T,
) where
    A: SupportMap,
    B: SupportMap<Vector = A::Vector>,
{
    let count = answers.len();
    assert!(a.len() == 1 || a.len() == count, "{} shapes a for {count} answers", a.len());
    assert!(b.len() == 1 || b.len() == count, "{} shapes b for {count} answers", b.len());
    for (k, answer) in answers.iter_mut().enumerate() {
        let (a, b) = (&a[if a.len() == 1 { 0 } else { k }], &b[if b.len() == 1 { 0 } else { k }]);
        *answer = ask(distance(a, b, options));
    }
}

/// The changes of a body's pose that certainly leave it farther from another body than a margin, without another
/// query: those in which no point of it goes farther than [`room`](Self::room).
///
/// [`Distance::free_step`] makes it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FreeStep<S> {
    /// How far every point may go: the lower bound of the distance, less the margin; negative if there is no room.
    pub room: S,
    /// The largest distance of the points of the body from the pivot.
    pub reach: S,
}

impl<V: Vector> Distance<V> {
    /// The answer for bodies that are apart by a signed distance.
    #[inline(always)]
    fn of_apart(apart: SignedDistance<V>) -> Self {
        let SignedDistance { lower, upper, point_a, point_b, status, iterations, .. } = apart;
        let (distance, normal, overlap) = (apart.signed_distance, Some(apart.normal), false);
        Self { distance, lower, upper, overlap, point_a, point_b, normal, status, iterations }
    }

    /// The changes of the pose of `a` that leave it farther from `b` than a margin.
    ///
    /// A change turns `a` by an angle about any axis through the pivot, and moves it. No point goes farther than the
    /// path of the pivot plus the angle times the point's distance from it. Along the normal of the plane that
    /// separates the bodies, no point comes nearer by more. So one distance serves until the body has gone as far as
    /// its room: most steps of a controller need no new query.
    ///
    /// ```
    /// use convex_support::{Ball, Cuboid, Posed, glam::DVec3};
    /// use gjk_raycast::{DistanceOptions, distance};
    ///
    /// let tool = Posed::translated(Cuboid::new(DVec3::new(0.3, 0.4, 1.2))?, DVec3::X * 5.0)?;
    /// let worker = Ball::new(1.0)?;
    /// let apart = distance(&tool, &worker, DistanceOptions::default()); // 3.7
    /// let step = apart.free_step(&tool, DVec3::X * 5.0, 0.5);
    /// // The tool reaches 1.3 from its middle. It may turn by one radian and go on by 1.8 …
    /// assert!(step.allows(1.8, 1.0));
    /// // … but not by 2, for all that is known.
    /// assert!(!step.allows(2.0, 1.0));
    /// assert!((step.way(1.0) - 1.9).abs() < 1e-12);
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    ///
    /// If `b` moves too, subtract its path from the same room. The answer must be that of these bodies, with `a` in its
    /// pose of the query. If [`limit`](crate::DistanceOptions::limit) ended the query, the room is that of the lower
    /// bound found by then.
    #[doc(alias("safe_step", "motion_bound"))]
    pub fn free_step<A: SupportMap<Vector = V> + ?Sized>(
        &self,
        a: &A,
        pivot: V,
        margin: V::Scalar,
    ) -> FreeStep<V::Scalar> {
        let Core { origin, radius, extent, error, .. } = a.core();
        let (arm, epsilon) = ((origin - pivot).norm(), V::Scalar::EPSILON);
        let rounded = (origin.abs().max_element() + pivot.abs().max_element()) * epsilon * Scalar::from_f64(2.0);
        let room = self.lower - margin;
        // The difference is rounded once.
        FreeStep { room: room - raised(room.abs() * epsilon), reach: raised(arm + extent + radius + error + rounded) }
    }
}

impl<S: Scalar> FreeStep<S> {
    /// Whether the body stays farther away than the margin if its pivot moves by this length, and it turns about the
    /// pivot by an angle. NaN is not allowed.
    #[must_use]
    pub fn allows(&self, way: S, angle: S) -> bool {
        raised(way.abs() + self.reach * angle.abs()) < self.room
    }

    /// How far the pivot may go if the body turns by an angle; negative if it may not turn so far.
    #[must_use]
    pub fn way(&self, angle: S) -> S {
        self.room - raised(self.reach * angle.abs())
    }
}
