//! How long does a step of a robot of 30 links among many obstacles take, and how does it grow with their number? And
//! how long a whole trajectory at once, with gradients?

use std::hint::black_box;

use convex_support::Ellipsoid;
use convex_support::glam::{DQuat, DVec3};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use ellip_margin::{Answer, Clearance, EllipsoidPair, Margin, MarginOptions, NearPair, clearance, map_margins_into};
use workloads::rng::Rng;

const LINKS: u32 = 30;
const STEPS: u32 = 500;

/// Ellipsoids of 2 to 8 cm in a room of 4 m, none of them in the way of the robot.
fn obstacles(count: usize) -> Vec<Ellipsoid<DVec3>> {
    let mut rng = Rng::new(80_000);
    (0..count)
        .map(|_| {
            let size = 0.02 + 0.06 * rng.unit();
            let a = DVec3::new(1.0, 0.3 + 0.7 * rng.unit(), 0.3 + 0.7 * rng.unit()) * size;
            let [x, y, z, w] = rng.quat();
            let mut center = DVec3::new(rng.signed(), rng.signed(), rng.signed()) * 2.0;
            if center.length() < 0.9 {
                center *= (0.95 + 0.5 * rng.unit()) / center.length();
            }
            Ellipsoid::new(center, a, DQuat::from_xyzw(x, y, z, w)).expect("valid by construction")
        })
        .collect()
}

/// A ring of links turning about the origin, a third of a degree a step: 3.5 mm.
fn motion() -> Vec<Vec<Ellipsoid<DVec3>>> {
    let mut rng = Rng::new(80_001);
    let shapes: Vec<_> = (0..LINKS)
        .map(|i| {
            let a = DVec3::new(0.12, 0.03 + 0.09 * rng.unit(), 0.03 + 0.03 * rng.unit());
            let [x, y, z, w] = rng.quat();
            (f64::from(i) * 0.4, 0.2 * rng.signed(), a, DQuat::from_xyzw(x, y, z, w))
        })
        .collect();
    let pose = |t: f64| {
        let links = shapes.iter().map(|&(phase, height, a, q)| {
            let angle = t + phase;
            let center = DVec3::new(0.7 * angle.cos(), 0.7 * angle.sin(), height);
            Ellipsoid::new(center, a, DQuat::from_rotation_z(angle) * q).expect("valid by construction")
        });
        links.collect()
    };
    (0..STEPS).map(|k| pose(f64::from(k) * 0.005)).collect()
}

fn bench(c: &mut Criterion) {
    let motion = motion();
    let mut group = c.benchmark_group("clearance");
    group.sample_size(20);
    for count in [100, 1_000, 10_000, 100_000] {
        let obstacles = obstacles(count);
        let mut scene = Clearance::new(&obstacles, MarginOptions::default()).expect("not empty");
        // Who is timed gives the answer of brute force.
        for links in motion.iter().step_by(STEPS as usize / if count > 10_000 { 1 } else { 4 }) {
            let (quick, brute) = (scene.step(links), clearance(links, &obstacles, MarginOptions::default()));
            let (quick, brute) = (quick.expect("links"), brute.expect("links"));
            assert_eq!(
                (quick.margin, quick.link, quick.obstacle),
                (brute.margin, brute.link, brute.obstacle),
                "{count}"
            );
        }
        let mut steps = motion.iter().cycle();
        group.bench_function(BenchmarkId::new("step", count), |b| {
            b.iter(|| black_box(scene.step(steps.next().expect("a cycle")).expect("links")));
        });
        if count <= 1_000 {
            group.bench_function(BenchmarkId::new("brute force", count), |b| {
                b.iter(|| black_box(clearance(&motion[0], &obstacles, MarginOptions::default()).expect("links")));
            });
        }
    }
    group.finish();
}

/// A whole trajectory at once, as an optimiser asks for it: 64 waypoints of 30 links among 1,000 obstacles, with
/// gradients.
fn trajectory(c: &mut Criterion) {
    let waypoints: Vec<Vec<_>> = motion().into_iter().step_by(7).take(64).collect();
    let links: Vec<_> = waypoints.concat();
    let obstacles = obstacles(1_000);
    let options = MarginOptions::default();
    let scene = Clearance::new(&obstacles, options).expect("not empty");
    let mut group = c.benchmark_group("trajectory");
    // To where the cost of a pair ends: links grown to twice and to three times their size.
    for threshold in [3.0, 8.0] {
        let count = scene.within(&links, threshold).expect("a number").len();
        group.bench_function(BenchmarkId::new(format!("pairs within {threshold}"), count), |b| {
            b.iter(|| {
                let mut sum = DVec3::ZERO;
                let cost = |pair: NearPair<DVec3>, margin: Answer<'_, DVec3, Margin<DVec3>>| {
                    let gradient = margin.gradient();
                    sum += (threshold - pair.margin.margin) * (gradient.translation + gradient.rotation);
                };
                scene.each_within(&links, threshold, cost).expect("a number");
                sum
            });
        });
    }
    let mut scene = scene;
    group.bench_function("nearest of each waypoint", |b| {
        b.iter(|| {
            let mut sum = DVec3::ZERO;
            for links in &waypoints {
                let least = scene.step(links).expect("links");
                let pair = EllipsoidPair::new(&links[least.link], &obstacles[least.obstacle], options);
                sum += pair.margin().gradient().translation;
            }
            sum
        });
    });
    group.sample_size(10);
    group.bench_function("all pairs", |b| {
        let mut gradients = vec![DVec3::ZERO; obstacles.len()];
        b.iter(|| {
            for link in &links {
                map_margins_into(std::slice::from_ref(link), &obstacles, options, &mut gradients, |margin| {
                    let gradient = margin.gradient();
                    gradient.translation + gradient.rotation
                })
                .expect("as many as there are");
            }
            black_box(&mut gradients);
        });
    });
    group.finish();
}

criterion_group!(benches, bench, trajectory);
criterion_main!(benches);
