//! Tables as OpenEXR images: names and values that reader and writer share.

mod canonical;
mod reader;
mod writer;

pub use reader::read;
pub use writer::write;

/// The attribute `arealight.format`.
pub const FORMAT: &str = "arealight-table";
/// The attribute `arealight.version`: the version of the format that is written, and the only one read.
pub const VERSION: i32 = 1;
/// The attribute `arealight.axes`.
pub const AXES: &str =
    "x: roughness = x / (size - 1), alpha = roughness^2; y: sqrt(1 - cos theta_view) = y / (size - 1)";
/// The attribute `arealight.frame`.
pub const FRAME: &str = "inverse matrix; rows in cosine space; columns (cos t, 0, sin t), (0, 1, 0), (-sin t, 0, cos t) \
    in the surface frame, for a view (sin t, 0, cos t)";
/// The attribute `arealight.normalisation`.
pub const NORMALISATION: &str = "R G B A = q00 q02 q20 q22 of [q00 0 q02; 0 1 0; alpha*q20 0 alpha*q22]; \
    magnitude R G = integral f cos, integral f cos (1 - cos theta_vh)^5";

mod attribute {
    pub const FORMAT: &str = "arealight.format";
    pub const VERSION: &str = "arealight.version";
    pub const AXES: &str = "arealight.axes";
    pub const FRAME: &str = "arealight.frame";
    pub const NORMALISATION: &str = "arealight.normalisation";
    pub const BRDF: &str = "arealight.brdf";
    pub const MADE_BY: &str = "arealight.made_by";
}

/// A layer of a table file.
struct Layer {
    name: &'static str,
    /// In the order of a texel's numbers.
    channels: &'static [&'static str],
}

const MATRIX: Layer = Layer { name: "matrix", channels: &["R", "G", "B", "A"] };
const MAGNITUDE: Layer = Layer { name: "magnitude", channels: &["R", "G"] };
/// Of a table of two matrices.
const SCHLICK_MATRIX: Layer = Layer { name: "schlick matrix", channels: &["R", "G", "B", "A"] };
