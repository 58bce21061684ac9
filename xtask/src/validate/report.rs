//! The report: one page without network, and the numbers beside it as CSV.

use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::Record;
use super::headline::Headline;
use super::page::{Section, prose, quoted};
use super::score::called;
use super::summary::total;
use crate::plot::escape;
use workloads::provenance::provenance;

const STYLE: &str = include_str!("report.css");

/// Writes the report into `folder` and says where its page is.
pub(super) fn write(
    records: &[Record],
    first: Option<&Headline>,
    sections: &[Section],
    folder: &Path,
) -> io::Result<PathBuf> {
    fs::create_dir_all(folder)?;
    fs::write(folder.join("cases.csv"), cases(records))?;
    if let Some(Headline { drawing, .. }) = first {
        fs::write(folder.join(format!("{}.csv", drawing.name)), drawing.csv())?;
    }
    for (name, text) in sections.iter().flat_map(Section::files) {
        fs::write(folder.join(name), text)?;
    }
    let page = folder.join("index.html");
    fs::write(&page, html(records, first, sections))?;
    Ok(page)
}

/// A word of warning where the machine does more than this; none where that cannot be told.
fn busy() -> String {
    let threads = std::thread::available_parallelism().map_or(1.0, |n| n.get() as f64);
    let load = fs::read_to_string("/proc/loadavg").ok();
    let load = load.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok()).unwrap_or(0.0);
    // Of itself this program has a load of one, and where it compiles or answers on all cores as many as they are.
    if load > threads + 0.5 {
        format!(", a load of {load:.0}: the machine was busy, and times are longer than they need be")
    } else {
        String::new()
    }
}

/// Every case in a line.
fn cases(records: &[Record]) -> String {
    let mut csv =
        String::from("file,id,query,precision,tags,wrong,soft,error,relative_error,error_over_allow,iterations,ns\n");
    let number = |value: Option<f64>| value.map_or_else(String::new, |v| format!("{v:e}"));
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

fn html(records: &[Record], first: Option<&Headline>, sections: &[Section]) -> String {
    let total = total(records);
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Error against run time</title>\n\
         <style>{STYLE}</style>\n<header><h1>Error against run time</h1>\n\
         <p class=\"summary\">{} questions with known answers: {} answered rightly, <b class=\"{}\">{} wrongly</b>{}.</p>\n",
        total.cases,
        total.cases - total.wrong,
        if total.wrong > 0 { "wrong" } else { "right" },
        total.wrong,
        if total.soft > 0 {
            format!(", <a href=\"#secondary\">{} with a secondary error</a>", total.soft)
        } else {
            String::new()
        },
    );
    if let Some(Headline { drawing, sentences }) = first {
        let items: String = sentences.iter().map(|sentence| format!("<li>{}\n", prose(sentence))).collect();
        let _ = write!(page, "<div class=\"screen\">{}<ul class=\"sentences\">\n{items}</ul></div>\n", drawing.html());
    }
    let _ = write!(
        page,
        "<p class=\"provenance\">{}{}. A time is the processor time of one thread for one question of shapes that are built already, called \
         through <code>dyn SupportMap</code> unless a chapter says otherwise; compare times within this page only. Known answers come from exact rational \
         arithmetic, from arithmetic of ninety digits, from closed forms, or are known by construction.</p>\n<nav><ol>\n",
        escape(&provenance()),
        escape(&busy())
    );
    for section in sections {
        let _ = writeln!(page, "<li><a href=\"#{}\">{}</a>", section.id, escape(section.title));
    }
    page.push_str("</ol></nav></header>\n<main>\n");
    page.extend(sections.iter().map(Section::html));
    page.push_str(&list("wrong", "Wrong", "What is answered, and what is true.", records, |r| &r.verdict.wrong));
    let secondary = "The answer itself is right; what stands beside it (a normal, a point, a gradient, a bound) is farther off than its case allows.";
    page.push_str(&list("secondary", "Right, with a secondary error", secondary, records, |r| &r.verdict.soft));
    page.push_str(
        "</main>\n<footer><p>The numbers of every case: <a href=\"cases.csv\">cases.csv</a>. Beside every figure and table \
         stands the file with its numbers.</p></footer>\n</html>\n",
    );
    page
}

fn list<'r>(
    id: &str,
    title: &str,
    lead: &str,
    records: &'r [Record],
    why: impl Fn(&'r Record) -> &'r Vec<String>,
) -> String {
    let item = |r: &'r Record| {
        let why = why(r).join("; ");
        format!("<li>{}, case {} of {}.jsonl: {}\n", called(&r.query), escape(&r.id), escape(&r.file), escape(&why))
    };
    let items: String = records.iter().filter(|r| !why(r).is_empty()).map(item).collect();
    if items.is_empty() {
        String::new()
    } else {
        format!("<section id=\"{id}\">\n<h2>{title}</h2>\n<p>{lead}</p>\n<ul>\n{items}</ul>\n</section>\n")
    }
}
