//! Light tables to and from files, and the table that is built in.
//!
//! A table file is an OpenEXR image of two or three layers that any EXR viewer opens:
//!
//! | layer | channels, 32-bit float | holds |
//! |---|---|---|
//! | `matrix` | `R G B A` | `q00 q02 q20 q22` of [`arealight::table`] |
//! | `magnitude` | `R G` | `albedo schlick` |
//! | `schlick_matrix` | `R G B A` | the matrix of Schlick's weight, in a table of two matrices |
//!
//! and these attributes, shared by all layers:
//!
//! | attribute | type | content |
//! |---|---|---|
//! | `arealight.format` | string | `arealight-table` |
//! | `arealight.version` | int | 2; files of version 1 have neither a third layer nor a hash |
//! | `arealight.axes` | string | what a texel's column and row mean |
//! | `arealight.frame` | string | the frame of the matrix |
//! | `arealight.normalisation` | string | how the matrix's entries are scaled |
//! | `arealight.brdf` | string | the BRDF that was fitted |
//! | `arealight.made_by` | string | what made the table |
//! | `arealight.hash` | string | the texels' [`hash`] |
//! | `arealight.fit_error` | string | how far the table is from its BRDF, in words; may be missing |
//!
//! A file whose axes, frame or normalisation differ would be read without complaint and shade wrongly, so
//! they are compared word by word; so is the hash. Files are treated as hostile: headers are checked before anything
//! is allocated for texels, and every refusal says what was found, where, and what was expected.

mod attributes;
mod error;
mod format;
mod open_exr;

use arealight::LightTable;
use std::fs::File;
use std::io::Read;
use std::path::Path;

pub use attributes::{AXES, FORMAT, FRAME, NORMALISATION, VERSION, hash};
pub use error::{FileError, ReadError};
pub use format::Format;

/// The largest file that is read: the largest table, uncompressed, and a header.
pub const MAX_FILE_BYTES: u64 = (arealight::table::MAX_SIZE as u64).pow(2) * 48 + (1 << 20);

static GGX: &[u8] = include_bytes!("../tables/ggx.exr");

/// The table for GGX that is built in: 64 nodes a side, two matrices, fitted by `arealight fit`.
///
/// # Panics
/// Never: a test reads the embedded file.
pub fn ggx() -> LightTable {
    read(GGX).expect("the embedded table is valid, as a test shows")
}

/// What a table file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct TableFile {
    /// The table.
    pub table: LightTable,
    /// How far the table is from its BRDF, in words, if someone measured it.
    pub fit_error: Option<String>,
}

impl TableFile {
    /// Reads a file's bytes, whose format shows in their beginning.
    ///
    /// # Errors
    /// [`ReadError`] says what is wrong and where.
    pub fn read(bytes: &[u8]) -> Result<Self, ReadError> {
        match Format::detect(bytes).ok_or(ReadError::UnknownFormat)? {
            Format::Exr => open_exr::read(bytes),
        }
    }

    /// Reads a file of at most [`MAX_FILE_BYTES`].
    ///
    /// # Errors
    /// [`FileError`] if the file cannot be read, or does not hold a table.
    pub fn load(path: &Path) -> Result<Self, FileError> {
        Ok(Self::read(&bytes_of(path)?)?)
    }

    /// The file's bytes; equal tables make equal bytes.
    ///
    /// Characters that EXR's Latin-1 lacks become `?`.
    pub fn write(&self) -> Vec<u8> {
        open_exr::write(self)
    }
}

/// Reads a table from a file's bytes.
///
/// # Errors
/// [`ReadError`] says what is wrong and where.
pub fn read(bytes: &[u8]) -> Result<LightTable, ReadError> {
    Ok(TableFile::read(bytes)?.table)
}

/// Reads a table from a file of at most [`MAX_FILE_BYTES`].
///
/// # Errors
/// [`FileError`] if the file cannot be read, or does not hold a table.
pub fn load(path: &Path) -> Result<LightTable, FileError> {
    Ok(TableFile::load(path)?.table)
}

/// A table as an OpenEXR file's bytes; equal tables make equal bytes.
///
/// Characters of the description that Latin-1 lacks become `?`, for EXR's strings hold nothing else.
pub fn write(table: &LightTable) -> Vec<u8> {
    TableFile { table: table.clone(), fit_error: None }.write()
}

/// Writes a table to an OpenEXR file.
///
/// # Errors
/// [`std::io::Error`] if the file cannot be written.
pub fn save(table: &LightTable, path: &Path) -> std::io::Result<()> {
    std::fs::write(path, write(table))
}

/// The bytes of a file that is not larger than any table.
fn bytes_of(path: &Path) -> Result<Vec<u8>, FileError> {
    let file = File::open(path)?;
    let mut bytes = Vec::new();
    // One byte more than allowed shows that there is more
    file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(FileError::TooLarge);
    }
    Ok(bytes)
}
