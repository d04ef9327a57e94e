//! The kernel that shades by a shadow map: `benches/kernels/pcss.comp`.

use arealight::kernels::Kernel;

/// The id of the specialisation constant `MAKES_MAP`: 1 makes the map, 0 shades by it.
pub const MAKES_MAP: u32 = 0;
/// Of `SEARCH_TAPS`: texels looked up for the depth of blockers.
pub const SEARCH_TAPS: u32 = 1;
/// Of `FILTER_TAPS`: texels looked up for the part of the light that arrives.
pub const FILTER_TAPS: u32 = 2;

/// Texels to a side of the map, of 4 bytes.
pub const MAP_SIZE: u32 = 512;

/// Percentage-closer soft shadows, which multiply the radiance. For one quad that shines to one side.
pub static PCSS: Kernel = Kernel::new("pcss", include_bytes!("../../spirv/pcss.spv"));
