//! Error against cost of every method, from what is stored: errors and times of `arealight bench`, and what a
//! GPU's compiler counts.

use crate::compiled::{Compiled, Family};
use crate::ladder::{CASES_PUBLISHED, CLIPLESS_PUBLISHED, Ladder, Row, percent};
use crate::svg::{Axis, Drawing, FILE_STYLE, Labels, grid, label};

/// Rows of the bench, and where `arealight bench compiled` has the same: kernel and level.
const COMPILED: [(&str, &str, &str); 9] = [
    ("clipless", "shade_yardstick", "clipless"),
    ("sphere horizon", "shade_yardstick", "sphere horizon"),
    ("clip by cases", "shade_yardstick", "clip by cases"),
    ("exact", "shade", "exact"),
    ("formula", "shade", "formula"),
    ("two lobes", "shade", "two specular lobes"),
    ("both horizons", "shade", "both horizons"),
    ("difference", "shade", "difference"),
    ("everything", "shade", "difference, both horizons, two specular lobes"),
];

/// The kernels of published quality have another table, read by the same code.
fn same_code(name: &str) -> &str {
    match name {
        CLIPLESS_PUBLISHED => "clipless",
        CASES_PUBLISHED => "clip by cases",
        other => other,
    }
}

/// What the chart lacks.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ErrorCostError {
    /// The statistics are of other families.
    #[error("the compile statistics have no family {0}")]
    Family(String),
    /// A file has no row that the chart has a dot for.
    #[error("nothing to draw: no row of the bench has compile statistics")]
    Nothing,
}

/// A dot: its name, cost and error, and whether it is ours.
struct Dot<'a> {
    name: &'a str,
    cost: f64,
    error: f64,
    is_ours: bool,
}

/// Error over compiled cost to the left, over time on the bench's device to the right; clipless costs 1 in
/// both.
///
/// # Errors
/// [`ErrorCostError`] where there is nothing to draw.
pub fn error_cost(bench: &Ladder, compiled: &Compiled, family: &str) -> Result<String, ErrorCostError> {
    let statistics = compiled.find(family).ok_or_else(|| ErrorCostError::Family(family.to_owned()))?;
    let rows: Vec<&Row> = bench.rows.iter().filter(|row| row.lights == bench.first()).collect();
    let dot = |row: &'_ Row, cost: f64| (row.errors.all.rmse, row.levels.is_some(), cost);
    let dots = |cost: &dyn Fn(&Row) -> Option<f64>| -> Vec<Dot<'_>> {
        let with_cost = rows.iter().filter_map(|row| Some((row, dot(row, cost(row)?))));
        with_cost.map(|(row, (error, is_ours, cost))| Dot { name: &row.name, cost, error, is_ours }).collect()
    };
    let by_compiler = dots(&|row| ratio(statistics, same_code(&row.name)));
    let by_clock = dots(&|row| Some(row.time.ratio.median));
    if by_compiler.is_empty() {
        return Err(ErrorCostError::Nothing);
    }

    let (width, height) = (960.0, 430.0);
    let mut drawing =
        Drawing::new(width, height, "Error against cost of our quality levels and of what engines ship");
    drawing.bar("paper", [0.0, 0.0], [width, height]);
    let left = format!("{family}: compiled cost, clipless = 1 (inverse throughput; no time)");
    panel(&mut drawing, [80.0, 40.0, 478.0, 362.0], &by_compiler, &left);
    let device = bench.device.split(" (").next().unwrap_or_default();
    let right = format!("{device}, on a CPU: time, clipless = 1");
    panel(&mut drawing, [560.0, 40.0, 950.0, 362.0], &by_clock, &right);
    drawing.upwards([14.0, 200.0], "error: RMSE over the mean of the truth");
    let key =
        [("ours", "Arealight's quality levels"), ("theirs", "what engines ship; ° with the published table")];
    for (index, (class, text)) in key.into_iter().enumerate() {
        let x = 86.0 + 220.0 * index as f64;
        drawing.dot(class, [x, 18.0], text);
        drawing.text("", "start", [x + 10.0, 22.0], text);
    }
    Ok(drawing.into_file(FILE_STYLE))
}

/// The compiled cost of a row of the bench, over that of clipless.
fn ratio(statistics: &Family, name: &str) -> Option<f64> {
    let (_, kernel, level) = COMPILED.into_iter().find(|(row, ..)| *row == name)?;
    statistics.find(&format!("{kernel}: quads, {level}"))?.ratio
}

/// A chart within bounds, both axes logarithmic.
fn panel(drawing: &mut Drawing, bounds: [f64; 4], dots: &[Dot<'_>], title: &str) {
    let x = Axis::over(dots.iter().map(|dot| dot.cost), bounds[0], bounds[2]);
    let y = Axis::over(dots.iter().map(|dot| dot.error), bounds[3], bounds[1]);
    grid(drawing, &x, &y, bounds, &percent);
    drawing.text("", "middle", [f64::midpoint(bounds[0], bounds[2]), bounds[3] + 40.0], title);
    let mut labels = Labels::default();
    let at = |dot: &Dot<'_>| [x.at(dot.cost), y.at(dot.error)];
    // Dots first, that no label covers one
    for dot in dots {
        labels.keep_free(at(dot));
        let class = if dot.is_ours { "ours" } else { "theirs" };
        let title = format!("{}: error {}, cost {:.2}", dot.name, percent(dot.error), dot.cost);
        drawing.dot(class, at(dot), &title);
    }
    for dot in dots {
        let is_published = same_code(dot.name) != dot.name;
        let name = format!("{}{}", same_code(dot.name), if is_published { "°" } else { "" });
        label(drawing, &mut labels, at(dot), &name, bounds);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn stored(path: &str) -> String {
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
    }

    #[test]
    fn the_chart_is_made_again_of_what_is_stored() {
        let bench: Ladder = serde_json::from_str(&stored("data/lavapipe.json")).unwrap();
        let compiled: Compiled = serde_json::from_str(&stored("data/compiled.json")).unwrap();
        let chart = error_cost(&bench, &compiled, "navi21").unwrap();
        assert!(
            chart == stored("../docs/images/error-cost.svg"),
            "cargo run -p arealight-benches --example figures -- docs/images"
        );
        for (name, kernel, level) in COMPILED {
            assert!(bench.rows.iter().any(|row| row.name == name), "{name}");
            assert!(compiled.families[0].find(&format!("{kernel}: quads, {level}")).is_some(), "{level}");
        }
        let error = error_cost(&bench, &compiled, "rv200").unwrap_err();
        assert_eq!(error.to_string(), "the compile statistics have no family rv200");
    }
}
