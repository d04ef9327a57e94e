//! Files that are whole or not there, however a program ends.

use std::fs::OpenOptions;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;
use tempfile::{Builder, NamedTempFile};

/// Names of files on their way.
const NAMES: (&str, &str) = (".arealight-", ".new");

/// How old such a file is that nobody writes any more: it is written at once.
const STALE: Duration = Duration::from_secs(600);

/// A file on its way to `path`, of another name until it is whole.
pub struct WholeFile {
    file: NamedTempFile,
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
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        sweep(folder);
        let mut builder = Builder::new();
        builder.prefix(NAMES.0).suffix(NAMES.1);
        // What the user's mask leaves, not what temporary files have
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        // Without the name, which is none of the user's
        let file = builder.tempfile_in(folder).map_err(|error| io::Error::from(error.kind()))?;
        if let Some(there) = there {
            file.as_file().set_permissions(there.permissions())?;
        }
        Ok(Self { file, path })
    }

    /// Writes all of it.
    pub fn write(mut self, bytes: &[u8]) -> io::Result<()> {
        self.file.write_all(bytes)?;
        self.file.as_file().sync_all()?;
        self.file.persist(&self.path)?;
        Ok(())
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::File;
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
}
