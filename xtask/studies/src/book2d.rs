//! `cargo xtask book2d`: the descent of GJK in the plane, step by step, as the book draws it.
//!
//! Schneider and Eberly, *Geometric Tools for Computer Graphics* (2003), Section 6.10.1, figures 6.25 to 6.29: the
//! simplex `S_k`, the closest point `V_k` of it to the origin, and the support point `W_k` that joins it. The vertices
//! that do not carry `V_k` have been discarded.

use std::fmt::Write as _;
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use convex_support::glam::DVec2;
use convex_support::{Point, Polytope};
use gjk_raycast::{Distance, DistanceOptions, Iterate, distance_with};
use xtask::plot::{GROUND, INK, by_theme};

/// A convex polygon whose distance from the origin is asked for, and the vertex to start at.
struct Figure {
    name: &'static str,
    polygon: &'static [[f64; 2]],
    first: [f64; 2],
}

const FIGURES: &[Figure] = &[
    Figure {
        name: "hexagon",
        polygon: &[[2.0, 1.0], [3.5, -0.6], [6.0, -0.9], [7.4, 1.2], [6.4, 3.4], [3.6, 3.6]],
        first: [-1.0, -0.6],
    },
    Figure {
        name: "edge",
        polygon: &[[1.6, -2.4], [5.0, -3.0], [7.0, 0.4], [5.2, 3.2], [2.2, 2.6]],
        first: [-1.0, 0.3],
    },
    Figure {
        name: "inside",
        polygon: &[[-2.0, -1.4], [2.6, -2.0], [3.4, 1.0], [0.2, 2.6], [-2.6, 1.2]],
        first: [-1.0, 0.2],
    },
];

/// One iterate, in the units of the figure.
#[derive(Clone, Debug)]
struct Step {
    simplex: Vec<DVec2>,
    v: DVec2,
    w: DVec2,
}

/// Draws the figures into `folder`.
pub(crate) fn run(folder: &Path) -> ExitCode {
    match draw(folder, &mut io::stdout().lock()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => xtask::output::failed(&format!("cannot write to {}", folder.display()), &why),
    }
}

fn draw(folder: &Path, output: &mut impl Write) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    for figure in FIGURES {
        let Some((steps, end)) = descend(figure) else { continue };
        let path = folder.join(format!("{}.svg", figure.name));
        fs::write(&path, svg(figure, &steps, &end))?;
        writeln!(output, "{}: {} steps, distance {}", path.display(), steps.len(), end.distance)?;
        for (k, Step { simplex, v, w }) in steps.iter().enumerate() {
            writeln!(output, "  {k}: {} vertices, |V| = {:.6}, W = ({}, {})", simplex.len(), v.length(), w.x, w.y)?;
        }
    }
    Ok(())
}

/// The descent, as the observer sees it; none if the figure is no polygon.
fn descend(figure: &Figure) -> Option<(Vec<Step>, Distance<DVec2>)> {
    let polygon = Polytope::new(figure.polygon.iter().map(|&p| DVec2::from_array(p))).ok()?;
    let origin = Point::new(DVec2::ZERO).ok()?;
    let mut steps = Vec::new();
    let mut options = DistanceOptions::new();
    options.axis = Some(DVec2::from_array(figure.first));
    let end = distance_with(&polygon, &origin, options, |iterate: Iterate<'_, DVec2>| {
        let place = |p: DVec2| p * iterate.scale;
        let simplex = iterate.simplex.iter().map(|&p| place(p)).collect();
        steps.push(Step { simplex, v: place(iterate.v), w: place(iterate.w) });
    });
    Some((steps, end))
}

/// Pixels per unit, and the size of a panel.
const UNIT: f64 = 30.0;
const PANEL: DVec2 = DVec2::new(360.0, 270.0);

/// One panel per step, and one for the end.
fn svg(figure: &Figure, steps: &[Step], end: &Distance<DVec2>) -> String {
    let points = || figure.polygon.iter().map(|&p| DVec2::from_array(p)).chain([DVec2::ZERO]);
    let low = points().fold(DVec2::INFINITY, DVec2::min);
    let high = points().fold(DVec2::NEG_INFINITY, DVec2::max);
    let middle = (low + high) / 2.0;
    let at = |p: DVec2| DVec2::new((p.x - middle.x) * UNIT, (middle.y - p.y) * UNIT) + PANEL / 2.0;
    let path = |points: &mut dyn Iterator<Item = DVec2>| {
        let corners: Vec<String> = points.map(at).map(|p| format!("{:.1} {:.1}", p.x, p.y)).collect();
        format!("M{}", corners.join("L"))
    };
    // A point, and its name to the right and above, or as far aside as is said.
    let dot = |p: DVec2, name: &str, colour: &str, aside: DVec2| {
        let p = at(p);
        format!(
            "<circle cx=\"{0:.1}\" cy=\"{1:.1}\" r=\"4\" fill=\"{colour}\"/>\
             <text x=\"{2:.1}\" y=\"{3:.1}\" fill=\"{colour}\">{name}</text>",
            p.x,
            p.y,
            p.x + aside.x,
            p.y + aside.y
        )
    };
    let above = DVec2::new(7.0, -6.0);
    let ring = |p: DVec2| {
        let p = at(p);
        format!("<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"8\" stroke=\"#0072b2\" stroke-width=\"3\"/>", p.x, p.y)
    };
    let outline = path(&mut figure.polygon.iter().map(|&p| DVec2::from_array(p)));
    // The first iterate has no simplex yet, only a direction: it is left to the text.
    let panels: Vec<(String, String)> = steps
        .iter()
        .enumerate()
        .filter(|(_, step)| !step.simplex.is_empty())
        .map(|(k, Step { simplex, v, w })| {
            let s = path(&mut simplex.iter().copied());
            // The line through W across V: no point of the polygon is nearer to the origin along V.
            let along = v.perp().normalize_or_zero() * PANEL.x;
            let mut drawing = format!(
                "<path d=\"{s}Z\" stroke=\"#0072b2\" stroke-width=\"3\"/>\
                 <path d=\"{}\" stroke=\"#d55e00\" stroke-dasharray=\"3 3\"/>\
                 <path d=\"{}\" stroke=\"#009e73\" stroke-dasharray=\"6 3\"/>",
                path(&mut [DVec2::ZERO, *v].into_iter()),
                path(&mut [*w - along, *w + along].into_iter()),
            );
            drawing.extend(simplex.iter().map(|&p| ring(p)));
            // Beside the line, on the side of the polygon.
            let inward = v.normalize_or_zero() * DVec2::new(20.0, -20.0) + DVec2::new(0.0, 16.0);
            drawing += &dot(*w, &format!("W<tspan baseline-shift=\"sub\">{k}</tspan>"), "#009e73", inward);
            drawing += &dot(*v, &format!("V<tspan baseline-shift=\"sub\">{k}</tspan>"), "#d55e00", above * 1.6);
            let plural = if simplex.len() == 1 { "vertex" } else { "vertices" };
            (format!("k = {k}: {} {plural}, |V| = {:.4}", simplex.len(), v.length()), drawing)
        })
        .chain([(
            format!("end: distance {:.4}", end.distance),
            if end.overlap { String::new() } else { dot(end.point_a, "closest point", "#d55e00", above) },
        )])
        .collect();
    let columns = (1..).find(|n| n * n >= panels.len()).unwrap_or(1);
    let rows = panels.len().div_ceil(columns);
    let mut svg = format!(
        "<svg viewBox=\"0 0 {} {}\" xmlns=\"http://www.w3.org/2000/svg\" fill=\"none\" \
         font-family=\"system-ui, sans-serif\" font-size=\"17\">\n<title>Descent of GJK on the {}</title>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"{GROUND}\"/>\n\
         <clipPath id=\"panel\"><rect width=\"{}\" height=\"{}\"/></clipPath>\n",
        columns as f64 * PANEL.x,
        rows as f64 * PANEL.y,
        figure.name,
        PANEL.x,
        PANEL.y - 4.0
    );
    for (i, (caption, drawing)) in panels.iter().enumerate() {
        let corner = DVec2::new((i % columns) as f64, (i / columns) as f64) * PANEL;
        let _ = writeln!(
            svg,
            "<g transform=\"translate({} {})\" clip-path=\"url(#panel)\"><path d=\"{outline}Z\" stroke=\"{INK}\" stroke-opacity=\".5\"/>\
             {}{drawing}<text x=\"12\" y=\"22\" fill=\"{INK}\">{caption}</text></g>",
            corner.x,
            corner.y,
            dot(DVec2::ZERO, "origin", INK, above)
        );
    }
    svg.push_str("</svg>\n");
    by_theme(&svg)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_descent_goes_down() {
        for figure in FIGURES {
            let (steps, end) = descend(figure).expect("a polygon");
            let lengths: Vec<f64> = steps.iter().filter(|s| !s.simplex.is_empty()).map(|s| s.v.length()).collect();
            assert!(lengths.is_sorted_by(|a, b| a >= b), "|V| never grows: {}: {lengths:?}", figure.name);
            assert_eq!(end.overlap, figure.name == "inside", "{}", figure.name);
            assert!(steps.len() <= figure.polygon.len() + 2, "finitely many steps on a polygon: {}", figure.name);
        }
    }
}
