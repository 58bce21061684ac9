//! `cargo xtask judge`: everybody's answers held against what is proved.

#[cfg(any(feature = "box3d", feature = "jolt"))]
mod compiled;
#[cfg(feature = "peers")]
mod parry;

use std::fs;
use std::io::{self, Write as _};
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
    /// Write parry's answers to a file of questions, in this precision, and end: `benches/peers/museum_today.py` reads
    /// them.
    #[cfg(feature = "peers")]
    #[arg(long, value_names = ["PRECISION", "QUESTIONS", "ANSWERS"], num_args = 3)]
    parry: Option<Vec<String>>,
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

/// Judges everybody.
pub(crate) fn run(scope: &Scope) -> ExitCode {
    match judge(scope) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(why) => {
            let _ = writeln!(io::stderr(), "error: {why}");
            ExitCode::from(2)
        }
    }
}

/// Whether every bracket holds the truth, and no claim of ours is disproved.
fn judge(scope: &Scope) -> Result<bool, String> {
    let questions = questions::all(usize::from(scope.each));
    if let Some(file) = &scope.questions {
        return write_questions(file, &questions).map(|()| true);
    }
    #[cfg(feature = "peers")]
    if let Some([precision, file, answers]) = scope.parry.as_deref() {
        let questions = questions::of_file(Path::new(file))?;
        let witness = if precision == "f32" { parry::single::witness } else { parry::double::witness };
        return witness(&questions, |_| ()).write(&questions, Path::new(answers)).map(|()| true);
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
    #[cfg(feature = "peers")]
    {
        witnesses.push(parry::double::witness(questions, |k| progress("parry f64", k)));
        witnesses.push(parry::single::witness(questions, |k| progress("parry f32", k)));
    }
    #[cfg(feature = "box3d")]
    witnesses.push(compiled::box3d(questions, |k| progress("Box3D", k)));
    #[cfg(feature = "jolt")]
    witnesses.push(compiled::jolt(questions, |k| progress("Jolt", k)));
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
