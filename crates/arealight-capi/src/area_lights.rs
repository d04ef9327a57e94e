//! All that shading needs, in one object that owns it.

use crate::constants::AREALIGHT_DESCRIPTORS_SETS;
use crate::device::{open, read_host, read_table};
use crate::failure::{ArealightResult, Failure, call};
use crate::lights::{read_lights, read_origin};
use crate::medium::{ArealightMediumFrame, ArealightMediumOptions, medium_frame, medium_options};
use crate::options::{level, shade_options, tile_options};
use crate::pass::{read_frame_of, read_resources};
use crate::shadows::{ArealightBlockers, FILTERS, HISTORIES};
use crate::types::{
    ArealightBuffer, ArealightFrame, ArealightHost, ArealightLight, ArealightLightSummary,
    ArealightPassOptions, ArealightResources, ArealightTable,
};
use crate::{arguments, handles};
use arealight_vk::ash::vk::{self, Handle as _};
use arealight_vk::gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use arealight_vk::gpu_allocator::{AllocationSizes, AllocatorDebugSettings};
use arealight_vk::{AreaLights, AreaLightsInfo, Resource, ShadeFrame};
use std::ffi::c_void;
use std::ptr::null_mut;
use std::sync::{Arc, Mutex};

/// What arealight_area_lights_create makes. All zero is both lobes at the exact level, two frames in flight.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct ArealightAreaLightsInfo {
    /// How surfaces are stored and shaded; `descriptors` and `module` are 0.
    pub options: ArealightPassOptions,
    /// As of arealight_create.
    pub table: *const ArealightTable,
    /// A medium before the picture, which arealight_area_lights_set_medium says more of before the first
    /// frame; its `by_image` and `module` are 0. Null is none.
    pub medium: *const ArealightMediumOptions,
    /// How many frames may be recorded that are not done yet, at most 8. 0 is 2.
    pub frames_in_flight: u32,
    /// With shadow rays, one of AREALIGHT_SHADOW_FILTER_*.
    pub shadow_filter: u32,
    /// With shadow rays, one of AREALIGHT_SHADOW_HISTORY_*.
    pub shadow_history: u32,
    /// 0
    pub reserved: u32,
}

/// The passes of one view with all that they need: table, buffers of lights, descriptor sets, lists of tiles,
/// what shadows take, and memory, in blocks of 4 MiB or more. A host that makes none has only its code.
pub struct ArealightAreaLights {
    inner: Mutex<AreaLights>,
}

/// How many frames are in flight, by ArealightAreaLightsInfo.frames_in_flight.
const FRAMES: [usize; 9] = [2, 1, 2, 3, 4, 5, 6, 7, 8];

/// Makes all that does not depend on the size of pictures. `info` may be null: zeros. `*out` is the host's to
/// destroy.
///
/// # Safety
/// As arealight_create.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_area_lights_create(
    host: *const ArealightHost,
    info: *const ArealightAreaLightsInfo,
    out: *mut *mut ArealightAreaLights,
) -> ArealightResult {
    // SAFETY: the caller vouches for pointers and handles; the device outlives what is made.
    call(|| unsafe {
        arguments::write(out, null_mut(), "out")?;
        let (host, info) = (read_host(host)?, read_info(info)?);
        let (instance, physical_device, device, context) = open(host)?;
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance,
            device,
            physical_device,
            debug_settings: AllocatorDebugSettings::default(),
            buffer_device_address: false,
            // The least: what is larger has a block of its own
            allocation_sizes: AllocationSizes::new(0, 0),
        });
        let failed = |error| Failure::new(ArealightResult::ErrorVulkan, format!("memory: {error}"));
        let allocator = Arc::new(Mutex::new(allocator.map_err(failed)?));
        let inner = Mutex::new(AreaLights::of_context(&context, allocator, &info)?);
        arguments::write(out, handles::give(ArealightAreaLights { inner }), "out")
    })
}

/// # Safety
/// `info` is null or valid.
unsafe fn read_info(info: *const ArealightAreaLightsInfo) -> Result<AreaLightsInfo, Failure> {
    if info.is_null() {
        return Ok(AreaLightsInfo::default());
    }
    // SAFETY: the same contract, here and below.
    let info = unsafe { arguments::read(info, "info") }?;
    if info.options.descriptors != AREALIGHT_DESCRIPTORS_SETS || !info.options.module.words.is_null() {
        let why = "must be 0, since the library has sets and modules of its own";
        return Err(Failure::argument(format!("options.descriptors and options.module: {why}")));
    }
    arguments::refuse_reserved(info.reserved, "info.reserved")?;
    let options = shade_options(&info.options)?;
    // SAFETY: as above.
    let (table, table_format) = unsafe { read_table(info.table) }?;
    // SAFETY: as above.
    let medium = (!info.medium.is_null()).then(|| unsafe { arguments::read(info.medium, "info.medium") });
    let medium = medium.transpose()?.map(|medium| {
        if medium.by_image != 0 || !medium.module.words.is_null() {
            let why = "must be 0, since the medium is even and has a module of its own";
            return Err(Failure::argument(format!("medium.by_image and medium.module: {why}")));
        }
        let nothing = medium_frame(&ShadeFrame::default(), &ArealightMediumFrame::default());
        Ok((medium_options(options, medium)?, nothing))
    });
    Ok(AreaLightsInfo {
        options,
        tiles: tile_options(&info.options),
        shadow_filter: level(info.shadow_filter, &FILTERS, "info.shadow_filter")?,
        shadow_history: level(info.shadow_history, &HISTORIES, "info.shadow_history")?,
        medium: medium.transpose()?,
        frames_in_flight: level(info.frames_in_flight, &FRAMES, "info.frames_in_flight")?,
        table,
        table_format,
        ..AreaLightsInfo::default()
    })
}

/// Records a frame into a VkCommandBuffer: lights, which are packed and uploaded, table, passes, and the
/// barriers between. Images are used in the compute stage; barriers before and after are the host's.
///
/// Frames in flight have a `place` each, from 0 to before ArealightAreaLightsInfo.frames_in_flight. Lights
/// are in world positions, and the positions of the G-buffer relative to `origin` (three numbers). Of `frame`
/// `lights`, `seed` and `tile_lists` are not read; of `resources` all images are, with
/// arealight_textures_image where lights are textured, but of the buffers `light_counts` alone. All may be
/// others in each frame. Where it fails, the commands must not be submitted.
///
/// # Safety
/// Pointers are null or valid, with as many items as their counts say. The command buffer is being recorded,
/// outside a render pass; it is submitted to one queue, which computes, in the order of the calls. The frame
/// before at this place is done. The images are of the frame's size and outlive the commands.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_area_lights_shade(
    area_lights: *mut ArealightAreaLights,
    command_buffer: *mut c_void,
    place: u32,
    lights: *const ArealightLight,
    light_count: u32,
    origin: *const f64,
    frame: *const ArealightFrame,
    resources: *const ArealightResources,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers, the command buffer and the images.
    call(|| unsafe {
        let mut area_lights = handles::lock(&handles::borrow(area_lights, "area_lights")?.inner);
        arguments::refuse_null([(command_buffer.is_null(), "command_buffer")])?;
        let lights = read_lights(lights, light_count)?;
        let origin = read_origin(origin)?;
        let frame = ArealightFrame {
            lights: ArealightLightSummary::default(),
            seed: 0,
            tile_lists: ArealightBuffer::default(),
            ..*arguments::read(frame, "frame")?
        };
        let frame = read_frame_of(area_lights.shade_pass(), &frame)?;
        let images = read_resources(Resource::default(), arguments::read(resources, "resources")?)?;
        let commands = vk::CommandBuffer::from_raw(command_buffer as u64);
        Ok(area_lights.shade(commands, place as usize, &lights, origin, &frame, &images)?)
    })
}

/// Says what blocks shadow rays from the next frame on, relative to an origin which those frames have, too:
/// by default nothing. It is copied.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_area_lights_set_blockers(
    area_lights: *mut ArealightAreaLights,
    blockers: *const ArealightBlockers,
    origin: *const f64,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers.
    call(|| unsafe {
        let mut area_lights = handles::lock(&handles::borrow(area_lights, "area_lights")?.inner);
        let blockers = &handles::borrow(blockers, "blockers")?.blockers;
        Ok(area_lights.set_blockers(blockers, read_origin(origin)?)?)
    })
}

/// Begins the history of shadows anew with the next frame, as after a cut.
///
/// # Safety
/// The pointer is null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_area_lights_forget_shadows(
    area_lights: *mut ArealightAreaLights,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointer.
    call(|| unsafe {
        handles::lock(&handles::borrow(area_lights, "area_lights")?.inner).forget_shadows();
        Ok(())
    })
}

/// Says what the medium is from the next frame on. Of `medium`, `frame`, `host_set` and `seed` are not read.
///
/// # Safety
/// Pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_area_lights_set_medium(
    area_lights: *mut ArealightAreaLights,
    medium: *const ArealightMediumFrame,
) -> ArealightResult {
    // SAFETY: the caller vouches for the pointers.
    call(|| unsafe {
        let mut area_lights = handles::lock(&handles::borrow(area_lights, "area_lights")?.inner);
        let medium = medium_frame(&ShadeFrame::default(), arguments::read(medium, "medium")?);
        let none = || Failure::argument("medium: is given, but ArealightAreaLightsInfo.medium was null");
        *area_lights.medium_mut().ok_or_else(none)? = medium;
        Ok(())
    })
}

/// Destroys it with all that it owns. Null is nothing.
///
/// # Safety
/// No commands that it recorded are pending, the device is alive, and no other thread uses the object.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arealight_area_lights_destroy(
    area_lights: *mut ArealightAreaLights,
) -> ArealightResult {
    // SAFETY: the same contract.
    call(|| unsafe { handles::take(area_lights, "area_lights") }.map(drop))
}
