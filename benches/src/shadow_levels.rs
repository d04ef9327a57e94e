//! What shadows err at each level against the Monte Carlo reference, and what they take.

pub(crate) mod pictures;
mod text;

use crate::ladder::Spread;
use crate::ladder::frame::processors;
use crate::shadows::{ShadowErrors, ShadowTruth, SizeError, part_found};
use crate::textures::{clocked, is_software};
use arealight::plan::{Output, ShadeOptions, ShadowFilter, ShadowHistory};
use arealight::{Effects, LightTable};
use arealight_engine::host::Host;
use arealight_engine::{Engine, EngineError, Reference, ShadowedView};
use arealight_scene::{Scene, SceneBuffers};
use arealight_vk::{ShadowStage, TableFormat};
use glam::DVec3;
use pictures::Pictures;
pub use pictures::PicturesError;
use serde::{Deserialize, Serialize};

/// What to run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Pixels to a side of the pictures.
    pub size: u32,
    /// Samples a pixel of each of the two references, where there is one light. Many lights have fewer, as
    /// each sample is of all of them.
    pub samples: u32,
    /// Rounds in which time is taken.
    pub rounds: u32,
}

impl Default for Options {
    /// Under three minutes on two processors.
    fn default() -> Self {
        Self { size: 192, samples: 256, rounds: 3 }
    }
}

/// What progress adds up to, of a reference and of a level.
const REFERENCE_STEPS: u64 = 20;

/// Samples of all lights together that a pixel of a reference has, as a multiple of [`Options::samples`].
const MANY: u32 = 3;

impl Options {
    /// What progress adds up to over so many scenes.
    pub fn steps(&self, scenes: usize) -> u64 {
        scenes as u64 * (4 * REFERENCE_STEPS + Level::ALL.len() as u64)
    }

    fn samples_under(&self, lights: u32) -> u32 {
        (MANY * self.samples).div_ceil(lights.max(1)).min(self.samples)
    }
}

/// How many frames a history is of: as many as it keeps.
pub const FRAMES: u32 = 16;

/// A way to shadows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Level {
    /// Light passes through everything.
    Off,
    /// So many rays a pixel, as they are.
    Rays(u32),
    /// So many rays a pixel, filtered.
    Filtered(u32),
    /// So many rays a pixel, filtered over the frames before too: [`FRAMES`] at rest.
    History(u32),
}

impl Level {
    /// Every level, in the order of the tables.
    pub const ALL: [Self; 9] = [
        Self::Off,
        Self::Rays(1),
        Self::Rays(2),
        Self::Rays(4),
        Self::Filtered(1),
        Self::Filtered(2),
        Self::Filtered(4),
        Self::History(1),
        Self::History(2),
    ];

    /// How many rays a pixel has.
    pub fn rays(self) -> u32 {
        match self {
            Self::Off => 0,
            Self::Rays(rays) | Self::Filtered(rays) | Self::History(rays) => rays,
        }
    }

    /// As `arealight render --shadows` takes it.
    pub fn name(self) -> String {
        match self {
            Self::Off => "off".into(),
            Self::Rays(rays) => format!("rays:{rays}"),
            Self::Filtered(rays) => format!("filtered:{rays}"),
            Self::History(rays) => format!("filtered:{rays}, history"),
        }
    }
}

/// Milliseconds of a device for each pass of a frame; none of what a level has not.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct PassTimes {
    /// Shading without shadows, and picking lights and lobes for rays.
    pub shade: Option<Spread>,
    /// Drawing rays and tracing them.
    pub rays: Option<Spread>,
    /// Updating the history.
    pub history: Option<Spread>,
    /// Filtering rays, and multiplying the radiance.
    pub filter: Option<Spread>,
}

impl PassTimes {
    /// The medians' sum.
    pub fn sum(&self) -> f64 {
        [self.shade, self.rays, self.history, self.filter].iter().flatten().map(|time| time.median).sum()
    }
}

/// A level on a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LevelResult {
    /// The level.
    pub level: Level,
    /// Its errors, without the reference's noise.
    pub errors: ShadowErrors,
    /// Its times.
    pub milliseconds: PassTimes,
    /// Rays a second, of the rays' pass; none without rays.
    pub rays_per_second: Option<f64>,
}

/// Every level on a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneResult {
    /// The scene.
    pub name: String,
    /// How many lights it has.
    pub lights: usize,
    /// Triangles that block light.
    pub blockers: usize,
    /// Samples a pixel of each reference.
    pub samples: u32,
    /// The share of the lit pixels that are in a penumbra.
    pub penumbra: f64,
    /// The noise that was taken out of the squares.
    pub noise: ShadowErrors,
    /// The levels.
    pub levels: Vec<LevelResult>,
}

/// What a run found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShadowLevels {
    /// The device.
    pub device: String,
    /// Whether it is a processor, whose times are those of all its threads, over their number.
    pub is_software: bool,
    /// [`Options::size`].
    pub size: u32,
    /// [`Options::rounds`].
    pub rounds: u32,
    /// Each scene.
    pub scenes: Vec<SceneResult>,
}

/// Runs every level on each scene. `progress` is told of steps done.
pub fn run(
    host: &Host,
    table: &LightTable,
    scenes: &[Scene],
    options: &Options,
    progress: &dyn Fn(u64),
) -> Result<ShadowLevels, PicturesError> {
    let mut engine = Engine::new(host.clone(), table, TableFormat::default())?;
    let mut results = Vec::with_capacity(scenes.len());
    for scene in scenes {
        engine.load_scene_textures(scene, 1024)?;
        results.push(run_scene(&engine, scene, options, progress)?);
    }
    Ok(ShadowLevels {
        device: host.device_name(),
        is_software: is_software(host),
        size: options.size,
        rounds: options.rounds,
        scenes: results,
    })
}

fn run_scene(
    engine: &Engine,
    scene: &Scene,
    options: &Options,
    progress: &dyn Fn(u64),
) -> Result<SceneResult, PicturesError> {
    let (pictures, buffers, _) = Pictures::new(engine, scene, [options.size; 2])?;
    let surfaces = scene.effects() & Effects::SURFACES;
    let mut view = View { host: engine.host(), pictures, scene: &buffers, surfaces };
    let lights = view.pictures.renderer.lights();
    let samples = options.samples_under(lights.light_count + lights.shape_count);
    let truth = Truth::new(&mut view, samples, progress)?;

    let mut levels = vec![];
    for level in Level::ALL {
        levels.push(view.run(level, &truth, options.rounds)?);
        progress(1);
    }
    Ok(SceneResult {
        name: scene.name.clone(),
        lights: scene.lights.len(),
        blockers: scene.triangles.len(),
        samples,
        penumbra: truth.mean.penumbra(),
        noise: truth.noise,
        levels,
    })
}

/// The mean of two references, and its noise.
struct Truth {
    mean: ShadowTruth,
    noise: ShadowErrors,
}

impl Truth {
    fn new(view: &mut View<'_>, samples: u32, progress: &dyn Fn(u64)) -> Result<Self, PicturesError> {
        let mut picture = |seed, shadows| {
            let mut told = 0;
            view.pictures.begin()?;
            view.pictures.renderer.reference(
                Reference { samples, seed, shadows, ..Reference::default() },
                |done| {
                    let steps = REFERENCE_STEPS * u64::from(done) / u64::from(samples);
                    progress(steps - told);
                    told = steps;
                },
            )?;
            view.pictures.radiance()
        };
        let (shadowed, unshadowed) = (picture(1, true)?, picture(1, false)?);
        let others = (picture(2, true)?, picture(2, false)?);
        let mean = |a: &[DVec3], b: &[DVec3]| -> Vec<DVec3> {
            a.iter().zip(b).map(|(a, b)| 0.5 * (*a + *b)).collect()
        };
        let mean_unshadowed = mean(&unshadowed, &others.1);
        let truth = ShadowTruth::new(mean(&shadowed, &others.0), &mean_unshadowed)?;
        // Half their difference is what one is from the mean, and the noise of that
        let one = ShadowTruth::new(shadowed.clone(), &unshadowed)?;
        let parts: Vec<f64> = one.parts.iter().map(|part| part.unwrap_or(1.0)).collect();
        let noise = truth.errors(&parts, &shadowed)?;
        Ok(Self { mean: truth, noise })
    }

    fn errors(&self, shadows: &[f64], radiance: &[DVec3]) -> Result<ShadowErrors, SizeError> {
        Ok(self.mean.errors(shadows, radiance)?.without(&self.noise))
    }
}

/// A view of a scene, with what it takes to shade it.
struct View<'a> {
    host: &'a Host,
    pictures: Pictures<'a>,
    scene: &'a SceneBuffers,
    surfaces: Effects,
}

/// Seconds of each pass that a frame has: of [`PassTimes`].
type Seconds = [Option<f64>; 4];

impl View<'_> {
    fn options(&self, shadow_rays: u32, output: Output) -> ShadeOptions {
        ShadeOptions { surfaces: self.surfaces, shadow_rays, output, ..ShadeOptions::default() }
    }

    fn run(&mut self, level: Level, truth: &Truth, rounds: u32) -> Result<LevelResult, PicturesError> {
        // A picture, by which pipelines are made too
        let passes = self.passes(level)?;
        let radiance = self.picture(level, passes.as_ref())?;
        let unshadowed = match &passes {
            Some(passes) => pictures::unshadowed(passes)?,
            None => radiance.clone(),
        };
        let pixels = radiance.iter().zip(&unshadowed);
        let shadows: Vec<f64> = pixels.map(|(with, without)| part_found(*with, *without)).collect();

        // Its time
        let mut seconds = vec![];
        for round in 0..rounds {
            seconds.push(self.shade(passes.as_ref(), FRAMES + round)?);
        }
        let processors = if is_software(self.host) { processors() } else { 1.0 };
        let time = |pass: usize| {
            let all: Option<Vec<f64>> = seconds.iter().map(|times| times[pass]).collect();
            all.filter(|all| !all.is_empty()).map(|all| Spread::of(&all).times(1e3 / processors))
        };
        let milliseconds = PassTimes { shade: time(0), rays: time(1), history: time(2), filter: time(3) };
        let rays = truth.mean.parts.iter().flatten().count() as f64 * f64::from(level.rays());
        Ok(LevelResult {
            level,
            errors: truth.errors(&shadows, &radiance)?,
            milliseconds,
            rays_per_second: milliseconds.rays.map(|time| 1e3 * rays / time.median),
        })
    }

    /// What a level with rays needs on the device.
    fn passes(&self, level: Level) -> Result<Option<ShadowedView>, EngineError> {
        let (none, gather) = (ShadowHistory::Off, ShadowFilter::Gather);
        let (rays, filter) = match level {
            Level::Off => return Ok(None),
            Level::Rays(rays) => (rays, (ShadowFilter::Off, none)),
            Level::Filtered(rays) => (rays, (gather, none)),
            Level::History(rays) => (rays, (gather, ShadowHistory::Camera)),
        };
        let options = self.options(rays, Output::default());
        self.pictures.renderer.shadowed(self.scene, options, filter).map(Some)
    }

    /// The radiance by a level.
    fn picture(&mut self, level: Level, passes: Option<&ShadowedView>) -> Result<Vec<DVec3>, EngineError> {
        let frames = if matches!(level, Level::History(_)) { FRAMES } else { 1 };
        for frame in 0..frames {
            self.pictures.begin()?;
            self.shade(passes, frame)?;
        }
        self.pictures.radiance()
    }

    fn shade(&mut self, passes: Option<&ShadowedView>, seed: u32) -> Result<Seconds, EngineError> {
        let plain = self.options(0, Output::Add);
        let (host, renderer) = (self.host, &mut self.pictures.renderer);
        let Some(passes) = passes else {
            return Ok([Some(clocked(host, || renderer.shade_as(plain))?), None, None, None]);
        };
        let mut seconds = [Some(clocked(host, || renderer.shade_picking(passes, seed))?), None, None, None];
        for stage in passes.stages() {
            let place = match stage {
                ShadowStage::Rays => 1,
                ShadowStage::History => 2,
                ShadowStage::Filter => 3,
            };
            seconds[place] = Some(clocked(host, || renderer.shadow_stage(passes, *stage, seed))?);
        }
        Ok(seconds)
    }
}
