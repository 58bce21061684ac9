//! `cargo xtask sweep`: ray casts, linear casts and distances at every scale, and derivatives, against references in
//! thirty digits.
//!
//! Bodies × sizes × distances × precisions. Bodies and questions are rounded to the precision that is asked first, and
//! the truth is that of the rounded numbers (`judge`). A ray is a *sure hit* if it hits the body shrunk by 5 %, and a
//! *sure miss* if it misses the body grown by 5 %.

mod certificates;
mod derivatives;
mod hull;
mod judge;
mod local;
mod obstacle;
mod questions;
mod row;
mod solid;

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, ValueEnum};
use rayon::prelude::*;

pub(crate) use row::Row;

/// What is swept, and how finely.
#[derive(Clone, Debug, Args)]
pub(crate) struct Scope {
    /// Only this question; all of them by default.
    #[arg(value_enum)]
    question: Option<Question>,
    /// Queries in each cell; of the certificates and the derivatives, in all.
    #[arg(long, value_name = "N")]
    rays: Option<u64>,
    /// Only subjects whose name contains this.
    #[arg(long, value_name = "SHAPE", default_value = "", hide_default_value = true)]
    only: String,
    /// Another seed draws other queries.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// A hundredth of the queries: half a minute.
    #[arg(long)]
    quick: bool,
    /// Where the table goes, every cell by itself.
    #[arg(long, value_name = "CSV", default_value = "target/sweep.csv")]
    output: PathBuf,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Question {
    /// Ray casts on single bodies, and on the difference of two.
    Ray,
    /// Linear casts of pairs.
    Linear,
    /// Distances of pairs, from overlap to ten sizes apart.
    Distance,
    /// Random queries of every kind, stopped early half of the time: only their certificates count.
    Certificates,
    /// First and second derivatives of answers about random regular pairs, with differences in thirty digits.
    Derivatives,
}

const QUESTIONS: [Question; 5] =
    [Question::Ray, Question::Linear, Question::Distance, Question::Certificates, Question::Derivatives];

/// Queries in a cell, and of certificates and derivatives in all, unless said otherwise.
const RAYS: u64 = 20_000;
const CERTIFICATES: u64 = 10_000_000;
const DERIVATIVES: u64 = 200_000;
const QUICK: u64 = 100;

impl Scope {
    /// All questions at a hundredth of the queries.
    pub(crate) fn quick(question: Question) -> Self {
        Self {
            question: Some(question),
            rays: None,
            only: String::new(),
            seed: 0,
            quick: true,
            output: PathBuf::from("target/sweep.csv"),
        }
    }

    fn count(&self, question: Question) -> u64 {
        let all = match question {
            Question::Certificates => CERTIFICATES,
            Question::Derivatives => DERIVATIVES,
            _ => RAYS,
        };
        self.rays.unwrap_or(if self.quick { all / QUICK } else { all })
    }
}

/// The table: every cell of the questions in scope, computed in parallel. `done` is told about each.
pub(crate) fn rows(scope: &Scope, done: impl Fn(&Row) + Sync) -> Vec<Row> {
    let asked = QUESTIONS.into_iter().filter(|q| scope.question.is_none_or(|only| only == *q));
    let mut rows = Vec::new();
    for question in asked {
        let cells: Vec<Row> = match question {
            Question::Certificates => certificates::cells(&scope.only),
            Question::Derivatives => derivatives::cells(&scope.only),
            _ => questions::cells(question, &scope.only),
        };
        let count = cells.len() as u64;
        rows.par_extend(cells.into_par_iter().map(|cell| {
            let row = match question {
                Question::Certificates => certificates::fill(cell, scope.count(question), count, scope.seed),
                Question::Derivatives => derivatives::fill(cell, scope.count(question), count, scope.seed),
                _ => questions::fill(cell, scope.count(question), scope.seed),
            };
            done(&row);
            row
        }));
    }
    rows
}

/// Prints the table, sizes taken together, and writes all of it as CSV.
pub(crate) fn run(scope: &Scope) -> ExitCode {
    let rows = rows(scope, |_| {});
    match write(&rows, &scope.output) {
        Err(why) if why.kind() != io::ErrorKind::BrokenPipe => {
            xtask::output::failed(&format!("cannot write {}", scope.output.display()), &why)
        }
        _ if rows.iter().all(Row::is_right) => ExitCode::SUCCESS,
        _ => ExitCode::FAILURE,
    }
}

fn write(rows: &[Row], path: &Path) -> io::Result<()> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    let mut csv = String::from(Row::HEADER);
    csv.extend(rows.iter().map(|row| format!("\n{}", row.csv())));
    fs::write(path, csv + "\n")?;

    let mut output = io::stdout().lock();
    writeln!(output, "{}", Row::TITLES)?;
    let mut together: Vec<Row> = Vec::new();
    for row in rows {
        match together.iter_mut().find(|other| other.differs_in_size(row)) {
            Some(other) => other.join(row),
            None => together.push(row.clone()),
        }
    }
    for row in &together {
        writeln!(output, "{row}")?;
    }
    let queries: u64 = rows.iter().map(|row| row.queries).sum();
    let wrong = rows.iter().filter(|row| !row.is_right()).count();
    writeln!(output, "{queries} queries in {} cells, {wrong} of them wrong; all in {}", rows.len(), path.display())
}
