//! How long does the convex hull of a point set take, as a polytope to ask for support points?
//!
//! `ball` has most points inside, `sphere` all of them on the hull, `box` all of them in six planes, as CAD meshes
//! have. Before timing, no point of a set may reach beyond its hull.

use std::hint::black_box;

use convex_support::glam::DVec3;
use convex_support::{Polytope, SupportMap, support_value};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
#[cfg(feature = "parry")]
use parry3d_f64::{math::Vector, shape::ConvexPolyhedron};
use workloads::rng::Rng;

/// Points on a sphere, drawn towards the middle by a factor of each point's own.
fn cloud(count: usize, factor: impl Fn(&mut Rng, DVec3) -> f64) -> Vec<DVec3> {
    let mut rng = Rng::new(70_000 + count as u64);
    (0..count)
        .map(|_| {
            let point = DVec3::from(rng.sphere());
            point * factor(&mut rng, point)
        })
        .collect()
}

/// Asserts that the hull reaches as far as the points do, to a few roundings.
fn encloses(hull: &impl SupportMap<Vector = DVec3>, points: &[DVec3]) {
    let mut rng = Rng::new(71_000);
    for _ in 0..100 {
        let d = DVec3::from(rng.sphere());
        let farthest = points.iter().map(|p| p.dot(d)).fold(f64::MIN, f64::max);
        let excess = farthest - support_value(&hull, d);
        assert!(excess <= 1e-15, "along {d} a point is {excess:e} beyond the hull");
    }
}

fn bench(c: &mut Criterion) {
    for count in [100, 1_000, 10_000, 100_000] {
        let clouds = [
            ("ball", cloud(count, |rng, _| rng.unit().cbrt())),
            ("sphere", cloud(count, |_, _| 1.0)),
            ("box", cloud(count, |_, p| 1.0 / p.abs().max_element())),
        ];
        for (name, points) in clouds {
            encloses(&Polytope::hull_of(points.iter().copied()).expect("finite points"), &points);
            let mut group = c.benchmark_group(format!("hull/{name}"));
            group.sample_size(10);
            group.bench_with_input(BenchmarkId::new("ours/DVec3", count), &points, |b, points| {
                b.iter(|| Polytope::hull_of(black_box(points).iter().copied()));
            });
            #[cfg(feature = "parry")]
            {
                let points: Vec<Vector> = points.iter().map(|p| Vector::new(p.x, p.y, p.z)).collect();
                group.bench_with_input(BenchmarkId::new("parry/f64", count), &points, |b, points| {
                    b.iter(|| ConvexPolyhedron::from_convex_hull(black_box(points)));
                });
            }
            group.finish();
        }
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
