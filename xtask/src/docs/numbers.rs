//! Numbers that the notes repeat: each has one source, which a change of it leaves behind nowhere.

use std::path::Path;

use super::{files, read};

/// A number that the notes repeat: the words before it, those after it, and what it is by its source.
struct Repeated {
    before: &'static str,
    after: &'static str,
    due: String,
}

/// What the notes say otherwise than the source of the number.
pub(super) fn differing(root: &Path) -> Result<Vec<String>, String> {
    let manifest = read(&root.join("Cargo.toml"))?;
    let of =
        |before: &str| manifest.split_once(before).and_then(|(_, rest)| rest.split('"').next()).unwrap_or_default();
    let rust = of("\nrust-version = \"");
    // From `>=0.32, <0.35`: the oldest and the newest minor that are allowed.
    let range = of("\nglam = { version = \"");
    let bound = |sign: &str| range.split(sign).nth(1)?.split(',').next()?.trim().parse::<f64>().ok();
    let (oldest, beyond) = (bound(">=0.").unwrap_or(f64::NAN), bound("<0.").unwrap_or(f64::NAN));
    let poses = read(&root.join("xtask/data/museum.jsonl"))?;
    let poses = poses.lines().filter(|line| !line.starts_with('#')).count();
    let numbers = [
        Repeated { before: "supported Rust version: ", after: ". ", due: rust.to_owned() },
        Repeated { before: "[![Rust ", after: " or later]", due: rust.to_owned() },
        Repeated { before: "a Rust toolchain (", after: " or later)", due: rust.to_owned() },
        Repeated { before: "glam)'s, ", after: ". ", due: format!("0.{oldest} to 0.{}", beyond - 1.0) },
        Repeated { before: "A range, ", after: ", see below", due: format!("0.{oldest} to 0.{}", beyond - 1.0) },
        Repeated { before: "the poses of ", after: " public bug reports", due: poses.to_string() },
    ];
    let mut differing = Vec::new();
    let mut found = [0; 6];
    for note in files(root, "md")? {
        // However the lines are broken.
        let text = read(&note)?.split_whitespace().collect::<Vec<_>>().join(" ") + " ";
        for (number, found) in numbers.iter().zip(&mut found) {
            for rest in text.split(number.before).skip(1) {
                let Some((said, _)) = rest.split_once(number.after) else { continue };
                *found += 1;
                if said != number.due {
                    let note = note.strip_prefix(root).unwrap_or(&note).display();
                    let Repeated { before, due, .. } = number;
                    differing.push(format!("{note} says \"{before}{said}\", which is {due} by its source"));
                }
            }
        }
    }
    let silent = numbers.iter().zip(found).filter(|(_, found)| *found == 0);
    differing.extend(silent.map(|(number, _)| format!("no note says \"{}…\" any more", number.before)));
    Ok(differing)
}
