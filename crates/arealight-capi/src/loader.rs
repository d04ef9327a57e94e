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
    vkCmdDispatch vkCmdDispatchBase vkCmdDispatchIndirect vkCmdFillBuffer vkCmdPipelineBarrier
    vkCmdPushConstants vkCmdUpdateBuffer vkCreateBuffer vkCreateComputePipelines vkCreateDescriptorPool
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
    use std::path::{Path, PathBuf};

    fn sources(path: PathBuf) -> String {
        let Ok(entries) = path.read_dir() else { return std::fs::read_to_string(path).unwrap() };
        entries.map(|entry| sources(entry.unwrap().path())).collect()
    }

    #[test]
    fn what_the_recorder_calls_is_looked_for() {
        let text = sources(Path::new(env!("CARGO_MANIFEST_DIR")).join("../arealight-vk/src"));
        let listed = DEVICE.to_lowercase();
        let listed: Vec<&str> = listed.split_whitespace().collect();
        let mut count = 0;
        for call in text.replace("device()", "device").split("device.").skip(1) {
            let name = call.split('(').next().unwrap_or_default();
            if name.bytes().all(|c| c.is_ascii_lowercase() || c == b'_')
                && !["clone", "handle"].contains(&name)
            {
                let name = format!("vk{}", name.replace('_', ""));
                assert!(listed.contains(&name.as_str()), "{name}");
                count += 1;
            }
        }
        assert!(count > 30, "{count}");
    }
}
