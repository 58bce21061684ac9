//! Measures every workload in one run and prints the page; `--write` puts it into `docs/performance.md` and
//! `docs/performance.csv` of the workspace, `--csv` prints the rows alone. `--profiles` adds what the build profile
//! does to our times.
//!
//! `summary [--write | --csv] [--profiles] [--milliseconds PER_ROW] [W1] [W2] [W3far] [W3near] [W3b]`
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "printing is what it is for")]

use std::path::Path;
use std::process::ExitCode;
use std::time::Duration;

use benches::report::{csv, markdown};
use benches::rows::{Workload, measure};

const INTRODUCTION: &str = "\
# Performance

This page compares the crates here (*ours*) with other libraries, on the same inputs, whose answers are known. Times are nanoseconds of thread CPU time for one query, from one
run of

```sh
cargo run --profile bench -p benches --features parry,box3d,jolt --bin summary -- --profiles --write
```

";

fn main() -> ExitCode {
    let (mut write, mut as_csv, mut by_profile) = (false, false, false);
    let mut budget = Duration::from_millis(100);
    let mut workloads = Vec::new();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        if argument == "--write" {
            write = true;
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
                "unexpected argument {argument:?}; usage: summary [--write | --csv] [--profiles] [--milliseconds N] \
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
    let text = format!("{INTRODUCTION}{}", markdown(&rows, &profiles));
    if !write {
        println!("{text}");
        return ExitCode::SUCCESS;
    }
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let written = std::fs::write(docs.join("performance.md"), text)
        .and_then(|()| std::fs::write(docs.join("performance.csv"), csv(&rows)));
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("cannot write docs/performance.*: {error}");
            ExitCode::FAILURE
        }
    }
}
