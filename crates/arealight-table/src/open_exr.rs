//! Tables as OpenEXR images: names that reader and writer share.

mod canonical;
mod reader;
mod writer;

pub use reader::{read, read_image};
pub use writer::write;

/// A layer of a table file.
struct Layer {
    name: &'static str,
    /// In the order of a texel's numbers.
    channels: &'static [&'static str],
}

const MATRIX: Layer = Layer { name: "matrix", channels: &["R", "G", "B", "A"] };
const MAGNITUDE: Layer = Layer { name: "magnitude", channels: &["R", "G"] };
const SCHLICK_MATRIX: Layer = Layer { name: "schlick_matrix", channels: &["R", "G", "B", "A"] };
/// [`arealight::table::LobePairs`]'s matrices, in their order.
const PAIR_MATRICES: [Layer; 2] = [
    Layer { name: "first_matrix", channels: &["R", "G", "B", "A"] },
    Layer { name: "second_matrix", channels: &["R", "G", "B", "A"] },
];
const SECOND_SHARES: Layer = Layer { name: "second_shares", channels: &["R", "G"] };
/// The layer of an image that is not a table file.
const IMAGE: Layer = Layer { name: "image", channels: &["R", "G", "B", "A"] };
