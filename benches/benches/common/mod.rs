//! One criterion group for one case: all methods on identical inputs, after their answers have been checked.

use benches::measure::Solver;
use benches::rows::Method;
use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput};
use workloads::score::{Precision, Score};

/// Queries in one iteration.
const QUERIES: usize = 500;

/// Adds a row per method, named after its precision's vector type, and says where the answers are wrong: a fast wrong
/// answer is none.
pub(crate) fn bench(
    c: &mut Criterion,
    name: &str,
    solvers: &[(Method, Solver)],
    score: impl Fn(Precision, &[f64]) -> Score,
) {
    let mut group: BenchmarkGroup<'_, WallTime> = c.benchmark_group(name);
    group.throughput(Throughput::Elements(QUERIES as u64)).sample_size(20);
    for (method, solver) in solvers {
        let wrong = score(method.precision(), &solver.answers()).wrong();
        let row =
            if wrong == 0 { row_name(*method).to_owned() } else { format!("{} ({wrong} wrong)", row_name(*method)) };
        group.bench_function(row, |b| b.iter(|| solver.run(0..QUERIES)));
    }
    group.finish();
}

fn row_name(method: Method) -> &'static str {
    match method {
        Method::OursF64 => "ours/DVec3",
        Method::OursF32 => "ours/Vec3A",
        Method::DynF64 => "ours dyn/DVec3",
        Method::ClosedF64 => "ours closed form/DVec3",
        Method::ClosedF32 => "ours closed form/Vec3A",
        Method::WarmF64 => "ours warm/DVec3",
        Method::WarmF32 => "ours warm/Vec3A",
        Method::ParryGjkF64 => "parry gjk/f64",
        Method::ParryGjkF32 => "parry gjk/f32",
        Method::ParryF64 => "parry/f64",
        Method::ParryF32 => "parry/f32",
        Method::Box3d => "box3d/f32",
        Method::Jolt => "jolt/f32",
    }
}
