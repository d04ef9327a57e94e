//! The charts.

use arealight_benches::ladder::{
    BASELINE, CASES_PUBLISHED, CLIPLESS_PUBLISHED, DEFAULT, Growth, Ladder, Row, number, percent,
};
use arealight_benches::svg::{Axis, Drawing, Labels, grid, label, number_short};

/// The colours of what is ours, of others', and of Monte Carlo, in words.
const KEY: &str = "<div class=\"key\"><span><i style=\"background:var(--ours)\"></i>our quality levels</span>\
    <span><i style=\"background:var(--theirs)\"></i>yardsticks: what others ship</span>\
    <span><i style=\"background:var(--noise)\"></i>Monte Carlo, by samples a pixel</span></div>";

/// What has a name in the chart of everything: the others are too near to each other there.
const NAMED: [&str; 7] = [
    "clipless",
    "sphere horizon",
    "clip by cases",
    CLIPLESS_PUBLISHED,
    CASES_PUBLISHED,
    DEFAULT,
    "everything",
];

/// Error against time, both logarithmic: everything, and our quality levels from nearer.
pub fn pareto(found: &Ladder) -> String {
    let samples: Vec<(String, f64, f64)> = found
        .monte_carlo
        .iter()
        .map(|samples| (samples.count.to_string(), samples.milliseconds, samples.errors.rmse))
        .collect();
    let rows: Vec<&Row> = found.rows_of(found.first()).collect();
    let near: Vec<&Row> = rows.iter().copied().filter(|row| row.levels.is_some()).collect();
    error_against_time("Error against time of every method", &rows, &samples, &NAMED)
        + KEY
        + "<p>Our quality levels from nearer; dotted: the Pareto front.</p>"
        + &error_against_time("Error against time of our quality levels", &near, &[], &[])
}

/// A chart of rows, and of Monte Carlo's samples. Rows of some names have labels; with none given, all.
fn error_against_time(title: &str, rows: &[&Row], samples: &[(String, f64, f64)], named: &[&str]) -> String {
    let (width, height) = (860.0, 480.0);
    let bounds = [72.0, 12.0, width - 8.0, height - 46.0];
    let place = |row: &Row| (row.time.milliseconds.median, row.errors.all.rmse);
    let noise = samples.iter().map(|(_, time, error)| (*time, *error));
    let all: Vec<(f64, f64)> = rows.iter().map(|row| place(row)).chain(noise.clone()).collect();
    let x = Axis::over(all.iter().map(|(time, _)| *time), bounds[0], bounds[2]);
    let y = Axis::over(all.iter().map(|(_, error)| *error), bounds[3], bounds[1]);

    let mut drawing = Drawing::new(width, height, title);
    grid(&mut drawing, &x, &y, bounds, &|value| percent(value));
    let middle = [0.5 * (bounds[0] + bounds[2]), 0.5 * (bounds[1] + bounds[3])];
    drawing.text("axis", "middle", [middle[0], height - 6.0], "ms per light per megapixel");
    drawing.upwards([10.0, middle[1]], "error: RMSE over mean");

    // Dots first, that no label covers one
    let mut labels = Labels::default();
    let line: Vec<[f64; 2]> = noise.map(|(time, error)| [x.at(time), y.at(error)]).collect();
    let dots: Vec<[f64; 2]> =
        rows.iter().map(|row| place(row)).map(|(time, error)| [x.at(time), y.at(error)]).collect();
    for dot in dots.iter().chain(&line) {
        labels.keep_free(*dot);
    }
    drawing.path("line-noise", &line);
    drawing.path("front", &front(rows, &dots));
    for ((count, _, error), dot) in samples.iter().zip(&line) {
        drawing.dot("noise", *dot, &format!("{count} samples: error {}", percent(*error)));
        label(&mut drawing, &mut labels, *dot, count, bounds);
    }
    for (row, dot) in rows.iter().zip(&dots) {
        let class = if row.levels.is_some() { "ours" } else { "theirs" };
        let [low, high] = row.time.ratio.quartiles.map(number);
        let title = format!(
            "{} ({}): error {}, time {} ({low} to {high}) of {}'s",
            row.name,
            row.description,
            percent(row.errors.all.rmse),
            number(row.time.ratio.median),
            BASELINE.name()
        );
        drawing.dot(class, *dot, &title);
        if named.is_empty() || named.contains(&row.name.as_str()) {
            label(&mut drawing, &mut labels, *dot, &row.name, bounds);
        }
    }
    drawing.into_html()
}

/// Our levels that none is better than in both, from the fastest on.
fn front(rows: &[&Row], dots: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut ours: Vec<(&Row, [f64; 2])> = rows.iter().copied().zip(dots.iter().copied()).collect();
    ours.retain(|(row, _)| row.levels.is_some());
    ours.sort_by(|a, b| a.0.time.milliseconds.median.total_cmp(&b.0.time.milliseconds.median));
    let mut best = f64::INFINITY;
    // Differences below a hundredth are none
    ours.retain(|(row, _)| {
        let error = row.errors.all.rmse;
        let better = error < 0.99 * best;
        best = best.min(error);
        better
    });
    ours.into_iter().map(|(_, dot)| dot).collect()
}

/// The parts of each method's error: a line a method, a dot a part.
pub fn parts(found: &Ladder) -> String {
    let rows: Vec<&Row> = found.rows_of(found.first()).collect();
    let (width, line, top, left) = (860.0, 26.0, 8.0, 230.0);
    let height = top + line * rows.len() as f64 + 40.0;
    let parts = |row: &Row| {
        let classes = ["fit", "table-part", "integral"].into_iter();
        let values = [Some(row.errors.fit), row.errors.table, Some(row.errors.integral)];
        classes.zip(values).filter_map(|(class, value)| Some((class, value?)))
    };
    // What is below a ten-millionth is drawn as that
    let drawn = |value: f64| value.max(1e-7);
    let values = rows.iter().flat_map(|row| parts(row)).map(|(_, value)| drawn(value));
    let x = Axis::over(values, left, width - 16.0);
    let mut drawing =
        Drawing::new(width, height, "Fit, table and integral error of every method, logarithmic");
    for tick in x.ticks() {
        let at = x.at(tick);
        drawing.line("grid", [at, top], [at, height - 36.0]);
        drawing.text("axis", "middle", [at, height - 20.0], &percent(tick));
    }
    for (index, row) in rows.iter().enumerate() {
        let y = top + line * (index as f64 + 0.5);
        drawing.text("", "end", [left - 10.0, y + 4.0], &row.name);
        drawing.line("grid", [left, y], [width - 16.0, y]);
        for (class, value) in parts(row) {
            let name = class.trim_end_matches("-part");
            drawing.dot(class, [x.at(drawn(value)), y], &format!("{}: {name} {}", row.name, percent(value)));
        }
    }
    let key = "<div class=\"key\"><span><i style=\"background:var(--ours)\"></i>fit</span>\
        <span><i style=\"background:var(--good)\"></i>table</span>\
        <span><i style=\"background:var(--theirs)\"></i>integral</span></div>";
    drawing.into_html() + key
}

/// A bar for each effect.
pub fn effects(found: &Ladder) -> String {
    let (width, line, top) = (860.0, 44.0, 8.0);
    let height = top + line * found.effects.len() as f64 + 34.0;
    let used = found.effects.iter().filter_map(|effect| effect.used.as_ref());
    let spreads = found.effects.iter().map(|effect| &effect.on).chain(used);
    let most = spreads.map(|spread| spread.quartiles[1]).fold(1.5, f64::max) - 1.0;
    // Names to the left, and what is said of the longest bar to its right
    let scale = (width - 130.0 - 200.0) / most;
    let at = |ratio: f64| 130.0 + (ratio - 1.0).max(0.0) * scale;
    let mut drawing = Drawing::new(width, height, "What each effect adds to the time of the default level");
    let step = [0.1, 0.25, 0.5, 1.0, 2.0, 5.0].into_iter().find(|step| most / step <= 8.0).unwrap_or(10.0);
    for tick in 0..=(most / step) as usize {
        let value = tick as f64 * step;
        drawing.line("grid", [at(1.0 + value), top], [at(1.0 + value), height - 30.0]);
        drawing.text("axis", "middle", [at(1.0 + value), height - 14.0], &format!("+{:.0} %", value * 100.0));
    }
    for (index, effect) in found.effects.iter().enumerate() {
        let y = top + line * index as f64;
        drawing.text("", "end", [122.0, y + 22.0], &effect.effect.replace('_', " "));
        let bars = [Some((&effect.on, "bar-on")), effect.used.as_ref().map(|used| (used, "bar-used"))];
        for (part, (spread, class)) in bars.into_iter().flatten().enumerate() {
            let y = y + 4.0 + 17.0 * part as f64;
            let end = at(spread.median);
            drawing.bar(class, [130.0, y], [end - 130.0, 14.0]);
            let [low, high] = spread.quartiles.map(at);
            drawing.line("spread", [low, y + 7.0], [high, y + 7.0]);
            let text = format!("{:+.0} %", (spread.median - 1.0) * 100.0);
            drawing.text("", "start", [end.max(high) + 6.0, y + 11.0], &text);
        }
    }
    let key = "<div class=\"key\"><span><i style=\"background:var(--ours)\"></i>in the set (of a lobe: what \
    it adds)</span>\
        <span><i style=\"background:var(--theirs)\"></i>lights that need it</span></div>";
    drawing.into_html() + key
}

/// A frame's time as something grows, both logarithmic.
pub fn growth(growths: &[Growth], of: &str) -> String {
    let (width, height) = (860.0, 340.0);
    let bounds = [64.0, 12.0, width - 150.0, height - 46.0];
    let steps = growths.iter().flat_map(|growth| &growth.steps);
    let x = Axis::over(steps.clone().map(|(count, _)| f64::from(*count)), bounds[0], bounds[2]);
    let y = Axis::over(steps.map(|(_, time)| time.median), bounds[3], bounds[1]);
    let mut drawing = Drawing::new(width, height, &format!("Time of a frame by its number of {of}"));
    grid(&mut drawing, &x, &y, bounds, &number_short);
    drawing.text("axis", "middle", [f64::midpoint(bounds[0], bounds[2]), height - 6.0], of);
    drawing.upwards([14.0, f64::midpoint(bounds[1], bounds[3])], "milliseconds a frame");
    let mut labels = Labels::default();
    let area = [0.0, 0.0, width, height];
    for (growth, class) in growths.iter().zip(["theirs", "ours", "noise"]) {
        let places: Vec<[f64; 2]> =
            growth.steps.iter().map(|(count, time)| [x.at(f64::from(*count)), y.at(time.median)]).collect();
        drawing.path(&format!("line-{class}"), &places);
        for (place, (count, time)) in places.iter().zip(&growth.steps) {
            let title = format!("{}, {count} {of}: {} ms", growth.method, number(time.median));
            drawing.dot(class, *place, &title);
        }
        if let Some(last) = places.last() {
            labels.keep_free(*last);
            label(&mut drawing, &mut labels, *last, &growth.method, area);
        }
    }
    drawing.into_html()
}
