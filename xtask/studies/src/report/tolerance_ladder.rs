//! Error against run time on the workloads of `benches`: hundreds of queries of one kind, whose answers are known in
//! closed form or by construction, down a ladder of tolerances; other methods and other libraries as single marks
//! beside it.

use std::fs;
use std::time::Duration;

use benches::measure::Solver;
use benches::ours::{self, Effort};
use benches::rows::{self, Method};
use gjk_raycast::SubAlgorithm;
use workloads::pairs::Pair;
use workloads::score::{self, Precision, Score};
use workloads::shapes::Shape;
use workloads::{w1_ray_cast, w2_linear_cast, w3_distance, w3b_intersect};

use super::headline::named;
use xtask::plot::{Plot, Scale, Series};
use xtask::validate::page::{Block, Figure, Section};
use xtask::validate::{Scope, progress};

/// The chapter, but for what the cases show.
pub(super) fn section(scope: &Scope) -> Section {
    let mut blocks = Vec::new();
    let mut add = |query: &str, heading: &str, figures: &mut dyn Iterator<Item = Figure>| {
        if scope.holds(query) {
            blocks.push(Block::Heading(heading.to_owned()));
            blocks.extend(figures.map(Block::Figure));
        }
    };
    let shapes = ["cuboid", "hull64", "hull1024", "roundbox", "cylinder", "ellipsoid"];
    add("ray_cast", "Ray cast: rays against one body", &mut shapes.into_iter().map(ray_cast));
    let pairs = ["cuboid-cuboid", "hull64-hull64", "cylinder-cone", "ellipsoid-ellipsoid"];
    add("linear_cast", "Linear cast: when two moving bodies meet", &mut pairs.into_iter().map(linear_cast));
    add("distance", "Distance: from 3 to 0.01 of bodies of about size 1", &mut pairs.into_iter().map(distance));
    add("intersect", "Overlap: bodies 1/2 to 1/1024 from contact", &mut pairs.into_iter().map(intersect));
    Section {
        id: "ladders",
        title: "Error against run time",
        lead:
            "Each line is a method in a precision, each mark on it a tolerance: lower is more accurate, further left \
               is faster. What to expect: after a few steps the lines fall steeply to the level of rounding, so a \
               loose tolerance saves little; that is why the default is no tolerance at all. Single marks are methods \
               that have no tolerance to set: closed forms, and other libraries with the one they come with, hollow \
               where they are recorded and not of this run. Johnson and signed volumes are other sub-algorithms for \
               the closest point of a simplex. A hull of 64 has 64 vertices. Here everything is compiled for the types \
               of its shapes; where all kinds of cases stand together, they are behind `dyn SupportMap`, and of a \
               dimension known at run time."
                .to_owned(),
        blocks,
    }
}

/// From coarse to as fine as rounding lets it be, which is the default.
const TOLERANCES: [f64; 9] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 0.0];

/// Most iterations of a boolean query: what it has in place of a tolerance.
const CAPS: [usize; 10] = [1, 2, 3, 4, 5, 6, 8, 11, 16, 200];

/// The queries of a workload that are asked.
const QUERIES: usize = 500;

/// What timing a row may cost at least.
const BUDGET: Duration = Duration::from_millis(3);

/// Methods of ours with a knob, with their precision, and their sub-algorithm where that is not the default, in the
/// order of the colours.
const KNOBS: [(&str, Precision, Option<SubAlgorithm>); 4] = [
    ("ours f64", Precision::Double, None),
    ("ours f32", Precision::Single, None),
    ("Johnson f64", Precision::Double, Some(SubAlgorithm::Johnson)),
    ("signed volumes f64", Precision::Double, Some(SubAlgorithm::SignedVolumes)),
];

/// What the other methods are called here, and their colours: of those whose marks are filled, as all are that are
/// measured.
fn single(method: Method) -> Option<(&'static str, usize)> {
    Some(match method {
        Method::ClosedF64 => ("closed form f64", 8),
        Method::ClosedF32 => ("closed form f32", 9),
        Method::WarmF64 => ("ours with axis f64", 8),
        Method::WarmF32 => ("ours with axis f32", 9),
        Method::ParryGjkF64 => ("parry GJK f64", 10),
        Method::ParryGjkF32 => ("parry GJK f32", 15),
        _ => return None,
    })
}

/// Other libraries as recorded in docs/performance.csv, where none was measured in this run; their marks are hollow.
///
/// In the columns of that file: the workload, the case, the method, nanoseconds, the 99th percentile and the worst of
/// the error, and counts of wrong answers of five kinds, of which being far off is the fourth.
const RECORDED: [(&str, &str, usize); 4] = [
    ("parry GJK f64", "parry GJK f64, recorded", 6),
    ("parry GJK f32", "parry GJK f32, recorded", 7),
    ("Box3D f32", "Box3D, recorded", 4),
    ("Jolt f32", "Jolt, recorded", 5),
];

/// The recorded marks of a case, of which `count` questions were asked; of boolean questions the share that was wrong.
fn recorded(workload: &str, case: &str, count: f64) -> Vec<Series> {
    if cfg!(feature = "peers") {
        return Vec::new();
    }
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/performance.csv");
    let csv = fs::read_to_string(file).unwrap_or_default();
    let mark = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let [of, what, method, ns, p99, _, counts @ ..] = cells.as_slice() else { return None };
        let &(_, name, colour) = RECORDED.iter().find(|(known, ..)| known == method)?;
        let counts: Vec<f64> = counts.iter().filter_map(|count| count.parse().ok()).collect();
        let lost = counts.iter().sum::<f64>() - counts.get(3)?;
        let error = match workload {
            "W3b" => lost / count,
            _ if lost * 100.0 > count => 1.0,
            _ => p99.parse::<f64>().ok()?.min(1.0),
        };
        let points = vec![[ns.parse().ok()?, error]];
        (*of == workload && *what == case).then(|| Series { name: name.to_owned(), points, joined: false, colour })
    };
    csv.lines().skip(1).filter_map(mark).collect()
}

/// The error that 99 % of the answers stay below; 1 where more than 1 % of the queries got none or the opposite one.
fn p99(score: &Score) -> f64 {
    let lost = score.false_hits + score.false_misses + score.undecided + score.said_zero;
    if lost * 100 > QUERIES { 1.0 } else { score.p99.min(1.0) }
}

/// The share of the queries that got no answer, or the opposite one.
fn share(score: &Score) -> f64 {
    score.wrong() as f64 / QUERIES as f64
}

/// Makes a solver of ours.
type Make<'a> = &'a dyn Fn(Precision, Effort) -> Solver;
/// Scores the answers of a solver that works in a precision.
type Judge<'a> = &'a dyn Fn(&[f64], Precision) -> Score;

/// The lines of our methods, then the marks of the others.
fn series(
    make: Make<'_>,
    others: Vec<(Method, Solver)>,
    judge: Judge<'_>,
    efforts: &[Effort],
    error: fn(&Score) -> f64,
) -> Vec<Series> {
    let point = |solver: &Solver, precision| {
        let range = 0..solver.count();
        [solver.nanoseconds(range, BUDGET), error(&judge(&solver.answers(), precision))]
    };
    let lines = KNOBS.iter().enumerate().map(|(colour, (name, precision, sub_algorithm))| {
        let at = |effort: &Effort| {
            let sub_algorithm = sub_algorithm.unwrap_or(effort.sub_algorithm);
            point(&make(*precision, Effort { sub_algorithm, ..*effort }), *precision)
        };
        // Twice, one after the other, and the shorter time of each: what disturbs a mark seldom comes again.
        let mut points: Vec<[f64; 2]> = efforts.iter().map(at).collect();
        points.iter_mut().zip(efforts.iter().map(at)).for_each(|(point, [ns, _])| point[0] = point[0].min(ns));
        Series { name: (*name).to_owned(), points, joined: true, colour }
    });
    let mut series: Vec<Series> = lines.collect();
    series.extend(others.into_iter().filter_map(|(method, solver)| {
        let (name, colour) = single(method)?;
        let wrong = judge(&solver.answers(), method.precision()).wrong();
        let name = if wrong > 0 { format!("{name}, {wrong} wrong") } else { name.to_owned() };
        Some(Series { name, points: vec![point(&solver, method.precision())], joined: false, colour })
    }));
    series
}

fn tolerances() -> Vec<Effort> {
    TOLERANCES.map(|tolerance| Effort { tolerance, ..Effort::default() }).to_vec()
}

fn figure(name: String, title: String, truth: &str, series: Vec<Series>) -> Figure {
    Figure {
        name,
        plot: Plot {
            title,
            x: "median time per query".to_owned(),
            y: "relative error, 99th percentile".to_owned(),
            scales: [Scale::Time, Scale::Log],
            floor: 1e-17,
            series,
        },
        caption: format!("{QUERIES} questions, tolerance from 0.1 to 0. {truth}"),
    }
}

fn ray_cast(case: &'static str) -> Figure {
    progress(&format!("ray casts against {case}"));
    let shape = Shape::named(case);
    let mut rays = w1_ray_cast::rays(case);
    rays.truncate(QUERIES);
    let make = |precision, effort| ours::ray_casts(precision, &shape, &rays, effort);
    let judge = |answers: &[f64], precision| score::ray_casts(&rays, answers, precision);
    let mut series = series(&make, rows::ray_casters(&shape, &rays), &judge, &tolerances(), p99);
    series.extend(recorded("W1", case, w1_ray_cast::RAYS as f64));
    figure(format!("ray-cast-{case}"), format!("Ray casts: {}", named(case)), "Truth in closed form.", series)
}

fn linear_cast(case: &'static str) -> Figure {
    progress(&format!("linear casts of {case}"));
    let pair = Pair::named(case);
    let mut casts = w2_linear_cast::casts(&pair);
    casts.truncate(QUERIES);
    let grazing = w2_linear_cast::grazing(&pair, &casts);
    let make = |precision, effort| ours::linear_casts(precision, &pair, &casts, effort);
    let judge = |answers: &[f64], _| score::linear_casts(&casts, &grazing, answers);
    let mut series = series(&make, rows::linear_casters(&pair, &casts), &judge, &tolerances(), p99);
    series.extend(recorded("W2", case, w2_linear_cast::CASTS as f64));
    let truth = "Truth by construction, to about 1e-14.";
    figure(format!("linear-cast-{case}"), format!("Linear casts: {}", named(case)), truth, series)
}

fn distance(case: &'static str) -> Figure {
    progress(&format!("distances of {case}"));
    let pair = Pair::named(case);
    let mut queries = w3_distance::queries(&pair);
    queries.truncate(QUERIES);
    let make = |precision, effort| ours::distances(precision, &pair, &queries, effort);
    let judge = |answers: &[f64], _| score::distances(&queries, answers);
    let mut series = series(&make, rows::distance_solvers(&pair, &queries), &judge, &tolerances(), p99);
    series.extend(recorded("W3far", case, w3_distance::FAR as f64));
    let truth = "Truth by construction, to about 1e-13 of the distance: the lines cannot fall further.";
    figure(format!("distance-{case}"), format!("Distances: {}", named(case)), truth, series)
}

fn intersect(case: &'static str) -> Figure {
    progress(&format!("intersections of {case}"));
    let pair = Pair::named(case);
    // Bodies that are apart, so that the same queries can be asked warm.
    let queries: Vec<_> = w3b_intersect::queries(&pair).into_iter().filter(|query| !query.meet).take(QUERIES).collect();
    let make = |precision, effort| ours::intersections(precision, &pair, &queries, false, effort);
    let judge = |answers: &[f64], _| score::intersections(&queries, answers);
    let mut others = rows::warm_intersection_testers(&pair, &queries);
    others.extend(rows::intersection_testers(&pair, &queries));
    let efforts = CAPS.map(|max_iterations| Effort { max_iterations, ..Effort::default() });
    let mut figure = figure(
        format!("intersect-{case}"),
        format!("Overlap: {}", named(case)),
        "",
        series(&make, others, &judge, &efforts, share),
    );
    figure.plot.series.extend(recorded("W3b", case, w3b_intersect::QUERIES as f64));
    figure.plot.y = "share of questions without the right answer".to_owned();
    figure.plot.floor = 0.5 / QUERIES as f64;
    figure.caption = format!(
        "{QUERIES} pairs that are apart; from 1 to 200 iterations allowed. Most are decided by the first few separating \
         planes; warm queries, which start from the plane of the time before, by the first."
    );
    figure
}
