//! What effects cost that no pixel uses, and whether absent ones cost nothing, in one run over a frame of the sweep,
//! which has quads alone:
//! `cargo bench -p arealight-benches --bench effects`. Prints a Markdown table.

use arealight_benches::effects::{markdown, measure};
use arealight_benches::start::start;
use arealight_engine::{Engine, SceneRenderer};
use arealight_scene::{Scene, SceneBuffers};
use glam::Vec3;
use std::path::Path;

const ROUNDS: usize = 240;
const SIZE: [u32; 2] = [320, 180];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let Some((host, rounds)) = start(ROUNDS) else { return Ok(()) };
    let engine = Engine::new(host, &arealight_table::ggx(), arealight_vk::TableFormat::default())?;
    let scene = Scene::load(Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/sweep.glb"))?;
    let camera =
        scene.camera(None, f64::from(SIZE[0]) / f64::from(SIZE[1])).ok_or("the sweep has a camera")?;
    let buffers = SceneBuffers::new(&scene, camera.position)?;
    let constants = buffers.constants(&camera, SIZE, Vec3::ZERO);
    let mut renderer = SceneRenderer::new(&engine, &buffers, &scene.lights, constants, SIZE)?;
    let costs = measure(engine.host(), &mut renderer, rounds)?;
    let device = engine.host().device_name();
    println!("{device}, the sweep, {} x {}, {rounds} rounds\n\n{}", SIZE[0], SIZE[1], markdown(&costs));
    Ok(())
}
