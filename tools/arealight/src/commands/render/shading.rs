//! The rendering of a picture.

use super::Arguments;
use super::bands::{Band, MOST_SAMPLES};
use crate::means::Means;
use crate::picture::{AUTO_LUMINANCE, Exposure, MAX_STOPS, Picture};
use crate::progress;
use crate::shadows::Shadows;
use arealight::plan::{MediumOptions, Output, ShadeOptions, TileOptions};
use arealight::{Effects, Light, Quality, reach};
use arealight_engine::{Engine, EngineError, Fog, Reference, SceneRenderer, ShadowedView, TileCounts};
use arealight_scene::{Camera, Scene, SceneBuffers};
use glam::{DVec3, Vec3};
use indicatif::ProgressBar;
use std::time::Duration;

/// What a render took, for the summary.
pub struct Outcome {
    pub visibility: Option<Duration>,
    pub shading: Option<Duration>,
    pub fog: Option<Duration>,
    pub tiles: Option<TileCounts>,
    pub picture: Picture,
    /// The exposure that the picture has.
    pub stops: f32,
    /// Rounds of shadow rays: of the band that has most.
    pub rounds: u32,
    /// Their noise in levels of 255, where it is known: of the band that has most.
    pub noise: Option<f64>,
}

/// The most rounds of shadow rays.
const MOST_ROUNDS: u32 = 64;
/// The most bands: rows of the largest picture.
const MOST_BANDS: u32 = 1 << 16;

impl Outcome {
    /// A picture of `size` without a row yet.
    fn begin([width, height]: [u32; 2]) -> Self {
        let picture = Picture { width, height, pixels: vec![] };
        let none = Some(Duration::ZERO);
        Self {
            visibility: none,
            shading: none,
            fog: None,
            tiles: None,
            picture,
            stops: 0.0,
            rounds: 0,
            noise: None,
        }
    }

    /// Adds the rows of a band below those that are there.
    fn add(
        &mut self,
        visibility: Option<Duration>,
        shading: Option<Duration>,
        tiles: Option<TileCounts>,
        pixels: Vec<Vec3>,
    ) {
        let sum = |all: Option<Duration>, one: Option<Duration>| all.zip(one).map(|(all, one)| all + one);
        self.visibility = sum(self.visibility, visibility);
        self.shading = sum(self.shading, shading);
        self.picture.pixels.extend(pixels);
        self.tiles = match (self.tiles.take(), tiles) {
            (Some(all), Some(one)) => Some(all + one),
            (all, one) => all.or(one),
        };
    }

    /// The shadow rays that a pixel of so many samples has had.
    pub fn rays(&self, shadows: Shadows, samples: u32) -> Option<u32> {
        match shadows {
            Shadows::Rays(rays, _) if self.rounds > 0 => Some(rays * samples * self.rounds),
            _ => None,
        }
    }

    /// Those in words, and what noise they left.
    pub fn rounds_text(&self, shadows: Shadows, samples: u32) -> Option<String> {
        let rays = self.rays(shadows, samples)?;
        Some(match self.noise {
            None => format!("shadows  {rays} rays a pixel"),
            Some(noise) => format!("shadows  {rays} rays a pixel; their noise is {noise:.2} levels of 255"),
        })
    }
}

/// Renders a scene, a band of rows after the other.
pub fn render(
    engine: &Engine,
    scene: &Scene,
    camera: &Camera,
    size: [u32; 2],
    (surfaces, quality): (Effects, Quality),
    arguments: &Arguments,
) -> Result<Outcome, EngineError> {
    // Everything on the GPU is relative to the camera
    let buffers = SceneBuffers::new(scene, camera.position)?;
    let whole = buffers.constants(camera, size, Vec3::ZERO);
    let bands = Band::of(size, MOST_SAMPLES);
    let bar = match arguments.reference {
        Some(samples) => {
            let samples = u64::from(arguments.samples_a_subpixel(samples));
            progress::bar(bands.len() as u64 * samples, "samples a subpixel")
        }
        None => progress::bar(bands.len() as u64, "bands"),
    };
    let mut sum = Outcome::begin(size);
    let mut emission = vec![];
    let fog = arguments.fog.of(scene, camera);
    let most_stops = most_stops(scene);
    for (index, band) in bands.iter().enumerate() {
        let in_band = band.size(size[0]);
        let camera = band.camera(whole, size[1]);
        let mut renderer = SceneRenderer::new(engine, &buffers, &scene.lights, camera, in_band)?;
        let visibility = renderer.visibility()?;
        // So far there is what lamps show of themselves
        let lamps = colors(&mut renderer)?;
        // Frames of a film, bands and rounds each have seeds of their own, one after the other
        let seed =
            arguments.seed.wrapping_mul(MOST_BANDS).wrapping_add(index as u32).wrapping_mul(MOST_ROUNDS);
        let shadowed = match arguments.shadow_level() {
            Shadows::Rays(shadow_rays, filter) if arguments.reference.is_none() => {
                let options = ShadeOptions { surfaces, quality, shadow_rays, ..ShadeOptions::default() };
                renderer.shadowed_passes(&buffers, options, filter)?
            }
            _ => vec![],
        };
        let view = View { surfaces, quality, seed, light_count: scene.lights.len(), shadowed };
        let (mut shading, tiles) = shade(&mut renderer, &view, arguments, &bar)?;
        let mut found = colors(&mut renderer)?;
        if let Some(rounds) = Rounds::of(arguments, in_band[0], most_stops) {
            let (means, noise, took) = rounds.go_on(&mut renderer, &view, (&lamps, &found), &bar)?;
            shading = shading.zip(took).map(|(one, more)| one + more);
            found = lamps.iter().zip(means.mean()).map(|(lamp, mean)| *lamp + mean.as_vec3()).collect();
            sum.rounds = sum.rounds.max(means.samples());
            if fog.is_some() {
                renderer.show(&found)?;
            }
            sum.noise = sum.noise.into_iter().chain(noise).reduce(f64::max);
        } else if arguments.reference.is_none() && arguments.shadow_level() != Shadows::Off {
            sum.rounds = 1;
        }
        if let Some(fog) = &fog {
            let took = add_fog(&mut renderer, &buffers, (fog, in_band, seed), arguments)?;
            sum.fog = took.map(|took| sum.fog.unwrap_or_default() + took);
            found = colors(&mut renderer)?;
        }
        if matches!(arguments.exposure, Exposure::Auto) {
            emission.extend(band.keep(size[0], lamps));
        }
        sum.add(visibility, shading, tiles, band.keep(size[0], found));
    }
    bar.finish_and_clear();
    sum.stops = match arguments.exposure {
        Exposure::Auto => sum.picture.auto_stops(&emission, most_stops),
        Exposure::Stops(stops) => stops,
    };
    Ok(sum)
}

/// The most stops of [`Exposure::Auto`]: ten more than a white sheet in the scene's middle needs that faces
/// each light. What is darker, as mirrors that see no lamp, is rounding.
fn most_stops(scene: &Scene) -> f32 {
    let (middle, least) = (scene.bounds.center(), 0.5 * scene.bounds.diagonal());
    let sheet = scene.lights.iter().map(|light| {
        let distance = light.shape.center().distance(middle).max(least);
        // A light's reach is its size and what grows with the root of one over the threshold
        let light = Light { texture: None, ..light.clone() };
        let [near, far] =
            [1.0, 0.25].map(|threshold| reach::radius(&light, threshold, reach::DIFFUSE_DENSITY));
        ((far - near) / distance).powi(2)
    });
    let stops = (f64::from(AUTO_LUMINANCE) / sheet.sum::<f64>()).log2() + 10.0;
    if stops.is_nan() { MAX_STOPS } else { (stops as f32).clamp(-MAX_STOPS, MAX_STOPS) }
}

/// Puts a fog before what a renderer shaded, as the arguments say.
fn add_fog(
    renderer: &mut SceneRenderer<'_>,
    scene: &SceneBuffers,
    (fog, size, seed): (&Fog, [u32; 2], u32),
    arguments: &Arguments,
) -> Result<Option<Duration>, EngineError> {
    let shadows = arguments.shadow_level() != Shadows::Off;
    if let Some(samples) = arguments.reference {
        let samples = arguments.samples_a_subpixel(samples);
        return renderer.fog_reference(fog, samples, (shadows, seed), |_| ());
    }
    let [columns, rows] = size.map(|side| side.div_ceil(8 * arguments.supersample));
    // doc: medium options
    let samples = arguments.fog.fog_samples;
    let options = MediumOptions { shadow_rays: shadows, samples, ..MediumOptions::default() };
    // doc end
    let view = renderer.fog_view(scene, [columns, rows, 64], (options, None))?;
    renderer.add_fog(&view, fog, seed)
}

/// The radiance of each sample.
fn colors(renderer: &mut SceneRenderer<'_>) -> Result<Vec<Vec3>, EngineError> {
    Ok(renderer.radiance()?.into_iter().map(glam::Vec4::truncate).collect())
}

/// Rounds of shadow rays, each with other random numbers, until little noise is left.
struct Rounds<'a> {
    arguments: &'a Arguments,
    /// The level of noise that is little.
    most: f64,
    /// Samples in a row.
    width: u32,
    /// As [`most_stops`] has it.
    most_stops: f32,
}

impl<'a> Rounds<'a> {
    /// None where one round is all that is asked for.
    fn of(arguments: &'a Arguments, width: u32, most_stops: f32) -> Option<Self> {
        let most = arguments.shadow_noise.filter(|_| arguments.shadow_level() != Shadows::Off)?;
        Some(Self { arguments, most, width, most_stops })
    }

    /// Goes on from what `seen` shows after the first round, before which there were `lamps` alone: the means
    /// of what surfaces reflect, their noise, and the time it took.
    fn go_on(
        &self,
        renderer: &mut SceneRenderer<'_>,
        view: &View,
        (lamps, seen): (&[Vec3], &[Vec3]),
        bar: &ProgressBar,
    ) -> Result<(Means, Option<f64>, Option<Duration>), EngineError> {
        let (mut means, mut total) = (Means::new(lamps.len()), Some(Duration::ZERO));
        let add = |means: &mut Means, before: &[Vec3], after: &[Vec3]| {
            let apart = before.iter().zip(after).map(|(a, b)| b.as_dvec3() - a.as_dvec3());
            means.add(&apart.collect::<Vec<DVec3>>(), 1);
        };
        add(&mut means, lamps, seen);
        let mut before = seen.to_vec();
        let mut noise = self.noise(&means, lamps);
        while means.samples() < MOST_ROUNDS && noise.is_none_or(|noise| noise > self.most) {
            // Each half of the means has seeds that follow each other, whose rays complement each other
            let [half, index] = [means.samples() % 2, means.samples() / 2];
            let seed = view.seed.wrapping_add(half * (MOST_ROUNDS / 2) + index);
            let took = view.shade(renderer, seed)?;
            total = total.zip(took).map(|(total, took)| total + took);
            // Each round is added to what is there
            let after = colors(renderer)?;
            add(&mut means, &before, &after);
            before = after;
            noise = self.noise(&means, lamps);
            bar.set_message(format!("bands, {} rounds of shadow rays", means.samples()));
        }
        Ok((means, noise, total))
    }

    /// The noise of what is known so far.
    fn noise(&self, means: &Means, lamps: &[Vec3]) -> Option<f64> {
        let stops = match self.arguments.exposure {
            Exposure::Stops(stops) => stops,
            Exposure::Auto => {
                let pixels: Vec<Vec3> = means.mean().into_iter().map(DVec3::as_vec3).collect();
                let height = pixels.len() as u32 / self.width.max(1);
                Picture { width: self.width, height, pixels }.auto_stops(lamps, self.most_stops)
            }
        };
        means.noise(self.width as usize, self.arguments.supersample as usize, stops)
    }
}

/// What a band is shaded with.
struct View {
    surfaces: Effects,
    quality: Quality,
    /// The first of the band's seeds.
    seed: u32,
    light_count: usize,
    /// What shadows are made with, for each pass; without shadows none.
    shadowed: Vec<ShadowedView>,
}

/// Shades what a renderer sees, as the arguments say.
fn shade(
    renderer: &mut SceneRenderer<'_>,
    view: &View,
    arguments: &Arguments,
    bar: &ProgressBar,
) -> Result<(Option<Duration>, Option<TileCounts>), EngineError> {
    let View { surfaces, quality, seed, light_count, .. } = *view;
    let took = match (arguments.reference, arguments.tiles) {
        (None, None) => view.shade(renderer, seed)?,
        (None, Some(cull_threshold)) => {
            let options = ShadeOptions { quality, output: Output::Add, ..ShadeOptions::default() };
            let tiles = TileOptions { cull_threshold, ..TileOptions::default() };
            // Of light that is reflected; what is let through is a pass of its own
            let mut counts = None;
            let took = renderer.each_pass(surfaces, |renderer, surfaces| {
                let view = renderer.tiled(ShadeOptions { surfaces, ..options }, tiles)?;
                let took = renderer.shade_tiled(&view)?;
                counts.get_or_insert(view.counts(light_count)?);
                Ok(took)
            })?;
            bar.inc(1);
            return Ok((took, counts));
        }
        (Some(samples), _) => {
            let samples = arguments.samples_a_subpixel(samples);
            let shadows = arguments.shadow_level() != Shadows::Off;
            let coupled = surfaces.contains(Effects::COUPLED);
            let reference = Reference { samples, shadows, coupled, seed };
            let before = bar.position();
            return Ok((
                renderer.reference(reference, |done| bar.set_position(before + u64::from(done)))?,
                None,
            ));
        }
    };
    bar.inc(1);
    Ok((took, None))
}

impl View {
    /// Shades with shadows, by the random numbers of a seed, or without.
    fn shade(&self, renderer: &mut SceneRenderer<'_>, seed: u32) -> Result<Option<Duration>, EngineError> {
        if self.shadowed.is_empty() {
            return renderer.shade(self.surfaces, self.quality);
        }
        renderer.shade_shadowed_passes(&self.shadowed, seed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight::LightShape;
    use std::f64::consts::PI;

    #[test]
    fn what_nothing_lights_is_lifted_by_ten_stops_over_a_white_sheet_at_most() {
        // A disk of radiance 2 and a square metre, ten metres away, and a sun of the same illuminance
        let disk = |radiance: f32, radius: f64, height: f64| Light {
            radiance: Vec3::splat(radiance),
            shape: LightShape::Disk {
                center: DVec3::Z * height,
                axis_u: DVec3::X * radius,
                axis_v: DVec3::NEG_Y * radius,
            },
            ..Light::default()
        };
        let lit_by = |lights: Vec<Light>| Scene { lights, ..Scene::default() };
        let side = (1.0 / PI).sqrt();
        let expected = (AUTO_LUMINANCE / (2.0 / 100.0 / std::f32::consts::PI)).log2() + 10.0;
        for scene in [lit_by(vec![disk(2.0, side, 10.0)]), lit_by(vec![disk(2e4, side * 10.0, 1e4)])] {
            assert!((most_stops(&scene) - expected).abs() < 1e-3, "{}", most_stops(&scene));
        }
        // The twin: no light, no bound
        assert_eq!(most_stops(&lit_by(vec![])), MAX_STOPS);
    }
}
