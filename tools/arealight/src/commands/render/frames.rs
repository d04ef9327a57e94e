//! Films: pictures of times that follow each other.

use crate::canvas::Canvas;
use crate::failure::Failure;
use crate::film;
use crate::output;
use crate::picture::{Exposure, Format, Picture};
use arealight_engine::ShadowedView;
use glam::DVec3;
use std::path::{Path, PathBuf};

/// How many pictures there are.
#[derive(clap::Args)]
#[command(next_help_heading = "Film")]
pub struct FilmArguments {
    /// A film of so many pictures, from --time on: numbered files, or one where --output ends in .gif. Means
    /// of shadow rays go over the pictures before, for as long as what rays find does not change; not with
    /// --shadow-noise
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=9999))]
    pub frames: Option<u32>,
    /// Pictures a second
    #[arg(long, value_name = "FPS", default_value_t = 24, requires = "frames",
        value_parser = clap::value_parser!(u32).range(1..=240))]
    rate: u32,
}

impl FilmArguments {
    /// Seconds from the first picture to one.
    pub fn seconds(&self, index: u32) -> Option<f64> {
        self.frames.map(|_| f64::from(index) / f64::from(self.rate))
    }

    pub fn count(&self) -> u32 {
        self.frames.unwrap_or(1)
    }
}

/// A picture of a film, or the only one, and what is kept for the next.
pub struct Frame {
    pub index: u32,
    /// What positions are relative to in all of them.
    pub origin: DVec3,
    /// The first one's, where it is found by itself.
    pub exposure: Exposure,
    /// The passes of shadows, with their history.
    pub shadows: Vec<ShadowedView>,
}

/// Where pictures go.
pub struct Reel<'a> {
    path: &'a Path,
    format: Format,
    film: &'a FilmArguments,
    shown: Vec<Canvas>,
}

impl<'a> Reel<'a> {
    /// One that ends at a path, of pictures of a size.
    ///
    /// # Errors
    /// [`Failure::Argument`] where the path's ending says nothing that pictures, or a film, are written as.
    pub fn new(path: &'a Path, film: &'a FilmArguments, size: [u32; 2]) -> Result<Self, Failure> {
        let refused = |why: &str| Failure::Argument {
            argument: "--output",
            message: format!("{}: {why}", path.display()),
        };
        let format = Picture::check_format(path)?;
        match (format, film.frames) {
            (Format::Gif, None) => Err(refused("one picture is no film: .png or .exr, or --frames")),
            (Format::Gif, _) if film::is_too_large(size, film.count()) => {
                Err(refused("a .gif of more than 2 GiB of pictures: smaller ones, or numbered .png"))
            }
            (Format::Gif, _) if film.rate > 100 => {
                Err(refused("a .gif has at most 100 pictures a second: a lower --rate, or numbered .png"))
            }
            (_, Some(_)) if output::is_stream(path) => Err(refused("is one file, not a film's")),
            _ => Ok(Self { path, format, film, shown: vec![] }),
        }
    }

    /// The file of a picture.
    pub fn file(&self, index: u32) -> PathBuf {
        if self.film.frames.is_none() || self.format == Format::Gif {
            return self.path.to_owned();
        }
        let mut name = self.path.with_extension("").into_os_string();
        name.push(format!("-{index:04}."));
        name.push(self.path.extension().unwrap_or_default());
        name.into()
    }

    /// Writes the next picture, of `factor` × `factor` samples a pixel; a .gif with its last one.
    pub fn add(&mut self, index: u32, picture: &Picture, (factor, stops): (u32, f32)) -> Result<(), Failure> {
        if self.format != Format::Gif {
            return picture.save(&self.file(index), factor, stops);
        }
        self.shown.push(picture.shown(factor, stops));
        if index + 1 < self.film.count() {
            return Ok(());
        }
        film::save(self.path, &self.shown, self.film.rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn films_are_numbered_files_or_one() {
        let film = FilmArguments { frames: Some(3), rate: 24 };
        let still = FilmArguments { frames: None, rate: 24 };
        let file = |path: &str, film| {
            Reel::new(Path::new(path), film, [640, 360]).map(|reel| reel.file(2).display().to_string())
        };
        assert_eq!(file("out/a.b.exr", &film).unwrap(), "out/a.b-0002.exr");
        assert_eq!([file("a.gif", &film).unwrap(), file("a.png", &still).unwrap()], ["a.gif", "a.png"]);
        assert_eq!([film.seconds(12), still.seconds(0)], [Some(0.5), None]);
        let refused = |path, film, why: &str| {
            assert!(file(path, film).unwrap_err().to_string().contains(why), "{path}");
        };
        refused("a.gif", &still, "--frames");
        refused("-", &film, "one file");
        refused("a.gif", &FilmArguments { frames: Some(9999), rate: 24 }, "2 GiB");
        refused("a.bmp", &film, ".png or .exr");
    }
}
