//! The least distance of two bodies that move and turn: the question and its answer; the search is
//! [`least`](super::least).

use convex_support::{Scalar, ScalarOf, SupportMap, Vector, compiled_once};
use num_traits::Float as _;

use super::first_contact::{NARROW_AT_END, NARROW_OF_ERROR, Search};
use super::instant::Approach;
use super::least::{LeastEnd, LeastSearch};
use super::motion_cast::{check, checked};
use super::moving_pair::MovingPair;
use super::trajectory::Trajectory;
use crate::options::{Rare, options};
use crate::pair::{Both, Shapes};
use crate::{Cast, Distance, Impact, MotionCastOptions, MotionIterate, Outcome, RayCastError, Status};

/// Times to examine, after which to give up. A minimum takes about fifteen, and each other minimum that is about as low
/// takes as many: bodies that spin for long near one another take the most.
const MAX_LOOKS_FOR_LEAST: usize = 100_000;

/// The least distance of two moving bodies, which may turn, over a time: how near they come, when and where.
///
/// ```
/// use convex_support::{Ball, Capsule, Posed, glam::DVec3};
/// use gjk_raycast::{MotionClearanceOptions, RigidMotion, motion_clearance};
///
/// // A blade of length 2 turns about z, once a second, with its middle at zero. A ball of radius
/// // 1/2 lies at x = 2. After a quarter of a turn the tip points at it.
/// let blade = Capsule::new(1.0, 0.0)?; // along y
/// let ball = Posed::translated(Ball::new(0.5)?, DVec3::X * 2.0)?;
/// let turning = RigidMotion::rotation(DVec3::Z * std::f64::consts::TAU, DVec3::ZERO);
/// let options = MotionClearanceOptions::new().with_max_time(0.4);
/// let least = motion_clearance(&blade, turning, &ball, RigidMotion::default(), options)?;
///
/// assert!((least.distance - 0.5).abs() < 1e-15 && (least.time - 0.25).abs() < 1e-7);
/// assert!(least.lower <= 0.5 && 0.5 <= least.upper && least.upper - least.lower < 1e-8);
/// assert_eq!(least.status, gjk_raycast::Status::Converged);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Motions are those of [`motion_cast`](crate::motion_cast()). The lower bound is proved for all times up to the end,
/// not only for those examined, and the upper bound is that of the distance at the answer's `time`. If the bodies meet,
/// the distance is 0, and the time is that of their first contact, of which [`motion_cast`](crate::motion_cast())
/// has a bracket.
///
/// A minimum takes about fifteen times examined, of which the search for it takes about ten and the proof about five.
/// Around a time at which the distance is about the least, the shortest proved interval is as long as the fourth root
/// of the [tolerance](MotionClearanceOptions::tolerance) if both motions are [rigid](crate::RigidMotion), and as its
/// square root for other motions and over half-spaces.
///
/// # Errors
/// [`RayCastError::NonFinite`] if a number of a [`RigidMotion`](crate::RigidMotion) is not finite, the
/// [end](MotionClearanceOptions::max_time) is not finite, or the tolerance is NaN.
pub fn motion_clearance<A, B>(
    a: &A,
    motion_a: impl Trajectory<Vector = A::Vector>,
    b: &B,
    motion_b: impl Trajectory<Vector = A::Vector>,
    options: MotionClearanceOptions<A::Vector>,
) -> Result<MotionClearance<A::Vector>, RayCastError>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    motion_clearance_with(a, motion_a, b, motion_b, options, |_| {})
}

/// [`motion_clearance`] with an observer that sees every time examined. Up to the time `lower` of an iterate the bodies
/// are proved to be farther apart than the lower bound of the answer.
///
/// # Errors
/// Those of [`motion_clearance`].
pub fn motion_clearance_with<A, B>(
    a: &A,
    motion_a: impl Trajectory<Vector = A::Vector>,
    b: &B,
    motion_b: impl Trajectory<Vector = A::Vector>,
    options: MotionClearanceOptions<A::Vector>,
    observer: impl FnMut(MotionIterate<A::Vector>),
) -> Result<MotionClearance<A::Vector>, RayCastError>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    clearance_within(a, motion_a, b, motion_b, options, ScalarOf::<A>::infinity(), observer)
}

/// [`motion_clearance_with`], where distances beyond a limit are all the same: if the bodies never come nearer, this is
/// the lower bound, and the upper one is infinite.
pub(crate) fn clearance_within<A, B>(
    a: &A,
    motion_a: impl Trajectory<Vector = A::Vector>,
    b: &B,
    motion_b: impl Trajectory<Vector = A::Vector>,
    options: MotionClearanceOptions<A::Vector>,
    limit: ScalarOf<A>,
    mut observer: impl FnMut(MotionIterate<A::Vector>),
) -> Result<MotionClearance<A::Vector>, RayCastError>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    let mut options = options.checked()?;
    check("motion_a", &motion_a)?;
    check("motion_b", &motion_b)?;
    // Bodies with the same motion stay as far apart as they are.
    let is_alike = motion_a.as_rigid_motion().is_some_and(|motion| motion_b.as_rigid_motion() == Some(motion));
    if is_alike {
        options.max_time = Scalar::ZERO;
    }
    Ok(by_search(&Both::<_, _>::new(a, b), [&motion_a, &motion_b], options, limit, &mut observer))
}

compiled_once! {
    /// The least distance of two bodies.
    fn by_search<V>(
        shapes: &dyn Shapes<Vector = V>,
        motions: [&dyn Trajectory<Vector = V>; 2],
        options: MotionClearanceOptions<V>,
        limit: V::Scalar,
        observer: &mut dyn FnMut(MotionIterate<V>),
    ) -> MotionClearance<V> {
        MotionClearance::of(&mut MovingPair::new(shapes, motions, &options.of_cast()), options, limit, observer)
    }
}

/// Options of [`motion_clearance`](crate::motion_clearance).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct MotionClearanceOptions<V: Vector> {
    /// The end of the motion; it belongs to the motion. It has to be set, since no finite search can tell the least
    /// distance over an infinite time. A negative value is taken for zero. Default: infinity, which is an error.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub max_time: V::Scalar,
    /// The width of the bracket at which to stop, relative to the distance. A bracket at the level of rounding always
    /// ends the search. Whatever it is, the distance is that of a local minimum to rounding. A negative value is taken
    /// for zero. Default: the root of the machine epsilon, since the time of a minimum is not known better.
    pub tolerance: V::Scalar,
    /// A first guess of the direction from `b` to `a` at the start. Default: none.
    pub axis: Option<V>,
    /// The number of times to examine, after which to give up. After half of them the bracket is allowed a width of a
    /// thousandth of the distance. Default: 100 000.
    pub max_iterations: usize,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) rare: Rare<MotionCastOptions<V>>,
}

impl<V: Vector> Default for MotionClearanceOptions<V> {
    fn default() -> Self {
        Self { rare: MotionCastOptions::new().rare, ..Self::lean() }
    }
}

impl<V: Vector> MotionClearanceOptions<V> {
    /// The default options without the machine code that [`MotionCastOptions::lean`] leaves out.
    #[must_use]
    pub fn lean() -> Self {
        let MotionCastOptions { max_time, axis, rare, .. } = MotionCastOptions::lean();
        Self { max_time, tolerance: V::Scalar::EPSILON.sqrt(), axis, max_iterations: MAX_LOOKS_FOR_LEAST, rare }
    }

    /// The options, if they are numbers, with an end that is not negative.
    pub(crate) fn checked(self) -> Result<Self, RayCastError> {
        let Self { tolerance, .. } = self;
        let MotionCastOptions { max_time, .. } = checked(MotionCastOptions { tolerance, ..self.of_cast() })?;
        if max_time == V::Scalar::infinity() {
            return Err(RayCastError::NonFinite { parameter: "max_time", index: 0 });
        }
        Ok(Self { max_time, ..self })
    }

    /// The options of the search for a first contact.
    fn of_cast(&self) -> MotionCastOptions<V> {
        let &Self { max_time, axis, max_iterations, rare, .. } = self;
        MotionCastOptions { max_time, axis, max_iterations, rare, ..MotionCastOptions::lean() }
    }
}

options! {
    MotionClearanceOptions: with_max_time(max_time: V::Scalar), with_tolerance(tolerance: V::Scalar),
    with_axis(axis: V => axis = Some(axis)), with_max_iterations(max_iterations: usize)
}

/// The answer of [`motion_clearance`](crate::motion_clearance).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "V: crate::data::VectorData")))]
#[cfg_attr(feature = "serde", serde(bound(deserialize = "V: crate::data::VectorData")))]
pub struct MotionClearance<V: Vector> {
    /// The least distance found, between the bounds: that of the bodies at `time`; 0 if they meet.
    pub distance: V::Scalar,
    /// At no time are the bodies nearer than this. It is 0 if the search ended before the end of the motion.
    pub lower: V::Scalar,
    /// At `time` they are no farther apart than this. It is infinite if nothing is known, as with a support map that
    /// returns NaN.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub upper: V::Scalar,
    /// A time at which they are that near: before it they are farther apart than `lower`. If they meet, it is the time
    /// of the first contact.
    pub time: V::Scalar,
    /// The point of `a` that is closest to `b` at that time, in the world. If the bodies meet, it is the point of
    /// contact, as in [`Impact`](crate::Impact).
    pub point_a: V,
    /// The closest point of `b`.
    pub point_b: V,
    /// The unit normal out of `b` towards `a` at that time. It is `None` if the bodies overlap at the start by more
    /// than rounding.
    pub normal: Option<V>,
    /// How the search ended.
    pub status: Status,
    /// The number of support points computed of each shape.
    pub iterations: usize,
}

impl<V: Vector> MotionClearance<V> {
    pub(super) fn of(
        bodies: &mut dyn Approach<V>,
        options: MotionClearanceOptions<V>,
        limit: V::Scalar,
        observer: &mut dyn FnMut(MotionIterate<V>),
    ) -> Self {
        let (zero, number) = (V::Scalar::ZERO, V::Scalar::from_f64);
        if limit < V::Scalar::infinity() {
            bodies.aim(limit);
            if bodies.stays_far_apart([zero, options.max_time]).is_some() {
                return Self::beyond(limit, 0);
            }
            bodies.aim(zero);
        }
        let relative = MotionCastOptions { tolerance: options.tolerance, ..options.of_cast() };
        let (end, search) = LeastSearch::run(&mut *bodies, relative, limit, observer);
        let (least, target, proved, looks) = (search.least, search.target, search.proved, search.looks);
        bodies.aim(zero);
        let there = (least.time, Some(least.normal));
        let answer = match end {
            LeastEnd::Proved if target == limit || limit == zero => return Self::beyond(limit, bodies.iterations()),
            // If there is only one time, its distance is the least.
            LeastEnd::Proved if options.max_time == zero => Self::at(bodies, there, None, Status::Converged),
            LeastEnd::Proved => Self::at(bodies, there, Some(target), Status::Converged),
            LeastEnd::Touching => Self::of_touching(bodies, options, there, (proved, looks), observer),
            LeastEnd::OutOfRange => Self::at(bodies, (zero, None), Some(zero), Status::Stalled),
            LeastEnd::IterationLimit => Self::at(bodies, there, Some(zero), Status::IterationLimit),
        };
        let rounding =
            (bodies.size() * V::Scalar::EPSILON * number(NARROW_AT_END)).max(least.error * number(NARROW_OF_ERROR));
        let is_narrow = answer.upper - answer.lower <= rounding.max(options.tolerance * answer.upper);
        let status = if answer.status == Status::Converged && !is_narrow { Status::Stalled } else { answer.status };
        Self { status, ..answer }
    }

    /// The answer about bodies that may touch, by the search for their first contact. As far as is known they are
    /// nearest at the time `least`, with a guess of the normal then; up to the time `proved` they are apart.
    fn of_touching(
        bodies: &mut dyn Approach<V>,
        options: MotionClearanceOptions<V>,
        least: (V::Scalar, Option<V>),
        (proved, looks): (V::Scalar, usize),
        observer: &mut dyn FnMut(MotionIterate<V>),
    ) -> Self {
        let zero = V::Scalar::ZERO;
        let mut show = |there: MotionIterate<V>| {
            observer(MotionIterate { iteration: there.iteration + looks, lower: there.lower.max(proved), ..there });
        };
        let cast = Search::run(bodies, options.of_cast(), None, &mut show);
        let at_most = |time, status| Self::at(bodies, time, Some(zero), status);
        match cast.outcome {
            Outcome::Hit(Impact { time, point, normal }) if cast.is_certain() => {
                let (distance, lower, upper, point_a, point_b) = (zero, zero, zero, point, point);
                let Cast { status, iterations, .. } = cast;
                Self { distance, lower, upper, time, point_a, point_b, normal, status, iterations }
            }
            Outcome::Hit(Impact { time, normal, .. }) => Self { normal, ..at_most((time, None), Status::Stalled) },
            Outcome::Miss(_) => at_most(least, Status::Converged),
            Outcome::Undecided => {
                // The last time at which the bodies are apart may be that of a contact that is not certain.
                let [last, least] = [(cast.lower, None), least].map(|time| at_most(time, cast.status));
                if last.upper < least.upper { last } else { least }
            }
        }
    }

    /// The answer that the bodies never come nearer than a limit.
    fn beyond(limit: V::Scalar, iterations: usize) -> Self {
        let (time, point_a, point_b, normal) = (V::Scalar::ZERO, V::ZERO, V::ZERO, None);
        let (distance, status) = (limit, Status::Converged);
        Self {
            distance,
            lower: limit,
            upper: V::Scalar::infinity(),
            time,
            point_a,
            point_b,
            normal,
            status,
            iterations,
        }
    }

    /// The answer that the bodies' distance at a time is the least, with a lower bound for all times, or none if there
    /// is no other time. The first guess of the normal at that time may be given.
    fn at(
        bodies: &dyn Approach<V>,
        (time, axis): (V::Scalar, Option<V>),
        lower: Option<V::Scalar>,
        status: Status,
    ) -> Self {
        let there = bodies.distance(time, axis);
        let lower = lower.unwrap_or(there.lower);
        let is_known = there.upper.is_finite();
        let (upper, iterations) = (if is_known { there.upper } else { V::Scalar::infinity() }, bodies.iterations());
        let distance = if is_known { there.distance.max(lower).min(upper) } else { upper };
        let Distance { point_a, point_b, normal, .. } = there;
        Self { distance, lower, upper, time, point_a, point_b, normal, status, iterations }
    }
}
