//! The files of gjk-raycast that one question goes through, counted under callgrind in a build without optimisation.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::Path;
use std::process::{Command, Stdio};

use super::circles::without_tests;

/// A question and the files whose lines ran within it, `lib.rs` left out.
pub(super) struct Question {
    pub(super) name: String,
    pub(super) files: Vec<String>,
    /// The lines of these files, unit tests left out.
    pub(super) lines: usize,
}

/// What of a path within the workspace is left out.
const SRC: &str = "gjk-raycast/src/";

/// One question of each kind; `None` if valgrind is not installed.
pub(super) fn questions(root: &Path) -> io::Result<Option<Vec<Question>>> {
    if Command::new("valgrind").arg("--version").stdout(Stdio::null()).status().is_err() {
        return Ok(None);
    }
    let target = root.join("target/walk");
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let built = Command::new(cargo)
        .args(["build", "--quiet", "--package", "walk"])
        .current_dir(root)
        .env("CARGO_TARGET_DIR", &target)
        // Lines are what is counted.
        .env("CARGO_PROFILE_DEV_DEBUG", "1")
        .status()?;
    if !built.success() {
        return Err(io::Error::other("the package `walk` does not build"));
    }
    let program = target.join("debug/walk");
    let names = Command::new(&program).output()?.stdout;
    let names = String::from_utf8_lossy(&names);
    names.lines().map(|name| question(name, &program, root)).collect::<io::Result<_>>().map(Some)
}

fn question(name: &str, program: &Path, root: &Path) -> io::Result<Question> {
    let counts = program.with_file_name(format!("{name}.callgrind"));
    let asked = Command::new("valgrind")
        .args(["--tool=callgrind", "--toggle-collect=walk::counted_*"])
        .arg(format!("--callgrind-out-file={}", counts.display()))
        .args([program.as_os_str(), name.as_ref()])
        .output()?;
    if !asked.status.success() {
        return Err(io::Error::other(format!("{name}: {}", String::from_utf8_lossy(&asked.stderr))));
    }
    let text = fs::read_to_string(&counts)?;
    let mut files = Vec::new();
    let mut lines = 0;
    for file in ran(&text).into_iter().filter_map(|path| path.split_once(SRC)).map(|(_, file)| file) {
        let path = root.join("crates").join(SRC).join(file);
        if file != "lib.rs" && path.exists() {
            lines += without_tests(&fs::read_to_string(path)?).trim_end().lines().count();
            files.push(file.to_owned());
        }
    }
    Ok(Question { name: name.to_owned(), files, lines })
}

/// The files of which callgrind has counted instructions. It names a file once and by a number from then on; the line
/// after `calls=` is about the called function.
fn ran(counts: &str) -> BTreeSet<&str> {
    let mut names = BTreeMap::new();
    let mut ran = BTreeSet::new();
    let (mut here, mut is_call) = (None, false);
    for line in counts.lines() {
        if let Some((kind, rest)) = line.split_once("=(")
            && ["fl", "fi", "fe", "cfl", "cfi"].contains(&kind)
            && let Some((number, name)) = rest.split_once(')')
        {
            if let Some(name) = name.strip_prefix(' ') {
                names.insert(number, name);
            }
            if !kind.starts_with('c') {
                here = names.get(number).copied();
            }
        } else if line.starts_with("calls=") {
            is_call = true;
        } else if line.starts_with(|c: char| c.is_ascii_digit() || "+-*".contains(c)) && !std::mem::take(&mut is_call) {
            ran.extend(here);
        }
    }
    ran
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_function_calls_is_not_its_own_file() {
        let counts =
            "fl=(1) a.rs\nfn=(1) f\n12 3\ncfi=(2) b.rs\ncfn=(2) g\ncalls=1 7\n13 40\nfi=(3) c.rs\n+1 2\nfe=(1)\n* 1\n";
        assert_eq!(ran(counts).into_iter().collect::<Vec<_>>(), ["a.rs", "c.rs"], "b.rs was only called");
    }
}
