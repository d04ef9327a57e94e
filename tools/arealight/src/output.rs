//! What commands write: standard output, which may be a pipe that closes early, and files, which are whole or
//! not there.

use crate::failure::Failure;
use arealight_scene::{Scene, Warning};
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use tempfile::NamedTempFile;

/// Prints `text` to standard output. A reader that has seen enough, such as `head`, is no failure.
///
/// # Errors
/// [`Failure::Output`] if standard output cannot be written for another reason, such as a full disk.
pub fn print(text: &str) -> Result<ExitCode, Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::output("standard output", error))
        }
        _ => Ok(ExitCode::SUCCESS),
    }
}

/// Prints to standard error what a scene's picture lacks, and what is not shown word for word: the file once,
/// then a line for each kind.
pub fn say_what_is_not_shown(scene: &Scene, path: &Path) {
    for (word, said) in [("warning", &scene.warnings), ("note", &scene.notes)] {
        match &Warning::grouped(said)[..] {
            [] => {}
            [line] => eprintln!("{word}: {}: {line}", path.display()),
            lines => eprintln!("{word}: {}:\n    {}", path.display(), lines.join("\n    ")),
        }
    }
}

/// Sees to it that a file can be written, before long work. What is there stays as it is, and nothing new is
/// left behind.
///
/// # Errors
/// [`Failure::Output`] if it cannot.
pub fn check(path: &Path) -> Result<(), Failure> {
    Output::open(path).map(drop).map_err(|error| Failure::output(path, error))
}

/// What stands for standard input and output among paths.
pub const STREAM: &str = "-";

/// Whether a path stands for a standard stream.
pub fn is_stream(path: &Path) -> bool {
    path == Path::new(STREAM)
}

/// Says what was done: on standard output, or on standard error where the work's own output, at `path`, goes
/// to standard output.
///
/// # Errors
/// As [`print`].
pub fn say_beside(path: Option<&Path>, text: &str) -> Result<ExitCode, Failure> {
    if path.is_some_and(is_stream) {
        eprint!("{text}");
        return Ok(ExitCode::SUCCESS);
    }
    print(text)
}

/// Writes a file: a reader sees what was there before or all of what is new, also if the disk is full or the
/// program ends.
///
/// # Errors
/// [`Failure::Output`] if it cannot be written. What was there stays then.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let written = Output::open(path).and_then(|output| output.write(bytes));
    written.map_err(|error| Failure::output(path, error))
}

/// Where bytes go.
enum Output {
    /// A file beside the one that it becomes.
    Beside(NamedTempFile, PathBuf),
    /// A device or a pipe, which cannot be replaced.
    There(File),
    /// Standard output.
    Stream,
}

impl Output {
    fn open(path: &Path) -> io::Result<Self> {
        if is_stream(path) {
            return Ok(Self::Stream);
        }
        // A link stays, and what it leads to is replaced
        let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        let there = std::fs::metadata(&path).ok();
        if there.as_ref().is_some_and(|there| !there.is_file()) {
            return OpenOptions::new().write(true).open(&path).map(Self::There);
        }
        if there.is_some() {
            // A file that may not be written is not replaced, although its folder would allow it
            OpenOptions::new().append(true).open(&path)?;
        }
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut builder = tempfile::Builder::new();
        builder.prefix(".arealight-").suffix(".new");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // As of any new file, and less what the user's mask takes; or those of the file that is replaced
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let temporary = builder.tempfile_in(folder)?;
        if let Some(there) = there {
            temporary.as_file().set_permissions(there.permissions())?;
        }
        Ok(Self::Beside(temporary, path))
    }

    fn write(self, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::There(mut file) => file.write_all(bytes),
            Self::Stream => {
                let mut out = io::stdout().lock();
                out.write_all(bytes)?;
                out.flush()
            }
            Self::Beside(mut temporary, path) => {
                temporary.write_all(bytes)?;
                temporary.as_file().sync_all()?;
                temporary.persist(path).map(drop).map_err(|error| error.error)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn a_file_is_replaced_by_all_of_the_new_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("answers.json");
        check(&path).unwrap();
        assert_eq!(names(folder.path()), [""; 0], "a check leaves nothing");
        write(&path, b"first, which is long").unwrap();
        check(&path).unwrap();
        write(&path, b"second").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"second");
        assert_eq!(names(folder.path()), ["answers.json"]);
    }

    #[test]
    fn what_cannot_be_written_is_refused_at_once() {
        let folder = tempfile::tempdir().unwrap();
        for path in [folder.path().join("missing/file.png"), folder.path().to_owned()] {
            for refused in [check(&path), write(&path, b"")] {
                assert!(matches!(refused, Err(Failure::Output { .. })), "{}", path.display());
            }
        }
        assert_eq!(names(folder.path()), [""; 0]);
    }

    #[cfg(unix)]
    #[test]
    fn links_modes_and_devices_stay_what_they_are() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (path, link) = (folder.path().join("real"), folder.path().join("link"));
        write(&path, b"old").unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o640)).unwrap();
        std::os::unix::fs::symlink(&path, &link).unwrap();
        write(&link, b"new").unwrap();
        assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        assert_eq!(std::fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
        // A new file has what the user's mask leaves, not what temporary files have
        let plain = folder.path().join("plain");
        std::fs::write(&plain, b"").unwrap();
        let other = folder.path().join("other");
        write(&other, b"").unwrap();
        let mode = |path: &Path| std::fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&other), mode(&plain));
        // A device is written as it is
        write(Path::new("/dev/null"), b"gone").unwrap();
        assert!(matches!(write(Path::new("/dev/full"), b"no"), Err(Failure::Output { .. })));
    }
}
