//! The programs' command line: `PROGRAM [PATH.png [WIDTH HEIGHT]]`.

use crate::Result;
use std::path::PathBuf;

/// How many frames are drawn before the one that is kept.
pub const FRAMES: u32 = 8;

/// What is asked for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CommandLine {
    /// Where the picture goes.
    pub path: PathBuf,
    /// Its width and height in pixels.
    pub size: [u32; 2],
}

impl CommandLine {
    /// Reads the arguments of a program, without its own name; `name` is the picture's where none is given.
    ///
    /// # Errors
    /// Says how it is used.
    pub fn parse(name: &str, arguments: impl Iterator<Item = String>) -> Result<Self> {
        let arguments: Vec<String> = arguments.collect();
        let number = |text: &str| text.parse().ok().filter(|number| (1..=4096).contains(number));
        let parsed = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
            [] => Some((name, Some(640), Some(400))),
            [path] => Some((path, Some(640), Some(400))),
            [path, width, height] => Some((path, number(width), number(height))),
            _ => None,
        };
        match parsed {
            Some((path, Some(width), Some(height))) if !path.starts_with('-') => {
                Ok(Self { path: path.into(), size: [width, height] })
            }
            _ => Err("usage: PROGRAM [PATH.png [WIDTH HEIGHT]], each of both from 1 to 4096".into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(arguments: &[&str]) -> Result<CommandLine> {
        CommandLine::parse("a.png", arguments.iter().map(ToString::to_string))
    }

    #[test]
    fn path_and_size_are_read_and_nothing_else() {
        assert_eq!(parse(&[]).unwrap(), CommandLine { path: "a.png".into(), size: [640, 400] });
        let given = CommandLine { path: "b.png".into(), size: [64, 40] };
        assert_eq!(parse(&["b.png", "64", "40"]).unwrap(), given);
        for wrong in [&["--help"][..], &["b.png", "64"], &["b.png", "64", "0"], &["b.png", "64", "x"]] {
            assert!(parse(wrong).is_err(), "{wrong:?}");
        }
    }
}
