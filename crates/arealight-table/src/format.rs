//! The formats of table files.

/// A format of table files that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// OpenEXR: our own format.
    Exr,
}

impl Format {
    /// The format of a file, by its first bytes.
    pub fn detect(bytes: &[u8]) -> Option<Self> {
        bytes.starts_with(&exr::meta::magic_number::BYTES).then_some(Self::Exr)
    }
}

impl std::fmt::Display for Format {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(match self {
            Self::Exr => "OpenEXR",
        })
    }
}
