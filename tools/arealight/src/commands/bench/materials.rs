//! `arealight bench materials`

use super::Ends;
use crate::failure::Failure;
use crate::{lights, progress};
use arealight_benches::materials::{self, Options};
use arealight_benches::sections::Markers;
use arealight_scene::{LoadOptions, Scene};
use std::path::PathBuf;
use std::process::ExitCode;

/// Measure the error of each material of a scene.
///
/// The scene is rendered at the exact level, and by Monte Carlo of the true BRDF, both without shadows. A row
/// of the table is a material: its mean radiance over that of the reference, and the root of the mean squared
/// difference over the mean, without the reference's noise.
#[derive(clap::Args)]
pub struct Arguments {
    /// A scene in place of the balls that are built in
    #[arg(value_name = "SCENE")]
    scene: Option<PathBuf>,
    /// Height of the pictures in pixels, which are 16:9.
    #[arg(long, default_value_t = Options::default().size[1],
        value_parser = clap::value_parser!(u32).range(16..=2048))]
    size: u32,
    /// Samples a pixel of each of the two references.
    #[arg(long, default_value_t = Options::default().samples,
        value_parser = clap::value_parser!(u32).range(2..=1_048_576))]
    samples: u32,
    #[command(flatten)]
    ends: Ends,
}

const BALLS: &[u8] = include_bytes!("../../../../../scenes/materials.glb");

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let Arguments { scene, size, samples, ends } = arguments;
    let read = match scene {
        None => {
            Scene::from_bytes(BALLS, "materials.glb").map_err(|error| Failure::input("materials.glb", error))
        }
        Some(path) => lights::read(path, LoadOptions::default()),
    }?;
    let options = Options { size: [size * 16 / 9, *size], samples: *samples };
    let host = ends.host()?;

    let found = progress::of(2 * u64::from(*samples), "samples a pixel", |tell| {
        materials::run(&host, &arealight::LightTable::ggx(), &read, &options, tell)
    })?;

    let path = scene.as_ref().map_or_else(String::new, |path| format!("{} ", path.display()));
    let command = format!(
        "arealight bench materials {path}--size {size} --samples {samples} --markdown docs/data/materials.md"
    );
    let section = found.to_markdown(&command);
    ends.section(&found, Markers::MATERIALS, &section, &found.to_text())?;
    Ok(ExitCode::SUCCESS)
}
