//! Error against run time: every method, in every precision, down a ladder of tolerances.

use serde_json::Value;

use xtask::engine;
use xtask::plot::{Plot, Scale, Series};
use xtask::table::quantile;
use xtask::validate::page::{Block, Figure};
use xtask::validate::{Case, progress, score};
use xtask::wire::answer::Line;
use xtask::wire::answer::as_read;
use xtask::wire::fields::Object;

/// A query, the knob that trades time for error, and what to try.
struct Ladder {
    name: &'static str,
    title: &'static str,
    query: &'static str,
    knob: &'static str,
    methods: &'static [&'static str],
    precisions: &'static [&'static str],
    rungs: &'static [f64],
    /// What to see.
    see: &'static str,
}

const COARSE_TO_FINE: &[f64] = &[1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14];
const BOTH: &[&str] = &["f64", "f32"];

const LADDERS: &[Ladder] = &[
    Ladder {
        name: "ladder-ray-cast",
        title: "Ray cast",
        see: "A mix of all shapes. Casting on closest points (Algorithm 1) has no use for a loose tolerance.",
        query: "ray_cast",
        knob: "tol",
        methods: &["gjk", "iterative"],
        precisions: BOTH,
        rungs: COARSE_TO_FINE,
    },
    Ladder {
        name: "ladder-linear-cast",
        title: "Linear cast",
        see: "A mix of all pairs: a step or two decide between a guess and the last digit.",
        query: "linear_cast",
        knob: "tol",
        methods: &["gjk"],
        precisions: BOTH,
        rungs: COARSE_TO_FINE,
    },
    Ladder {
        name: "ladder-distance",
        title: "Distance",
        see: "Polytopes end at the exact distance after finitely many steps, whatever the tolerance.",
        query: "distance",
        knob: "tol",
        methods: &["gjk"],
        precisions: BOTH,
        rungs: COARSE_TO_FINE,
    },
    Ladder {
        name: "ladder-enclosing",
        title: "Enclosing ellipsoid",
        see: "Second-order methods pay for six digits more with one or two iterations; the ellipsoid algorithm of the paper is a hundred times slower.",
        query: "enclosing_ellipsoid",
        knob: "epsilon",
        methods: &["newton", "khachiyan", "ellipsoid", "dual_newton"],
        precisions: &["f64"],
        rungs: &[1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12],
    },
    Ladder {
        name: "ladder-inscribed",
        title: "Inscribed ellipsoid",
        see: "An interior-point method: each digit costs about the same, the last ones nothing.",
        query: "inscribed_ellipsoid",
        knob: "epsilon",
        methods: &["newton"],
        precisions: &["f64"],
        rungs: &[1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12],
    },
    Ladder {
        name: "ladder-margin",
        title: "Margin of ellipsoids",
        see: MARGIN_SEEN,
        query: "margin",
        knob: "tol",
        methods: MARGIN_METHODS,
        precisions: BOTH,
        rungs: COARSE_TO_FINE,
    },
];

/// The eigenvalues are there where the papers' routes are built in.
#[cfg(feature = "paper")]
const MARGIN_METHODS: &[&str] = &["secular", "eigen"];
#[cfg(not(feature = "paper"))]
const MARGIN_METHODS: &[&str] = &["secular"];
#[cfg(feature = "paper")]
const MARGIN_SEEN: &str =
    "The secular equation reaches rounding in the time that the eigenvalue route takes to set up its matrix.";
#[cfg(not(feature = "paper"))]
const MARGIN_SEEN: &str = "Two or three steps lead to rounding, whatever the tolerance.";

/// A method as a reader knows it.
fn called(method: &str) -> &str {
    match method {
        "gjk" => "ours",
        "iterative" => "by closest points",
        "newton" => "Newton",
        "khachiyan" => "Khachiyan",
        "ellipsoid" => "ellipsoid algorithm",
        "dual_newton" => "dual Newton",
        "secular" => "secular equation",
        "eigen" => "eigenvalues",
        other => other,
    }
}

/// The most cases of a query that go down its ladder.
const MOST: usize = 48;

/// How long a question is timed.
const MICROSECONDS: u64 = 30;

/// A method whose median time is beyond this goes no further down.
const SLOWEST_NS: f64 = 3e7;

/// The figures of the queries among the cases.
pub(super) fn blocks(cases: &[Case]) -> Vec<Block> {
    let mut blocks: Vec<Block> = LADDERS.iter().filter_map(|ladder| figure(ladder, cases)).map(Block::Figure).collect();
    if !blocks.is_empty() {
        let heading = "All kinds of cases together, against exact truths";
        blocks.insert(0, Block::Heading(heading.to_owned()));
    }
    blocks
}

fn figure(ladder: &Ladder, cases: &[Case]) -> Option<Figure> {
    let chosen = choose(ladder.query, cases);
    if chosen.is_empty() {
        return None;
    }
    let mut series = Vec::new();
    let mut unanswered: Vec<(String, usize)> = Vec::new();
    for method in ladder.methods {
        for precision in ladder.precisions {
            let mut points = Vec::new();
            for &rung in ladder.rungs {
                progress(&format!("{}: {method} {precision} {rung:e}", ladder.query));
                let measured = measure(ladder, &chosen, method, precision, rung);
                count(&mut unanswered, method, precision, measured.unanswered);
                let Some(point) = measured.point else { continue };
                points.push(point);
                if point[0] > SLOWEST_NS {
                    break;
                }
            }
            if !points.is_empty() {
                series.push(Series {
                    name: format!("{}, {precision}", called(method)),
                    points,
                    joined: true,
                    colour: series.len(),
                });
            }
        }
    }
    let error = if ladder.query.ends_with("_ellipsoid") { "of the volume" } else { "relative" };
    Some(Figure {
        name: ladder.name.to_owned(),
        plot: Plot {
            title: ladder.title.to_owned(),
            x: "median time per query".to_owned(),
            y: "error that 9 of 10 stay below".to_owned(),
            scales: [Scale::Time, Scale::Log],
            floor: 1e-17,
            series,
        },
        caption: format!(
            "{} {} from {:e} to {:e}; {} cases, errors {error}.{}",
            ladder.see,
            if ladder.knob == "tol" { "Tolerance" } else { "Certified gap" },
            ladder.rungs[0],
            ladder.rungs[ladder.rungs.len() - 1],
            chosen.len(),
            without_answer(&unanswered)
        ),
    })
}

/// Counts questions without an answer.
fn count(unanswered: &mut Vec<(String, usize)>, method: &str, precision: &str, more: usize) {
    let name = format!("{}, {precision}", called(method));
    match unanswered.iter_mut().find(|(known, _)| *known == name) {
        Some((_, count)) => *count += more,
        None => unanswered.push((name, more)),
    }
}

/// Whose questions had no answer, over all tolerances, and why that is.
fn without_answer(unanswered: &[(String, usize)]) -> String {
    let some: Vec<String> =
        unanswered.iter().filter(|(_, count)| *count > 0).map(|(name, count)| format!("{count} of {name}")).collect();
    if some.is_empty() {
        return String::new();
    }
    format!(
        " Without an answer, as the method came to its limit of iterations before the tolerance and says so: {}, over all tolerances.",
        some.join("; ")
    )
}

/// Cases in double precision whose inputs determine the answer well, spread over all there are.
fn choose<'c>(query: &str, cases: &'c [Case]) -> Vec<&'c Case> {
    let is_fit = |case: &&Case| {
        let o = &case.object;
        let text = |name: &str| o.get(name).and_then(Value::as_str);
        let scalar = score::scalar_of(query).and_then(|name| o.get("expect")?.get(name));
        let allow = o.get("allow").and_then(Value::as_f64);
        let determined = match (scalar.and_then(Value::as_f64), allow) {
            // Far from contact, where single precision still knows the answer.
            (Some(scalar), Some(allow)) => query.ends_with("_ellipsoid") || allow <= 1e-6 * scalar.abs(),
            (None, _) => scalar.is_some_and(Value::is_array),
            (Some(_), None) => true,
        };
        text("query") == Some(query) && text("precision") != Some("f32") && text("method").is_none() && determined
    };
    let fit: Vec<&Case> = cases.iter().filter(is_fit).collect();
    let stride = fit.len().div_ceil(MOST).max(1);
    fit.into_iter().step_by(stride).collect()
}

/// What became of a rung of a ladder.
struct Measured {
    /// The median time and the 90th percentile of the error, where at least half of the cases were answered.
    point: Option<[f64; 2]>,
    unanswered: usize,
}

fn measure(ladder: &Ladder, cases: &[&Case], method: &str, precision: &str, rung: f64) -> Measured {
    let (mut times, mut errors) = (Vec::new(), Vec::new());
    for case in cases {
        let mut object: Object = case.object.clone();
        object.insert("method".to_owned(), Value::from(method));
        object.insert("precision".to_owned(), Value::from(precision));
        object.insert(ladder.knob.to_owned(), Value::from(rung));
        let Ok(question) = engine::question(&object, &case.meshes) else { continue };
        let Ok(answer) = question.ask() else { continue };
        let answer = as_read(Line { id: None, line: 0, outcome: Ok(answer) });
        let verdict = score::judge(&object, &answer);
        // A wrong flag is as wrong as can be.
        errors.push(verdict.relative.unwrap_or(1.0));
        // What disturbs one of three seldom disturbs them all.
        times.push((0..3).map(|_| question.time(MICROSECONDS)).fold(f64::INFINITY, f64::min));
    }
    let unanswered = cases.len() - errors.len();
    let point = || Some([quantile(&times, 0.5)?, quantile(&errors, 0.9)?]);
    Measured { point: if 2 * unanswered > cases.len() { None } else { point() }, unanswered }
}
