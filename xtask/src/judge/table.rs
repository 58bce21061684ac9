//! The judgement as a table, a figure, and files.

use std::fmt::Write as _;
use std::fs;
use std::io::{self, Write as _};
use std::path::Path;

use crate::plot::duration;
use crate::table::quantile;
use workloads::note;
use workloads::provenance::provenance;

use super::figure::{self, Point};
use super::questions::{SETS, asked_as};
use super::verdict::{Outcome, Verdict};
use super::witnesses::Witness;

/// What became of the answers of one to the questions of a set.
#[derive(Clone, Debug)]
pub struct Row {
    pub peer: String,
    pub set: &'static str,
    asked: usize,
    none: usize,
    right: usize,
    off: usize,
    pub disproved: usize,
    open: usize,
    errors: Vec<f64>,
    times: Vec<f64>,
}

impl Row {
    pub fn new(peer: &str, set: &'static str) -> Self {
        let (errors, times) = (Vec::new(), Vec::new());
        Self { peer: peer.to_owned(), set, asked: 0, none: 0, right: 0, off: 0, disproved: 0, open: 0, errors, times }
    }

    /// Counts an answer.
    pub fn add(&mut self, verdict: &Verdict, ns: f64) {
        self.asked += 1;
        match verdict.outcome {
            Outcome::Right => self.right += 1,
            Outcome::Inaccurate => self.off += 1,
            Outcome::Disproved => self.disproved += 1,
            Outcome::Undecided => self.open += 1,
        }
        self.errors.extend(verdict.error);
        self.times.push(ns);
    }

    /// Counts a question without an answer, which was asked or not.
    pub fn add_none(&mut self, asked: bool) {
        self.asked += usize::from(asked);
        self.none += usize::from(asked);
    }

    /// Its mark in the figure.
    #[must_use]
    pub fn point(&self) -> Option<Point> {
        Some(Point {
            set: self.set.to_owned(),
            who: self.peer.clone(),
            disproved: self.disproved,
            error: quantile(&self.errors, 0.99).unwrap_or(f64::NAN),
            ns: quantile(&self.times, 0.5)?,
        })
    }

    /// The names of the cells.
    const HEADERS: [&str; 12] = [
        "question",
        "who",
        "asked",
        "right",
        "inaccurate",
        "disproved",
        "no answer",
        "undecided",
        "median error",
        "99th percentile",
        "worst",
        "median time",
    ];

    /// As text; `number` writes errors, `time` writes nanoseconds.
    fn cells(&self, number: impl Fn(f64) -> String, time: impl Fn(f64) -> String) -> [String; 12] {
        let error = |p| quantile(&self.errors, p).map_or_else(String::new, &number);
        let counts =
            [self.asked, self.right, self.off, self.disproved, self.none, self.open].map(|count| count.to_string());
        let [asked, right, off, disproved, none, open] = counts;
        let finite: Vec<f64> = self.times.iter().copied().filter(|ns| ns.is_finite()).collect();
        let median = quantile(&finite, 0.5).map_or_else(String::new, time);
        let (set, peer) = (self.set.to_owned(), self.peer.clone());
        [set, peer, asked, right, off, disproved, none, open, error(0.5), error(0.99), error(1.0), median]
    }
}

/// Everything that was found.
#[derive(Debug)]
pub struct Report<'a> {
    pub rows: Vec<Row>,
    pub witnesses: &'a [Witness],
    pub cases: usize,
    /// How many truths are known, and whose brackets do not hold them.
    pub violated: &'a (usize, Vec<String>),
}

impl Report<'_> {
    /// Writes the files, and prints the tables.
    ///
    /// # Errors
    /// Where a file cannot be written.
    pub fn write(&self, folder: &Path, disproved: &str) -> io::Result<()> {
        fs::create_dir_all(folder)?;
        let markdown = format!("# Other libraries, judged\n\n{}\n{}", self.judged(), self.settings());
        fs::write(folder.join("judge.md"), &markdown)?;
        fs::write(folder.join("judge.csv"), self.csv())?;
        fs::write(folder.join("disproved.jsonl"), disproved)?;
        fs::write(folder.join("judge.svg"), self.figure())?;
        let mut output = io::stdout().lock();
        writeln!(output, "{markdown}\nwritten to {}: judge.md, judge.csv, judge.svg, disproved.jsonl", folder.display())
    }

    /// Writes the tables and the figure into the notes.
    ///
    /// # Errors
    /// Where a file cannot be written.
    pub fn record(&self) -> io::Result<()> {
        note::write(&note::path("comparison.md"), "judged", &self.judged())?;
        note::write(&note::path("comparison.md"), "settings", &self.settings())?;
        fs::write(note::path("judge.csv"), self.csv())?;
        fs::write(note::path("figures/judge.svg"), self.figure())
    }

    /// The figure as a picture of its own.
    fn figure(&self) -> String {
        let about_ellipsoids = figure::recorded().into_iter().filter(|point| !SETS.contains(&point.set.as_str()));
        figure::file(&figure::read(&self.csv()).into_iter().chain(about_ellipsoids).collect::<Vec<_>>())
    }

    /// The rows in the order of the questions, and of those who answer.
    fn sorted(&self) -> Vec<&Row> {
        let mut sets: Vec<&str> = Vec::new();
        for row in &self.rows {
            if !sets.contains(&row.set) {
                sets.push(row.set);
            }
        }
        sets.sort_by_key(|set| SETS.iter().position(|known| known == set).unwrap_or(usize::MAX));
        sets.iter().flat_map(|set| self.rows.iter().filter(move |row| row.set == *set && row.asked > 0)).collect()
    }

    fn csv(&self) -> String {
        let exact = |value: f64| format!("{value:e}");
        let lines = self.sorted().into_iter().map(|row| row.cells(exact, |ns| format!("{ns:.1}")).join(","));
        [Row::HEADERS.join(",")].into_iter().chain(lines).map(|line| line + "\n").collect()
    }

    /// The tables, how many truths were known otherwise, and where all of it was measured.
    fn judged(&self) -> String {
        let (known, violated) = self.violated;
        let held = match violated.len() {
            0 => "every bracket holds it".to_owned(),
            count => format!("all brackets but {count} hold it"),
        };
        let mut text = format!(
            "{}\n{} questions. The truth of {known} of them is known independently of any bracket; {held}.\n",
            markdown(&self.csv()),
            self.cases
        );
        for id in violated {
            let _ = writeln!(text, "- the bracket of {id} does not hold the truth");
        }
        let _ = writeln!(text, "Measured on {}.", provenance());
        text
    }

    /// How each was asked, and which error is not held against it.
    fn settings(&self) -> String {
        let mut text =
            "| library | how it is asked | error allowed: the greatest of these |\n|---|---|---|\n".to_owned();
        for Witness { name, tolerance, of_motion, rounding, settings, .. } in self.witnesses {
            let tolerance = if *tolerance > 0.0 { format!("{tolerance:e}; ") } else { String::new() };
            let motion = if *of_motion > 0.0 { format!("{of_motion:e} of the motion; ") } else { String::new() };
            let _ = writeln!(text, "| {name} | {settings} | {tolerance}{motion}{rounding:e} of the scene's size |");
        }
        text
    }
}

/// The tables of a `judge.csv`: the questions of the workloads, and those of the embedded suite.
#[must_use]
pub fn markdown(csv: &str) -> String {
    const SUITE: &str = "suite: ";
    let rows: Vec<Vec<&str>> = csv.lines().skip(1).map(|line| line.split(',').collect()).collect();
    let mut text = String::new();
    for (title, of_suite) in [("Ordinary questions", false), ("Hard questions: the embedded suite", true)] {
        let _ = writeln!(
            text,
            "### {title}\n\n| question | library | asked | inaccurate | disproved | no answer | error of 99 in 100 below | worst error | median time |\n\
             |---|---|---:|---:|---:|---:|---:|---:|---:|"
        );
        for row in rows.iter().filter(|row| row[0].starts_with(SUITE) == of_suite) {
            let &[set, who, asked, _, inaccurate, disproved, none, _, _, most, worst, ns] = row.as_slice() else {
                continue;
            };
            let error = |cell: &str| match cell.parse::<f64>() {
                Ok(0.0) => "0".to_owned(),
                Ok(error) => format!("{error:.0e}"),
                Err(_) => String::new(),
            };
            let set = asked_as(set.trim_start_matches(SUITE));
            let time = ns.parse().map_or_else(|_| String::new(), duration);
            let (most, worst) = (error(most), error(worst));
            let _ = writeln!(
                text,
                "| {set} | {who} | {asked} | {inaccurate} | {disproved} | {none} | {most} | {worst} | {time} |"
            );
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whoever edits the note by hand, or records the numbers without the tables, is told.
    #[test]
    fn the_note_has_the_tables_of_the_recorded_numbers() {
        let read = |name| fs::read_to_string(note::path(name)).expect("it is in the folder of notes");
        let (page, csv) = (read("comparison.md"), read("judge.csv"));
        let part = note::part(&page, "judged").expect("there is such a part");
        let due = markdown(&csv);
        assert!(part.contains(due.trim()), "docs/comparison.md has other numbers than docs/judge.csv; due:\n{due}");
    }
}
