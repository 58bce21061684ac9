//! The first figure: error against time, every question of this run beside what other libraries were recorded to do.

use std::fs;

use super::Record;
use super::page::Drawing;
use super::progress::progress;
use super::summary::quantile;
use crate::judge::figure::{Point, marks, read};
use crate::judge::{judged, proved, questions, witnesses};
use crate::plot::duration;

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
        caption: "Filled marks are measured in this run: ours, in double (f64) and single (f32) precision. Hollow marks are other libraries as \
                  recorded in docs/comparison.md; ✗ counts hits, misses and overlaps that are disproved. An error is a length over the size of the scene; \
                  of ellipsoids, stiff ones among them, it is relative, that of 1 + margin or of the volume. Near contact: distances of a \
                  millionth of the scene."
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
        0 => "each held the truth here".to_owned(),
        count => format!("{count} of them failed to hold the truth here"),
    };
    let mut sentences = vec![
        "Each mark is one kind of question and who answers it: lower is more accurate, further left is faster, and both axes are \
         logarithmic."
            .to_owned(),
    ];
    sentences.extend(of_precision(points, "ours f64", "In double precision"));
    sentences.extend(of_precision(points, "ours f32", "In single precision"));
    sentences.push(format!(
        "Our answers carry two bounds that follow from the geometry, so that the error is known without the truth; {bounds}."
    ));
    let mut names: Vec<&str> = Vec::new();
    for point in others {
        if !names.contains(&point.who.as_str()) {
            names.push(&point.who);
        }
    }
    let disproved: usize =
        others.iter().filter(|point| !point.set.starts_with("suite")).map(|point| point.disproved).sum();
    if let Some((last, names)) = names.split_last() {
        sentences.push(format!(
            "Of the answers of {} and {last}, as recorded, such bounds disprove {disproved} (`cargo xtask judge` asks again).",
            names.join(", ")
        ));
    }
    sentences
}

/// How accurate and how fast, over the questions that others are asked too.
fn of_precision(points: &[Point], who: &str, precision: &str) -> Option<String> {
    let is_shared = |point: &&Point| point.who == who && !OF_ELLIPSOIDS.iter().any(|(_, name)| *name == point.set);
    let of: Vec<&Point> = points.iter().filter(is_shared).collect();
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
