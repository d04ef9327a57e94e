//! A scene on the device, drawn as the state says: what has changed since the last frame alone is done again.

use super::costs::{Cost, Tried};
use super::lamps::{self, Edit};
use super::orbit::Orbit;
use super::state::{Mode, Partner, State};
use crate::means::{Distance, Means};
use crate::shadows::Shadows;
use arealight::plan::{MediumOptions, ShadeOptions, ShadowHistory};
use arealight::{Effects, Level, Light};
use arealight_benches::ladder::{SHADE_YARDSTICK, yardstick_for};
use arealight_benches::published;
use arealight_engine::{Engine, EngineError, Fog, FogView, Reference, SceneRenderer, ShadowedView};
use arealight_scene::{Scene, SceneBuffers, SceneFog};
use arealight_vk::TableFormat;
use glam::{DVec3, Vec3};
use std::time::Duration;

/// The devices' tables and pipelines, which outlive what is drawn.
pub struct Engines {
    ours: Engine,
    /// With the table of a yardstick; none where there is no yardstick for the lights.
    yardstick: Option<Engine>,
}

impl Engines {
    /// With what the yardstick for the scene needs.
    pub fn new(ours: Engine, scene: &Scene) -> Result<Self, EngineError> {
        // Yardsticks shade polygons of one colour
        let others = Effects::SHAPES | Effects::IMAGES;
        let yardstick = if scene.effects().intersects(others) {
            None
        } else {
            Some(Engine::new(ours.host().clone(), &published::table(), TableFormat::default())?)
        };
        Ok(Self { ours, yardstick })
    }

    /// Whether there is a yardstick for the scene.
    pub fn has_yardstick(&self) -> bool {
        self.yardstick.is_some()
    }
}

/// What lamps are, and how rough surfaces are.
#[derive(Debug, Clone, PartialEq)]
struct Placed {
    lamps: Vec<Edit>,
    rougher: f32,
}

/// What a picture is of: another needs other pixels.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Seen {
    placed: Placed,
    /// Of images that move.
    frames: Vec<Option<usize>>,
    orbit: Orbit,
    shadows: bool,
    fog: Option<SceneFog>,
}

/// A picture that was drawn.
struct Drawn {
    of: (Seen, Level),
    /// Of as many rounds of shadow rays as it has samples.
    means: Means,
    radiance: Vec<DVec3>,
    time: Option<Duration>,
}

/// Rounds of shadow rays after which a picture at rest stays as it is.
const MOST_ROUNDS: u32 = 64;

impl Drawn {
    /// Whether another round would change nothing, or no more than is seen.
    fn is_done(&self) -> bool {
        !self.of.0.shadows || self.means.samples() >= MOST_ROUNDS
    }
}

/// A scene, and what was drawn of it last.
pub struct Viewer<'a> {
    engines: &'a Engines,
    /// As it was read.
    original: Scene,
    /// As it is.
    scene: Scene,
    placed: Placed,
    /// Of images that move.
    frames: Vec<Option<usize>>,
    buffers: SceneBuffers,
    pub(super) renderer: SceneRenderer<'a>,
    yardstick: Option<SceneRenderer<'a>>,
    shadowed: Option<(Level, Vec<ShadowedView>)>,
    /// With shadows or without.
    fogged: Option<(bool, FogView)>,
    size: [u32; 2],
    /// Of the renderers' cameras.
    looks: Option<Orbit>,
    /// Our renderer has found the surfaces, and nothing was shaded since: its radiance is what lamps emit.
    is_unshaded: bool,
    visibility: Option<Duration>,
    emission: Vec<DVec3>,
    ours: Option<Drawn>,
    theirs: Option<Drawn>,
    truth: Option<(Seen, Means)>,
    pub(super) tried: Option<(Seen, Vec<Tried>)>,
    /// Levels that were shaded before, with shadows or without, for lights of these effects: their pipelines
    /// are compiled.
    compiled: Vec<(Level, bool, Effects)>,
}

/// What there is to show.
pub struct Shown<'v> {
    /// With its lamps as they are.
    pub scene: &'v Scene,
    /// The picture's size.
    pub size: [u32; 2],
    /// Our radiance.
    pub ours: &'v [DVec3],
    /// What it is wiped against, or how far from: that of the yardstick or the truth.
    pub other: Option<Vec<DVec3>>,
    /// Radiance of the lamps themselves.
    pub emission: &'v [DVec3],
    /// The device's time of finding surfaces and of shading them.
    pub times: [Option<Duration>; 2],
    /// What the surfaces and lights need.
    pub effects: Effects,
    /// Samples of the truth so far, and how far our picture is from it.
    pub truth: Option<(u32, Option<Distance>)>,
    /// The yardstick's name.
    pub yardstick: &'static str,
    /// What each level costs, and every effect but one, where that is asked for, as far as it is measured.
    pub costs: Vec<Cost>,
    /// How many of the costs are measured, and how many there will be.
    pub measured: [usize; 2],
}

impl Shown<'_> {
    /// The same, with no time known.
    #[must_use]
    pub fn without_times(mut self) -> Self {
        self.costs.iter_mut().for_each(|cost| cost.milliseconds = None);
        Self { times: [None; 2], ..self }
    }
}

impl<'a> Viewer<'a> {
    /// Uploads a scene.
    ///
    /// # Errors
    /// [`EngineError`] names what is too large for the device.
    pub fn new(engines: &'a Engines, scene: Scene, size: [u32; 2]) -> Result<Self, EngineError> {
        let placed = Placed { lamps: vec![Edit::NONE; scene.lamps.len()], rougher: 0.0 };
        let (buffers, renderer, yardstick) = upload(engines, &scene, size)?;
        Ok(Self {
            engines,
            original: scene.clone(),
            frames: vec![None; scene.images.len()],
            scene,
            placed,
            buffers,
            renderer,
            yardstick,
            shadowed: None,
            fogged: None,
            size,
            looks: None,
            is_unshaded: false,
            visibility: None,
            emission: vec![],
            ours: None,
            theirs: None,
            truth: None,
            tried: None,
            compiled: vec![],
        })
    }

    /// The scene as it is, with lamps where they were moved to.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Whether the next picture differs, although nobody does anything: shadows or the truth converge.
    pub fn goes_on(&self, state: &State) -> bool {
        let truth_samples = self.truth.as_ref().map_or(0, |(_, truth)| truth.samples());
        self.measures(state)
            || state.plays && self.scene.has_moving_images()
            || state.needs_truth() && truth_samples < MOST_SAMPLES
            || self.ours.as_ref().is_some_and(|drawn| !drawn.is_done())
    }

    /// Whether costs are asked for, and not all of them measured.
    pub fn measures(&self, state: &State) -> bool {
        let [tried, trials] = self.measured();
        state.costs && tried < trials
    }

    /// Draws in another size from now on.
    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), EngineError> {
        if size == self.size {
            return Ok(());
        }
        self.size = size;
        self.upload()
    }

    /// Draws what the state asks for, and adds `samples` a pixel to the truth where that is a part of it.
    pub fn draw(&mut self, state: &State, samples: u32) -> Result<(), EngineError> {
        self.place(state)?;
        self.show_frames(state.time)?;
        let seen = self.seen(state);
        self.look(state.orbit)?;
        self.draw_ours(&seen, state.level)?;
        if state.mode == Mode::Wipe(Partner::Yardstick) {
            self.draw_theirs(&seen)?;
        }
        if state.needs_truth() && samples > 0 {
            self.add_truth(&seen, samples)?;
        }
        if state.costs {
            self.try_next(&seen)?;
        }
        Ok(())
    }

    fn seen(&self, state: &State) -> Seen {
        let (placed, shadows, fog) = (self.placed.clone(), state.has_shadows(), state.fog());
        Seen { placed, frames: self.frames.clone(), orbit: state.orbit, shadows, fog }
    }

    fn upload(&mut self) -> Result<(), EngineError> {
        (self.buffers, self.renderer, self.yardstick) = upload(self.engines, &self.scene, self.size)?;
        (self.shadowed, self.looks, self.ours, self.theirs) = (None, None, None, None);
        (self.truth, self.tried, self.fogged) = (None, None, None);
        Ok(())
    }

    /// Moves lamps, and makes surfaces as rough as the state says.
    fn place(&mut self, state: &State) -> Result<(), EngineError> {
        let placed = Placed { lamps: state.lamps.clone(), rougher: state.rougher };
        if placed == self.placed {
            return Ok(());
        }
        let mut scene = self.original.clone();
        scene.show_frames(state.time);
        lamps::edit(&mut scene, &placed.lamps);
        for material in &mut scene.materials {
            let roughness = material.material.roughness + placed.rougher;
            material.material.roughness = roughness.clamp(0.0, 1.0);
        }
        (self.scene, self.placed) = (scene, placed);
        self.upload()
    }

    /// Shows images that move as they are at a time.
    fn show_frames(&mut self, time: f64) -> Result<(), EngineError> {
        let frames = self.scene.frames_at(time);
        if self.frames != frames {
            self.frames = frames;
            self.scene.show_frames(time);
            self.engines.ours.show_frames(&self.scene)?;
            self.buffers.show_frames(&self.scene);
            self.renderer.set_texels(&self.buffers.texels)?;
            self.looks = None;
        }
        Ok(())
    }

    /// Finds the surfaces that the camera sees, and what it sees of lamps.
    fn look(&mut self, orbit: Orbit) -> Result<(), EngineError> {
        if self.looks == Some(orbit) {
            return Ok(());
        }
        let constants = self.buffers.constants(&orbit.camera(), self.size, Vec3::ZERO);
        for renderer in self.yardstick.iter_mut().chain([&mut self.renderer]) {
            renderer.look(constants);
        }
        self.visibility = self.renderer.visibility()?;
        self.emission = radiance(&mut self.renderer)?;
        self.looks = Some(orbit);
        self.is_unshaded = true;
        Ok(())
    }

    /// Takes back what our renderer has shaded, before it shades again.
    pub(super) fn begin(&mut self) -> Result<(), EngineError> {
        if !std::mem::take(&mut self.is_unshaded) {
            self.renderer.visibility()?;
        }
        Ok(())
    }

    fn draw_ours(&mut self, seen: &Seen, level: Level) -> Result<(), EngineError> {
        let of = (seen.clone(), level);
        let before = self.ours.take().filter(|drawn| drawn.of == of);
        let means = match before {
            Some(drawn) if drawn.is_done() => {
                self.ours = Some(drawn);
                return Ok(());
            }
            Some(drawn) => drawn.means,
            None => Means::new(self.emission.len()),
        };
        self.ours = Some(self.draw_round(of, means)?);
        Ok(())
    }

    /// Our picture once more, with other random numbers where it has any.
    fn draw_round(&mut self, of: (Seen, Level), mut means: Means) -> Result<Drawn, EngineError> {
        let seed = means.samples();
        let mut time = self.shade_once(&of, seed)?;
        let pipelines = (of.1, of.0.shadows, self.renderer.lights().effects);
        if !self.compiled.contains(&pipelines) {
            // The first time was the driver's compiler's
            time = self.shade_once(&of, seed)?;
            self.compiled.push(pipelines);
        }
        if let Some(fog) = self.fog(&of.0) {
            let [columns, rows] = self.size.map(|side| side.div_ceil(8));
            if self.fogged.as_ref().is_none_or(|(shadows, _)| *shadows != of.0.shadows) {
                let options = MediumOptions { shadow_rays: of.0.shadows, ..MediumOptions::default() };
                let blockers = self.renderer.blockers(&self.buffers)?;
                let view = self.renderer.fog_view(&blockers, [columns, rows, 64], (options, None))?;
                self.fogged = Some((of.0.shadows, view));
            }
            if let Some((_, view)) = &self.fogged {
                self.renderer.add_fog(view, &fog, seed)?;
            }
        }
        means.add(&radiance(&mut self.renderer)?, 1);
        Ok(Drawn { of, radiance: means.mean(), means, time })
    }

    fn shade_once(
        &mut self,
        (seen, level): &(Seen, Level),
        seed: u32,
    ) -> Result<Option<Duration>, EngineError> {
        self.begin()?;
        if seen.shadows { self.shade_with_shadows(*level, seed) } else { self.shade(*level) }
    }

    /// The fog of what is seen.
    fn fog(&self, seen: &Seen) -> Option<Fog> {
        seen.fog.map(|fog| Fog::of_scene(&self.scene, &seen.orbit.camera(), fog))
    }

    fn shade(&mut self, level: Level) -> Result<Option<Duration>, EngineError> {
        self.renderer.shade(self.scene.surfaces(), level.quality())
    }

    fn shade_with_shadows(&mut self, level: Level, seed: u32) -> Result<Option<Duration>, EngineError> {
        let Shadows::Rays(shadow_rays, filter) = Shadows::for_samples(1) else { return self.shade(level) };
        if self.shadowed.as_ref().is_none_or(|(of, _)| *of != level) {
            let (quality, surfaces) = (level.quality(), self.scene.surfaces());
            let options = ShadeOptions { quality, surfaces, shadow_rays, ..ShadeOptions::default() };
            let blockers = self.renderer.blockers(&self.buffers)?;
            let of = (filter, ShadowHistory::Off);
            let views = self.renderer.shadowed_passes(&blockers, options, of)?;
            self.shadowed = Some((level, views));
        }
        let views = self.shadowed.as_ref().map_or(&[][..], |(_, views)| views);
        self.renderer.shade_shadowed_passes(views, seed)
    }

    fn draw_theirs(&mut self, seen: &Seen) -> Result<(), EngineError> {
        let of = (seen.clone(), Level::default());
        let Some(renderer) = &mut self.yardstick else { return Ok(()) };
        if self.theirs.as_ref().is_some_and(|drawn| drawn.of == of) {
            return Ok(());
        }
        let (_, school) = yardstick_for(&self.scene);
        // Diffuse lobes are added, as where these are from
        let effects = self.scene.effects() - Effects::MODEL;
        renderer.visibility()?;
        let time = renderer.shade_by(&SHADE_YARDSTICK, &[(0, effects.bits()), (1, school as u32)])?;
        let mut radiance = radiance(renderer)?;
        // Lamps are shown as they are: a yardstick has no answer for a point on the light itself
        let ours = self.ours.as_ref().map_or(&[][..], |drawn| &drawn.radiance);
        for ((theirs, ours), emission) in radiance.iter_mut().zip(ours).zip(&self.emission) {
            if *emission != DVec3::ZERO {
                *theirs = *ours;
            }
        }
        let means = Means::new(0);
        self.theirs = Some(Drawn { of, means, radiance, time });
        Ok(())
    }

    fn add_truth(&mut self, seen: &Seen, samples: u32) -> Result<(), EngineError> {
        let pixels = self.emission.len();
        let mut truth = match self.truth.take() {
            Some((of, truth)) if of == *seen => truth,
            _ => Means::new(pixels),
        };
        if truth.samples() < MOST_SAMPLES {
            let coupled = self.scene.surfaces().contains(Effects::COUPLED);
            let (seed, shadows) = (truth.samples(), seen.shadows);
            let reference = Reference { samples, seed, shadows, coupled, ..Reference::default() };
            self.begin()?;
            self.renderer.reference(reference, |_| {})?;
            if let Some(fog) = self.fog(seen) {
                self.renderer.fog_reference(&fog, samples, (seen.shadows, truth.samples()), |_| {})?;
            }
            truth.add(&radiance(&mut self.renderer)?, samples);
        }
        self.truth = Some((seen.clone(), truth));
        Ok(())
    }

    /// Whether a pixel shows no lamp.
    pub(super) fn is_lit(&self, pixel: usize) -> bool {
        self.emission.get(pixel) == Some(&DVec3::ZERO)
    }

    /// What was drawn last, of this state.
    pub fn shown(&self, state: &State) -> Shown<'_> {
        let seen = &self.seen(state);
        let ours = self.ours.as_ref().map_or(&[][..], |drawn| &drawn.radiance);
        let truth = self.truth.as_ref().filter(|(of, _)| of == seen).map(|(_, truth)| truth);
        let other = match state.mode {
            Mode::Picture => None,
            Mode::Wipe(Partner::Yardstick) => self.theirs.as_ref().map(|drawn| drawn.radiance.clone()),
            Mode::Wipe(Partner::Truth) | Mode::Error => truth.map(Means::mean),
        };
        Shown {
            scene: &self.scene,
            size: self.size,
            ours,
            other,
            emission: &self.emission,
            times: [self.visibility, self.ours.as_ref().and_then(|drawn| drawn.time)],
            effects: self.scene.surfaces() | self.renderer.lights().effects,
            truth: truth.map(|truth| (truth.samples(), truth.distance(ours, |i| self.is_lit(i)))),
            yardstick: yardstick_for(&self.scene).0,
            costs: if state.costs { self.costs(seen, truth) } else { vec![] },
            measured: self.measured(),
        }
    }
}

/// Samples of the truth that are enough.
const MOST_SAMPLES: u32 = 1 << 14;

/// A scene's buffers, and what draws it by our table and by the yardstick's.
type Uploaded<'a> = (SceneBuffers, SceneRenderer<'a>, Option<SceneRenderer<'a>>);

fn upload<'a>(engines: &'a Engines, scene: &Scene, size: [u32; 2]) -> Result<Uploaded<'a>, EngineError> {
    // Everything on the device is relative to the scene's middle, about which the camera goes
    let buffers = SceneBuffers::new(scene, scene.bounds.center())?;
    let camera = scene.framing_camera(f64::from(size[0]) / f64::from(size[1]));
    let constants = buffers.constants(&camera, size, Vec3::ZERO);
    let renderer = SceneRenderer::new(&engines.ours, &buffers, &scene.lights, constants, size)?;
    // A yardstick's lights have no beam
    let bare: Vec<Light> =
        scene.lights.iter().map(|light| Light { profile: None, ..light.clone() }).collect();
    let yardstick = engines.yardstick.as_ref();
    let yardstick = yardstick.map(|engine| SceneRenderer::new(engine, &buffers, &bare, constants, size));
    Ok((buffers, renderer, yardstick.transpose()?))
}

pub(super) fn radiance(renderer: &mut SceneRenderer<'_>) -> Result<Vec<DVec3>, EngineError> {
    Ok(renderer.radiance()?.into_iter().map(|texel| texel.truncate().as_dvec3()).collect())
}
