//! The workloads answered by Jolt in `f32`, through the safe functions of `oxijolt`.
//!
//! Its tolerance is its own: to casts and collisions bodies touch from 0.1 mm on. It is asked as its users ask it:
//! through a world, here of the one body that rests. What is measured includes the way to that body (broad phase,
//! locks, filters) and what comes with an answer: the normal of a hit, and the depth of bodies that overlap, which Jolt
//! finds wherever it says that they do. Convex radii are zero, so that shapes have sharp edges.

use oxijolt::{
    BodySettings, CollideShape, PhysicsWorld, Quat, QueryError, QueryFilter, RVec3, RayCast, Shape as Body, ShapeCast,
    Vec3, WorldSettings,
};

use crate::measure::Solver;
use workloads::Pose;
use workloads::pairs::Pair;
use workloads::shapes::Shape;
use workloads::vec3;
use workloads::w1_ray_cast::Ray;
use workloads::w2_linear_cast::Cast;
use workloads::w3b_intersect::IntersectQuery;

/// Vertices of a hull; of more points some are left out.
const MAX_HULL_VERTICES: usize = 256;

/// Ray casts; `None` for shapes that it does not have.
#[must_use]
pub fn ray_casts(shape: &Shape, rays: &[Ray]) -> Option<Solver> {
    let world = world(&body(shape)?);
    let rays = rays.iter().map(|ray| RayCast::new(position(ray.origin), vector(ray.direction))).collect();
    Some(Solver::new(rays, move |ray| {
        lambda(world.cast_ray(ray, &QueryFilter::new()).map(|hit| hit.map(|hit| hit.fraction)))
    }))
}

/// Linear casts; `None` for shapes that it does not have.
///
/// Back faces count. They are hits whose normal has the direction of the motion, which a body that starts apart cannot
/// have: where contact is an edge on an edge, Jolt's normal may have the wrong sign, and the hit would be lost.
#[must_use]
pub fn linear_casts(pair: &Pair, casts: &[Cast]) -> Option<Solver> {
    let (a, b) = (body(&pair.a)?, body(&pair.b)?);
    let world = world(&a);
    let queries = casts.iter().map(|cast| (placed(cast.pose), vector(cast.velocity))).collect();
    Some(Solver::new(queries, move |&((position, rotation), velocity)| {
        let cast = ShapeCast::new(&b, position, rotation, velocity).collide_with_back_faces(true);
        lambda(world.cast_shape(&cast, &QueryFilter::new()).map(|hit| hit.map(|hit| hit.fraction)))
    }))
}

/// Intersection tests; `None` for shapes that it does not have.
#[must_use]
pub fn intersections(pair: &Pair, queries: &[IntersectQuery]) -> Option<Solver> {
    let (a, b) = (body(&pair.a)?, body(&pair.b)?);
    let world = world(&a);
    let queries = queries.iter().map(|query| placed(query.pose)).collect();
    Some(Solver::new(queries, move |&(position, rotation)| {
        let hits = world.collide_shape(&CollideShape::new(&b, position, rotation), &QueryFilter::new());
        hits.map_or(f64::NAN, |hits| f64::from(u8::from(!hits.is_empty())))
    }))
}

/// Where a cast hit, if it was answered.
fn lambda(fraction: Result<Option<f32>, QueryError>) -> f64 {
    fraction.map_or(f64::NAN, |hit| hit.map_or(f64::INFINITY, f64::from))
}

/// A world in which that body rests at the origin, and nothing else is.
fn world(body: &Body) -> PhysicsWorld {
    let settings = WorldSettings::default().max_bodies(1).single_threaded().temp_allocator_size(1 << 20);
    let mut world = PhysicsWorld::new(settings).expect("a world of one body");
    world.create_body(body, &BodySettings::new_static()).expect("room for one body");
    world
}

fn body(shape: &Shape) -> Option<Body> {
    let number = |x: &f64| *x as f32;
    let body = match shape {
        Shape::Ball { radius } => Body::new_sphere(number(radius)),
        Shape::Cuboid { half_extents } => Body::new_box_with_convex_radius(vector(*half_extents), 0.0),
        Shape::Cylinder { half_height, radius } => {
            Body::new_cylinder_with_convex_radius(number(half_height), number(radius), 0.0)
        }
        Shape::Cone { half_height, radius } => {
            Body::new_tapered_cylinder_with_convex_radius(number(half_height), 0.0, number(radius), 0.0)
        }
        Shape::Capsule { half_height, radius } => Body::new_capsule(number(half_height), number(radius)),
        Shape::Hull { points } if points.len() <= MAX_HULL_VERTICES => {
            let points: Vec<Vec3> = points.iter().map(|&point| vector(point)).collect();
            Body::new_convex_hull_with_convex_radius(&points, 0.0)
        }
        // Only spheres may be scaled alike along all axes, and a radius above 5 cm collides like one of 5 cm.
        Shape::Hull { .. } | Shape::Ellipsoid { .. } | Shape::RoundBox { .. } => return None,
    };
    body.ok()
}

fn vector([x, y, z]: vec3::Vec3) -> Vec3 {
    Vec3::new(x as f32, y as f32, z as f32)
}

fn position([x, y, z]: vec3::Vec3) -> RVec3 {
    RVec3::new(x as f32, y as f32, z as f32)
}

fn placed(pose: Pose) -> (RVec3, Quat) {
    let [x, y, z, w] = pose.rotation.map(|part| part as f32);
    (position(pose.translation), Quat::from_xyzw(x, y, z, w))
}
