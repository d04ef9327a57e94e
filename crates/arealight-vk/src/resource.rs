//! The host's images and buffers, as descriptors take them.

use arealight::kernels::BindingKind;
use ash::vk;

/// The resource of a descriptor. The host owns it, and keeps it alive while recorded work runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Resource {
    /// An image that is read by texel.
    SampledImage {
        /// A view of it with the aspect and layers to read.
        view: vk::ImageView,
        /// The layout it has when the pass runs.
        layout: vk::ImageLayout,
    },
    /// An array image that is read with the kernel's own sampler.
    FilteredImage {
        /// A view of it with the levels and layers to read.
        view: vk::ImageView,
        /// The layout it has when the pass runs.
        layout: vk::ImageLayout,
    },
    /// An image that is stored to, in layout `GENERAL`.
    StorageImage {
        /// A view of one layer.
        view: vk::ImageView,
    },
    /// A range of a buffer.
    StorageBuffer {
        /// The buffer, with usage `STORAGE_BUFFER`.
        buffer: vk::Buffer,
        /// The range's first byte, a multiple of `minStorageBufferOffsetAlignment`.
        offset: vk::DeviceSize,
        /// Its length in bytes, or `WHOLE_SIZE`.
        range: vk::DeviceSize,
    },
}

impl Resource {
    /// An image of colour that is read by texel, in layout `SHADER_READ_ONLY_OPTIMAL`.
    pub fn sampled(view: vk::ImageView) -> Self {
        Self::SampledImage { view, layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL }
    }

    /// An image of depth that is read by texel, in layout `DEPTH_STENCIL_READ_ONLY_OPTIMAL`.
    pub fn depth(view: vk::ImageView) -> Self {
        Self::SampledImage { view, layout: vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL }
    }

    /// An image that is stored to.
    pub fn stored(view: vk::ImageView) -> Self {
        Self::StorageImage { view }
    }

    /// A whole buffer.
    pub fn buffer(buffer: vk::Buffer) -> Self {
        Self::StorageBuffer { buffer, offset: 0, range: vk::WHOLE_SIZE }
    }

    /// The view of an image.
    pub(crate) fn view(self) -> Option<vk::ImageView> {
        match self {
            Self::SampledImage { view, .. }
            | Self::FilteredImage { view, .. }
            | Self::StorageImage { view } => Some(view),
            Self::StorageBuffer { .. } => None,
        }
    }

    pub(crate) fn kind(self) -> BindingKind {
        match self {
            Self::SampledImage { .. } => BindingKind::SampledImage,
            Self::FilteredImage { .. } => BindingKind::FilteredImage,
            Self::StorageImage { .. } => BindingKind::StorageImage,
            Self::StorageBuffer { .. } => BindingKind::StorageBuffer,
        }
    }

    pub(crate) fn is_null(self) -> bool {
        match self {
            Self::StorageBuffer { buffer, .. } => buffer == vk::Buffer::null(),
            image => image.view().is_some_and(|view| view == vk::ImageView::null()),
        }
    }
}

impl Default for Resource {
    /// Nothing, which no pass takes: the name of what it stands for is in the error.
    fn default() -> Self {
        Self::buffer(vk::Buffer::null())
    }
}
