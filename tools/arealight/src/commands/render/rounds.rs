//! Rounds of shadow rays, where a picture is noisy.

use super::Arguments;
use super::shading::{View, ViewShadows, colors};
use crate::means::Means;
use arealight::plan::{ShadeOptions, ShadowHistory};
use arealight_engine::{Cells, EngineError, SceneRenderer, ShadowedView};
use glam::{DVec3, Vec3};
use indicatif::ProgressBar;
use std::time::Duration;

/// The most rounds.
pub const MOST_ROUNDS: u32 = 64;
/// Rays a sample of rounds after the first: four take less than twice the time of one.
const RAYS: u32 = 4;
/// Samples to a side of a tile, which is done when its own noise is low.
const TILE: u32 = 96;
/// Samples around a tile that its shadows are filtered with, and one for the normals there.
const MARGIN: u32 = 8;

/// Rounds, each with other random numbers, of the tiles of a picture that are noisy.
pub struct Rounds<'a> {
    shadows: &'a ViewShadows,
    /// The first of the band's seeds.
    seed: u32,
    size: [u32; 2],
    /// Samples along each axis of a pixel.
    supersample: u32,
    /// The level of noise that is little.
    most: f64,
    stops: f32,
}

/// A part of a picture.
struct Tile {
    corner: [u32; 2],
    size: [u32; 2],
    means: Means,
    /// The variance of a ray, as each round from the second on found it.
    variances: Vec<f64>,
    /// None where one round alone is known.
    noise: Option<f64>,
}

/// What rounds came to.
pub struct Converged {
    /// The picture with the means of all rounds.
    pub picture: Vec<Vec3>,
    pub took: Option<Duration>,
    /// Shadow rays a sample: the most of a tile, and those of all in the mean.
    pub rays: [f64; 2],
    /// The noise that is left, a root of the mean square.
    pub noise: f64,
}

impl Tile {
    /// The tiles of a picture.
    fn all(picture: [u32; 2]) -> Vec<Self> {
        let [columns, rows] = picture.map(|side| side.div_ceil(TILE));
        let tile = |index: u32| {
            let corner = [index % columns * TILE, index / columns * TILE];
            let size = [0, 1].map(|axis| TILE.min(picture[axis] - corner[axis]));
            let means = Means::new((size[0] * size[1]) as usize);
            Self { corner, size, means, variances: vec![], noise: None }
        };
        (0..columns * rows).map(tile).collect()
    }

    /// The tile and what is around it, as a corner and a size.
    fn with_margin(&self, picture: [u32; 2]) -> [[u32; 2]; 2] {
        let corner = self.corner.map(|at| at.saturating_sub(MARGIN));
        let end = [0, 1].map(|axis| (self.corner[axis] + self.size[axis] + MARGIN).min(picture[axis]));
        [corner, [end[0] - corner[0], end[1] - corner[1]]]
    }

    /// Finds the noise that is left, by what all rounds found: one that happens to find little ends nothing.
    fn estimate(&mut self, supersample: usize, stops: f32) {
        let rays = f64::from(self.means.samples());
        let noise = self.means.noise(self.size[0] as usize, supersample, stops);
        self.variances.extend(noise.map(|noise| noise * noise * rays));
        let mean = self.variances.iter().sum::<f64>() / self.variances.len() as f64;
        self.noise = noise.map(|_| (mean / rays).sqrt());
    }

    /// Whether a sample is noisier than that.
    fn is_noisier(&self, most: f64) -> bool {
        self.noise.is_none_or(|noise| noise > most)
    }
}

/// What a picture of rows of `width` samples has in a rectangle, row by row.
fn within<T: Copy>(
    picture: &[T],
    width: u32,
    [[x, y], [columns, rows]]: [[u32; 2]; 2],
) -> impl Iterator<Item = T> {
    (y..y + rows).flat_map(move |row| {
        let first = row as usize * width as usize + x as usize;
        picture[first..first + columns as usize].iter().copied()
    })
}

impl<'a> Rounds<'a> {
    /// Rounds of a picture of so many samples, shown at an exposure; None where one is all that is asked for.
    pub fn of(
        arguments: &Arguments,
        view: &'a View,
        size: [u32; 2],
        stops: impl FnOnce() -> f32,
    ) -> Option<Self> {
        let (shadows, most) = (view.shadows.as_ref()?, arguments.shadow_noise?);
        let (seed, supersample) = (view.seed, arguments.supersample);
        Some(Self { shadows, seed, size, supersample, most, stops: stops() })
    }

    /// Goes on from what `seen` shows after the first round, before which there were `lamps` alone.
    pub fn go_on(
        &self,
        renderer: &SceneRenderer<'_>,
        (lamps, seen): (&[Vec3], &[Vec3]),
        bar: &ProgressBar,
    ) -> Result<Converged, EngineError> {
        let (mut tiles, hidden) = (Tile::all(self.size), self.shadows.hidden()?);
        for tile in &mut tiles {
            let of = |picture| within(picture, self.size[0], [tile.corner, tile.size]);
            let reflected = of(seen).zip(of(lamps)).map(|(seen, lamp)| (seen - lamp).as_dvec3());
            tile.means.add(&reflected.collect::<Vec<DVec3>>(), self.shadows.options.shadow_rays);
            // Where all rays arrived, others do too
            let is_hidden = within(&hidden, self.size[0], tile.with_margin(self.size)).any(|hidden| hidden);
            tile.noise = (!is_hidden).then_some(0.0);
        }
        let cells = Cells::new(TILE + 2 * MARGIN, self.size);
        let (mut took, mut passes) = (Some(Duration::ZERO), vec![]);
        // The second round tells what noise there is; tiles of about as much then go on together
        for rounds in [2, MOST_ROUNDS] {
            tiles.sort_by(|a, b| b.noise.unwrap_or(0.0).total_cmp(&a.noise.unwrap_or(0.0)));
            let mut noisy: Vec<_> = tiles.iter_mut().filter(|tile| tile.is_noisier(self.most)).collect();
            let (mut done, count) = (0, noisy.len());
            for tiles in noisy.chunks_mut(cells.count()) {
                bar.set_message(format!("bands, shadows of {count} noisy parts, {done} done"));
                let one = self.converge(renderer, (cells, &mut passes), (tiles, rounds))?;
                took = took.zip(one).map(|(all, one)| all + one);
                done += tiles.len();
            }
        }
        Ok(self.converged(&tiles, lamps, took))
    }

    /// Rounds of tiles side by side, to so many in all, until none of them is noisy. Each had as many.
    fn converge(
        &self,
        renderer: &SceneRenderer<'_>,
        (cells, passes): (Cells, &mut Vec<ShadowedView>),
        (tiles, rounds): (&mut [&mut Tile], u32),
    ) -> Result<Option<Duration>, EngineError> {
        let rectangles: Vec<_> = tiles.iter().map(|tile| tile.with_margin(self.size)).collect();
        let mut part = renderer.cells(cells, &rectangles)?;
        let ViewShadows { blockers, options, filter, .. } = self.shadows;
        if passes.is_empty() {
            let options = ShadeOptions { shadow_rays: RAYS, ..*options };
            *passes = part.shadowed_passes(blockers, options, (*filter, ShadowHistory::Off))?;
        }
        for pass in passes.iter() {
            part.bind_shadowed(pass)?;
        }
        let size = cells.size(tiles.len());
        let black = vec![Vec3::ZERO; (size[0] * size[1]) as usize];
        let mut took = Some(Duration::ZERO);
        for round in (tiles[0].means.samples() - options.shadow_rays) / RAYS + 1..rounds {
            if !tiles.iter().any(|tile| tile.is_noisier(self.most)) {
                break;
            }
            part.show(&black)?;
            // Each half of the means has seeds that follow each other, whose rays complement each other
            let seed = self.seed.wrapping_add(round % 2 * (MOST_ROUNDS / 2) + round / 2);
            took = took.zip(part.shade_shadowed_passes(passes, seed)?).map(|(all, one)| all + one);
            let shaded = colors(&mut part)?;
            for (index, tile) in tiles.iter_mut().enumerate() {
                let [corner, _] = rectangles[index];
                let corner = [0, 1].map(|axis| cells.corner(index)[axis] + tile.corner[axis] - corner[axis]);
                let reflected = within(&shaded, size[0], [corner, tile.size]).map(Vec3::as_dvec3);
                tile.means.add(&reflected.collect::<Vec<DVec3>>(), RAYS);
                tile.estimate(self.supersample as usize, self.stops);
            }
        }
        Ok(took)
    }

    fn converged(&self, tiles: &[Tile], lamps: &[Vec3], took: Option<Duration>) -> Converged {
        let mut picture = lamps.to_vec();
        let (mut samples, mut rays, mut most, mut squares) = (0.0, 0.0, 0.0, 0.0);
        for tile in tiles {
            let [columns, rows] = tile.size;
            let count = f64::from(columns * rows);
            for (index, mean) in (0..).zip(tile.means.mean()) {
                let [x, y] = [tile.corner[0] + index % columns, tile.corner[1] + index / columns];
                picture[(y * self.size[0] + x) as usize] += mean.as_vec3();
            }
            samples += count;
            rays += count * f64::from(tile.means.samples());
            squares += count * tile.noise.unwrap_or(0.0).powi(2);
            most = f64::max(most, tile.means.samples().into());
        }
        Converged { picture, took, rays: [most, rays / samples], noise: (squares / samples).sqrt() }
    }
}
