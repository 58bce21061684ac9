//! The workloads answered by `Box3D` in `f32`, through the safe functions of `boxddd`.
//!
//! Its tolerances are those for lengths in metres: casts aim for 5 mm short of contact, and bodies overlap from half a
//! millimetre on. Its shapes are spheres, capsules and hulls of at most 128 edges; its queries between bodies also take
//! up to 64 points with a radius. What is measured includes what `boxddd` adds: checked arguments, and for casts and
//! distances a copy of the points, which those functions take for themselves.

use boxddd::collision::{
    self, CastOutput, DistanceInput, LocalManifold, MAX_SHAPE_PROXY_POINTS, RayCastInput, ShapeCastPairInput,
    ShapeProxy,
};
use boxddd::{Capsule, Foundation, Hull, Quat, Sphere, Transform, Vec3};
use convex_support::glam::{DQuat, DVec3};

use crate::measure::Solver;
use workloads::Pose;
use workloads::pairs::Pair;
use workloads::shapes::Shape;
use workloads::vec3;
use workloads::w1_ray_cast::Ray;
use workloads::w2_linear_cast::Cast;
use workloads::w3_distance::DistanceQuery;
use workloads::w3b_intersect::IntersectQuery;

const VALID: &str = "the shapes and poses of the workloads are valid";

/// Edges of a hull; one of more is not built.
const MAX_HULL_EDGES: usize = 128;

/// Bodies nearer than this overlap, to `Box3D`'s own tests.
const OVERLAP_SLOP: f32 = 5e-4;

/// Ray casts; of a point where there are points with a radius but no shape. `None` where there is neither.
#[must_use]
pub fn ray_casts(shape: &Shape, rays: &[Ray]) -> Option<Solver> {
    begin();
    let inputs = || rays.iter().map(|ray| RayCastInput::new(vector(ray.origin), vector(ray.direction)).expect(VALID));
    Some(match body(shape) {
        Some(Body::Sphere(sphere)) => {
            Solver::new(inputs().collect(), move |input| lambda(collision::ray_cast_sphere(&sphere, *input)))
        }
        Some(Body::Capsule(capsule)) => {
            Solver::new(inputs().collect(), move |input| lambda(collision::ray_cast_capsule(&capsule, *input)))
        }
        Some(Body::Hull(hull)) => {
            Solver::new(inputs().collect(), move |input| lambda(collision::ray_cast_hull(&hull, *input)))
        }
        None => {
            let (target, point) = (proxy(shape)?, ShapeProxy::sphere(0.0).expect(VALID));
            let cast = |ray: RayCastInput| {
                let start = Transform::new(ray.origin, Quat::IDENTITY);
                ShapeCastPairInput::new(target.clone(), point.clone(), start, ray.translation).expect(VALID)
            };
            Solver::new(inputs().map(cast).collect(), |input| lambda(collision::shape_cast_pair(input.clone())))
        }
    })
}

/// Linear casts; `None` where a body has no points.
#[must_use]
pub fn linear_casts(pair: &Pair, casts: &[Cast]) -> Option<Solver> {
    begin();
    let (a, b) = (proxy(&pair.a)?, proxy(&pair.b)?);
    let input = |cast: &Cast| {
        ShapeCastPairInput::new(a.clone(), b.clone(), transform(cast.pose), vector(cast.velocity)).expect(VALID)
    };
    Some(Solver::new(casts.iter().map(input).collect(), |input| lambda(collision::shape_cast_pair(input.clone()))))
}

/// Distances; `None` where a body has no points.
#[must_use]
pub fn distances(pair: &Pair, queries: &[DistanceQuery]) -> Option<Solver> {
    begin();
    let inputs = distance_inputs(pair, queries.iter().map(|query| query.pose))?;
    Some(Solver::new(inputs, |input| distance(input).map_or(f64::NAN, f64::from)))
}

/// Intersection tests; by distance where there are points but no shape. `None` where there is neither.
#[must_use]
pub fn intersections(pair: &Pair, queries: &[IntersectQuery]) -> Option<Solver> {
    begin();
    let poses = queries.iter().map(|query| query.pose);
    let transforms = || poses.clone().map(transform).collect();
    let a = proxy(&pair.a)?;
    Some(match body(&pair.b) {
        Some(Body::Sphere(b)) => Solver::new(transforms(), move |pose| yes(collision::overlap_sphere(&b, *pose, &a))),
        Some(Body::Capsule(b)) => Solver::new(transforms(), move |pose| yes(collision::overlap_capsule(&b, *pose, &a))),
        Some(Body::Hull(b)) => Solver::new(transforms(), move |pose| yes(collision::overlap_hull(&b, *pose, &a))),
        None => Solver::new(distance_inputs(pair, poses)?, |input| {
            yes(distance(input).map(|distance| distance < OVERLAP_SLOP))
        }),
    })
}

/// Contact manifolds, by how many points these have; `None` where there is no function for two such shapes.
#[must_use]
pub fn manifolds(pair: &Pair, queries: &[IntersectQuery]) -> Option<Solver> {
    begin();
    let points = |found: boxddd::Result<LocalManifold>| found.map_or(f64::NAN, |found| found.points.len() as f64);
    let of = |transform: fn(Pose) -> Transform| queries.iter().map(|query| transform(query.pose)).collect();
    Some(match (body(&pair.a)?, body(&pair.b)?) {
        // The hull comes first.
        (Body::Sphere(a), Body::Hull(b)) => {
            Solver::new(of(inverse), move |&pose| points(collision::collide_hull_and_sphere(&b, &a, pose)))
        }
        (Body::Capsule(a), Body::Capsule(b)) => {
            Solver::new(of(transform), move |&pose| points(collision::collide_capsules(&a, &b, pose)))
        }
        (Body::Hull(a), Body::Hull(b)) => {
            Solver::new(of(transform), move |&pose| points(collision::collide_hulls(&a, &b, pose)))
        }
        _ => return None,
    })
}

/// Has to come before anything else that is asked of `Box3D`.
fn begin() {
    Foundation::initialize_default().expect("nobody else sets Box3D's units");
}

/// A shape to which `Box3D` casts rays.
enum Body {
    Sphere(Sphere),
    Capsule(Capsule),
    Hull(Hull),
}

fn body(shape: &Shape) -> Option<Body> {
    // Points in general position have triangles for facets, and Euler's formula 3·n − 6 edges.
    let hull = |points: &[Vec3], edges| {
        (edges <= MAX_HULL_EDGES).then(|| Hull::from_points(points, points.len() as i32).ok()).flatten()
    };
    Some(match shape {
        Shape::Ball { radius } => Body::Sphere(Sphere::new(Vec3::ZERO, *radius as f32)),
        Shape::Capsule { half_height, radius } => {
            let [bottom, top] = segment(*half_height);
            Body::Capsule(Capsule::new(bottom, top, *radius as f32))
        }
        Shape::Cuboid { half_extents } => Body::Hull(hull(&corners(*half_extents), 12)?),
        Shape::Hull { points } => {
            let points: Vec<Vec3> = points.iter().map(|&point| vector(point)).collect();
            Body::Hull(hull(&points, (3 * points.len()).saturating_sub(6))?)
        }
        Shape::Cylinder { .. } | Shape::Cone { .. } | Shape::Ellipsoid { .. } | Shape::RoundBox { .. } => return None,
    })
}

/// Points and a radius.
fn proxy(shape: &Shape) -> Option<ShapeProxy> {
    let (points, radius) = match shape {
        Shape::Ball { radius } => (vec![Vec3::ZERO], *radius),
        Shape::Capsule { half_height, radius } => (segment(*half_height).to_vec(), *radius),
        Shape::Cuboid { half_extents } => (corners(*half_extents).to_vec(), 0.0),
        Shape::RoundBox { half_extents, radius } => (corners(*half_extents).to_vec(), *radius),
        Shape::Hull { points } if points.len() <= MAX_SHAPE_PROXY_POINTS => {
            (points.iter().map(|&point| vector(point)).collect(), 0.0)
        }
        Shape::Hull { .. } | Shape::Cylinder { .. } | Shape::Cone { .. } | Shape::Ellipsoid { .. } => return None,
    };
    ShapeProxy::new(points, radius as f32).ok()
}

fn segment(half_height: f64) -> [Vec3; 2] {
    [-half_height, half_height].map(|y| vector([0.0, y, 0.0]))
}

fn corners([x, y, z]: vec3::Vec3) -> [Vec3; 8] {
    std::array::from_fn(|i| {
        let signed = |bit: usize, size: f64| if i >> bit & 1 == 1 { size } else { -size };
        vector([signed(0, x), signed(1, y), signed(2, z)])
    })
}

fn distance_inputs(pair: &Pair, poses: impl Iterator<Item = Pose>) -> Option<Vec<DistanceInput>> {
    let (a, b) = (proxy(&pair.a)?, proxy(&pair.b)?);
    Some(poses.map(|pose| DistanceInput::new(a.clone(), b.clone(), transform(pose)).expect(VALID)).collect())
}

fn distance(input: &DistanceInput) -> boxddd::Result<f32> {
    collision::shape_distance(input.clone()).map(|output| output.distance)
}

fn lambda(output: boxddd::Result<CastOutput>) -> f64 {
    match output {
        Ok(hit) if hit.hit => f64::from(hit.fraction),
        Ok(_) => f64::INFINITY,
        Err(_) => f64::NAN,
    }
}

fn yes(answer: boxddd::Result<bool>) -> f64 {
    answer.map_or(f64::NAN, |meet| f64::from(u8::from(meet)))
}

fn vector([x, y, z]: vec3::Vec3) -> Vec3 {
    Vec3::new(x as f32, y as f32, z as f32)
}

/// The first body as the second sees it.
fn inverse(pose: Pose) -> Transform {
    let back = DQuat::from_array(pose.rotation).conjugate();
    transform(Pose { rotation: back.to_array(), translation: (-(back * DVec3::from(pose.translation))).into() })
}

fn transform(pose: Pose) -> Transform {
    let [x, y, z, w] = pose.rotation;
    Transform::new(vector(pose.translation), Quat::new(vector([x, y, z]), w as f32))
}
