//! The rendering of a picture.

use super::Arguments;
use super::bands::{Band, MOST_SAMPLES};
use crate::picture::{Exposure, Picture};
use crate::progress;
use crate::shadows::Shadows;
use arealight::plan::{Output, ShadeOptions, ShadowHistory, TileOptions};
use arealight::{Effects, Quality};
use arealight_engine::{Engine, EngineError, Reference, SceneRenderer, TileCounts};
use arealight_scene::{Camera, Scene, SceneBuffers};
use glam::Vec3;
use indicatif::ProgressBar;
use std::time::Duration;

/// What a render took, for the summary.
pub struct Outcome {
    pub visibility: Option<Duration>,
    pub shading: Option<Duration>,
    pub tiles: Option<TileCounts>,
    pub picture: Picture,
    /// The exposure that the picture has.
    pub stops: f32,
}

impl Outcome {
    /// A picture of `size` without a row yet.
    fn begin([width, height]: [u32; 2]) -> Self {
        let picture = Picture { width, height, pixels: vec![] };
        let none = Some(Duration::ZERO);
        Self { visibility: none, shading: none, tiles: None, picture, stops: 0.0 }
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
    for (index, band) in bands.iter().enumerate() {
        let in_band = band.size(size[0]);
        let camera = band.camera(whole, size[1]);
        let mut renderer = SceneRenderer::new(engine, &buffers, &scene.lights, camera, in_band)?;
        let visibility = renderer.visibility()?;
        // So far there is what lamps show of themselves
        if matches!(arguments.exposure, Exposure::Auto) {
            emission.extend(band.keep(size[0], colors(&mut renderer)?));
        }
        let view = View { surfaces, quality, index: index as u32, light_count: scene.lights.len() };
        let (shading, tiles) = shade(&mut renderer, &buffers, &view, arguments, &bar)?;
        sum.add(visibility, shading, tiles, band.keep(size[0], colors(&mut renderer)?));
    }
    bar.finish_and_clear();
    sum.stops = match arguments.exposure {
        Exposure::Auto => sum.picture.auto_stops(&emission),
        Exposure::Stops(stops) => stops,
    };
    Ok(sum)
}

/// The radiance of each sample.
fn colors(renderer: &mut SceneRenderer<'_>) -> Result<Vec<Vec3>, EngineError> {
    Ok(renderer.radiance()?.into_iter().map(glam::Vec4::truncate).collect())
}

/// What a band is shaded with.
struct View {
    surfaces: Effects,
    quality: Quality,
    /// Of the band.
    index: u32,
    light_count: usize,
}

/// Shades what a renderer sees, as the arguments say.
fn shade(
    renderer: &mut SceneRenderer<'_>,
    scene: &SceneBuffers,
    view: &View,
    arguments: &Arguments,
    bar: &ProgressBar,
) -> Result<(Option<Duration>, Option<TileCounts>), EngineError> {
    let View { surfaces, quality, index, light_count } = *view;
    let took = match (arguments.reference, arguments.tiles) {
        (None, None) => {
            let shadows = arguments.shadow_level();
            shade_with_shadows(renderer, scene, (surfaces, quality), (shadows, index))?
        }
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
            let reference = Reference { samples, shadows, coupled, seed: index };
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

/// Shades a view with shadows, by the random numbers of a seed, or without.
fn shade_with_shadows(
    renderer: &mut SceneRenderer<'_>,
    scene: &SceneBuffers,
    (surfaces, quality): (Effects, Quality),
    (shadows, seed): (Shadows, u32),
) -> Result<Option<Duration>, EngineError> {
    let Shadows::Rays(shadow_rays, filter) = shadows else { return renderer.shade(surfaces, quality) };
    let options = ShadeOptions { quality, shadow_rays, ..ShadeOptions::default() };
    renderer.each_pass(surfaces, |renderer, surfaces| {
        let options = ShadeOptions { surfaces, ..options };
        let view = renderer.shadowed(scene, options, (filter, ShadowHistory::Off))?;
        renderer.shade_shadowed(&view, seed)
    })
}
