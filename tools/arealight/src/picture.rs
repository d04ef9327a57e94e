//! From radiance to a file: supersampled radiance is resolved, and written as it is (EXR) or for a screen
//! (PNG).

use crate::canvas::Canvas;
use crate::failure::Failure;
use crate::film;
use crate::output;
use exr::prelude::{Image, SpecificChannels, Vec2, WritableImage as _};
use glam::{DVec3, Vec3};
use std::collections::HashMap;
use std::io::Cursor;
use std::path::Path;

/// Linear radiance, row after row from the top.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Linear Rec. 709 radiance, W/(m² sr).
    pub pixels: Vec<Vec3>,
    /// Of pixels that have other samples than their own alone, those: [`crate::edges`].
    pub edges: HashMap<u32, Vec<u32>>,
}

/// What a picture is saved as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// OpenEXR, float32 radiance.
    Exr,
    /// PNG, 8 bits, sRGB.
    Png,
    /// GIF, of films.
    Gif,
}

/// How radiance becomes what a screen shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Exposure {
    /// Radiance is multiplied by 2^stops; within [`MAX_STOPS`].
    Stops(f32),
    /// By so many stops that [`AUTO_PART`] of the samples that are lit and show no lamp have a luminance of
    /// at most [`AUTO_LUMINANCE`].
    Auto,
}

/// The most stops, up or down: within what float32 radiance bears.
pub const MAX_STOPS: f32 = 64.0;

/// The part of the samples that is not brighter than [`AUTO_LUMINANCE`] in a picture that is exposed by
/// itself: highlights, which are few, may be.
pub const AUTO_PART: f64 = 0.9;

/// Where the tone map begins to roll off, nearly: most of the picture keeps its contrast.
pub const AUTO_LUMINANCE: f32 = 0.7;

impl std::str::FromStr for Exposure {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "auto" {
            return Ok(Self::Auto);
        }
        let stops = text.parse().ok().filter(|stops: &f32| stops.abs() <= MAX_STOPS);
        stops.map(Self::Stops).ok_or_else(|| "must be auto, or a number of stops from -64 to 64".to_owned())
    }
}

/// Of linear Rec. 709.
fn luminance(color: Vec3) -> f32 {
    color.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

impl Picture {
    /// The stops of [`Exposure::Auto`]; 0 where nothing is lit. `emission` is what each sample has of lamps
    /// that the camera sees: those samples do not count. `most` is for what nothing lights.
    pub fn auto_stops(&self, emission: &[Vec3], most: f32) -> f32 {
        let reflected = self.pixels.iter().zip(emission).filter(|(_, emission)| **emission == Vec3::ZERO);
        let luminances = reflected.map(|(radiance, _)| luminance(*radiance));
        let mut lit: Vec<f32> = luminances.filter(|y| *y > 0.0 && y.is_finite()).collect();
        if lit.is_empty() {
            return 0.0;
        }
        let rank = ((lit.len() - 1) as f64 * AUTO_PART) as usize;
        let (_, bright, _) = lit.select_nth_unstable_by(rank, f32::total_cmp);
        (AUTO_LUMINANCE / *bright).log2().clamp(-MAX_STOPS, most)
    }

    /// Means over `factor` × `factor` samples of `map` applied to each sample.
    fn resolve(&self, factor: u32, map: impl Fn(Vec3) -> Vec3) -> Self {
        let (width, height) = (self.width / factor, self.height / factor);
        let mean = |pixel: u32| {
            let (x, y) = (pixel % width * factor, pixel / width * factor);
            let own = (0..factor * factor).map(|i| (y + i / factor) * self.width + x + i % factor);
            let shown = |sample: u32| map(self.pixels[sample as usize]);
            match self.edges.get(&pixel) {
                Some(samples) => {
                    samples.iter().map(|sample| shown(*sample)).sum::<Vec3>() / samples.len() as f32
                }
                None => own.map(shown).sum::<Vec3>() / (factor * factor) as f32,
            }
        };
        Self { width, height, pixels: (0..width * height).map(mean).collect(), edges: HashMap::new() }
    }

    /// Writes the picture, of `factor` × `factor` samples a pixel, in the format that the path's ending
    /// names: `.exr` holds the mean radiance in float32, untouched by `stops`; `.png` is what a screen shows.
    pub fn save(&self, path: &Path, factor: u32, stops: f32) -> Result<(), Failure> {
        match Self::check_format(path)? {
            Format::Exr => self.resolve(factor, |radiance| radiance).save_exr(path),
            Format::Png => self.shown(factor, stops).save_png(path),
            Format::Gif => film::save(path, &[self.shown(factor, stops)], 1),
        }
    }

    /// What a screen shows of it: multiplied by 2^stops, tone-mapped sample by sample (so that the edge of a
    /// bright light stays smooth), and encoded as sRGB.
    pub fn shown(&self, factor: u32, stops: f32) -> Canvas {
        let mapped = self.resolve(factor, |radiance| tone_map(radiance * stops.exp2()));
        let bytes = mapped.pixels.iter().flat_map(|p| p.to_array().map(srgb_from_linear)).collect();
        Canvas::of_pixels(mapped.width, mapped.height, bytes)
    }

    /// The format that a path's ending names, PNG for standard output: ask before long work.
    pub fn check_format(path: &Path) -> Result<Format, Failure> {
        if output::is_stream(path) {
            return Ok(Format::Png);
        }
        match path.extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
            Some("exr") => Ok(Format::Exr),
            Some("png") => Ok(Format::Png),
            Some("gif") => Ok(Format::Gif),
            _ => Err(Failure::Argument {
                argument: "--output",
                message: format!(
                    "{}: the file's name must end in .png or .exr, a film's in .gif or these",
                    path.display()
                ),
            }),
        }
    }

    fn save_exr(&self, path: &Path) -> Result<(), Failure> {
        let pixel = |x: usize, y: usize| {
            let p = self.pixels[y * self.width as usize + x];
            (p.x, p.y, p.z)
        };
        let channels = SpecificChannels::rgb(|position: Vec2<usize>| pixel(position.x(), position.y()));
        let mut bytes = Cursor::new(Vec::new());
        Image::from_channels((self.width as usize, self.height as usize), channels)
            .write()
            .to_buffered(&mut bytes)
            .map_err(|error| Failure::output(path, error))?;
        output::write(path, bytes.get_ref())
    }
}

/// Khronos PBR Neutral: colours below 0.8 stay as they are but for a small toe, highlights roll off towards
/// white. From radiance times exposure to [0, 1].
pub fn tone_map(color: Vec3) -> Vec3 {
    const START: f32 = 0.8 - 0.04;
    const DESATURATION: f32 = 0.15;
    // What has overflowed is white, not NaN
    let color = color.clamp(Vec3::ZERO, Vec3::splat(1e30));
    let low = color.min_element();
    let toe = if low < 0.08 { low - 6.25 * low * low } else { 0.04 };
    let color = color - toe;
    let peak = color.max_element();
    if peak < START {
        return color;
    }
    let range = 1.0 - START;
    let rolled = 1.0 - range * range / (peak + range - START);
    let white = 1.0 - 1.0 / (DESATURATION * (peak - rolled) + 1.0);
    (color * (rolled / peak)).lerp(Vec3::splat(rolled), white)
}

/// The byte that a screen shows as `linear`; what is outside of [0, 1] is clamped.
pub fn srgb_from_linear(linear: f32) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let encoded = if linear <= 0.0031308 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0 + 0.5) as u8
}

/// Pixels to a side of the blocks whose means are compared on a screen: an eye sees their differences, where
/// it does not see noise.
pub const BLOCK: usize = 4;

/// The root of the mean squared difference of what a screen shows of radiances at an exposure, in levels of
/// 255: of the means of blocks of `block` x `block` in rows of `width`; and of that the part that is not
/// alike in all channels. Each is held against two truths, whose noise is taken off where it is not the same.
pub fn levels(
    judged: impl Iterator<Item = (DVec3, [DVec3; 2])>,
    width: usize,
    block: usize,
    stops: f32,
) -> [f64; 2] {
    let shown = |radiance: DVec3| {
        let mapped = tone_map(radiance.as_vec3() * stops.exp2()).to_array();
        DVec3::from_array(mapped.map(|channel| f64::from(srgb_from_linear(channel))))
    };
    let mut blocks = vec![];
    for (index, (judged, truths)) in judged.enumerate() {
        let (x, y) = (index % width, index / width);
        let place = y / block * width.div_ceil(block) + x / block;
        if place >= blocks.len() {
            blocks.resize(place + 1, ([DVec3::ZERO; 2], 0.0));
        }
        let judged = shown(judged);
        let block = &mut blocks[place];
        block.0.iter_mut().zip(truths).for_each(|(sum, truth)| *sum += judged - shown(truth));
        block.1 += 1.0;
    }
    let squares = blocks.iter().fold([0.0; 2], |[all, color], (sums, count)| {
        let [a, b] = sums.map(|sum| sum / *count);
        let [of_color, and] = [a, b].map(|apart| apart - apart.element_sum() / 3.0);
        [all + a.dot(b), color + of_color.dot(and)]
    });
    squares.map(|square| (square.max(0.0) / (3 * blocks.len()) as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tone_mapping_is_monotonic_and_stays_in_range() {
        let mut before = -1.0;
        for i in 0..2000 {
            let mapped = tone_map(Vec3::splat(i as f32 * 0.01)).x;
            assert!(mapped > before && mapped <= 1.0, "{i}: {before} then {mapped}");
            before = mapped;
        }
        assert_eq!(tone_map(Vec3::splat(65504.0)).max_element().round(), 1.0);
        assert_eq!(tone_map(Vec3::splat(-1.0)), Vec3::ZERO);
        assert!(tone_map(Vec3::splat(f32::INFINITY)).min_element() > 0.99);
    }

    #[test]
    fn samples_are_averaged_and_exr_keeps_radiance() {
        // Beyond what a screen shows, and another in each channel
        let pixels = (0..8).map(|i| Vec3::new(i as f32, 1000.0 * i as f32, -0.25 * i as f32)).collect();
        let picture = Picture { width: 4, height: 2, pixels, ..Picture::default() };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.exr");
        picture.save(&path, 2, 3.0).unwrap();

        let layer = exr::prelude::read_first_flat_layer_from_file(&path).unwrap().layer_data;
        assert_eq!((layer.size.width(), layer.size.height()), (2, 1));
        let channel = |wanted: &str| -> Vec<f32> {
            let mut channels = layer.channel_data.list.iter();
            channels.find(|c| c.name.eq(wanted)).unwrap().sample_data.values_as_f32().collect()
        };
        assert_eq!(
            [channel("R"), channel("G"), channel("B")],
            [[2.5, 4.5], [2500.0, 4500.0], [-0.625, -1.125]]
        );
    }

    #[test]
    fn levels_are_of_blocks_and_colours_apart() {
        let grey = DVec3::splat(0.1);
        let from_grey = |odd: DVec3, even: DVec3, stops| {
            let texels = (0..64).map(|i| if (i + i / 8) % 2 == 0 { even } else { odd });
            levels(texels.map(|texel| (texel, [grey; 2])), 8, BLOCK, stops)
        };
        // Noise that the blocks' means have not; twice as much in each channel; in one alone
        let [noise, color] = from_grey(grey * 1.05, grey * 0.95, 0.0);
        assert!(noise < 1.0 && color < 0.1, "{noise}, {color}");
        let [all, color] = from_grey(grey * 2.0, grey * 2.0, 0.0);
        assert!(all > 30.0 && color < 1e-9, "{all}, {color}");
        let red = DVec3::new(0.2, 0.1, 0.1);
        let [all, color] = from_grey(red, red, 0.0);
        assert!((color / all - (2.0_f64 / 3.0).sqrt()).abs() < 0.02, "{all}, {color}");
        // A stop more shows more
        assert!(from_grey(red, red, 1.0)[0] > all);
    }

    #[test]
    fn srgb_ends_are_exact() {
        assert_eq!([0.0, 1.0, 2.0, f32::NAN].map(srgb_from_linear), [0, 255, 255, 0]);
    }

    #[test]
    fn a_picture_exposes_itself() {
        // Black, a hundred greys up to 8, and as many samples of a lamp a thousand times as bright
        let greys: Vec<Vec3> = (0..=100).map(|i| Vec3::splat(i as f32 * 0.08)).collect();
        let lamp = [Vec3::splat(8000.0); 100];
        let stops = |pixels: Vec<Vec3>, emission: &[Vec3]| {
            let width = pixels.len() as u32;
            Picture { width, height: 1, pixels, ..Picture::default() }.auto_stops(emission, MAX_STOPS)
        };
        let both = || [&greys[..], &lamp].concat();
        let emission = [&[Vec3::ZERO; 101][..], &lamp].concat();
        let auto = stops(both(), &emission);
        let brightest_kept = greys[91].x * auto.exp2();
        assert!((brightest_kept - AUTO_LUMINANCE).abs() < 0.02, "{brightest_kept}");
        // The lamp does not matter, what it lights does
        assert_eq!(stops(greys.clone(), &emission[..101]), auto);
        let brighter = both().into_iter().map(|pixel| pixel * 4.0).collect();
        assert!((stops(brighter, &emission) - (auto - 2.0)).abs() < 1e-5);
        // The twin: as a surface, it would
        assert!(stops(both(), &[Vec3::ZERO; 201]) < auto - 9.0);
        // Nothing lit, and nearly nothing
        assert_eq!(stops(vec![Vec3::ZERO, Vec3::NAN], &[Vec3::ZERO; 2]), 0.0);
        assert_eq!(stops(vec![Vec3::splat(1e-30)], &[Vec3::ZERO]), MAX_STOPS);
        let rounding = Picture { width: 1, height: 1, pixels: vec![Vec3::splat(1e-7)], ..Picture::default() };
        assert_eq!(rounding.auto_stops(&[Vec3::ZERO], 7.0), 7.0);
    }

    #[test]
    fn exposures_are_stops_or_auto() {
        assert_eq!("-1.5".parse(), Ok(Exposure::Stops(-1.5)));
        assert_eq!("auto".parse(), Ok(Exposure::Auto));
        assert!(["nan", "inf", "200", "", "Auto"].iter().all(|bad| bad.parse::<Exposure>().is_err()));
    }

    #[test]
    fn another_ending_is_refused() {
        let picture = Picture { width: 1, height: 1, pixels: vec![Vec3::ONE], ..Picture::default() };
        let error = picture.save(Path::new("out.bmp"), 1, 0.0).unwrap_err();
        assert!(error.to_string().contains("must end in .png or .exr"));
    }
}
