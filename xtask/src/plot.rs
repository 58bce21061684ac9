//! Log–log plots as SVG, by hand: points and lines in colours that read on light and dark pages.

use std::fmt::Write as _;

/// One set of points of a plot.
#[derive(Clone, Debug)]
pub(crate) struct Series {
    pub(crate) name: String,
    /// Pairs of positive numbers; a 0 is drawn at the lower edge.
    pub(crate) points: Vec<[f64; 2]>,
    /// Whether the points are joined, in the order given.
    pub(crate) joined: bool,
}

/// A plot with logarithmic axes.
#[derive(Clone, Debug)]
pub(crate) struct LogLog {
    pub(crate) title: String,
    pub(crate) x: String,
    pub(crate) y: String,
    /// What is below is drawn at the lower edge.
    pub(crate) y_floor: f64,
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

impl LogLog {
    /// The plot as an `<svg>` element.
    pub(crate) fn svg(&self) -> String {
        let xs = self.series.iter().flat_map(|s| s.points.iter().map(|p| p[0]));
        let ys = self.series.iter().flat_map(|s| s.points.iter().map(|p| p[1].max(self.y_floor)));
        let (x, y) = (Decades::around(xs), Decades::around(ys));
        let px = |v: f64| LEFT + x.part(v) * (WIDTH - LEFT - RIGHT);
        let py = |v: f64| HEIGHT - BOTTOM - y.part(v.max(self.y_floor)) * (HEIGHT - TOP - BOTTOM);
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
            let colour = COLOURS[i % COLOURS.len()];
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

/// A range of whole decades.
#[derive(Clone, Copy, Debug)]
struct Decades {
    from: i32,
    to: i32,
}

impl Decades {
    fn around(values: impl Iterator<Item = f64>) -> Self {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for v in values.filter(|v| *v > 0.0 && v.is_finite()) {
            (low, high) = (low.min(v), high.max(v));
        }
        if low > high {
            return Self { from: 0, to: 1 };
        }
        let (from, to) = (low.log10().floor() as i32, high.log10().ceil() as i32);
        Self { from, to: to.max(from + 1) }
    }

    /// Where between its ends a value lies, from 0 to 1.
    fn part(self, value: f64) -> f64 {
        if value > 0.0 {
            ((value.log10() - f64::from(self.from)) / f64::from(self.to - self.from)).clamp(0.0, 1.0)
        } else {
            0.0
        }
    }

    fn ticks(self) -> impl Iterator<Item = (f64, String)> {
        let step = (self.to - self.from).div_euclid(9).max(1);
        (self.from..=self.to).step_by(step as usize).map(|e| {
            let label = if (0..4).contains(&e) { format!("{}", 10i32.pow(e as u32)) } else { format!("1e{e}") };
            (10f64.powi(e), label)
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
    fn decades_hold_their_values() {
        let decades = Decades::around([3e-9, 0.0, 2e4, f64::NAN].into_iter());
        assert_eq!((decades.from, decades.to), (-9, 5), "whole decades around the positive values");
        assert_eq!(decades.part(0.0), 0.0, "zero lies at the lower edge");
        assert_eq!(decades.part(1e5), 1.0, "the upper edge");
        assert_eq!(Decades::around([1.0].into_iter()).part(1.0), 0.0, "one value still has a decade");
    }
}
