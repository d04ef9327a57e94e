//! Standard output, which may be a pipe that closes early.

use crate::failure::Failure;
use arealight_scene::{Scene, Warning};
use std::io::Write as _;
use std::path::Path;
use std::process::ExitCode;

/// Prints `text` to standard output. A reader that has seen enough, such as `head`, is no failure.
///
/// # Errors
/// [`Failure::Output`] if standard output cannot be written for another reason, such as a full disk.
pub fn print(text: &str) -> Result<ExitCode, Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::output("standard output", error))
        }
        _ => Ok(ExitCode::SUCCESS),
    }
}

/// Prints to standard error what a scene's picture lacks, and what is not shown word for word: the file once, then a line for each kind.
pub fn say_what_is_not_shown(scene: &Scene, path: &Path) {
    for (word, said) in [("warning", &scene.warnings), ("note", &scene.notes)] {
        match &Warning::grouped(said)[..] {
            [] => {}
            [line] => eprintln!("{word}: {}: {line}", path.display()),
            lines => eprintln!("{word}: {}:\n    {}", path.display(), lines.join("\n    ")),
        }
    }
}
