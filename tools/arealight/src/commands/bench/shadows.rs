//! `arealight bench shadows`

use super::Ends;
use crate::failure::Failure;
use crate::{lights, progress};
use arealight_benches::sections::Markers;
use arealight_benches::{shadow_levels, shadow_motion};
use arealight_scene::{LoadOptions, Scene};
use std::path::PathBuf;
use std::process::ExitCode;

/// Measure the error and cost of shadows at each level.
///
/// Pictures of scenes by every level are held against the Monte
/// Carlo reference with shadows: the part of each pixel's light that arrives, in all lit pixels and in
/// penumbra alone, and the radiance. Times are of each pass of a frame.
#[derive(clap::Args)]
pub struct Arguments {
    /// Scenes to measure in place of those that are built in
    #[arg(value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    /// Films instead, in which the camera and the light move: errors with and without a history, each frame
    /// beside its own truth.
    #[arg(long)]
    motion: bool,
    /// Pixels to a side of the pictures; of films, which are 16:9, the height [default: 192; 90 with
    /// --motion]
    #[arg(long, value_parser = clap::value_parser!(u32).range(16..=2048))]
    size: Option<u32>,
    /// Samples a pixel of each of two references, fewer with many lights; of films, frames of four rays
    /// [default: 256; 64 with --motion]
    #[arg(long, value_parser = clap::value_parser!(u32).range(4..=65_536))]
    samples: Option<u32>,
    /// Rounds in which time is taken.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u32).range(0..=1000),
        conflicts_with = "motion")]
    rounds: u32,
    /// Judge every so many of a film's 64 frames.
    #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=64),
        requires = "motion")]
    every: u32,
    #[command(flatten)]
    ends: Ends,
}

/// The scenes that are built in.
const SCENES: [(&str, &[u8]); 4] = [
    ("shadows.glb", include_bytes!("../../../../../scenes/shadows.glb")),
    ("shadows-glossy.glb", include_bytes!("../../../../../scenes/shadows-glossy.glb")),
    ("hundred-lamps.glb", include_bytes!("../../../../../scenes/hundred-lamps.glb")),
    ("hundred-lamps-metal.glb", include_bytes!("../../../../../scenes/hundred-lamps-metal.glb")),
];

/// Of them, those that films are made of.
const FILMED: usize = 2;

impl Arguments {
    fn scenes(&self) -> Result<Vec<Scene>, Failure> {
        if self.scenes.is_empty() {
            let built_in = |(name, bytes): &(&str, &[u8])| {
                Scene::from_bytes(bytes, name).map_err(|error| Failure::input(name, error))
            };
            let count = if self.motion { FILMED } else { SCENES.len() };
            return SCENES.iter().take(count).map(built_in).collect();
        }
        self.scenes.iter().map(|path| lights::read(path, LoadOptions::default())).collect()
    }

    /// The command that runs the same again, with these options beside the scenes.
    fn command(&self, options: &str) -> String {
        let mut command = "arealight bench shadows".to_owned();
        for path in &self.scenes {
            command.push(' ');
            command.push_str(&path.display().to_string());
        }
        format!("{command} {options} --markdown docs/data/shadows.md")
    }
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    if arguments.motion { run_motion(arguments) } else { run_levels(arguments) }?;
    Ok(ExitCode::SUCCESS)
}

fn run_levels(arguments: &Arguments) -> Result<(), Failure> {
    let base = shadow_levels::Options::default();
    let size = arguments.size.unwrap_or(base.size);
    let samples = arguments.samples.unwrap_or(base.samples);
    let options = shadow_levels::Options { size, samples, rounds: arguments.rounds };
    let scenes = arguments.scenes()?;
    let host = arguments.ends.host()?;

    let found = progress::of(options.steps(scenes.len()), "steps", |tell| {
        shadow_levels::run(&host, &arealight::LightTable::ggx(), &scenes, &options, tell)
    })?;

    let command =
        arguments.command(&format!("--size {size} --samples {samples} --rounds {}", arguments.rounds));
    arguments.ends.section(&found, Markers::SHADOWS, &found.to_markdown(&command), &found.to_text())
}

fn run_motion(arguments: &Arguments) -> Result<(), Failure> {
    let base = shadow_motion::Options::default();
    let height = arguments.size.unwrap_or(base.size[1]);
    let truth = arguments.samples.unwrap_or(base.truth);
    let size = [height * 16 / 9, height];
    let options = shadow_motion::Options { size, truth, every: arguments.every, ..base };
    let scenes = arguments.scenes()?;
    let host = arguments.ends.host()?;

    let found = progress::of(options.steps(scenes.len()), "frames", |tell| {
        shadow_motion::run(&host, &arealight::LightTable::ggx(), &scenes, &options, tell)
    })?;

    let command =
        arguments.command(&format!("--motion --size {height} --samples {truth} --every {}", arguments.every));
    arguments.ends.section(&found, Markers::SHADOWS_IN_MOTION, &found.to_markdown(&command), &found.to_text())
}
