//! The folder that an export goes to: what is in the way there, and writing.

use super::File;
use super::manifest::{NAME, recorded, sha256};
use crate::failure::Failure;
use crate::output;
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// A folder, and what an earlier export recorded there.
pub struct Folder {
    path: PathBuf,
    /// Hashes by path.
    recorded: BTreeMap<String, String>,
}

/// What writing would do.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Plan {
    /// Files that would be replaced, and are not as an export wrote them.
    pub foreign: Vec<String>,
    /// Files of an earlier export that are no longer a part. They are left.
    pub left: Vec<String>,
}

impl Folder {
    /// Reads what an earlier export says of the folder, which need not be there.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        let manifest = read(&path.join(NAME))?;
        let recorded = manifest.as_deref().map(recorded).unwrap_or_default();
        Ok(Self { path: path.to_owned(), recorded })
    }

    /// What writing `files` would do.
    pub fn plan(&self, files: &[File]) -> Result<Plan, Failure> {
        let mut plan = Plan::default();
        for file in files {
            let Some(there) = read(&self.path.join(&file.path))? else { continue };
            // A manifest is an export's own where it can be read as one
            let own = if file.path == NAME {
                !self.recorded.is_empty()
            } else {
                self.recorded.get(&file.path) == Some(&sha256(&there))
            };
            if !own && there != file.bytes {
                plan.foreign.push(file.path.clone());
            }
        }
        let known = |path: &&String| !files.iter().any(|file| file.path == **path);
        plan.left = self.recorded.keys().filter(known).cloned().collect();
        Ok(plan)
    }

    /// Writes every file, the manifest last, and each at once: a reader never sees half of one.
    pub fn write(&self, files: &[File]) -> Result<(), Failure> {
        for file in files {
            let path = self.path.join(&file.path);
            let folder = path.parent().unwrap_or(&self.path);
            std::fs::create_dir_all(folder).map_err(|error| Failure::output(folder, error))?;
            output::write(&path, &file.bytes)?;
        }
        Ok(())
    }
}

/// The bytes of a file; `None` where there is none.
fn read(path: &Path) -> Result<Option<Vec<u8>>, Failure> {
    match std::fs::read(path) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => Err(Failure::output(path, error)),
    }
}
