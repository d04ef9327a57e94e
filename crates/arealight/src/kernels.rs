//! The manifest: every kernel with its SPIR-V, bindings, constants and group size. A test reads the same
//! facts back out of the SPIR-V, so the two cannot drift.

use crate::plan::RadianceFormat;

pub use binding::{Access, Binding, BindingKind};
pub use images::{read_samples, store_to};

mod binding;
pub mod constant;
mod images;

/// A compute kernel.
#[derive(Debug, PartialEq, Eq)]
pub struct Kernel {
    /// The file's name without its ending.
    pub name: &'static str,
    /// SPIR-V 1.3 for Vulkan 1.1, entry point `main`; a multiple of four bytes.
    pub spirv: &'static [u8],
    /// Invocations of a workgroup in x, y and z.
    pub local_size: [u32; 3],
    /// Size of the push constants in bytes, of the struct of [`crate::gpu`] named for the kernel.
    pub push_constant_size: u32,
    /// The bindings of set 0, by number.
    pub bindings: &'static [Binding],
    /// Specialisation constants that the kernel has.
    pub constants: &'static [u32],
}

impl Kernel {
    /// How many workgroups cover so many invocations.
    pub fn groups_for(&self, invocations: [u32; 3]) -> [u32; 3] {
        [0, 1, 2].map(|i| invocations[i].div_ceil(self.local_size[i]))
    }

    /// A kernel of another module, that is bound and specialised as this one is.
    #[must_use]
    pub const fn like(&self, name: &'static str, spirv: &'static [u8]) -> Self {
        let Self { local_size, push_constant_size, bindings, constants, .. } = *self;
        Self { name, spirv, local_size, push_constant_size, bindings, constants }
    }

    /// The SPIR-V as words, in the machine's byte order.
    pub fn words(&self) -> Vec<u32> {
        self.each_word().collect()
    }

    fn each_word(&self) -> impl Iterator<Item = u32> {
        self.spirv.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
    }

    /// As [`Kernel::words`], with images of this format where the module stores to rgba32f, and a G-buffer of
    /// so many samples: a word a type or a read, so that one module serves all.
    pub fn words_for(&self, format: RadianceFormat, samples: u32) -> Vec<u32> {
        let mut words = self.words();
        store_to(format, &mut words);
        read_samples(samples, &mut words);
        words
    }
}

const fn read(name: &'static str, kind: BindingKind, content: &'static str) -> Binding {
    Binding { name, kind, access: Access::Read, content }
}

const fn write(name: &'static str, kind: BindingKind, access: Access, content: &'static str) -> Binding {
    Binding { name, kind, access, content }
}

/// The light table, of every kernel that looks lobes up.
pub const TABLE: Binding = read(
    "table_image",
    BindingKind::SampledImage,
    "LightTable::texels: 2D array, layer 0 matrix, layer 1 magnitudes, layer 2 Schlick's matrix, layers 3 to \
    5 pairs; rgba16f or \
     rgba32f",
);
/// Polygon lights.
pub const LIGHTS: Binding = read("lights", BindingKind::StorageBuffer, "GpuLight[]");
/// Polygon lights' vertices.
pub const LIGHT_VERTICES: Binding =
    read("light_vertices", BindingKind::StorageBuffer, "vec4[]: position relative to the light's center, 0");
/// Positions of a G-buffer.
pub const G_POSITION: Binding = read(
    "g_position",
    BindingKind::SampledImage,
    "position relative to the origin in xyz, 0 in w where there is no surface (rgba32f); or depth (d32f)",
);
/// Normals and roughness of a G-buffer.
pub const G_NORMAL: Binding = read(
    "g_normal",
    BindingKind::SampledImage,
    "shading normal in xyz, of any length; perceptual roughness in w (rgba16f; rgba32f for mirrors); the \
    shade kernel: by \
     GBufferLayout",
);
/// Base colour and metalness of a G-buffer.
pub const G_BASE_COLOR: Binding = read(
    "g_base_color",
    BindingKind::SampledImage,
    "linear base colour in rgb, metalness in a (rgba8 unorm; sRGB formats decode by themselves); the shade \
    kernel: by \
     GBufferLayout",
);
/// Dielectric reflectance of a G-buffer.
pub const G_SPECULAR: Binding = read(
    "g_specular",
    BindingKind::SampledImage,
    "dielectric F0 in rgb, dielectric F90 in a (rgba8 unorm); read only with Effects::SPECULAR_INPUT, \
     else bind any image; the shade kernel: by GBufferLayout",
);

/// A G-buffer's coats.
pub const G_COAT: Binding = read(
    "g_coat",
    BindingKind::SampledImage,
    "weight of the coat in r, its perceptual roughness in g; with Effects::COAT_NORMAL its normal's place on \
    the octahedron, \
     in [-1, 1], in ba (rgba16f; rg8 unorm without normals); read only with Effects::COAT, else bind any \
     image",
);

/// A G-buffer's sheen.
pub const G_SHEEN: Binding = read(
    "g_sheen",
    BindingKind::SampledImage,
    "linear colour of the sheen in rgb, its perceptual roughness in a (rgba8 unorm; sRGB formats decode by \
    themselves); read only \
     with Effects::SHEEN, else bind any image",
);

/// A G-buffer's second roughnesses.
pub const G_ANISOTROPY: Binding = read(
    "g_anisotropy",
    BindingKind::SampledImage,
    "tangent's place on the octahedron, in [-1, 1], in rg, perceptual roughness along it in b \
    (Effects::ANISOTROPY; 0: \
     isotropic), roughness of the diffuse lobe in a (Effects::DIFFUSE_ROUGHNESS) (rgba16f); read only with \
     one of these, else bind any image",
);

/// A G-buffer's thin films.
pub const G_FILM: Binding = read(
    "g_film",
    BindingKind::SampledImage,
    "how much of a surface a thin film covers in r, its index of refraction in g, its thickness in \
    nanometres in b (rgba16f); read only with \
     Effects::THIN_FILM, else bind any image",
);

/// Lights' textures.
pub const LIGHT_TEXTURES: Binding = read(
    "light_textures",
    BindingKind::FilteredImage,
    "2D array of the lights' textures, a layer each, with the levels of PyramidSize (rgba16f); read only \
    with \
     Effects::IMAGES, else bind any 2D array image",
);

/// Disks, spheres and tubes.
pub const SHAPES: Binding = read(
    "shapes",
    BindingKind::StorageBuffer,
    "GpuShape[]; the shade kernel reads it only with Effects::SHAPES, else bind any buffer",
);

const RADIANCE: Binding = write(
    "radiance_image",
    BindingKind::StorageImage,
    Access::ReadWrite,
    "outgoing radiance in rgb, of the diffuse lobe alone with ShadeOptions::separate_lobes; 1 in a where \
    there is a \
     surface (rgba32f, or by RadianceFormat)",
);
const GLOSSY: Binding = write(
    "glossy_image",
    BindingKind::StorageImage,
    Access::ReadWrite,
    "the glossy lobe's, likewise; used only with ShadeOptions::separate_lobes, else bind radiance_image's \
    again",
);

const PICKS: Binding = write(
    "shadow_picks",
    BindingKind::StorageBuffer,
    Access::Write,
    "u32[]: of each pixel ShadeOptions::shadow_rays words, a light and a lobe for each ray; written only \
    with shadow rays, else bind any \
     buffer",
);

const STENCIL: Binding = read(
    "g_stencil",
    BindingKind::SampledImage,
    "stencil in r, of which eight bits are compared (s8_uint, r8_uint); read only with \
    ShadeOptions::stencil, else bind any image",
);
const LIGHT_COUNTS: Binding = read(
    "light_counts",
    BindingKind::StorageBuffer,
    "LightCounts; read only with ShadeOptions::light_counts, else bind any buffer",
);
const LOBE_HORIZONS: Binding =
    read("lobe_horizons", BindingKind::StorageBuffer, "LightTable::lobe_horizons: twelve floats per cell");
const TILE_LISTS: Binding = write(
    "tile_lists",
    BindingKind::StorageBuffer,
    Access::ReadWrite,
    "tiles::memory bytes; begins with tiles::NO_TILES per class",
);

/// Shades a G-buffer with polygon lights and shapes: whole frames, or the tiles of one class, by
/// [`constant::CLASS`]. Push constants: [`crate::gpu::ShadeConstants`].
///
/// Whole frames use the first [`FRAME_BINDINGS`] bindings alone, and the next with
/// [`ShadeOptions::light_counts`](crate::plan::ShadeOptions::light_counts). A module that was pruned for them
/// has no other, so that its pipeline layout needs no more; the module as it is has `tile_lists`, too.
pub static SHADE: Kernel = Kernel {
    name: "shade",
    spirv: include_bytes!("../spirv/shade.spv"),
    local_size: [8, 8, 1],
    push_constant_size: size_of::<crate::gpu::ShadeConstants>() as u32,
    bindings: &[
        TABLE,
        LIGHTS,
        LIGHT_VERTICES,
        G_POSITION,
        G_NORMAL,
        G_BASE_COLOR,
        G_SPECULAR,
        RADIANCE,
        LIGHT_TEXTURES,
        SHAPES,
        GLOSSY,
        G_COAT,
        G_SHEEN,
        G_ANISOTROPY,
        G_FILM,
        PICKS,
        STENCIL,
        LIGHT_COUNTS,
        Binding { access: Access::Read, ..TILE_LISTS },
        LOBE_HORIZONS.unused(),
    ],
    constants: &[
        constant::EFFECTS,
        constant::FORM_FACTOR,
        constant::POSITION_SOURCE,
        constant::OUTPUT,
        constant::HORIZON,
        constant::SPECULAR_LOBES,
        constant::LOBES,
        constant::FOOTPRINT,
        constant::HAS_QUADS,
        constant::CLASS,
        constant::LAYOUT,
        constant::SHADOW_RAYS,
        constant::VIEW,
        constant::LIGHT_COUNTS,
        constant::SAMPLES,
    ],
};

/// How many of the first bindings of [`SHADE`] whole frames use.
pub const FRAME_BINDINGS: usize = 17;

/// Sorts the tiles of a G-buffer into classes; a workgroup per tile. Its descriptor set is that of [`SHADE`].
/// Push constants: [`crate::gpu::ShadeConstants`].
pub static CLASSIFY: Kernel = Kernel {
    name: "classify",
    spirv: include_bytes!("../spirv/classify.spv"),
    local_size: [8, 8, 1],
    push_constant_size: size_of::<crate::gpu::ShadeConstants>() as u32,
    bindings: &[
        TABLE.unused(),
        LIGHTS,
        LIGHT_VERTICES.unused(),
        G_POSITION,
        G_NORMAL,
        G_BASE_COLOR,
        G_SPECULAR,
        RADIANCE.unused(),
        LIGHT_TEXTURES.unused(),
        SHAPES,
        GLOSSY.unused(),
        G_COAT,
        G_SHEEN,
        G_ANISOTROPY,
        G_FILM,
        PICKS.unused(),
        STENCIL,
        LIGHT_COUNTS,
        TILE_LISTS,
        LOBE_HORIZONS,
    ],
    constants: &[
        constant::EFFECTS,
        constant::POSITION_SOURCE,
        constant::HORIZON,
        constant::SPECULAR_LOBES,
        constant::LOBES,
        constant::LAYOUT,
        constant::CULL,
        constant::VIEW,
        constant::LIGHT_COUNTS,
        constant::SAMPLES,
    ],
};

const UNSHADOWED: Binding = read(
    "unshadowed_image",
    BindingKind::StorageImage,
    "what the shade kernel stored at radiance_image (rgba32f, or by RadianceFormat)",
);
const SHADOW: Binding = write(
    "shadow_image",
    BindingKind::StorageImage,
    Access::ReadWrite,
    "of the light of a pixel: the part that arrives, the penumbra's width, 1 where there is light, how many \
    rays (rgba16f)",
);
const SHADOWED: Binding = write(
    "radiance_image",
    BindingKind::StorageImage,
    Access::ReadWrite,
    "outgoing radiance in rgb; 1 in a where there is a surface (rgba32f, or by RadianceFormat); may be \
    unshadowed_image's",
);
/// What blocks rays: nodes.
pub const BLOCKER_NODES: Binding = read("nodes", BindingKind::StorageBuffer, "Blockers::nodes: GpuBvhNode[]");
/// And triangles.
pub const BLOCKER_TRIANGLES: Binding =
    read("blocker_triangles", BindingKind::StorageBuffer, "Blockers::triangles: vec4[3][]");

const SHADOW_KEPT: Binding = write(
    "shadow_history",
    BindingKind::StorageBuffer,
    Access::ReadWrite,
    "plan::shadow_history_size bytes, zeros before the first frame; used only with ShadowOptions::history, \
    else bind any buffer",
);
const MOTION: Binding = read(
    "g_motion",
    BindingKind::SampledImage,
    "where a pixel's point was in the frame before less where it is, in parts of the image's size (rg16f); \
    read only with \
     ShadowHistory::MotionVectors, else bind any image",
);

/// Traces the shadow rays that [`SHADE`] picked lights and lobes for. Push constants:
/// [`crate::gpu::ShadowConstants`].
pub static SHADOW_RAYS: Kernel = Kernel {
    name: "shadow_rays",
    spirv: include_bytes!("../spirv/shadow_rays.spv"),
    local_size: [8, 8, 1],
    push_constant_size: size_of::<crate::gpu::ShadowConstants>() as u32,
    bindings: &[
        TABLE,
        LIGHTS,
        LIGHT_VERTICES,
        G_POSITION,
        G_NORMAL,
        G_BASE_COLOR,
        G_SPECULAR,
        UNSHADOWED.unused(),
        SHAPES,
        G_COAT,
        G_SHEEN,
        G_ANISOTROPY,
        G_FILM,
        Binding { access: Access::Read, ..PICKS },
        SHADOW,
        SHADOWED.unused(),
        BLOCKER_NODES,
        BLOCKER_TRIANGLES,
        SHADOW_KEPT.unused(),
        MOTION.unused(),
    ],
    constants: &[
        constant::EFFECTS,
        constant::POSITION_SOURCE,
        constant::HORIZON,
        constant::SPECULAR_LOBES,
        constant::LOBES,
        constant::LAYOUT,
        constant::SHADOW_RAYS,
        constant::VIEW,
    ],
};

/// Makes means over frames of the rays of [`SHADOW_RAYS`]. Its descriptor set is that kernel's. Push
/// constants: [`crate::gpu::ShadowConstants`].
pub static SHADOW_HISTORY: Kernel = Kernel {
    name: "shadow_history",
    spirv: include_bytes!("../spirv/shadow_history.spv"),
    local_size: [8, 8, 1],
    push_constant_size: size_of::<crate::gpu::ShadowConstants>() as u32,
    bindings: &[
        TABLE.unused(),
        LIGHTS.unused(),
        LIGHT_VERTICES.unused(),
        G_POSITION,
        G_NORMAL,
        G_BASE_COLOR,
        G_SPECULAR,
        UNSHADOWED.unused(),
        SHAPES.unused(),
        G_COAT,
        G_SHEEN,
        G_ANISOTROPY,
        G_FILM,
        PICKS.unused(),
        SHADOW,
        SHADOWED.unused(),
        BLOCKER_NODES.unused(),
        BLOCKER_TRIANGLES.unused(),
        SHADOW_KEPT,
        MOTION,
    ],
    constants: &[
        constant::EFFECTS,
        constant::POSITION_SOURCE,
        constant::HORIZON,
        constant::SPECULAR_LOBES,
        constant::LOBES,
        constant::LAYOUT,
        constant::SHADOW_RAYS,
        constant::SHADOW_MOTION,
        constant::VIEW,
    ],
};

/// Multiplies unshadowed radiance with what the rays of [`SHADOW_RAYS`] say of it. Its descriptor set is that
/// kernel's. Push constants: [`crate::gpu::ShadowConstants`].
pub static SHADOW_FILTER: Kernel = Kernel {
    name: "shadow_filter",
    spirv: include_bytes!("../spirv/shadow_filter.spv"),
    local_size: [8, 8, 1],
    push_constant_size: size_of::<crate::gpu::ShadowConstants>() as u32,
    bindings: &[
        TABLE.unused(),
        LIGHTS.unused(),
        LIGHT_VERTICES.unused(),
        G_POSITION,
        G_NORMAL,
        G_BASE_COLOR,
        G_SPECULAR,
        UNSHADOWED,
        SHAPES.unused(),
        G_COAT,
        G_SHEEN,
        G_ANISOTROPY,
        G_FILM,
        PICKS.unused(),
        SHADOW,
        SHADOWED,
        BLOCKER_NODES.unused(),
        BLOCKER_TRIANGLES.unused(),
        SHADOW_KEPT,
        MOTION.unused(),
    ],
    constants: &[
        constant::EFFECTS,
        constant::POSITION_SOURCE,
        constant::OUTPUT,
        constant::HORIZON,
        constant::SPECULAR_LOBES,
        constant::LOBES,
        constant::LAYOUT,
        constant::SHADOW_RAYS,
        constant::SHADOW_FILTER,
        constant::SHADOW_HISTORY,
        constant::VIEW,
    ],
};

/// Loads a part of an image into level 0 of a layer of the light textures; an invocation per texel of the
/// level. Push constants: [`crate::gpu::TextureLoadConstants`].
pub static TEXTURE_LOAD: Kernel = Kernel {
    name: "texture_load",
    spirv: include_bytes!("../spirv/texture_load.spv"),
    local_size: [32, 2, 1],
    push_constant_size: size_of::<crate::gpu::TextureLoadConstants>() as u32,
    bindings: &[
        read(
            "source",
            BindingKind::SampledImage,
            "the image: linear light or sRGB, in any format that is sampled as numbers (not integers)",
        ),
        write("out_level", BindingKind::StorageImage, Access::Write, "level 0, every layer (rgba16f)"),
    ],
    constants: &[constant::LOAD_STEPS],
};

/// Makes a level of the light textures from the one before; an invocation per block of
/// [`crate::plan::BLUR_BLOCK`] texels of the level and layer. Push constants:
/// [`crate::pyramid::PyramidSize::weights`] of the level, six
/// floats, and the first layer.
pub static TEXTURE_BLUR: Kernel = Kernel {
    name: "texture_blur",
    spirv: include_bytes!("../spirv/texture_blur.spv"),
    local_size: [32, 2, 1],
    push_constant_size: 4 * (crate::pyramid::MOST_TAPS as u32 + 1),
    bindings: &[
        read("finer_level", BindingKind::SampledImage, "the level before, every layer (rgba16f)"),
        write("out_level", BindingKind::StorageImage, Access::Write, "the level, every layer (rgba16f)"),
    ],
    constants: &[constant::RADIUS],
};

/// Every kernel.
pub static ALL: [&Kernel; 7] =
    [&SHADE, &CLASSIFY, &SHADOW_RAYS, &SHADOW_HISTORY, &SHADOW_FILTER, &TEXTURE_LOAD, &TEXTURE_BLUR];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_module_is_spirv() {
        for kernel in ALL {
            assert_eq!(kernel.spirv.len() % 4, 0, "{}", kernel.name);
            assert_eq!(kernel.words()[0], 0x0723_0203, "{}: SPIR-V's magic number", kernel.name);
        }
    }

    #[test]
    fn one_word_makes_the_shade_kernel_store_to_half_floats() {
        let words = SHADE.words();
        assert_eq!(SHADE.words_for(RadianceFormat::Rgba32Float, 1), words);
        let half = SHADE.words_for(RadianceFormat::Rgba16Float, 1);
        let changed: Vec<_> = words.iter().zip(&half).filter(|(from, to)| from != to).collect();
        // Both images have one type
        assert_eq!(changed, [(&1, &2)]);
        // A module that is cut off is left as it is from there on, without a panic
        let end = words.iter().zip(&half).position(|(from, to)| from != to).unwrap();
        store_to(RadianceFormat::Rgba16Float, &mut words[..end].to_vec());
    }

    #[test]
    fn a_few_words_make_kernels_read_samples() {
        for kernel in [&SHADE, &CLASSIFY] {
            let words = kernel.words();
            let samples = kernel.words_for(RadianceFormat::Rgba32Float, 4);
            let mut changed: Vec<_> = words
                .iter()
                .zip(&samples)
                .filter(|(from, to)| from != to)
                .map(|(from, to)| (*from, *to))
                .collect();
            // The images of floats have one type, the stencil another; each image is read once, or more often
            // in code that is there twice
            let types = changed.extract_if(.., |change| *change == (0, 1)).count();
            assert_eq!(types, 2, "{}", kernel.name);
            assert!(changed.len() >= 8, "{}: {} reads", kernel.name, changed.len());
            assert!(changed.iter().all(|change| *change == (0x2, 0x40)), "{}: {changed:?}", kernel.name);
        }
    }
}
