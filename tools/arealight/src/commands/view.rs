//! `arealight view`: a scene in a window, or a recording of what a script does in one.

use crate::canvas::Canvas;
use crate::failure::Failure;
use crate::lights::{LightArguments, scene_name};
use crate::output::{self, print};
use crate::picture::Exposure;
use crate::progress;
use crate::view::{Engines, Interface, Look, Mode, Script, Shown, State, Viewer, paint, show};
use crate::{gpu, memory};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Look at a scene: move its lamps and the camera, and compare the error and cost of each level.
///
/// In a window, with a panel; or, with --record, as pictures of what a script does, without a window. For
/// example: arealight view scenes/room.glb
#[derive(clap::Args)]
pub struct Arguments {
    /// A .gltf or .glb file; the built-in demo scene if absent
    scene: Option<PathBuf>,
    #[command(flatten)]
    lights: LightArguments,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "960x540", value_parser = super::render::parse_size)]
    size: [u32; 2],
    /// The file's camera of this name to begin with; its first one, or one that frames the scene, if absent
    #[arg(long, value_name = "NAME", help_heading = "Scene")]
    camera: Option<String>,
    /// Exposure to begin with, in stops
    #[arg(long, value_name = "EV", default_value = "0")]
    exposure: Exposure,
    /// Samples a pixel that each frame adds to the truth, where it is shown
    #[arg(long, value_name = "N", default_value_t = 2,
        value_parser = clap::value_parser!(u32).range(1..=1024))]
    samples: u32,
    /// What to do, a line for each event: seconds, and `key NAME`, `press X Y`, `move X Y`, `release` or
    /// `wheel STEPS`; the viewer ends with it
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,
    /// Open no window, and write what the script does into this folder: frame-0000.png and so on, film.gif,
    /// and the camera and lamps at its end, look.json
    #[arg(long, value_name = "DIR", requires = "script")]
    record: Option<PathBuf>,
    /// Frames a second of a recording
    #[arg(long, value_name = "FPS", default_value_t = 12, requires = "record",
        value_parser = clap::value_parser!(u32).range(1..=50))]
    rate: u32,
    /// Show the device's times in a recording too, which then differs from run to run
    #[arg(long, requires = "record")]
    times: bool,
    /// Print what each frame of a recording shows as JSON: the quality level, times, and the error as far as
    /// it is known
    #[arg(long, requires = "record")]
    json: bool,
    #[command(flatten)]
    device: gpu::DeviceArgument,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    // Read what is given
    let path = scene_name(arguments.scene.as_deref());
    let aspect = f64::from(arguments.size[0]) / f64::from(arguments.size[1]);
    let (scene, camera) =
        arguments.lights.load_as_it_is(arguments.scene.as_deref(), arguments.camera.as_deref(), aspect)?;
    output::say_what_is_not_shown(&scene, &path);
    let look = arguments.lights.look(&scene)?;
    let script = arguments.script.as_deref().map(read_script).transpose()?;
    let exposure = match arguments.exposure {
        Exposure::Stops(stops) => stops,
        Exposure::Auto => {
            let message = "a viewer's exposure is a number of stops; + and - change it".to_owned();
            return Err(Failure::Argument { argument: "--exposure", message });
        }
    };

    // A place for a recording, before anything takes long
    if let Some(folder) = &arguments.record {
        std::fs::create_dir_all(folder).map_err(|error| Failure::output(folder, error))?;
        output::check(&folder.join(FILM))?;
    }

    // Draw
    let table = arealight::LightTable::ggx();
    let mut engine = gpu::engine(arguments.device.device.as_deref(), &table)?;
    engine
        .load_scene_textures(&scene, super::render::TEXTURE_SIZE)
        .map_err(|error| gpu::failure(error, &path))?;
    let engines = Engines::new(engine, &scene).map_err(|error| gpu::failure(error, &path))?;
    let camera = camera.pinhole(scene.bounds.center());
    let mut state = State::new(&scene, &camera, exposure, engines.has_yardstick());
    state.time = arguments.lights.time();
    if let Some(look) = look {
        look.begin(&mut state);
    }
    let viewer = Viewer::new(&engines, scene, arguments.size).map_err(|error| gpu::failure(error, &path))?;
    match (&arguments.record, script) {
        (Some(folder), Some(script)) => record(arguments, viewer, state, &script, folder, &path),
        (_, script) => show(viewer, state, arguments.size, arguments.samples, script.as_ref(), &path),
    }
}

/// The name of a recording as one file.
const FILM: &str = "film.gif";

fn read_script(path: &Path) -> Result<Script, Failure> {
    Script::parse(&memory::read_text(path)?).map_err(|error| Failure::input(path, error))
}

/// Draws a frame for each step of time, and writes them.
fn record(
    arguments: &Arguments,
    mut viewer: Viewer<'_>,
    mut state: State,
    script: &Script,
    folder: &Path,
    scene: &Path,
) -> Result<ExitCode, Failure> {
    let aspect = f64::from(arguments.size[0]) / f64::from(arguments.size[1]);
    let rate = f64::from(arguments.rate);
    let count = (script.seconds() * rate).ceil() as u32 + 1;
    if crate::film::is_too_large(arguments.size, count) {
        let message = format!("{count} frames are more than 2 GiB: a lower --rate, or a smaller --size");
        return Err(Failure::Argument { argument: "--record", message });
    }
    let bar = progress::bar(u64::from(count), "frames");
    let mut interface = Interface::new(1.0);
    let (mut frames, mut said): (Vec<Canvas>, Vec<Value>) = (vec![], vec![]);
    for index in 0..count {
        // What is at time 0 comes before the first frame
        let [before, now] = [f64::from(index) - 1.0, f64::from(index)].map(|frame| frame / rate);
        state.play(viewer.scene(), if index == 0 { 0.0 } else { 1.0 / rate });
        for event in script.between(before, now) {
            if !interface.takes(&event, arguments.size) {
                state.apply(event, viewer.scene(), aspect);
            }
        }
        state.save = false; // every frame is
        viewer.draw(&state, arguments.samples).map_err(|error| gpu::failure(error, scene))?;
        while viewer.measures(&state) {
            viewer.draw(&state, 0).map_err(|error| gpu::failure(error, scene))?;
        }
        let shown = viewer.shown(&state);
        said.push(summary(&state, &shown, now));
        let shown = if arguments.times { shown } else { shown.without_times() };
        let mut frame = paint(&state, &shown);
        interface.draw(&mut frame, &mut state, &shown);
        frame.save_png(&folder.join(format!("frame-{index:04}.png")))?;
        frames.push(frame);
        bar.inc(1);
        if state.quit {
            break;
        }
    }
    bar.finish_and_clear();
    Look::of(&state).save(&folder.join("look.json"))?;
    let film = folder.join(FILM);
    crate::film::save(&film, &frames, arguments.rate)?;
    output::say(&format!("wrote {} frames and {}", frames.len(), film.display()));
    if arguments.json { print(&format!("{:#}\n", json!({ "frames": said }))) } else { Ok(ExitCode::SUCCESS) }
}

/// What a frame shows.
fn summary(state: &State, shown: &Shown<'_>, seconds: f64) -> Value {
    let distance = shown.truth.and_then(|(_, distance)| distance);
    let [visibility, shading] = shown.times.map(|time| time.map(|time| time.as_secs_f64()));
    let costs: Vec<Value> = shown
        .costs
        .iter()
        .map(|cost| {
            let error = cost.distance.and_then(|distance| distance.error);
            json!({ "name": cost.name, "milliseconds": cost.milliseconds, "error": error })
        })
        .collect();
    json!({
        "seconds": seconds,
        "level": state.level.name(),
        "mode": match state.mode {
            Mode::Picture => "picture",
            Mode::Wipe(_) => "wipe",
            Mode::Error => "error",
        },
        "shadows": state.has_shadows(),
        "fog": state.fog().map(|fog| fog.density),
        "effects": shown.effects.names(),
        "gpu_seconds": { "visibility": visibility, "shading": shading },
        "truth_samples": shown.truth.map_or(0, |(samples, _)| samples),
        "error": distance.and_then(|distance| distance.error),
        "truth_noise": distance.map(|distance| distance.noise),
        "costs": costs,
    })
}
