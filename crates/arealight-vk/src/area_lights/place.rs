//! What each frame in flight has for itself.

use super::history::History;
use crate::context::Context;
use crate::error::{Error, VulkanCall};
use crate::medium::{MediumPass, MediumResources};
use crate::memory::{Buffer, LEAST, SharedAllocator, StoredImage, mapped};
use crate::resource::Resource;
use crate::shade::{ShadePass, ShadeResources};
use crate::shadows::{BlockerResources, ShadowPass, ShadowResources};
use arealight::PackedLights;
use arealight::plan::{Output, RadianceFormat, ShadeOptions};
use ash::vk;
use bytemuck::cast_slice;
use gpu_allocator::MemoryLocation;
use std::sync::Arc;

/// What a frame has that others in flight must not touch.
pub(super) struct Place {
    /// Of the shade pass, and of the passes of shadows and a medium where there are.
    pub(super) sets: Vec<vk::DescriptorSet>,
    /// What the place's frame copies the table and blockers from.
    pub(super) staging: (Option<Arc<Buffer>>, Option<Arc<[Buffer; 2]>>),
    blockers: Option<Arc<[Buffer; 2]>>,
    history: Option<Arc<Buffer>>,
    /// Lights, vertices and shapes.
    lights: [Buffer; 3],
    tile_lists: Option<Buffer>,
    shadows: Option<Shadows>,
    froxels: Option<StoredImage>,
}

/// What shadows need of a frame's size.
struct Shadows {
    picks: Buffer,
    shadow: StoredImage,
    /// Where the radiance without shadows goes, if it may not overwrite the host's.
    unshadowed: Option<StoredImage>,
}

impl Place {
    /// # Safety
    /// It is dropped when no pending work uses it, before the device; so for all that it makes.
    pub(super) unsafe fn new(
        context: &Context,
        allocator: &SharedAllocator,
        sets: Vec<vk::DescriptorSet>,
    ) -> Result<Self, Error> {
        // SAFETY: the same contract.
        let empty = || unsafe { mapped(context, allocator, &[]) };
        let lights = [empty()?, empty()?, empty()?];
        Ok(Self {
            sets,
            staging: (None, None),
            blockers: None,
            history: None,
            lights,
            tile_lists: None,
            shadows: None,
            froxels: None,
        })
    }

    /// Writes the lights, to larger buffers where they need them.
    ///
    /// # Safety
    /// No pending work uses the place.
    pub(super) unsafe fn write_lights(
        &mut self,
        context: &Context,
        allocator: &SharedAllocator,
        packed: &PackedLights,
    ) -> Result<(), Error> {
        let arrays: [&[u8]; 3] =
            [cast_slice(&packed.lights), cast_slice(&packed.vertices), cast_slice(&packed.shapes)];
        for (buffer, bytes) in self.lights.iter_mut().zip(arrays) {
            if bytes.len() as vk::DeviceSize > buffer.size {
                // Twice as much each time, so that growing lights seldom need another
                let size = (bytes.len() as vk::DeviceSize).next_power_of_two();
                let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
                // SAFETY: the same contract.
                *buffer =
                    unsafe { Buffer::new(context, allocator, usage, (size, MemoryLocation::CpuToGpu)) }?;
            }
            buffer.write(bytes);
        }
        Ok(())
    }

    /// Makes what depends on the size of the picture, where it is another.
    ///
    /// # Safety
    /// As [`Place::write_lights`].
    pub(super) unsafe fn fit(
        &mut self,
        context: &Context,
        allocator: &SharedAllocator,
        (shade, options): (&ShadePass, ShadeOptions),
        (size, froxels): ([u32; 2], Option<[u32; 3]>),
    ) -> Result<(), Error> {
        let on_device = |usage, size: vk::DeviceSize| {
            let what = (size.max(LEAST), MemoryLocation::GpuOnly);
            // SAFETY: the same contract.
            unsafe { Buffer::new(context, allocator, usage, what) }
        };
        if let Some(needed) = shade.tile_memory(size)
            && self.tile_lists.as_ref().is_none_or(|lists| lists.size < needed.size)
        {
            self.tile_lists = Some(on_device(needed.usage, needed.size)?);
        }
        let (froxels, most) = (froxels.map(|of| of.map(|count| count.max(1))), context.limits.volume_side);
        if froxels.into_iter().flatten().any(|count| count > most) {
            let message = format!("must be at most {most} along each axis, as a volume of the device");
            return Err(Error::InvalidArgument { field: "froxels", message });
        }
        if let Some(extent) = froxels
            && self.froxels.as_ref().is_none_or(|image| image.image.info.extent != extent)
        {
            // SAFETY: as above.
            let image = unsafe {
                StoredImage::new(context, allocator, MediumPass::FORMAT, extent, vk::ImageType::TYPE_3D)
            };
            self.froxels = Some(image?);
        }
        let extent = [size[0], size[1], 1].map(|side| side.max(1));
        let is_other = self.shadows.as_ref().is_none_or(|shadows| shadows.shadow.image.info.extent != extent);
        if options.shadow_rays > 0 && is_other {
            let format = match options.format {
                RadianceFormat::Rgba32Float => vk::Format::R32G32B32A32_SFLOAT,
                RadianceFormat::Rgba16Float => vk::Format::R16G16B16A16_SFLOAT,
            };
            // SAFETY: as above.
            let image = |format| unsafe {
                StoredImage::new(context, allocator, format, extent, vk::ImageType::TYPE_2D)
            };
            self.shadows = Some(Shadows {
                picks: on_device(vk::BufferUsageFlags::STORAGE_BUFFER, shade.picks_size(size))?,
                shadow: image(ShadowPass::SHADOW_FORMAT)?,
                unshadowed: (options.output == Output::Add).then(|| image(format)).transpose()?,
            });
        }
        Ok(())
    }

    /// The host's resources of a frame, with those of the place.
    pub(super) fn resources(&self, g_buffer: &ShadeResources) -> ShadeResources {
        let [lights, light_vertices, shapes] =
            self.lights.each_ref().map(|buffer| Resource::buffer(buffer.raw));
        let unshadowed = self.shadows.as_ref().and_then(|shadows| shadows.unshadowed.as_ref());
        ShadeResources {
            lights,
            light_vertices,
            shapes: Some(shapes),
            radiance: unshadowed.map_or(g_buffer.radiance, |image| Resource::stored(image.image.view)),
            picks: self.shadows.as_ref().map(|shadows| Resource::buffer(shadows.picks.raw)),
            tile_lists: self.tile_lists.as_ref().map(|lists| Resource::buffer(lists.raw)),
            ..*g_buffer
        }
    }

    /// Those of the shadow pass; the place keeps the blockers and the history.
    pub(super) fn shadow_resources(
        &mut self,
        g_buffer: &ShadeResources,
        blockers: &Arc<[Buffer; 2]>,
        history: Option<&History>,
    ) -> ShadowResources {
        self.blockers = Some(Arc::clone(blockers));
        self.history = history.map(|history| Arc::clone(&history.buffer));
        let shadows = self.shadows.as_ref();
        let own = shadows.and_then(|shadows| shadows.unshadowed.as_ref());
        ShadowResources {
            shadow: shadows
                .map_or_else(Resource::default, |shadows| Resource::stored(shadows.shadow.image.view)),
            radiance: own.map(|_| g_buffer.radiance),
            history: self.history.as_ref().map(|buffer| Resource::buffer(buffer.raw)),
            blockers: self.blocker_resources(),
        }
    }

    fn blocker_resources(&self) -> Option<BlockerResources> {
        let buffers = self.blockers.as_ref()?;
        let [nodes, triangles] = buffers.each_ref().map(|buffer| Resource::buffer(buffer.raw));
        Some(BlockerResources { nodes, triangles })
    }

    /// Those of a medium's pass.
    pub(super) fn medium_resources(&self) -> MediumResources {
        let froxels =
            self.froxels.as_ref().map_or_else(Resource::default, |image| Resource::stored(image.image.view));
        MediumResources { froxels, medium: None, blockers: self.blocker_resources() }
    }

    /// Records that the place's images get their layout: what they held is of no frame to come.
    ///
    /// # Safety
    /// The command buffer is recording, outside a render pass.
    pub(super) unsafe fn record_layouts(&self, context: &Context, command_buffer: vk::CommandBuffer) {
        let unused = (vk::ImageLayout::UNDEFINED, vk::AccessFlags::NONE);
        let written = vk::AccessFlags::SHADER_READ | vk::AccessFlags::SHADER_WRITE;
        let barrier = |image: &StoredImage| image.image.barrier(unused, (vk::ImageLayout::GENERAL, written));
        let of_shadows = self.shadows.iter().flat_map(|of| std::iter::once(&of.shadow).chain(&of.unshadowed));
        let images: Vec<_> = of_shadows.chain(&self.froxels).map(barrier).collect();
        if images.is_empty() {
            return;
        }
        // SAFETY: the same contract; the images are the place's.
        unsafe {
            context.record_images(
                command_buffer,
                (vk::PipelineStageFlags::TOP_OF_PIPE, vk::PipelineStageFlags::COMPUTE_SHADER),
                &images,
            );
        }
    }
}

/// A place, if it is there.
pub(super) fn place_of<T>(places: &mut [T], place: usize) -> Result<&mut T, Error> {
    let count = places.len();
    let message = format!("{place} is not there: frames_in_flight is {count}");
    places.get_mut(place).ok_or(Error::InvalidArgument { field: "place", message })
}

/// A pool, and all its sets.
pub(super) fn descriptor_sets(
    Context { device, .. }: &Context,
    sizes: &[vk::DescriptorPoolSize],
    layouts: &[vk::DescriptorSetLayout],
) -> Result<(vk::DescriptorPool, Vec<vk::DescriptorSet>), Error> {
    let info = vk::DescriptorPoolCreateInfo::default().max_sets(layouts.len() as u32).pool_sizes(sizes);
    // SAFETY: the device is valid by the contract of Context::new; the layouts are the passes'.
    unsafe {
        let pool = device.create_descriptor_pool(&info, None).call("vkCreateDescriptorPool")?;
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(layouts);
        match device.allocate_descriptor_sets(&info).call("vkAllocateDescriptorSets") {
            Ok(sets) => Ok((pool, sets)),
            Err(error) => {
                device.destroy_descriptor_pool(pool, None);
                Err(error)
            }
        }
    }
}
