//! Error against time, a panel for each kind of question, a mark for everybody who answers it.

use std::fs;

use workloads::note;

use super::questions::{SETS, asked_as};
use crate::plot::{Mark, Panel, Panels, by_theme};

/// What one answers to one kind of questions: the row of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    pub set: String,
    pub who: String,
    /// How many of the answers are disproved.
    pub disproved: usize,
    /// The error that 99 of 100 answers stay below; NaN where the answer is yes or no.
    pub error: f64,
    /// The median.
    pub ns: f64,
}

/// The questions about ellipsoids, by the query that asks them.
pub const OF_ELLIPSOIDS: [(&str, &str); 2] =
    [("enclosing_ellipsoid", "ellipsoid around points"), ("margin", "margin of ellipsoids")];

/// The rows of a `judge.csv`.
#[must_use]
pub fn read(csv: &str) -> Vec<Point> {
    let point = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let [set, who, _, _, _, disproved, _, _, _, error, _, ns] = cells.as_slice() else { return None };
        Some(Point {
            set: (*set).to_owned(),
            who: (*who).to_owned(),
            disproved: disproved.parse().ok()?,
            error: if error.is_empty() { f64::NAN } else { error.parse().ok()? },
            ns: ns.parse().ok()?,
        })
    };
    csv.lines().skip(1).filter_map(point).collect()
}

/// What was recorded: of questions about two bodies, and of those about ellipsoids.
#[must_use]
pub fn recorded() -> Vec<Point> {
    let of = |name| fs::read_to_string(note::path(name)).map(|csv| read(&csv)).unwrap_or_default();
    [of("judge.csv"), of("ellipsoids.csv")].concat()
}

/// Whether somebody is one of ours.
#[must_use]
pub fn is_ours(who: &str) -> bool {
    who.starts_with("ours")
}

/// The figure; questions of the embedded suite are left out.
#[must_use]
pub fn panels(points: &[Point]) -> Panels {
    let sets = SETS.into_iter().chain(OF_ELLIPSOIDS.map(|(_, set)| set));
    let panel = |set: &str| {
        let marks: Vec<Mark> = points.iter().filter(|point| point.set == set).map(mark).collect();
        (!marks.is_empty()).then(|| Panel { title: title(set), marks })
    };
    Panels {
        title: "How wrong, and how slow: ours and other libraries".to_owned(),
        note: "Each library is asked only about shapes that it has.".to_owned(),
        panels: sets.filter_map(panel).collect(),
    }
}

/// The figure as a picture of its own.
#[must_use]
pub fn file(points: &[Point]) -> String {
    by_theme(&panels(points).svg(2, ""))
}

/// What stands above a panel.
fn title(set: &str) -> String {
    match set {
        "overlap" => "overlap, yes or no: time only".to_owned(),
        set => asked_as(set).to_owned(),
    }
}

fn mark(point: &Point) -> Mark {
    let is_single = point.who.contains("f32");
    // A version is a word that begins with a digit.
    let name: Vec<&str> = point.who.split(' ').filter(|word| !word.starts_with(|c: char| c.is_ascii_digit())).collect();
    let mut name = name.join(" ");
    for only in ["Box3D", "Jolt"] {
        name = name.replace(&format!("{only} f32"), only);
    }
    let Point { ns, error, disproved, .. } = *point;
    Mark { name, ns, error, is_ours: is_ours(&point.who), is_single, disproved }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_and_drawn() {
        let csv = "question,who,asked,right,inaccurate,disproved,no answer,undecided,median error,99th percentile,worst,median time\n\
                   distance,ours f64,9,9,0,0,0,0,1e-16,2e-16,2e-16,310.5\n\
                   distance,theirs 1.2,9,7,0,2,0,0,1e-6,1e-3,1e-2,900.0\n\
                   suite: distance,theirs 1.2,9,7,0,2,0,0,1e-6,1e-3,1e-2,900.0\n\
                   overlap,theirs 1.2,9,9,0,0,0,0,,,,100.0\n";
        let panels = panels(&read(csv));
        let titles: Vec<&str> = panels.panels.iter().map(|panel| panel.title.as_str()).collect();
        assert_eq!(titles, ["distance", "overlap, yes or no: time only"], "those of the suite are left out");
        let [ours, theirs] = panels.panels[0].marks.as_slice() else { panic!("two: {panels:?}") };
        assert!(ours.is_ours && !ours.is_single && ours.name == "ours f64", "{ours:?}");
        assert!(!theirs.is_ours && theirs.disproved == 2 && theirs.name == "theirs", "without its version: {theirs:?}");
    }

    /// Whoever records other numbers, or draws otherwise, is told; the picture that is due is then in the folder of
    /// temporary files.
    #[test]
    fn the_figure_in_the_notes_is_that_of_the_recorded_numbers() {
        let due = file(&recorded());
        let drawn = fs::read_to_string(note::path("figures/judge.svg")).expect("it is in the folder of figures");
        let file = std::env::temp_dir().join("judge.svg");
        if due != drawn {
            fs::write(&file, &due).expect("a temporary file");
        }
        assert!(due == drawn, "docs/figures/judge.svg is not of these numbers; {} is", file.display());
    }
}
