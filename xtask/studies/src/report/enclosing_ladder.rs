//! Enclosing ellipsoids: the certified gap against time, method by method, on seven kinds of points; how the cuts of
//! the ellipsoid algorithm grow with log(1/ε); what a dimension costs.
//!
//! One run of a method gives its whole curve, by the observer: how long it ran when a gap was first certified.

use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};

use lj_ellipsoid::{EnclosingMethod, EnclosingOptions, Status, enclosing, enclosing_with};
use workloads::rng::Rng;
use workloads::w4_enclosing::{Cloud, cloud, in_ball, on_sphere};

use xtask::mesh::Meshes;
use xtask::plot::{Plot, Scale, Series};
use xtask::validate::page::Figure;
use xtask::validate::{Scope, progress};

/// The methods, the gap each is asked for, and how many iterations it may take where not as many as suit it.
const METHODS: [(&str, EnclosingMethod, f64, Option<usize>); 4] = [
    ("Newton", EnclosingMethod::Newton, 1e-13, None),
    ("Khachiyan", EnclosingMethod::Khachiyan, 1e-9, Some(40_000)),
    ("ellipsoid algorithm", EnclosingMethod::EllipsoidAlgorithm, 1e-10, Some(10_000)),
    ("dual Newton", EnclosingMethod::DualReducedNewton, 1e-13, None),
];

/// How long a method may repeat itself for a steadier time.
const PATIENCE: Duration = Duration::from_millis(60);

/// Gaps below are rounding.
const FLOOR: f64 = 1e-16;

/// A mesh of a real robot link.
const LINK: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/robots/ur5/meshes/forearm_link.obj");

/// The figures, where enclosing ellipsoids are asked for; on a tenth of the points where it must be quick.
pub(super) fn figures(scope: &Scope) -> Vec<Figure> {
    if !scope.holds("enclosing_ellipsoid") {
        return Vec::new();
    }
    let count = if scope.quick { 100 } else { 1_000 };
    let mut figures: Vec<Figure> = kinds(count).into_iter().map(|kind| gap_against_time(&kind)).collect();
    figures.push(cuts_against_gap(count / 10));
    figures.push(dimensions(count));
    figures
}

/// Points of one kind.
struct Kind {
    /// As in the name of a file.
    name: &'static str,
    title: &'static str,
    points: Vec<[f64; 3]>,
    what: &'static str,
}

fn kinds(count: usize) -> Vec<Kind> {
    let normal = cloud::<3>(Cloud::Normal, count);
    let mut random = Rng::new(0x10e9);
    let cauchy = normal.iter().map(|p| {
        let scale = random.normal() / random.normal();
        p.map(|x| scale * x)
    });
    let aspect = normal.iter().map(|&[x, y, z]| {
        let (y, z) = (1e-3 * y, 1e-6 * z);
        // Turned, so that no coordinate is thin.
        [0.6 * x - 0.8 * y, 0.48 * x + 0.36 * y - 0.8 * z, 0.64 * x + 0.48 * y + 0.6 * z]
    });
    let mut kinds = vec![
        Kind { name: "normal", title: "normal points", points: normal.clone(), what: "normal points: few touch" },
        Kind {
            name: "ball",
            title: "points in a ball",
            points: in_ball(count),
            what: "points spread evenly in a ball: many nearly touch",
        },
        Kind {
            name: "sphere",
            title: "points on a sphere",
            points: on_sphere(count),
            what: "points on a sphere: all nearly touch",
        },
        Kind {
            name: "lognormal",
            title: "lognormal points",
            points: normal.iter().map(|p| p.map(f64::exp)).collect(),
            what: "exponentials of normal numbers: a long tail to one side",
        },
        Kind {
            name: "cauchy",
            title: "Cauchy-scaled points",
            points: cauchy.collect(),
            what: "normal points, each scaled by a Cauchy number: a few are far beyond the rest",
        },
        Kind {
            name: "aspect",
            title: "aspect 1e6",
            points: aspect.collect(),
            what: "normal points a million times longer than thick",
        },
    ];
    if let Ok(mesh) = Meshes::relative_to(Path::new("")).load(Path::new(LINK)) {
        let points = mesh.points().iter().map(|p| p.to_array()).collect();
        kinds.push(Kind {
            name: "mesh",
            title: "a robot's link",
            points,
            what: "the vertices of the forearm of a UR5",
        });
    }
    kinds
}

fn asked(method: EnclosingMethod, epsilon: f64, iterations: Option<usize>) -> EnclosingOptions {
    let mut options = EnclosingOptions::new().with_method(method).with_epsilon(epsilon);
    options.max_iterations = iterations;
    options
}

/// Nanoseconds and the least gap certified by then, whenever it has halved; and how the method ended.
fn trace(points: &[[f64; 3]], options: EnclosingOptions) -> (Vec<[f64; 2]>, Option<Status>) {
    let begin = Instant::now();
    let mut best: Option<Vec<[f64; 2]>> = None;
    loop {
        let mut curve: Vec<[f64; 2]> = Vec::with_capacity(128);
        let start = Instant::now();
        let answer = enclosing_with(points, options, |iterate| {
            if curve.last().is_none_or(|[_, least]| iterate.log_det_gap < 0.5 * least) {
                curve.push([start.elapsed().as_nanos() as f64, iterate.log_det_gap.max(FLOOR)]);
            }
        });
        let elapsed = start.elapsed().as_nanos() as f64;
        let status = answer.as_ref().ok().map(|answer| answer.status);
        curve.extend(answer.map(|answer| [elapsed, answer.log_det_gap.max(FLOOR)]));
        // Every run takes the same steps: of each the shortest time.
        let best = match &mut best {
            Some(best) => {
                best.iter_mut().zip(&curve).for_each(|(best, now)| best[0] = best[0].min(now[0]));
                best
            }
            None => best.insert(curve),
        };
        if begin.elapsed() > PATIENCE {
            return (std::mem::take(best), status);
        }
    }
}

fn gap_against_time(kind: &Kind) -> Figure {
    let mut series = Vec::new();
    let mut cut_short = Vec::new();
    for (colour, (name, method, epsilon, iterations)) in METHODS.into_iter().enumerate() {
        progress(&format!("{name} on {}", kind.name));
        let options = asked(method, epsilon, iterations);
        let (points, status) = trace(&kind.points, options);
        let name = match status {
            Some(Status::IterationLimit) => {
                cut_short.push(name);
                format!("{name} (cut short)")
            }
            _ => name.to_owned(),
        };
        series.push(Series { name, points, joined: true, colour });
    }
    let limits = match cut_short.is_empty() {
        true => String::new(),
        false => format!(" Cut short by the limit of iterations, before the gap asked for: {}.", cut_short.join(", ")),
    };
    Figure {
        name: format!("ladder-enclosing-{}", kind.name),
        plot: Plot {
            title: format!("Enclosing ellipsoid: {}", kind.title),
            x: "time".to_owned(),
            y: "certified gap on ln det X".to_owned(),
            scales: [Scale::Time, Scale::Log],
            floor: FLOOR,
            series,
        },
        caption: format!(
            "{} points in space: {}. When each method had certified which gap, its start included; the last mark is \
             the answer, whose gap counts the rounding of everything. What to expect: Newton's method has its last \
             digit before Khachiyan's has its second.{limits}",
            kind.points.len(),
            kind.what,
        ),
    }
}

/// The cuts of the ellipsoid algorithm: a straight line over log(1/ε), as Rimon and Boyd have it.
fn cuts_against_gap(count: usize) -> Figure {
    let series = vec![
        cuts("2 dimensions", 0, &cloud::<2>(Cloud::Normal, count)),
        cuts("3 dimensions", 1, &cloud::<3>(Cloud::Normal, count)),
        cuts("4 dimensions", 2, &cloud::<4>(Cloud::Normal, count)),
    ];
    Figure {
        name: "ladder-enclosing-cuts".to_owned(),
        plot: Plot {
            title: "Enclosing ellipsoid: cuts of the ellipsoid algorithm".to_owned(),
            x: "certified gap on ln det X".to_owned(),
            y: "cuts".to_owned(),
            scales: [Scale::Log, Scale::Linear],
            floor: 0.0,
            series,
        },
        caption: format!(
            "{count} normal points. The number of cuts grows with log(1/ε), a straight line here, as Rimon and Boyd prove; \
             its slope grows with the fourth power of the dimension, as the square of the number of variables."
        ),
    }
}

fn cuts<const N: usize>(name: &str, colour: usize, points: &[[f64; N]]) -> Series {
    progress(&format!("cuts in {name}"));
    let options = EnclosingOptions::new()
        .with_method(EnclosingMethod::EllipsoidAlgorithm)
        .with_epsilon(1e-8)
        .with_max_iterations(30_000);
    let mut curve: Vec<[f64; 2]> = Vec::new();
    let _ = enclosing_with(points, options, |iterate| {
        let gap = iterate.log_det_gap;
        if gap > 0.0 && curve.last().map_or(gap < 1.0, |[least, _]| gap < 0.3 * least) {
            curve.push([gap, iterate.iteration as f64]);
        }
    });
    Series { name: name.to_owned(), points: curve, joined: true, colour }
}

/// Time against dimension, for the methods that know a constant one.
fn dimensions(count: usize) -> Figure {
    let mut series: Vec<Series> = METHODS
        .into_iter()
        .enumerate()
        .map(|(colour, (name, ..))| Series { name: name.to_owned(), points: Vec::new(), joined: true, colour })
        .collect();
    dimension(&cloud::<2>(Cloud::Normal, count), &mut series);
    dimension(&cloud::<3>(Cloud::Normal, count), &mut series);
    dimension(&cloud::<4>(Cloud::Normal, count), &mut series);
    dimension(&cloud::<6>(Cloud::Normal, count), &mut series);
    dimension(&cloud::<8>(Cloud::Normal, count), &mut series);
    dimension(&cloud::<10>(Cloud::Normal, count), &mut series);
    Figure {
        name: "ladder-enclosing-dimension".to_owned(),
        plot: Plot {
            title: "Enclosing ellipsoid: time against dimension".to_owned(),
            x: "dimension".to_owned(),
            y: "time".to_owned(),
            scales: [Scale::Linear, Scale::Time],
            floor: 1.0,
            series,
        },
        caption: format!(
            "{count} normal points to a certified gap of 1e-4, in dimensions the compiler knows. A method stops where it takes \
             more than half a second or does not converge."
        ),
    }
}

fn dimension<const N: usize>(points: &[[f64; N]], series: &mut [Series]) {
    for ((name, method, _, iterations), series) in METHODS.into_iter().zip(series) {
        // The cuts grow with the fourth power of the dimension: no use in waiting for those of the next one.
        let slow = series.points.last().is_some_and(|[_, last]| *last > 5e7);
        if slow || series.points.last().map_or(2.0, |[n, _]| *n) + 2.0 < N as f64 {
            continue;
        }
        progress(&format!("{name} in {N} dimensions"));
        let options = asked(method, 1e-4, iterations);
        let (begin, mut least, mut converged) = (Instant::now(), f64::INFINITY, true);
        while converged && begin.elapsed() < PATIENCE {
            let start = Instant::now();
            converged = black_box(enclosing(points, options)).is_ok_and(|answer| answer.status == Status::Converged);
            least = least.min(start.elapsed().as_nanos() as f64);
        }
        if converged {
            series.points.push([N as f64, least]);
        }
    }
}
