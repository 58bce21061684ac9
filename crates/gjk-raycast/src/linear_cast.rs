//! When two shapes meet that move without turning.

use convex_support::{SupportMap, Vector};

use crate::body::Pair;
use crate::cast::{CastHit, cast};
use crate::ray::check_finite;
use crate::{
    Distance, DistanceOptions, Iterate, LinearCast, LinearCastOptions, LinearHit, Outcome, Ray, RayCastError,
    RayCastOptions, distance_with,
};

/// The velocities of two shapes, in units of length per unit of time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion<V> {
    /// The velocity of `a`.
    pub velocity_a: V,
    /// The velocity of `b`.
    pub velocity_b: V,
}

impl<V: Vector> Motion<V> {
    /// The error of a motion that is none.
    pub(crate) fn check(&self) -> Result<(), RayCastError> {
        check_finite("velocity_a", self.velocity_a)?;
        check_finite("velocity_b", self.velocity_b)
    }
}

/// When two shapes first touch that move at constant velocities without turning, and where.
///
/// A ray is cast against their configuration space obstacle: `A + t·v_A` and `B + t·v_B` have a point in common just
/// where `t·(v_B − v_A)` is in `A − B`. Where the velocities are equal, the shapes hit only if they overlap.
///
/// ```
/// use convex_support::{Ball, Posed, glam::DVec2};
/// use gjk_raycast::{LinearCastOptions, Motion, linear_cast};
///
/// let fast = Ball::new(0.5)?;
/// let slow = Posed::translated(Ball::new(0.5)?, DVec2::new(4.0, 0.0))?;
/// let motion = Motion { velocity_a: DVec2::new(3.0, 0.0), velocity_b: DVec2::new(1.0, 0.0) };
/// let hit = linear_cast(&fast, &slow, motion, LinearCastOptions::default())?.outcome.hit().ok_or("they meet")?;
/// assert_eq!((hit.time, hit.point, hit.normal), (1.5, DVec2::new(5.0, 0.0), Some(DVec2::NEG_X)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RayCastError::NonFinite`] if a velocity is not finite.
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
    linear_cast_with(a, b, motion, options, |_| {})
}

/// [`linear_cast`], showing an observer every iterate.
///
/// # Errors
/// [`RayCastError::NonFinite`] if a velocity is not finite.
pub fn linear_cast_with<A, B>(
    a: &A,
    b: &B,
    motion: Motion<A::Vector>,
    options: LinearCastOptions<A::Vector>,
    observer: impl FnMut(Iterate<'_, A::Vector>),
) -> Result<LinearCast<A::Vector>, RayCastError>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    motion.check()?;
    let mut body = Pair::new(a, b);
    let (core_a, core_b) = (a.core(), b.core());
    let mut wanted = RayCastOptions::new()
        .with_max_lambda(options.max_time)
        .with_tolerance(options.tolerance)
        .with_max_iterations(options.max_iterations)
        .with_sub_algorithm(options.sub_algorithm)
        .with_method(options.method);
    // Seen from b, a is at the outside of the obstacle: normals of A − B point out of a.
    wanted.axis = options.axis.map(|axis| -axis);
    // The ray starts at zero, where both shapes are in place: at b's origin, seen from a's.
    let mut ray = Ray { source: core_b.origin, direction: motion.velocity_b - motion.velocity_a };
    if ray.direction == A::Vector::ZERO {
        // Only the start counts, and any ray of length zero is the start.
        ray.direction = (core_a.origin - core_b.origin).unit().unwrap_or_else(|| A::Vector::axis(0));
        wanted.max_lambda = <A::Vector as Vector>::Scalar::default();
    }
    let cast = cast(&mut body, ray, wanted, observer);
    let mut iterations = cast.iterations;
    let outcome = match cast.outcome {
        Outcome::Hit(CastHit { lambda: time, normal, spot, witness }) => {
            let zero = <A::Vector as Vector>::Scalar::default();
            let point = if normal.is_none() && time == zero {
                // The cast knows where the motion enters, which is behind the start or, sliding, ahead of it.
                let start = start(a, b, options);
                iterations += start.iterations;
                start.point_b
            } else {
                // With p a point of a's core and q one of b's, q − p + spot is what lies between them at the time, and is as
                // long as both radii. The point that divides it as they do is on both shapes, however well the normal is known.
                let between = (witness.b - witness.a + spot) * cast.scale;
                let share = if core_b.radius > zero { core_b.radius / (core_a.radius + core_b.radius) } else { zero };
                core_b.origin + witness.b * cast.scale + motion.velocity_b * time - between * share
            };
            Outcome::Hit(LinearHit { time, point, normal: normal.map(|n| -n) })
        }
        Outcome::Miss(mut miss) => {
            miss.axis = -miss.axis;
            Outcome::Miss(miss)
        }
        Outcome::Undecided => Outcome::Undecided,
    };
    Ok(LinearCast { outcome, lower: cast.lower, upper: cast.upper, status: cast.status, iterations })
}

/// The distance at the start. Its observer is one of its own, so that the compiler makes it apart from the distances that
/// users ask for, which are slower where they share their code with it.
#[cold]
#[inline(never)]
fn start<A, B>(a: &A, b: &B, options: LinearCastOptions<A::Vector>) -> Distance<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    let wanted = DistanceOptions::new().with_max_iterations(options.max_iterations);
    distance_with(a, b, wanted.with_sub_algorithm(options.sub_algorithm), |_| {})
}
