//! The levels of a light's texture as the GPU's prefilter makes them, and its lookup, both in float64.

use super::{Texture, mirrored};
use arealight::PyramidSize;
use glam::{DVec2, DVec3};

/// The prefiltered levels of a texture: see [`arealight::pyramid`].
#[derive(Debug, Clone, PartialEq)]
pub struct Pyramid {
    size: PyramidSize,
    levels: Vec<Texture>,
}

impl Pyramid {
    /// Filters `texture`, which is resampled where it has another size.
    pub fn new(texture: &Texture, size: PyramidSize) -> Self {
        // Each level from the one before
        let side = size.side(0) as usize;
        let mut levels = vec![texture.resampled(side, side)];
        for level in 1..size.levels() {
            levels.push(halved(&levels[level as usize - 1], size, level));
        }
        Self { size, levels }
    }

    /// The size.
    pub fn size(&self) -> PyramidSize {
        self.size
    }

    /// A level; beyond the last, the last.
    pub fn level(&self, level: u32) -> &Texture {
        &self.levels[(level as usize).min(self.levels.len() - 1)]
    }

    /// A trilinear lookup at a texture coordinate, as samplers do it: clamped at the edges, which within the
    /// image is as if it were mirrored; between two levels by the fraction of `level`.
    pub fn lookup(&self, uv: DVec2, level: f64) -> DVec3 {
        let level = level.max(0.0).min(self.levels.len() as f64 - 1.0);
        let sharper = level as u32;
        let [near, far] = [sharper, sharper + 1].map(|level| self.level(level).sample(uv));
        near.lerp(far, level.fract())
    }

    /// The lookup that stands for a Gaussian blur of standard deviation `sigma`, in texture coordinates of a
    /// light that shows `shown` of the image and whose metric makes a texel as long in both directions:
    /// `sigma` is in units of the square root of the shown area.
    pub fn blurred(&self, uv: DVec2, sigma: f64, shown: DVec2) -> DVec3 {
        let texels = f64::from(self.size.side(0)) * (shown.x * shown.y).sqrt();
        self.lookup(uv, self.size.level_of(sigma * texels))
    }
}

/// Half the texels a side: the kernel of `level` along both axes, mirrored beyond the border.
fn halved(finer: &Texture, size: PyramidSize, level: u32) -> Texture {
    let weights = size.weights(level);
    let side = size.side(level) as usize;
    let filtered = |texel: &dyn Fn(isize) -> DVec3, index: usize| -> DVec3 {
        let middle = 2 * index.cast_signed();
        let taps = weights.iter().take(size.taps(level) as usize).zip(0_isize..);
        taps.map(|(weight, i)| (texel(middle - i) + texel(middle + 1 + i)) * f64::from(*weight)).sum()
    };
    let narrowed = Texture::from_fn(side, finer.height(), |column, row| {
        filtered(&|tap| finer.texel(mirrored(tap, finer.width()), row.cast_signed()), column)
    });
    Texture::from_fn(side, side, |column, row| {
        filtered(&|tap| narrowed.texel(column.cast_signed(), mirrored(tap, narrowed.height())), row)
    })
}
