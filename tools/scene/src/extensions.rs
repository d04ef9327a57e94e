//! Extensions: which are read, which cost looks where they are not, and which leave nothing to show.

use crate::error::SceneError;
use crate::messages::Messages;
use gltf::json;
use serde_json::{Map, Value};
use std::collections::BTreeSet;

/// Compressed buffer views: the second has all that the first has.
pub(crate) const MESHOPT: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];
pub(crate) const AREA_LIGHTS: &str = "EXT_lights_area";
pub(crate) const DRACO: &str = "KHR_draco_mesh_compression";
pub(crate) const IES_LIGHTS: &str = "EXT_lights_ies";
pub(crate) const INSTANCING: &str = "EXT_mesh_gpu_instancing";
pub(crate) const PUNCTUAL_LIGHTS: &str = "KHR_lights_punctual";

pub(crate) const ANISOTROPY: &str = "KHR_materials_anisotropy";
pub(crate) const CLEARCOAT: &str = "KHR_materials_clearcoat";
pub(crate) const DIFFUSE_TRANSMISSION: &str = "KHR_materials_diffuse_transmission";
pub(crate) const IRIDESCENCE: &str = "KHR_materials_iridescence";
pub(crate) const SHEEN: &str = "KHR_materials_sheen";
pub(crate) const TRANSMISSION: &str = "KHR_materials_transmission";
pub(crate) const UNLIT: &str = "KHR_materials_unlit";

/// Extensions of materials that are read here; the gltf crate reads others. Those that are not read are said
/// where a material has them.
pub(crate) const OF_MATERIALS: [&str; 7] =
    [ANISOTROPY, CLEARCOAT, DIFFUSE_TRANSMISSION, IRIDESCENCE, SHEEN, TRANSMISSION, UNLIT];

/// What else is read.
const READ: [&str; 13] = [
    AREA_LIGHTS,
    IES_LIGHTS,
    INSTANCING,
    MESHOPT[0],
    MESHOPT[1],
    WEBP,
    DRACO,
    PUNCTUAL_LIGHTS,
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
    "KHR_xmp",
    "KHR_xmp_json_ld",
];

/// What a scene is shown without, with a warning, also where a file requires it; and every other
/// `KHR_materials` extension.
const COSTS_LOOKS: [&str; 7] = [
    "EXT_lights_image_based",
    "KHR_animation_pointer",
    "KHR_audio_emitter",
    "KHR_interactivity",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "MSFT_lod",
];

const MATERIALS: &str = "KHR_materials_";
const WEBP: &str = "EXT_texture_webp";

/// Refuses what a file requires and nothing can be shown without.
pub(crate) fn check_required(file: &str, required: &[String]) -> Result<(), SceneError> {
    let may_be_required =
        |name: &str| READ.contains(&name) || COSTS_LOOKS.contains(&name) || name.starts_with(MATERIALS);
    match required.iter().find(|name| !may_be_required(name)) {
        Some(name) => Err(SceneError::RequiredExtension { file: file.to_owned(), extension: name.clone() }),
        None => Ok(()),
    }
}

/// Makes textures that are WebP alone refer to that image, and refuses data that are only in an extension
/// that is not read.
pub(crate) fn check_fallbacks(file: &str, root: &mut json::Root) -> Result<(), SceneError> {
    let refused = |field: String, name: &str| {
        Err(SceneError::OnlyInExtension { file: file.to_owned(), field, extension: name.to_owned() })
    };
    for (t, texture) in root.textures.iter_mut().enumerate() {
        if texture.source.value() != NO_IMAGE {
            continue;
        }
        let others = texture.extensions.iter().flat_map(|extensions| &extensions.others);
        let webp =
            others.clone().find(|(name, _)| *name == WEBP).and_then(|(_, webp)| webp["source"].as_u64());
        if let Some(image) = webp.and_then(|image| u32::try_from(image).ok()) {
            texture.source = json::Index::new(image);
        } else if let Some((name, _)) = others.clone().next() {
            return refused(format!("textures[{t}]"), name);
        }
    }
    Ok(())
}

/// What stands for a texture without an image.
const NO_IMAGE: usize = u32::MAX as usize;

/// Warns once of each extension that is not read. A material's are said where it is used.
pub(crate) fn warn_of_unread(root: &json::Root, messages: &mut Messages) {
    let mut names: BTreeSet<&String> = root.extensions_used.iter().collect();
    names.extend(root.extensions.iter().flat_map(|extensions| extensions.others.keys()));
    let nodes = root.nodes.iter().flat_map(|node| &node.extensions);
    names.extend(nodes.flat_map(|extensions| extensions.others.keys()));
    let is_unread = |name: &&&String| {
        let of_materials = name.starts_with(MATERIALS) && name.as_str() != "KHR_materials_variants";
        !of_materials && !READ.contains(&name.as_str())
    };
    for name in names.iter().filter(is_unread) {
        messages.warn(name.as_str(), loss(name));
    }
}

/// What a scene lacks without an extension.
fn loss(name: &str) -> &'static str {
    match name {
        "EXT_lights_image_based" => "light from all around is left out",
        "KHR_materials_variants" => "the default materials are shown",
        "KHR_texture_basisu" | "EXT_texture_avif" | "MSFT_texture_dds" => {
            "is not supported: the textures' other images are shown"
        }
        _ => "is not supported: ignored",
    }
}

/// The name under which an element says something of compressed buffer views, and what.
pub(crate) fn meshopt(others: &Map<String, Value>) -> Option<(&str, &Value)> {
    let (name, said) = others.iter().find(|(name, _)| MESHOPT.contains(&name.as_str()))?;
    Some((name, said))
}

/// Whether a buffer without data stands for those that are there compressed.
pub(crate) fn is_fallback(buffer: &json::Buffer) -> bool {
    let said = buffer.extensions.as_ref().and_then(|extensions| meshopt(&extensions.others));
    said.is_some_and(|(_, said)| said["fallback"] == true)
}
