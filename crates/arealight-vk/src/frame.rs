//! A frame: its pixels, camera and lights.

use crate::resource::Resource;
use arealight::LightSummary;
#[cfg(doc)]
use arealight::plan::ShadeOptions;
use ash::vk;
use glam::{Mat4, Vec3};

/// What differs from frame to frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ShadeFrame {
    /// How many pixels are shaded, from the corner x = y = 0 of the radiance images on, or from `offset`. The
    /// images may be larger. The G-buffer's images have a texel for each pixel, or
    /// [`ShadeOptions::texels_per_pixel`] to a side.
    pub size: [u32; 2],
    /// With [`ShadeOptions::rectangle`], the first pixel that is shaded; else zero. In the G-buffer it has
    /// the same place, times [`ShadeOptions::texels_per_pixel`].
    pub offset: [u32; 2],
    /// The viewport that drew the G-buffer. Its height is negative where y is up in clip space, as in hosts
    /// that come from Direct3D, Metal or WebGPU. None: just the texels of `size` and `offset`, y down, depth
    /// from 0 to 1. Only positions from depth, and a shadow's history, depend on it.
    pub viewport: Option<Viewport>,
    /// The camera's position relative to the origin that lights and positions are packed with; with
    /// [`ShadeOptions::orthographic`] the direction to it, of any length but zero. With shadow rays the
    /// length is that at which a perspective camera would stand that sees as much: what counts as one plane
    /// depends on it.
    pub camera: Vec3,
    /// The inverse of (projection × view), from clip space to positions relative to the origin: of the matrix
    /// that drew the depth, jitter included. Needed with [`ShadeOptions::from_depth`], else ignored.
    pub position_from_clip: Option<Mat4>,
    /// [`PackedLights::summary`](arealight::PackedLights::summary) of the lights in the set's buffers; with
    /// [`ShadeOptions::light_counts`] the most that there may be.
    pub lights: LightSummary,
    /// With tiles, [`ShadeResources::tile_lists`](crate::ShadeResources::tile_lists) of the set: dispatches
    /// are read from it. Passes without tiles do not use it.
    pub tile_lists: Option<Resource>,
    /// With [`ShadeOptions::shadow_rays`], of the random numbers that rays are drawn with: one more in each
    /// frame. Else ignored.
    pub seed: u32,
    /// The rows of pixels that this record shades, from the first to before the second, of those that `size`
    /// says; None: all. Both are multiples of 8, or the second is the last row's end. A frame of more work
    /// than a driver's watchdog allows is recorded and submitted by [`ShadeFrame::parts`]. The picture is the
    /// same to the bit.
    pub rows: Option<[u32; 2]>,
    /// With [`ShadeOptions::stencil`], which pixels are shaded. Else ignored.
    pub stencil: StencilTest,
    /// With [`Descriptors::LightOffsets`](crate::Descriptors::LightOffsets), where the frame's lights,
    /// vertices and shapes begin, in bytes after what the set was written with. Else zero.
    pub light_offsets: [u32; 3],
}

/// Shades pixels whose stencil equals the reference in the bits of the mask: `VK_COMPARE_OP_EQUAL`. By
/// default all are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StencilTest {
    /// The bits that are compared.
    pub compare_mask: u8,
    /// What they must be.
    pub reference: u8,
}

impl ShadeFrame {
    /// The frame in parts of whole rows of workgroups, each with at most `most` pairs of a pixel and a light;
    /// the smallest part is a row of workgroups (8 rows of pixels). docs/gpu.md has the cost of a light; 2^24
    /// pairs take less than two seconds on a device that does ten million a second. Tiles leave out pairs
    /// that are counted here.
    pub fn parts(&self, most: u64) -> impl Iterator<Item = Self> + use<> {
        let frame = *self;
        let [first, end] = frame.rows.unwrap_or([0, frame.size[1]]);
        let lights = u64::from(frame.lights.light_count) + u64::from(frame.lights.shape_count);
        let pairs_of_group_row = u64::from(GROUP_SIDE) * u64::from(frame.size[0]) * lights.max(1);
        let group_rows = (most / pairs_of_group_row.max(1)).clamp(1, u64::from(u32::MAX / GROUP_SIDE));
        let step = group_rows as u32 * GROUP_SIDE;
        (first..end)
            .step_by(step as usize)
            .map(move |row| Self { rows: Some([row, row.saturating_add(step).min(end)]), ..frame })
    }
}

/// Rows of pixels of a workgroup, of the kernels shade and classify alike.
pub(crate) const GROUP_SIDE: u32 = arealight::tiles::SIDE;

/// The rectangle of a G-buffer's texels that clip space was drawn to, as `vkCmdSetViewport` got it:
/// `VkViewport`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Viewport {
    /// Where x = -1 in clip space is, in texels.
    pub x: f32,
    /// Where y = -1 in clip space is, in texels: with a negative height the lower edge.
    pub y: f32,
    /// Above 0.
    pub width: f32,
    /// Negative where y is up in clip space. Not 0.
    pub height: f32,
    /// The depth that is stored of depth 0 in clip space.
    pub min_depth: f32,
    /// The depth that is stored of depth 1. Not `min_depth`.
    pub max_depth: f32,
}

impl From<vk::Viewport> for Viewport {
    fn from(viewport: vk::Viewport) -> Self {
        let vk::Viewport { x, y, width, height, min_depth, max_depth } = viewport;
        Self { x, y, width, height, min_depth, max_depth }
    }
}
