//! `cargo xtask fuzz`: damaged query lines, hulls of small integers against an exact oracle, and what answers say of
//! themselves, for a bounded time.
//!
//! The time is shared evenly. The same seed draws the same sequence; how far it comes depends on the machine, unless a
//! number of cases is given.

mod claims;
mod integers;
mod lines;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use clap::{Args, ValueEnum};
use rayon::prelude::*;

use workloads::rng::Rng;

/// How long, of what, and from where.
#[derive(Clone, Debug, Args)]
pub struct Scope {
    /// How long it takes.
    #[arg(long, value_name = "N", default_value_t = 10)]
    seconds: u64,
    /// So many cases of each kind instead of as many as there is time for: the same ones on every machine.
    #[arg(long, value_name = "N", conflicts_with = "seconds")]
    cases: Option<u64>,
    /// Another seed draws other cases.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Only one kind of cases.
    #[arg(long, value_enum)]
    kind: Option<Kind>,
    /// Of claims, only those in one precision.
    #[arg(long, value_parser = ["f32", "f64"])]
    precision: Option<String>,
    /// Of claims, only those in the plane or in space.
    #[arg(long, value_parser = clap::value_parser!(u8).range(2..=3))]
    dimension: Option<u8>,
    /// Of claims, only those of one query.
    #[arg(long, value_parser = ["ray_cast", "ray_exit", "distance", "signed_distance", "intersect", "contact", "linear_cast", "motion_cast"])]
    query: Option<String>,
    /// Hold the answers to the queries of a file to the laws of claims, instead of drawing any.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["kind", "precision", "dimension", "query"])]
    replay: Option<PathBuf>,
}

/// What is tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// Damaged query lines.
    Lines,
    /// Hulls of small integers, against an exact oracle.
    Integers,
    /// What answers say of themselves: widths, points, certainty.
    Claims,
}

/// Failures of a kind that are told; one is enough to fail.
const MOST_TOLD: usize = 10;

pub fn run(scope: &Scope) -> ExitCode {
    match fuzz(scope, &mut io::stdout()) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(why) => crate::output::failed("cannot read or write", &why),
    }
}

/// The number of failures.
fn fuzz(scope: &Scope, output: &mut impl Write) -> io::Result<usize> {
    if let Some(file) = &scope.replay {
        return replay(file, output);
    }
    let kinds = [Kind::Lines, Kind::Integers, Kind::Claims];
    let kinds: Vec<Kind> = kinds.into_iter().filter(|kind| scope.kind.is_none_or(|only| only == *kind)).collect();
    let share = Duration::from_millis(scope.seconds * 1000 / kinds.len() as u64);
    let mut failures = 0;
    for kind in kinds {
        let start = Instant::now();
        let end = start + share;
        let (what, tried, failed) = match kind {
            Kind::Lines => {
                let suite = lines::Suite::read()?;
                let (tried, failed) = tried(scope, end, |rng| suite.case(rng));
                ("damaged lines", tried, failed)
            }
            Kind::Integers => {
                let (tried, failed) = tried(scope, end, integers::case);
                ("hulls of integers", tried, failed)
            }
            Kind::Claims => {
                let (tried, failed) = claimed(scope, end, output)?;
                ("claims", tried, failed)
            }
        };
        let rate = tried as f64 / start.elapsed().as_secs_f64();
        writeln!(output, "{what}: {tried} tried, {rate:.0} a second, {failed} failed")?;
        failures += failed;
    }
    Ok(failures)
}

/// Claims, with a table of how much was asked.
fn claimed(scope: &Scope, end: Instant, output: &mut impl Write) -> io::Result<(u64, usize)> {
    let choice = claims::Choice {
        precision: scope.precision.clone(),
        dimension: scope.dimension.map(usize::from),
        query: scope.query.clone(),
    };
    let all = Mutex::new(claims::Tallies::new());
    let found = tried(scope, end, |rng| {
        let mut tallies = claims::Tallies::new();
        let verdict = claims::case(&choice, rng, &mut tallies);
        let mut all = all.lock().unwrap_or_else(PoisonError::into_inner);
        for (name, tally) in tallies {
            let sum = all.entry(name).or_default();
            sum.asked += tally.asked;
            sum.claims += tally.claims;
            sum.widest = sum.widest.max(tally.widest);
        }
        verdict
    });
    for (name, tally) in all.into_inner().unwrap_or_else(PoisonError::into_inner) {
        let claims::Tally { asked, claims, widest } = tally;
        writeln!(output, "{name}: {asked} asked, {claims} claims, widest bracket {widest:.2e} of what is allowed")?;
    }
    Ok(found)
}

/// Writes failures as they are found: of those that say the same but for numbers, the first few.
#[derive(Default)]
struct Teller(Mutex<BTreeMap<String, usize>>);

impl Teller {
    fn tell(&self, failure: &str) {
        let begins: String = failure.chars().filter(|c| !c.is_ascii_digit()).take(100).collect();
        let mut told = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let count = told.entry(begins).or_insert(0);
        *count += 1;
        if *count <= MOST_TOLD {
            let _ = writeln!(io::stdout(), "{failure}");
        }
    }
}

/// Holds the queries of a file to the laws of claims.
fn replay(file: &PathBuf, output: &mut impl Write) -> io::Result<usize> {
    let mut failures = 0;
    let starts = [[1.0, 0.0, 0.0], [0.5, -0.25, 0.125]];
    for line in BufReader::new(File::open(file)?).lines() {
        let line = line?;
        let Ok(object) = crate::wire::json::object(line.as_bytes()) else { continue };
        let folder = file.parent().unwrap_or_else(|| std::path::Path::new(""));
        if let Some(report) = crate::claims::of(&object, &starts, &crate::mesh::Meshes::relative_to(folder))
            && !report.broken.is_empty()
        {
            failures += 1;
            writeln!(output, "{report}  {line}")?;
        }
    }
    writeln!(output, "{failures} lines with false claims")?;
    Ok(failures)
}

/// One case: nothing, or what went wrong.
type Verdict = Result<(), String>;

/// Tries cases on all cores. How many were tried, and how many failed.
fn tried(scope: &Scope, end: Instant, case: impl Fn(&mut Rng) -> Verdict + Sync) -> (u64, usize) {
    let teller = Teller::default();
    let lane = |lane: u64| Rng::new(scope.seed.wrapping_mul(0x9E37_79B9).wrapping_add(lane));
    let fails = |rng: &mut Rng| case(rng).inspect_err(|failure| teller.tell(failure)).is_err();
    if let Some(cases) = scope.cases {
        return (cases, (0..cases).into_par_iter().filter(|&i| fails(&mut lane(i))).count());
    }
    // Until the time is up; each core draws its own.
    let until_end = |i: u64| {
        let mut rng = lane(i);
        let (mut tried, mut failed) = (0, 0);
        while Instant::now() < end {
            tried += 1;
            failed += usize::from(fails(&mut rng));
        }
        (tried, failed)
    };
    let lanes = 0..rayon::current_num_threads() as u64;
    lanes
        .into_par_iter()
        .map(until_end)
        .reduce(|| (0, 0), |(tried, failed), (more, other)| (tried + more, failed + other))
}
