//! What a textured light shows, in float64: bilinear lookup, resampling, and pictures to test with.
//!
//! Texture coordinates run from (0, 0), the outer corner of the first texel of the top row, to (1, 1).
//! Between the texels' centres values are interpolated; beyond the outermost centres the edge is extended.

mod pictures;
mod pyramid;

pub use pyramid::Pyramid;

use glam::{DVec2, DVec3};

/// An image of linear factors, which multiply a light's radiance.
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    width: usize,
    height: usize,
    texels: Vec<DVec3>,
}

/// Why texels are refused as a texture.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum BadTexture {
    /// There are none, or not width times height of them.
    #[error(
        "texels: {count} given for {width} x {height}; give one row after the other, at least one texel in \
        all"
    )]
    Count {
        /// Texels given.
        count: usize,
        /// Width in texels.
        width: usize,
        /// Height in texels.
        height: usize,
    },
    /// A texel is NaN or infinite.
    #[error("texels[{index}]: {value} must be finite")]
    NotFinite {
        /// Its place.
        index: usize,
        /// What it is.
        value: DVec3,
    },
}

/// One axis of a bilinear lookup: a share of each of two neighbours.
#[derive(Debug, Clone, Copy)]
struct Neighbours {
    low: usize,
    high: usize,
    /// The share of `high`, in [0, 1].
    share: f64,
}

impl Neighbours {
    /// About `coordinate`, in texels from the outer edge of the first of `count`.
    fn new(coordinate: f64, count: usize) -> Self {
        let last = count - 1;
        // `max` takes NaN to the first texel
        let place = (coordinate - 0.5).max(0.0).min(last as f64);
        let low = place as usize;
        Self { low, high: (low + 1).min(last), share: place - low as f64 }
    }
}

impl Texture {
    /// A texture of `width` × `height` texels, row after row from the top.
    ///
    /// # Errors
    /// [`BadTexture`] where the count is wrong, or a texel not finite.
    pub fn new(width: usize, height: usize, texels: Vec<DVec3>) -> Result<Self, BadTexture> {
        if texels.is_empty() || width.checked_mul(height) != Some(texels.len()) {
            return Err(BadTexture::Count { count: texels.len(), width, height });
        }
        match texels.iter().position(|texel| !texel.is_finite()) {
            Some(index) => Err(BadTexture::NotFinite { index, value: texels[index] }),
            None => Ok(Self { width, height, texels }),
        }
    }

    /// Texels a row, at least one.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows, at least one.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The texels, row after row from the top.
    pub fn texels(&self) -> &[DVec3] {
        &self.texels
    }

    /// The texel of a column and a row; beyond the edge, that at the edge.
    pub fn texel(&self, column: isize, row: isize) -> DVec3 {
        let clamp = |index: isize, count: usize| index.clamp(0, count.cast_signed() - 1) as usize;
        self.texels[clamp(row, self.height) * self.width + clamp(column, self.width)]
    }

    /// The factor at a texture coordinate; beyond the edge, that at the edge.
    pub fn sample(&self, uv: DVec2) -> DVec3 {
        let column = Neighbours::new(uv.x * self.width as f64, self.width);
        let row = Neighbours::new(uv.y * self.height as f64, self.height);
        let along = |row: usize| {
            let row = &self.texels[row * self.width..];
            row[column.low].lerp(row[column.high], column.share)
        };
        along(row.low).lerp(along(row.high), row.share)
    }

    /// The brightest channel of any texel.
    pub fn brightest(&self) -> f64 {
        self.texels.iter().map(|texel| texel.max_element()).fold(0.0, f64::max)
    }

    /// The mean over the whole image, of the texels as of the interpolated function.
    pub fn mean(&self) -> DVec3 {
        self.texels.iter().sum::<DVec3>() / self.texels.len() as f64
    }

    /// The image with other numbers of texels, as the prefilter makes it: each is a mean over the source,
    /// weighted by a tent about its centre, whose radius is a texel of the coarser of both. The source is
    /// extended beyond its edge.
    ///
    /// Equal numbers copy; larger ones are interpolated.
    #[must_use]
    pub fn resampled(&self, width: usize, height: usize) -> Self {
        let columns = Tent::axis(self.width, width.max(1));
        let rows = Tent::axis(self.height, height.max(1));
        // Along the rows first
        let narrowed: Vec<DVec3> = self
            .texels
            .chunks_exact(self.width)
            .flat_map(|row| columns.iter().map(|tent| tent.apply(|column| row[column])))
            .collect();
        let texels = rows
            .iter()
            .flat_map(|tent| {
                let narrowed = &narrowed;
                let columns = columns.len();
                (0..columns).map(move |column| tent.apply(|row| narrowed[row * columns + column]))
            })
            .collect();
        Self { width: columns.len(), height: rows.len(), texels }
    }
}

/// What one resampled texel takes of its source along one axis.
struct Tent {
    /// Source texels with their weights, which sum to one.
    taps: Vec<(usize, f64)>,
}

impl Tent {
    /// One for each of `target` texels, of `source` texels.
    fn axis(source: usize, target: usize) -> Vec<Self> {
        let ratio = source as f64 / target as f64;
        let radius = ratio.max(1.0);
        let tent = |index: usize| {
            let center = (index as f64 + 0.5) * ratio - 0.5;
            let (first, last) = ((center - radius).ceil() as isize, (center + radius).floor() as isize);
            let weight = |tap: isize| (1.0 - (tap as f64 - center).abs() / radius).max(0.0);
            let sum: f64 = (first..=last).map(weight).sum();
            let inside = |tap: isize| tap.clamp(0, source.cast_signed() - 1) as usize;
            Self { taps: (first..=last).map(|tap| (inside(tap), weight(tap) / sum)).collect() }
        };
        (0..target).map(tent).collect()
    }

    fn apply(&self, texel: impl Fn(usize) -> DVec3) -> DVec3 {
        self.taps.iter().map(|&(index, weight)| texel(index) * weight).sum()
    }
}

#[cfg(test)]
mod tests;
