//! Error against difficulty: condition, thickness, scale, distance, gap to contact, as far as the tags of cases say them.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use super::page::{Block, Row, Section, Table, error};
use super::summary::{called, quantile};
use super::{Record, score};
use crate::plot::duration;

/// The chapter: a table of every kind and value of difficulty.
#[must_use]
pub fn section(records: &[Record]) -> Section {
    let table = table(records);
    let blocks = if table.rows.is_empty() { Vec::new() } else { vec![Block::Table(table)] };
    Section {
        id: "stiff",
        title: "Stiff and extreme cases",
        lead: "Aspect, scale, offset, condition, gap to contact, grazing: what happens to the answers where the numbers get hard. What to \
               see: worst errors stay below what the inputs allow (err/allow below 1) and do not grow with the difficulty, \
               nothing is wrong, no certificate is violated, and iterations stay few. Where a relative error is large, the \
               answer itself is nearly zero, or a change of the last digits of the inputs changes it as much."
            .to_owned(),
        blocks,
    }
}

/// For each query, precision, and kind and value of difficulty: how many, how right, how many iterations, how long.
fn table(records: &[Record]) -> Table {
    let mut groups = BTreeMap::<(&str, String, Ordered, &str), Vec<&Record>>::new();
    for record in records {
        for (kind, value) in record.tags.iter().filter_map(|tag| difficulty(tag)) {
            let key = (record.query.as_str(), kind.to_owned(), Ordered(value), record.precision);
            groups.entry(key).or_default().push(record);
        }
    }
    let rows = groups.into_iter().map(|((query, kind, Ordered(value), precision), of)| {
        let worst = |of_verdict: fn(&score::Verdict) -> Option<f64>| {
            of.iter().filter_map(|r| of_verdict(&r.verdict)).fold(f64::NAN, f64::max)
        };
        let wrong = of.iter().filter(|r| !r.verdict.wrong.is_empty()).count();
        let violations = of.iter().filter(|r| r.verdict.violates_certificate()).count();
        let times: Vec<f64> = of.iter().filter_map(|r| r.time).collect();
        let iterations = of.iter().filter_map(|r| r.iterations).max();
        Row::of([
            called(query),
            difficulty_as_said(&kind),
            // Powers of two are scales; all else is told as it is.
            match value.log2() {
                two if two.fract() == 0.0 && two.abs() > 20.0 => format!("2^{two}"),
                _ if value == 1.0 => "1".to_owned(),
                _ => format!("{value:e}"),
            },
            precision.to_owned(),
            of.len().to_string(),
            error(worst(|v| v.relative)),
            error(worst(|v| v.ratio)),
            wrong.to_string(),
            violations.to_string(),
            iterations.map_or_else(|| "–".to_owned(), |i| i.to_string()),
            quantile(&times, 0.5).map_or_else(|| "–".to_owned(), duration),
        ])
        .bad_if(wrong + violations > 0)
    });
    Table::new(
        "stiff",
        "Worst error: relative; of ellipsoids, that of the volume. Violations: certificates (brackets, gaps) that do not hold the truth.",
        &[
            "query",
            "difficulty",
            "value",
            "precision",
            "cases",
            "worst error",
            "err/allow",
            "wrong",
            "violations",
            "iterations, most",
            "median time",
        ],
        rows.collect(),
    )
}

/// A kind of difficulty as a reader says it.
fn difficulty_as_said(kind: &str) -> String {
    match kind {
        "cond" => "condition",
        "by" => "passes at",
        "scale" => "scale of the scene",
        "gap" => "gap to contact",
        "offset" | "far" => "distance from the origin",
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

/// The kind and value of a tag that ends in a positive number with a kind before it, such as `cond1e+06` or `scale2^-30`.
#[must_use]
pub fn difficulty(tag: &str) -> Option<(&str, f64)> {
    let at = tag.find(|c: char| c.is_ascii_digit())?;
    let (kind, number) = tag.split_at(at);
    let kind = kind.trim_end_matches(['-', '^']);
    let value = match number.split_once('^') {
        Some((base, exponent)) => base.parse::<f64>().ok()?.powi(exponent.parse().ok()?),
        None => number.parse().ok()?,
    };
    // Dimensions, counts and steps of a motion are no difficulties.
    (kind.len() > 1 && value > 0.0 && kind != "nesting" && kind != "f").then_some((kind, value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn difficulties_are_told_from_other_tags() {
        assert_eq!(difficulty("cond1e+06"), Some(("cond", 1e6)), "a condition");
        assert_eq!(difficulty("thickness1e-05"), Some(("thickness", 1e-5)), "a thickness");
        assert_eq!(difficulty("scale2^-30"), Some(("scale", 2f64.powi(-30))), "a scale");
        assert_eq!(difficulty("n4"), None, "a dimension");
        assert_eq!(difficulty("3d"), None, "a dimension");
        assert_eq!(difficulty("easy"), None, "no number at all");
    }
}
