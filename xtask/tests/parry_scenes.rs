//! A compound and a mesh of parry's as scenes: the rays and the distances are parry's. Needs the feature `parry`.

use convex_support::glam::DVec3;
use convex_support::parry3d_f64::{pieces, triangles};
use convex_support::{Ball, Posed};
use gjk_raycast::{DistanceOptions, Ray, RayCastOptions, Scene};
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query;
use parry3d_f64::shape::{self, Compound, RoundShape, Shape, SharedShape, TriMesh};
use workloads::rng::Rng;

fn vector(rng: &mut Rng, size: f64) -> Vector {
    Vector::new(rng.signed(), rng.signed(), rng.signed()) * size
}

fn pose(rng: &mut Rng, size: f64) -> Pose {
    Pose::new(vector(rng, size), vector(rng, 2.0))
}

fn ours(v: Vector) -> DVec3 {
    DVec3::new(v.x, v.y, v.z)
}

/// One of each of parry's convex kinds, several times.
fn compound(rng: &mut Rng) -> Compound {
    let mut pieces = Vec::new();
    for _ in 0..8 {
        let corners: Vec<_> = (0..12).map(|_| vector(rng, 0.5)).collect();
        let hull = shape::ConvexPolyhedron::from_convex_hull(&corners).expect("twelve random points");
        let [a, b, c] = [0; 3].map(|_| vector(rng, 0.5));
        for shape in [
            SharedShape::ball(0.3),
            SharedShape::cuboid(0.2, 0.3, 0.4),
            SharedShape::capsule(a, b, 0.2),
            SharedShape::triangle(a, b, c),
            SharedShape::cylinder(0.4, 0.2),
            SharedShape::cone(0.4, 0.3),
            SharedShape::new(hull.clone()),
            SharedShape::round_cuboid(0.2, 0.3, 0.4, 0.1),
            SharedShape::new(RoundShape { inner_shape: hull, border_radius: 0.1 }),
        ] {
            pieces.push((pose(rng, 4.0), shape));
        }
    }
    Compound::new(pieces)
}

/// A hilly landscape, mirrored and reversed.
fn mesh(rng: &mut Rng) -> TriMesh {
    let side = 12;
    let vertex = |i: u32| Vector::new(f64::from(i % side), rng.unit(), f64::from(i / side));
    let vertices: Vec<_> = (0..side * side).map(vertex).collect();
    let corner = |i: u32| i / (side - 1) * side + i % (side - 1);
    let squares = (0..(side - 1) * (side - 1)).map(corner);
    let triangles = squares.flat_map(|i| [[i, i + 1, i + side], [i + 1, i + side + 1, i + side]]).collect();
    let mut mesh = TriMesh::new(vertices, triangles).expect("triangles").scaled(Vector::new(-0.5, 1.5, 0.75));
    mesh.reverse();
    mesh
}

/// Asks both the same: rays through what is there, and how far a ball is.
fn answers_agree<S: convex_support::SupportMap<Vector = DVec3>>(
    theirs: &dyn Shape,
    whole: &Pose,
    scene: &Scene<S>,
    rng: &mut Rng,
) {
    let (mut hits, mut apart) = (0, 0);
    for _ in 0..500 {
        let around = theirs.compute_local_aabb();
        let (source, aim) = (vector(rng, 12.0), around.center() + vector(rng, 1.0) * around.half_extents());
        let direction = whole * aim - source;
        let ray = query::Ray::new(source, direction);
        let expected = theirs.cast_ray(whole, &ray, 10.0, true);
        let ray = Ray { source: ours(source), direction: ours(direction) };
        let first =
            scene.all().ray_cast(ray, RayCastOptions::default().with_max_lambda(10.0)).expect("a good ray").first;
        assert_eq!(expected.is_some(), first.is_some(), "{expected:?} or {first:?}");
        if let (Some(expected), Some(first)) = (expected, first) {
            hits += 1;
            assert!((expected - first.hit.lambda).abs() < 1e-6, "{expected} or {}", first.hit.lambda);
        }

        let place = vector(rng, 6.0);
        let expected = query::distance(whole, theirs, &Pose::from_translation(place), &shape::Ball::new(0.25));
        let expected = expected.expect("parry knows how").distance;
        let ball = Posed::translated(Ball::new(0.25).expect("a radius"), ours(place)).expect("finite");
        let nearest = scene.all().nearest(&ball, DistanceOptions::default()).nearest.expect("there are bodies");
        apart += u32::from(expected > 0.0);
        let found = nearest.distance.distance;
        assert!((expected - found).abs() < 1e-6, "{expected} or {found}");
    }
    assert!((100..500).contains(&hits), "{hits} hits");
    assert!((100..500).contains(&apart), "{apart} apart");
}

#[test]
fn a_compound() {
    let mut rng = Rng::new(18_001);
    let compound = compound(&mut rng);
    let whole = pose(&mut rng, 2.0);
    let pieces = pieces(&compound).expect("all are convex");
    let scene = Scene::new(pieces.iter().map(|piece| piece.at(&whole).expect("finite"))).expect("finite");
    assert_eq!(scene.len(), compound.shapes().len());
    answers_agree(&compound, &whole, &scene, &mut rng);
    // Moved, it is the same compound elsewhere.
    let whole = pose(&mut rng, 2.0);
    let mut scene = scene;
    scene.update(|piece, _| pieces[piece].at(&whole).expect("finite")).expect("finite");
    answers_agree(&compound, &whole, &scene, &mut rng);
}

#[test]
fn a_mesh() {
    let mut rng = Rng::new(18_002);
    let mesh = mesh(&mut rng);
    let scene = Scene::new(triangles(&mesh).expect("finite")).expect("finite");
    answers_agree(&mesh, &Pose::IDENTITY, &scene, &mut rng);
    let whole = pose(&mut rng, 2.0);
    let posed = pieces(&mesh).expect("finite");
    let posed = Scene::new(posed.iter().map(|piece| piece.at(&whole).expect("finite"))).expect("finite");
    answers_agree(&mesh, &whole, &posed, &mut rng);
    // The fronts are those that parry's normals point away from.
    for (i, triangle) in mesh.triangles().enumerate() {
        let normal = triangle.normal().expect("no sliver");
        for direction in [normal, -normal, vector(&mut rng, 1.0)] {
            assert_eq!(scene.is_front(i, ours(direction)), normal.dot(direction) < 0.0, "triangle {i}");
        }
    }
}
