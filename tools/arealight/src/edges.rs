//! Edges of what is far brighter than what is beside it, as lamps are: the few samples of a pixel draw them
//! in steps. There, more lines of sight say which materials a pixel shows, and samples nearby how bright.

use crate::picture::{Picture, srgb_from_linear, tone_map};
use arealight_scene::{Camera, SceneBuffers};
use glam::{DVec2, Vec3};
use rayon::prelude::*;
use std::collections::HashMap;
use std::ops::Range;

/// Levels of 255 between neighbouring samples from which on an edge is bright.
const BRIGHT: u8 = 32;
/// Lines of sight of a pixel on such an edge, along each axis.
const LINES: u32 = 6;
/// Samples of a pixel along each axis that are some, and fewer.
pub const FACTORS: Range<u32> = 2..LINES;

/// What a camera sees of a scene.
pub struct Sight<'a> {
    pub scene: &'a SceneBuffers,
    pub camera: &'a Camera,
    /// That each sample shows, if any.
    pub materials: Vec<Option<u32>>,
    /// Samples of a pixel along each axis.
    pub factor: u32,
}

impl Sight<'_> {
    /// Of each pixel on a bright edge, as `stops` show the picture, the sample for each line of sight.
    pub fn edges(&self, picture: &Picture, stops: f32) -> HashMap<u32, Vec<u32>> {
        let size = [picture.width, picture.height].map(|side| side / self.factor);
        let seen = |pixel: u32| {
            let at = [pixel % size[0], pixel / size[0]];
            self.is_bright(at, size, (picture, stops)).then(|| self.seen(at, size))?.map(|seen| (pixel, seen))
        };
        (0..size[0] * size[1]).into_par_iter().filter_map(seen).collect()
    }

    /// The samples of a pixel, and so many around it, as columns and rows.
    fn near(&self, pixel: [u32; 2], size: [u32; 2], reach: u32) -> impl Iterator<Item = [u32; 2]> {
        let [columns, rows] = [0, 1].map(|axis| {
            let [first, end] = [pixel[axis], pixel[axis] + 1].map(|at| at * self.factor);
            first.saturating_sub(reach)..(end + reach).min(size[axis] * self.factor)
        });
        rows.flat_map(move |row| columns.clone().map(move |column| [column, row]))
    }

    /// Whether a pixel shows several materials, and one is far brighter than the others.
    fn is_bright(&self, pixel: [u32; 2], size: [u32; 2], (picture, stops): (&Picture, f32)) -> bool {
        let near = || self.near(pixel, size, 1).map(|[column, row]| (row * picture.width + column) as usize);
        let mut materials = near().map(|sample| self.materials[sample]);
        let first = materials.next();
        if materials.all(|material| Some(material) == first) {
            return false;
        }
        let shown = near().map(|sample| tone_map(picture.pixels[sample] * stops.exp2()));
        let [low, high] =
            shown.fold([Vec3::ONE, Vec3::ZERO], |[low, high], shown| [low.min(shown), high.max(shown)]);
        let [low, high] = [low, high].map(|color| color.to_array().map(srgb_from_linear));
        low.into_iter().zip(high).any(|(low, high)| high.saturating_sub(low) >= BRIGHT)
    }

    /// For each of a pixel's lines of sight the nearest sample of the same material, its own before others.
    /// None where one meets what is not all there: triangles don't tell its edges.
    fn seen(&self, pixel: [u32; 2], size: [u32; 2]) -> Option<Vec<u32>> {
        let line = |index: u32| {
            let at = [pixel[0] * LINES + index % LINES, pixel[1] * LINES + index / LINES];
            let place = line_of_sight(at, LINES);
            let material = self.material(place, size);
            let index = |[column, row]: [u32; 2]| row * size[0] * self.factor + column;
            let unlike = |at: [u32; 2]| {
                let other = self.materials[index(at) as usize] != material;
                let elsewhere = at.map(|at| at / self.factor) != pixel;
                let apart = DVec2::from(line_of_sight(at, self.factor)).distance_squared(place.into());
                100.0 * f64::from(other) + 10.0 * f64::from(elsewhere) + apart
            };
            let near = self.near(pixel, size, self.factor);
            let nearest = near.min_by(|a, b| unlike(*a).total_cmp(&unlike(*b)))?;
            let is_whole = |material: u32| self.scene.materials[material as usize].is_whole();
            material.is_none_or(is_whole).then_some(index(nearest))
        };
        (0..LINES * LINES).map(line).collect()
    }

    /// The material at a place, which is in pixels.
    fn material(&self, place: [f64; 2], size: [u32; 2]) -> Option<u32> {
        let [width, height] = size.map(f64::from);
        let place = [place[0] / width * 2.0 - 1.0, 1.0 - place[1] / height * 2.0];
        let [start, direction] = self.camera.ray(place, width / height);
        let hit = self.scene.closest_hit(start, direction)?;
        Some(self.scene.triangles[hit.triangle].material)
    }
}

/// Where the line of sight of a sample goes, in pixels of n x n of them, as the visibility kernel sends it:
/// each of a pixel's in a row and a column of its own.
fn line_of_sight([column, row]: [u32; 2], n: u32) -> [f64; 2] {
    let place =
        |at: u32, shift: u32| (f64::from(at) + (f64::from(shift) + 0.5) / f64::from(n)) / f64::from(n);
    [place(column, row % n), place(row, n - 1 - column % n)]
}
