//! The first figure: error against time, every question of this run beside what other libraries were recorded to do.

use std::fs;

use super::Record;
use super::page::Drawing;
use super::progress::progress;
use super::summary::quantile;
use crate::judge::figure::{Point, marks, read};
use crate::judge::{judged, proved, questions, witnesses};

/// How many questions of each kind are asked of each shape or pair of shapes.
const EACH: usize = 6;

/// Where the judge's table is recorded.
const RECORDED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/judge.csv");

/// The queries about ellipsoids, which no other library answers, as a reader knows them.
const OF_ELLIPSOIDS: [(&str, &str); 4] = [
    ("margin", "margin of ellipsoids"),
    ("clearance", "clearance of a robot"),
    ("enclosing_ellipsoid", "enclosing ellipsoid"),
    ("inscribed_ellipsoid", "inscribed ellipsoid"),
];

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
    let recorded: Vec<Point> = fs::read_to_string(RECORDED).map(|csv| read(&csv)).unwrap_or_default();
    let others: Vec<Point> = recorded.into_iter().filter(|point| !is_ours(&point.who)).collect();
    let sentences = sentences(records, &points, &others);
    points.extend(others);
    let drawing = Drawing {
        name: "headline".to_owned(),
        marks: marks(&points, |who| !is_ours(who)),
        caption: "Further down is more accurate, further left is faster; both axes are logarithmic. Filled: measured in this run. Hollow: other \
                  libraries as recorded (docs/judge.md); ✗ counts hits, misses and overlaps that are disproved. An error is a length, in \
                  parts of the scene's size; of ellipsoids, stiff ones among them, it is that of 1 + the margin or of the volume, relative."
            .to_owned(),
    };
    Headline { drawing, sentences }
}

fn is_ours(who: &str) -> bool {
    who.starts_with("ours")
}

/// Ours, in both precisions, on a sample of the workloads.
fn ours() -> Vec<Point> {
    let questions = questions::of_workloads(EACH);
    let witnesses = ["f64", "f32"].map(|precision| {
        witnesses::ours(&questions, precision, |k| progress(&format!("the first figure: question {k} in {precision}")))
    });
    let cases = proved(questions, |k| progress(&format!("the first figure: question {k}")));
    let rows = witnesses.iter().flat_map(|witness| judged(witness, &cases, &mut String::new()));
    rows.filter_map(|row| row.point()).collect()
}

/// Ours in double precision on the cases of a query.
fn of_records(records: &[Record], query: &str, name: &str) -> Option<Point> {
    let of = || records.iter().filter(|r| r.query == query && r.precision == "f64");
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

/// The error of a volume is relative already; that of a margin is one of 1 + m, the square of a ratio of sizes, as m itself
/// passes through zero.
fn error(record: &Record) -> Option<f64> {
    let (error, relative) = (record.verdict.error?, record.verdict.relative?);
    let is_volume = record.query.ends_with("_ellipsoid");
    Some(if is_volume || relative == 0.0 { relative } else { error / (1.0 + error / relative) })
}

/// What to see.
fn sentences(records: &[Record], points: &[Point], others: &[Point]) -> Vec<String> {
    let wrong = records.iter().filter(|r| !r.verdict.wrong.is_empty()).count();
    let violated = records.iter().filter(|r| r.verdict.violates_certificate()).count();
    let of = |who: &str| {
        points
            .iter()
            .filter(|point| point.who == who && !OF_ELLIPSOIDS.iter().any(|(_, name)| *name == point.set))
            .collect::<Vec<_>>()
    };
    let worst = |points: &[&Point]| points.iter().map(|point| point.error).fold(0.0, f64::max);
    let span = |points: &[&Point]| {
        let (least, most) =
            points.iter().fold((f64::INFINITY, 0.0f64), |(low, high), p| (low.min(p.ns), high.max(p.ns)));
        format!("{} to {}", crate::plot::duration(least), crate::plot::duration(most))
    };
    let (double, single) = (of("ours f64"), of("ours f32"));
    let mut sentences = vec![
        format!(
            "Of {} questions with known answers {wrong} were answered wrongly, and {violated} bounds failed to hold the truth.",
            records.len()
        ),
        format!(
            "In double precision 99 of 100 answers are certain to {:.0e} of the scene or better, in {} at the median of each kind.",
            worst(&double),
            span(&double)
        ),
        format!("In single precision it is {:.0e}, in {}.", worst(&single), span(&single)),
        "Every answer carries two bounds that geometry proves, so its error is known without knowing the truth."
            .to_owned(),
    ];
    let mut names: Vec<&str> = Vec::new();
    for point in others {
        if !names.contains(&point.who.as_str()) {
            names.push(&point.who);
        }
    }
    let disproved: usize =
        others.iter().filter(|point| !point.set.starts_with("suite")).map(|point| point.disproved).sum();
    if !names.is_empty() {
        sentences.push(format!(
            "Of the answers recorded of {}, these bounds disprove {disproved} (cargo xtask judge asks them again).",
            names.join(", ")
        ));
    }
    sentences
}
