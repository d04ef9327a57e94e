//! Extensions: which are read, which cost looks where they are not, and which leave nothing to show.

use crate::document::Document;
use crate::load::Loader;
use crate::{SceneError, compressed_views};
use gltf::json;
use std::collections::BTreeSet;

/// What is read; part of a [`KHR_materials`](COSTS_LOOKS) extension may be left out, which is said where a
/// material has it.
const READ: [&str; 20] = [
    "EXT_lights_area",
    "EXT_mesh_gpu_instancing",
    compressed_views::NAMES[0],
    compressed_views::NAMES[1],
    "EXT_texture_webp",
    crate::draco::NAME,
    crate::punctual::NAME,
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
    "KHR_xmp",
    "KHR_xmp_json_ld",
];

/// What a scene is shown without, with a warning, also where a file requires it; and every other
/// `KHR_materials` extension.
const COSTS_LOOKS: [&str; 8] = [
    "EXT_lights_ies",
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
pub(crate) fn check_fallbacks(document: &mut Document) -> Result<(), SceneError> {
    let file = document.file.clone();
    let refused = |field: String, name: &str| {
        Err(SceneError::OnlyInExtension { file: file.clone(), field, extension: name.to_owned() })
    };
    let root = &mut document.root;
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
pub(crate) fn warn_of_unread(loader: &mut Loader) {
    let root = &loader.document.root;
    let mut names: BTreeSet<&String> = root.extensions_used.iter().collect();
    names.extend(root.extensions.iter().flat_map(|extensions| extensions.others.keys()));
    let nodes = root.nodes.iter().flat_map(|node| &node.extensions);
    names.extend(nodes.flat_map(|extensions| extensions.others.keys()));
    let is_unread = |name: &&&String| {
        let of_materials = name.starts_with(MATERIALS) && name.as_str() != "KHR_materials_variants";
        !of_materials && !READ.contains(&name.as_str())
    };
    let unread: Vec<String> = names.iter().filter(is_unread).map(|name| (*name).clone()).collect();
    for name in unread {
        let text = loss(&name);
        loader.warn(name, text);
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
