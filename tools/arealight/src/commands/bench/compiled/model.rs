//! `arealight bench compiled --model`

use super::{Markers, document, write};
use crate::failure::Failure;
use crate::gpu;
use crate::output::print;
use arealight_benches::compiled::Compiled;
use arealight_benches::model::{Modelled, count_scene, markdown, text};
use arealight_scene::Scene;
use std::path::Path;
use std::process::ExitCode;

/// Whole workgroups: what waves do hardly depends on the size.
const SIZE: [u32; 2] = [480, 272];

/// Our scenes with quads, in whose first views paths are counted.
const SCENES: [(&str, &[u8]); 3] = [
    ("demo", include_bytes!("../../../../../../scenes/demo.glb")),
    ("room", include_bytes!("../../../../../../scenes/room.glb")),
    ("sweep", include_bytes!("../../../../../../scenes/sweep.glb")),
];

/// Counts the paths of our scenes, and prices them by the statistics of each family.
pub fn run(found: &Compiled, document_path: Option<&Path>) -> Result<ExitCode, Failure> {
    let failed = |error: &dyn std::fmt::Display| Failure::Device(error.to_string());
    let engine = gpu::engine(None, &arealight::LightTable::ggx())?;
    let mut scenes = vec![];
    for (name, bytes) in SCENES {
        let scene = Scene::from_bytes(bytes, name).map_err(|error| Failure::Scene(error.to_string()))?;
        let counts = count_scene(&engine, &scene, SIZE).map_err(|error| failed(&error))?;
        scenes.push(Modelled {
            name: name.to_owned(),
            left_out: scene.lights.len() - counts[0].quads,
            counts,
        });
    }
    if let Some(path) = document_path {
        write(path, &document(path, Markers::MODEL, &markdown(&scenes, found, SIZE))?)?;
    }
    print(&text(&scenes, found, SIZE))
}
