//! The first figure: error against time, every question of this run beside what other libraries were recorded to do.

use super::Record;
use super::page::Drawing;
use super::progress::progress;
use crate::judge::figure::{OF_ELLIPSOIDS, Point, is_ours, panels, recorded};
use crate::judge::{judged, proved, questions, witnesses};
use crate::plot::{Panels, duration};
use crate::table::quantile;

/// How many questions of each kind are asked of each shape or pair of shapes.
const EACH: usize = 6;

/// The figure, and the sentences that stand beside it.
#[derive(Clone, Debug)]
pub(super) struct Headline {
    pub drawing: Drawing,
    pub sentences: Vec<String>,
}

/// Of the whole suite; there is none of a part of it.
pub(super) fn headline(records: &[Record]) -> Headline {
    let mut points = ours();
    points.extend(OF_ELLIPSOIDS.iter().filter_map(|(query, name)| of_records(records, query, name)));
    let others: Vec<Point> =
        recorded().into_iter().filter(|point| !is_ours(&point.who) && !point.set.starts_with("suite")).collect();
    let sentences = sentences(records, &points, &others);
    points.extend(others);
    let drawing = Drawing {
        name: "headline".to_owned(),
        panels: Panels { note: "Ours: this run, this machine. Others: as recorded, on another.".to_owned(), ..panels(&points) },
        caption: "Filled marks are ours, measured in this run. Hollow marks and crosses are other libraries, as recorded in docs/comparison.md with date \
                  and machine, each asked about those bodies that it has. Near contact, bodies are a millionth of the scene apart. The error of an ellipsoid around points is relative to its \
                  volume, and that of a margin m to 1 + m."
            .to_owned(),
    };
    Headline { drawing, sentences }
}

/// Ours, in both precisions, on a sample of the workloads.
fn ours() -> Vec<Point> {
    let questions = questions::of_workloads(EACH);
    let witnesses = ["f64", "f32"].map(|precision| {
        witnesses::ours(&questions, precision, |k| progress(&format!("timing question {k} in {precision}")))
    });
    let cases = proved(questions, |k| progress(&format!("proving bounds for question {k}")));
    let rows = witnesses.iter().flat_map(|witness| judged(witness, &cases, &mut String::new()));
    rows.filter_map(|row| row.point()).collect()
}

/// The file of the suite that others were asked too, about ellipsoids.
const ELLIPSOIDS: &str = "ellipsoids";

/// Ours in double precision on the cases of a query.
fn of_records(records: &[Record], query: &str, name: &str) -> Option<Point> {
    let of = || records.iter().filter(|r| r.query == query && r.precision == "f64" && r.file == ELLIPSOIDS);
    let (times, errors): (Vec<f64>, Vec<f64>) =
        (of().filter_map(|r| r.time).collect(), of().filter_map(error).collect());
    Some(Point {
        set: name.to_owned(),
        who: "ours f64".to_owned(),
        disproved: 0,
        error: quantile(&errors, 0.99)?,
        ns: quantile(&times, 0.5)?,
    })
}

/// The error of a volume is relative already; that of a margin is one of 1 + m, the square of a ratio of sizes, as m
/// itself passes through zero.
fn error(record: &Record) -> Option<f64> {
    let (error, relative) = (record.verdict.error?, record.verdict.relative?);
    let is_volume = record.query.ends_with("_ellipsoid");
    Some(if is_volume || relative == 0.0 { relative } else { error / (1.0 + error / relative) })
}

/// What to see.
fn sentences(records: &[Record], points: &[Point], others: &[Point]) -> Vec<String> {
    let violated = records.iter().filter(|r| r.verdict.violates_certificate()).count();
    let bounds = match violated {
        0 => "Every bound held the truth in this run.".to_owned(),
        count => format!("{count} bounds failed to hold the truth in this run."),
    };
    let mut sentences = Vec::new();
    sentences.extend(of_precision(points, "ours f64", "In double precision"));
    sentences.extend(of_precision(points, "ours f32", "In single precision"));
    sentences.push(format!("Our answers have a lower and an upper bound, which follow from the geometry. {bounds}"));
    let mut names: Vec<&str> = Vec::new();
    for point in others.iter().filter(|point| point.disproved > 0) {
        if !names.contains(&point.who.as_str()) {
            names.push(&point.who);
        }
    }
    let disproved: usize = others.iter().map(|point| point.disproved).sum();
    if disproved > 0 {
        sentences.push(format!(
            "Of the recorded answers of other libraries such bounds disprove {disproved} ({}); `cargo xtask judge` asks again.",
            names.join(", ")
        ));
    }
    sentences
}

/// How accurate and how fast, over the questions that others are asked too.
fn of_precision(points: &[Point], who: &str, precision: &str) -> Option<String> {
    let is_length = |point: &&Point| {
        point.who == who && !point.error.is_nan() && !OF_ELLIPSOIDS.iter().any(|(_, name)| *name == point.set)
    };
    let of: Vec<&Point> = points.iter().filter(is_length).collect();
    let worst = of.iter().copied().max_by(|a, b| a.error.total_cmp(&b.error))?;
    let fastest = of.iter().copied().min_by(|a, b| a.ns.total_cmp(&b.ns))?;
    let slowest = of.iter().copied().max_by(|a, b| a.ns.total_cmp(&b.ns))?;
    let rest = of.iter().filter(|point| point.set != worst.set).map(|point| point.error).fold(0.0, f64::max);
    // Where one kind is far worse than the others, it says little of them.
    let but = if 10.0 * rest < worst.error {
        format!(" ({}; all others below {rest:.0e})", worst.set)
    } else {
        String::new()
    };
    Some(format!(
        "{precision} the errors of 99 in 100 answers are below {:.0e} of the scene's size{but}, and the median question takes from {} ({}) to {} ({}).",
        worst.error,
        duration(fastest.ns),
        fastest.set,
        duration(slowest.ns),
        slowest.set
    ))
}
