//! How long do questions to a scene of many bodies take, and how does that grow with their number? parry's tree with
//! its narrow phase beside ours, on the same bodies and questions, after the answers have been compared.

use std::hint::black_box;

use benches::scene::{self, ball, balls, cuboid, places, posed, side, vector};
use convex_support::glam::{DVec3, Vec3A};
use convex_support::{Polytope, Posed, SupportMap, Triangle, Vector};
use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};
use gjk_raycast::Scene;
use workloads::rng::Rng;

/// Questions that a row goes through.
const QUESTIONS: usize = 4096;

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

/// The questions to bodies of one kind.
fn questions<V: Vector<AngularVelocity = V>, S: SupportMap<Vector = V>>(
    c: &mut Criterion,
    name: &str,
    scene: &Scene<S>,
    side: f64,
) {
    let mut group = c.benchmark_group("scene");
    let questions = scene::questions(side, QUESTIONS);
    let mut next = questions.iter().cycle();
    let mut next = move || *next.next().expect("a cycle");
    group.bench_function(BenchmarkId::new("ray_cast", name), |b| {
        b.iter(|| black_box(scene::ray_cast(scene, next())));
    });
    group.bench_function(BenchmarkId::new("nearest", name), |b| b.iter(|| black_box(scene::nearest(scene, next()))));
    let mut found = Vec::new();
    group.bench_function(BenchmarkId::new("all_within", name), |b| {
        b.iter(|| scene::all_within(scene, next(), &mut found));
    });
    group.bench_function(BenchmarkId::new("linear_cast", name), |b| {
        b.iter(|| black_box(scene::linear_cast(scene, next())));
    });
    group.bench_function(BenchmarkId::new("motion_cast", name), |b| {
        b.iter(|| black_box(scene::motion_cast(scene, next())));
    });
    group.finish();
}

/// Building, moving and pairs.
fn upkeep<V: Vector>(c: &mut Criterion, name: &str, places: &[[f64; 3]]) {
    let mut group = c.benchmark_group("scene");
    group.sample_size(10);
    let bodies: Vec<_> = places.iter().map(|&place| posed(ball::<V>(), place)).collect();
    group.bench_function(BenchmarkId::new("build", name), |b| {
        b.iter_batched(|| bodies.clone(), |bodies| Scene::new(bodies).expect("finite"), BatchSize::LargeInput);
    });
    let mut scene = Scene::new(bodies).expect("finite");
    group.bench_function(BenchmarkId::new("update", name), |b| b.iter(|| scene.update(|_, body| *body)));
    let mut pairs = Vec::new();
    group.bench_function(BenchmarkId::new("pairs_within", name), |b| b.iter(|| scene::pairs(&scene, &mut pairs)));
    group.finish();
}

fn bench(c: &mut Criterion) {
    for count in [100, 10_000, 100_000, 1_000_000] {
        let (places, side) = (places(count), side(count));
        fn scene<S: SupportMap + Clone>(shape: &S, places: &[[f64; 3]]) -> Scene<Posed<S>> {
            Scene::new(places.iter().map(|&place| posed(shape.clone(), place))).expect("finite")
        }
        questions(c, &format!("balls/DVec3/{count}"), &balls::<DVec3>(&places), side);
        upkeep::<DVec3>(c, &format!("balls/DVec3/{count}"), &places);
        #[cfg(feature = "parry")]
        parry(c, count, &places, side);
        if count == 100_000 {
            questions(c, "balls/Vec3A/100000", &balls::<Vec3A>(&places), side);
            questions(c, "boxes/DVec3/100000", &scene(&cuboid::<DVec3>(), &places), side);
            questions(c, "boxes/Vec3A/100000", &scene(&cuboid::<Vec3A>(), &places), side);
            let hull = hull::<DVec3>();
            questions(c, "hull64/DVec3/100000", &scene(&&hull, &places), side);
            upkeep::<Vec3A>(c, "balls/Vec3A/100000", &places);
        }
    }
    questions(c, "triangles/DVec3/1000000", &landscape::<DVec3>(708), 708.0);
}

/// The same bodies in parry's tree.
#[cfg(feature = "parry")]
fn parry(c: &mut Criterion, count: usize, places: &[[f64; 3]], side: f64) {
    use parry3d_f64::partitioning::BvhWorkspace;

    let questions = scene::questions(side, QUESTIONS);
    let (theirs, ours) = (scene::parry::Balls::new(places), balls::<DVec3>(places));
    // Who is timed gives the same answers.
    for &question in questions.iter().step_by(64) {
        let first = scene::ray_cast(&ours, question).first;
        let (p, q) = (theirs.ray_cast(question), first.map_or(f64::INFINITY, |hit| hit.hit.lambda));
        assert!(p == q || (p - q).abs() < 1e-9, "{p} or {q}");
        let (p, q) = (theirs.nearest(question), scene::nearest(&ours, question));
        assert!((p - q).abs() < 1e-9, "{p} or {q}");
    }
    let mut group = c.benchmark_group("scene");
    let mut next = questions.iter().cycle();
    let mut next = move || *next.next().expect("a cycle");
    let name = format!("balls/parry/f64/{count}");
    group.bench_function(BenchmarkId::new("ray_cast", &name), |b| b.iter(|| black_box(theirs.ray_cast(next()))));
    group.bench_function(BenchmarkId::new("nearest", &name), |b| b.iter(|| black_box(theirs.nearest(next()))));
    group.bench_function(BenchmarkId::new("all_within", &name), |b| b.iter(|| black_box(theirs.all_within(next()))));
    group.bench_function(BenchmarkId::new("linear_cast", &name), |b| b.iter(|| black_box(theirs.linear_cast(next()))));
    group.bench_function(BenchmarkId::new("motion_cast", &name), |b| b.iter(|| black_box(theirs.motion_cast(next()))));
    group.sample_size(10);
    group.bench_function(BenchmarkId::new("build", &name), |b| b.iter(|| black_box(theirs.rebuilt())));
    let mut workspace = BvhWorkspace::default();
    group.bench_function(BenchmarkId::new("pairs_within", &name), |b| b.iter(|| theirs.pairs(&mut workspace)));
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
