//! `arealight render`: a picture of a glTF scene, lit by its polygon lights.

mod bands;
mod frames;
mod rounds;
mod shading;
mod summary;

use crate::failure::Failure;
use crate::gpu;
use crate::lights::{LightArguments, scene_name};
use crate::output::{self, say_beside};
use crate::picture::Exposure;
use crate::progress;
use crate::quality::{QualityArguments, name_of};
use crate::shadows::Shadows;
use arealight::Effects;
use arealight_engine::Fog;
use arealight_scene::{Camera, Scene, SceneFog};
use frames::{FilmArguments, Frame, Reel};
use shading::render;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use summary::{Phases, Summary};

/// Render a glTF scene: what emits is a light.
///
/// Visibility by traversal of a bounding volume hierarchy, shading by linearly transformed cosines, both on
/// the GPU, with shadows by rays that are drawn from the lobes.
#[derive(clap::Args)]
#[command(next_help_heading = "Picture")]
pub struct Arguments {
    /// A .gltf or .glb file; the built-in demo scene if absent
    scene: Option<PathBuf>,
    #[command(flatten)]
    lights: LightArguments,
    /// The picture: .png (exposed and tone-mapped) or .exr (radiance); `-` writes PNG to standard output;
    /// out/SCENE.png if absent. A film may be a .gif
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = parse_size)]
    size: [u32; 2],
    /// The file's camera of this name; its first one, or one that frames the scene, if absent
    #[arg(long, value_name = "NAME", help_heading = "Scene")]
    camera: Option<String>,
    #[command(flatten)]
    device: gpu::DeviceArgument,
    /// Integrate the true BRDF by Monte Carlo instead, with so many samples a pixel
    #[arg(long, value_name = "SPP", value_parser = clap::value_parser!(u32).range(1..=1 << 20))]
    reference: Option<u32>,
    /// Exposure of a .png in stops: radiance is multiplied by 2^EV; or auto: nine tenths of what is lit,
    /// lamps apart, have a luminance of at most 0.7
    #[arg(long, value_name = "EV", default_value = "0")]
    exposure: Exposure,
    /// Samples a pixel along each axis, against jagged edges; from 2 to 5, bright edges have 6 lines of sight
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=8))]
    supersample: u32,
    /// What surfaces are shaded with: `required` (what the scene's need), or a list of `diffuse`, `glossy`
    /// and `specular_input`, such as diffuse
    #[arg(long, value_name = "SET", default_value = "required", conflicts_with = "reference")]
    surfaces: SurfaceChoice,
    /// How layers of surfaces share light
    #[arg(long, value_enum, value_name = "MODEL", default_value = "gltf")]
    coupling: Coupling,
    /// Shade by tiles of 8 x 8 pixels, each by the lights that contribute to it; with FRACTION, less than 1,
    /// without the lights that together contribute less than this fraction of what the others do
    #[arg(long, value_name = "FRACTION", num_args = 0..=1, require_equals = true,
        default_missing_value = "0", value_parser = parse_part, conflicts_with = "reference")]
    tiles: Option<f32>,
    /// Shadows: off; or by N rays a sample, from 1 to 4, as they are (rays:N) or filtered over the penumbra
    /// (filtered:N). With --reference they are exact, or off [default: filtered, by four rays a pixel or one
    /// a sample; off with --tiles]
    #[arg(long, value_name = "LEVEL")]
    shadows: Option<Shadows>,
    /// Go on with shadow rays where they are noisy, until the noise of each part of the picture, in levels of
    /// 255 as the screen shows the means of 4 x 4 pixels, is below LEVELS; at most 64 rounds [default: one]
    #[arg(long, value_name = "LEVELS", value_parser = parse_levels,
        conflicts_with_all = ["tiles", "reference"])]
    shadow_noise: Option<f64>,
    /// Other random numbers
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u32,
    #[command(flatten)]
    film: FilmArguments,
    #[command(flatten)]
    fog: FogArguments,
    #[command(flatten)]
    quality: QualityArguments,
    /// Print the summary as JSON
    #[arg(long, help_heading = None)]
    json: bool,
}

/// A medium before the picture.
#[derive(clap::Args)]
struct FogArguments {
    /// Fog in the place of the scene's: extinction per unit of length, 0 for none. Its froxels are 8 pixels
    /// wide and high, fewer in pictures less than 768 wide, in 64 slices
    #[arg(long, value_name = "DENSITY", value_parser = parse_density)]
    fog: Option<f32>,
    /// Of fog, the mean cosine of the angle by which it turns light: above 0 forwards
    #[arg(long, value_name = "G", default_value_t = 0.0, requires = "fog",
        value_parser = parse_anisotropy)]
    anisotropy: f32,
    /// Of fog, what it scatters of what it takes away
    #[arg(long, value_name = "PART", default_value_t = 1.0, requires = "fog", value_parser = parse_albedo)]
    fog_albedo: f32,
    /// Of each of the fog's froxels: samples, each with a shadow ray for each light
    #[arg(long, value_name = "N", default_value_t = 4,
        value_parser = clap::value_parser!(u32).range(1..=1024))]
    fog_samples: u32,
}

impl FogArguments {
    /// The fog that is asked for, else the scene's: it ends beyond the scene.
    fn of(&self, scene: &Scene, camera: &Camera) -> Option<Fog> {
        let (anisotropy, albedo) = (self.anisotropy.into(), self.fog_albedo.into());
        let asked = self.fog.map(|density| SceneFog { density: density.into(), anisotropy, albedo });
        let fog = asked.or(scene.fog).filter(|fog| fog.density > 0.0)?;
        Some(Fog::of_scene(scene, camera, fog))
    }
}

fn parse_density(text: &str) -> Result<f32, String> {
    let density = text.parse().ok().filter(|density: &f32| density.is_finite() && *density >= 0.0);
    density.ok_or_else(|| "must be a number from 0 on".to_owned())
}

fn parse_anisotropy(text: &str) -> Result<f32, String> {
    let g = text.parse().ok().filter(|g: &f32| g.abs() < 1.0);
    g.ok_or_else(|| "must be a number between -1 and 1".to_owned())
}

fn parse_albedo(text: &str) -> Result<f32, String> {
    let albedo = text.parse().ok().filter(|albedo| (0.0..=1.0).contains(albedo));
    albedo.ok_or_else(|| "must be a number from 0 to 1".to_owned())
}

/// Where pictures go that nobody named a place for.
const FOLDER: &str = "out";

impl Arguments {
    /// A pixel's reference samples are spread evenly over its subpixels, each having one at least.
    fn samples_a_subpixel(&self, samples: u32) -> u32 {
        samples.div_ceil(self.supersample * self.supersample)
    }

    /// The reference samples that a pixel really has.
    fn reference_samples(&self) -> Option<u32> {
        self.reference.map(|samples| self.samples_a_subpixel(samples) * self.supersample * self.supersample)
    }

    /// The scene as a picture of the film shows it, and the camera; says what is not shown of the first one.
    fn load(&self, index: u32) -> Result<(Scene, Camera), Failure> {
        let aspect = f64::from(self.size[0]) / f64::from(self.size[1]);
        let (path, camera) = (self.scene.as_deref(), self.camera.as_deref());
        let seconds = self.film.seconds(index);
        let lights = seconds.map_or_else(|| self.lights.clone(), |seconds| self.lights.later(seconds));
        let found = lights.load(path, camera, aspect)?;
        if index == 0 {
            output::say_what_is_not_shown(&found.0, &self.scene_name());
        }
        Ok(found)
    }

    fn shadow_level(&self) -> Shadows {
        if self.tiles.is_some() {
            return Shadows::Off;
        }
        self.shadows.unwrap_or_else(|| Shadows::for_samples(self.supersample * self.supersample))
    }

    fn casts_shadows(&self) -> bool {
        self.shadow_level() != Shadows::Off
    }

    fn scene_name(&self) -> PathBuf {
        scene_name(self.scene.as_deref())
    }

    fn output(&self, scene: &Scene) -> PathBuf {
        let stem = self.scene.as_deref().and_then(Path::file_stem).map(OsString::from);
        let mut name = stem.unwrap_or_else(|| scene.name.clone().into());
        name.push(if self.reference.is_some() { "-reference.png" } else { ".png" });
        self.output.clone().unwrap_or_else(|| Path::new(FOLDER).join(name))
    }
}

/// Whose word it is what surfaces need.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum SurfaceChoice {
    /// The scan's.
    Required,
    /// The user's.
    Stated(Effects),
}

impl std::str::FromStr for SurfaceChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "required" => Ok(Self::Required),
            list => match effects_of(list)? {
                effects if Effects::SURFACES.contains(effects) => Ok(Self::Stated(effects)),
                effects => Err(format!("{} depends on the lights alone", effects - Effects::SURFACES)),
            },
        }
    }
}

/// What lies below a layer gets what the layer leaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Coupling {
    /// Of each direction's light, by the Fresnel term, as glTF has it
    Gltf,
    /// Of all light, by the layer's albedo, as Blender's Cycles and OpenPBR have it: darker at grazing views
    Albedo,
}

impl Coupling {
    fn of(self, surfaces: Effects) -> Effects {
        let layered = |layer: Effects, by_albedo: Effects| {
            let is_there = self == Self::Albedo && surfaces.contains(layer);
            if is_there { by_albedo } else { Effects::empty() }
        };
        surfaces
            | layered(Effects::COUPLED, Effects::COUPLED_BY_ALBEDO)
            | layered(Effects::COAT, Effects::COAT_BY_ALBEDO)
    }
}

/// The set of names with commas between them, as [`Effects`] is displayed; `none` is the empty one.
fn effects_of(list: &str) -> Result<Effects, String> {
    if list.trim() == "none" {
        return Ok(Effects::empty());
    }
    let effect = |name: &str| {
        let found = Effects::all().iter().find(|effect| effect.names() == [name]);
        found.ok_or_else(|| format!("'{name}' is no effect; there are {}", Effects::all()))
    };
    list.split(',').map(|name| effect(name.trim())).collect()
}

impl SurfaceChoice {
    /// The set for `scene`. One that a surface needs more than gives another picture than the scene's: it is
    /// for the user to state, and said.
    fn surfaces(self, scene: &Scene, path: &Path) -> Effects {
        let required = scene.surfaces();
        let Self::Stated(surfaces) = self else { return required };
        for effect in arealight_scene::required_effects(scene) {
            if (required - surfaces).contains(effect.effect) {
                output::say(&format!("warning: {}: --surfaces is without {effect}", path.display()));
            }
        }
        surfaces
    }
}

/// The most texels a side that a light's texture gets.
pub(super) const TEXTURE_SIZE: u32 = 1024;

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    if arguments.tiles.is_some() && arguments.shadows.is_some_and(|level| level != Shadows::Off) {
        let message = "is shaded without shadows: take --shadows off, or leave one of them out".into();
        return Err(Failure::Argument { argument: "--tiles", message });
    }
    if arguments.shadow_noise.is_some() && !arguments.casts_shadows() {
        let message = "there are no shadows: leave --shadows off out".into();
        return Err(Failure::Argument { argument: "--shadow-noise", message });
    }

    // Read the scene
    let mut phases = Phases::default();
    let path = arguments.scene_name();
    let (mut scene, mut camera) = phases.time("load", || arguments.load(0))?;
    let output = arguments.output(&scene);
    let mut reel = Reel::new(&output, &arguments.film, arguments.size)?;
    if arguments.output.is_none() {
        std::fs::create_dir_all(FOLDER).map_err(|error| Failure::output(FOLDER, error))?;
    }
    output::check(&reel.file(0))?;
    let samples = arguments.size.map(|side| side * arguments.supersample);

    // Render, save, picture by picture
    let table = arguments.quality.table()?;
    let mut engine = phases.time("device", || gpu::engine(arguments.device.device.as_deref(), &table))?;
    let surfaces = arguments.coupling.of(arguments.surfaces.surfaces(&scene, &path));
    let quality = arguments.quality.within(arguments.quality.level_of(surfaces));
    let (origin, exposure) = (camera.position, arguments.exposure);
    let mut frame = Frame { index: 0, origin, exposure, shadows: vec![] };
    let mut before = None;
    let film = |count: u32| progress::bar(count.into(), "pictures");
    let bar = arguments.film.frames.map_or_else(indicatif::ProgressBar::hidden, film);
    let mut shown = vec![];
    let outcome = loop {
        phases
            .time("light textures", || {
                if shown == scene.light_textures {
                    return engine.show_frames(&scene);
                }
                engine.load_scene_textures(&scene, TEXTURE_SIZE)
            })
            .map_err(|error| gpu::failure(error, &path))?;
        shown.clone_from(&scene.light_textures);
        let of = (surfaces, quality);
        let outcome = phases
            .time("picture", || render(&engine, &scene, &camera, samples, of, (arguments, &mut frame)))
            .map_err(|error| gpu::failure(error, &path))?;
        let (factor, stops) = (arguments.supersample, outcome.stops);
        phases.time("save", || reel.add(frame.index, &outcome.picture, (factor, stops)))?;
        let outcome = outcome.after(before);
        bar.inc(1);
        frame.index += 1;
        if frame.index == arguments.film.count() {
            break outcome;
        }
        frame.exposure = Exposure::Stops(outcome.stops);
        before = Some(outcome);
        (scene, camera) = phases.time("load", || arguments.load(frame.index))?;
    };
    bar.finish_and_clear();

    // Say so
    let output = &reel.file(0);
    let device = engine.host().device_name();
    let summary = Summary {
        arguments,
        scene: &scene,
        surfaces,
        level: name_of(quality),
        camera: &camera,
        device,
        outcome: &outcome,
        phases: &phases,
        output,
    };
    say_beside(Some(output), &if arguments.json { summary.to_json() } else { summary.to_text() })
}

/// A part of a pixel.
fn parse_part(text: &str) -> Result<f32, String> {
    let part = text.parse().ok().filter(|part| (0.0..1.0).contains(part));
    part.ok_or_else(|| "must be a number from 0 up to, but not, 1".to_owned())
}

/// Levels of 255.
fn parse_levels(text: &str) -> Result<f64, String> {
    let levels = text.parse().ok().filter(|levels: &f64| *levels > 0.0 && levels.is_finite());
    levels.ok_or_else(|| "must be a number above 0".to_owned())
}

/// A width and a height such as `1280x720`.
pub(super) fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse().ok().filter(|side| (1..=8192).contains(side));
    text.split_once(['x', 'X'])
        .and_then(|(width, height)| Some([side(width)?, side(height)?]))
        .ok_or_else(|| "must be like 1280x720, each side from 1 to 8192".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surfaces_are_stated_or_required() {
        assert_eq!("required".parse(), Ok(SurfaceChoice::Required));
        assert_eq!("glossy".parse(), Ok(SurfaceChoice::Stated(Effects::GLOSSY)));
        assert!("shiny".parse::<SurfaceChoice>().unwrap_err().contains("'shiny' is no effect"));
        let message = "glossy,tube".parse::<SurfaceChoice>().unwrap_err();
        assert_eq!(message, "tube depends on the lights alone");
    }

    #[test]
    fn sizes_are_two_numbers_within_limits() {
        assert_eq!(parse_size("640x480"), Ok([640, 480]));
        assert_eq!(parse_part("0.01"), Ok(0.01));
        assert!(["nan", "1", "-0.1", ""].iter().all(|bad| parse_part(bad).is_err()));
        assert_eq!(parse_levels("0.5"), Ok(0.5));
        assert!(["nan", "inf", "0", "-1", ""].iter().all(|bad| parse_levels(bad).is_err()));
        for bad in ["", "640", "640x", "0x480", "640x9000", "-1x2", "1x2x3", "axb"] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
    }
}
