//! A scene through some of the methods, to be seen.

use super::LONG;
use super::frame::Frame;
use super::methods::{CASES_PUBLISHED, CLIPLESS_PUBLISHED, DEFAULT, Method, SPHERE_PUBLISHED};
use super::reference::{PictureError, Reference};
use crate::school::{School, YardstickTable};
use crate::textures::is_software;
use arealight::{Effects, Horizon, Level, LightTable, Quality, SpecularLobes};
use arealight_engine::host::Host;
use arealight_engine::{Engine, EngineError, SceneRenderer};
use arealight_scene::{Scene, SceneBuffers};
use arealight_vk::TableFormat;
use glam::{DVec3, Vec3};

/// What a method makes of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// The method's name.
    pub name: &'static str,
    /// What surfaces reflect, row after row from the top.
    pub reflected: Vec<DVec3>,
    /// Against the reference, where no light is seen.
    pub error: PictureError,
    /// Milliseconds of the frame.
    pub milliseconds: f64,
}

/// The pictures.
#[derive(Debug, Clone, PartialEq)]
pub struct Pictures {
    /// The scene's name.
    pub scene: String,
    /// Its lights.
    pub lights: usize,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// What the camera sees of the lights.
    pub emitted: Vec<DVec3>,
    /// Monte Carlo of many samples: the mean of two independent halves.
    pub reference: Vec<DVec3>,
    /// How many samples, in both halves.
    pub samples: u32,
    /// Each method's.
    pub shown: Vec<Picture>,
}

const SIZE: [u32; 2] = [320, 180];

/// How many long steps of progress [`make`] tells of.
pub const STEPS: usize = 11;

/// How many units of progress [`beside_the_truth`] tells of, for each scene.
pub const STEPS_BESIDE_THE_TRUTH: u64 = 4 * LONG;

/// Runs a frame so often, for its time.
const REPEATS: usize = 5;

/// What a picture is rendered with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct View {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples of the reference, in both halves.
    pub samples: u32,
    /// Frames whose time is taken; with 0 the time is NaN.
    pub repeats: usize,
}

/// What of a scene is shaded: its diffuse lobes are added, not coupled, in every method, as the reference
/// adds them.
fn effects_of(scene: &Scene) -> Effects {
    scene.effects() - Effects::COUPLED - Effects::COUPLED_BY_ALBEDO
}

/// Renders scenes, such as the frames of a film, by the two methods that stand beside the truth in a
/// document: the default level, and a yardstick with a table of published quality. The scenes share the first
/// one's textures.
pub fn beside_the_truth(
    host: &Host,
    table: &LightTable,
    scenes: &[Scene],
    view: View,
    progress: &dyn Fn(u64),
) -> Result<Vec<Pictures>, EngineError> {
    let mut engine = Engine::new(host.clone(), table, TableFormat::default())?;
    if let Some(scene) = scenes.first() {
        engine.load_scene_textures(scene, 256)?;
    }
    scenes.iter().map(|scene| render(&engine, scene, &duel(scene), view, progress)).collect()
}

/// The default level, and the yardstick that is for the scene's lights.
fn duel(scene: &Scene) -> [(&'static str, Method); 2] {
    let effects = effects_of(scene);
    let (name, school) = yardstick_for(scene);
    let published = Method::Yardstick { effects, school, table: YardstickTable::PublishedQuality };
    [(DEFAULT, Method::Level { effects, quality: Quality::default() }), (name, published)]
}

/// The yardstick for a scene's polygons: clip by cases where they are quads, else the clipped sphere.
pub fn yardstick_for(scene: &Scene) -> (&'static str, School) {
    if effects_of(scene).contains(Effects::POLYGON) {
        (SPHERE_PUBLISHED, School::SphereHorizon)
    } else {
        (CASES_PUBLISHED, School::ClipByCases)
    }
}

/// What is shown: yardsticks as they are shipped, with their table, but for scenes that are too much for
/// them; quality levels; and Monte Carlo.
fn methods(scene: &Scene) -> Vec<(&'static str, Method)> {
    let effects = effects_of(scene);
    let level = |quality| Method::Level { effects, quality };
    let yardstick = |school| Method::Yardstick { effects, school, table: YardstickTable::PublishedQuality };
    let exact = Quality::default();
    let mut methods = vec![
        (CLIPLESS_PUBLISHED, yardstick(School::Clipless)),
        (SPHERE_PUBLISHED, yardstick(School::SphereHorizon)),
        (CASES_PUBLISHED, yardstick(School::ClipByCases)),
        ("exact", level(exact)),
        ("two lobes", level(Quality { specular_lobes: SpecularLobes::Two, ..exact })),
        ("both horizons", level(Quality { horizon: Horizon::Both, ..exact })),
        ("finest", level(Level::Finest.quality())),
        ("Monte Carlo, 1 sample", Method::Samples { count: 1 }),
        ("Monte Carlo, 16 samples", Method::Samples { count: 16 }),
    ];
    methods.retain(|(_, method)| match method {
        Method::Yardstick { school, .. } => {
            let is_for_quads = *school == School::ClipByCases && effects.contains(Effects::POLYGON);
            !is_for_quads && !effects.intersects(Effects::TEXTURED)
        }
        Method::Level { .. } | Method::Samples { .. } => true,
    });
    methods
}

/// Renders a scene by every method, and by `samples` of Monte Carlo.
pub fn make(
    engine: &Engine,
    table: &LightTable,
    scene: &Scene,
    samples: u32,
    progress: &dyn Fn(u64),
) -> Result<Pictures, EngineError> {
    let mut engine = Engine::new(engine.host().clone(), table, TableFormat::default())?;
    engine.load_scene_textures(scene, 256)?;
    let size = if is_software(engine.host()) { SIZE } else { SIZE.map(|side| side * 2) };
    render(&engine, scene, &methods(scene), View { size, samples, repeats: REPEATS }, progress)
}

/// Renders a scene, whose textures the engine has, by some methods.
fn render(
    engine: &Engine,
    scene: &Scene,
    methods: &[(&'static str, Method)],
    view: View,
    progress: &dyn Fn(u64),
) -> Result<Pictures, EngineError> {
    let size = view.size;
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    let camera = scene.cameras.first().cloned().unwrap_or_else(|| scene.framing_camera(aspect));
    let buffers = SceneBuffers::new(scene, camera.position)?;
    let constants = buffers.constants(&camera, size, Vec3::ZERO);
    let mut renderer = SceneRenderer::new(engine, &buffers, &scene.lights, constants, size)?;
    renderer.visibility()?;
    let emitted: Vec<DVec3> =
        renderer.radiance()?.into_iter().map(|texel| texel.truncate().as_dvec3()).collect();
    let seen_from = constants.position();
    let frame = Frame::new(engine, renderer.g_buffer(), &scene.lights, buffers.origin, seen_from)?;

    // Two independent halves, whose difference is the reference's noise
    let ready = frame.ready(Method::Samples { count: view.samples.div_ceil(2) })?;
    let half = |seed| {
        let half = frame.shaded(&ready, seed)?;
        progress(LONG);
        Ok::<_, EngineError>(half)
    };
    let reference = Reference::new([half(1)?, half(3)?]);
    // On a light's own surface its form factor jumps
    let is_judged: Vec<bool> = emitted.iter().map(|emitted| *emitted == DVec3::ZERO).collect();
    let mut shown = vec![];
    for (name, method) in methods {
        let ready = frame.ready(*method)?;
        let reflected = frame.shaded(&ready, 2)?;
        let error = reference.error_of(&reflected, &is_judged);
        let seconds =
            (0..view.repeats).map(|_| frame.run(&ready, u32::MAX, 0)).collect::<Result<Vec<_>, _>>()?;
        let milliseconds = 1e3 * super::timing::quantile(&seconds, 0.5);
        shown.push(Picture { name, reflected, error, milliseconds });
        progress(LONG);
    }
    let (lights, scene) = (scene.lights.len(), scene.name.clone());
    let (reference, samples) = (reference.mean(), 2 * view.samples.div_ceil(2));
    Ok(Pictures { scene, lights, size, emitted, reference, samples, shown })
}
