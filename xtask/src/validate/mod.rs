//! `cargo xtask validate [FILE…]`: answers against the truth, error against run time.

mod report;
mod score;
mod summary;

use std::fs::File;
use std::io::{self, BufRead, BufReader, IsTerminal as _, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use serde_json::Value;

use self::score::Verdict;
use crate::engine::{self, Ask};
use crate::mesh::Meshes;
use crate::wire::answer::Line;
use crate::wire::query;
use crate::wire::reader::Object;

/// What is validated where no files are named.
const EMBEDDED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/suite");

/// One case and what became of it.
#[derive(Clone, Debug)]
pub(crate) struct Record {
    /// The stem of the file's name.
    file: String,
    id: String,
    query: String,
    precision: &'static str,
    tags: Vec<String>,
    verdict: Verdict,
    /// Nanoseconds to solve it, once its shapes are built; none for a line that asks nothing.
    time: Option<f64>,
}

/// Validates the files, or the embedded suite, and writes the report to `folder`.
pub(crate) fn run(files: &[PathBuf], folder: &Path) -> ExitCode {
    match validate(files, folder) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(why) => {
            let _ = writeln!(io::stderr(), "error: {why}");
            ExitCode::from(2)
        }
    }
}

/// Whether everything was right.
fn validate(files: &[PathBuf], folder: &Path) -> Result<bool, String> {
    let embedded;
    let files = if files.is_empty() {
        embedded = suite()?;
        &embedded
    } else {
        files
    };
    let mut records = Vec::new();
    for file in files {
        validate_file(file, &mut records).map_err(|why| format!("cannot read {}: {why}", file.display()))?;
    }
    let mut output = io::stdout().lock();
    let written = summary::print(&records, &mut output).and_then(|()| {
        let page = report::write(&records, folder)?;
        writeln!(output, "report: {}", page.display())
    });
    match written {
        Err(why) if why.kind() != io::ErrorKind::BrokenPipe => Err(format!("cannot write the report: {why}")),
        _ => Ok(records.iter().all(|r| r.verdict.wrong.is_empty())),
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

fn validate_file(file: &Path, records: &mut Vec<Record>) -> io::Result<()> {
    let meshes = Meshes::relative_to(file.parent().unwrap_or(Path::new("")));
    let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let progress = io::stderr().is_terminal();
    let mut input = BufReader::new(File::open(file)?);
    let mut text = Vec::new();
    let mut line = 0;
    while input.read_until(b'\n', &mut text)? > 0 {
        line += 1;
        let trimmed = text.trim_ascii_end();
        if !trimmed.is_empty() && !trimmed.starts_with(b"#") {
            records.push(validate_line(trimmed, line, &name, &meshes));
            if progress && line % 32 == 0 {
                write!(io::stderr(), "\r{name}: line {line}\x1b[K")?;
            }
        }
        text.clear();
    }
    if progress {
        write!(io::stderr(), "\r\x1b[K")?;
    }
    Ok(())
}

fn validate_line(text: &[u8], line: u64, file: &str, meshes: &Meshes) -> Record {
    let object = query::object(text);
    // A line that cannot be read may still say what is expected of it.
    let case = match &object {
        Ok(object) => Some(object.clone()),
        Err(_) => query::expectation_of(text),
    };
    let question = object.and_then(|object| engine::question(&object, meshes));
    let outcome = question.as_ref().map_err(Clone::clone).and_then(|question| question.ask());
    let time = outcome.is_ok().then(|| question.as_ref().ok().map(|q| time(q.as_ref()))).flatten();
    let answer = as_read(Line { id: Value::Null, line, outcome });
    let verdict = case.as_ref().map_or_else(|| score::judge_unreadable(&answer), |case| score::judge(case, &answer));
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
    }
}

/// Nanoseconds to solve the question: long enough to be told from the clock, short enough for thousands of questions.
fn time(question: &dyn Ask) -> f64 {
    const MICROSECONDS: u64 = 100;
    question.time(MICROSECONDS)
}

/// The answer as whoever reads the line of output gets it.
fn as_read(line: Line) -> Object {
    serde_json::to_vec(&line).ok().and_then(|text| serde_json::from_slice(&text).ok()).unwrap_or_default()
}
