//! How long does the smallest ellipsoid around points take (W4), by each method, and how near does it come?
//!
//! Rows of one group have identical points. Before timing, the answers of a group are checked against each other within
//! their certified gaps; the gap reached is part of the row's name.

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use lj_ellipsoid::{Enclosing, EnclosingMethod, EnclosingOptions, MovingPoints, enclosing};
use workloads::w4_enclosing::{Cloud, cloud, corners, in_ball, on_sphere};

/// The certified gaps on ln det that each method is asked for, and the most points it is asked about.
const METHODS: [(&str, EnclosingMethod, &[f64], usize); 4] = [
    ("newton", EnclosingMethod::Newton, &[1e-4, 1e-7, 1e-12], usize::MAX),
    ("dual reduced newton", EnclosingMethod::DualReducedNewton, &[1e-7, 1e-12], 10_000),
    ("khachiyan away", EnclosingMethod::Khachiyan, &[1e-4, 1e-7], 10_000),
    ("ellipsoid algorithm", EnclosingMethod::EllipsoidAlgorithm, &[1e-2, 1e-4], 100),
];

/// Agreement within the certified gaps: nobody is better than somebody else's bound.
fn check<const N: usize>(answers: &[Enclosing<N>]) {
    for a in answers {
        for b in answers {
            let excess = a.ellipsoid.log_det() - b.ellipsoid.log_det();
            assert!(excess <= b.log_det_gap + 1e-10, "ln det {excess} beyond a bound of {}", b.log_det_gap);
        }
    }
}

fn group<const N: usize>(c: &mut Criterion, name: &str, points: &[[f64; N]]) {
    let mut group = c.benchmark_group(format!("enclosing/{name}/n{N}/m{}", points.len()));
    group.warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(1)).sample_size(10);
    let mut answers = Vec::new();
    for (method_name, method, gaps, most) in METHODS {
        if points.len() > most {
            continue;
        }
        for &gap in gaps {
            let options = EnclosingOptions::new().with_method(method).with_epsilon(gap).with_max_iterations(100_000);
            let answer = enclosing(points, options).expect("the points span the space");
            let row = format!("{method_name} {gap:.0e}, reached {:.0e}", answer.log_det_gap);
            answers.push(answer);
            group.bench_function(BenchmarkId::from_parameter(row), |b| {
                b.iter(|| enclosing(black_box(points), options));
            });
        }
    }
    check(&answers);
    group.finish();
}

fn workload(c: &mut Criterion) {
    for (name, kind) in [("normal", Cloud::Normal), ("cube", Cloud::Cube)] {
        for count in [8, 100, 10_000, 1_000_000] {
            group::<2>(c, name, &cloud(kind, count));
            group::<3>(c, name, &cloud(kind, count));
        }
        group::<10>(c, name, &cloud(kind, 10_000));
    }
}

fn hard(c: &mut Criterion) {
    group::<2>(c, "box", &corners([2.0, 1.0]));
    group::<3>(c, "box", &corners([3.0, 2.0, 1.0]));
    group::<3>(c, "normal", &cloud(Cloud::Normal, 1_000));
    for count in [1_000, 10_000, 1_000_000] {
        group::<3>(c, "ball", &in_ball(count));
        group::<3>(c, "sphere", &on_sphere(count));
    }
}

/// One point of a thousand moves out and back: a warm solve against a cold one.
fn moving(c: &mut Criterion) {
    let points: Vec<[f64; 3]> = in_ball(1_000);
    let options = EnclosingOptions::new().with_epsilon(1e-9);
    let mut group = c.benchmark_group("enclosing/moving/n3/m1000");
    let mut moving = MovingPoints::new(&points, options).expect("finite");
    let touching = moving.enclosing().expect("full rank").contacts[0];
    let home = points[touching];
    let mut step = 0u32;
    group.bench_function("warm", |b| {
        b.iter(|| {
            step += 1;
            let out = 1.0 + 1e-3 * f64::from(step % 7);
            moving.update(touching, home.map(|x| x * out)).expect("finite");
            moving.enclosing().expect("full rank").log_det_gap
        });
    });
    group.bench_function("cold", |b| b.iter(|| enclosing(black_box(&points), options)));
    group.finish();
}

criterion_group!(benches, workload, hard, moving);
criterion_main!(benches);
