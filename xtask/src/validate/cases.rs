//! Every case: error against time as dots, and counts by query and file.

use std::collections::BTreeMap;

use super::Record;
use super::page::{Block, Figure, Row, Section, Table, error};
use super::score::called;
use super::summary::{Group, HEADERS, by_file, by_query};
use crate::plot::{Plot, Scale, Series};
use crate::table::quantile;

/// Errors below this are drawn here: it is less than half an ulp.
const FLOOR: f64 = 1e-17;

/// The chapter.
pub fn section(records: &[Record]) -> Section {
    let mut blocks: Vec<Block> =
        ["f64", "f32"].into_iter().filter_map(|p| scatter(records, p)).map(Block::Figure).collect();
    let groups = [
        (
            "cases-by-query",
            "By question and precision, those first whose worst error comes nearest to its tolerance. Errors are relative, steps iterations.",
            "question",
            by_query(records),
        ),
        ("cases-by-file", "By file of xtask/data/suite, sorted in the same way.", "file", by_file(records)),
    ];
    blocks.extend(
        groups.into_iter().map(|(name, caption, title, groups)| Block::Table(table(name, caption, title, &groups))),
    );
    Section {
        id: "cases",
        title: "Every case",
        lead: "Each case has a known answer, and a tolerance that its inputs allow: 1e-7 (in f32 1e-4) of the answer, and twice \
               what a change of the inputs by 1000 (in f32 16) rounding errors does to the truth. An answer is wrong if its error exceeds the tolerance, if hit \
               or miss, overlap or gap is the wrong way round, or if an error came in place of an answer. The column \"error / tolerance\" has the worst \
               ratio: below 1 is right. A secondary error is one of a right answer: of a normal, a point, a gradient or a bound beside it. Errors are \
               relative to the answer, those of ellipsoids to the volume."
            .to_owned(),
        blocks,
    }
}

/// The queries that have a scalar, in the order of their colours.
const QUERIES: [&str; 13] = [
    "ray_cast",
    "linear_cast",
    "distance",
    "margin",
    "enclosing_ellipsoid",
    "inscribed_ellipsoid",
    "track",
    "clearance",
    "signed_distance",
    "motion_cast",
    "ray_exit",
    "path",
    "growth_distance",
];

/// Relative error against time, a colour for each query.
fn scatter(records: &[Record], precision: &str) -> Option<Figure> {
    let series = |(colour, query): (usize, &&str)| {
        let of_query = records.iter().filter(|r| r.precision == precision && r.query == **query);
        let points: Vec<[f64; 2]> = of_query.filter_map(|r| Some([r.time?, r.verdict.relative?.min(1.0)])).collect();
        (!points.is_empty()).then(|| Series { name: called(query), points, joined: false, colour })
    };
    let series: Vec<Series> = QUERIES.iter().enumerate().filter_map(series).collect();
    let errors: Vec<f64> = series.iter().flat_map(|series| series.points.iter().map(|[_, error]| *error)).collect();
    let at_most = |share| error(quantile(&errors, share).unwrap_or(f64::NAN));
    (!series.is_empty()).then(|| Figure {
        name: format!("cases-{precision}"),
        plot: Plot {
            title: format!("Each case in {precision}"),
            x: "time per query".to_owned(),
            y: "relative error".to_owned(),
            scales: [Scale::Time, Scale::Log],
            floor: FLOOR,
            series,
        },
        caption: format!(
            "One dot per case, in {precision}; exact answers lie on the lowest line. What to see: half of the errors \
             are at most {}, and nine in ten at most {}. Where the answer itself is nearly zero (bodies that almost \
             touch, rays that start on a surface), a large relative error can be the best that the inputs allow: the \
             tables compare each error with that.",
            at_most(0.5),
            at_most(0.9),
        ),
    })
}

fn table(name: &str, caption: &str, title: &str, groups: &BTreeMap<String, Group>) -> Table {
    let headers: Vec<&str> = [title].into_iter().chain(HEADERS).collect();
    let mut groups: Vec<_> = groups.iter().collect();
    // Those without an error come last.
    let worst = |group: &Group| group.worst_of_tolerance().unwrap_or(-1.0);
    groups.sort_by(|(_, a), (_, b)| worst(b).total_cmp(&worst(a)));
    let rows = groups
        .into_iter()
        .map(|(name, group)| Row::of([name.clone()].into_iter().chain(group.columns())).bad_if(group.wrong > 0))
        .collect();
    Table::new(name, caption, &headers, rows)
}
