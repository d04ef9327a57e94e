//! Stencil tests: pixels that fail stay as they are, whatever a frame does to others.

use arealight_tests::floor::SIZE;
use arealight_tests::prelude::*;
use arealight_vk::StencilTest;

/// The kernels' own rounding.
const BOUND: f64 = 1e-4;

/// A stencil with all eight bits in use, of whole tiles and of single pixels.
fn stencil([x, y]: [u32; 2]) -> u8 {
    let blocks = u32::from(x < 16 && y < 8) << 7;
    (blocks | ((x * 7 + y * 3) % 128)) as u8
}

#[test]
fn pixels_that_fail_the_stencil_test_stay_as_they_are() {
    let Some(engine) = TestEngine::new() else { return };
    let floor = Floor::new(&engine, &lamps());
    let stencils: Vec<u8> = pixels().map(stencil).collect();
    let image = image(&engine, SIZE, vk::Format::R8_UINT, vk::ImageUsageFlags::SAMPLED, &stencils);
    let planes = floor.resources().planes.with(Plane::Stencil, Some(read(&image)));
    let resources = ShadeResources { planes, ..floor.resources() };
    for (tiles, output, compare_mask, reference) in [
        (false, Output::Overwrite, 0x83, 0x02),
        (false, Output::Add, 0x80, 0x80),
        // Tiles of which no pixel passes are there, and those of which some do
        (true, Output::Overwrite, 0x80, 0x80),
        (true, Output::Add, 0xc1, 0x41),
    ] {
        let options = ShadeOptions { stencil: true, output, ..ShadeOptions::default() };
        let test = StencilTest { compare_mask, reference };
        let frame = ShadeFrame { stencil: test, ..floor.frame() };
        let found = floor.shade(options, tiles, (&resources, &frame, Descriptors::Sets));
        let mut passed = 0;
        for (pixel, found) in pixels().zip(found) {
            if stencil(pixel) & compare_mask != reference & compare_mask {
                assert_eq!(found, BEFORE, "{pixel:?} fails {test:?}");
                continue;
            }
            passed += 1;
            let before = if output == Output::Add { BEFORE.truncate().as_dvec3() } else { DVec3::ZERO };
            let expected = before + floor.expected(pixel, |_| true);
            let error = (found.truncate().as_dvec3() - expected).abs().max_element();
            assert!(error < BOUND, "{pixel:?}, {test:?}, tiles {tiles}: {found} is not {expected}");
            assert!((found.w - 1.0).abs() < f32::EPSILON);
        }
        assert!((20..pixels().count() / 2).contains(&passed), "{passed} pixels pass {test:?}");
    }
    // The twin: a mask of no bits passes everything
    let options = ShadeOptions { stencil: true, ..ShadeOptions::default() };
    let found = floor.shade(options, false, (&resources, &floor.frame(), Descriptors::Sets));
    assert!(found.iter().all(|texel| *texel != BEFORE));
}

#[test]
fn a_stencil_that_is_not_there_is_named() {
    let Some(engine) = TestEngine::new() else { return };
    let floor = Floor::new(&engine, &lamps());
    let options = ShadeOptions { stencil: true, ..ShadeOptions::default() };
    // SAFETY: Nothing is recorded; the pass and the pool are dropped before the engine.
    unsafe {
        let pass = engine.pass(options).unwrap();
        let pool = engine.host().descriptor_pool(1, &pass.pool_sizes(1)).unwrap();
        let set = pool.allocate(pass.set_layout()).unwrap();
        assert_eq!(field(&pass.write_set(set, &floor.resources()).unwrap_err()), "stencil");
    }
    let rays = ShadeOptions { shadow_rays: 1, ..options };
    assert_eq!(field(&engine.pass(rays).unwrap_err()), "stencil");
}
