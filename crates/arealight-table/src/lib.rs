//! Light tables to and from files.
//!
//! # Start here
//! ```
//! use arealight::LightTable;
//! use arealight::glam::DVec3;
//!
//! let table = LightTable::ggx(); // the built-in one
//! let sample = table.lookup(0.3, 0.7); // roughness, cosine of the view
//! assert!(sample.albedo > 0.9 && sample.albedo <= 1.0);
//! // Towards the light the lobe is a cosine about z, after this matrix
//! let mirror = DVec3::new(-(1.0_f64 - 0.7 * 0.7).sqrt(), 0.0, 0.7);
//! assert!((sample.inverse * mirror).normalize().z > 0.99);
//!
//! let bytes = arealight_table::write(&table); // OpenEXR; also KTX2, DDS and C
//! assert_eq!(arealight_table::read(&bytes)?, table);
//! # Ok::<(), arealight_table::ReadError>(())
//! ```
//!
//! # Files
//! A table file is an OpenEXR image of two to six layers that any EXR viewer opens:
//!
//! | layer | channels, 32-bit float | holds |
//! |---|---|---|
//! | `matrix` | `R G B A` | `q00 q02 q20 q22` of [`arealight::table`] |
//! | `magnitude` | `R G` | `albedo schlick`, with the grazing dip added |
//! | `schlick_matrix` | `R G B A` | the matrix of Schlick's weight, in a table of two matrices |
//! | `first_matrix`, `second_matrix` | `R G B A` | those of two lobes for one ([`arealight::table::LobePairs`]) |
//! | `second_shares` | `R G` | the second lobe's share of the energy at a reflectance of 1 and of [`arealight::table::DIELECTRIC_F0`] |
//!
//! and these attributes, shared by all layers:
//!
//! | attribute | type | content |
//! |---|---|---|
//! | `arealight.format` | string | `arealight-table` |
//! | `arealight.version` | int | 4; files of version 3 have no pairs, those of version 2 no grazing dip, those of version 1 neither third layer nor hash |
//! | `arealight.axes` | string | what a texel's column and row mean |
//! | `arealight.frame` | string | the frame of the matrix |
//! | `arealight.normalisation` | string | how the matrix's entries are scaled |
//! | `arealight.brdf` | string | the BRDF that was fitted |
//! | `arealight.made_by` | string | what made the table |
//! | `arealight.grazing_dip` | string | what is added to the magnitudes at each node: `none`, or `ggx` for [`arealight::table::ggx_grazing_dip`] |
//! | `arealight.hash` | string | the texels' [`hash`] |
//! | `arealight.fit_error` | string | how far the table is from its BRDF, in words; may be missing |
//!
//! Engines take the same table as KTX2 or DDS, a 2D array of six layers in 16 or 32-bit floats
//! ([`arealight::LightTable::texels`]) with these attributes as key/value data and `arealight.matrices`, 1 or
//! 2, and 2 more with pairs; in DDS they follow the texels. C takes it as source text. In all of
//! these, the magnitudes' third channel says how much of GGX's grazing dip was added, 1 or 0, so that the
//! shader needs no attribute. [`read_published`] reads tables in the convention of Heitz et al. 2016. A
//! file's format is told by its content.
//!
//! A file whose axes, frame or normalisation differ would be read without complaint and shade wrongly, so
//! they are compared word by word; so is the hash. Files are treated as hostile: headers are checked before
//! anything is allocated for texels, and every refusal says what was found, where, and what was expected.

#![forbid(unsafe_code)]

mod attributes;
mod convert;
mod dds;
mod error;
mod format;
mod ktx;
mod open_exr;
mod published;
mod source;
mod texture;

use arealight::LightTable;
use std::fs::File;
use std::io::Read;
use std::path::Path;

pub use attributes::{AXES, FORMAT, FRAME, NORMALISATION, VERSION, hash};
pub use convert::{resampled, rounded};
pub use error::{FileError, ReadError, SaveError, WriteError};
pub use format::{Format, Precision, Target};
pub use published::{Adjusted, Published, PublishedError, load_published, read_published};

/// The largest file that is read: the largest table, uncompressed, and a header.
pub const MAX_FILE_BYTES: u64 = (arealight::table::MAX_SIZE as u64).pow(2) * 96 + (1 << 20);

/// The built-in table, [`LightTable::ggx`], with its measured error.
pub fn ggx_file() -> TableFile {
    let fit_error = include_str!("../tables/ggx-fit-error.txt").trim_end();
    TableFile { table: LightTable::ggx(), fit_error: Some(fit_error.into()) }
}

/// The contents of a table file.
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
            Format::Ktx2 => ktx::read(bytes)?.table(),
            Format::Dds => dds::read(bytes)?.table(),
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
    /// Characters of attributes that the format lacks (EXR: those beyond Latin-1) become `?`.
    ///
    /// # Errors
    /// [`WriteError`] if the table is too large for the target, or its numbers are for the precision.
    pub fn write(&self, target: Target) -> Result<Vec<u8>, WriteError> {
        // Round first: the hash is of the numbers in the file
        let table = rounded(&self.table, target.precision())?;
        let file = Self { table, fit_error: self.fit_error.clone() };
        let attributes = texture::encode_key_values(&file, &[]).len();
        if attributes > texture::MAX_KEY_VALUE_BYTES / 2 {
            return Err(WriteError::Attributes { bytes: attributes });
        }
        Ok(match target {
            Target::Exr => open_exr::write(&file),
            Target::Ktx2(precision) => ktx::write(&file, precision),
            Target::Dds(precision) => dds::write(&file, precision),
            Target::CHeader(precision) => source::c_header(&file, precision).into_bytes(),
            Target::Raw => file.table.numbers().iter().flat_map(|number| number.to_le_bytes()).collect(),
        })
    }

    /// Writes a file, of the format that its extension stands for, see [`Target::of_path`].
    ///
    /// # Errors
    /// [`SaveError`] if the path does not say what to write, or the file cannot be written.
    pub fn save(&self, path: &Path, precision: Option<Precision>) -> Result<(), SaveError> {
        let bytes = self.write(Target::of_path(path, precision)?)?;
        Ok(std::fs::write(path, bytes)?)
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
    open_exr::write(&TableFile { table: table.clone(), fit_error: None })
}

/// Writes a table to a file, of the format that its extension stands for, see [`Target::of_path`].
///
/// # Errors
/// [`SaveError`] if the path does not say what to write, or the file cannot be written.
pub fn save(table: &LightTable, path: &Path) -> Result<(), SaveError> {
    TableFile { table: table.clone(), fit_error: None }.save(path, None)
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
