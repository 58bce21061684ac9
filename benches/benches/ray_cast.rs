//! How long does a ray cast against one body take (W1)?

use benches::rows::ray_casters;
use criterion::{Criterion, criterion_group, criterion_main};
use workloads::score::{Precision, ray_casts};
use workloads::shapes::{SHAPE_NAMES, Shape};
use workloads::w1_ray_cast::rays;

mod common;

fn bench(c: &mut Criterion) {
    for name in SHAPE_NAMES {
        let rays = rays(name);
        let solvers = ray_casters(&Shape::named(name), &rays);
        let score = |precision: Precision, answers: &[f64]| ray_casts(&rays, answers, precision);
        common::bench(c, &format!("ray_cast/{name}"), &solvers, score);
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
