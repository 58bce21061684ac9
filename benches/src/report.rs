//! The measurements as text: a page of Markdown for people, CSV for programs.

use std::fmt::Write as _;

use workloads::provenance;
use workloads::score::Precision;

use crate::ratios::Ratios;
use crate::rows::{Method, Row, Workload};

/// The rows as CSV.
#[must_use]
pub fn csv(rows: &[Row]) -> String {
    let mut text = String::from(
        "workload,case,method,ns,p99_error,max_error,false_hits,false_misses,undecided,far_off,said_zero\n",
    );
    for Row { workload, case, method, ns, score } in rows {
        let (workload, method) = (workload.name(), method.name());
        let _ = writeln!(
            text,
            "{workload},{case},{method},{ns:.1},{:e},{:e},{},{},{},{},{}",
            score.p99, score.max, score.false_hits, score.false_misses, score.undecided, score.far_off, score.said_zero
        );
    }
    text
}

/// The part of the note on other libraries that has the ratios, the questions together and one by one.
#[must_use]
pub fn ratios(rows: &[Row], measured: &str) -> String {
    format!("{}{measured}\n", beside_peers(rows))
}

/// The part with a table for each question.
#[must_use]
pub fn times(rows: &[Row]) -> String {
    let mut text = String::new();
    for workload in Workload::ALL.into_iter().filter(|workload| rows.iter().any(|row| row.workload == *workload)) {
        let _ = writeln!(text, "### {}\n\n{}", title(workload), table(rows, workload));
    }
    text
}

/// Processor, compiler, date and commit; what was not built.
#[must_use]
pub fn measured() -> String {
    let compiler = provenance::compiler().unwrap_or_else(|| "an unknown compiler".to_owned());
    let flags = if cfg!(target_feature = "avx2") { "with AVX2" } else { "baseline instruction set" };
    let commit = provenance::commit().map_or(String::new(), |commit| format!(", commit {commit}"));
    let peers =
        [("parry", cfg!(feature = "parry")), ("Box3D", cfg!(feature = "box3d")), ("Jolt", cfg!(feature = "jolt"))];
    let missing: Vec<_> = peers.into_iter().filter_map(|(name, built)| (!built).then_some(name)).collect();
    let missing = if missing.is_empty() { String::new() } else { format!(" Not built in: {}.", missing.join(", ")) };
    format!(
        "Measured on {}, one thread, {flags}, profile `bench` (thin LTO, one codegen unit), {compiler}, {}{commit}.{missing}",
        provenance::processor(),
        provenance::today()
    )
}

fn title(workload: Workload) -> String {
    let (question, count) = (workload.question(), workload.count());
    let what = match workload {
        Workload::RayCast => "rays at each body, relative error of λ",
        Workload::LinearCast => "motions of each pair, relative error of the time",
        Workload::DistanceFar => "pairs 3 to 0.01 apart, relative error",
        Workload::DistanceNear => "pairs 1e-6 apart, absolute error",
        Workload::Intersect => "pairs within 1/2 to 1/1024 of contact",
    };
    format!("{}{}: {count} {what}", question[..1].to_uppercase(), &question[1..])
}

/// What is compared with other libraries: a title, a workload, and a method of either precision.
const COMPARED: [(&str, Workload, [Method; 2]); 6] = [
    ("ray cast", Workload::RayCast, [Method::OursF64, Method::OursF32]),
    ("ray cast, by `line_crossing`", Workload::RayCast, [Method::ClosedF64, Method::ClosedF32]),
    ("linear cast", Workload::LinearCast, [Method::OursF64, Method::OursF32]),
    ("distance", Workload::DistanceFar, [Method::OursF64, Method::OursF32]),
    ("near contact", Workload::DistanceNear, [Method::OursF64, Method::OursF32]),
    ("overlap", Workload::Intersect, [Method::OursF64, Method::OursF32]),
];

/// Ours beside the fastest correct library: all rows, then each workload. Empty without peers.
fn beside_peers(rows: &[Row]) -> String {
    if !rows.iter().any(|row| row.method.is_peer()) {
        return String::new();
    }
    let mut text = String::from(
        "| question | precision | our time / theirs | faster in | slower in | none correct | slower where |\n\
         |---|---|---:|---:|---:|---:|---|\n",
    );
    for method in [Method::OursF64, Method::OursF32] {
        let ours: Vec<_> = rows.iter().filter(|row| row.method == method).collect();
        text += &beside_peers_in("**all**", rows, &ours, false);
    }
    for (title, workload, methods) in COMPARED {
        for method in methods {
            let ours: Vec<_> = rows.iter().filter(|row| row.workload == workload && row.method == method).collect();
            text += &beside_peers_in(title, rows, &ours, true);
        }
    }
    text + "\n"
}

/// A line for some rows of ours, all of one precision, which ends with the names of those that are behind, if they are
/// wanted. Empty for no rows.
fn beside_peers_in(title: &str, rows: &[Row], ours: &[&Row], named: bool) -> String {
    let Some(precision) = ours.first().map(|row| row.method.precision()) else { return String::new() };
    let right: Vec<_> = ours.iter().filter(|row| row.score.wrong() == 0).collect();
    let matched: Vec<_> = right.iter().filter_map(|row| Some((row, fastest_correct(rows, row)?))).collect();
    let ratios: Ratios<'_> = matched.iter().map(|(row, peer)| (row.case, row.ns / peer.ns)).collect();
    let behind: Vec<_> = matched.iter().filter(|(row, peer)| row.ns > peer.ns).collect();
    let names: Vec<_> = behind
        .iter()
        .filter(|_| named)
        .map(|(row, peer)| format!("{} {:.2} ({})", row.case, row.ns / peer.ns, library(peer.method)))
        .collect();
    let mean = if ratios.is_empty() { "-".to_owned() } else { format!("**{:.2}**", ratios.mean()) };
    format!(
        "| {title} | {} | {mean} | {} | {} | {} | {} |\n",
        suffix(precision),
        matched.len() - behind.len(),
        behind.len(),
        right.len() - matched.len(),
        names.join(", "),
    )
}

/// The name of a precision.
const fn suffix(precision: Precision) -> &'static str {
    match precision {
        Precision::Double => "f64",
        Precision::Single => "f32",
    }
}

/// A method without its precision.
fn library(method: Method) -> &'static str {
    method.name().trim_end_matches(suffix(method.precision())).trim_end()
}

/// What else was measured of the same workload and case.
fn find<'a>(rows: &'a [Row], of: &Row, method: Method) -> Option<&'a Row> {
    rows.iter().find(|row| row.workload == of.workload && row.case == of.case && row.method == method)
}

/// The fastest of the other libraries that answer the workload and case of a row rightly, all of it and in its
/// precision.
fn fastest_correct<'a>(rows: &'a [Row], of: &Row) -> Option<&'a Row> {
    rows.iter()
        .filter(|row| row.workload == of.workload && row.case == of.case)
        .filter(|row| row.method.is_peer() && row.method.precision() == of.method.precision())
        .filter(|row| row.score.wrong() == 0)
        .min_by(|a, b| a.ns.total_cmp(&b.ns))
}

/// The part with our methods beside one another: means of ratios, and the cases with the least and the greatest.
#[must_use]
pub fn ours(rows: &[Row]) -> String {
    const PAIRS: [(Method, Method); 4] = [
        (Method::OursF32, Method::OursF64),
        (Method::DynF64, Method::OursF64),
        (Method::OursF64, Method::ClosedF64),
        (Method::WarmF64, Method::OursF64),
    ];
    let mut text = String::from("| |");
    for (method, than) in PAIRS {
        let _ = write!(text, " {} / {} |", method.name(), than.name());
    }
    let _ = writeln!(text, "\n|---|{}", "---|".repeat(PAIRS.len()));
    for workload in Workload::ALL {
        let ratios = PAIRS.map(|(method, than)| -> Ratios<'_> {
            let rows_of_it = rows.iter().filter(|row| row.workload == workload && row.method == method);
            rows_of_it.filter_map(|row| Some((row.case, row.ns / find(rows, row, than)?.ns))).collect()
        });
        if ratios.iter().any(|ratios| !ratios.is_empty()) {
            let _ =
                writeln!(text, "| {} | {} |", workload.question(), ratios.map(|ratios| ratios.to_string()).join(" | "));
        }
    }
    text
}

/// One table: a case a line; ours beside the fastest correct library, in either precision, and who else is wrong.
fn table(rows: &[Row], workload: Workload) -> String {
    let rows: Vec<Row> = rows.iter().filter(|row| row.workload == workload).cloned().collect();
    let mut text = String::from(
        "| body | ours f64 | fastest correct | ratio | ours f32 | fastest correct | ratio | wrong answers of others |\n\
         |---|---|---|---:|---|---|---:|---|\n",
    );
    for double in rows.iter().filter(|row| row.method == Method::OursF64) {
        let _ = write!(text, "| {} |", double.case);
        for ours in [Some(double), find(&rows, double, Method::OursF32)].into_iter().flatten() {
            let peer = fastest_correct(&rows, ours);
            let theirs =
                peer.map_or_else(|| "none".to_owned(), |peer| format!("{}, {}", cell(peer), library(peer.method)));
            let ratio = peer.map_or_else(|| "-".to_owned(), |peer| format!("{:.2}", ours.ns / peer.ns));
            let _ = write!(text, " {} | {theirs} | {ratio} |", cell(ours));
        }
        let is_wrong = |row: &&Row| row.case == double.case && row.method.is_peer() && row.score.wrong() > 0;
        let wrong: Vec<String> =
            rows.iter().filter(is_wrong).map(|row| format!("{} {}", row.method.name(), row.score.wrong())).collect();
        let _ = writeln!(text, " {} |", wrong.join(", "));
    }
    text
}

/// The time, the error where there is one, and how many answers are wrong.
fn cell(row: &Row) -> String {
    let mut cell = format!("{:.*} ns", usize::from(row.ns < 9.95), row.ns);
    if !row.score.p99.is_nan() {
        let _ = write!(cell, ", {:.0e}", row.score.p99);
    }
    if row.score.wrong() > 0 {
        let _ = write!(cell, ", {} wrong", row.score.wrong());
    }
    cell
}
