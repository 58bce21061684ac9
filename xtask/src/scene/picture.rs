//! A robot's ellipsoids among those of the obstacles as an animated SVG.

use std::fmt::Write as _;

use convex_support::Ellipsoid;
use convex_support::glam::{DMat3, DVec2, DVec3};

/// Seconds that a frame stays.
const PERIOD: f64 = 0.1;

/// An ellipse of the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ellipse {
    center: DVec2,
    semi_axes: DVec2,
    angle: f64,
}

/// What is to be drawn.
#[derive(Debug)]
pub(super) struct Frames {
    obstacles: Vec<Ellipse>,
    frames: Vec<(Vec<Ellipse>, Option<DVec2>)>,
}

/// The picture's axes in the world: looking along (−1, −1, −½) with z up, as rows.
fn view() -> DMat3 {
    let forward = DVec3::new(-1.0, -1.0, -0.5).normalize();
    let right = forward.cross(DVec3::Z).normalize();
    DMat3::from_cols(right, right.cross(forward), forward).transpose()
}

/// Where a point of space is in the picture.
pub(super) fn project(point: DVec3) -> DVec2 {
    (view() * point).truncate()
}

/// The outline of an ellipsoid: the support values of the outline are those of the ellipsoid within the picture, so its
/// shape matrix is a block of R·diag(a²)·Rᵀ in the picture's axes.
pub(super) fn outline(e: &Ellipsoid<DVec3>) -> Ellipse {
    let view = view();
    let shape = view * e.shape_matrix() * view.transpose();
    let (a, b, c) = (shape.x_axis.x, shape.x_axis.y, shape.y_axis.y);
    let (mean, half) = ((a + c) / 2.0, (a - c).hypot(2.0 * b) / 2.0);
    let semi_axes = DVec2::new((mean + half).sqrt(), (mean - half).max(0.0).sqrt());
    Ellipse { center: project(e.center()), semi_axes, angle: (2.0 * b).atan2(a - c) / 2.0 }
}

/// An ellipse of the plane as it is.
pub(super) fn flat(e: &Ellipsoid<DVec2>) -> Ellipse {
    Ellipse { center: e.center(), semi_axes: e.semi_axes(), angle: e.axes().x_axis.to_angle() }
}

impl Frames {
    pub(super) fn new(obstacles: impl Iterator<Item = Ellipse>) -> Self {
        Self { obstacles: obstacles.collect(), frames: Vec::new() }
    }

    /// Adds a frame; `nearest` is the point of the nearest obstacle nearest to the robot.
    pub(super) fn add(&mut self, links: impl Iterator<Item = Ellipse>, nearest: Option<DVec2>) {
        self.frames.push((links.collect(), nearest));
    }

    /// The animation; where nothing moves, its first frame.
    pub(super) fn svg(&self) -> String {
        let (mut low, mut high) = (DVec2::splat(f64::INFINITY), DVec2::splat(f64::NEG_INFINITY));
        for e in self.obstacles.iter().chain(self.frames.iter().flat_map(|(links, _)| links)) {
            let reach = DVec2::splat(e.semi_axes.max_element());
            (low, high) = (low.min(e.center - reach), high.max(e.center + reach));
        }
        let scale = 720.0 / (high - low).max_element().max(f64::MIN_POSITIVE);
        let at = |p: DVec2| DVec2::new(p.x - low.x, high.y - p.y) * scale;
        let ellipse = |e: &Ellipse| {
            let (c, a) = (at(e.center), e.semi_axes * scale);
            let turn = -e.angle.to_degrees();
            format!(
                "<ellipse rx=\"{:.1}\" ry=\"{:.1}\" transform=\"translate({:.1} {:.1}) rotate({turn:.1})\"/>",
                a.x, a.y, c.x, c.y
            )
        };
        let size = (high - low) * scale;
        let mut svg = format!(
            "<svg viewBox=\"0 0 {:.0} {:.0}\" xmlns=\"http://www.w3.org/2000/svg\">\n\
             <title>The links' enclosing ellipsoids (blue) along the trajectory, among those of the obstacles (orange); \
             the dot is the point of the nearest obstacle that a grown link would touch first</title>\n\
             <g fill=\"#e69f00\" fill-opacity=\".35\" stroke=\"#b57d00\">",
            size.x, size.y
        );
        svg.extend(self.obstacles.iter().map(ellipse));
        svg.push_str("</g>\n");
        let count = self.frames.len().max(1) as f64;
        for (k, (links, nearest)) in self.frames.iter().enumerate() {
            let [from, to] = [k as f64 / count, (k + 1) as f64 / count];
            let (display, values, times) = if k == 0 {
                ("inline", "inline;none".to_owned(), format!("0;{to:.4}"))
            } else {
                ("none", "none;inline;none".to_owned(), format!("0;{from:.4};{to:.4}"))
            };
            let _ = write!(
                svg,
                "<g display=\"{display}\" fill=\"#0072b2\" fill-opacity=\".35\" stroke=\"#0072b2\">\
                 <animate attributeName=\"display\" calcMode=\"discrete\" repeatCount=\"indefinite\" \
                 dur=\"{:.1}s\" values=\"{values}\" keyTimes=\"{times}\"/>",
                count * PERIOD
            );
            svg.extend(links.iter().map(ellipse));
            if let Some(p) = nearest.map(at) {
                let _ = write!(
                    svg,
                    "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"5\" fill=\"#d55e00\" fill-opacity=\"1\" stroke=\"none\"/>",
                    p.x, p.y
                );
            }
            svg.push_str("</g>\n");
        }
        svg.push_str("</svg>\n");
        svg
    }
}
