//! `arealight bench textures`

use crate::failure::Failure;
use crate::output::print;
use crate::progress;
use arealight_benches::footprints::{self, Footprints, Options};
use arealight_engine::{Host, HostOptions};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Hold every lookup of light textures to its error.
///
/// Rectangles that show pictures are seen by surfaces of every roughness, on the device and through its pyramid, by each rung
/// and by the filter of Heitz et al. 2016. Judged are the answers against the integral of picture times lobe in float64:
/// the root of their mean square error over the mean, the median of the relative ones, and whether they are too bright
/// on average. Times are of the same points in the same run.
///
/// Exit code 1 if a rung misses its bar; what the article's filter does changes nothing.
#[derive(clap::Args)]
pub struct Arguments {
    /// The device: a part of its name, or its number among those that `arealight devices` lists.
    #[arg(long, value_name = "NAME|NUMBER")]
    device: Option<String>,
    /// Poses of each family; each is seen with every picture.
    #[arg(long, default_value_t = 600, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    poses: u32,
    /// Another seed makes other poses.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Rounds in which time is taken; with 0 it is not.
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u32).range(0..=10_000))]
    rounds: u32,
    /// Write JSON; `-` prints it instead of the tables. Numbers that are not finite are null.
    #[arg(long, value_name = "FILE|-")]
    json: Option<PathBuf>,
    /// Write the tables as Markdown.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let options =
        Options { poses: arguments.poses as usize, seed: arguments.seed, rounds: arguments.rounds as usize };
    let device = |error: &dyn std::fmt::Display| Failure::Device(error.to_string());
    let host = Host::new(HostOptions { device: arguments.device.clone(), ..HostOptions::default() });
    let host = host.map_err(|error| device(&error))?;

    let bar = progress::bar(options.steps(), "poses");
    let found = footprints::run(&host, &arealight_table::ggx(), &options, &|count| bar.inc(count));
    bar.finish_and_clear();
    let found = found.map_err(|error| device(&error))?;

    if let Some(path) = &arguments.markdown {
        write(path, &found.to_markdown())?;
    }
    report(&found, arguments.json.as_deref())?;
    Ok(if found.shortfalls().next().is_some() { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

/// Prints the tables, or JSON where that goes to standard output.
fn report(found: &Footprints, json: Option<&Path>) -> Result<ExitCode, Failure> {
    // Strings and numbers, with strings for keys, always serialise
    let text = || serde_json::to_string_pretty(found).unwrap_or_default() + "\n";
    match json {
        Some(path) if path == Path::new("-") => return print(&text()),
        Some(path) => write(path, &text())?,
        None => {}
    }
    print(&found.to_text())
}

fn write(path: &Path, text: &str) -> Result<(), Failure> {
    std::fs::write(path, text).map_err(|error| Failure::output(path, error))
}
