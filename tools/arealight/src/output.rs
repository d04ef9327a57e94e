//! What commands write: standard output, which may be a pipe that closes early, and files, which are whole or
//! not there.

use crate::failure::Failure;
use crate::whole_file::WholeFile;
use arealight_scene::{Scene, Warning};
use std::borrow::Cow;
use std::fmt::Write as _;
use std::fs::OpenOptions;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;

/// The most characters of a word that are shown, unless it may be a path; and of a line.
const LONGEST: (usize, usize) = (100, 4000);

/// A text as a terminal and a log may have it: names of foreign files turn no colours on, move no cursor and
/// fill no screen. Control characters, and those that turn the direction of writing, are escaped as JSON has
/// them, which stays what it is.
pub fn shown(text: &str) -> Cow<'_, str> {
    let is_bad = |c: char| {
        (c.is_control() && c != '\n' && c != '\t')
            || matches!(c, '\u{200e}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    if !text.contains(is_bad) {
        return text.into();
    }
    let mut made = String::with_capacity(text.len());
    for c in text.chars() {
        let _ = if is_bad(c) { write!(made, "\\u{:04x}", u32::from(c)) } else { write!(made, "{c}") };
    }
    made.into()
}

/// A text of foreign names without what has no end: the beginnings of its words, but of paths, and of its
/// lines.
pub fn brief(text: &str) -> String {
    let cut = |text: &str, most: usize| match text.char_indices().nth(most) {
        Some((end, _)) => format!("{}... ({} bytes)", &text[..end], text.len()),
        None => text.to_owned(),
    };
    let word = |word: &str| if word.contains('/') { word.to_owned() } else { cut(word, LONGEST.0) };
    let line = |line: &str| cut(&line.split(' ').map(word).collect::<Vec<_>>().join(" "), LONGEST.1);
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}

/// Says something [`brief`] to standard error, as [`shown`].
pub fn say(text: &str) {
    // What nobody can read is no reason to end
    let _ = writeln!(io::stderr(), "{}", shown(&brief(text)));
}

/// Says that a file was written.
pub fn say_wrote(path: &Path) {
    say(&format!("wrote {}", path.display()));
}

/// Prints `text`, as [`shown`], to standard output.
pub fn print(text: &str) -> Result<ExitCode, Failure> {
    print_styled(&shown(text))
}

/// Prints our own `text` to standard output, with what colours it. A reader that has seen enough, such as
/// `head`, is no failure.
///
/// # Errors
/// [`Failure::Output`] if standard output cannot be written for another reason, such as a full disk.
pub fn print_styled(text: &str) -> Result<ExitCode, Failure> {
    to_stdout(text.as_bytes()).map_err(|error| Failure::output("standard output", error))?;
    Ok(ExitCode::SUCCESS)
}

fn to_stdout(bytes: &[u8]) -> io::Result<()> {
    let mut out = io::stdout().lock();
    let written = out.write_all(bytes).and_then(|()| out.flush());
    written.or_else(|error| if error.kind() == io::ErrorKind::BrokenPipe { Ok(()) } else { Err(error) })
}

/// Prints to standard error what a scene's picture lacks, and what is not shown word for word: the file once,
/// then a line for each kind.
pub fn say_what_is_not_shown(scene: &Scene, path: &Path) {
    for (word, said) in [("warning", &scene.warnings), ("note", &scene.notes)] {
        match &Warning::grouped(said)[..] {
            [] => {}
            [line] => say(&format!("{word}: {}: {line}", path.display())),
            lines => say(&format!("{word}: {}:\n    {}", path.display(), lines.join("\n    "))),
        }
    }
}

/// The files that are read.
static READ: Mutex<Vec<PathBuf>> = Mutex::new(vec![]);

/// Sees to it that nothing is written in the place of a file, which is read.
pub fn keep(path: &Path) {
    if let (Ok(path), Ok(mut read)) = (path.canonicalize(), READ.lock()) {
        read.push(path);
    }
}

/// Sees to it that a file can be written, before long work, and is none of those that are read. What is there
/// stays as it is, and nothing new is left behind. A pipe or device is not touched.
pub fn check(path: &Path) -> Result<(), Failure> {
    Output::open(path).map(drop)
}

/// What stands for standard input and output among paths.
pub const STREAM: &str = "-";

/// Whether a path stands for a standard stream.
pub fn is_stream(path: &Path) -> bool {
    path == Path::new(STREAM)
}

/// Says what was done: on standard output, or on standard error where the work's own output, at `path`, goes
/// to standard output.
pub fn say_beside(path: Option<&Path>, text: &str) -> Result<ExitCode, Failure> {
    if path.is_some_and(is_stream) {
        say(text);
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
    Output::open(path)?.write(bytes).map_err(|error| Failure::output(path, error))
}

/// Where bytes go.
enum Output {
    /// A file that becomes the one at a path.
    File(WholeFile),
    /// A device or a pipe, which is not opened before there is something to write: it would end a pipe.
    There(PathBuf),
    /// Standard output.
    Stream,
}

impl Output {
    fn open(path: &Path) -> Result<Self, Failure> {
        if is_stream(path) {
            return Ok(Self::Stream);
        }
        // A link stays, and what it leads to is replaced
        let real = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        let output = match std::fs::metadata(&real) {
            Ok(there) if there.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
            Ok(there) if !there.is_file() => Ok(Self::There(real)),
            _ if READ.lock().is_ok_and(|read| read.contains(&real)) => {
                let message =
                    format!("{} is an input, which it would replace: name another file", path.display());
                return Err(Failure::Argument { argument: "output", message });
            }
            _ => WholeFile::begin(real).map(Self::File),
        };
        output.map_err(|error| Failure::output(path, error))
    }

    fn write(self, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::File(file) => file.write(bytes),
            Self::There(path) => OpenOptions::new().write(true).open(path)?.write_all(bytes),
            Self::Stream => to_stdout(bytes),
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
    fn what_is_read_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let [input, other] = ["in", "other"].map(|name| folder.path().join(name));
        write(&input, b"precious").unwrap();
        let again = folder.path().join(".").join("in");
        keep(&input);
        for refused in [check(&again), write(&again, b"")].map(Result::unwrap_err) {
            assert!(matches!(refused, Failure::Argument { .. }), "{refused}");
        }
        check(&other).unwrap();
    }

    #[test]
    fn keys_and_numbers_without_an_end_are_cut() {
        let long = "k".repeat(1000);
        assert_eq!(
            brief(&format!("a {long}\n/{long}")),
            format!("a {}... (1000 bytes)\n/{long}", &long[..100])
        );
        assert_eq!(brief(&"é ".repeat(3000)).chars().count(), 4000 + "... (9000 bytes)".len());
    }

    #[test]
    fn foreign_names_are_shown_and_do_nothing() {
        let name = "b\u{1b}]0;title\u{7}\u{202e}\r\u{9b}\n\té";
        assert_eq!(shown(name), "b\\u001b]0;title\\u0007\\u202e\\u000d\\u009b\n\té");
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
