//! Measures every workload in one run and prints the tables; `--write` puts them into `docs/performance.md` and
//! `docs/performance.csv` of the workspace.
//!
//! `summary [--write] [--milliseconds PER_ROW] [W1] [W2] [W3far] [W3near] [W3b]`
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "printing is what it is for")]

use std::path::Path;
use std::process::ExitCode;
use std::time::Duration;

use benches::report::{csv, markdown};
use benches::rows::{Workload, measure};

const INTRODUCTION: &str = "\
# Performance

Written by `cargo run --profile bench -p benches --features parry --bin summary -- --write`, to which `--features box3d,jolt` adds the columns
of those two; `benches/README.md` says what is measured and how to read it. A cell is `ns / p99 error / wrong answers`:
nanoseconds of thread CPU time for one query (the smallest over passes of the median), the error that 99 % of the answers stay
below, and how many of the answers are wrong. Only rows without wrong answers compete. A goal is a ratio to parry3d-f64's GJK
in the same run.

";

fn main() -> ExitCode {
    let mut write = false;
    let mut budget = Duration::from_millis(100);
    let mut workloads = Vec::new();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        if argument == "--write" {
            write = true;
        } else if argument == "--milliseconds"
            && let Some(milliseconds) = arguments.next().and_then(|number| number.parse().ok())
        {
            budget = Duration::from_millis(milliseconds);
        } else if let Some(workload) = Workload::ALL.into_iter().find(|workload| workload.name() == argument) {
            workloads.push(workload);
        } else {
            eprintln!(
                "unexpected argument {argument:?}; usage: summary [--write] [--milliseconds N] [W1 W2 W3far W3near W3b]"
            );
            return ExitCode::FAILURE;
        }
    }
    if workloads.is_empty() {
        workloads = Workload::ALL.to_vec();
    }
    let rows = measure(&workloads, budget, |row| {
        eprintln!("{} {} {}: {:.0} ns, {:?}", row.workload.name(), row.case, row.method.name(), row.ns, row.score);
    });
    let text = markdown(&rows);
    if !write {
        println!("{text}");
        return ExitCode::SUCCESS;
    }
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let written = std::fs::write(docs.join("performance.md"), format!("{INTRODUCTION}{text}"))
        .and_then(|()| std::fs::write(docs.join("performance.csv"), csv(&rows)));
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("cannot write docs/performance.*: {error}");
            ExitCode::FAILURE
        }
    }
}
