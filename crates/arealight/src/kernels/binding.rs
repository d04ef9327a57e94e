//! What a kernel is bound to.

use crate::planes::Plane;

/// What a binding holds. All are in descriptor set 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BindingKind {
    /// A sampled image, read by texel; no sampler.
    SampledImage,
    /// A sampled image with a sampler that is part of the layout: trilinear, clamped to the edge, normalised
    /// coordinates.
    FilteredImage,
    /// A storage image.
    StorageImage,
    /// A storage buffer.
    StorageBuffer,
}

/// What a kernel does to a binding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// Reads only.
    Read,
    /// Writes only.
    Write,
    /// Reads and writes.
    ReadWrite,
    /// Nothing: the binding is in the descriptor set for another kernel of the pass.
    None,
}

/// A binding of descriptor set 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Binding {
    /// Its number.
    pub number: u32,
    /// Its name in the GLSL.
    pub name: &'static str,
    /// What it holds.
    pub kind: BindingKind,
    /// What is done to it.
    pub access: Access,
    /// Content, encoding and smallest sufficient format; empty for what no kernel of this crate has.
    pub content: &'static str,
}

/// What a binding of this name holds, in the kernels of this crate.
pub(super) fn content(name: &str) -> &'static str {
    let bound = BOUND.iter().find(|(known, _)| *known == name).map(|(_, content)| *content);
    bound.or_else(|| Plane::bound_at(name).map(Plane::content)).unwrap_or_default()
}

/// What bindings hold that are no planes.
const BOUND: [(&str, &str); 22] = [
    (
        "table_image",
        "LightTable::texels: 2D array, layer 0 matrix, layer 1 magnitudes, layer 2 Schlick's matrix, layers 3 \
         to 5 pairs; rgba16f or rgba32f",
    ),
    ("lights", "GpuLight[]"),
    ("light_vertices", "vec4[]: position relative to the light's center, 0"),
    (
        "shapes",
        "GpuShape[]: disks, spheres and tubes; read only where a frame has some, else bind any buffer",
    ),
    (
        "light_textures",
        "2D array of the lights' textures, a layer each, with the levels of PyramidSize (rgba16f); read only \
         with Effects::IMAGES, else bind any 2D array image",
    ),
    (
        "radiance_image",
        "outgoing radiance in rgb, of the diffuse lobe alone with ShadeOptions::separate_lobes; 1 in a where \
         there is a surface (rgba32f, or by RadianceFormat)",
    ),
    (
        "glossy_image",
        "as radiance_image, of the glossy lobe; used only with ShadeOptions::separate_lobes, else bind \
         radiance_image's again",
    ),
    (
        "shadow_picks",
        "plan::shadow_picks_size bytes: of each pixel the specular lobes' part, and of each ray a light, a lobe \
         and a colour; written only with shadow rays, else bind any buffer",
    ),
    ("light_counts", "LightCounts; read only with ShadeOptions::light_counts, else bind any buffer"),
    ("lobe_horizons", "LightTable::lobe_horizons: twelve floats per cell"),
    ("tile_lists", "tiles::memory bytes; begins with tiles::NO_TILES per class"),
    (
        "unshadowed_image",
        "what the shade kernel stored at radiance_image (rgba32f, or by RadianceFormat); may be \
         radiance_image",
    ),
    (
        "shadow_image",
        "of the light of a pixel: the part that arrives, the penumbra's width, from 1 on where there is light, \
         how many rays (rgba16f)",
    ),
    ("nodes", "Blockers::nodes: GpuBvhNode[]"),
    ("blocker_triangles", "Blockers::triangles: vec4[3][], in w of the first the bits of a number"),
    (
        "shadow_history",
        "plan::shadow_history_size bytes, zeros before the first frame; used only with \
         ShadowOptions::history, else bind any buffer",
    ),
    (
        "froxels",
        "3D, a texel a froxel: what is scattered per unit of length and the extinction, then the sum from the \
         camera on and what is let through (rgba16f)",
    ),
    (
        "medium_image",
        "3D, a texel a froxel: scattering coefficients in rgb, extinction in a; read only with \
         MediumOptions::by_image, else bind any sampled image",
    ),
    ("source", "the image: linear light or sRGB, in any format that is sampled as numbers (not integers)"),
    ("finer_level", "the level before, every layer (rgba16f)"),
    ("all_levels", "every level and layer (rgba16f)"),
    ("out_level", "the level, every layer (rgba16f)"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernels::{ALL, Kernel};

    #[test]
    fn every_binding_of_a_kernel_says_what_it_holds() {
        let named =
            |name: &str| ALL.iter().any(|kernel| kernel.bindings().iter().any(|one| one.name == name));
        for binding in ALL.into_iter().flat_map(Kernel::bindings) {
            assert!(!binding.name.is_empty() && !binding.content.is_empty(), "{binding:?}");
        }
        // And no content is of a binding that is gone
        for name in BOUND.map(|(name, _)| name).into_iter().chain(Plane::ALL.map(Plane::binding)) {
            assert!(named(name), "'{name}'");
        }
        assert!(!named("g_transparency"));
    }
}
