//! How long does the margin of two ellipsoids take, by our method and by the paper's, with what can be asked beside it?
//!
//! Answers are given to `black_box` by reference, so that no copy of them is timed.

use std::hint::black_box;

use convex_support::Ellipsoid;
use convex_support::glam::{DMat3, DQuat, DVec3};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use ellip_margin::paper::free_margin_eigen;
use ellip_margin::{
    EllipsoidPair, MarginOptions, Method, distance, distance_bracket, free_margin, free_margins_into, scaling,
};
use nalgebra::SMatrix;
use workloads::rng::Rng;

const PAIRS: usize = 2_000;

/// Pairs of a batch.
const BATCH: usize = 10_000;

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

/// The margin by the paper's matrix `[[C, −I], [−bbᵀ, C]]` and nalgebra's eigenvalues of it, the fastest general
/// routine we know of for one of this size.
fn margin_by_nalgebra(e1: &Ellipsoid<DVec3>, e2: &Ellipsoid<DVec3>) -> f64 {
    let p = e1.matrix();
    let root = e2.axes() * DMat3::from_diagonal(e2.semi_axes()) * e2.axes().transpose(); // Q^-½
    let r = e1.center() - e2.center();
    let (c, b) = (root * p * root, root * (p * r));
    let m = SMatrix::<f64, 6, 6>::from_fn(|i, j| match (i < 3, j < 3) {
        (true, true) => c.col(j)[i],
        (true, false) => -f64::from(u8::from(i == j - 3)),
        (false, true) => -b[i - 3] * b[j],
        (false, false) => c.col(j - 3)[i - 3],
    });
    let lambda = m.complex_eigenvalues().iter().fold(f64::INFINITY, |least, l| least.min(l.re));
    let x = (c - DMat3::from_diagonal(DVec3::splat(lambda))).inverse() * b;
    let w = root * x - r;
    w.dot(p * w) - 1.0
}

fn bench(c: &mut Criterion) {
    let options = MarginOptions::default();
    let singular = options.with_method(Method::SingularBasis);
    for (name, seed, shortest) in [("condition_1e2", 60_030, 0.1), ("condition_1e6", 60_031, 1e-3)] {
        let pairs = pairs(seed, shortest);
        // Who is timed gives the right answer: the eigenvalues as far as they can.
        let mut astray = 0;
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
            let other = margin_by_nalgebra(a, b);
            astray += usize::from((other - basis.margin).abs() > tolerance * basis.margin);
        }
        // At a condition of 1e6 nalgebra's have no digit right for one pair in some thousand.
        let most = if shortest == 0.1 { 0 } else { PAIRS / 200 };
        assert!(astray <= most, "{astray} of {PAIRS} margins by nalgebra are wrong");
        let mut group = c.benchmark_group(format!("margin/{name}"));
        group.throughput(Throughput::Elements(PAIRS as u64));
        let mut row = |label: &str, f: &dyn Fn(&Ellipsoid<DVec3>, &Ellipsoid<DVec3>)| {
            group.bench_function(label, |bencher| {
                bencher.iter(|| pairs.iter().for_each(|[a, b]| f(black_box(a), black_box(b))));
            });
        };
        row("cold", &|a, b| {
            black_box(&free_margin(a, b, options));
        });
        row("cold, with gradient", &|a, b| {
            black_box(&EllipsoidPair::new(a, b, options).margin().gradient());
        });
        row("cold, singular basis", &|a, b| {
            black_box(&free_margin(a, b, singular));
        });
        row("eigenvalues (faer)", &|a, b| {
            black_box(&free_margin_eigen(a, b));
        });
        row("eigenvalues (nalgebra)", &|a, b| {
            black_box(margin_by_nalgebra(a, b));
        });
        row("distance bracket", &|a, b| {
            black_box(&distance_bracket(a, b, options));
        });
        row("exact distance", &|a, b| {
            black_box(&distance(a, b, options));
        });
        row("common scale", &|a, b| {
            black_box(&scaling(a, b, options));
        });
        let (first, second): (Vec<_>, Vec<_>) = pairs.iter().cycle().take(BATCH).map(|[a, b]| (*a, *b)).unzip();
        let mut margins = Vec::new();
        group.throughput(Throughput::Elements(BATCH as u64));
        group.bench_function("batch", |bencher| {
            bencher.iter(|| {
                margins.clear();
                free_margins_into(black_box(&first), black_box(&second), options, &mut margins)
                    .expect("lists of one length");
                black_box(&margins);
            });
        });
        group.finish();
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
