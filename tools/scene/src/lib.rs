//! glTF scenes for Arealight: lights, materials, triangles, cameras, and the scan that says which
//! effects that they need.
//!
//! [`Scene::load`] reads a `.gltf` or `.glb` file. Files are not trusted: whatever is in them gives a scene,
//! perhaps with [`Warning`]s about what was left out, or a [`SceneError`] that names the file and the field,
//! and never a panic.
//!
//! # What becomes a light
//! - Flat geometry with an emissive material: coplanar neighbours merge into one outline, so a quad is one
//!   light of four vertices. Its radiance is emissiveFactor × `KHR_materials_emissive_strength`, as numbers
//!   in W/(m² sr). A double-sided material makes a two-sided light, but for the parts of a mesh that are
//!   closed and face outwards: nobody sees their inside, and each is one-sided. An emissiveTexture is shown
//!   where it is mapped onto the outline by one affine map: a part of it is a layer of the light textures
//!   ([`Scene::light_textures`]), and where the mapping has a seam, another light begins. Parts that are
//!   black are no lights.
//! - `EXT_lights_area` rectangles and disks, which have no visible geometry: radiance = colour × intensity in
//!   nits / [`LUMENS_PER_WATT`].
//! - A mesh on the joints of a skin shines where they are, and one of `EXT_mesh_gpu_instancing` once an
//!   instance.
//! - Emissive meshes whose node has a word for what they stand for:
//!   `"extras": { "arealight": { "shape": "sphere", "radius": 0.5 } }`. The mesh is drawn, and a
//!   [`Light`](arealight::Light) of that shape lights. Shapes are `disk` (which faces +Y), `sphere`,
//!   `cylinder`, `pipe` (a cylinder without caps) and `capsule`, about the node's origin and its Y axis, each
//!   with a `radius`, and the last three with the `height` of their straight part, in the node's space. A
//!   disk may be scaled at will; a sphere and a capsule stay what they are under a uniform scale, a cylinder
//!   as long as it stays round.
//!
//! # Spaces
//! Positions are world positions in `f64`, in the file's unit of length (glTF: metres), right-handed, +Y up.
//! [`SceneBuffers`] makes them `f32` relative to an origin.

#![allow(clippy::missing_errors_doc, clippy::missing_panics_doc)] // what the types say
#![forbid(unsafe_code)]

mod accessor;
mod animations;
mod area_lights;
mod attributes;
mod borders;
mod bounds;
mod budget;
mod camera;
mod closed;
mod compressed_views;
mod document;
mod draco;
mod effects;
mod emitters;
mod error;
mod extensions;
mod gpu;
mod ies_lights;
mod images;
mod light_textures;
mod lit_texels;
mod load;
mod materials;
mod meshes;
mod messages;
mod mips;
mod moving;
mod node_lights;
mod nodes;
mod numbers;
mod outlines;
mod primitives;
mod punctual;
pub mod rays;
mod scene;
mod shape_lights;
mod shaping;
mod shown;
mod skins;
mod small_parts;
mod studio;
mod tangents;
mod transforms;
mod uv_map;
mod uv_mapping;
mod weld;

pub use area_lights::LUMENS_PER_WATT;
pub use bounds::{Bounds, MAX_COORDINATE};
pub use budget::memory_of;
pub use camera::Camera;
pub use effects::{RequiredEffect, required_effects};
pub use error::SceneError;
pub use gpu::{BufferError, Hit, SceneBuffers};
pub use light_textures::{LightTextureSource, MAX_LIGHT_TEXELS, MAX_LIGHT_TEXTURES};
pub use load::LoadOptions;
pub use messages::Warning;
pub use scene::{
    Image, MAX_TRIANGLES, Scene, SceneFog, SceneLamp, SceneLightTexture, SceneMaterial, Texture, Triangle,
    Wrap,
};
pub use shown::MAX_REPEATS;
