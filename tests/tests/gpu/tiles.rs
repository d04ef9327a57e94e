//! Shading by tiles: the picture without, whatever the lights; lists, classes and their bounds.

use arealight::kernels::{CLASSIFY, SHADE};
use arealight::{Opening, Profile, TileClass};
use arealight_engine::TileCounts;
use arealight_tests::frame::black;
use arealight_tests::prelude::*;

/// No multiple of a tile's side.
const SIZE: [u32; 2] = [61, 37];

/// A picture without tiles, and with: reflected light alone.
struct Pictures {
    plain: Vec<Vec4>,
    tiled: Vec<Vec4>,
    counts: TileCounts,
}

fn of(surfaces: Effects) -> ShadeOptions {
    ShadeOptions { surfaces, ..ShadeOptions::default() }
}

/// The picture without tiles.
fn plain(engine: &TestEngine, scene: &Scene, lights: &[Light], surfaces: Effects) -> Vec<Vec4> {
    reflected(engine, scene, lights, SIZE, of(surfaces))
}

fn pictures(
    engine: &TestEngine,
    scene: &Scene,
    lights: &[Light],
    surfaces: Effects,
    tiles: TileOptions,
) -> Pictures {
    let (tiled, counts) = reflected_by_tiles(engine, scene, lights, SIZE, (of(surfaces), tiles));
    Pictures { plain: plain(engine, scene, lights, surfaces), tiled, counts }
}

/// Every frame is classified, however few lights it has.
fn every_frame() -> TileOptions {
    TileOptions { least_quads: 0, ..TileOptions::default() }
}

impl Pictures {
    fn count(&self, class: TileClass) -> u32 {
        self.counts.classes.iter().find(|(found, _)| *found == class).expect("every class is counted").1
    }

    /// How many pixels differ by more than what the quality level promises of each light: some that are left
    /// out would be rounded to more than nothing.
    fn different(&self, lights: &[Light]) -> usize {
        let radiance: f32 = lights.iter().map(|light| light.radiance.max_element()).sum();
        let pixels = self.plain.iter().zip(&self.tiled);
        let differs = |(plain, tiled): &(&Vec4, &Vec4)| {
            let bound = f32::EPSILON * plain.max_element() + 1e-6 * radiance;
            let difference = (**plain - **tiled).abs().max_element();
            difference.is_nan() || difference > bound
        };
        pixels.filter(differs).count()
    }

    fn all_tiles(&self) -> u32 {
        self.counts.classes.iter().map(|(_, count)| count).sum()
    }
}

#[test]
fn quads_give_the_same_picture_to_the_bit() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene("sweep.glb");
    let found = pictures(&engine, &scene, &scene.lights, scene.effects(), every_frame());
    assert_eq!(found.plain, found.tiled);
    assert!(found.plain.iter().filter(|pixel| pixel.x > 1e-3).count() > 500, "something is lit");
    assert_eq!(found.all_tiles(), 8 * 5, "{:?}", found.counts);
    assert!(found.count(TileClass::Quads) > 0, "{:?}", found.counts);
    // The twin: what is not the same is seen
    let mut lights = scene.lights.clone();
    lights.iter_mut().flat_map(|light| light.shape.vertices_mut()).for_each(|vertex| vertex.x += 1e-3);
    let moved = Pictures { plain: plain(&engine, &scene, &lights, scene.effects()), ..found };
    assert!(moved.different(&scene.lights) > 10);
}

#[test]
fn few_quads_are_not_classified_and_give_the_same_picture_to_the_bit() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene("sweep.glb");
    let found = pictures(&engine, &scene, &scene.lights, scene.effects(), TileOptions::default());
    assert_eq!(found.plain, found.tiled);
    assert!(found.plain.iter().filter(|pixel| pixel.x > 1e-3).count() > 500, "something is lit");
    assert!(!found.counts.is_classified(), "{:?}", found.counts);
}

#[test]
fn a_room_of_any_lights_differs_by_rounding_whether_its_lists_hold_them_or_not() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene("room.glb");
    // Some tiles have more lights
    let tiles = TileOptions { capacity: 5, ..every_frame() };
    let found = pictures(&engine, &scene, &scene.lights, scene.effects(), tiles);
    assert_eq!(found.different(&scene.lights), 0, "{:?}", found.counts);
    assert!(found.count(TileClass::Any) > 0, "{:?}", found.counts);
    let all = u64::from(found.all_tiles()) * scene.lights.len() as u64;
    assert!(found.counts.lights < all, "{:?}", found.counts);
}

/// Lights that are hard to classify about the floor of the sweep, y = 0: near it, on it, across it, below it,
/// lights away, of no area, of both sides.
fn hard_lights(center: DVec3) -> Vec<Light> {
    let square = |along: DVec3, across: DVec3, at: DVec3, two_sided| Light {
        name: format!("{at}"),
        radiance: Vec3::new(1.0, 0.5, 0.25),
        two_sided,
        shape: LightShape::Polygon(
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|(x, y)| center + at + along * x + across * y)
                .into(),
        ),
        ..Light::default()
    };
    let (x, y, z) = (DVec3::X * 0.4, DVec3::Y * 0.4, DVec3::Z * 0.4);
    let mut lights = Vec::new();
    for two_sided in [false, true] {
        for height in [-0.5, -1e-4, 0.0, 1e-6, 0.01, 0.4, 2.0] {
            lights.push(square(x, z, DVec3::Y * height, two_sided));
            lights.push(square(z, x, DVec3::Y * height, two_sided));
            lights.push(square(x, y, DVec3::new(0.3, height, -0.2), two_sided));
        }
        lights.push(square(x, x * 0.5, DVec3::Y, two_sided));
        lights.push(square(x * 1e4, z * 1e4, DVec3::Y * 3.0, two_sided));
        lights.push(square(x * 1e-4, z * 1e-4, DVec3::Y * 0.3, two_sided));
    }
    lights
}

#[test]
fn hard_lights_and_none_differ_by_rounding() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene("sweep.glb");
    let lights = hard_lights(scene.bounds.center());
    let found = pictures(&engine, &scene, &lights, scene.effects(), every_frame());
    assert_eq!(found.different(&lights), 0, "{:?}", found.counts);
    assert!(found.plain.iter().filter(|pixel| pixel.x > 1e-3).count() > 500, "something is lit");
    // Without lights nothing is left but the surfaces' marks
    let none = pictures(&engine, &scene, &[], Effects::DIFFUSE, every_frame());
    assert_eq!(none.plain, none.tiled);
    assert_eq!(none.count(TileClass::Empty), none.all_tiles());
}

/// The floor of the sweep under a light of each shape at this height, alone.
fn shape_scene(height: f64) -> Scene {
    let mut scene = scene("sweep.glb");
    let at = |x: f64| scene.bounds.center().with_y(scene.bounds.min.y + height) + DVec3::X * x;
    let (x, z) = (DVec3::X * 0.3, DVec3::Z * 0.2);
    let light = |name: &str, shape| Light {
        name: name.to_owned(),
        radiance: Vec3::new(1.0, 0.5, 0.25),
        shape,
        ..Light::default()
    };
    scene.lights = vec![
        light("disk", LightShape::Disk { center: at(-0.8), axis_u: x, axis_v: z }),
        light("sphere", LightShape::Sphere { center: at(0.0), radius: 0.2 }),
        light("tube", LightShape::Tube { p0: at(0.6), p1: at(1.0), radius: 0.05, ends: TubeEnds::Round }),
    ];
    scene
}

#[test]
fn tiles_list_the_shapes_that_contribute_to_them() {
    let Some(engine) = TestEngine::new() else { return };
    let shade = |height: f64| {
        let scene = shape_scene(height);
        pictures(&engine, &scene, &scene.lights, Effects::DIFFUSE, every_frame())
    };
    let above = shade(1.0);
    assert_eq!(above.plain, above.tiled);
    let lit = above.plain.iter().filter(|pixel| pixel.x > 1e-3).count();
    assert!(lit > 200, "{lit} pixels are lit");
    assert!(above.count(TileClass::Any) > 0, "{:?}", above.counts);
    assert_eq!(above.count(TileClass::Quads), 0, "{:?}", above.counts);
    let below = shade(-1.0);
    // Shapes below the horizon are left out, which the quality level may round to 1e-6 of their radiance each
    let is_same = |plain: &[Vec4], tiled: &[Vec4]| {
        plain.iter().zip(tiled).all(|(a, b)| (*a - *b).abs().max_element() <= 3e-6)
    };
    assert!(is_same(&below.plain, &below.tiled));
    assert!(below.count(TileClass::Empty) > above.count(TileClass::Empty), "{:?}", below.counts);
    let all = 3 * u64::from(below.count(TileClass::Any));
    assert!(below.counts.lights < all, "some tiles have fewer shapes: {:?}", below.counts);
    // The twin: pictures of other heights differ
    assert!(!is_same(&above.plain, &below.tiled));
}

#[test]
fn images_of_disks_are_looked_up_by_tiles_too() {
    let Some(mut engine) = TestEngine::new() else { return };
    let textures = [Texture::gradient(128, 128), Texture::from_fn(128, 128, |_, _| DVec3::ONE)].map(Arc::new);
    arealight_benches::pictures::load(&mut engine, &textures, |_| TexturePart::default()).unwrap();
    let shade = |layer| {
        let mut scene = shape_scene(1.0);
        scene.lights.retain(|light| matches!(light.shape, LightShape::Disk { .. }));
        let texture = Some(LightTexture { layer, uvs: vec![] });
        scene.lights.iter_mut().for_each(|disk| disk.texture.clone_from(&texture));
        let tiles = TileOptions { cull_threshold: 0.5, ..every_frame() };
        pictures(&engine, &scene, &scene.lights, Effects::DIFFUSE, tiles)
    };
    let found = shade(0);
    assert!(found.count(TileClass::Any) > 0, "{:?}", found.counts);
    // How bright an image is is not known, so that nothing is culled
    assert_eq!(found.plain, found.tiled);
    // The twin: with another image they differ
    assert_ne!(shade(1).tiled, found.plain);
}

#[test]
fn tiles_leave_out_lights_that_openings_hide() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene("sweep.glb");
    let center = scene.bounds.center().with_y(scene.bounds.min.y);
    let mut lights = lamps(20, center);
    let shade = |lights: &[Light]| pictures(&engine, &scene, lights, Effects::DIFFUSE, every_frame());
    let open = shade(&lights);
    for (index, lamp) in lights.iter_mut().enumerate() {
        let doors = Opening::doors(&lamp.shape, 0.1, 0.3).unwrap();
        lamp.opening = Some(Opening { housed: index % 3 > 0, ..doors });
        lamp.profile = (index % 2 == 0).then(|| Profile::cone(0.5, 1.2, 4).unwrap());
    }
    let found = shade(&lights);
    assert_eq!(found.different(&lights), 0, "{:?}", found.counts);
    let lit = found.plain.iter().filter(|pixel| pixel.x > 1e-4).count();
    assert!(lit > 100, "{lit} pixels are lit");
    // The twin: without them most tiles have more
    assert!(2 * found.counts.lights < open.counts.lights, "{:?} {:?}", found.counts, open.counts);
}

/// Where lamps are over the floor of the sweep, in rows of ten, and how bright: some are bright and most dim.
fn places(count: usize, center: DVec3) -> impl Iterator<Item = (DVec3, Vec3)> {
    let rows = count.div_ceil(10) as f64;
    (0..count).map(move |index| {
        let (column, row) = ((index % 10) as f64 - 4.5, ((index / 10) as f64 + 0.5) / rows - 0.5);
        let radiance = Vec3::new(1.0, 0.8, 0.6) * if index.is_multiple_of(7) { 20.0 } else { 0.02 };
        (center + DVec3::new(column, 1.2, 6.0 * row), radiance)
    })
}

/// Square lamps that face down.
fn lamps(count: usize, center: DVec3) -> Vec<Light> {
    let lamp = |(at, radiance): (DVec3, Vec3)| {
        let corner = |x: f64, z: f64| at + DVec3::new(0.05 * x, 0.0, 0.05 * z);
        Light {
            name: format!("lamp at {at}"),
            radiance,
            shape: LightShape::Polygon(vec![
                corner(-1.0, -1.0),
                corner(1.0, -1.0),
                corner(1.0, 1.0),
                corner(-1.0, 1.0),
            ]),
            ..Light::default()
        }
    };
    places(count, center).map(lamp).collect()
}

/// Disks that face down, spheres and tubes, in turn.
fn round_lamps(count: usize, center: DVec3) -> Vec<Light> {
    let lamp = |(index, (at, radiance)): (usize, (DVec3, Vec3))| Light {
        name: format!("lamp at {at}"),
        radiance,
        shape: match index % 3 {
            0 => LightShape::Disk { center: at, axis_u: DVec3::X * 0.06, axis_v: DVec3::Z * 0.05 },
            1 => LightShape::Sphere { center: at, radius: 0.04 },
            _ => {
                let half = DVec3::new(0.08, 0.01, 0.02);
                LightShape::Tube { p0: at - half, p1: at + half, radius: 0.02, ends: TubeEnds::Round }
            }
        },
        ..Light::default()
    };
    places(count, center).enumerate().map(lamp).collect()
}

/// The sweep, and the middle of its floor.
fn floor() -> (Scene, DVec3) {
    let scene = scene("sweep.glb");
    let center = scene.bounds.center().with_y(scene.bounds.min.y);
    (scene, center)
}

/// The most that a pixel lost, in the sum of its channels, over what it kept. What float32 rounds of hundreds
/// of lights, and pixels that nothing lights, do not count.
fn lost(all: &[Vec4], kept: &[Vec4]) -> f64 {
    let sum = |pixel: &Vec4| f64::from(pixel.x) + f64::from(pixel.y) + f64::from(pixel.z);
    let pixels = all.iter().map(sum).zip(kept.iter().map(sum));
    pixels.map(|(all, kept)| (all - kept - 1e-5 * all - 1e-6).max(0.0) / kept.max(1e-9)).fold(0.0, f64::max)
}

#[test]
fn lights_that_are_culled_contribute_less_than_the_threshold() {
    let Some(engine) = TestEngine::new() else { return };
    let tiles = TileOptions { cull_threshold: 0.05, capacity: 1000, ..every_frame() };
    // One group of 64 lights and a part, shapes among them; more than the kernel keeps the bounds of
    for (squares, rounds) in [(100, 0), (0, 100), (60, 30), (640, 0)] {
        let (scene, center) = floor();
        let (squares_of, rounds_of) = (lamps(squares, center), round_lamps(rounds, center + DVec3::X * 0.3));
        let lights = [&squares_of[..], &rounds_of[..]].concat();
        let found = pictures(&engine, &scene, &lights, scene.effects(), tiles);
        let what = lost(&found.plain, &found.tiled);
        assert!(what <= 0.05, "{squares} and {rounds}: {what}");
        let all = u64::from(found.all_tiles() - found.count(TileClass::Empty)) * (squares + rounds) as u64;
        assert!(
            found.counts.lights * 10 < all * 9,
            "{squares} and {rounds}: {} of {all}",
            found.counts.lights
        );
        // The twin: two rows of lamps too few are seen
        let few = [&squares_of[squares.min(20)..], &rounds_of[rounds.min(20)..]].concat();
        let few = plain(&engine, &scene, &few, scene.effects());
        assert!(lost(&found.plain, &few) > 0.05, "{squares} and {rounds}: {}", lost(&found.plain, &few));
    }
}

/// The lists of a frame of lamps: of each tile the polygons and the shapes.
fn lists(engine: &TestEngine, squares: usize, rounds: usize, tiles: TileOptions) -> Vec<[Vec<u32>; 2]> {
    let (scene, center) = floor();
    let lights = [lamps(squares, center), round_lamps(rounds, center + DVec3::X * 0.3)].concat();
    with_renderer(engine, &black(&scene), &lights, SIZE, |renderer| {
        let options = ShadeOptions { surfaces: scene.effects(), ..ShadeOptions::default() };
        let view = renderer.tiled(options, tiles).unwrap();
        renderer.shade_tiled(&view).unwrap();
        let lists = view.lists().unwrap();
        let mut listed: Vec<_> = lists.tiles_of(TileClass::Any).collect();
        listed.sort_unstable();
        listed.iter().map(|tile| lists.lights(*tile).expect("there is room").map(<[u32]>::to_vec)).collect()
    })
}

#[test]
fn lists_have_the_order_of_the_buffers() {
    let Some(engine) = TestEngine::new() else { return };
    let tiles = TileOptions { cull_threshold: 0.05, capacity: 1000, ..every_frame() };
    let found = lists(&engine, 150, 90, tiles);
    assert!(found.len() > 10, "{} tiles", found.len());
    let is_ascending = |list: &Vec<u32>| list.is_sorted_by(|a, b| a < b);
    assert!(found.iter().flatten().all(is_ascending));
    assert!(found.iter().all(|[polygons, shapes]| {
        polygons.last().is_none_or(|last| *last < 150) && shapes.last().is_none_or(|last| *last < 90)
    }));
    // Some list has lights of every group of 64 but not all of them
    assert!(found.iter().any(|[polygons, shapes]| {
        let group = |first: u32| polygons.iter().any(|light| (first..first + 64).contains(light));
        group(0) && group(64) && group(128) && !shapes.is_empty() && polygons.len() < 150
    }));
    // The same every time
    assert_eq!(found, lists(&engine, 150, 90, tiles));
    // The twin: with another threshold others
    assert_ne!(found, lists(&engine, 150, 90, TileOptions { cull_threshold: 0.2, ..tiles }));
}

#[test]
fn options_out_of_range_and_missing_buffers_are_refused() {
    let Some(engine) = TestEngine::new() else { return };
    let info_of =
        |tiles, table_size| ShadePassInfo { tiles: Some(tiles), table_size, ..ShadePassInfo::default() };
    let make = |tiles, table_size| engine.pass(info_of(tiles, table_size));
    let refused = |tiles, table_size| field(&make(tiles, table_size).unwrap_err());
    assert_eq!(refused(TileOptions { capacity: 0, ..every_frame() }, 64), "capacity");
    for cull_threshold in [1.0, -0.1, f32::NAN] {
        assert_eq!(refused(TileOptions { cull_threshold, ..every_frame() }, 64), "cull_threshold");
    }
    assert_eq!(refused(every_frame(), 1), "table_size");
    // A module of the host's has one for tiles too
    let own = ShadePassInfo { module: Some(SHADE.words()), ..info_of(every_frame(), 64) };
    assert_eq!(field(&engine.pass(own.clone()).unwrap_err()), "tile_module");
    engine.pass(ShadePassInfo { tile_module: Some(CLASSIFY.words()), ..own }).unwrap();

    let pass = make(every_frame(), 64).unwrap();
    let needed = pass.tile_memory([17, 8]).unwrap();
    assert_eq!(needed.size, arealight::tiles::memory([17, 8], every_frame().capacity));
    assert!(needed.usage.contains(vk::BufferUsageFlags::INDIRECT_BUFFER));
    let plain = engine.pass(ShadeOptions::default()).unwrap();
    assert_eq!((plain.tile_memory([17, 8]), plain.tiles()), (None, None));
    let names = |pass: &ShadePass| pass.accesses().iter().map(|access| access.name).collect::<Vec<_>>();
    assert!(names(&pass).contains(&"lobe_horizons") && !names(&plain).contains(&"lobe_horizons"));
    let (scene, _) = floor();
    with_renderer(&engine, &black(&scene), &scene.lights, SIZE, |renderer| {
        let view = renderer.tiled(ShadeOptions::default(), every_frame()).unwrap();
        let (resources, frame) = renderer.tiled_run(&view);
        let none = vk::DescriptorSet::null();
        // SAFETY: Nothing is written or recorded where an error is returned.
        unsafe {
            let without = ShadeResources { tile_lists: None, ..resources };
            assert_eq!(field(&pass.write_set(none, &without).unwrap_err()), "tile_lists");
            let without = ShadeResources { lobe_horizons: None, ..resources };
            assert_eq!(field(&pass.write_set(none, &without).unwrap_err()), "lobe_horizons");
            for lists in [None, resources.planes[Plane::Position], Some(Resource::buffer(vk::Buffer::null()))]
            {
                let frame = ShadeFrame { tile_lists: lists, ..frame };
                let error = pass.record(vk::CommandBuffer::null(), none, &frame).unwrap_err();
                assert_eq!(field(&error), "tile_lists");
                assert_eq!(field(&pass.prepare(&frame).unwrap_err()), "tile_lists");
            }
        }
        // The twin: with them the frame is right
        pass.prepare(&frame).unwrap();
    });
}
