//! Images: two-dimensional, with layers.

use crate::device::Host;
use crate::error::{HostError, NameCall as _};
use crate::memory::{Buffer, Location};
use crate::submit::Usage;
use ash::vk;
use bytemuck::Pod;
use gpu_allocator::vulkan::Allocation;

/// What an [`Image`] is made with.
#[derive(Debug, Clone)]
pub struct ImageDescription<'a> {
    /// For messages.
    pub name: &'a str,
    /// Width and height in texels, each at least 1.
    pub extent: [u32; 2],
    /// Array layers, at least 1.
    pub layers: u32,
    /// The texels' format.
    pub format: vk::Format,
    /// What it is used for; copies to and from it are always possible.
    pub usage: vk::ImageUsageFlags,
}

/// An image with its memory, tiled as the device likes it, without mipmaps. It holds its host.
///
/// Its layout is the caller's to know: each function that needs it asks.
#[derive(Debug)]
pub struct Image {
    host: Host,
    name: String,
    extent: [u32; 2],
    layers: u32,
    format: vk::Format,
    raw: vk::Image,
    view: vk::ImageView,
    array_view: vk::ImageView,
    allocation: Option<Allocation>,
}

impl Host {
    /// Makes an image. Its contents and layout are undefined.
    ///
    /// # Errors
    /// [`HostError::InvalidArgument`] where the device has no such image: a dimension is 0 or beyond its
    /// limits, or it cannot use the format so. [`HostError::OutOfMemory`].
    pub fn image(&self, description: &ImageDescription<'_>) -> Result<Image, HostError> {
        self.multisampled_image(description, 1)
    }

    /// As [`Host::image`], with several samples a texel: 2, 4 or 8.
    pub fn multisampled_image(
        &self,
        description: &ImageDescription<'_>,
        samples: u32,
    ) -> Result<Image, HostError> {
        self.image_of(description, samples, None)
    }

    /// As [`Host::image`], in three dimensions: [`Image::view`] is of all of it, and there is no array.
    ///
    /// # Errors
    /// As [`Host::image`].
    pub fn volume(&self, description: &ImageDescription<'_>, depth: u32) -> Result<Image, HostError> {
        self.image_of(description, 1, Some(depth))
    }

    fn image_of(
        &self,
        description: &ImageDescription<'_>,
        samples: u32,
        depth: Option<u32>,
    ) -> Result<Image, HostError> {
        let image_type = if depth.is_some() { vk::ImageType::TYPE_3D } else { vk::ImageType::TYPE_2D };
        let usage = description.usage | vk::ImageUsageFlags::TRANSFER_SRC | vk::ImageUsageFlags::TRANSFER_DST;
        let samples = vk::SampleCountFlags::from_raw(samples);
        self.check_image(description, usage, samples, (image_type, depth.unwrap_or(1)))?;
        let [width, height] = description.extent;
        let info = vk::ImageCreateInfo::default()
            .image_type(image_type)
            .format(description.format)
            .extent(vk::Extent3D { width, height, depth: depth.unwrap_or(1) })
            .mip_levels(1)
            .array_layers(description.layers)
            .samples(samples)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(usage);
        // SAFETY: The device is alive, and offers such an image.
        let raw = unsafe { self.device().create_image(&info, None) }.named("vkCreateImage")?;
        let mut image = Image {
            host: self.clone(),
            name: description.name.to_owned(),
            extent: description.extent,
            layers: description.layers,
            format: description.format,
            raw,
            view: vk::ImageView::null(),
            array_view: vk::ImageView::null(),
            allocation: None,
        };

        // SAFETY: The image is of this device.
        let requirements = unsafe { self.device().get_image_memory_requirements(raw) };
        let allocation = self.allocate(description.name, requirements, Location::Device, false)?;
        // SAFETY: The allocation's memory is of this device and fits the image, which has none yet.
        let bound = unsafe { self.device().bind_image_memory(raw, allocation.memory(), allocation.offset()) };
        image.allocation = Some(allocation);
        bound.named("vkBindImageMemory")?;

        // A view can be made only of an image that is used for more than copies
        if depth.is_some() {
            image.view = image.make_view(vk::ImageViewType::TYPE_3D, 1)?;
        } else if !description.usage.is_empty() {
            image.view = image.make_view(vk::ImageViewType::TYPE_2D, 1)?;
            image.array_view = image.make_view(vk::ImageViewType::TYPE_2D_ARRAY, description.layers)?;
        }
        Ok(image)
    }

    /// Whether the device offers such an image.
    fn check_image(
        &self,
        image: &ImageDescription<'_>,
        usage: vk::ImageUsageFlags,
        samples: vk::SampleCountFlags,
        (image_type, depth): (vk::ImageType, u32),
    ) -> Result<(), HostError> {
        let refuse = |message| Err(HostError::InvalidArgument { name: image.name.to_owned(), message });
        let [width, height] = image.extent;
        if width == 0 || height == 0 || depth == 0 || image.layers == 0 {
            return refuse(format!("{width}×{height} texels, {} layers: none may be 0", image.layers));
        }
        // SAFETY: The physical device is of this instance.
        let properties = unsafe {
            self.instance().get_physical_device_image_format_properties(
                self.physical_device(),
                image.format,
                image_type,
                vk::ImageTiling::OPTIMAL,
                usage,
                vk::ImageCreateFlags::empty(),
            )
        };
        match properties {
            Err(vk::Result::ERROR_FORMAT_NOT_SUPPORTED) => {
                refuse(format!("the device has no {:?} images for {usage:?}", image.format))
            }
            properties => {
                let limit = properties.named("vkGetPhysicalDeviceImageFormatProperties")?;
                if !limit.sample_counts.contains(samples) {
                    return refuse(format!(
                        "the device has {:?} images of {:?}",
                        image.format, limit.sample_counts
                    ));
                }
                let most = [limit.max_extent.width, limit.max_extent.height];
                if width > most[0]
                    || height > most[1]
                    || depth > limit.max_extent.depth
                    || image.layers > limit.max_array_layers
                {
                    return refuse(format!(
                        "{width}×{height} texels, {} layers: the device has {}×{} and {} at most",
                        image.layers, most[0], most[1], limit.max_array_layers
                    ));
                }
                Ok(())
            }
        }
    }
}

impl Image {
    /// The handle.
    pub fn handle(&self) -> vk::Image {
        self.raw
    }

    /// A two-dimensional view of the first layer; null where the image is used for copies only.
    pub fn view(&self) -> vk::ImageView {
        self.view
    }

    /// A view of all layers as an array; null where the image is used for copies only.
    pub fn array_view(&self) -> vk::ImageView {
        self.array_view
    }

    /// Width and height in texels.
    pub fn extent(&self) -> [u32; 2] {
        self.extent
    }

    /// Array layers.
    pub fn layers(&self) -> u32 {
        self.layers
    }

    /// The texels' format.
    pub fn format(&self) -> vk::Format {
        self.format
    }

    /// Records a barrier from one use of the image to another, with the change of layout.
    pub fn transition(&self, commands: vk::CommandBuffer, before: Usage, after: Usage) {
        let barrier = [vk::ImageMemoryBarrier::default()
            .src_access_mask(before.access)
            .dst_access_mask(after.access)
            .old_layout(before.layout)
            .new_layout(after.layout)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(self.raw)
            .subresource_range(self.whole(self.layers))];
        let flags = vk::DependencyFlags::empty();
        // SAFETY: The commands are being recorded; the image is of this device.
        unsafe {
            self.host.device().cmd_pipeline_barrier(
                commands,
                before.stage,
                after.stage,
                flags,
                &[],
                &[],
                &barrier,
            );
        }
    }

    /// Replaces all texels, layer after layer, row after row, and leaves the image ready for `after`.
    pub fn upload<T: Pod>(&self, items: &[T], after: Usage) -> Result<(), HostError> {
        let size = self.bytes()?;
        if size_of_val(items) as u64 != size {
            return Err(self.argument(format!("{} bytes given for {size}", size_of_val(items))));
        }
        let name = format!("{}, staged", self.name);
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        let staging = self.host.buffer(&name, size, usage, Location::Upload)?;
        staging.upload(items)?;
        self.host.submit(|commands| {
            self.transition(commands, Usage::UNDEFINED, Usage::COPY_DESTINATION);
            self.record_upload(commands, &staging);
            self.transition(commands, Usage::COPY_DESTINATION, after);
        })
    }

    /// Reads all texels, layer after layer, row after row. `current` is the image's last use, and its layout
    /// is as before afterwards.
    ///
    /// # Errors
    /// [`HostError::InvalidArgument`] where the image's bytes are not a number of items, or this crate does
    /// not know the format's size; whatever the copy meets.
    pub fn download<T: Pod>(&self, current: Usage) -> Result<Vec<T>, HostError> {
        let name = format!("{}, read back", self.name);
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let staging = self.host.buffer(&name, self.bytes()?, usage, Location::Readback)?;
        self.host.submit(|commands| {
            self.transition(commands, current, Usage::COPY_SOURCE);
            self.record_download(commands, &staging);
            self.transition(commands, Usage::COPY_SOURCE, current);
        })?;
        staging.download()
    }

    /// Records that all texels become zeros; the image is ready to be copied to, and of floats.
    pub fn record_clear(&self, commands: vk::CommandBuffer) {
        let layout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        let (zeros, whole) = (vk::ClearColorValue::default(), [self.whole(self.layers)]);
        // SAFETY: The commands are being recorded; the image was put into this layout.
        unsafe { self.host.device().cmd_clear_color_image(commands, self.raw, layout, &zeros, &whole) };
    }

    /// Records copies of rectangles of another image of the format, each from one corner to another, of a
    /// size. The images are ready to be copied to and from, and hold the rectangles.
    pub fn record_copies(&self, commands: vk::CommandBuffer, from: &Self, rectangles: &[[[u32; 2]; 3]]) {
        let region = |[source, destination, [width, height]]: &[[u32; 2]; 3]| {
            let offset = |[x, y]: [u32; 2]| vk::Offset3D { x: x.cast_signed(), y: y.cast_signed(), z: 0 };
            let layers =
                vk::ImageSubresourceLayers::default().aspect_mask(aspect(self.format)).layer_count(1);
            vk::ImageCopy::default()
                .src_subresource(layers)
                .dst_subresource(layers)
                .src_offset(offset(*source))
                .dst_offset(offset(*destination))
                .extent(vk::Extent3D { width: *width, height: *height, depth: 1 })
        };
        let regions: Vec<_> = rectangles.iter().map(region).collect();
        let [source, destination] =
            [vk::ImageLayout::TRANSFER_SRC_OPTIMAL, vk::ImageLayout::TRANSFER_DST_OPTIMAL];
        // SAFETY: The commands are being recorded; the images were put into these layouts.
        unsafe {
            self.host.device().cmd_copy_image(commands, from.raw, source, self.raw, destination, &regions);
        }
    }

    fn record_upload(&self, commands: vk::CommandBuffer, from: &Buffer) {
        let layout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        let (device, region) = (self.host.device(), [self.copy_region()]);
        // SAFETY: The buffer has the image's size; the image was put into this layout.
        unsafe { device.cmd_copy_buffer_to_image(commands, from.handle(), self.raw, layout, &region) };
    }

    fn record_download(&self, commands: vk::CommandBuffer, to: &Buffer) {
        let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        let (device, region) = (self.host.device(), [self.copy_region()]);
        // SAFETY: The buffer has the image's size; the image was put into this layout.
        unsafe { device.cmd_copy_image_to_buffer(commands, self.raw, layout, to.handle(), &region) };
    }

    /// The whole image, packed in a buffer.
    fn copy_region(&self) -> vk::BufferImageCopy {
        let layers =
            vk::ImageSubresourceLayers::default().aspect_mask(aspect(self.format)).layer_count(self.layers);
        let [width, height] = self.extent;
        vk::BufferImageCopy::default().image_subresource(layers).image_extent(vk::Extent3D {
            width,
            height,
            depth: 1,
        })
    }

    /// The size of all texels, packed.
    fn bytes(&self) -> Result<u64, HostError> {
        let texel = texel_size(self.format)
            .ok_or_else(|| self.argument(format!("the size of a texel of {:?} is not known", self.format)))?;
        Ok(u64::from(self.extent[0]) * u64::from(self.extent[1]) * u64::from(self.layers) * texel)
    }

    fn whole(&self, layers: u32) -> vk::ImageSubresourceRange {
        vk::ImageSubresourceRange::default()
            .aspect_mask(aspect(self.format))
            .level_count(1)
            .layer_count(layers)
    }

    fn make_view(&self, kind: vk::ImageViewType, layers: u32) -> Result<vk::ImageView, HostError> {
        let info = vk::ImageViewCreateInfo::default()
            .image(self.raw)
            .view_type(kind)
            .format(self.format)
            .subresource_range(self.whole(layers));
        // SAFETY: The image is of this device and has memory.
        unsafe { self.host.device().create_image_view(&info, None) }.named("vkCreateImageView")
    }

    fn argument(&self, message: String) -> HostError {
        HostError::InvalidArgument { name: self.name.clone(), message }
    }
}

impl Drop for Image {
    fn drop(&mut self) {
        if self.host.is_abandoned() {
            std::mem::forget(self.allocation.take());
            return;
        }
        let device = self.host.device();
        // SAFETY: All are of this device or null, and nothing uses them: submissions are waited for.
        unsafe {
            device.destroy_image_view(self.view, None);
            device.destroy_image_view(self.array_view, None);
            device.destroy_image(self.raw, None);
        }
        self.host.free(self.allocation.take());
    }
}

/// What an image of the format holds.
fn aspect(format: vk::Format) -> vk::ImageAspectFlags {
    match format {
        vk::Format::D16_UNORM | vk::Format::D32_SFLOAT => vk::ImageAspectFlags::DEPTH,
        _ => vk::ImageAspectFlags::COLOR,
    }
}

/// Bytes a texel, of the formats that the tools use.
fn texel_size(format: vk::Format) -> Option<u64> {
    Some(match format {
        vk::Format::R8_UNORM | vk::Format::R8_UINT => 1,
        vk::Format::R16_SFLOAT | vk::Format::D16_UNORM => 2,
        vk::Format::R8G8B8A8_UNORM
        | vk::Format::R8G8B8A8_SNORM
        | vk::Format::R8G8B8A8_SRGB
        | vk::Format::A2B10G10R10_UNORM_PACK32
        | vk::Format::R16G16_SNORM
        | vk::Format::R16G16_SFLOAT
        | vk::Format::R32_SFLOAT
        | vk::Format::R32_UINT
        | vk::Format::D32_SFLOAT => 4,
        vk::Format::R16G16B16A16_SFLOAT | vk::Format::R32G32_SFLOAT => 8,
        vk::Format::R32G32B32A32_SFLOAT | vk::Format::R32G32B32A32_UINT => 16,
        _ => return None,
    })
}
