//! `arealight compare`

use crate::canvas::Canvas;
use crate::differences::diverging;
use crate::failure::Failure;
use crate::memory;
use crate::output::{self, print};
use crate::picture::{BLOCK, levels};
use arealight_cases::images::Images;
use arealight_oracle::texture::Texture;
use glam::DVec3;
use serde_json::json;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Compare two pictures of radiance, such as one of ours with its reference.
///
/// Both are OpenEXR files of one size. The errors are of A against B: the root of the mean squared difference
/// over the mean of B, the ratio of the means, and the largest difference; and of what a screen shows, in
/// levels of 255, the root of the mean squared difference of the means of 4 x 4 pixels, which an eye sees
/// where it does not see noise. For example: arealight compare ours.exr reference.exr -o map.png
#[derive(clap::Args)]
pub struct Arguments {
    /// The picture to judge (.exr)
    #[arg(value_name = "A.exr")]
    judged: PathBuf,
    /// What it is judged by (.exr)
    #[arg(value_name = "B.exr")]
    truth: PathBuf,
    /// The same as B by other random numbers (`--seed`), of as many samples: with two of them their noise is
    /// not taken for error
    #[arg(value_name = "C.exr")]
    other: Option<PathBuf>,
    /// Write a map of the difference as PNG: blue where A is darker than B, red where it is brighter
    #[arg(short, long, value_name = "FILE.png")]
    output: Option<PathBuf>,
    /// The difference that has the strongest colour of the map, over the mean of B
    #[arg(long, default_value_t = 0.25, requires = "output")]
    scale: f64,
    /// Exposure of what a screen shows, in stops
    #[arg(long, value_name = "EV", default_value_t = 0.0)]
    exposure: f32,
    /// Exit with 1 where the error is larger than this: the root of the mean squared difference over the mean
    #[arg(long, value_parser = super::eval::tolerance)]
    tolerance: Option<f64>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// How far one picture is from another.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Difference {
    /// Root of the mean squared difference of all channels, over the mean of the second picture.
    error: f64,
    /// Mean of the first over that of the second.
    ratio: f64,
    /// The largest difference of a channel, and the pixel that has it.
    largest: (f64, [usize; 2]),
    /// Mean of the second picture.
    mean: f64,
    /// Of what a screen shows: [`levels`].
    levels: [f64; 2],
}

impl Difference {
    /// Of pictures of one size. What two truths differ by is noise, which is not in the mean of the product
    /// of a picture's differences from them.
    fn new(judged: &Texture, [truth, other]: [&Texture; 2], stops: f32) -> Self {
        let truths = || truth.texels().iter().zip(other.texels()).map(|(b, c)| [*b, *c]);
        let pairs = || judged.texels().iter().copied().zip(truths());
        let width = truth.width().max(1);
        let count = 3.0 * pairs().count() as f64;
        let mean = |sum: f64| sum / count;
        let average = mean(truths().map(|[b, c]| 0.5 * (b + c).element_sum()).sum());
        let square: f64 = mean(pairs().map(|(a, [b, c])| (a - b).dot(a - c)).sum()).max(0.0);
        let mut largest = (0.0, 0);
        for (index, (a, [b, c])) in pairs().enumerate() {
            let apart = (a - 0.5 * (b + c)).abs().max_element();
            if apart > largest.0 {
                largest = (apart, index);
            }
        }
        Self {
            error: square.sqrt() / average,
            ratio: mean(judged.texels().iter().map(|texel| texel.element_sum()).sum()) / average,
            largest: (largest.0, [largest.1 % width, largest.1 / width]),
            mean: average,
            levels: levels(pairs(), width, BLOCK, stops),
        }
    }
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let Arguments { judged, truth, other, output, scale, exposure, tolerance, json } = arguments;
    if let Some(path) = output {
        if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png")) {
            let message = format!("{}: the file's name must end in .png", path.display());
            return Err(Failure::Argument { argument: "--output", message });
        }
        [judged, truth].into_iter().chain(other).for_each(|path| output::keep(path));
        output::check(path)?;
    }
    if !(scale.is_finite() && *scale > 0.0) {
        return Err(Failure::Argument { argument: "--scale", message: format!("{scale} is not above 0") });
    }
    if !(-64.0..=64.0).contains(exposure) {
        let message = format!("{exposure} is not within -64 and 64");
        return Err(Failure::Argument { argument: "--exposure", message });
    }
    let mut images = Images::beside(Path::new(""), memory::most_of);
    let mut read = |path: &Path| images.read(path).map_err(|error| Failure::input(path, error));
    let (a, b) = (read(judged)?, read(truth)?);
    let c = other.as_deref().map(&mut read).transpose()?;
    let size = |picture: &Texture| [picture.width(), picture.height()];
    for (path, picture) in [(judged, &a)].into_iter().chain(other.iter().zip(&c)) {
        if size(picture) != size(&b) {
            let ([x, y], [w, h]) = (size(picture), size(&b));
            let message = format!("has {x} x {y} pixels, and {} has {w} x {h}", truth.display());
            return Err(Failure::input(path, message));
        }
    }
    let found = Difference::new(&a, [&b, c.as_ref().unwrap_or(&b)], *exposure);
    if found.mean.is_nan() || found.mean <= 0.0 {
        return Err(Failure::input(truth, "is black on average: an error has nothing to be relative to"));
    }

    if let Some(path) = output {
        map(&a, &b, scale * found.mean).save_png(path)?;
        output::say_wrote(path);
    }
    let Difference { error, ratio, largest: (largest, [x, y]), mean, levels: [levels, color] } = found;
    let text = if *json {
        let value = json!({
            "rmse_over_mean": error, "mean_ratio": ratio, "largest": largest, "largest_at": [x, y],
            "mean": mean, "levels": levels, "levels_of_color": color,
            "output": output.as_ref().map(|path| path.display().to_string()),
        });
        format!("{value:#}\n")
    } else {
        format!(
            "RMSE / mean    {:.3} %\nmean / mean    {ratio:.4}\nlargest        {largest:.3e} at pixel ({x}, \
            {y}); the mean is {mean:.3e}\nlevels of 255  {levels:.2} in blocks of {BLOCK} x {BLOCK}, of them \
            {color:.2} of colour\n",
            100.0 * error
        )
    };
    print(&text)?;
    let most = tolerance.filter(|most| error.is_nan() || error > *most);
    Ok(most.map_or(ExitCode::SUCCESS, |most| {
        output::say(&format!("error: RMSE over mean {error:e} is above --tolerance {most:e}"));
        ExitCode::FAILURE
    }))
}

/// The differences of the channels' means, `full` being the strongest colour's.
fn map(judged: &Texture, truth: &Texture, full: f64) -> Canvas {
    let [width, height] = [truth.width() as u32, truth.height() as u32];
    let mut canvas = Canvas::new(width, height, [255; 3]);
    let mean = |texel: DVec3| texel.element_sum() / 3.0;
    canvas.rectangle((0, 0), (width.cast_signed(), height.cast_signed()), |x, y| {
        let index = y as usize * truth.width() + x as usize;
        diverging((mean(judged.texels()[index]) - mean(truth.texels()[index])) / full)
    });
    canvas
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_relative_to_the_second_picture() {
        let picture = |texels: [f64; 4]| Texture::new(2, 2, texels.map(DVec3::splat).to_vec()).unwrap();
        let truth = picture([1.0, 2.0, 3.0, 2.0]);
        let same = Difference::new(&truth, [&truth; 2], 0.0);
        assert_eq!((same.error, same.ratio, same.largest), (0.0, 1.0, (0.0, [0, 0])));
        assert_eq!(same.levels, [0.0; 2]);
        let other = Difference::new(&picture([1.0, 2.0, 5.0, 2.0]), [&truth; 2], 0.0);
        // One of four pixels is off by 2, over a mean of 2
        assert_eq!((other.error, other.ratio, other.largest), (0.5, 1.25, (2.0, [0, 1])));
    }

    #[test]
    fn noise_of_two_truths_is_no_error() {
        // One truth has too much, too little or as much in columns of blocks, the other in rows
        let picture = |of: &dyn Fn([usize; 2]) -> f64| {
            let grey = |i: usize| DVec3::splat(0.3 + 0.05 * of([i / 4 % 9, i / 144]));
            Texture::new(36, 36, (0..36 * 36).map(grey).collect()).unwrap()
        };
        let truths = [0, 1].map(|axis| picture(&|place| (place[axis] % 3) as f64 - 1.0));
        let found = |off: f64, truths: [&Texture; 2]| Difference::new(&picture(&|_| off), truths, 0.0);
        let two = [&truths[0], &truths[1]];
        let (right, wrong) = (found(0.0, two), found(1.0, two));
        // A screen's curve is bent: of too much and too little a part of a level is left
        assert!(right.error < 1e-9 && right.levels[0] < 0.5, "{right:?}");
        assert!((wrong.error / (0.05 / 0.3) - 1.0).abs() < 1e-9, "{wrong:?}");
        // The twin: by one truth
        let one = found(0.0, [&truths[0]; 2]);
        assert!(one.error > 0.1 && one.levels[0] > 5.0, "{one:?}");
    }
}
