//! The first contact of two shapes that move without turning.

use convex_support::numerics::twofold::lost_in_sum;
use convex_support::{Core, CoreKind, Scalar, SupportMap, Vector, compiled_once, compiled_table};
use num_traits::Float as _;

use crate::body::{CastBody, PointPair};
use crate::cast::{CastHit, CastRay, ObstacleCast, Part, RayBodies, cast, certain_closely, settle_ends};
use crate::observer::Observer;
use crate::options::{MAX_ITERATIONS, MayBeLean, Rare, options};
use crate::outcome::{check_finite, check_limits};
use crate::pair::{Both, Pair, Shape, Shapes as _};
use crate::start_in_contact::{Later, RareInLinearCasts, StartingPair};
use crate::{
    Cast, CastMethod, Impact, Iterate, Miss, Outcome, Ray, RayCast, RayCastError, RayCastOptions, RigidMotion,
    StartInContact, Status, SubAlgorithm, WarmStart,
};

/// Shapes may be in contact if they are apart by so many ε of their sizes and of their distance from the origin, and so
/// many times the errors that they state of their support points: they and their places are rounded.
const MAY_TOUCH: f64 = 16.0;
const NEAR_OF_FAR: f64 = 4.0;
const NEAR_OF_STATED: f64 = 4.0;

/// The first contact of two shapes that move at constant velocities, without turning.
///
/// A ray is cast against their configuration space obstacle: `A + t·v_A` and `B + t·v_B` have a point in common if
/// and only if `t·(v_B − v_A)` is in `A − B`. If the velocities are equal, the answer is a hit only if the shapes
/// overlap.
///
/// ```
/// use convex_support::{Ball, Posed, glam::DVec2};
/// use gjk_raycast::{LinearCastOptions, Motion, linear_cast};
///
/// let fast = Ball::new(0.5)?;
/// let slow = Posed::translated(Ball::new(0.5)?, DVec2::new(4.0, 0.0))?;
/// let motion = Motion { velocity_a: DVec2::new(3.0, 0.0), velocity_b: DVec2::new(1.0, 0.0) };
/// let cast = linear_cast(&fast, &slow, motion, LinearCastOptions::default())?;
/// let hit = cast.outcome.hit().ok_or("they meet")?;
/// assert_eq!((hit.time, hit.point, hit.normal), (1.5, DVec2::new(5.0, 0.0), Some(DVec2::NEG_X)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Stepping a world
/// If shapes are moved to their contact, the next cast starts with shapes that touch. By default it is a hit at
/// time 0 again, whatever the motion. With [`StartInContact::IfDeeper`] it is a hit only if the shapes get deeper
/// than they began. A motion that leaves the contact, or slides along it, is a miss, since shapes that move straight
/// do not meet again:
///
/// ```
/// use convex_support::{Ball, Cuboid, Posed, glam::DVec2};
/// use gjk_raycast::{LinearCastOptions, Motion, StartInContact, linear_cast};
///
/// let floor = Cuboid::new(DVec2::new(10.0, 1.0))?;
/// let ball = Posed::translated(Ball::new(0.5)?, DVec2::new(0.0, 1.5))?;
/// let options = LinearCastOptions::new().with_start_in_contact(StartInContact::IfDeeper);
/// let cast = |velocity_a| {
///     linear_cast(&ball, &floor, Motion { velocity_a, ..Motion::default() }, options)
/// };
/// assert!(cast(DVec2::new(3.0, 0.0))?.outcome.is_miss());
/// assert!(cast(DVec2::new(3.0, 1.0))?.outcome.is_miss());
/// let hit = cast(DVec2::new(3.0, -1.0))?.outcome.hit().ok_or("it goes into the floor")?;
/// assert_eq!((hit.time, hit.normal), (0.0, Some(DVec2::Y)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// A cast to a [`target_distance`](LinearCastOptions::target_distance) is the cast of `a` swept by a ball of that
/// radius, and is certified in the same way.
///
/// # Errors
/// [`RayCastError::NonFinite`] if a velocity is not finite, the target distance is NaN or infinite, or the end of the
/// motion NaN.
#[doc(alias("shape_cast", "sweep", "convex_cast", "time_of_impact", "toi", "ccd", "swept_test"))]
#[inline]
pub fn linear_cast<A, B>(
    a: &A,
    b: &B,
    motion: Motion<A::Vector>,
    options: LinearCastOptions<A::Vector>,
) -> Result<LinearCast<A::Vector>, RayCastError>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    watched(a, b, motion, options, &mut Observer::none())
}

/// [`linear_cast`] with an observer that sees every iterate.
///
/// # Errors
/// Those of [`linear_cast`].
#[inline]
pub fn linear_cast_with<A, B>(
    a: &A,
    b: &B,
    motion: Motion<A::Vector>,
    options: LinearCastOptions<A::Vector>,
    mut observer: impl FnMut(Iterate<'_, A::Vector>),
) -> Result<LinearCast<A::Vector>, RayCastError>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    watched(a, b, motion, options, &mut Observer::new(&mut observer))
}

/// The velocities of two shapes, in units of length per unit of time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Motion<V> {
    /// The velocity of `a`.
    pub velocity_a: V,
    /// The velocity of `b`.
    pub velocity_b: V,
}

impl<V: Vector> Motion<V> {
    /// The motions of both bodies.
    #[must_use]
    pub fn translations(self) -> [RigidMotion<V>; 2] {
        [self.velocity_a, self.velocity_b].map(RigidMotion::translation)
    }

    /// The error of a motion that is invalid, or cannot be cast with these options.
    pub(crate) fn check(&self, options: &LinearCastOptions<V>) -> Result<(), RayCastError> {
        check_finite("velocity_a", self.velocity_a)?;
        check_finite("velocity_b", self.velocity_b)?;
        check_limits(options.max_time, options.target_distance)
    }
}

/// Options of [`linear_cast`](crate::linear_cast).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct LinearCastOptions<V: Vector> {
    /// The end of the motion; it belongs to the motion. If the motion ends at the first contact, to rounding, neither a
    /// hit nor a miss is certain. If it is negative, the motion has no time, and the answer is a miss. Default:
    /// infinity.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub max_time: V::Scalar,
    /// The distance at which the shapes count as touching: the cast stops that far from contact. A negative value is
    /// taken for zero. Default: 0.
    pub target_distance: V::Scalar,
    /// What to answer if the shapes touch at the start. To step a world from contact to contact, take
    /// [`StartInContact::IfDeeper`]. Default: [`StartInContact::Report`].
    pub start_in_contact: StartInContact,
    /// How far from contact, relative to the sizes of the shapes, the answer may stay uncertain. A bracket at the level
    /// of rounding always ends the iteration. A negative value and NaN are taken for zero. Default: 0.
    pub tolerance: V::Scalar,
    /// The iterations after which to give up, those of repeated searches included. Only the depths that
    /// [`StartInContact::IfDeeper`] looks at may take as many each. Default: 200.
    pub max_iterations: usize,
    /// The warm start from the last frame's answer, which predicts the direction from `b` to `a` at contact. Default:
    /// none.
    pub warm_start: Option<WarmStart<V>>,
    /// How the closest point of a simplex is found. Default: [`SubAlgorithm::Regions`].
    pub sub_algorithm: SubAlgorithm,
    /// How planes are found. Default: [`CastMethod::Portal`].
    pub method: CastMethod,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) rare: Rare<Self>,
}

impl<V: Vector> Default for LinearCastOptions<V> {
    fn default() -> Self {
        Self { rare: Self::rare(), ..Self::lean() }
    }
}

impl<V: Vector> LinearCastOptions<V> {
    /// The default options, with no machine code besides Algorithm 3 and the closed forms for points and balls: a
    /// program in which all options are lean has three tenths of the code for linear casts.
    ///
    /// The faster search of [`CastMethod::Portal`] is left out, as in [`RayCastOptions::lean`], and so are all
    /// measurements at the start besides the cast itself. If shapes touch or overlap there, the hit has a point of
    /// both, but no normal. It is certain only if the search happens to end with points of both around the start. With
    /// [`StartInContact::IfDeeper`] shapes that may be in contact at the start are
    /// [undecided](crate::Outcome::Undecided).
    #[must_use]
    pub fn lean() -> Self {
        Self {
            max_time: V::Scalar::infinity(),
            target_distance: V::Scalar::ZERO,
            start_in_contact: StartInContact::Report,
            tolerance: V::Scalar::ZERO,
            max_iterations: MAX_ITERATIONS,
            warm_start: None,
            sub_algorithm: SubAlgorithm::Regions,
            method: CastMethod::Portal,
            rare: Rare(None),
        }
    }
}

impl<V: Vector> MayBeLean for LinearCastOptions<V> {
    type Table = RareInLinearCasts<V>;
    const TABLE: Self::Table = RareInLinearCasts::TABLE;

    fn rare() -> Rare<Self> {
        Rare(Some(compiled_table!(RareInLinearCasts<V> of LinearCastOptions)))
    }
}

options! {
    LinearCastOptions: with_max_time(max_time: V::Scalar), with_target_distance(target_distance: V::Scalar),
    with_start_in_contact(start_in_contact: StartInContact), with_tolerance(tolerance: V::Scalar),
    with_max_iterations(max_iterations: usize), with_warm_start(warm_start: Option<WarmStart<V>>),
    with_axis(axis: V => warm_start = Some(WarmStart::new(axis))), with_sub_algorithm(sub_algorithm: SubAlgorithm),
    with_method(method: CastMethod)
}

/// The answer of [`linear_cast`](crate::linear_cast).
pub type LinearCast<V> = Cast<Impact<V>, V>;

impl<V: Vector> LinearCast<V> {
    /// The warm start for the [cast of the next frame](crate::LinearCastOptions::warm_start), from this answer and its
    /// own warm start.
    #[must_use]
    pub fn warm_start(&self, before: Option<WarmStart<V>>) -> Option<WarmStart<V>> {
        self.outcome.warm_start(before, |hit| hit.normal)
    }
}

#[inline(always)]
fn watched<A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized>(
    a: &A,
    b: &B,
    motion: Motion<A::Vector>,
    options: LinearCastOptions<A::Vector>,
    observer: &mut Observer<'_, A::Vector>,
) -> Result<LinearCast<A::Vector>, RayCastError> {
    motion.check(&options)?;
    let target = options.target_distance.max(<A::Vector as Vector>::Scalar::ZERO);
    Ok(as_body(a, b, target, |body, shapes, cores| by_search(body, shapes, cores, motion, &options, observer)))
}

/// The questions of a search about two shapes, one of them swept by a ball.
#[inline(always)]
pub(crate) fn as_body<A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized, R>(
    a: &A,
    b: &B,
    target_distance: <A::Vector as Vector>::Scalar,
    search: impl FnOnce(&mut dyn CastBody<Vector = A::Vector>, [Shape<'_, A::Vector>; 2], &[Core<A::Vector>; 2]) -> R,
) -> R {
    let shapes = Both::<_, _, true>::new(a, b);
    let mut cores = shapes.cores();
    cores[0] = cores[0].rounded(target_distance);
    let mut body = Pair::new(&shapes, cores.each_ref()).swept(target_distance);
    search(&mut body, shapes.each(), &cores)
}

compiled_once! {
    /// The cast by a search, for a pair of shapes with these cores.
    pub(crate) fn by_search<V>(
        body: &mut dyn CastBody<Vector = V>,
        shapes: [Shape<'_, V>; 2],
        cores: &[Core<V>; 2],
        motion: Motion<V>,
        options: &LinearCastOptions<V>,
        observer: &mut Observer<'_, V>,
    ) -> LinearCast<V> {
        let [a, b] = shapes;
        let (whole, wanted) = ray_of(motion, cores.each_ref().map(|core| core.origin), options);
        let CastRay { ray, direction_error, .. } = whole;
        // Of no other pair is a crossing known.
        let is_point = |core: &Core<V>| matches!(core.kind, CoreKind::Point(_));
        let known = || certain_closely(body, ray, direction_error, &wanted, observer);
        // Where bodies begin in contact, only a search or a further look has a point of both.
        let is_told = |known: &RayCast<V>| known.upper > <V::Scalar as Scalar>::ZERO || options.rare.0.is_some();
        let mut cast = match cores.iter().any(is_point).then(known).flatten().filter(is_told) {
            Some(known) => ObstacleCast::of_certain(&known, body, ray),
            None => cast(body, whole, &wanted, observer),
        };
        let skin = options.target_distance.max(Scalar::ZERO);
        settle_ends(&mut cast, RayBodies { a, skin, b, direction: ray.direction, direction_error }, &wanted);
        answer(&cast, [a, b], cores, motion, options)
    }
}

/// The answer of a cast about two shapes.
fn answer<V: Vector>(
    cast: &ObstacleCast<V>,
    shapes: [Shape<'_, V>; 2],
    cores: &[Core<V>; 2],
    motion: Motion<V>,
    options: &LinearCastOptions<V>,
) -> LinearCast<V> {
    let outcome = match &cast.outcome {
        Outcome::Hit(hit) => Outcome::Hit(hit_on_the_way(hit, cast.scale, cores, motion.velocity_b)),
        Outcome::Miss(miss) => Outcome::Miss(Miss { axis: -miss.axis }),
        Outcome::Undecided => Outcome::Undecided,
    };
    let &ObstacleCast { lower, upper, status, iterations, .. } = cast;
    let answer = LinearCast { outcome, lower, upper, status, iterations };
    let time = match answer.outcome {
        Outcome::Hit(Impact { time, normal: None, .. }) => time,
        _ => V::Scalar::infinity(),
    };
    if time == V::Scalar::ZERO || options.start_in_contact == StartInContact::IfDeeper {
        return look_at_start(answer, shapes, cores, motion, options);
    }
    LinearCast { status: status.of(&answer.outcome, answer.is_certain()), ..answer }
}

/// The answer where the bodies overlap at the start, or only a motion that goes deeper counts, given the plain answer.
/// A function of its own, for which alone an answer has to be in memory before it is returned.
#[cold]
#[inline(never)]
fn look_at_start<V: Vector>(
    mut answer: LinearCast<V>,
    [a, b]: [Shape<'_, V>; 2],
    cores: &[Core<V>; 2],
    motion: Motion<V>,
    options: &LinearCastOptions<V>,
) -> LinearCast<V> {
    let (velocities, axis) = ([motion.velocity_a, motion.velocity_b], options.warm_start.map(|warm| warm.axis));
    let &LinearCastOptions { max_iterations, sub_algorithm, .. } = options;
    let (target, slack) = (options.target_distance.max(Scalar::ZERO), rounding_of_places(cores));
    let start = StartingPair { a, b, velocities, target, slack, axis, max_iterations, sub_algorithm };
    if options.start_in_contact == StartInContact::IfDeeper {
        // It measures the start for itself.
        only_if_deeper(&mut answer, &start, options);
    } else if let Some(rare) = options.rare.0 {
        // Any contact counts.
        (rare.touch)(&start, &mut answer);
    }
    answer.status = answer.status.of(&answer.outcome, answer.is_certain());
    answer
}

/// How far apart, or how deep in one another, shapes may be found that are in contact but for rounding.
fn rounding_of_places<V: Vector>([core_a, core_b]: &[Core<V>; 2]) -> V::Scalar {
    let sizes = core_a.extent + core_a.radius + core_b.extent + core_b.radius;
    contact_slack(sizes, core_a.origin.norm() + core_b.origin.norm(), core_a.error + core_b.error)
}

/// How far apart bodies may be in contact, given their sizes, their distances from the origin, and the errors that they
/// state of their support points.
pub(crate) fn contact_slack<S: Scalar>(sizes: S, far: S, stated: S) -> S {
    // By powers of two that are less than 1, so that nothing overflows.
    let units = |number: f64| S::EPSILON * S::from_f64(number);
    sizes * units(MAY_TOUCH) + far * units(NEAR_OF_FAR) + stated * S::from_f64(NEAR_OF_STATED)
}

/// The ray of `b` in the frame of `a`, with its options.
#[inline(always)]
fn ray_of<V: Vector>(
    motion: Motion<V>,
    [origin_a, origin_b]: [V; 2],
    options: &LinearCastOptions<V>,
) -> (CastRay<V>, RayCastOptions<V>) {
    let zero = V::Scalar::ZERO;
    let &LinearCastOptions { max_time, tolerance, max_iterations, sub_algorithm, method, .. } = options;
    // Seen from b, a is at the outside of the obstacle: normals of A − B point out of a.
    let warm_start = options.warm_start.map(WarmStart::reversed);
    let rare = Rare(options.rare.0.map(|rare| rare.in_ray_casts));
    let (min_lambda, max_lambda) = (zero, max_time);
    let mut wanted =
        RayCastOptions { min_lambda, max_lambda, tolerance, max_iterations, warm_start, sub_algorithm, method, rare };
    // The ray starts at zero, where both shapes are in place: at b's origin, seen from a's.
    let mut ray = Ray { source: origin_b, direction: motion.velocity_b - motion.velocity_a };
    if ray.direction == V::ZERO {
        // Only the start counts, and any ray of length zero is the start.
        ray.direction = (origin_a - origin_b).unit().unwrap_or_else(|| V::axis(0));
        wanted.max_lambda = zero;
    }
    // What the difference of the velocities loses.
    let lost = lost_in_sum(motion.velocity_b, -motion.velocity_a);
    let direction_error = if lost == V::ZERO { zero } else { lost.norm() / ray.direction.norm() };
    (CastRay { ray, direction_error, part: Part::Whole }, wanted)
}

/// A hit of bodies that are apart at the start.
///
/// With `p` a point of a's core and `q` one of b's, `q − p + spot` is the vector between them at that time, as long
/// as both radii together. The point that divides it in the ratio of the radii is on both shapes, whatever the error
/// of the normal.
#[inline(always)]
pub(crate) fn hit_on_the_way<V: Vector>(
    hit: &CastHit<V>,
    scale: V::Scalar,
    [core_a, core_b]: &[Core<V>; 2],
    velocity_b: V,
) -> Impact<V> {
    let &CastHit { lambda: time, normal, spot, witness: PointPair { a: p, b: q } } = hit;
    let between = (q - p + spot) * scale;
    let zero = V::Scalar::ZERO;
    let share = if core_b.radius > zero { core_b.radius / (core_a.radius + core_b.radius) } else { zero };
    let at_start = core_b.origin + q * scale;
    Impact { time, point: at_start + velocity_b * time - between * share, normal: normal.map(|n| -n) }
}

/// The answer if only a motion that goes deeper counts as a hit, given the plain answer. Shapes that are apart by no
/// more than a slack may be in contact.
#[cold]
#[inline(never)]
fn only_if_deeper<V: Vector>(answer: &mut LinearCast<V>, start: &StartingPair<'_, V>, options: &LinearCastOptions<V>) {
    let (zero, infinity, [velocity_a, velocity_b]) = (V::Scalar::ZERO, V::Scalar::infinity(), start.velocities);
    let may_begin_in_contact = match answer.outcome {
        Outcome::Hit(Impact { normal: Some(n), time, .. }) => {
            let closing = n.dot(velocity_b - velocity_a);
            // NaN is looked at.
            !(closing * time > start.slack)
        }
        Outcome::Hit(_) => true,
        Outcome::Undecided => answer.lower * (velocity_b - velocity_a).norm() <= start.slack,
        Outcome::Miss(_) => false,
    };
    if !may_begin_in_contact {
        return;
    }
    // Without a look at the start nothing is known.
    match options.rare.0.and_then(|rare| (rare.of_motion)(start, &mut answer.iterations)) {
        Some(Later::Apart) => {}
        Some(Later::Never(axis)) => {
            (answer.outcome, answer.status) = (Outcome::Miss(Miss { axis }), Status::Converged);
            (answer.lower, answer.upper) = (infinity, infinity);
        }
        Some(Later::Deeper { upper, point, normal }) => {
            if !matches!(answer.outcome, Outcome::Hit(Impact { time, .. }) if time > zero) {
                answer.outcome = Outcome::Hit(Impact { time: zero, point, normal: Some(normal) });
                (answer.lower, answer.status) = (zero, Status::Converged);
            }
            let upper = answer.upper.min(upper.max(answer.lower));
            answer.upper = answer.outcome.until(options.max_time, upper, |hit| hit.time);
            if let Outcome::Hit(hit) = &mut answer.outcome {
                hit.time = hit.time.min(answer.upper);
            }
        }
        None => {
            let is_given_up = answer.iterations >= options.max_iterations;
            answer.status = if is_given_up { Status::IterationLimit } else { Status::Stalled };
            (answer.outcome, answer.lower, answer.upper) = (Outcome::Undecided, zero, infinity);
        }
    }
}
