//! The first contact of two bodies that move and turn.

use super::first_contact::Search;
use super::moving_pair::MovingPair;
use super::trajectory::{RigidMotion, Trajectory};
use crate::linear_cast::as_body;
use crate::outcome::{check_finite, check_limits, check_numbers};
use crate::pair::{Both, Shapes};
use crate::{Motion, MotionCast, MotionCastOptions, MotionIterate, RayCastError};
use convex_support::{AngularVelocity, Scalar, SupportMap, Vector, compiled_once};
use num_traits::Float as _;

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
#[doc(alias("nonlinear_shape_cast", "continuous_collision", "ccd", "toi", "conservative_advancement"))]
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
            if let Some(rare) = options.rare.0 {
                let cast = as_body(a, b, options.target_distance, |body, shapes, cores| {
                    (rare.straight)(body, shapes, cores, motion, &options.straight())
                });
                return Ok(MotionCast { lower: cast.lower.min(options.max_time), ..cast });
            }
        }
    }
    Ok(by_search(&Both::<_, _>::new(a, b), [&motion_a, &motion_b], options, &mut observer))
}

compiled_once! {
    /// The first contact of bodies that turn.
    fn by_search<V>(
        shapes: &dyn Shapes<Vector = V>,
        motions: [&dyn Trajectory<Vector = V>; 2],
        options: MotionCastOptions<V>,
        observer: &mut dyn FnMut(MotionIterate<V>),
    ) -> MotionCast<V> {
        let begin_in_contact = options.rare.0.map(|rare| rare.begin_in_contact);
        Search::run(&mut MovingPair::new(shapes, motions, &options), options, begin_in_contact, observer)
    }
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
