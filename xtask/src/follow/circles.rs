//! Circles of imports: files of a library each of which imports, perhaps by way of others, something that the next one
//! defines.
//!
//! A `use` is resolved through re-exports to the file of the definition: `use crate::Ball` leads to `shapes/ball.rs`.
//! Names of the language are read by the shape of their lines, as rustfmt writes them, and not by a parser.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::Path;

/// The text of each file of a library without its unit tests, by the path within `src`.
pub(super) type Files = BTreeMap<String, String>;

pub(super) fn read(src: &Path) -> io::Result<Files> {
    let mut files = Files::new();
    let mut folders = vec![src.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = fs::read_to_string(&path)?;
                let name = path.strip_prefix(src).map_err(io::Error::other)?.to_string_lossy().replace('\\', "/");
                files.insert(name, without_tests(&text).to_owned());
            }
        }
    }
    Ok(files)
}

/// A file's text up to its unit tests.
pub(super) fn without_tests(text: &str) -> &str {
    text.split("#[cfg(test)]\nmod tests").next().unwrap_or(text)
}

/// The circles, each as the files that reach one another.
pub(super) fn circles(files: &Files) -> Vec<Vec<&str>> {
    let imports = imports(files);
    let reached: BTreeMap<&str, BTreeSet<&str>> =
        files.keys().map(|file| (file.as_str(), reached_from(file, &imports))).collect();
    let mut circles: Vec<Vec<&str>> = Vec::new();
    for (&file, there) in &reached {
        let circle: Vec<&str> = there.iter().copied().filter(|other| reached[other].contains(file)).collect();
        if circle.len() > 1 && !circles.contains(&circle) {
            circles.push(circle);
        }
    }
    circles
}

type Imports<'f> = BTreeMap<&'f str, BTreeSet<&'f str>>;

fn reached_from<'f>(file: &'f str, imports: &Imports<'f>) -> BTreeSet<&'f str> {
    let mut reached = BTreeSet::new();
    let mut pending = vec![file];
    while let Some(file) = pending.pop() {
        for &next in imports.get(file).into_iter().flatten() {
            if reached.insert(next) {
                pending.push(next);
            }
        }
    }
    reached
}

/// The files whose definitions each file imports.
fn imports(files: &Files) -> Imports<'_> {
    let mut definitions: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (file, text) in files {
        for name in text.lines().filter_map(defined) {
            definitions.entry(name).or_default().insert(file);
        }
    }
    let mut imports = Imports::new();
    for (file, text) in files {
        for path in uses(text).iter().flat_map(|used| expanded(used)) {
            if let Some(target) = resolved(&path, file, files, &definitions)
                && target != file
            {
                imports.entry(file).or_default().insert(target);
            }
        }
    }
    imports
}

/// The name that a line at the left margin defines.
fn defined(line: &str) -> Option<&str> {
    let mut words = line.split(' ').peekable();
    if words.peek().is_some_and(|word| word.starts_with("pub")) {
        words.next();
    }
    let mut word = words.next()?;
    if matches!(word, "const" | "unsafe") && words.peek() == Some(&"fn") {
        word = words.next()?;
    }
    if !matches!(word, "fn" | "struct" | "enum" | "trait" | "type" | "const" | "static") {
        return None;
    }
    let name = words.next()?;
    let end = name.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(name.len());
    Some(&name[..end]).filter(|name| !name.is_empty())
}

/// What the `use` lines at the left margin import from the library itself.
fn uses(text: &str) -> Vec<String> {
    let mut uses = Vec::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        let mut rest = line;
        if rest.starts_with("pub") {
            rest = rest.split_once(' ').map_or("", |(_, rest)| rest);
        }
        let Some(path) = rest.strip_prefix("use ") else { continue };
        if !["crate", "super", "self"].iter().any(|root| path.starts_with(root)) {
            continue;
        }
        let mut whole = path.to_owned();
        while !whole.contains(';') {
            let Some(line) = lines.next() else { break };
            whole.push_str(line.trim());
            whole.push(' ');
        }
        uses.push(whole.split(';').next().unwrap_or_default().to_owned());
    }
    uses
}

/// A path for each name within braces.
fn expanded(path: &str) -> Vec<String> {
    let path = path.trim();
    let Some((before, braced)) = path.split_once('{').filter(|_| path.ends_with('}')) else {
        let name = path.split(" as ").next().unwrap_or(path);
        return vec![name.to_owned()];
    };
    let inside = &braced[..braced.len() - 1];
    let (mut depth, mut begin, mut parts) = (0, 0, Vec::new());
    for (at, c) in inside.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&inside[begin..at]);
                begin = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&inside[begin..]);
    let parts = parts.into_iter().map(str::trim).filter(|part| !part.is_empty());
    parts.flat_map(|part| expanded(&format!("{before}{part}"))).collect()
}

/// The file of a module.
fn module<'f>(path: &[&str], files: &'f Files) -> Option<&'f str> {
    let stem = path.join("/");
    let names = if path.is_empty() {
        ["lib.rs".to_owned(), String::new()]
    } else {
        [format!("{stem}.rs"), format!("{stem}/mod.rs")]
    };
    names.iter().find_map(|name| files.get_key_value(name)).map(|(name, _)| name.as_str())
}

/// The file that defines what a path in a `file` names.
fn resolved<'f>(
    path: &str,
    file: &str,
    files: &'f Files,
    definitions: &BTreeMap<&str, BTreeSet<&'f str>>,
) -> Option<&'f str> {
    let mut here: Vec<&str> = file.trim_end_matches(".rs").split('/').filter(|&part| part != "mod").collect();
    if here == ["lib"] {
        here.clear();
    }
    let mut parts = path.split("::").map(str::trim).peekable();
    match parts.peek() {
        Some(&"crate") => {
            here.clear();
            parts.next();
        }
        Some(&"self") => drop(parts.next()),
        _ => {}
    }
    while parts.next_if_eq(&"super").is_some() {
        here.pop();
    }
    let mut rest: Vec<&str> = parts.collect();
    while let Some(&next) = rest.first() {
        let deeper: Vec<&str> = here.iter().copied().chain([next]).collect();
        let is_item = rest.len() == 1 && definitions.contains_key(next);
        if is_item || module(&deeper, files).is_none() {
            break;
        }
        here = deeper;
        rest.remove(0);
    }
    let Some(name) = rest.first() else { return module(&here, files) };
    let defining = definitions.get(name)?;
    let folder = if here.is_empty() { String::new() } else { format!("{}/", here.join("/")) };
    let own = module(&here, files).filter(|file| defining.contains(file));
    let within: Vec<&str> = defining.iter().copied().filter(|file| file.starts_with(&folder)).collect();
    own.or(match (within.as_slice(), defining.len()) {
        (&[file], _) => Some(file),
        (_, 1) => defining.first().copied(),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(files: &[(&str, &str)]) -> Files {
        files.iter().map(|&(name, text)| (name.to_owned(), text.to_owned())).collect()
    }

    #[test]
    fn a_circle_is_found_through_re_exports_and_braces() {
        let files = of(&[
            ("lib.rs", "mod a;\nmod b;\npub use a::Apple;\npub use b::c::Cherry;\n"),
            ("a.rs", "use crate::{Cherry, b::c::{other}};\n\npub struct Apple;\n"),
            ("b/mod.rs", "pub mod c;\n"),
            ("b/c.rs", "use crate::Apple;\n\npub struct Cherry;\npub(crate) const fn other() {}\n"),
        ]);
        assert_eq!(circles(&files), [["a.rs", "b/c.rs"]], "both define what the other one imports");
    }

    #[test]
    fn unit_tests_and_imports_that_lead_one_way_make_no_circle() {
        let text = "use super::b::Berry;\n#[cfg(test)]\nmod tests {\n}\n";
        let files = of(&[("lib.rs", ""), ("a.rs", without_tests(text)), ("b.rs", "pub struct Berry;\n")]);
        assert!(circles(&files).is_empty(), "one way");
    }
}
