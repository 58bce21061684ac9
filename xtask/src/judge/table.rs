//! The judgement as a table, a figure, and files.

use std::fmt::Write as _;
use std::fs;
use std::io::{self, Write as _};
use std::path::Path;

use crate::plot::duration;
use crate::validate::summary::quantile;
use workloads::provenance::provenance;

use super::figure::{self, Point};
use super::questions::SETS;
use super::verdict::{Outcome, Verdict};
use super::witnesses::Witness;

/// What became of the answers of one to the questions of a set.
#[derive(Clone, Debug)]
pub struct Row {
    pub peer: String,
    pub set: &'static str,
    asked: usize,
    none: usize,
    right: usize,
    off: usize,
    pub disproved: usize,
    open: usize,
    errors: Vec<f64>,
    times: Vec<f64>,
}

impl Row {
    pub fn new(peer: &str, set: &'static str) -> Self {
        let (errors, times) = (Vec::new(), Vec::new());
        Self { peer: peer.to_owned(), set, asked: 0, none: 0, right: 0, off: 0, disproved: 0, open: 0, errors, times }
    }

    /// Counts an answer.
    pub fn add(&mut self, verdict: &Verdict, ns: f64) {
        self.asked += 1;
        match verdict.outcome {
            Outcome::Right => self.right += 1,
            Outcome::Off => self.off += 1,
            Outcome::Disproved => self.disproved += 1,
            Outcome::Open => self.open += 1,
        }
        self.errors.extend(verdict.error);
        self.times.push(ns);
    }

    /// Counts a question without an answer, which was asked or not.
    pub fn add_none(&mut self, asked: bool) {
        self.asked += usize::from(asked);
        self.none += usize::from(asked);
    }

    /// Its mark in the figure; none where no length was asked.
    #[must_use]
    pub fn point(&self) -> Option<Point> {
        Some(Point {
            set: self.set.to_owned(),
            who: self.peer.clone(),
            disproved: self.disproved,
            error: quantile(&self.errors, 0.99)?,
            ns: quantile(&self.times, 0.5)?,
        })
    }

    /// The names of the cells.
    const HEADERS: [&str; 12] = [
        "question",
        "who",
        "asked",
        "right",
        "off",
        "disproved",
        "no answer",
        "open",
        "median error",
        "99th percentile",
        "worst",
        "median time",
    ];

    /// As text; `number` writes errors, `time` writes nanoseconds.
    fn cells(&self, number: impl Fn(f64) -> String, time: impl Fn(f64) -> String) -> [String; 12] {
        let error = |p| quantile(&self.errors, p).map_or_else(String::new, &number);
        let counts =
            [self.asked, self.right, self.off, self.disproved, self.none, self.open].map(|count| count.to_string());
        let [asked, right, off, disproved, none, open] = counts;
        let finite: Vec<f64> = self.times.iter().copied().filter(|ns| ns.is_finite()).collect();
        let median = quantile(&finite, 0.5).map_or_else(String::new, time);
        let (set, peer) = (self.set.to_owned(), self.peer.clone());
        [set, peer, asked, right, off, disproved, none, open, error(0.5), error(0.99), error(1.0), median]
    }
}

/// Everything that was found.
#[derive(Debug)]
pub struct Report<'a> {
    pub rows: Vec<Row>,
    pub witnesses: &'a [Witness],
    pub cases: usize,
    /// How many truths are known, and whose brackets do not hold them.
    pub violated: &'a (usize, Vec<String>),
}

impl Report<'_> {
    /// Writes the files, and prints the table.
    ///
    /// # Errors
    /// Where a file cannot be written.
    pub fn write(&self, folder: &Path, disproved: &str) -> io::Result<()> {
        fs::create_dir_all(folder)?;
        let markdown = self.markdown();
        fs::write(folder.join("judge.md"), &markdown)?;
        fs::write(folder.join("judge.csv"), self.csv())?;
        fs::write(folder.join("disproved.jsonl"), disproved)?;
        fs::write(folder.join("judge.svg"), self.figure())?;
        let mut output = io::stdout().lock();
        writeln!(output, "{markdown}\nwritten to {}: judge.md, judge.csv, judge.svg, disproved.jsonl", folder.display())
    }

    /// Writes the table and the figure into the folder of notes.
    ///
    /// # Errors
    /// Where a file cannot be written.
    pub fn record(&self, docs: &Path) -> io::Result<()> {
        fs::write(docs.join("judge.md"), self.markdown() + BY_HAND)?;
        fs::write(docs.join("judge.csv"), self.csv())?;
        fs::write(docs.join("figures/judge.svg"), self.figure())
    }

    /// The figure as a picture of its own, which has a ground.
    fn figure(&self) -> String {
        let marks = figure::marks(&figure::read(&self.csv()), |who| !self.is_measured(who));
        marks.svg().replacen("<svg ", "<svg style=\"background:#fff;color:#1c1c1e\" ", 1)
    }

    /// Whether somebody was asked in this run.
    fn is_measured(&self, who: &str) -> bool {
        self.witnesses.iter().any(|witness| witness.name == who && witness.is_measured)
    }

    /// The rows in the order of the questions, and of those who answer.
    fn sorted(&self) -> Vec<&Row> {
        let mut sets: Vec<&str> = Vec::new();
        for row in &self.rows {
            if !sets.contains(&row.set) {
                sets.push(row.set);
            }
        }
        sets.sort_by_key(|set| SETS.iter().position(|known| known == set).unwrap_or(usize::MAX));
        sets.iter().flat_map(|set| self.rows.iter().filter(move |row| row.set == *set && row.asked > 0)).collect()
    }

    fn csv(&self) -> String {
        let exact = |value: f64| format!("{value:e}");
        let lines = self.sorted().into_iter().map(|row| row.cells(exact, |ns| format!("{ns:.1}")).join(","));
        [Row::HEADERS.join(",")].into_iter().chain(lines).map(|line| line + "\n").collect()
    }

    fn markdown(&self) -> String {
        let (known, violated) = self.violated;
        let mut text = format!(
            "# Other libraries, judged\n\n{}\n\n{}\n\nMeasured on {}.\n\n",
            INTRODUCTION.trim(),
            COMMANDS.trim(),
            provenance()
        );
        let held = match violated.len() {
            0 => "in all of them".to_owned(),
            count => format!("in all but {count}"),
        };
        let _ = writeln!(
            text,
            "{} questions. Of {known} of them the truth is known besides; the brackets hold it {held}.\n",
            self.cases
        );
        for id in violated {
            let _ = writeln!(text, "- the bracket of {id} does not hold the truth");
        }
        for witness in self.witnesses {
            let Witness { name, tolerance, of_motion, rounding, settings, .. } = witness;
            let tolerance = if *tolerance > 0.0 { format!("{tolerance:e}, or ") } else { String::new() };
            let motion = if *of_motion > 0.0 { format!("{of_motion:e} of the motion, or ") } else { String::new() };
            let _ = writeln!(text, "- **{name}**: {settings}. Allowed: {tolerance}{motion}{rounding:e} of the reach.");
        }
        let _ =
            writeln!(text, "\n| {} |\n|---|---|{}", Row::HEADERS.join(" | "), "---:|".repeat(Row::HEADERS.len() - 2));
        for row in self.sorted() {
            let cells = row.cells(|error| if error == 0.0 { "0".to_owned() } else { format!("{error:.0e}") }, duration);
            let _ = writeln!(text, "| {} |", cells.join(" | "));
        }
        text
    }
}

/// How to make the table again.
const COMMANDS: &str = "\
```sh
cargo xtask judge --each 100 --questions target/judge/questions.jsonl
python3 -m venv target/venv && target/venv/bin/pip install -r benches/peers/requirements.txt
for peer in coal fcl ipctk mujoco; do
    target/venv/bin/python benches/peers/${peer}_answers.py target/judge/questions.jsonl target/judge/$peer.jsonl
done
target/venv/bin/python benches/peers/ipctk_answers.py --ccd tight-inclusion target/judge/questions.jsonl target/judge/ipctk-ti.jsonl
cargo run --release -p studies --features peers,box3d,jolt -- judge --each 100 \\
    --answers target/judge/{coal,mujoco,fcl,ipctk,ipctk-ti}.jsonl   # --record writes this note
```

The IPC toolkit takes a few minutes, the others seconds. Box3D and Jolt are built from source by a C++ compiler and \
cmake; without them the last command is `cargo xtask judge`, with the same options.

Claims that are disproved are written with their questions and what shows it to `target/judge/disproved.jsonl`.";

/// What was checked without any of this.
const BY_HAND: &str = "
## Six claims, checked by hand

Of parry 0.31.1, without a bracket of ours:

- *suite: ray cast*, `closed_form/316`, in `f32`: a miss. Source, direction, centre and radius are whole numbers of some 1e10; in exact arithmetic the quadratic has a \
positive discriminant, the line passes the ball's centre at 0.2517 of its radius, and the ray enters at λ = 0.80328. Squares of such numbers, squared, are beyond `f32`.
- *turning cast*, `ball-cuboid/320` (`--each 50` asks it), in `f32`: a miss. At t = 0.4508 the centre of the ball, in coordinates of the turned box, is 0.92716 from the box, less than its radius of 1.
- *suite: depth*, `signed_distance/1`, in `f64`: apart by 7.1e-8. The centre of the box is within the cylinder, at 0.02 of its half height and 0.13 of its radius; both bodies are some 1e-6 large.

Of FCL 0.7.0, of bodies that its own `collide` finds overlapping when they are put there:

- *linear cast*, `capsule-capsule/880`: a miss. At t = 0.48096 the axes of the capsules are 0.35998 apart at most, as points of theirs \
show; the sum of the radii is 0.75.
- *linear cast*, `hull16-hull16/1840`: a miss. At t = 0.52559 both hulls have the point (0.30389, -0.34808, 0.30753) inside: it is a mean of the \
corners of either, each with a weight of 0.004 at least.
- *suite: linear cast*, `linear_cast/39`: a miss. At t = 7.53517 the centre of the ball, of radius 1.1608, is that of the box.
";

/// What the columns are.
const INTRODUCTION: &str = "\
Every answer is compared with a bracket that is proved by geometry, not with an answer of ours. It is

- *right* if its error is at most what is allowed. That is a length, the greatest of these: the tolerance that \
the library documents, for some libraries a part of the motion, and the rounding of the precision.
- *off* if the hit, miss, overlap or gap is as claimed, but its time or length is not right.
- *disproved* if the claimed hit, miss, overlap or gap is proved to be false, by more than what is allowed: the \
bodies are apart at the time of a claimed hit, or deep in one another on the way of a claimed miss.
- *no answer* if the library returned an error.
- *open* if the bracket did not close, or if it is a miss and only rounding decides whether a corner is met.

A library is not asked about shapes that it does not have, nor about cases that its documentation leaves \
undefined. An error is a length in units of the reach of the scene, the distance from the origin of the farthest \
corner of a body's box. The error of a time is how far the bodies are from touching at that time, or how far \
they have moved since they touched.";
