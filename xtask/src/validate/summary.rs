//! What validation found, in numbers: per query and per tag.

use std::collections::BTreeMap;
use std::io::{self, Write};

use super::Record;

/// Counts and quantiles of a group of cases.
#[derive(Clone, Debug, Default)]
pub struct Group {
    pub cases: usize,
    pub wrong: usize,
    pub errored: usize,
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
        self.errored += usize::from(record.verdict.errored);
        self.soft += usize::from(!record.verdict.soft.is_empty());
        self.relative.extend(record.verdict.relative);
        self.ratio.extend(record.verdict.ratio);
        self.time.extend(record.time);
        self.iterations.extend(record.iterations.map(|i| i as f64));
    }

    /// The columns of [`HEADERS`], after the name.
    pub fn columns(&self) -> [String; 12] {
        let whole = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |v| format!("{v:.0}"));
        [
            self.cases.to_string(),
            (self.cases - self.wrong).to_string(),
            self.wrong.to_string(),
            self.errored.to_string(),
            self.soft.to_string(),
            error(quantile(&self.relative, 0.5)),
            error(quantile(&self.relative, 0.99)),
            error(quantile(&self.relative, 1.0)),
            error(quantile(&self.ratio, 1.0)),
            whole(quantile(&self.iterations, 0.5)),
            whole(quantile(&self.iterations, 1.0)),
            whole(quantile(&self.time, 0.5)),
        ]
    }
}

/// What the columns of a group are.
pub const HEADERS: [&str; 12] = [
    "cases",
    "right",
    "wrong",
    "errored",
    "soft",
    "rel 50%",
    "rel 99%",
    "rel max",
    "err/allow",
    "it 50%",
    "it max",
    "ns 50%",
];

fn error(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), |e| format!("{e:.1e}"))
}

/// The smallest value that at least the fraction `p` of the values does not exceed.
pub fn quantile(values: &[f64], p: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let rank = (p * sorted.len() as f64).ceil() as usize;
    sorted.get(rank.saturating_sub(1)).copied()
}

/// A query as a reader says it.
#[must_use]
pub fn called(query: &str) -> String {
    query.replace('_', " ")
}

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

pub fn by_tag(records: &[Record]) -> BTreeMap<String, Group> {
    groups(records, |r| {
        let tags = if r.tags.is_empty() { vec!["untagged"] } else { r.tags.iter().map(String::as_str).collect() };
        tags.iter().map(|tag| format!("{}: {tag}", called(&r.query))).collect()
    })
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

/// Prints the summary.
pub fn print(records: &[Record], output: &mut impl Write) -> io::Result<()> {
    table(output, "file", &by_file(records))?;
    table(output, "query: tag", &by_tag(records))?;
    table(output, "query", &by_query(records))?;
    let bad: Vec<&Record> = records.iter().filter(|r| !r.verdict.wrong.is_empty()).collect();
    for record in bad.iter().take(TOLD) {
        let Record { file, id, tags, verdict, .. } = record;
        writeln!(output, "WRONG {file} {id} ({}): {}", tags.join(", "), verdict.wrong.join("; "))?;
    }
    if bad.len() > TOLD {
        writeln!(output, "… and {} more wrong; the report lists all", bad.len() - TOLD)?;
    }
    for record in records.iter().filter(|r| !r.verdict.soft.is_empty()).take(TOLD) {
        writeln!(output, "soft {} {}: {}", record.file, record.id, record.verdict.soft.join("; "))?;
    }
    let total = total(records);
    writeln!(
        output,
        "{} cases: {} right, {} wrong ({} of them errors where an answer was due), {} right with a remark",
        total.cases,
        total.cases - total.wrong,
        total.wrong,
        bad.iter().filter(|record| record.verdict.errored).count(),
        total.soft
    )
}

fn table(output: &mut impl Write, title: &str, groups: &BTreeMap<String, Group>) -> io::Result<()> {
    let width = groups.keys().map(|name| name.chars().count()).chain([title.len()]).max().unwrap_or(0);
    write!(output, "{title:width$}")?;
    for header in HEADERS {
        write!(output, " {header:>9}")?;
    }
    writeln!(output)?;
    for (name, group) in groups {
        write!(output, "{name:width$}")?;
        for column in group.columns() {
            write!(output, " {column:>9}")?;
        }
        writeln!(output)?;
    }
    writeln!(output)
}
