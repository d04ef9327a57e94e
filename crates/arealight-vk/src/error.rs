//! What can go wrong, as one type.

use ash::vk;

/// An error of the recorder. Nothing was recorded and nothing leaks where one is returned, but for
/// `AreaLights::shade`.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A Vulkan call failed.
    #[error("{call} failed: {result}")]
    Vulkan {
        /// The call.
        call: &'static str,
        /// The result it returned.
        result: vk::Result,
    },
    /// The device lacks something that is needed, or the host did not enable it.
    #[error("the device lacks {feature} (or enough of it), which {needed_by} needs")]
    MissingFeature {
        /// The feature, limit or version.
        feature: &'static str,
        /// What needs it.
        needed_by: &'static str,
    },
    /// An argument is wrong.
    #[error("{field}: {message}")]
    InvalidArgument {
        /// The argument's field.
        field: &'static str,
        /// The fault, and what would be right.
        message: String,
    },
    /// An image has a format that the pass does not read, or store to, as it should.
    #[error("{field}: the format is {format:?}; it must be one of {}", one_of(expected))]
    WrongFormat {
        /// The image's field of [`crate::ShadeResources`].
        field: &'static str,
        /// Its format.
        format: vk::Format,
        /// Those that will do.
        expected: &'static [vk::Format],
    },
    /// A descriptor set points at an image of the recorder's that is gone. Found in debug builds alone.
    #[error("{field}: the image that the descriptor set points at was destroyed; write the set again")]
    Destroyed {
        /// The binding's name in the manifest.
        field: &'static str,
    },
    /// A light cannot be used.
    #[error(transparent)]
    Light(#[from] arealight::LightError),
    /// A part of an image cannot become a light's texture.
    #[error("layer {layer} of the light textures: {error}")]
    TexturePart {
        /// The layer that it was meant for.
        layer: u32,
        /// What is wrong with it.
        error: arealight::TextureError,
    },
}

fn one_of(formats: &[vk::Format]) -> String {
    formats.iter().map(|format| format!("{format:?}")).collect::<Vec<_>>().join(", ")
}

/// Names the call that a Vulkan result came from.
pub(crate) trait VulkanCall<T> {
    fn call(self, call: &'static str) -> Result<T, Error>;
}

impl<T> VulkanCall<T> for Result<T, vk::Result> {
    fn call(self, call: &'static str) -> Result<T, Error> {
        self.map_err(|result| Error::Vulkan { call, result })
    }
}
