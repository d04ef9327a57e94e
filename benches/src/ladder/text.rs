//! What was found, for people: as text for a terminal, as Markdown for the documents.

use super::{BASELINE, Ladder, Row, SplitErrors, Spread};
use crate::table::Table;
use std::fmt::Write as _;

/// Errors, in the order of every table of them: all, of it fit, table and integral; p99, worst, bias; how
/// many are no numbers.
pub fn error_cells(errors: &SplitErrors) -> [String; 8] {
    [
        percent(errors.all.rmse),
        percent(errors.fit),
        errors.table.map_or_else(|| "-".to_owned(), percent),
        percent(errors.integral),
        percent(errors.all.p99),
        percent(errors.all.worst),
        percent(errors.all.bias),
        errors.all.not_finite.to_string(),
    ]
}

/// How lights are read by what is compared: ratios of time depend on it.
pub const READS: &str =
    "Yardsticks read each light once for both lobes, in the same loop over the same buffers as ours.";

/// Three digits, and as few zeros as can be.
pub fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        tiny if tiny < 1e-3 => format!("{value:.1e}"),
        small if small < 0.1 => format!("{value:.4}"),
        middling if middling < 9.995 => format!("{value:.2}"),
        large if large < 99.95 => format!("{value:.1}"),
        huge if huge < 1e6 => format!("{value:.0}"),
        _ => format!("{value:.1e}"),
    }
}

/// A share in percent.
pub fn percent(value: f64) -> String {
    let percent = value * 100.0;
    match percent.abs() {
        0.0 => "0 %".to_owned(),
        tiny if tiny < 1e-3 => format!("{percent:.0e} %"),
        small if small < 0.1 => format!("{percent:.3} %"),
        _ => format!("{} %", number(percent)),
    }
}

fn spread(spread: &Spread) -> String {
    let [low, high] = spread.quartiles;
    format!("{} ({} to {})", number(spread.median), number(low), number(high))
}

impl Ladder {
    /// The rows of some lights.
    pub fn rows_of(&self, lights: &str) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(move |row| row.lights == lights)
    }

    /// The first lights, which have the whole ladder.
    pub fn first(&self) -> &str {
        self.workloads.first().map_or("", |(name, _)| name)
    }

    fn ladder(&self, lights: &str) -> Table {
        let row = |row: &Row| {
            let samples = |pick: fn(&super::Equal) -> f64| {
                row.samples.as_ref().map_or_else(String::new, |s| number(pick(s)))
            };
            let mut cells = vec![row.name.clone()];
            cells.extend(error_cells(&row.errors));
            cells.extend([number(row.time.milliseconds.median), spread(&row.time.ratio)]);
            cells.extend([samples(|equal| equal.error), samples(|equal| equal.time)]);
            cells
        };
        Table::new(
            "method | RMSE | of it fit | table | integral | p99 | worst | bias | NaN | ms | \
            time, clipless = 1 | samples, equal error | equal time",
            self.rows_of(lights).map(row),
        )
    }

    fn samples(&self) -> Table {
        let row = |samples: &super::Samples| {
            vec![
                samples.count.to_string(),
                percent(samples.errors.rmse),
                percent(samples.errors.p99),
                percent(samples.errors.worst),
                number(samples.milliseconds),
                if samples.measured { "measured" } else { "in proportion" }.to_owned(),
            ]
        };
        Table::new("samples | RMSE | p99 | worst | ms | time is", self.monte_carlo.iter().map(row))
    }

    fn effects(&self) -> Table {
        let row = |effect: &super::EffectCost| {
            let used = effect.used.as_ref().map_or_else(|| "-".to_owned(), spread);
            vec![effect.effect.clone(), spread(&effect.on), used]
        };
        Table::new(
            "effect | turned on, time without it = 1 | lights that need it, quads = 1",
            self.effects.iter().map(row),
        )
    }

    /// What the numbers are, in words.
    pub fn legend(&self) -> String {
        let clock = if self.software {
            "processor time of all threads over their number: what the clock would say on an idle machine"
        } else {
            "GPU time, by timestamps"
        };
        format!(
            "Errors are over the mean of the truth, the integral of the true BRDF, at {} points. Times are \
            of a frame of {} pixels and {} lights, over its lights and megapixels ({clock}); medians of {} \
            rounds, with quartiles. Ratios are to {} on the same device. {READS}",
            self.points,
            self.pixels,
            super::points::LIGHTS,
            self.rounds,
            BASELINE.name()
        )
    }

    /// For a terminal.
    pub fn to_text(&self) -> String {
        let mut text = format!("{}\n{}\n", self.device, self.legend());
        for (name, description) in &self.workloads {
            let _ = write!(text, "\n{name}: {description}\n{}", self.ladder(name).to_text());
        }
        let _ = write!(text, "\nMonte Carlo\n{}", self.samples().to_text());
        let _ = write!(text, "\neffects\n{}", self.effects().to_text());
        let _ = writeln!(text, "\n{:.0} s", self.seconds);
        text
    }

    /// For a document.
    pub fn to_markdown(&self) -> String {
        let mut text = format!("`{}` on {}.\n\n{}\n", self.command, self.device, self.legend());
        for (name, description) in &self.workloads {
            let _ = write!(text, "\n### {name}: {description}\n\n{}", self.ladder(name).to_markdown());
        }
        let _ = write!(text, "\n### Monte Carlo\n\n{}", self.samples().to_markdown());
        let _ = write!(text, "\n### Effects\n\n{}", self.effects().to_markdown());
        text
    }
}
