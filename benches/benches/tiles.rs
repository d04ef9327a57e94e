//! What tiles gain: whole frames of our scenes; a floor under disks and spheres, and images on disks:
//! `cargo bench -p arealight-benches --bench tiles`, with `-- scenes` or `-- shapes` these alone. Prints
//! Markdown tables. Ever more lamps are of `arealight bench lights`.

use arealight::plan::{ShadeOptions, TileOptions};
use arealight::{Footprint, LightTexture, Quality};
use arealight_benches::pictures;
use arealight_benches::start::start;
use arealight_benches::tiles::{Baseline, TiledFrame, disks, floor, markdown, measure, round_lamps};
use arealight_engine::{Engine, SceneRenderer};
use arealight_oracle::texture::Texture;
use arealight_scene::{Scene, SceneBuffers};
use glam::{DVec3, Vec3};
use std::error::Error;
use std::path::Path;
use std::sync::Arc;

const ROUNDS: usize = 20;
const SIZE: [u32; 2] = [640, 360];

/// Its width over its height.
const ASPECT: f64 = SIZE[0] as f64 / SIZE[1] as f64;

/// The side of the floor in metres.
const FLOOR: f64 = 40.0;

/// What fraction of a pixel may be culled over the floor.
const THRESHOLDS: [f32; 2] = [0.01, 0.1];

/// The floor's roughness: concrete.
const ROUGHNESS: f32 = 0.9;

/// How many disks or spheres there are over it.
const ROUND_LAMPS: [usize; 2] = [10, 100];

/// How many disks with images shine above the same floor, and how high.
const DISKS: usize = 16;
const DISK_HEIGHT: f64 = 30.0;

fn scene(name: &str) -> Result<Scene, Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    Ok(Scene::load(folder.join(name).with_extension("glb"))?)
}

fn frame(
    engine: &Engine,
    (name, scene): (&str, &Scene),
    size: [u32; 2],
    quality: Quality,
    against: (TileOptions, Baseline),
    rounds: usize,
) -> Result<TiledFrame, Box<dyn Error>> {
    let camera =
        scene.camera(None, f64::from(size[0]) / f64::from(size[1])).ok_or("the scene has no camera")?;
    let buffers = SceneBuffers::new(scene, camera.position)?;
    let constants = buffers.constants(&camera, size, Vec3::ZERO);
    let mut renderer = SceneRenderer::new(engine, &buffers, &scene.lights, constants, size)?;
    let options = ShadeOptions { surfaces: scene.effects(), quality, ..ShadeOptions::default() };
    Ok(measure(engine.host(), name, &mut renderer, options, against, rounds)?)
}

/// Frames of the floor under disks, and under spheres.
fn shape_frames(engine: &Engine, rounds: usize) -> Result<Vec<TiledFrame>, Box<dyn Error>> {
    let mut frames = vec![];
    for (kind, are_spheres) in [("disks", false), ("spheres", true)] {
        for cull_threshold in THRESHOLDS {
            for count in ROUND_LAMPS {
                let mut scene = floor(ROUGHNESS, FLOOR, ASPECT);
                scene.lights = round_lamps(count, FLOOR, are_spheres);
                let against = (TileOptions { cull_threshold, ..TileOptions::default() }, Baseline::Exact);
                let name = format!("{count} {kind}, threshold {cull_threshold}");
                frames.push(frame(engine, (&name, &scene), SIZE, Quality::default(), against, rounds)?);
            }
        }
    }
    Ok(frames)
}

/// Frames of textured disks, by one fetch and by four.
fn image_frames(engine: &Engine, rounds: usize) -> Result<Vec<TiledFrame>, Box<dyn Error>> {
    let mut frames = vec![];
    let mut scene = floor(ROUGHNESS, FLOOR, ASPECT);
    scene.lights = disks(DISKS, 0.5 * FLOOR, DISK_HEIGHT, DVec3::ZERO);
    let texture = Some(LightTexture { layer: 0, uvs: vec![] });
    scene.lights.iter_mut().for_each(|disk| disk.texture.clone_from(&texture));
    for footprint in [Footprint::Round, Footprint::Ellipse] {
        let quality = Quality { footprint, ..Quality::default() };
        let against = (TileOptions::default(), Baseline::Plain);
        let name = format!("disks with an image: {DISKS}, {footprint:?}");
        frames.push(frame(engine, (&name, &scene), SIZE, quality, against, rounds)?);
    }
    Ok(frames)
}

/// Frames of our scenes.
fn scene_frames(engine: &Engine, rounds: usize) -> Result<Vec<TiledFrame>, Box<dyn Error>> {
    let against = (TileOptions::default(), Baseline::Clipless);
    let mut frames = vec![];
    for name in ["demo", "room", "sweep"] {
        frames.push(frame(engine, (name, &scene(name)?), SIZE, Quality::default(), against, rounds)?);
    }
    // What is classified all the same, though it has a single quad
    let every = (TileOptions { least_quads: 0, ..TileOptions::default() }, Baseline::Clipless);
    let name = "sweep, classified";
    frames.push(frame(engine, (name, &scene("sweep")?), SIZE, Quality::default(), every, rounds)?);
    Ok(frames)
}

fn main() -> Result<(), Box<dyn Error>> {
    let Some((host, rounds)) = start(ROUNDS) else { return Ok(()) };
    let mut engine = Engine::new(host, &arealight::LightTable::ggx(), arealight_vk::TableFormat::default())?;
    let device = engine.host().device_name();
    println!("{device}, {rounds} rounds\n");
    let named = |part: &str| std::env::args().any(|argument| argument == part);
    let wanted = |part: &str| named(part) || !(named("scenes") || named("shapes"));
    if wanted("scenes") {
        println!("## Scenes, {} x {}\n", SIZE[0], SIZE[1]);
        println!("{}", markdown(&scene_frames(&engine, rounds)?));
    }
    if wanted("shapes") {
        println!("## A floor under disks and spheres, {} x {}\n", SIZE[0], SIZE[1]);
        println!("{}", markdown(&shape_frames(&engine, rounds)?));
        pictures::load(&mut engine, &[Arc::new(Texture::noise(256, 256, 1))], |_| 1.0)?;
        println!("{}", markdown(&image_frames(&engine, rounds)?));
    }
    Ok(())
}
