//! `cargo xtask prove`: whether certificates prove what answers claim, in interval arithmetic of 256 bits.
//!
//! What proves is the package `checker`; here lines are read, judged in parallel, and counted.

mod random;
#[cfg(test)]
mod tests;

use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

use checker::{Bounds, Parts, Proof, Reader, Unread, Verdict, judge};
use clap::Args;
use rayon::prelude::*;
use serde_json::{Value, json};

use crate::mesh::Meshes;
use crate::output;
use crate::wire::json;

/// What to prove.
#[derive(Clone, Debug, Args)]
pub struct Choice {
    /// Files of queries with answers and certificates, as `query --certify` writes them; `-` is standard input.
    #[arg(required_unless_present = "random", value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Draw random queries for so many seconds, answer them, and prove that.
    #[arg(long, value_name = "SECONDS", conflicts_with = "files")]
    random: Option<u64>,
    /// Draw robots' paths and boxes of joint values.
    #[arg(long, requires = "random")]
    robots: bool,
    /// Draw least distances over motions and paths, growth distances, and boxes of joint values among obstacles.
    #[arg(long, requires = "random", conflicts_with = "robots")]
    clearances: bool,
    /// Another seed draws other queries.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// What the paths of meshes are relative to.
    #[arg(long, value_name = "FOLDER")]
    folder: Option<PathBuf>,
    /// Write only lines that are not proved, and the counts.
    #[arg(long)]
    quiet: bool,
}

/// How many lines came out how.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    pub proved: u64,
    pub not_proved: u64,
    pub disproved: u64,
    /// Random queries that the crates could not answer.
    pub unanswered: u64,
    /// Parts of paths and of boxes of joint values that are proved to be free, and those that are not.
    pub parts: [u64; 2],
}

/// What the parts of a certificate are called that are proved, and that are not.
const PARTS: [&str; 2] = ["parts_proved", "parts_not_proved"];

/// Lines that are judged together.
const BATCH: usize = 1024;

/// Judges the files, a line of output for each line, and the counts last.
pub fn run(choice: &Choice) -> ExitCode {
    match prove(choice, &mut BufWriter::new(io::stdout().lock())) {
        Ok(Counts { not_proved: 0, disproved: 0, .. }) => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(why) => output::failed("cannot read or write", &why),
    }
}

fn prove(choice: &Choice, output: &mut impl Write) -> io::Result<Counts> {
    let meshes = Meshes::relative_to(choice.folder.as_deref().unwrap_or(Path::new("")));
    let mut counts = Counts::default();
    if let Some(seconds) = choice.random {
        let told = Mutex::new(Vec::new());
        let tell = |line: &str| told.lock().unwrap_or_else(PoisonError::into_inner).push(line.to_owned());
        let kinds = match choice {
            Choice { robots: true, .. } => random::ROBOTS,
            Choice { clearances: true, .. } => random::CLEARANCES,
            _ => random::PLANES,
        };
        let tally = random::prove_for(kinds, seconds, choice.seed, tell);
        for line in told.into_inner().unwrap_or_else(PoisonError::into_inner) {
            writeln!(output, "{line}")?;
        }
        for (kind, of_kind) in tally {
            writeln!(output, "{}", of_kind.said(Some(&kind)))?;
            counts = counts.plus(of_kind);
        }
    }
    for file in &choice.files {
        let input: Box<dyn BufRead> = if file == Path::new("-") {
            Box::new(io::stdin().lock())
        } else {
            Box::new(BufReader::new(File::open(file)?))
        };
        let mut lines = (1_u64..).zip(input.split(b'\n'));
        loop {
            let batch: Vec<(u64, Vec<u8>)> =
                lines.by_ref().take(BATCH).map(|(i, line)| Ok((i, line?))).collect::<io::Result<_>>()?;
            if batch.is_empty() {
                break;
            }
            let asks = |(_, line): &&(u64, Vec<u8>)| !line.trim_ascii().is_empty() && !line.starts_with(b"#");
            let asked: Vec<_> = batch.iter().filter(asks).collect();
            let judged: Vec<_> = asked.par_iter().map(|(_, line)| judge_line(line, &meshes)).collect();
            for ((i, line), (verdict, said)) in asked.into_iter().zip(judged) {
                counts.add(verdict, &said);
                if !(choice.quiet && verdict == Verdict::Proved) {
                    let id = json::id_of(line.trim_ascii()).map_or_else(|| i.to_string(), |id| id.get().to_owned());
                    let said = said.to_string();
                    writeln!(output, "{{\"id\":{id},{}", said.trim_start_matches('{'))?;
                }
            }
        }
    }
    writeln!(output, "{}", counts.said(None))?;
    output.flush()?;
    Ok(counts)
}

impl Counts {
    /// The line of output, for one kind of query or for all.
    fn said(self, kind: Option<&str>) -> Value {
        let Self { proved, not_proved, disproved, unanswered, parts } = self;
        let mut said =
            json!({"proved": proved, "not_proved": not_proved, "disproved": disproved, "unanswered": unanswered});
        if parts != [0; 2] {
            (said[PARTS[0]], said[PARTS[1]]) = (parts[0].into(), parts[1].into());
        }
        if let Some(kind) = kind {
            said["kind"] = kind.into();
        }
        said
    }

    fn plus(self, other: Self) -> Self {
        Self {
            proved: self.proved + other.proved,
            not_proved: self.not_proved + other.not_proved,
            disproved: self.disproved + other.disproved,
            unanswered: self.unanswered + other.unanswered,
            parts: [0, 1].map(|i| self.parts[i] + other.parts[i]),
        }
    }

    fn add(&mut self, verdict: Verdict, said: &Value) {
        for (count, name) in self.parts.iter_mut().zip(PARTS) {
            *count += said[name].as_u64().unwrap_or(0);
        }
        *match verdict {
            Verdict::Proved => &mut self.proved,
            Verdict::NotProved => &mut self.not_proved,
            Verdict::Disproved => &mut self.disproved,
        } += 1;
    }
}

/// The verdict on a line, and what is said of it.
pub fn judge_line(line: &[u8], meshes: &Meshes) -> (Verdict, Value) {
    let judged: Result<Proof, Unread> = json::object(line.trim_ascii()).map_err(|why| why.message).and_then(|line| {
        let mesh = |path: &str| {
            let mesh = meshes.load(Path::new(path)).map_err(|why| why.message)?;
            Ok(mesh.points().iter().map(|point| point.to_array()).collect())
        };
        let line = Value::Object(line);
        judge(&line, &Reader::new(&line, &mesh)?)
    });
    let unread = |why| Proof { verdict: Verdict::NotProved, because: Some(why), bounds: None, parts: None };
    let Proof { verdict, because, bounds, parts } = judged.unwrap_or_else(unread);
    let mut said = json!({"verdict": match verdict {
        Verdict::Proved => "proved",
        Verdict::NotProved => "not proved",
        Verdict::Disproved => "disproved",
    }});
    if let Some(Bounds { lower, upper }) = bounds {
        // Infinity is null.
        (said["lower"], said["upper"]) = (lower.to_f64().into(), upper.to_f64().into());
    }
    if let Some(Parts { are_of_free, proved, not_proved }) = parts {
        said["claim"] = if are_of_free { "free" } else { "met" }.into();
        (said[PARTS[0]], said[PARTS[1]]) = (proved.into(), not_proved.into());
    }
    if let Some(because) = because {
        said["because"] = because.into();
    }
    (verdict, said)
}
