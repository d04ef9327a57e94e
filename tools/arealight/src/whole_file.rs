//! Files that are whole or not there, however a program ends.

use std::collections::hash_map::RandomState;
use std::fs::{File, OpenOptions};
use std::hash::BuildHasher;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Names of files on their way, where they need one.
const NAMES: (&str, &str) = (".arealight-", ".new");

/// How old such a file is that nobody writes any more: it is written at once.
const STALE: Duration = Duration::from_secs(600);

/// A file on its way to `path`. On Linux it has no name until it is whole, so that nothing is left of it
/// where the program is killed; where that cannot be, one that is removed.
pub struct WholeFile {
    file: File,
    name: Option<PathBuf>,
    folder: PathBuf,
    path: PathBuf,
}

impl WholeFile {
    /// Begins one, and takes away what programs left in its folder that were killed. A file that is replaced
    /// keeps its permissions.
    pub fn begin(path: PathBuf) -> io::Result<Self> {
        let there = std::fs::metadata(&path).ok();
        if there.is_some() {
            // A file that may not be written is not replaced, although its folder would allow it
            OpenOptions::new().append(true).open(&path)?;
        }
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let folder = folder.unwrap_or(Path::new(".")).to_owned();
        sweep(&folder);
        let (file, name) = if let Ok(file) = nameless(&folder) {
            (file, None)
        } else {
            let name = fresh(&folder);
            (OpenOptions::new().write(true).create_new(true).open(&name)?, Some(name))
        };
        if let Some(there) = there {
            file.set_permissions(there.permissions())?;
        }
        Ok(Self { file, name, folder, path })
    }

    /// Writes all of it.
    pub fn write(mut self, bytes: &[u8]) -> io::Result<()> {
        self.file.write_all(bytes)?;
        self.file.sync_all()?;
        let name = if let Some(name) = self.name.clone() {
            name
        } else {
            let name = fresh(&self.folder);
            link(&self.file, &name)?;
            self.name.insert(name).clone()
        };
        std::fs::rename(name, &self.path)?;
        self.name = None;
        Ok(())
    }
}

impl Drop for WholeFile {
    fn drop(&mut self) {
        if let Some(name) = &self.name {
            let _ = std::fs::remove_file(name);
        }
    }
}

/// A name that no file in `folder` has.
fn fresh(folder: &Path) -> PathBuf {
    let (start, end) = NAMES;
    folder.join(format!("{start}{:016x}{end}", RandomState::new().hash_one(std::process::id())))
}

fn sweep(folder: &Path) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let is_ours = name.to_str().is_some_and(|name| name.starts_with(NAMES.0) && name.ends_with(NAMES.1));
        let age = || entry.metadata().ok()?.modified().ok()?.elapsed().ok();
        if is_ours && age().is_some_and(|age| age > STALE) {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// Where an open file can be found, to give it a name.
#[cfg(target_os = "linux")]
const OPEN_FILES: &str = "/proc/self/fd";

#[cfg(target_os = "linux")]
fn nameless(folder: &Path) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt;
    std::fs::metadata(OPEN_FILES)?;
    let flags = rustix::fs::OFlags::TMPFILE.bits().cast_signed();
    OpenOptions::new().write(true).custom_flags(flags).mode(0o666).open(folder)
}

#[cfg(target_os = "linux")]
fn link(file: &File, name: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD, linkat};
    use std::os::fd::AsRawFd;
    let open = format!("{OPEN_FILES}/{}", file.as_raw_fd());
    Ok(linkat(CWD, open, CWD, name, AtFlags::SYMLINK_FOLLOW)?)
}

#[cfg(not(target_os = "linux"))]
fn nameless(_: &Path) -> io::Result<File> {
    Err(io::ErrorKind::Unsupported.into())
}

#[cfg(not(target_os = "linux"))]
fn link(_: &File, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::SystemTime;

    #[test]
    fn what_killed_programs_left_is_swept_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str, age: u64| {
            let file = File::create(folder.path().join(name)).unwrap();
            file.set_modified(SystemTime::now() - Duration::from_secs(age)).unwrap();
        };
        file(".arealight-0123.new", 700);
        file(".arealight-4567.new", 60);
        file("arealight.new", 700);
        WholeFile::begin(folder.path().join("a")).unwrap().write(b"new").unwrap();
        let entries = std::fs::read_dir(folder.path()).unwrap();
        let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        assert_eq!(names, [".arealight-4567.new", "a", "arealight.new"]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn what_is_on_its_way_has_no_name() {
        let folder = tempfile::tempdir().unwrap();
        let begun = WholeFile::begin(folder.path().join("a")).unwrap();
        // A file system that has no such files gives it one, which goes with it
        let names = || std::fs::read_dir(folder.path()).unwrap().count();
        assert_eq!(names(), usize::from(begun.name.is_some()));
        drop(begun);
        assert_eq!(names(), 0);
    }
}
