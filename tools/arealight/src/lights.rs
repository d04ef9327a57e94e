//! What a scene is lit by, and from where it is seen: what commands that read scenes share.

use crate::failure::Failure;
use crate::memory;
use crate::output::keep;
use crate::view::Look;
use arealight_scene::{Camera, LoadOptions, Scene};
use std::path::{Path, PathBuf};

/// What a scene is lit by.
#[derive(clap::Args, Clone, Debug)]
#[command(next_help_heading = "Scene")]
pub struct LightArguments {
    /// The radius of points and spots of `KHR_lights_punctual`, in metres, and show suns half a degree wide;
    /// without it they are left out, but those whose `extras.arealight.radius` says one
    #[arg(long, value_name = "RADIUS", value_parser = parse_radius)]
    light_size: Option<f64>,
    /// Show the scene's animations and moving images at this time, in seconds; without it the scene is at
    /// rest
    #[arg(long, value_name = "SECONDS", value_parser = parse_time)]
    time: Option<f64>,
    /// What lights the scene: what the file has (`file`), or that and three softboxes in a dim tent
    /// around what the camera sees, for models without lights (`studio`)
    #[arg(long, value_name = "RIG", default_value = "file")]
    lights: Rig,
    /// The camera and lamps of this scene as `arealight view` saved them, by `p`; its camera goes before
    /// --camera
    #[arg(long, value_name = "FILE")]
    look: Option<PathBuf>,
}

/// Lights that are not the file's.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
enum Rig {
    File,
    Studio,
}

impl LightArguments {
    /// The time that the scene is shown at first.
    pub fn time(&self) -> f64 {
        self.time.unwrap_or(0.0)
    }

    /// The same so many seconds later.
    #[must_use]
    pub fn later(&self, seconds: f64) -> Self {
        Self { time: Some(self.time() + seconds), ..self.clone() }
    }

    /// What a person made of a scene.
    pub fn look(&self, scene: &Scene) -> Result<Option<Look>, Failure> {
        self.look.as_deref().map(|path| Look::read(path, scene)).transpose()
    }

    /// Reads a scene, as a person left it, and finds the camera.
    pub fn load(
        &self,
        path: Option<&Path>,
        camera: Option<&str>,
        aspect: f64,
    ) -> Result<(Scene, Camera), Failure> {
        let (mut scene, camera) = self.load_as_it_is(path, camera, aspect)?;
        let look = self.look(&scene)?;
        let camera = look.map_or(camera, |look| look.apply(&mut scene));
        Ok((scene, camera))
    }

    /// Reads a scene, or the demo's if there is none, and finds the camera: that of a name, the file's first,
    /// or one that frames the scene. What is not shown of it is for the caller to say.
    pub fn load_as_it_is(
        &self,
        path: Option<&Path>,
        camera: Option<&str>,
        aspect: f64,
    ) -> Result<(Scene, Camera), Failure> {
        let mut scene = match path {
            Some(path) => {
                let (light_size, time) = (self.light_size, self.time);
                read(path, LoadOptions { light_size, time, ..LoadOptions::default() })?
            }
            None => demo()?,
        };
        let path = scene_name(path);
        let camera = camera_of(&scene, camera, aspect, &path)?;
        if self.lights == Rig::Studio {
            scene.add_studio(&camera).map_err(|fault| Failure::Argument {
                argument: "--lights",
                message: format!("studio: {} is too large, or too far out: {fault}", path.display()),
            })?;
        }
        Ok((scene, camera))
    }
}

/// Reads a scene, with what the file leaves open; as much as there is memory for.
pub fn read(path: &Path, options: LoadOptions) -> Result<Scene, Failure> {
    let options = LoadOptions { memory: memory::limit(), ..options };
    let scene = Scene::load_with(path, options).map_err(|error| Failure::Scene(error.to_string()))?;
    scene.files.iter().map(PathBuf::as_path).chain([path]).for_each(keep);
    Ok(scene)
}

/// What a scene is called that may be the demo.
pub fn scene_name(path: Option<&Path>) -> PathBuf {
    path.map_or_else(|| "demo (built in)".into(), Path::to_owned)
}

fn parse_radius(text: &str) -> Result<f64, String> {
    let radius = text.parse().ok().filter(|radius| (1e-6..=1e6).contains(radius));
    radius.ok_or_else(|| "must be a radius from 1e-6 to 1e6 m".to_owned())
}

fn parse_time(text: &str) -> Result<f64, String> {
    let time = text.parse().ok().filter(|time: &f64| time.is_finite());
    time.ok_or_else(|| "must be a time in seconds".to_owned())
}

/// The scene that is shown where no file is given.
fn demo() -> Result<Scene, Failure> {
    Scene::from_bytes(include_bytes!("../../../scenes/demo.glb"), "demo")
        .map_err(|error| Failure::input("demo (built in)", error))
}

/// The camera of a name, or the scene's first.
fn camera_of(scene: &Scene, name: Option<&str>, aspect: f64, path: &Path) -> Result<Camera, Failure> {
    scene.camera(name, aspect).ok_or_else(|| {
        let names: Vec<_> = scene.cameras.iter().map(|camera| format!("'{}'", camera.name)).collect();
        let names = if names.is_empty() { "no cameras".to_owned() } else { names.join(", ") };
        Failure::Argument {
            argument: "--camera",
            message: format!(
                "'{}' is not in {}, which has {names}",
                name.unwrap_or_default(),
                path.display()
            ),
        }
    })
}
