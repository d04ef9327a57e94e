//! `arealight bench pictures`

mod film;
mod strip;

use crate::commands::render::parse_size;
use crate::failure::Failure;
use crate::{gpu, lights, output, progress};
use arealight_benches::ladder::{STEPS_BESIDE_THE_TRUTH, View, beside_the_truth};
use arealight_scene::LoadOptions;
use std::path::PathBuf;
use std::process::ExitCode;

/// Draw the default level, what engines ship, with a table of published quality, and the truth side by side.
///
/// `.png`: a strip of the three pictures with maps of the differences from the truth. `.gif`: a film in which
/// the scene's lights swing, ours next to the truth. Polygon lights swing about the vertical axis through the
/// scene's middle.
///
/// The yardstick is clip by cases for scenes of quads, the clipped sphere for others. Shadows are left out,
/// and diffuse lobes are added, in every picture.
#[derive(clap::Args)]
pub struct Arguments {
    /// The scene, glTF.
    scene: PathBuf,
    /// What to write: .png or .gif.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Width and height of each picture before it is cropped.
    #[arg(long, value_name = "WxH", default_value = "320x180", value_parser = parse_size)]
    size: [u32; 2],
    /// The part to show: left, top, width and height in pixels. By default all.
    #[arg(long, value_name = "X,Y,W,H", value_parser = parse_crop)]
    crop: Option<[u32; 4]>,
    /// Samples a pixel of the truth.
    #[arg(long, default_value_t = 2048, value_parser = clap::value_parser!(u32).range(2..=1 << 20))]
    samples: u32,
    /// Frames of a film.
    #[arg(long, default_value_t = 24, value_parser = clap::value_parser!(u32).range(2..=240))]
    frames: u32,
    /// Degrees that lights swing to either side.
    #[arg(long, default_value_t = 40.0, value_parser = parse_swing)]
    swing: f64,
    #[command(flatten)]
    device: gpu::DeviceArgument,
}

fn parse_crop(text: &str) -> Result<[u32; 4], String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    let crop: Option<[u32; 4]> = numbers.and_then(|numbers| numbers.try_into().ok());
    crop.filter(|[_, _, width, height]| *width > 0 && *height > 0)
        .ok_or_else(|| "left, top, width and height are expected, such as 0,40,320,60".to_owned())
}

fn parse_swing(text: &str) -> Result<f64, String> {
    let degrees = text.parse::<f64>().ok().filter(|degrees| (0.0..=180.0).contains(degrees));
    degrees.ok_or_else(|| "degrees from 0 to 180 are expected".to_owned())
}

/// What the output's name asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Strip,
    Film,
}

impl Arguments {
    fn format(&self) -> Result<Format, Failure> {
        match self.output.extension().and_then(|ending| ending.to_str()) {
            Some("png") => Ok(Format::Strip),
            Some("gif") => Ok(Format::Film),
            _ => Err(Failure::Argument {
                argument: "--output",
                message: format!("{}: the file's name must end in .png or .gif", self.output.display()),
            }),
        }
    }

    /// The part of each picture to show.
    fn crop(&self) -> Result<[u32; 4], Failure> {
        let [width, height] = self.size;
        let crop = self.crop.unwrap_or([0, 0, width, height]);
        let [x, y, w, h] = crop;
        if x.saturating_add(w) > width || y.saturating_add(h) > height {
            let message = format!("{x},{y},{w},{h} reaches out of a picture of {width}x{height}");
            return Err(Failure::Argument { argument: "--crop", message });
        }
        Ok(crop)
    }
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let format = arguments.format()?;
    let crop = arguments.crop()?;
    let scene = lights::read(&arguments.scene, LoadOptions::default())?;
    output::check(&arguments.output)?;
    let host = gpu::host(arguments.device.device.as_deref())?;

    let scenes = match format {
        Format::Strip => vec![scene],
        Format::Film => film::swing(&scene, arguments.frames, arguments.swing),
    };
    let view = View { size: arguments.size, samples: arguments.samples, repeats: 0 };
    let bar = progress::bar(STEPS_BESIDE_THE_TRUTH * scenes.len() as u64, "steps");
    let found =
        beside_the_truth(&host, &arealight::LightTable::ggx(), &scenes, view, &|count| bar.inc(count));
    bar.finish_and_clear();
    let found = found.map_err(|error| Failure::Device(error.to_string()))?;

    match format {
        Format::Strip => {
            found.iter().try_for_each(|found| strip::draw(found, crop).save_png(&arguments.output))?;
        }
        Format::Film => {
            let film =
                film::encode(&found, crop).map_err(|error| Failure::output(&arguments.output, error))?;
            output::write(&arguments.output, &film)?;
        }
    }
    output::say_wrote(&arguments.output);
    Ok(ExitCode::SUCCESS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_malformed_is_refused() {
        assert_eq!(parse_crop("0,40,320,60"), Ok([0, 40, 320, 60]));
        for wrong in ["", "1,2,3", "1,2,0,4", "1,2,3,4,5", "a,2,3,4"] {
            assert!(parse_crop(wrong).is_err(), "{wrong}");
        }
        assert_eq!(parse_swing("40"), Ok(40.0));
        assert!(parse_swing("181").is_err() && parse_swing("NaN").is_err());
    }
}
