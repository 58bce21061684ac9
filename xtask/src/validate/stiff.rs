//! Error against difficulty: condition, thickness, scale, distance, gap to contact, as far as the tags of cases say them.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use serde_json::Value;

use super::page::{Row, Table, error};
use super::summary::quantile;
use super::{Block, Case, Figure, Record, Scope, Section, as_read, progress, score};
use crate::engine;
use crate::plot::{Plot, Scale, Series, duration};
use crate::sweep::{self, Question};
use crate::wire::answer::Line;

/// Methods beside the default that are shown for comparison.
const COMPARED: &[(&str, &str)] = &[("margin", "eigen"), ("ray_cast", "iterative")];

/// What the inputs allow.
const ALLOWED: &str = "what the inputs allow";

/// Fewer values than this make no figure.
const FEWEST_VALUES: usize = 3;

/// For each value of a difficulty, the worst of what was measured there.
type Worst = BTreeMap<u64, f64>;

/// The chapter: a table of every kind and value of difficulty, and figures of those with enough cases.
pub(super) fn section(scope: &Scope, records: &[Record], cases: &[Case]) -> Section {
    let mut blocks: Vec<Block> = figures(cases).into_iter().map(Block::Figure).collect();
    if !scope.quick {
        blocks.extend(swept(scope));
    }
    let table = table(records);
    if !table.rows.is_empty() {
        blocks.push(Block::Table(table));
    }
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

/// The sweep of casts and distances: random bodies at every size and distance, against references in thirty digits.
fn swept(scope: &Scope) -> Vec<Block> {
    let questions = [
        (Question::Ray, "ray_cast", "ray casts", "the source ever farther away"),
        (Question::Linear, "linear_cast", "linear casts", "the start ever farther away"),
        (Question::Distance, "distance", "distances", "the gap ever wider"),
        (Question::Certificates, "intersect", "certificates", "of queries of every kind, half of them stopped early"),
    ];
    let mut blocks = Vec::new();
    for (question, _, what, how) in questions.into_iter().filter(|(_, query, ..)| scope.holds(query)) {
        let cells =
            sweep::rows(&sweep::Scope::quick(question), |row| progress(&format!("sweep of {what}: {}", row.subject)));
        blocks.push(Block::Heading(format!("Swept: {what}, {how}")));
        blocks.push(Block::Table(swept_table(question, what, cells)));
    }
    if !blocks.is_empty() {
        blocks.push(Block::Heading("Cases by kind and value of difficulty".to_owned()));
    }
    blocks
}

/// The columns of a sweep, and whether they say something of queries that are stopped early, at any distance: of those, only
/// the certificates count.
const SWEPT: [(&str, bool); 12] = [
    ("distance", false),
    ("precision", true),
    ("cells", true),
    ("queries", true),
    ("worst error", false),
    ("in ulps", false),
    ("false", false),
    ("undecided", true),
    ("violations", true),
    ("iterations, mean", true),
    ("most", true),
    ("wrong cells", true),
];

/// All sizes and subjects together: neither makes a difference, which the task `sweep` shows one by one.
fn swept_table(question: Question, what: &str, cells: Vec<sweep::Row>) -> Table {
    let mut by_distance = BTreeMap::<(Ordered, &str), Vec<sweep::Row>>::new();
    for cell in cells {
        let precision = if cell.is_single { "f32" } else { "f64" };
        by_distance.entry((Ordered(cell.distance), precision)).or_default().push(cell);
    }
    let stopped = question == Question::Certificates;
    let is_shown = |&(_, of_stopped): &(&str, bool)| of_stopped || !stopped;
    let rows = by_distance.into_iter().map(|((Ordered(distance), precision), of)| {
        let sum = |count: fn(&sweep::Row) -> u64| of.iter().map(count).sum::<u64>();
        let most = |value: fn(&sweep::Row) -> f64| of.iter().map(value).fold(0.0, f64::max);
        let wrong = of.iter().filter(|cell| !cell.is_right()).count();
        let columns = [
            format!("{distance:e}"),
            precision.to_owned(),
            of.len().to_string(),
            sum(|c| c.queries).to_string(),
            error(most(|c| c.worst)),
            format!("{:.1}", most(sweep::Row::ulps)),
            sum(|c| c.false_hits + c.missed).to_string(),
            sum(|c| c.undecided).to_string(),
            sum(|c| c.violations).to_string(),
            format!("{:.1}", sum(|c| c.iterations) as f64 / sum(|c| c.queries).max(1) as f64),
            of.iter().map(|c| c.most_iterations).max().unwrap_or(0).to_string(),
            wrong.to_string(),
        ];
        let shown = columns.into_iter().zip(&SWEPT).filter(|(_, title)| is_shown(title));
        Row::of(shown.map(|(column, _)| column)).bad_if(wrong > 0)
    });
    let caption = if stopped {
        "Random bodies of many kinds, aspects, sizes and distances. A query that is stopped early may be undecided, but a bound \
         that it gives must hold: violations are bounds that do not."
    } else {
        "Random bodies of many kinds, aspects and sizes; distances and errors in sizes of the body, and in rounding errors of the \
         distance. False: hits that are sure misses, and misses that are sure hits."
    };
    let titles: Vec<&str> = SWEPT.iter().filter(|title| is_shown(title)).map(|(title, _)| *title).collect();
    Table::new(&format!("sweep-{}", what.replace(' ', "-")), caption, &titles, rows.collect())
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
            query.to_owned(),
            kind,
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

/// A number that can be sorted by.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ordered(f64);

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

/// One figure for each query and kind of difficulty.
fn figures(cases: &[Case]) -> Vec<Figure> {
    // By query and kind of difficulty, then by method.
    let mut found = BTreeMap::<(String, String), BTreeMap<String, Worst>>::new();
    for (i, case) in cases.iter().enumerate() {
        if i % 64 == 0 {
            progress(&format!("stiff and extreme cases: {i} of {}", cases.len()));
        }
        let text = |name: &str| case.object.get(name).and_then(Value::as_str);
        let Some(query) = text("query") else { continue };
        if text("precision") == Some("f32") || text("method").is_some() {
            continue;
        }
        let tags = case.object.get("tags").and_then(Value::as_array).into_iter().flatten();
        let difficulties: Vec<(&str, f64)> = tags.filter_map(Value::as_str).filter_map(difficulty).collect();
        if difficulties.is_empty() {
            continue;
        }
        let methods = COMPARED.iter().filter(|(of, _)| *of == query).map(|(_, method)| Some(*method));
        for method in [None].into_iter().chain(methods) {
            let Some((error, allowed)) = measure(case, method) else { continue };
            for (kind, value) in &difficulties {
                let figure = found.entry((query.to_owned(), (*kind).to_owned())).or_default();
                let mut note = |name: &str, error: f64| {
                    let worst = figure.entry(name.to_owned()).or_default().entry(value.to_bits()).or_insert(0.0);
                    *worst = worst.max(error);
                };
                note(method.unwrap_or("ours"), error);
                note(ALLOWED, allowed);
            }
        }
    }
    found.into_iter().filter_map(|((query, kind), methods)| figure(&query, &kind, methods)).collect()
}

fn figure(query: &str, kind: &str, methods: BTreeMap<String, Worst>) -> Option<Figure> {
    // Scaling changes nothing, which a table shows better.
    if kind == "scale" || methods.values().map(BTreeMap::len).max()? < FEWEST_VALUES {
        return None;
    }
    let series = methods.into_iter().map(|(name, worst)| {
        let colour = match name.as_str() {
            "ours" => 0,
            ALLOWED => 7,
            _ => 1,
        };
        let mut points: Vec<[f64; 2]> = worst.into_iter().map(|(bits, error)| [f64::from_bits(bits), error]).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Series { name, points, joined: true, colour }
    });
    Some(Figure {
        name: format!("stiff-{query}-{kind}"),
        plot: Plot {
            title: format!("{query}: worst error against {kind}"),
            x: match kind {
                "cond" => "condition of the matrices",
                "gap" => "gap to contact / size",
                "thickness" => "thickness / size",
                "scale" => "scale",
                other => other,
            }
            .to_owned(),
            y: "worst error".to_owned(),
            scales: [Scale::Log, Scale::Log],
            floor: 1e-17,
            series: series.collect(),
        },
        caption: "What to see: ours stays under the line of what the inputs allow. The worst error among the cases of each value, in f64: relative; of ellipsoids, that of the volume. What is allowed \
                  is 1e-7 and twice what a change of the inputs by 1000 ulps does to the truth."
            .to_owned(),
    })
}

/// The kind and value of a tag that ends in a positive number with a kind before it, such as `cond1e+06` or `scale2^-30`.
fn difficulty(tag: &str) -> Option<(&str, f64)> {
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

/// The error of a case and what is allowed, both in the unit of the figure.
fn measure(case: &Case, method: Option<&str>) -> Option<(f64, f64)> {
    let mut object = case.object.clone();
    if let Some(method) = method {
        object.insert("method".to_owned(), Value::from(method));
    }
    let answer = engine::question(&object, &case.meshes).ok()?.ask().ok()?;
    let answer = as_read(Line { id: Value::Null, line: 0, outcome: Ok(answer) });
    let verdict = score::judge(&object, &answer);
    let query = object.get("query").and_then(Value::as_str)?;
    let relative = verdict.relative?;
    let allowed = match verdict.ratio {
        Some(ratio) if ratio > 0.0 => relative / ratio,
        // An exact answer has no error to divide.
        _ => {
            let allow = object.get("allow").and_then(Value::as_f64)?;
            match score::scalar_of(query)? {
                "log_det" => allow,
                scalar => allow / object.get("expect")?.get(scalar)?.as_f64()?.abs(),
            }
        }
    };
    Some((relative, allowed))
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
