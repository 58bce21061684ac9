//! Runs one row of the workloads once, for callgrind to count: `instructions ROW`, or `instructions` to list the rows.
//!
//! `benches/instructions.sh` runs them all and compares with the committed table. `instructions --addresses` prints
//! where the code begins that is run once between the inputs and the end, and where that which follows it;
//! `benches/blocked.sh` counts between them.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "printing is what it is for")]

use std::process::ExitCode;

use benches::measure::Solver;
use benches::ours::Effort;
use benches::ours::shapes::{Boxed, OfWorkload, VALID, with, with_both};
use benches::ours::tasks::{Distances, Intersections, LinearCasts, MotionCasts, RayCasts, SignedDistances};
use convex_support::glam::{DVec2, DVec3, Vec3A};
use convex_support::{
    Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Faceted, Polytope, Rounded, Scalar as _, SupportMap,
};
use gjk_raycast::{Ray, RayCastOptions};
use workloads::Pose;
use workloads::pairs::Pair;
use workloads::rng::Rng;
use workloads::shapes::{Shape, hull_points};
use workloads::vec3::{add, scale};
use workloads::w2_linear_cast::Cast;
use workloads::{w1_ray_cast, w2_linear_cast, w3_distance, w3b_intersect, w6_motion_cast};

/// Queries of a row that are run.
const QUERIES: usize = 500;

/// A name, and how to make it.
type Row = (&'static str, fn() -> Solver);

/// The cuboid and the hull in double precision, of which most rows are.
type Block = Cuboid<DVec3>;
type Hull = Polytope<DVec3>;
type RoundBox = Rounded<Cuboid<DVec3>>;

/// Rows that stand for the rest: polytopes, smooth and rounded bodies, small and large, known and behind `dyn`, in
/// space and in the plane, each kind of query. Only their shapes are compiled.
const ROWS: [Row; 40] = [
    ("ray_cast/cuboid", || ray_cast::<Block>("cuboid")),
    ("ray_cast/hull1024", || ray_cast::<Hull>("hull1024")),
    ("linear_cast/hull64-hull64", || linear_cast::<Hull, Hull>("hull64-hull64")),
    ("linear_cast/cuboid-cuboid", || linear_cast::<Block, Block>("cuboid-cuboid")),
    ("linear_cast/capsule-capsule", || linear_cast::<Capsule<DVec3>, Capsule<DVec3>>("capsule-capsule")),
    ("distance/ellipsoid-ellipsoid", || distance::<Ellipsoid<DVec3>, Ellipsoid<DVec3>>("ellipsoid-ellipsoid")),
    ("intersect/cuboid-cuboid", || intersect::<Block, Block>("cuboid-cuboid")),
    ("ray_cast/ball", || ray_cast::<Ball<DVec3>>("ball")),
    ("ray_cast/hull16", || ray_cast::<Faceted<DVec3>>("hull16")),
    ("ray_cast/cylinder", || ray_cast::<Cylinder<DVec3>>("cylinder")),
    ("ray_cast/plane-hull64", || {
        planar_ray_cast(Polytope::new(hull_points(64).into_iter().map(seen)).expect("64 points span a polygon"))
    }),
    ("ray_cast/cuboid-dyn", || rays("cuboid", |rays, shape| with::<Block>(shape, Boxed(rays)))),
    ("linear_cast/cylinder-cone", || linear_cast::<Cylinder<DVec3>, Cone<DVec3>>("cylinder-cone")),
    ("linear_cast/hull64-hull64-dyn", || {
        casts("hull64-hull64", |casts, pair| with_both::<Hull, Hull>(pair, Boxed(casts)))
    }),
    ("distance/cylinder-cone", || distance::<Cylinder<DVec3>, Cone<DVec3>>("cylinder-cone")),
    ("distance/cuboid-cuboid-dyn", || {
        distances("cuboid-cuboid", 0, |distances, pair| with_both::<Block, Block>(pair, Boxed(distances)))
    }),
    ("motion_cast/cuboid-cuboid", || motion_cast::<Block, Block>("cuboid-cuboid")),
    ("motion_cast/hull64-hull64", || motion_cast::<Hull, Hull>("hull64-hull64")),
    ("motion_cast/ellipsoid-ellipsoid", || motion_cast::<Ellipsoid<DVec3>, Ellipsoid<DVec3>>("ellipsoid-ellipsoid")),
    ("signed_distance/cuboid-cuboid", || signed_distance::<Block, Block>("cuboid-cuboid")),
    ("signed_distance/cylinder-cone", || signed_distance::<Cylinder<DVec3>, Cone<DVec3>>("cylinder-cone")),
    ("signed_distance/ball-cuboid", || signed_distance::<Ball<DVec3>, Block>("ball-cuboid")),
    ("signed_distance/roundbox-roundbox", || signed_distance::<RoundBox, RoundBox>("roundbox-roundbox")),
    ("motion_cast/capsule-capsule", || motion_cast::<Capsule<DVec3>, Capsule<DVec3>>("capsule-capsule")),
    ("motion_cast/ball-cuboid", || motion_cast::<Ball<DVec3>, Block>("ball-cuboid")),
    ("near_contact/ball-cuboid-f32", || near_contact::<Ball<Vec3A>, Cuboid<Vec3A>>("ball-cuboid")),
    ("near_contact/cuboid-cuboid-f32", || near_contact::<Cuboid<Vec3A>, Cuboid<Vec3A>>("cuboid-cuboid")),
    ("near_contact/hull64-hull64-f32", || near_contact::<Polytope<Vec3A>, Polytope<Vec3A>>("hull64-hull64")),
    ("intersect/hull64-hull64-f32", || intersect::<Polytope<Vec3A>, Polytope<Vec3A>>("hull64-hull64")),
    ("ray_cast/hull64-face", || {
        let rays = w1_ray_cast::square_on_faces("hull64", QUERIES);
        with::<Hull>(&Shape::named("hull64"), RayCasts(&rays, Effort::default()))
    }),
    ("ray_cast/cone-leaving", rays_leaving_a_cone),
    ("ray_cast/plane-polygon64", || planar_ray_cast(polygon())),
    ("ray_cast/plane-rounded-ellipse", || {
        let ellipse = Ellipsoid::new(DVec2::ZERO, DVec2::new(1.0, 0.8), 0.0).expect("an ellipse");
        planar_ray_cast(Rounded::new(ellipse, 0.125).expect("a radius"))
    }),
    ("ray_cast/plane-rounded-polygon64", || planar_ray_cast(Rounded::new(polygon(), 0.125).expect("a radius"))),
    ("linear_cast/cuboid-cuboid-face", || linear_cast_at_face::<Block, Block>("cuboid-cuboid")),
    ("linear_cast/hull64-hull64-face", || linear_cast_at_face::<Hull, Hull>("hull64-hull64")),
    ("linear_cast/ellipsoid-ellipsoid", || linear_cast::<Ellipsoid<DVec3>, Ellipsoid<DVec3>>("ellipsoid-ellipsoid")),
    ("linear_cast/roundbox-roundbox", || linear_cast::<RoundBox, RoundBox>("roundbox-roundbox")),
    ("linear_cast/hull64-hull64-touching", || linear_cast_from_contact::<Hull, Hull>("hull64-hull64")),
    ("linear_cast/roundbox-roundbox-touching", || linear_cast_from_contact::<RoundBox, RoundBox>("roundbox-roundbox")),
];

fn rays(name: &str, solver: impl Fn(RayCasts<'_>, &Shape) -> Solver) -> Solver {
    solver(RayCasts(&w1_ray_cast::rays(name)[..QUERIES], Effort::default()), &Shape::named(name))
}

fn ray_cast<S: OfWorkload>(name: &str) -> Solver {
    rays(name, |rays, shape| with::<S>(shape, rays))
}

fn casts(name: &str, solver: impl Fn(LinearCasts<'_>, &Pair) -> Solver) -> Solver {
    let pair = Pair::named(name);
    solver(LinearCasts(&w2_linear_cast::casts(&pair)[..QUERIES], Effort::default()), &pair)
}

fn linear_cast<A: OfWorkload, B: OfWorkload<Vector = A::Vector>>(name: &str) -> Solver {
    casts(name, |casts, pair| with_both::<A, B>(pair, casts))
}

fn linear_cast_at_face<A: OfWorkload, B: OfWorkload<Vector = A::Vector>>(name: &str) -> Solver {
    let pair = Pair::named(name);
    with_both::<A, B>(&pair, LinearCasts(&w2_linear_cast::inside_faces(&pair, QUERIES), Effort::default()))
}

/// The hits of W2 from where they touch, to rounding; every other one backwards, so that it leaves.
fn linear_cast_from_contact<A: OfWorkload, B: OfWorkload<Vector = A::Vector>>(name: &str) -> Solver {
    let pair = Pair::named(name);
    let hits = w2_linear_cast::casts(&pair).into_iter().filter_map(|cast| Some((cast, cast.lambda?)));
    let moved = hits.zip([1.0, -1.0].into_iter().cycle()).map(|((cast, lambda), sign)| {
        let translation = add(cast.pose.translation, scale(cast.velocity, lambda));
        Cast { pose: Pose { translation, ..cast.pose }, velocity: scale(cast.velocity, sign), ..cast }
    });
    with_both::<A, B>(&pair, LinearCasts(&moved.take(QUERIES).collect::<Vec<_>>(), Effort::default()))
}

fn distances(name: &str, from: usize, solver: impl Fn(Distances<'_>, &Pair) -> Solver) -> Solver {
    let pair = Pair::named(name);
    solver(Distances(&w3_distance::queries(&pair)[from..][..QUERIES], Effort::default()), &pair)
}

fn distance<A: OfWorkload, B: OfWorkload<Vector = A::Vector>>(name: &str) -> Solver {
    distances(name, 0, |distances, pair| with_both::<A, B>(pair, distances))
}

/// Distances within a few rounding errors of contact.
fn near_contact<A: OfWorkload, B: OfWorkload<Vector = A::Vector>>(name: &str) -> Solver {
    distances(name, w3_distance::FAR, |distances, pair| with_both::<A, B>(pair, distances))
}

fn intersect<A: OfWorkload, B: OfWorkload<Vector = A::Vector>>(name: &str) -> Solver {
    let pair = Pair::named(name);
    let queries = &w3b_intersect::queries(&pair)[..QUERIES];
    with_both::<A, B>(&pair, Intersections { queries, is_warm: false, effort: Effort::default() })
}

fn motion_cast<A: OfWorkload<Vector = DVec3>, B: OfWorkload<Vector = DVec3>>(name: &str) -> Solver {
    let pair = Pair::named(name);
    with_both::<A, B>(&pair, MotionCasts(&w6_motion_cast::casts(&pair)[..QUERIES], Effort::default()))
}

/// Of the bodies of W3b, half of which overlap.
fn signed_distance<A: OfWorkload<Vector = DVec3>, B: OfWorkload<Vector = DVec3>>(name: &str) -> Solver {
    let pair = Pair::named(name);
    with_both::<A, B>(&pair, SignedDistances(&w3b_intersect::queries(&pair)[..QUERIES], Effort::default()))
}

/// The rays of `hull64` seen along z, at a target in the plane.
fn planar_ray_cast(target: impl SupportMap<Vector = DVec2> + 'static) -> Solver {
    let rays = w1_ray_cast::rays("hull64").into_iter().take(QUERIES);
    let rays = rays.map(|ray| Ray { source: seen(ray.origin), direction: seen(ray.direction) });
    rays_at(target, rays.collect(), RayCastOptions::default())
}

fn seen([x, y, _]: [f64; 3]) -> DVec2 {
    DVec2::new(x, y)
}

/// 64 corners on an ellipse.
fn polygon() -> Polytope<DVec2> {
    let mut rng = Rng::new(64);
    let points = (0..64).map(|_| seen(rng.sphere()).normalize() * DVec2::new(1.0, 0.8));
    Polytope::new(points).expect("64 points span a polygon")
}

/// Rays from where those of W1 hit a cone, back to where the next ones came from. They begin a little behind their
/// source, as a ray tracer has them.
fn rays_leaving_a_cone() -> Solver {
    let rays = w1_ray_cast::rays("cone");
    let from_hit = |(i, ray): (usize, &w1_ray_cast::Ray)| {
        let source = DVec3::from(ray.origin) + ray.lambda? * DVec3::from(ray.direction);
        Some(Ray { source, direction: DVec3::from(rays[i + 1].origin) - source })
    };
    let leaving = rays[..rays.len() - 1].iter().enumerate().filter_map(from_hit).take(QUERIES);
    let target = Cone::of(&Shape::named("cone")).expect(VALID);
    rays_at(target, leaving.collect(), RayCastOptions::default().with_min_lambda(1e-6))
}

fn rays_at<S: SupportMap + 'static>(
    target: S,
    rays: Vec<Ray<S::Vector>>,
    options: RayCastOptions<S::Vector>,
) -> Solver {
    Solver::new(rays, move |&ray| match gjk_raycast::ray_cast(&target, ray, options) {
        Ok(cast) => cast.outcome.hit().map_or(f64::INFINITY, |hit| hit.lambda.as_f64()),
        Err(_) => f64::NAN,
    })
}

fn main() -> ExitCode {
    let Some(wanted) = std::env::args().nth(1) else {
        ROWS.iter().for_each(|(name, _)| println!("{name}"));
        return ExitCode::SUCCESS;
    };
    if wanted == "--addresses" {
        println!("{:p} {:p}", counted as fn(&Solver), done as fn());
        return ExitCode::SUCCESS;
    }
    let Some((_, solver)) = ROWS.iter().find(|(name, _)| *name == wanted) else {
        eprintln!("no row is called {wanted:?}");
        return ExitCode::FAILURE;
    };
    counted(&solver());
    done();
    ExitCode::SUCCESS
}

/// What runs after [`counted`].
#[inline(never)]
fn done() {
    std::hint::black_box(());
}

/// What callgrind counts; making the inputs is left out.
#[inline(never)]
fn counted(solver: &Solver) {
    solver.run(0..QUERIES);
}
