//! Where a material's textures lie on its meshes: which texture coordinates, and `KHR_texture_transform`.
//!
//! A mesh is drawn with one mapping for all textures of its material, which files nearly always have. Where
//! they differ the first texture's is drawn, with a warning; what a mesh lights is by its emissive texture's
//! own.

use crate::extensions::OF_MATERIALS;
use glam::{DVec2, Vec2};
use gltf::json;
use serde_json::Value;

const TRANSFORM: &str = "KHR_texture_transform";

/// Larger numbers in a file are cut to this: coordinates of textures are `f32`.
const LARGEST: f64 = 1e6;

/// Which texture coordinates a texture is read at, and how they are moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct UvMapping {
    /// The number in `TEXCOORD_n`.
    pub set: u32,
    offset: DVec2,
    /// Radians.
    rotation: f64,
    scale: DVec2,
}

impl Default for UvMapping {
    fn default() -> Self {
        Self { set: 0, offset: DVec2::ZERO, rotation: 0.0, scale: DVec2::ONE }
    }
}

impl UvMapping {
    fn new(set: u32, transform: Option<&Value>) -> Self {
        let said = |name: &str| transform.and_then(|transform| transform.get(name));
        let number = |value: Option<&Value>, otherwise: f64| {
            value.and_then(Value::as_f64).map_or(otherwise, |x| x.clamp(-LARGEST, LARGEST))
        };
        let pair = |name: &str, otherwise: f64| {
            let element = |at: usize| number(said(name).and_then(|value| value.get(at)), otherwise);
            DVec2::new(element(0), element(1))
        };
        let other_set = said("texCoord").and_then(Value::as_u64).and_then(|set| u32::try_from(set).ok());
        Self {
            set: other_set.unwrap_or(set),
            offset: pair("offset", 0.0),
            rotation: number(said("rotation"), 0.0),
            scale: pair("scale", 1.0),
        }
    }

    /// Scaled, then turned, then moved. The picture turns clockwise as it is seen, its rows from the top.
    pub fn apply(&self, uv: Vec2) -> Vec2 {
        if (Self { set: 0, ..*self }) == Self::default() {
            return uv;
        }
        let (sin, cos) = self.rotation.sin_cos();
        let DVec2 { x, y } = uv.as_dvec2() * self.scale;
        let moved = DVec2::new(cos * x + sin * y, cos * y - sin * x) + self.offset;
        moved.clamp(DVec2::splat(f64::from(f32::MIN)), DVec2::splat(f64::from(f32::MAX))).as_vec2()
    }
}

/// The mappings of a material.
#[derive(Debug, Clone, Default)]
pub(crate) struct Mappings {
    /// That of its first texture, with which all are drawn.
    pub drawn: UvMapping,
    /// The emissive texture's.
    pub light: UvMapping,
    /// The textures that are mapped otherwise than the first, and the first's name.
    pub others: Vec<String>,
    pub first: String,
}

impl Mappings {
    pub fn of(material: &json::Material) -> Self {
        let textures = textures(material);
        let Some((first, drawn)) = textures.first().cloned() else { return Self::default() };
        let light = textures.iter().find(|(name, _)| name == "emissiveTexture").map_or(drawn, |(_, uv)| *uv);
        let others = textures.into_iter().filter(|(_, mapping)| *mapping != drawn).map(|(name, _)| name);
        Self { drawn, light, others: others.collect(), first }
    }
}

/// The names and mappings of a material's textures that are read.
fn textures(material: &json::Material) -> Vec<(String, UvMapping)> {
    let pbr = &material.pbr_metallic_roughness;
    let of_info = |name: &str, info: &Option<json::texture::Info>| {
        let info = info.as_ref()?;
        let transform = info.extensions.as_ref().and_then(|e| e.others.get(TRANSFORM));
        Some((name.to_owned(), UvMapping::new(info.tex_coord, transform)))
    };
    let normal = material.normal_texture.as_ref().map(|info| {
        let transform = info.extensions.as_ref().and_then(|e| e.others.get(TRANSFORM));
        ("normalTexture".to_owned(), UvMapping::new(info.tex_coord, transform))
    });
    let specular = material.extensions.as_ref().and_then(|e| e.specular.as_ref());
    let mut found: Vec<(String, UvMapping)> = [
        of_info("baseColorTexture", &pbr.base_color_texture),
        of_info("metallicRoughnessTexture", &pbr.metallic_roughness_texture),
        normal,
        of_info("emissiveTexture", &material.emissive_texture),
        specular.and_then(|s| of_info("specularTexture", &s.specular_texture)),
        specular.and_then(|s| of_info("specularColorTexture", &s.specular_color_texture)),
    ]
    .into_iter()
    .flatten()
    .collect();
    for extension in OF_MATERIALS {
        let said =
            material.extensions.as_ref().and_then(|e| e.others.get(extension)).and_then(Value::as_object);
        for (name, info) in said.into_iter().flatten().filter(|(name, _)| name.ends_with("Texture")) {
            let set = info["texCoord"].as_u64().and_then(|set| u32::try_from(set).ok()).unwrap_or(0);
            found.push((name.clone(), UvMapping::new(set, info["extensions"].get(TRANSFORM))));
        }
    }
    found
}
