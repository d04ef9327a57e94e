//! What Vulkan offers here.

use crate::device::{Candidate, candidates, default_index};
use crate::error::HostError;
use crate::instance::{Instance, version_text};
use crate::validation::Validation;
use ash::vk;

/// The kind of a device, from the one taken first to the last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DeviceKind {
    /// A GPU with memory of its own.
    Discrete,
    /// A GPU that shares the CPU's memory.
    Integrated,
    /// A part of a GPU, in a virtual machine.
    Virtual,
    /// A driver that computes on the CPU.
    Cpu,
    /// Anything else.
    Other,
}

impl std::fmt::Display for DeviceKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Discrete => "discrete GPU",
            Self::Integrated => "integrated GPU",
            Self::Virtual => "virtual GPU",
            Self::Cpu => "CPU",
            Self::Other => "other",
        })
    }
}

/// A device as far as it matters here.
#[derive(Debug, Clone)]
pub struct DeviceSummary {
    /// What [`crate::HostOptions::device`] takes.
    pub index: usize,
    /// Its name.
    pub name: String,
    /// Its kind.
    pub kind: DeviceKind,
    /// The driver's name and version.
    pub driver: String,
    /// The Vulkan version that it speaks.
    pub api_version: String,
    /// Whether it is taken when none is asked for.
    pub is_default: bool,
    /// Why it cannot be used; `None` where it can.
    pub lack: Option<String>,
    /// The queue family that would be used.
    pub queue_family: u32,
    /// Bits of that family's timestamps that count; without any, GPU times are not reported.
    pub timestamp_valid_bits: u32,
    /// Whether it has the feature `robustBufferAccess`, which is used where it is asked for.
    pub robust_buffer_access: bool,
    /// Its limits: timestamp period, largest work group, storage buffer, image and so on.
    pub limits: vk::PhysicalDeviceLimits,
}

/// Lists every device, in the order that [`crate::HostOptions::device`] counts them.
///
/// # Errors
/// [`HostError::LoaderMissing`] where there is no Vulkan at all, [`HostError::NoDevice`] where it has no
/// driver. Drivers without a device are an empty list.
pub fn devices() -> Result<Vec<DeviceSummary>, HostError> {
    let instance = Instance::new(Validation::Off)?;
    let candidates = candidates(&instance, vk::QueueFlags::COMPUTE, None)?;
    let default = default_index(&candidates);
    Ok(candidates.into_iter().map(|candidate| summary(&instance, candidate, default)).collect())
}

fn summary(instance: &Instance, candidate: Candidate, default: Option<usize>) -> DeviceSummary {
    // SAFETY: The physical device is of this instance, which is alive.
    let features = unsafe { instance.raw.get_physical_device_features(candidate.physical_device) };
    DeviceSummary {
        index: candidate.index,
        is_default: default == Some(candidate.index),
        driver: driver(instance, &candidate),
        name: candidate.name,
        kind: match candidate.properties.device_type {
            vk::PhysicalDeviceType::DISCRETE_GPU => DeviceKind::Discrete,
            vk::PhysicalDeviceType::INTEGRATED_GPU => DeviceKind::Integrated,
            vk::PhysicalDeviceType::VIRTUAL_GPU => DeviceKind::Virtual,
            vk::PhysicalDeviceType::CPU => DeviceKind::Cpu,
            _ => DeviceKind::Other,
        },
        api_version: version_text(candidate.properties.api_version),
        lack: candidate.lack,
        queue_family: candidate.queue_family,
        timestamp_valid_bits: candidate.timestamp_valid_bits,
        robust_buffer_access: features.robust_buffer_access == vk::TRUE,
        limits: candidate.properties.limits,
    }
}

/// What the driver calls itself; before Vulkan 1.2, its version number.
pub(crate) fn driver(instance: &Instance, candidate: &Candidate) -> String {
    if candidate.properties.api_version < vk::API_VERSION_1_2 {
        return format!("version {:#x}", candidate.properties.driver_version);
    }
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
    // SAFETY: The physical device is of this instance and speaks Vulkan 1.2, which knows the chained struct.
    unsafe { instance.raw.get_physical_device_properties2(candidate.physical_device, &mut properties) };
    let name = driver.driver_name_as_c_str().unwrap_or_default().to_string_lossy();
    let info = driver.driver_info_as_c_str().unwrap_or_default().to_string_lossy();
    format!("{name} {info}").trim().to_owned()
}
