//! The images of a window, which takes them in turn.

use crate::device::Host;
use crate::error::{HostError, NameCall as _};
use crate::frames::{FRAMES_IN_FLIGHT, Semaphores};
#[cfg(feature = "window")]
use crate::{device::HostOptions, instance::Instance};
use ash::khr::{surface, swapchain};
use ash::vk;
#[cfg(feature = "window")]
use raw_window_handle::{RawDisplayHandle, RawWindowHandle};

/// Where a window shows images.
pub(crate) struct Surface {
    functions: surface::Instance,
    raw: vk::SurfaceKHR,
}

#[cfg(feature = "window")]
impl Host {
    /// As [`Host::new`], with a queue that presents to a window.
    ///
    /// # Errors
    /// As [`Host::new`], and where the window cannot be presented to.
    ///
    /// # Safety
    /// The handles are those of a window and its display, which outlive the host and all that is made of it.
    pub unsafe fn for_window(
        options: HostOptions,
        display: RawDisplayHandle,
        window: RawWindowHandle,
    ) -> Result<Self, HostError> {
        let needed = ash_window::enumerate_required_extensions(display)
            .named("ash_window::enumerate_required_extensions")?;
        // SAFETY: They are strings of C, and constants.
        let needed: Vec<_> = needed.iter().map(|name| unsafe { std::ffi::CStr::from_ptr(*name) }).collect();
        let instance = Instance::with(options.newest_version, options.validation, &needed)?;
        let functions = surface::Instance::new(&instance.entry, &instance.raw);
        // SAFETY: The caller's contract; the instance has the extensions.
        let raw =
            unsafe { ash_window::create_surface(&instance.entry, &instance.raw, display, window, None) };
        let surface = Surface { functions, raw: raw.named("ash_window::create_surface")? };
        Self::of(instance, Some(surface), options)
    }
}

impl Surface {
    /// Whether a queue of this family can present here what is copied.
    pub(crate) fn is_shown_by(&self, device: vk::PhysicalDevice, family: u32) -> bool {
        // SAFETY: the device is the instance's, and has the family.
        let presents =
            unsafe { self.functions.get_physical_device_surface_support(device, family, self.raw) };
        presents == Ok(true) && self.format(device).is_ok() && self.capabilities(device).is_ok()
    }

    /// One of the formats that any device can blit to, whose numbers are taken for sRGB as they are.
    fn format(&self, device: vk::PhysicalDevice) -> Result<vk::SurfaceFormatKHR, HostError> {
        // SAFETY: as above.
        let offered = unsafe { self.functions.get_physical_device_surface_formats(device, self.raw) };
        let offered = offered.named("vkGetPhysicalDeviceSurfaceFormatsKHR")?;
        let can = |one: &vk::SurfaceFormatKHR| {
            matches!(one.format, vk::Format::B8G8R8A8_UNORM | vk::Format::R8G8B8A8_UNORM)
                && one.color_space == vk::ColorSpaceKHR::SRGB_NONLINEAR
        };
        offered.into_iter().find(can).ok_or_else(|| refuse("takes no images of eight bits a channel"))
    }

    fn capabilities(&self, device: vk::PhysicalDevice) -> Result<vk::SurfaceCapabilitiesKHR, HostError> {
        // SAFETY: as above.
        let found = unsafe { self.functions.get_physical_device_surface_capabilities(device, self.raw) };
        let found = found.named("vkGetPhysicalDeviceSurfaceCapabilitiesKHR")?;
        if !found.supported_usage_flags.contains(vk::ImageUsageFlags::TRANSFER_DST) {
            return Err(refuse("has images that cannot be copied to"));
        }
        Ok(found)
    }
}

/// What a window cannot do.
fn refuse(message: &str) -> HostError {
    HostError::InvalidArgument { name: "the window".to_owned(), message: message.to_owned() }
}

impl Drop for Surface {
    fn drop(&mut self) {
        // SAFETY: Swapchains hold the host, which holds the surface, so none is left.
        unsafe { self.functions.destroy_surface(self.raw, None) };
    }
}

/// Images of the host's window at one size. When that changes, or a call says so, drop it and make another.
pub struct Swapchain {
    host: Host,
    functions: swapchain::Device,
    raw: vk::SwapchainKHR,
    images: Vec<vk::Image>,
    /// Of each place among the frames in flight: the window has done with the image that was acquired there.
    free: Vec<vk::Semaphore>,
    /// Of each image: it is drawn.
    drawn: Vec<vk::Semaphore>,
    /// The images' width and height.
    pub size: [u32; 2],
}

impl Swapchain {
    /// Makes images as large as the window, or of `size` where the window leaves that open; none where it has
    /// no area, as one that is minimised.
    ///
    /// # Errors
    /// [`HostError::InvalidArgument`] where the host has no window; where the device refuses.
    ///
    /// # Safety
    /// The host has no other swapchain.
    pub unsafe fn new(host: &Host, size: [u32; 2]) -> Result<Option<Self>, HostError> {
        let surface = host.surface().ok_or_else(|| refuse("is none: the host was made without one"))?;
        let limits = surface.capabilities(host.physical_device())?;
        let format = surface.format(host.physical_device())?;
        let extent = if limits.current_extent.width == u32::MAX {
            let (least, most) = (limits.min_image_extent, limits.max_image_extent);
            let width = size[0].clamp(least.width, most.width);
            vk::Extent2D { width, height: size[1].clamp(least.height, most.height) }
        } else {
            limits.current_extent
        };
        if extent.width == 0 || extent.height == 0 {
            return Ok(None);
        }

        // One more than the window keeps; zero is no limit
        let most = if limits.max_image_count == 0 { u32::MAX } else { limits.max_image_count };
        let alphas = limits.supported_composite_alpha;
        let alpha = [vk::CompositeAlphaFlagsKHR::OPAQUE, vk::CompositeAlphaFlagsKHR::INHERIT];
        let alpha = alpha.into_iter().find(|alpha| alphas.contains(*alpha));
        let info = vk::SwapchainCreateInfoKHR::default()
            .surface(surface.raw)
            .min_image_count((limits.min_image_count + 1).min(most))
            .image_format(format.format)
            .image_color_space(format.color_space)
            .image_extent(extent)
            .image_array_layers(1)
            .image_usage(vk::ImageUsageFlags::TRANSFER_DST)
            .pre_transform(limits.current_transform)
            .composite_alpha(alpha.unwrap_or(vk::CompositeAlphaFlagsKHR::PRE_MULTIPLIED))
            .present_mode(vk::PresentModeKHR::FIFO)
            .clipped(true);
        let mut made = Self {
            host: host.clone(),
            functions: swapchain::Device::new(host.instance(), host.device()),
            raw: vk::SwapchainKHR::null(),
            images: vec![],
            free: vec![],
            drawn: vec![],
            size: [extent.width, extent.height],
        };
        // SAFETY: the caller's contract; what is made is destroyed with `made`.
        unsafe {
            made.raw = made.functions.create_swapchain(&info, None).named("vkCreateSwapchainKHR")?;
            made.images = made.functions.get_swapchain_images(made.raw).named("vkGetSwapchainImagesKHR")?;
            let info = vk::SemaphoreCreateInfo::default();
            let semaphore = || host.device().create_semaphore(&info, None).named("vkCreateSemaphore");
            for _ in 0..FRAMES_IN_FLIGHT {
                made.free.push(semaphore()?);
            }
            for _ in &made.images {
                made.drawn.push(semaphore()?);
            }
        }
        Ok(Some(made))
    }

    /// The image that is shown next, its number, and the semaphores of the frame at `place` that copies to
    /// it.
    ///
    /// # Errors
    /// [`HostError::Vulkan`] with `ERROR_OUT_OF_DATE_KHR` where the window has changed, and where the device
    /// refuses.
    ///
    /// # Safety
    /// No frame of this place is in flight, and the next that is submitted has these semaphores.
    pub unsafe fn acquire(&self, place: usize) -> Result<(vk::Image, u32, Semaphores), HostError> {
        let free = self.free[place];
        // SAFETY: the caller's contract: nothing waits for the semaphore any more.
        let acquired =
            unsafe { self.functions.acquire_next_image(self.raw, u64::MAX, free, vk::Fence::null()) };
        // An image that does not quite fit is still shown
        let (index, _) = acquired.named("vkAcquireNextImageKHR")?;
        let semaphores = Semaphores {
            wait: Some((free, vk::PipelineStageFlags::TRANSFER)),
            signal: Some(self.drawn[index as usize]),
        };
        Ok((self.images[index as usize], index, semaphores))
    }

    /// Shows an image when it is drawn. Whether its size still fits the window.
    ///
    /// # Safety
    /// The frame that draws it was submitted, and leaves it in `PRESENT_SRC_KHR` layout.
    pub unsafe fn present(&self, index: u32) -> Result<bool, HostError> {
        let (drawn, swapchains, indices) = ([self.drawn[index as usize]], [self.raw], [index]);
        let info = vk::PresentInfoKHR::default()
            .wait_semaphores(&drawn)
            .swapchains(&swapchains)
            .image_indices(&indices);
        let queue = self.host.queue();
        // SAFETY: the caller's contract; the queue is locked.
        let presented = unsafe { self.functions.queue_present(*queue, &info) };
        Ok(!presented.named("vkQueuePresentKHR")?)
    }
}

impl Drop for Swapchain {
    fn drop(&mut self) {
        let device = self.host.device();
        // SAFETY: all are this device's, and after the wait nothing uses them; a lost device uses nothing
        // either.
        unsafe {
            let _ = device.device_wait_idle();
            for semaphore in self.free.iter().chain(&self.drawn) {
                device.destroy_semaphore(*semaphore, None);
            }
            self.functions.destroy_swapchain(self.raw, None);
        }
    }
}
