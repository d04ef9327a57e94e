//! Why Vulkan cannot be used, and what to do.

use ash::vk;

/// A failure of the host. Its text says what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HostError {
    /// There is no Vulkan loader.
    #[error(
        "Vulkan is not installed here: its loader cannot be opened ({0}). Install the loader and a driver; \
         on Debian: apt-get install libvulkan1 mesa-vulkan-drivers (the latter computes on the CPU where \
         there is no GPU)"
    )]
    LoaderMissing(#[source] ash::LoadingError),
    /// The loader is of Vulkan 1.0.
    #[error(
        "the Vulkan loader offers {0} and 1.1 is needed: update it (on Debian: apt-get install libvulkan1)"
    )]
    LoaderTooOld(String),
    /// The loader finds no driver, or none of its devices has Vulkan 1.1 and a queue that computes.
    #[error(
        "no usable Vulkan device (found: {}). Install the driver of your GPU, or one that computes on the \
         CPU; on Debian: apt-get install mesa-vulkan-drivers",
        list(found)
    )]
    NoDevice {
        /// Devices that there are, each with what it lacks.
        found: Vec<String>,
    },
    /// No usable device has the name or index that was asked for.
    #[error(
        "there is no usable Vulkan device `{wanted}`: take one of {}, by index or a part of its name",
        list(available)
    )]
    DeviceNotFound {
        /// What was asked for.
        wanted: String,
        /// The usable devices, as `index: name`.
        available: Vec<String>,
    },
    /// The device that was asked for is there, and cannot be used.
    #[error(
        "the Vulkan device {name} cannot be used ({lack}): take one of {}, by index or a part of its name",
        list(available)
    )]
    DeviceUnusable {
        /// The device.
        name: String,
        /// What it lacks.
        lack: String,
        /// The usable devices, as `index: name`.
        available: Vec<String>,
    },
    /// Validation was asked for and its layer is not installed.
    #[error(
        "the Vulkan validation layer is not installed: on Debian, apt-get install vulkan-validationlayers"
    )]
    ValidationLayerMissing,
    /// The installed validation layer cannot be told to do what was asked for.
    #[error(
        "the installed Vulkan validation layer offers neither VK_EXT_layer_settings nor \
         VK_EXT_validation_features: update it, or use Validation::Core"
    )]
    ValidationModeMissing,
    /// The device lacks a feature that was asked for.
    #[error("the device lacks the feature {0}: do not ask for it, or choose another device")]
    MissingFeature(&'static str),
    /// The driver does not say that of a pipeline.
    #[error("the driver's statistics of a pipeline have no \"{0}\": another version of Mesa may")]
    MissingStatistic(&'static str),
    /// Memory of the host or the device ran out.
    #[error("out of memory: {what}. Use a smaller image or scene, or another device")]
    OutOfMemory {
        /// What the memory was for.
        what: String,
    },
    /// The device was lost: the driver reset it, or crashed.
    #[error(
        "the Vulkan device was lost in {call}: the driver reset it, usually for a dispatch that took too \
         long or read out of bounds. Try again with less work, and with validation; the system's log may say \
         more"
    )]
    DeviceLost {
        /// The Vulkan function that said so.
        call: &'static str,
    },
    /// Submitted work did not finish in time. The host is of no more use.
    #[error("the GPU did not finish within {timeout:?}: submit less at once, or raise HostOptions::timeout")]
    TimedOut {
        /// How long was waited.
        timeout: std::time::Duration,
    },
    /// An argument of a function of this crate cannot be used.
    #[error("{name}: {message}")]
    InvalidArgument {
        /// The buffer, image or parameter.
        name: String,
        /// What is wrong with it.
        message: String,
    },
    /// A Vulkan function failed otherwise.
    #[error("{call} failed: {result}")]
    Vulkan {
        /// The function.
        call: &'static str,
        /// What it returned.
        result: vk::Result,
    },
}

fn list(items: &[String]) -> String {
    if items.is_empty() { "none".to_owned() } else { items.join(", ") }
}

/// Names the call that a result came from.
pub(crate) trait NameCall<T> {
    /// The value, or the error that tells which call failed.
    fn named(self, call: &'static str) -> Result<T, HostError>;
}

impl<T> NameCall<T> for Result<T, vk::Result> {
    fn named(self, call: &'static str) -> Result<T, HostError> {
        self.map_err(|result| match result {
            vk::Result::ERROR_DEVICE_LOST => HostError::DeviceLost { call },
            vk::Result::ERROR_OUT_OF_HOST_MEMORY | vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => {
                HostError::OutOfMemory { what: format!("{call} ({result})") }
            }
            result => HostError::Vulkan { call, result },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn losing_the_device_and_running_out_of_memory_have_their_own_errors() {
        let named = |result| Err::<(), _>(result).named("vkQueueSubmit").unwrap_err();
        let lost = named(vk::Result::ERROR_DEVICE_LOST);
        assert!(matches!(lost, HostError::DeviceLost { call: "vkQueueSubmit" }));
        assert!(lost.to_string().contains("Try again with less work"));
        let memory = named(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY);
        assert!(matches!(memory, HostError::OutOfMemory { .. }));
        let other = named(vk::Result::ERROR_INITIALIZATION_FAILED);
        assert!(matches!(other, HostError::Vulkan { call: "vkQueueSubmit", .. }));
    }

    #[test]
    fn errors_about_devices_list_what_there_is() {
        let error = HostError::DeviceNotFound {
            wanted: "titan".to_owned(),
            available: vec!["0: llvmpipe".to_owned(), "1: other".to_owned()],
        };
        assert!(error.to_string().contains("`titan`: take one of 0: llvmpipe, 1: other"), "{error}");
        let none = HostError::NoDevice { found: vec![] };
        assert!(none.to_string().contains("(found: none)"), "{none}");
    }
}
