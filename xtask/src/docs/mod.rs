//! `cargo xtask docs`: the API documentation of the four libraries as docs.rs builds it, with every feature and no
//! warning let pass; and a check that what the pages and the notes refer to is there, without a network.

mod names;
mod numbers;

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

const LIBRARIES: [&str; 4] = ["convex-support", "gjk-raycast", "lj-ellipsoid", "ellip-margin"];

/// Builds the pages, checks them and the notes, and says where they are.
pub fn run() -> ExitCode {
    let root = root();
    let checked = |pages: PathBuf| {
        let complaints = [missing(root)?, names::missing(root)?, numbers::differing(root)?, fetched(&pages)?].concat();
        for complaint in &complaints {
            let _ = writeln!(io::stderr(), "error: {complaint}");
        }
        let _ = writeln!(io::stdout(), "{}", pages.join("convex_support/index.html").display());
        Ok(complaints.is_empty())
    };
    crate::output::ended(build(root).and_then(checked))
}

/// The folder of the workspace.
fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."))
}

/// The folder of the pages.
fn build(root: &Path) -> Result<PathBuf, String> {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root).env("RUSTDOCFLAGS", "-D warnings");
    command.args(["doc", "--no-deps", "--all-features"]);
    command.args(LIBRARIES.iter().flat_map(|library| ["--package", library]));
    let status = command.status().map_err(|why| format!("cannot run cargo: {why}"))?;
    if !status.success() {
        return Err("the documentation does not build".to_owned());
    }
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    Ok(target.join("doc"))
}

/// The relative links in the notes and READMEs that lead nowhere: to no file, or to no heading of a note.
fn missing(root: &Path) -> Result<Vec<String>, String> {
    let mut missing = Vec::new();
    for note in files(root, "md")? {
        let text = read(&note)?;
        for target in text.split("](").skip(1).filter_map(|rest| rest.split([')', ' ']).next()) {
            let (file, heading) = target.split_once('#').unwrap_or((target, ""));
            if target.contains("://") {
                continue;
            }
            let there = if file.is_empty() { note.clone() } else { note.with_file_name(file) };
            let is_note = there.extension().is_some_and(|e| e == "md") && !heading.is_empty();
            if !there.exists() || is_note && !anchors(&read(&there)?).any(|anchor| anchor == heading) {
                missing.push(format!("{} links to {target}, which is not there", note.display()));
            }
        }
    }
    Ok(missing)
}

/// What the headings of a note are called in links: small letters, with strokes for spaces, and without other signs.
fn anchors(text: &str) -> impl Iterator<Item = String> {
    let headings = text.split("```").step_by(2).flat_map(str::lines).filter(|line| line.starts_with('#'));
    let sign = |c: char| match c {
        ' ' => Some('-'),
        '-' | '_' => Some(c),
        c => c.is_alphanumeric().then_some(c),
    };
    headings.map(move |line| line.trim_start_matches('#').trim().to_lowercase().chars().filter_map(sign).collect())
}

/// The pages of the libraries that a browser would fetch something for.
fn fetched(pages: &Path) -> Result<Vec<String>, String> {
    let mut fetched = Vec::new();
    for library in LIBRARIES {
        for page in files(&pages.join(library.replace('-', "_")), "html")? {
            let text = read(&page)?;
            if ["src=\"http", "src=\"//", "url(http"].iter().any(|sign| text.contains(sign)) {
                fetched.push(format!("{} needs the network", page.display()));
            }
        }
    }
    Ok(fetched)
}

fn read(file: &Path) -> Result<String, String> {
    fs::read_to_string(file).map_err(|why| format!("cannot read {}: {why}", file.display()))
}

/// All files below `folder` that end with `.extension`, but for hidden folders and cargo's own.
fn files(folder: &Path, extension: &str) -> Result<Vec<PathBuf>, String> {
    let failed = |why: io::Error| format!("cannot read {}: {why}", folder.display());
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if path.is_dir() && name != "target" && !name.starts_with('.') {
            found.extend(files(&path, extension)?);
        } else if path.extension().is_some_and(|e| e == extension) {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_are_linked_to_as_on_the_web() {
        let found: Vec<String> = anchors("# A `b_c`, and (d)\n```sh\n# no heading\n```\n## Two–three\n").collect();
        assert_eq!(found, ["a-b_c-and-d", "twothree"]);
    }

    #[test]
    fn the_notes_lead_nowhere_that_is_not_there() {
        let found = missing(root())
            .and_then(|links| Ok([links, names::missing(root())?, numbers::differing(root())?].concat()));
        assert_eq!(found, Ok(Vec::new()));
    }
}
