//! What a query did not have to do: rays cut off at their end, planes remembered, pairs that cannot matter.

use benches::ours::{self, Effort};
use convex_support::glam::{DQuat, DVec3};
use convex_support::{Cylinder, Ellipsoid, InvalidShape, Polytope, Posed, Segment, SupportMap};
use ellip_margin::{Clearance, MarginOptions};
use gjk_raycast::{IntersectOptions, Outcome, Ray, RayCastOptions, WarmStart, intersects, ray_cast};
use workloads::pairs::{PAIR_NAMES, Pair};
use workloads::{w3_distance, w3b_intersect};

use super::headline::named;
use super::{growth, paper};
use crate::scene;
use workloads::rng::Rng;
use workloads::score::Precision;
use xtask::plot::{Plot, Scale, Series};
use xtask::validate::page::{Block, Figure, Row, Section, Table};
use xtask::validate::{Scope, progress};

/// The chapter.
pub(super) fn section(scope: &Scope) -> Section {
    let mut blocks = Vec::new();
    if scope.holds("ray_cast") {
        progress("rays of finite length");
        blocks.push(Block::Figure(short_rays(&finite_rays())));
        progress("warm starts");
        blocks.push(Block::Figure(warm_start(&coherence())));
    }
    if scope.holds("intersect") || scope.holds("distance") {
        progress("early outs");
        blocks.push(Block::Table(early_out()));
    }
    if scope.holds("clearance") {
        progress("culled pairs");
        blocks.push(Block::Table(culled()));
        progress("a robot along its trajectory");
        blocks.extend(levels().map(Block::Table));
    }
    Section {
        id: "left-out",
        title: "What was left out",
        lead: "The cheapest work is the work not done: rays that end, planes that are remembered, pairs that cannot matter. Work is counted \
               in support points (how often a body is asked for its farthest point), which do not depend on the machine."
            .to_owned(),
        blocks,
    }
}

type Body = Box<dyn SupportMap<Vector = DVec3>>;

/// A polytope, an ellipsoid or a cylinder of about unit size, turned at random.
fn body(random: &mut Rng, kind: usize, center: DVec3) -> Result<Body, InvalidShape> {
    let rotation = DQuat::from_scaled_axis(DVec3::from(random.cube()) * 3.0);
    Ok(match kind % 3 {
        0 => {
            let points: Vec<DVec3> = (0..16).map(|_| DVec3::from(random.sphere())).collect();
            Box::new(Posed::new(Polytope::new(points)?, rotation, center)?)
        }
        1 => {
            let semi_axes = DVec3::splat(0.4) + DVec3::from(random.cube()).abs() * 0.6;
            Box::new(Posed::new(Ellipsoid::new(DVec3::ZERO, semi_axes, DQuat::IDENTITY)?, rotation, center)?)
        }
        _ => Box::new(Posed::new(Cylinder::<DVec3>::new(0.8, 0.5)?, rotation, center)?),
    })
}

/// Mean support points of a cast, against the length of its ray: those of the paper's algorithm, and ours; cut off at
/// the end of the ray, or compared with it afterwards.
pub(super) struct FiniteRays {
    /// The length of the ray over the size of the environment, and the four means.
    pub(super) rows: Vec<(f64, [f64; 4])>,
}

/// Rays of one length after another through an environment of bodies: every ray is cast against every body.
pub(super) fn finite_rays() -> FiniteRays {
    const SIZE: f64 = 40.0;
    let mut random = Rng::new(11);
    let bodies: Vec<Body> = (0..90)
        .filter_map(|i| {
            let center = DVec3::from(random.cube()) * (SIZE / 2.0);
            body(&mut random, i, center).ok()
        })
        .collect();
    // Each is aimed at a body, from anywhere.
    let rays: Vec<Ray<DVec3>> = (0..60)
        .map(|i| {
            let source = DVec3::from(random.cube()) * (SIZE / 2.0);
            let target = bodies[i].core().origin + DVec3::from(random.cube()) * 0.4;
            Ray { source, direction: (target - source).normalize() }
        })
        .collect();
    // What the endless ray passes far from is nobody's work.
    let is_near = |ray: &Ray<DVec3>, body: &Body| {
        let to_center = body.core().origin - ray.source;
        let along = to_center.dot(ray.direction).max(0.0);
        (to_center - ray.direction * along).length() <= body.core().extent + body.core().radius
    };
    let near: Vec<(&Ray<DVec3>, &Body)> = rays
        .iter()
        .flat_map(|ray| bodies.iter().map(move |body| (ray, body)))
        .filter(|(ray, body)| is_near(ray, body))
        .collect();
    let rows = [0.01, 0.03, 0.1, 0.3, 1.0, 3.0].map(|part| {
        let length = part * SIZE;
        let mut sums = [0usize; 4];
        for &(ray, body) in &near {
            let printed = |max| paper::ray_cast(body, *ray, max, 1e-12, None).iterations;
            let ours = |max| {
                let options = RayCastOptions::default().with_max_lambda(max);
                ray_cast(body, *ray, options).map_or(0, |cast| cast.iterations)
            };
            let counts = [printed(f64::INFINITY), printed(length), ours(f64::INFINITY), ours(length)];
            sums.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
        }
        let casts = near.len() as f64;
        (part, sums.map(|sum| sum as f64 / casts))
    });
    FiniteRays { rows: rows.to_vec() }
}

fn short_rays(measured: &FiniteRays) -> Figure {
    let names = ["paper's, endless", "paper's, cut at its end", "ours, endless", "ours, cut at its end"];
    let series = names.iter().enumerate().map(|(k, name)| Series {
        name: (*name).to_owned(),
        points: measured.rows.iter().map(|(part, means)| [*part, means[k]]).collect(),
        joined: true,
        colour: k,
    });
    Figure {
        name: "left-out-short-rays".to_owned(),
        plot: Plot {
            title: "Support points saved by a ray's end".to_owned(),
            x: "length of the ray / size of the environment".to_owned(),
            y: "support points per cast, mean".to_owned(),
            scales: [Scale::Log, Scale::Linear],
            floor: 0.0,
            series: series.collect(),
        },
        caption: format!(
            "Rays aimed at some of 90 bodies (polytopes, ellipsoids, cylinders) in a box; every pair whose endless ray comes near the \
             body. What to see: cut off at its end, the shortest ray needs {:.2} support points, since the ball around the shape is \
             looked at first; compared with its end afterwards, it costs {:.2} at any length.",
            measured.rows.first().map_or(f64::NAN, |(_, means)| means[3]),
            measured.rows.first().map_or(f64::NAN, |(_, means)| means[2]),
        ),
    }
}

/// Mean support points per frame of a body that turns past a segment and misses it.
pub(super) struct Coherence {
    /// The step from frame to frame over the body's size, and the means: the paper's ray cast cold and warm, ours cold
    /// and warm, boolean cold and warm.
    pub(super) rows: Vec<(f64, [f64; 6])>,
}

/// The same segment as ray and as body, and the last answer's axis for a start.
pub(super) fn coherence() -> Coherence {
    const FRAMES: u32 = 60;
    let rows = [0.001, 0.003, 0.01, 0.03, 0.1, 0.3].map(|step| {
        let mut random = Rng::new(12);
        let (mut sums, mut frames) = ([0usize; 6], 0usize);
        for kind in 0..24 {
            let (source, target) = (DVec3::from(random.sphere()) * 2.5, DVec3::from(random.cube()) * 1.1);
            let direction = (target - source) * 2.0;
            let ray = Ray { source, direction };
            let Ok(segment) = Segment::new([source, ray.at(1.0)]) else { continue };
            let (turn, drift) = (DVec3::from(random.sphere()) * step, DVec3::from(random.sphere()) * step);
            let Ok(resting) = body(&mut random, kind, DVec3::ZERO) else { continue };
            let mut axes: [Option<DVec3>; 3] = [None; 3];
            for frame in 0..FRAMES {
                let at = f64::from(frame);
                // To and fro, so that it stays near.
                let sway = (at * step).sin() / step;
                let Ok(moved) = Posed::new(&resting, DQuat::from_scaled_axis(turn * at), drift * sway.clamp(-1.0, 1.0))
                else {
                    continue;
                };
                let ours = |axis: Option<DVec3>| {
                    let warm = axis.map(WarmStart::new);
                    ray_cast(&moved, ray, RayCastOptions::default().with_max_lambda(1.0).with_warm_start(warm)).ok()
                };
                let meet = |axis: Option<DVec3>| {
                    let mut options = IntersectOptions::default();
                    options.axis = axis;
                    intersects(&segment, &moved, options)
                };
                let printed = |axis| paper::ray_cast(&moved, ray, 1.0, 1e-12, axis);
                let (Some(cold), Some(warm)) = (ours(None), ours(axes[1])) else { continue };
                let answers = [printed(None), printed(axes[0])];
                let tests = [meet(None), meet(axes[2])];
                let Outcome::Miss(miss) = warm.outcome else {
                    axes = [None; 3];
                    continue;
                };
                if axes[1].is_some() {
                    frames += 1;
                    let counts = [
                        answers[0].iterations,
                        answers[1].iterations,
                        cold.iterations,
                        warm.iterations,
                        tests[0].iterations,
                        tests[1].iterations,
                    ];
                    sums.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
                }
                axes = [Some(answers[1].v), Some(miss.axis), tests[1].axis];
            }
        }
        (step, sums.map(|sum| sum as f64 / frames.max(1) as f64))
    });
    Coherence { rows: rows.to_vec() }
}

fn warm_start(measured: &Coherence) -> Figure {
    let smallest = measured.rows.first().map_or([f64::NAN; 6], |(_, means)| *means);
    let names = [
        "paper's cast, cold",
        "paper's cast, warm",
        "our cast, cold",
        "our cast, warm",
        "boolean, cold",
        "boolean, warm",
    ];
    let series = names.iter().enumerate().map(|(k, name)| Series {
        name: (*name).to_owned(),
        points: measured.rows.iter().map(|(step, means)| [*step, means[k]]).collect(),
        joined: true,
        colour: k,
    });
    Figure {
        name: "left-out-warm-start".to_owned(),
        plot: Plot {
            title: "Support points saved by a warm start".to_owned(),
            x: "step from frame to frame / size of the body".to_owned(),
            y: "support points per frame, mean".to_owned(),
            scales: [Scale::Log, Scale::Linear],
            floor: 0.0,
            series: series.collect(),
        },
        caption: format!(
            "A body turns and drifts past a ray that misses it; each frame starts from the separating axis of the one before. What to \
             see: at the smallest step our cast needs {:.2} support points warm and {:.2} cold, the boolean test {:.2} warm and {:.2} cold; \
             at the largest, the warm cast needs {:.2}.",
            smallest[3],
            smallest[2],
            smallest[5],
            smallest[4],
            measured.rows.last().map_or(f64::NAN, |(_, means)| means[3]),
        ),
    }
}

/// Mean support points of a boolean test beside those of the distance, and of a warm one.
fn early_out() -> Table {
    const QUERIES: usize = 400;
    let mean = |solver: &benches::measure::Solver| {
        let answers = solver.answers();
        format!("{:.2}", answers.iter().sum::<f64>() / answers.len() as f64)
    };
    let counting = Effort { iterations: true, ..Effort::default() };
    let rows = PAIR_NAMES.into_iter().map(|case| {
        let pair = Pair::named(case);
        let apart: Vec<_> = w3b_intersect::queries(&pair).into_iter().filter(|q| !q.meet).take(QUERIES).collect();
        let same: Vec<_> = apart
            .iter()
            .map(|q| w3_distance::DistanceQuery { pose: q.pose, normal: q.normal, distance: q.moved })
            .collect();
        Row::of([
            named(case),
            mean(&ours::distances(Precision::Double, &pair, &same, counting)),
            mean(&ours::intersections(Precision::Double, &pair, &apart, false, counting)),
            mean(&ours::intersections(Precision::Double, &pair, &apart, true, counting)),
        ])
    });
    Table::new(
        "left-out-early-out",
        "Support points of each body, mean over 400 pairs 1/2 to 1/1024 apart: the distance to the last digit, the boolean answer, \
         which stops at the first separating plane, and the boolean answer that starts from the plane of the time before.",
        &["pair", "distance", "overlap", "overlap, warm"],
        rows.collect(),
    )
}

/// Pairs of links and obstacles that needed no margin, and why.
fn culled() -> Table {
    const STEPS: u32 = 60;
    let mut random = Rng::new(4);
    let rows = [10, 100, 1000, 10_000].into_iter().filter_map(|m| {
        let obstacles = growth::field(m, &mut random);
        let mut tracked = Clearance::new(&obstacles, MarginOptions::default()).ok()?;
        let mut sums = [0usize; 4];
        for step in 0..STEPS {
            let result = tracked.step(&growth::robot(f64::from(step) * 0.01)).ok()?;
            let out = result.left_out;
            let counts = [result.pairs_evaluated, out.by_motion, out.by_box, out.by_plane];
            sums.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
        }
        let all = (30 * obstacles.len() * STEPS as usize) as f64;
        let share = |count: usize| format!("{:.3} %", 100.0 * count as f64 / all);
        let solved = format!("{:.1}", sums[0] as f64 / f64::from(STEPS));
        Some(Row::of([
            m.to_string(),
            (30 * obstacles.len()).to_string(),
            solved,
            share(sums[0]),
            share(sums[1]),
            share(sums[2]),
            share(sums[3]),
        ]))
    });
    Table::new(
        "left-out-culled",
        "Clearance of 30 links among obstacles, 60 steps of 0.01 radians: of all pairs, how many margins were solved per step, and \
         why the others were not: the link has moved too little since, a box around the obstacle or a group of them is too \
         far, a plane separates them.",
        &["obstacles", "pairs", "solved per step", "solved", "by motion", "by box", "by plane"],
        rows.collect(),
    )
}

/// Which level of the robot's scene knew the answer.
fn levels() -> Option<Table> {
    let levels = scene::embedded_levels().ok()?;
    let pairs = levels.first()?.asked as f64;
    let rows = levels.iter().map(|level| {
        Row::of([
            level.name.to_owned(),
            level.asked.to_string(),
            level.knew.to_string(),
            format!("{:.1} %", 100.0 * level.knew as f64 / pairs),
            xtask::plot::duration(level.nanoseconds),
        ])
    });
    Some(Table::new(
        "left-out-levels",
        "A UR5 along its trajectory among objects, every pair of link and obstacle in every row: the outer ellipsoids are asked \
         first, the inner ones where those overlap, the hulls only where neither can tell.",
        &["level", "asked", "knew", "of all pairs", "time per question"],
        rows.collect(),
    ))
}
