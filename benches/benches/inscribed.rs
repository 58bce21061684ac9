//! How long does the largest ellipsoid inside half-spaces, or inside the hull of points, take?

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use lj_ellipsoid::{HalfSpace, InscribedOptions, Status, inscribed, inscribed_in_hull};
use workloads::w4_enclosing::{Cloud, cloud, halfspaces};

fn from_halfspaces<const N: usize>(c: &mut Criterion) {
    let mut group = c.benchmark_group(format!("inscribed/halfspaces/n{N}"));
    group.warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(1));
    for count in [12, 60, 300, 2_000] {
        let body: Vec<HalfSpace<N>> =
            halfspaces(count).into_iter().map(|(normal, offset)| HalfSpace { normal, offset }).collect();
        let answer = inscribed(&body, InscribedOptions::new()).expect("a bounded body");
        assert_eq!(answer.status, Status::Converged, "{count} half-spaces, gap {}", answer.log_det_gap);
        group.bench_function(BenchmarkId::from_parameter(count), |b| {
            b.iter(|| inscribed(black_box(&body), InscribedOptions::new()));
        });
    }
    group.finish();
}

fn from_points<const N: usize>(c: &mut Criterion) {
    let mut group = c.benchmark_group(format!("inscribed/hull of normal points/n{N}"));
    group.warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(1));
    for count in [8, 100, 10_000] {
        let cloud = cloud::<N>(Cloud::Normal, count);
        let answer = inscribed_in_hull(&cloud, InscribedOptions::new()).expect("the points span the space");
        assert_eq!(answer.status, Status::Converged, "{count} points, gap {}", answer.log_det_gap);
        group.bench_function(BenchmarkId::from_parameter(count), |b| {
            b.iter(|| inscribed_in_hull(black_box(&cloud), InscribedOptions::new()));
        });
    }
    group.finish();
}

criterion_group!(
    benches,
    from_halfspaces::<2>,
    from_halfspaces::<3>,
    from_halfspaces::<6>,
    from_points::<2>,
    from_points::<3>
);
criterion_main!(benches);
