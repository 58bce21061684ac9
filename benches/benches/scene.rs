//! How long do questions to a scene of many bodies take, and how does that grow with their number? parry's tree with its
//! narrow phase beside ours, on the same bodies and questions, after the answers have been compared.

use std::hint::black_box;

use convex_support::glam::{DVec3, Vec3A};
use convex_support::{Ball, Cuboid, Polytope, Posed, Scalar, SupportMap, Triangle, Vector};
use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};
use gjk_raycast::{DistanceOptions, LinearCastOptions, Motion, Ray, RayCastOptions, Scene};
use workloads::rng::Rng;

/// Questions that a row goes through.
const QUESTIONS: usize = 4096;
/// How near pairs are.
const NEAR: f64 = 0.05;

/// Places at random, as dense for any number of bodies: one to eight units of volume.
fn places(count: usize) -> Vec<[f64; 3]> {
    let mut rng = Rng::new(90_000 + count as u64);
    let side = 2.0 * (count as f64).cbrt();
    (0..count).map(|_| [0; 3].map(|_| side * rng.unit())).collect()
}

fn vector<V: Vector>(v: [f64; 3]) -> V {
    V::from_fn(|i| V::Scalar::from_f64(v[i]))
}

fn posed<S: SupportMap>(shape: S, place: [f64; 3]) -> Posed<S> {
    Posed::translated(shape, vector(place)).expect("finite")
}

fn ball<V: Vector>() -> Ball<V> {
    Ball::new(V::Scalar::from_f64(0.3)).expect("a radius")
}

fn cuboid<V: Vector>() -> Cuboid<V> {
    Cuboid::new(vector([0.2, 0.3, 0.25])).expect("half extents")
}

/// The hull of 64 points on a sphere.
fn hull<V: Vector>() -> Polytope<V> {
    let mut rng = Rng::new(90_001);
    let point = |_| {
        let v = DVec3::new(rng.signed(), rng.signed(), rng.signed());
        vector((v.normalize_or_zero() * 0.3).to_array())
    };
    Polytope::new((0..64).map(point)).expect("points")
}

/// A hilly landscape of 2·side² triangles.
fn landscape<V: Vector>(side: usize) -> Scene<Triangle<V>> {
    let mut rng = Rng::new(90_002);
    let vertices: Vec<V> = (0..(side + 1) * (side + 1))
        .map(|i| vector([(i % (side + 1)) as f64, rng.unit(), (i / (side + 1)) as f64]))
        .collect();
    let corner = |x: usize, z: usize| z * (side + 1) + x;
    let squares = (0..side * side).map(|i| (i % side, i / side));
    let triangles: Vec<_> = squares
        .flat_map(|(x, z)| {
            let [a, b, c, d] = [corner(x, z), corner(x + 1, z), corner(x, z + 1), corner(x + 1, z + 1)];
            [[a, b, c], [b, d, c]]
        })
        .collect();
    Scene::mesh(&vertices, &triangles).expect("finite")
}

fn rays<V: Vector>(side: f64) -> Vec<Ray<V>> {
    let mut rng = Rng::new(90_003);
    let ray = |_| {
        let source = vector([side * rng.unit(), side * rng.unit(), side * rng.unit()]);
        Ray { source, direction: vector([rng.signed(), rng.signed(), rng.signed()]) }
    };
    (0..QUESTIONS).map(ray).collect()
}

/// The questions to bodies of one kind.
fn questions<S: SupportMap>(c: &mut Criterion, name: &str, scene: &Scene<S>, side: f64) {
    let mut group = c.benchmark_group("scene");
    let rays = rays::<S::Vector>(side);
    let number = <<S::Vector as Vector>::Scalar as Scalar>::from_f64;
    let mut next = rays.iter().cycle();
    let mut next = move || *next.next().expect("a cycle");
    group.bench_function(BenchmarkId::new("ray_cast", name), |b| {
        b.iter(|| black_box(scene.ray_cast(next(), RayCastOptions::default())));
    });
    group.bench_function(BenchmarkId::new("nearest", name), |b| {
        b.iter(|| black_box(scene.nearest(&posed_at(next().source), DistanceOptions::default())));
    });
    let mut found = Vec::new();
    group.bench_function(BenchmarkId::new("all_within", name), |b| {
        b.iter(|| scene.all_within(&posed_at(next().source), number(1.0), DistanceOptions::default(), &mut found));
    });
    group.bench_function(BenchmarkId::new("linear_cast", name), |b| {
        b.iter(|| {
            let Ray { source, direction } = next();
            let motion = Motion { velocity_a: direction, velocity_b: Vector::ZERO };
            black_box(scene.linear_cast(&posed_at(source), motion, LinearCastOptions::default()))
        });
    });
    group.finish();
}

fn posed_at<V: Vector>(place: V) -> Posed<Ball<V>> {
    Posed::translated(ball(), place).expect("finite")
}

/// Building, moving and pairs.
fn upkeep<V: Vector>(c: &mut Criterion, name: &str, places: &[[f64; 3]]) {
    let mut group = c.benchmark_group("scene");
    group.sample_size(10);
    let bodies: Vec<_> = places.iter().map(|&place| posed::<Ball<V>>(ball(), place)).collect();
    group.bench_function(BenchmarkId::new("build", name), |b| {
        b.iter_batched(|| bodies.clone(), |bodies| Scene::new(bodies).expect("finite"), BatchSize::LargeInput);
    });
    let mut scene = Scene::new(bodies).expect("finite");
    group.bench_function(BenchmarkId::new("update", name), |b| b.iter(|| scene.update(|_, body| *body)));
    let mut pairs = Vec::new();
    let near = V::Scalar::from_f64(NEAR);
    group.bench_function(BenchmarkId::new("pairs_within", name), |b| {
        b.iter(|| scene.pairs_within(near, DistanceOptions::default(), &mut pairs));
    });
    group.finish();
}

fn bench(c: &mut Criterion) {
    for count in [100, 10_000, 100_000, 1_000_000] {
        let (places, side) = (places(count), 2.0 * (count as f64).cbrt());
        fn scene<S: SupportMap + Clone>(shape: &S, places: &[[f64; 3]]) -> Scene<Posed<S>> {
            Scene::new(places.iter().map(|&place| posed(shape.clone(), place))).expect("finite")
        }
        questions(c, &format!("balls/DVec3/{count}"), &scene(&ball::<DVec3>(), &places), side);
        upkeep::<DVec3>(c, &format!("balls/DVec3/{count}"), &places);
        #[cfg(feature = "parry")]
        parry::bench(c, count, &places, &rays(side));
        if count == 100_000 {
            questions(c, "balls/Vec3A/100000", &scene(&ball::<Vec3A>(), &places), side);
            questions(c, "boxes/DVec3/100000", &scene(&cuboid::<DVec3>(), &places), side);
            questions(c, "boxes/Vec3A/100000", &scene(&cuboid::<Vec3A>(), &places), side);
            let hull = hull::<DVec3>();
            questions(c, "hull64/DVec3/100000", &scene(&&hull, &places), side);
            upkeep::<Vec3A>(c, "balls/Vec3A/100000", &places);
        }
    }
    questions(c, "triangles/DVec3/1000000", &landscape::<DVec3>(708), 708.0);
}

/// The same bodies in parry's tree, each question with parry's own narrow phase.
#[cfg(feature = "parry")]
mod parry {
    use std::hint::black_box;

    use convex_support::glam::DVec3;
    use criterion::{BenchmarkId, Criterion};
    use gjk_raycast::{DistanceOptions, RayCastOptions, Scene};
    use parry3d_f64::bounding_volume::{Aabb, BoundingVolume};
    use parry3d_f64::math::{Pose, Vector};
    use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};
    use parry3d_f64::query::{self, Ray, RayCast};
    use parry3d_f64::shape::Ball;

    use super::{NEAR, ball, posed, posed_at};

    fn vector(v: [f64; 3]) -> Vector {
        Vector::new(v[0], v[1], v[2])
    }

    pub(super) fn bench(c: &mut Criterion, count: usize, places: &[[f64; 3]], rays: &[gjk_raycast::Ray<DVec3>]) {
        let shape = Ball::new(0.3);
        let poses: Vec<Pose> = places.iter().map(|&p| Pose::from_translation(vector(p))).collect();
        let boxes: Vec<Aabb> = poses.iter().map(|pose| shape.aabb(pose)).collect();
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        let cast = |ray: &Ray| {
            tree.cast_ray(ray, f64::MAX, |leaf, best| shape.cast_ray(&poses[leaf as usize], ray, best, true))
        };
        let nearest = |at: DVec3| {
            let (pose, around) = (Pose::from_translation(vector(at.to_array())), Vector::splat(0.3));
            let at = vector(at.to_array());
            let (low, high) = (at - around, at + around);
            tree.find_best(
                f64::MAX,
                |node, _| (node.mins() - high).max(low - node.maxs()).max(Vector::ZERO).length(),
                |leaf, _| query::distance(&pose, &shape, &poses[leaf as usize], &shape).ok().map(|d| d.distance),
            )
        };
        let ours = Scene::new(places.iter().map(|&place| posed(ball::<DVec3>(), place))).expect("finite");
        // Who is timed gives the same answers.
        for ray in rays.iter().step_by(64) {
            let theirs = cast(&Ray::new(vector(ray.source.to_array()), vector(ray.direction.to_array())));
            let first = ours.ray_cast(*ray, RayCastOptions::default()).expect("a good ray").first;
            let (p, q) = (theirs.map_or(f64::INFINITY, |hit| hit.1), first.map_or(f64::INFINITY, |hit| hit.hit.lambda));
            assert!(p == q || (p - q).abs() < 1e-9, "{p} or {q}");
            let (p, q) = (nearest(ray.source), ours.nearest(&posed_at(ray.source), DistanceOptions::default()).nearest);
            let (p, q) = (p.expect("bodies").1, q.expect("bodies").distance.distance);
            assert!((p - q).abs() < 1e-9, "{p} or {q}");
        }
        let mut group = c.benchmark_group("scene");
        let theirs: Vec<_> =
            rays.iter().map(|ray| Ray::new(vector(ray.source.to_array()), vector(ray.direction.to_array()))).collect();
        let mut next = theirs.iter().cycle();
        let name = format!("balls/parry/f64/{count}");
        group.bench_function(BenchmarkId::new("ray_cast", &name), |b| {
            b.iter(|| black_box(cast(next.next().expect("a cycle"))));
        });
        let mut next = rays.iter().cycle();
        group.bench_function(BenchmarkId::new("nearest", &name), |b| {
            b.iter(|| black_box(nearest(next.next().expect("a cycle").source)));
        });
        group.sample_size(10);
        group.bench_function(BenchmarkId::new("build", &name), |b| {
            b.iter(|| black_box(Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes)));
        });
        let loose: Vec<Aabb> = boxes.iter().map(|around| around.loosened(0.5 * NEAR)).collect();
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &loose);
        let mut workspace = BvhWorkspace::default();
        group.bench_function(BenchmarkId::new("pairs_within", &name), |b| {
            b.iter(|| {
                let mut near = 0_usize;
                tree.traverse_bvtt_single_tree::<false>(&mut workspace, &mut |i, j| {
                    let distance = query::distance(&poses[i as usize], &shape, &poses[j as usize], &shape);
                    near += usize::from(distance.is_ok_and(|d| d.distance <= NEAR));
                });
                near
            });
        });
        group.finish();
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
