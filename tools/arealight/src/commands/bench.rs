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
use crate::output::{self, print, print_styled, say_beside, shown};
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
        if self.save.is_some() && self.save == self.markdown {
            let message = "is the file of --markdown too: name another".into();
            return Err(Failure::Argument { argument: "--save", message });
        }
        self.save.iter().chain(&self.markdown).try_for_each(|path| output::check(path))?;
        // What is there must be readable, or it would be lost after a long run
        self.markdown.as_deref().map_or(Ok(String::new()), there)?;
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
        let whole = self.markdown.as_deref().map(|path| document(path, markers, section)).transpose()?;
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
        if let Some(stream) = self.save.iter().chain(&self.markdown).find(|path| output::is_stream(path)) {
            return say_beside(Some(stream), text).map(drop);
        }
        if self.json { print(&json()) } else { print_styled(&verdict::for_stdout(&shown(text))) }.map(drop)
    }
}

fn write(path: &Path, text: &str) -> Result<(), Failure> {
    output::write(path, text.as_bytes())
}

/// The document with a section: in its place where it has one, else alone.
///
/// # Errors
/// [`Failure::Input`] where it is there and cannot be read: it would be lost.
fn document(path: &Path, markers: Markers, section: &str) -> Result<String, Failure> {
    Ok(replace_section(&there(path)?, markers, section).unwrap_or_else(|| {
        let [begin, end] = markers.lines();
        format!("{begin}\n\n{}\n\n{end}\n", section.trim())
    }))
}

/// The text of a document that may not be there yet.
fn there(path: &Path) -> Result<String, Failure> {
    match std::fs::read_to_string(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(Failure::input(path, error)),
        read => Ok(read.unwrap_or_default()),
    }
}
