//! How long does a step along a trajectory take, by our tracker, by the paper's inverse iteration, and cold?
//!
//! Answers are given to `black_box` by reference: to move one there copies it before all of it is stored, which takes a
//! twentieth of the time.

use std::hint::black_box;

use convex_support::Ellipsoid;
use convex_support::glam::{DQuat, DVec3};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use ellip_margin::paper::InverseIterationTracker;
use ellip_margin::{MarginOptions, MarginTracker, free_margin};
use workloads::rng::Rng;

const STEPS: u32 = 2_000;

/// A link that passes an obstacle, turning by `angle` and moving by a `length` a step, to and fro.
fn path(angle: f64, length: f64) -> Vec<[Ellipsoid<DVec3>; 2]> {
    let mut rng = Rng::new(70_000);
    let link = Ellipsoid::new(DVec3::ZERO, DVec3::new(1.0, 0.3, 0.2), DQuat::IDENTITY).expect("valid");
    let obstacle = Ellipsoid::new(DVec3::ZERO, DVec3::new(0.8, 0.5, 0.3), DQuat::from_rotation_x(0.7)).expect("valid");
    let axis = DVec3::from_array(rng.sphere());
    (0..STEPS)
        .map(|k| {
            let t = f64::from(k);
            let across = (t * length * 0.5).sin() * 2.0;
            let pose = DQuat::from_axis_angle(axis, t * angle);
            [link.posed(pose, DVec3::new(across, 2.0, 0.5)).expect("finite"), obstacle]
        })
        .collect()
}

fn bench(c: &mut Criterion) {
    for (name, degrees, length) in [("1_degree", 1.0f64, 1.0 / 128.0), ("5_degrees", 5.0, 5.0 / 128.0)] {
        let path = path(degrees.to_radians(), length);
        let mut group = c.benchmark_group(format!("track/{name}"));
        group.throughput(Throughput::Elements(u64::from(STEPS)));
        group.bench_function("tracked", |b| {
            b.iter(|| {
                let mut track = MarginTracker::default();
                for [e1, e2] in &path {
                    black_box(&track.step(black_box(e1), black_box(e2)));
                }
            });
        });
        group.bench_function("inverse iteration", |b| {
            b.iter(|| {
                let mut track = InverseIterationTracker::new(1e-6, 40).expect("a positive tolerance");
                for [e1, e2] in &path {
                    black_box(&track.step(black_box(e1), black_box(e2)));
                }
            });
        });
        group.bench_function("cold", |b| {
            b.iter(|| {
                for [e1, e2] in &path {
                    black_box(&free_margin(black_box(e1), black_box(e2), MarginOptions::default()));
                }
            });
        });
        group.finish();
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
