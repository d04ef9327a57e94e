//! `arealight bench stability`

use super::Ends;
use crate::failure::Failure;
use crate::plots::{self, Kind};
use crate::progress;
use arealight_benches::method::{METHODS, Method};
use arealight_benches::shape_stability;
use arealight_benches::stability::{self, Options};
use arealight_cases::hard::family::{FAMILIES, Family};
use std::path::PathBuf;
use std::process::ExitCode;

/// Check every level of the form factor against its promises, on families of hard cases.
///
/// Each family's polygons go through every level on the device, and through yardsticks, which are what
/// engines ship: `sphere-horizon`, `clipless`, `clip-by-cases`, and `clip-and-acos`. The results' bits are
/// judged against a reference of 106 bits. Printed are, for each family: the largest error; the largest
/// distance to the values between those of polygons whose vertices differ in float32's last places; of small
/// lights the error in parts of their solid angle over pi; how many results were NaN or infinite; and whether
/// the promises were kept. Families are printed where one of our levels falls short; with --verbose all are.
///
/// Exit code 1 if a level falls short of its promises; what the yardsticks do changes nothing.
#[derive(clap::Args)]
pub struct Arguments {
    /// Polygons of each family, or shapes.
    #[arg(long, default_value_t = 10_000, value_parser = clap::value_parser!(u64).range(1..=100_000_000))]
    samples: u64,
    /// Another seed makes other ones.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Only this family; may be given several times.
    #[arg(long, value_name = "NAME", value_parser = family)]
    family: Vec<&'static Family>,
    /// Only this level or yardstick; may be given several times.
    #[arg(long, value_name = "NAME", value_parser = method)]
    level: Vec<&'static Method>,
    /// Disks, spheres and tubes in the polygons' place.
    #[arg(long, conflicts_with_all = ["family", "level"])]
    shapes: bool,
    /// Draw the families' errors, ours and the yardsticks'.
    #[arg(long, value_name = "FILE", conflicts_with = "shapes")]
    svg: Option<PathBuf>,
    #[command(flatten)]
    ends: Ends,
}

fn family(name: &str) -> Result<&'static Family, String> {
    let names = || FAMILIES.iter().map(|family| family.name).collect::<Vec<_>>().join(", ");
    Family::find(name).ok_or_else(|| format!("there are: {}", names()))
}

fn method(name: &str) -> Result<&'static Method, String> {
    let names = || METHODS.iter().map(|method| method.name).collect::<Vec<_>>().join(", ");
    Method::find(name).ok_or_else(|| format!("there are: {}", names()))
}

/// Those that were asked for, or all.
fn chosen<T>(asked: &[&'static T], all: &'static [T]) -> Vec<&'static T> {
    if asked.is_empty() { all.iter().collect() } else { asked.to_vec() }
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    if arguments.shapes {
        return run_shapes(arguments);
    }
    let options = Options {
        samples: arguments.samples,
        seed: arguments.seed,
        families: chosen(&arguments.family, FAMILIES),
        methods: chosen(&arguments.level, METHODS),
    };
    arguments.svg.as_deref().map_or(Ok(()), plots::check)?;
    let host = arguments.ends.host()?;

    let found = progress::of(options.samples * options.families.len() as u64, "polygons", |tell| {
        stability::run(&host, &arealight::LightTable::ggx(), &options, tell)
    })?;

    if let Some(path) = &arguments.svg {
        plots::draw(Kind::Stability, &serde_json::to_value(&found).unwrap_or_default(), path)?;
    }
    arguments.ends.report(&found, &found.to_markdown(), &found.to_text(progress::is_verbose()))?;
    Ok(if found.shortfalls().next().is_some() { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

/// What is promised of shapes, for the document.
const SHAPE_PROMISES: &str = "Each result is held against float64, by its bits: a finite number in [0, 1]; a \
backward error (the distance to the values of shapes whose numbers differ by 4 x 2^-24 of their lengths) of \
at most 1e-6, of disks 6e-7; of far lights an error of at most 1e-5, of disks 5e-6 and of tubes whose radius \
is a 64th of their distance or less 5e-4, of what they would send from the zenith. Beside the disks is the \
published disk, its discriminant kept from being negative, on the same device: how many of its results are \
not finite, and the largest error of those that are.";

fn run_shapes(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let host = arguments.ends.host()?;
    let rows = progress::of(arguments.samples * shape_stability::family_count(), "shapes", |tell| {
        shape_stability::run(&host, arguments.samples, arguments.seed, tell)
    })?;

    let table = shape_stability::markdown(&rows);
    let document = format!(
        "# Hard disks, spheres and tubes\n\nMade by `arealight bench stability --shapes --samples {} --seed \
        {} --markdown FILE` on {}.\n\n{SHAPE_PROMISES}\n\n{table}",
        arguments.samples,
        arguments.seed,
        host.device_name()
    );
    arguments.ends.report(&rows, &document, &table)?;
    let kept = rows.iter().all(shape_stability::ShapeRow::is_kept);
    Ok(if kept { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_name_is_answered_with_the_right_ones() {
        assert_eq!(family("crossing").unwrap().name, "crossing");
        assert!(family("crosing").unwrap_err().contains("in-horizon, just-above"));
        assert_eq!(method("clipless").unwrap().name, "clipless");
        assert!(method("exact").unwrap_err().starts_with("there are: polygon-exact, "));
    }
}
