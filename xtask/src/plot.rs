//! Plots as SVG, by hand: points and lines in colours that read on light and dark pages.

use std::fmt::Write as _;

/// One set of points of a plot.
#[derive(Clone, Debug)]
pub(crate) struct Series {
    pub(crate) name: String,
    pub(crate) points: Vec<[f64; 2]>,
    /// Whether the points are joined, in the order given.
    pub(crate) joined: bool,
    /// Which of the colours; plots side by side give the same thing the same one.
    pub(crate) colour: usize,
}

/// How numbers are laid out along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scale {
    Linear,
    /// By whole decades. What is not positive is drawn at the lower edge.
    Log,
}

/// Numbers against numbers.
#[derive(Clone, Debug)]
pub(crate) struct Plot {
    pub(crate) title: String,
    pub(crate) x: String,
    pub(crate) y: String,
    pub(crate) scales: [Scale; 2],
    /// What is below is drawn there.
    pub(crate) floor: f64,
    pub(crate) series: Vec<Series>,
}

const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 420.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 170.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 46.0;

/// Colours that can be told apart, also by the colour-blind (Okabe and Ito).
const COLOURS: [&str; 8] = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#d55e00", "#56b4e9", "#b59f00", "#888888"];

impl Plot {
    /// The plot as an `<svg>` element.
    pub(crate) fn svg(&self) -> String {
        let xs = self.series.iter().flat_map(|s| s.points.iter().map(|p| p[0]));
        let ys = self.series.iter().flat_map(|s| s.points.iter().map(|p| p[1].max(self.floor)));
        let (x, y) = (Axis::around(self.scales[0], xs), Axis::around(self.scales[1], ys));
        let px = |v: f64| LEFT + x.part(v) * (WIDTH - LEFT - RIGHT);
        let py = |v: f64| HEIGHT - BOTTOM - y.part(v.max(self.floor)) * (HEIGHT - TOP - BOTTOM);
        let mut svg = format!(
            "<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" xmlns=\"http://www.w3.org/2000/svg\" \
             font-family=\"system-ui, sans-serif\" font-size=\"12\" fill=\"currentColor\">\n\
             <title>{0}</title>\n<text x=\"{LEFT}\" y=\"20\" font-size=\"14\" font-weight=\"600\">{0}</text>\n",
            escape(&self.title)
        );
        let (right, bottom) = (WIDTH - RIGHT, HEIGHT - BOTTOM);
        for (value, label) in x.ticks() {
            let at = px(value);
            let _ = writeln!(
                svg,
                "<path d=\"M{at:.1} {TOP}V{bottom}\" stroke=\"currentColor\" stroke-opacity=\".15\"/>\
                 <text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{label}</text>",
                bottom + 16.0
            );
        }
        for (value, label) in y.ticks() {
            let at = py(value);
            let _ = writeln!(
                svg,
                "<path d=\"M{LEFT} {at:.1}H{right}\" stroke=\"currentColor\" stroke-opacity=\".15\"/>\
                 <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>",
                LEFT - 6.0,
                at + 4.0
            );
        }
        let _ = writeln!(
            svg,
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>\
             <text transform=\"translate(14 {:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            (LEFT + right) / 2.0,
            HEIGHT - 10.0,
            escape(&self.x),
            (TOP + bottom) / 2.0,
            escape(&self.y)
        );
        for (i, series) in self.series.iter().enumerate() {
            let colour = COLOURS[series.colour % COLOURS.len()];
            let _ = writeln!(svg, "<g fill=\"{colour}\" stroke=\"{colour}\"><title>{}</title>", escape(&series.name));
            if series.joined && !series.points.is_empty() {
                let path: Vec<String> =
                    series.points.iter().map(|p| format!("{:.1} {:.1}", px(p[0]), py(p[1]))).collect();
                let _ = writeln!(svg, "<path fill=\"none\" stroke-width=\"1.5\" d=\"M{}\"/>", path.join("L"));
            }
            let (radius, opacity) = if series.joined { (3.0, 1.0) } else { (2.2, 0.55) };
            for p in &series.points {
                let _ = write!(
                    svg,
                    "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius}\" stroke=\"none\" fill-opacity=\"{opacity}\"/>",
                    px(p[0]),
                    py(p[1])
                );
            }
            let _ = writeln!(
                svg,
                "\n<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"4\" stroke=\"none\"/></g>\
                 <text x=\"{:.1}\" y=\"{:.1}\">{}</text>",
                right + 14.0,
                TOP + 8.0 + 18.0 * i as f64,
                right + 24.0,
                TOP + 12.0 + 18.0 * i as f64,
                escape(&series.name)
            );
        }
        svg.push_str("</svg>\n");
        svg
    }
}

/// The range of an axis, in whole ticks.
#[derive(Clone, Copy, Debug)]
struct Axis {
    scale: Scale,
    /// The ends and the tick, in decades on a logarithmic axis.
    from: f64,
    to: f64,
    tick: f64,
}

impl Axis {
    fn around(scale: Scale, values: impl Iterator<Item = f64>) -> Self {
        let place = |v: f64| if scale == Scale::Log { v.log10() } else { v };
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for v in values.map(place).filter(|v| v.is_finite()) {
            (low, high) = (low.min(v), high.max(v));
        }
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        let tick = match scale {
            Scale::Log => ((high - low) / 9.0).floor().max(1.0),
            // 1, 2 or 5 times a power of ten, five to ten of them.
            Scale::Linear => {
                let span = if high > low { high - low } else { 1.0 };
                let ten = 10f64.powf((span / 5.0).log10().floor());
                [5.0, 2.0, 1.0].map(|m| m * ten).into_iter().find(|t| span / t >= 5.0).unwrap_or(ten)
            }
        };
        let from = (low / tick).floor() * tick;
        Self { scale, from, to: ((high / tick).ceil() * tick).max(from + tick), tick }
    }

    /// Where between its ends a value lies, from 0 to 1.
    fn part(self, value: f64) -> f64 {
        let place = match self.scale {
            Scale::Linear => value,
            Scale::Log if value > 0.0 => value.log10(),
            Scale::Log => return 0.0,
        };
        ((place - self.from) / (self.to - self.from)).clamp(0.0, 1.0)
    }

    /// The values with a tick, and what is written at it.
    fn ticks(self) -> impl Iterator<Item = (f64, String)> {
        let count = ((self.to - self.from) / self.tick).round() as usize;
        (0..=count).map(move |i| {
            let place = self.from + i as f64 * self.tick;
            match self.scale {
                Scale::Log if (0.0..4.0).contains(&place) => {
                    (10f64.powf(place), format!("{}", 10f64.powf(place).round()))
                }
                Scale::Log => (10f64.powf(place), format!("1e{place}")),
                Scale::Linear => {
                    let decimals = (-self.tick.log10().floor()).max(0.0) as usize;
                    (place, format!("{place:.decimals$}"))
                }
            }
        })
    }
}

/// Text for HTML and SVG.
pub(crate) fn escape(text: &str) -> String {
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
        assert_eq!(Axis::around(Scale::Log, [1.0].into_iter()).part(1.0), 0.0, "one value still has a decade");
    }

    #[test]
    fn linear_axes_go_by_round_ticks() {
        let axis = Axis::around(Scale::Linear, [0.12, 4.9].into_iter());
        assert_eq!((axis.from, axis.to, axis.tick), (0.0, 5.0, 0.5), "whole ticks around the values");
        let labels: Vec<String> = axis.ticks().map(|(_, label)| label).collect();
        assert_eq!((labels[0].as_str(), labels[10].as_str()), ("0.0", "5.0"), "{labels:?}");
    }
}
