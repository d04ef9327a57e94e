//! The images of a window, which takes them in turn.

use crate::Result;
use crate::gpu::{FRAMES_IN_FLIGHT, Gpu, Instance, Semaphores};
use ash::khr::{surface, swapchain};
use ash::vk;

/// Where a window shows images. Destroyed when this is dropped.
pub struct Surface<'a> {
    functions: surface::Instance,
    raw: vk::SurfaceKHR,
    _instance: &'a Instance,
}

impl<'a> Surface<'a> {
    /// Takes a surface over.
    ///
    /// # Safety
    /// The surface is the instance's, which has `VK_KHR_surface`, and goes before its window.
    pub unsafe fn new(instance: &'a Instance, raw: vk::SurfaceKHR) -> Self {
        Self { functions: surface::Instance::new(&instance.entry, instance), raw, _instance: instance }
    }

    /// Whether a queue of this family can present here what is copied.
    pub fn is_shown_by(&self, device: vk::PhysicalDevice, family: u32) -> bool {
        // SAFETY: the device is the instance's, and has the family.
        let presents =
            unsafe { self.functions.get_physical_device_surface_support(device, family, self.raw) };
        presents == Ok(true) && self.format(device).is_ok() && self.capabilities(device).is_ok()
    }

    /// One of the formats that any device can blit to, whose numbers are taken for sRGB as they are.
    fn format(&self, device: vk::PhysicalDevice) -> Result<vk::SurfaceFormatKHR> {
        // SAFETY: as above.
        let offered = unsafe { self.functions.get_physical_device_surface_formats(device, self.raw) }?;
        let can = |one: &vk::SurfaceFormatKHR| {
            matches!(one.format, vk::Format::B8G8R8A8_UNORM | vk::Format::R8G8B8A8_UNORM)
                && one.color_space == vk::ColorSpaceKHR::SRGB_NONLINEAR
        };
        Ok(offered.into_iter().find(can).ok_or("the window takes no images of eight bits a channel")?)
    }

    fn capabilities(&self, device: vk::PhysicalDevice) -> Result<vk::SurfaceCapabilitiesKHR> {
        // SAFETY: as above.
        let found = unsafe { self.functions.get_physical_device_surface_capabilities(device, self.raw) }?;
        if !found.supported_usage_flags.contains(vk::ImageUsageFlags::TRANSFER_DST) {
            return Err("the window's images cannot be copied to".into());
        }
        Ok(found)
    }
}

impl Drop for Surface<'_> {
    fn drop(&mut self) {
        // SAFETY: swapchains borrow the surface, so none is left.
        unsafe { self.functions.destroy_surface(self.raw, None) };
    }
}

/// Images of a window at one size. When that changes, or a call says so, drop it and make another.
pub struct Swapchain<'a> {
    gpu: &'a Gpu<'a>,
    functions: swapchain::Device,
    raw: vk::SwapchainKHR,
    images: Vec<vk::Image>,
    /// Of each place among the frames in flight: the window has done with the image that was acquired there.
    free: Vec<vk::Semaphore>,
    /// Of each image: it is drawn.
    drawn: Vec<vk::Semaphore>,
    /// The images' width and height.
    pub size: [u32; 2],
    _surface: &'a Surface<'a>,
}

impl<'a> Swapchain<'a> {
    /// Makes images as large as the window, or of `size` where the window leaves that open; none where it has
    /// no area, as one that is minimised.
    ///
    /// # Errors
    /// Where the device refuses.
    ///
    /// # Safety
    /// The device has `VK_KHR_swapchain`, and the surface no other swapchain.
    pub unsafe fn new(gpu: &'a Gpu<'a>, surface: &'a Surface<'a>, size: [u32; 2]) -> Result<Option<Self>> {
        let limits = surface.capabilities(gpu.physical_device)?;
        let format = surface.format(gpu.physical_device)?;
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
            gpu,
            functions: swapchain::Device::new(gpu.instance, &gpu.device),
            raw: vk::SwapchainKHR::null(),
            images: vec![],
            free: vec![],
            drawn: vec![],
            size: [extent.width, extent.height],
            _surface: surface,
        };
        // SAFETY: the caller's contract; what is made is destroyed with `made`.
        unsafe {
            made.raw = made.functions.create_swapchain(&info, None)?;
            made.images = made.functions.get_swapchain_images(made.raw)?;
            let semaphore = || gpu.device.create_semaphore(&vk::SemaphoreCreateInfo::default(), None);
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
    /// `ERROR_OUT_OF_DATE_KHR` where the window has changed, and where the device refuses.
    ///
    /// # Safety
    /// No frame of this place is in flight, and the next that is submitted has these semaphores.
    pub unsafe fn acquire(&self, place: usize) -> Result<(vk::Image, u32, Semaphores)> {
        let free = self.free[place];
        // SAFETY: the caller's contract: nothing waits for the semaphore any more.
        let acquired =
            unsafe { self.functions.acquire_next_image(self.raw, u64::MAX, free, vk::Fence::null()) };
        let (index, _) = acquired?; // an image that does not quite fit is still shown
        let semaphores = Semaphores {
            wait: Some((free, vk::PipelineStageFlags::TRANSFER)),
            signal: Some(self.drawn[index as usize]),
        };
        Ok((self.images[index as usize], index, semaphores))
    }

    /// Shows an image when it is drawn. Whether its size still fits the window.
    ///
    /// # Errors
    /// As [`Swapchain::acquire`].
    ///
    /// # Safety
    /// The frame that draws it was submitted, and leaves it in `PRESENT_SRC_KHR` layout.
    pub unsafe fn present(&self, index: u32) -> Result<bool> {
        let (drawn, swapchains, indices) = ([self.drawn[index as usize]], [self.raw], [index]);
        let info = vk::PresentInfoKHR::default()
            .wait_semaphores(&drawn)
            .swapchains(&swapchains)
            .image_indices(&indices);
        // SAFETY: the caller's contract.
        Ok(!unsafe { self.functions.queue_present(self.gpu.queue, &info) }?)
    }
}

impl Drop for Swapchain<'_> {
    fn drop(&mut self) {
        let device = &self.gpu.device;
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
