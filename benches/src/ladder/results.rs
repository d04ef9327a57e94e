//! The page of what was measured on devices, made of files that `arealight bench --save` wrote.

use super::{BASELINE, DEFAULT, Ladder, Row, number};
use crate::table::Table;
use std::fmt::Write as _;

/// Megapixels of 1920 x 1080.
const FRAME: f64 = 2.0736;

/// What the page begins with.
const HEAD: &str = "# Error and time on devices

Milliseconds of a frame of 1920 x 1080 by the default level: every pixel has a diffuse and a glossy lobe,
lights are quads, nothing is shadowed.
";

/// What follows the first table.
const LEGEND: &str = "
**Send yours**: `arealight bench --save docs/results/my-gpu.json` takes some minutes. The file has the
names of the device and its driver, and what was measured. `arealight bench results` makes this page.

In the tables below errors are split into what the lobe cannot follow (fit: lobes fitted to just that
roughness and view, against the truth), what the table's nodes lose between them, and what float32 and the
level's form factor lose (integral). The last columns are the samples of Monte Carlo with multiple importance
sampling that have the same error, and that take as long: 0 where even one takes longer.
";

/// The page of such runs, by the names of their files.
pub fn results(runs: &[(String, Ladder)]) -> String {
    let summary = |(file, run): &(String, Ladder)| {
        let find = |name: &str| run.rows_of(run.first()).find(|row| row.name == name);
        let frame = |row: &Row, lights: f64| number(FRAME * (row.time.fixed + lights * row.time.per_light));
        let mut cells = vec![format!("[{}]({file})", run.device), run.driver.clone()];
        if let (Some(ours), Some(clipless)) = (find(DEFAULT), find(BASELINE.name())) {
            cells.extend([1.0, 4.0, 16.0].map(|lights| frame(ours, lights)));
            let light = ours.time.per_light / clipless.time.per_light;
            cells.extend([number(ours.time.ratio.median), number(light)]);
        }
        cells
    };
    let heads = " | driver | 1 light | 4 lights | 16 | 4 lights, clipless = 1 | \
        a light more, clipless = 1";
    let summary = Table::new(heads, runs.iter().map(summary)).to_markdown();
    let mut text = format!("{HEAD}\n{summary}{LEGEND}");
    for (_, run) in runs {
        let _ = write!(text, "\n## {}\n\n{}", run.device, run.to_markdown());
    }
    text
}
