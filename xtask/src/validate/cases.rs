//! Every case: error against time as dots, and counts by query, file and tag.

use std::collections::BTreeMap;

use super::Record;
use super::page::{Block, Figure, Row, Section, Table};
use super::summary::{Group, HEADERS, by_file, by_query, by_tag, called};
use crate::plot::{Plot, Scale, Series};

/// Errors below this are drawn here: it is less than half an ulp.
const FLOOR: f64 = 1e-17;

/// The chapter.
pub fn section(records: &[Record]) -> Section {
    let mut blocks: Vec<Block> =
        ["f64", "f32"].into_iter().filter_map(|p| scatter(records, p)).map(Block::Figure).collect();
    let groups = [
        ("cases-by-query", "By query and precision.", "query", by_query(records)),
        ("cases-by-file", "By file.", "file", by_file(records)),
        ("cases-by-tag", "By query and tag.", "query: tag", by_tag(records)),
    ];
    blocks.extend(groups.into_iter().map(|(name, caption, title, groups)| {
        let table = table(name, caption, title, &groups);
        Block::Table(if groups.len() > 30 { table.folded() } else { table })
    }));
    Section {
        id: "cases",
        title: "Every case",
        lead: "Each case has a true answer and says what error its inputs allow: 1e-7 (in f32 1e-4) of the answer, and twice \
               what a change of the inputs by 1000 (in f32 16) ulps does to the truth. The column err/allow is the worst \
               error in that unit, rel the relative error (of ellipsoids, that of the volume); an answer is wrong where it exceeds 1, where a flag is, or where an error came in place of \
               an answer. A case is soft, right with a remark, where a normal, a witness or a certificate is off."
            .to_owned(),
        blocks,
    }
}

/// The queries that have a scalar, in the order of their colours.
const QUERIES: [&str; 10] = [
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
];

/// Relative error against time, a colour for each query.
fn scatter(records: &[Record], precision: &str) -> Option<Figure> {
    let series = |(colour, query): (usize, &&str)| {
        let of_query = records.iter().filter(|r| r.precision == precision && r.query == **query);
        let points: Vec<[f64; 2]> = of_query.filter_map(|r| Some([r.time?, r.verdict.relative?.min(1.0)])).collect();
        (!points.is_empty()).then(|| Series { name: called(query), points, joined: false, colour })
    };
    let series: Vec<Series> = QUERIES.iter().enumerate().filter_map(series).collect();
    (!series.is_empty()).then(|| Figure {
        name: format!("cases-{precision}"),
        plot: Plot {
            title: format!("Each case in {precision}"),
            x: "time per query".to_owned(),
            y: "relative error; of ellipsoids, that of the volume".to_owned(),
            scales: [Scale::Time, Scale::Log],
            floor: FLOOR,
            series,
        },
        caption: format!(
            "One dot per case, in {precision}; exact answers lie on the lowest line. What to see: nearly everything is at the level of \
             rounding. A large relative error of an answer near zero (bodies that almost touch, rays that start on a \
             surface) can be as good as the inputs allow: the tables compare each error with what its inputs allow."
        ),
    })
}

fn table(name: &str, caption: &str, title: &str, groups: &BTreeMap<String, Group>) -> Table {
    let headers: Vec<&str> = [title].into_iter().chain(HEADERS).collect();
    let rows = groups
        .iter()
        .map(|(name, group)| Row::of([name.clone()].into_iter().chain(group.columns())).bad_if(group.wrong > 0))
        .collect();
    Table::new(name, caption, &headers, rows)
}
