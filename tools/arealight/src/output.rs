//! Standard output, which may be a pipe that closes early.

use crate::failure::Failure;
use std::io::Write as _;
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
