//! `cargo xtask bits`: whether this machine answers as others do, to the last bit.
//!
//! Questions of every kind, dimension and precision are drawn from fixed seeds and answered; every field of the
//! answers, their derivatives, certificates and iteration counts are hashed. Numbers are written with the digits that
//! tell them from their neighbours, so that one bit in one of them changes the hash. `bits.txt` keeps the hashes that
//! every machine is to have.

use std::io::{self, BufWriter, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use rayon::prelude::*;
use workloads::rng::Rng;

use crate::draw::{KINDS, query};
use crate::engine;
use crate::mesh::Meshes;
use crate::output;
use crate::wire::json;

/// Where the hashes of [`COUNTS`] questions each are kept.
const KEPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/bits.txt");

/// Questions of each kind, dimension and precision: for every day, and over a million in all.
const COUNTS: [u64; 2] = [500, 20_000];

/// How many questions, and what becomes of the hashes.
#[derive(Clone, Debug, Args)]
pub struct Choice {
    /// Questions of each kind, dimension and precision: 20000 of them are over a million in all, whose hashes are kept
    /// too. Those of any other count than these two are printed, and compared with nothing.
    #[arg(long, value_name = "N", default_value_t = COUNTS[0])]
    count: u64,
    /// Write the hashes of both counts down as what every machine is to have.
    #[arg(long, conflicts_with_all = ["count", "answers"])]
    record: bool,
    /// Print the answers themselves, in order, a line each: `diff` tells in which of them two machines differ.
    #[arg(long)]
    answers: bool,
    /// Where the hashes are kept.
    #[arg(long, value_name = "FILE", default_value = KEPT)]
    kept: PathBuf,
}

/// Questions of one kind, dimension and precision.
struct Row {
    name: String,
    /// What is said of the question with this number; an error where it has no answer.
    ask: Box<dyn Fn(u64) -> Result<String, String> + Sync>,
}

/// Answers the questions and compares the hashes; exit status 1 where they differ.
#[must_use]
pub fn run(choice: &Choice) -> ExitCode {
    let outcome = if choice.answers { print(choice.count) } else { compare(choice) };
    outcome.unwrap_or_else(|why| output::failed("cannot read or write", &why))
}

fn print(count: u64) -> io::Result<ExitCode> {
    let mut output = BufWriter::new(io::stdout().lock());
    for Row { name, ask } in rows() {
        for (i, answer) in (0..count).zip(answers(&ask, count, |answer| answer)) {
            writeln!(output, "{name} {i}: {answer:?}")?;
        }
    }
    output.flush()?;
    Ok(ExitCode::SUCCESS)
}

fn compare(choice: &Choice) -> io::Result<ExitCode> {
    if choice.record {
        let head = "# Of each kind of question: how many were asked, the hash of the answers, and how many have one; by `cargo xtask bits --record`.\n";
        std::fs::write(&choice.kept, format!("{head}{}", COUNTS.map(hashes).concat()))?;
        return Ok(ExitCode::SUCCESS);
    }
    let text = hashes(choice.count);
    let mut output = io::stdout().lock();
    if !COUNTS.contains(&choice.count) {
        output.write_all(text.as_bytes())?;
        return Ok(ExitCode::SUCCESS);
    }
    let kept = std::fs::read_to_string(&choice.kept)?;
    let differ: Vec<_> = text.lines().filter(|line| !kept.lines().any(|due| due == *line)).collect();
    for line in &differ {
        writeln!(output, "{line} differs from {}", choice.kept.display())?;
    }
    let (rows, all) = (text.lines().count(), fnv1a(FNV_BASIS, &text));
    writeln!(
        output,
        "bits: {} of {rows} hashes of {} answers each differ; all of them: {all:016x}",
        differ.len(),
        choice.count
    )?;
    Ok(if differ.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// A line for each row: what is kept of this many questions.
fn hashes(count: u64) -> String {
    let line = |Row { name, ask }: Row| {
        let each = answers(&ask, count, |answer| match answer {
            Ok(said) => (1, fnv1a(FNV_BASIS, &said)),
            Err(why) => (0, fnv1a(FNV_BASIS, &why)),
        });
        let answered: u64 = each.iter().map(|(answered, _)| answered).sum();
        let hash = each.iter().fold(FNV_BASIS, |hash, (_, answer)| fnv1a(hash, &format!("{answer:016x}")));
        format!("{count:>5} {name:<26} {hash:016x} {answered}\n")
    };
    rows().map(line).collect()
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
            asked.and_then(|question| question.ask_everything()).map_err(|problem| problem.message)
        };
        Row { name, ask: Box::new(ask) }
    })
}

/// What there is to `keep` of each answer, in order, found on all cores.
fn answers<T: Send>(
    ask: &(dyn Fn(u64) -> Result<String, String> + Sync),
    count: u64,
    keep: impl Fn(Result<String, String>) -> T + Sync,
) -> Vec<T> {
    (0..count).into_par_iter().map(|i| keep(ask(i))).collect()
}

/// Of the 64-bit FNV-1a hash of nothing.
const FNV_BASIS: u64 = 0xcbf2_9ce4_8422_2325;

/// The FNV-1a hash of what was hashed before, and a line.
fn fnv1a(hash: u64, line: &str) -> u64 {
    line.bytes().chain([b'\n']).fold(hash, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}
