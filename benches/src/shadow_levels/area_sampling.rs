//! The kernel that shades by rays to points of lights: `benches/kernels/area_sampling.comp`.

use arealight::gpu::ShadeConstants;
use arealight::kernels::{
    Access, BLOCKER_NODES, BLOCKER_TRIANGLES, Binding, BindingKind, G_BASE_COLOR, G_NORMAL, G_POSITION,
    G_SPECULAR, Kernel, LIGHT_VERTICES, LIGHTS,
};

/// The id of the specialisation constant `RAYS`: how many a pixel has, 1 to 16.
pub const RAYS: u32 = 0;

/// What the kernels that are compared with change.
pub(super) const RADIANCE: Binding = Binding {
    name: "radiance_image",
    kind: BindingKind::StorageImage,
    access: Access::ReadWrite,
    content: "radiance is added to, or multiplied (rgba32f)",
};

/// Plain area sampling: of each ray the light by power over distance squared, and a point of it by area. For
/// convex quads without a texture.
pub static AREA_SAMPLING: Kernel = Kernel {
    name: "area_sampling",
    spirv: include_bytes!("../../spirv/area_sampling.spv"),
    local_size: [8, 8, 1],
    push_constant_size: size_of::<ShadeConstants>() as u32,
    bindings: &[
        LIGHTS,
        LIGHT_VERTICES,
        G_POSITION,
        G_NORMAL,
        G_BASE_COLOR,
        G_SPECULAR,
        RADIANCE,
        BLOCKER_NODES,
        BLOCKER_TRIANGLES,
    ],
    constants: &[RAYS],
};
