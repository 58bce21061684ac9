//! Queries of the workloads, as they are put to two shapes of any types.

use convex_support::glam::DVec3;
use convex_support::{CrossedByLine, Posed, Scalar, SupportMap, line_crossing};
use gjk_raycast::{
    DistanceOptions, IntersectOptions, LinearCastOptions, Motion, MotionCastOptions, Outcome, RayCastOptions,
    RigidMotion, SignedDistanceOptions, Status, distance, intersects, linear_cast, motion_cast, ray_cast,
    signed_distance,
};
use workloads::Pose;
use workloads::shapes::Shape;
use workloads::w1_ray_cast::Ray;
use workloads::w2_linear_cast::Cast;
use workloads::w3_distance::DistanceQuery;
use workloads::w3b_intersect::IntersectQuery;
use workloads::w6_motion_cast::TurningCast;

use super::Effort;
use super::shapes::{OfWorkload, PairTask, Space, Task, VALID, number, vector};
use crate::measure::Solver;

/// Ray casts by GJK.
#[derive(Clone, Copy, Debug)]
pub struct RayCasts<'a>(pub &'a [Ray], pub Effort);

impl<V: Space> Task<V> for RayCasts<'_> {
    fn solver<S: SupportMap<Vector = V> + 'static>(self, target: S) -> Solver {
        let rays =
            self.0.iter().map(|ray| gjk_raycast::Ray { source: vector(ray.origin), direction: vector(ray.direction) });
        let effort = self.1;
        let options = RayCastOptions::default()
            .with_max_lambda(V::Scalar::ONE)
            .with_tolerance(number::<V>(effort.tolerance))
            .with_max_iterations(effort.max_iterations)
            .with_sub_algorithm(effort.sub_algorithm)
            .with_method(effort.method);
        Solver::new(rays.collect(), move |&ray| {
            let Ok(cast) = ray_cast(&target, ray, options) else { return f64::NAN };
            let answer = match cast.outcome {
                Outcome::Hit(hit) => hit.lambda.as_f64(),
                Outcome::Miss(_) => f64::INFINITY,
                Outcome::Undecided => f64::NAN,
            };
            effort.tell(answer, cast.iterations)
        })
    }
}

/// Ray casts in closed form.
pub(super) fn crossings<S: CrossedByLine<Vector: Space> + OfWorkload>(shape: &Shape, rays: &[Ray]) -> Solver {
    let target = S::of(shape).expect(VALID);
    let rays = rays.iter().map(|ray| (vector(ray.origin), vector(ray.direction))).collect();
    Solver::new(rays, move |&(source, direction): &(S::Vector, S::Vector)| {
        let crossing = line_crossing(&target, source, direction).crossing();
        let hit = crossing.and_then(|crossing| crossing.first_hit(Scalar::ONE));
        hit.map_or(f64::INFINITY, Scalar::as_f64)
    })
}

/// Linear casts. The body is posed within the measurement: every query comes with a new pose.
#[derive(Clone, Copy, Debug)]
pub struct LinearCasts<'a>(pub &'a [Cast], pub Effort);

impl<V: Space> PairTask<V> for LinearCasts<'_> {
    fn solver<A, B>(self, a: A, b: B) -> Solver
    where
        A: SupportMap<Vector = V> + 'static,
        B: SupportMap<Vector = V> + 'static,
    {
        let queries = self.0.iter().map(|cast| (placed::<V>(cast.pose), vector::<V>(cast.velocity))).collect();
        let effort = self.1;
        let options = LinearCastOptions::default()
            .with_max_time(V::Scalar::ONE)
            .with_tolerance(number::<V>(effort.tolerance))
            .with_max_iterations(effort.max_iterations)
            .with_sub_algorithm(effort.sub_algorithm);
        Solver::new(queries, move |&((rotation, translation), velocity_b)| {
            let b = Posed::new(&b, rotation, translation).expect(VALID);
            let motion = Motion { velocity_a: V::ZERO, velocity_b };
            let Ok(cast) = linear_cast(&a, &b, motion, options) else { return f64::NAN };
            let answer = match cast.outcome {
                Outcome::Hit(hit) => hit.time.as_f64(),
                Outcome::Miss(_) => f64::INFINITY,
                Outcome::Undecided => f64::NAN,
            };
            effort.tell(answer, cast.iterations)
        })
    }
}

/// Casts of a body that turns. The body is posed within the measurement.
#[derive(Clone, Copy, Debug)]
pub struct MotionCasts<'a>(pub &'a [TurningCast], pub Effort);

impl PairTask<DVec3> for MotionCasts<'_> {
    fn solver<A, B>(self, a: A, b: B) -> Solver
    where
        A: SupportMap<Vector = DVec3> + 'static,
        B: SupportMap<Vector = DVec3> + 'static,
    {
        let Self(casts, effort) = self;
        let query = |cast: &TurningCast| {
            let pose = placed::<DVec3>(cast.pose);
            let (velocity, angular_velocity) = (cast.velocity.into(), cast.angular_velocity.into());
            (pose, RigidMotion { velocity, angular_velocity, center: pose.1 })
        };
        let options = MotionCastOptions::default().with_max_time(1.0);
        Solver::new(casts.iter().map(query).collect(), move |&((rotation, translation), motion)| {
            let b = Posed::new(&b, rotation, translation).expect(VALID);
            let Ok(cast) = motion_cast(&a, RigidMotion::default(), &b, motion, options) else { return f64::NAN };
            let answer = match cast.outcome {
                Outcome::Hit(hit) => hit.time,
                Outcome::Miss(_) => f64::INFINITY,
                Outcome::Undecided => f64::NAN,
            };
            effort.tell(answer, cast.iterations)
        })
    }
}

/// Signed distances.
#[derive(Clone, Copy, Debug)]
pub struct SignedDistances<'a>(pub &'a [IntersectQuery], pub Effort);

impl PairTask<DVec3> for SignedDistances<'_> {
    fn solver<A, B>(self, a: A, b: B) -> Solver
    where
        A: SupportMap<Vector = DVec3> + 'static,
        B: SupportMap<Vector = DVec3> + 'static,
    {
        let Self(queries, effort) = self;
        let queries = queries.iter().map(|query| placed::<DVec3>(query.pose)).collect();
        Solver::new(queries, move |&(rotation, translation)| {
            let b = Posed::new(&b, rotation, translation).expect(VALID);
            let answer = signed_distance(&a, &b, SignedDistanceOptions::default());
            effort.tell(answer.signed_distance, answer.iterations)
        })
    }
}

/// Distances.
#[derive(Clone, Copy, Debug)]
pub struct Distances<'a>(pub &'a [DistanceQuery], pub Effort);

impl<V: Space> PairTask<V> for Distances<'_> {
    fn solver<A, B>(self, a: A, b: B) -> Solver
    where
        A: SupportMap<Vector = V> + 'static,
        B: SupportMap<Vector = V> + 'static,
    {
        let queries = self.0.iter().map(|query| placed::<V>(query.pose)).collect();
        let effort = self.1;
        let options = DistanceOptions::default()
            .with_tolerance(number::<V>(effort.tolerance))
            .with_max_iterations(effort.max_iterations)
            .with_sub_algorithm(effort.sub_algorithm);
        Solver::new(queries, move |&(rotation, translation)| {
            let b = Posed::new(&b, rotation, translation).expect(VALID);
            let answer = distance(&a, &b, options);
            effort.tell(answer.distance.as_f64(), answer.iterations)
        })
    }
}

/// Intersection tests.
#[derive(Clone, Copy, Debug)]
pub struct Intersections<'a> {
    /// Which bodies.
    pub queries: &'a [IntersectQuery],
    /// Whether they are given the axis, if any, that the same query answered with before.
    pub is_warm: bool,
    /// How hard to try.
    pub effort: Effort,
}

impl<V: Space> PairTask<V> for Intersections<'_> {
    fn solver<A, B>(self, a: A, b: B) -> Solver
    where
        A: SupportMap<Vector = V> + 'static,
        B: SupportMap<Vector = V> + 'static,
    {
        let Self { queries, is_warm, effort } = self;
        let cold = IntersectOptions::default()
            .with_max_iterations(effort.max_iterations)
            .with_sub_algorithm(effort.sub_algorithm);
        let prepared = queries.iter().map(|query| {
            let pose = placed::<V>(query.pose);
            let axis = if is_warm { axis_of(&a, &b, pose) } else { None };
            (pose, axis.map_or(cold, |axis| cold.with_axis(axis)))
        });
        Solver::new(prepared.collect(), move |&((rotation, translation), options)| {
            let b = Posed::new(&b, rotation, translation).expect(VALID);
            let answer = intersects(&a, &b, options);
            let value = match answer.status {
                Status::Converged => f64::from(u8::from(answer.overlap)),
                Status::IterationLimit | Status::Stalled => f64::NAN,
            };
            effort.tell(value, answer.iterations)
        })
    }
}

/// The axis that separates two bodies, if they are apart. Apart from the query that is timed, which is compiled into
/// its loop.
#[inline(never)]
fn axis_of<V: Space>(
    a: &impl SupportMap<Vector = V>,
    b: &impl SupportMap<Vector = V>,
    (rotation, translation): (V::Rotation, V),
) -> Option<V> {
    let b = Posed::new(b, rotation, translation).expect(VALID);
    intersects(a, &b, IntersectOptions::default()).axis
}

/// The rotation and translation of a pose.
#[must_use]
pub fn placed<V: Space>(pose: Pose) -> (V::Rotation, V) {
    (V::rotation(pose.rotation), vector(pose.translation))
}
