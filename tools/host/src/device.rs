//! The device: which one is taken, how it is made, and in which order all of it goes.

use crate::error::{HostError, NameCall as _};
use crate::instance::{Instance, version_text};
use crate::listing::driver;
use crate::null_hardware::is_null_hardware;
use crate::swapchain::Surface;
use crate::validation::{Message, MessageLog, Validation};
use ash::vk;
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use std::mem::ManuallyDrop;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// What a [`Host`] is made with.
#[derive(Debug, Clone)]
pub struct HostOptions {
    /// The device: its index in [`crate::devices`], or a part of its name (upper and lower case are the
    /// same). `None` takes a discrete GPU, else the best kind there is.
    pub device: Option<String>,
    /// What the validation layer looks at; [`Host::validation_messages`] has what it says.
    pub validation: Validation,
    /// Enables `robustBufferAccess`: accesses out of a buffer's bounds do no harm, and hide from
    /// [`Validation::GpuAssisted`].
    pub robust_buffer_access: bool,
    /// Enables `VK_KHR_push_descriptor`.
    pub push_descriptors: bool,
    /// What the queue does: it computes by default. A host that draws asks for `GRAPHICS`, too.
    pub queue: vk::QueueFlags,
    /// The newest version of Vulkan that may be used, if the loader has it: 1.3 by default.
    pub newest_version: u32,
    /// How long [`Host::submit`] waits for the GPU; 10 minutes by default, for slow dispatches on a CPU.
    pub timeout: Duration,
}

impl Default for HostOptions {
    fn default() -> Self {
        Self {
            device: None,
            validation: Validation::Off,
            robust_buffer_access: false,
            push_descriptors: false,
            queue: vk::QueueFlags::COMPUTE,
            newest_version: vk::API_VERSION_1_3,
            timeout: Duration::from_secs(600),
        }
    }
}

/// A Vulkan device with one queue and an allocator. Clones share it.
#[derive(Clone)]
pub struct Host {
    inner: Arc<Inner>,
}

struct Inner {
    /// Dropped last, and not at all where the device is not.
    instance: ManuallyDrop<Instance>,
    /// Of the window that the host presents to; it goes before the instance.
    surface: Option<Surface>,
    physical_device: vk::PhysicalDevice,
    properties: vk::PhysicalDeviceProperties,
    device: ash::Device,
    queue_family: u32,
    timestamp_valid_bits: u32,
    driver: String,
    queue: Mutex<vk::Queue>,
    /// `None` only while the host is being dropped: the allocator frees its memory before the device goes.
    allocator: Mutex<Option<Allocator>>,
    enabled_features: vk::PhysicalDeviceFeatures,
    timeout: Duration,
    /// The GPU did not finish in time and may still use anything: nothing may be destroyed.
    abandoned: AtomicBool,
}

impl std::fmt::Debug for Host {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Host").field("device", &self.device_name()).finish_non_exhaustive()
    }
}

impl Host {
    /// Opens Vulkan, takes a device and makes a queue and an allocator.
    ///
    /// # Errors
    /// Says what is missing and how to get it: the loader, a driver, the device that was asked for, the
    /// validation layer, a feature.
    pub fn new(options: HostOptions) -> Result<Self, HostError> {
        let instance = Instance::with(options.newest_version, options.validation, &[])?;
        Self::of(instance, None, options)
    }

    /// A host of an instance, that presents to its surface; which goes first where there is an error.
    pub(crate) fn of(
        instance: Instance,
        surface: Option<Surface>,
        options: HostOptions,
    ) -> Result<Self, HostError> {
        let HostOptions { device: wanted, robust_buffer_access, push_descriptors, queue, timeout, .. } =
            options;
        let found = candidates(&instance, queue, surface.as_ref())?;
        let candidate = choose(found, wanted.as_deref())?;
        let (physical_device, queue_family) = (candidate.physical_device, candidate.queue_family);
        let driver = driver(&instance, &candidate);

        // Enable nothing optional unless asked
        // SAFETY: The physical device is of this instance, which is alive; for both calls.
        let (supported, properties) = unsafe {
            let features = instance.raw.get_physical_device_features(physical_device);
            (features, instance.raw.get_physical_device_properties(physical_device))
        };
        if robust_buffer_access && supported.robust_buffer_access == vk::FALSE {
            return Err(HostError::MissingFeature("robustBufferAccess"));
        }
        let enabled_features =
            vk::PhysicalDeviceFeatures::default().robust_buffer_access(robust_buffer_access);

        // Make the device with one queue
        let queues =
            [vk::DeviceQueueCreateInfo::default().queue_family_index(queue_family).queue_priorities(&[1.0])];
        let extensions = extensions(&instance, physical_device, push_descriptors, surface.is_some())?;
        let info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_features(&enabled_features)
            .enabled_extension_names(&extensions);
        // SAFETY: What the info points to lives until the call returns, and the instance as long as the
        // device.
        let device = unsafe { instance.raw.create_device(physical_device, &info, None) };
        let device = device.named("vkCreateDevice")?;
        // SAFETY: The device was made with this queue.
        let queue = unsafe { device.get_device_queue(queue_family, 0) };

        let allocator = match new_allocator(&instance.raw, physical_device, &device) {
            Ok(allocator) => allocator,
            Err(error) => {
                // SAFETY: Nothing was made of the device yet.
                unsafe { device.destroy_device(None) };
                return Err(error);
            }
        };
        let inner = Inner {
            instance: ManuallyDrop::new(instance),
            surface,
            physical_device,
            properties,
            device,
            queue_family,
            timestamp_valid_bits: candidate.timestamp_valid_bits,
            driver,
            queue: Mutex::new(queue),
            allocator: Mutex::new(Some(allocator)),
            enabled_features,
            timeout,
            abandoned: AtomicBool::new(false),
        };
        Ok(Self { inner: Arc::new(inner) })
    }

    /// The instance.
    pub fn instance(&self) -> &ash::Instance {
        &self.inner.instance.raw
    }

    /// The physical device.
    pub fn physical_device(&self) -> vk::PhysicalDevice {
        self.inner.physical_device
    }

    /// The device.
    pub fn device(&self) -> &ash::Device {
        &self.inner.device
    }

    /// The surface of the window that it presents to.
    pub(crate) fn surface(&self) -> Option<&Surface> {
        self.inner.surface.as_ref()
    }

    /// The family of the queue; it computes and copies.
    pub fn queue_family(&self) -> u32 {
        self.inner.queue_family
    }

    /// The queue, locked: Vulkan wants one thread at a time to use it.
    pub fn queue(&self) -> MutexGuard<'_, vk::Queue> {
        self.inner.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The physical device's properties and limits.
    pub fn properties(&self) -> &vk::PhysicalDeviceProperties {
        &self.inner.properties
    }

    /// The device's name.
    pub fn device_name(&self) -> String {
        self.properties().device_name_as_c_str().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// The features that the device was made with.
    pub fn enabled_features(&self) -> &vk::PhysicalDeviceFeatures {
        &self.inner.enabled_features
    }

    /// The driver's name and version.
    pub fn driver(&self) -> &str {
        &self.inner.driver
    }

    /// Bits of the queue's timestamps that count; 0 where it has none.
    pub fn timestamp_valid_bits(&self) -> u32 {
        self.inner.timestamp_valid_bits
    }

    /// Another allocator, for what owns memory of its own: all that was made with it goes before the host.
    pub fn allocator(&self) -> Result<Arc<Mutex<Allocator>>, HostError> {
        let made = new_allocator(self.instance(), self.physical_device(), self.device())?;
        Ok(Arc::new(Mutex::new(made)))
    }

    /// Lends the allocator, for memory that this crate's types do not cover. What is allocated must be freed
    /// before the last clone of the host is dropped.
    pub fn with_allocator<R>(&self, function: impl FnOnce(&mut Allocator) -> R) -> R {
        let mut allocator = self.inner.allocator.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(allocator) = allocator.as_mut() else {
            unreachable!("the allocator is taken only by Inner::drop, when no Host is left")
        };
        function(allocator)
    }

    /// What the validation layer has said so far.
    pub fn validation_messages(&self) -> Vec<Message> {
        self.inner.instance.messages.messages()
    }

    /// What the validation layer has said since the last time this was called.
    pub fn take_validation_messages(&self) -> Vec<Message> {
        self.inner.instance.messages.take()
    }

    pub(crate) fn message_log(&self) -> Arc<MessageLog> {
        Arc::clone(&self.inner.instance.messages)
    }

    pub(crate) fn timeout(&self) -> Duration {
        self.inner.timeout
    }

    pub(crate) fn abandon(&self) {
        self.inner.abandoned.store(true, Ordering::Relaxed);
    }

    /// Whether a submission timed out: the GPU may still use anything, so that nothing may be destroyed.
    pub fn is_abandoned(&self) -> bool {
        self.inner.abandoned.load(Ordering::Relaxed)
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        let allocator = self.allocator.get_mut().unwrap_or_else(PoisonError::into_inner).take();
        if *self.abandoned.get_mut() {
            std::mem::forget((allocator, self.surface.take()));
            return;
        }
        // SAFETY: Every object of the device holds the host and is thus gone, and no work is pending, since
        // submissions are waited for. The allocator frees its memory before the device goes, and the
        // instance, which is not touched again, goes last.
        unsafe {
            drop(allocator);
            self.device.destroy_device(None);
            drop(self.surface.take());
            ManuallyDrop::drop(&mut self.instance);
        }
    }
}

fn new_allocator(
    instance: &ash::Instance,
    physical_device: vk::PhysicalDevice,
    device: &ash::Device,
) -> Result<Allocator, HostError> {
    let made = Allocator::new(&AllocatorCreateDesc {
        instance: instance.clone(),
        device: device.clone(),
        physical_device,
        debug_settings: gpu_allocator::AllocatorDebugSettings::default(),
        buffer_device_address: false,
        allocation_sizes: gpu_allocator::AllocationSizes::default(),
    });
    made.map_err(|error| HostError::OutOfMemory { what: format!("the allocator ({error})") })
}

/// A physical device, and what speaks for or against it.
pub(crate) struct Candidate {
    /// Its place in the drivers' order.
    pub(crate) index: usize,
    pub(crate) physical_device: vk::PhysicalDevice,
    pub(crate) properties: vk::PhysicalDeviceProperties,
    pub(crate) name: String,
    /// A family that does what is asked for; of no meaning where `lack` is set.
    pub(crate) queue_family: u32,
    pub(crate) timestamp_valid_bits: u32,
    /// Why it cannot be used.
    pub(crate) lack: Option<String>,
}

/// Every physical device, whether it has a queue for that or not: what it does, and where it presents to.
pub(crate) fn candidates(
    instance: &Instance,
    queue: vk::QueueFlags,
    surface: Option<&Surface>,
) -> Result<Vec<Candidate>, HostError> {
    let devices = instance.physical_devices()?.into_iter().enumerate();
    Ok(devices.map(|(index, device)| candidate(instance, index, device, queue, surface)).collect())
}

fn candidate(
    instance: &Instance,
    index: usize,
    physical_device: vk::PhysicalDevice,
    queue: vk::QueueFlags,
    surface: Option<&Surface>,
) -> Candidate {
    // SAFETY: The physical device is of this instance, which is alive; for both calls.
    let (properties, families) = unsafe {
        let properties = instance.raw.get_physical_device_properties(physical_device);
        (properties, instance.raw.get_physical_device_queue_family_properties(physical_device))
    };
    let does = |(number, family): (u32, &vk::QueueFamilyProperties)| {
        family.queue_flags.contains(queue)
            && surface.is_none_or(|surface| surface.is_shown_by(physical_device, number))
    };
    let family = (0..).zip(&families).position(does);
    let name = properties.device_name_as_c_str().unwrap_or_default().to_string_lossy().into_owned();
    let lack = if is_null_hardware(&name) {
        Some("it compiles shaders and runs none: see arealight bench compiled".to_owned())
    } else if properties.api_version < vk::API_VERSION_1_1 {
        Some(format!("only Vulkan {}", version_text(properties.api_version)))
    } else if family.is_none() {
        Some(if surface.is_some() { "no queue for the window" } else { "no compute queue" }.to_owned())
    } else {
        None
    };
    let family = family.unwrap_or(0);
    Candidate {
        index,
        physical_device,
        properties,
        name,
        queue_family: family as u32,
        timestamp_valid_bits: families.get(family).map_or(0, |family| family.timestamp_valid_bits),
        lack,
    }
}

/// The candidate that is asked for, else the first of the best kind.
pub(crate) fn choose(candidates: Vec<Candidate>, wanted: Option<&str>) -> Result<Candidate, HostError> {
    let (usable, others): (Vec<_>, Vec<_>) =
        candidates.into_iter().partition(|candidate| candidate.lack.is_none());
    if usable.is_empty() {
        let describe = |one: Candidate| format!("{} ({})", one.name, one.lack.unwrap_or_default());
        return Err(HostError::NoDevice { found: others.into_iter().map(describe).collect() });
    }
    let default = default_index(&usable);
    let available = usable.iter().map(|one| format!("{}: {}", one.index, one.name)).collect();
    let asked_for = |one: &Candidate| match wanted.map(|wanted| (wanted, wanted.parse::<usize>())) {
        None => Some(one.index) == default,
        Some((_, Ok(index))) => one.index == index,
        Some((name, Err(_))) => {
            !name.trim().is_empty() && one.name.to_lowercase().contains(&name.to_lowercase())
        }
    };
    if let Some(found) = usable.into_iter().find(asked_for) {
        return Ok(found);
    }
    Err(match others.into_iter().find(asked_for) {
        Some(Candidate { name, lack, .. }) => {
            HostError::DeviceUnusable { name, lack: lack.unwrap_or_default(), available }
        }
        None => HostError::DeviceNotFound { wanted: wanted.unwrap_or_default().to_owned(), available },
    })
}

/// The index of the device that is taken when none is asked for: the first usable one of the best kind.
pub(crate) fn default_index(candidates: &[Candidate]) -> Option<usize> {
    let usable = candidates.iter().filter(|one| one.lack.is_none());
    usable.min_by_key(|one| rank(one.properties.device_type)).map(|one| one.index)
}

/// Lower is taken first.
fn rank(kind: vk::PhysicalDeviceType) -> u32 {
    match kind {
        vk::PhysicalDeviceType::DISCRETE_GPU => 0,
        vk::PhysicalDeviceType::INTEGRATED_GPU => 1,
        vk::PhysicalDeviceType::VIRTUAL_GPU => 2,
        vk::PhysicalDeviceType::CPU => 3,
        _ => 4,
    }
}

/// Extensions that are enabled: what was asked for, and what must be where the device has it, which is only
/// the one that marks a non-conformant device.
fn extensions(
    instance: &Instance,
    physical_device: vk::PhysicalDevice,
    push_descriptors: bool,
    presents: bool,
) -> Result<Vec<*const std::ffi::c_char>, HostError> {
    // SAFETY: The physical device is of this instance, which is alive.
    let offered = unsafe { instance.raw.enumerate_device_extension_properties(physical_device) };
    let offered = offered.named("vkEnumerateDeviceExtensionProperties")?;
    let is_there =
        |name: &std::ffi::CStr| offered.iter().any(|one| one.extension_name_as_c_str() == Ok(name));
    let mut enabled = vec![];
    if is_there(vk::KHR_PORTABILITY_SUBSET_NAME) {
        enabled.push(vk::KHR_PORTABILITY_SUBSET_NAME.as_ptr());
    }
    if presents {
        if !is_there(vk::KHR_SWAPCHAIN_NAME) {
            return Err(HostError::MissingFeature("VK_KHR_swapchain"));
        }
        enabled.push(vk::KHR_SWAPCHAIN_NAME.as_ptr());
    }
    if push_descriptors {
        if !is_there(vk::KHR_PUSH_DESCRIPTOR_NAME) {
            return Err(HostError::MissingFeature("VK_KHR_push_descriptor"));
        }
        enabled.push(vk::KHR_PUSH_DESCRIPTOR_NAME.as_ptr());
    }
    Ok(enabled)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn candidate(index: usize, name: &str, kind: vk::PhysicalDeviceType, lack: Option<&str>) -> Candidate {
        Candidate {
            index,
            physical_device: vk::PhysicalDevice::null(),
            properties: vk::PhysicalDeviceProperties { device_type: kind, ..Default::default() },
            name: name.to_owned(),
            queue_family: 0,
            timestamp_valid_bits: 64,
            lack: lack.map(str::to_owned),
        }
    }

    fn three() -> Vec<Candidate> {
        vec![
            candidate(0, "llvmpipe (LLVM 15)", vk::PhysicalDeviceType::CPU, None),
            candidate(1, "Old 9000", vk::PhysicalDeviceType::DISCRETE_GPU, Some("only Vulkan 1.0.3")),
            candidate(2, "Radiance RX", vk::PhysicalDeviceType::DISCRETE_GPU, None),
        ]
    }

    #[test]
    fn a_usable_discrete_gpu_comes_first() {
        assert_eq!(choose(three(), None).unwrap().index, 2);
    }

    #[test]
    fn a_device_is_found_by_index_and_by_a_part_of_its_name() {
        assert_eq!(choose(three(), Some("0")).unwrap().index, 0);
        assert_eq!(choose(three(), Some("radiance")).unwrap().index, 2);
    }

    #[test]
    fn what_cannot_be_had_says_what_can() {
        let refused = |wanted| choose(three(), Some(wanted)).map(|one| one.index).unwrap_err();
        assert!(refused("").to_string().contains("take one of 0: llvmpipe"), "no name is no device's");
        let text = refused("titan").to_string();
        assert!(text.contains("`titan`: take one of 0: llvmpipe (LLVM 15), 2: Radiance RX"), "{text}");
        for one in ["1", "old"] {
            assert!(matches!(refused(one), HostError::DeviceUnusable { .. }));
            let text = refused(one).to_string();
            assert!(
                text.contains("Old 9000 cannot be used (only Vulkan 1.0.3): take one of 0: llvm"),
                "{text}"
            );
        }
        let only_old = three().into_iter().filter(|one| one.index == 1).collect();
        let error = choose(only_old, None).map(|one| one.index).unwrap_err();
        assert!(error.to_string().contains("found: Old 9000 (only Vulkan 1.0.3)"), "{error}");
    }
}
