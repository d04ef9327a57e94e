//! From a document to a scene, step by step.

use crate::document::Document;
use crate::light_textures::{self, TexturedLight};
use crate::scene::LoadOptions;
use crate::{
    Bounds, Scene, SceneError, Warning, area_lights, emitters, extensions, materials, meshes, nodes,
    punctual, skins,
};
use glam::Vec3;
use std::cell::LazyCell;
use std::path::Path;

/// A scene in the making.
pub(crate) struct Loader {
    /// The file.
    pub document: Document,
    /// What has been read so far.
    pub scene: Scene,
    /// The scene's index of each of the file's materials that has been used; the last is the default one.
    pub materials: Vec<Option<u32>>,
    /// The scene's index of each of the file's images that has been used.
    pub images: Vec<Option<u32>>,
    /// The lights that a texture shines through, until all are known.
    pub textured: Vec<TexturedLight>,
    /// The [`nodes::PlacedNode::number`] whose mesh was last found to stand for a shape, and what it shines
    /// with.
    pub shaped: Option<(usize, Vec3)>,
}

impl Loader {
    /// Notes what is not shown as the file says.
    pub fn warn(&mut self, place: impl Into<String>, text: impl Into<String>) {
        let warning = Warning { place: place.into(), text: text.into() };
        if !self.scene.warnings.contains(&warning) {
            self.scene.warnings.push(warning);
        }
    }

    /// Notes what is shown as the file means, though not word for word.
    pub fn note(&mut self, place: impl Into<String>, text: impl Into<String>) {
        let note = Warning { place: place.into(), text: text.into() };
        if !self.scene.notes.contains(&note) {
            self.scene.notes.push(note);
        }
    }
}

pub(crate) fn load(path: &Path, options: LoadOptions) -> Result<Scene, SceneError> {
    let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    read(Document::open(path)?, name, options)
}

pub(crate) fn from_bytes(bytes: &[u8], name: &str, options: LoadOptions) -> Result<Scene, SceneError> {
    read(Document::parse(bytes, name.to_owned(), None)?, name.to_owned(), options)
}

fn read(document: Document, name: String, options: LoadOptions) -> Result<Scene, SceneError> {
    let materials = vec![None; document.root.materials.len() + 1];
    let images = vec![None; document.root.images.len()];
    let scene = Scene { name, ..Scene::default() };
    let mut loader = Loader { document, scene, materials, images, textured: Vec::new(), shaped: None };
    warn_of_what_is_ignored(&mut loader);
    // Place the nodes in the world
    let placed = nodes::place(&mut loader)?;
    // Give every primitive to the triangles, and to the lights where it emits
    let mut meshes = meshes::Meshes::new(&loader);
    let worlds = LazyCell::new(|| nodes::worlds(&placed));
    for node in &placed {
        let pose = match node.skin {
            Some(skin) => skins::pose(&mut loader, &worlds, node, skin)?,
            None => None,
        };
        let primitives = meshes.of_node(&mut loader, node)?;
        let mut mesh = Vec::with_capacity(primitives.len());
        for primitive in &*primitives {
            let material = materials::resolve(&mut loader, primitive)?;
            mesh.push(meshes::place(&mut loader, (node, pose.as_deref()), primitive, material)?);
        }
        emitters::add(&mut loader, node, &mesh);
    }
    light_textures::assign(&mut loader);
    emitters::finish(&mut loader);
    // Lights and cameras that hang on nodes
    let shown = loader.scene.lights.len();
    area_lights::add(&mut loader, &placed)?;
    loader.scene.bounds = loader.scene.triangles.iter().flat_map(|t| t.positions).collect();
    punctual::add(&mut loader, &placed, options.light_size)?;
    let Loader { scene, .. } = &mut loader;
    emitters::add_bare(scene, shown);
    if scene.bounds.is_empty() {
        let lights = scene.lights.iter().flat_map(|light| light.shape.bounds());
        scene.bounds = lights.collect::<Bounds>();
    }
    nodes::add_cameras(&mut loader, &placed);
    warn_of_what_is_missing(&mut loader);
    Ok(loader.scene)
}

fn warn_of_what_is_ignored(loader: &mut Loader) {
    let animations = loader.document.root.animations.len();
    if animations > 0 {
        loader.warn("animations", format!("{animations} ignored; the scene is shown at rest"));
    }
    extensions::warn_of_unread(loader);
}

/// What is said of a scene without lights.
pub(crate) const NO_LIGHTS: &str = "has no area lights (emissive faces or EXT_lights_area): surfaces are \
black (--lights studio adds softboxes)";

fn warn_of_what_is_missing(loader: &mut Loader) {
    let place = "scene";
    if loader.scene.triangles.is_empty() {
        loader.warn(place, "has no triangles: there is no surface to light");
    }
    if loader.scene.lights.is_empty() {
        loader.warn(place, NO_LIGHTS);
    }
}
