//! A contact sheet: the drawings of many poses, each in a cell with its name and its truth.

use std::fmt::Write as _;

use super::drawing::{ASPECT, Drawing, Flat, Role, cut};
use crate::plot::{by_theme, escape};

/// One cell of a sheet.
pub(super) struct Cell {
    pub(super) name: String,
    pub(super) truth: String,
    pub(super) drawing: Drawing,
}

/// How large the picture of a cell is.
const WIDTH: f64 = 176.0;
const HEIGHT: f64 = WIDTH / ASPECT;
/// Between the cells, and below each for two lines of text.
const GAP: f64 = 10.0;
const TEXT: f64 = 44.0;
/// As many in a row as can be read on a telephone.
const COLUMNS: usize = 3;
/// The half width of a point.
const DOT: f64 = 2.6;

/// The sheet as an SVG file on its own ground, light or dark as the reader's pages are.
pub(super) fn svg(title: &str, cells: &[Cell]) -> String {
    let rows = cells.len().div_ceil(COLUMNS);
    let (width, height) = (GAP + (WIDTH + GAP) * COLUMNS as f64, GAP + (HEIGHT + TEXT) * rows as f64);
    let mut svg = format!(
        "<svg viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" role=\"img\" aria-label=\"{}\" \
         xmlns=\"http://www.w3.org/2000/svg\" font-family=\"system-ui, 'Segoe UI', 'DejaVu Sans', sans-serif\" \
         font-size=\"14\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n",
        escape(title)
    );
    for (k, cell) in cells.iter().enumerate() {
        let left = GAP + (WIDTH + GAP) * (k % COLUMNS) as f64;
        let top = GAP + (HEIGHT + TEXT) * (k / COLUMNS) as f64;
        let _ = writeln!(svg, "<g transform=\"translate({left} {top})\">");
        for (role, points) in &cell.drawing.parts {
            cell.drawing.draw(&mut svg, *role, points);
        }
        let _ = writeln!(
            svg,
            "<rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"none\" stroke=\"#c7c7cc\"/>\
             <text y=\"{:.0}\" font-weight=\"600\" fill=\"#1c1c1e\">{}</text>\
             <text y=\"{:.0}\" fill=\"#48484c\">{}</text></g>",
            HEIGHT + 15.0,
            escape(&cell.name),
            HEIGHT + 32.0,
            escape(&cell.truth)
        );
    }
    svg.push_str("</svg>\n");
    by_theme(&svg)
}

impl Drawing {
    /// Whether a part of an area is in the cell.
    pub(super) fn shows(&self, points: &[Flat]) -> bool {
        !within(&points.iter().map(|x| self.px(*x)).collect::<Vec<_>>()).is_empty()
    }

    /// Where a point lies in its cell.
    fn px(&self, x: Flat) -> Flat {
        let scale = 0.5 * HEIGHT / self.half;
        [0.5 * WIDTH + scale * (x[0] - self.middle[0]), 0.5 * HEIGHT - scale * (x[1] - self.middle[1])]
    }

    fn draw(&self, svg: &mut String, role: Role, points: &[Flat]) {
        let at: Vec<Flat> = points.iter().map(|x| self.px(*x)).collect();
        match role {
            Role::Other => area(svg, &at, "fill=\"#d9d9de\" stroke=\"#6a6a70\"", "#6a6a70"),
            Role::Own => area(svg, &at, "fill=\"#0072b2\" fill-opacity=\".25\" stroke=\"#0072b2\"", "#0072b2"),
            Role::Moved => area(svg, &at, "fill=\"none\" stroke=\"#0072b2\" stroke-dasharray=\"4 3\"", "#0072b2"),
            Role::Cloud => at.iter().for_each(|x| dot(svg, *x, "#6a6a70")),
            Role::Mark => {
                let _ = write!(
                    svg,
                    "<path d=\"{}\" fill=\"none\" stroke=\"#c25400\" stroke-width=\"2\"/>",
                    path(&within(&at))
                );
                at.iter().filter(|x| is_inside(**x)).for_each(|x| dot(svg, *x, "#c25400"));
                svg.push('\n');
            }
            Role::Way if at.len() == 2 => arrow(svg, &within(&at)),
            Role::Way => arrow(svg, &at),
        }
    }
}

/// A convex area, as much of it as is in the cell; one too small to be seen is a point.
fn area(svg: &mut String, at: &[Flat], look: &str, colour: &str) {
    let inside = within(at);
    let spread = |i: usize| {
        let [low, high] = at.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| [l.min(x[i]), h.max(x[i])]);
        high - low
    };
    if let (Some(&first), true) = (at.first(), spread(0).hypot(spread(1)) < 2.0 * DOT) {
        dot(svg, first, colour);
    } else if !inside.is_empty() {
        let _ = writeln!(svg, "<path d=\"{}z\" {look}/>", path(&inside));
    }
}

fn dot(svg: &mut String, [x, y]: Flat, colour: &str) {
    let _ = write!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{DOT}\" fill=\"{colour}\"/>");
}

fn arrow(svg: &mut String, way: &[Flat]) {
    let [.., from, to] = way else { return };
    let along = [to[0] - from[0], to[1] - from[1]];
    let length = along[0].hypot(along[1]);
    if length < 0.5 {
        return;
    }
    let [x, y] = along.map(|d| 7.0 * d / length);
    let back = |turn: f64| [to[0] - x - turn * 0.5 * y, to[1] - y + turn * 0.5 * x];
    let _ = writeln!(
        svg,
        "<path d=\"{}{}\" fill=\"none\" stroke=\"#1c1c1e\" stroke-width=\"1.3\"/>",
        path(way),
        path(&[back(1.0), *to, back(-1.0)])
    );
}

/// What of a convex polygon, or of a segment, is in the cell.
fn within(at: &[Flat]) -> Vec<Flat> {
    let sides = [([1.0, 0.0], WIDTH), ([-1.0, 0.0], 0.0), ([0.0, 1.0], HEIGHT), ([0.0, -1.0], 0.0)];
    let mut inside = sides.iter().fold(at.to_vec(), |at, (normal, offset)| cut(&at, *normal, *offset));
    // A segment is there and back.
    if at.len() == 2 {
        let far = |x: &Flat| (x[0] - at[0][0]).hypot(x[1] - at[0][1]);
        inside.sort_by(|x, y| far(x).total_cmp(&far(y)));
        if inside.len() > 2 {
            inside = vec![inside[0], inside[inside.len() - 1]];
        }
    }
    inside
}

fn is_inside([x, y]: Flat) -> bool {
    (0.0..=WIDTH).contains(&x) && (0.0..=HEIGHT).contains(&y)
}

fn path(points: &[Flat]) -> String {
    let mut text = String::new();
    for (k, [x, y]) in points.iter().enumerate() {
        let _ = write!(text, "{}{x:.1} {y:.1}", if k == 0 { 'M' } else { 'L' });
    }
    text
}
