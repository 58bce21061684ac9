//! `cargo xtask path FILE…`: whether robots' edges are free, and what sampling would have said.

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use serde_json::Value;

use crate::engine::path::{EdgeReport, Pictures, Verdict, edges, pictures};
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
    /// Draw how near the robot comes along the last path in space that is free: what is proved, and what poses say.
    #[arg(long, value_name = "FILE.svg")]
    clearance: Option<PathBuf>,
    /// Draw the box of two joint values that is grown around the middle of that path's first edge.
    #[arg(long, value_name = "FILE.svg")]
    grown: Option<PathBuf>,
}

/// The pictures to be drawn: of the first path that touches something, and of the last one that is free.
struct ToDraw<'c> {
    touching: Option<&'c Path>,
    free: [Option<&'c Path>; 2],
}

impl ToDraw<'_> {
    fn draw(&mut self, drawn: Pictures) -> Result<(), String> {
        let files = match drawn {
            Pictures::Touching(svg) => vec![(self.touching.take(), svg)],
            Pictures::Free(svgs) => self.free.into_iter().zip(svgs).collect(),
        };
        files.into_iter().filter_map(|(file, svg)| Some((file?, svg))).try_for_each(|(file, svg)| {
            fs::write(file, svg).map_err(|why| format!("cannot write {}: {why}", file.display()))
        })
    }
}

/// Prints the table.
#[must_use]
pub fn run(choice: &Choice) -> ExitCode {
    let mut groups = BTreeMap::<String, Vec<EdgeReport>>::new();
    let free = [choice.clearance.as_deref(), choice.grown.as_deref()];
    let mut to_draw = ToDraw { touching: choice.picture.as_deref(), free };
    let read = choice.files.iter().try_for_each(|file| read(file, &mut groups, &mut to_draw));
    if read.is_err() {
        return crate::output::ended(read.map(|()| true));
    }
    match print(&groups, &mut io::stdout().lock()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => crate::output::failed("cannot write the table", &why),
    }
}

/// Asks every path of a file, and puts its edges into the group of its first tag. Draws what is still to be drawn.
fn read(file: &Path, groups: &mut BTreeMap<String, Vec<EdgeReport>>, to_draw: &mut ToDraw<'_>) -> Result<(), String> {
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
        let is_done = to_draw.touching.is_none() && to_draw.free == [None; 2];
        if !is_done && let Some(drawn) = pictures(&object, &meshes).map_err(|problem| failed(problem.message))? {
            to_draw.draw(drawn)?;
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
