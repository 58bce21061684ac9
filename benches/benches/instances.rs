//! What do instances of one mesh cost, beside the flat scene of all their triangles; and how long does the nearest pair
//! of two meshes take? With the feature `parry` beside parry's tree of the same meshes, and its distance of two meshes.

use std::hint::black_box;

#[cfg(feature = "parry")]
use benches::scene::Question;
use benches::scene::{self, places, side, vector};
use convex_support::glam::{DQuat, DVec3};
use convex_support::{Posed, Triangle};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use gjk_raycast::{DistanceOptions, Group, Pose, Scene};
use workloads::rng::Rng;

const QUESTIONS: usize = 4096;
/// The squares of a mesh along each side: 10,082 triangles; and those of each mesh whose nearest pair is asked for.
const SIDE: usize = 71;
const LARGE_SIDE: usize = 224;

/// Vertices and triangles of hills over the unit square.
fn hills(side: usize, seed: u64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut rng = Rng::new(seed);
    let row = side + 1;
    let at = |i: usize| i as f64 / side as f64;
    let vertices = (0..row * row).map(|i| DVec3::new(at(i % row), 0.02 * rng.unit(), at(i / row))).collect();
    let corners = |i: usize| {
        let corner = i / side * row + i % side;
        [corner, corner + 1, corner + row, corner + row + 1].map(|corner| u32::try_from(corner).expect("small"))
    };
    let triangles = (0..side * side).map(corners).flat_map(|[a, b, c, d]| [[a, b, c], [b, d, c]]).collect();
    (vertices, triangles)
}

fn poses(count: usize) -> Vec<Pose<DVec3>> {
    let mut rng = Rng::new(90_010);
    let rotation = |_| DQuat::from_array([0; 4].map(|_| rng.signed())).normalize();
    let rotations: Vec<_> = (0..count).map(rotation).collect();
    let pose = |(place, rotation)| Pose { rotation, translation: vector(place) };
    places(count).into_iter().zip(rotations).map(pose).collect()
}

fn instances(group: &Group<DVec3>, poses: &[Pose<DVec3>]) -> Scene<Triangle<DVec3>> {
    let mut scene = Scene::new([]).expect("empty");
    for &pose in poses {
        scene.insert_group(group, pose).expect("a pose");
    }
    scene
}

fn of_many(c: &mut Criterion) {
    let (vertices, triangles) = hills(SIDE, 90_011);
    let mesh = Scene::mesh(&vertices, &triangles).expect("a mesh");
    let group = Group::new(mesh).expect("triangles");
    let mut rows = c.benchmark_group("instances");
    for count in [100, 1000, 10_000] {
        let (poses, questions) = (poses(count), scene::questions(side(count), QUESTIONS));
        let mut scene = instances(&group, &poses);
        rows.bench_function(BenchmarkId::new("build", count), |b| b.iter(|| black_box(instances(&group, &poses))));
        let mut next = questions.iter().cycle();
        let mut next = move || *next.next().expect("a cycle");
        rows.bench_function(BenchmarkId::new("ray_cast", count), |b| {
            b.iter(|| black_box(scene::ray_cast(&scene, next())));
        });
        rows.bench_function(BenchmarkId::new("nearest", count), |b| {
            b.iter(|| black_box(scene::nearest(&scene, next())));
        });
        if count == 100 {
            let placed = |pose: &Pose<DVec3>| {
                let Pose { rotation, translation } = *pose;
                let corner = |&vertex: &u32| vertices[vertex as usize];
                let triangle = |corners: &[u32; 3]| Triangle::new(corners.each_ref().map(corner)).expect("finite");
                triangles
                    .iter()
                    .map(move |corners| Posed::new(triangle(corners), rotation, translation).expect("a pose"))
                    .collect::<Vec<_>>()
            };
            let flat = Scene::new(poses.iter().flat_map(placed)).expect("finite");
            // Who is timed gives the same answers.
            for &question in questions.iter().step_by(64) {
                let instance = scene::ray_cast(&scene, question).first.map(|first| first.hit);
                assert_eq!(instance, scene::ray_cast(&flat, question).first.map(|first| first.hit), "{question:?}");
            }
            rows.bench_function(BenchmarkId::new("ray_cast", "flat/100"), |b| {
                b.iter(|| black_box(scene::ray_cast(&flat, next())));
            });
            rows.bench_function(BenchmarkId::new("nearest", "flat/100"), |b| {
                b.iter(|| black_box(scene::nearest(&flat, next())));
            });
        }
        rows.bench_function(BenchmarkId::new("update_instances", count), |b| {
            b.iter(|| scene.update_instances(|_, instance| instance.pose()).expect("poses"));
        });
        #[cfg(feature = "parry")]
        parry::of_many(&mut rows, &vertices, &triangles, &poses, &questions);
    }
    rows.finish();
}

/// How far the nearest triangles of two meshes are from each other, that lie over one another.
fn of_two(c: &mut Criterion) {
    let mut rows = c.benchmark_group("nearest_between");
    rows.sample_size(10);
    let (below, triangles) = hills(LARGE_SIDE, 90_012);
    let (above, _) = hills(LARGE_SIDE, 90_013);
    let first = Scene::mesh(&below, &triangles).expect("a mesh");
    for gap in [1.0, 0.1, 0.001] {
        let lifted: Vec<_> = above.iter().map(|&vertex| vertex + DVec3::Y * (0.02 + gap)).collect();
        let second = Scene::mesh(&lifted, &triangles).expect("a mesh");
        let distance = || {
            let nearest = first.all().nearest_between(&second, DistanceOptions::default()).nearest;
            nearest.expect("triangles").distance.distance
        };
        rows.bench_function(BenchmarkId::new("meshes", gap), |b| b.iter(|| black_box(distance())));
        let any = || first.all().any_pair_between(&second, 2.0 * gap, DistanceOptions::default()).any;
        rows.bench_function(BenchmarkId::new("any within twice", gap), |b| b.iter(|| black_box(any())));
        #[cfg(feature = "parry")]
        parry::of_two(&mut rows, [&below, &lifted], &triangles, gap, distance());
    }
    rows.finish();
}

#[cfg(feature = "parry")]
mod parry {
    use criterion::BenchmarkGroup;
    use criterion::measurement::WallTime;
    use parry3d_f64::math::{Pose, Rotation, Vector};
    use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};
    use parry3d_f64::query::{self, Ray, RayCast as _};
    use parry3d_f64::shape::TriMesh;

    use super::{BenchmarkId, DVec3, Question, black_box};

    fn mesh(vertices: &[DVec3], triangles: &[[u32; 3]]) -> TriMesh {
        let vertices = vertices.iter().map(|v| Vector::new(v.x, v.y, v.z)).collect();
        TriMesh::new(vertices, triangles.to_vec()).expect("triangles")
    }

    pub(super) fn of_many(
        rows: &mut BenchmarkGroup<'_, WallTime>,
        vertices: &[DVec3],
        triangles: &[[u32; 3]],
        poses: &[gjk_raycast::Pose<DVec3>],
        questions: &[Question],
    ) {
        let (mesh, count) = (mesh(vertices, triangles), poses.len());
        let pose = |pose: &gjk_raycast::Pose<DVec3>| {
            let (t, r) = (pose.translation, pose.rotation);
            Pose::from_parts(Vector::new(t.x, t.y, t.z), Rotation::from_xyzw(r.x, r.y, r.z, r.w))
        };
        let poses: Vec<_> = poses.iter().map(pose).collect();
        let build = || {
            let boxes: Vec<_> = poses.iter().map(|pose| mesh.aabb(pose)).collect();
            Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes)
        };
        let tree = build();
        let id = |question| BenchmarkId::new(question, format!("parry/{count}"));
        rows.bench_function(id("build"), |b| b.iter(|| black_box(build())));
        let mut next = questions.iter().cycle();
        rows.bench_function(id("ray_cast"), |b| {
            b.iter(|| {
                let &[source, direction, _] = next.next().expect("a cycle");
                let [source, direction] = [source, direction].map(|[x, y, z]| Vector::new(x, y, z));
                let ray = Ray::new(source, direction);
                let cast = |leaf: u32, best| mesh.cast_ray(&poses[leaf as usize], &ray, best, true);
                black_box(tree.cast_ray(&ray, f64::MAX, cast))
            });
        });
    }

    pub(super) fn of_two(
        rows: &mut BenchmarkGroup<'_, WallTime>,
        vertices: [&[DVec3]; 2],
        triangles: &[[u32; 3]],
        gap: f64,
        ours: f64,
    ) {
        let [first, second] = vertices.map(|vertices| mesh(vertices, triangles));
        let distance = || query::distance(&Pose::IDENTITY, &first, &Pose::IDENTITY, &second).expect("meshes").distance;
        // Who is timed gives the same answer, to parry's tolerance.
        assert!((distance() - ours).abs() < 1e-6, "{} or {ours}", distance());
        rows.bench_function(BenchmarkId::new("meshes", format!("parry/{gap}")), |b| b.iter(|| black_box(distance())));
    }
}

criterion_group!(benches, of_many, of_two);
criterion_main!(benches);
