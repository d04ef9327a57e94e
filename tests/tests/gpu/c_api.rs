//! The C library as a host uses and misuses it: each mistake has a result and a message that names it.

use arealight_engine::host::HostError;
use arealight_tests::c_library::prelude::*;
use arealight_tests::prelude::*;
use ash::vk::Handle as _;

#[test]
fn hosts_that_are_none_are_refused_by_field() {
    use ArealightResult::{ErrorAbiVersion, ErrorArgument, ErrorMissingFeature, ErrorTable};
    assert_eq!(arealight_abi_version(), AREALIGHT_ABI_VERSION);
    let mut out = null_mut();
    // SAFETY: the pointers are null or valid, here and below.
    let create =
        |host: &ArealightHost, out: &mut *mut Arealight| unsafe { arealight_create(host, null(), out) };
    // SAFETY: as above.
    refused(unsafe { arealight_create(null(), null(), &raw mut out) }, ErrorArgument, "host: is null");
    let host = no_host();
    // SAFETY: as above.
    refused(unsafe { arealight_create(&raw const host, null(), null_mut()) }, ErrorArgument, "out: is null");

    let other = AREALIGHT_ABI_VERSION + 1;
    for (wrong, result, words) in [
        (ArealightHost { abi_version: other, ..host }, ErrorAbiVersion, "host.abi_version: 3"),
        (ArealightHost { api_version: vk::API_VERSION_1_0, ..host }, ErrorMissingFeature, "Vulkan 1.1"),
        (
            ArealightHost { get_instance_proc_addr: None, ..host },
            ErrorArgument,
            "get_instance_proc_addr: is null",
        ),
        (ArealightHost { get_device_proc_addr: None, ..host }, ErrorArgument, "host.get_device_proc_addr"),
        (ArealightHost { instance: null_mut(), ..host }, ErrorArgument, "host.instance"),
        (ArealightHost { physical_device: null_mut(), ..host }, ErrorArgument, "host.physical_device"),
        (ArealightHost { device: null_mut(), ..host }, ErrorArgument, "host.device"),
        (host, ErrorMissingFeature, "does not find vkGetPhysicalDeviceProperties"),
    ] {
        out = null_mut::<Arealight>().wrapping_add(1);
        refused(create(&wrong, &mut out), result, words);
        assert!(out.is_null(), "what is not made is null");
        let mut owner = null_mut::<ArealightAreaLights>().wrapping_add(1);
        // SAFETY: as above.
        let made = unsafe { arealight_area_lights_create(&raw const wrong, null(), &raw mut owner) };
        refused(made, result, words);
        assert!(owner.is_null());
    }

    // Tables that are none
    let noise = b"noise";
    let table = ArealightTable { bytes: noise.as_ptr(), size: noise.len(), format: 0, reserved: 0 };
    for (wrong, result, words) in [
        (table, ErrorTable, "neither OpenEXR nor KTX2 nor DDS"),
        (ArealightTable { format: 2, ..table }, ErrorArgument, "table.format: 2"),
        (ArealightTable { bytes: null(), ..table }, ErrorArgument, "table.bytes: is null"),
    ] {
        // SAFETY: as above.
        refused(unsafe { arealight_create(&raw const host, &raw const wrong, &raw mut out) }, result, words);
    }
}

#[test]
fn area_lights_say_what_they_cannot_do() {
    use ArealightResult::{ErrorArgument, ErrorLight};
    let (host, mut made, words) = (no_host(), null_mut(), [0_u32; 4]);
    let zero = ArealightPassOptions::default();
    let module = ArealightModule { words: words.as_ptr(), size: 16, host_set_layout: 0 };
    let by_image = ArealightMediumOptions { by_image: 1, ..Default::default() };
    let with = |options| ArealightAreaLightsInfo { options, ..NO_INFO };
    for (wrong, words) in [
        (ArealightAreaLightsInfo { frames_in_flight: 9, ..NO_INFO }, "frames_in_flight: 9 must be"),
        (ArealightAreaLightsInfo { shadow_filter: 2, ..NO_INFO }, "info.shadow_filter: 2 must be"),
        (ArealightAreaLightsInfo { shadow_history: 3, ..NO_INFO }, "info.shadow_history: 3 must be"),
        (ArealightAreaLightsInfo { reserved: 1, ..NO_INFO }, "info.reserved"),
        (ArealightAreaLightsInfo { medium: &raw const by_image, ..NO_INFO }, "medium.by_image and medium."),
        (
            with(ArealightPassOptions { descriptors: 1, ..zero }),
            "options.descriptors and options.module: must be 0",
        ),
        (with(ArealightPassOptions { module, ..zero }), "options.module: must be 0"),
        (with(ArealightPassOptions { horizon: 2, ..zero }), "options.horizon: 2 must be"),
    ] {
        // SAFETY: the pointers are valid.
        let result =
            unsafe { arealight_area_lights_create(&raw const host, &raw const wrong, &raw mut made) };
        refused(result, ErrorArgument, words);
    }

    let Some(engine) = TestEngine::new() else { return };
    let library = CLibrary::new(&engine);
    let (lamp, pixel) = (lamp(), OnePixel::new(&engine, Vec4::W, 0.5));
    let (light, radiance) = (c_lamp(&lamp), radiance(&engine, [1; 2], Vec4::NAN));
    let radiance = c_image(&radiance, Usage::COMPUTE_WRITE);
    let nothing = ArealightResources::default();
    let images = ArealightResources { planes: c_planes(&pixel), radiance, ..nothing };
    let frame = ArealightFrame { width: 1, height: 1, ..NO_FRAME };
    let uvs = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 0.0];
    let textured = ArealightLight { textured: 1, texture_coordinates: uvs.as_ptr(), ..light };
    let flat = ArealightLight { vertex_count: 2, ..light };
    let medium = ArealightMediumFrame::default();
    let masked = ArealightFrame { stencil_reference: 1, ..frame };
    library.with_area_lights(&NO_INFO, |owner| {
        let never = engine.host().try_submit(|commands| {
            let commands = commands.as_raw() as *mut c_void;
            for (place, light, origin, frame, images, result, words) in [
                (2, light, 0.0, frame, images, ErrorArgument, "place: 2 is not there: frames_in_flight is 2"),
                (0, flat, 0.0, frame, images, ErrorLight, "lights[0]: vertices: 2 given"),
                (0, light, f64::NAN, frame, images, ErrorArgument, "origin: "),
                (0, light, 0.0, NO_FRAME, images, ErrorArgument, "size"),
                (0, light, 0.0, masked, images, ErrorArgument, "without a stencil in the pass must be 0"),
                (0, light, 0.0, frame, nothing, ErrorArgument, "position: is missing"),
                (0, textured, 0.0, frame, images, ErrorArgument, "light_textures"),
            ] {
                let (images, frame, origin) = (&raw const images, &raw const frame, [origin; 3]);
                // SAFETY: the pointers are null or valid, here and below; what is recorded is never run.
                let shade = |commands, lights| unsafe {
                    let origin = origin.as_ptr();
                    arealight_area_lights_shade(owner, commands, place, lights, 1, origin, frame, images)
                };
                refused(shade(commands, &raw const light), result, words);
                refused(shade(null_mut(), &raw const light), ErrorArgument, "command_buffer: is null");
                refused(shade(commands, null()), ErrorArgument, "lights: is null");
            }
            // SAFETY: as above.
            unsafe {
                let mut blockers = null_mut();
                good(arealight_blockers_create(null(), null(), 0, &raw mut blockers));
                let set = arealight_area_lights_set_blockers(owner, blockers, [0.0; 3].as_ptr());
                refused(set, ErrorArgument, "ArealightPassOptions.shadow_rays is 0");
                good(arealight_blockers_destroy(blockers));
                good(arealight_area_lights_forget_shadows(owner));
                let set = arealight_area_lights_set_medium(owner, &raw const medium);
                refused(set, ErrorArgument, "ArealightAreaLightsInfo.medium was null");
            }
            Err(HostError::NoDevice { found: vec![] })
        });
        never.unwrap_err();
        // The twin: the next frame is shaded
        let lit = library.shade(null_mut(), &pixel, &[light], ArealightImage::default(), Vec3::ONE);
        assert!(lit.truncate().min_element() > 0.05, "{lit}");
        made = owner;
    });
    // SAFETY: what is refused is not looked at.
    refused(unsafe { arealight_area_lights_destroy(made) }, ErrorArgument, "was it destroyed?");
}

#[test]
fn null_objects_are_refused_and_destroying_nothing_is_fine() {
    use ArealightResult::ErrorArgument;
    let (arealight, pass) = (null_mut::<Arealight>(), null_mut::<ArealightPass>());
    // SAFETY: the pointers are null.
    unsafe {
        refused(arealight_table_memory(arealight, null_mut()), ErrorArgument, "arealight: is null");
        refused(arealight_table_bind_memory(arealight, 8, 0), ErrorArgument, "arealight: is null");
        refused(arealight_table_upload(arealight, null()), ErrorArgument, "arealight: is null");
        refused(arealight_pass_set_layout(pass, null_mut()), ErrorArgument, "pass: is null");
        refused(arealight_pass_write_set(pass, arealight, 0, null()), ErrorArgument, "pass: is null");
        refused(arealight_pass_record(pass, null_mut(), 0, null()), ErrorArgument, "pass: is null");
        refused(arealight_pass_create(arealight, null(), null_mut()), ErrorArgument, "out: is null");
        good(arealight_destroy(arealight));
        good(arealight_pass_destroy(pass));
        good(arealight_area_lights_destroy(null_mut()));
    }
}

/// A frame of this width, of eight rows and no light.
fn dark_frame(width: u32) -> ArealightFrame {
    ArealightFrame { width, height: 8, ..NO_FRAME }
}

#[test]
fn calls_out_of_order_are_refused() {
    use ArealightResult::{ErrorArgument, ErrorTooSmall};
    let Some(engine) = TestEngine::new() else { return };
    let library = CLibrary::new(&engine);
    let pass = library.pass(AREALIGHT_EFFECT_DIFFUSE);
    let (arealight, resources) = (library.arealight, ArealightResources::default());
    // SAFETY: the pointers are null or valid, and calls that are refused look behind no handle, here and
    // below.
    unsafe {
        // A pass is no library, and the other way round
        refused(
            arealight_table_memory(pass.cast(), null_mut()),
            ErrorArgument,
            "is no Arealight that is alive",
        );
        refused(arealight_pass_destroy(arealight.cast()), ErrorArgument, "is no ArealightPass that is alive");
        // A set before the table is there, or no set
        let write = |set| arealight_pass_write_set(pass, arealight, set, &raw const resources);
        refused(write(0), ErrorArgument, "set: is null");
        refused(arealight_table_bind_memory(arealight, 0, 0), ErrorArgument, "memory: is null");
        refused(write(8), ErrorArgument, "call arealight_table_bind_memory first");
        let layout = set_layout(pass);
        assert!(layout.layout != 0 && layout.sampled_images > 0 && layout.storage_images == 2);
        // A frame that cannot be recorded
        let commands = null_mut::<c_void>().wrapping_add(8);
        let record =
            |commands, set, frame: &ArealightFrame| arealight_pass_record(pass, commands, set, frame);
        refused(record(null_mut(), 8, &dark_frame(8)), ErrorArgument, "command_buffer: is null");
        refused(record(commands, 0, &dark_frame(8)), ErrorArgument, "set: is null");
        refused(record(commands, 8, &dark_frame(0)), ErrorArgument, "size");
        let blind = ArealightFrame { camera: [f32::NAN; 3], ..dark_frame(8) };
        refused(record(commands, 8, &blind), ErrorArgument, "camera");
        let lights = ArealightLightSummary { quad_count: 1, ..ArealightLightSummary::default() };
        let too_many = ArealightFrame { lights, ..dark_frame(8) };
        refused(record(commands, 8, &too_many), ErrorArgument, "lights: has 1 quads of 0");
        let lights = ArealightLightSummary { effects: 1 << 30, ..ArealightLightSummary::default() };
        let unknown = ArealightFrame { lights, ..dark_frame(8) };
        refused(record(commands, 8, &unknown), ErrorArgument, "frame.lights.effects: 0x40000000");
        let cut = ArealightFrame { rows: [0, 4], ..dark_frame(8) };
        refused(record(commands, 8, &cut), ErrorArgument, "rows: 0 to 4 cut workgroups");
        let masked = ArealightFrame { stencil_compare_mask: 256, ..dark_frame(8) };
        let words =
            "frame.stencil_compare_mask and stencil_reference: without a stencil in the pass must be 0";
        refused(record(commands, 8, &masked), ErrorArgument, words);
        let seeded = ArealightFrame { seed: 7, ..dark_frame(8) };
        refused(record(commands, 8, &seeded), ErrorArgument, "frame.seed: without shadow rays");
        let lists = ArealightBuffer { buffer: 1, offset: 0, range: 4 };
        let listed = ArealightFrame { tile_lists: lists, ..dark_frame(8) };
        refused(record(commands, 8, &listed), ErrorArgument, "frame.tile_lists: without tiles");
        let moved = ArealightFrame { light_offsets: [0, 0, 256], ..dark_frame(8) };
        refused(record(commands, 8, &moved), ErrorArgument, "light_offsets: are given");
        // A pipeline ahead
        refused(arealight_pass_prepare(pass, &raw const blind), ErrorArgument, "camera");
        let right = dark_frame(8);
        good(arealight_pass_prepare(pass, &raw const right));
    }

    let (plain, mut black) = (ArealightPassOptions::default(), null_mut());
    for (wrong, words) in [
        (
            ArealightPassOptions { surfaces: AREALIGHT_EFFECT_SPECULAR_INPUT, ..plain },
            "surfaces: have no lobe",
        ),
        (ArealightPassOptions { samples: 3, ..plain }, "samples: is 3"),
        (ArealightPassOptions { descriptors: 3, ..plain }, "options.descriptors: 3"),
        (ArealightPassOptions { stencil: 2, ..plain }, "options.stencil: 2"),
        (ArealightPassOptions { light_counts: 2, ..plain }, "options.light_counts: 2"),
    ] {
        // SAFETY: as above.
        let made = unsafe { arealight_pass_create(arealight, &raw const wrong, &raw mut black) };
        refused(made, ErrorArgument, words);
    }

    // An upload that lacks something
    let memory = library.table_memory();
    assert!(memory.size >= memory.staging_size && memory.staging_size == 64 * 64 * 6 * 16);
    let whole = ArealightUpload {
        staging_data: null_mut::<c_void>().wrapping_add(8),
        staging_size: memory.staging_size,
        staging_buffer: 8,
        staging_offset: 0,
        command_buffer: null_mut::<c_void>().wrapping_add(8),
    };
    for (wrong, result, words) in [
        (ArealightUpload { staging_data: null_mut(), ..whole }, ErrorArgument, "upload.staging_data"),
        (ArealightUpload { staging_buffer: 0, ..whole }, ErrorArgument, "upload.staging_buffer"),
        (ArealightUpload { command_buffer: null_mut(), ..whole }, ErrorArgument, "upload.command_buffer"),
        (ArealightUpload { staging_size: 16, ..whole }, ErrorTooSmall, "upload.staging_size: 16, but 393216"),
        (ArealightUpload { staging_offset: 8, ..whole }, ErrorArgument, "upload.staging_offset: 8"),
        (whole, ErrorArgument, "call arealight_table_bind_memory first"),
    ] {
        // SAFETY: what is refused is not looked at.
        refused(unsafe { arealight_table_upload(arealight, &raw const wrong) }, result, words);
    }

    // SAFETY: the pass is this thread's, and is not alive the second time.
    unsafe {
        good(arealight_pass_destroy(pass));
        refused(arealight_pass_destroy(pass), ErrorArgument, "was it destroyed?");
    }
    assert!(engine.host().validation_messages().is_empty());
}

#[test]
fn a_pass_outlives_what_made_it() {
    let Some(engine) = TestEngine::new() else { return };
    let mut library = CLibrary::new(&engine);
    let pass = library.pass(AREALIGHT_EFFECT_DIFFUSE);
    // It destroys nothing then
    let arealight = std::mem::replace(&mut library.arealight, null_mut());
    // SAFETY: nothing is pending; the device outlives both.
    unsafe {
        good(arealight_destroy(arealight));
        good(arealight_pass_destroy(pass));
        let mut out = null_mut();
        let gone = arealight_pass_create(arealight, null(), &raw mut out);
        refused(gone, ArealightResult::ErrorArgument, "arealight: is no Arealight that is alive");
    }
}

#[test]
fn passes_with_tiles_ask_for_their_buffers() {
    use ArealightResult::{ErrorArgument, ErrorTooSmall};
    let Some(engine) = TestEngine::new() else { return };
    let library = CLibrary::new(&engine);
    let tiles = ArealightPassOptions {
        surfaces: AREALIGHT_EFFECT_DIFFUSE,
        tile_capacity: 64,
        ..ArealightPassOptions::default()
    };
    let mut pass = null_mut();
    // SAFETY: the pointers are null or valid, and calls that are refused look behind no handle, here and
    // below.
    unsafe {
        let wrong = ArealightPassOptions { tile_cull_threshold: 1.0, ..tiles };
        let create =
            |options: &ArealightPassOptions, out| arealight_pass_create(library.arealight, options, out);
        refused(create(&wrong, &raw mut pass), ErrorArgument, "cull_threshold: is 1");
        let words = [0_u32; 4];
        let module = ArealightModule { words: words.as_ptr(), size: 16, host_set_layout: 0 };
        let with_module = ArealightPassOptions { module, ..tiles };
        refused(create(&with_module, &raw mut pass), ErrorArgument, "options.tile_capacity: must be 0");
        good(create(&tiles, &raw mut pass));

        // What to allocate; a pass without tiles needs nothing
        let mut memory = ArealightTileMemory { size: 1, usage: 1, reserved: 1 };
        good(arealight_pass_tile_memory(pass, 17, 8, &raw mut memory));
        assert_eq!(memory.size, arealight::tiles::memory([17, 8], 64));
        let indirect = vk::BufferUsageFlags::INDIRECT_BUFFER.as_raw();
        assert_eq!((memory.usage & indirect, memory.reserved), (indirect, 0));
        let plain = library.pass(AREALIGHT_EFFECT_DIFFUSE);
        good(arealight_pass_tile_memory(plain, 17, 8, &raw mut memory));
        assert_eq!((memory.size, memory.usage), (0, 0));

        // The horizons of the table's lobes
        let mut size = 0;
        let horizons =
            |data: *mut u32, size| arealight_lobe_horizons(library.arealight, 0, data.cast(), size);
        good(horizons(null_mut(), &raw mut size));
        let mut bytes = vec![0_u32; size as usize / 4];
        size -= 1;
        refused(horizons(bytes.as_mut_ptr(), &raw mut size), ErrorTooSmall, "are needed");
        good(horizons(bytes.as_mut_ptr(), &raw mut size));
        let cells: &[arealight::table::LobeHorizon] = bytemuck::cast_slice(&bytes);
        assert_eq!(cells.len(), 63 * 63, "cells between 64 nodes a side");
        assert!(cells.iter().all(|cell| cell.schlick_albedo > 0.0 && cell.schlick_albedo <= 1.02));

        // A frame without its lists
        let frame = dark_frame(8);
        refused(arealight_pass_prepare(pass, &raw const frame), ErrorArgument, "tile_lists: is missing");
        good(arealight_pass_prepare(plain, &raw const frame));
        good(arealight_pass_destroy(pass));
        good(arealight_pass_destroy(plain));
    }
}
