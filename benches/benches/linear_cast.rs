//! How long does it take to find when two moving bodies first touch (W2)?

use benches::rows::linear_casters;
use criterion::{Criterion, criterion_group, criterion_main};
use workloads::pairs::{PAIR_NAMES, Pair};
use workloads::score::linear_casts;
use workloads::w2_linear_cast::{casts, grazing};

mod common;

fn bench(c: &mut Criterion) {
    for name in PAIR_NAMES {
        let pair = Pair::named(name);
        let casts = casts(&pair);
        let grazing = grazing(&pair, &casts);
        let solvers = linear_casters(&pair, &casts);
        common::bench(c, &format!("linear_cast/{name}"), &solvers, |_, answers| {
            linear_casts(&casts, &grazing, answers)
        });
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
