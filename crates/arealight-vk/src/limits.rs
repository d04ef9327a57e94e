//! The device's limits for descriptors and light textures.

use crate::error::{Error, VulkanCall};
use ash::vk;

/// The format of the light textures, which every Vulkan device filters and stores to.
pub(crate) const TEXTURE_FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

/// How the image is used: shading samples it, filtering stores to it, a clear and tests copy.
pub(crate) const TEXTURE_USAGE: vk::ImageUsageFlags = vk::ImageUsageFlags::from_raw(
    vk::ImageUsageFlags::SAMPLED.as_raw()
        | vk::ImageUsageFlags::STORAGE.as_raw()
        | vk::ImageUsageFlags::TRANSFER_SRC.as_raw()
        | vk::ImageUsageFlags::TRANSFER_DST.as_raw(),
);

/// The largest image of a kind.
#[derive(Clone, Copy)]
pub(crate) struct ImageLimits {
    pub(crate) extent: [u32; 2],
    pub(crate) layers: u32,
}

/// How many descriptors of a kind a compute stage may use, and where they may begin.
#[derive(Clone, Copy)]
pub(crate) struct DescriptorLimits {
    pub(crate) sampled_images: u32,
    pub(crate) storage_images: u32,
    pub(crate) storage_buffers: u32,
    /// `minStorageBufferOffsetAlignment`.
    pub(crate) storage_buffer_alignment: vk::DeviceSize,
    /// `maxStorageBufferRange`.
    pub(crate) storage_buffer_range: u32,
    /// `maxImageDimension3D`.
    pub(crate) volume_side: u32,
}

impl DescriptorLimits {
    /// Refuses a buffer that a set cannot bind whole.
    pub(crate) fn check_range(self, bytes: vk::DeviceSize, needed_by: &'static str) -> Result<(), Error> {
        if bytes > self.storage_buffer_range.into() {
            return Err(Error::MissingFeature { feature: "maxStorageBufferRange", needed_by });
        }
        Ok(())
    }
}

/// The largest light textures of the device.
pub(crate) fn light_texture_limits(
    instance: &ash::Instance,
    physical_device: vk::PhysicalDevice,
) -> Result<Option<ImageLimits>, Error> {
    let needed = vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR | vk::FormatFeatureFlags::STORAGE_IMAGE;
    // SAFETY: the handles are valid by the contract of Context::new; so for both calls.
    let (features, image) = unsafe {
        let format = instance.get_physical_device_format_properties(physical_device, TEXTURE_FORMAT);
        let image = instance.get_physical_device_image_format_properties(
            physical_device,
            TEXTURE_FORMAT,
            vk::ImageType::TYPE_2D,
            vk::ImageTiling::OPTIMAL,
            TEXTURE_USAGE,
            vk::ImageCreateFlags::empty(),
        );
        (format.optimal_tiling_features, image)
    };
    match image {
        Err(vk::Result::ERROR_FORMAT_NOT_SUPPORTED) => Ok(None),
        _ if !features.contains(needed) => Ok(None),
        image => {
            let limits = image.call("vkGetPhysicalDeviceImageFormatProperties")?;
            let extent = [limits.max_extent.width, limits.max_extent.height];
            Ok(Some(ImageLimits { extent, layers: limits.max_array_layers }))
        }
    }
}
