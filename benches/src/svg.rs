//! Drawing: logarithmic axes, and what stands on them.

use std::fmt::Write as _;

/// Text that stands in HTML or an attribute.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A logarithmic axis over some pixels.
#[derive(Debug, Clone, Copy)]
pub struct Axis {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Axis {
    /// Over all `values` above zero with a margin, from pixel `from` to pixel `to`.
    pub fn over(values: impl Iterator<Item = f64>, from: f64, to: f64) -> Self {
        let usable = values.filter(|value| value.is_finite() && *value > 0.0).map(f64::log10);
        let (low, high) = usable
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
        let margin = 0.06 * (high - low).max(0.5);
        Self { low: low - margin, high: high + margin, from, to }
    }

    /// The pixel of a value.
    pub fn at(&self, value: f64) -> f64 {
        let part = (value.max(f64::MIN_POSITIVE).log10() - self.low) / (self.high - self.low);
        self.from + part.clamp(-0.05, 1.05) * (self.to - self.from)
    }

    /// Values for ticks: powers of ten, and where these are few some multiples of them.
    pub fn ticks(&self) -> Vec<f64> {
        let steps: &[f64] = match self.high - self.low {
            less if less < 0.8 => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0],
            few if few < 2.5 => &[1.0, 2.0, 5.0],
            _ => &[1.0],
        };
        let powers = self.low.floor() as i32..=self.high.ceil() as i32;
        let values = powers.flat_map(|power| steps.iter().map(move |step| step * 10_f64.powi(power)));
        values.filter(|value| (self.low..=self.high).contains(&value.log10())).collect()
    }
}

/// The colours of a drawing that is a file of its own, for light and dark pages: ours blue, others' orange.
pub const FILE_STYLE: &str = "\
text { font: 12px system-ui, sans-serif; fill: #1c2430; } .axis { fill: #5b6675; } .title { font-weight: \
600; font-size: 14px; }
line, polyline { fill: none; } .grid { stroke: #d8dde4; } .leader { stroke: #5b6675; } .paper { fill: #fff; }
.ours { fill: #0b6bcb; } .theirs { fill: #c2410c; } .noise { fill: #6b7280; } .bad { fill: #b91c1c; }
.line-ours { stroke: #0b6bcb; stroke-width: 2; } .line-theirs { stroke: #c2410c; stroke-width: 2; \
stroke-dasharray: 6 4; }
.line-noise, .front { stroke: #6b7280; stroke-dasharray: 2 4; } .ink { stroke: #1c2430; stroke-width: 1.5; } \
.ink-head { fill: #1c2430; }
.faint { stroke: #9aa5b4; } .hidden { stroke: #9aa5b4; stroke-dasharray: 3 4; } .area-ours { fill: #0b6bcb; \
fill-opacity: .22; }
.area-theirs { fill: #c2410c; fill-opacity: .16; } .area-ball { fill: #9aa5b4; fill-opacity: .12; }
@media (prefers-color-scheme: dark) { text { fill: #e6e9ee; } .axis { fill: #9aa5b4; } .grid { stroke: \
#333c48; } .leader { stroke: #9aa5b4; }
.paper { fill: #14181e; } .ours { fill: #5aa9f5; } .theirs { fill: #fb923c; } .noise { fill: #9aa5b4; } .bad \
{ fill: #f87171; }
.line-ours { stroke: #5aa9f5; } .line-theirs { stroke: #fb923c; } .ink { stroke: #e6e9ee; } .ink-head { \
fill: #e6e9ee; } .faint { stroke: #5b6675; }
.area-ours { fill: #5aa9f5; } .area-theirs { fill: #fb923c; } }
";

/// A drawing of a size in its own units, which fills the page's width.
pub struct Drawing {
    body: String,
    width: f64,
    height: f64,
    label: String,
}

impl Drawing {
    /// Empty; `label` is for those who do not see it.
    pub fn new(width: f64, height: f64, label: &str) -> Self {
        Self { body: String::new(), width, height, label: escape(label) }
    }

    /// A straight line of a class.
    pub fn line(&mut self, class: &str, [x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) {
        let _ = write!(
            self.body,
            r#"<line class="{class}" x1="{x0:.1}" y1="{y0:.1}" x2="{x1:.1}" y2="{y1:.1}"/>"#
        );
    }

    /// A line through points.
    pub fn path(&mut self, class: &str, points: &[[f64; 2]]) {
        let points: Vec<String> = points.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        let _ = write!(self.body, r#"<polyline class="{class}" points="{}"/>"#, points.join(" "));
    }

    /// An area within points.
    pub fn area(&mut self, class: &str, points: &[[f64; 2]]) {
        let points: Vec<String> = points.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        let _ = write!(self.body, r#"<polygon class="{class}" points="{}"/>"#, points.join(" "));
    }

    /// A straight line with a head at its end.
    pub fn arrow(&mut self, class: &str, from: [f64; 2], to: [f64; 2]) {
        self.line(class, from, to);
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let length = dx.hypot(dy).max(f64::MIN_POSITIVE);
        let (dx, dy) = (dx / length, dy / length);
        let side = |turn: f64| [to[0] - 8.0 * dx + turn * 3.5 * dy, to[1] - 8.0 * dy - turn * 3.5 * dx];
        self.area(&format!("{class}-head"), &[to, side(1.0), side(-1.0)]);
    }

    /// A dot, with a title that is shown when pointed at.
    pub fn dot(&mut self, class: &str, [x, y]: [f64; 2], title: &str) {
        let title = escape(title);
        let _ = write!(
            self.body,
            r#"<circle class="{class}" cx="{x:.1}" cy="{y:.1}" r="5"><title>{title}</title></circle>"#
        );
    }

    /// A bar.
    pub fn bar(&mut self, class: &str, [x, y]: [f64; 2], [width, height]: [f64; 2]) {
        let (width, height) = (width.max(0.0), height.max(0.0));
        let _ = write!(
            self.body,
            r#"<rect class="{class}" x="{x:.1}" y="{y:.1}" width="{width:.1}" height="{height:.1}" rx="2"/>"#
        );
    }

    /// Text; `anchor` is start, middle or end.
    pub fn text(&mut self, class: &str, anchor: &str, [x, y]: [f64; 2], text: &str) {
        let text = escape(text);
        let _ = write!(
            self.body,
            r#"<text class="{class}" text-anchor="{anchor}" x="{x:.1}" y="{y:.1}">{text}</text>"#
        );
    }

    /// Text that runs upwards.
    pub fn upwards(&mut self, [x, y]: [f64; 2], text: &str) {
        let text = escape(text);
        let _ = write!(
            self.body,
            r#"<text class="axis" text-anchor="middle" transform="translate({x:.1} {y:.1}) rotate(-90)">{text}</text>"#
        );
    }

    /// As a file of its own, for light and dark pages.
    pub fn into_file(self, style: &str) -> String {
        let Self { body, width, height, label } = self;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
            height=\"{height}\" role=\"img\" \
             aria-label=\"{label}\">\n<style>\n{style}</style>\n{body}\n</svg>\n"
        )
    }

    /// As an element of a page.
    pub fn into_html(self) -> String {
        let Self { body, width, height, label } = self;
        // Wide drawings scroll on narrow screens: their text would be too small to read
        format!(
            r#"<div class="drawing"><svg viewBox="0 0 {width} {height}" style="min-width:{}px" role="img" aria-label="{label}">{body}</svg></div>"#,
            (width * 0.8).round()
        )
    }
}

/// The boxes that are taken, so that labels do not cover each other.
#[derive(Default)]
pub struct Labels {
    taken: Vec<[f64; 4]>,
}

/// Units that a character is wide and a line high.
const CHARACTER: f64 = 6.6;
const LINE: f64 = 13.0;

impl Labels {
    /// Keeps free what is about a dot.
    pub fn keep_free(&mut self, [x, y]: [f64; 2]) {
        self.taken.push([x - 6.0, y - 6.0, x + 6.0, y + 6.0]);
    }

    /// The nearest free place for a label of a dot, and its anchor: beside it, else along ever wider rings,
    /// within the width.
    pub fn place(&mut self, [x, y]: [f64; 2], text: &str, bounds: [f64; 4]) -> ([f64; 2], &'static str) {
        let width = text.chars().count() as f64 * CHARACTER;
        let candidates = (0..14).flat_map(|ring| {
            let reach = 9.0 + f64::from(ring) * 7.0;
            (0..16).map(move |step| {
                // To the right first, then alternating up and down
                let turn = f64::from((step + 1) / 2) * if step % 2 == 0 { 1.0 } else { -1.0 };
                let (sin, cos) = (turn * std::f64::consts::PI / 8.0).sin_cos();
                [x + reach * cos, y + reach * sin]
            })
        });
        for [left, middle] in candidates {
            let anchor = if left >= x { "start" } else { "end" };
            let start = if anchor == "start" { left } else { left - width };
            let area = [start, middle - LINE / 2.0, start + width, middle + LINE / 2.0];
            let inside =
                area[0] >= bounds[0] && area[1] >= bounds[1] && area[2] <= bounds[2] && area[3] <= bounds[3];
            let free = self.taken.iter().all(|other| {
                area[2] < other[0] || area[0] > other[2] || area[3] < other[1] || area[1] > other[3]
            });
            if inside && free {
                self.taken.push(area);
                return ([left, middle + 4.0], anchor);
            }
        }
        ([x + 9.0, y + 4.0], "start")
    }
}

/// A label of a dot, where there is room for it.
pub fn label(drawing: &mut Drawing, labels: &mut Labels, dot: [f64; 2], text: &str, bounds: [f64; 4]) {
    let (at, anchor) = labels.place(dot, text, bounds);
    // A label that had to move away is tied to its dot
    let away = (at[0] - dot[0]).hypot(at[1] - 4.0 - dot[1]);
    if away > 12.0 {
        let (dx, dy) = ((at[0] - dot[0]) / away, (at[1] - 4.0 - dot[1]) / away);
        drawing.line(
            "leader",
            [dot[0] + 5.0 * dx, dot[1] + 5.0 * dy],
            [at[0] - 2.0 * dx, at[1] - 4.0 - 2.0 * dy],
        );
    }
    drawing.text("", anchor, at, text);
}

/// The grid of two axes within bounds, its lines named: across by their numbers, up by `name`.
pub fn grid(drawing: &mut Drawing, x: &Axis, y: &Axis, bounds: [f64; 4], name: &dyn Fn(f64) -> String) {
    for tick in x.ticks() {
        let at = x.at(tick);
        drawing.line("grid", [at, bounds[1]], [at, bounds[3]]);
        drawing.text("axis", "middle", [at, bounds[3] + 16.0], &number_short(tick));
    }
    for tick in y.ticks() {
        let at = y.at(tick);
        drawing.line("grid", [bounds[0], at], [bounds[2], at]);
        drawing.text("axis", "end", [bounds[0] - 6.0, at + 4.0], &name(tick));
    }
}

/// A tick: no digits that say nothing.
pub fn number_short(value: f64) -> String {
    match value {
        large if large >= 1e6 => format!("{} M", large / 1e6),
        large if large >= 1e4 => format!("{} k", large / 1e3),
        _ => format!("{value}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_is_logarithmic_and_its_ticks_are_on_it() {
        let axis = Axis::over([1.0, 100.0, f64::NAN, 0.0].into_iter(), 0.0, 100.0);
        assert!((axis.at(10.0) - 50.0).abs() < 1e-9);
        assert_eq!(axis.ticks(), [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]);
        assert_eq!(Axis::over([1.0, 4.0].into_iter(), 0.0, 1.0).ticks(), [1.0, 1.5, 2.0, 3.0, 4.0]);
        assert!(Axis::over([0.0].into_iter(), 0.0, 1.0).at(5.0).is_finite());
    }

    #[test]
    fn labels_of_one_place_do_not_cover_each_other() {
        let mut labels = Labels::default();
        let bounds = [0.0, 0.0, 800.0, 400.0];
        labels.keep_free([400.0, 200.0]);
        let places: Vec<_> = (0..12).map(|_| labels.place([400.0, 200.0], "both horizons", bounds)).collect();
        for (i, a) in places.iter().enumerate() {
            for b in &places[..i] {
                assert!(a != b);
            }
        }
        // The boxes are all apart, but for the dot's own
        assert_eq!(labels.taken.len(), 13);
    }

    #[test]
    fn what_is_markup_is_escaped() {
        assert_eq!(escape("a < b & \"c\""), "a &lt; b &amp; &quot;c&quot;");
    }
}
