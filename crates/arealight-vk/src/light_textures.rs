//! The lights' textures on the GPU: an array image with a layer for each, and the passes that filter them.

use crate::context::{COPIED, Context};
use crate::error::Error;
use crate::image::{Image, ImageInfo};
use crate::image_memory::image_memory;
use crate::limits::{TEXTURE_FORMAT as FORMAT, TEXTURE_USAGE as USAGE};
use crate::pass::ComputePass;
use crate::resource::Resource;
use arealight::gpu::TextureLoadConstants;
use arealight::kernels::{TEXTURE_KERNEL, TEXTURE_LOAD, TEXTURE_MIP, constant};
use arealight::pyramid::LAYERS;
use arealight::{PyramidSize, TexturePart};
use ash::vk;
use std::ops::Range;

/// The one layout of the image, from [`LightTextures::record_clear`] on.
///
/// A layout is that of all layers a descriptor sees, not of those that a shader reads: were a layer put into
/// another while it is filtered, no frame could shade with the others meanwhile.
const LAYOUT: vk::ImageLayout = vk::ImageLayout::GENERAL;

/// What becomes of a layer.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TextureUpdate {
    /// The layer that is replaced.
    pub layer: u32,
    /// A set that [`LightTextures::write_source_set`] pointed at the image.
    pub source_set: vk::DescriptorSet,
    /// Width and height of the image in texels, each from 1 to 4096.
    pub source_size: [u32; 2],
    /// The part of it that the layer shows, and the form of the light that it is for
    /// ([`TexturePart::shown_by`]).
    pub part: TexturePart,
    /// The image holds sRGB in a format that does not decode by itself, `R8G8B8A8_UNORM` for instance.
    pub decode_srgb: bool,
}

/// The array image of the lights' textures with its pyramid, and the passes that fill it. The host gives it
/// memory and descriptor sets:
///
/// 1. [`LightTextures::new`], 2. allocate for [`LightTextures::memory_requirements`], 3.
///    [`LightTextures::bind_memory`],
/// 4. allocate [`LightTextures::level_sets`] sets of [`LightTextures::level_set_layout`], once, and one for
///    each image ([`LightTextures::source_set_layout`]),
/// 5. [`LightTextures::write_level_sets`], 6. [`LightTextures::record_clear`].
///
/// From then on [`LightTextures::resource`] can be shaded with, and [`LightTextures::record_update`] replaces
/// layers.
///
/// # Frames in flight
/// An update writes the layers that it names and nothing else, and no layout ever changes. On one queue all
/// is ordered: the update waits for what was submitted before, and what comes later waits for it. Between
/// queues (of one family) the host orders by semaphore: an update of a layer after every frame that shades
/// with the layer, and before the next that does. Frames that shade with other layers may run meanwhile, so
/// that a video which alternates between two layers never waits.
///
/// Dropping it destroys the image, its views and the passes; the memory stays the host's.
#[derive(Debug)]
pub struct LightTextures {
    context: Context,
    size: PyramidSize,
    layers: u32,
    /// By what is needed. Their layouts are alike, so that a set made for one is for all.
    load: [ComputePass; 4],
    mip: ComputePass,
    /// Its sets are laid out as those of `mip`.
    kernel: ComputePass,
    image: Image,
}

impl LightTextures {
    /// Makes the image of `layers` layers, without memory, and the passes.
    ///
    /// # Safety
    /// The textures are dropped only when no recorded use of them is pending, and before the device is
    /// destroyed.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] where there is no layer, or the layers are larger or more than the device
    /// has; [`Error::MissingFeature`] where it cannot filter or store to their format; [`Error::Vulkan`]
    /// where a call fails.
    pub unsafe fn new(context: &Context, size: PyramidSize, layers: u32) -> Result<Self, Error> {
        check_size(context, size, layers)?;
        let pass = |kernel, constant| {
            // SAFETY: the same contract.
            unsafe { ComputePass::new(context, kernel, &[constant]) }
        };
        let load = |steps| pass(&TEXTURE_LOAD, (constant::LOAD_STEPS, steps));
        let load = [load(0)?, load(1)?, load(2)?, load(3)?];
        // SAFETY: the same contract.
        let of_levels = |kernel| unsafe { ComputePass::new(context, kernel, &[]) };
        let (mip, kernel) = (of_levels(&TEXTURE_MIP)?, of_levels(&TEXTURE_KERNEL)?);
        let side = size.side(0);
        let info = ImageInfo {
            name: "light textures",
            image_type: vk::ImageType::TYPE_2D,
            format: FORMAT,
            extent: [side, side, 1],
            levels: size.levels(),
            layers: LAYERS * layers,
            usage: USAGE,
        };
        // SAFETY: the same contract.
        let image = unsafe { Image::new(context, info) }?;
        Ok(Self { context: context.clone(), size, layers, load, mip, kernel, image })
    }

    image_memory!("arealight light textures");

    /// The size of every layer.
    pub fn size(&self) -> PyramidSize {
        self.size
    }

    /// Checks that the layer of every textured light is there, before lights are packed and uploaded: the
    /// pass does not know what will be bound.
    ///
    /// # Errors
    /// [`Error::Light`] names the first light whose layer is not.
    pub fn check_lights(&self, lights: &[arealight::Light]) -> Result<(), Error> {
        Ok(arealight::Light::check_texture_layers(lights, self.layers)?)
    }

    /// How many layers there are.
    pub fn layers(&self) -> u32 {
        self.layers
    }

    /// The image: [`PyramidSize::levels`] levels of [`PyramidSize::side`] texels a side in
    /// `R16G16B16A16_SFLOAT`, in layout `GENERAL` once it was cleared. It can be copied from, but not written
    /// to.
    pub fn image(&self) -> vk::Image {
        self.image.raw
    }

    /// The textures as a pass takes them. A null view before [`LightTextures::bind_memory`], which
    /// `write_set` refuses.
    pub fn resource(&self) -> Resource {
        Resource::FilteredImage { view: self.image.view, layout: LAYOUT }
    }

    /// The layout of a descriptor set for an image that is loaded.
    pub fn source_set_layout(&self) -> vk::DescriptorSetLayout {
        self.load[0].set_layout()
    }

    /// The layout of a descriptor set for a level.
    pub fn level_set_layout(&self) -> vk::DescriptorSetLayout {
        self.mip.set_layout()
    }

    /// How many sets there are for levels: one for each mip but the first, and one for each level of what
    /// lobes see.
    pub fn level_sets(&self) -> u32 {
        2 * self.size.levels() - 1
    }

    /// What the sets of all levels, [`LightTextures::level_sets`], take from the host's descriptor pool.
    pub fn level_pool_sizes(&self) -> Vec<vk::DescriptorPoolSize> {
        self.mip.pool_sizes(self.level_sets())
    }

    /// What the sets of `sources` images, at least one, take from the host's descriptor pool.
    pub fn source_pool_sizes(&self, sources: u32) -> Vec<vk::DescriptorPoolSize> {
        self.load[0].pool_sizes(sources)
    }

    /// Points a set at an image to load: a [`Resource::SampledImage`] with a 2D view, whose first level is
    /// read.
    ///
    /// # Safety
    /// - `set` was allocated with [`LightTextures::source_set_layout`] and no pending command buffer uses it.
    /// - The image's format is sampled as numbers, not as integers. It is valid, and stays so while recorded
    ///   work that uses the set is pending.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] where the resource is null or no sampled image, or the textures have no
    /// memory.
    pub unsafe fn write_source_set(&self, set: vk::DescriptorSet, source: Resource) -> Result<(), Error> {
        // SAFETY: the same contract; the level is ours.
        unsafe {
            self.load[0].write_set(set, &[source, Resource::StorageImage { view: self.image.level_view(0) }])
        }
    }

    /// Points the sets at the levels. Once is enough.
    ///
    /// # Safety
    /// Each of `sets` was allocated with [`LightTextures::level_set_layout`] and no pending command buffer
    /// uses it.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] where there are not [`LightTextures::level_sets`], or the textures have no
    /// memory.
    pub unsafe fn write_level_sets(&self, sets: &[vk::DescriptorSet]) -> Result<(), Error> {
        self.check_level_sets(sets)?;
        let levels = self.size.levels() as usize;
        let mips = (1..levels).map(|level| (self.image.level_view(level - 1), level));
        let kernels = (0..levels).map(|level| (self.image.view, level));
        for ((read, level), &set) in mips.chain(kernels).zip(sets) {
            let read = Resource::SampledImage { view: read, layout: LAYOUT };
            let written = Resource::StorageImage { view: self.image.level_view(level) };
            // SAFETY: the caller vouches for the set; the levels are ours.
            unsafe { self.mip.write_set(set, &[read, written]) }?;
        }
        Ok(())
    }

    /// Records that every layer becomes black, and the image's final layout. Needed once, before anything
    /// else.
    ///
    /// # Safety
    /// - `command_buffer` is recording, outside a render pass, on a queue with graphics or compute.
    /// - [`LightTextures::bind_memory`] was called.
    pub unsafe fn record_clear(&self, command_buffer: vk::CommandBuffer) {
        let device = &self.context.device;
        let unused = (vk::ImageLayout::UNDEFINED, vk::AccessFlags::NONE);
        let first_use = self.image.barrier(unused, (LAYOUT, vk::AccessFlags::TRANSFER_WRITE));
        let black = vk::ClearColorValue { float32: [0.0, 0.0, 0.0, 1.0] };
        // SAFETY: the caller vouches for the command buffer; the image is ours and has memory.
        unsafe {
            // After whatever used an earlier content
            self.context.record_images(
                command_buffer,
                (vk::PipelineStageFlags::ALL_COMMANDS, vk::PipelineStageFlags::TRANSFER),
                &[first_use],
            );
            device.cmd_clear_color_image(
                command_buffer,
                self.image.raw,
                LAYOUT,
                &black,
                &[self.image.range()],
            );
            let used = (vk::PipelineStageFlags::ALL_COMMANDS, READ | WRITE);
            self.context.record_barrier(command_buffer, COPIED, used);
        }
    }

    /// Records that layers are loaded and filtered, with the barriers between and around: afterwards they are
    /// visible to shaders. The cost is that of the layers given; others are left alone. The layers are
    /// filtered side by side, level by level, and those with consecutive numbers in one dispatch.
    ///
    /// # Safety
    /// - `command_buffer` is recording, outside a render pass, on a queue with compute, and
    ///   [`LightTextures::record_clear`] was recorded before.
    /// - `level_sets` were written by [`LightTextures::write_level_sets`], and each update's set by
    ///   [`LightTextures::write_source_set`], with an image of the size that the update says.
    /// - The images are in the layout given there, and visible to compute shaders.
    /// - Work on other queues that uses these layers is ordered by the host, as said above.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] where a layer is not there or is given twice, or sets are missing;
    /// [`Error::TexturePart`] for a source that cannot be loaded; [`Error::Destroyed`] (in debug builds)
    /// where a set points at light textures that are gone. Then nothing is recorded.
    pub unsafe fn record_update(
        &self,
        command_buffer: vk::CommandBuffer,
        level_sets: &[vk::DescriptorSet],
        updates: &[TextureUpdate],
    ) -> Result<(), Error> {
        // Check all before anything is recorded
        self.check_level_sets(level_sets)?;
        for set in level_sets.iter().copied().chain(updates.iter().map(|update| update.source_set)) {
            self.context.written_sets.check(set)?;
        }
        let (layers, constants) = self.check_updates(updates)?;
        if updates.is_empty() {
            return Ok(());
        }

        // SAFETY: the caller vouches for the command buffer and the sets, here and below.
        let _label = unsafe { self.context.names.label(command_buffer, c"arealight light textures") };
        // SAFETY: as above.
        let barrier = |before, after| unsafe { self.context.record_barrier(command_buffer, before, after) };
        let compute = vk::PipelineStageFlags::COMPUTE_SHADER;
        let everything = vk::PipelineStageFlags::ALL_COMMANDS;

        // Load level 0, after whatever used the layers before
        barrier((everything, WRITE), (compute, READ | WRITE));
        for (update, constants) in updates.iter().zip(&constants) {
            let groups = TEXTURE_LOAD.groups_for([self.size.side(0), self.size.side(0), 1]);
            let pass = &self.load[constants.steps() as usize];
            let bytes = bytemuck::bytes_of(constants);
            // SAFETY: as above.
            unsafe { pass.record(command_buffer, update.source_set, bytes, groups) }?;
        }
        // Make each mip from the one before
        let (mips, kernels) = level_sets.split_at(self.size.levels() as usize - 1);
        for (level, &set) in (1..).zip(mips) {
            barrier((compute, WRITE), (compute, READ));
            for run in &layers {
                let side = self.size.side(level);
                let groups = TEXTURE_MIP.groups_for([side, side, run.end - run.start]);
                // SAFETY: as above.
                unsafe { self.mip.record(command_buffer, set, bytemuck::bytes_of(&run.start), groups) }?;
            }
        }
        // What lobes see, from coarse to fine
        for (level, &set) in (0..self.size.levels()).zip(kernels).rev() {
            for update in updates {
                // Each sees all levels, so that one waits for another of the same, too
                barrier((compute, WRITE), (compute, READ));
                let TexturePart { aspect, is_ellipse, .. } = update.part;
                let constants = [update.layer, level, aspect.to_bits(), u32::from(is_ellipse)];
                let blocks = self.size.side(level).div_ceil(2);
                let groups = TEXTURE_KERNEL.groups_for([blocks, blocks, 1]);
                let bytes = bytemuck::bytes_of(&constants);
                // SAFETY: as above.
                unsafe { self.kernel.record(command_buffer, set, bytes, groups) }?;
            }
        }
        barrier((compute, WRITE), (everything, READ));
        Ok(())
    }

    fn check_level_sets(&self, sets: &[vk::DescriptorSet]) -> Result<(), Error> {
        if sets.len() == self.level_sets() as usize {
            return Ok(());
        }
        let message = format!("{} given, but there must be {}", sets.len(), self.level_sets());
        Err(Error::InvalidArgument { field: "level_sets", message })
    }

    /// The layers of the updates, as ranges of consecutive ones, and their constants.
    pub(crate) fn check_updates(
        &self,
        updates: &[TextureUpdate],
    ) -> Result<(Vec<Range<u32>>, Vec<TextureLoadConstants>), Error> {
        let constants = updates.iter().map(|update| self.load_constants(update)).collect::<Result<_, _>>()?;
        Ok((self.runs_of_layers(updates)?, constants))
    }

    fn runs_of_layers(&self, updates: &[TextureUpdate]) -> Result<Vec<Range<u32>>, Error> {
        let wrong = |message| Err(Error::InvalidArgument { field: "layer", message });
        let mut layers: Vec<u32> = updates.iter().map(|update| update.layer).collect();
        layers.sort_unstable();
        if let Some(layer) = layers.iter().find(|layer| **layer >= self.layers) {
            return wrong(format!("{layer} is not there: the light textures have {}", self.layers));
        }
        if let Some([twice, _]) = layers.windows(2).find(|pair| pair[0] == pair[1]) {
            return wrong(format!("{twice} is given twice; give it once a recording"));
        }
        let runs = layers.chunk_by(|one, next| one + 1 == *next);
        Ok(runs.map(|run| run[0]..run[run.len() - 1] + 1).collect())
    }

    fn load_constants(&self, update: &TextureUpdate) -> Result<TextureLoadConstants, Error> {
        let TextureUpdate { layer, source_size, part, decode_srgb, .. } = *update;
        part.load_constants(source_size, self.size, layer, decode_srgb)
            .map_err(|error| Error::TexturePart { layer, error })
    }
}

const READ: vk::AccessFlags = vk::AccessFlags::SHADER_READ;
const WRITE: vk::AccessFlags = vk::AccessFlags::SHADER_WRITE;

/// Whether the device has such an image.
fn check_size(context: &Context, size: PyramidSize, layers: u32) -> Result<(), Error> {
    let Some(limits) = context.light_texture_limits else {
        return Err(Error::MissingFeature {
            feature: "R16G16B16A16_SFLOAT images that are filtered and stored to",
            needed_by: "light textures",
        });
    };
    let (side, [widest, highest]) = (size.side(0), limits.extent);
    if side > widest.min(highest) {
        let message = format!(
            "{side} x {side} texels, but the device's largest image has {widest} x {highest}; take a smaller \
            size"
        );
        return Err(Error::InvalidArgument { field: "size", message });
    }
    if layers == 0 || layers > limits.layers / LAYERS {
        let message = format!("{layers} must be from 1 to a quarter of the device's {}", limits.layers);
        return Err(Error::InvalidArgument { field: "layers", message });
    }
    Ok(())
}
