//! The record beside the SPIR-V files of what they were made from.

use crate::TaskError;
use crate::compile::Compiled;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// `manifest.json`.
#[derive(Debug, Default, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// By kernel.
    pub kernels: BTreeMap<String, Entry>,
}

/// How a SPIR-V file was made.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Entry {
    /// Of the options and of every source file's path and text, in the order of the paths.
    pub source_sha256: String,
    /// Of the SPIR-V file.
    pub spirv_sha256: String,
    /// The generator that the SPIR-V file's header names.
    pub compiler: String,
}

impl Manifest {
    /// Where it is, among the modules of `folder`.
    pub fn path(folder: &Path) -> PathBuf {
        folder.join("manifest.json")
    }

    /// Reads it; empty where there is none yet.
    pub fn read(folder: &Path) -> Result<Self, TaskError> {
        let path = Self::path(folder);
        match std::fs::read(&path) {
            Ok(bytes) => {
                serde_json::from_slice(&bytes).map_err(|source| TaskError::Manifest { path, source })
            }
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(Self::default()),
            Err(source) => Err(TaskError::File { path, source }),
        }
    }

    /// Its text, as in the file.
    pub fn to_text(&self) -> String {
        // A map of strings always serialises.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}

impl Entry {
    /// What was just compiled.
    pub fn of(compiled: &Compiled) -> Self {
        Self {
            source_sha256: source_hash(&compiled.options, &compiled.sources),
            spirv_sha256: hash(&compiled.spirv),
            compiler: compiler_of(&compiled.spirv),
        }
    }
}

/// The SHA-256 of bytes, in hexadecimal.
pub fn hash(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
        _ = write!(text, "{byte:02x}");
        text
    })
}

/// Hashes the options, then path and text of each source, each with its length before it.
fn source_hash(options: &str, sources: &BTreeMap<String, String>) -> String {
    let mut bytes = vec![];
    let parts = sources.iter().flat_map(|(path, text)| [path.as_str(), text.as_str()]);
    for part in std::iter::once(options).chain(parts) {
        bytes.extend((part.len() as u64).to_le_bytes());
        bytes.extend(part.as_bytes());
    }
    hash(&bytes)
}

/// The generator of a SPIR-V module: the tool's registered number and its version, from the third word.
fn compiler_of(spirv: &[u8]) -> String {
    let Some(&[a, b, c, d]) = spirv.get(8..12) else { return "unknown".to_owned() };
    let word = u32::from_le_bytes([a, b, c, d]);
    let tool = match word >> 16 {
        8 => "glslang".to_owned(),
        13 => "shaderc over glslang".to_owned(),
        number => format!("generator {number}"),
    };
    format!("{tool}, generator version {}", word & 0xffff)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sources(pairs: &[(&str, &str)]) -> BTreeMap<String, String> {
        pairs.iter().map(|&(path, text)| (path.to_owned(), text.to_owned())).collect()
    }

    #[test]
    fn the_hash_is_sha256() {
        // FIPS 180-4's example of one block.
        assert_eq!(hash(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    }

    #[test]
    fn the_source_hash_tells_apart_what_concatenation_does_not() {
        let one = source_hash("", &sources(&[("a", "bc"), ("d", "e")]));
        assert_eq!(one, source_hash("", &sources(&[("d", "e"), ("a", "bc")])), "the order is the paths'");
        assert_ne!(one, source_hash("", &sources(&[("ab", "c"), ("d", "e")])));
        assert_ne!(one, source_hash("", &sources(&[("a", "bcd"), ("", "e")])));
    }

    #[test]
    fn the_text_reads_back() {
        let entry =
            Entry { source_sha256: "1".to_owned(), spirv_sha256: "2".to_owned(), compiler: "3".to_owned() };
        let manifest = Manifest { kernels: [("shade".to_owned(), entry)].into() };
        assert_eq!(serde_json::from_str::<Manifest>(&manifest.to_text()).unwrap(), manifest);
    }
}
