//! The C library on a device of the tests, called as a host in C does.

use crate::TestEngine;
use crate::one_pixel::{self, OnePixel};
use arealight::plan::RadianceFormat;
use arealight::{Light, Plane};
use arealight_engine::host::{Buffer, DescriptorPool, Image, Location, Usage};
use arealight_vk::Resource;
use ash::vk::{self, Handle as _};
use glam::{Vec3, Vec4};
use prelude::*;
use std::cell::Cell;
use std::ffi::{CStr, c_char, c_void};
use std::mem::transmute;
use std::ptr::{null, null_mut};

/// The C interface, all of whose names say that they are of it, and what most of its tests name.
pub mod prelude {
    pub use super::{
        CLibrary, CLightBuffers, DeviceMemory, NO_ARRAYS, NO_FRAME, NO_INFO, NO_LIGHT, c_image, c_lamp,
        c_planes, good, no_host, refused, set_layout, whole,
    };
    pub use arealight_capi::*;
    pub use std::ffi::c_void;
    pub use std::ptr::{null, null_mut};
}

/// Asserts that a call failed with `expected`, and a message that has `words`.
#[track_caller]
pub fn refused(result: ArealightResult, expected: ArealightResult, words: &str) {
    // SAFETY: the message is this thread's, and lives until its next failure.
    let message = unsafe { CStr::from_ptr(arealight_last_error()) }.to_string_lossy();
    assert_eq!(result, expected, "{message}");
    assert!(message.contains(words), "`{words}` is not in: {message}");
}

/// Asserts that a call did not fail.
#[track_caller]
pub fn good(result: ArealightResult) {
    // SAFETY: as above.
    assert_eq!(result, ArealightResult::Ok, "{:?}", unsafe { CStr::from_ptr(arealight_last_error()) });
}

unsafe extern "system" fn finds_nothing(_: *mut c_void, _: *const c_char) -> ArealightFunction {
    None
}

/// A host without a device: what it says is checked before anything of Vulkan is called.
pub fn no_host() -> ArealightHost {
    ArealightHost {
        abi_version: AREALIGHT_ABI_VERSION,
        api_version: vk::API_VERSION_1_1,
        get_instance_proc_addr: Some(finds_nothing),
        get_device_proc_addr: Some(finds_nothing),
        // Not null; nothing looks behind them
        instance: null_mut::<c_void>().wrapping_add(8),
        physical_device: null_mut::<c_void>().wrapping_add(8),
        device: null_mut::<c_void>().wrapping_add(8),
        pipeline_cache: 0,
    }
}

/// A light without vertices: zeros, with which a host in C begins, but for its radiance.
// SAFETY: numbers and pointers alone.
pub const NO_LIGHT: ArealightLight = ArealightLight { radiance: [1.0; 3], ..unsafe { std::mem::zeroed() } };

/// A light of constant radiance, whose vertices it points to.
pub fn c_lamp(light: &Light) -> ArealightLight {
    ArealightLight {
        vertices: light.shape.vertices().as_ptr().cast(),
        vertex_count: light.shape.vertices().len() as u32,
        radiance: light.radiance.to_array(),
        ..NO_LIGHT
    }
}

/// An image as C has it.
pub fn c_image(image: &Image, usage: Usage) -> ArealightImage {
    ArealightImage { view: image.view().as_raw(), layout: usage.layout.as_raw().cast_unsigned(), reserved: 0 }
}

/// The planes of a pixel as C has them.
pub fn c_planes(pixel: &OnePixel<'_>) -> [ArealightImage; Plane::COUNT] {
    let planes = pixel.planes();
    Plane::ALL.map(|plane| match planes[plane] {
        Some(Resource::SampledImage { view, layout }) => {
            ArealightImage { view: view.as_raw(), layout: layout.as_raw().cast_unsigned(), reserved: 0 }
        }
        _ => ArealightImage::default(),
    })
}

/// All of a buffer as C has it.
pub fn whole(buffer: &Buffer) -> ArealightBuffer {
    ArealightBuffer { buffer: buffer.handle().as_raw(), offset: 0, range: AREALIGHT_WHOLE_SIZE }
}

/// A frame of no pixels and no light.
// SAFETY: numbers and pointers alone.
pub const NO_FRAME: ArealightFrame = unsafe { std::mem::zeroed() };

/// Both lobes at the exact level, for two frames in flight.
// SAFETY: as above.
pub const NO_INFO: ArealightAreaLightsInfo = unsafe { std::mem::zeroed() };

/// To ask for the sizes alone.
// SAFETY: as above.
pub const NO_ARRAYS: ArealightPackedLights = unsafe { std::mem::zeroed() };

/// Lights in buffers, as a host in C packs them.
pub struct CLightBuffers {
    /// Of the lights.
    pub summary: ArealightLightSummary,
    buffers: [Option<Buffer>; 3],
}

impl CLightBuffers {
    /// Lights about zero.
    pub fn new(engine: &TestEngine, lights: &[ArealightLight]) -> Self {
        let mut packed = NO_ARRAYS;
        let pack = |packed: &mut ArealightPackedLights| {
            let (count, origin) = (lights.len() as u32, [0.0_f64; 3]);
            // SAFETY: the lights and the arrays are as they say.
            good(unsafe { arealight_pack_lights(lights.as_ptr(), count, origin.as_ptr(), packed) });
        };
        // The sizes first
        pack(&mut packed);
        let mut arrays = [packed.lights_size, packed.vertices_size, packed.shapes_size]
            .map(|size| vec![0_u32; size as usize / 4]);
        [packed.lights, packed.vertices, packed.shapes] =
            arrays.each_mut().map(|array| array.as_mut_ptr().cast());
        pack(&mut packed);
        let upload = |array: Vec<u32>| engine.host().storage_buffer("of C", &array).expect("memory");
        let buffers = arrays.map(|array| (!array.is_empty()).then(|| upload(array)));
        Self { summary: packed.summary, buffers }
    }

    /// The lights alone.
    pub fn resources(&self) -> ArealightResources {
        let [lights, light_vertices, shapes] =
            self.buffers.each_ref().map(|buffer| buffer.as_ref().map_or_else(Default::default, whole));
        ArealightResources { lights, light_vertices, shapes, ..ArealightResources::default() }
    }
}

/// The library on a device of the tests.
pub struct CLibrary<'a> {
    engine: &'a TestEngine,
    /// Keeps the loader, whose functions the library has.
    _entry: ash::Entry,
    /// The device.
    pub host: ArealightHost,
    /// Null is not destroyed.
    pub arealight: *mut Arealight,
    /// Whether frames are recorded by what is pushed, of passes that are made so.
    pub is_pushed: Cell<bool>,
    /// Set 1 of the next frames, for a module of the host's, or 0.
    pub host_set: Cell<u64>,
    /// What shades instead, if it is not null, and its next place.
    owner: Cell<(*mut ArealightAreaLights, u32)>,
    /// The table's, once it was uploaded.
    memory: Cell<Option<DeviceMemory>>,
}

impl<'a> CLibrary<'a> {
    /// As a host in C makes it.
    pub fn new(engine: &'a TestEngine) -> Self {
        let host = engine.host();
        // SAFETY: the system's loader is what the host of the tests was opened with.
        let entry = unsafe { ash::Entry::load() }.expect("the loader");
        let (find_instance, find_device) =
            (entry.static_fn().get_instance_proc_addr, host.instance().fp_v1_0().get_device_proc_addr);
        // SAFETY: both sides are functions of C that take a handle, which is a pointer, and a string.
        let host = unsafe {
            ArealightHost {
                get_instance_proc_addr: transmute::<vk::PFN_vkGetInstanceProcAddr, ArealightProcAddr>(
                    find_instance,
                ),
                get_device_proc_addr: transmute::<vk::PFN_vkGetDeviceProcAddr, ArealightProcAddr>(
                    find_device,
                ),
                instance: host.instance().handle().as_raw() as *mut c_void,
                physical_device: host.physical_device().as_raw() as *mut c_void,
                device: host.device().handle().as_raw() as *mut c_void,
                ..no_host()
            }
        };
        let mut arealight = null_mut();
        // SAFETY: the handles are the engine's, which outlives the library's object.
        good(unsafe { arealight_create(&raw const host, null(), &raw mut arealight) });
        let (owner, memory) = (Cell::new((null_mut(), 0)), Cell::default());
        let (is_pushed, host_set) = (Cell::default(), Cell::default());
        Self { engine, _entry: entry, host, arealight, is_pushed, host_set, owner, memory }
    }

    /// With its table.
    pub fn with_table(engine: &'a TestEngine) -> Self {
        let made = Self::new(engine);
        made.upload(DeviceMemory::new(engine, &made.table_memory()));
        made
    }

    /// Does something while what owns all that shading needs shades, at one place and the other.
    pub fn with_area_lights(
        &self,
        info: &ArealightAreaLightsInfo,
        act: impl FnOnce(*mut ArealightAreaLights),
    ) {
        let mut owner = null_mut();
        // SAFETY: the handles are the engine's, and submissions are waited for.
        good(unsafe { arealight_area_lights_create(&raw const self.host, info, &raw mut owner) });
        self.owner.set((owner, 0));
        act(owner);
        self.owner.set((null_mut(), 0));
        // SAFETY: as above.
        good(unsafe { arealight_area_lights_destroy(owner) });
    }

    /// A pass for surfaces.
    pub fn pass(&self, surfaces: u32) -> *mut ArealightPass {
        self.pass_with(&ArealightPassOptions { surfaces, ..ArealightPassOptions::default() })
    }

    /// A pass of these options.
    pub fn pass_with(&self, options: &ArealightPassOptions) -> *mut ArealightPass {
        let mut pass = null_mut();
        // SAFETY: the pointers are valid.
        good(unsafe { arealight_pass_create(self.arealight, options, &raw mut pass) });
        pass
    }

    /// What memory the table needs.
    pub fn table_memory(&self) -> ArealightMemory {
        let mut memory = ArealightMemory::default();
        // SAFETY: the pointer is valid.
        good(unsafe { arealight_table_memory(self.arealight, &raw mut memory) });
        memory
    }

    /// Records the upload of the table to memory, with texels that `staging` gets.
    pub fn record_upload(
        &self,
        memory: vk::DeviceMemory,
        staging: &Buffer,
        commands: vk::CommandBuffer,
    ) -> ArealightResult {
        let mut texels = vec![0_u8; staging.size() as usize];
        // SAFETY: it is as large as the callers were asked for.
        let bound = unsafe { arealight_table_bind_memory(self.arealight, memory.as_raw(), 0) };
        if bound != ArealightResult::Ok {
            return bound;
        }
        let upload = ArealightUpload {
            staging_data: texels.as_mut_ptr().cast(),
            staging_size: texels.len() as u64,
            staging_buffer: staging.handle().as_raw(),
            staging_offset: 0,
            command_buffer: commands.as_raw() as *mut c_void,
        };
        // SAFETY: memory and buffer are large enough, by the callers; the commands are being recorded.
        let result = unsafe { arealight_table_upload(self.arealight, &raw const upload) };
        staging.upload(&texels).expect("the buffer is mapped");
        result
    }

    /// Uploads the table to memory that it keeps.
    pub fn upload(&self, memory: DeviceMemory) {
        let staging = self.staging();
        let record = |commands| good(self.record_upload(memory.raw, &staging, commands));
        self.engine.host().submit(record).expect("a submission");
        self.memory.set(Some(memory));
    }

    /// A buffer for the table's texels.
    pub fn staging(&self) -> Buffer {
        let (size, usage) = (self.table_memory().staging_size, vk::BufferUsageFlags::TRANSFER_SRC);
        self.engine.host().buffer("table", size, usage, Location::Upload).expect("memory")
    }

    /// A set of a layout, with its pool.
    pub fn set(&self, layout: &ArealightSetLayout) -> (vk::DescriptorSet, DescriptorPool) {
        let sizes = [
            (vk::DescriptorType::SAMPLED_IMAGE, layout.sampled_images),
            (vk::DescriptorType::COMBINED_IMAGE_SAMPLER, layout.combined_image_samplers),
            (vk::DescriptorType::STORAGE_IMAGE, layout.storage_images),
            (vk::DescriptorType::STORAGE_BUFFER, layout.storage_buffers),
        ];
        let sizes: Vec<_> = sizes
            .into_iter()
            .filter(|(_, count)| *count > 0)
            .map(|(ty, descriptor_count)| vk::DescriptorPoolSize { ty, descriptor_count })
            .collect();
        let pool = self.engine.host().descriptor_pool(1, &sizes).expect("memory");
        // SAFETY: the layout is one of the library's, which is alive.
        let set = unsafe { pool.allocate(vk::DescriptorSetLayout::from_raw(layout.layout)) };
        (set.expect("the pool has one set"), pool)
    }

    /// What the pixel shows by a pass, as [`OnePixel::shade`] says it of the recorder's.
    pub fn shade(
        &self,
        pass: *mut ArealightPass,
        pixel: &OnePixel<'_>,
        lights: &[ArealightLight],
        light_textures: ArealightImage,
        camera: Vec3,
    ) -> Vec4 {
        let packed = CLightBuffers::new(self.engine, lights);
        let format = RadianceFormat::Rgba32Float;
        let radiance = one_pixel::stored(self.engine, format);
        let resources = ArealightResources {
            planes: c_planes(pixel),
            light_textures,
            radiance: c_image(&radiance, Usage::COMPUTE_WRITE),
            ..packed.resources()
        };
        let frame = ArealightFrame {
            width: 1,
            height: 1,
            camera: camera.to_array(),
            lights: packed.summary,
            host_set: self.host_set.get(),
            ..NO_FRAME
        };
        self.submit(pass, lights, &resources, &frame);
        one_pixel::read(&radiance, format)
    }

    /// Records a frame by what owns all that shading needs, where there is one, by what is pushed, or with a
    /// new set, and waits for it.
    #[expect(clippy::not_unsafe_ptr_arg_deref, reason = "the library refuses a pass that is none")]
    pub fn submit(
        &self,
        pass: *mut ArealightPass,
        lights: &[ArealightLight],
        resources: &ArealightResources,
        frame: &ArealightFrame,
    ) {
        let (arealight, host, (owner, place)) = (self.arealight, self.engine.host(), self.owner.get());
        let raw = |commands: vk::CommandBuffer| commands.as_raw() as *mut c_void;
        let recorded = if !owner.is_null() {
            let (first, count, origin) = (lights.as_ptr(), lights.len() as u32, [0.0_f64; 3].as_ptr());
            self.owner.set((owner, 1 - place));
            // SAFETY: the commands are being recorded, and what they use lives until they were waited for.
            host.submit(|commands| unsafe {
                let commands = raw(commands);
                good(arealight_area_lights_shade(
                    owner, commands, place, first, count, origin, frame, resources,
                ));
            })
        } else if self.is_pushed.get() {
            // SAFETY: as above.
            host.submit(|commands| unsafe {
                good(arealight_pass_record_pushed(pass, arealight, raw(commands), resources, frame));
            })
        } else {
            let (set, _pool) = self.set(&set_layout(pass));
            // SAFETY: the set is new, and what it points to lives until the submission was waited for.
            good(unsafe { arealight_pass_write_set(pass, arealight, set.as_raw(), resources) });
            // SAFETY: the commands are being recorded, with a set of the frame's size.
            host.submit(|commands| unsafe {
                good(arealight_pass_record(pass, raw(commands), set.as_raw(), frame));
            })
        };
        recorded.expect("a submission");
    }
}

impl Drop for CLibrary<'_> {
    fn drop(&mut self) {
        // SAFETY: nothing is pending on the device.
        good(unsafe { arealight_destroy(self.arealight) });
    }
}

/// What descriptor sets of a pass are made with.
#[expect(clippy::not_unsafe_ptr_arg_deref, reason = "the library refuses a pass that is none")]
pub fn set_layout(pass: *const ArealightPass) -> ArealightSetLayout {
    let mut layout = ArealightSetLayout::default();
    // SAFETY: the pointers are valid.
    good(unsafe { arealight_pass_set_layout(pass, &raw mut layout) });
    layout
}

/// Memory that a host in C allocated.
pub struct DeviceMemory {
    /// The handle.
    pub raw: vk::DeviceMemory,
    device: ash::Device,
}

impl DeviceMemory {
    /// Of the first type that will do.
    pub fn new(engine: &TestEngine, needed: &ArealightMemory) -> Self {
        let info = vk::MemoryAllocateInfo::default()
            .allocation_size(needed.size)
            .memory_type_index(needed.memory_type_bits.trailing_zeros());
        let device = engine.host().device().clone();
        // SAFETY: the device is alive, and has the type.
        let raw = unsafe { device.allocate_memory(&info, None) }.expect("memory");
        Self { raw, device }
    }
}

impl Drop for DeviceMemory {
    fn drop(&mut self) {
        // SAFETY: tests destroy what is bound to it first.
        unsafe { self.device.free_memory(self.raw, None) };
    }
}
