//! `arealight bench shadows`

use super::{Ends, document};
use crate::failure::Failure;
use crate::progress;
use arealight_benches::sections::Markers;
use arealight_benches::shadow_levels::{self, Options};
use arealight_scene::Scene;
use std::path::PathBuf;
use std::process::ExitCode;

/// Measure what shadows err at each level, and what they take.
///
/// Pictures of scenes by every level, and by area sampling with as many rays, are held against the Monte Carlo reference with shadows: the part of
/// each pixel's light that arrives, in all lit pixels and in penumbra alone, and the radiance. Times are of each pass of a frame.
#[derive(clap::Args)]
pub struct Arguments {
    /// Scenes to measure in place of the three that are built in
    #[arg(value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    /// Pixels to a side of the pictures.
    #[arg(long, default_value_t = 192, value_parser = clap::value_parser!(u32).range(16..=2048))]
    size: u32,
    /// Samples a pixel of the reference, of which there are two; less where there are many lights.
    #[arg(long, default_value_t = 256, value_parser = clap::value_parser!(u32).range(4..=65_536))]
    samples: u32,
    /// Rounds in which time is taken.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u32).range(0..=1000))]
    rounds: u32,
    #[command(flatten)]
    ends: Ends,
}

/// The scenes that are built in.
const SCENES: [(&str, &[u8]); 3] = [
    ("shadows.glb", include_bytes!("../../../../../scenes/shadows.glb")),
    ("shadows-glossy.glb", include_bytes!("../../../../../scenes/shadows-glossy.glb")),
    ("hundred-lamps.glb", include_bytes!("../../../../../scenes/hundred-lamps.glb")),
];

impl Arguments {
    fn scenes(&self) -> Result<Vec<Scene>, Failure> {
        if self.scenes.is_empty() {
            let built_in = |(name, bytes): (&str, &[u8])| {
                Scene::from_bytes(bytes, name).map_err(|error| Failure::input(name, error))
            };
            return SCENES.into_iter().map(built_in).collect();
        }
        let load = |path: &PathBuf| Scene::load(path).map_err(|error| Failure::Scene(error.to_string()));
        self.scenes.iter().map(load).collect()
    }

    /// The command that runs the same again.
    fn command(&self) -> String {
        let mut command = "arealight bench shadows".to_owned();
        for path in &self.scenes {
            command += &format!(" {}", path.display());
        }
        let Self { size, samples, rounds, .. } = self;
        command + &format!(" --size {size} --samples {samples} --rounds {rounds} --markdown docs/shadows.md")
    }
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let Arguments { size, samples, rounds, .. } = *arguments;
    let options = Options { size, samples, rounds };
    let scenes = arguments.scenes()?;
    let host = arguments.ends.host()?;

    let bar = progress::bar(options.steps(scenes.len()), "steps");
    let found =
        shadow_levels::run(&host, &arealight_table::ggx(), &scenes, &options, &|count| bar.inc(count));
    bar.finish_and_clear();
    let found = found.map_err(|error| Failure::Device(error.to_string()))?;

    let section = found.to_markdown(&arguments.command());
    let whole = arguments.ends.markdown.as_deref();
    let whole = whole.map(|path| document(path, Markers::SHADOWS, &section)).unwrap_or_default();
    arguments.ends.report(&found, &whole, &found.to_text())?;
    Ok(ExitCode::SUCCESS)
}
