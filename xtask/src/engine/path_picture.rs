//! A robot's way as a picture: its links where they are along the way, what is around it, and the first contact.

use std::fmt::Write as _;

use convex_support::SupportMap;
use convex_support::glam::{DMat3, DVec2, DVec3};
use gjk_raycast::{Body, Impact, Linkage, PathContact, Scene};

use crate::plot::{GROUND, INK, by_theme};
use crate::wire::shape::Solid;

/// Poses for each edge, and directions for each outline.
const POSES: usize = 12;
const DIRECTIONS: usize = 24;
const WIDTH: f64 = 640.0;
const MARGIN: f64 = 14.0;
/// Room for the legend.
const LEGEND: f64 = 64.0;
/// Of links before the contact and after it, of obstacles and of the contact: told apart by the colour-blind too (Okabe
/// and Ito).
const COLOURS: [&str; 4] = ["#0072b2", "#8a8a8a", "#e69f00", "#c2185b"];

/// An outline, and how far from the eye its middle is.
struct Outline {
    points: Vec<DVec2>,
    depth: f64,
}

/// Outlines to be drawn in one way.
struct Layer {
    style: String,
    outlines: Vec<Outline>,
}

/// The picture as an `<svg>` element; `None` where a pose of the robot is not known.
pub(super) fn svg(
    robot: &Linkage<Solid<DVec3>>,
    scene: &Scene<Solid<DVec3>>,
    waypoints: &[Vec<f64>],
    contact: Option<(PathContact<DVec3>, Impact<DVec3>)>,
) -> Option<String> {
    let view = view();
    let outline = |body: &dyn SupportMap<Vector = DVec3>| -> Outline {
        let support = |direction: DVec3| view * body.support(view.transpose() * direction);
        let angles = (0..DIRECTIONS).map(|k| std::f64::consts::TAU * k as f64 / DIRECTIONS as f64);
        let points = angles.map(|angle| support(DVec2::from_angle(angle).extend(0.0)).truncate()).collect();
        Outline { points, depth: f64::midpoint(support(DVec3::Z).z, support(DVec3::NEG_Z).z) }
    };
    let posed = |values: &[f64]| -> Option<Vec<Outline>> {
        let bodies = (0..robot.links()).flat_map(|link| (0..robot.bodies(link).len()).map(move |body| (link, body)));
        bodies.map(|(link, body)| Some(outline(&robot.placed(link, body, values).ok()?))).collect()
    };
    let at = |edge: usize, time: f64| -> Vec<f64> {
        waypoints[edge].iter().zip(&waypoints[edge + 1]).map(|(a, b)| a + time * (b - a)).collect()
    };
    let end = contact.map_or(f64::INFINITY, |(contact, hit)| contact.edge as f64 + hit.time);
    let (mut before, mut after) = (Vec::new(), Vec::new());
    for (edge, k) in (0..waypoints.len() - 1).flat_map(|edge| (0..=POSES).map(move |k| (edge, k))) {
        let time = k as f64 / POSES as f64;
        let layer = if edge as f64 + time <= end { &mut before } else { &mut after };
        layer.extend(posed(&at(edge, time))?);
    }
    let swept = |colour: &str, opacity: f64, line: f64| {
        format!("fill=\"{colour}\" fill-opacity=\"{opacity}\" stroke=\"{colour}\" stroke-opacity=\"{line}\"")
    };
    let obstacles = scene.iter().filter_map(|(_, body)| match body {
        Body::Convex(body) => Some(outline(body)),
        Body::HalfSpace(_) => None,
    });
    let swept_over = vec![
        Layer { style: swept(COLOURS[1], 0.03, 0.2), outlines: after },
        Layer { style: swept(COLOURS[0], 0.04, 0.2), outlines: before },
    ];
    let mut solid = vec![
        Layer { style: swept(COLOURS[2], 0.4, 1.0), outlines: obstacles.collect() },
        Layer { style: swept(COLOURS[0], 0.7, 1.0), outlines: posed(&waypoints[0])? },
    ];
    if let Some((contact, hit)) = contact {
        solid.push(Layer { style: swept(COLOURS[3], 0.7, 1.0), outlines: posed(&at(contact.edge, hit.time))? });
    }
    let point = contact.map(|(_, hit)| (view * hit.point).truncate());
    Some(draw(swept_over.into_iter().chain(by_depth(solid)).collect(), point, contact))
}

/// Outlines from the farthest to the nearest, so that what is in front covers what is behind.
fn by_depth(layers: Vec<Layer>) -> Vec<Layer> {
    let each = |Layer { style, outlines }| {
        outlines.into_iter().map(move |outline| Layer { style: String::clone(&style), outlines: vec![outline] })
    };
    let mut apart: Vec<Layer> = layers.into_iter().flat_map(each).collect();
    apart.sort_by(|a, b| b.outlines[0].depth.total_cmp(&a.outlines[0].depth));
    apart
}

fn draw(layers: Vec<Layer>, point: Option<DVec2>, contact: Option<(PathContact<DVec3>, Impact<DVec3>)>) -> String {
    let points = || layers.iter().flat_map(|layer| layer.outlines.iter().flat_map(|outline| outline.points.clone()));
    let low = points().fold(DVec2::INFINITY, DVec2::min);
    let high = points().fold(DVec2::NEG_INFINITY, DVec2::max);
    let scale = (WIDTH - 2.0 * MARGIN) / (high.x - low.x).max(f64::MIN_POSITIVE);
    let at = |p: DVec2| DVec2::new(MARGIN + (p.x - low.x) * scale, LEGEND + (high.y - p.y) * scale);
    let height = LEGEND + (high.y - low.y) * scale + MARGIN;
    let mut svg = format!(
        "<svg viewBox=\"0 0 {WIDTH} {height:.0}\" xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" \
         font-family=\"system-ui, sans-serif\" font-size=\"14\">\n<title>A robot along an edge, and its first contact\
         </title>\n<rect width=\"100%\" height=\"100%\" fill=\"{GROUND}\"/>\n"
    );
    for Layer { style, outlines } in &layers {
        let _ = write!(svg, "<path {style} d=\"");
        for outline in outlines {
            // In tenths, from one to the next.
            let mut last = DVec2::ZERO;
            for (k, point) in outline.points.iter().map(|p| (at(*p) * 10.0).round()).enumerate() {
                let (step, letter) = ((point - last) / 10.0, if k == 0 { 'M' } else { 'l' });
                let _ = write!(svg, "{letter}{} {}", step.x, step.y);
                last = point;
            }
            svg.push('z');
        }
        svg.push_str("\"/>\n");
    }
    let first = contact.map_or_else(String::new, |(contact, hit)| {
        format!("first contact: link {}, after {:.2} % of the way", contact.link, 100.0 * hit.time)
    });
    let entries = [
        (0, "robot at the start, and its way"),
        (1, "its way after the contact"),
        (2, "obstacles"),
        (3, first.as_str()),
    ];
    for (k, (colour, name)) in entries.into_iter().filter(|(k, _)| contact.is_some() || k % 2 == 0).enumerate() {
        let (x, y) = (18.0 + 280.0 * (k % 2) as f64, 20.0 + 22.0 * (k / 2) as f64);
        let _ = writeln!(
            svg,
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"6\" fill=\"{0}\" fill-opacity=\".4\" stroke=\"{0}\"/>\
             <text x=\"{1}\" y=\"{2}\" fill=\"{INK}\">{name}</text>",
            COLOURS[colour],
            x + 14.0,
            y + 5.0
        );
    }
    // An arrow from aside ends at the contact, which is small.
    if let Some(point) = point.map(at) {
        let _ = writeln!(
            svg,
            "<path d=\"M{:.1} {:.1}l40 40m-40 -40h12m-12 0v12\" fill=\"none\" stroke=\"{2}\" stroke-width=\"3\"/>\
             <text x=\"{3:.1}\" y=\"{4:.1}\" fill=\"{INK}\" font-weight=\"600\">first contact</text>",
            point.x + 4.0,
            point.y + 4.0,
            COLOURS[3],
            point.x + 46.0,
            point.y + 58.0
        );
    }
    svg.push_str("</svg>\n");
    by_theme(&svg)
}

/// The picture's axes in the world, as rows: from the side and a little from above, with z up.
fn view() -> DMat3 {
    let forward = DVec3::new(-0.8, 0.75, -0.45).normalize();
    let right = forward.cross(DVec3::Z).normalize();
    DMat3::from_cols(right, right.cross(forward), forward).transpose()
}
