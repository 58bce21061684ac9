//! The true overlaps and distances of a scene, where somebody has computed them.

use std::collections::HashMap;
use std::fs;
use std::io::{self, Write};
use std::path::Path;

use serde::Deserialize;

#[derive(Debug, Deserialize)]
struct Line {
    step: usize,
    link: String,
    obstacle: usize,
    overlap: bool,
    distance: f64,
    gap: f64,
}

/// True answers, and how ours compare.
#[derive(Debug)]
pub(super) struct Truth {
    lines: HashMap<(usize, String, usize), Line>,
    compared: usize,
    wrong_flags: usize,
    worst_error: f64,
}

impl Truth {
    /// The error of a distance, in metres, that is put down to the rounding of poses and of the truth itself, for
    /// bodies within a metre or two of the origin.
    const ALLOWED: f64 = 1e-12;

    pub(super) fn read(path: &Path) -> Result<Self, String> {
        let text = fs::read_to_string(path).map_err(|why| format!("cannot read {}: {why}", path.display()))?;
        let mut lines = HashMap::new();
        for (number, line) in text.lines().enumerate() {
            let line: Line =
                serde_json::from_str(line).map_err(|why| format!("{} line {}: {why}", path.display(), number + 1))?;
            lines.insert((line.step, line.link.clone(), line.obstacle), line);
        }
        Ok(Self { lines, compared: 0, wrong_flags: 0, worst_error: 0.0 })
    }

    /// Compares a pair, if its truth is known; its distance is asked for only then.
    pub(super) fn compare(
        &mut self,
        step: usize,
        link: &str,
        obstacle: usize,
        overlap: bool,
        distance: impl FnOnce() -> f64,
    ) {
        let Some(truth) = self.lines.get(&(step, link.to_owned(), obstacle)) else { return };
        self.compared += 1;
        self.wrong_flags += usize::from(overlap != truth.overlap);
        let error = ((distance() - truth.distance).abs() - truth.gap).max(0.0);
        self.worst_error = self.worst_error.max(error);
    }

    /// Whether every line of it was compared and found to agree.
    pub(super) fn holds(&self) -> bool {
        self.compared == self.lines.len() && self.wrong_flags == 0 && self.worst_error <= Self::ALLOWED
    }

    pub(super) fn print(&self, output: &mut impl Write) -> io::Result<()> {
        let Self { lines, compared, wrong_flags, worst_error } = self;
        let total = lines.len();
        writeln!(
            output,
            "against the truth: {compared} of {total} pairs, {wrong_flags} wrong overlaps, worst distance error {worst_error:.1e} m"
        )
    }
}
