//! `cargo xtask query FILE…`: one answer per line, in order, in constant memory; lines of JSON, or rows of a table.

use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use rayon::prelude::*;

use crate::columns::{Bound, Columns, Template};
use crate::engine;
use crate::mesh::{Access, Meshes};
use crate::output;
use crate::wire::answer::{Answer, Line};
use crate::wire::error::Problem;
use crate::wire::json;

/// Lines are read as long as they are there already, and answered together: at most about this much of them at once.
const BATCH_BYTES: usize = 1 << 18;

/// What to answer.
#[derive(Clone, Debug, Args)]
pub struct Choice {
    /// Query files; `-` is standard input.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// The folder that `mesh` queries may read from, links resolved, or `none`; without it they read any OBJ or STL
    /// file that this program may.
    #[arg(long, value_name = "FOLDER|none", value_parser = Access::parse, default_value = "", hide_default_value = true)]
    meshes: Access,
    /// The number of the first line of each file, where it is a part of a larger one: ids and errors count from it.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    first_line: u64,
    /// Write each query as it is, with its `answer` and the `certificate` that proves it, for `cargo xtask prove`.
    #[arg(long)]
    certify: bool,
    /// Read CSV, whose first row has the names of its columns: the query in which `$name` is the cell of a column, as
    /// in `{"query":"distance","a":{"type":"ball","radius":$r},"b":{"type":"point","at":[$x,$y,$z]}}`.
    #[arg(long, value_name = "QUERY", value_parser = Template::parse, conflicts_with = "certify")]
    template: Option<Template>,
    /// Write CSV with these fields of the answers, as in `id,distance,lower,point_a.0,error`.
    #[arg(long, value_name = "FIELDS", value_delimiter = ',', conflicts_with = "certify")]
    columns: Vec<String>,
}

/// Answers the files to standard output.
#[must_use]
pub fn run(Choice { files, meshes, first_line, certify, template, columns }: &Choice) -> ExitCode {
    let columns = (!columns.is_empty()).then(|| Columns::new(columns));
    let row = |numbered: &Numbered, meshes: &Meshes| answer_row(numbered, meshes, columns.as_ref());
    let write: &Writer<'_> = if *certify { &certified_line } else { &row };
    let door = Door { template: template.as_ref(), write };
    let mut output = BufWriter::new(io::stdout().lock());
    if let Some(Err(why)) = columns.as_ref().map(|columns| output.write_all(columns.header().as_bytes())) {
        return output::failed("cannot write the answers", &why);
    }
    let (mut any_error, mut any_failure, mut any_answer) = (false, false, false);
    for file in files {
        match answer_file(file, meshes, Lines { read: first_line - 1 }, door, &mut output) {
            Ok(Tally { errors, answers }) => {
                any_error |= errors > 0;
                any_answer |= answers > 0;
            }
            Err(Failure::Output(why)) => return output::failed("cannot write the answers", &why),
            Err(Failure::Input(why)) => {
                any_failure = true;
                complain(&format!("cannot read {}: {why}", file.display()));
            }
        }
    }
    for missing in columns.iter().flat_map(Columns::missing).filter(|_| any_answer) {
        any_failure = true;
        complain(&format!("no answer has the field `{missing}`; xtask/README.md names the fields of each query"));
    }
    match (any_failure, any_error) {
        (true, _) => ExitCode::from(2),
        (false, true) => ExitCode::from(1),
        (false, false) => ExitCode::SUCCESS,
    }
}

#[expect(clippy::print_stderr, reason = "this is the task's word to the person who started it")]
fn complain(message: &str) {
    eprintln!("error: {message}");
}

/// What became of the lines of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Tally {
    answers: u64,
    errors: u64,
}

/// Why a file could not be answered to its end.
#[derive(Debug)]
enum Failure {
    Input(io::Error),
    Output(io::Error),
}

fn answer_file(
    file: &Path,
    access: &Access,
    lines: Lines,
    door: Door<'_>,
    output: &mut impl Write,
) -> Result<Tally, Failure> {
    let meshes = |folder| Meshes::relative_to(folder).with_access(access.clone());
    if file == Path::new("-") {
        return answer_lines(io::stdin().lock(), lines, &meshes(Path::new("")), door, output);
    }
    let is_table = file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
    if is_table && door.template.is_none() {
        return Err(Failure::Input(io::Error::other(
            "a table needs a `--template`, the query with `$name` for a cell",
        )));
    }
    let folder = file.parent().unwrap_or(Path::new(""));
    answer_lines(File::open(file).map_err(Failure::Input)?, lines, &meshes(folder), door, output)
}

/// Answers every line of `input`; `lines` says which lines came before.
///
/// A batch is what lies in the buffer, so that whoever sends one line and waits gets its answer.
fn answer_lines(
    input: impl Read,
    mut lines: Lines,
    meshes: &Meshes,
    Door { template, write }: Door<'_>,
    output: &mut impl Write,
) -> Result<Tally, Failure> {
    let mut input = BufReader::with_capacity(BATCH_BYTES, input);
    let table = match template {
        Some(template) => Some(lines.table(template, &mut input).map_err(Failure::Input)?),
        None => None,
    };
    let filled = |mut numbered: Numbered| {
        if let Some(table) = &table {
            match table.fill(&numbered.text) {
                Ok(text) => numbered.text = text,
                Err(problem) => numbered.problem = Some(problem),
            }
        }
        numbered
    };
    let mut tally = Tally::default();
    let mut more = true;
    while more {
        let mut batch = Vec::new();
        loop {
            more = lines.next(&mut input, &mut batch).map_err(Failure::Input)?;
            if !more || !input.buffer().contains(&b'\n') {
                break;
            }
        }
        let answers: Vec<(bool, Vec<u8>)> = batch.into_par_iter().map(|line| write(&filled(line), meshes)).collect();
        for (answered, text) in answers {
            output.write_all(&text).map_err(Failure::Output)?;
            if answered { tally.answers += 1 } else { tally.errors += 1 }
        }
        output.flush().map_err(Failure::Output)?;
    }
    Ok(tally)
}

/// A line that asks something, and its number.
struct Numbered {
    line: u64,
    text: Vec<u8>,
    /// What is wrong with it as a row of a table.
    problem: Option<Problem>,
}

/// How lines are read and answered: as rows of a table, for which there is a template, or as they are.
#[derive(Clone, Copy)]
struct Door<'d> {
    template: Option<&'d Template>,
    write: &'d Writer<'d>,
}

/// Counts the lines of a file.
struct Lines {
    read: u64,
}

impl Lines {
    /// Reads a line and puts it into the batch, unless it is blank or a comment; false at the end of the file.
    fn next(&mut self, input: &mut impl BufRead, batch: &mut Vec<Numbered>) -> io::Result<bool> {
        let mut text = Vec::new();
        if input.read_until(b'\n', &mut text)? == 0 {
            return Ok(false);
        }
        self.read = self.read.saturating_add(1);
        if self.read == 1 && text.starts_with(b"\xEF\xBB\xBF") {
            text.drain(..3);
        }
        text.truncate(text.trim_ascii_end().len());
        if !text.is_empty() && !text.starts_with(b"#") {
            batch.push(Numbered { line: self.read, text, problem: None });
        }
        Ok(true)
    }

    /// Reads the first row of a table.
    fn table<'t>(&mut self, template: &'t Template, input: &mut impl BufRead) -> io::Result<Bound<'t>> {
        let mut first = Vec::new();
        while first.is_empty() && self.next(input, &mut first)? {}
        let header = first.pop().map_or_else(Vec::new, |header| header.text);
        template.bind(&String::from_utf8_lossy(&header)).map_err(io::Error::other)
    }
}

/// The line of output for one line of input.
#[must_use]
pub fn answer(text: &[u8], meshes: &Meshes) -> Vec<u8> {
    answer_row(&Numbered { line: 1, text: text.to_vec(), problem: None }, meshes, None).1
}

/// How a line of input is answered: the line of output, and whether it is an answer.
type Writer<'w> = dyn Fn(&Numbered, &Meshes) -> (bool, Vec<u8>) + Sync + 'w;

/// The query as it is written, with its answer and certificate; or what is wrong with it.
fn certified_line(numbered: &Numbered, meshes: &Meshes) -> (bool, Vec<u8>) {
    let asked = json::object(&numbered.text).and_then(|object| engine::question(&object, meshes));
    let Ok((answer, certificate)) = asked.and_then(|question| question.ask_with_certificate()) else {
        return answer_row(numbered, meshes, None);
    };
    let json = |answer: &Answer| serde_json::to_string(answer).unwrap_or_default();
    let mut text = numbered.text.clone();
    // The last byte of an object is its bracket.
    text.pop();
    text.extend_from_slice(format!(",\"answer\":{}", json(&answer)).as_bytes());
    if let Some(certificate) = certificate {
        text.extend_from_slice(format!(",\"certificate\":{}", json(&certificate)).as_bytes());
    }
    text.extend_from_slice(b"}\n");
    (true, text)
}

/// The line with its answer and certificate; `None` where it has no answer.
#[must_use]
pub fn certified(text: &[u8], meshes: &Meshes) -> Option<Vec<u8>> {
    let (is_answer, line) = certified_line(&Numbered { line: 1, text: text.to_vec(), problem: None }, meshes);
    is_answer.then_some(line)
}

/// The line of output for a line of input, with these columns or as JSON, and whether it is an answer.
fn answer_row(
    Numbered { line, text, problem }: &Numbered,
    meshes: &Meshes,
    columns: Option<&Columns>,
) -> (bool, Vec<u8>) {
    let read = problem.clone().map_or_else(|| json::object(text), Err);
    let outcome = read.and_then(|object| engine::question(&object, meshes)).and_then(|question| question.ask());
    let id = if problem.is_none() { json::id_of(text) } else { None };
    let answered = outcome.is_ok();
    if let Some(columns) = columns {
        let text =
            |id: &serde_json::value::RawValue| serde_json::from_str(id.get()).unwrap_or_else(|_| id.get().to_owned());
        let id = id.as_deref().map_or_else(|| line.to_string(), text);
        return (answered, columns.row(&id, &outcome));
    }
    // Writing to memory fails only for values that are no JSON, and there are none in a `Line`.
    let mut text = serde_json::to_vec(&Line { id, line: *line, outcome }).unwrap_or_default();
    text.push(b'\n');
    (answered, text)
}

#[cfg(test)]
mod tests {
    use super::*;

    const AS_JSON: Door<'_> = Door { template: None, write: &|numbered, meshes| answer_row(numbered, meshes, None) };

    /// A table is answered row by row: good rows, bad ones, and those whose query is none.
    #[test]
    fn a_table_is_answered_in_columns() {
        let query =
            r#"{"id":"$name","query":"distance","a":{"type":"ball","radius":$r},"b":{"type":"point","at":[$x,0,0]}}"#;
        let template = Template::parse(query).expect("a template");
        let columns = Columns::new(&["id", "distance", "normal.0", "error"].map(str::to_owned));
        let write = |numbered: &Numbered, meshes: &Meshes| answer_row(numbered, meshes, Some(&columns));
        let door = Door { template: Some(&template), write: &write };
        let table = b"\xEF\xBB\xBFname,r,x\r\n\"a, b\",1,3\r\nsunk,1,0.5\n\nbad,1\nnegative,-1,3\n";
        let mut output = Vec::new();
        let tally = answer_lines(&table[..], Lines { read: 0 }, &Meshes::relative_to(""), door, &mut output);
        assert_eq!(tally.expect("in memory"), Tally { answers: 2, errors: 2 });
        let rows: Vec<String> = String::from_utf8_lossy(&output).lines().map(str::to_owned).collect();
        assert_eq!(rows[..2], ["\"a, b\",2.0,-1.0,", "sunk,0.0,,"]);
        assert_eq!(rows[2], "5,,,\"the row has 2 cells, and the first row 3\"");
        assert!(rows[3].starts_with("negative,,,") && rows[3].contains("radius"), "{}", rows[3]);
        assert_eq!(rows.len(), 4);
    }

    #[test]
    fn a_table_without_a_template_is_no_query_file() {
        let access = Access::parse("none").expect("no meshes");
        let told = answer_file(Path::new("parts.csv"), &access, Lines { read: 0 }, AS_JSON, &mut Vec::new());
        assert!(matches!(&told, Err(Failure::Input(why)) if why.to_string().contains("--template")), "{told:?}");
    }

    fn answers(input: &[u8], first_line: u64) -> Vec<u8> {
        let mut output = Vec::new();
        let lines = Lines { read: first_line - 1 };
        answer_lines(input, lines, &Meshes::relative_to(""), AS_JSON, &mut output).expect("in memory");
        output
    }

    /// A file cut anywhere between lines, its parts numbered on, is answered as in one piece: good lines, bad ones,
    /// blank ones.
    #[test]
    fn parts_of_a_file_are_answered_as_the_whole() {
        let lines: [&[u8]; 7] = [
            b"\xEF\xBB\xBF# a comment",
            br#"{"query":"distance","a":{"type":"ball","radius":1},"b":{"type":"point","at":[3,0,0]}}"#,
            b"",
            b"this is no query",
            b"\xFF\xFE",
            b"\r",
            br#"{"id":"last","query":"intersect","a":{"type":"ball","radius":-1},"b":{"type":"point","at":[3,0,0]}}"#,
        ];
        let whole = answers(&lines.join(&b'\n'), 1);
        assert_eq!(whole.iter().filter(|&&byte| byte == b'\n').count(), 4, "an answer or an error for each query");
        assert!(String::from_utf8_lossy(&whole).contains(r#""line":7,"error""#), "numbered as in the file");
        for cut in 0..=lines.len() {
            let (head, tail) = lines.split_at(cut);
            let parts = [answers(&head.join(&b'\n'), 1), answers(&tail.join(&b'\n'), 1 + cut as u64)].concat();
            assert_eq!(String::from_utf8_lossy(&parts), String::from_utf8_lossy(&whole), "cut before line {}", cut + 1);
        }
    }
}
