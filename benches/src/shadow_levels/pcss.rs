//! The kernel that shades by a shadow map: `benches/kernels/pcss.comp`.

use super::area_sampling::RADIANCE;
use arealight::gpu::ShadeConstants;
use arealight::kernels::{
    Access, BLOCKER_NODES, BLOCKER_TRIANGLES, Binding, BindingKind, G_BASE_COLOR, G_NORMAL, G_POSITION,
    G_SPECULAR, Kernel, LIGHT_VERTICES, LIGHTS,
};

/// The id of the specialisation constant `MAKES_MAP`: 1 makes the map, 0 shades by it.
pub const MAKES_MAP: u32 = 0;
/// Of `SEARCH_TAPS`: texels looked up for the depth of blockers.
pub const SEARCH_TAPS: u32 = 1;
/// Of `FILTER_TAPS`: texels looked up for the part of the light that arrives.
pub const FILTER_TAPS: u32 = 2;

/// Texels to a side of the map, of 4 bytes.
pub const MAP_SIZE: u32 = 512;

/// Percentage-closer soft shadows, which multiply the radiance. For one quad that shines to one side.
pub static PCSS: Kernel = Kernel {
    name: "pcss",
    spirv: include_bytes!("../../spirv/pcss.spv"),
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
        Binding {
            name: "depths",
            kind: BindingKind::StorageBuffer,
            access: Access::ReadWrite,
            content: "depths of the shadow map: float[512 x 512]",
        },
    ],
    constants: &[MAKES_MAP, SEARCH_TAPS, FILTER_TAPS],
};
