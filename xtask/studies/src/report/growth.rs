//! How the time of a query grows: with vertices, points, obstacles and dimension.

use std::hint::black_box;

use convex_support::glam::{DQuat, DVec3};
use convex_support::{Ellipsoid, Polytope, SupportMap};
use cpu_time::ThreadTime;
use ellip_margin::{Clearance, MarginOptions, clearance};
use gjk_raycast::{Ray, RayCastOptions, ray_cast};
use lj_ellipsoid::{EnclosingMethod, EnclosingOptions, enclosing, enclosing_dyn};

use crate::scene_growth;
use workloads::rng::Rng;
use xtask::plot::{Plot, Scale, Series};
use xtask::validate::page::{Block, Figure, Section};
use xtask::validate::{Scope, progress};

/// The chapter.
pub(super) fn section(scope: &Scope) -> Section {
    Section {
        id: "growth",
        title: "Growth with the size of the question",
        lead:
            "How the time of one query grows with vertices, points, obstacles and dimensions. On these axes a straight \
               line is a power: what is scanned has slope 1, what is looked up stays nearly level."
                .to_owned(),
        blocks: figures(scope).into_iter().map(Block::Figure).collect(),
    }
}

/// The figures that are asked for.
fn figures(scope: &Scope) -> Vec<Figure> {
    let mut figures = Vec::new();
    if scope.holds("ray_cast") {
        figures.push(vertices());
    }
    if scope.holds("enclosing_ellipsoid") {
        figures.extend([points(), dimension()]);
    }
    if scope.holds("clearance") {
        figures.push(obstacles());
    }
    if scope.holds("ray_cast") || scope.holds("linear_cast") || scope.holds("distance") {
        figures.extend(scene_growth::figures(&scene_growth::measured(scene_growth::MOST)));
    }
    figures
}

/// Mean nanoseconds of thread CPU time of a run, over about 20 ms or a single one.
pub(super) fn time(mut run: impl FnMut()) -> f64 {
    const BUDGET_NS: f64 = 2e7;
    let start = ThreadTime::now();
    run();
    let once = (start.elapsed().as_nanos() as f64).max(1.0);
    let count = (BUDGET_NS / once) as u32;
    if count == 0 {
        return once;
    }
    let start = ThreadTime::now();
    (0..count).for_each(|_| run());
    start.elapsed().as_nanos() as f64 / f64::from(count)
}

fn figure(name: &str, title: &str, x: &str, series: Vec<(String, Vec<[f64; 2]>)>, caption: &str) -> Figure {
    let series = series.into_iter().enumerate();
    Figure {
        name: name.to_owned(),
        plot: Plot {
            title: title.to_owned(),
            x: x.to_owned(),
            y: "time".to_owned(),
            scales: [Scale::Log, Scale::Time],
            floor: 1.0,
            series: series.map(|(colour, (name, points))| Series { name, points, joined: true, colour }).collect(),
        },
        caption: caption.to_owned(),
    }
}

/// Ray casts against the hull of points on a sphere.
fn vertices() -> Figure {
    let mut random = Rng::new(1);
    let rays: Vec<Ray<DVec3>> = (0..64)
        .map(|_| {
            let source = DVec3::from(random.sphere()) * 3.0;
            Ray { source, direction: DVec3::from(random.cube()) * 0.9 - source }
        })
        .collect();
    let (mut scan, mut climb) = (Vec::new(), Vec::new());
    for n in [4, 12, 32, 100, 316, 1000, 3162, 10_000, 31_623, 100_000] {
        progress(&format!("ray casts against {n} vertices"));
        let points: Vec<DVec3> = (0..n).map(|_| DVec3::from(random.sphere())).collect();
        let per_ray = |shape: &dyn SupportMap<Vector = DVec3>| {
            let cast = |ray: &Ray<DVec3>| black_box(ray_cast(shape, *ray, RayCastOptions::default()).is_ok());
            time(|| rays.iter().for_each(|ray| _ = cast(ray))) / rays.len() as f64
        };
        if let Ok(all) = Polytope::new(points.iter().copied()) {
            scan.push([f64::from(n), per_ray(&all)]);
        }
        if let Ok(hull) = Polytope::hull_of(points) {
            climb.push([f64::from(n), per_ray(&hull)]);
        }
    }
    figure(
        "growth-vertices",
        "Ray cast: time against vertices",
        "vertices",
        vec![("scan of all points".to_owned(), scan), ("look-up on the hull".to_owned(), climb)],
        "Rays from three radii away, most of which hit, against the hull of points on a sphere, f64. Scanning looks at \
         every point in every support query; of the hull, found once, the few vertices that can be farthest are looked \
         up. What to expect: a hundred times the vertices cost a look-up little.",
    )
}

/// Enclosing ellipsoids of points in a ball.
fn points() -> Figure {
    let mut random = Rng::new(2);
    let methods = [
        ("Newton", EnclosingMethod::Newton),
        ("Khachiyan", EnclosingMethod::Khachiyan),
        ("ellipsoid algorithm", EnclosingMethod::EllipsoidAlgorithm),
        ("dual Newton", EnclosingMethod::DualReducedNewton),
    ];
    let mut series: Vec<(String, Vec<[f64; 2]>)> =
        methods.iter().map(|(name, _)| ((*name).to_owned(), vec![])).collect();
    for n in [5, 10, 100, 1000, 10_000, 100_000, 1_000_000] {
        let points: Vec<[f64; 3]> =
            (0..n).map(|_| (DVec3::from(random.sphere()) * random.signed().abs().cbrt()).to_array()).collect();
        for ((name, method), (_, measured)) in methods.into_iter().zip(&mut series) {
            progress(&format!("{name} on {n} points"));
            // No point in waiting longer than a second for a method that has been outrun.
            if measured.last().is_some_and(|[_, last]| *last > 1e8) {
                continue;
            }
            let options = EnclosingOptions::default().with_method(method).with_epsilon(1e-7);
            measured.push([f64::from(n), time(|| _ = black_box(enclosing(&points, options).is_ok()))]);
        }
    }
    figure(
        "growth-points",
        "Enclosing ellipsoid: time against points",
        "points",
        series,
        "Points spread evenly in a ball, three dimensions, certified gap 1e-7. A method is not tried on ten times the points \
         once it takes more than 0.1 s. What to expect: Newton's method on a working set looks at most points once or \
         twice, so that a million cost no more than a few scans.",
    )
}

/// Enclosing ellipsoids of 200 points in many dimensions.
fn dimension() -> Figure {
    let mut random = Rng::new(3);
    let mut measured = Vec::new();
    for n in 2..=10usize {
        progress(&format!("{n} dimensions"));
        let cloud: Vec<Vec<f64>> = (0..200).map(|_| (0..n).map(|_| random.signed()).collect()).collect();
        let run = || _ = black_box(enclosing_dyn(&cloud, EnclosingOptions::default()).is_ok());
        measured.push([n as f64, time(run)]);
    }
    figure(
        "growth-dimension",
        "Enclosing ellipsoid: time against dimension",
        "dimension",
        vec![("Newton".to_owned(), measured)],
        "200 points in a cube, certified gap 1e-9, the dimension known at run time only. What to expect: a power, not \
         an exponential.",
    )
}

/// A robot of 30 links along a smooth trajectory among obstacles.
fn obstacles() -> Figure {
    let mut random = Rng::new(4);
    let (mut culled, mut brute) = (Vec::new(), Vec::new());
    for m in [10, 100, 1000, 10_000, 100_000] {
        progress(&format!("clearance among {m} obstacles"));
        let obstacles = field(m, &mut random);
        let Ok(mut tracked) = Clearance::new(&obstacles, MarginOptions::default()) else { continue };
        let mut step = 0.0;
        let mut links = || {
            step += 1.0;
            robot(step * 0.01)
        };
        let _ = tracked.step(&links());
        culled.push([f64::from(m), time(|| _ = black_box(tracked.step(&links()).is_ok()))]);
        if m <= 10_000 {
            let run = || _ = black_box(clearance(&links(), &obstacles, MarginOptions::default()).is_ok());
            brute.push([f64::from(m), time(run)]);
        }
    }
    figure(
        "growth-obstacles",
        "Clearance: time per step against obstacles",
        "obstacles",
        vec![("culled and tracked".to_owned(), culled), ("all pairs".to_owned(), brute)],
        "A chain of 30 links that turns by 0.01 radians per step among ellipsoids of constant density; the least margin of all \
         pairs in every step. What to expect: all pairs grow with their number, the tracked tree hardly at all.",
    )
}

/// Ellipsoids around a robot. As many as there are, the space they fill grows: the density around the robot stays.
pub(super) fn field(count: u32, random: &mut Rng) -> Vec<Ellipsoid<DVec3>> {
    let extent = 2.0 * f64::from(count).cbrt();
    (0..count)
        .filter_map(|_| {
            let center = DVec3::from(random.cube()) * extent;
            let center = center + center.normalize() * 3.0;
            let semi_axes = DVec3::splat(0.3) + DVec3::from(random.cube()).abs() * 0.4;
            Ellipsoid::new(center, semi_axes, DQuat::from_scaled_axis(DVec3::from(random.cube()) * 3.0)).ok()
        })
        .collect()
}

/// A chain of 30 links, bent and turned by an angle.
pub(super) fn robot(angle: f64) -> Vec<Ellipsoid<DVec3>> {
    (0..30)
        .filter_map(|i| {
            let along = f64::from(i) / 29.0;
            let (sine, cosine) = (angle + along).sin_cos();
            let center = DVec3::new(2.0 * along * cosine, 2.0 * along * sine, 0.5 * (3.0 * along + angle).sin());
            Ellipsoid::new(center, DVec3::new(0.08, 0.05, 0.04), DQuat::from_rotation_z(angle + along)).ok()
        })
        .collect()
}
