//! The kernel that shades by rays to points of lights: `benches/kernels/area_sampling.comp`.

use arealight::kernels::Kernel;

/// The id of the specialisation constant `RAYS`: how many a pixel has, 1 to 16.
pub const RAYS: u32 = 0;

/// Plain area sampling: of each ray the light by power over distance squared, and a point of it by area. For
/// convex quads without a texture.
pub static AREA_SAMPLING: Kernel =
    Kernel::new("area_sampling", include_bytes!("../../spirv/area_sampling.spv"));
