//! `arealight bench lights`

use super::Ends;
use crate::commands::render::parse_size;
use crate::failure::Failure;
use crate::plots::{self, Kind};
use crate::progress;
use arealight_benches::many_lights::{self, Options};
use arealight_benches::sections::Markers;
use std::path::PathBuf;
use std::process::ExitCode;

/// Measure what many lights cost: a floor under 10 to 10,000 lamps, shaded with all of them and by tiles.
///
/// Tiles cull a stated fraction of a pixel's radiance, lists of froxels a stated radiance. Errors are against
/// the picture with all lights.
#[derive(clap::Args)]
pub struct Arguments {
    /// How many lamps there are.
    #[arg(long, value_name = "N,N,...", value_delimiter = ',', default_values_t = Options::default().counts,
        value_parser = parse_count)]
    lamps: Vec<usize>,
    /// The picture in pixels.
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = parse_size)]
    size: [u32; 2],
    /// Roughness of the floor, in [0.1, 1].
    #[arg(long, value_name = "R", default_value_t = Options::default().roughness,
        value_parser = parse_roughness)]
    roughness: f32,
    /// Runs of each frame, at least two; the fastest counts.
    #[arg(long, value_name = "N", default_value_t = Options::default().rounds,
        value_parser = clap::value_parser!(u32).range(1..=1000))]
    rounds: u32,
    /// Fog over a black floor instead, with all lamps and by lists of froxels.
    #[arg(long)]
    fog: bool,
    /// Write a chart of time and error as SVG.
    #[arg(long, value_name = "FILE", conflicts_with = "fog")]
    svg: Option<PathBuf>,
    #[command(flatten)]
    ends: Ends,
}

fn parse_count(text: &str) -> Result<usize, String> {
    let count = text.trim().parse().ok().filter(|count| (1..=100_000).contains(count));
    count.ok_or_else(|| "must be a number from 1 to 100000".to_owned())
}

fn parse_roughness(text: &str) -> Result<f32, String> {
    let roughness = text.parse().ok().filter(|roughness| (0.1..=1.0).contains(roughness));
    roughness.ok_or_else(|| "must be a number from 0.1 to 1".to_owned())
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let Arguments { lamps, size, roughness, rounds, fog, svg, ends } = arguments;
    svg.as_deref().map_or(Ok(()), plots::check)?;
    let host = ends.host()?;
    let options = Options {
        counts: lamps.clone(),
        size: *size,
        roughness: *roughness,
        rounds: *rounds,
        ways: if *fog { many_lights::FOG_WAYS.to_vec() } else { many_lights::WAYS.to_vec() },
    };
    let found = progress::of(many_lights::steps(&options), "frames", |tell| {
        many_lights::run(&host, &arealight::LightTable::ggx(), &options, tell)
    })?;

    let (markers, how) =
        if *fog { (Markers::FOG, "--fog") } else { (Markers::LIGHTS, "--svg docs/images/lights.svg") };
    let section = found.to_markdown(&format!("arealight bench lights {how} --markdown docs/data/tiles.md"));
    if let Some(path) = svg {
        plots::draw(Kind::Lights, &serde_json::to_value(&found).unwrap_or_default(), path)?;
    }
    ends.section(&found, markers, &section, &found.to_text())?;
    Ok(ExitCode::SUCCESS)
}
