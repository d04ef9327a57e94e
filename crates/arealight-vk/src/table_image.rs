//! The light table on the GPU: an array image of [`arealight::table::LAYERS`] layers.

use crate::context::Context;
use crate::error::Error;
use crate::image::{Image, ImageInfo};
use crate::image_memory::image_memory;
use crate::resource::Resource;
use arealight::LightTable;
use arealight::table::LAYERS;
use ash::vk;

/// The texel format of the table on the GPU.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TableFormat {
    /// Eight bytes a texel. What that costs is tested: see `tests/tests/gpu/shading.rs`.
    Rgba16Float,
    /// Sixteen bytes a texel, the fit as it is.
    #[default]
    Rgba32Float,
}

impl TableFormat {
    /// The Vulkan format.
    pub fn vulkan(self) -> vk::Format {
        match self {
            Self::Rgba16Float => vk::Format::R16G16B16A16_SFLOAT,
            Self::Rgba32Float => vk::Format::R32G32B32A32_SFLOAT,
        }
    }

    /// The table's texels in this format: what the staging buffer of [`TableImage::record_upload`] holds.
    pub fn bytes(self, table: &LightTable) -> Vec<u8> {
        let texels = table.texels();
        match self {
            Self::Rgba32Float => bytemuck::cast_slice(&texels).to_vec(),
            Self::Rgba16Float => {
                texels.iter().flatten().flat_map(|&value| half::f16::from_f32(value).to_le_bytes()).collect()
            }
        }
    }
}

/// The table's image and view. The host gives it memory:
///
/// 1. [`TableImage::new`], 2. allocate for [`TableImage::memory_requirements`], 3.
///    [`TableImage::bind_memory`],
/// 4. fill a staging buffer with [`TableImage::bytes`], 5. [`TableImage::record_upload`].
///
/// Dropping it destroys image and view; the memory stays the host's.
#[derive(Debug)]
pub struct TableImage {
    context: Context,
    image: Image,
    format: TableFormat,
    size: u32,
}

impl TableImage {
    /// The layout that [`TableImage::record_upload`] leaves the image in.
    pub const LAYOUT: vk::ImageLayout = vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL;

    /// Makes the image, without memory.
    ///
    /// # Safety
    /// The table image is dropped only when no recorded use of it is pending, and before the device is
    /// destroyed.
    ///
    /// # Errors
    /// [`Error::Vulkan`] where a call fails.
    pub unsafe fn new(context: &Context, table: &LightTable, format: TableFormat) -> Result<Self, Error> {
        let info = ImageInfo {
            name: "table",
            image_type: vk::ImageType::TYPE_2D,
            format: format.vulkan(),
            extent: [table.size(), table.size(), 1],
            levels: 1,
            layers: LAYERS,
            usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
        };
        // SAFETY: the same contract.
        let image = unsafe { Image::new(context, info) }?;
        Ok(Self { context: context.clone(), image, format, size: table.size() })
    }

    /// The texels of the table that it was made for, in its format: what the staging buffer of
    /// [`TableImage::record_upload`] holds.
    pub fn bytes(&self, table: &LightTable) -> Vec<u8> {
        self.format.bytes(table)
    }

    image_memory!("arealight table");

    /// Records the copy from a staging buffer, with the barriers around it: afterwards the image is in layout
    /// [`TableImage::LAYOUT`], visible to compute and fragment shaders.
    ///
    /// # Safety
    /// - `command_buffer` is recording, outside a render pass, on a queue with graphics or compute.
    /// - `staging` holds [`TableImage::bytes`] of the same table from `offset` on (a multiple of 16), is
    ///   visible to transfers, and outlives the recorded work.
    /// - [`TableImage::bind_memory`] was called; no pending work reads the image.
    pub unsafe fn record_upload(
        &self,
        command_buffer: vk::CommandBuffer,
        staging: vk::Buffer,
        offset: vk::DeviceSize,
    ) {
        let device = &self.context.device;
        let unused = (vk::ImageLayout::UNDEFINED, vk::AccessFlags::NONE);
        let copied = (vk::ImageLayout::TRANSFER_DST_OPTIMAL, vk::AccessFlags::TRANSFER_WRITE);
        let before = self.image.barrier(unused, copied);
        let after = self.image.barrier(copied, (Self::LAYOUT, vk::AccessFlags::SHADER_READ));
        let copy = vk::BufferImageCopy::default()
            .buffer_offset(offset)
            .image_subresource(vk::ImageSubresourceLayers {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                mip_level: 0,
                base_array_layer: 0,
                layer_count: LAYERS,
            })
            .image_extent(vk::Extent3D { width: self.size, height: self.size, depth: 1 });
        // The queue may have no graphics, so the readers' stages cannot be named one by one
        let readers = vk::PipelineStageFlags::ALL_COMMANDS;
        // SAFETY: the caller vouches for the command buffer and the staging buffer; the image is ours.
        unsafe {
            let _label = self.context.names.label(command_buffer, c"arealight table upload");
            // After whatever read an earlier table
            self.context.record_images(
                command_buffer,
                (vk::PipelineStageFlags::ALL_COMMANDS, vk::PipelineStageFlags::TRANSFER),
                &[before],
            );
            device.cmd_copy_buffer_to_image(
                command_buffer,
                staging,
                self.image.raw,
                vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                &[copy],
            );
            self.context.record_images(command_buffer, (vk::PipelineStageFlags::TRANSFER, readers), &[after]);
        }
    }

    /// A view of all layers, for shaders of the host's own. Null before [`TableImage::bind_memory`].
    pub fn view(&self) -> vk::ImageView {
        self.image.view
    }

    /// The table as a pass takes it, after the upload. A null view before [`TableImage::bind_memory`], which
    /// `write_set` refuses.
    pub fn resource(&self) -> Resource {
        Resource::SampledImage { view: self.image.view, layout: Self::LAYOUT }
    }
}
