//! Plots as SVG, by hand: points and lines that can be told apart by colour and by mark, on light and dark pages and on
//! paper.

mod panels;
mod theme;

use std::fmt::Write as _;

pub use self::panels::{Mark, Panel, Panels};
pub use self::theme::{GROUND, INK, by_theme};

/// One set of points of a plot.
#[derive(Clone, Debug)]
pub struct Series {
    pub name: String,
    pub points: Vec<[f64; 2]>,
    /// Whether the points are joined, in the order given.
    pub joined: bool,
    /// Which of the colours and marks; plots side by side give the same thing the same one.
    pub colour: usize,
}

/// How numbers are laid out along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    Linear,
    /// Logarithmic. What is not positive is drawn at the lower edge.
    Log,
    /// Logarithmic, of nanoseconds.
    Time,
}

/// Numbers against numbers.
#[derive(Clone, Debug)]
pub struct Plot {
    pub title: String,
    pub x: String,
    pub y: String,
    pub scales: [Scale; 2],
    /// What is below is drawn there.
    pub floor: f64,
    pub series: Vec<Series>,
}

/// Narrow enough to be read on a telephone.
const WIDTH: f64 = 520.0;
/// Of the plot with its axes; the legend comes below.
const HEIGHT: f64 = 370.0;
const LEFT: f64 = 72.0;
const RIGHT: f64 = 30.0;
const TOP: f64 = 40.0;
const BOTTOM: f64 = 48.0;
const LEGEND_ROW: f64 = 20.0;
/// About the width of a letter, to lay out the legend.
const LETTER: f64 = 7.2;

/// Colours after Okabe and Ito, made as dark as text has to be on white, with a contrast of 4.5 to 1; where two look
/// alike to the colour-blind, the marks differ. A page may replace them by its custom properties `--c0` to `--c11`,
/// such as brighter ones on a dark ground.
const COLOURS: [&str; 12] = [
    "#0072b2", "#c25400", "#17803d", "#b8508f", "#8a6a00", "#00798c", "#7a5195", "#6f6f6f", "#8b4513", "#b0123b",
    "#3d49b5", "#66760f",
];

impl Plot {
    /// The plot as an `<svg>` element.
    pub fn svg(&self) -> String {
        let xs = self.series.iter().flat_map(|s| s.points.iter().map(|p| p[0]));
        let ys = self.series.iter().flat_map(|s| s.points.iter().map(|p| p[1].max(self.floor)));
        let (x, y) = (Axis::around(self.scales[0], xs), Axis::around(self.scales[1], ys));
        let legend = self.legend();
        let rows = legend.iter().map(|entry| entry.row + 1).max().unwrap_or(0);
        let frame = Frame { x, y, floor: self.floor, size: [WIDTH, HEIGHT] };
        let mut svg = format!(
            "<svg viewBox=\"0 0 {WIDTH} {:.0}\" role=\"img\" aria-label=\"{1}\" xmlns=\"http://www.w3.org/2000/svg\" \
             font-family=\"system-ui, sans-serif\" font-size=\"13.5\" fill=\"currentColor\">\n\
             <text x=\"8\" y=\"18\" font-size=\"15\" font-weight=\"600\">{1}</text>\n",
            HEIGHT + LEGEND_ROW * rows as f64,
            escape(&self.title)
        );
        let floored = self.series.iter().flat_map(|s| &s.points).any(|p| p[1] < self.floor);
        frame.axes(&mut svg, [&self.x, &self.y], floored);
        for series in &self.series {
            draw(&mut svg, series, &frame);
        }
        for entry in &legend {
            let (x, y) = (entry.left, HEIGHT + 4.0 + LEGEND_ROW * entry.row as f64);
            let look = look(entry.series.colour);
            let line = if entry.series.joined {
                format!("<path d=\"M{:.1} {y:.1}h26\" fill=\"none\" {}/>", x, dashes(entry.series.colour))
            } else {
                String::new()
            };
            let _ = writeln!(
                svg,
                "<g {look}>{line}{}</g><text x=\"{:.1}\" y=\"{:.1}\">{}</text>",
                mark(entry.series.colour, x + 13.0, y, 4.0),
                x + 32.0,
                y + 4.0,
                escape(&entry.series.name)
            );
        }
        svg.push_str("</svg>\n");
        svg
    }

    /// The plot as a file: on its own ground, and light or dark as the reader's pages are.
    pub fn file(&self) -> String {
        let svg = self.svg().replacen(
            "fill=\"currentColor\">",
            &format!(
                "color=\"{INK}\" fill=\"currentColor\">\n\
            <rect width=\"100%\" height=\"100%\" fill=\"{GROUND}\"/>"
            ),
            1,
        );
        by_theme(&svg)
    }

    /// The names of the series in rows below the plot, where they cover nothing.
    fn legend(&self) -> Vec<Entry<'_>> {
        let (mut left, mut row) = (LEFT - 30.0, 0);
        self.series
            .iter()
            .map(|series| {
                let width = 32.0 + LETTER * series.name.chars().count() as f64 + 18.0;
                if left + width > WIDTH && left > LEFT {
                    (left, row) = (LEFT - 30.0, row + 1);
                }
                let entry = Entry { series, left, row };
                left += width;
                entry
            })
            .collect()
    }
}

/// A name in the legend.
struct Entry<'p> {
    series: &'p Series,
    left: f64,
    row: usize,
}

/// Where numbers lie on the picture.
struct Frame {
    x: Axis,
    y: Axis,
    floor: f64,
    /// How large the picture is without its legend.
    size: [f64; 2],
}

impl Frame {
    /// Grid, ticks and titles of both axes. The vertical one is titled above its end, where it can be read without
    /// turning.
    fn axes(&self, svg: &mut String, titles: [&str; 2], floored: bool) {
        let [right, bottom] = [self.size[0] - RIGHT, self.size[1] - BOTTOM];
        let ticks = self.x.ticks();
        let every = labelled(&ticks, (right - LEFT) / (ticks.len() - 1).max(1) as f64);
        for (i, (value, label)) in ticks.into_iter().enumerate() {
            let at = self.px(value);
            let label = if i % every == 0 { label } else { String::new() };
            let _ = writeln!(
                svg,
                "<path d=\"M{at:.1} {TOP}V{bottom}\" stroke=\"currentColor\" stroke-opacity=\".13\"/>\
                 <text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{label}</text>",
                bottom + 17.0
            );
        }
        // Values below the floor, zero above all, lie on the lowest line.
        for (i, (value, label)) in self.y.ticks().into_iter().enumerate() {
            let at = self.py(value);
            let label = if i == 0 && floored { "0".to_owned() } else { label };
            let _ = writeln!(
                svg,
                "<path d=\"M{LEFT} {at:.1}H{right}\" stroke=\"currentColor\" stroke-opacity=\".13\"/>\
                 <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>",
                LEFT - 7.0,
                at + 4.0
            );
        }
        let _ = writeln!(
            svg,
            "<path d=\"M{LEFT} {TOP}V{bottom}H{right}\" fill=\"none\" stroke=\"currentColor\" stroke-opacity=\".5\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>\
             <text transform=\"translate(15 {:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            f64::midpoint(LEFT, right),
            self.size[1] - 12.0,
            escape(titles[0]),
            f64::midpoint(TOP, bottom),
            escape(titles[1])
        );
    }

    fn px(&self, value: f64) -> f64 {
        LEFT + self.x.part(value) * (self.size[0] - LEFT - RIGHT)
    }

    fn py(&self, value: f64) -> f64 {
        self.size[1] - BOTTOM - self.y.part(value.max(self.floor)) * (self.size[1] - TOP - BOTTOM)
    }
}

/// Which of ticks at this distance are labelled, so that no label touches the next: all, every second, and so on.
fn labelled(ticks: &[(f64, String)], spacing: f64) -> usize {
    let longest = ticks.iter().map(|(_, label)| label.chars().count()).max().unwrap_or(0);
    ((LETTER * longest as f64 + 4.0) / spacing).ceil().max(1.0) as usize
}

fn draw(svg: &mut String, series: &Series, frame: &Frame) {
    let _ = writeln!(svg, "<g {}><title>{}</title>", look(series.colour), escape(&series.name));
    if series.joined && series.points.len() > 1 {
        let path: Vec<String> =
            series.points.iter().map(|p| format!("{:.1} {:.1}", frame.px(p[0]), frame.py(p[1]))).collect();
        let _ = writeln!(svg, "<path fill=\"none\" {} d=\"M{}\"/>", dashes(series.colour), path.join("L"));
    }
    let (radius, opacity) = if series.points.len() > 60 { (2.4, ".6") } else { (4.0, "1") };
    let _ = write!(svg, "<g fill-opacity=\"{opacity}\">");
    for p in &series.points {
        svg.push_str(&mark(series.colour, frame.px(p[0]), frame.py(p[1]), radius));
    }
    svg.push_str("</g></g>\n");
}

/// The colour of a series, as attributes.
fn look(colour: usize) -> String {
    let c = colour % COLOURS.len();
    format!("style=\"fill:var(--c{c},{0});stroke:var(--c{c},{0})\"", COLOURS[c])
}

/// The line of a series, as attributes.
fn dashes(colour: usize) -> &'static str {
    [
        "stroke-width=\"1.8\"",
        "stroke-width=\"1.8\" stroke-dasharray=\"7 3\"",
        "stroke-width=\"1.8\" stroke-dasharray=\"2 3\"",
        "stroke-width=\"1.8\" stroke-dasharray=\"9 3 2 3\"",
    ][colour % 4]
}

/// The mark of a series: disc, square, triangle, diamond; hollow beyond four.
fn mark(colour: usize, x: f64, y: f64, r: f64) -> String {
    // Where the colours begin again, the marks are one further.
    let kind = colour + colour / COLOURS.len();
    shape(kind % 4, kind % 8 >= 4, [x, y], r)
}

/// How many shapes there are.
const SHAPES: usize = 6;

/// A disc, square, triangle, diamond, triangle on its tip, or bar across.
fn shape(kind: usize, is_hollow: bool, [x, y]: [f64; 2], r: f64) -> String {
    let fill = if is_hollow { " style=\"fill:var(--ground,none)\" stroke-width=\"1.6\"" } else { " stroke=\"none\"" };
    match kind % SHAPES {
        0 => format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{r}\"{fill}/>"),
        1 => {
            let (x, y, side) = (x - 0.9 * r, y - 0.9 * r, 1.8 * r);
            format!("<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{side:.1}\" height=\"{side:.1}\"{fill}/>")
        }
        2 => {
            let (top, half) = (y - 1.2 * r, 1.15 * r);
            format!("<path d=\"M{x:.1} {top:.1}l{half:.1} {:.1}h-{:.1}z\"{fill}/>", 2.0 * r, 2.0 * half)
        }
        3 => {
            let d = 1.25 * r;
            format!("<path d=\"M{x:.1} {:.1}l{d:.1} {d:.1}l-{d:.1} {d:.1}l-{d:.1} -{d:.1}z\"{fill}/>", y - d)
        }
        4 => {
            let (tip, half) = (y + 1.2 * r, 1.15 * r);
            format!("<path d=\"M{x:.1} {tip:.1}l{half:.1} -{:.1}h-{:.1}z\"{fill}/>", 2.0 * r, 2.0 * half)
        }
        _ => {
            let (left, top, width) = (x - 1.3 * r, y - 0.55 * r, 2.6 * r);
            format!("<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{width:.1}\" height=\"{:.1}\"{fill}/>", 1.1 * r)
        }
    }
}

/// The range of an axis.
#[derive(Clone, Copy, Debug)]
struct Axis {
    scale: Scale,
    /// The ends, as logarithms on a logarithmic axis.
    from: f64,
    to: f64,
    /// The distance of ticks; on a logarithmic axis in whole decades, or 0 where ticks are at 1, 2 and 5 of each.
    tick: f64,
}

impl Axis {
    fn around(scale: Scale, values: impl Iterator<Item = f64>) -> Self {
        let place = |v: f64| if scale == Scale::Linear { v } else { v.log10() };
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for v in values.map(place).filter(|v| v.is_finite()) {
            (low, high) = (low.min(v), high.max(v));
        }
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        if scale == Scale::Linear {
            // 1, 2 or 5 times a power of ten, five to ten of them.
            let span = if high > low { high - low } else { 1.0 };
            let ten = 10f64.powf((span / 5.0).log10().floor());
            let tick = [5.0, 2.0, 1.0].map(|m| m * ten).into_iter().find(|t| span / t >= 5.0).unwrap_or(ten);
            let from = (low / tick).floor() * tick;
            return Self { scale, from, to: ((high / tick).ceil() * tick).max(from + tick), tick };
        }
        let (floor, ceil) = (low.floor(), high.ceil().max(low.floor() + 1.0));
        if high - low < 1.7 {
            // Short: from one of 1, 2, 5 to another.
            let steps =
                || (0..=(ceil - floor) as usize).flat_map(|d| [1.0f64, 2.0, 5.0].map(|m| floor + d as f64 + m.log10()));
            let from = steps().filter(|s| *s <= low + 1e-9).fold(floor, f64::max);
            let to = steps().filter(|s| *s >= high - 1e-9 && *s > from + 0.5).fold(ceil.max(from + 1.0), f64::min);
            return Self { scale, from, to, tick: 0.0 };
        }
        // At most ten ticks.
        let tick = ((ceil - floor) / 10.0).ceil().max(1.0);
        let to = floor + ((ceil - floor) / tick).ceil() * tick;
        Self { scale, from: floor, to, tick }
    }

    /// Where between its ends a value lies, from 0 to 1.
    fn part(self, value: f64) -> f64 {
        let place = match self.scale {
            Scale::Linear => value,
            _ if value > 0.0 => value.log10(),
            _ => return 0.0,
        };
        ((place - self.from) / (self.to - self.from)).clamp(0.0, 1.0)
    }

    /// The values with a tick, and what is written at it.
    fn ticks(self) -> Vec<(f64, String)> {
        let written = |value: f64| match self.scale {
            Scale::Time => duration(value),
            _ => power(value),
        };
        if self.scale != Scale::Linear && self.tick == 0.0 {
            let decades = self.from.floor() as i32..=self.to.ceil() as i32;
            let all = decades.flat_map(|d| [1.0, 2.0, 5.0].map(|m| m * 10f64.powi(d)));
            let inside = all.filter(|v| (self.from - 1e-9..=self.to + 1e-9).contains(&v.log10()));
            return inside.map(|v| (v, written(v))).collect();
        }
        let count = ((self.to - self.from) / self.tick).round() as usize;
        let at = |i: usize| {
            let place = self.from + i as f64 * self.tick;
            if self.scale == Scale::Linear {
                let decimals = (-self.tick.log10().floor()).max(0.0) as usize;
                (place, format!("{place:.decimals$}"))
            } else {
                let value = 10f64.powi(place.round() as i32);
                (value, written(value))
            }
        };
        (0..=count).map(at).collect()
    }
}

/// A number of nanoseconds as people write it.
pub fn duration(ns: f64) -> String {
    let (scale, unit) = match ns {
        _ if ns.is_nan() => return "–".to_owned(),
        _ if ns < 999.5 => (1.0, "ns"),
        _ if ns < 999.5e3 => (1e3, "µs"),
        _ if ns < 999.5e6 => (1e6, "ms"),
        _ => (1e9, "s"),
    };
    let value = ns / scale;
    let decimals = if value >= 99.5 || value.fract() == 0.0 {
        0
    } else if value >= 9.95 {
        1
    } else {
        2
    };
    format!("{value:.decimals$} {unit}")
}

/// 10⁻⁷, 2·10⁵, or 20: small whole numbers as they are.
fn power(value: f64) -> String {
    if (1.0..10_000.0).contains(&(value * (1.0 + 1e-9))) {
        return format!("{}", value.round());
    }
    let exponent = (value.log10() + 1e-9).floor() as i32;
    let leading = (value / 10f64.powi(exponent)).round();
    let digits = raised(exponent);
    if leading == 1.0 { format!("10{digits}") } else { format!("{leading}·10{digits}") }
}

/// A whole number as an exponent.
pub fn raised(exponent: i32) -> String {
    let digit = |c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32(digit as u32 - '0' as u32 + '⁰' as u32).unwrap_or(digit),
    };
    exponent.to_string().chars().map(digit).collect()
}

/// Text for HTML and SVG.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithmic_axes_go_by_whole_decades() {
        let axis = Axis::around(Scale::Log, [3e-9, 0.0, 2e4, f64::NAN].into_iter());
        assert_eq!((axis.from, axis.to), (-9.0, 5.0), "whole decades around the positive values");
        assert_eq!(axis.part(0.0), 0.0, "zero lies at the lower edge");
        assert_eq!(axis.part(1e5), 1.0, "the upper edge");
    }

    #[test]
    fn one_value_has_an_axis() {
        let axis = Axis::around(Scale::Log, [1.0].into_iter());
        assert_eq!((axis.from, axis.to), (0.0, 5f64.log10()), "from 1 to 5");
    }

    #[test]
    fn short_logarithmic_axes_go_by_ones_twos_and_fives() {
        let labels: Vec<String> =
            Axis::around(Scale::Time, [210.0, 2300.0].into_iter()).ticks().into_iter().map(|t| t.1).collect();
        assert_eq!(labels, ["200 ns", "500 ns", "1 µs", "2 µs", "5 µs"], "from 200 ns to 5 µs");
    }

    #[test]
    fn linear_axes_go_by_round_ticks() {
        let axis = Axis::around(Scale::Linear, [0.12, 4.9].into_iter());
        assert_eq!((axis.from, axis.to, axis.tick), (0.0, 5.0, 0.5), "whole ticks around the values");
        let labels: Vec<String> = axis.ticks().into_iter().map(|(_, label)| label).collect();
        assert_eq!((labels[0].as_str(), labels[10].as_str()), ("0.0", "5.0"), "{labels:?}");
    }

    #[test]
    fn labels_do_not_touch() {
        let ticks = Axis::around(Scale::Time, [50.0, 5e7].into_iter()).ticks();
        assert_eq!(ticks.len(), 8, "the decades from 10 ns to 100 ms: {ticks:?}");
        assert_eq!([100.0, 45.0, 20.0].map(|spacing| labelled(&ticks, spacing)), [1, 2, 3], "all, or some");
    }

    /// The contrast of text by the Web Content Accessibility Guidelines: (L + 0.05) / (l + 0.05), of relative
    /// luminances.
    #[test]
    fn names_in_colour_can_be_read_on_white() {
        let channel = |colour: &str, at: usize| {
            let part = f64::from(u8::from_str_radix(&colour[at..at + 2], 16).expect("a hexadecimal number")) / 255.0;
            if part <= 0.04045 { part / 12.92 } else { ((part + 0.055) / 1.055).powf(2.4) }
        };
        for colour in COLOURS {
            let [red, green, blue] = [1, 3, 5].map(|at| channel(colour, at));
            let luminance = 0.2126 * red + 0.7152 * green + 0.0722 * blue;
            assert!(1.05 / (luminance + 0.05) >= 4.5, "{colour}: {}", 1.05 / (luminance + 0.05));
        }
    }

    #[test]
    fn numbers_are_written_short() {
        assert_eq!([1e-7, 1.0, 2e5, 1000.0, 20.0].map(power), ["10⁻⁷", "1", "2·10⁵", "1000", "20"], "powers of ten");
        assert_eq!([3.0, 1234.0, 2.5e7].map(duration), ["3 ns", "1.23 µs", "25 ms"], "durations");
    }
}
