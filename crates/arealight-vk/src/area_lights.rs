//! All that shading by area lights needs, in one object that owns it.

mod history;
mod place;
mod textures;

use crate::context::{COPIED, Context, USED, WRITTEN};
use crate::error::Error;
use crate::frame::ShadeFrame;
use crate::light_textures::TextureUpdate;
use crate::medium::{MediumFrame, MediumPass, MediumPassInfo};
use crate::memory::{Buffer, Memory, SharedAllocator, holding, mapped};
use crate::resource::Resource;
use crate::shade::{Bound, ShadePass, ShadePassInfo, ShadeResources};
use crate::shadows::{ShadowFrame, ShadowOptions, ShadowPass, ShadowPassInfo};
use crate::table_image::{TableFormat, TableImage};
use crate::view::{check_whole, view_of};
use arealight::plan::{MediumOptions, Output, ShadeOptions, ShadowFilter, ShadowHistory, TileOptions};
use arealight::{Blockers, Light, LightSummary, LightTable, PackedLights, PyramidSize};
use ash::vk;
use bytemuck::cast_slice;
use glam::{DVec3, Vec3};
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::Allocator;
use history::History;
use place::{Place, descriptor_sets, place_of};
use std::sync::{Arc, Mutex};
use textures::Textures;

/// What [`AreaLights`] are made of.
#[derive(Debug, Clone, PartialEq)]
pub struct AreaLightsInfo {
    /// How the host's surfaces are stored and shaded. With [`ShadeOptions::shadow_rays`] there are shadows,
    /// of [`AreaLights::set_blockers`].
    pub options: ShadeOptions,
    /// Lists of lights for tiles of the picture, for scenes of many lights.
    pub tiles: Option<TileOptions>,
    /// How shadow rays are filtered.
    pub shadow_filter: ShadowFilter,
    /// Of how many frames' rays a mean is made before, until [`AreaLights::forget_shadows`]; each frame has
    /// its [`ShadeFrame::position_from_clip`].
    pub shadow_history: ShadowHistory,
    /// A medium before the picture: one image, whole, of a perspective camera, with one sample a pixel. Rays
    /// need [`ShadeOptions::shadow_rays`]. Depth, format and quality are taken from
    /// [`AreaLightsInfo::options`], and size, camera, matrix, lights and seed from each frame.
    pub medium: Option<(MediumOptions, MediumFrame)>,
    /// How many frames the host may have recorded that are not done yet.
    pub frames_in_flight: usize,
    /// The table of lobes.
    pub table: LightTable,
    /// Its format on the GPU.
    pub table_format: TableFormat,
    /// Size and number of the layers for images on lights; none where no light has one.
    pub textures: Option<(PyramidSize, u32)>,
}

impl Default for AreaLightsInfo {
    /// [`ShadeOptions::default`] with the built-in table, two frames in flight, and nothing else.
    fn default() -> Self {
        Self {
            options: ShadeOptions::default(),
            tiles: None,
            shadow_filter: ShadowFilter::default(),
            shadow_history: ShadowHistory::Off,
            medium: None,
            frames_in_flight: 2,
            table: LightTable::ggx(),
            table_format: TableFormat::default(),
            textures: None,
        }
    }
}

/// The passes with all that they need: table, buffers of lights, descriptor sets, lists of tiles, light
/// textures, and what shadows take. Three calls make a picture: [`AreaLights::new`], then
/// [`AreaLights::shade`] in each frame, and at the end the drop.
///
/// One is for one view: each frame of it is one call. The recorder below ([`ShadePass`], [`ShadowPass`]) is
/// for hosts that own all this themselves.
///
/// # Frames in flight
/// Every frame has a *place*, from 0 to before [`AreaLightsInfo::frames_in_flight`]. What a place has is
/// written when its next frame is recorded, so that the host waits for the one before, as it does for its own
/// command buffer. What is recorded is submitted to one queue, in the order in which it was recorded. Buffers
/// grow when a frame has more lights or pixels than the one before at its place.
pub struct AreaLights {
    shade: ShadePass,
    shadow: Option<ShadowPass>,
    medium: Option<(MediumPass, MediumFrame)>,
    places: Vec<Place>,
    textures: Option<Textures>,
    table: (TableImage, Memory),
    lobe_horizons: Buffer,
    blockers: Option<Arc<[Buffer; 2]>>,
    /// What blockers are relative to, where there are any.
    blockers_origin: Option<DVec3>,
    history: Option<History>,
    /// What the table and blockers are copied from by the next frame, until it was recorded.
    new_table: Option<Arc<Buffer>>,
    new_blockers: Option<Arc<[Buffer; 2]>>,
    pool: vk::DescriptorPool,
    options: ShadeOptions,
    seed: u32,
    allocator: SharedAllocator,
    context: Context,
}

impl std::fmt::Debug for AreaLights {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("AreaLights").field("options", &self.options).finish_non_exhaustive()
    }
}

impl AreaLights {
    /// Makes all that does not depend on the size of pictures.
    ///
    /// # Safety
    /// - As [`Context::new`]. The allocator is of the same device.
    /// - It is dropped when no recorded commands are pending, before the device is destroyed.
    ///
    /// # Errors
    /// As [`Context::new`], [`ShadePass::new`], [`ShadowPass::new`], [`MediumPass::new`] and
    /// [`LightTextures::new`](crate::LightTextures::new); [`Error::InvalidArgument`] where there is no frame
    /// in flight, or no shadow rays but a medium's or a history; [`Error::Vulkan`] where memory is out.
    pub unsafe fn new(
        instance: &ash::Instance,
        physical_device: vk::PhysicalDevice,
        device: &ash::Device,
        allocator: Arc<Mutex<Allocator>>,
        info: &AreaLightsInfo,
    ) -> Result<Self, Error> {
        // SAFETY: the same contract.
        unsafe { Self::of_context(&Context::new(instance, physical_device, device)?, allocator, info) }
    }

    /// As [`AreaLights::new`], on a context with a pipeline cache, names for debuggers or whole modules.
    ///
    /// # Safety
    /// As [`AreaLights::new`].
    ///
    /// # Errors
    /// As [`AreaLights::new`].
    pub unsafe fn of_context(
        context: &Context,
        allocator: Arc<Mutex<Allocator>>,
        info: &AreaLightsInfo,
    ) -> Result<Self, Error> {
        let (table, frames) = (&info.table, info.frames_in_flight);
        if frames == 0 {
            let message = "is 0, but a frame that is recorded is in flight".into();
            return Err(Error::InvalidArgument { field: "frames_in_flight", message });
        }
        let has_rays = info.medium.is_some_and(|(medium, _)| medium.shadow_rays);
        if (has_rays || info.shadow_history != ShadowHistory::Off) && info.options.shadow_rays == 0 {
            let message = "is 0, but the medium has rays, or shadows a history: 1 will do".into();
            return Err(Error::InvalidArgument { field: "shadow_rays", message });
        }
        if info.medium.is_some() {
            let ShadeOptions { orthographic, separate_lobes, .. } = info.options;
            let others = [(orthographic, "orthographic"), (separate_lobes, "separate_lobes")];
            check_whole(info.options, &others, "a medium is before one image of a perspective camera,")?;
        }
        let allocator = SharedAllocator(allocator);
        // SAFETY: the same contract, throughout.
        unsafe {
            let (shade, shadow) = passes(context, info)?;
            let medium = info.medium.map(|(medium, frame)| {
                let ShadeOptions { from_depth, format, quality, .. } = info.options;
                let options = MediumOptions { by_image: false, from_depth, format, quality, ..medium };
                let info = MediumPassInfo { options, ..MediumPassInfo::default() };
                Ok::<_, Error>((MediumPass::new(context, info)?, frame))
            });
            let mut image = TableImage::new(context, table, info.table_format)?;
            let memory = allocator.keep(image.allocate(&mut allocator.lock())?);
            let texels = mapped(context, &allocator, &image.bytes(table))?;
            // Tiles alone read them, and they take half a second
            let of_lobes = |_| table.lobe_horizons(info.options.quality.specular_lobes);
            let horizons = info.tiles.map_or_else(Vec::new, of_lobes);
            let lobe_horizons = mapped(context, &allocator, cast_slice(&horizons))?;
            let textures = info.textures.map(|size| Textures::new(context, &allocator, size, frames));
            // From here on dropping it destroys what it has
            let mut made = Self {
                shade,
                shadow,
                medium: medium.transpose()?,
                places: vec![],
                textures: textures.transpose()?,
                table: (image, memory),
                lobe_horizons,
                blockers: None,
                blockers_origin: None,
                history: None,
                new_table: Some(Arc::new(texels)),
                new_blockers: None,
                pool: vk::DescriptorPool::null(),
                options: info.options,
                seed: 0,
                allocator,
                context: context.clone(),
            };
            made.make_places(frames)?;
            if made.shadow.is_some()
                && let Ok(nothing) = Blockers::new(&[])
            {
                made.set_blockers(&nothing, DVec3::ZERO)?;
            }
            Ok(made)
        }
    }

    /// # Safety
    /// As [`AreaLights::new`].
    unsafe fn make_places(&mut self, frames: usize) -> Result<(), Error> {
        let count = frames as u32;
        let mut layouts = vec![self.shade.set_layout()];
        let mut sizes = self.shade.pool_sizes(count);
        if let Some(shadow) = &self.shadow {
            layouts.push(shadow.set_layout());
            sizes.extend(shadow.pool_sizes(count));
        }
        if let Some((medium, _)) = &self.medium {
            layouts.push(medium.set_layout());
            sizes.extend(medium.pool_sizes(count));
        }
        let sets;
        (self.pool, sets) = descriptor_sets(&self.context, &sizes, &layouts.repeat(frames))?;
        for sets in sets.chunks(layouts.len()) {
            // SAFETY: the same contract.
            self.places.push(unsafe { Place::new(&self.context, &self.allocator, sets.to_vec()) }?);
        }
        Ok(())
    }

    /// The pass that shades.
    pub fn shade_pass(&self) -> &ShadePass {
        &self.shade
    }

    /// Makes the pipelines of frames with such lights and such a view, before [`AreaLights::shade`] does.
    ///
    /// # Errors
    /// As [`AreaLights::shade`].
    pub fn prepare(&self, lights: &[Light], view: &ShadeFrame) -> Result<(), Error> {
        self.prepare_for(PackedLights::new(lights, DVec3::ZERO)?.summary(), view)
    }

    fn prepare_for(&self, lights: LightSummary, view: &ShadeFrame) -> Result<(), Error> {
        let any = Some(Resource::buffer(self.lobe_horizons.raw));
        self.shade.prepare(&ShadeFrame { lights, tile_lists: any, ..*view })?;
        self.shadow.iter().try_for_each(|shadow| shadow.prepare(lights))?;
        self.medium.iter().try_for_each(|(medium, _)| medium.prepare(lights))
    }

    /// The medium of the next frame, where [`AreaLightsInfo::medium`] has one.
    pub fn medium_mut(&mut self) -> Option<&mut MediumFrame> {
        self.medium.as_mut().map(|(_, frame)| frame)
    }

    /// In which stages, and how, the host's images are used: what the host's barriers around
    /// [`AreaLights::shade`] are made of.
    pub fn stages_and_access(&self) -> (vk::PipelineStageFlags, vk::AccessFlags) {
        self.shade.stages_and_access()
    }

    /// What blocks shadow rays from the next frame on, relative to `origin`, which those frames have, too: by
    /// default nothing. So where there are shadows, let the origin stay while the camera moves.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] where there are no shadows: see [`ShadeOptions::shadow_rays`];
    /// [`Error::Vulkan`] where memory is out.
    pub fn set_blockers(&mut self, blockers: &Blockers, origin: DVec3) -> Result<(), Error> {
        if self.shadow.is_none() {
            let message = "are given, but ShadeOptions::shadow_rays is 0".into();
            return Err(Error::InvalidArgument { field: "blockers", message });
        }
        let arrays: [&[u8]; 2] = [cast_slice(&blockers.nodes), cast_slice(&blockers.triangles)];
        let pair = |location| {
            // SAFETY: places that use the buffers keep them.
            let made = |bytes| unsafe { holding(&self.context, &self.allocator, bytes, location) };
            Ok::<_, Error>(Arc::new([made(arrays[0])?, made(arrays[1])?]))
        };
        let (on_device, staging) = (pair(MemoryLocation::GpuOnly)?, pair(MemoryLocation::CpuToGpu)?);
        self.blockers_origin = (!blockers.triangles.is_empty()).then_some(origin);
        (self.blockers, self.new_blockers) = (Some(on_device), Some(staging));
        Ok(())
    }

    /// Begins [`AreaLightsInfo::shadow_history`] anew with the next frame, as after a cut. Another size of
    /// picture does, too.
    pub fn forget_shadows(&mut self) {
        if let Some(history) = &mut self.history {
            history.before = None;
        }
    }

    /// Records that images are loaded into layers of the light textures, for the frame at `place`, before
    /// [`AreaLights::shade`]. Each update comes with its image, a
    /// [`Resource::SampledImage`]; [`TextureUpdate::source_set`] does not count.
    ///
    /// # Safety
    /// As [`LightTextures::record_update`](crate::LightTextures::record_update), but for its sets; the frame
    /// before at this place is done. The commands are those of the frame's [`AreaLights::shade`].
    ///
    /// # Errors
    /// As [`LightTextures::record_update`](crate::LightTextures::record_update); [`Error::InvalidArgument`]
    /// where there are no light textures, or no such place.
    pub unsafe fn load_textures(
        &mut self,
        command_buffer: vk::CommandBuffer,
        place: usize,
        updates: &[(Resource, TextureUpdate)],
    ) -> Result<(), Error> {
        let Some(textures) = &mut self.textures else {
            let message = "is none in AreaLightsInfo, but a texture is loaded".into();
            return Err(Error::InvalidArgument { field: "textures", message });
        };
        // SAFETY: the same contract.
        unsafe { textures.load(command_buffer, place, updates) }
    }

    /// Records a frame, between the host's barriers: see [`AreaLights::stages_and_access`].
    ///
    /// `lights` are in the world, and the positions of the G-buffer relative to `origin`, a place near the
    /// camera or the world's own. Of `view`, sizes, camera and matrix count; lights, seed and lists of tiles
    /// are ours. `g_buffer` has the host's images (light textures too, without [`AreaLightsInfo::textures`]);
    /// table, lights and buffers are ours. They may be others, and of another size, in each frame.
    ///
    /// # Safety
    /// - `command_buffer` is recording, outside a render pass, on a queue with compute; it is submitted
    ///   unless an error is returned. So acquire the image of a swapchain before: it may be out of date.
    /// - The frame before at this place is done.
    /// - The images are valid, of the view's size at least, and stay so until the frame is done.
    ///
    /// # Errors
    /// [`Error::Light`] names the light that is wrong, [`Error::InvalidArgument`] the field or resource;
    /// [`Error::Vulkan`] where memory is out or a pipeline cannot be made. Then the commands are not to be
    /// submitted.
    pub unsafe fn shade(
        &mut self,
        command_buffer: vk::CommandBuffer,
        place: usize,
        lights: &[Light],
        origin: DVec3,
        view: &ShadeFrame,
        g_buffer: &ShadeResources,
    ) -> Result<(), Error> {
        // SAFETY: the same contract.
        let recorded = unsafe { self.record(command_buffer, place, (lights, origin), view, g_buffer) };
        if let Some(textures) = &mut self.textures {
            textures.settle(place, recorded.is_ok());
        }
        recorded?;
        (self.new_table, self.new_blockers) = (None, None);
        if let Some(history) = &mut self.history {
            history.before = Some(origin);
        }
        self.seed = self.seed.wrapping_add(1);
        Ok(())
    }

    /// # Safety
    /// As [`AreaLights::shade`].
    unsafe fn record(
        &mut self,
        command_buffer: vk::CommandBuffer,
        place: usize,
        (lights, origin): (&[Light], DVec3),
        view: &ShadeFrame,
        g_buffer: &ShadeResources,
    ) -> Result<(), Error> {
        // Check, and make what is missing
        if let Some(textures) = &self.textures {
            textures.check_lights(lights)?;
        }
        if let Some(there) = self.blockers_origin
            && there != origin
        {
            let message = format!("is {origin}, but blockers are relative to {there}: set them again");
            return Err(Error::InvalidArgument { field: "origin", message });
        }
        let packed = PackedLights::new(lights, origin)?;
        self.prepare_for(packed.summary(), view)?;
        let place = place_of(&mut self.places, place)?;
        let (context, allocator) = (&self.context, &self.allocator);
        // SAFETY: the frame before at this place is done, so nothing uses what it has.
        unsafe {
            place.write_lights(context, allocator, &packed)?;
            let froxels = self.medium.as_ref().map(|(_, medium)| medium.froxels);
            place.fit(context, allocator, (&self.shade, self.options), (view.size, froxels))?;
        }
        let has_history = self.shadow.as_ref().is_some_and(ShadowPass::has_history);
        if has_history && self.history.as_ref().is_none_or(|history| history.size != view.size) {
            // SAFETY: places whose frames use the one before keep it.
            self.history = Some(unsafe { History::new(context, allocator, view.size) }?);
        }
        let resources = ShadeResources {
            table: self.table.0.resource(),
            light_textures: self.textures.as_ref().map(Textures::resource).or(g_buffer.light_textures),
            lobe_horizons: Some(Resource::buffer(self.lobe_horizons.raw)),
            ..place.resources(g_buffer)
        };
        let frame = ShadeFrame {
            lights: packed.summary(),
            tile_lists: resources.tile_lists,
            seed: self.seed,
            ..*view
        };
        // SAFETY: as above; the resources are the host's, and ours.
        unsafe { self.shade.write_set(place.sets[0], &resources) }?;
        let shadows = match (&self.shadow, &self.blockers) {
            (Some(shadow), Some(blockers)) => {
                let of_shadows = place.shadow_resources(g_buffer, blockers, self.history.as_ref());
                // SAFETY: as above.
                unsafe { shadow.write_set(place.sets[1], &resources, &of_shadows) }?;
                Some((shadow, of_shadows))
            }
            _ => None,
        };
        let medium = self.medium.as_ref().map(|(medium, given)| {
            if view.position_from_clip.is_none() || view.rows.is_some() {
                let field = if view.rows.is_some() { "rows" } else { "position_from_clip" };
                let message = "is not that of a whole picture before which a medium is".into();
                return Err(Error::InvalidArgument { field, message });
            }
            let position_from_clip = view_of(self.options, view)?.position_from_clip;
            let (size, camera, lights, seed) = (view.size, view.camera, frame.lights, self.seed);
            let frame = MediumFrame { size, camera, position_from_clip, lights, seed, ..*given };
            let set = place.sets[place.sets.len() - 1];
            let seen = ShadeResources { radiance: g_buffer.radiance, ..resources };
            // SAFETY: as above.
            unsafe { medium.write_set(set, &seen, &place.medium_resources()) }?;
            Ok::<_, Error>((medium, set, frame))
        });
        let medium = medium.transpose()?;

        // Record what the frame reads, and the passes
        // SAFETY: the same contract.
        unsafe {
            place.staging = (self.new_table.clone(), self.new_blockers.clone());
            if let Some(staging) = &self.new_table {
                self.table.0.record_upload(command_buffer, staging.raw, 0);
            }
            if let (Some(staging), Some(blockers)) = (&self.new_blockers, &self.blockers) {
                for (from, to) in staging.iter().zip(blockers.iter()) {
                    let all = vk::BufferCopy::default().size(from.size);
                    context.device.cmd_copy_buffer(command_buffer, from.raw, to.raw, &[all]);
                }
                context.record_barrier(command_buffer, COPIED, USED);
            }
            if let Some(textures) = &mut self.textures {
                textures.clear_once(command_buffer);
            }
            place.record_layouts(context, command_buffer);
            self.shade.record(command_buffer, place.sets[0], &frame)?;
            if let Some((shadow, of_shadows)) = shadows {
                context.record_barrier(command_buffer, WRITTEN, USED);
                let mut frame = ShadowFrame { shade: &frame, origin_shift: Vec3::ZERO };
                if let Some(history) = &self.history {
                    history.record_beginning(context, command_buffer);
                    frame.origin_shift = history.origin_shift(origin);
                }
                shadow.record(command_buffer, Bound::Set(place.sets[1]), &of_shadows, &frame)?;
            }
            if let Some((medium, set, frame)) = medium {
                context.record_barrier(command_buffer, WRITTEN, USED);
                medium.record(command_buffer, set, &frame)?;
            }
        }
        Ok(())
    }
}

impl Drop for AreaLights {
    fn drop(&mut self) {
        // SAFETY: by the contract of AreaLights::new no recorded use is pending and the device is alive; a
        // null pool is ignored.
        unsafe { self.context.device.destroy_descriptor_pool(self.pool, None) };
    }
}

/// The passes: with shadows that which shades overwrites an image of its own, and the other has the host's
/// output.
///
/// # Safety
/// As [`AreaLights::new`].
unsafe fn passes(context: &Context, info: &AreaLightsInfo) -> Result<(ShadePass, Option<ShadowPass>), Error> {
    let (with_shadows, host) = (info.options.shadow_rays > 0, info.options);
    let options = if with_shadows { ShadeOptions { output: Output::Overwrite, ..host } } else { host };
    let (tiles, table_size) = (info.tiles, info.table.size());
    // SAFETY: the same contract; the modules are the kernels'.
    unsafe {
        let shade = ShadePass::new(context, ShadePassInfo { tiles, table_size, ..options.into() })?;
        if !with_shadows {
            return Ok((shade, None));
        }
        let (filter, history) = (info.shadow_filter, info.shadow_history);
        let shadows = ShadowOptions { filter, history, output: host.output };
        let shadow =
            ShadowPass::new(context, ShadowPassInfo { options, shadows, ..ShadowPassInfo::default() })?;
        Ok((shade, Some(shadow)))
    }
}
