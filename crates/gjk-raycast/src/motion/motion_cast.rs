//! The first contact of two bodies that move and turn, and its options.

use convex_support::{AngularVelocity, Core, Scalar, SupportMap, Vector, compiled_once};
use num_traits::Float as _;

use super::boxes::Block;
use super::first_contact::{MotionEnd, Search};
use super::instant::{Instant, Limits};
use super::moving_pair::MovingPair;
use super::rigid_motion::RigidMotion;
use super::trajectory::Trajectory;
use crate::body::{Both, CastBody, Shapes};
use crate::error::RayCastError;
use crate::extra::{Extra, in_static};
use crate::linear_cast::{AtStart, as_body, by_search};
use crate::observer::Observer;
use crate::options::{new_by_default, setters};
use crate::ray::{check_finite, check_limits, check_numbers};
use crate::separation::Closer;
use crate::shape::Shape;
use crate::{LinearCast, LinearCastOptions, Motion, MotionCast, StartInContact, WarmStart};

/// Times to examine after which to give up. A contact takes about ten, and each turn near another body about as many;
/// bodies that spin for long very near one another take the most.
const MAX_ITERATIONS: usize = 10_000;

/// Options of [`motion_cast`](crate::motion_cast).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct MotionCastOptions<V: Vector> {
    /// The end of the motion; it belongs to the motion. A negative value is taken for zero. Default: infinity. Set an
    /// end if a body spins: no finite search can prove that a spinning body never touches another one, and the answer
    /// is undecided after [`max_iterations`](Self::max_iterations).
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub max_time: V::Scalar,
    /// How far from contact, relative to the sizes of the shapes, the answer may stay uncertain. A bracket at the level
    /// of rounding always ends the search. Default: 0.
    pub tolerance: V::Scalar,
    /// The distance at which bodies count as touching: the cast stops that far from contact. A negative value is taken
    /// for zero. Default: 0.
    pub target_distance: V::Scalar,
    /// What to answer if the bodies touch at the start. Default: [`StartInContact::Report`].
    pub start_in_contact: StartInContact,
    /// A first guess of the direction from `b` to `a` at the start, such as the axis of the last miss. Default: none.
    pub axis: Option<V>,
    /// The number of times to examine, after which to give up; each takes a few support points, which
    /// [`MotionCast::iterations`](crate::MotionCast::iterations) counts. Default: 10 000.
    pub max_iterations: usize,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) extra: Extra<FullMotion<V>>,
}

impl<V: Vector> MotionCastOptions<V> {
    /// The default options.
    #[must_use]
    pub fn new() -> Self {
        Self { extra: FullMotion::named(), ..Self::lean() }
    }

    /// The default options, with no machine code besides GJK, closed forms, and the closest points of the last time: a
    /// program in which all options are lean has a third of the code for motion casts.
    ///
    /// The search then does without the shortest way out of an overlap, the facets of two boxes, the proof that bodies
    /// without an inside have passed through one another, and the linear cast, so that motions that do not turn are
    /// searched like those that do. It takes more support points, the bracket may be wider, and a contact that is not
    /// certain, or a graze, may be undecided where the default options decide. With [`StartInContact::IfDeeper`], a
    /// start that may be in contact may be undecided too.
    #[must_use]
    pub fn lean() -> Self {
        Self {
            max_time: V::Scalar::infinity(),
            tolerance: V::Scalar::ZERO,
            target_distance: V::Scalar::ZERO,
            start_in_contact: StartInContact::Report,
            axis: None,
            max_iterations: MAX_ITERATIONS,
            extra: Extra::NONE,
        }
    }

    setters!(max_time, tolerance, target_distance, start_in_contact, axis, max_iterations);
}

new_by_default!(MotionCastOptions);

/// The state of a motion cast that an observer sees at every time examined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionIterate<V: Vector> {
    /// Counts from 0.
    pub iteration: usize,
    /// The time examined.
    pub time: V::Scalar,
    /// The certain distance of a separating plane between the bodies then; not positive if none is known.
    pub gap: V::Scalar,
    /// The unit normal of that plane, from `b` to `a`.
    pub normal: V,
    /// The bodies have no point in common up to this time.
    pub lower: V::Scalar,
    /// The bodies have a point in common at this time; infinite if none is known.
    pub upper: V::Scalar,
}

/// The first contact of two moving bodies, which may turn: its time, point and normal.
///
/// ```
/// use convex_support::{Ball, Capsule, Posed, glam::DVec3};
/// use gjk_raycast::{MotionCastOptions, RigidMotion, motion_cast};
///
/// // A blade of length 2 turns about z, once a second, with its middle at zero. A ball of radius
/// // 1/2 lies at x = 1.
/// let blade = Capsule::new(1.0, 0.0)?; // along y
/// let ball = Posed::translated(Ball::new(0.5)?, DVec3::X)?;
/// let turning = RigidMotion::rotation(DVec3::Z * std::f64::consts::TAU, DVec3::ZERO);
/// let options = MotionCastOptions::new().with_max_time(1.0);
/// let cast = motion_cast(&blade, turning, &ball, RigidMotion::default(), options)?;
///
/// // It touches where it comes within asin(1/2) = 30° of x: its other half, after 60°.
/// let hit = cast.outcome.hit().ok_or("they meet")?;
/// assert!((hit.time - 1.0 / 6.0).abs() < 1e-15);
/// assert!(cast.lower <= hit.time && hit.time <= cast.upper && cast.upper - cast.lower < 1e-13);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// The motions are [`RigidMotion`]s, [`ChainMotion`](crate::ChainMotion)s or any other [`Trajectory`]; a body at rest
/// has the motion `RigidMotion::default()`. Up to `lower` the bodies are proved to be apart at all times, not only at
/// those examined; by `upper` they have met. A miss is proved for the whole motion. If the bodies graze one another,
/// so that rounding decides, the answer is [`Outcome::Undecided`](crate::Outcome::Undecided), and `lower` is the time
/// of the graze.
///
/// A start in contact is a hit at time 0, whatever the motion. With
/// [`StartInContact::IfDeeper`](crate::StartInContact::IfDeeper) the hit is the time from which the bodies get deeper
/// than they began, or touch again after they were apart: this steps a world from contact to contact.
///
/// If neither body turns, the answer is that of [`linear_cast`](crate::linear_cast).
///
/// # Errors
/// [`RayCastError::NonFinite`] if a number of a [`RigidMotion`] is not finite, the target distance is NaN or
/// infinite, or another option NaN.
pub fn motion_cast<A, B>(
    a: &A,
    motion_a: impl Trajectory<Vector = A::Vector>,
    b: &B,
    motion_b: impl Trajectory<Vector = A::Vector>,
    options: MotionCastOptions<A::Vector>,
) -> Result<MotionCast<A::Vector>, RayCastError>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    motion_cast_with(a, motion_a, b, motion_b, options, |_| {})
}

/// [`motion_cast`] with an observer that sees every time examined. If nothing turns, it sees none.
///
/// # Errors
/// Those of [`motion_cast`].
pub fn motion_cast_with<A, B>(
    a: &A,
    motion_a: impl Trajectory<Vector = A::Vector>,
    b: &B,
    motion_b: impl Trajectory<Vector = A::Vector>,
    options: MotionCastOptions<A::Vector>,
    mut observer: impl FnMut(MotionIterate<A::Vector>),
) -> Result<MotionCast<A::Vector>, RayCastError>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    let options = checked(options)?;
    check("motion_a", &motion_a)?;
    check("motion_b", &motion_b)?;
    if let (Some(rigid_a), Some(rigid_b)) = (motion_a.as_rigid_motion(), motion_b.as_rigid_motion()) {
        let turns = |motion: &RigidMotion<A::Vector>| motion.angular_velocity != Default::default();
        let alike = rigid_a == rigid_b;
        if alike || !(turns(&rigid_a) || turns(&rigid_b)) {
            let velocity = |motion: RigidMotion<A::Vector>| if alike { A::Vector::ZERO } else { motion.velocity };
            let motion = Motion { velocity_a: velocity(rigid_a), velocity_b: velocity(rigid_b) };
            if let Some(extra) = options.extra.get() {
                return Ok(as_body(a, b, options.target_distance, |body, shapes, cores| {
                    (extra.straight)(body, shapes, cores, motion, &options)
                }));
            }
        }
    }
    Ok(first_contact(&Both::<_, _>::new(a, b), [&motion_a, &motion_b], options, &mut observer))
}

/// What a search does beyond looks at one time by GJK and at what was closest before.
#[allow(clippy::type_complexity, reason = "the type is written once")]
pub(crate) struct FullMotion<V: Vector> {
    pub(super) closer: &'static Closer<V>,
    /// The cast of bodies that do not turn.
    straight: fn(
        &mut dyn CastBody<Vector = V>,
        [Shape<'_, V>; 2],
        [Core<V>; 2],
        Motion<V>,
        &MotionCastOptions<V>,
    ) -> MotionCast<V>,
    pub(super) by_boxes:
        fn(&MovingPair<'_, V>, V::Scalar, &[Block<V>; 2], V, Limits<V::Scalar>, bool) -> Option<Instant<V>>,
    pub(super) begin_in_contact: fn(&mut Search<'_, V>) -> MotionEnd<V>,
    pub(super) keep_in_contact: fn(&MovingPair<'_, V>, &Instant<V>, &Instant<V>, V::Scalar) -> bool,
    pub(super) have_met: fn(&MovingPair<'_, V>, &Instant<V>, V::Scalar) -> bool,
}

impl<V: Vector> FullMotion<V> {
    const TABLE: Self = Self {
        closer: &Closer::TABLE,
        straight: |body, shapes, cores, motion, options| {
            let wanted = LinearCastOptions { extra: AtStart::named(), ..linear_options(options) };
            of_linear_cast(by_search(body, shapes, cores, motion, &wanted, &mut Observer::none()), options.max_time)
        },
        by_boxes: |pair, time, blocks, axis, limits, is_close| pair.by_boxes(time, blocks, axis, limits, is_close),
        begin_in_contact: |search| search.begin_in_contact(),
        keep_in_contact: |pair, from, to, depth| pair.keep_in_contact(from, to, depth),
        have_met: |pair, near, time| pair.have_met(near, time),
    };
}

in_static!(FullMotion);

compiled_once! {
    /// The first contact of bodies that turn.
    fn first_contact<V>(
        shapes: &dyn Shapes<Vector = V>,
        motions: [&dyn Trajectory<Vector = V>; 2],
        options: MotionCastOptions<V>,
        observer: &mut dyn FnMut(MotionIterate<V>),
    ) -> MotionCast<V> {
        Search::run(&MovingPair::new(shapes, motions, &options), options, observer)
    }
}

/// The same options for a motion that does not turn, but for what they name.
pub(crate) fn linear_options<V: Vector>(options: &MotionCastOptions<V>) -> LinearCastOptions<V> {
    let mut wanted = LinearCastOptions::lean()
        .with_max_time(options.max_time)
        .with_target_distance(options.target_distance)
        .with_start_in_contact(options.start_in_contact)
        .with_tolerance(options.tolerance)
        .with_max_iterations(options.max_iterations);
    wanted.warm_start = options.axis.map(WarmStart::new);
    wanted
}

/// The answer for a motion that does not turn.
pub(crate) fn of_linear_cast<V: Vector>(cast: LinearCast<V>, max_time: V::Scalar) -> MotionCast<V> {
    // What comes after the end of the motion is not said of other motions either.
    MotionCast { lower: cast.lower.min(max_time), ..cast }
}

/// The options, if they are numbers, with what is below zero taken for zero.
pub(crate) fn checked<V: Vector>(options: MotionCastOptions<V>) -> Result<MotionCastOptions<V>, RayCastError> {
    let MotionCastOptions { max_time, tolerance, target_distance, .. } = options;
    check_numbers([("max_time", max_time), ("tolerance", tolerance)])?;
    check_limits(max_time, target_distance)?;
    let zero = V::Scalar::ZERO;
    let (max_time, target_distance) = (max_time.max(zero), target_distance.max(zero));
    Ok(MotionCastOptions { max_time, target_distance, ..options })
}

/// Whether all numbers of a [`RigidMotion`] are finite.
pub(crate) fn check(which: &'static str, motion: &impl Trajectory) -> Result<(), RayCastError> {
    let Some(motion) = motion.as_rigid_motion() else { return Ok(()) };
    check_finite(which, motion.velocity)?;
    check_finite(which, motion.center)?;
    match motion.angular_velocity.non_finite() {
        None => Ok(()),
        Some(index) => Err(RayCastError::NonFinite { parameter: which, index }),
    }
}
