//! The rendering of a picture.

use super::Arguments;
use super::bands::{Band, MOST_SAMPLES};
use super::frames::Frame;
use super::rounds::{MOST_ROUNDS, Rounds};
use crate::edges::{self, Sight};
use crate::picture::{AUTO_LUMINANCE, Exposure, Format, MAX_STOPS, Picture};
use crate::progress;
use crate::shadows::Shadows;
use arealight::plan::{MediumOptions, Output, ShadeOptions, ShadowFilter, ShadowHistory, TileOptions};
use arealight::{Effects, Light, Quality, reach};
use arealight_engine::{
    BlockerBuffers, Engine, EngineError, Fog, Reference, SceneRenderer, ShadowedView, TileCounts,
};
use arealight_scene::{Camera, Scene, SceneBuffers};
use arealight_tool_kernels::gpu::VisibilityConstants;
use glam::Vec3;
use indicatif::ProgressBar;
use std::rc::Rc;
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
    /// Shadow rays a sample: the most that a part of the picture has, and those of all in the mean.
    rays: [f64; 2],
    /// Their noise in levels of 255, where it is known: of the band that has most.
    pub noise: Option<f64>,
}

/// Both times, where both are known.
fn sum(all: Option<Duration>, one: Option<Duration>) -> Option<Duration> {
    all.zip(one).map(|(all, one)| all + one)
}

/// The most bands: rows of the largest picture.
const MOST_BANDS: u32 = 1 << 16;

impl Outcome {
    /// A picture of `size` without a row yet.
    fn begin([width, height]: [u32; 2]) -> Self {
        let picture = Picture { width, height, ..Picture::default() };
        let none = Some(Duration::ZERO);
        Self {
            visibility: none,
            shading: none,
            fog: None,
            tiles: None,
            picture,
            stops: 0.0,
            rays: [0.0; 2],
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
        self.visibility = sum(self.visibility, visibility);
        self.shading = sum(self.shading, shading);
        self.picture.pixels.extend(pixels);
        self.tiles = match (self.tiles.take(), tiles) {
            (Some(all), Some(one)) => Some(all + one),
            (all, one) => all.or(one),
        };
    }

    /// With the times of a picture before.
    #[must_use]
    pub fn after(self, before: Option<Self>) -> Self {
        let Some(before) = before else { return self };
        Self {
            visibility: sum(before.visibility, self.visibility),
            shading: sum(before.shading, self.shading),
            fog: sum(before.fog, self.fog),
            ..self
        }
    }

    /// The shadow rays that pixels of so many samples have had, at most and in the mean.
    pub fn rays(&self, samples: u32) -> Option<[f64; 2]> {
        (self.rays[0] > 0.0).then(|| self.rays.map(|rays| rays * f64::from(samples)))
    }

    /// Those in words, and what noise they left.
    pub fn rays_text(&self, samples: u32) -> Option<String> {
        let [most, mean] = self.rays(samples)?;
        Some(match self.noise {
            None => format!("shadows  {most} rays a pixel"),
            Some(noise) => format!(
                "shadows  {mean:.1} rays a pixel, {most} where they are noisiest; their noise is {noise:.2} levels \
                 of 255"
            ),
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
    (arguments, frame): (&Arguments, &mut Frame),
) -> Result<Outcome, EngineError> {
    let buffers = SceneBuffers::new(scene, frame.origin)?;
    let supersample = arguments.supersample;
    let whole = VisibilityConstants { supersample, ..buffers.constants(camera, size, Vec3::ZERO) };
    let bands = Band::of(size, MOST_SAMPLES);
    let bar = match arguments.reference {
        _ if arguments.film.frames.is_some() => ProgressBar::hidden(),
        Some(samples) => {
            let samples = u64::from(arguments.samples_a_subpixel(samples));
            progress::bar(bands.len() as u64 * samples, "samples a subpixel")
        }
        None => progress::bar(bands.len() as u64, "bands"),
    };
    let mut sum = Outcome::begin(size);
    let (mut emission, mut materials) = (vec![], vec![]);
    let fog = arguments.fog.of(scene, camera);
    let most_stops = most_stops(scene);
    // A film's shadows go on from the frame before. A picture in bands would need a history a band
    let has_history = arguments.film.frames.is_some() && arguments.shadow_noise.is_none() && bands.len() == 1;
    let history = if has_history { ShadowHistory::Camera } else { ShadowHistory::Off };
    let first_seed = arguments.seed.wrapping_add(frame.index);
    for (index, band) in bands.iter().enumerate() {
        let in_band = band.size(size[0]);
        let camera = band.camera(whole, size[1]);
        let mut renderer = SceneRenderer::new(engine, &buffers, &scene.lights, camera, in_band)?;
        let visibility = renderer.visibility()?;
        if edges::FACTORS.contains(&supersample) {
            let material = |triangle: u32| buffers.triangles[triangle as usize].material;
            let seen = band.keep(size[0], renderer.triangles()?);
            materials.extend(seen.into_iter().map(|triangle| triangle.map(material)));
        }
        // So far there is what lamps show of themselves
        let lamps = colors(&mut renderer)?;
        // Frames of a film, bands and rounds each have seeds of their own, one after the other
        let of_band = || first_seed.wrapping_mul(MOST_BANDS).wrapping_add(index as u32);
        let seed = if has_history { first_seed } else { of_band().wrapping_mul(MOST_ROUNDS) };
        let shadows = match arguments.shadow_level() {
            Shadows::Rays(shadow_rays, filter) if arguments.reference.is_none() => {
                let options = ShadeOptions { surfaces, quality, shadow_rays, ..ShadeOptions::default() };
                let blockers = renderer.blockers(&buffers)?;
                let mut passes = std::mem::take(&mut frame.shadows);
                for pass in &mut passes {
                    renderer.take_over(pass, &blockers)?;
                }
                if passes.is_empty() {
                    passes = renderer.shadowed_passes(&blockers, options, (filter, history))?;
                }
                Some(ViewShadows { blockers, options, filter, passes })
            }
            _ => None,
        };
        let mut view = View { surfaces, quality, seed, light_count: scene.lights.len(), shadows };
        let (mut shading, tiles) = shade(&mut renderer, &view, arguments, &bar)?;
        let mut found = colors(&mut renderer)?;
        let stops = || match frame.exposure {
            Exposure::Stops(stops) => stops,
            Exposure::Auto => {
                let [width, height] = in_band;
                let pixels = found.clone();
                Picture { width, height, pixels, ..Picture::default() }.auto_stops(&lamps, most_stops)
            }
        };
        if let Some(rounds) = Rounds::of(arguments, &view, in_band, stops) {
            let converged = rounds.go_on(&renderer, (&lamps, &found), &bar)?;
            shading = self::sum(shading, converged.took);
            found = converged.picture;
            let [most, mean] = converged.rays;
            let part = f64::from(band.kept.end - band.kept.start) / f64::from(size[1]);
            sum.rays = [sum.rays[0].max(most), sum.rays[1] + mean * part];
            if fog.is_some() {
                renderer.show(&found)?;
            }
            sum.noise = Some(sum.noise.unwrap_or(0.0).max(converged.noise));
        } else if let Some(shadows) = &view.shadows {
            sum.rays = [f64::from(shadows.options.shadow_rays); 2];
        }
        if let Some(fog) = &fog {
            let took =
                add_fog(&mut renderer, (&buffers, view.shadows.as_ref()), (fog, in_band, seed), arguments)?;
            sum.fog = took.map(|took| sum.fog.unwrap_or_default() + took);
            found = colors(&mut renderer)?;
        }
        if let Some(shadows) = view.shadows.take().filter(|_| has_history) {
            frame.shadows = shadows.passes;
        }
        if matches!(frame.exposure, Exposure::Auto) {
            emission.extend(band.keep(size[0], lamps));
        }
        sum.add(visibility, shading, tiles, band.keep(size[0], found));
    }
    bar.finish_and_clear();
    sum.stops = match frame.exposure {
        Exposure::Auto => sum.picture.auto_stops(&emission, most_stops),
        Exposure::Stops(stops) => stops,
    };
    if edges::FACTORS.contains(&supersample) {
        let sight = Sight { scene: &buffers, camera, materials, factor: supersample };
        // Radiance, which is not shown, is the same at every exposure
        let format = arguments.output.as_deref().map(Picture::check_format);
        let stops = if matches!(format, Some(Ok(Format::Exr))) { 0.0 } else { sum.stops };
        sum.picture.edges = sight.edges(&sum.picture, stops);
    }
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
    (scene, shadows): (&SceneBuffers, Option<&ViewShadows>),
    (fog, size, seed): (&Fog, [u32; 2], u32),
    arguments: &Arguments,
) -> Result<Option<Duration>, EngineError> {
    let shadow_rays = arguments.casts_shadows();
    if let Some(samples) = arguments.reference {
        let samples = arguments.samples_a_subpixel(samples);
        return renderer.fog_reference(fog, samples, (shadow_rays, seed), |_| ());
    }
    // A beam is a few froxels wide in small pictures, too
    let froxel = (arguments.size[0] / 96).clamp(2, 8) * arguments.supersample;
    let [columns, rows] = size.map(|side| side.div_ceil(froxel));
    // doc: medium options
    let samples = arguments.fog.fog_samples;
    let options = MediumOptions { shadow_rays, samples, ..MediumOptions::default() };
    // doc end
    let blockers = shadows.map_or_else(|| renderer.blockers(scene), |of| Ok(Rc::clone(&of.blockers)))?;
    let view = renderer.fog_view(&blockers, [columns, rows, 64], (options, None))?;
    renderer.add_fog(&view, fog, seed)
}

/// The radiance of each sample.
pub fn colors(renderer: &mut SceneRenderer<'_>) -> Result<Vec<Vec3>, EngineError> {
    Ok(renderer.radiance()?.into_iter().map(glam::Vec4::truncate).collect())
}

/// What a band is shaded with.
pub struct View {
    surfaces: Effects,
    quality: Quality,
    /// The first of the band's seeds.
    pub seed: u32,
    light_count: usize,
    pub shadows: Option<ViewShadows>,
}

/// What shadows are made with.
pub struct ViewShadows {
    pub blockers: Rc<BlockerBuffers>,
    pub options: ShadeOptions,
    pub filter: ShadowFilter,
    passes: Vec<ShadowedView>,
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
        (None, None) => match &view.shadows {
            None => renderer.shade(surfaces, quality)?,
            Some(shadows) => renderer.shade_shadowed_passes(&shadows.passes, seed)?,
        },
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
            let shadows = arguments.casts_shadows();
            let coupled = surfaces.contains(Effects::COUPLED);
            let by_albedo = surfaces.contains(Effects::COUPLED_BY_ALBEDO);
            let reference = Reference { samples, shadows, coupled, by_albedo, seed };
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

impl ViewShadows {
    /// Of each sample, whether a ray was hidden.
    pub fn hidden(&self) -> Result<Vec<bool>, EngineError> {
        let mut hidden = vec![];
        for pass in &self.passes {
            let shadows = pass.shadows()?;
            hidden.resize(shadows.len(), false);
            hidden.iter_mut().zip(shadows).for_each(|(hidden, shadow)| {
                *hidden |= shadow.z > 0.0 && shadow.x < 1.0;
            });
        }
        Ok(hidden)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight::LightShape;
    use glam::DVec3;
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
