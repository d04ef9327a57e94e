//! `arealight bench`

mod compiled;
mod furnace;
mod ladder;
mod lights;
mod materials;
mod page;
mod pictures;
mod results;
mod shadows;
mod stability;
mod textures;

use crate::failure::Failure;
use crate::output::{self, print, print_styled, shown};
use crate::{gpu, verdict};
use arealight_benches::sections::{Markers, replace_section};
use arealight_engine::Host;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Measure what accuracy costs in time on a device: every quality level and what others ship, with error and
/// time.
///
/// Errors are against the integral of the true BRDF in float64, at points about four lights, and split into
/// those of the fit, of the table and of the integral. Times are of frames of the same points, every method
/// in turn, and of Monte Carlo on the same device and yardsticks: the form factors that engines ship, by
/// school, on the same work with the same reads.
#[derive(clap::Args)]
#[command(args_conflicts_with_subcommands = true)]
pub struct Arguments {
    #[command(subcommand)]
    bench: Option<Bench>,
    #[command(flatten)]
    ladder: ladder::LadderArguments,
}

#[derive(clap::Subcommand)]
enum Bench {
    Compiled(compiled::Arguments),
    Furnace(furnace::Arguments),
    Lights(lights::Arguments),
    Materials(materials::Arguments),
    Pictures(pictures::Arguments),
    Results(results::Arguments),
    Shadows(shadows::Arguments),
    Stability(stability::Arguments),
    Textures(textures::Arguments),
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    match &arguments.bench {
        None => ladder::run(&arguments.ladder),
        Some(Bench::Compiled(arguments)) => compiled::run(arguments),
        Some(Bench::Furnace(arguments)) => furnace::run(arguments),
        Some(Bench::Lights(arguments)) => lights::run(arguments),
        Some(Bench::Materials(arguments)) => materials::run(arguments),
        Some(Bench::Pictures(arguments)) => pictures::run(arguments),
        Some(Bench::Results(arguments)) => results::run(arguments),
        Some(Bench::Shadows(arguments)) => shadows::run(arguments),
        Some(Bench::Stability(arguments)) => stability::run(arguments),
        Some(Bench::Textures(arguments)) => textures::run(arguments),
    }
}

/// Where a benchmark runs, and where its tables go.
#[derive(clap::Args)]
struct Ends {
    #[command(flatten)]
    device: gpu::DeviceArgument,
    /// Print JSON instead of the tables. Numbers that are not finite are null.
    #[arg(long)]
    json: bool,
    /// Write that JSON, which has nothing of the machine but its device's and driver's names.
    #[arg(long, value_name = "FILE")]
    save: Option<PathBuf>,
    /// Write the tables as Markdown.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
}

impl Ends {
    /// The device, when it is known that every file can be written.
    fn host(&self) -> Result<Host, Failure> {
        self.save
            .as_deref()
            .into_iter()
            .chain(self.markdown.as_deref())
            .try_for_each(|path| output::check(path, None))?;
        gpu::host(self.device.device.as_deref())
    }

    /// As [`Ends::report`], of a section of a document.
    fn section(
        &self,
        found: &impl Serialize,
        markers: Markers,
        section: &str,
        text: &str,
    ) -> Result<(), Failure> {
        let whole = self.markdown.as_deref().map(|path| document(path, markers, section));
        self.report(found, &whole.unwrap_or_default(), text)
    }

    /// Writes the tables where they were asked for, and prints them, or JSON where that goes to standard
    /// output.
    fn report(&self, found: &impl Serialize, markdown: &str, text: &str) -> Result<(), Failure> {
        if let Some(path) = &self.markdown {
            write(path, markdown)?;
        }
        // Strings and numbers, with strings for keys, always serialise
        let json = || serde_json::to_string_pretty(found).unwrap_or_default() + "\n";
        if let Some(path) = &self.save {
            write(path, &json())?;
        }
        if self.json { print(&json()) } else { print_styled(&verdict::for_stdout(&shown(text))) }.map(drop)
    }
}

fn write(path: &Path, text: &str) -> Result<(), Failure> {
    output::write(path, text.as_bytes())
}

/// The document with a section: in its place where it has one, else alone.
fn document(path: &Path, markers: Markers, section: &str) -> String {
    let there = std::fs::read_to_string(path).unwrap_or_default();
    replace_section(&there, markers, section).unwrap_or_else(|| {
        let [begin, end] = markers.lines();
        format!("{begin}\n\n{}\n\n{end}\n", section.trim())
    })
}
