//! Runs one row of the workloads once, for callgrind to count: `instructions ROW`, or `instructions` to list the rows.
//!
//! `benches/instructions.sh` runs them all and compares with the committed table.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "printing is what it is for")]

use std::process::ExitCode;

use benches::measure::Solver;
use benches::ours::{self, Effort};
use benches::pairs::Pair;
use benches::shapes::Shape;
use benches::{w1_ray_cast, w2_linear_cast, w3_distance, w3b_intersect};
use convex_support::glam::DVec3;

/// Queries of a row that are run.
const QUERIES: usize = 500;

/// A name, and how to make it.
type Row = (&'static str, fn() -> Solver);

/// Six rows that stand for the rest: polytope, smooth and rounded bodies, small and large, each kind of query.
const ROWS: [Row; 6] = [
    ("ray_cast/cuboid", || ray_cast("cuboid")),
    ("ray_cast/hull1024", || ray_cast("hull1024")),
    ("linear_cast/hull64-hull64", || {
        let pair = Pair::named("hull64-hull64");
        ours::linear_casts::<DVec3>(&pair, &w2_linear_cast::casts(&pair)[..QUERIES], Effort::default())
    }),
    ("linear_cast/capsule-capsule", || {
        let pair = Pair::named("capsule-capsule");
        ours::linear_casts::<DVec3>(&pair, &w2_linear_cast::casts(&pair)[..QUERIES], Effort::default())
    }),
    ("distance/ellipsoid-ellipsoid", || {
        let pair = Pair::named("ellipsoid-ellipsoid");
        ours::distances::<DVec3>(&pair, &w3_distance::queries(&pair)[..QUERIES], Effort::default())
    }),
    ("intersect/cuboid-cuboid", || {
        let pair = Pair::named("cuboid-cuboid");
        ours::intersections::<DVec3>(&pair, &w3b_intersect::queries(&pair)[..QUERIES], false, Effort::default())
    }),
];

fn ray_cast(name: &str) -> Solver {
    ours::ray_casts::<DVec3>(&Shape::named(name), &w1_ray_cast::rays(name)[..QUERIES], Effort::default())
}

fn main() -> ExitCode {
    let Some(wanted) = std::env::args().nth(1) else {
        ROWS.iter().for_each(|(name, _)| println!("{name}"));
        return ExitCode::SUCCESS;
    };
    let Some((_, solver)) = ROWS.iter().find(|(name, _)| *name == wanted) else {
        eprintln!("no row is called {wanted:?}");
        return ExitCode::FAILURE;
    };
    counted(&solver());
    ExitCode::SUCCESS
}

/// What callgrind counts; making the inputs is left out.
#[inline(never)]
fn counted(solver: &Solver) {
    solver.run(0..QUERIES);
}
