// Included twice by `parry.rs`, once for each of the two crates called `parry` there.

use parry::math::{Pose, Real, Rotation, Vector};
use parry::query::gjk::{self, GJKResult, VoronoiSimplex};
use parry::query::{
    self, ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher, RayCast, ShapeCastOptions,
};
use parry::shape::{
    Ball, Capsule, Cone, ConvexPolyhedron, Cuboid, Cylinder, RoundCuboid, Shape as ParryShape, SupportMap,
};

use crate::measure::Solver;
use workloads::pairs::Pair;
use workloads::shapes::Shape;
use workloads::vec3::Vec3;
use workloads::w1_ray_cast::Ray;
use workloads::w2_linear_cast::Cast;
use workloads::w3_distance::DistanceQuery;
use workloads::w3b_intersect::IntersectQuery;

/// Ray casts by parry's GJK.
#[must_use]
pub fn ray_casts(shape: &Shape, rays: &[Ray]) -> Solver {
    struct Casts<'a>(&'a [Ray]);
    impl Task for Casts<'_> {
        fn solver<S: SupportMap + 'static>(self, target: S) -> Solver {
            Solver::new(parry_rays(self.0), move |ray| {
                let hit = gjk::cast_local_ray(&target, &mut VoronoiSimplex::new(), ray, 1.0);
                hit.map_or(f64::INFINITY, |(lambda, _)| f64::from(lambda))
            })
        }
    }
    with_shape(shape, Casts(rays))
}

/// Ray casts by parry's trait `RayCast`; `None` for shapes that it does not have.
#[must_use]
pub fn front_door_ray_casts(shape: &Shape, rays: &[Ray]) -> Option<Solver> {
    let target = boxed(shape)?;
    Some(Solver::new(parry_rays(rays), move |ray| {
        RayCast::cast_local_ray(&*target, ray, 1.0, true).map_or(f64::INFINITY, f64::from)
    }))
}

/// Linear casts by parry's GJK.
#[must_use]
pub fn linear_casts(pair: &Pair, casts: &[Cast]) -> Solver {
    struct Casts<'a>(&'a [Cast]);
    impl PairTask for Casts<'_> {
        fn solver<A: SupportMap + 'static, B: SupportMap + 'static>(self, a: A, b: B) -> Solver {
            let queries = self.0.iter().map(|cast| (pose(cast.pose), vector(cast.velocity))).collect();
            Solver::new(queries, move |(pose, velocity)| {
                let hit = gjk::directional_distance(pose, &a, &b, *velocity, &mut VoronoiSimplex::new());
                hit.filter(|hit| hit.0 <= 1.0).map_or(f64::INFINITY, |hit| f64::from(hit.0))
            })
        }
    }
    with_pair(pair, Casts(casts))
}

/// Linear casts by parry's `cast_shapes`; `None` for shapes that it does not have.
#[must_use]
pub fn front_door_linear_casts(pair: &Pair, casts: &[Cast]) -> Option<Solver> {
    let (a, b) = (boxed(&pair.a)?, boxed(&pair.b)?);
    let queries = casts.iter().map(|cast| (pose(cast.pose), vector(cast.velocity))).collect();
    Some(Solver::new(queries, move |(pose, velocity)| {
        let options = ShapeCastOptions::with_max_time_of_impact(1.0);
        match query::cast_shapes(&Pose::IDENTITY, Vector::ZERO, &*a, pose, *velocity, &*b, options) {
            Ok(hit) => hit.map_or(f64::INFINITY, |hit| f64::from(hit.time_of_impact)),
            Err(_) => f64::NAN,
        }
    }))
}

/// Distances by parry's GJK.
#[must_use]
pub fn distances(pair: &Pair, queries: &[DistanceQuery]) -> Solver {
    struct Distances<'a>(&'a [DistanceQuery]);
    impl PairTask for Distances<'_> {
        fn solver<A: SupportMap + 'static, B: SupportMap + 'static>(self, a: A, b: B) -> Solver {
            let queries = self.0.iter().map(|query| pose(query.pose)).collect();
            Solver::new(queries, move |pose| {
                let mut simplex = VoronoiSimplex::new();
                simplex.reset(gjk::CsoPoint::from_shapes(pose, &a, &b, first_direction(pose)));
                match gjk::closest_points(pose, &a, &b, Real::MAX, true, &mut simplex) {
                    GJKResult::ClosestPoints(on_a, on_b, _) => f64::from((on_a - on_b).length()),
                    GJKResult::Intersection => 0.0,
                    GJKResult::Proximity(_) | GJKResult::NoIntersection(_) => f64::NAN,
                }
            })
        }
    }
    with_pair(pair, Distances(queries))
}

/// Distances by parry's `distance`; `None` for shapes that it does not have.
#[must_use]
pub fn front_door_distances(pair: &Pair, queries: &[DistanceQuery]) -> Option<Solver> {
    let (a, b) = (boxed(&pair.a)?, boxed(&pair.b)?);
    let queries = queries.iter().map(|query| pose(query.pose)).collect();
    Some(Solver::new(queries, move |pose| {
        query::distance(&Pose::IDENTITY, &*a, pose, &*b).map_or(f64::NAN, |answer| f64::from(answer.distance))
    }))
}

/// Intersection tests by parry's GJK.
#[must_use]
pub fn intersections(pair: &Pair, queries: &[IntersectQuery]) -> Solver {
    struct Tests<'a>(&'a [IntersectQuery]);
    impl PairTask for Tests<'_> {
        fn solver<A: SupportMap + 'static, B: SupportMap + 'static>(self, a: A, b: B) -> Solver {
            let queries = self.0.iter().map(|query| pose(query.pose)).collect();
            Solver::new(queries, move |pose| {
                let mut simplex = VoronoiSimplex::new();
                simplex.reset(gjk::CsoPoint::from_shapes(pose, &a, &b, first_direction(pose)));
                match gjk::closest_points(pose, &a, &b, 0.0, false, &mut simplex) {
                    GJKResult::Intersection => 1.0,
                    GJKResult::Proximity(_) | GJKResult::NoIntersection(_) => 0.0,
                    GJKResult::ClosestPoints(..) => f64::NAN,
                }
            })
        }
    }
    with_pair(pair, Tests(queries))
}

/// Intersection tests by parry's `intersection_test`; `None` for shapes that it does not have.
#[must_use]
pub fn front_door_intersections(pair: &Pair, queries: &[IntersectQuery]) -> Option<Solver> {
    let (a, b) = (boxed(&pair.a)?, boxed(&pair.b)?);
    let queries = queries.iter().map(|query| pose(query.pose)).collect();
    Some(Solver::new(queries, move |pose| {
        query::intersection_test(&Pose::IDENTITY, &*a, pose, &*b)
            .map_or(f64::NAN, |answer| f64::from(u8::from(answer.intersecting)))
    }))
}

/// Depths by parry's `contact`; `None` for shapes that it does not have.
#[must_use]
pub fn front_door_depths(pair: &Pair, queries: &[IntersectQuery]) -> Option<Solver> {
    let (a, b) = (boxed(&pair.a)?, boxed(&pair.b)?);
    let queries = queries.iter().map(|query| pose(query.pose)).collect();
    Some(Solver::new(queries, move |pose| {
        let contact = query::contact(&Pose::IDENTITY, &*a, pose, &*b, 0.0);
        contact.ok().flatten().map_or(f64::NAN, |contact| f64::from(contact.dist))
    }))
}

/// Manifolds by parry's `contact_manifolds`, each made anew; `None` for shapes that it does not have.
#[must_use]
pub fn front_door_manifolds(pair: &Pair, queries: &[IntersectQuery]) -> Option<Solver> {
    let (a, b) = (boxed(&pair.a)?, boxed(&pair.b)?);
    let queries = queries.iter().map(|query| pose(query.pose)).collect();
    Some(Solver::new(queries, move |pose| {
        let mut manifolds = Vec::<ContactManifold<(), ()>>::new();
        let asked = DefaultQueryDispatcher.contact_manifolds(pose, &*a, &*b, 0.0, &mut manifolds, &mut None);
        asked.map_or(f64::NAN, |()| manifolds.iter().map(|manifold| manifold.points.len()).sum::<usize>() as f64)
    }))
}

/// Where parry's own callers start: from one centre to the other.
fn first_direction(pose: &Pose) -> Vector {
    pose.translation.try_normalize().unwrap_or(Vector::X)
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::unnecessary_cast,
    trivial_numeric_casts,
    reason = "`Real` is f32 here, f64 there"
)]
fn number(x: f64) -> Real {
    x as Real
}

fn vector(v: Vec3) -> Vector {
    Vector::from_array(v.map(number))
}

fn pose(pose: workloads::Pose) -> Pose {
    Pose::from_parts(vector(pose.translation), Rotation::from_array(pose.rotation.map(number)))
}

fn parry_rays(rays: &[Ray]) -> Vec<query::Ray> {
    rays.iter().map(|ray| query::Ray::new(vector(ray.origin), vector(ray.direction))).collect()
}

/// parry has no ellipsoid; to its GJK functions it is as good as its own shapes.
struct Ellipsoid(Vector);

impl SupportMap for Ellipsoid {
    fn local_support_point(&self, direction: Vector) -> Vector {
        let scaled = self.0 * direction;
        let length = scaled.length();
        if length > 0.0 { self.0 * scaled / length } else { Vector::new(self.0.x, 0.0, 0.0) }
    }
}

fn ball(radius: f64) -> Ball {
    Ball::new(number(radius))
}

fn cuboid(half_extents: Vec3) -> Cuboid {
    Cuboid::new(vector(half_extents))
}

fn capsule(half_height: f64, radius: f64) -> Capsule {
    Capsule::new_y(number(half_height), number(radius))
}

fn hull(points: &[Vec3]) -> ConvexPolyhedron {
    let points: Vec<Vector> = points.iter().map(|&p| vector(p)).collect();
    ConvexPolyhedron::from_convex_hull(&points).expect("the hulls of the workloads are bodies")
}

fn round_box(half_extents: Vec3, radius: f64) -> RoundCuboid {
    RoundCuboid { inner_shape: cuboid(half_extents), border_radius: number(radius) }
}

fn boxed(shape: &Shape) -> Option<Box<dyn ParryShape>> {
    Some(match shape {
        Shape::Ball { radius } => Box::new(ball(*radius)),
        Shape::Cuboid { half_extents } => Box::new(cuboid(*half_extents)),
        Shape::Cylinder { half_height, radius } => Box::new(Cylinder::new(number(*half_height), number(*radius))),
        Shape::Cone { half_height, radius } => Box::new(Cone::new(number(*half_height), number(*radius))),
        Shape::Capsule { half_height, radius } => Box::new(capsule(*half_height, *radius)),
        Shape::Ellipsoid { .. } => return None,
        Shape::Hull { points } => Box::new(hull(points)),
        Shape::RoundBox { half_extents, radius } => Box::new(round_box(*half_extents, *radius)),
    })
}

/// Makes a solver from a shape of any type.
trait Task {
    fn solver<S: SupportMap + 'static>(self, shape: S) -> Solver;
}

/// Makes a solver from two shapes of any types.
trait PairTask {
    fn solver<A: SupportMap + 'static, B: SupportMap + 'static>(self, a: A, b: B) -> Solver;
}

fn with_shape<T: Task>(shape: &Shape, task: T) -> Solver {
    match shape {
        Shape::Ball { radius } => task.solver(ball(*radius)),
        Shape::Cuboid { half_extents } => task.solver(cuboid(*half_extents)),
        Shape::Cylinder { half_height, radius } => task.solver(Cylinder::new(number(*half_height), number(*radius))),
        Shape::Cone { half_height, radius } => task.solver(Cone::new(number(*half_height), number(*radius))),
        Shape::Capsule { half_height, radius } => task.solver(capsule(*half_height, *radius)),
        Shape::Ellipsoid { semi_axes } => task.solver(Ellipsoid(vector(*semi_axes))),
        Shape::Hull { points } => task.solver(hull(points)),
        Shape::RoundBox { half_extents, radius } => task.solver(round_box(*half_extents, *radius)),
    }
}

fn with_pair<T: PairTask>(pair: &Pair, task: T) -> Solver {
    match (&pair.a, &pair.b) {
        (Shape::Ball { radius }, Shape::Cuboid { half_extents }) => task.solver(ball(*radius), cuboid(*half_extents)),
        (Shape::Cuboid { half_extents: a }, Shape::Cuboid { half_extents: b }) => task.solver(cuboid(*a), cuboid(*b)),
        (Shape::Cylinder { half_height: h, radius: r }, Shape::Cone { half_height, radius }) => {
            task.solver(Cylinder::new(number(*h), number(*r)), Cone::new(number(*half_height), number(*radius)))
        }
        (Shape::Capsule { half_height, radius }, Shape::Ellipsoid { semi_axes }) => {
            task.solver(capsule(*half_height, *radius), Ellipsoid(vector(*semi_axes)))
        }
        (Shape::Ellipsoid { semi_axes: a }, Shape::Ellipsoid { semi_axes: b }) => {
            task.solver(Ellipsoid(vector(*a)), Ellipsoid(vector(*b)))
        }
        (Shape::Hull { points: a }, Shape::Hull { points: b }) => task.solver(hull(a), hull(b)),
        (Shape::RoundBox { half_extents: a, radius: r }, Shape::RoundBox { half_extents: b, radius: s }) => {
            task.solver(round_box(*a, *r), round_box(*b, *s))
        }
        (Shape::Cuboid { half_extents }, Shape::Hull { points }) => task.solver(cuboid(*half_extents), hull(points)),
        (Shape::Capsule { half_height: h, radius: r }, Shape::Capsule { half_height, radius }) => {
            task.solver(capsule(*h, *r), capsule(*half_height, *radius))
        }
        pair => panic!("no pair of the workloads: {pair:?}"),
    }
}
