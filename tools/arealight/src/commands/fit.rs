//! `arealight fit`

use crate::failure::Failure;
use crate::output::print;
use crate::progress;
use arealight::LightTable;
use arealight_fit::report::{COUNT, Errors, PUBLISHED, SEED, cases, measure};
use arealight_fit::{GgxBrdf, Settings};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// Fit a light table to GGX, and measure it.
#[derive(clap::Args)]
pub struct Arguments {
    /// Where the table goes; without it the table is only fitted, and measured with --report.
    #[arg(short, long, value_name = "FILE.exr")]
    output: Option<PathBuf>,
    /// Nodes a side, 2 to 1024.
    #[arg(long, default_value_t = 64, value_parser = clap::value_parser!(u32).range(2..=1024))]
    size: u32,
    /// Compare the table with the true BRDF on 3000 random quads, beside the published table.
    #[arg(long)]
    report: bool,
    /// Print the summary as JSON.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    // Fit
    let settings = Settings { size: arguments.size, ..Settings::default() };
    let bar = progress::bar(2 * u64::from(settings.size).pow(2), "steps");
    let start = Instant::now();
    let table = arealight_fit::fit(&GgxBrdf, &settings, &|_, _| bar.inc(1));
    let seconds = start.elapsed().as_secs_f64();
    bar.finish_and_clear();
    let table =
        table.map_err(|error| Failure::Argument { argument: "--size", message: error.to_string() })?;

    // Write it before it is measured: a report that is broken off loses nothing
    if let Some(path) = &arguments.output {
        arealight_table::save(&table, path).map_err(|error| Failure::output(path, error))?;
    }
    let errors = arguments.report.then(|| report(&table));
    let summary = Summary { arguments, table: &table, seconds, errors: errors.as_deref() };
    print(&if arguments.json { summary.to_json() } else { summary.to_text() })
}

/// Measures a table, with a progress bar.
fn report(table: &LightTable) -> Vec<Errors> {
    let bar = progress::bar(COUNT as u64, "quads");
    let cases = cases(COUNT, SEED, &|| bar.inc(1));
    bar.finish_and_clear();
    measure(table, &cases)
}

/// What there is to say of a run.
struct Summary<'a> {
    arguments: &'a Arguments,
    table: &'a LightTable,
    seconds: f64,
    errors: Option<&'a [Errors]>,
}

impl Summary<'_> {
    fn to_text(&self) -> String {
        let (size, brdf, seconds) = (self.table.size(), &self.table.description().brdf, self.seconds);
        let mut text = format!("fitted {brdf}, {size} x {size} nodes, in {seconds:.1} s\n");
        if let Some(path) = &self.arguments.output {
            let _ = writeln!(text, "wrote {}", path.display());
        }
        if let Some(errors) = self.errors {
            text.push_str(&comparison(errors));
        }
        text
    }

    fn to_json(&self) -> String {
        let errors = |e: &Errors| json!({ "mean": e.mean, "percentile_95": e.percentile_95, "max": e.max });
        let line = |(ours, published): (&Errors, &Errors)| json!({ "f0": ours.f0, "this": errors(ours), "published": errors(published) });
        let report = self.errors.map(|ours| ours.iter().zip(&PUBLISHED).map(line).collect::<Value>());
        let summary = json!({
            "brdf": self.table.description().brdf,
            "made_by": self.table.description().made_by,
            "size": self.table.size(),
            "seconds": self.seconds,
            "output": self.arguments.output,
            "quads": report.as_ref().map(|_| COUNT),
            "report": report,
        });
        format!("{summary:#}\n")
    }
}

/// The errors beside those of the published table, a reflectance a line.
fn comparison(errors: &[Errors]) -> String {
    let mut text = format!(
        "\nAbsolute error of the reflected radiance, over {COUNT} random quads of unit radiance (about the mirror\n\
         direction, anywhere, across the horizon), roughness 0.1 to 1, view 0 to 89 degrees:\n\n\
         {:>5}  {:>26}  {:>26}\n{:>5}  {:>8} {:>8} {:>8}  {:>8} {:>8} {:>8}\n",
        "", "this table", "published, 64 x 64", "F0", "mean", "95 %", "max", "mean", "95 %", "max"
    );
    for (ours, published) in errors.iter().zip(&PUBLISHED) {
        let _ = writeln!(
            text,
            "{:>5}  {:>8.5} {:>8.4} {:>8.3}  {:>8.5} {:>8.4} {:>8.3}",
            ours.f0,
            ours.mean,
            ours.percentile_95,
            ours.max,
            published.mean,
            published.percentile_95,
            published.max
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arguments() -> Arguments {
        Arguments { output: Some("a.exr".into()), size: 2, report: true, json: true }
    }

    #[test]
    fn the_comparison_is_aligned() {
        let text = comparison(&PUBLISHED);
        let lines: Vec<&str> = text.lines().skip(6).collect();
        assert_eq!(lines[0], " 0.02   0.00140   0.0088    0.040   0.00140   0.0088    0.040");
        assert_eq!(lines.len(), PUBLISHED.len());
        assert!(lines.iter().all(|line| line.len() == lines[0].len()), "{text}");
    }

    #[test]
    fn json_holds_what_the_text_says() {
        let (arguments, table) = (arguments(), arealight_table::ggx());
        let summary =
            Summary { arguments: &arguments, table: &table, seconds: 1.5, errors: Some(&PUBLISHED) };
        let value: Value = serde_json::from_str(&summary.to_json()).unwrap();
        assert_eq!(value["size"], 64);
        assert_eq!(value["output"], "a.exr");
        assert_eq!(value["report"].as_array().unwrap().len(), PUBLISHED.len());
        assert_eq!(value["report"][6]["this"]["max"], 0.234);
        let text = summary.to_text();
        assert!(text.starts_with("fitted ggx-correlated-smith, 64 x 64 nodes, in 1.5 s\nwrote a.exr\n"));
    }
}
