//! Ids of the specialisation constants, the same in every kernel.

/// [`crate::Effects`] as bits.
pub const EFFECTS: u32 = 0;
/// [`crate::plan::ShadeOptions::from_depth`].
pub const POSITION_SOURCE: u32 = 2;
/// [`crate::plan::ShadeOptions::output_bits`].
pub const OUTPUT: u32 = 3;
/// [`crate::Horizon`].
pub const HORIZON: u32 = 4;
/// [`crate::SpecularLobes`].
pub const SPECULAR_LOBES: u32 = 5;
/// [`crate::Lobes`].
pub const LOBES: u32 = 6;
/// [`crate::Footprint`].
pub const FOOTPRINT: u32 = 7;
/// [`crate::gpu::TextureLoadConstants::steps`].
pub const LOAD_STEPS: u32 = 9;
/// [`crate::gpu::GpuShape`]'s kinds, or [`crate::gpu::GpuShape::ANY`].
pub const SHAPE: u32 = 10;
/// 0 where no polygon light of a frame is a convex quad without an image, else 1.
pub const HAS_QUADS: u32 = 11;
/// [`crate::TileClass`], or [`crate::tiles::NO_CLASS`] for whole frames.
pub const CLASS: u32 = 12;
/// [`crate::plan::GBufferLayout`].
pub const LAYOUT: u32 = 13;
/// 1 where [`crate::plan::TileOptions::cull_threshold`] is not zero.
pub const CULL: u32 = 14;
/// [`crate::plan::ShadeOptions::shadow_rays`].
pub const SHADOW_RAYS: u32 = 15;
/// [`crate::plan::ShadowFilter`].
pub const SHADOW_FILTER: u32 = 16;
/// 1 where the host gives motion vectors, else 0.
pub const SHADOW_MOTION: u32 = 17;
/// 1 where shadows are means over frames, else 0.
pub const SHADOW_HISTORY: u32 = 18;
/// [`crate::plan::ShadeOptions::view_bits`].
pub const VIEW: u32 = 19;
/// [`crate::plan::ShadeOptions::light_counts`].
pub const LIGHT_COUNTS: u32 = 20;
/// [`crate::plan::ShadeOptions::samples`].
pub const SAMPLES: u32 = 21;
/// [`crate::plan::MediumOptions::shadow_rays`]: 0 without, 1 with [`crate::plan::MediumOptions::one_light`],
/// else 2.
pub const MEDIUM_RAYS: u32 = 22;
/// [`crate::plan::MediumOptions::by_image`].
pub const MEDIUM_IMAGE: u32 = 23;
/// [`crate::plan::MediumOptions::jitter`].
pub const MEDIUM_JITTER: u32 = 24;
/// Of [`super::MEDIUM_SCATTER`]: [`crate::plan::MediumOptions::samples`].
pub const MEDIUM_SAMPLES: u32 = 25;
/// Whether the frame has [`crate::plan::MediumOptions::least_lights`].
pub const MEDIUM_LISTS: u32 = 26;
/// [`crate::plan::MediumOptions::fill_hidden`].
pub const MEDIUM_HIDDEN: u32 = 27;
