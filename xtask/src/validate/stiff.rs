//! Error against difficulty: condition, thickness, scale, distance, gap to contact, as far as the tags of cases say
//! them.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::io::{self, Write};

use super::needles::Needles;
use super::page::{Block, Row, Section, Table, error};
use super::score::called;
use super::{Record, score};
use crate::plot::{duration, raised};
use crate::table::{aligned, quantile};

/// The chapter: a row for every kind of difficulty, and folded one for each of its values.
#[must_use]
pub fn section(records: &[Record], needles: &Needles) -> Section {
    let groups = groups(records);
    let hard: Vec<&Record> = records.iter().filter(|r| r.tags.iter().any(|tag| difficulty(tag).is_some())).collect();
    let mut blocks: Vec<Block> = needles.table().map(Block::Table).into_iter().collect();
    if !groups.is_empty() {
        blocks.extend([kinds(&groups), values(&groups)].map(Block::Table));
    }
    Section {
        id: "stiff",
        title: "Stiff and extreme cases",
        lead: format!(
            "What happens to the answers where the numbers get hard: long and thin bodies, scenes that are tiny, huge \
             or far from the origin, bodies that nearly touch, rays that graze. What to see: {}. Where a relative \
             error is large, is the answer itself nearly zero, or would a change of the last digits of the inputs \
             change it as much? The ratio of error and tolerance takes both into account.",
            Tally::of(&hard).in_words()
        ),
        blocks,
    }
}

/// Prints a row for every kind of difficulty.
pub(super) fn print(records: &[Record], output: &mut impl Write) -> io::Result<()> {
    let table = kinds(&groups(records));
    let headers: Vec<&str> = table.headers.iter().map(String::as_str).collect();
    let rows: Vec<Vec<String>> = table.rows.into_iter().map(|row| row.cells).collect();
    if rows.is_empty() {
        return Ok(());
    }
    writeln!(output, "By kind of difficulty:")?;
    aligned(output, &headers, &rows, table.names)
}

/// Cases by query, precision, and kind and value of difficulty.
type Groups<'r> = BTreeMap<(&'r str, &'r str, &'r str, Ordered), Vec<&'r Record>>;

fn groups(records: &[Record]) -> Groups<'_> {
    let mut groups = Groups::new();
    for record in records {
        for (kind, value) in record.tags.iter().filter_map(|tag| difficulty(tag)) {
            let key = (record.query.as_str(), kind, record.precision, Ordered(value));
            groups.entry(key).or_default().push(record);
        }
    }
    groups
}

/// The columns of both tables that are not names.
const HEADERS: [&str; 7] =
    ["cases", "worst error", "error / tolerance", "wrong", "bounds that fail", "most iterations", "median time"];

/// A row for each kind of difficulty, those first whose errors come nearest to what is allowed.
fn kinds(groups: &Groups<'_>) -> Table {
    let mut kinds = BTreeMap::<(&str, &str, &str), (Vec<f64>, Vec<&Record>)>::new();
    for ((query, kind, precision, Ordered(value)), of) in groups {
        let (values, records) = kinds.entry((query, kind, precision)).or_default();
        values.push(*value);
        records.extend(of);
    }
    let mut kinds: Vec<_> = kinds.into_iter().collect();
    let worst = |of: &[&Record]| Ordered(of.iter().filter_map(|r| r.verdict.ratio).fold(0.0, f64::max));
    kinds.sort_by_key(|(_, (_, of))| std::cmp::Reverse(worst(of)));
    let rows = kinds.into_iter().map(|((query, kind, precision), (values, of))| {
        let [first, last] = [values.first(), values.last()].map(|value| value.map_or_else(String::new, |v| number(*v)));
        let span = if first == last { first } else { format!("{first} to {last}") };
        row([format!("{} {precision}", called(query)), difficulty_as_said(kind), span], &of)
    });
    let headers: Vec<&str> = ["question", "difficulty", "from, to"].into_iter().chain(HEADERS).collect();
    Table::new(
        "stiff",
        "By kind of difficulty, those first whose worst error comes nearest to its tolerance (below 1 is right). Errors are relative, those of \
         fitted ellipsoids to the volume.",
        &headers,
        rows.collect(),
    )
    .with_names(3)
}

/// A row for each value of each kind of difficulty.
fn values(groups: &Groups<'_>) -> Table {
    let rows = groups.iter().map(|((query, kind, precision, Ordered(value)), of)| {
        row([format!("{} {precision}", called(query)), difficulty_as_said(kind), number(*value)], of)
    });
    let headers: Vec<&str> = ["question", "difficulty", "value"].into_iter().chain(HEADERS).collect();
    Table::new("stiff-values", "The same for each value", &headers, rows.collect()).with_names(3).folded()
}

/// What is true of some cases.
struct Tally {
    cases: usize,
    wrong: usize,
    /// Answers whose bounds do not hold the truth.
    violations: usize,
    /// The worst error in units of what the inputs allow; NaN where none is known.
    of_tolerance: f64,
    iterations: Option<u64>,
}

impl Tally {
    fn of(records: &[&Record]) -> Self {
        Self {
            cases: records.len(),
            wrong: records.iter().filter(|r| !r.verdict.wrong.is_empty()).count(),
            violations: records.iter().filter(|r| r.verdict.violates_certificate()).count(),
            of_tolerance: worst(records, |v| v.ratio),
            iterations: records.iter().filter_map(|r| r.iterations).max(),
        }
    }

    fn iterations(&self) -> String {
        self.iterations.map_or_else(|| "–".to_owned(), |i| i.to_string())
    }

    fn in_words(&self) -> String {
        let count = |number: usize| if number == 0 { "none".to_owned() } else { number.to_string() };
        format!(
            "of {} answers {} {} wrong, and of {} the bounds fail to hold the truth; the worst error is {} of what the \
             inputs allow, and the most iterations are {}",
            self.cases,
            count(self.wrong),
            if self.wrong > 1 { "are" } else { "is" },
            count(self.violations),
            error(self.of_tolerance),
            self.iterations()
        )
    }
}

/// The largest of a number that verdicts have; NaN where none has it.
fn worst(records: &[&Record], of_verdict: fn(&score::Verdict) -> Option<f64>) -> f64 {
    records.iter().filter_map(|r| of_verdict(&r.verdict)).fold(f64::NAN, f64::max)
}

/// The names of a row, and what is true of its cases.
fn row(names: [String; 3], of: &[&Record]) -> Row {
    let tally = Tally::of(of);
    let times: Vec<f64> = of.iter().filter_map(|r| r.time).collect();
    let numbers = [
        tally.cases.to_string(),
        error(worst(of, |v| v.relative)),
        error(tally.of_tolerance),
        tally.wrong.to_string(),
        tally.violations.to_string(),
        tally.iterations(),
        quantile(&times, 0.5).map_or_else(|| "–".to_owned(), duration),
    ];
    Row::of(names.into_iter().chain(numbers)).bad_if(tally.wrong + tally.violations > 0)
}

/// Powers of two are scales; all else is told as it is.
fn number(value: f64) -> String {
    match value.log2() {
        two if two.fract() == 0.0 && two.abs() >= 10.0 => format!("2{}", raised(two as i32)),
        _ if (0.1..1000.0).contains(&value) => value.to_string(),
        _ => format!("{value:e}"),
    }
}

/// A kind of difficulty as a reader says it.
#[must_use]
pub fn difficulty_as_said(kind: &str) -> String {
    match kind {
        "aspect" => "length over width",
        "cond" => "condition number",
        "by" => "misses by",
        "scale" => "scale of the scene",
        "gap" => "gap to contact",
        "grazing" => "depth of the graze",
        "far" => "distance of source or body",
        "offset" => "distance from the origin",
        "near-goal" => "distance from the goal",
        "near-start" => "distance from the start",
        "ratio" => "ratio of the sizes",
        "thick" | "thickness" => "thickness over width",
        other => other,
    }
    .to_owned()
}

/// A number that can be sorted by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ordered(pub f64);

impl Eq for Ordered {}

impl PartialOrd for Ordered {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ordered {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

/// The kind and value of a tag that ends in a positive number with a kind before it, such as `cond1e+06` or
/// `scale2^-30`.
#[must_use]
pub fn difficulty(tag: &str) -> Option<(&str, f64)> {
    let at = tag.find(|c: char| c.is_ascii_digit())?;
    let (kind, number) = tag.split_at(at);
    let kind = kind.trim_end_matches(['-', '^']);
    let value = match number.split_once('^') {
        Some((base, exponent)) => base.parse::<f64>().ok()?.powi(exponent.parse().ok()?),
        None => number.parse().ok()?,
    };
    // Dimensions, counts and steps of a motion are no difficulties, nor is the name of a scene, such as `shelf_ur5`.
    (kind.len() > 1 && value > 0.0 && kind != "nesting" && !kind.contains('_')).then_some((kind, value))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The chapter said that no answer is wrong and no bound fails, whatever the run had found.
    #[test]
    fn what_is_said_of_a_run_is_counted() {
        let record = |wrong: &[&str], soft: &[&str], ratio| Record {
            file: "suite".to_owned(),
            id: String::new(),
            query: "distance".to_owned(),
            precision: "f64",
            tags: vec!["gap1e-6".to_owned()],
            verdict: score::Verdict {
                wrong: wrong.iter().map(|&why| why.to_owned()).collect(),
                soft: soft.iter().map(|&why| why.to_owned()).collect(),
                ratio: Some(ratio),
                ..score::Verdict::default()
            },
            time: None,
            iterations: Some(7),
        };
        let said = |records: &[Record]| section(records, &Needles::default()).lead;
        let right = said(&[record(&[], &[], 0.25)]);
        assert!(right.contains("of 1 answers none is wrong, and of none the bounds fail"), "{right}");
        assert!(right.contains("2.5e-1 of what the inputs allow, and the most iterations are 7"), "{right}");
        let bad = [record(&["off"], &[], 30.0), record(&["off"], &["bracket"], 2.0), record(&[], &[], 0.1)];
        let bad = said(&bad);
        assert!(bad.contains("of 3 answers 2 are wrong, and of 1 the bounds fail"), "{bad}");
    }

    #[test]
    fn difficulties_are_told_from_other_tags() {
        assert_eq!(difficulty("cond1e+06"), Some(("cond", 1e6)), "a condition");
        assert_eq!(difficulty("thickness1e-05"), Some(("thickness", 1e-5)), "a thickness");
        assert_eq!(difficulty("scale2^-30"), Some(("scale", 2f64.powi(-30))), "a scale");
        assert_eq!(difficulty("n4"), None, "a dimension");
        assert_eq!(difficulty("3d"), None, "a dimension");
        assert_eq!(difficulty("easy"), None, "no number at all");
        assert_eq!(difficulty("bookshelf_small_ur5"), None, "the name of a scene, which ends in a digit");
    }
}
