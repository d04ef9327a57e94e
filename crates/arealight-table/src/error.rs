//! Why a file is no table.

use arealight::TableError;
use arealight::table::MAX_SIZE;

/// Why bytes do not hold a table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file does not begin as an OpenEXR file does.
    #[error("not an OpenEXR file; a light table is one, written by `arealight fit`")]
    NotExr,
    /// The OpenEXR reader refuses the file: it is damaged, cut short, or uses what the reader does not know.
    #[error("{part}: damaged or unsupported OpenEXR data: {reason}")]
    Damaged {
        /// The header, or the texels.
        part: &'static str,
        /// The reader's own words.
        reason: String,
    },
    /// An attribute is missing: the file is some other image.
    #[error("attribute `{attribute}` is missing; a light table has it (is this another image?)")]
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
         only `schlick matrix`"
    )]
    MissingLayer {
        /// The layer.
        layer: &'static str,
    },
    /// There are more layers than a table has.
    #[error("{count} layers; a light table has two or three")]
    LayerCount {
        /// How many there are.
        count: usize,
    },
    /// A layer has other channels than it should.
    #[error("layer `{layer}`: channels `{found}`; expected `{expected}`, 32-bit float, not subsampled")]
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
        "layer `{layer}`: {width} x {height} texels; tables are square, 2 to {MAX_SIZE} a side, all layers alike"
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
