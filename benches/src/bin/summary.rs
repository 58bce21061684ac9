//! Measures every workload in one run. `--write` puts the tables into `docs/comparison.md` and the rows into
//! `docs/performance.csv`, `--csv` prints the rows, and otherwise the tables are printed. `--profiles` adds what the
//! build profile does to our times. `--recorded` writes the tables of the recorded rows again, and measures nothing.
//!
//! `summary [--write | --csv | --recorded] [--profiles] [--milliseconds PER_ROW] [W1] [W2] [W3far] [W3near] [W3b]`
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "printing is what it is for")]

use std::io;
use std::process::ExitCode;
use std::time::Duration;

use benches::report::{csv, measured, ours, ratios, times};
use benches::rows::{Row, Workload, measure};
use workloads::note;

fn main() -> ExitCode {
    let (mut write, mut as_csv, mut by_profile) = (false, false, false);
    let mut budget = Duration::from_millis(100);
    let mut workloads = Vec::new();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        if argument == "--write" {
            write = true;
        } else if argument == "--recorded" {
            return ended(recorded());
        } else if argument == "--csv" {
            as_csv = true;
        } else if argument == "--profiles" {
            by_profile = true;
        } else if argument == "--milliseconds"
            && let Some(milliseconds) = arguments.next().and_then(|number| number.parse().ok())
        {
            budget = Duration::from_millis(milliseconds);
        } else if let Some(workload) = Workload::ALL.into_iter().find(|workload| workload.name() == argument) {
            workloads.push(workload);
        } else {
            eprintln!(
                "unexpected argument {argument:?}; usage: summary [--write | --csv | --recorded] [--profiles] [--milliseconds N] \
                 [W1 W2 W3far W3near W3b]"
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
    if as_csv {
        print!("{}", csv(&rows));
        return ExitCode::SUCCESS;
    }
    let profiles = if by_profile { benches::profiles::section() } else { Ok(String::new()) };
    let profiles = match profiles {
        Ok(section) => section,
        Err(error) => {
            eprintln!("cannot measure another profile: {error}");
            return ExitCode::FAILURE;
        }
    };
    if !write {
        println!("{}\n{}\n{profiles}\n{}", ratios(&rows, &measured()), ours(&rows), times(&rows));
        return ExitCode::SUCCESS;
    }
    let written = std::fs::write(note::path("performance.csv"), csv(&rows))
        .and_then(|()| parts(&rows, &measured()))
        .and_then(|()| if by_profile { part("builds", &profiles) } else { Ok(()) });
    ended(written)
}

fn part(name: &str, text: &str) -> io::Result<()> {
    note::write(&note::path("comparison.md"), name, text)
}

/// Writes the tables of these rows.
fn parts(rows: &[Row], measured: &str) -> io::Result<()> {
    part("ratios", &ratios(rows, measured))?;
    part("methods", &ours(rows))?;
    part("times", &times(rows))
}

/// Writes the tables of the rows that were recorded, with where they were measured as it stands there.
fn recorded() -> io::Result<()> {
    let rows: Vec<Row> =
        std::fs::read_to_string(note::path("performance.csv"))?.lines().skip(1).filter_map(Row::parse).collect();
    let page = std::fs::read_to_string(note::path("comparison.md"))?;
    let measured =
        note::part(&page, "ratios").and_then(|part| part.lines().find(|line| line.starts_with("Measured on")));
    parts(&rows, measured.unwrap_or_default())
}

fn ended(written: io::Result<()>) -> ExitCode {
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("cannot write docs/comparison.md or docs/performance.csv: {error}");
            ExitCode::FAILURE
        }
    }
}
