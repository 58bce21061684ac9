//! `cargo xtask validate [FILE…]`: answers against the truth, error against run time.

pub mod cases;
mod headline;
pub mod needles;
pub mod page;
mod progress;
mod report;
pub mod score;
pub mod stiff;
pub mod summary;

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use clap::Args;
use serde_json::Value;

use self::needles::Needles;
use self::page::Section;
pub use self::progress::{begin as begin_progress, end as end_progress, progress};
use self::score::Verdict;
use crate::EMBEDDED;
use crate::claims;
use crate::engine;
use crate::mesh::Meshes;
use crate::wire::answer::{Line, as_read};
use crate::wire::error::Problem;
use crate::wire::fields::Object;
use crate::wire::json;

/// One case and what became of it.
#[derive(Clone, Debug)]
pub struct Record {
    /// The stem of the file's name.
    pub file: String,
    pub id: String,
    pub query: String,
    pub precision: &'static str,
    pub tags: Vec<String>,
    pub verdict: Verdict,
    /// Nanoseconds to solve it, once its shapes are built; none for a line that asks nothing.
    pub time: Option<f64>,
    /// Iterations, of all poses together for `track`.
    pub iterations: Option<u64>,
}

/// A case that was answered, to be asked again in other ways.
#[derive(Debug)]
pub struct Case {
    pub object: Object,
    pub meshes: Arc<Meshes>,
}

/// What to validate, and how thoroughly.
#[derive(Clone, Debug, Args)]
pub struct Scope {
    /// Query files with `expect`; without any, the embedded suite.
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
    /// The cases alone, held to their truths and not to the laws of claims: nothing is compiled for it but the engine
    /// of the queries, and it runs for seconds.
    #[arg(long)]
    pub quick: bool,
    /// Also the papers' own routes to the margin, by eigenvalues: their library takes a minute or two more to build.
    #[arg(long)]
    paper: bool,
    /// Only this query, the queries of this crate, or this chapter of the report; or both, as in `gjk-raycast/growth`.
    #[arg(long, value_name = "QUERY|CRATE|CHAPTER", value_parser = Only::parse)]
    only: Option<Only>,
    /// Where the report goes.
    #[arg(long, value_name = "FOLDER", default_value = "target/report")]
    report: PathBuf,
}

/// The queries, by the crate that answers them.
const CRATES: [(&str, &[&str]); 3] = [
    (
        "gjk-raycast",
        &[
            "ray_cast",
            "ray_exit",
            "linear_cast",
            "motion_cast",
            "motion_clearance",
            "distance",
            "signed_distance",
            "growth_distance",
            "contact",
            "intersect",
            "scene",
            "path",
            "joint_box",
        ],
    ),
    ("lj-ellipsoid", &["enclosing_ellipsoid", "inscribed_ellipsoid"]),
    ("ellip-margin", &["margin", "track", "clearance"]),
];

/// The chapters of the report, in their order.
const CHAPTERS: [&str; 7] = ["headline", "ladders", "stiff", "growth", "left-out", "claims", "cases"];

/// A chapter of the report, and who writes it.
#[derive(Clone, Copy, Debug)]
pub struct Chapter {
    /// One of the names of the chapters.
    pub name: &'static str,
    pub write: fn(&Material<'_>) -> Section,
}

/// What chapters are written from.
#[derive(Debug)]
pub struct Material<'a> {
    pub scope: &'a Scope,
    pub records: &'a [Record],
    pub cases: &'a [Case],
    pub needles: &'a Needles,
}

/// The chapters of a quick run; the others are studies.
pub const QUICK: [Chapter; 2] = [
    Chapter { name: "stiff", write: |material| stiff::section(material.records, material.needles) },
    Chapter { name: "cases", write: |material| cases::section(material.records) },
];

/// A part of the work.
#[derive(Clone, Debug)]
struct Only {
    queries: Option<Vec<String>>,
    chapter: Option<String>,
}

impl Only {
    fn parse(text: &str) -> Result<Self, String> {
        let mut only = Self { queries: None, chapter: None };
        for part in text.split('/') {
            let of_crate = CRATES.iter().find(|(name, _)| *name == part).map(|(_, queries)| queries.to_vec());
            let known = CRATES.iter().flat_map(|(_, queries)| *queries).find(|query| **query == part);
            if let Some(queries) = of_crate.or(known.map(|query| vec![*query])) {
                only.queries = Some(queries.into_iter().map(str::to_owned).collect());
            } else if CHAPTERS.contains(&part) {
                only.chapter = Some(part.to_owned());
            } else {
                let crates =
                    CRATES.iter().flat_map(|(name, queries)| [*name].into_iter().chain(queries.iter().copied()));
                let names: Vec<&str> = crates.chain(CHAPTERS).collect();
                return Err(format!("{part:?} is none of {}", names.join(", ")));
            }
        }
        Ok(only)
    }
}

impl Scope {
    /// Whether a query is asked for.
    #[must_use]
    pub fn holds(&self, query: &str) -> bool {
        let queries = self.only.as_ref().and_then(|only| only.queries.as_ref());
        queries.is_none_or(|queries| queries.iter().any(|q| q == query))
    }

    /// Whether a chapter of the report is asked for.
    fn shows(&self, chapter: &str) -> bool {
        match self.only.as_ref().and_then(|only| only.chapter.as_ref()) {
            Some(only) => only == chapter,
            None => !self.quick || QUICK.iter().any(|quick| quick.name == chapter),
        }
    }

    /// Whether neither files nor a part are named.
    fn is_whole(&self) -> bool {
        self.files.is_empty() && self.only.is_none()
    }

    /// Whether a chapter is asked for that is none of [`QUICK`].
    #[must_use]
    pub fn is_study(&self) -> bool {
        CHAPTERS.into_iter().any(|chapter| self.shows(chapter) && QUICK.iter().all(|quick| quick.name != chapter))
    }

    /// The features that studies are built with.
    #[must_use]
    pub fn features(&self) -> &'static str {
        if self.paper { "paper" } else { "" }
    }
}

/// Validates and writes the report.
pub fn run(scope: &Scope, chapters: &[Chapter]) -> ExitCode {
    crate::output::ended(validate(scope, chapters))
}

/// Whether everything was right, or there was nobody to tell.
fn validate(scope: &Scope, chapters: &[Chapter]) -> Result<bool, String> {
    let embedded;
    let files = if scope.files.is_empty() {
        embedded = suite()?;
        &embedded
    } else {
        &scope.files
    };
    let (mut records, mut cases) = (Vec::new(), Vec::new());
    let chapters: Vec<&Chapter> = chapters.iter().filter(|chapter| scope.shows(chapter.name)).collect();
    progress::begin(chapters.len() + 1, "cases");
    for file in files {
        validate_file(file, scope, &mut records, &mut cases)
            .map_err(|why| format!("cannot read {}: {why}", file.display()))?;
    }
    if records.is_empty() {
        return Err("there is nothing to validate".to_owned());
    }
    let needles = if scope.files.is_empty() && !scope.quick && scope.shows("stiff") {
        progress("needles and plates");
        Needles::ask(scope)
    } else {
        Needles::default()
    };
    records.extend(needles.records());
    let material = Material { scope, records: &records, cases: &cases, needles: &needles };
    let first = scope.is_whole().then(|| headline::headline(&records));
    let mut sections = Vec::new();
    for chapter in chapters {
        progress::chapter(chapter.name);
        let section = (chapter.write)(&material);
        if !section.blocks.is_empty() {
            sections.push(section);
        }
    }
    progress::end();
    let mut output = io::stdout().lock();
    let sentences = first.as_ref().map_or(&[] as &[String], |first| &first.sentences);
    let written = report::write(&records, first.as_ref(), &sections, &scope.report)
        .and_then(|page| summary::print(&records, sentences, &page, &mut output));
    match written {
        Err(why) if why.kind() == io::ErrorKind::BrokenPipe => Ok(true),
        Err(why) => Err(format!("cannot write the report: {why}")),
        Ok(()) => Ok(records.iter().all(|r| r.verdict.wrong.is_empty())),
    }
}

/// The files of the embedded suite, in order of their names.
fn suite() -> Result<Vec<PathBuf>, String> {
    let folder = std::fs::read_dir(EMBEDDED).map_err(|why| format!("cannot read {EMBEDDED}: {why}"))?;
    let mut files: Vec<PathBuf> =
        folder.flatten().map(|e| e.path()).filter(|p| p.extension().is_some_and(|e| e == "jsonl")).collect();
    files.sort();
    Ok(files)
}

fn validate_file(file: &Path, scope: &Scope, records: &mut Vec<Record>, cases: &mut Vec<Case>) -> io::Result<()> {
    let meshes = Arc::new(Meshes::relative_to(file.parent().unwrap_or(Path::new(""))));
    let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut input = BufReader::new(File::open(file)?);
    let mut text = Vec::new();
    let mut line = 0;
    while input.read_until(b'\n', &mut text)? > 0 {
        line += 1;
        let trimmed = text.trim_ascii_end();
        if !trimmed.is_empty() && !trimmed.starts_with(b"#") {
            let object = json::object(trimmed);
            let asked = object.as_ref().ok().and_then(|o| o.get("query")).and_then(Value::as_str).unwrap_or("none");
            if scope.holds(asked) {
                let record = validate_line(trimmed, &object, line, &name, &meshes);
                if record.time.is_some() && cases.len() < MOST_CASES {
                    cases.extend(object.ok().map(|object| Case { object, meshes: Arc::clone(&meshes) }));
                }
                records.push(record);
            }
            if line % 32 == 0 {
                progress(&format!("{name}: line {line}"));
            }
        }
        text.clear();
    }
    Ok(())
}

/// The most cases that are kept to be asked again.
const MOST_CASES: usize = 10_000;

fn validate_line(text: &[u8], object: &Result<Object, Problem>, line: u64, file: &str, meshes: &Meshes) -> Record {
    // A line that cannot be read may still say what is expected of it.
    let case = match object {
        Ok(object) => Some(object.clone()),
        Err(_) => json::expectation_of(text),
    };
    let question = object.as_ref().map_err(Clone::clone).and_then(|object| engine::question(object, meshes));
    let outcome = question.as_ref().map_err(Clone::clone).and_then(|question| question.ask());
    let time = question.ok().filter(|_| outcome.is_ok()).map(|question| question.time(MICROSECONDS));
    let answer = as_read(Line { id: None, line, outcome });
    let mut verdict =
        case.as_ref().map_or_else(|| score::judge_unreadable(&answer), |case| score::judge(case, &answer));
    if engine::IS_FOR_STUDIES
        && let Ok(object) = object
    {
        score::judge_claims(claims::of(object, &STARTS, meshes).unwrap_or_default(), &mut verdict);
    }
    let case = case.unwrap_or_default();
    let field = |name: &str| case.get(name).and_then(Value::as_str);
    Record {
        file: file.to_owned(),
        id: case.get("id").map_or_else(|| line.to_string(), |id| id.as_str().map_or(id.to_string(), str::to_owned)),
        query: field("query").unwrap_or("none").to_owned(),
        precision: if field("precision") == Some("f32") { "f32" } else { "f64" },
        tags: case
            .get("tags")
            .and_then(Value::as_array)
            .map(|tags| tags.iter().filter_map(Value::as_str).map(str::to_owned).collect())
            .unwrap_or_default(),
        verdict,
        time,
        iterations: answer.get("iterations").and_then(iterations),
    }
}

/// Iterations as answered: a number, or one for each pose.
fn iterations(value: &Value) -> Option<u64> {
    match value {
        Value::Array(each) => each.iter().map(Value::as_u64).sum(),
        number => number.as_u64(),
    }
}

/// Directions that searches are begun from, and of planes that are tried: nothing depends on them.
const STARTS: [[f64; 3]; 2] = [[1.0, 0.0, 0.0], [0.5, -0.25, 0.125]];

/// How long a question is timed: long enough to be told from the clock, short enough for thousands of questions.
const MICROSECONDS: u64 = 100;
