//! The formats of table files.

use crate::WriteError;
use std::path::Path;

/// A format of table files that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// OpenEXR: our own format.
    Exr,
    /// Khronos texture, version 2: for engines.
    Ktx2,
    /// `DirectDraw` surface: for engines.
    Dds,
}

impl Format {
    /// The format of a file, by its first bytes; a name says nothing.
    pub fn detect(bytes: &[u8]) -> Option<Self> {
        let starts: [(&[u8], Self); 3] =
            [(&exr::meta::magic_number::BYTES, Self::Exr), (&ktx2::MAGIC, Self::Ktx2), (b"DDS ", Self::Dds)];
        starts.into_iter().find(|(magic, _)| bytes.starts_with(magic)).map(|(_, format)| format)
    }
}

impl std::fmt::Display for Format {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(match self {
            Self::Exr => "OpenEXR",
            Self::Ktx2 => "KTX2",
            Self::Dds => "DDS",
        })
    }
}

/// The numbers that texels are stored in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Precision {
    /// 16-bit floats: their rounding costs less than the fit's error by far, see the project's page on the
    /// fit.
    #[default]
    Half,
    /// 32-bit floats.
    Single,
}

impl Precision {
    /// Bytes of a texel of four channels.
    pub fn texel_bytes(self) -> usize {
        match self {
            Self::Half => 8,
            Self::Single => 16,
        }
    }
}

/// A table's file format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Target {
    /// OpenEXR, 32-bit floats: our own format.
    Exr,
    /// A 2D array of [`arealight::table::LAYERS`] layers.
    Ktx2(Precision),
    /// A 2D array of [`arealight::table::LAYERS`] layers, with the header of Direct3D 10.
    Dds(Precision),
    /// A C array of as many layers.
    CHeader(Precision),
    /// [`arealight::LightTable::numbers`] as little-endian 32-bit floats and nothing else: what the built-in
    /// table is embedded as.
    Raw,
}

impl Target {
    /// The format of a path's extension: `exr`, `ktx2`, `dds`, `h` or `f32`. Without a precision, EXR
    /// is written in 32-bit floats, and everything else in 16-bit ones.
    ///
    /// # Errors
    /// [`WriteError::Extension`] for another one, [`WriteError::Precision`] where the format has no choice.
    pub fn of_path(path: &Path, precision: Option<Precision>) -> Result<Self, WriteError> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        let chosen = precision.unwrap_or_default();
        match (extension.as_str(), precision) {
            ("exr", None | Some(Precision::Single)) => Ok(Self::Exr),
            ("exr", Some(Precision::Half)) => Err(WriteError::Precision { format: "OpenEXR", bits: 32 }),
            ("ktx2", _) => Ok(Self::Ktx2(chosen)),
            ("dds", _) => Ok(Self::Dds(chosen)),
            ("h", _) => Ok(Self::CHeader(chosen)),
            ("f32", None | Some(Precision::Single)) => Ok(Self::Raw),
            ("f32", Some(Precision::Half)) => Err(WriteError::Precision { format: "raw", bits: 32 }),
            _ => Err(WriteError::Extension { extension }),
        }
    }

    /// The precision that texels are rounded to.
    pub fn precision(self) -> Precision {
        match self {
            Self::Exr | Self::Raw => Precision::Single,
            Self::Ktx2(precision) | Self::Dds(precision) | Self::CHeader(precision) => precision,
        }
    }
}
