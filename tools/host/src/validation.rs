//! The validation layer: how it is switched on, and what it says, kept per instance.

use crate::error::HostError;
use ash::vk;
use std::ffi::{CStr, c_void};
use std::sync::{Mutex, PoisonError};

pub(crate) const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// What the validation layer looks at. The layer slows everything down, the last two by a lot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Validation {
    /// Nothing: the layer is not loaded.
    #[default]
    Off,
    /// Every call's arguments and state.
    Core,
    /// That, and missing barriers. Within compute it sees those of buffers that the GLSL qualifies
    /// `readonly` or `writeonly`.
    Synchronization,
    /// Every call's arguments and state, and out-of-bounds accesses in shaders, which it instruments.
    GpuAssisted,
}

/// How bad a message is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Probably wrong.
    Warning,
    /// Invalid use of Vulkan.
    Error,
}

/// A message of the validation layer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// How bad it is.
    pub severity: Severity,
    /// Its name, such as `VUID-VkBufferCreateInfo-size-00912`.
    pub id: String,
    /// What the layer says.
    pub text: String,
}

impl std::fmt::Display for Message {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:?} {}: {}", self.severity, self.id, self.text)
    }
}

/// The messages of one instance.
#[derive(Debug, Default)]
pub(crate) struct MessageLog(Mutex<Vec<Message>>);

impl MessageLog {
    pub(crate) fn messages(&self) -> Vec<Message> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    pub(crate) fn take(&self) -> Vec<Message> {
        std::mem::take(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn push(&self, message: Message) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(message);
    }

    /// A messenger that appends to this log, which must outlive it.
    pub(crate) fn messenger(&self) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
        vk::DebugUtilsMessengerCreateInfoEXT::default()
            .message_severity(
                vk::DebugUtilsMessageSeverityFlagsEXT::WARNING | vk::DebugUtilsMessageSeverityFlagsEXT::ERROR,
            )
            .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
            .pfn_user_callback(Some(collect))
            .user_data(std::ptr::from_ref(self).cast_mut().cast())
    }
}

/// Appends a message to the log that `user_data` points to.
unsafe extern "system" fn collect(
    severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user_data: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: Vulkan passes valid callback data, and the messenger's user data is a log that outlives it.
    let (data, log) = unsafe { (&*data, &*user_data.cast::<MessageLog>()) };
    let text = |pointer: *const std::ffi::c_char| {
        if pointer.is_null() {
            return String::new();
        }
        // SAFETY: Strings in the callback data are null-terminated, and not null as was just checked.
        unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned()
    };
    let severity = if severity.contains(vk::DebugUtilsMessageSeverityFlagsEXT::ERROR) {
        Severity::Error
    } else {
        Severity::Warning
    };
    log.push(Message { severity, id: text(data.p_message_id_name), text: text(data.p_message) });
    vk::FALSE
}

/// How the installed layer is told what to look at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Switch {
    /// It need not be told.
    Default,
    /// By `VK_EXT_validation_features`, which older layers know.
    Features,
    /// By `VK_EXT_layer_settings`, which newer layers prefer.
    Settings,
}

impl Switch {
    /// The switch for a mode, of what the layer's extensions allow.
    pub(crate) fn choose(mode: Validation, extensions: &[&CStr]) -> Result<Self, HostError> {
        if matches!(mode, Validation::Off | Validation::Core) {
            Ok(Self::Default)
        } else if extensions.contains(&vk::EXT_LAYER_SETTINGS_NAME) {
            Ok(Self::Settings)
        } else if extensions.contains(&vk::EXT_VALIDATION_FEATURES_NAME) {
            Ok(Self::Features)
        } else {
            Err(HostError::ValidationModeMissing)
        }
    }

    /// The instance extension that it needs.
    pub(crate) fn extension(self) -> Option<&'static CStr> {
        match self {
            Self::Default => None,
            Self::Features => Some(vk::EXT_VALIDATION_FEATURES_NAME),
            Self::Settings => Some(vk::EXT_LAYER_SETTINGS_NAME),
        }
    }
}

impl Validation {
    /// What `VK_EXT_validation_features` calls the mode.
    pub(crate) fn features(self) -> &'static [vk::ValidationFeatureEnableEXT] {
        match self {
            Self::Off | Self::Core => &[],
            Self::Synchronization => &[vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION],
            Self::GpuAssisted => &[
                vk::ValidationFeatureEnableEXT::GPU_ASSISTED,
                vk::ValidationFeatureEnableEXT::GPU_ASSISTED_RESERVE_BINDING_SLOT,
            ],
        }
    }

    /// The layer's setting for the mode, a boolean.
    pub(crate) fn setting(self) -> Option<&'static CStr> {
        match self {
            Self::Off | Self::Core => None,
            Self::Synchronization => Some(c"validate_sync"),
            Self::GpuAssisted => Some(c"gpuav_enable"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newer_switch_is_preferred_and_none_is_an_error() {
        let (old, new) = (vk::EXT_VALIDATION_FEATURES_NAME, vk::EXT_LAYER_SETTINGS_NAME);
        let choose = |extensions: &[&CStr]| Switch::choose(Validation::Synchronization, extensions);
        assert_eq!(choose(&[old]).unwrap(), Switch::Features);
        assert_eq!(choose(&[old, new]).unwrap(), Switch::Settings);
        assert!(matches!(choose(&[]), Err(HostError::ValidationModeMissing)));
        assert_eq!(Switch::choose(Validation::Core, &[]).unwrap(), Switch::Default);
    }
}
