//! Names and labels by which a debugger shows our objects and commands, where the host has
//! `VK_EXT_debug_utils`.

use ash::ext::debug_utils::Device;
use ash::vk;
use std::ffi::{CStr, CString};

/// The extension's functions, or nothing to do.
#[derive(Clone, Default)]
pub(crate) struct DebugNames(Option<Device>);

impl DebugNames {
    pub(crate) fn new(functions: Device) -> Self {
        Self(Some(functions))
    }

    /// Names an object of ours `arealight NAME`.
    pub(crate) fn name(&self, object: impl vk::Handle, name: &str) {
        let (Some(functions), Ok(name)) = (&self.0, CString::new(format!("arealight {name}"))) else {
            return;
        };
        let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(object).object_name(&name);
        // A name is not worth an error
        // SAFETY: the object is ours and live, and no other thread has it yet.
        let _ = unsafe { functions.set_debug_utils_object_name(&info) };
    }

    /// Puts a label around the commands that are recorded until it is dropped.
    ///
    /// # Safety
    /// The command buffer is recording until then.
    pub(crate) unsafe fn label(&self, command_buffer: vk::CommandBuffer, name: &CStr) -> Label<'_> {
        if let Some(functions) = &self.0 {
            let label = vk::DebugUtilsLabelEXT::default().label_name(name);
            // SAFETY: the caller's contract.
            unsafe { functions.cmd_begin_debug_utils_label(command_buffer, &label) };
        }
        Label { functions: self.0.as_ref(), command_buffer }
    }
}

/// A label that ends when it is dropped.
pub(crate) struct Label<'a> {
    functions: Option<&'a Device>,
    command_buffer: vk::CommandBuffer,
}

impl Drop for Label<'_> {
    fn drop(&mut self) {
        if let Some(functions) = self.functions {
            // SAFETY: by the contract of DebugNames::label the command buffer is recording.
            unsafe { functions.cmd_end_debug_utils_label(self.command_buffer) };
        }
    }
}
