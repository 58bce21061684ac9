//! How long does it take to tell whether two bodies meet (W3b)?

use benches::rows::{intersection_testers, warm_intersection_testers};
use criterion::{Criterion, criterion_group, criterion_main};
use workloads::pairs::{PAIR_NAMES, Pair};
use workloads::score::intersections;
use workloads::w3b_intersect::queries;

mod common;

fn bench(c: &mut Criterion) {
    for name in PAIR_NAMES {
        let pair = Pair::named(name);
        let queries = queries(&pair);
        let solvers = intersection_testers(&pair, &queries);
        common::bench(c, &format!("intersect/{name}"), &solvers, |_, answers| intersections(&queries, answers));
        let apart: Vec<_> = queries.into_iter().filter(|query| !query.meet).collect();
        let solvers = warm_intersection_testers(&pair, &apart);
        common::bench(c, &format!("intersect/warm/{name}"), &solvers, |_, answers| intersections(&apart, answers));
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
