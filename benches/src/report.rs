//! The measurements as text: Markdown tables for people, CSV for programs.

use std::fmt::Write as _;

use workloads::provenance;

use crate::goals::{GOALS, NEAR_P99, WARM_NS, parry_ns};
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

/// Everything: the machine, the goals, and a table for each workload.
#[must_use]
pub fn markdown(rows: &[Row]) -> String {
    let mut text = format!("{}\n\n## Goals\n\n{}\n", machine(), goals(rows));
    for workload in Workload::ALL.into_iter().filter(|workload| rows.iter().any(|row| row.workload == *workload)) {
        let _ = writeln!(text, "## {}\n\n{}", title(workload), table(rows, workload));
    }
    text
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

/// One table: a case a line, a method a column, `ns / p99 error / wrong` in each cell.
fn table(rows: &[Row], workload: Workload) -> String {
    let rows: Vec<_> = rows.iter().filter(|row| row.workload == workload).collect();
    let methods: Vec<_> =
        Method::ALL.into_iter().filter(|method| rows.iter().any(|row| row.method == *method)).collect();
    let mut cases: Vec<&str> = rows.iter().map(|row| row.case).collect();
    cases.dedup();

    let mut text = String::from("| case |");
    for method in &methods {
        let _ = write!(text, " {} |", method.name());
    }
    let _ = writeln!(text, "\n|---|{}", "---|".repeat(methods.len()));
    for case in cases {
        let _ = write!(text, "| {case} |");
        for method in &methods {
            match rows.iter().find(|row| row.case == case && row.method == *method) {
                Some(row) if row.score.p99.is_nan() => {
                    let _ = write!(text, " {:.0} / {} |", row.ns, row.score.wrong());
                }
                Some(row) => {
                    let _ = write!(text, " {:.0} / {:.1e} / {} |", row.ns, row.score.p99, row.score.wrong());
                }
                None => text.push_str(" - |"),
            }
        }
        text.push('\n');
    }
    text
}

/// Each goal beside what was measured.
fn goals(rows: &[Row]) -> String {
    let find = |workload, case: &str, method| {
        rows.iter().find(|row| row.workload == workload && row.case == case && row.method == method)
    };
    let mut text = String::from(
        "| workload | case | method | ns | best right peer | ratio | parry gjk f64 | ratio | goal | p99 error | goal | wrong | |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    let mut line = |row: &Row, goal_ns: f64, goal_p99: f64| {
        let parry = find(row.workload, row.case, Method::ParryGjkF64).map_or(f64::NAN, |parry| parry.ns);
        let best = rows
            .iter()
            .filter(|peer| peer.workload == row.workload && peer.case == row.case && peer.method.is_peer())
            .filter(|peer| peer.score.wrong() == 0)
            .min_by(|a, b| a.ns.total_cmp(&b.ns))
            .map_or("- | -".into(), |peer| {
                format!("{:.0} ({}) | {:.3}", peer.ns, peer.method.name(), row.ns / peer.ns)
            });
        let (ratio, goal) = (row.ns / parry, goal_ns / parry_ns(row.workload, row.case).unwrap_or(f64::NAN));
        let accurate = row.score.p99.is_nan() || row.score.p99 <= goal_p99;
        let verdict = match (ratio <= goal, accurate, row.score.wrong()) {
            (true, true, 0) => "met",
            (false, true, 0) => "slow",
            (_, false, 0) => "inaccurate",
            _ => "wrong",
        };
        let p99 = if row.score.p99.is_nan() { "-".into() } else { format!("{:.1e}", row.score.p99) };
        let p99_goal = if goal_p99.is_finite() { format!("{goal_p99:.0e}") } else { "-".into() };
        let _ = writeln!(
            text,
            "| {} | {} | {} | {:.0} | {best} | {parry:.0} | {ratio:.3} | {goal:.3} | {p99} | {p99_goal} | {} | {verdict} |",
            row.workload.name(),
            row.case,
            row.method.name(),
            row.ns,
            row.score.wrong(),
        );
    };
    for goal in GOALS {
        if let Some(row) = find(goal.workload, goal.case, goal.method) {
            line(row, goal.ns, goal.p99);
        }
    }
    for row in rows.iter().filter(|row| row.method == Method::WarmF64) {
        line(row, WARM_NS, f64::INFINITY);
    }
    for row in rows.iter().filter(|row| row.workload == Workload::DistanceNear && row.method == Method::OursF64) {
        // Twice the far time of this very run, brought to the machine of the goals and back by `line`.
        let far = find(Workload::DistanceFar, row.case, Method::OursF64).map_or(f64::NAN, |far| far.ns);
        let parry = find(row.workload, row.case, Method::ParryGjkF64).map_or(f64::NAN, |parry| parry.ns);
        let goal = 2.0 * far / parry * parry_ns(row.workload, row.case).unwrap_or(f64::NAN);
        line(row, goal, NEAR_P99);
    }
    let twins = [
        (Method::OursF32, Method::OursF64),
        (Method::ClosedF32, Method::ClosedF64),
        (Method::WarmF32, Method::WarmF64),
    ];
    let slower = rows.iter().filter_map(|row| {
        let (_, twin) = twins.iter().find(|(single, _)| *single == row.method)?;
        let ratio = row.ns / find(row.workload, row.case, *twin)?.ns;
        (ratio > 1.0).then(|| format!("{} {} {} ({ratio:.2})", row.workload.name(), row.case, row.method.name()))
    });
    let slower: Vec<_> = slower.collect();
    let _ = match slower.as_slice() {
        [] => writeln!(text, "\n`f32` is at least as fast as `f64` in every row."),
        slower => writeln!(
            text,
            "\n`f32` should be at least as fast as `f64` everywhere; it is not in: {}.",
            slower.join(", ")
        ),
    };
    let dearest = |workload| {
        let boxed = rows.iter().filter(|row| row.workload == workload && row.method == Method::DynF64);
        let ratios = boxed.filter_map(|row| Some((row.case, row.ns / find(workload, row.case, Method::OursF64)?.ns)));
        let most = ratios.max_by(|a, b| a.1.total_cmp(&b.1));
        most.map(|(case, ratio)| format!("{} {ratio:.2} ({case})", workload.name()))
    };
    let dearest: Vec<_> = Workload::ALL.into_iter().filter_map(dearest).collect();
    let _ = writeln!(
        text,
        "\nShapes behind `dyn SupportMap` take at most so many times as long as known ones: {}.",
        dearest.join(", ")
    );
    text
}

/// Processor, compiler and date.
fn machine() -> String {
    let compiler = provenance::compiler().unwrap_or_else(|| "an unknown compiler".to_owned());
    let flags = if cfg!(target_feature = "avx2") { "with AVX2" } else { "baseline instruction set" };
    format!(
        "Measured on {}, one thread, {flags}, thin LTO, {compiler}, on {}.",
        provenance::processor(),
        provenance::today()
    )
}
