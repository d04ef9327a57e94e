//! Lights by the C library: how they are packed and how far they reach, and what is refused by name.

use arealight::{Opening, Profile};
use arealight_tests::c_library::prelude::*;
use arealight_tests::prelude::*;

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
        (ArealightLight { texture_coordinates: null(), ..textured }, ErrorArgument, "coordinates: is null"),
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
        (ArealightLight { cluster_error: -1.0, ..light() }, ErrorArgument, "lights[1].cluster_error: -1 is"),
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
    let holed = ArealightLight { hole_vertex_counts: hole, hole_count: 1, ..light() };
    let outside = ArealightLight { vertices: both.as_ptr(), ..holed };
    for (wrong, result, words) in [
        (ArealightLight { hole_count: 1, ..light() }, ErrorArgument, "lights[0].hole_vertex_counts: is null"),
        (outside, ErrorLight, "lights[0] 'lamp': holes[0]: vertices[0]"),
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
            "'lamp': texture: a mesh is not",
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
        ..holed
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
