//! The first contact of two shapes that move without turning.

use convex_support::numerics::twofold::lost_in_sum;
use convex_support::{Core, CoreKind, Posed, Scalar, SupportMap, Vector, compiled_once};
use num_traits::Float as _;

use crate::body::{Both, CastBody, Pair, PointPair, Shapes as _};
use crate::cast::{
    CastHit, CastRay, ObstacleCast, Part, Quicker, RayBodies, cast, certain_closely, settle_ends, sliding,
};
use crate::distance::distance_of_any;
use crate::extra::in_static;
use crate::observer::Observer;
use crate::shape::{Shape, WithoutLines};
use crate::signed_distance::signed_distance_of_any;
use crate::{
    DistanceOptions, Impact, Iterate, LinearCast, LinearCastOptions, Miss, Motion, Outcome, Ray, RayCastError,
    RayCastOptions, SignedDistance, SignedDistanceOptions, StartInContact, Status, WarmStart,
};

/// Shapes may be in contact if they are apart by so many ε of their sizes and of their distance from the origin: they
/// and their places are rounded.
const NEAR: f64 = 16.0;
const NEAR_OF_FAR: f64 = 4.0;

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

/// The functions that measure shapes in contact at the start, in addition to the cast itself.
#[allow(clippy::type_complexity, reason = "the type is written once")]
pub(crate) struct AtStart<V: Vector> {
    rays: &'static Quicker<V>,
    touch: fn(&StartingPair<'_, V>, &mut LinearCast<V>, &LinearCastOptions<V>),
    of_motion: fn(&StartingPair<'_, V>, Motion<V>, &LinearCastOptions<V>, V::Scalar) -> Option<InContact<V>>,
}

impl<V: Vector> AtStart<V> {
    pub(crate) const TABLE: Self = Self {
        rays: &Quicker::TABLE,
        touch: |start, answer, options| start.touch(answer, options),
        of_motion: |start, motion, options, slack| start.of_motion(motion, options, slack),
    };
}

in_static!(AtStart);

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
        let mut cast = match cores.iter().any(is_point).then(known).flatten() {
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
    [a, b]: [Shape<'_, V>; 2],
    cores: &[Core<V>; 2],
    motion: Motion<V>,
    options: &LinearCastOptions<V>,
) -> LinearCast<V> {
    let zero = V::Scalar::ZERO;
    let target = options.target_distance.max(zero);
    let outcome = match &cast.outcome {
        Outcome::Hit(hit) => Outcome::Hit(hit_on_the_way(hit, cast.scale, cores, motion.velocity_b)),
        Outcome::Miss(miss) => Outcome::Miss(Miss { axis: -miss.axis }),
        Outcome::Undecided => Outcome::Undecided,
    };
    let &ObstacleCast { lower, upper, status, iterations, .. } = cast;
    let mut answer = LinearCast { outcome, lower, upper, status, iterations };
    let start = StartingPair { a, b, target };
    // Where only deeper motions count, what is known of the start is looked for below.
    if let Outcome::Hit(Impact { time, normal: None, .. }) = answer.outcome
        && time == zero
        && options.start_in_contact == StartInContact::Report
        && let Some(extra) = options.extra.get()
    {
        (extra.touch)(&start, &mut answer, options);
    }
    if options.start_in_contact == StartInContact::IfDeeper {
        let [core_a, core_b] = cores;
        let sizes = core_a.extent + core_a.radius + core_b.extent + core_b.radius;
        let far = core_a.origin.norm() + core_b.origin.norm();
        // By powers of two that are less than 1, so that nothing overflows.
        let units = |number: f64| V::Scalar::EPSILON * Scalar::from_f64(number);
        let slack = sizes * units(NEAR) + far * units(NEAR_OF_FAR);
        only_if_deeper(&mut answer, &start, motion, options, slack);
    }
    answer.status = answer.status.of(&answer.outcome, answer.is_certain());
    answer
}

/// The ray of `b` in the frame of `a`, with its options.
#[inline(always)]
fn ray_of<V: Vector>(
    motion: Motion<V>,
    [origin_a, origin_b]: [V; 2],
    options: &LinearCastOptions<V>,
) -> (CastRay<V>, RayCastOptions<V>) {
    let zero = V::Scalar::ZERO;
    let mut wanted = RayCastOptions::lean()
        .with_max_lambda(options.max_time)
        .with_tolerance(options.tolerance)
        .with_max_iterations(options.max_iterations)
        .with_sub_algorithm(options.sub_algorithm)
        .with_method(options.method);
    // Seen from b, a is at the outside of the obstacle: normals of A − B point out of a.
    wanted.warm_start = options.warm_start.map(WarmStart::reversed);
    wanted.extra = options.extra.part(|extra| extra.rays);
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
fn hit_on_the_way<V: Vector>(
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
fn only_if_deeper<V: Vector>(
    answer: &mut LinearCast<V>,
    start: &StartingPair<'_, V>,
    motion: Motion<V>,
    options: &LinearCastOptions<V>,
    slack: V::Scalar,
) {
    let (zero, infinity) = (V::Scalar::ZERO, V::Scalar::infinity());
    let may_begin_in_contact = match answer.outcome {
        Outcome::Hit(Impact { normal: Some(n), time, .. }) => {
            let closing = n.dot(motion.velocity_b - motion.velocity_a);
            // NaN is looked at.
            !(closing * time > slack)
        }
        Outcome::Hit(_) => true,
        Outcome::Undecided => answer.lower * (motion.velocity_b - motion.velocity_a).norm() <= slack,
        Outcome::Miss(_) => false,
    };
    if !may_begin_in_contact {
        return;
    }
    let contact = match options.extra.get().map(|extra| (extra.of_motion)(start, motion, options, slack)) {
        // They are apart.
        Some(None) => return,
        Some(contact) => contact.filter(|contact| slack < infinity && contact.start.upper < infinity),
        None => None,
    };
    let Some(contact) = contact else {
        // Of numbers out of range nothing is known, nor without a look at the start.
        (answer.outcome, answer.status) = (Outcome::Undecided, Status::Stalled);
        (answer.lower, answer.upper) = (zero, infinity);
        return;
    };
    answer.iterations += contact.start.iterations;
    let is_hit_at_start = matches!(answer.outcome, Outcome::Hit(Impact { time, .. }) if time == zero);
    if let Some(axis) = contact.leaves_along {
        (answer.outcome, answer.status) = (Outcome::Miss(Miss { axis }), Status::Converged);
        (answer.lower, answer.upper) = (infinity, infinity);
    } else if is_hit_at_start {
        let (point, normal) = (contact.start.point_b, Some(contact.start.normal));
        answer.outcome = Outcome::Hit(Impact { time: zero, point, normal });
    }
}

/// How far on shapes are tested first, in units of their uncertainty; how much farther each time; and how often at
/// most, which is beyond their sizes in any precision.
const FIRST: f64 = 64.0;
const FARTHER: f64 = 8.0;
const LOOKS: usize = 18;

/// Two shapes at the start of a cast. They are behind pointers, so that rare queries are compiled once.
struct StartingPair<'s, V: Vector> {
    a: Shape<'s, V>,
    b: Shape<'s, V>,
    /// How far apart they count as touching.
    target: V::Scalar,
}

impl<V: Vector> StartingPair<'_, V> {
    /// Returns a hit at the start by a point of both shapes, and the normal if they only touch: the entry that the cast
    /// finds is behind the start or, if they slide, ahead of it.
    #[cold]
    #[inline(never)]
    fn touch(&self, answer: &mut LinearCast<V>, options: &LinearCastOptions<V>) {
        let zero = V::Scalar::ZERO;
        let left = |taken: usize| options.max_iterations.saturating_sub(taken);
        let wanted = DistanceOptions::new().with_max_iterations(left(answer.iterations));
        let at_start = distance_of_any(self.a, self.b, wanted.with_sub_algorithm(options.sub_algorithm));
        answer.iterations += at_start.iterations;
        let max_iterations = left(answer.iterations);
        let start = self.signed_distance(&LinearCastOptions { max_iterations, ..*options }, zero);
        answer.iterations += start.iterations;
        let only_touches = start.upper >= self.target;
        if !only_touches {
            // They are certainly deeper than touching, whatever the motion.
            answer.upper = zero;
        }
        let normal = only_touches.then_some(start.normal);
        answer.outcome = Outcome::Hit(Impact { time: zero, point: at_start.point_b, normal });
    }

    /// The signed distance at the start; the search stops as soon as the depth is certain to exceed a limit.
    fn signed_distance(&self, options: &LinearCastOptions<V>, depth_limit: V::Scalar) -> SignedDistance<V> {
        let mut wanted = SignedDistanceOptions::new().with_depth_limit(depth_limit);
        wanted.max_iterations = wanted.max_iterations.min(options.max_iterations);
        wanted.axis = options.warm_start.map(|warm| warm.axis);
        signed_distance_of_any(self.a, self.b, wanted)
    }

    /// The contact of shapes that touch or overlap at the start, to a slack that is the rounding of their places;
    /// `None` if they are certainly apart by more.
    ///
    /// The depth of a point in a convex set is a concave function of the point: it is the least of the distances from
    /// the supporting planes. So if it falls at first along a line, it falls along all of it; and if it is more
    /// anywhere along the line than at the start, it grows from the start on. Where the depth is `−s`, along the normal
    /// `n`, it changes by `−n·w` with the relative velocity `w` of `a`; if several ways out are equally short, or the
    /// shapes touch at corners, by the least of these. Then `n` is one of many normals, and the shapes may part along
    /// another one although they close in along `n`. So it counts whether they are certainly deeper later.
    #[cold]
    #[inline(never)]
    fn of_motion(&self, motion: Motion<V>, options: &LinearCastOptions<V>, slack: V::Scalar) -> Option<InContact<V>> {
        let start = self.signed_distance(options, V::Scalar::infinity());
        if !(start.lower <= self.target + slack) {
            return None;
        }
        let velocity = motion.velocity_a - motion.velocity_b;
        let (speed, closing) = (velocity.norm(), -start.normal.dot(velocity));
        if !(closing > sliding(speed)) {
            return Some(InContact { start, leaves_along: Some(start.normal) });
        }
        // If the depth is known to rounding, a motion that never shows a change slides.
        let slides = start.upper >= self.target - slack || start.upper - start.lower <= slack;
        let leaves_along = match self.later(velocity, speed / closing, &start, slack) {
            Later::Deeper => None,
            Later::Less(normal) => Some(normal),
            Later::Unknown(normal) => slides.then_some(normal),
        };
        Some(InContact { start, leaves_along })
    }

    /// Whether the shapes get deeper than they start as they move along a velocity, so many times as far as they come
    /// nearer along the normal. They are tested so far on that it shows, if the normal is the only one, to as far as
    /// their sizes.
    fn later(&self, velocity: V, per_depth: V::Scalar, start: &SignedDistance<V>, slack: V::Scalar) -> Later<V> {
        let SignedDistance { upper, lower, normal, .. } = *start;
        let size = self.a.core().size() + self.b.core().size() + self.target;
        let unit = velocity.unit().unwrap_or(V::ZERO);
        let mut step = (slack + (upper - lower)) * per_depth * V::Scalar::from_f64(FIRST);
        let mut last = normal;
        for _ in 0..LOOKS {
            if !(step < size) {
                break;
            }
            let Ok(moved) = Posed::translated(self.a, unit * step) else { break };
            let there = signed_distance_of_any(&WithoutLines(&moved), self.b, SignedDistanceOptions::new());
            if there.upper < lower.min(self.target - slack) {
                return Later::Deeper;
            }
            if there.lower > upper {
                return Later::Less(there.normal);
            }
            last = there.normal;
            step *= V::Scalar::from_f64(FARTHER);
        }
        Later::Unknown(last)
    }
}

/// Whether shapes in contact are deeper later than at the start; if not, with the normal.
enum Later<V> {
    Deeper,
    Less(V),
    Unknown(V),
}

/// Two shapes in contact.
struct InContact<V: Vector> {
    start: SignedDistance<V>,
    /// If the motion does not go deeper: the direction from `b` to `a` along which it leaves, or slides.
    leaves_along: Option<V>,
}
