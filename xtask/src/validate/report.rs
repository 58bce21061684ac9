//! The report: one page without network, and the numbers beside it as CSV.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::provenance::provenance;
use super::summary::{Group, HEADERS, by_file, by_query, by_tag, total};
use super::{Figure, Record};
use crate::plot::{Plot, Scale, Series, escape};

const STYLE: &str = "
:root { color-scheme: light dark }
body { font: 15px/1.5 system-ui, sans-serif; max-width: 66rem; margin: 2rem auto; padding: 0 1rem }
table { border-collapse: collapse; margin: 1rem 0; font-variant-numeric: tabular-nums }
th, td { padding: .15rem .6rem; text-align: right; border-bottom: 1px solid color-mix(in srgb, currentColor 20%, transparent) }
th:first-child, td:first-child { text-align: left }
.wrong { color: #c03030; font-weight: 600 }
svg { width: 100%; height: auto; max-width: 56rem; display: block; margin: 1.5rem 0 }
figcaption { max-width: 46rem }
";

/// Errors below this are drawn here: it is less than half an ulp.
const FLOOR: f64 = 1e-17;

/// Writes the report into `folder` and says where its page is.
pub(super) fn write(records: &[Record], figures: &[Figure], folder: &Path) -> io::Result<PathBuf> {
    fs::create_dir_all(folder)?;
    fs::write(folder.join("cases.csv"), cases(records))?;
    for figure in figures {
        fs::write(folder.join(format!("{}.csv", figure.name)), points(figure))?;
    }
    let page = folder.join("index.html");
    fs::write(&page, html(records, figures))?;
    Ok(page)
}

/// The points of a figure.
fn points(figure: &Figure) -> String {
    let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    let mut csv = format!("series,{},{}\n", quoted(&figure.plot.x), quoted(&figure.plot.y));
    for series in &figure.plot.series {
        for [x, y] in &series.points {
            let _ = writeln!(csv, "{},{x:e},{y:e}", quoted(&series.name));
        }
    }
    csv
}

/// Every case in a line.
fn cases(records: &[Record]) -> String {
    let mut csv =
        String::from("file,id,query,precision,tags,wrong,soft,error,relative_error,error_over_allow,iterations,ns\n");
    let number = |value: Option<f64>| value.map_or_else(String::new, |v| format!("{v:e}"));
    let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    for r in records {
        let v = &r.verdict;
        let _ = writeln!(
            csv,
            "{},{},{},{},{},{},{},{},{},{},{},{}",
            quoted(&r.file),
            quoted(&r.id),
            quoted(&r.query),
            r.precision,
            quoted(&r.tags.join(" ")),
            quoted(&v.wrong.join("; ")),
            quoted(&v.soft.join("; ")),
            number(v.error),
            number(v.relative),
            number(v.ratio),
            r.iterations.map_or_else(String::new, |i| i.to_string()),
            r.time.map_or_else(String::new, |ns| format!("{ns:.1}"))
        );
    }
    csv
}

fn html(records: &[Record], figures: &[Figure]) -> String {
    let total = total(records);
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>Error against run time</title>\n\
         <style>{STYLE}</style>\n<h1>Error against run time</h1>\n\
         <p>{} cases with true answers known in exact arithmetic or to many digits: {} right, \
         <span class=\"{}\">{} wrong</span>, {} right with a remark. Release build, one thread; the time is that of solving \
         the query once its shapes are built.</p>\n",
        total.cases,
        total.cases - total.wrong,
        if total.wrong > 0 { "wrong" } else { "right" },
        total.wrong,
        total.soft
    );
    let _ = writeln!(page, "<p>{}</p>", escape(&provenance()));
    page.push_str(&scatter(records));
    for Figure { name, plot, caption } in figures {
        let _ = writeln!(
            page,
            "<figure id=\"{name}\">{}<figcaption>{} <a href=\"{name}.csv\">{name}.csv</a></figcaption></figure>",
            plot.svg(),
            escape(caption)
        );
    }
    page.push_str("<h2>By query</h2>\n");
    page.push_str(&table("query", &by_query(records)));
    page.push_str("<h2>By file</h2>\n");
    page.push_str(&table("file", &by_file(records)));
    page.push_str("<h2>By tag</h2>\n");
    page.push_str(&table("query: tag", &by_tag(records)));
    page.push_str(&list("Wrong", records, |r| &r.verdict.wrong));
    page.push_str(&list("Right with a remark", records, |r| &r.verdict.soft));
    page.push_str("<p>The numbers of every case: <a href=\"cases.csv\">cases.csv</a>.</p>\n</html>\n");
    page
}

/// The queries that have a scalar, in the order of their colours.
const QUERIES: [&str; 8] = [
    "ray_cast",
    "linear_cast",
    "distance",
    "margin",
    "enclosing_ellipsoid",
    "inscribed_ellipsoid",
    "track",
    "clearance",
];

/// The error that is plotted: relative, but for the logarithm of a volume its own, which is relative already.
fn plotted(record: &Record) -> Option<f64> {
    if record.query.ends_with("_ellipsoid") { record.verdict.error } else { record.verdict.relative }
}

/// Relative error against time, a colour for each query.
fn scatter(records: &[Record]) -> String {
    ["f64", "f32"]
        .into_iter()
        .map(|precision| {
            let series = |(colour, query): (usize, &&str)| {
                let of_query = records.iter().filter(|r| r.precision == precision && r.query == **query);
                let points: Vec<[f64; 2]> = of_query.filter_map(|r| Some([r.time?, plotted(r)?.min(1.0)])).collect();
                (!points.is_empty()).then(|| Series { name: (*query).to_owned(), points, joined: false, colour })
            };
            let plot = Plot {
                title: format!("Relative error of the scalar against time per query, {precision}"),
                x: "nanoseconds".to_owned(),
                y: "relative error; of a log-volume, absolute".to_owned(),
                scales: [Scale::Log, Scale::Log],
                floor: FLOOR,
                series: QUERIES.iter().enumerate().filter_map(series).collect(),
            };
            format!(
                "<figure>{}<figcaption>One dot per case, in {precision}; exact answers lie at the lower edge. A large \
                 relative error of an answer near zero (bodies that almost touch, rays that start on a surface) can be as \
                 good as the inputs allow: the tables compare each error with what its inputs allow.</figcaption></figure>\n",
                plot.svg()
            )
        })
        .collect()
}

fn table(title: &str, groups: &BTreeMap<String, Group>) -> String {
    let mut html = format!("<table>\n<tr><th>{title}");
    for header in HEADERS {
        let _ = write!(html, "<th>{header}");
    }
    html.push('\n');
    for (name, group) in groups {
        let class = if group.wrong > 0 { " class=\"wrong\"" } else { "" };
        let _ = write!(html, "<tr{class}><td>{}", escape(name));
        for column in group.columns() {
            let _ = write!(html, "<td>{column}");
        }
        html.push('\n');
    }
    html.push_str("</table>\n");
    html
}

fn list<'r>(title: &str, records: &'r [Record], why: impl Fn(&'r Record) -> &'r Vec<String>) -> String {
    let items: String = records
        .iter()
        .filter(|r| !why(r).is_empty())
        .map(|r| format!("<li>{} {}: {}\n", escape(&r.file), escape(&r.id), escape(&why(r).join("; "))))
        .collect();
    if items.is_empty() { String::new() } else { format!("<h2>{title}</h2>\n<ul>\n{items}</ul>\n") }
}
