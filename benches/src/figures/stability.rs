//! Hard cases: the largest backward error of each family, ours and the yardsticks'.

use crate::report::OVERVIEW;
use crate::stability::{Row, Stability};
use crate::svg::{Axis, Drawing, FILE_STYLE, number_short};

/// The methods with a dot: as the battery names them, as readers do, and the class of their colour.
const METHODS: [(&str, &str, &str); 5] = [
    ("clip-and-acos", "clip and arc cosines", "acos"),
    ("clipless", "clipless", "noise"),
    ("sphere-horizon", "clipped sphere", "sphere"),
    ("clip-by-cases", "clip by cases", "theirs"),
    ("polygon-exact", "Arealight, exact", "ours"),
];

/// Colours of the methods that other charts have not.
const COLORS: &str = ".sphere { fill: #7c3aed; } .acos { fill: #15803d; } .promise { stroke: #0b6bcb; \
stroke-dasharray: 5 4; }\n";

/// Backward errors below are drawn as this one.
const LEAST: f64 = 1e-8;

/// What is promised: see the document.
const PROMISE: f64 = 6e-7;

/// A line for each family that is judged by its errors, a dot for each method; a column to the right for
/// results that are NaN or infinite.
pub fn stability(found: &Stability) -> String {
    debug_assert!(METHODS.iter().all(|(method, ..)| OVERVIEW.contains(method)));
    let mut families: Vec<&str> = found.rows.iter().map(|row| row.family).collect();
    families.dedup();
    let (width, line, top, left, right) = (900.0, 18.0, 44.0, 150.0, 700.0);
    let height = top + line * families.len() as f64 + 46.0;
    let bottom = height - 42.0;
    let mut drawing =
        Drawing::new(width, height, "The largest error of each family of hard cases, by method");
    drawing.bar("paper", [0.0, 0.0], [width, height]);
    let x = Axis::over([LEAST, 1.0].into_iter(), left, right);
    for tick in x.ticks() {
        drawing.line("grid", [x.at(tick), top], [x.at(tick), bottom]);
        let name = if tick < 1e-3 { format!("{tick:e}") } else { number_short(tick) };
        drawing.text("axis", "middle", [x.at(tick), bottom + 16.0], &name);
    }
    drawing.text("", "middle", [f64::midpoint(left, right), bottom + 34.0], "largest backward error");
    drawing.text("", "middle", [800.0, bottom + 16.0], "NaN or infinite");
    drawing.line("promise", [x.at(PROMISE), top], [x.at(PROMISE), bottom]);
    drawing.text("axis", "middle", [x.at(PROMISE), top - 4.0], "promised: 6e-7");
    for (index, (_, name, class)) in METHODS.iter().enumerate() {
        let at = 20.0 + 160.0 * index as f64;
        drawing.dot(class, [at, 16.0], name);
        drawing.text("", "start", [at + 10.0, 20.0], name);
    }
    for (index, family) in families.iter().enumerate() {
        let y = top + line * (index as f64 + 0.5);
        drawing.text("", "end", [left - 10.0, y + 4.0], family);
        drawing.line("grid", [left, y], [860.0, y]);
        for (column, (method, name, class)) in METHODS.into_iter().enumerate() {
            let row = found.rows.iter().find(|row| row.family == *family && row.method == method);
            if let Some((at, what)) = row.and_then(|row| dot(row, &x, column)) {
                drawing.dot(class, [at, y], &format!("{family}, {name}: {what}"));
            }
        }
    }
    drawing.into_file(&(FILE_STYLE.to_owned() + COLORS))
}

/// Where a method's dot is, and what it says; none where the method takes no case of the family, or has no
/// error there.
fn dot(row: &Row, x: &Axis, column: usize) -> Option<(f64, String)> {
    let tally = &row.tally;
    if tally.samples == 0 {
        return None;
    }
    if tally.not_finite > 0 {
        let at = 760.0 + 20.0 * column as f64;
        return Some((at, format!("{} of {} results NaN or infinite", tally.not_finite, tally.samples)));
    }
    let error = tally.largest_backward_error.filter(|error| error.is_finite())?;
    Some((x.at(error.max(LEAST)), format!("{error:.1e}")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight_cases::hard::family::Scope;
    use arealight_cases::hard::judge::Tally;

    #[test]
    fn what_is_not_finite_has_a_column_of_its_own() {
        let row = |method, not_finite| {
            let tally =
                Tally { samples: 10, largest_backward_error: Some(1e-7), not_finite, ..Tally::default() };
            Row { family: "crossing", scope: Scope::Accuracy, method, is_yardstick: false, tally }
        };
        let x = Axis::over([LEAST, 1.0].into_iter(), 0.0, 100.0);
        assert!(dot(&row("polygon-exact", 0), &x, 4).unwrap().0 < 100.0);
        let (at, what) = dot(&row("clip-and-acos", 3), &x, 0).unwrap();
        assert!(at > 700.0 && what == "3 of 10 results NaN or infinite");

        let rows = vec![row("polygon-exact", 0), row("clip-and-acos", 3)];
        let found = Stability { device: "a device".to_owned(), samples: 10, seed: 0, rows };
        // Five in the key, two in the chart
        assert_eq!(stability(&found).matches("<circle").count(), 7);
    }
}
