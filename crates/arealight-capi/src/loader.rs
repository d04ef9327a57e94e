//! Vulkan's functions, from the two of the host that find them.

use crate::arguments;
use crate::failure::{ArealightResult, Failure};
use crate::types::{ArealightHost, ArealightProcAddr};
use arealight_vk::ash;
use arealight_vk::ash::vk::{self, Handle as _};
use std::ffi::{CStr, CString, c_void};

/// Functions that are called: one that is missing is said here, not when it is called.
const INSTANCE: &str = "vkGetPhysicalDeviceProperties vkGetPhysicalDeviceFormatProperties
    vkGetPhysicalDeviceImageFormatProperties vkGetPhysicalDeviceMemoryProperties";
const DEVICE: &str = "vkAllocateDescriptorSets vkAllocateMemory vkBindBufferMemory vkBindImageMemory
    vkCmdBindDescriptorSets vkCmdBindPipeline vkCmdClearColorImage vkCmdCopyBuffer vkCmdCopyBufferToImage
    vkCmdDispatch vkCmdDispatchBase vkCmdDispatchIndirect vkCmdPipelineBarrier vkCmdPushConstants
    vkCmdUpdateBuffer vkCreateBuffer vkCreateComputePipelines vkCreateDescriptorPool
    vkCreateDescriptorSetLayout vkCreateImage vkCreateImageView vkCreatePipelineLayout vkCreateSampler
    vkCreateShaderModule vkDestroyBuffer vkDestroyDescriptorPool vkDestroyDescriptorSetLayout
    vkDestroyImage vkDestroyImageView vkDestroyPipeline vkDestroyPipelineLayout vkDestroySampler
    vkDestroyShaderModule vkFreeMemory vkGetBufferMemoryRequirements vkGetImageMemoryRequirements
    vkMapMemory vkUnmapMemory vkUpdateDescriptorSets";

/// The function tables of the host's instance and device.
///
/// # Safety
/// The handles are valid, and the functions find those of Vulkan for them.
///
/// # Errors
/// [`Failure`] names a handle that is null, or the function that was not found.
pub unsafe fn load(host: &ArealightHost) -> Result<(ash::Instance, ash::Device), Failure> {
    arguments::refuse_null([
        (host.instance.is_null(), "host.instance"),
        (host.physical_device.is_null(), "host.physical_device"),
        (host.device.is_null(), "host.device"),
    ])?;
    let find_instance = finder(host.get_instance_proc_addr, host.instance, "host.get_instance_proc_addr")?;
    let find_device = finder(host.get_device_proc_addr, host.device, "host.get_device_proc_addr")?;
    for (find, names, field) in [
        (&find_instance as &dyn Fn(&CStr) -> *const c_void, INSTANCE, "get_instance_proc_addr"),
        (&find_device, DEVICE, "get_device_proc_addr"),
    ] {
        let is_missing = |name: &&str| CString::new(*name).is_ok_and(|name| find(&name).is_null());
        if let Some(missing) = names.split_whitespace().find(is_missing) {
            let message = format!("host.{field}: does not find {missing}");
            return Err(Failure::new(ArealightResult::ErrorMissingFeature, message));
        }
    }
    // SAFETY: the caller vouches for handles and functions.
    unsafe {
        let instance = vk::Instance::from_raw(host.instance as u64);
        let device = vk::Device::from_raw(host.device as u64);
        Ok((ash::Instance::load_with(find_instance, instance), ash::Device::load_with(find_device, device)))
    }
}

fn finder(
    function: ArealightProcAddr,
    handle: *mut c_void,
    field: &str,
) -> Result<impl Fn(&CStr) -> *const c_void, Failure> {
    let function = function.ok_or_else(|| Failure::argument(format!("{field}: is null")))?;
    Ok(move |name: &CStr| {
        // SAFETY: the caller of `load` vouches for the function; the name is a string of C.
        let found = unsafe { function(handle, name.as_ptr()) };
        found.map_or(std::ptr::null(), |found| found as *const c_void)
    })
}

#[cfg(test)]
mod tests {
    use super::DEVICE;
    use std::path::Path;

    /// What the recorder's sources call of a device, as C names it.
    fn called(folder: &Path, found: &mut Vec<String>) {
        for entry in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if entry.is_dir() {
                called(&entry, found);
                continue;
            }
            let source = std::fs::read_to_string(&entry).unwrap();
            for call in source.split("device.").chain(source.split("device().")).skip(1) {
                let name = call.split(|c: char| !(c.is_ascii_lowercase() || c == '_' || c.is_ascii_digit()));
                let name = name.into_iter().next().unwrap_or_default();
                if call[name.len()..].starts_with('(') && !["clone", "handle"].contains(&name) {
                    let words = name.split('_').map(|word| word[..1].to_uppercase() + &word[1..]);
                    found.push(format!("vk{}", words.collect::<String>()));
                }
            }
        }
    }

    #[test]
    fn what_is_called_is_looked_for() {
        let mut found = vec![];
        called(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../arealight-vk/src"), &mut found);
        assert!(found.len() > 30 && found.contains(&"vkCmdCopyBuffer".into()), "{found:?}");
        for name in found {
            assert!(DEVICE.split_whitespace().any(|listed| listed == name), "{name}");
        }
    }
}
