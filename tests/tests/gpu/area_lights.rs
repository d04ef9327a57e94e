//! The object that owns all that shading needs: it draws what the recorder does.

use arealight::plan::{MediumOptions, ShadowFilter, ShadowHistory};
use arealight::{Blockers, TexturePart};
use arealight_tests::floor::{SIZE, position};
use arealight_tests::prelude::*;
use arealight_vk::gpu_allocator::{AllocationSizes, AllocatorDebugSettings, vulkan};
use arealight_vk::{AreaLights, AreaLightsInfo, MediumFrame, TextureUpdate, Viewport};
use glam::{DAffine3, Mat4};
use std::sync::Mutex;

/// Area lights on the engine's device, and where their memory is from.
fn make(
    engine: &TestEngine,
    info: &AreaLightsInfo,
) -> Result<(AreaLights, Arc<Mutex<vulkan::Allocator>>), Error> {
    let host = engine.host();
    let allocator = vulkan::Allocator::new(&vulkan::AllocatorCreateDesc {
        instance: host.instance().clone(),
        device: host.device().clone(),
        physical_device: host.physical_device(),
        debug_settings: AllocatorDebugSettings::default(),
        buffer_device_address: false,
        allocation_sizes: AllocationSizes::default(),
    });
    let allocator = Arc::new(Mutex::new(allocator.unwrap()));
    // SAFETY: The handles belong together, and submissions are waited for.
    let made = unsafe {
        let (instance, device) = (host.instance(), host.device());
        AreaLights::new(instance, host.physical_device(), device, Arc::clone(&allocator), info)
    };
    made.map(|made| (made, allocator))
}

/// Does something with area lights on the engine's device, and sees that all memory was given back.
fn with_area_lights(engine: &TestEngine, info: &AreaLightsInfo, act: impl FnOnce(&mut AreaLights)) {
    let (mut area_lights, allocator) = make(engine, info).unwrap();
    act(&mut area_lights);
    drop(area_lights);
    let left = allocator.lock().unwrap().generate_report().total_allocated_bytes;
    assert_eq!(left, 0, "bytes were not given back");
}

/// The picture of a floor under its lights, of the frame at a place.
fn picture(
    area_lights: &mut AreaLights,
    place: usize,
    (floor, lights): (&Floor<'_>, &[Light]),
    view: &ShadeFrame,
) -> Vec<Vec4> {
    picture_at(DVec3::ZERO, area_lights, place, (floor, lights), view)
}

/// The same where all of that is elsewhere.
fn picture_at(
    origin: DVec3,
    area_lights: &mut AreaLights,
    place: usize,
    (floor, lights): (&Floor<'_>, &[Light]),
    view: &ShadeFrame,
) -> Vec<Vec4> {
    let there: Vec<Light> =
        lights.iter().map(|light| light.moved(&DAffine3::from_translation(origin))).collect();
    // The object has a table and buffers of its own
    let nothing = ShadeResources::default();
    let ShadeResources { table, lights: records, light_vertices, .. } = nothing;
    let g_buffer =
        ShadeResources { table, lights: records, light_vertices, shapes: None, ..floor.resources() };
    floor.picture_after(|commands| {
        // SAFETY: The frame is waited for, and the images outlive it.
        unsafe { area_lights.shade(commands, place, &there, origin, view, &g_buffer) }.unwrap();
    })
}

fn many() -> Vec<Light> {
    lamps().into_iter().cycle().take(30).collect()
}

#[test]
fn frames_of_any_lights_and_sizes_are_those_of_the_recorder() {
    let Some(engine) = TestEngine::new() else { return };
    let small = [SIZE[0] - 9, SIZE[1] - 10];
    for tiles in [None, Some(TileOptions { least_quads: 0, ..TileOptions::default() })] {
        let options = ShadeOptions::default();
        let info = AreaLightsInfo { options, tiles, ..AreaLightsInfo::default() };
        with_area_lights(&engine, &info, |area_lights| {
            let mut pictures = vec![];
            // Each place is used again, for more lights and for fewer, and for more pixels and fewer
            for (number, (lights, size)) in
                [(vec![lamp()], small), (many(), SIZE), (lamps(), SIZE), (vec![], small), (lamps(), SIZE)]
                    .into_iter()
                    .enumerate()
            {
                let floor = Floor::new(&engine, &lights);
                let view = ShadeFrame { size, ..floor.frame() };
                area_lights.prepare(&lights, &view).unwrap();
                let ours = picture(area_lights, number % 2, (&floor, &lights), &view);
                let resources = floor.resources();
                let theirs = floor.shade(options, tiles.is_some(), (&resources, &view, Descriptors::Sets));
                assert!(ours == theirs, "frame {number}");
                pictures.push(ours);
            }
            // The twin: other lights make other pictures, and the same ones the same
            assert_eq!(pictures[2], pictures[4]);
            for (one, other) in [(0, 1), (1, 2), (2, 3)] {
                assert_ne!(pictures[one], pictures[other]);
            }
        });
    }
}

#[test]
fn what_blocks_darkens_and_what_does_not_changes_nothing() {
    let Some(engine) = TestEngine::new() else { return };
    let (floor, lights) = (Floor::new(&engine, &[lamp()]), [lamp()]);
    let view = floor.frame();
    for output in [Output::Overwrite, Output::Add] {
        let options = ShadeOptions { output, ..ShadeOptions::default() };
        let unshadowed = floor.shade(options, false, (&floor.resources(), &view, Descriptors::Sets));
        let info = AreaLightsInfo {
            options: ShadeOptions { shadow_rays: 2, ..options },
            shadow_filter: ShadowFilter::Gather,
            ..AreaLightsInfo::default()
        };
        with_area_lights(&engine, &info, |area_lights| {
            let frame =
                |area_lights: &mut AreaLights, place| picture(area_lights, place, (&floor, &lights), &view);
            let free = frame(area_lights, 0);
            for (ours, theirs) in free.iter().zip(&unshadowed) {
                assert!(
                    (*ours - *theirs).abs().max_element() <= 1e-6 * theirs.max_element(),
                    "{ours} {theirs}"
                );
            }
            // Far larger than the lamp, right above the floor
            let corners = [[-50.0, -50.0], [50.0, -50.0], [50.0, 50.0], [-50.0, 50.0]];
            let [a, b, c, d] = corners.map(|[x, y]| Vec3::new(x, y, 0.01));
            let sheet = Blockers::new(&[[a, b, c], [a, c, d]]).unwrap();
            // Those of another origin than the frame's are refused, not elsewhere
            area_lights.set_blockers(&sheet, DVec3::X).unwrap();
            let (commands, resources) = (vk::CommandBuffer::null(), floor.resources());
            // SAFETY: Nothing is recorded where an error is returned.
            let refused = unsafe { area_lights.shade(commands, 1, &lights, DVec3::ZERO, &view, &resources) };
            assert_eq!(field(&refused.unwrap_err()), "origin");
            area_lights.set_blockers(&sheet, DVec3::ZERO).unwrap();
            let dark = frame(area_lights, 1);
            let black = if output == Output::Add { BEFORE } else { Vec4::ZERO };
            // What is taken away may be rounded in another way than what was there
            let brightest =
                free.iter().fold(0.0, |most: f32, texel| most.max(texel.truncate().max_element()));
            let bound = Vec3::splat(engine.rounding() * brightest);
            let is_black = |texel: &Vec4| (*texel - black).truncate().abs().cmple(bound).all();
            assert!(dark.iter().all(is_black), "{:?}", dark.iter().find(|texel| !is_black(texel)));
            area_lights.set_blockers(&Blockers::new(&[]).unwrap(), DVec3::X).unwrap();
            assert_eq!(frame(area_lights, 0), free);
            // The twin: there was something to darken
            assert!(free.iter().filter(|texel| texel.x > black.x + 0.01).count() > free.len() / 4);
        });
    }
}

#[test]
fn shadows_of_frames_before_take_noise_away_until_they_are_forgotten() {
    let Some(engine) = TestEngine::new() else { return };
    let (floor, lights) = (Floor::new(&engine, &[lamp()]), [lamp()]);
    // From clip space to the positions of the floor's pixels
    let position_from_clip =
        Mat4::from_cols(3.7 * Vec4::X, -2.1 * Vec4::Y, Vec4::Z, Vec4::new(-0.1, 0.5, 0.0, 1.0));
    let view = ShadeFrame { position_from_clip: Some(position_from_clip), ..floor.frame() };
    let [a, b, c] = [[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 1.0));
    let blockers = Blockers::new(&[[a, b, c]]).unwrap();
    // A film by one ray a pixel; its last frame may be moved, or larger than the ones before
    let film = |shadow_history, count, forgets, (before, moved): ([u32; 2], f64)| {
        let options = ShadeOptions { shadow_rays: 1, ..ShadeOptions::default() };
        let shadow_filter = ShadowFilter::Off;
        let info = AreaLightsInfo { options, shadow_filter, shadow_history, ..AreaLightsInfo::default() };
        let mut pictures = vec![];
        with_area_lights(&engine, &info, |area_lights| {
            for number in 1..=count {
                let (size, origin) = if number < count { (before, 0.0) } else { (SIZE, moved) };
                if forgets && number == count {
                    area_lights.forget_shadows();
                }
                let origin = DVec3::X * origin;
                area_lights.set_blockers(&blockers, origin).unwrap();
                let (view, floor) = (ShadeFrame { size, ..view }, (&floor, &lights[..]));
                pictures.push(picture_at(origin, area_lights, number % 2, floor, &view));
            }
        });
        pictures
    };
    let truth = film(ShadowHistory::Off, 128, false, (SIZE, 0.0));
    let error = |picture: &[Vec4]| {
        let mean = |index: usize| truth.iter().map(|one| one[index]).sum::<Vec4>() / truth.len() as f32;
        picture.iter().enumerate().map(|(index, texel)| (*texel - mean(index)).length_squared()).sum::<f32>()
    };
    let frames = 9;
    let kept = film(ShadowHistory::Camera, frames, false, (SIZE, 0.0));
    let forgotten = film(ShadowHistory::Camera, frames, true, (SIZE, 0.0)).pop().unwrap();
    // The variance of a mean of nine is a ninth; what is compared is a mean itself, and some of them shorter
    assert!(error(&kept[8]) < 0.25 * error(&kept[0]), "{} {}", error(&kept[8]), error(&kept[0]));
    assert!(error(&forgotten) > 0.7 * error(&kept[0]), "{} {}", error(&forgotten), error(&kept[0]));
    // So is it where pictures were smaller, or of a place that is not in the picture
    for other in [([8, 8], 0.0), (SIZE, 100.0)] {
        assert!(film(ShadowHistory::Camera, frames, false, other).pop().unwrap() == forgotten);
    }
}

#[test]
fn media_dim_what_is_shaded_and_scatter_light_that_nothing_blocks() {
    let Some(engine) = TestEngine::new() else { return };
    let (floor, lights) = (Floor::new(&engine, &[lamp()]), [lamp()]);
    let view = ShadeFrame { position_from_clip: Some(Mat4::IDENTITY), ..floor.frame() };
    let medium = MediumFrame {
        froxels: [4, 3, 64],
        extinction: 0.2,
        anisotropy: 0.5,
        nearest: 1.0,
        farthest: 16.0,
        ..MediumFrame::default()
    };
    for (field, options) in [
        ("samples", ShadeOptions { samples: 4, ..ShadeOptions::default() }),
        ("orthographic", ShadeOptions { orthographic: true, ..ShadeOptions::default() }),
    ] {
        let medium = Some((MediumOptions::default(), medium));
        let made = make(&engine, &AreaLightsInfo { options, medium, ..AreaLightsInfo::default() });
        assert_eq!(self::field(&made.err().unwrap()), field);
    }
    for shadow_rays in [0, 1] {
        let options = ShadeOptions { shadow_rays, ..ShadeOptions::default() };
        let rays = MediumOptions { shadow_rays: shadow_rays > 0, ..MediumOptions::default() };
        let clear = AreaLightsInfo { options, ..AreaLightsInfo::default() };
        let mut pictures = vec![];
        with_area_lights(&engine, &clear, |area_lights| {
            pictures.push(picture(area_lights, 0, (&floor, &lights), &view));
        });
        with_area_lights(&engine, &AreaLightsInfo { medium: Some((rays, medium)), ..clear }, |area_lights| {
            pictures.push(picture(area_lights, 0, (&floor, &lights), &view));
            *area_lights.medium_mut().unwrap() =
                MediumFrame { scattering: Vec3::ONE, froxels: [5, 4, 32], ..medium };
            pictures.push(picture(area_lights, 0, (&floor, &lights), &view));
            // y up in clip space
            let [width, height] = SIZE.map(|side| side as f32);
            let up = Viewport { y: height, width, height: -height, max_depth: 1.0, ..Viewport::default() };
            let position_from_clip = Some(Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0)));
            let view = ShadeFrame { viewport: Some(up), position_from_clip, ..view };
            let upright = picture(area_lights, 0, (&floor, &lights), &view);
            assert!(shadow_rays > 0 || upright == pictures[2]);
            // SAFETY: Nothing is recorded where an error is returned.
            let mut refused = |view: &ShadeFrame| unsafe {
                let commands = vk::CommandBuffer::null();
                area_lights.shade(commands, 0, &lights, DVec3::ZERO, view, &floor.resources())
            };
            let (rows, position_from_clip) = (Some([0, 8]), None);
            for view in [ShadeFrame { rows, ..view }, ShadeFrame { position_from_clip, ..view }] {
                assert!(matches!(refused(&view), Err(Error::InvalidArgument { .. })));
            }
        });
        for (pixel, clear) in pixels().zip(&pictures[0]) {
            let away = position(pixel).distance(view.camera);
            let [_, dim, bright] =
                [0, 1, 2].map(|index| pictures[index][(pixel[1] * SIZE[0] + pixel[0]) as usize]);
            let expected = clear.truncate() * (-0.2 * away).exp();
            // Froxels have 11 bits
            assert!(
                (dim.truncate() - expected).abs().cmple(2e-3 * expected + 1e-6).all(),
                "{dim} {expected}"
            );
            assert!(bright.truncate().cmpgt(dim.truncate()).all(), "{bright} {dim}");
        }
    }
}

#[test]
fn images_on_lights_are_loaded_before_a_frame() {
    let Some(engine) = TestEngine::new() else { return };
    let (format, sampled) = (vk::Format::R32G32B32A32_SFLOAT, vk::ImageUsageFlags::SAMPLED);
    let red = image(&engine, [4; 2], format, sampled, &[[1.0_f32, 0.0, 0.0, 1.0]; 16]);
    let uvs = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(DVec2::from_array).to_vec();
    let LightShape::Polygon(corners) = lamp().shape else { unreachable!("a polygon") };
    assert_eq!(corners.len(), uvs.len());
    let light = Light { texture: Some(LightTexture { layer: 1, uvs }), ..lamp() };
    let lights = [light];
    let floor = Floor::new(&engine, &lights);
    let info =
        AreaLightsInfo { textures: Some((PyramidSize::new(64).unwrap(), 2)), ..AreaLightsInfo::default() };
    with_area_lights(&engine, &info, |area_lights| {
        let update = TextureUpdate {
            layer: 1,
            source_set: vk::DescriptorSet::null(),
            source_size: [4; 2],
            part: TexturePart::default(),
            decode_srgb: false,
        };
        // Black before it is loaded
        let black = picture(area_lights, 0, (&floor, &lights), &floor.frame());
        assert!(black.iter().all(|texel| texel.truncate() == Vec3::ZERO));
        for place in [1, 0, 1] {
            let images = [(read(&red), update)];
            let none = [(read(&red), TextureUpdate { layer: 9, ..update })];
            let mut load = |commands, images| {
                // SAFETY: The commands are waited for, and the image outlives them.
                unsafe { area_lights.load_textures(commands, place, images) }.is_ok()
            };
            // As often as the host likes; what is refused changes nothing
            let mut loads = |commands| [&images, &none, &images].map(|images| load(commands, images));
            let mut loaded = [false; 3];
            engine.host().submit(|commands| loaded = loads(commands)).unwrap();
            assert_eq!(loaded, [true, false, true]);
            let lit = picture(area_lights, place, (&floor, &lights), &floor.frame());
            assert!(lit.iter().all(|texel| texel.y == 0.0 && texel.z == 0.0));
            assert!(lit.iter().filter(|texel| texel.x > 0.01).count() > lit.len() / 4);
        }
        // A layer that is not there
        let beyond = [Light {
            texture: lights[0].texture.clone().map(|one| LightTexture { layer: 2, ..one }),
            ..lamp()
        }];
        // SAFETY: Nothing is recorded where an error is returned.
        let error = unsafe {
            let commands = vk::CommandBuffer::null();
            area_lights.shade(commands, 0, &beyond, DVec3::ZERO, &floor.frame(), &floor.resources())
        };
        assert!(matches!(error, Err(Error::Light(_))), "{error:?}");
    });
}

#[test]
fn mistakes_are_named() {
    let Some(engine) = TestEngine::new() else { return };
    let floor = Floor::new(&engine, &[lamp()]);
    let commands = vk::CommandBuffer::null();
    let field = |result: Result<(), Error>| field(&result.unwrap_err());
    with_area_lights(&engine, &AreaLightsInfo::default(), |area_lights| {
        // SAFETY: Nothing is recorded where an error is returned.
        let mut shade = |place, view: &ShadeFrame, g_buffer: &ShadeResources| unsafe {
            field(area_lights.shade(commands, place, &[lamp()], DVec3::ZERO, view, g_buffer))
        };
        assert_eq!(shade(2, &floor.frame(), &floor.resources()), "place");
        assert_eq!(shade(0, &ShadeFrame { size: [0, 4], ..floor.frame() }, &floor.resources()), "size");
        let mut without = floor.resources();
        without.planes[Plane::Normal] = None;
        assert_eq!(shade(0, &floor.frame(), &without), Plane::Normal.name());
        let nothing = Blockers::new(&[]).unwrap();
        assert_eq!(field(area_lights.set_blockers(&nothing, DVec3::ZERO)), "blockers");
        // SAFETY: As above.
        assert_eq!(field(unsafe { area_lights.load_textures(commands, 0, &[]) }), "textures");
        // The twin: the next frame is drawn
        let lit = picture(area_lights, 0, (&floor, &[lamp()]), &floor.frame());
        assert!(lit.iter().any(|texel| texel.x > 0.1));
    });
}
