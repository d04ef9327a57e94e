//! Hosts that have shadows of their own: a function of theirs says what part of a light arrives, or what
//! blocks a ray, and reads a set of theirs.

use crate::shadows::{flat, options, surfaces, symmetric_lights};
use arealight_engine::host::{Buffer, OwnSet};
use arealight_tests::c_library::prelude::*;
use arealight_tests::kernel::{shade_with_visibility, shadow_rays_with_bridge};
use arealight_tests::prelude::*;
use arealight_tests::shadow_patch::{PatchPasses, SIDE, ShadowPatch};
use ash::vk::Handle as _;

/// Rays that ask a host by this macro of the examples, who reads a buffer, and a patch behind blockers.
fn asking<'a>(
    engine: &'a TestEngine,
    macro_name: &str,
    (number, buffer): (u32, &Buffer),
    blockers: Vec<[Vec3; 3]>,
) -> (PatchPasses<'a>, ShadowPatch, OwnSet) {
    // SAFETY: The callers' buffer outlives the set.
    let own = unsafe { engine.host().own_set(number, &[Resource::buffer(buffer.handle())]) }.unwrap();
    let module = shadow_rays_with_bridge(macro_name);
    let mut passes = PatchPasses::with_blocker(engine, options(), (module, own.layout));
    passes.blocker_set = Some(own.set);
    let (_, material, view) = surfaces().remove(0);
    let (_, light) = symmetric_lights().remove(0);
    (passes, ShadowPatch { material, view, lights: vec![light], blockers }, own)
}

#[test]
fn a_host_says_itself_what_blocks() {
    let Some(engine) = TestEngine::new() else { return };
    let host = engine.host();
    let half = [[-100.0_f32, 0.0, 0.01, 0.0], [100.0, 100.0, 0.0, 0.0]];
    let rectangle = host.storage_buffer("rectangle", &half).unwrap();
    let (passes, patch, _own) = asking(&engine, "AREALIGHT_HOST_BLOCKER", (0, &rectangle), vec![]);
    let found = patch.run(&passes).mean();
    assert!((found - 0.5).abs() < 4e-3, "{found}");
    // The twin: its rectangle elsewhere
    rectangle.upload(&[[0.0_f32, 0.0, -1.0, 0.0], [0.0; 4]]).unwrap();
    assert!((patch.run(&passes).mean() - 1.0).abs() < 1e-6);
}

#[test]
fn a_host_says_what_is_there_of_triangles_that_are_cut_out() {
    let Some(engine) = TestEngine::new() else { return };
    let host = engine.host();
    // A plate over everything, there where its coordinate is below a half, which is where y is positive
    let [a, b, c, d] = [(-100.0, -100.0), (100.0, -100.0), (100.0, 100.0), (-100.0, 100.0)]
        .map(|(x, y)| Vec3::new(x, y, 0.01));
    let coordinates = |triangle: [Vec3; 3]| triangle.map(|vertex| [0.5 - vertex.y / 400.0, 0.0]);
    let blockers = vec![[a, b, c], [a, c, d]];
    let half: Vec<[[f32; 2]; 3]> = blockers.iter().copied().map(coordinates).collect();
    let alpha = host.storage_buffer("coordinates", &half).unwrap();
    let (passes, patch, _own) = asking(&engine, "AREALIGHT_HOST_ALPHA", (1, &alpha), blockers);
    let found = patch.run(&passes).mean();
    assert!((found - 0.5).abs() < 4e-3, "{found}");
    // The twin: a pass that asks nobody
    let plain = PatchPasses::new(&engine, options(), ShadowFilter::Off);
    assert_eq!(patch.run(&plain).mean(), 0.0);
}

#[test]
fn a_host_multiplies_each_light_with_what_its_shadow_maps_say() {
    let Some(engine) = TestEngine::new() else { return };
    let host = engine.host();
    // Of two lights one arrives by a quarter in the left half of the image, the other one by a half
    // everywhere
    let masks = host
        .image(&ImageDescription {
            name: "shadow masks",
            extent: [SIDE; 2],
            layers: 2,
            format: vk::Format::R32_SFLOAT,
            usage: vk::ImageUsageFlags::SAMPLED,
        })
        .unwrap();
    let first = (0..SIDE * SIDE).map(|pixel| if pixel % SIDE < SIDE / 2 { 0.25_f32 } else { 1.0 });
    let second = (0..SIDE * SIDE).map(|_| 0.5_f32);
    masks.upload(&first.chain(second).collect::<Vec<_>>(), Usage::COMPUTE_READ).unwrap();
    let layout = Usage::COMPUTE_READ.layout;
    // SAFETY: The image outlives the set.
    let own = unsafe { host.own_set(0, &[Resource::SampledImage { view: masks.array_view(), layout }]) };
    let own = own.unwrap();
    let options = ShadeOptions { shadow_rays: 1, ..options() };
    let lights = [
        flat(1.5, &[[0.2, -0.6], [0.2, 0.6], [1.5, 0.6], [1.5, -0.6]]),
        flat(2.0, &[[-1.5, -0.6], [-1.5, 0.6], [-0.2, 0.6], [-0.2, -0.6]]),
    ];
    for (surface, material, view) in surfaces() {
        let patch = ShadowPatch { material, view, lights: lights.to_vec(), blockers: Vec::new() };
        let plain = PatchPasses::new(&engine, options, ShadowFilter::Off);
        let alone = lights
            .clone()
            .map(|light| ShadowPatch { lights: vec![light], ..patch.clone() }.run(&plain).unshadowed[0]);
        let mut passes =
            PatchPasses::with_visibility(&engine, options, (shade_with_visibility(), own.layout));
        passes.visibility_set = Some(own.set);
        let found = patch.run(&passes).unshadowed;
        for (pixel, found) in found.iter().enumerate() {
            let is_left = pixel as u32 % SIDE < SIDE / 2;
            let expected = alone[0] * if is_left { 0.25 } else { 1.0 } + alone[1] * 0.5;
            // A sum in float32
            assert!((*found - expected).abs().max_element() <= 1e-6 * expected.max_element(), "{surface}");
        }
        // The twin: the halves differ
        assert_ne!(found[0], found[SIDE as usize - 1], "{surface}");
    }
    // Through the C library, of a pixel in the left half
    let (library, pixel) = (CLibrary::with_table(&engine), OnePixel::new(&engine, Vec4::W, 1.0));
    let shade = |module: ArealightModule| {
        let pass = library.pass_with(&ArealightPassOptions { module, ..ArealightPassOptions::default() });
        let found = library.shade(pass, &pixel, &[c_lamp(&lights[0])], ArealightImage::default(), Vec3::Z);
        // SAFETY: nothing is pending.
        good(unsafe { arealight_pass_destroy(pass) });
        found.truncate()
    };
    let plain = shade(ArealightModule::default());
    library.host_set.set(own.set.as_raw());
    let words = shade_with_visibility();
    let (size, host_set_layout) = (size_of_val(&words[..]), own.layout.as_raw());
    let found = shade(ArealightModule { words: words.as_ptr(), size, host_set_layout });
    assert!(plain.min_element() > 0.0 && found == plain * 0.25, "{found} of {plain}");
}
