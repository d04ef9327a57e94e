//! What a run found, as text and as Markdown.

use super::{LevelResult, SceneResult, ShadowLevels};
use crate::ladder::Spread;
use crate::table::Table;
use std::fmt::Write as _;

/// What the tables' columns are.
const MEASURES: &str = "*S* is the part of a pixel's unshadowed light that arrives, in luminance; its errors \
are those of lit pixels times 100, the root of their mean square over all of them and over those in a \
penumbra, and their mean (above 0 too much arrives). The error of the radiance is the root of its mean \
square over its mean. The truth is the mean of two Monte Carlo references of the true BRDF, each with and \
without shadows by the same samples; their noise, measured by their difference, is taken out of the squares. \
A history is of 16 frames at rest.";

const HEADS: &str = "level | S, RMSE x 100 | in penumbra | mean | radiance, RMSE / mean % | shade, ms | rays, ms | \
    history, ms | filter, ms | sum, ms | million rays/s";

fn cells(result: &LevelResult) -> Vec<String> {
    let LevelResult { level, errors, milliseconds, rays_per_second } = result;
    let time = |time: Option<Spread>| time.map_or_else(String::new, |time| format!("{:.1}", time.median));
    vec![
        level.name(),
        format!("{:.2}", 100.0 * errors.rmse),
        format!("{:.2}", 100.0 * errors.penumbra_rmse),
        format!("{:+.2}", 100.0 * errors.bias),
        format!("{:.1}", 100.0 * errors.radiance.rmse),
        time(milliseconds.shade),
        time(milliseconds.rays),
        time(milliseconds.history),
        time(milliseconds.filter),
        format!("{:.1}", milliseconds.sum()),
        rays_per_second.map_or_else(String::new, |rays| format!("{:.2}", 1e-6 * rays)),
    ]
}

impl SceneResult {
    fn table(&self) -> Table {
        Table::new(HEADS, self.levels.iter().map(cells))
    }

    /// What is seen, and how well it is known.
    fn summary(&self) -> String {
        let Self { lights, blockers, samples, penumbra, noise, .. } = self;
        let many = if *lights == 1 { "light" } else { "lights" };
        let [penumbra, noise_all, noise] =
            [*penumbra, noise.rmse, noise.penumbra_rmse].map(|part| 100.0 * part);
        format!(
            "{lights} {many}, {blockers} triangles that block; {penumbra:.0} % of the lit pixels are in a \
            penumbra. Each reference has {samples} samples a pixel of each light; the noise of their S is \
            {noise_all:.2}, in penumbra {noise:.2}."
        )
    }
}

impl ShadowLevels {
    fn how(&self) -> String {
        let (size, rounds) = (self.size, self.rounds);
        let clock = if self.is_software {
            "of processor time over the number of processors, which says nothing of a GPU"
        } else {
            "of the device"
        };
        format!(
            "Pictures of {size} x {size} pixels; times are medians of {rounds} rounds, in milliseconds \
            {clock}."
        )
    }

    /// Tables for a terminal.
    pub fn to_text(&self) -> String {
        let mut text = String::new();
        for scene in &self.scenes {
            let _ = write!(text, "{}: {}\n{}\n", scene.name, scene.summary(), scene.table().to_text());
        }
        text + &self.how() + "\n"
    }

    /// A section of a document. `command` is what made it.
    pub fn to_markdown(&self, command: &str) -> String {
        let mut text = format!("Made by `{command}` on {}. {}\n\n{MEASURES}\n", self.device, self.how());
        for scene in &self.scenes {
            let table = scene.table().to_markdown();
            let _ = write!(text, "\n### {}\n\n{}\n\n{table}", scene.name, scene.summary());
        }
        text
    }
}
