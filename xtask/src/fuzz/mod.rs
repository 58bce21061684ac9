//! `cargo xtask fuzz`: damaged query lines, and hulls of small integers against an exact oracle, for a bounded time.
//!
//! Half of the time each. The same seed draws the same sequence; how far it comes depends on the machine.

mod integers;
mod lines;

use std::io::{self, Write};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use clap::Args;
use rayon::prelude::*;

use workloads::rng::Rng;

/// How long, and from where.
#[derive(Clone, Debug, Args)]
pub struct Scope {
    /// How long it takes.
    #[arg(long, value_name = "N", default_value_t = 10)]
    seconds: u64,
    /// Another seed draws other cases.
    #[arg(long, default_value_t = 0)]
    seed: u64,
}

/// Failures that are told; one is enough to fail.
const MOST_TOLD: usize = 10;

pub fn run(scope: &Scope) -> ExitCode {
    match fuzz(scope, &mut io::stdout().lock()) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(why) => crate::output::failed("cannot read or write", &why),
    }
}

/// The number of failures.
fn fuzz(scope: &Scope, output: &mut impl Write) -> io::Result<usize> {
    let half = Duration::from_millis(scope.seconds * 500);
    let suite = lines::Suite::read()?;
    let mut failures = 0;
    for (what, case) in [
        ("damaged lines", Box::new(|rng: &mut Rng| suite.case(rng)) as Box<dyn Fn(&mut Rng) -> Verdict + Sync>),
        ("hulls of integers", Box::new(integers::case)),
    ] {
        let (tried, failed) = until(Instant::now() + half, scope.seed, case);
        for failure in failed.iter().take(MOST_TOLD) {
            writeln!(output, "{failure}")?;
        }
        writeln!(output, "{what}: {tried} tried, {} failed", failed.len())?;
        failures += failed.len();
    }
    Ok(failures)
}

/// One case: nothing, or what went wrong.
type Verdict = Result<(), String>;

/// Tries cases until the time is up, on all cores; each core draws its own.
fn until(end: Instant, seed: u64, case: impl Fn(&mut Rng) -> Verdict + Sync) -> (u64, Vec<String>) {
    let lanes = 0..rayon::current_num_threads() as u64;
    lanes
        .into_par_iter()
        .map(|lane| {
            let mut rng = Rng::new(seed.wrapping_mul(0x9E37_79B9).wrapping_add(lane));
            let (mut tried, mut failed) = (0, Vec::new());
            while Instant::now() < end {
                tried += 1;
                failed.extend(case(&mut rng).err());
            }
            (tried, failed)
        })
        .reduce(
            || (0, Vec::new()),
            |(tried, mut failed), (more, other)| {
                failed.extend(other);
                (tried + more, failed)
            },
        )
}
