//! The workloads answered by this workspace, in either precision. Each method is compiled for each pair of types here and nowhere
//! else: what calls these functions is not generic.

use convex_support::glam::{DQuat, DVec3, Quat, Vec3A};
use convex_support::{
    Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Faceted, InvalidShape, Polytope, Posed, Rounded, Scalar,
    SupportMap, Vector3, line_crossing,
};
use gjk_raycast::{
    CastMethod, DistanceOptions, IntersectOptions, LinearCastOptions, Motion, MotionCastOptions, Outcome,
    RayCastOptions, RigidMotion, SignedDistanceOptions, Status, SubAlgorithm, distance, intersects, linear_cast,
    motion_cast, ray_cast, signed_distance,
};

use workloads::Pose;
use workloads::pairs::Pair;
use workloads::score::Precision;
use workloads::shapes::Shape;
use workloads::vec3::Vec3;
use workloads::w1_ray_cast::Ray;
use workloads::w2_linear_cast::Cast;
use workloads::w3_distance::DistanceQuery;
use workloads::w3b_intersect::IntersectQuery;
use workloads::w6_motion_cast::TurningCast;

use crate::measure::Solver;

/// The vectors that are measured.
trait Space: Vector3 {
    /// A rotation from a unit quaternion.
    fn rotation(q: workloads::vec3::Quat) -> Self::Rotation;
}

impl Space for DVec3 {
    fn rotation(q: workloads::vec3::Quat) -> DQuat {
        DQuat::from_array(q)
    }
}

impl Space for Vec3A {
    #[allow(clippy::cast_possible_truncation, reason = "rounding to the nearest f32 is the purpose")]
    fn rotation(q: workloads::vec3::Quat) -> Quat {
        Quat::from_array(q.map(|x| x as f32))
    }
}

fn number<V: Space>(x: f64) -> V::Scalar {
    V::Scalar::from_f64(x)
}

fn vector<V: Space>(v: Vec3) -> V {
    V::from_fn(|i| number::<V>(v[i]))
}

/// Why a shape of the workloads should always be one.
const VALID: &str = "the shapes and poses of the workloads are valid";

/// How hard `gjk-raycast` is to try, and what its solvers are to tell. By default its own options, and the answer.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// The relative tolerance; rounding ends the iteration in any case.
    pub tolerance: f64,
    /// The iterations after which to give up.
    pub max_iterations: usize,
    /// How the closest point of a simplex is found.
    pub sub_algorithm: SubAlgorithm,
    /// How the planes of a ray cast are found.
    pub method: CastMethod,
    /// Whether the support points that were computed of each body are told in place of the answer.
    pub iterations: bool,
    /// Whether shapes come as `Box<dyn SupportMap>`.
    pub boxed: bool,
}

impl Default for Effort {
    fn default() -> Self {
        let options = DistanceOptions::<DVec3>::default();
        Self {
            tolerance: options.tolerance,
            max_iterations: options.max_iterations,
            sub_algorithm: options.sub_algorithm,
            method: RayCastOptions::<DVec3>::default().method,
            iterations: false,
            boxed: false,
        }
    }
}

impl Effort {
    /// What a solver answers.
    fn tell(self, answer: f64, iterations: usize) -> f64 {
        if self.iterations { iterations as f64 } else { answer }
    }
}

/// Ray casts by GJK.
#[must_use]
pub fn ray_casts(precision: Precision, shape: &Shape, rays: &[Ray], effort: Effort) -> Solver {
    match precision {
        Precision::Double => ray_casts_in::<DVec3>(shape, rays, effort),
        Precision::Single => ray_casts_in::<Vec3A>(shape, rays, effort),
    }
}

fn ray_casts_in<V: Space>(shape: &Shape, rays: &[Ray], effort: Effort) -> Solver {
    struct Cast<'a>(&'a [Ray], Effort);
    impl<V: Space> Task<V> for Cast<'_> {
        fn solver<S: SupportMap<Vector = V> + 'static>(self, target: S) -> Solver {
            let rays = self
                .0
                .iter()
                .map(|ray| gjk_raycast::Ray { source: vector(ray.origin), direction: vector(ray.direction) });
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
    with_shape::<V, _>(shape, Cast(rays, effort), effort.boxed)
}

/// Ray casts in closed form.
#[must_use]
pub fn closed_form_ray_casts(precision: Precision, shape: &Shape, rays: &[Ray]) -> Solver {
    match precision {
        Precision::Double => closed_form_ray_casts_in::<DVec3>(shape, rays),
        Precision::Single => closed_form_ray_casts_in::<Vec3A>(shape, rays),
    }
}

fn closed_form_ray_casts_in<V: Space>(shape: &Shape, rays: &[Ray]) -> Solver {
    fn solver<S: SupportMap<Vector: Space> + 'static>(target: Result<S, InvalidShape>, rays: &[Ray]) -> Solver {
        let target = target.expect(VALID);
        let rays = rays.iter().map(|ray| (vector(ray.origin), vector(ray.direction))).collect();
        Solver::new(rays, move |&(source, direction): &(S::Vector, S::Vector)| {
            let crossing = line_crossing(&target, source, direction).crossing();
            let hit = crossing.and_then(|crossing| crossing.first_hit(Scalar::ONE));
            hit.map_or(f64::INFINITY, Scalar::as_f64)
        })
    }
    match *shape {
        Shape::Ball { radius } => solver(Ball::<V>::new(number::<V>(radius)), rays),
        Shape::Cuboid { half_extents } => solver(Cuboid::<V>::new(vector(half_extents)), rays),
        Shape::Cylinder { half_height, radius } => {
            solver(Cylinder::<V>::new(number::<V>(half_height), number::<V>(radius)), rays)
        }
        Shape::Cone { half_height, radius } => {
            solver(Cone::<V>::new(number::<V>(half_height), number::<V>(radius)), rays)
        }
        Shape::Capsule { half_height, radius } => {
            solver(Capsule::<V>::new(number::<V>(half_height), number::<V>(radius)), rays)
        }
        Shape::Ellipsoid { semi_axes } => {
            solver(Ellipsoid::<V>::new(V::ZERO, vector(semi_axes), V::Rotation::default()), rays)
        }
        Shape::RoundBox { half_extents, radius } => solver(
            Cuboid::<V>::new(vector(half_extents)).and_then(|core| Rounded::new(core, number::<V>(radius))),
            rays,
        ),
        Shape::Hull { ref points } => solver(Faceted::<V>::hull_of(points.iter().map(|&p| vector(p))), rays),
    }
}

/// Linear casts. The body is posed within the measurement: every query comes with a new pose.
#[must_use]
pub fn linear_casts(precision: Precision, pair: &Pair, casts: &[Cast], effort: Effort) -> Solver {
    match precision {
        Precision::Double => linear_casts_in::<DVec3>(pair, casts, effort),
        Precision::Single => linear_casts_in::<Vec3A>(pair, casts, effort),
    }
}

fn linear_casts_in<V: Space>(pair: &Pair, casts: &[Cast], effort: Effort) -> Solver {
    struct Task<'a>(&'a [Cast], Effort);
    impl<V: Space> PairTask<V> for Task<'_> {
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
    with_pair::<V, _>(pair, Task(casts, effort), effort.boxed)
}

/// Casts of a body that turns. The body is posed within the measurement.
#[must_use]
pub fn motion_casts(pair: &Pair, casts: &[TurningCast], effort: Effort) -> Solver {
    struct Task<'a>(&'a [TurningCast], Effort);
    impl PairTask<DVec3> for Task<'_> {
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
    with_pair::<DVec3, _>(pair, Task(casts, effort), effort.boxed)
}

/// Signed distances.
#[must_use]
pub fn signed_distances(pair: &Pair, queries: &[IntersectQuery], effort: Effort) -> Solver {
    struct Task<'a>(&'a [IntersectQuery], Effort);
    impl PairTask<DVec3> for Task<'_> {
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
    with_pair::<DVec3, _>(pair, Task(queries, effort), effort.boxed)
}

/// Distances.
#[must_use]
pub fn distances(precision: Precision, pair: &Pair, queries: &[DistanceQuery], effort: Effort) -> Solver {
    match precision {
        Precision::Double => distances_in::<DVec3>(pair, queries, effort),
        Precision::Single => distances_in::<Vec3A>(pair, queries, effort),
    }
}

fn distances_in<V: Space>(pair: &Pair, queries: &[DistanceQuery], effort: Effort) -> Solver {
    struct Task<'a>(&'a [DistanceQuery], Effort);
    impl<V: Space> PairTask<V> for Task<'_> {
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
    with_pair::<V, _>(pair, Task(queries, effort), effort.boxed)
}

/// Intersection tests; `warm` ones are given the axis, if any, that the same query answered with before.
#[must_use]
pub fn intersections(
    precision: Precision,
    pair: &Pair,
    queries: &[IntersectQuery],
    warm: bool,
    effort: Effort,
) -> Solver {
    match precision {
        Precision::Double => intersections_in::<DVec3>(pair, queries, warm, effort),
        Precision::Single => intersections_in::<Vec3A>(pair, queries, warm, effort),
    }
}

fn intersections_in<V: Space>(pair: &Pair, queries: &[IntersectQuery], warm: bool, effort: Effort) -> Solver {
    struct Task<'a>(&'a [IntersectQuery], bool, Effort);
    impl<V: Space> PairTask<V> for Task<'_> {
        fn solver<A, B>(self, a: A, b: B) -> Solver
        where
            A: SupportMap<Vector = V> + 'static,
            B: SupportMap<Vector = V> + 'static,
        {
            let Self(queries, warm, effort) = self;
            let ask = move |(rotation, translation), options| {
                let b = Posed::new(&b, rotation, translation).expect(VALID);
                intersects(&a, &b, options)
            };
            let prepared = queries.iter().map(|query| {
                let (pose, cold) = (placed::<V>(query.pose), IntersectOptions::default());
                let axis = if warm { ask(pose, cold).axis } else { None };
                let options = axis.map_or(cold, |axis| cold.with_axis(axis));
                let options = options.with_max_iterations(effort.max_iterations);
                (pose, options.with_sub_algorithm(effort.sub_algorithm))
            });
            Solver::new(prepared.collect(), move |&(pose, options)| {
                let answer = ask(pose, options);
                let value = match answer.status {
                    Status::Converged => f64::from(u8::from(answer.overlap)),
                    Status::IterationLimit | Status::Stalled => f64::NAN,
                };
                effort.tell(value, answer.iterations)
            })
        }
    }
    with_pair::<V, _>(pair, Task(queries, warm, effort), effort.boxed)
}

fn placed<V: Space>(pose: Pose) -> (V::Rotation, V) {
    (V::rotation(pose.rotation), vector(pose.translation))
}

/// Makes a solver from a shape of any type.
trait Task<V: Space> {
    fn solver<S: SupportMap<Vector = V> + 'static>(self, shape: S) -> Solver;
}

/// Makes a solver from two shapes of any types.
trait PairTask<V: Space> {
    fn solver<A, B>(self, a: A, b: B) -> Solver
    where
        A: SupportMap<Vector = V> + 'static,
        B: SupportMap<Vector = V> + 'static;
}

/// Makes a task's solver from shapes behind `dyn SupportMap`.
struct Boxed<T>(T);

impl<V: Space, T: Task<V>> Task<V> for Boxed<T> {
    fn solver<S: SupportMap<Vector = V> + 'static>(self, shape: S) -> Solver {
        self.0.solver(boxed(shape))
    }
}

impl<V: Space, T: PairTask<V>> PairTask<V> for Boxed<T> {
    fn solver<A, B>(self, a: A, b: B) -> Solver
    where
        A: SupportMap<Vector = V> + 'static,
        B: SupportMap<Vector = V> + 'static,
    {
        self.0.solver(boxed(a), boxed(b))
    }
}

fn boxed<S: SupportMap + 'static>(shape: S) -> Box<dyn SupportMap<Vector = S::Vector>> {
    Box::new(shape)
}

fn with_shape<V: Space, T: Task<V>>(shape: &Shape, task: T, is_boxed: bool) -> Solver {
    if is_boxed { with_typed_shape(shape, Boxed(task)) } else { with_typed_shape(shape, task) }
}

fn with_typed_shape<V: Space, T: Task<V>>(shape: &Shape, task: T) -> Solver {
    match shape {
        Shape::Ball { radius } => task.solver(ball::<V>(*radius)),
        Shape::Cuboid { half_extents } => task.solver(cuboid::<V>(*half_extents)),
        Shape::Cylinder { half_height, radius } => task.solver(cylinder::<V>(*half_height, *radius)),
        Shape::Cone { half_height, radius } => task.solver(cone::<V>(*half_height, *radius)),
        Shape::Capsule { half_height, radius } => task.solver(capsule::<V>(*half_height, *radius)),
        Shape::Ellipsoid { semi_axes } => task.solver(ellipsoid::<V>(*semi_axes)),
        Shape::Hull { points } => task.solver(hull::<V>(points)),
        Shape::RoundBox { half_extents, radius } => task.solver(round_box::<V>(*half_extents, *radius)),
    }
}

fn with_pair<V: Space, T: PairTask<V>>(pair: &Pair, task: T, is_boxed: bool) -> Solver {
    if is_boxed { with_typed_pair(pair, Boxed(task)) } else { with_typed_pair(pair, task) }
}

/// # Panics
/// For two shapes that are no pair of the workloads.
fn with_typed_pair<V: Space, T: PairTask<V>>(pair: &Pair, task: T) -> Solver {
    match (&pair.a, &pair.b) {
        (Shape::Ball { radius }, Shape::Cuboid { half_extents }) => {
            task.solver(ball::<V>(*radius), cuboid::<V>(*half_extents))
        }
        (Shape::Cuboid { half_extents: a }, Shape::Cuboid { half_extents: b }) => {
            task.solver(cuboid::<V>(*a), cuboid::<V>(*b))
        }
        (Shape::Cylinder { half_height: h, radius: r }, Shape::Cone { half_height, radius }) => {
            task.solver(cylinder::<V>(*h, *r), cone::<V>(*half_height, *radius))
        }
        (Shape::Capsule { half_height, radius }, Shape::Ellipsoid { semi_axes }) => {
            task.solver(capsule::<V>(*half_height, *radius), ellipsoid::<V>(*semi_axes))
        }
        (Shape::Ellipsoid { semi_axes: a }, Shape::Ellipsoid { semi_axes: b }) => {
            task.solver(ellipsoid::<V>(*a), ellipsoid::<V>(*b))
        }
        (Shape::Hull { points: a }, Shape::Hull { points: b }) => task.solver(hull::<V>(a), hull::<V>(b)),
        (Shape::RoundBox { half_extents: a, radius: r }, Shape::RoundBox { half_extents: b, radius: s }) => {
            task.solver(round_box::<V>(*a, *r), round_box::<V>(*b, *s))
        }
        (Shape::Cuboid { half_extents }, Shape::Hull { points }) => {
            task.solver(cuboid::<V>(*half_extents), hull::<V>(points))
        }
        (Shape::Capsule { half_height: h, radius: r }, Shape::Capsule { half_height, radius }) => {
            task.solver(capsule::<V>(*h, *r), capsule::<V>(*half_height, *radius))
        }
        pair => panic!("no pair of the workloads: {pair:?}"),
    }
}

fn ball<V: Space>(radius: f64) -> Ball<V> {
    Ball::new(number::<V>(radius)).expect(VALID)
}

fn cuboid<V: Space>(half_extents: Vec3) -> Cuboid<V> {
    Cuboid::new(vector(half_extents)).expect(VALID)
}

fn cylinder<V: Space>(half_height: f64, radius: f64) -> Cylinder<V> {
    Cylinder::new(number::<V>(half_height), number::<V>(radius)).expect(VALID)
}

fn cone<V: Space>(half_height: f64, radius: f64) -> Cone<V> {
    Cone::new(number::<V>(half_height), number::<V>(radius)).expect(VALID)
}

fn capsule<V: Space>(half_height: f64, radius: f64) -> Capsule<V> {
    Capsule::new(number::<V>(half_height), number::<V>(radius)).expect(VALID)
}

fn ellipsoid<V: Space>(semi_axes: Vec3) -> Ellipsoid<V> {
    Ellipsoid::new(V::ZERO, vector(semi_axes), V::Rotation::default()).expect(VALID)
}

fn hull<V: Space>(points: &[Vec3]) -> Polytope<V> {
    Polytope::hull_of(points.iter().map(|&p| vector(p))).expect(VALID)
}

fn round_box<V: Space>(half_extents: Vec3, radius: f64) -> Rounded<Cuboid<V>> {
    Rounded::new(cuboid(half_extents), number::<V>(radius)).expect(VALID)
}
