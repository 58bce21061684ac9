//! `cargo xtask query FILE…`: one answer per line, in order, in constant memory.

use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use rayon::prelude::*;

use crate::engine;
use crate::mesh::{Access, Meshes};
use crate::output;
use crate::wire::answer::{Answer, Line};
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
}

/// Answers the files to standard output.
#[must_use]
pub fn run(Choice { files, meshes, first_line, certify }: &Choice) -> ExitCode {
    let write = if *certify { certified_line } else { answer_line };
    let mut output = BufWriter::new(io::stdout().lock());
    let (mut any_error, mut any_failure) = (false, false);
    for file in files {
        match answer_file(file, meshes, Lines { read: first_line - 1 }, write, &mut output) {
            Ok(Tally { errors, .. }) => any_error |= errors > 0,
            Err(Failure::Output(why)) => return output::failed("cannot write the answers", &why),
            Err(Failure::Input(why)) => {
                any_failure = true;
                complain(&format!("cannot read {}: {why}", file.display()));
            }
        }
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
    write: Writer,
    output: &mut impl Write,
) -> Result<Tally, Failure> {
    let meshes = |folder| Meshes::relative_to(folder).with_access(access.clone());
    if file == Path::new("-") {
        return answer_lines(io::stdin().lock(), lines, &meshes(Path::new("")), write, output);
    }
    let folder = file.parent().unwrap_or(Path::new(""));
    answer_lines(File::open(file).map_err(Failure::Input)?, lines, &meshes(folder), write, output)
}

/// Answers every line of `input`; `lines` says which lines came before.
///
/// A batch is what lies in the buffer, so that whoever sends one line and waits gets its answer.
fn answer_lines(
    input: impl Read,
    mut lines: Lines,
    meshes: &Meshes,
    write: Writer,
    output: &mut impl Write,
) -> Result<Tally, Failure> {
    let mut input = BufReader::with_capacity(BATCH_BYTES, input);
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
        let answers: Vec<(bool, Vec<u8>)> = batch.par_iter().map(|line| write(line, meshes)).collect();
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
            batch.push(Numbered { line: self.read, text });
        }
        Ok(true)
    }
}

/// The line of output for one line of input.
#[must_use]
pub fn answer(text: &[u8], meshes: &Meshes) -> Vec<u8> {
    answer_line(&Numbered { line: 1, text: text.to_vec() }, meshes).1
}

/// How a line of input is answered: the line of output, and whether it is an answer.
type Writer = fn(&Numbered, &Meshes) -> (bool, Vec<u8>);

/// The query as it is written, with its answer and certificate; or what is wrong with it.
fn certified_line(numbered: &Numbered, meshes: &Meshes) -> (bool, Vec<u8>) {
    let asked = json::object(&numbered.text).and_then(|object| engine::question(&object, meshes));
    let Ok((answer, certificate)) = asked.and_then(|question| question.ask_with_certificate()) else {
        return answer_line(numbered, meshes);
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
    let (is_answer, line) = certified_line(&Numbered { line: 1, text: text.to_vec() }, meshes);
    is_answer.then_some(line)
}

/// The line of output for a line of input, and whether it is an answer.
fn answer_line(Numbered { line, text }: &Numbered, meshes: &Meshes) -> (bool, Vec<u8>) {
    let asked = json::object(text).and_then(|object| engine::question(&object, meshes));
    let (id, outcome) = (json::id_of(text), asked.and_then(|question| question.ask()));
    let answered = outcome.is_ok();
    // Writing to memory fails only for values that are no JSON, and there are none in a `Line`.
    let mut text = serde_json::to_vec(&Line { id, line: *line, outcome }).unwrap_or_default();
    text.push(b'\n');
    (answered, text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answers(input: &[u8], first_line: u64) -> Vec<u8> {
        let mut output = Vec::new();
        let lines = Lines { read: first_line - 1 };
        answer_lines(input, lines, &Meshes::relative_to(""), answer_line, &mut output).expect("in memory");
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
