//! A picture of a level, seen from above and aside without perspective, as SVG: bodies are outlines by their support
//! points, what is behind is drawn first, and lines and dots lie on top.

use std::fmt::Write as _;

use convex_support::SupportMap;
use convex_support::glam::{Mat3, Vec3};

/// Pixels of a unit of length, and the middle of the picture.
const SCALE: f32 = 40.0;
const MIDDLE: [f32; 2] = [320.0, 210.0];
/// Directions along which the outline of a body is asked for.
const DIRECTIONS: u16 = 64;

/// What is drawn so far: bodies with how far in front they are, and what lies on top.
#[derive(Default)]
pub(crate) struct Picture {
    bodies: Vec<(f32, String)>,
    top: String,
}

/// To the right, up, and towards the eye.
fn view() -> Mat3 {
    Mat3::from_rotation_x(0.7) * Mat3::from_rotation_y(-0.35)
}

fn place(point: Vec3) -> [f32; 2] {
    let seen = view() * point;
    [MIDDLE[0] + SCALE * seen.x, MIDDLE[1] - SCALE * seen.y]
}

impl Picture {
    /// Draws the outline of a body in a class of the style sheet.
    pub(crate) fn body(&mut self, class: &str, body: &dyn SupportMap<Vector = Vec3>) {
        let to_world = view().transpose();
        let corners = (0..DIRECTIONS).map(|i| {
            let (y, x) = (core::f32::consts::TAU * f32::from(i) / f32::from(DIRECTIONS)).sin_cos();
            let [x, y] = place(body.support(to_world * Vec3::new(x, y, 0.0)));
            format!("{x:.1} {y:.1}")
        });
        let mut corners: Vec<String> = corners.collect();
        corners.dedup();
        // What lies on the ground is behind all that stands on it.
        let [low, high] = [-1.0, 1.0].map(|side| body.support(Vec3::Y * side).y);
        let middle = body.support(to_world * Vec3::Z) + body.support(to_world * Vec3::NEG_Z);
        let depth = if low == high { f32::NEG_INFINITY } else { (view() * middle).z };
        self.bodies.push((depth, format!("<path class=\"{class}\" d=\"M{}z\"/>", corners.join("L"))));
    }

    /// Draws a line to a dot.
    pub(crate) fn way(&mut self, class: &str, from: Vec3, to: Vec3) {
        let ([a, b], [c, d]) = (place(from), place(to));
        let _ = writeln!(
            self.top,
            "<path class=\"way {class}\" d=\"M{a:.1} {b:.1}L{c:.1} {d:.1}\"/>\
             <circle class=\"{class}\" cx=\"{c:.1}\" cy=\"{d:.1}\" r=\"4\"/>"
        );
    }

    /// Writes below a point.
    pub(crate) fn label(&mut self, text: &str, at: Vec3) {
        let [x, y] = place(at);
        let _ = writeln!(self.top, "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{text}</text>", y + 20.0);
    }

    /// The picture, for light pages and for dark ones.
    pub(crate) fn svg(mut self) -> String {
        self.bodies.sort_by(|a, b| a.0.total_cmp(&b.0));
        let bodies: Vec<_> = self.bodies.into_iter().map(|(_, body)| body).collect();
        format!(
            "<svg viewBox=\"0 0 640 420\" role=\"img\" aria-label=\"A level of a game, and what was asked about it\" \
             xmlns=\"http://www.w3.org/2000/svg\" font-family=\"system-ui, sans-serif\" font-size=\"15\">\n\
             <style>.paper{{fill:#fff}}text{{fill:#1c1c1e;paint-order:stroke;stroke:#fff;stroke-width:4}}\
             .ground{{fill:#eef0f2;stroke:#c3c7cc;stroke-width:.6}}.crystal{{fill:#e69f00;stroke:#7a5400}}\
             .hero{{fill:#0072b2;stroke:#00334f}}.was{{fill:none;stroke:#0072b2;stroke-dasharray:4 3}}\
             .bullet,.enemy{{fill:#c2185b;stroke:#5c0a2a}}.gone{{fill:none;stroke:#c2185b;stroke-dasharray:4 3}}\
             .picked{{fill:#009e73;stroke:#00523c}}.shot{{fill:#c2185b;stroke:#c2185b}}.ray{{fill:#009e73;stroke:#009e73}}\
             .walk{{fill:#0072b2;stroke:#0072b2}}.way{{fill:none;stroke-width:2}}\
             @media(prefers-color-scheme:dark){{.paper{{fill:#16181c}}text{{fill:#e8e8ea;stroke:#16181c}}\
             .ground{{fill:#23262b;stroke:#44484f}}.hero,.walk{{fill:#56b4e9;stroke:#bfe3f8}}.was{{stroke:#56b4e9}}\
             .way{{fill:none}}.ray{{stroke:#2fd3a5}}.shot{{stroke:#ff7aa8}}.gone{{stroke:#ff7aa8}}}}</style>\n\
             <rect class=\"paper\" width=\"100%\" height=\"100%\"/>\n{}\n{}</svg>\n",
            bodies.join("\n"),
            self.top
        )
    }
}
