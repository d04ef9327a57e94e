//! The C library as a host uses and misuses it: each mistake has a result and a message that names it.

use arealight_capi::{
    AREALIGHT_ABI_VERSION, AREALIGHT_EFFECT_DIFFUSE, AREALIGHT_EFFECT_MESH, AREALIGHT_EFFECT_POLYGON,
    AREALIGHT_EFFECT_SPHERE, AREALIGHT_EFFECT_TEXTURED, AREALIGHT_EFFECT_TUBE, AREALIGHT_EFFECT_TWO_SIDED,
    AREALIGHT_SHAPE_SPHERE, AREALIGHT_SHAPE_TUBE, Arealight, ArealightBuffer, ArealightFrame, ArealightHost,
    ArealightLight, ArealightPackedLights, ArealightPass, ArealightPassOptions, ArealightResources,
    ArealightResult, ArealightShape, ArealightTable, ArealightTileMemory, ArealightUpload,
    arealight_abi_version, arealight_create, arealight_destroy, arealight_lobe_horizons,
    arealight_pass_create, arealight_pass_create_with_module, arealight_pass_destroy,
    arealight_pass_pack_lights, arealight_pass_pack_shapes, arealight_pass_prepare, arealight_pass_record,
    arealight_pass_set_layout, arealight_pass_tile_memory, arealight_pass_write_set, arealight_table_memory,
    arealight_table_upload,
};
use arealight_tests::TestEngine;
use arealight_tests::c_library::{CLibrary, NO_ARRAYS, NO_LIGHT, good, no_host, refused, set_layout};
use ash::vk;
use std::ffi::c_void;
use std::ptr::{null, null_mut};

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
        (ArealightHost { abi_version: other, ..no_host() }, ErrorAbiVersion, "host.abi_version: 3"),
        (ArealightHost { api_version: vk::API_VERSION_1_0, ..no_host() }, ErrorMissingFeature, "Vulkan 1.1"),
        (
            ArealightHost { get_instance_proc_addr: None, ..no_host() },
            ErrorArgument,
            "host.get_instance_proc_addr",
        ),
        (
            ArealightHost { get_device_proc_addr: None, ..no_host() },
            ErrorArgument,
            "host.get_device_proc_addr",
        ),
        (ArealightHost { instance: null_mut(), ..no_host() }, ErrorArgument, "host.instance"),
        (ArealightHost { physical_device: null_mut(), ..no_host() }, ErrorArgument, "host.physical_device"),
        (ArealightHost { device: null_mut(), ..no_host() }, ErrorArgument, "host.device"),
        (no_host(), ErrorMissingFeature, "does not find vkGetPhysicalDeviceProperties"),
    ] {
        out = null_mut::<Arealight>().wrapping_add(1);
        refused(create(&wrong, &mut out), result, words);
        assert!(out.is_null(), "what is not made is null");
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
fn null_objects_are_refused_and_destroying_nothing_is_fine() {
    use ArealightResult::ErrorArgument;
    let (arealight, pass) = (null_mut::<Arealight>(), null_mut::<ArealightPass>());
    // SAFETY: the pointers are null.
    unsafe {
        refused(arealight_table_memory(arealight, null_mut()), ErrorArgument, "arealight: is null");
        refused(arealight_table_upload(arealight, null()), ErrorArgument, "arealight: is null");
        refused(arealight_pass_set_layout(pass, null_mut()), ErrorArgument, "pass: is null");
        refused(
            arealight_pass_pack_lights(pass, null(), 0, null(), null_mut()),
            ErrorArgument,
            "pass: is null",
        );
        refused(arealight_pass_write_set(pass, arealight, 0, null()), ErrorArgument, "pass: is null");
        refused(arealight_pass_record(pass, null_mut(), 0, null()), ErrorArgument, "pass: is null");
        refused(arealight_pass_create(arealight, null(), null_mut()), ErrorArgument, "out: is null");
        good(arealight_destroy(arealight));
        good(arealight_pass_destroy(pass));
    }
}

const TRIANGLE: [f64; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];

const CORNERS: [f64; 6] = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0];

fn light() -> ArealightLight {
    ArealightLight { name: c"lamp".as_ptr(), vertices: TRIANGLE.as_ptr(), vertex_count: 3, ..NO_LIGHT }
}

/// Packs one light about the origin.
fn pack(
    pass: *mut ArealightPass,
    light: &ArealightLight,
    arrays: &mut ArealightPackedLights,
) -> ArealightResult {
    // SAFETY: the light and the arrays are as they say; a pass that is none is what is tested.
    unsafe { arealight_pass_pack_lights(pass, light, 1, [0.0; 3].as_ptr(), arrays) }
}

/// A sphere.
fn moon() -> ArealightShape {
    ArealightShape {
        name: c"moon".as_ptr(),
        kind: AREALIGHT_SHAPE_SPHERE,
        ends: 0,
        center: [0.0; 3],
        axis_u: [0.0; 3],
        axis_v: [0.0; 3],
        radius: 1.0,
        radiance: [1.0; 3],
        two_sided: 0,
        textured: 0,
        texture_layer: 0,
    }
}

#[test]
fn lights_that_cannot_be_shaded_are_named() {
    use ArealightResult::{ErrorArgument, ErrorEffects, ErrorLight, ErrorTooSmall};
    let Some(engine) = TestEngine::new() else { return };
    let library = CLibrary::new(&engine);
    let pass = library.pass(AREALIGHT_EFFECT_DIFFUSE);
    let mut arrays = NO_ARRAYS;
    let nan = [f64::NAN, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    for (wrong, result, words) in [
        (ArealightLight { vertex_count: 2, ..light() }, ErrorLight, "light 'lamp': vertices: 2 given"),
        (ArealightLight { vertices: nan.as_ptr(), ..light() }, ErrorLight, "light 'lamp': vertices[0]"),
        (ArealightLight { radiance: [f32::NAN; 3], ..light() }, ErrorLight, "light 'lamp': radiance"),
        (
            ArealightLight { radiance: [-1.0; 3], name: null(), ..light() },
            ErrorLight,
            "light 'lights[0]': radiance",
        ),
        (ArealightLight { vertices: null(), ..light() }, ErrorArgument, "lights[0].vertices: is null"),
        (ArealightLight { two_sided: 7, ..light() }, ErrorArgument, "lights[0].two_sided: 7"),
        (
            ArealightLight { two_sided: 1, ..light() },
            ErrorEffects,
            "light 'lamp' calls for the effects: two_sided",
        ),
        (ArealightLight { texture_coordinates: CORNERS.as_ptr(), ..light() }, ErrorEffects, "textured"),
    ] {
        refused(pack(pass, &wrong, &mut arrays), result, words);
    }
    // SAFETY: the pointers are null or valid.
    unsafe {
        let infinite = [f64::INFINITY, 0.0, 0.0];
        let packed = arealight_pass_pack_lights(pass, null(), 0, infinite.as_ptr(), &raw mut arrays);
        refused(packed, ErrorArgument, "origin");
        refused(
            arealight_pass_pack_lights(pass, null(), 0, null(), &raw mut arrays),
            ErrorArgument,
            "origin: is null",
        );
    }

    // Sizes first; then arrays, which may be too small
    good(pack(pass, &light(), &mut arrays));
    assert_eq!((arrays.lights_size, arrays.vertices_size), (64, 48));
    let unused = AREALIGHT_EFFECT_TWO_SIDED
        | AREALIGHT_EFFECT_POLYGON
        | AREALIGHT_EFFECT_TEXTURED
        | AREALIGHT_EFFECT_MESH;
    assert_eq!((arrays.quad_count, arrays.unused), (1, unused), "a triangle is a quad");
    let (mut lights, mut vertices) = ([0u32; 16], [0.0f32; 12]);
    let (to_lights, to_vertices) = (lights.as_mut_ptr().cast(), vertices.as_mut_ptr().cast());
    arrays = ArealightPackedLights {
        lights: to_lights,
        vertices: to_vertices,
        lights_size: 64,
        vertices_size: 47,
        ..arrays
    };
    refused(pack(pass, &light(), &mut arrays), ErrorTooSmall, "packed.vertices_size: 47, but 48 are needed");
    good(pack(pass, &light(), &mut arrays));
    assert_eq!((lights[0], lights[12]), (1f32.to_bits(), 3), "its radiance and its number of vertices");

    // Shapes likewise
    let mut size = 0;
    let sphere = moon();
    let round = library.pass(AREALIGHT_EFFECT_DIFFUSE | AREALIGHT_EFFECT_SPHERE | AREALIGHT_EFFECT_TUBE);
    let mut pack_shape = |pass, shape: &ArealightShape, size: &mut u64| {
        let to = if *size > 0 { lights.as_mut_ptr().cast() } else { null_mut() };
        // SAFETY: `lights` has 128 bytes; no more are said.
        unsafe { arealight_pass_pack_shapes(pass, shape, 1, [0.0; 3].as_ptr(), to, size) }
    };
    for (wrong, result, words) in [
        (ArealightShape { kind: 3, ..sphere }, ErrorArgument, "shapes[0].kind: 3"),
        (
            ArealightShape { kind: AREALIGHT_SHAPE_TUBE, ends: 3, ..sphere },
            ErrorArgument,
            "shapes[0].ends: 3",
        ),
        (ArealightShape { kind: AREALIGHT_SHAPE_TUBE, ..sphere }, ErrorLight, "light 'moon': p0 and p1"),
        (
            ArealightShape { radius: -1.0, name: null(), ..sphere },
            ErrorLight,
            "light 'shapes[0]': radius: -1",
        ),
        (ArealightShape { two_sided: 2, ..sphere }, ErrorArgument, "shapes[0].two_sided: 2"),
        (ArealightShape { textured: 2, ..sphere }, ErrorArgument, "shapes[0].textured: 2"),
        (ArealightShape { textured: 1, ..sphere }, ErrorLight, "light 'moon': texture: only ellipses"),
    ] {
        refused(pack_shape(round, &wrong, &mut size), result, words);
    }
    refused(pack_shape(pass, &sphere, &mut size), ErrorEffects, "light 'moon' calls for the effects: sphere");
    good(pack_shape(round, &sphere, &mut size));
    assert_eq!(size, 64);
    size = 63;
    refused(pack_shape(round, &sphere, &mut size), ErrorTooSmall, "size: 63, but 64 are needed");
    good(pack_shape(round, &sphere, &mut size));
    // SAFETY: the passes are this thread's.
    unsafe {
        good(arealight_pass_destroy(round));
        good(arealight_pass_destroy(pass));
    }
    refused(pack(pass, &light(), &mut arrays), ErrorArgument, "pass: is no ArealightPass that is alive");
}

#[test]
fn holes_and_faces_that_cannot_be_are_named() {
    use ArealightResult::{ErrorArgument, ErrorEffects, ErrorLight};
    let Some(engine) = TestEngine::new() else { return };
    let library = CLibrary::new(&engine);
    let pass = library.pass(AREALIGHT_EFFECT_DIFFUSE);
    let mut arrays = NO_ARRAYS;
    let (three, both) = (3_u32, [TRIANGLE, TRIANGLE.map(|number| number + 2.0)].concat());
    let outside = ArealightLight { vertices: both.as_ptr(), ..light() };
    let (threes, coordinates, nine) = ([3, 3], [CORNERS; 2].concat(), [TRIANGLE; 3].concat());
    let mesh = |counts| ArealightLight {
        vertices: both.as_ptr(),
        vertex_count: 6,
        face_vertex_counts: counts,
        face_count: 2,
        ..light()
    };
    let inside = [TRIANGLE, [0.1, 0.1, 0.0, 0.4, 0.1, 0.0, 0.1, 0.4, 0.0]].concat();
    for (wrong, result, words) in [
        (ArealightLight { hole_count: 1, ..light() }, ErrorArgument, "lights[0].hole_vertex_counts: is null"),
        (
            ArealightLight { hole_vertex_counts: &raw const three, hole_count: 1, ..outside },
            ErrorLight,
            "light 'lamp': holes[0]: vertices[0]",
        ),
        (
            ArealightLight {
                vertices: inside.as_ptr(),
                hole_vertex_counts: &raw const three,
                hole_count: 1,
                ..light()
            },
            ErrorEffects,
            "light 'lamp' calls for the effects: polygon",
        ),
        // With an image too, whose coordinates are the outline's alone
        (
            ArealightLight {
                vertices: inside.as_ptr(),
                texture_coordinates: CORNERS.as_ptr(),
                hole_vertex_counts: &raw const three,
                hole_count: 1,
                ..light()
            },
            ErrorEffects,
            "light 'lamp' calls for the effects: polygon, textured",
        ),
        (ArealightLight { face_count: 2, ..light() }, ErrorArgument, "lights[0].face_vertex_counts: is null"),
        (
            ArealightLight { face_count: 2, ..mesh([4, 2].as_ptr()) },
            ErrorLight,
            "light 'lamp': faces[1]: 2 vertices, a face has at least 3",
        ),
        (
            ArealightLight { face_count: 1, ..mesh(&raw const three) },
            ErrorLight,
            "light 'lamp': faces: 3 vertices in all, but the light has 6",
        ),
        (
            ArealightLight { texture_coordinates: coordinates.as_ptr(), ..mesh(threes.as_ptr()) },
            ErrorLight,
            "light 'lamp': texture: a mesh shows no image",
        ),
        (
            ArealightLight {
                vertices: nine.as_ptr(),
                hole_vertex_counts: &raw const three,
                hole_count: 1,
                ..mesh(threes.as_ptr())
            },
            ErrorLight,
            "light 'lamp': holes[0]: the light has several faces",
        ),
        (mesh(threes.as_ptr()), ErrorEffects, "light 'lamp' calls for the effects: polygon, mesh"),
    ] {
        refused(pack(pass, &wrong, &mut arrays), result, words);
    }
    // SAFETY: the pass is this thread's.
    good(unsafe { arealight_pass_destroy(pass) });
}

/// A frame of this width, of eight rows and no light.
fn dark_frame(width: u32) -> ArealightFrame {
    ArealightFrame {
        width,
        height: 8,
        camera: [0.0; 3],
        light_count: 0,
        shape_count: 0,
        quad_count: 0,
        unused: 0,
        reserved: 0,
        position_from_clip: null(),
        tile_lists: ArealightBuffer::default(),
    }
}

#[test]
fn calls_out_of_order_are_refused() {
    use ArealightResult::{ErrorArgument, ErrorTooSmall};
    let Some(engine) = TestEngine::new() else { return };
    let library = CLibrary::new(&engine);
    let pass = library.pass(AREALIGHT_EFFECT_DIFFUSE);
    let (arealight, resources) = (library.arealight, ArealightResources::default());
    // SAFETY: the pointers are null or valid, and calls that are refused look behind no handle, here and below.
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
        refused(write(8), ErrorArgument, "call arealight_table_upload first");
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
        let too_many = ArealightFrame { quad_count: 1, ..dark_frame(8) };
        refused(record(commands, 8, &too_many), ErrorArgument, "quad_count");
        // A pipeline ahead
        refused(arealight_pass_prepare(pass, &raw const blind), ErrorArgument, "camera");
        let right = dark_frame(8);
        good(arealight_pass_prepare(pass, &raw const right));
    }

    // An upload that lacks something
    let memory = library.table_memory();
    assert!(memory.size >= memory.staging_size && memory.staging_size == 64 * 64 * 3 * 16);
    let whole = ArealightUpload {
        memory: 8,
        memory_offset: 0,
        staging_data: null_mut::<c_void>().wrapping_add(8),
        staging_size: memory.staging_size,
        staging_buffer: 8,
        staging_offset: 0,
        command_buffer: null_mut::<c_void>().wrapping_add(8),
    };
    for (wrong, result, words) in [
        (ArealightUpload { memory: 0, ..whole }, ErrorArgument, "upload.memory: is null"),
        (ArealightUpload { staging_data: null_mut(), ..whole }, ErrorArgument, "upload.staging_data"),
        (ArealightUpload { staging_buffer: 0, ..whole }, ErrorArgument, "upload.staging_buffer"),
        (ArealightUpload { command_buffer: null_mut(), ..whole }, ErrorArgument, "upload.command_buffer"),
        (ArealightUpload { staging_size: 16, ..whole }, ErrorTooSmall, "upload.staging_size: 16, but 196608"),
        (ArealightUpload { staging_offset: 8, ..whole }, ErrorArgument, "upload.staging_offset: 8"),
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
        effects: AREALIGHT_EFFECT_DIFFUSE,
        tile_capacity: 64,
        ..ArealightPassOptions::default()
    };
    let mut pass = null_mut();
    // SAFETY: the pointers are null or valid, and calls that are refused look behind no handle, here and below.
    unsafe {
        let wrong = ArealightPassOptions { tile_cull_threshold: 1.0, ..tiles };
        let create =
            |options: &ArealightPassOptions, out| arealight_pass_create(library.arealight, options, out);
        refused(create(&wrong, &raw mut pass), ErrorArgument, "cull_threshold: is 1");
        let words = [0_u32; 4];
        let with_module = arealight_pass_create_with_module(
            library.arealight,
            &raw const tiles,
            words.as_ptr(),
            16,
            &raw mut pass,
        );
        refused(with_module, ErrorArgument, "options.tile_capacity: must be 0");
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
        let horizons = |data: *mut u32, size| arealight_lobe_horizons(library.arealight, data.cast(), size);
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
