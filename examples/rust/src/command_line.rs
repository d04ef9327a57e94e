//! The programs' command line: `PROGRAM [--frames N] [PATH.png [WIDTH HEIGHT]]`.

use crate::Result;
use std::path::PathBuf;

/// Frames a second, where the clock does not say when each is.
pub const FRAME_RATE: f64 = 30.0;

/// What is asked for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CommandLine {
    /// Where the picture goes.
    pub path: Option<PathBuf>,
    /// Its width and height in pixels.
    pub size: [u32; 2],
    /// How many frames are drawn.
    pub frames: Option<u32>,
}

impl CommandLine {
    /// Reads the arguments of a program, without its own name.
    ///
    /// # Errors
    /// Says how it is used.
    pub fn parse(arguments: impl Iterator<Item = String>) -> Result<Self> {
        let arguments: Vec<String> = arguments.collect();
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        Self::read(&arguments).ok_or_else(|| {
            "usage: PROGRAM [--frames N] [PATH.png [WIDTH HEIGHT]], each of both from 1 to 4096".into()
        })
    }

    fn read(arguments: &[&str]) -> Option<Self> {
        let number = |text: &str| text.parse().ok().filter(|number| (1..=4096).contains(number));
        let (frames, rest) = match arguments {
            ["--frames", count, rest @ ..] => (Some(count.parse().ok().filter(|count| *count > 0)?), rest),
            _ => (None, arguments),
        };
        let (path, size) = match rest {
            [] => (None, [640, 400]),
            [path] => (Some(*path), [640, 400]),
            [path, width, height] => (Some(*path), [number(width)?, number(height)?]),
            _ => return None,
        };
        let is_option = path.is_some_and(|path| path.starts_with('-'));
        (!is_option).then(|| Self { path: path.map(PathBuf::from), size, frames })
    }

    /// Where the picture goes, `name` where that is not said.
    pub fn path_or(&self, name: &str) -> PathBuf {
        self.path.clone().unwrap_or_else(|| name.into())
    }

    /// When each frame is that a picture takes, in seconds: of eight, where their number is not said.
    pub fn times(&self) -> impl Iterator<Item = f64> {
        (0..self.frames.unwrap_or(8)).map(|frame| f64::from(frame) / FRAME_RATE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(arguments: &[&str]) -> Result<CommandLine> {
        CommandLine::parse(arguments.iter().map(ToString::to_string))
    }

    #[test]
    fn path_size_and_frames_are_read_and_nothing_else() {
        let nothing = CommandLine { path: None, size: [640, 400], frames: None };
        assert_eq!(parse(&[]).unwrap(), nothing);
        assert_eq!((nothing.path_or("a.png"), nothing.times().count()), ("a.png".into(), 8));
        let given = CommandLine { path: Some("b.png".into()), size: [64, 40], frames: Some(2) };
        assert_eq!(parse(&["--frames", "2", "b.png", "64", "40"]).unwrap(), given);
        assert_eq!(given.times().collect::<Vec<_>>(), [0.0, 1.0 / 30.0]);
        for wrong in [
            &["--help"][..],
            &["b.png", "64"],
            &["b.png", "64", "0"],
            &["b.png", "64", "x"],
            &["--frames"],
            &["--frames", "0"],
        ] {
            assert!(parse(wrong).is_err(), "{wrong:?}");
        }
    }
}
