//! An image on a light as the GPU stores it, and its lookup, both in float64: see [`arealight::pyramid`].

use super::{Neighbours, Texture};
use arealight::PyramidSize;
use arealight::pyramid::LAYERS;
use glam::{DVec2, DVec4};
use std::f64::consts::PI;

/// A square image of colours, with coverage in w.
type Level = Vec<DVec4>;

/// The mips of an image, and what lobes see of it: A, and B along its rows and its columns, times
/// `1 + pi (h^2 + d^2)^(3/2) / h` at a distance d from the light.
#[derive(Debug, Clone, PartialEq)]
pub struct Pyramid {
    size: PyramidSize,
    layers: [Vec<Level>; LAYERS as usize],
}

impl Pyramid {
    /// Filters `texture`, which is resampled where it has another size, for a light that is `aspect` times as
    /// wide as high; of an ellipse, what it covers. By sums over six texels a height, where the GPU has
    /// three and coarser levels.
    pub fn new(texture: &Texture, size: PyramidSize, aspect: f64, is_ellipse: bool) -> Self {
        let side = size.side(0) as usize;
        let texture = texture.resampled(side, side);
        let mut mips: Vec<Level> = vec![texture.texels().iter().map(|texel| texel.extend(1.0)).collect()];
        for level in 1..size.levels() {
            mips.push(halved(&mips[level as usize - 1], size.side(level) as usize));
        }
        let mut seen = [const { Vec::new() }; 3];
        let covered: Vec<Level> = mips.iter().map(|mip| covered(mip, is_ellipse)).collect();
        for (level, mip) in (0..).zip(&covered) {
            // Of the coarsest a finer mip, for as many texels as a sum needs
            let summed =
                if size.side(level) < 32 { &covered[size.side(0).ilog2() as usize - 5] } else { mip };
            let node = |index: u32| {
                let side = size.side(level);
                let node =
                    (DVec2::new(f64::from(index % side), f64::from(index / side)) + 0.5) / f64::from(side);
                sums(summed, node_place(node), size.height(level), aspect, side == 1)
            };
            let nodes: Vec<[DVec4; 3]> = (0..size.side(level).pow(2)).map(node).collect();
            for (layer, levels) in seen.iter_mut().enumerate() {
                levels.push(nodes.iter().map(|sums| sums[layer]).collect());
            }
        }
        let [a, b_rows, b_columns] = seen;
        Self { size, layers: [mips, a, b_rows, b_columns] }
    }

    /// What a device has, by layer and level; see [`arealight::pyramid`] for their order.
    ///
    /// # Panics
    /// Where a level has not the texels of its size.
    pub fn from_levels(size: PyramidSize, texels: impl Fn(u32, u32) -> Vec<[f32; 4]>) -> Self {
        let level = |layer, level| -> Level {
            let texels = texels(layer, level);
            assert_eq!(texels.len() as u32, size.side(level).pow(2), "layer {layer}, level {level}");
            texels.into_iter().map(|texel| DVec4::from_array(texel.map(f64::from))).collect()
        };
        let layer = |layer: usize| (0..size.levels()).map(|at| level(layer as u32, at)).collect();
        Self { size, layers: std::array::from_fn(layer) }
    }

    /// The size.
    pub fn size(&self) -> PyramidSize {
        self.size
    }

    /// A level of a layer of [`arealight::pyramid`], row after row.
    pub fn level(&self, layer: usize, level: u32) -> &[DVec4] {
        &self.layers[layer][level as usize]
    }

    /// A trilinear lookup in a layer, as samplers do it: clamped at the edges and at both ends of the levels;
    /// between two by the fraction of `level`.
    pub fn lookup(&self, layer: usize, uv: DVec2, level: f64) -> DVec4 {
        let last = self.size.levels() - 1;
        let level = level.max(0.0).min(f64::from(last));
        let at = |level: u32| {
            let side = self.size.side(level.min(last)) as usize;
            let [column, row] = [uv.x, uv.y].map(|along| Neighbours::new(along * side as f64, side));
            let texels = &self.layers[layer][level.min(last) as usize];
            let along = |row: usize| {
                texels[row * side + column.low].lerp(texels[row * side + column.high], column.share)
            };
            along(row.low).lerp(along(row.high), row.share)
        };
        at(level as u32).lerp(at(level as u32 + 1), level.fract())
    }
}

/// Means of four texels.
fn halved(finer: &[DVec4], side: usize) -> Level {
    let texel = |index: usize| {
        let first = 4 * side * (index / side) + 2 * (index % side);
        0.25 * (finer[first] + finer[first + 1] + finer[first + 2 * side] + finer[first + 2 * side + 1])
    };
    (0..side * side).map(texel).collect()
}

/// What an ellipse covers of an image that it touches the edges of; or all.
fn covered(texels: &[DVec4], is_ellipse: bool) -> Level {
    let side = texels.len().isqrt();
    let middle = 0.5 * side as f64;
    let cover = |(index, texel): (usize, &DVec4)| {
        let place = DVec2::new((index % side) as f64, (index / side) as f64) + 0.5;
        let inside = (middle - place.distance(DVec2::splat(middle)) + 0.5).clamp(0.0, 1.0);
        if is_ellipse { inside * *texel } else { *texel }
    };
    texels.iter().enumerate().map(cover).collect()
}

/// A, and B along rows and columns, of a square image on a light `aspect` times as wide as high, as they are
/// stored; `at` is in its sides, `height` in the longer one. The sum over the texels' middles.
fn sums(texels: &[DVec4], at: DVec2, height: f64, aspect: f64, is_last: bool) -> [DVec4; 3] {
    let side = texels.len().isqrt();
    let stretch = DVec2::new(aspect.sqrt(), aspect.sqrt().recip());
    let height = height * stretch.max_element();
    let mut sums = [DVec4::ZERO; 3];
    for (index, texel) in texels.iter().enumerate() {
        let place = (DVec2::new((index % side) as f64, (index / side) as f64) + 0.5) / side as f64;
        let from = place - at;
        let square = (from * stretch).length_squared() + height * height;
        let k = height * height / (PI * square * square);
        // The last level is for all that is farther away, too
        let k_a = if is_last { (PI * height * height).recip() } else { k };
        for (sum, weight) in sums.iter_mut().zip([k_a, k * from.x / height, k * from.y / height]) {
            *sum += weight * *texel;
        }
    }
    // Alike at all heights and places
    let outside = (((at - 0.5).abs() - 0.5).max(DVec2::ZERO) * stretch).length();
    let scale = 1.0 + PI * outside.hypot(height).powi(3) / height;
    sums.map(|sum| scale * sum / texels.len() as f64)
}

/// Where a node of A or B is on the light, in its sides, from the texture coordinate of its layer: the light
/// fills the middle half of each axis, and all outside the quarters beside.
fn node_place(coordinate: DVec2) -> DVec2 {
    let along = |t: f64| {
        let from_middle = (t - 0.5).abs();
        let share = 4.0 * from_middle - 1.0;
        let place = if share > 0.0 { 0.5 + 0.5 * share / (1.0 - share) } else { 2.0 * from_middle };
        0.5 + place.copysign(t - 0.5)
    };
    DVec2::new(along(coordinate.x), along(coordinate.y))
}
