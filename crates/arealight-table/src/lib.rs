//! Light tables to and from files, and the table that is built in.
//!
//! A table file is an OpenEXR image of two or three layers that any EXR viewer opens:
//!
//! | layer | channels, 32-bit float | holds |
//! |---|---|---|
//! | `matrix` | `R G B A` | `q00 q02 q20 q22` of [`arealight::table`] |
//! | `magnitude` | `R G` | `albedo schlick` |
//! | `schlick matrix` | `R G B A` | the same as in `matrix` for the lobe of Schlick's weight; a table of one matrix does without |
//!
//! and these attributes, shared by all layers:
//!
//! | attribute | type | content |
//! |---|---|---|
//! | `arealight.format` | string | `arealight-table` |
//! | `arealight.version` | int | 1 |
//! | `arealight.axes` | string | what a texel's column and row mean |
//! | `arealight.frame` | string | the frame of the matrix |
//! | `arealight.normalisation` | string | how the matrix's entries are scaled |
//! | `arealight.brdf` | string | the BRDF that was fitted |
//! | `arealight.made_by` | string | what made the table |
//!
//! A file whose axes, frame or normalisation differ would be read without complaint and shade wrongly, so
//! they are compared word by word. Files are treated as hostile: headers are checked before anything is
//! allocated for texels, and every refusal says what was found, where, and what was expected.

mod error;
mod open_exr;

use arealight::LightTable;
use std::fs::File;
use std::io::Read;
use std::path::Path;

pub use error::{FileError, ReadError};
pub use open_exr::{AXES, FORMAT, FRAME, NORMALISATION, VERSION};

/// The largest file that is read: the largest table, uncompressed, and a header.
pub const MAX_FILE_BYTES: u64 = (arealight::table::MAX_SIZE as u64).pow(2) * 40 + (1 << 20);

static GGX: &[u8] = include_bytes!("../tables/ggx.exr");

/// The table for GGX that is built in: 64 nodes a side, fitted by `arealight fit`.
///
/// # Panics
/// Never: a test reads the embedded file.
pub fn ggx() -> LightTable {
    read(GGX).expect("the embedded table is valid, as a test shows")
}

/// Reads a table from a file's bytes.
///
/// # Errors
/// [`ReadError`] says what is wrong and where.
pub fn read(bytes: &[u8]) -> Result<LightTable, ReadError> {
    open_exr::read(bytes)
}

/// Reads a table from a file of at most [`MAX_FILE_BYTES`].
///
/// # Errors
/// [`FileError`] if the file cannot be read, or does not hold a table.
pub fn load(path: &Path) -> Result<LightTable, FileError> {
    let file = File::open(path)?;
    let mut bytes = Vec::new();
    // One byte more than allowed shows that there is more
    file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(FileError::TooLarge);
    }
    Ok(read(&bytes)?)
}

/// A table as a file's bytes; equal tables make equal bytes.
///
/// Characters of the description that Latin-1 lacks become `?`, for EXR's strings hold nothing else.
pub fn write(table: &LightTable) -> Vec<u8> {
    open_exr::write(table)
}

/// Writes a table to a file.
///
/// # Errors
/// [`std::io::Error`] if the file cannot be written.
pub fn save(table: &LightTable, path: &Path) -> std::io::Result<()> {
    std::fs::write(path, write(table))
}
