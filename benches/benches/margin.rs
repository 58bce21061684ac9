//! How long does the margin of two ellipsoids take, by our method and by the paper's, with what can be asked beside it?

use std::hint::black_box;

use benches::rng::Rng;
use convex_support::Ellipsoid;
use convex_support::glam::{DMat3, DQuat, DVec3};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use ellip_margin::eigen::free_margin_eigen;
use ellip_margin::{MarginOptions, Method, distance, distance_bracket, free_margin, scaling};

const PAIRS: usize = 2_000;

/// The pairs of W5 before either is made a ball: semi-axes from 1 to `shortest`, centres 3 apart.
fn pairs(seed: u64, shortest: f64) -> Vec<[Ellipsoid<DVec3>; 2]> {
    let mut rng = Rng::new(seed);
    let mut ellipsoid = |center: bool| {
        let a = DVec3::new(1.0, shortest + (1.0 - shortest) * rng.unit(), shortest);
        let [x, y, z, w] = rng.quat();
        let axes = DMat3::from_quat(DQuat::from_xyzw(x, y, z, w));
        let center = if center { DVec3::from_array(rng.sphere()) * 3.0 } else { DVec3::ZERO };
        Ellipsoid::from_axes(center, a, axes).expect("valid by construction")
    };
    (0..PAIRS).map(|_| [ellipsoid(false), ellipsoid(true)]).collect()
}

fn bench(c: &mut Criterion) {
    let options = MarginOptions::default();
    let singular = options.with_method(Method::SingularBasis);
    for (name, seed, shortest) in [("condition_1e2", 60_030, 0.1), ("condition_1e6", 60_031, 1e-3)] {
        let pairs = pairs(seed, shortest);
        // Who is timed gives the right answer: the eigenvalues as far as they can.
        for [a, b] in &pairs {
            let (ours, basis, paper) =
                (free_margin(a, b, options), free_margin(a, b, singular), free_margin_eigen(a, b));
            assert!((ours.margin - basis.margin).abs() <= 1e-11 * basis.margin, "{} {}", ours.margin, basis.margin);
            let tolerance = if shortest == 0.1 { 1e-9 } else { 0.1 };
            assert!(
                (paper.margin - basis.margin).abs() <= tolerance * basis.margin,
                "{} {}",
                paper.margin,
                basis.margin
            );
        }
        let mut group = c.benchmark_group(format!("margin/{name}"));
        group.throughput(Throughput::Elements(PAIRS as u64));
        let mut row = |label: &str, f: &dyn Fn(&Ellipsoid<DVec3>, &Ellipsoid<DVec3>)| {
            group.bench_function(label, |bencher| {
                bencher.iter(|| pairs.iter().for_each(|[a, b]| f(black_box(a), black_box(b))));
            });
        };
        row("cold", &|a, b| {
            let _ = black_box(free_margin(a, b, options));
        });
        row("cold, with gradient", &|a, b| {
            let _ = black_box(free_margin(a, b, options).gradient(a, b));
        });
        row("cold, singular basis", &|a, b| {
            let _ = black_box(free_margin(a, b, singular));
        });
        row("eigenvalues (faer)", &|a, b| {
            let _ = black_box(free_margin_eigen(a, b));
        });
        row("distance bracket", &|a, b| {
            let _ = black_box(distance_bracket(a, b, options));
        });
        row("exact distance", &|a, b| {
            let _ = black_box(distance(a, b, options));
        });
        row("common scale", &|a, b| {
            let _ = black_box(scaling(a, b, options));
        });
        group.finish();
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
