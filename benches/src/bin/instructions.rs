//! Runs one row of the workloads once, for callgrind to count: `instructions ROW`, or `instructions` to list the rows.
//!
//! `benches/instructions.sh` runs them all and compares with the committed table.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "printing is what it is for")]

use std::process::ExitCode;

use benches::measure::Solver;
use benches::ours::{self, Effort};
use convex_support::Polytope;
use convex_support::glam::DVec2;
use gjk_raycast::{Ray, RayCastOptions};
use workloads::pairs::Pair;
use workloads::score::Precision;
use workloads::shapes::{Shape, hull_points};
use workloads::{w1_ray_cast, w2_linear_cast, w3_distance, w3b_intersect, w6_motion_cast};

/// Queries of a row that are run.
const QUERIES: usize = 500;

/// A name, and how to make it.
type Row = (&'static str, fn() -> Solver);

/// Rows that stand for the rest: polytopes, smooth and rounded bodies, small and large, known and behind `dyn`, in space and
/// in the plane, each kind of query.
const ROWS: [Row; 23] = [
    ("ray_cast/cuboid", || ray_cast("cuboid", Effort::default())),
    ("ray_cast/hull1024", || ray_cast("hull1024", Effort::default())),
    ("linear_cast/hull64-hull64", || linear_cast("hull64-hull64", Effort::default())),
    ("linear_cast/cuboid-cuboid", || linear_cast("cuboid-cuboid", Effort::default())),
    ("linear_cast/capsule-capsule", || linear_cast("capsule-capsule", Effort::default())),
    ("distance/ellipsoid-ellipsoid", || distance("ellipsoid-ellipsoid", Effort::default())),
    ("intersect/cuboid-cuboid", || {
        let pair = Pair::named("cuboid-cuboid");
        ours::intersections(
            Precision::Double,
            &pair,
            &w3b_intersect::queries(&pair)[..QUERIES],
            false,
            Effort::default(),
        )
    }),
    ("ray_cast/ball", || ray_cast("ball", Effort::default())),
    ("ray_cast/cylinder", || ray_cast("cylinder", Effort::default())),
    ("ray_cast/plane-hull64", planar_ray_cast),
    ("ray_cast/cuboid-dyn", || ray_cast("cuboid", boxed())),
    ("linear_cast/cylinder-cone", || linear_cast("cylinder-cone", Effort::default())),
    ("linear_cast/hull64-hull64-dyn", || linear_cast("hull64-hull64", boxed())),
    ("distance/cylinder-cone", || distance("cylinder-cone", Effort::default())),
    ("distance/cuboid-cuboid-dyn", || distance("cuboid-cuboid", boxed())),
    ("motion_cast/cuboid-cuboid", || motion_cast("cuboid-cuboid")),
    ("motion_cast/hull64-hull64", || motion_cast("hull64-hull64")),
    ("motion_cast/ellipsoid-ellipsoid", || motion_cast("ellipsoid-ellipsoid")),
    ("signed_distance/cuboid-cuboid", || signed_distance("cuboid-cuboid")),
    ("signed_distance/cylinder-cone", || signed_distance("cylinder-cone")),
    ("near_contact/ball-cuboid-f32", || near_contact("ball-cuboid")),
    ("near_contact/cuboid-cuboid-f32", || near_contact("cuboid-cuboid")),
    ("near_contact/hull64-hull64-f32", || near_contact("hull64-hull64")),
];

/// Shapes as `Box<dyn SupportMap>`.
fn boxed() -> Effort {
    Effort { boxed: true, ..Effort::default() }
}

fn ray_cast(name: &str, effort: Effort) -> Solver {
    ours::ray_casts(Precision::Double, &Shape::named(name), &w1_ray_cast::rays(name)[..QUERIES], effort)
}

fn linear_cast(name: &str, effort: Effort) -> Solver {
    let pair = Pair::named(name);
    ours::linear_casts(Precision::Double, &pair, &w2_linear_cast::casts(&pair)[..QUERIES], effort)
}

fn distance(name: &str, effort: Effort) -> Solver {
    let pair = Pair::named(name);
    ours::distances(Precision::Double, &pair, &w3_distance::queries(&pair)[..QUERIES], effort)
}

/// Distances within a few rounding errors of contact.
fn near_contact(name: &str) -> Solver {
    let pair = Pair::named(name);
    let near = &w3_distance::queries(&pair)[w3_distance::FAR..][..QUERIES];
    ours::distances(Precision::Single, &pair, near, Effort::default())
}

fn motion_cast(name: &str) -> Solver {
    let pair = Pair::named(name);
    ours::motion_casts(&pair, &w6_motion_cast::casts(&pair)[..QUERIES], Effort::default())
}

/// Of the bodies of W3b, half of which overlap.
fn signed_distance(name: &str) -> Solver {
    let pair = Pair::named(name);
    ours::signed_distances(&pair, &w3b_intersect::queries(&pair)[..QUERIES], Effort::default())
}

/// The rays and points of `hull64`, seen along z.
fn planar_ray_cast() -> Solver {
    let seen = |v: [f64; 3]| DVec2::new(v[0], v[1]);
    let target = Polytope::new(hull_points(64).into_iter().map(seen)).expect("64 points span a polygon");
    let rays = w1_ray_cast::rays("hull64").into_iter().take(QUERIES);
    let rays = rays.map(|ray| Ray { source: seen(ray.origin), direction: seen(ray.direction) });
    Solver::new(rays.collect(), move |&ray| match gjk_raycast::ray_cast(&target, ray, RayCastOptions::default()) {
        Ok(cast) => cast.outcome.hit().map_or(f64::INFINITY, |hit| hit.lambda),
        Err(_) => f64::NAN,
    })
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
