//! Tables in the convention of Heitz et al. 2016, as their code writes them and many engines have them.
//!
//! Two images of n x n texels, four channels each, roughness along x, `sqrt(1 - cos theta_view)` along y:
//! ```text
//!           | x  0  z |
//! M^-1  =   | 0  1  0 |   first image (x, y, z, w);   second image (integral f cos, Schlick's part, 0, -)
//!           | y  0  w |
//! ```
//! with alpha = roughness², at least 1e-5, and M⁻¹ in the surface frame. (The last channel, a sphere's form
//! factor behind the horizon, is not used: polygons are clipped.) Tables of older code with an angle for y,
//! or with M⁻¹ transposed, cannot be told from these.

use arealight::table::mirror_frame;
use arealight::{LightTable, TableDescription, TableError};
use std::path::Path;

use crate::{FileError, Format, ReadError, bytes_of, dds, ktx, open_exr};

/// The smallest alpha of the convention.
const MIN_ALPHA: f64 = 1e-5;

/// How far a magnitude may be outside of what a table holds; farther out it is another quantity.
const TOLERANCE: f32 = 0.02;

/// A table that was read in the convention of Heitz et al. 2016.
#[derive(Debug, Clone, PartialEq)]
pub struct Published {
    /// The table, in our convention, of one matrix. At its nodes the lobes are the same but for rounding.
    pub table: LightTable,
    /// What was not taken as it is.
    pub adjusted: Vec<Adjusted>,
}

/// A texel that was not taken as it is.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Adjusted {
    /// A magnitude a little outside of 0 <= Schlick's part <= albedo <= 1, by noise or rounding, was brought
    /// in.
    Magnitude {
        /// The texel's column (roughness).
        x: u32,
        /// The texel's row (view angle).
        y: u32,
        /// The albedo and Schlick's part in the image.
        found: [f32; 2],
        /// Those of the table.
        used: [f32; 2],
    },
    /// A matrix of the first column has entries too small for 16-bit floats and became singular. In its place
    /// stands the second column's, in the mirror frame, where the two differ little.
    Matrix {
        /// The texel's row (view angle).
        y: u32,
        /// The entries in the image.
        found: [f32; 4],
    },
}

/// Why two images make no table.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PublishedError {
    /// The image of matrices cannot be read.
    #[error("the image of matrices: {0}")]
    Matrix(FileError),
    /// The image of magnitudes cannot be read.
    #[error("the image of magnitudes: {0}")]
    Magnitude(FileError),
    /// The images differ in size.
    #[error(
        "{matrix} texels a side in the image of matrices, {magnitude} in that of magnitudes; must be the same"
    )]
    Sizes {
        /// Texels a side of the first.
        matrix: u32,
        /// Texels a side of the second.
        magnitude: u32,
    },
    /// The texels make no table.
    #[error("{0} (are these images of another convention?)")]
    Table(#[from] TableError),
}

/// Reads a table in the convention of Heitz et al. 2016 from its two images: DDS (as from their code), KTX2
/// or OpenEXR, four channels of 16 or 32-bit floats. `brdf` is what was fitted, which the images do not say.
///
/// # Errors
/// [`PublishedError`] says which image is wrong, where and why.
pub fn read_published(matrix: &[u8], magnitude: &[u8], brdf: &str) -> Result<Published, PublishedError> {
    let (size, matrices) = read_image(matrix).map_err(|error| PublishedError::Matrix(error.into()))?;
    let (other_size, magnitudes) =
        read_image(magnitude).map_err(|error| PublishedError::Magnitude(error.into()))?;
    if size != other_size {
        return Err(PublishedError::Sizes { matrix: size, magnitude: other_size });
    }
    convert(size, &matrices, &magnitudes, brdf)
}

/// [`read_published`] from two files.
///
/// # Errors
/// [`PublishedError`] says which file is wrong, where and why.
pub fn load_published(matrix: &Path, magnitude: &Path, brdf: &str) -> Result<Published, PublishedError> {
    let matrix = bytes_of(matrix).map_err(PublishedError::Matrix)?;
    let magnitude = bytes_of(magnitude).map_err(PublishedError::Magnitude)?;
    read_published(&matrix, &magnitude, brdf)
}

/// An image of one layer and four channels, and its texels a side.
fn read_image(file: &[u8]) -> Result<(u32, Vec<[f32; 4]>), ReadError> {
    let texture = match Format::detect(file).ok_or(ReadError::UnknownFormat)? {
        Format::Exr => return open_exr::read_image(file),
        Format::Ktx2 => ktx::read(file)?,
        Format::Dds => dds::read(file)?,
    };
    if texture.layers != 1 {
        return Err(ReadError::LayerCount { count: texture.layers as usize, expected: &[1] });
    }
    Ok((texture.size, texture.layer(0)))
}

fn convert(
    size: u32,
    matrices: &[[f32; 4]],
    magnitudes: &[[f32; 4]],
    brdf: &str,
) -> Result<Published, PublishedError> {
    let nodes = (0..size * size).map(|i| (i % size, i / size));
    let mut adjusted = Vec::new();
    let mut magnitude = Vec::with_capacity(magnitudes.len());
    for ((x, y), &[albedo, schlick, ..]) in nodes.clone().zip(magnitudes) {
        let found = [albedo, schlick];
        let used_albedo = brought_in(albedo, 1.0);
        let used = [used_albedo, brought_in(schlick, used_albedo)];
        // A NaN differs from itself, and is refused below
        if used != found && used.iter().all(|number| number.is_finite()) {
            adjusted.push(Adjusted::Magnitude { x, y, found, used });
        }
        magnitude.push(used);
    }
    let to_mirror_frame = |((x, y), &texel)| {
        let (roughness, cos_view) = LightTable::node(size, x, y);
        to_mirror_frame(texel, (roughness * roughness).max(MIN_ALPHA), cos_view)
    };
    let mut matrix: Vec<[f32; 4]> = nodes.zip(matrices).map(to_mirror_frame).collect();
    for y in 0..size {
        let first = (y * size) as usize;
        let [q00, q02, q20, q22] = matrix[first];
        if q00 * q22 - q02 * q20 == 0.0 {
            matrix[first] = matrix[first + 1];
            adjusted.push(Adjusted::Matrix { y, found: matrices[first] });
        }
    }
    let description = TableDescription {
        brdf: brdf.to_owned(),
        made_by: "converted from two images in the convention of Heitz et al. 2016".to_owned(),
        ggx_dip: false,
    };
    Ok(Published { table: LightTable::new(description, size, matrix, magnitude)?, adjusted })
}

/// A number that is a little outside of 0 to `most`, brought in; any other number as it is.
fn brought_in(number: f32, most: f32) -> f32 {
    let is_near = (-TOLERANCE..=most + TOLERANCE).contains(&number);
    if is_near { number.max(0.0).min(most) } else { number }
}

/// A texel of [`arealight::table`] for M⁻¹ of the surface frame.
fn to_mirror_frame([x, y, z, w]: [f32; 4], alpha: f64, cos_view: f64) -> [f32; 4] {
    let [x, y, z, w] = [x, y, z, w].map(f64::from);
    let frame = mirror_frame(cos_view);
    let (across, mirror) = (frame.x_axis, frame.z_axis);
    [
        x * across.x + z * across.z,
        x * mirror.x + z * mirror.z,
        (y * across.x + w * across.z) / alpha,
        (y * mirror.x + w * mirror.z) / alpha,
    ]
    .map(|entry| entry as f32)
}
