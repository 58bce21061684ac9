//! Marks that are named beside them: few points, of which each says something of its own.

use std::fmt::Write as _;

use super::{Axis, Frame, LEFT, LEGEND_ROW, RIGHT, Scale, TOP, escape, look, shape};

/// A point with its name.
#[derive(Clone, Debug)]
pub struct Mark {
    pub at: [f64; 2],
    pub label: String,
    /// Whom of [`Marks::groups`] it belongs to.
    pub group: usize,
}

/// Whose points are alike.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    pub name: String,
    /// Which of the colours.
    pub colour: usize,
    pub is_hollow: bool,
}

/// Error against time, as marks.
#[derive(Clone, Debug)]
pub struct Marks {
    pub title: String,
    pub x: String,
    pub y: String,
    /// What is below is drawn there.
    pub floor: f64,
    pub groups: Vec<Group>,
    pub marks: Vec<Mark>,
}

/// The picture as it is on a desk, and on a telephone, without its legend.
const WIDE: [f64; 2] = [780.0, 660.0];
const NARROW: [f64; 2] = [420.0, 860.0];
const FONT: f64 = 11.5;
/// About the width of a letter of a label.
const LETTER: f64 = 6.2;
/// The radius of a mark.
const RADIUS: f64 = 4.5;

/// A box on the picture: left, top, right, bottom.
type Area = [f64; 4];

fn overlap(a: Area, b: Area) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

impl Marks {
    /// The picture as an `<svg>` element.
    #[must_use]
    pub fn svg(&self) -> String {
        self.drawn(WIDE, "wide")
    }

    /// The same for a narrow page.
    #[must_use]
    pub fn narrow_svg(&self) -> String {
        self.drawn(NARROW, "narrow")
    }

    fn drawn(&self, size: [f64; 2], class: &str) -> String {
        let xs = self.marks.iter().map(|mark| mark.at[0]);
        let ys = self.marks.iter().map(|mark| mark.at[1].max(self.floor));
        let (x, y) = (Axis::around(Scale::Time, xs), Axis::around(Scale::Log, ys));
        let frame = Frame { x, y, floor: self.floor, size };
        let mut svg = format!(
            "<svg class=\"{class}\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{2}\" xmlns=\"http://www.w3.org/2000/svg\" \
             font-family=\"system-ui, sans-serif\" font-size=\"12.5\" fill=\"currentColor\">\n\
             <text x=\"8\" y=\"18\" font-size=\"14.5\" font-weight=\"600\">{2}</text>\n",
            size[0],
            size[1] + LEGEND_ROW * self.legend_rows(size[0]) as f64,
            escape(&self.title)
        );
        frame.axes(&mut svg, [&self.x, &self.y], self.marks.iter().any(|mark| mark.at[1] < self.floor));
        self.draw(&mut svg, &frame);
        self.legend(&mut svg, size);
        svg.push_str("</svg>\n");
        svg
    }

    /// Marks and their names, each where it covers no other.
    fn draw(&self, svg: &mut String, frame: &Frame) {
        let places: Vec<[f64; 2]> =
            self.marks.iter().map(|mark| [frame.px(mark.at[0]), frame.py(mark.at[1])]).collect();
        let widths: Vec<f64> = self.marks.iter().map(|mark| LETTER * mark.label.chars().count() as f64).collect();
        let names = named(&places, &widths, frame.size);
        for ((one, &[x, y]), area) in self.marks.iter().zip(&places).zip(names) {
            let group = &self.groups[one.group];
            let (left, base) = (area[0], area[3] - 3.5);
            let tie = tie([x, y], area).map_or_else(String::new, |[to_x, to_y]| {
                format!("<path d=\"M{x:.1} {y:.1}L{to_x:.1} {to_y:.1}\" stroke-width=\".8\" stroke-opacity=\".6\"/>")
            });
            let _ = writeln!(
                svg,
                "<g {}><title>{}: {}</title>{tie}{}<text x=\"{left:.1}\" y=\"{base:.1}\" font-size=\"{FONT}\" stroke=\"none\">{}</text></g>",
                look(group.colour),
                escape(&group.name),
                escape(&one.label),
                group.mark(x, y),
                escape(&one.label)
            );
        }
    }

    /// Where the groups are named below a picture of this width: left ends and rows.
    fn legend_places(&self, width: f64) -> Vec<(f64, usize)> {
        let (mut left, mut row) = (LEFT - 30.0, 0);
        let place = |group: &Group| {
            let wide = 10.0 + 6.7 * group.name.chars().count() as f64 + 20.0;
            if left + wide > width && left > LEFT {
                (left, row) = (LEFT - 30.0, row + 1);
            }
            let here = (left, row);
            left += wide;
            here
        };
        self.groups.iter().map(place).collect()
    }

    fn legend_rows(&self, width: f64) -> usize {
        self.legend_places(width).last().map_or(0, |(_, row)| row + 1)
    }

    /// The groups, below the picture.
    fn legend(&self, svg: &mut String, [width, height]: [f64; 2]) {
        for (group, (left, row)) in self.groups.iter().zip(self.legend_places(width)) {
            let y = height + 4.0 + LEGEND_ROW * row as f64;
            let _ = writeln!(
                svg,
                "<g {}>{}</g><text x=\"{:.1}\" y=\"{:.1}\">{}</text>",
                look(group.colour),
                group.mark(left, y),
                left + 10.0,
                y + 4.0,
                escape(&group.name)
            );
        }
    }
}

impl Group {
    fn mark(&self, x: f64, y: f64) -> String {
        shape(self.colour, self.is_hollow, [x, y], RADIUS)
    }
}

/// Where the names of these widths stand beside their marks. A name is moved while another place costs it less, a few
/// times over, as where it is best depends on where the others are.
fn named(places: &[[f64; 2]], widths: &[f64], size: [f64; 2]) -> Vec<Area> {
    const ROUNDS: usize = 12;
    let marks: Vec<Area> = places.iter().map(|[x, y]| [x - 5.0, y - 5.0, x + 5.0, y + 5.0]).collect();
    let mut names: Vec<Area> = Vec::new();
    for k in (0..places.len()).cycle().take(ROUNDS * places.len()) {
        let others = |areas: &[Area]| areas.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, a)| *a).collect();
        let taken: Vec<Area> = marks.iter().copied().chain::<Vec<Area>>(others(&names)).collect();
        let beside: Vec<Area> = others(&marks);
        let tied = |(i, name): (usize, &Area)| if i == k { None } else { Some((places[i], tie(places[i], *name)?)) };
        let ties: Vec<_> = names.iter().enumerate().filter_map(tied).collect();
        let cost = |area: &Area| {
            let covered = taken.iter().filter(|other| overlap(*area, **other)).count();
            let away = distance(places[k], *area);
            // A name about as near to another mark is taken for that one's.
            let near = beside.iter().filter(|other| distance(middle(**other), *area) < away + 7.0).count();
            let crossed = tie(places[k], *area).map_or(0, |to| {
                let passed = beside.iter().chain(taken.iter().skip(marks.len()));
                passed.filter(|other| crosses(places[k], to, **other)).count()
                    + ties.iter().filter(|tie| meet((places[k], to), **tie)).count()
            });
            let struck = ties.iter().filter(|(from, to)| crosses(*from, *to, *area)).count();
            away + 2000.0 * covered as f64 + 200.0 * (crossed + struck) as f64 + 30.0 * near as f64
        };
        let best = candidates(places[k], widths[k], size).into_iter().min_by(|a, b| cost(a).total_cmp(&cost(b)));
        let best = best.unwrap_or([places[k][0] + 7.0, places[k][1], places[k][0] + 7.0 + widths[k], places[k][1]]);
        match names.get_mut(k) {
            Some(name) => *name = best,
            None => names.push(best),
        }
    }
    names
}

fn middle(area: Area) -> [f64; 2] {
    [f64::midpoint(area[0], area[2]), f64::midpoint(area[1], area[3])]
}

/// The point of an area that is nearest to another point.
fn nearest([x, y]: [f64; 2], area: Area) -> [f64; 2] {
    [x.clamp(area[0], area[2]), y.clamp(area[1], area[3])]
}

fn distance([x, y]: [f64; 2], area: Area) -> f64 {
    let [to_x, to_y] = nearest([x, y], area);
    (to_x - x).hypot(to_y - y)
}

/// Where a name that had to go far is tied to its mark.
fn tie(mark: [f64; 2], name: Area) -> Option<[f64; 2]> {
    (distance(mark, name) > 12.0).then(|| nearest(mark, name))
}

/// Whether the way from one point to another leads through an area: whether it is within both slabs of it at one time.
fn crosses(from: [f64; 2], to: [f64; 2], area: Area) -> bool {
    let (mut enter, mut leave) = (0.0f64, 1.0f64);
    for i in [0, 1] {
        let along = to[i] - from[i];
        if along == 0.0 {
            if from[i] <= area[i] || from[i] >= area[i + 2] {
                return false;
            }
            continue;
        }
        let [one, other] = [area[i], area[i + 2]].map(|edge| (edge - from[i]) / along);
        (enter, leave) = (enter.max(one.min(other)), leave.min(one.max(other)));
    }
    enter < leave
}

/// Whether two ways cross.
fn meet((a, b): ([f64; 2], [f64; 2]), (c, d): ([f64; 2], [f64; 2])) -> bool {
    let side = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

/// Places within the picture for a name of this width beside a point.
fn candidates([x, y]: [f64; 2], width: f64, size: [f64; 2]) -> Vec<Area> {
    let height = FONT + 2.5;
    let place = |left: f64, top: f64| [left, top, left + width, top + height];
    let inside =
        |a: &Area| a[0] >= LEFT && a[2] <= size[0] - RIGHT + 24.0 && a[1] >= TOP - 8.0 && a[3] <= size[1] - 50.0;
    // Thirty-two directions, those to the sides, above and below first.
    let directions = (0..32).map(|k| f64::from(k) * std::f64::consts::PI / 16.0);
    let mut directions: Vec<[f64; 2]> = directions.map(|angle| [angle.cos(), angle.sin()]).collect();
    directions.sort_by(|a, b| (a[0] * a[1]).abs().total_cmp(&(b[0] * b[1]).abs()));
    let beside = |away: f64| {
        let at = move |[along, up]: [f64; 2]| {
            let (center, middle) = (x + along * (7.0 + away + width / 2.0), y + up * (6.0 + away + height / 2.0));
            place(center - width / 2.0, middle - height / 2.0)
        };
        directions.clone().into_iter().map(at)
    };
    [0.0, 6.0, 12.0, 18.0, 26.0, 36.0, 48.0, 62.0, 78.0, 96.0, 116.0]
        .into_iter()
        .flat_map(beside)
        .filter(inside)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_cover_neither_marks_nor_one_another() {
        let places: Vec<[f64; 2]> = (0..12).map(|k| [300.0 + f64::from(k), 300.0 + 3.0 * f64::from(k % 5)]).collect();
        let names = named(&places, &[60.0; 12], WIDE);
        for (k, name) in names.iter().enumerate() {
            assert!(!names[..k].iter().any(|other| overlap(*name, *other)), "{name:?} among {names:?}");
            let covered = places.iter().find(|[x, y]| overlap(*name, [x - 4.0, y - 4.0, x + 4.0, y + 4.0]));
            assert_eq!(covered, None, "a mark under {name:?}");
        }
    }

    #[test]
    fn ways_through_names_and_one_another_are_seen() {
        let name = [10.0, 10.0, 50.0, 20.0];
        assert!(crosses([0.0, 15.0], [60.0, 15.0], name), "along it");
        assert!(crosses([9.0, 19.5], [11.0, 20.5], [10.0, 10.0, 50.0, 20.2]), "through its corner");
        assert!(
            !crosses([0.0, 15.0], [10.0, 15.0], name) && !crosses([0.0, 20.0], [60.0, 20.0], name),
            "up to its edge"
        );
        assert!(meet(([0.0, 0.0], [4.0, 4.0]), ([0.0, 4.0], [4.0, 0.0])), "a cross");
        assert!(!meet(([0.0, 0.0], [1.0, 1.0]), ([0.0, 4.0], [4.0, 0.0])), "ends before it");
    }
}
