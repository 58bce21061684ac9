//! What the notes name: each file, folder and item between backticks must be in the tree, so that a change that moves
//! or renames one finds the sentences about it.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use super::{files, read};

/// How the names of files end that a note may speak of.
const FILES: [&str; 15] =
    ["rs", "md", "toml", "sh", "py", "csv", "json", "jsonl", "svg", "png", "yml", "css", "txt", "obj", "urdf"];

/// Where items, features, options of programs and fields of data are named.
const SOURCES: [&str; 6] = ["rs", "toml", "py", "sh", "css", "jsonl"];

/// Names of other programs and languages, and of files that a task writes.
const FOREIGN: &[&str] = &[
    // Bevy
    "ConicalFrustum",
    "Extrusion",
    "Plane3d",
    "Segment3d",
    "Torus",
    "Triangle3d",
    "bevy_math",
    "bevy_shape",
    // CGAL
    "Approximate_min_ellipsoid_d",
    "Min_ellipse_2",
    // parry
    "PersistentQueryDispatcher",
    "Rot2",
    "Rot3",
    "TrackedContact",
    "Unsupported",
    "compute_impact_geometry_on_penetration",
    "contact_manifolds",
    "local_p1",
    "local_p2",
    "normal1",
    "witness1",
    // other crates and programs
    "callgrind_annotate",
    "chull",
    "inari",
    "obvhs",
    "quickhull",
    "rstar",
    "xargs",
    // Rust and cargo
    "repository",
    "unsafe",
    // written by `cargo xtask scene`
    "film.png",
];

/// Shorter names are symbols of formulas.
const SHORTEST: usize = 4;

/// What is in the tree.
struct Tree {
    files: Vec<PathBuf>,
    /// Identifiers in sources, comments left out, and the names of files without their ends.
    words: HashSet<String>,
}

impl Tree {
    fn read(root: &Path) -> Result<Self, String> {
        let mut tree = Self { files: Vec::new(), words: FOREIGN.iter().map(|&name| name.to_owned()).collect() };
        for kind in FILES {
            for file in files(root, kind)? {
                if SOURCES.contains(&kind) {
                    let text = read(&file)?;
                    let is_comment = |line: &&str| kind == "rs" && line.trim_start().starts_with("//");
                    let code = text.lines().filter(|line| !is_comment(line));
                    tree.words.extend(code.flat_map(identifiers).map(str::to_owned));
                }
                tree.words.extend(file.file_stem().map(|stem| stem.to_string_lossy().into_owned()));
                tree.files.push(file.strip_prefix(root).unwrap_or(&file).to_owned());
            }
        }
        Ok(tree)
    }

    /// Whether there is a file or folder that this is the end of the path of.
    fn has(&self, path: &str) -> bool {
        let end = Path::new(path.trim_start_matches("../").trim_start_matches("./"));
        let is_written = end.starts_with("target") || FOREIGN.contains(&path);
        is_written || self.files.iter().any(|file| file.ancestors().any(|part| part.ends_with(end)))
    }

    /// What the code between two backticks names that is not there.
    fn unknown<'c>(&self, code: &'c str) -> Vec<&'c str> {
        let mut unknown: Vec<&str> = code.split_whitespace().filter(|word| is_path(word) && !self.has(word)).collect();
        // An item, or a call, a type or an initializer that begins with one.
        let path = code.split(|c: char| !is_of_identifier(c) && c != ':').next().unwrap_or_default();
        if code[path.len()..].is_empty() || code[path.len()..].starts_with(['(', '<', '!', '{', '[']) {
            let missing = |name: &&str| name.len() >= SHORTEST && !name.starts_with(|c: char| c.is_ascii_digit());
            unknown.extend(path.split("::").filter(missing).filter(|name| !self.words.contains(*name)));
        }
        unknown
    }
}

fn is_of_identifier(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

fn identifiers(line: &str) -> impl Iterator<Item = &str> {
    line.split(|c| !is_of_identifier(c)).filter(|word| !word.is_empty())
}

/// Whether a word of a note is the path of a file or, with a stroke at its end, of a folder.
fn is_path(word: &str) -> bool {
    let is_plain = word.chars().all(|c| is_of_identifier(c) || matches!(c, '.' | '/' | '-'));
    let names_file = word.rsplit_once('.').is_some_and(|(stem, end)| !stem.is_empty() && FILES.contains(&end));
    is_plain && (names_file || word.len() > 1 && word.ends_with('/'))
}

/// The code between backticks in a note, blocks of code left out.
fn code(note: &str) -> impl Iterator<Item = &str> {
    note.split("```").step_by(2).flat_map(|prose| prose.split('`').skip(1).step_by(2))
}

/// What the notes and READMEs name that is not in the tree. Changelogs tell of what is gone, too.
pub(super) fn missing(root: &Path) -> Result<Vec<String>, String> {
    let tree = Tree::read(root)?;
    let mut missing = Vec::new();
    for note in files(root, "md")?.iter().filter(|note| !note.ends_with("CHANGELOG.md")) {
        let text = read(note)?;
        for code in code(&text) {
            let complaint = |name: &str| {
                let note = note.strip_prefix(root).unwrap_or(note).display();
                format!("{note} names {name} in `{code}`, which is nowhere in the tree: renamed, moved or gone?")
            };
            missing.extend(tree.unknown(code).into_iter().map(complaint));
        }
    }
    Ok(missing)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_told_from_a_formula_and_a_path_from_a_quotient() {
        let tree = Tree {
            files: ["crates/one/src/cast/bracket.rs", "README.md"].map(PathBuf::from).to_vec(),
            words: ["Bracket", "lower", "with_limit"].map(str::to_owned).into(),
        };
        for known in [
            "bracket.rs",
            "cast/bracket.rs",
            "src/cast/",
            "../README.md",
            "cat README.md",
            "target/report/index.html",
            "Bracket::lower",
            "with_limit(d)",
            "Bracket<S>",
            "v·w / |v|",
            "h_A(d) + h_B(−d)",
            "a/b",
            "1.5e308",
            "",
        ] {
            assert_eq!(tree.unknown(known), Vec::<&str>::new(), "{known}");
        }
        for (code, unknown) in [
            ("bracket.py", "bracket.py"),
            ("ast/bracket.rs", "ast/bracket.rs"),
            ("portal/", "portal/"),
            ("cat LICENSE.md", "LICENSE.md"),
            ("Bracket::upper", "upper"),
            ("Brackets<S>", "Brackets"),
            ("without_limit(d)", "without_limit"),
        ] {
            assert_eq!(tree.unknown(code), [unknown], "{code}");
        }
        let note = "A `Bracket` has\n```rust\nlet x = `no name`;\n```\na `lower` end.";
        assert_eq!(code(note).collect::<Vec<_>>(), ["Bracket", "lower"]);
    }
}
