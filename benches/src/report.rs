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

/// Everything but the title: where it was measured, the ratios to the peers and among our own methods, `profiles` (a
/// section of its own, or nothing), and a table for each workload.
#[must_use]
pub fn markdown(rows: &[Row], profiles: &str) -> String {
    let mut text = format!("{}\n\n{}{}{profiles}{CELLS}", provenance(), beside_peers(rows), beside_ourselves(rows));
    for workload in Workload::ALL.into_iter().filter(|workload| rows.iter().any(|row| row.workload == *workload)) {
        let _ = writeln!(text, "### {}\n\n{}", title(workload), table(rows, workload));
    }
    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}

/// Processor, compiler, date and commit; what was not built.
fn provenance() -> String {
    let compiler = provenance::compiler().unwrap_or_else(|| "an unknown compiler".to_owned());
    let flags = if cfg!(target_feature = "avx2") { "with AVX2" } else { "baseline instruction set" };
    let commit = provenance::commit().map_or(String::new(), |commit| format!(", commit {commit}"));
    let peers =
        [("parry", cfg!(feature = "parry")), ("Box3D", cfg!(feature = "box3d")), ("Jolt", cfg!(feature = "jolt"))];
    let missing: Vec<_> = peers.into_iter().filter_map(|(name, built)| (!built).then_some(name)).collect();
    let missing = if missing.is_empty() { String::new() } else { format!(" Not built in: {}.", missing.join(", ")) };
    format!(
        "Measured on {}, one thread, {flags}, profile `bench` (thin LTO, one codegen unit), {compiler}, on {}{commit}.{missing}",
        provenance::processor(),
        provenance::today()
    )
}

fn title(workload: Workload) -> &'static str {
    match workload {
        Workload::RayCast => "W1: ray cast",
        Workload::LinearCast => "W2: linear cast",
        Workload::DistanceFar => "W3: distance, 3 to 0.01 (relative error)",
        Workload::DistanceNear => "W3: distance, 1e-6 (absolute error)",
        Workload::Intersect => "W3b: intersection",
    }
}

/// How to read the tables of the workloads.
const CELLS: &str = "\
## All rows

A cell is `ns / p99 error / wrong answers`. The error is the one that 99 % of the answers stay below; it is left out if the answer is yes or no. The number of wrong
answers is left out if there are none. The time of the best right peer of either precision is bold.

";

/// How to read the table of ratios to peers.
const BESIDE_PEERS: &str = "\
The ratios are geometric means of ratios of times: below 1, ours is faster. A row is a shape or a pair of shapes of a workload. The *best right peer* of a row is the
fastest other library that answers all its questions rightly in the same precision: parry's GJK, parry as its users call it, and in `f32`
Box3D or Jolt. *Ahead* and *behind* count the rows in which ours is faster or slower than that peer. Rows that all other libraries get wrong (*no right peer*), or that ours
gets wrong, are counted but not compared; parry's GJK is compared whatever it answers.
Ours are the default options. The two lines of `line_crossing` time the closed form alone, and are not among *all rows*.
[benches/README.md](../benches/README.md) says what the questions are, and which answers count as wrong. For depths, bodies that turn, coal, MuJoCo, FCL and the IPC toolkit see
[judge.md](judge.md).

";

/// What is compared with the peers: a title, a workload, and a method of either precision.
const COMPARED: [(&str, Workload, [Method; 2]); 6] = [
    ("W1 ray cast", Workload::RayCast, [Method::OursF64, Method::OursF32]),
    ("W1 `line_crossing`", Workload::RayCast, [Method::ClosedF64, Method::ClosedF32]),
    ("W2 linear cast", Workload::LinearCast, [Method::OursF64, Method::OursF32]),
    ("W3 distance, 3 to 0.01", Workload::DistanceFar, [Method::OursF64, Method::OursF32]),
    ("W3 distance, 1e-6", Workload::DistanceNear, [Method::OursF64, Method::OursF32]),
    ("W3b intersection", Workload::Intersect, [Method::OursF64, Method::OursF32]),
];

/// Ours beside the best right peer and beside parry's GJK: all rows, then each workload. Empty without peers.
fn beside_peers(rows: &[Row]) -> String {
    if !rows.iter().any(|row| row.method.is_peer()) {
        return String::new();
    }
    let mut text = String::from(
        "## Beside the best right peer\n\n\
         | | | ours / best right peer | ours / parry's GJK | ahead | behind | no right peer | ours wrong | behind in |\n\
         |---|---|---:|---:|---:|---:|---:|---:|---|\n",
    );
    for method in [Method::OursF64, Method::OursF32] {
        let ours: Vec<_> = rows.iter().filter(|row| row.method == method).collect();
        text += &beside_peers_in("**all rows**", rows, &ours, false);
    }
    for (title, workload, methods) in COMPARED {
        for method in methods {
            let ours: Vec<_> = rows.iter().filter(|row| row.workload == workload && row.method == method).collect();
            text += &beside_peers_in(title, rows, &ours, true);
        }
    }
    format!("{text}\n{BESIDE_PEERS}")
}

/// A line for some rows of ours, all of one precision, which ends with the names of those that are behind, if they are
/// wanted. Empty for no rows.
fn beside_peers_in(title: &str, rows: &[Row], ours: &[&Row], named: bool) -> String {
    let Some(precision) = ours.first().map(|row| row.method.precision()) else { return String::new() };
    let (precision, gjk) = match precision {
        Precision::Double => ("f64", Method::ParryGjkF64),
        Precision::Single => ("f32", Method::ParryGjkF32),
    };
    let to_gjk: Ratios<'_> =
        ours.iter().filter_map(|row| Some((row.case, row.ns / find(rows, row, gjk)?.ns))).collect();
    let right: Vec<_> = ours.iter().filter(|row| row.score.wrong() == 0).collect();
    let matched: Vec<_> = right.iter().filter_map(|row| Some((row, best_right_peer(rows, row)?))).collect();
    let to_best: Ratios<'_> = matched.iter().map(|(row, peer)| (row.case, row.ns / peer.ns)).collect();
    let behind: Vec<_> = matched.iter().filter(|(row, peer)| row.ns > peer.ns).collect();
    let names: Vec<_> = behind
        .iter()
        .filter(|_| named)
        .map(|(row, peer)| {
            let name = peer.method.name().trim_end_matches(precision).trim_end();
            format!("{} {:.2} ({name})", row.case, row.ns / peer.ns)
        })
        .collect();
    let mean = |ratios: Ratios<'_>| if ratios.is_empty() { "-".to_owned() } else { format!("{:.2}", ratios.mean()) };
    format!(
        "| {title} | {precision} | **{}** | {} | {} | {} | {} | {} | {} |\n",
        mean(to_best),
        mean(to_gjk),
        matched.len() - behind.len(),
        behind.len(),
        right.len() - matched.len(),
        ours.len() - right.len(),
        names.join(", "),
    )
}

/// What else was measured of the same workload and case.
fn find<'a>(rows: &'a [Row], of: &Row, method: Method) -> Option<&'a Row> {
    rows.iter().find(|row| row.workload == of.workload && row.case == of.case && row.method == method)
}

/// The fastest of the other libraries that answer the workload and case of a row rightly, all of it and in its
/// precision.
fn best_right_peer<'a>(rows: &'a [Row], of: &Row) -> Option<&'a Row> {
    rows.iter()
        .filter(|row| row.workload == of.workload && row.case == of.case)
        .filter(|row| row.method.is_peer() && row.method.precision() == of.method.precision())
        .filter(|row| row.score.wrong() == 0)
        .min_by(|a, b| a.ns.total_cmp(&b.ns))
}

/// Our methods beside one another.
fn beside_ourselves(rows: &[Row]) -> String {
    const PAIRS: [(Method, Method); 4] = [
        (Method::OursF32, Method::OursF64),
        (Method::DynF64, Method::OursF64),
        (Method::OursF64, Method::ClosedF64),
        (Method::WarmF64, Method::OursF64),
    ];
    let mut text = String::from(
        "## Our methods beside one another\n\n\
         The geometric mean of the ratios, and the cases with the least and the greatest. *Warm* is `intersects` told the axis that the same query ended with before, for bodies that are apart.\n\n| |",
    );
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
            let _ = writeln!(text, "| {} | {} |", workload.name(), ratios.map(|ratios| ratios.to_string()).join(" | "));
        }
    }
    text.push('\n');
    text
}

/// One table: a case a line, a method a column.
fn table(rows: &[Row], workload: Workload) -> String {
    let rows: Vec<Row> = rows.iter().filter(|row| row.workload == workload).cloned().collect();
    let methods: Vec<_> =
        Method::ALL.into_iter().filter(|method| rows.iter().any(|row| row.method == *method)).collect();
    let mut cases: Vec<&Row> = rows.iter().collect();
    cases.dedup_by_key(|row| row.case);

    let mut text = String::from("| case |");
    for method in &methods {
        let _ = write!(text, " {} |", method.name());
    }
    let _ = writeln!(text, "\n|---|{}", "---|".repeat(methods.len()));
    for case in cases {
        let _ = write!(text, "| {} |", case.case);
        for &method in &methods {
            let cell = find(&rows, case, method).map_or_else(|| "-".to_owned(), |row| cell(&rows, row));
            let _ = write!(text, " {cell} |");
        }
        text.push('\n');
    }
    text
}

/// The time, in bold that of the best right peer of its precision; the error where there is one; the wrong answers
/// where there are any.
fn cell(rows: &[Row], row: &Row) -> String {
    let best = best_right_peer(rows, row).is_some_and(|best| best.method == row.method);
    let time = format!("{:.*}", usize::from(row.ns < 9.95), row.ns);
    let mut parts = vec![if best { format!("**{time}**") } else { time }];
    if !row.score.p99.is_nan() {
        parts.push(format!("{:.0e}", row.score.p99));
    }
    if row.score.wrong() > 0 {
        parts.push(format!("{} wrong", row.score.wrong()));
    }
    parts.join(" / ")
}
