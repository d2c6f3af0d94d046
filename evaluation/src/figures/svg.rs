//! A chart as SVG text: axes with units, lines, discs, bars. For files in the repository, where a reader's
//! dark or light scheme applies to an image as well.

use std::fmt::Write as _;

/// Okabe and Ito's colours, which the colour-blind tell apart.
pub(crate) const COLOURS: [&str; 8] =
    ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#8c8c8c", "#b8a500"];
/// A run that failed.
pub(crate) const FAILED: &str = "#c1121f";
const STYLE: &str = "svg{background:#fff}text{font:12px sans-serif;fill:#16181d}.t{font-weight:600;font-size:13px}\
.g{stroke:#e3e6eb}.a{stroke:#8a909c}@media(prefers-color-scheme:dark){svg{background:#14161a}text{fill:#eceef2}.g{stroke:#2c3038}}";
const WIDTH: f64 = 640.0;
const LEFT: f64 = 62.0;
const RIGHT: f64 = 16.0;
const TOP: f64 = 30.0;
const BOTTOM: f64 = 46.0;

/// Title and axis labels, with units.
pub(crate) struct Labels<'a> {
    pub(crate) title: &'a str,
    pub(crate) x: &'a str,
    pub(crate) y: &'a str,
    /// The command that gives the same runs.
    pub(crate) command: &'a str,
}

/// A chart under construction.
pub(crate) struct Chart {
    body: String,
    x: [f64; 2],
    y: [f64; 2],
    height: f64,
}

impl Chart {
    /// Axes over `x` and `y`; `equal`: one metre is as long on both.
    pub(crate) fn new(labels: &Labels<'_>, x: [f64; 2], y: [f64; 2], equal: bool) -> Self {
        let marks = round_values(y).into_iter().map(|value| (value, value.to_string())).collect();
        Self::marked(labels, x, y, equal, marks)
    }

    /// Axes over decimal logarithms: `y` from 10^y[0] to 10^y[1].
    pub(crate) fn logarithmic(labels: &Labels<'_>, x: [f64; 2], y: [f64; 2]) -> Self {
        let powers = y[0].ceil() as i32..=y[1].floor() as i32;
        let marks = powers.map(|power| (f64::from(power), 10f64.powi(power).to_string())).collect();
        Self::marked(labels, x, y, false, marks)
    }

    fn marked(labels: &Labels<'_>, x: [f64; 2], y: [f64; 2], equal: bool, marks: Vec<(f64, String)>) -> Self {
        let across = WIDTH - LEFT - RIGHT;
        let inner = if equal { across * (y[1] - y[0]) / (x[1] - x[0]) } else { 260.0 };
        let mut chart = Self { body: String::new(), x, y, height: inner + TOP + BOTTOM };
        let (bottom, right) = (chart.height - BOTTOM, WIDTH - RIGHT);
        for (value, text) in marks {
            let at = chart.y(value);
            chart.add(format_args!("<path class=\"g\" d=\"M{LEFT} {at:.1}H{right}\"/>"));
            chart.text(LEFT - 6.0, at + 4.0, "end", &text);
        }
        chart.add(format_args!("<path class=\"a\" fill=\"none\" d=\"M{LEFT} {TOP}V{bottom}H{right}\"/>"));
        chart.add(format_args!("<text class=\"t\" x=\"{LEFT}\" y=\"18\">{}</text>", escaped(labels.title)));
        chart.text(LEFT + across / 2.0, chart.height - 8.0, "middle", labels.x);
        let middle = TOP + inner / 2.0;
        chart.add(format_args!(
            "<text transform=\"translate(14 {middle}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            escaped(labels.y)
        ));
        chart.add(format_args!("<desc>{}</desc>", escaped(labels.command)));
        chart
    }

    /// Numbers along the x axis.
    pub(crate) fn number_x(&mut self) {
        for value in round_values(self.x) {
            self.text(self.x(value), self.height - BOTTOM + 16.0, "middle", &value.to_string());
        }
    }

    /// These words along the x axis.
    pub(crate) fn mark_x(&mut self, marks: impl Iterator<Item = (f64, String)>) {
        for (value, text) in marks {
            let at = self.x(value);
            let anchor = if at > WIDTH - RIGHT - 1.0 { "end" } else { "middle" };
            self.text(at, self.height - BOTTOM + 16.0, anchor, &text);
        }
    }

    /// Colours and what they mean, one below the other: in the upper left corner, or the lower right one.
    pub(crate) fn keys<'a>(&mut self, entries: impl ExactSizeIterator<Item = (&'a str, String)>, lower_right: bool) {
        let height = 15.0 * entries.len() as f64;
        let (left, top) = match lower_right {
            true => (WIDTH - RIGHT - 240.0, self.height - BOTTOM - height),
            false => (LEFT + 8.0, TOP + 16.0),
        };
        for (index, (colour, text)) in entries.enumerate() {
            let at = top + 15.0 * index as f64;
            self.add(format_args!(
                "<rect x=\"{left:.1}\" y=\"{:.1}\" width=\"10\" height=\"10\" fill=\"{colour}\"/>",
                at - 9.0
            ));
            self.text(left + 16.0, at, "start", &text);
        }
    }

    fn add(&mut self, element: std::fmt::Arguments<'_>) {
        let _ = writeln!(self.body, "{element}"); // writing to a String cannot fail
    }

    fn x(&self, value: f64) -> f64 {
        LEFT + (value - self.x[0]) / (self.x[1] - self.x[0]) * (WIDTH - LEFT - RIGHT)
    }

    fn y(&self, value: f64) -> f64 {
        let inner = self.height - TOP - BOTTOM;
        TOP + (self.y[1] - value) / (self.y[1] - self.y[0]) * inner
    }

    fn text(&mut self, x: f64, y: f64, anchor: &str, text: &str) {
        self.add(format_args!("<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{}</text>", escaped(text)));
    }

    /// A polyline through `points`.
    pub(crate) fn line(&mut self, points: &[[f64; 2]], colour: &str, dash: &str) {
        let mut path = String::from("M");
        for &[x, y] in points {
            let _ = write!(path, "{:.1} {:.1} ", self.x(x), self.y(y));
        }
        self.add(format_args!(
            "<path fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.5\" stroke-dasharray=\"{dash}\" d=\"{}\"/>",
            path.trim_end()
        ));
    }

    /// A disc of `radius` on the x axis' scale; `filled` or a ring.
    pub(crate) fn disc(&mut self, [x, y]: [f64; 2], radius: f64, colour: &str, filled: bool) {
        let radius = (self.x(radius) - self.x(0.0)).max(1.0);
        let fill = if filled { colour } else { "none" };
        self.add(format_args!(
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius:.1}\" fill=\"{fill}\" stroke=\"{colour}\"/>",
            self.x(x),
            self.y(y)
        ));
    }

    /// Closed chains of points: filled by the even-odd rule, or, with a `radius` on the x axis' scale, drawn as wide.
    pub(crate) fn shape(&mut self, rings: &[Vec<[f64; 2]>], radius: f64, colour: &str) {
        let width = 2.0 * (self.x(radius) - self.x(0.0));
        let path = rings_path(rings, |[x, y]| [self.x(x), self.y(y)]);
        let fill = if radius > 0.0 { "none" } else { colour };
        self.add(format_args!(
            "<path fill=\"{fill}\" fill-rule=\"evenodd\" stroke=\"{colour}\" stroke-width=\"{width:.1}\" \
             stroke-linejoin=\"round\" d=\"{path}\"/>"
        ));
    }

    /// A word at a place of the plot.
    pub(crate) fn word(&mut self, [x, y]: [f64; 2], text: &str) {
        self.text(self.x(x), self.y(y) + 4.0, "middle", text);
    }

    /// Bar `index` of a chart whose x axis counts bars from 0, with its name below it.
    pub(crate) fn bar(&mut self, index: usize, value: f64, colour: &str, name: &str) {
        let (left, right) = (self.x(index as f64 - 0.36), self.x(index as f64 + 0.36));
        let (top, bottom) = (self.y(value), self.height - BOTTOM);
        let height = (bottom - top).max(0.0);
        self.add(format_args!(
            "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{height:.1}\" fill=\"{colour}\"/>",
            right - left
        ));
        let middle = (left + right) / 2.0;
        self.text(middle, bottom + 16.0, "middle", name);
        let digits = if value < 10.0 { 1 } else { 0 };
        self.text(middle, top - 4.0, "middle", &format!("{value:.digits$}"));
    }

    /// Colours and what they mean, in the top right corner.
    pub(crate) fn legend(&mut self, entries: &[(&str, String)]) {
        let mut right = WIDTH - RIGHT;
        for (colour, text) in entries.iter().rev() {
            let width = 7.0 * text.chars().count() as f64;
            self.text(right, 18.0, "end", text);
            self.add(format_args!(
                "<rect x=\"{:.1}\" y=\"9\" width=\"10\" height=\"10\" fill=\"{colour}\"/>",
                right - width - 14.0
            ));
            right -= width + 28.0;
        }
    }

    /// The whole file.
    pub(crate) fn finish(self) -> String {
        let height = self.height;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height:.0}\" role=\"img\">\n\
             <style>{STYLE}</style>\n{}</svg>\n",
            self.body
        )
    }
}

/// Text as it may stand between tags.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

/// About six round numbers in a range.
fn round_values([from, to]: [f64; 2]) -> Vec<f64> {
    let rough = ((to - from) / 6.0).max(f64::MIN_POSITIVE);
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * power).find(|&step| step >= rough);
    let step = step.unwrap_or(rough);
    let first = (from / step).ceil() as i64;
    let last = (to / step).floor() as i64;
    (first..=last).map(|n| (n as f64 * step * 1e6).round() / 1e6).collect()
}

/// The path of closed chains of points, each put where `at` says.
pub(super) fn rings_path(rings: &[Vec<[f64; 2]>], at: impl Fn([f64; 2]) -> [f64; 2]) -> String {
    let mut path = String::new();
    for ring in rings {
        for (index, point) in ring.iter().enumerate() {
            let [x, y] = at(*point);
            let _ = write!(path, "{}{x:.1} {y:.1}", if index == 0 { "M" } else { "L" });
        }
        path.push('Z');
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_carry_round_numbers() {
        assert_eq!(round_values([0.0, 49.0]), [0.0, 10.0, 20.0, 30.0, 40.0]);
        assert_eq!(round_values([-1.5, 1.5]), [-1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5]);
    }

    #[test]
    fn a_bar_stands_on_the_axis_and_text_is_escaped() {
        let labels = Labels { title: "a<b", x: "x", y: "y (m)", command: "run" };
        let mut chart = Chart::new(&labels, [-0.5, 1.5], [0.0, 10.0], false);
        chart.bar(0, 5.0, FAILED, "FH5");
        let text = chart.finish();
        assert!(text.contains("a&lt;b") && text.contains("height=\"130.0\" fill=\"#c1121f\""), "{text}");
    }
}
