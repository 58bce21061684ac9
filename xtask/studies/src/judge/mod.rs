//! `cargo xtask judge`: everybody's answers held against what is proved.

#[cfg(any(feature = "box3d", feature = "jolt"))]
mod compiled;
#[cfg(feature = "peers")]
mod parry;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use xtask::judge::questions::{self, Question};
use xtask::judge::table::Report;
use xtask::judge::witnesses::{self, Witness};
use xtask::judge::{judged, proved, violated};
use xtask::validate::{begin_progress, end_progress};

/// What to ask, and whom.
#[derive(Clone, Debug, Args)]
pub(crate) struct Scope {
    /// Answers of somebody else to the questions that `--questions` writes; `benches/peers/` has programs that give
    /// them.
    #[arg(long, value_name = "FILE", num_args = 1..)]
    answers: Vec<PathBuf>,
    /// Write the questions as a query file, and end.
    #[arg(long, value_name = "FILE")]
    questions: Option<PathBuf>,
    /// Write the answers of one built-in library to a file of questions, and end: `benches/peers/museum_today.py` reads
    /// them.
    #[arg(long, value_names = ["LIBRARY", "QUESTIONS", "ANSWERS"], num_args = 3)]
    ask: Option<Vec<String>>,
    /// How many questions of each kind are asked of each shape or pair of shapes of the workloads.
    #[arg(long, value_name = "N", default_value_t = 50, value_parser = clap::value_parser!(u16).range(2..=2000))]
    each: u16,
    /// Where the table, the figure and the claims that are disproved go.
    #[arg(long, value_name = "FOLDER", default_value = "target/judge")]
    report: PathBuf,
    /// Write the table and the figure into the notes too, where the report and the README find them.
    #[arg(long)]
    record: bool,
}

/// All answers of a library, which says how many it has given.
type Ask = fn(&[Question], &mut dyn FnMut(usize)) -> Witness;

/// The libraries that are built in, in the order of the table.
const LIBRARIES: &[(&str, Ask)] = &[
    #[cfg(feature = "peers")]
    ("parry f64", |questions, progress| parry::double::witness(questions, progress)),
    #[cfg(feature = "peers")]
    ("parry f32", |questions, progress| parry::single::witness(questions, progress)),
    #[cfg(feature = "box3d")]
    ("Box3D f32", |questions, progress| compiled::box3d(questions, progress)),
    #[cfg(feature = "jolt")]
    ("Jolt f32", |questions, progress| compiled::jolt(questions, progress)),
];

/// Judges everybody.
pub(crate) fn run(scope: &Scope) -> ExitCode {
    xtask::output::ended(judge(scope))
}

/// Whether every bracket holds the truth, and no claim of ours is disproved.
fn judge(scope: &Scope) -> Result<bool, String> {
    let questions = questions::all(usize::from(scope.each));
    if let Some(file) = &scope.questions {
        return write_questions(file, &questions).map(|()| true);
    }
    if let Some([library, file, answers]) = scope.ask.as_deref() {
        let questions = questions::of_file(Path::new(file))?;
        let (_, ask) = LIBRARIES.iter().find(|(name, _)| name == library).ok_or("no such library is built in")?;
        return ask(&questions, &mut |_| ()).write(&questions, Path::new(answers)).map(|()| true);
    }
    begin_progress(1, "judge");
    let witnesses = witnesses(scope, &questions)?;
    let cases = proved(questions, |k| progress("proving", k));
    let mut disproved = String::new();
    let mut rows = Vec::new();
    for witness in &witnesses {
        progress(&format!("judging {}", witness.name), 0);
        rows.extend(judged(witness, &cases, &mut disproved));
    }
    end_progress();
    let violated = violated(&cases);
    let report = Report { rows, witnesses: &witnesses, cases: cases.len(), violated: &violated };
    report.write(&scope.report, &disproved).map_err(|why| format!("cannot write {}: {why}", scope.report.display()))?;
    if scope.record {
        report.record().map_err(|why| format!("cannot write docs/comparison.md and what belongs to it: {why}"))?;
    }
    let sound = report.rows.iter().filter(|row| row.peer.starts_with("ours")).all(|row| row.disproved == 0);
    Ok(violated.1.is_empty() && sound)
}

fn write_questions(file: &Path, questions: &[Question]) -> Result<(), String> {
    let line = |question: &Question| serde_json::to_string(&question.object).unwrap_or_default() + "\n";
    let text: String = questions.iter().map(line).collect();
    let folder = file.parent().unwrap_or(Path::new(""));
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(file, text))
        .map_err(|why| format!("cannot write {}: {why}", file.display()))
}

/// Who answers, in the order of the table.
fn witnesses(scope: &Scope, questions: &[Question]) -> Result<Vec<Witness>, String> {
    let mut witnesses = vec![
        witnesses::ours(questions, "f64", |k| progress("ours f64", k)),
        witnesses::ours(questions, "f32", |k| progress("ours f32", k)),
    ];
    witnesses.extend(LIBRARIES.iter().map(|(name, ask)| ask(questions, &mut |k| progress(name, k))));
    for file in &scope.answers {
        witnesses.push(witnesses::from_file(file, questions)?);
    }
    Ok(witnesses)
}

fn progress(what: &str, done: usize) {
    if done.is_multiple_of(64) {
        xtask::validate::progress(&format!("{what} {done}"));
    }
}
