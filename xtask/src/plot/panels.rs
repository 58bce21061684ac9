//! Small panels with the same axes, one for each kind of question, in which each mark has its name beside it.
//!
//! The picture says its colours by attributes, so that any viewer shows it, on its own ground. A page may replace the
//! colours by the classes `ground`, `ink`, `faint`, `ours`, `other` and `false`.

use std::fmt::Write as _;

use super::{duration, escape, raised};

/// Whose answers a mark stands for.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    pub name: String,
    pub ns: f64,
    /// NaN where the answer is yes or no.
    pub error: f64,
    pub is_ours: bool,
    /// Whether it works in single precision.
    pub is_single: bool,
    /// How many answers are proved false.
    pub disproved: usize,
}

/// The marks of one kind of question.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    pub title: String,
    pub marks: Vec<Mark>,
}

/// Error against time, in panels.
#[derive(Clone, Debug)]
pub struct Panels {
    pub title: String,
    /// A sentence below the title: whose marks these are.
    pub note: String,
    pub panels: Vec<Panel>,
}

/// The ends of the axes, as logarithms: of nanoseconds, and of the error.
const TIMES: [f64; 2] = [1.0, 5.0];
const ERRORS: [f64; 2] = [-17.0, 0.0];
/// Powers of ten with a line and a label.
const TIME_TICKS: [i32; 5] = [1, 2, 3, 4, 5];
const ERROR_TICKS: [i32; 5] = [-16, -12, -8, -4, 0];

/// Of one panel, without its title.
const WIDTH: f64 = 264.0;
const HEIGHT: f64 = 196.0;
/// From one panel to the next.
const STEP: [f64; 2] = [WIDTH + 14.0, HEIGHT + 34.0];
/// Where the first panel begins: room for the numbers of the vertical axis, and for titles.
const LEFT: f64 = 80.0;
const TOP: f64 = 106.0;
/// Room beside the last panel, for half of a number, and below it for the title of the axis.
const RIGHT: f64 = 14.0;
const BOTTOM: f64 = 26.0;
const FONT: f64 = 15.0;
/// About the width of a letter of a name.
const LETTER: f64 = 8.3;
/// The half width of a mark.
const RADIUS: f64 = 5.0;
/// What is said of the marks: how many lines, and how high each is.
const KEYS: usize = 6;
const KEY_ROW: f64 = 24.0;

/// A box on the picture: left, top, right, bottom.
type Area = [f64; 4];

impl Panels {
    /// The picture as an `<svg>` element, with as many panels in a row.
    #[must_use]
    pub fn svg(&self, columns: usize, class: &str) -> String {
        // What the marks mean stands in the place of one more panel, or in a few lines below where the rows are full.
        let rows = self.panels.len().div_ceil(columns);
        let is_below = self.panels.len() == rows * columns;
        let below = if is_below { KEY_ROW * KEYS.div_ceil(columns) as f64 + 10.0 } else { 0.0 };
        let size = [LEFT + STEP[0] * columns as f64 + RIGHT, TOP + STEP[1] * rows as f64 + BOTTOM + below];
        let mut svg = format!(
            "<svg class=\"{class}\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{2}\" xmlns=\"http://www.w3.org/2000/svg\" \
             font-family=\"system-ui, 'Segoe UI', 'DejaVu Sans', sans-serif\" font-size=\"{FONT}\">\n\
             <rect class=\"ground\" width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n\
             <g class=\"ink\" fill=\"#1c1c1e\">\n<text x=\"10\" y=\"24\" font-size=\"19\" font-weight=\"600\">{2}</text>\n\
             <text x=\"10\" y=\"46\">Lower is more accurate, further left is faster.</text>\n\
             <text x=\"10\" y=\"66\">{3}</text>\n",
            size[0],
            size[1],
            escape(&self.title),
            escape(&self.note)
        );
        for (k, panel) in self.panels.iter().enumerate() {
            let corner = corner(k, columns);
            let is_lowest = k + columns >= self.panels.len();
            frame(&mut svg, panel, corner, k % columns == 0, is_lowest);
            panel.draw(&mut svg, corner);
        }
        let [left, top] = corner(self.panels.len(), columns);
        key(&mut svg, [left, top + if is_below { BOTTOM } else { 8.0 }], if is_below { columns } else { 1 });
        let _ = writeln!(
            svg,
            "<text transform=\"translate(17 {:.0}) rotate(-90)\" text-anchor=\"middle\">error that 99 of 100 answers stay below, over the size of the scene</text>",
            f64::midpoint(TOP, size[1] - BOTTOM - below)
        );
        let _ = writeln!(
            svg,
            "<text x=\"{:.0}\" y=\"{:.0}\" text-anchor=\"middle\">median time of one question</text>\n</g>\n</svg>",
            f64::midpoint(LEFT, size[0]),
            size[1] - below - 12.0
        );
        svg
    }
}

/// Where a panel begins.
fn corner(k: usize, columns: usize) -> [f64; 2] {
    [LEFT + STEP[0] * (k % columns) as f64, TOP + STEP[1] * (k / columns) as f64]
}

/// Where a time lies, from the left end of a panel.
fn across(ns: f64) -> f64 {
    WIDTH * ((ns.log10() - TIMES[0]) / (TIMES[1] - TIMES[0])).clamp(0.0, 1.0)
}

/// Where an error lies, from the top of a panel.
fn down(error: f64) -> f64 {
    HEIGHT * (1.0 - ((error.log10() - ERRORS[0]) / (ERRORS[1] - ERRORS[0])).clamp(0.0, 1.0))
}

/// Title, lines and numbers of a panel.
fn frame(svg: &mut String, panel: &Panel, [left, top]: [f64; 2], is_leftmost: bool, is_lowest: bool) {
    let _ = writeln!(
        svg,
        "<text x=\"{left:.1}\" y=\"{:.1}\" font-weight=\"600\" font-size=\"16\">{}</text>",
        top - 7.0,
        escape(&panel.title)
    );
    let mut lines = String::new();
    for (k, power) in TIME_TICKS.into_iter().enumerate() {
        let x = left + across(10f64.powi(power));
        // The outer numbers stay within the panel.
        let anchor = if k == 0 {
            "start"
        } else if k + 1 == TIME_TICKS.len() {
            "end"
        } else {
            "middle"
        };
        let _ = write!(lines, "M{x:.1} {top:.1}v{HEIGHT}");
        // Every second number has room.
        if is_lowest && k % 2 == 0 {
            let _ = writeln!(
                svg,
                "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{}</text>",
                top + HEIGHT + 17.0,
                duration(10f64.powi(power))
            );
        }
    }
    for power in ERROR_TICKS {
        let y = top + down(10f64.powi(power));
        if panel.has_errors() {
            let _ = write!(lines, "M{left:.1} {y:.1}h{WIDTH}");
        }
        if is_leftmost {
            let label = if power == 0 { "1".to_owned() } else { format!("10{}", raised(power)) };
            let _ =
                writeln!(svg, "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>", left - 6.0, y + 5.0);
        }
    }
    let _ = writeln!(svg, "<path class=\"faint\" d=\"{lines}\" fill=\"none\" stroke=\"#d4d6db\"/>");
}

impl Panel {
    /// Whether its answers are numbers; otherwise its marks stand in rows.
    fn has_errors(&self) -> bool {
        self.marks.iter().any(|mark| !mark.error.is_nan())
    }

    /// Marks and their names.
    fn draw(&self, svg: &mut String, [left, top]: [f64; 2]) {
        let mut marks: Vec<&Mark> = self.marks.iter().collect();
        marks.sort_by(|a, b| a.ns.total_cmp(&b.ns));
        let row = |k: usize| HEIGHT * (k as f64 + 0.5) / marks.len() as f64;
        let place = |(k, mark): (usize, &&Mark)| {
            let y = if mark.error.is_nan() { row(k) } else { down(mark.error) };
            [left + across(mark.ns), top + y]
        };
        let places: Vec<[f64; 2]> = marks.iter().enumerate().map(place).collect();
        let labels: Vec<String> = marks.iter().map(|mark| mark.label()).collect();
        let widths: Vec<f64> =
            marks.iter().zip(&labels).map(|(mark, label)| mark.letter() * label.chars().count() as f64).collect();
        let names = if self.has_errors() {
            named(&places, &widths, [left + 1.0, top, left + WIDTH + 6.0, top + HEIGHT])
        } else {
            bars(svg, &places, &widths, left)
        };
        for (((mark, label), &[x, y]), area) in marks.iter().zip(&labels).zip(&places).zip(names) {
            if let Some([to_x, to_y]) = tie([x, y], area) {
                let _ = writeln!(
                    svg,
                    "<path class=\"other\" d=\"M{x:.1} {y:.1}L{to_x:.1} {to_y:.1}\" stroke=\"#55585f\" stroke-width=\".8\"/>"
                );
            }
            let weight = if mark.is_ours { " font-weight=\"600\"" } else { "" };
            // A name on the left ends where it is to end, whatever the letters of a viewer.
            let (at, anchor) = if area[2] <= x { (area[2], " text-anchor=\"end\"") } else { (area[0], "") };
            let _ = writeln!(
                svg,
                "{}<text x=\"{at:.1}\" y=\"{:.1}\"{anchor}{weight}>{}</text>",
                mark.shape([x, y]),
                area[3] - 3.5,
                escape(label)
            );
        }
    }
}

/// Where only times are told, a mark is the end of a bar, with its name behind it, or before it where there is no room.
fn bars(svg: &mut String, places: &[[f64; 2]], widths: &[f64], left: f64) -> Vec<Area> {
    let (half, away) = ((FONT + 2.5) / 2.0, RADIUS + 3.0);
    let mut names = Vec::new();
    for (&[x, y], width) in places.iter().zip(widths) {
        let is_behind = x + away + width <= left + WIDTH;
        let from = if is_behind { x + away } else { x - away - width };
        let end = if is_behind { x } else { from - 4.0 };
        let _ = writeln!(
            svg,
            "<path class=\"faint\" d=\"M{left:.1} {y:.1}H{end:.1}\" fill=\"none\" stroke=\"#d4d6db\" stroke-width=\"7\"/>"
        );
        names.push([from, y - half, from + width, y + half]);
    }
    names
}

impl Mark {
    /// The name; what is proved false, and a time beyond the axis, are told with it.
    fn label(&self) -> String {
        let mut label = self.name.clone();
        if self.disproved > 0 {
            let _ = write!(label, ": {}", self.disproved);
        }
        if self.ns.log10() > TIMES[1] {
            let _ = write!(label, " {} →", rounded(self.ns));
        }
        label
    }

    /// About the width of a letter of its name.
    fn letter(&self) -> f64 {
        if self.is_ours { 1.1 * LETTER } else { LETTER }
    }

    fn shape(&self, [x, y]: [f64; 2]) -> String {
        let (left, top, side) = (x - 0.9 * RADIUS, y - 0.9 * RADIUS, 1.8 * RADIUS);
        let look = match self.is_ours {
            true => "class=\"ours\" fill=\"#0b5cad\"",
            false => "class=\"other\" fill=\"none\" stroke=\"#55585f\" stroke-width=\"1.7\"",
        };
        match (self.disproved, self.is_single) {
            (0, false) => format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{RADIUS}\" {look}/>"),
            (0, true) => {
                format!("<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{side:.1}\" height=\"{side:.1}\" {look}/>")
            }
            _ => format!(
                "<path class=\"false\" d=\"M{left:.1} {top:.1}l{side:.1} {side:.1}m0 -{side:.1}l-{side:.1} {side:.1}\" \
                 fill=\"none\" stroke=\"#b3261e\" stroke-width=\"2.6\"/>"
            ),
        }
    }
}

/// What the marks mean, in so many columns.
fn key(svg: &mut String, [left, top]: [f64; 2], columns: usize) {
    let mark = |is_ours, is_single, disproved| Mark {
        name: String::new(),
        ns: 1.0,
        error: 1.0,
        is_ours,
        is_single,
        disproved,
    };
    let lines: [(Option<Mark>, &str); KEYS] = [
        (Some(mark(true, false, 0)), "ours, double precision"),
        (Some(mark(true, true, 0)), "ours, single precision"),
        (Some(mark(false, false, 0)), "another library, double"),
        (Some(mark(false, true, 0)), "another library, single"),
        (Some(mark(false, false, 1)), "proved false: how many"),
        (None, "Ellipsoids: relative error."),
    ];
    for (k, (mark, text)) in lines.iter().enumerate() {
        let y = top + KEY_ROW * (0.5 + (k / columns) as f64);
        let left = left + STEP[0] * (k % columns) as f64;
        let shape = mark.as_ref().map_or_else(String::new, |mark| mark.shape([left + 10.0, y - 5.0]));
        let x = if mark.is_some() { left + 24.0 } else { left + 4.0 };
        let _ = writeln!(svg, "{shape}<text x=\"{x:.1}\" y=\"{y:.1}\">{text}</text>");
    }
}

/// A time of one or two digits.
fn rounded(ns: f64) -> String {
    let unit = 10f64.powf(ns.log10().floor() - 1.0);
    duration((ns / unit).round() * unit)
}

fn overlap(a: Area, b: Area) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// Where the names of these widths stand beside their marks. A name is moved while another place costs it less, a few
/// times over, as where it is best depends on where the others are.
fn named(places: &[[f64; 2]], widths: &[f64], within: Area) -> Vec<Area> {
    const ROUNDS: usize = 12;
    let reach = RADIUS + 1.0;
    let marks: Vec<Area> = places.iter().map(|[x, y]| [x - reach, y - reach, x + reach, y + reach]).collect();
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
        let best = candidates(places[k], widths[k], within).into_iter().min_by(|a, b| cost(a).total_cmp(&cost(b)));
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

/// Places within an area for a name of this width: to either side of a point, or above or below it.
fn candidates([x, y]: [f64; 2], width: f64, within: Area) -> Vec<Area> {
    let (half, away) = ((FONT + 2.5) / 2.0, RADIUS + 3.0);
    let inside = |a: &Area| a[0] >= within[0] && a[2] <= within[2] && a[1] >= within[1] && a[3] <= within[3];
    let place = |left: f64, middle: f64| [left, middle - half, left + width, middle + half];
    // The least shift first.
    let shifts = (0..=48).map(|k| f64::from(if k % 2 == 0 { -2 * k } else { 2 * k + 2 }));
    let beside = |dy: f64| {
        let sides = [x + away, x - away - width].map(|left| place(left, y + dy));
        let across = (0..=4).map(move |k| place(x - width * f64::from(k) / 4.0, y + dy));
        sides.into_iter().chain(across.filter(move |_| dy.abs() > half + RADIUS))
    };
    shifts.flat_map(beside).filter(inside).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WITHIN: Area = [100.0, 100.0, 600.0, 600.0];

    #[test]
    fn names_cover_neither_marks_nor_one_another() {
        let places: Vec<[f64; 2]> = (0..12).map(|k| [300.0 + f64::from(k), 300.0 + 3.0 * f64::from(k % 5)]).collect();
        let names = named(&places, &[60.0; 12], WITHIN);
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

    #[test]
    fn what_is_proved_false_or_beyond_the_axis_is_told_beside_its_mark() {
        let mark = |ns, disproved| Mark {
            name: "theirs".to_owned(),
            ns,
            error: 1e-6,
            is_ours: false,
            is_single: true,
            disproved,
        };
        assert_eq!(mark(900.0, 2).label(), "theirs: 2");
        assert!(mark(900.0, 2).shape([0.0, 0.0]).contains("class=\"false\""), "a cross");
        assert_eq!(mark(7e6, 0).label(), "theirs 7 ms →");
        let panels = Panels {
            title: "all".to_owned(),
            note: "each".to_owned(),
            panels: vec![Panel { title: "one".to_owned(), marks: vec![mark(900.0, 0)] }],
        };
        let svg = panels.svg(1, "");
        assert!(
            svg.contains(">theirs</text>") && !svg.contains("style=") && !svg.contains("var("),
            "plain attributes: {svg}"
        );
    }
}
