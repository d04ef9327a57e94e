//! `manifest.json` of an export: what each file is, and what a host defines, binds and pays for.

use super::File;
use super::bridges::{Bridge, bridges, by_header};
use arealight::kernels::{self, Access, Binding, BindingKind, Kernel, constant};
use arealight::{Effects, PyramidSize};
use arealight_vk::TableFormat;
use serde_json::{Map, Value, json};
use sha2::{Digest as _, Sha256};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The manifest's path in an export.
pub const NAME: &str = "manifest.json";

/// What tells an export's manifest from another program's.
const GENERATOR: &str = "arealight export";

/// The manifest of `files`, of which `library` are the GLSL library and its examples; `targets` says what of
/// them is in other languages.
pub fn manifest(files: &[File], library: &[(&str, &str)], targets: &Map<String, Value>) -> Value {
    json!({
        "generator": GENERATOR,
        "version": env!("CARGO_PKG_VERSION"),
        "license": env!("CARGO_PKG_LICENSE"),
        "conventions": CONVENTIONS,
        "files": files.iter().map(file).collect::<Map<_, _>>(),
        "bridges": bridges(library).iter().map(bridge).collect::<Vec<_>>(),
        "headers": by_header(library),
        "effects": effects(),
        "memory": memory(),
        "kernels": kernels::ALL.iter()
            .map(|kernel| (kernel.name.to_owned(), of_kernel(kernel))).collect::<Map<_, _>>(),
        "targets": targets,
    })
}

/// What every number here means; the library's files begin with the same.
const CONVENTIONS: [&str; 7] = [
    "SI radiometry, linear Rec. 709 colour; radiance in W/(m^2 sr).",
    "Right-handed; matrices are column-major and act on column vectors; angles in radians.",
    "roughness is perceptual, alpha = roughness^2; GGX with height-correlated Smith masking-shadowing and \
    Schlick's Fresnel term.",
    "A light's front is the side from which its vertices run counter-clockwise.",
    "Positions are relative to an origin near the camera that the host chooses; a light's vertices are \
    relative to the light's center.",
    "The table's axes are roughness (x) and sqrt(1 - cos theta_view) (y), nodes at both ends; texels are \
    read unfiltered.",
    "A light's image has four array layers of the light textures: its mips, and what lobes \
     see of it, which the kernels texture_load, texture_mip and texture_kernel make. They are read \
     trilinearly, clamped to the edge, at an explicit level.",
];

/// What a file of the library is, by its path.
pub fn content_of(path: &str) -> &'static str {
    match path.split('/').next() {
        Some("include") => "GLSL library; include it as \"arealight/...\"",
        Some("kernels") => "GLSL of our kernels: shade.comp reads a G-buffer of yours by a bridge",
        Some("examples") => "an example of a host's shader",
        _ => "licence: either, as you like",
    }
}

fn file(file: &File) -> (String, Value) {
    let described =
        json!({ "sha256": sha256(&file.bytes), "bytes": file.bytes.len(), "content": file.content });
    (file.path.clone(), described)
}

fn bridge(bridge: &Bridge) -> Value {
    json!({
        "name": bridge.name,
        "prototype": bridge.prototype,
        "returns": bridge.comment,
        "declared_in": bridge.file,
        "declared_with": bridge.toggle,
    })
}

fn effects() -> Map<String, Value> {
    Effects::all().iter().map(|effect| (effect.to_string(), json!(effect.bits()))).collect()
}

/// Bytes on the GPU, before the alignment that the driver adds.
fn memory() -> Value {
    let table = arealight::LightTable::ggx();
    let bytes = |format: TableFormat| format.bytes(&table).len();
    let layer = |side: u32| {
        let size = PyramidSize::new(side).ok()?;
        // Four channels of 16 bits
        Some((format!("{side} x {side}"), json!(size.texels() * 8)))
    };
    let sides = std::iter::successors(Some(PyramidSize::SMALLEST), |side| Some(side * 2));
    let layers = sides.take_while(|side| *side <= PyramidSize::LARGEST).filter_map(layer);
    json!({
        "table": { "rgba16f": bytes(TableFormat::Rgba16Float), "rgba32f": bytes(TableFormat::Rgba32Float) },
        "light_texture_layer": layers.collect::<Map<_, _>>(),
        "light": size_of::<arealight::gpu::GpuLight>(),
        "light_vertex": size_of::<[f32; 4]>(),
        "shape": size_of::<arealight::gpu::GpuShape>(),
    })
}

fn of_kernel(kernel: &Kernel) -> Value {
    let bindings = kernel.bindings().iter().map(binding);
    let constants = kernel.constants().iter().map(|id| (constant_name(*id).to_owned(), json!(id)));
    json!({
        "spirv": format!("spirv/{}.spv", kernel.name),
        "local_size": kernel.local_size(),
        "push_constant_bytes": kernel.push_constant_size(),
        "bindings": bindings.collect::<Vec<_>>(),
        "specialization_constants": constants.collect::<Map<_, _>>(),
    })
}

fn binding(binding: &Binding) -> Value {
    let kind = match binding.kind {
        BindingKind::SampledImage => "sampled image",
        BindingKind::FilteredImage => "combined image sampler: trilinear, clamped to the edge",
        BindingKind::StorageImage => "storage image",
        BindingKind::StorageBuffer => "storage buffer",
    };
    let access = match binding.access {
        Access::Read => "read",
        Access::Write => "write",
        Access::ReadWrite => "read and write",
        Access::None => "none: for another kernel of the pass",
    };
    json!({
        "set": 0,
        "binding": binding.number,
        "name": binding.name,
        "kind": kind,
        "access": access,
        "content": binding.content,
    })
}

fn constant_name(id: u32) -> &'static str {
    const NAMES: [(u32, &str); 26] = [
        (constant::EFFECTS, "EFFECTS"),
        (constant::POSITION_SOURCE, "POSITION_SOURCE"),
        (constant::OUTPUT, "OUTPUT"),
        (constant::HORIZON, "HORIZON"),
        (constant::SPECULAR_LOBES, "SPECULAR_LOBES"),
        (constant::LOBES, "LOBES"),
        (constant::FOOTPRINT, "FOOTPRINT"),
        (constant::LOAD_STEPS, "LOAD_STEPS"),
        (constant::SHAPE, "SHAPE"),
        (constant::HAS_QUADS, "HAS_QUADS"),
        (constant::CLASS, "CLASS"),
        (constant::LAYOUT, "LAYOUT"),
        (constant::CULL, "CULL"),
        (constant::SHADOW_RAYS, "SHADOW_RAYS"),
        (constant::SHADOW_FILTER, "SHADOW_FILTER"),
        (constant::SHADOW_MOTION, "SHADOW_MOTION"),
        (constant::SHADOW_HISTORY, "SHADOW_HISTORY"),
        (constant::VIEW, "VIEW"),
        (constant::LIGHT_COUNTS, "LIGHT_COUNTS"),
        (constant::SAMPLES, "SAMPLES"),
        (constant::MEDIUM_RAYS, "MEDIUM_RAYS"),
        (constant::MEDIUM_IMAGE, "MEDIUM_IMAGE"),
        (constant::MEDIUM_JITTER, "MEDIUM_JITTER"),
        (constant::MEDIUM_SAMPLES, "MEDIUM_SAMPLES"),
        (constant::MEDIUM_LISTS, "MEDIUM_LISTS"),
        (constant::MEDIUM_HIDDEN, "MEDIUM_HIDDEN"),
    ];
    NAMES.iter().find(|(known, _)| *known == id).map_or("unnamed", |(_, name)| name)
}

/// The hashes that an earlier export recorded, by path; none where the bytes are no export's manifest.
pub fn recorded(manifest: &[u8]) -> BTreeMap<String, String> {
    let Ok(manifest) = serde_json::from_slice::<Value>(manifest) else { return BTreeMap::new() };
    if manifest["generator"] != GENERATOR {
        return BTreeMap::new();
    }
    let files = manifest["files"].as_object().into_iter().flatten();
    files.filter_map(|(path, file)| Some((path.clone(), file["sha256"].as_str()?.to_owned()))).collect()
}

/// SHA-256 in hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_constant_of_a_kernel_has_a_name() {
        for kernel in kernels::ALL {
            for id in kernel.constants() {
                assert_ne!(constant_name(*id), "unnamed", "constant {id} of {}", kernel.name);
            }
        }
    }
}
