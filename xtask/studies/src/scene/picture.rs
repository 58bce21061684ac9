//! A robot's ellipsoids among those of the obstacles as an animated SVG.

use std::fmt::Write as _;

use convex_support::Ellipsoid;
use convex_support::glam::{DMat3, DVec2, DVec3};

use xtask::plot::escape;

/// Seconds that a frame stays.
const PERIOD: f64 = 0.1;

/// Room for the legend above the picture.
const LEGEND: f64 = 84.0;

/// Room for the legend and the caption beside it.
const LEAST_WIDTH: f64 = 560.0;

pub(super) const OBSTACLE: &str = "#e69f00";

/// An ellipse of the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ellipse {
    center: DVec2,
    semi_axes: DVec2,
    angle: f64,
}

/// What is known of a link: the worst of its pairs with obstacles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum State {
    /// Its ellipsoid touches no obstacle's.
    #[default]
    Clear,
    /// Its ellipsoid does, its hull does not.
    Near,
    /// It overlaps an obstacle.
    Overlapping,
}

impl State {
    const ALL: [Self; 3] = [Self::Clear, Self::Near, Self::Overlapping];

    /// Told apart by the colour-blind too (Okabe and Ito).
    pub(super) fn colour(self) -> &'static str {
        match self {
            Self::Clear => "#0072b2",
            Self::Near => "#cc79a7",
            Self::Overlapping => "#d55e00",
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Clear => "link: its ellipsoid is clear",
            Self::Near => "link: hulls decided, clear",
            Self::Overlapping => "link overlaps an obstacle",
        }
    }
}

/// The robot at a time.
#[derive(Clone, Debug, Default)]
pub(super) struct Frame {
    pub(super) links: Vec<(Ellipse, State)>,
    /// The centre of the link of least margin, and the point of the nearest obstacle that it would touch first.
    pub(super) nearest: Option<[DVec2; 2]>,
    /// What is written beside it.
    pub(super) caption: String,
}

/// What is to be drawn.
#[derive(Debug)]
pub(super) struct Frames {
    obstacles: Vec<Ellipse>,
    frames: Vec<Frame>,
}

/// The picture's axes in the world: looking along (−0.5, 1, −0.65) with z up, as rows.
pub(super) fn view() -> DMat3 {
    let forward = DVec3::new(-0.5, 1.0, -0.65).normalize();
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

impl Ellipse {
    /// Half the size of the box around it.
    fn reach(&self) -> DVec2 {
        let axis = DVec2::from_angle(self.angle);
        let (a, b) = (axis * self.semi_axes.x, axis.perp() * self.semi_axes.y);
        DVec2::new(a.x.hypot(b.x), a.y.hypot(b.y))
    }
}

impl Frames {
    pub(super) fn new(obstacles: impl Iterator<Item = Ellipse>) -> Self {
        Self { obstacles: obstacles.collect(), frames: Vec::new() }
    }

    /// Adds a frame.
    pub(super) fn add(&mut self, frame: Frame) {
        self.frames.push(frame);
    }

    /// The animation; where nothing moves, its first frame.
    pub(super) fn svg(&self) -> String {
        let (mut low, mut high) = (DVec2::splat(f64::INFINITY), DVec2::splat(f64::NEG_INFINITY));
        let moving = self.frames.iter().flat_map(|frame| frame.links.iter().map(|(ellipse, _)| ellipse));
        for e in self.obstacles.iter().chain(moving) {
            let reach = e.reach();
            (low, high) = (low.min(e.center - reach), high.max(e.center + reach));
        }
        let scale = 720.0 / (high - low).max_element().max(f64::MIN_POSITIVE);
        let at = |p: DVec2| DVec2::new(p.x - low.x + 12.0 / scale, high.y - p.y + LEGEND / scale) * scale;
        let ellipse = |e: &Ellipse| {
            let (c, a) = (at(e.center), e.semi_axes * scale);
            let turn = -e.angle.to_degrees();
            format!(
                "<ellipse rx=\"{:.1}\" ry=\"{:.1}\" transform=\"translate({:.1} {:.1}) rotate({turn:.1})\"/>",
                a.x, a.y, c.x, c.y
            )
        };
        let size = (high - low) * scale + DVec2::new(24.0, LEGEND + 12.0);
        let mut svg = format!(
            "<svg viewBox=\"0 0 {:.0} {:.0}\" xmlns=\"http://www.w3.org/2000/svg\" font-family=\"system-ui, sans-serif\" \
             font-size=\"13\">\n<title>The ellipsoids around a robot's links along its trajectory, among those of the \
             obstacles</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
            size.x.max(LEAST_WIDTH),
            size.y
        );
        let mut entry = |row: usize, colour: &str, name: &str| {
            let y = 18.0 + 18.0 * row as f64;
            let _ = writeln!(
                svg,
                "<circle cx=\"18\" cy=\"{:.1}\" r=\"5\" fill=\"{colour}\" fill-opacity=\".5\" stroke=\"{colour}\"/>\
                 <text x=\"30\" y=\"{y:.1}\">{name}</text>",
                y - 4.5
            );
        };
        let occurs = |state: &State| self.frames.iter().any(|frame| frame.links.iter().any(|(_, s)| s == state));
        let states = State::ALL.into_iter().filter(occurs).map(|state| (state.colour(), state.name()));
        for (row, (colour, name)) in states.chain([(OBSTACLE, "obstacle")]).enumerate() {
            entry(row, colour, name);
        }
        let _ = write!(svg, "<g fill=\"{OBSTACLE}\" fill-opacity=\".3\" stroke=\"#b57d00\">");
        svg.extend(self.obstacles.iter().map(ellipse));
        svg.push_str("</g>\n");
        let count = self.frames.len().max(1) as f64;
        for (k, frame) in self.frames.iter().enumerate() {
            let [from, to] = [k as f64 / count, (k + 1) as f64 / count];
            let (display, values, times) = if k == 0 {
                ("inline", "inline;none".to_owned(), format!("0;{to:.4}"))
            } else {
                ("none", "none;inline;none".to_owned(), format!("0;{from:.4};{to:.4}"))
            };
            let _ = write!(
                svg,
                "<g display=\"{display}\" fill-opacity=\".35\">\
                 <animate attributeName=\"display\" calcMode=\"discrete\" repeatCount=\"indefinite\" \
                 dur=\"{:.1}s\" values=\"{values}\" keyTimes=\"{times}\"/>",
                count * PERIOD
            );
            for state in State::ALL {
                let of_state: String =
                    frame.links.iter().filter(|(_, s)| *s == state).map(|(e, _)| ellipse(e)).collect();
                if !of_state.is_empty() {
                    let colour = state.colour();
                    let _ = write!(svg, "<g fill=\"{colour}\" stroke=\"{colour}\">{of_state}</g>");
                }
            }
            if let Some([from, to]) = frame.nearest.map(|ends| ends.map(at)) {
                let _ = write!(
                    svg,
                    "<path d=\"M{:.1} {:.1}L{:.1} {:.1}\" stroke=\"#000\" stroke-dasharray=\"4 3\"/>\
                     <circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"4.5\" fill-opacity=\"1\"/>",
                    from.x, from.y, to.x, to.y, to.x, to.y
                );
            }
            for (row, line) in frame.caption.lines().enumerate() {
                let _ = write!(
                    svg,
                    "<text x=\"270\" y=\"{:.1}\" fill-opacity=\"1\">{}</text>",
                    18.0 + 18.0 * row as f64,
                    escape(line)
                );
            }
            svg.push_str("</g>\n");
        }
        svg.push_str("</svg>\n");
        svg
    }
}
