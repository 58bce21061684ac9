//! The sweep as a part of the report: random bodies at every size and distance, against references in thirty digits.

use std::collections::BTreeMap;

use xtask::validate::page::{Block, Row, Table, error};
use xtask::validate::stiff::Ordered;
use xtask::validate::{Scope, progress};

use crate::sweep::{self, Question};

/// The sweep of casts and distances: random bodies at every size and distance, against references in thirty digits.
pub(super) fn swept(scope: &Scope) -> Vec<Block> {
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

/// The columns of a sweep, and whether they say something of queries that are stopped early, at any distance: of those,
/// only the certificates count.
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
        "Random bodies of many kinds, aspects and sizes. Distances and errors are in sizes of the body, and the latter also in rounding errors \
         (ulps) of the distance. A cell is one shape at one size. False: hits that are sure misses, and misses that are sure hits."
    };
    let titles: Vec<&str> = SWEPT.iter().filter(|title| is_shown(title)).map(|(title, _)| *title).collect();
    Table::new(&format!("sweep-{}", what.replace(' ', "-")), caption, &titles, rows.collect())
}
