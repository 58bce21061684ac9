//! `cargo xtask path FILE…`: whether robots' edges are free, and what sampling would have said.

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use serde_json::Value;

use crate::engine::path::{EdgeReport, Verdict, edges, picture as drawn};
use crate::mesh::Meshes;
use crate::wire::json;

/// What to ask.
#[derive(Clone, Debug, Args)]
pub struct Choice {
    /// Files of queries, of which those of kind `path` are asked, edge by edge.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Draw the first path in space that touches something, and its contact, into a file of this name.
    #[arg(long, value_name = "FILE.svg")]
    picture: Option<PathBuf>,
}

/// Prints the table.
#[must_use]
pub fn run(choice: &Choice) -> ExitCode {
    let mut groups = BTreeMap::<String, Vec<EdgeReport>>::new();
    let mut picture = choice.picture.as_deref();
    let read = choice.files.iter().try_for_each(|file| read(file, &mut groups, &mut picture));
    if read.is_err() {
        return crate::output::ended(read.map(|()| true));
    }
    match print(&groups, &mut io::stdout().lock()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => crate::output::failed("cannot write the table", &why),
    }
}

/// Asks every path of a file, and puts its edges into the group of its first tag. A picture that is still to be drawn is
/// drawn of the first that touches something.
fn read(
    file: &Path,
    groups: &mut BTreeMap<String, Vec<EdgeReport>>,
    picture: &mut Option<&Path>,
) -> Result<(), String> {
    let text = fs::read_to_string(file).map_err(|why| format!("cannot read {}: {why}", file.display()))?;
    let meshes = Meshes::relative_to(file.parent().unwrap_or(Path::new("")));
    for (number, line) in text.lines().enumerate() {
        let failed = |why: String| format!("{}, line {}: {why}", file.display(), number + 1);
        if line.trim().is_empty() || line.starts_with('#') {
            continue;
        }
        let object = json::object(line.as_bytes()).map_err(|problem| failed(problem.message))?;
        if object.get("query").and_then(Value::as_str) != Some("path") {
            continue;
        }
        let tag = object.get("tags").and_then(|tags| tags.get(0)).and_then(Value::as_str).unwrap_or("untagged");
        let found = edges(&object, &meshes).map_err(|problem| failed(problem.message))?;
        groups.entry(tag.to_owned()).or_default().extend(found);
        if let Some(file) = *picture
            && let Some((svg, true)) = drawn(&object, &meshes).map_err(|problem| failed(problem.message))?
        {
            fs::write(file, svg).map_err(|why| format!("cannot write {}: {why}", file.display()))?;
            *picture = None;
        }
    }
    Ok(())
}

fn print(groups: &BTreeMap<String, Vec<EdgeReport>>, output: &mut impl Write) -> io::Result<()> {
    writeln!(
        output,
        "{:<26} {:>6} {:>6} {:>8} {:>10} {:>10} {:>10} {:>11} {:>11} {:>11}",
        "problem",
        "edges",
        "free",
        "contact",
        "undecided",
        "median µs",
        "worst µs",
        "0.13 wrong",
        "1/32 wrong",
        "1/128 wrong"
    )?;
    let all: Vec<EdgeReport> = groups.values().flatten().copied().collect();
    for (name, edges) in groups.iter().map(|(name, edges)| (name.as_str(), edges)).chain([("all", &all)]) {
        let count = |verdict| edges.iter().filter(|edge| edge.verdict == verdict).count();
        // What sampling takes for free although the robot touches something.
        let wrong =
            |k: usize| edges.iter().filter(|edge| edge.verdict == Verdict::Contact && edge.sampled_free[k]).count();
        let mut times: Vec<f64> = edges.iter().map(|edge| edge.nanoseconds * 1e-3).collect();
        times.sort_by(f64::total_cmp);
        let at = |index: usize| times.get(index).copied().unwrap_or(f64::NAN);
        writeln!(
            output,
            "{name:<26} {:>6} {:>6} {:>8} {:>10} {:>10.1} {:>10.1} {:>11} {:>11} {:>11}",
            edges.len(),
            count(Verdict::Free),
            count(Verdict::Contact),
            count(Verdict::Undecided),
            at(times.len() / 2),
            at(times.len().saturating_sub(1)),
            wrong(0),
            wrong(1),
            wrong(2),
        )?;
    }
    writeln!(
        output,
        "\"wrong\": edges that touch something, and that steps of so many radians along the joints take for free; 0.13 is \
         one per cent of the diagonal of a Panda's joint limits"
    )
}
