//! The fitted table: for each roughness and view angle a linear transform of the clamped cosine, and the
//! lobe's albedo.
//!
//! # What a texel holds
//! A table is square, `size` nodes a side. Node `(x, y)` belongs to `roughness = x / (size - 1)` and to
//! `sqrt(1 - cos theta_view) = y / (size - 1)`; texels are stored row after row, `index = y * size + x`, and
//! interpolated bilinearly between nodes.
//!
//! The inverse transform takes a direction of the shading frame into cosine space. It is stored in the
//! *mirror frame*, whose axes are, for a view `(sin t, 0, cos t)` in the surface frame:
//! `x' = (cos t, 0, sin t)`, `y' = (0, 1, 0)`, `z' = (-sin t, 0, cos t)`, the mirror direction of the view.
//! There, divided by its middle entry, with the last row divided by alpha, it is smooth down to a mirror:
//! ```text
//!         |      q00   0        q02 |   | x'^T |
//! M^-1 =  |        0   1          0 | * | y'^T |        matrix texel = (q00, q02, q20, q22)
//!         | alpha q20  0  alpha q22 |   | z'^T |
//! ```
//! (In the surface frame the same entries interpolate badly at low roughness: the largest change of a form
//! factor between nodes is 0.82 there, 0.011 here, at 31² nodes.)
//!
//! The magnitude texel is `(albedo, schlick)`: the integrals over the hemisphere of `f cos` and of
//! `f cos (1 - cos theta_vh)^5`, for a BRDF `f` without Fresnel term, so that the specular albedo is
//! `f0 * albedo + (f90 - f0) * schlick`. Near the horizon these change within a width of alpha, which no grid
//! resolves. So they may be stored with that part added in closed form, [`ggx_grazing_dip`], which a lookup
//! takes away again: what is interpolated is smooth, and the albedos are within 2e-3 at every view. The
//! description says if it was added, and so does the third channel of the GPU's magnitude texel.
//!
//! # Two matrices
//! Schlick's weight changes the lobe's shape as well as its size: it takes away near the normal and leaves
//! what is grazing. A second matrix layer holds the lobe of `f cos (1 - cos theta_vh)^5`, and a material of
//! any reflectance has one lobe between the two, by their shares of its specular albedo. A table without it
//! uses the one matrix for both.
//!
//! # Pairs
//! Two transformed cosines follow a BRDF much better than one ([`crate::SpecularLobes::Two`]). [`LobePairs`]
//! holds two matrices for every reflectance, and what share of the energy the second one has at a reflectance
//! of 1 and at [`DIELECTRIC_F0`]: what a reflectance has of either lobe is linear in it, and so exact in each
//! channel of a colour.

use glam::{DMat3, DVec3};

mod built_in;
mod grazing;
mod horizons;
mod sample;

pub use horizons::LobeHorizon;

pub use grazing::ggx_grazing_dip;
pub use sample::TableSample;

/// The largest `size` that a table may have: far beyond any use, and small enough to allocate.
pub const MAX_SIZE: u32 = 1024;

/// A table's metadata.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct TableDescription {
    /// The BRDF that was fitted, for example `ggx-correlated-smith`.
    pub brdf: String,
    /// What made it, for people: program, version, settings.
    pub made_by: String,
    /// Whether [`ggx_grazing_dip`] is added to the albedos in the magnitude texels, and taken away again by a
    /// lookup. False for other BRDFs: the texels are the albedos.
    pub ggx_dip: bool,
}

impl TableDescription {
    /// What is added to `(albedo, schlick)` at a roughness and the cosine of a view. Roughness and cosine are
    /// clamped as [`LightTable::lookup`] does.
    pub fn dip(&self, roughness: f64, cos_view: f64) -> [f64; 2] {
        if self.ggx_dip {
            ggx_grazing_dip(clamped_roughness(roughness), clamped_cosine(cos_view))
        } else {
            [0.0; 2]
        }
    }

    /// How far an albedo at a node may lie outside of its range: not at all, or by twice what rounding to
    /// float16 moves a number above 1.
    fn tolerance(&self) -> f32 {
        if self.ggx_dip { 1e-3 } else { 0.0 }
    }
}

/// A fitted table, valid by construction: sizes agree, and every number is finite.
#[derive(Debug, Clone, PartialEq)]
pub struct LightTable {
    description: TableDescription,
    size: u32,
    matrix: Vec<[f32; 4]>,
    magnitude: Vec<[f32; 2]>,
    schlick_matrix: Option<Vec<[f32; 4]>>,
    pairs: Option<LobePairs>,
}

/// The reflectance at normal incidence, with F90 = 1, of the second of [`LobePairs::second_shares`].
pub const DIELECTRIC_F0: f64 = 0.02;

/// Two lobes a texel, in the place of one.
#[derive(Debug, Clone, PartialEq)]
pub struct LobePairs {
    /// The matrices of the first lobe and of the second.
    pub matrices: [Vec<[f32; 4]>; 2],
    /// The second lobe's share of the energy, in [0, 1]: at a reflectance of 1, and of [`DIELECTRIC_F0`].
    pub second_shares: Vec<[f32; 2]>,
}

/// The layers of [`LightTable::texels`].
pub const LAYERS: u32 = 6;

/// Why texels do not make a table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// The size is out of range.
    #[error("size: {size} nodes a side; a table has 2 to {MAX_SIZE}")]
    Size {
        /// The size given.
        size: u32,
    },
    /// A layer has another number of texels than its size says.
    #[error("{layer}: {count} texels, but {size} nodes a side need {}", u64::from(*size) * u64::from(*size))]
    TexelCount {
        /// The layer.
        layer: &'static str,
        /// Its number of texels.
        count: usize,
        /// The table's size.
        size: u32,
    },
    /// A texel is NaN or infinite.
    #[error("{layer}: texel ({x}, {y}) channel {channel} is {value}, not a finite number")]
    NotFinite {
        /// The layer.
        layer: &'static str,
        /// The texel's column (roughness).
        x: u32,
        /// The texel's row (view angle).
        y: u32,
        /// The channel within the texel.
        channel: usize,
        /// What it holds.
        value: f32,
    },
    /// A transform cannot be inverted.
    #[error("{layer}: texel ({x}, {y}) is singular or mirrored: determinant {determinant}, must be above 0")]
    Singular {
        /// The layer.
        layer: &'static str,
        /// The texel's column (roughness).
        x: u32,
        /// The texel's row (view angle).
        y: u32,
        /// The determinant of its two by two block.
        determinant: f32,
    },
    /// The share of a second lobe is outside [0, 1].
    #[error("second shares: texel ({x}, {y}) is {share}; must be in [0, 1]")]
    SecondShare {
        /// The texel's column (roughness).
        x: u32,
        /// The texel's row (view angle).
        y: u32,
        /// The share found.
        share: f32,
    },
    /// A magnitude, without the dip that was added to it, is outside [0, 1], where every albedo lies, or its
    /// Schlick part is above the whole.
    #[error("magnitude: texel ({x}, {y}) is ({albedo}, {schlick}); must be 0 <= Schlick part <= albedo <= 1")]
    Magnitude {
        /// The texel's column (roughness).
        x: u32,
        /// The texel's row (view angle).
        y: u32,
        /// The albedo found.
        albedo: f32,
        /// The Schlick part found.
        schlick: f32,
    },
}

impl LightTable {
    /// Makes a table of one matrix from its texels. The magnitudes hold what the description says: see
    /// [`TableDescription::ggx_dip`].
    ///
    /// # Errors
    /// [`TableError`] says which layer, texel and channel is wrong.
    pub fn new(
        description: TableDescription,
        size: u32,
        matrix: Vec<[f32; 4]>,
        magnitude: Vec<[f32; 2]>,
    ) -> Result<Self, TableError> {
        if !(2..=MAX_SIZE).contains(&size) {
            return Err(TableError::Size { size });
        }
        let count = size as usize * size as usize;
        for (layer, found) in [("matrix", matrix.len()), ("magnitude", magnitude.len())] {
            if found != count {
                return Err(TableError::TexelCount { layer, count: found, size });
            }
        }
        for (index, (m, a)) in matrix.iter().zip(&magnitude).enumerate() {
            let (x, y) = (index as u32 % size, index as u32 / size);
            finite("matrix", x, y, m)?;
            finite("magnitude", x, y, a)?;
            invertible("matrix", x, y, m)?;
            // The Schlick part is a part: with more, a surface without F90 would reflect less than nothing
            let [albedo, schlick] = without_dip(&description, size, x, y, *a);
            let tolerance = description.tolerance();
            if albedo > 1.0 + tolerance || schlick < -tolerance || schlick > albedo + tolerance {
                return Err(TableError::Magnitude { x, y, albedo, schlick });
            }
        }
        Ok(Self { description, size, matrix, magnitude, schlick_matrix: None, pairs: None })
    }

    /// This table with a second matrix: the lobe of Schlick's weight.
    ///
    /// # Errors
    /// [`TableError`] says which texel and channel is wrong.
    pub fn with_schlick_matrix(self, matrix: Vec<[f32; 4]>) -> Result<Self, TableError> {
        const LAYER: &str = "schlick matrix";
        if matrix.len() != self.matrix.len() {
            return Err(TableError::TexelCount { layer: LAYER, count: matrix.len(), size: self.size });
        }
        for (index, texel) in matrix.iter().enumerate() {
            let (x, y) = (index as u32 % self.size, index as u32 / self.size);
            finite(LAYER, x, y, texel)?;
            invertible(LAYER, x, y, texel)?;
        }
        Ok(Self { schlick_matrix: Some(matrix), ..self })
    }

    /// This table with two lobes for one, for [`crate::SpecularLobes::Two`].
    ///
    /// # Errors
    /// [`TableError`] says which layer, texel and channel is wrong.
    pub fn with_pairs(self, pairs: LobePairs) -> Result<Self, TableError> {
        let count_of = |layer: &'static str, count: usize| {
            let is_right = count == self.matrix.len();
            is_right.then_some(()).ok_or(TableError::TexelCount { layer, count, size: self.size })
        };
        for (layer, matrix) in ["first matrix", "second matrix"].into_iter().zip(&pairs.matrices) {
            count_of(layer, matrix.len())?;
            for (index, texel) in matrix.iter().enumerate() {
                let (x, y) = (index as u32 % self.size, index as u32 / self.size);
                finite(layer, x, y, texel)?;
                invertible(layer, x, y, texel)?;
            }
        }
        count_of("second shares", pairs.second_shares.len())?;
        for (index, shares) in pairs.second_shares.iter().enumerate() {
            let (x, y) = (index as u32 % self.size, index as u32 / self.size);
            finite("second shares", x, y, shares)?;
            if let Some(&share) = shares.iter().find(|share| !(0.0..=1.0).contains(*share)) {
                return Err(TableError::SecondShare { x, y, share });
            }
        }
        Ok(Self { pairs: Some(pairs), ..self })
    }

    /// What the table says of itself.
    pub fn description(&self) -> &TableDescription {
        &self.description
    }

    /// Nodes a side.
    pub fn size(&self) -> u32 {
        self.size
    }

    /// The matrix layer, `(q00, q02, q20, q22)` a texel.
    pub fn matrix(&self) -> &[[f32; 4]] {
        &self.matrix
    }

    /// The matrix layer of Schlick's weight, if there is one.
    pub fn schlick_matrix(&self) -> Option<&[[f32; 4]]> {
        self.schlick_matrix.as_deref()
    }

    /// Two lobes for one, if it has them.
    pub fn pairs(&self) -> Option<&LobePairs> {
        self.pairs.as_ref()
    }

    /// The magnitude layer as it is stored: `(albedo, schlick)` a texel, with the description's dip added.
    pub fn magnitude(&self) -> &[[f32; 2]] {
        &self.magnitude
    }

    /// `(albedo, schlick)` at each node: the magnitude layer without the dip. Where that was added and
    /// rounded, they may lie 1e-3 outside of their range.
    pub fn albedos(&self) -> Vec<[f32; 2]> {
        let texels = self.magnitude.iter().enumerate();
        let albedos = |(i, &texel)| {
            let (x, y) = (i as u32 % self.size, i as u32 / self.size);
            without_dip(&self.description, self.size, x, y, texel)
        };
        texels.map(albedos).collect()
    }

    /// The roughness and the cosine of the view angle that node `(x, y)` of a table of `size` (2 or more)
    /// stands for.
    pub fn node(size: u32, x: u32, y: u32) -> (f64, f64) {
        let step = f64::from(size.saturating_sub(1).max(1));
        let v = f64::from(y) / step;
        (f64::from(x) / step, 1.0 - v * v)
    }

    /// The [`LAYERS`] layers as the GPU image has them, four `f32` a texel: layer 0 the matrix; layer 1 the
    /// magnitude in its first two channels, and in the third how much of GGX's dip was added to it, 1 or 0;
    /// layer 2 the matrix of Schlick's weight; layers 3 and 4 those of [`LobePairs`]; layer 5 its shares in
    /// the first two channels. A table of one matrix has that again in layer 2; one without pairs has its own
    /// matrices in layers 3 and 4, with no share for the second at a reflectance of 1.
    pub fn texels(&self) -> Vec<[f32; 4]> {
        let dip = f32::from(u8::from(self.description.ggx_dip));
        let magnitude = self.magnitude.iter().map(|m| [m[0], m[1], dip, 0.0]);
        let schlick = self.schlick_matrix.as_ref().unwrap_or(&self.matrix);
        let mut texels: Vec<[f32; 4]> =
            self.matrix.iter().copied().chain(magnitude).chain(schlick.iter().copied()).collect();
        if let Some(pairs) = &self.pairs {
            texels.extend(pairs.matrices.iter().flatten());
            texels.extend(pairs.second_shares.iter().map(|shares| [shares[0], shares[1], 0.0, 0.0]));
        } else {
            texels.extend(self.matrix.iter().chain(schlick));
            texels.extend(self.schlick_shares().map(|share| [0.0, share, 0.0, 0.0]));
        }
        texels
    }

    /// At each node what share of the energy Schlick's lobe has at a reflectance of [`DIELECTRIC_F0`].
    fn schlick_shares(&self) -> impl Iterator<Item = f32> {
        let share = |index: u32| {
            let (roughness, cos_view) = Self::node(self.size, index % self.size, index / self.size);
            self.lookup(roughness, cos_view).schlick_share(DIELECTRIC_F0, 1.0) as f32
        };
        (0..self.size * self.size).map(share)
    }

    /// Looks up the lobes, in float64: the twin of `arealight_table_lookup`.
    ///
    /// `roughness` is perceptual and clamped to [0, 1] (its alpha to [`crate::MIN_ALPHA`]); `cos_view` is
    /// clamped to [0, 1]. NaN counts as 0.
    pub fn lookup(&self, roughness: f64, cos_view: f64) -> TableSample {
        let (roughness, cos_view) = (clamped_roughness(roughness), clamped_cosine(cos_view));
        // Find the four nodes around the sample
        let last = f64::from(self.size - 1);
        let (u, v) = (roughness * last, (1.0 - cos_view).sqrt() * last);
        let (x, y) = (u.floor().min(last - 1.0), v.floor().min(last - 1.0));
        let (s, t) = (u - x, v - y);
        let at = |dx: usize, dy: usize| (y as usize + dy) * self.size as usize + x as usize + dx;
        let weights = [
            (at(0, 0), (1.0 - s) * (1.0 - t)),
            (at(1, 0), s * (1.0 - t)),
            (at(0, 1), (1.0 - s) * t),
            (at(1, 1), s * t),
        ];
        // Interpolate
        let alpha = roughness * roughness;
        let inverse =
            |texels: &[[f32; 4]]| inverse_from_texel(interpolated(texels, &weights), alpha, cos_view);
        let [albedo, schlick] = interpolated(&self.magnitude, &weights);
        let dip = self.description.dip(roughness, cos_view);
        let albedo = (albedo - dip[0]).clamp(0.0, 1.0);
        let schlick = (schlick - dip[1]).clamp(0.0, albedo);
        let lobe = inverse(&self.matrix);
        let schlick_inverse = self.schlick_matrix.as_deref().map_or(lobe, inverse);
        let pairs = self.pairs.as_ref().map(|pairs| {
            (
                pairs.matrices.each_ref().map(|texels| inverse(texels)),
                interpolated(&pairs.second_shares, &weights),
            )
        });
        TableSample { inverse: lobe, schlick_inverse, albedo, schlick, pairs }
    }
}

/// A perceptual roughness as it is looked up: within [0, 1], its alpha not below [`crate::MIN_ALPHA`]. NaN
/// counts as 0.
pub fn clamped_roughness(roughness: f64) -> f64 {
    roughness.clamp(crate::MIN_ALPHA.sqrt(), 1.0).max(crate::MIN_ALPHA.sqrt())
}

/// The cosine of a view as it is looked up: within [0, 1]. NaN counts as 0.
pub fn clamped_cosine(cos_view: f64) -> f64 {
    cos_view.clamp(0.0, 1.0).max(0.0)
}

/// The albedos that a magnitude texel holds.
fn without_dip(description: &TableDescription, size: u32, x: u32, y: u32, texel: [f32; 2]) -> [f32; 2] {
    if !description.ggx_dip {
        return texel;
    }
    let (roughness, cos_view) = LightTable::node(size, x, y);
    let dip = description.dip(roughness, cos_view);
    std::array::from_fn(|i| (f64::from(texel[i]) - dip[i]) as f32)
}

/// The weighted sum of the texels at four indices.
fn interpolated<const N: usize>(texels: &[[f32; N]], weights: &[(usize, f64); 4]) -> [f64; N] {
    std::array::from_fn(|c| weights.iter().map(|&(i, weight)| weight * f64::from(texels[i][c])).sum())
}

/// M⁻¹ in the surface frame from a matrix texel, see the module's text.
pub fn inverse_from_texel(texel: [f64; 4], alpha: f64, cos_view: f64) -> DMat3 {
    let mirrored = DMat3::from_cols(
        DVec3::new(texel[0], 0.0, alpha * texel[2]),
        DVec3::Y,
        DVec3::new(texel[1], 0.0, alpha * texel[3]),
    );
    mirrored * mirror_frame(cos_view).transpose()
}

/// The mirror frame's axes as columns, in the surface frame, for a view `(sin t, 0, cos t)`.
pub fn mirror_frame(cos_view: f64) -> DMat3 {
    let sin_view = ((1.0 - cos_view) * (1.0 + cos_view)).max(0.0).sqrt();
    DMat3::from_cols(DVec3::new(cos_view, 0.0, sin_view), DVec3::Y, DVec3::new(-sin_view, 0.0, cos_view))
}

/// The part of a lobe's energy that lies above the surface, in (0, 1], for M⁻¹ of the surface frame.
///
/// A lobe that is clipped at the surface's horizon as well as at that of cosine space loses the rest; divided
/// by this, it keeps the albedo. The half space above the surface is one in cosine space too, and the lune
/// between it and the upper one at an angle `a` between their normals holds `(1 + cos a) / 2` of a cosine.
pub fn share_above_surface(inverse: &DMat3) -> f64 {
    // The normal of the surface's horizon in cosine space
    let horizon = inverse.x_axis.cross(inverse.y_axis);
    let length = horizon.length();
    if length > 0.0 { (0.5 + 0.5 * horizon.z / length).max(1e-6) } else { 1.0 }
}

fn invertible(layer: &'static str, x: u32, y: u32, texel: &[f32; 4]) -> Result<(), TableError> {
    let determinant = texel[0] * texel[3] - texel[1] * texel[2];
    if determinant.is_nan() || determinant <= 0.0 {
        return Err(TableError::Singular { layer, x, y, determinant });
    }
    Ok(())
}

fn finite(layer: &'static str, x: u32, y: u32, texel: &[f32]) -> Result<(), TableError> {
    match texel.iter().position(|v| !v.is_finite()) {
        Some(channel) => Err(TableError::NotFinite { layer, x, y, channel, value: texel[channel] }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests;
