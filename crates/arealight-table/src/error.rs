//! Why a file is refused.

use crate::Format;
use arealight::TableError;
use arealight::table::MAX_SIZE;

/// Why bytes do not hold a table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file begins as none of the formats does.
    #[error("neither OpenEXR nor KTX2 nor DDS, in which light tables are kept")]
    UnknownFormat,
    /// The file is damaged, cut short, or uses unknown features.
    #[error("{part}: damaged or unsupported {format} data: {reason}")]
    Damaged {
        /// The format by which the file begins.
        format: Format,
        /// The header, or the texels.
        part: &'static str,
        /// What is wrong with it.
        reason: String,
    },
    /// An attribute is missing: the file is some other image.
    #[error(
        "attribute `{attribute}` is missing; a light table has it (is this another image? Tables in the \
        convention of Heitz et al. 2016 are two images: convert them by `arealight table convert`)"
    )]
    MissingAttribute {
        /// The attribute.
        attribute: &'static str,
    },
    /// An attribute says that the texels mean something else than this program would read in them.
    #[error("attribute `{attribute}` is `{found}`; this program reads `{expected}`")]
    Attribute {
        /// The attribute.
        attribute: &'static str,
        /// What the file says.
        found: String,
        /// What it must say.
        expected: String,
    },
    /// A layer is missing.
    #[error(
        "layer `{layer}` is missing; a light table has the layers `matrix` and `magnitude`, and as a third \
         only `schlick_matrix`"
    )]
    MissingLayer {
        /// The layer.
        layer: &'static str,
    },
    /// There are more layers than a table has, or fewer.
    #[error("{count} layers; a light table of this version has {}", one_of(expected))]
    LayerCount {
        /// How many there are.
        count: usize,
        /// How many there may be.
        expected: &'static [usize],
    },
    /// A field of the header says something that no light table has.
    #[error("{format} header: `{field}` is {found}; expected {expected}")]
    Field {
        /// The format by which the file begins.
        format: Format,
        /// The field, by its name in the format's specification.
        field: &'static str,
        /// What the file says.
        found: String,
        /// What it must say.
        expected: &'static str,
    },
    /// A layer has other channels than it should.
    #[error("layer `{layer}`: channels `{found}`; expected `{expected}`, not subsampled")]
    Channels {
        /// The layer.
        layer: &'static str,
        /// The channels found, with their types.
        found: String,
        /// The channels expected.
        expected: &'static str,
    },
    /// A layer is not square, too large, too small, or of another size than the first.
    #[error(
        "layer `{layer}`: {width} x {height} texels; tables are square, 2 to {MAX_SIZE} a side, all layers \
        alike"
    )]
    Size {
        /// The layer.
        layer: &'static str,
        /// Its width.
        width: usize,
        /// Its height.
        height: usize,
    },
    /// A layer is stored in a way that this reader does not take.
    #[error("layer `{layer}`: {found}; a light table is stored in scan lines, uncompressed or by ZIP")]
    Storage {
        /// The layer.
        layer: &'static str,
        /// How it is stored.
        found: String,
    },
    /// Some texels are nowhere in the file.
    #[error("layer `{layer}`: the file holds {found} of {expected} scan lines")]
    Incomplete {
        /// The layer.
        layer: &'static str,
        /// Scan lines found.
        found: usize,
        /// Scan lines that the header promises.
        expected: usize,
    },
    /// The texels are not those that the file was written with.
    #[error(
        "attribute `arealight.hash` is `{expected}`, but the texels have {found}: the file is damaged, or \
        was edited"
    )]
    Hash {
        /// The texels' hash.
        found: String,
        /// What the file says.
        expected: String,
    },
    /// The texels make no table.
    #[error(transparent)]
    Table(#[from] TableError),
}

/// Why a file cannot be loaded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// The file cannot be opened or read.
    #[error(transparent)]
    File(#[from] std::io::Error),
    /// The file is larger than any table.
    #[error("more than {} bytes: larger than any light table", crate::MAX_FILE_BYTES)]
    TooLarge,
    /// The file does not hold a table.
    #[error(transparent)]
    Read(#[from] ReadError),
}

/// Why a table cannot be written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The file's name does not say what to write.
    #[error("extension `{extension}`: tables are written as .exr, .ktx2, .dds, .h (C) or .f32 (raw)")]
    Extension {
        /// What the file's name ends with.
        extension: String,
    },
    /// The format has another precision.
    #[error("{format} tables are written in {bits}-bit floats only")]
    Precision {
        /// The format.
        format: &'static str,
        /// The bits that it has.
        bits: u32,
    },
    /// The metadata is too long.
    #[error("{bytes} bytes of attributes; at most {} are read back", crate::texture::MAX_KEY_VALUE_BYTES)]
    Attributes {
        /// Their length.
        bytes: usize,
    },
    /// Rounded to 16 bits, the texels make no table.
    #[error("in 16-bit floats, {0}; write 32-bit ones")]
    Table(#[from] TableError),
}

/// Why a table cannot be saved.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SaveError {
    /// The table cannot be written as the path asks.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The file cannot be written.
    #[error(transparent)]
    File(#[from] std::io::Error),
}

/// Numbers as `2 or 3`.
fn one_of(counts: &[usize]) -> String {
    counts.iter().map(usize::to_string).collect::<Vec<_>>().join(" or ")
}
