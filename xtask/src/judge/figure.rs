//! Error against time, a mark for each question and everybody who answers it.

use crate::plot::{Group, Mark, Marks};

/// What one answers to one kind of questions: the row of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    pub set: String,
    pub who: String,
    /// How many of the answers are disproved.
    pub disproved: usize,
    /// The error that 99 of 100 answers stay below.
    pub error: f64,
    /// The median.
    pub ns: f64,
}

/// Errors below this are drawn here: it is less than half an ulp.
const FLOOR: f64 = 1e-17;

/// The rows of a `judge.csv`; those without error or time say nothing here.
#[must_use]
pub fn read(csv: &str) -> Vec<Point> {
    let point = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let [set, who, _, _, _, disproved, _, _, _, error, _, ns] = cells.as_slice() else { return None };
        Some(Point {
            set: (*set).to_owned(),
            who: (*who).to_owned(),
            disproved: disproved.parse().ok()?,
            error: error.parse().ok()?,
            ns: ns.parse().ok()?,
        })
    };
    csv.lines().skip(1).filter_map(point).collect()
}

/// The figure. Of whom `is_recorded` is said, the marks are hollow; others are filled.
#[must_use]
pub fn marks(points: &[Point], is_recorded: impl Fn(&str) -> bool) -> Marks {
    let mut groups: Vec<Group> = Vec::new();
    let mut marks = Vec::new();
    for point in points.iter().filter(|point| !point.set.starts_with("suite")) {
        let group = groups.iter().position(|group| group.name == point.who).unwrap_or_else(|| {
            let (name, colour) = (point.who.clone(), groups.len());
            groups.push(Group { name, colour, is_hollow: is_recorded(&point.who) });
            groups.len() - 1
        });
        let name = if point.set == "distance of 1e-6" { "near contact" } else { &point.set };
        let label = match point.disproved {
            0 => name.to_owned(),
            count => format!("{name} ({count} ✗)"),
        };
        marks.push(Mark { at: [point.ns, point.error], label, group });
    }
    Marks {
        title: "Each kind of question, and who answers it".to_owned(),
        x: "median time per query".to_owned(),
        y: "error that 99 of 100 answers stay below, in sizes of the scene".to_owned(),
        floor: FLOOR,
        groups,
        marks,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_and_drawn() {
        let csv = "question,who,asked,right,off,disproved,no answer,open,median error,99th percentile,worst,median time\n\
                   distance,ours f64,9,9,0,0,0,0,1e-16,2e-16,2e-16,310.5\n\
                   distance,theirs,9,7,0,2,0,0,1e-6,1e-3,1e-2,900.0\n\
                   overlap,theirs,9,9,0,0,0,0,,,,100.0\n";
        let points = read(csv);
        assert_eq!(points.len(), 2, "a row without an error is left out: {points:?}");
        let marks = marks(&points, |who| who == "theirs");
        let group = |name: &str, colour, is_hollow| Group { name: name.to_owned(), colour, is_hollow };
        assert_eq!(marks.groups, [group("ours f64", 0, false), group("theirs", 1, true)], "filled and hollow");
        assert_eq!(marks.marks[1].label, "distance (2 ✗)");
        assert!(marks.svg().contains("distance (2 ✗)</text>"), "named beside its mark");
    }
}
