//! Devices that lack something, images that are gone, and names for debuggers: on devices that lie about
//! themselves, so that every answer can be had on any.

use arealight_engine::host::Location;
use arealight_tests::prelude::*;
use arealight_tool_kernels::kernels::VISIBILITY;
use arealight_vk::{ComputePass, Context, LightTextures, TableImage};
use std::ffi::{CStr, c_void};
use std::sync::Mutex;

/// The engine's instance with some functions replaced.
fn lying_instance(engine: &TestEngine, lies: &[(&CStr, *const c_void)]) -> ash::Instance {
    let real = engine.host().instance();
    // SAFETY: each name comes with a function of its type; the others are the instance's own.
    unsafe {
        ash::Instance::load_with(
            |name| match (lies.iter().find(|(lie, _)| *lie == name), name.to_bytes()) {
                (Some((_, function)), _) => *function,
                (None, b"vkGetPhysicalDeviceProperties") => {
                    real.fp_v1_0().get_physical_device_properties as *const c_void
                }
                (None, b"vkGetPhysicalDeviceFormatProperties") => {
                    real.fp_v1_0().get_physical_device_format_properties as *const c_void
                }
                (None, b"vkGetPhysicalDeviceImageFormatProperties") => {
                    real.fp_v1_0().get_physical_device_image_format_properties as *const c_void
                }
                _ => std::ptr::null(),
            },
            real.handle(),
        )
    }
}

fn context(engine: &TestEngine, instance: &ash::Instance) -> Result<Context, Error> {
    let host = engine.host();
    // SAFETY: the handles belong together, and live as long as the engine.
    unsafe { Context::new(instance, host.physical_device(), host.device()) }
}

/// Properties of a device of Vulkan 1.0.
unsafe extern "system" fn old(_: vk::PhysicalDevice, properties: *mut vk::PhysicalDeviceProperties) {
    // SAFETY: Vulkan's contract.
    unsafe {
        *properties = vk::PhysicalDeviceProperties { api_version: vk::API_VERSION_1_0, ..Default::default() }
    };
}

/// Properties of a device that binds as little as Vulkan allows.
unsafe extern "system" fn least(_: vk::PhysicalDevice, properties: *mut vk::PhysicalDeviceProperties) {
    let limits = vk::PhysicalDeviceLimits {
        max_per_stage_descriptor_sampled_images: 16,
        max_per_stage_descriptor_storage_images: 4,
        max_per_stage_descriptor_storage_buffers: 4,
        max_storage_buffer_range: 1 << 27,
        max_compute_work_group_count: [65535; 3],
        ..Default::default()
    };
    let least =
        vk::PhysicalDeviceProperties { api_version: vk::API_VERSION_1_1, limits, ..Default::default() };
    // SAFETY: Vulkan's contract.
    unsafe { *properties = least };
}

/// No format can do anything.
unsafe extern "system" fn no_format(
    _: vk::PhysicalDevice,
    _: vk::Format,
    properties: *mut vk::FormatProperties,
) {
    // SAFETY: Vulkan's contract.
    unsafe { *properties = vk::FormatProperties::default() };
}

#[test]
fn what_a_device_lacks_is_named() {
    let Some(engine) = TestEngine::new() else { return };
    let properties = c"vkGetPhysicalDeviceProperties";
    let error =
        context(&engine, &lying_instance(&engine, &[(properties, old as *const c_void)])).unwrap_err();
    assert!(matches!(error, Error::MissingFeature { feature: "Vulkan 1.1", .. }), "{error}");

    // The least that Vulkan allows is enough to shade, and too little for the tools' own visibility
    let limits = (properties, least as *const c_void);
    let context_of_least = context(&engine, &lying_instance(&engine, &[limits])).unwrap();
    // SAFETY: no submission uses the passes.
    unsafe {
        ShadePass::new(&context_of_least, ShadeOptions::default()).unwrap();
        let error = ComputePass::new(&context_of_least, &VISIBILITY, &[]).unwrap_err();
        let Error::MissingFeature { feature, needed_by } = error else { panic!("{error}") };
        assert_eq!((feature, needed_by), ("maxPerStageDescriptorStorageImages", "visibility"));
        // Five words of picks for each of so many pixels are more than it binds
        let rays = ShadeOptions { shadow_rays: 2, ..ShadeOptions::default() };
        let pass = ShadePass::new(&context_of_least, rays).unwrap();
        let frame = |size| ShadeFrame { size, ..ShadeFrame::default() };
        let record = |size| pass.record(vk::CommandBuffer::null(), vk::DescriptorSet::null(), &frame(size));
        let error = record([4096, 2048]).unwrap_err();
        assert!(matches!(error, Error::MissingFeature { feature: "maxStorageBufferRange", .. }), "{error}");
    }

    let formats = (c"vkGetPhysicalDeviceFormatProperties", no_format as *const c_void);
    let without = context(&engine, &lying_instance(&engine, &[limits, formats])).unwrap();
    let size = PyramidSize::new(64).unwrap();
    // SAFETY: nothing is made.
    let error = unsafe { LightTextures::new(&without, size, 1) }.unwrap_err();
    assert!(matches!(error, Error::MissingFeature { needed_by: "light textures", .. }), "{error}");
}

#[test]
#[cfg(debug_assertions)]
fn a_set_that_points_at_a_destroyed_table_is_refused() {
    let Some(engine) = TestEngine::new() else { return };
    let host = engine.host();
    // SAFETY: no submission uses the pass or the table; the set is new, and the layout the pass's. Nothing is
    // recorded where an error is returned.
    unsafe {
        let pass = ComputePass::new(engine.context(), &arealight_tool_kernels::kernels::EVAL, &[]).unwrap();
        let mut table =
            TableImage::new(engine.context(), &LightTable::ggx(), TableFormat::default()).unwrap();
        let memory = host.with_allocator(|allocator| table.allocate(allocator)).unwrap();
        let pool = host.descriptor_pool(1, &pass.pool_sizes(1)).unwrap();
        let set = pool.allocate(pass.set_layout()).unwrap();
        let buffer = host.storage_buffer("numbers", &[0.0_f32; 64]).unwrap();
        let whole = Resource::buffer(buffer.handle());
        let write = |table| {
            pass.write_set(set, &[table, whole, whole, whole, whole, engine.light_textures()]).unwrap();
        };
        write(table.resource());
        drop(table);
        host.with_allocator(|allocator| allocator.free(memory)).unwrap();
        let constants = vec![0; pass.kernel().push_constant_size() as usize];
        host.submit(|commands| {
            let error = pass.record(commands, set, &constants, [1; 3]).unwrap_err();
            assert_eq!(error, Error::Destroyed { field: "table_image" });
            // Written again, it is good again; groups that no device has keep it from being recorded
            write(engine.table());
            let error = pass.record(commands, set, &constants, [u32::MAX; 3]).unwrap_err();
            assert!(matches!(error, Error::InvalidArgument { field: "groups", .. }), "{error}");
        })
        .unwrap();
    }
}

/// What was named and labelled by the one test that looks at it.
static SAID: Mutex<Vec<String>> = Mutex::new(Vec::new());

fn say(text: String) {
    SAID.lock().expect("no test panics while it holds this").push(text);
}

unsafe extern "system" fn set_name(
    _: vk::Device,
    info: *const vk::DebugUtilsObjectNameInfoEXT<'_>,
) -> vk::Result {
    // SAFETY: Vulkan's contract.
    let (kind, name) = unsafe { ((*info).object_type, CStr::from_ptr((*info).p_object_name)) };
    say(format!("{kind:?} {}", name.to_string_lossy()));
    vk::Result::SUCCESS
}

unsafe extern "system" fn begin(_: vk::CommandBuffer, label: *const vk::DebugUtilsLabelEXT<'_>) {
    // SAFETY: Vulkan's contract.
    say(format!("begin {}", unsafe { CStr::from_ptr((*label).p_label_name) }.to_string_lossy()));
}

unsafe extern "system" fn end(_: vk::CommandBuffer) {
    say("end".into());
}

unsafe extern "system" fn find(_: vk::Device, name: *const std::ffi::c_char) -> vk::PFN_vkVoidFunction {
    // SAFETY: Vulkan's contract; each function is of its name's type.
    unsafe {
        let function = match CStr::from_ptr(name).to_bytes() {
            b"vkSetDebugUtilsObjectNameEXT" => set_name as *const c_void,
            b"vkCmdBeginDebugUtilsLabelEXT" => begin as *const c_void,
            b"vkCmdEndDebugUtilsLabelEXT" => end as *const c_void,
            _ => return None,
        };
        std::mem::transmute(function)
    }
}

#[test]
fn objects_are_named_and_commands_labelled_where_the_host_can() {
    let Some(engine) = TestEngine::new() else { return };
    let instance = lying_instance(&engine, &[(c"vkGetDeviceProcAddr", find as *const c_void)]);
    // SAFETY: the instance's functions for debuggers are the ones above.
    let context = unsafe { engine.context().clone().with_debug_utils(&instance) };
    let table = LightTable::ggx();
    // SAFETY: the submission is waited for before anything is dropped; the staging buffer holds the table.
    unsafe {
        let mut image = TableImage::new(&context, &table, TableFormat::default()).unwrap();
        let memory = engine.host().with_allocator(|allocator| image.allocate(allocator)).unwrap();
        let bytes = TableFormat::default().bytes(&table);
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        let staging = engine.host().buffer("staging", bytes.len() as u64, usage, Location::Upload).unwrap();
        staging.upload(&bytes).unwrap();
        engine.host().submit(|commands| image.record_upload(commands, staging.handle(), 0)).unwrap();
        let options = ShadeOptions { surfaces: Effects::DIFFUSE, ..ShadeOptions::default() };
        let pass = ShadePass::new(&context, options).unwrap();
        // What is not recorded has no label either
        let frame =
            ShadeFrame { size: [8, u32::MAX], lights: LightSummary::default(), ..ShadeFrame::default() };
        let none = vk::DescriptorSet::null();
        engine.host().submit(|commands| drop(pass.record(commands, none, &frame).unwrap_err())).unwrap();
        // A pipeline is named once it is made
        pass.prepare(&ShadeFrame { size: [8, 8], ..frame }).unwrap();
        drop(pass);
        drop(image);
        engine.host().with_allocator(|allocator| allocator.free(memory)).unwrap();
    }
    let said = SAID.lock().unwrap().clone();
    assert_eq!(
        said,
        [
            "IMAGE arealight table",
            "IMAGE_VIEW arealight table",
            "begin arealight table upload",
            "end",
            "DESCRIPTOR_SET_LAYOUT arealight shade",
            "PIPELINE_LAYOUT arealight shade",
            "PIPELINE arealight shade",
        ]
    );
}
