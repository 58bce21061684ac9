//! What validation found, in numbers: per query and per tag.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::Path;

use super::Record;
use super::page::error;
use super::score::called;
use super::stiff;
use crate::engine::IS_FOR_STUDIES;
use crate::plot::duration;
use crate::table::{aligned, quantile};

/// Counts and quantiles of a group of cases.
#[derive(Clone, Debug, Default)]
pub struct Group {
    pub cases: usize,
    pub wrong: usize,
    /// Of those that are wrong, the ones that have converged to a wide bracket.
    pub wide: usize,
    pub soft: usize,
    relative: Vec<f64>,
    ratio: Vec<f64>,
    time: Vec<f64>,
    iterations: Vec<f64>,
}

impl Group {
    fn add(&mut self, record: &Record) {
        self.cases += 1;
        self.wrong += usize::from(!record.verdict.wrong.is_empty());
        self.wide += usize::from(record.verdict.is_wide());
        self.soft += usize::from(!record.verdict.soft.is_empty());
        self.relative.extend(record.verdict.relative);
        self.ratio.extend(record.verdict.ratio);
        self.time.extend(record.time);
        self.iterations.extend(record.iterations.map(|i| i as f64));
    }

    /// The worst error in units of its tolerance, if there is one.
    pub fn worst_of_tolerance(&self) -> Option<f64> {
        quantile(&self.ratio, 1.0)
    }

    /// The columns of [`HEADERS`], after the name.
    pub fn columns(&self) -> [String; 12] {
        let told = |value: Option<f64>, as_text: fn(f64) -> String| value.map_or_else(|| "–".to_owned(), as_text);
        let whole = |value: f64| format!("{value:.0}");
        [
            self.cases.to_string(),
            (self.cases - self.wrong).to_string(),
            self.wrong.to_string(),
            // Only the laws of claims tell.
            told(IS_FOR_STUDIES.then_some(self.wide as f64), whole),
            self.soft.to_string(),
            told(quantile(&self.relative, 0.5), error),
            told(quantile(&self.relative, 0.99), error),
            told(quantile(&self.relative, 1.0), error),
            told(self.worst_of_tolerance(), error),
            told(quantile(&self.iterations, 0.5), whole),
            told(quantile(&self.iterations, 1.0), whole),
            told(quantile(&self.time, 0.5), duration),
        ]
    }
}

/// What the columns of a group are.
pub const HEADERS: [&str; 12] = [
    "cases",
    "right",
    "wrong",
    "wide though converged",
    "secondary errors",
    "median relative error",
    "99 % below",
    "worst",
    "share of the allowed error",
    "iterations",
    "most",
    "median time",
];

/// Groups of cases by what `names` calls them.
pub fn groups<'r>(records: &'r [Record], names: impl Fn(&'r Record) -> Vec<String>) -> BTreeMap<String, Group> {
    let mut groups = BTreeMap::<String, Group>::new();
    for record in records {
        for name in names(record) {
            groups.entry(name).or_default().add(record);
        }
    }
    groups
}

pub fn by_query(records: &[Record]) -> BTreeMap<String, Group> {
    groups(records, |r| vec![format!("{} {}", called(&r.query), r.precision)])
}

pub fn by_file(records: &[Record]) -> BTreeMap<String, Group> {
    groups(records, |r| vec![r.file.clone()])
}

pub fn total(records: &[Record]) -> Group {
    let mut total = Group::default();
    records.iter().for_each(|record| total.add(record));
    total
}

/// The most wrong answers that are told one by one.
const TOLD: usize = 20;

/// Prints the verdict, what it means, where the page is, and then tables.
pub fn print(records: &[Record], sentences: &[String], page: &Path, output: &mut impl Write) -> io::Result<()> {
    let total = total(records);
    writeln!(
        output,
        "{} right, {} wrong: questions with known answers, each within the error that its case allows.",
        total.cases - total.wrong,
        total.wrong
    )?;
    sentences.iter().try_for_each(|sentence| writeln!(output, "{sentence}"))?;
    writeln!(output, "The page, with figures and every case: {}\n", page.display())?;
    let bad: Vec<&Record> = records.iter().filter(|r| !r.verdict.wrong.is_empty()).collect();
    for record in bad.iter().take(TOLD) {
        let Record { file, id, tags, verdict, .. } = record;
        writeln!(output, "WRONG {file} {id} ({}): {}", tags.join(", "), verdict.wrong.join("; "))?;
    }
    if bad.len() > TOLD {
        writeln!(output, "… and {} more wrong; the report lists all", bad.len() - TOLD)?;
    }
    let errored = bad.iter().filter(|record| record.verdict.errored).count();
    if errored > 0 {
        writeln!(output, "{errored} of the wrong ones are errors where an answer was due")?;
    }
    writeln!(output, "By question; {EXPLAINED}")?;
    table(output, "question", &by_query(records))?;
    writeln!(output, "By file:")?;
    table(output, "file", &by_file(records))?;
    stiff::print(records, output)?;
    for record in records.iter().filter(|r| !r.verdict.soft.is_empty()).take(TOLD) {
        let Record { file, id, verdict, .. } = record;
        writeln!(output, "right, with a secondary error: {file} {id}: {}", verdict.soft.join("; "))?;
    }
    Ok(())
}

/// What the columns of the tables mean.
const EXPLAINED: &str = "errors are relative to the truth, where that is larger than the error allowed. An answer is \
    right if it takes up at most 1 of that; iterations are support points, mostly. A secondary error is one of what \
    stands beside a right value: a normal, a point, a bound wider than it need be.";

fn table(output: &mut impl Write, title: &str, groups: &BTreeMap<String, Group>) -> io::Result<()> {
    let headers: Vec<&str> = [title].into_iter().chain(HEADERS).collect();
    let rows = groups.iter().map(|(name, group)| [name.clone()].into_iter().chain(group.columns()).collect());
    aligned(output, &headers, &rows.collect::<Vec<Vec<String>>>(), 1)
}
