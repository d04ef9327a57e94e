//! From a file to a scene, step by step: each takes what earlier ones made, and gives a value.

use crate::bounds::Bounds;
use crate::document::Document;
use crate::emitters::Emitters;
use crate::error::SceneError;
use crate::messages::Messages;
use crate::scene::{NO_LIGHTS, Scene, SceneLamp};
use crate::{
    animations, area_lights, compressed_views, draco, extensions, ies_lights, light_textures, materials,
    meshes, mips, nodes, primitives, punctual, skins,
};
use std::cell::LazyCell;
use std::path::Path;

/// What a file leaves open.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LoadOptions {
    /// The radius of points and spots of `KHR_lights_punctual`, in metres, where the file says none. Without
    /// they are left out, with a warning.
    pub light_size: Option<f64>,
    /// When animations and images that move are shown, in seconds; without, nothing has moved yet.
    pub time: Option<f64>,
    /// The most memory that the scene may take, in bytes; else [`crate::memory_of`] what its files hold.
    pub memory: Option<u64>,
}

impl Scene {
    /// Reads a `.gltf` or `.glb` file, and the buffers and images it refers to by relative paths or data
    /// URIs. What the scene cannot show as the file says is in [`Scene::warnings`].
    ///
    /// # Errors
    /// [`SceneError`] names the file and the field.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        Self::load_with(path, LoadOptions::default())
    }

    /// As [`Scene::load`], with what the file leaves open.
    pub fn load_with(path: impl AsRef<Path>, options: LoadOptions) -> Result<Self, SceneError> {
        let path = path.as_ref();
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        read(Document::open(path, options.memory)?, name.unwrap_or_default(), options)
    }

    /// Reads a scene from memory. It cannot refer to other files; `name` stands for the file in messages.
    ///
    /// # Errors
    /// [`SceneError`] names the field.
    pub fn from_bytes(bytes: &[u8], name: &str) -> Result<Self, SceneError> {
        Self::from_bytes_with(bytes, name, LoadOptions::default())
    }

    /// As [`Scene::from_bytes`], with what the file leaves open.
    pub fn from_bytes_with(bytes: &[u8], name: &str, options: LoadOptions) -> Result<Self, SceneError> {
        let document = Document::parse(bytes, name.to_owned(), None, options.memory)?;
        read(document, name.to_owned(), options)
    }
}

fn read(mut document: Document, name: String, options: LoadOptions) -> Result<Scene, SceneError> {
    compressed_views::decompress(&mut document)?;
    draco::decompress(&mut document)?;
    let messages = &mut Messages::default();
    document.time = options.time.unwrap_or(0.0);
    match options.time {
        Some(time) => animations::apply(&mut document, time, messages)?,
        None if document.root.animations.is_empty() => {}
        None => messages.warn("animations", "the scene is shown at rest, not at a time (--time)"),
    }
    let document = &document;
    extensions::warn_of_unread(&document.root, messages);
    // Place the nodes in the world, and read what their meshes are and what they are made of
    let nodes = nodes::place(document, messages)?;
    let primitives = primitives::read(document, &nodes, messages)?;
    let of_nodes = nodes.iter().filter_map(|node| node.mesh).flat_map(|mesh| &primitives[mesh]);
    let mut materials = materials::read(document, of_nodes.map(|one| one.material), messages)?;
    let smaller = mips::smaller(&materials.textures.textures, &materials.list, &materials.textures.images);
    if smaller > 0 {
        let text = format!("{smaller} images are shown at half their size or less: all take 128 MiB at most");
        messages.note("textures", text);
    }
    // Make triangles of every mesh, and lights where it emits
    let (mut triangles, mut emitters) = (Vec::new(), Emitters::default());
    let worlds = LazyCell::new(|| nodes::worlds(&nodes));
    for node in &nodes {
        let pose = skins::pose(document, || &worlds, node, messages)?;
        let mesh = node.mesh.map_or(&[][..], |mesh| &primitives[mesh]);
        let placed = (node, pose.as_deref());
        let mesh = meshes::place(document, placed, mesh, &materials, &mut triangles, messages)?;
        emitters.add(node, &mesh, &materials, messages);
    }
    let light_textures =
        light_textures::assign(&emitters.textured, &mut emitters.lights, &mut materials.textures, messages);
    emitters.finish();
    // Lights and cameras that hang on nodes
    let Emitters { mut lights, mut lamps, .. } = emitters;
    let shown = lights.len();
    lights.extend(area_lights::lights(document, &nodes, messages)?);
    let mut bounds: Bounds = triangles.iter().flat_map(|t| t.positions).collect();
    lights.extend(punctual::lights(document, &nodes, options.light_size, bounds, messages)?);
    lights.extend(ies_lights::lights(document, &nodes, options.light_size, messages)?);
    lamps.extend(SceneLamp::bare(shown..lights.len()));
    if shown > 0 && shown < lights.len() {
        let text = "emission is taken as radiance, W/(m² sr), lights without a mesh by 683 lm/W: 1000 nits of \
                    these are 1.46, of an emissive strength 1000";
        messages.note("lights", text);
    }
    if bounds.is_empty() {
        bounds = lights.iter().flat_map(|light| light.shape.bounds()).collect();
    }
    let cameras = nodes::cameras(document, &nodes, messages);
    if triangles.is_empty() {
        messages.warn("scene", "has no triangles: there is no surface to light");
    }
    if lights.is_empty() {
        messages.warn("scene", NO_LIGHTS);
    }
    let fog = nodes::fog(&document.root, messages);
    let Messages { warnings, notes } = std::mem::take(messages);
    Ok(Scene {
        name: nodes::scene_name(&document.root).unwrap_or(name),
        triangles,
        materials: materials.list,
        textures: materials.textures.textures,
        images: materials.textures.images,
        lights,
        lamps,
        light_textures,
        cameras,
        fog,
        bounds,
        warnings: warnings.into_iter().collect(),
        notes: notes.into_iter().collect(),
        files: document.files.take(),
    })
}
