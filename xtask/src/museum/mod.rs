//! `cargo xtask museum`: poses out of public trackers, where this or that library was wrong, asked here.
//!
//! One file has them, `data/museum.jsonl`, as queries with their truth. The command, the tables and drawings of
//! `docs/museum.md` and the regression test read that file.

mod drawing;
mod sheet;

use std::fmt::Write as _;
use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use checker::Verdict as Proof;
use clap::Args;
use serde_json::Value;
use workloads::note;

use self::drawing::Drawing;
#[cfg(test)]
use self::drawing::Role;
use self::sheet::Cell;
use crate::engine;
use crate::mesh::Meshes;
use crate::output;
use crate::prove::judge_line;
use crate::query::certified;
use crate::table::aligned;
use crate::validate::score::{Verdict, judge, scalar_of};
use crate::wire::answer::Line;
use crate::wire::answer::as_read;
use crate::wire::fields::Object;
use crate::wire::json;

/// What to do with the answers.
#[derive(Clone, Copy, Debug, Args)]
pub struct Choice {
    /// Write the tables into `docs/museum.md`, and the drawings into `docs/figures`.
    #[arg(long)]
    write: bool,
}

/// The poses.
const POSES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/museum.jsonl");

/// A pose, and what is answered.
struct Piece {
    case: Object,
    answer: Object,
    verdict: Verdict,
    /// Whether the certificate proves the answer; none where the query is of a kind that has no certificate.
    proof: Option<Proof>,
}

/// Asks about every pose, and prints the table.
pub fn run(choice: Choice) -> ExitCode {
    let pieces = match pieces() {
        Ok(pieces) => pieces,
        Err(why) => return output::ended(Err(why)),
    };
    if let Err(why) = print(&pieces) {
        return output::failed("cannot write the table", &why);
    }
    let written = if choice.write { write(&pieces) } else { Ok(()) };
    output::ended(written.map(|()| pieces.iter().all(Piece::is_right)))
}

/// Writes the tables and the drawings into the note.
fn write(pieces: &[Piece]) -> Result<(), String> {
    let file = note::path("museum.md");
    for part in &PARTS {
        note::write(&file, part.name, &markdown(pieces, part))
            .map_err(|why| format!("cannot write {}: {why}", file.display()))?;
        let figure = part.figure();
        fs::write(&figure, part.sheet(pieces)?).map_err(|why| format!("cannot write {}: {why}", figure.display()))?;
    }
    Ok(())
}

/// A part of the note: its poses are of these kinds of query.
struct Part {
    name: &'static str,
    title: &'static str,
    queries: &'static [&'static str],
}

const PARTS: [Part; 5] = [
    Part { name: "rays", title: "Rays", queries: &["ray_cast"] },
    Part { name: "casts", title: "Bodies that move", queries: &["linear_cast", "motion_cast"] },
    Part { name: "distances", title: "Distances and overlaps", queries: &["distance", "intersect"] },
    Part { name: "depths", title: "Depths and contacts", queries: &["signed_distance"] },
    Part { name: "ellipsoids", title: "Ellipsoids", queries: &["enclosing_ellipsoid", "inscribed_ellipsoid"] },
];

impl Part {
    fn of<'p>(&self, pieces: &'p [Piece]) -> impl Iterator<Item = &'p Piece> {
        let queries = self.queries;
        pieces.iter().filter(move |piece| queries.contains(&piece.said("query")))
    }

    /// Where its drawings are.
    fn figure(&self) -> PathBuf {
        note::path(&format!("figures/museum-{}.svg", self.name))
    }

    /// Its drawings.
    fn sheet(&self, pieces: &[Piece]) -> Result<String, String> {
        let cells = self.of(pieces).map(Piece::cell).collect::<Result<Vec<_>, _>>()?;
        Ok(sheet::svg(&format!("The museum: {}", self.title.to_lowercase()), &cells))
    }
}

fn pieces() -> Result<Vec<Piece>, String> {
    let text = fs::read_to_string(POSES).map_err(|why| format!("cannot read {POSES}: {why}"))?;
    text.lines().filter(|line| !line.starts_with('#')).map(piece).collect()
}

fn piece(line: &str) -> Result<Piece, String> {
    let meshes = Meshes::relative_to("");
    let case = json::object(line.as_bytes()).map_err(|why| format!("{line}: {}", why.message))?;
    let outcome = engine::question(&case, &meshes).and_then(|question| question.ask());
    let answer = as_read(Line { id: None, line: 1, outcome });
    let proof = certified(line.as_bytes(), &meshes)
        .filter(|line| line.windows(14).any(|part| part == b"\"certificate\":"))
        .map(|line| judge_line(&line, &meshes).0);
    Ok(Piece { verdict: judge(&case, &answer), case, answer, proof })
}

impl Piece {
    fn is_right(&self) -> bool {
        self.verdict.wrong.is_empty() && self.verdict.soft.is_empty() && self.proof != Some(Proof::Disproved)
    }

    fn said(&self, field: &str) -> &str {
        self.case.get(field).and_then(Value::as_str).unwrap_or_default()
    }

    /// The drawing of the pose and of the answer, under its name and its truth.
    fn cell(&self) -> Result<Cell, String> {
        let name = self.said("id").to_owned();
        let drawing = Drawing::new(&self.case, &self.answer).map_err(|why| format!("{name}: {}", why.message))?;
        Ok(Cell { name, truth: self.truth(), drawing })
    }

    /// The link to the report.
    fn link(&self) -> String {
        let issue = self.said("_issue");
        let (project, number) = issue.split_once('#').unwrap_or((issue, ""));
        let name = project.rsplit('/').next().unwrap_or(project);
        format!("[{name} #{number}](https://github.com/{project}/issues/{number})")
    }

    /// What an answer, or the truth, says: a miss, a time, a length.
    fn shown(&self, of: &Object) -> String {
        let query = self.said("query");
        if of.get("hit") == Some(&Value::Bool(false)) {
            return "a miss".to_owned();
        }
        let scalar = scalar_of(query).and_then(|name| of.get(name)?.as_f64());
        match (scalar, of.get("overlap").and_then(Value::as_bool)) {
            (Some(0.0), _) if query == "signed_distance" => "they touch".to_owned(),
            (Some(0.0), _) if query == "distance" => "they overlap".to_owned(),
            (Some(depth), _) if query == "signed_distance" && depth < 0.0 => format!("{} deep", short(-depth)),
            (Some(gap), _) if query.ends_with("distance") => format!("{} apart", short(gap)),
            (Some(at), _) if query.ends_with("cast") => format!("a hit at {}", short(at)),
            (Some(size), _) => format!("ln det X = {}", short(size)),
            (None, Some(overlap)) => if overlap { "they overlap" } else { "they are apart" }.to_owned(),
            (None, None) => "no answer".to_owned(),
        }
    }

    /// How sure the answer is.
    fn proof(&self) -> &'static str {
        match self.proof {
            Some(Proof::Proved) => "proved",
            Some(Proof::NotProved) => "to rounding",
            Some(Proof::Disproved) => "disproved",
            None => "bracket",
        }
    }

    fn truth(&self) -> String {
        self.case.get("expect").and_then(Value::as_object).map_or_else(String::new, |expect| self.shown(expect))
    }
}

/// A number of five digits.
fn short(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-3..1e5).contains(&size) {
        return format!("{value:.2e}");
    }
    let decimals = if size == 0.0 { 0 } else { (4 - size.log10().floor() as i32).max(0) as usize };
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

fn print(pieces: &[Piece]) -> io::Result<()> {
    let headers = ["issue", "reported", "truth", "our answer", "certainty", ""];
    let row = |piece: &Piece| {
        let right = if piece.is_right() { "right" } else { "WRONG" };
        let (issue, reported) = (piece.said("_issue").to_owned(), piece.said("_reported").to_owned());
        vec![issue, reported, piece.truth(), piece.shown(&piece.answer), piece.proof().to_owned(), right.to_owned()]
    };
    let rows: Vec<Vec<String>> = pieces.iter().map(row).collect();
    let mut output = io::stdout().lock();
    aligned(&mut output, &headers, &rows, headers.len())?;
    for piece in pieces.iter().filter(|piece| !piece.is_right()) {
        let why = piece.verdict.wrong.iter().chain(&piece.verdict.soft).cloned().collect::<Vec<_>>().join("; ");
        writeln!(output, "WRONG {}: {why}", piece.said("id"))?;
    }
    let right = pieces.iter().filter(|piece| piece.is_right()).count();
    let proved = pieces.iter().filter(|piece| piece.proof == Some(Proof::Proved)).count();
    writeln!(output, "{} poses: {right} right, {proved} of them with a proof that was checked", pieces.len())
}

/// A part of the note: its drawings, and the rows of its poses. A star says that the report leaves out a number.
fn markdown(pieces: &[Piece], part: &Part) -> String {
    let mut text = format!(
        "<img src=\"figures/museum-{}.svg\" alt=\"Drawings of the poses: {}\" width=\"568\">\n\n\
         | pose | what is asked | reported | truth | our answer | certainty | others today |\n\
         |---|---|---|---|---|---|---|\n",
        part.name,
        part.title.to_lowercase()
    );
    for piece in part.of(pieces) {
        let _ = writeln!(
            text,
            "| `{}`{} of {} | {} | {} | {}: {} | {} | {} | {} |",
            piece.said("id"),
            if piece.said("_pose") == "given" { "" } else { "\\*" },
            piece.link(),
            piece.said("_title"),
            piece.said("_reported"),
            piece.truth(),
            piece.said("_truth"),
            piece.shown(&piece.answer),
            piece.proof(),
            piece.said("_today")
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each row is what went wrong elsewhere: the answer is right to what its line allows, no bound fails, and no
    /// certificate disproves it.
    #[test]
    fn every_piece_is_answered_rightly() {
        let pieces = pieces().expect("the file is there");
        let wrong = |piece: &Piece| format!("{}: {:?} {:?}", piece.said("id"), piece.verdict, piece.answer);
        let wrong: Vec<String> = pieces.iter().filter(|piece| !piece.is_right()).map(wrong).collect();
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
        assert!(pieces.len() >= 90, "{} poses", pieces.len());
    }

    /// The README says how many are right, and how many proved.
    #[test]
    fn the_readme_has_these_counts() {
        let pieces = pieces().expect("the file is there");
        let count = |is: &dyn Fn(&Piece) -> bool| pieces.iter().filter(|piece| is(piece)).count();
        let (right, proved) = (count(&Piece::is_right), count(&|piece| piece.proof == Some(Proof::Proved)));
        let readme = fs::read_to_string(note::path("../README.md")).expect("it is at the root");
        let said = format!("they answer {right} rightly, {proved} of them with a proof");
        assert!(readme.split_whitespace().collect::<Vec<_>>().join(" ").contains(&said), "not in README.md: {said}");
    }

    #[test]
    fn the_note_names_every_piece() {
        let page = fs::read_to_string(note::path("museum.md")).expect("it is in the folder of notes");
        for piece in pieces().expect("the file is there") {
            assert!(
                page.contains(&piece.link()),
                "{} is not in docs/museum.md: cargo xtask museum --write",
                piece.said("id")
            );
        }
    }

    /// Whether a pose has a body in this role, or an ellipsoid in the place of the first.
    fn has(piece: &Piece, role: Role) -> bool {
        let keys = if role == Role::Own { ["a", "points", "halfspaces"] } else { ["b", "target", "halfspaces"] };
        keys.iter().any(|key| piece.case.contains_key(*key))
    }

    /// A drawing shows what it is of: each body that is asked about, or the ellipsoid, is in its cell.
    #[test]
    fn every_piece_is_drawn() {
        let pieces = pieces().expect("the file is there");
        for part in &PARTS {
            let figure = fs::read_to_string(part.figure()).expect("it is in the folder of figures");
            for piece in part.of(&pieces) {
                let cell = piece.cell().expect("it is a pose");
                let drawing = &cell.drawing;
                for role in [Role::Own, Role::Other].into_iter().filter(|role| has(piece, *role)) {
                    let is_shown = |(of, points): &(Role, Vec<_>)| *of == role && drawing.shows(points);
                    assert!(drawing.parts.iter().any(is_shown), "{}: {role:?} is not seen", cell.name);
                }
                assert!(figure.contains(&cell.name), "{}: cargo xtask museum --write", cell.name);
            }
        }
        assert_eq!(PARTS.iter().map(|part| part.of(&pieces).count()).sum::<usize>(), pieces.len());
    }

    #[test]
    fn numbers_are_written_short() {
        let shown = [0.0, 100.0, 0.1, 8.4834, 0.00631114, 3.575_454e-6, 12_345.678].map(short);
        assert_eq!(shown, ["0", "100", "0.1", "8.4834", "0.0063111", "3.58e-6", "12346"]);
    }
}
