//! How long does the distance of two bodies take, far from each other and near (W3)?

use benches::rows::distance_solvers;
use criterion::{Criterion, criterion_group, criterion_main};
use workloads::pairs::{PAIR_NAMES, Pair};
use workloads::score::distances;
use workloads::w3_distance::{FAR, queries};

mod common;

fn bench(c: &mut Criterion) {
    for name in PAIR_NAMES {
        let pair = Pair::named(name);
        let queries = queries(&pair);
        for (range, queries) in [("far", &queries[..FAR]), ("near", &queries[FAR..])] {
            let solvers = distance_solvers(&pair, queries);
            common::bench(c, &format!("distance/{range}/{name}"), &solvers, |_, answers| distances(queries, answers));
        }
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
