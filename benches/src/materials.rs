//! The error of each material of a scene: its picture against the Monte Carlo reference, by material.

use crate::shadow_levels::PicturesError;
use crate::shadow_levels::pictures::Pictures;
use crate::table::Table;
use arealight::plan::ShadeOptions;
use arealight::{Effects, LightTable, Plane, Quality, SpecularLobes};
use arealight_engine::host::{Host, Usage};
use arealight_engine::{Engine, EngineError, Reference};
use arealight_scene::{Scene, SceneMaterial};
use arealight_vk::TableFormat;
use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// What to run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Of the pictures, in pixels.
    pub size: [u32; 2],
    /// Samples a pixel of each of the two references.
    pub samples: u32,
}

impl Default for Options {
    /// A minute on two processors.
    fn default() -> Self {
        Self { size: [320, 180], samples: 512 }
    }
}

/// A material in a picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MaterialResult {
    /// Its name in the scene.
    pub name: String,
    /// The effects that it needs, beside both lobes.
    pub effects: String,
    /// How many pixels show it.
    pub pixels: usize,
    /// Mean radiance over that of the reference, of all channels.
    pub ratio: f64,
    /// Root of the mean squared difference, over the reference's mean. The references' noise is not in it:
    /// squares are products of the differences from two of them. 0 where noise makes the mean negative.
    pub error: f64,
    /// `error` with two specular lobes ([`SpecularLobes::Two`]).
    pub two_lobes: f64,
    /// `error` over half vectors ([`SpecularLobes::HalfVectors`]).
    pub half_vectors: f64,
    /// The same of the reference itself, of one of the two: its noise.
    pub noise: f64,
}

/// What a run found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MaterialErrors {
    /// The device.
    pub device: String,
    /// [`Options::size`].
    pub size: [u32; 2],
    /// [`Options::samples`].
    pub samples: u32,
    /// Each material that the camera sees, in the order of the scene's.
    pub materials: Vec<MaterialResult>,
}

/// Two independent pictures of the truth, and ours.
struct Pixels {
    /// By one specular lobe, by two, and over half vectors.
    ours: [Vec<DVec3>; 3],
    truths: [Vec<DVec3>; 2],
    /// Index into the scene's materials; none where nothing or a lamp is seen.
    materials: Vec<Option<usize>>,
}

/// Renders a scene without shadows, at the exact level by one specular lobe, by two and over half vectors,
/// and twice by Monte Carlo. `progress` is told how many samples a pixel are done, of two times
/// [`Options::samples`].
pub fn run(
    host: &Host,
    table: &LightTable,
    scene: &Scene,
    options: &Options,
    progress: &dyn Fn(u64),
) -> Result<MaterialErrors, PicturesError> {
    let mut engine = Engine::new(host.clone(), table, TableFormat::default())?;
    engine.load_scene_textures(scene, 1024)?;
    let pixels = render(&engine, scene, options, progress)?;
    let materials = scene.materials.iter().enumerate();
    Ok(MaterialErrors {
        device: host.device_name(),
        size: options.size,
        samples: options.samples,
        materials: materials
            .filter_map(|(index, material)| {
                let effects = (material.effects() & Effects::SURFACES)
                    - (Effects::DIFFUSE | Effects::GLOSSY | Effects::COUPLED | Effects::SPECULAR_INPUT);
                let found = pixels.errors(index)?;
                Some(MaterialResult { name: material.name.clone(), effects: effects.to_string(), ..found })
            })
            .collect(),
    })
}

fn render(
    engine: &Engine,
    scene: &Scene,
    options: &Options,
    progress: &dyn Fn(u64),
) -> Result<Pixels, PicturesError> {
    let (mut pictures, buffers, _) = Pictures::new(engine, scene, options.size)?;
    // What each pixel shows
    let positions: Vec<[f32; 4]> = pictures.renderer.g_buffer()[Plane::Position]
        .download(Usage::COMPUTE_READ)
        .map_err(EngineError::from)?;
    let material = |position: &[f32; 4]| {
        let triangle = buffers.triangles.get((position[3] as usize).checked_sub(1)?)?;
        let material = triangle.material as usize;
        (scene.materials[material].emission == Vec3::ZERO).then_some(material)
    };
    let materials: Vec<Option<usize>> = positions.iter().map(material).collect();
    // Ours, each pixel by a pass of what its material needs: one of everything would have one specular lobe
    // below two layers
    let mut ours = |specular_lobes| -> Result<_, EngineError> {
        let quality = Quality { specular_lobes, ..Quality::default() };
        let mut found = vec![DVec3::ZERO; materials.len()];
        let needed: BTreeSet<u32> = scene.materials.iter().map(|material| needs(material).bits()).collect();
        for surfaces in needed.into_iter().map(Effects::from_bits_retain) {
            pictures.begin()?;
            pictures.renderer.shade_as(ShadeOptions { surfaces, quality, ..ShadeOptions::default() })?;
            for ((found, radiance), material) in found.iter_mut().zip(pictures.radiance()?).zip(&materials) {
                if material.is_some_and(|material| needs(&scene.materials[material]) == surfaces) {
                    *found = radiance;
                }
            }
        }
        Ok(found)
    };
    let ours = [ours(SpecularLobes::One)?, ours(SpecularLobes::Two)?, ours(SpecularLobes::HalfVectors)?];
    let mut truth = |seed| {
        let mut told = 0;
        pictures.begin()?;
        let reference = Reference { samples: options.samples, seed, ..Reference::default() };
        pictures.renderer.reference(reference, |done| {
            progress(u64::from(done - told));
            told = done;
        })?;
        pictures.radiance()
    };
    Ok(Pixels { ours, truths: [truth(1)?, truth(2)?], materials })
}

/// What shading a material needs of surfaces.
fn needs(material: &SceneMaterial) -> Effects {
    material.effects() & Effects::SURFACES
}

impl Pixels {
    /// Of a material; none where no pixel shows it, or it reflects nothing.
    fn errors(&self, material: usize) -> Option<MaterialResult> {
        let mut pixels = 0;
        let [mut mean, mut truth, mut noise] = [0.0; 3];
        let mut squares = [0.0; 3];
        for (index, shown) in self.materials.iter().enumerate() {
            if *shown != Some(material) {
                continue;
            }
            let [first, second] = self.truths.each_ref().map(|truth| truth[index]);
            pixels += 1;
            mean += self.ours[0][index].element_sum();
            truth += 0.5 * (first + second).element_sum();
            for (square, ours) in squares.iter_mut().zip(&self.ours) {
                *square += (ours[index] - first).dot(ours[index] - second);
            }
            noise += 0.5 * (first - second).length_squared();
        }
        let count = 3.0 * f64::from(pixels);
        let reference = truth / count;
        let error = |square: f64| (square / count).max(0.0).sqrt() / reference;
        (reference > 0.0).then(|| MaterialResult {
            name: String::new(),
            effects: String::new(),
            pixels: pixels as usize,
            ratio: mean / truth,
            error: error(squares[0]),
            two_lobes: error(squares[1]),
            half_vectors: error(squares[2]),
            noise: (noise / count).sqrt() / reference,
        })
    }
}

impl MaterialErrors {
    /// The largest error of any material.
    pub fn largest(&self) -> f64 {
        self.materials.iter().map(|material| material.error).fold(0.0, f64::max)
    }

    /// The table.
    pub fn to_text(&self) -> String {
        format!(
            "{}: {} samples a pixel, two references\n\n{}",
            self.device,
            self.samples,
            self.table(true).to_text()
        )
    }

    /// A row for each material: of a terminal's table the pixels and the noise, of a document's the effects.
    fn table(&self, is_text: bool) -> Table {
        let percent = |part: &f64| format!("{:.2} %", 100.0 * part);
        let row = |found: &MaterialResult| {
            let MaterialResult { name, effects, ratio, error, two_lobes, half_vectors, noise, .. } = found;
            let second = if is_text { found.pixels.to_string() } else { effects.clone() };
            let mut cells = vec![name.clone(), second, format!("{ratio:.4}")];
            cells.extend([error, two_lobes, half_vectors].map(percent));
            cells.extend(is_text.then(|| percent(noise)));
            cells
        };
        let (second, last) = if is_text { ("pixels", " | reference's noise") } else { ("effects", "") };
        let errors = "mean over reference | RMSE over mean | by two lobes | over half vectors";
        Table::new(&format!("material | {second} | {errors}{last}"), self.materials.iter().map(row))
    }

    /// The same as Markdown, with the command that repeats it.
    pub fn to_markdown(&self, command: &str) -> String {
        format!(
            "By `{command}` on {}: the exact level, by one specular lobe, by two and over half vectors, \
            beside Monte Carlo of the true BRDF, without shadows. The references' noise is taken out of the \
            squares.\n\n{}",
            self.device,
            self.table(false).to_markdown()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture of one material, with noise that the two references do not share.
    fn pixels(off_by: f64) -> Pixels {
        let noisy = |every: usize| {
            let noise = |i: usize| if (i / every).is_multiple_of(2) { 0.5 } else { -0.5 };
            (0..4096).map(|i| DVec3::splat(1.0 + noise(i))).collect()
        };
        let truths = [noisy(1), noisy(2)];
        let mut materials = vec![Some(3); 4096];
        materials.push(None);
        let ours = [off_by, 0.5 * off_by, 0.2 * off_by].map(|off_by| vec![DVec3::splat(1.0 + off_by); 4096]);
        let mut pixels = Pixels { ours, truths, materials };
        for ours in &mut pixels.ours {
            ours.push(DVec3::splat(100.0));
        }
        for truth in &mut pixels.truths {
            truth.push(DVec3::ZERO);
        }
        pixels
    }

    #[test]
    fn noise_is_no_error_and_an_error_shows_below_it() {
        let right = pixels(0.0).errors(3).unwrap();
        assert!(right.error < 1e-6 && (right.ratio - 1.0).abs() < 1e-9, "{right:?}");
        assert!((right.noise - 0.5).abs() < 1e-9, "{right:?}");
        let wrong = pixels(0.05).errors(3).unwrap();
        assert!((wrong.two_lobes - 0.025).abs() < 1e-9, "{wrong:?}");
        assert!((wrong.half_vectors - 0.01).abs() < 1e-9, "{wrong:?}");
        assert!((wrong.error - 0.05).abs() < 1e-9 && (wrong.ratio - 1.05).abs() < 1e-9, "{wrong:?}");
        assert_eq!(wrong.pixels, 4096);
        assert!(pixels(0.0).errors(2).is_none(), "no pixel shows it");
    }
}
