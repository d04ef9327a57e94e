//! The levels of a light's texture as the GPU's prefilter makes them, and its lookup, both in float64.

use super::Texture;
use arealight::PyramidSize;
use glam::{DVec2, DVec3};

/// The prefiltered levels of a texture: see [`arealight::pyramid`].
#[derive(Debug, Clone, PartialEq)]
pub struct Pyramid {
    size: PyramidSize,
    levels: Vec<Texture>,
}

impl Pyramid {
    /// Filters `texture`, which is resampled where its size is not that of the content.
    pub fn new(texture: &Texture, size: PyramidSize) -> Self {
        let [width, height] = size.content().map(|side| side as usize);
        let content = if (texture.width(), texture.height()) == (width, height) {
            texture.clone()
        } else {
            texture.resampled(width, height)
        };
        // Level 0: the content, its edge extended into the margin
        let [margin_x, margin_y] = size.margin(0).map(|margin| margin as i64);
        let [extent_x, extent_y] = size.extent(0).map(|side| side as usize);
        let first = Texture::from_fn(extent_x, extent_y, |column, row| {
            content.texel(column as i64 - margin_x, row as i64 - margin_y)
        });
        // Each level from the one before
        let mut levels = vec![first];
        for level in 1..size.levels() {
            levels.push(halved(&levels[level as usize - 1], size, level));
        }
        Self { size, levels }
    }

    /// The size.
    pub fn size(&self) -> PyramidSize {
        self.size
    }

    /// A level with its margins; beyond the last, the last.
    pub fn level(&self, level: u32) -> &Texture {
        &self.levels[(level as usize).min(self.levels.len() - 1)]
    }

    /// A trilinear lookup at a texture coordinate of the content, as samplers do it: clamped at the margins' outer
    /// edges, between two levels by the fraction of `level`.
    pub fn lookup(&self, uv: DVec2, level: f64) -> DVec3 {
        let [content, extent] = [self.size.content(), self.size.extent(0)]
            .map(|sides| DVec2::new(f64::from(sides[0]), f64::from(sides[1])));
        let margin = DVec2::from_array(self.size.margin(0));
        let padded = (uv * content + margin) / extent;
        let level = level.max(0.0).min(self.levels.len() as f64 - 1.0);
        let sharper = level as u32;
        let [near, far] = [sharper, sharper + 1].map(|level| self.level(level).sample(padded));
        near.lerp(far, level.fract())
    }

    /// The lookup that stands for a Gaussian blur of standard deviation `sigma`, in texture coordinates of a light that
    /// shows `shown` of the content and whose metric makes a texel as long in both directions: `sigma` is in units of
    /// the square root of the shown area.
    pub fn blurred(&self, uv: DVec2, sigma: f64, shown: DVec2) -> DVec3 {
        let [width, height] = self.size.content().map(f64::from);
        let texels = (width * shown.x * height * shown.y).sqrt();
        self.lookup(uv, self.size.level_of(sigma * texels))
    }
}

/// Half the texels a side: the kernel of `level` along both axes, clamped at the border.
fn halved(finer: &Texture, size: PyramidSize, level: u32) -> Texture {
    let kernel = size.kernel(level);
    let [width, height] = size.extent(level).map(|side| side as usize);
    let filtered = |texel: &dyn Fn(i64) -> DVec3, index: usize| -> DVec3 {
        let middle = 2 * index as i64;
        let taps = kernel.weights.iter().take(kernel.radius as usize).zip(0_i64..);
        taps.map(|(weight, i)| (texel(middle - i) + texel(middle + 1 + i)) * f64::from(*weight)).sum()
    };
    let narrowed = Texture::from_fn(width, finer.height(), |column, row| {
        filtered(&|tap| finer.texel(tap, row as i64), column)
    });
    Texture::from_fn(width, height, |column, row| filtered(&|tap| narrowed.texel(column as i64, tap), row))
}
