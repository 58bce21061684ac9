//! `cargo xtask bits`: whether this machine answers as others do, to the last bit.
//!
//! Questions of every kind, dimension and precision are drawn from fixed seeds and answered; the answers, as the query
//! format writes them, with iteration counts and certificates, are hashed. Numbers are written with the digits that
//! tell them from their neighbours, so that one bit in one of them changes the hash. `bits.txt` keeps the hashes that
//! every machine is to have.

use std::fmt::Write as _;
use std::io::{self, BufWriter, Write};
use std::process::ExitCode;

use clap::Args;
use rayon::prelude::*;
use serde_json::Value;
use workloads::rng::Rng;

use crate::draw::{KINDS, query};
use crate::engine;
use crate::mesh::Meshes;
use crate::wire::json;

/// Where the hashes of [`COUNT`] questions each are kept.
const KEPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/bits.txt");

/// Questions of each row of [`KEPT`].
const COUNT: u64 = 500;

/// How many questions, and what becomes of the hashes.
#[derive(Clone, Debug, Args)]
pub struct Choice {
    /// Questions of each kind, dimension and precision; hashes of another count than the default are printed and
    /// compared with nothing.
    #[arg(long, value_name = "N", default_value_t = COUNT)]
    count: u64,
    /// Write the hashes down as what every machine is to have.
    #[arg(long, conflicts_with_all = ["count", "answers"])]
    record: bool,
    /// Print the answers themselves, in order, a line each: `diff` tells in which of them two machines differ.
    #[arg(long)]
    answers: bool,
}

/// Questions of one kind, dimension and precision.
struct Row {
    name: String,
    ask: Box<dyn Fn(u64) -> (bool, String) + Sync>,
}

/// Answers the questions and compares the hashes; exit status 1 where they differ.
#[must_use]
pub fn run(choice: &Choice) -> ExitCode {
    let outcome = if choice.answers { print(choice.count) } else { compare(choice) };
    outcome.unwrap_or_else(|why| {
        let _ = writeln!(io::stderr(), "error: {why}");
        ExitCode::from(2)
    })
}

fn print(count: u64) -> io::Result<ExitCode> {
    let mut output = BufWriter::new(io::stdout().lock());
    for Row { name, ask } in rows() {
        for (i, (_, answer)) in (0..count).zip(answers(&ask, count)) {
            writeln!(output, "{name} {i}: {answer}")?;
        }
    }
    output.flush()?;
    Ok(ExitCode::SUCCESS)
}

fn compare(choice: &Choice) -> io::Result<ExitCode> {
    let mut text = format!(
        "# Hashes of the answers to {} questions of each kind, and how many of them have an answer; by `cargo xtask bits --record`.\n",
        choice.count
    );
    for Row { name, ask } in rows() {
        let answers = answers(&ask, choice.count);
        let answered = answers.iter().filter(|(answered, _)| *answered).count();
        let hash = answers.iter().fold(FNV_BASIS, |hash, (_, answer)| fnv1a(hash, answer));
        let _ = writeln!(text, "{name:<32} {hash:016x} {answered}");
    }
    let mut output = io::stdout().lock();
    if choice.record {
        std::fs::write(KEPT, &text)?;
    }
    if choice.count != COUNT {
        output.write_all(text.as_bytes())?;
        return Ok(ExitCode::SUCCESS);
    }
    let kept = std::fs::read_to_string(KEPT)?;
    let differ: Vec<_> = text.lines().filter(|line| !kept.lines().any(|due| due == *line)).collect();
    for line in &differ {
        writeln!(output, "{line} differs from {KEPT}")?;
    }
    writeln!(
        output,
        "bits: {} of {} hashes differ; all of them: {:016x}",
        differ.len(),
        rows().count(),
        fnv1a(FNV_BASIS, &text)
    )?;
    Ok(if differ.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// The rows, in the order of the file.
fn rows() -> impl Iterator<Item = Row> {
    let of = |kind: (&'static str, _)| {
        ["f32", "f64"].into_iter().flat_map(move |precision| [2, 3].map(|dimension| (kind, precision, dimension)))
    };
    KINDS.iter().copied().flat_map(of).map(|(kind, precision, dimension)| {
        let name = format!("{} {precision} {dimension}D", kind.0);
        let seed = fnv1a(FNV_BASIS, &name);
        let ask = move |i: u64| {
            let question =
                query(kind, precision, dimension, &mut Rng::new(seed ^ i.wrapping_mul(0x9E37_79B9_7F4A_7C15)));
            let object = json::object(question.to_string().as_bytes());
            let asked = object.and_then(|object| engine::question(&object, &Meshes::relative_to("")));
            match asked.and_then(|question| question.ask_with_certificate()) {
                Ok(answer) => (true, serde_json::to_string(&answer).unwrap_or_default()),
                Err(problem) => (false, Value::from(problem.message).to_string()),
            }
        };
        Row { name, ask: Box::new(ask) }
    })
}

/// In order, found on all cores.
fn answers(ask: &(dyn Fn(u64) -> (bool, String) + Sync), count: u64) -> Vec<(bool, String)> {
    (0..count).into_par_iter().map(ask).collect()
}

/// Of the 64-bit FNV-1a hash of nothing.
const FNV_BASIS: u64 = 0xcbf2_9ce4_8422_2325;

/// The FNV-1a hash of what was hashed before, and a line.
fn fnv1a(hash: u64, line: &str) -> u64 {
    line.bytes().chain([b'\n']).fold(hash, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}
