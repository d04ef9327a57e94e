//! Images of the library's own, with memory of the host's.

use crate::context::{Context, color_range};
use crate::error::{Error, VulkanCall};
use ash::vk;
use std::ops::Range;

/// What an image is made of: one sample a texel; with several layers it is seen as an array.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ImageInfo {
    pub(crate) name: &'static str,
    pub(crate) image_type: vk::ImageType,
    pub(crate) format: vk::Format,
    pub(crate) extent: [u32; 3],
    pub(crate) levels: u32,
    pub(crate) layers: u32,
    pub(crate) usage: vk::ImageUsageFlags,
}

/// An image and its views, which dropping it destroys.
#[derive(Debug)]
pub(crate) struct Image {
    context: Context,
    pub(crate) info: ImageInfo,
    pub(crate) raw: vk::Image,
    /// Of all of it; null before it has memory.
    pub(crate) view: vk::ImageView,
    /// Of each level, where there are several.
    level_views: Vec<vk::ImageView>,
}

impl Image {
    /// Makes it without memory.
    ///
    /// # Safety
    /// It is dropped only when no recorded use of it is pending, and before the device is destroyed.
    pub(crate) unsafe fn new(context: &Context, info: ImageInfo) -> Result<Self, Error> {
        let [width, height, depth] = info.extent;
        let create = vk::ImageCreateInfo::default()
            .image_type(info.image_type)
            .format(info.format)
            .extent(vk::Extent3D { width, height, depth })
            .mip_levels(info.levels)
            .array_layers(info.layers)
            .samples(vk::SampleCountFlags::TYPE_1)
            .usage(info.usage);
        // SAFETY: the device is valid by the contract of Context::new.
        let raw = unsafe { context.device.create_image(&create, None) }.call("vkCreateImage")?;
        context.names.name(raw, info.name);
        Ok(Self { context: context.clone(), info, raw, view: vk::ImageView::null(), level_views: vec![] })
    }

    pub(crate) fn memory_requirements(&self) -> vk::MemoryRequirements {
        // SAFETY: the image is ours and live.
        unsafe { self.context.device.get_image_memory_requirements(self.raw) }
    }

    /// Binds memory, and makes the views.
    ///
    /// # Safety
    /// Called once, with memory that satisfies the requirements and outlives the image.
    pub(crate) unsafe fn bind_memory(
        &mut self,
        memory: vk::DeviceMemory,
        offset: vk::DeviceSize,
    ) -> Result<(), Error> {
        // SAFETY: the same contract.
        unsafe { self.context.device.bind_image_memory(self.raw, memory, offset) }
            .call("vkBindImageMemory")?;
        self.view = self.make_view(0..self.info.levels)?;
        self.context.names.name(self.view, self.info.name);
        for level in (0..self.info.levels).filter(|_| self.info.levels > 1) {
            let view = self.make_view(level..level + 1)?;
            self.level_views.push(view);
        }
        Ok(())
    }

    /// A view of some levels of every layer.
    fn make_view(&self, levels: Range<u32>) -> Result<vk::ImageView, Error> {
        let of_one = vk::ImageViewType::from_raw(self.info.image_type.as_raw());
        let info = vk::ImageViewCreateInfo::default()
            .image(self.raw)
            .view_type(if self.info.layers > 1 { vk::ImageViewType::TYPE_2D_ARRAY } else { of_one })
            .format(self.info.format)
            .subresource_range(color_range(levels, self.info.layers));
        // SAFETY: the image is ours and has memory.
        unsafe { self.context.device.create_image_view(&info, None) }.call("vkCreateImageView")
    }

    /// The view of a level; null before it has memory.
    pub(crate) fn level_view(&self, level: usize) -> vk::ImageView {
        self.level_views.get(level).copied().unwrap_or_default()
    }

    /// All of it.
    pub(crate) fn range(&self) -> vk::ImageSubresourceRange {
        color_range(0..self.info.levels, self.info.layers)
    }

    /// A barrier of all of it from one layout to another.
    pub(crate) fn barrier(
        &self,
        (before, written): (vk::ImageLayout, vk::AccessFlags),
        (after, used): (vk::ImageLayout, vk::AccessFlags),
    ) -> vk::ImageMemoryBarrier<'static> {
        vk::ImageMemoryBarrier::default()
            .image(self.raw)
            .subresource_range(self.range())
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .old_layout(before)
            .src_access_mask(written)
            .new_layout(after)
            .dst_access_mask(used)
    }
}

impl Drop for Image {
    fn drop(&mut self) {
        for view in self.level_views.drain(..).chain([self.view]) {
            self.context.written_sets.destroy(view);
            // SAFETY: by the contract of Image::new; a null view is ignored.
            unsafe { self.context.device.destroy_image_view(view, None) };
        }
        // SAFETY: as above.
        unsafe { self.context.device.destroy_image(self.raw, None) };
    }
}
