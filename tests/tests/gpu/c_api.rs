//! The C library as a host uses and misuses it: each mistake has a result and a message that names it.

use arealight::{Opening, Profile};
use arealight_capi::{
    AREALIGHT_ABI_VERSION, AREALIGHT_EFFECT_DIFFUSE, AREALIGHT_EFFECT_SPECULAR_INPUT,
    AREALIGHT_EFFECT_SPHERE, AREALIGHT_EFFECT_TWO_SIDED, AREALIGHT_LIGHT_DISK, AREALIGHT_LIGHT_MESH,
    AREALIGHT_LIGHT_SPHERE, AREALIGHT_LIGHT_TUBE, AREALIGHT_SPECULAR_LOBES_ONE, Arealight, ArealightFrame,
    ArealightHost, ArealightLight, ArealightLightSummary, ArealightModule, ArealightPackedLights,
    ArealightPass, ArealightPassOptions, ArealightReach, ArealightResources, ArealightResult, ArealightTable,
    ArealightTileMemory, ArealightUpload, arealight_abi_version, arealight_create, arealight_destroy,
    arealight_light_reach, arealight_lobe_density, arealight_lobe_horizons, arealight_pack_lights,
    arealight_pass_create, arealight_pass_destroy, arealight_pass_prepare, arealight_pass_record,
    arealight_pass_set_layout, arealight_pass_tile_memory, arealight_pass_write_set,
    arealight_table_bind_memory, arealight_table_memory, arealight_table_upload,
};
use arealight_tests::c_library::{
    CLibrary, NO_ARRAYS, NO_FRAME, NO_LIGHT, good, no_host, refused, set_layout,
};
use arealight_tests::prelude::*;
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
        (ArealightHost { abi_version: other, ..host }, ErrorAbiVersion, "host.abi_version: 3"),
        (ArealightHost { api_version: vk::API_VERSION_1_0, ..host }, ErrorMissingFeature, "Vulkan 1.1"),
        (
            ArealightHost { get_instance_proc_addr: None, ..host },
            ErrorArgument,
            "host.get_instance_proc_addr",
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
        refused(arealight_table_bind_memory(arealight, 8, 0), ErrorArgument, "arealight: is null");
        refused(arealight_table_upload(arealight, null()), ErrorArgument, "arealight: is null");
        refused(arealight_pass_set_layout(pass, null_mut()), ErrorArgument, "pass: is null");
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

/// Packs lights about the origin.
fn pack(lights: &[ArealightLight], arrays: &mut ArealightPackedLights) -> ArealightResult {
    let (count, origin) = (lights.len() as u32, [0.0_f64; 3]);
    // SAFETY: the lights and the arrays are as they say.
    unsafe { arealight_pack_lights(lights.as_ptr(), count, origin.as_ptr(), arrays) }
}

/// A sphere.
fn moon() -> ArealightLight {
    ArealightLight { name: c"moon".as_ptr(), kind: AREALIGHT_LIGHT_SPHERE, radius: 1.0, ..NO_LIGHT }
}

#[test]
fn lights_that_cannot_be_shaded_are_named() {
    use ArealightResult::{ErrorArgument, ErrorLight};
    let mut arrays = NO_ARRAYS;
    let nan = [f64::NAN, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let textured = ArealightLight { textured: 1, texture_coordinates: CORNERS.as_ptr(), ..light() };
    let tube = ArealightLight { kind: AREALIGHT_LIGHT_TUBE, ..moon() };
    let profiled = |pairs: &[f64], light| ArealightLight {
        profile: pairs.as_ptr(),
        profile_row_count: pairs.len() as u32 / 2,
        profile_levels: 4,
        ..light
    };
    let (cone, back) = ([0.0, 1.0, 20.0, 1.0, 30.0, 0.0], [91.0, 1.0]);
    let around = [0.0, 1.0, 1.0, 1.0, 1.0, 20.0, 1.0, 0.2, 0.5, 0.2, 30.0, 0.0, 0.0, 0.0, 0.0];
    let behind = ArealightLight {
        has_opening: 1,
        opening_center: [0.2, 0.3, 0.5],
        opening_axis_u: [0.5, 0.0, 0.0],
        opening_axis_v: [0.0, 0.4, 0.0],
        opening_housed: 1,
        ..light()
    };
    let spot = profiled(&cone, behind);
    for (wrong, result, words) in [
        (ArealightLight { kind: 5, ..light() }, ErrorArgument, "lights[1].kind: 5"),
        (ArealightLight { vertex_count: 2, ..light() }, ErrorLight, "lights[1] 'lamp': vertices: 2 given"),
        (ArealightLight { vertices: nan.as_ptr(), ..light() }, ErrorLight, "lights[1] 'lamp': vertices[0]"),
        (ArealightLight { radiance: [f32::NAN; 3], ..light() }, ErrorLight, "lights[1] 'lamp': radiance"),
        (ArealightLight { radiance: [-1.0; 3], name: null(), ..light() }, ErrorLight, "lights[1]: radiance"),
        (ArealightLight { vertices: null(), ..light() }, ErrorArgument, "lights[1].vertices: is null"),
        (ArealightLight { two_sided: 7, ..light() }, ErrorArgument, "lights[1].two_sided: 7"),
        (ArealightLight { textured: 2, ..textured }, ErrorArgument, "lights[1].textured: 2"),
        (
            ArealightLight { texture_coordinates: null(), ..textured },
            ErrorArgument,
            "lights[1].texture_coordinates: is null",
        ),
        (ArealightLight { ends: 3, ..tube }, ErrorArgument, "lights[1].ends: 3"),
        (tube, ErrorLight, "lights[1] 'moon': axis_u: is zero"),
        (ArealightLight { radius: -1.0, name: null(), ..moon() }, ErrorLight, "lights[1]: radius: -1"),
        (ArealightLight { kind: AREALIGHT_LIGHT_DISK, ..moon() }, ErrorLight, "'moon': axis_u and axis_v"),
        (ArealightLight { textured: 1, ..moon() }, ErrorLight, "'moon': texture: only polygons and disks"),
        (ArealightLight { profile: null(), ..spot }, ErrorArgument, "lights[1].profile: is null"),
        (ArealightLight { profile_levels: 0, ..spot }, ErrorLight, "lights[1] 'lamp': profile: levels: 0"),
        (profiled(&back, light()), ErrorLight, "lights[1] 'lamp': profile: pairs[0]: 91 degrees"),
        (profiled(&[], light()), ErrorLight, "lights[1] 'lamp': profile: no pair"),
        (profiled(&cone, moon()), ErrorLight, "'moon': profile or opening: "),
        (ArealightLight { has_opening: 2, ..light() }, ErrorArgument, "lights[1].has_opening: 2"),
        (ArealightLight { opening_housed: 2, ..behind }, ErrorArgument, "lights[1].opening_housed: 2"),
        (ArealightLight { opening_axis_v: [0.0; 3], ..behind }, ErrorLight, "'lamp': opening: axis_u and"),
        (
            ArealightLight { cluster_error: -1.0, ..light() },
            ErrorArgument,
            "lights[1].cluster_error: -1 is not",
        ),
    ] {
        refused(pack(&[light(), wrong], &mut arrays), result, words);
    }
    // The twins; what a profile and an opening are packed to is what it is in Rust
    let (mut record, mut rows) = ([0u32; 16], [0.0f32; 1024]);
    let mut whole = ArealightPackedLights {
        lights: record.as_mut_ptr().cast(),
        lights_size: 64,
        vertices: rows.as_mut_ptr().cast(),
        vertices_size: 4096,
        ..NO_ARRAYS
    };
    let street = ArealightLight { profile_row_count: 3, profile_azimuth_count: 4, ..profiled(&around, spot) };
    good(pack(&[street], &mut whole));
    let expected = Light {
        shape: LightShape::Polygon(TRIANGLE.as_chunks().0.iter().map(|v| DVec3::from_array(*v)).collect()),
        radiance: Vec3::ONE,
        profile: Some(Profile::new(around.as_chunks::<5>().0, 4).unwrap()),
        opening: Some(Opening {
            center: DVec3::new(0.2, 0.3, 0.5),
            axis_u: DVec3::X * 0.5,
            axis_v: DVec3::Y * 0.4,
            housed: true,
        }),
        ..Light::default()
    };
    let expected = PackedLights::new(&[expected], DVec3::ZERO).unwrap();
    let vertices: &[u8] = bytemuck::cast_slice(&expected.vertices);
    assert_eq!(bytemuck::bytes_of(&record), bytemuck::cast_slice::<_, u8>(&expected.lights));
    assert_eq!(&bytemuck::bytes_of(&rows)[..whole.vertices_size as usize], vertices);
    good(pack(&[light(), textured, moon(), ArealightLight { axis_u: [1.0; 3], ..tube }], &mut arrays));
    // SAFETY: the pointers are null or valid.
    unsafe {
        let infinite = [f64::INFINITY, 0.0, 0.0];
        let packed = arealight_pack_lights(null(), 0, infinite.as_ptr(), &raw mut arrays);
        refused(packed, ErrorArgument, "origin");
        let packed = arealight_pack_lights(null(), 0, null(), &raw mut arrays);
        refused(packed, ErrorArgument, "origin: is null");
        let packed = arealight_pack_lights(null(), 0, [0.0; 3].as_ptr(), null_mut());
        refused(packed, ErrorArgument, "packed: is null");
    }
}

#[test]
fn arrays_of_the_host_are_filled_where_they_are_large_enough() {
    use ArealightResult::ErrorTooSmall;
    let given = [moon(), ArealightLight { two_sided: 1, ..light() }];
    let mut arrays = NO_ARRAYS;
    good(pack(&given, &mut arrays));
    assert_eq!((arrays.lights_size, arrays.vertices_size, arrays.shapes_size), (64, 48, 64));
    let effects = AREALIGHT_EFFECT_TWO_SIDED | AREALIGHT_EFFECT_SPHERE;
    let expected = ArealightLightSummary { light_count: 1, quad_count: 1, shape_count: 1, effects };
    assert_eq!(arrays.summary, expected, "a triangle is a quad");
    let (mut lights, mut vertices, mut shapes) = ([0u32; 16], [0.0f32; 12], [0u32; 16]);
    let all = ArealightPackedLights {
        lights: lights.as_mut_ptr().cast(),
        vertices: vertices.as_mut_ptr().cast(),
        shapes: shapes.as_mut_ptr().cast(),
        ..arrays
    };
    for (mut small, words) in [
        (ArealightPackedLights { vertices_size: 47, ..all }, "packed.vertices_size: 47, but 48 are needed"),
        (ArealightPackedLights { shapes_size: 63, ..all }, "packed.shapes_size: 63, but 64 are needed"),
    ] {
        refused(pack(&given, &mut small), ErrorTooSmall, words);
        assert_eq!((small.vertices_size, small.shapes_size), (48, 64), "what is needed");
    }
    let mut whole = all;
    good(pack(&given, &mut whole));
    assert_eq!((lights[0], lights[12]), (1f32.to_bits(), 3), "its radiance and its number of vertices");
    assert_eq!((shapes[3], shapes[7]), (1, 1f32.to_bits()), "its kind and its radius");
}

#[test]
fn holes_and_faces_that_cannot_be_are_named() {
    use ArealightResult::{ErrorArgument, ErrorLight};
    let mut arrays = NO_ARRAYS;
    let (three, both) = (3_u32, [TRIANGLE, TRIANGLE.map(|number| number + 2.0)].concat());
    let outside = ArealightLight { vertices: both.as_ptr(), ..light() };
    let threes = [3, 3];
    let mesh = |counts| ArealightLight {
        kind: AREALIGHT_LIGHT_MESH,
        vertices: both.as_ptr(),
        vertex_count: 6,
        face_vertex_counts: counts,
        face_count: 2,
        ..light()
    };
    let hole = &raw const three;
    for (wrong, result, words) in [
        (ArealightLight { hole_count: 1, ..light() }, ErrorArgument, "lights[0].hole_vertex_counts: is null"),
        (
            ArealightLight { hole_vertex_counts: hole, hole_count: 1, ..outside },
            ErrorLight,
            "lights[0] 'lamp': holes[0]: vertices[0]",
        ),
        (mesh(null()), ErrorArgument, "lights[0].face_vertex_counts: is null"),
        (mesh([4, 2].as_ptr()), ErrorLight, "lights[0] 'lamp': face_vertex_counts[1]: 2 vertices"),
        (
            ArealightLight { face_count: 1, ..mesh(hole) },
            ErrorLight,
            "lights[0] 'lamp': face_vertex_counts: 3 vertices in all, but the light has 6",
        ),
        (
            ArealightLight { textured: 1, ..mesh(threes.as_ptr()) },
            ErrorLight,
            "lights[0] 'lamp': texture: a mesh is not textured",
        ),
    ] {
        refused(pack(&[wrong], &mut arrays), result, words);
    }
    // The twins: a hole inside, with a texture whose coordinates are the outline's alone; and a mesh
    let inside = [TRIANGLE, [0.1, 0.1, 0.0, 0.4, 0.1, 0.0, 0.1, 0.4, 0.0]].concat();
    let cut = ArealightLight {
        vertices: inside.as_ptr(),
        textured: 1,
        texture_coordinates: CORNERS.as_ptr(),
        hole_vertex_counts: hole,
        hole_count: 1,
        ..light()
    };
    good(pack(&[cut, mesh(threes.as_ptr())], &mut arrays));
    assert_eq!((arrays.summary.light_count, arrays.summary.quad_count), (2, 0));
    // Rows of clusters are among those of faces, four each
    let many: Vec<f64> = (0..16).flat_map(|step| TRIANGLE.map(|number| number + f64::from(step))).collect();
    let mut vertices = |cluster_error| {
        let (vertices, counts) = (many.as_ptr(), [3; 16]);
        let faces = mesh(counts.as_ptr());
        let many = ArealightLight { vertices, vertex_count: 48, face_count: 16, cluster_error, ..faces };
        good(pack(&[many], &mut arrays));
        arrays.vertices_size
    };
    assert_eq!((vertices(0.0), (vertices(0.05) - 16 * 64) % 64), (16 * 64, 0));
    assert!(vertices(0.05) > vertices(0.0));
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
        let lists = arealight_capi::ArealightBuffer { buffer: 1, offset: 0, range: 4 };
        let listed = ArealightFrame { tile_lists: lists, ..dark_frame(8) };
        refused(record(commands, 8, &listed), ErrorArgument, "frame.tile_lists: without tiles");
        let moved = ArealightFrame { light_offsets: [0, 0, 256], ..dark_frame(8) };
        refused(record(commands, 8, &moved), ErrorArgument, "light_offsets: are given");
        // A pipeline ahead
        refused(arealight_pass_prepare(pass, &raw const blind), ErrorArgument, "camera");
        let right = dark_frame(8);
        good(arealight_pass_prepare(pass, &raw const right));
    }

    // A pass without a lobe would be black
    let plain = ArealightPassOptions::default();
    let lobeless = ArealightPassOptions { surfaces: AREALIGHT_EFFECT_SPECULAR_INPUT, ..plain };
    let mut black = null_mut();
    // SAFETY: the pointers are valid; nothing is made where an error is returned.
    let made = unsafe { arealight_pass_create(arealight, &raw const lobeless, &raw mut black) };
    refused(made, ErrorArgument, "surfaces: have no lobe");

    for (wrong, words) in [
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
        let module = ArealightModule { host_set_layout: 1, ..module };
        let with_set = ArealightPassOptions { module, ..Default::default() };
        refused(create(&with_set, &raw mut pass), ErrorArgument, "module.host_set_layout: must be 0");
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

#[test]
fn c_lights_reach_as_far_as_rust_says() {
    use ArealightResult::{ErrorArgument, ErrorLight};
    let Some(engine) = TestEngine::new() else { return };
    let library = CLibrary::new(&engine);
    let (mut density, mut reach) = (0.0, ArealightReach::default());
    // SAFETY: the pointers are valid, here and below.
    let asked = |roughness, density: &mut f64| unsafe {
        arealight_lobe_density(library.arealight, AREALIGHT_SPECULAR_LOBES_ONE, roughness, density)
    };
    good(asked(0.3, &mut density));
    let table = LightTable::ggx();
    assert_eq!(density.to_bits(), table.lobe_density(SpecularLobes::One, 0.3).to_bits());
    refused(asked(1.5, &mut density), ErrorArgument, "roughness: 1.5 must be from 0 to 1");
    // SAFETY: as above.
    let found = |light: &ArealightLight, threshold, reach: &mut ArealightReach| unsafe {
        arealight_light_reach(light, threshold, density, reach)
    };
    let moon = moon();
    good(found(&moon, 0.01, &mut reach));
    let shape = LightShape::Sphere { center: moon.center.into(), radius: moon.radius };
    let radiance = moon.radiance.into();
    let light = Light { radiance, shape, ..Light::default() };
    let radius = arealight::reach::radius(&light, 0.01, density);
    let [low, high] = arealight::reach::bounds(&light, radius).map(|corner| corner.to_array());
    assert_eq!(reach, ArealightReach { center: moon.center, radius, low, high });
    assert!(radius > moon.radius && radius.is_finite());
    // Nothing bounds an image, and a threshold of zero: on a wall neither
    let wall = ArealightLight { radiance: [1.0; 3], ..self::light() };
    let image = ArealightLight { textured: 1, texture_coordinates: CORNERS.as_ptr(), ..wall };
    for (screen, threshold) in [(wall, 0.0), (image, 0.01)] {
        good(found(&screen, threshold, &mut reach));
        let everywhere = [reach.low.map(|low| -low), reach.high].concat();
        assert_eq!((reach.radius, everywhere), (f64::INFINITY, vec![f64::INFINITY; 6]));
    }
    // What cannot be answered
    refused(found(&moon, f64::NAN, &mut reach), ErrorArgument, "threshold: NaN must be finite");
    let flat = ArealightLight { radius: -1.0, ..moon };
    refused(found(&flat, 0.01, &mut reach), ErrorLight, "radius: -1 must be above zero");
}
