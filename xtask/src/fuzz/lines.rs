//! The lines of the embedded suite, damaged: whatever is asked, there is one line of JSON for an answer, and no panic.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::Value;
use serde_json::value::RawValue;

use super::Verdict;
use crate::EMBEDDED;
use crate::mesh::Meshes;
use crate::query;
use workloads::rng::Rng;

/// Longer lines are left out: most of the time would go into a few of them.
const LONGEST: usize = 4096;

/// No line of that length may take longer.
const SLOWEST: Duration = Duration::from_secs(20);

/// What a number or a word is replaced by: the ends of the ranges of both precisions, and what is no number at all.
const EXTREMES: &[&str] = &[
    "0",
    "-0.0",
    "1",
    "-1",
    "1e308",
    "-1e308",
    "1e309",
    "1e-308",
    "5e-324",
    "1e38",
    "1e39",
    "1e-45",
    "1e-46",
    "1e18",
    "1e-18",
    "3",
    "1e400",
    "NaN",
    "Infinity",
    "null",
    "true",
    "\"\"",
    "[]",
    "{}",
    "[1,2,3]",
    "[0,0,0]",
    "1.0000000000000002",
    "0.9999999999999999",
    "18446744073709551616",
    "01",
    "+1",
    ".5",
    "1e",
];

/// The lines to begin with.
pub(super) struct Suite {
    lines: Vec<Vec<u8>>,
    meshes: Meshes,
}

impl Suite {
    pub(super) fn read() -> io::Result<Self> {
        let mut lines = Vec::new();
        let mut files: Vec<_> = fs::read_dir(EMBEDDED)?.collect::<Result<_, _>>()?;
        files.sort_by_key(fs::DirEntry::path);
        for file in files.iter().map(fs::DirEntry::path).filter(|path| path.extension().is_some_and(|e| e == "jsonl")) {
            let text = fs::read(file)?;
            let short = text.split(|&byte| byte == b'\n').filter(|line| (1..=LONGEST).contains(&line.len()));
            lines.extend(short.map(<[u8]>::to_vec));
        }
        if lines.is_empty() {
            return Err(io::Error::other(format!("there are no lines in {EMBEDDED}")));
        }
        Ok(Self { lines, meshes: Meshes::relative_to(Path::new(EMBEDDED)) })
    }

    pub(super) fn case(&self, rng: &mut Rng) -> Verdict {
        let mut line = self.any(rng).clone();
        for _ in 0..=rng.below(4) {
            self.damage(&mut line, rng);
        }
        let told = |what: &str| Err(format!("{what}: {}", String::from_utf8_lossy(&line)));
        let start = Instant::now();
        let Ok(answer) = catch_unwind(AssertUnwindSafe(|| query::answer(&line, &self.meshes))) else {
            return told("a panic");
        };
        if start.elapsed() > SLOWEST {
            return told("too slow");
        }
        // An `id` is given back as it was written, and may have a number that is beyond a double.
        let Ok(answer) = serde_json::from_slice::<BTreeMap<String, &RawValue>>(&answer) else {
            return told("an answer that is no object");
        };
        let value = |field: &&RawValue| serde_json::from_str::<Value>(field.get()).unwrap_or(Value::Null);
        match answer.get("error").map(value) {
            None if answer.contains_key("line") || answer.contains_key("id") => Ok(()),
            Some(error) if error.get("kind").is_some_and(Value::is_string) => Ok(()),
            _ => told("an error of no kind"),
        }
    }

    fn any(&self, rng: &mut Rng) -> &Vec<u8> {
        &self.lines[rng.below(self.lines.len() as u64) as usize]
    }

    /// One change: of a byte, of a stretch, of a number or word, or the end of another line for this one's.
    fn damage(&self, line: &mut Vec<u8>, rng: &mut Rng) {
        if line.is_empty() {
            return;
        }
        let mut place = |line: &[u8]| rng.below(line.len() as u64 + 1) as usize;
        let (i, j) = (place(line), place(line));
        let (i, j) = (i.min(j), i.max(j));
        match rng.below(8) {
            0 => {
                let byte = i.min(line.len() - 1);
                line[byte] ^= 1 << rng.below(8);
            }
            1 => drop(line.drain(i..j.min(i + 8))),
            2 => {
                let copy = line[i..j.min(i + 64)].to_vec();
                drop(line.splice(i..i, copy));
            }
            3 => line.insert(i, b"{}[]\",:-.eE019 \\\xff\0"[rng.below(18) as usize]),
            4 => {
                let other = self.any(rng);
                let from = rng.below(other.len() as u64) as usize;
                line.truncate(i);
                line.extend_from_slice(&other[from..]);
            }
            _ => {
                let words = words(line);
                if words.is_empty() {
                    return;
                }
                let word = words[rng.below(words.len() as u64) as usize].clone();
                let new = EXTREMES[rng.below(EXTREMES.len() as u64) as usize];
                drop(line.splice(word, new.bytes()));
            }
        }
    }
}

/// Where the numbers and bare words of a line are.
fn words(line: &[u8]) -> Vec<std::ops::Range<usize>> {
    let is_part = |b: u8| b.is_ascii_alphanumeric() || b"+-.".contains(&b);
    let mut words = Vec::new();
    let mut start = None;
    for (i, &byte) in line.iter().chain(b" ").enumerate() {
        match (start, is_part(byte)) {
            (None, true) if i == 0 || line[i - 1] != b'"' => start = Some(i),
            (Some(from), false) => {
                words.push(from..i);
                start = None;
            }
            _ => {}
        }
    }
    words
}
