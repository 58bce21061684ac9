//! `cargo xtask follow`: how far whoever inherits the libraries has to read.
//!
//! Two measures, compared with a committed table: circles of imports between the files of each library, and the files
//! of gjk-raycast that one question goes through.

mod circles;
mod walk;

use std::fmt::Write as _;
use std::fs;
use std::io::{self, Write as _};
use std::path::Path;
use std::process::ExitCode;

use clap::Args;

/// Whether the table is compared or written.
#[derive(Clone, Debug, Args)]
pub struct Choice {
    /// Write the table anew, after a change that was meant.
    #[arg(long)]
    write: bool,
    /// Name the files that each question goes through.
    #[arg(long)]
    list: bool,
}

/// The root of the workspace.
const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

const LIBRARIES: [&str; 4] = ["convex-support", "gjk-raycast", "lj-ellipsoid", "ellip-margin"];

/// A part in so many lines may come to a question's path before it counts as longer.
const LINES_IN: usize = 100;

#[must_use]
pub fn run(choice: &Choice) -> ExitCode {
    crate::output::ended(follow(choice))
}

/// A row of the table: a library with its files and the number of circles among them, or a question with the files and
/// lines that it goes through.
#[derive(Clone, Debug, PartialEq)]
struct Row {
    name: String,
    files: usize,
    most: usize,
}

/// Whether nothing got longer.
fn follow(choice: &Choice) -> io::Result<bool> {
    let table = Path::new(ROOT).join("xtask/follow.txt");
    let mut rows = Vec::new();
    for library in LIBRARIES {
        let files = circles::read(&Path::new(ROOT).join("crates").join(library).join("src"))?;
        let circles = circles::circles(&files);
        for circle in &circles {
            writeln!(io::stderr(), "{library}: a circle of imports: {}", circle.join(", "))?;
        }
        rows.push(Row { name: format!("circles/{library}"), files: files.len(), most: circles.len() });
    }
    match walk::questions(Path::new(ROOT))? {
        Some(questions) => {
            for question in questions {
                if choice.list {
                    writeln!(io::stdout(), "{}: {}", question.name, question.files.join(" "))?;
                }
                rows.push(Row { name: question.name, files: question.files.len(), most: question.lines });
            }
        }
        None => writeln!(io::stdout(), "valgrind is not installed: only circles of imports are compared")?,
    }
    if choice.write {
        fs::write(&table, written(&rows))?;
    }
    compare(&read(&fs::read_to_string(&table)?), &rows, &mut io::stdout().lock())
}

/// The table: for each library its files and circles, for each question its files and lines.
fn written(rows: &[Row]) -> String {
    let mut text = String::from("# files, and circles of imports or lines: cargo xtask follow\n");
    for Row { name, files, most } in rows {
        let _ = writeln!(text, "{name} {files} {most}");
    }
    text
}

fn read(text: &str) -> Vec<Row> {
    let row = |line: &str| {
        let mut words = line.split(' ');
        let name = words.next()?.to_owned();
        let mut number = || words.next()?.parse().ok();
        Some(Row { name, files: number()?, most: number()? })
    };
    text.lines().filter(|line| !line.starts_with('#')).filter_map(row).collect()
}

/// Prints both tables side by side. A row is longer if it has more circles, or more files or over 1 % more lines on a
/// question's path; a library may have more files.
fn compare(before: &[Row], now: &[Row], output: &mut impl io::Write) -> io::Result<bool> {
    writeln!(output, "{:26} {:>15} {:>18}", "", "files", "circles or lines")?;
    let mut is_well = true;
    for row in now {
        let old = before.iter().find(|old| old.name == row.name);
        let is_library = row.name.starts_with("circles/");
        let is_longer =
            old.is_none_or(|old| row.most > old.most + old.most / LINES_IN || (!is_library && row.files > old.files));
        let was = |of: fn(&Row) -> usize| old.map_or_else(|| "new".to_owned(), |old| of(old).to_string());
        let verdict = if is_longer { "  LONGER: shorten it, or run with --write if it was meant" } else { "" };
        writeln!(
            output,
            "{:26} {:>6} -> {:>5} {:>9} -> {:>5}{verdict}",
            row.name,
            was(|row| row.files),
            row.files,
            was(|row| row.most),
            row.most
        )?;
        is_well &= !is_longer;
    }
    Ok(is_well)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_longer_by_a_file_and_a_library_by_a_circle_only() {
        let row = |name: &str, files, most| Row { name: name.to_owned(), files, most };
        let before = [row("circles/a", 10, 0), row("ray", 12, 3000)];
        let longer = |now: &[Row]| !compare(&before, now, &mut io::sink()).expect("nothing is written");
        assert!(!longer(&[row("circles/a", 11, 0), row("ray", 12, 3030)]), "within what may come");
        assert!(longer(&[row("circles/a", 10, 1)]), "a circle");
        assert!(longer(&[row("ray", 13, 3000)]), "a file");
        assert!(longer(&[row("ray", 12, 3031)]), "over a hundredth of the lines");
        assert!(longer(&[row("new", 1, 1)]), "a question that the table lacks");
        assert_eq!(read(&written(&before)), before, "the table comes back");
    }
}
