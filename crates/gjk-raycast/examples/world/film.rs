//! Pictures of a world from the side, at some moments, as SVG: bodies are outlines, and points of contact are dots.

use std::fmt::Write as _;

use gjk_raycast::convex_support::SupportMap;
use gjk_raycast::convex_support::glam::DVec3;

use crate::world::World;

/// As wide as a telephone's page.
const WIDTH: f64 = 390.0;
const TITLE: f64 = 30.0;
const CAPTION: f64 = 22.0;
/// Directions along which the outline of a body is asked for.
const DIRECTIONS: u32 = 96;

/// Moments of a world.
pub(crate) struct Film {
    title: &'static str,
    /// What is seen of x and y.
    view: [[f64; 2]; 2],
    columns: usize,
    frames: Vec<(String, String)>,
}

impl Film {
    pub(crate) fn new(title: &'static str, view: [[f64; 2]; 2], columns: usize) -> Self {
        Self { title, view, columns, frames: Vec::new() }
    }

    /// How large a frame is, and how many pixels a unit of length is.
    fn frame(&self) -> ([f64; 2], f64) {
        let [width, height] = self.view.map(|[from, to]| to - from);
        let each = WIDTH / self.columns as f64;
        let scale = (each - 8.0) / width;
        ([each, height * scale + CAPTION], scale)
    }

    fn place(&self, point: DVec3) -> [f64; 2] {
        let (_, scale) = self.frame();
        [(point.x - self.view[0][0]) * scale + 4.0, (self.view[1][1] - point.y) * scale]
    }

    /// Adds what the world looks like now.
    pub(crate) fn take(&mut self, world: &World<DVec3>, caption: String) {
        let mut drawn = String::new();
        for body in &world.bodies {
            let corners = (0..DIRECTIONS).map(|i| {
                let (sine, cosine) = (std::f64::consts::TAU * f64::from(i) / f64::from(DIRECTIONS)).sin_cos();
                let direction = body.rotation.transpose() * DVec3::new(cosine, sine, 0.0);
                let [x, y] = self.place(body.center + body.rotation * body.shape.support(direction));
                format!("{x:.1} {y:.1}")
            });
            let mut corners: Vec<String> = corners.collect();
            corners.dedup();
            let class = if body.inverse_mass > 0.0 { "body" } else { "fixed" };
            let _ = writeln!(drawn, "<path class=\"{class}\" d=\"M{}z\"/>", corners.join("L"));
        }
        for point in world.contacts.iter().flat_map(|found| found.contact.points()) {
            let [x, y] = self.place(point.point_a);
            let _ = writeln!(drawn, "<circle class=\"dot\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\"/>");
        }
        self.frames.push((caption, drawn));
    }

    /// The picture, black on white or white on black as the page is.
    pub(crate) fn svg(&self) -> String {
        let ([width, height], _) = self.frame();
        let rows = self.frames.len().div_ceil(self.columns);
        let all = TITLE + (height + 6.0) * rows as f64;
        let mut svg = format!(
            "<svg viewBox=\"0 0 {WIDTH} {all:.0}\" role=\"img\" aria-label=\"{0}\" \
             xmlns=\"http://www.w3.org/2000/svg\" font-family=\"system-ui, sans-serif\" font-size=\"14\">\n\
             <style>.ground{{fill:#fff}}.ink{{fill:#1c1c1e}}.fixed{{fill:#c9ccd1;stroke:#6b6f76}}\
             .body{{fill:#8ab4d8;fill-opacity:.6;stroke:#123a5c;stroke-width:1.2}}.dot{{fill:#c23b00}}\
             @media(prefers-color-scheme:dark){{.ground{{fill:#16181c}}.ink{{fill:#e8e8ea}}\
             .fixed{{fill:#44484f;stroke:#8d929a}}.body{{fill:#3f78a8;stroke:#cfe4f7}}.dot{{fill:#ffb27a}}}}</style>\n\
             <rect class=\"ground\" width=\"100%\" height=\"100%\"/>\n\
             <text class=\"ink\" x=\"6\" y=\"20\" font-size=\"16\" font-weight=\"600\">{0}</text>\n",
            self.title
        );
        for (i, (caption, drawn)) in self.frames.iter().enumerate() {
            let (x, y) = (width * (i % self.columns) as f64, TITLE + (height + 6.0) * (i / self.columns) as f64);
            let _ = writeln!(
                svg,
                "<svg x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{0:.1}\">\n{drawn}</svg>\n\
                 <text class=\"ink\" x=\"{1:.1}\" y=\"{2:.1}\" text-anchor=\"middle\">{caption}</text>",
                height - CAPTION,
                x + width / 2.0,
                y + height - 5.0
            );
        }
        svg.push_str("</svg>\n");
        svg
    }
}
