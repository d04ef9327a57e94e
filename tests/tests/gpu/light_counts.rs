//! How many lights a frame has, said by a buffer that the GPU wrote.

use arealight::gpu::LightCounts;
use arealight_tests::prelude::*;

/// The largest difference from what these numbers of lights of the buffers give.
fn worst(floor: &Floor<'_>, counts: LightCounts, found: &[Vec4]) -> f64 {
    let (lights, shapes) = (counts.light_count as usize, counts.shape_count as usize);
    let packed = &floor.lights.packed;
    let shaded: Vec<u32> =
        packed.order.iter().take(lights).chain(packed.shape_order.iter().take(shapes)).copied().collect();
    let error = |(pixel, found): ([u32; 2], &Vec4)| {
        let expected: DVec3 = floor.expected(pixel, |index| shaded.contains(&(index as u32)));
        (found.truncate().as_dvec3() - expected).abs().max_element()
    };
    pixels().zip(found).map(error).fold(0.0, f64::max)
}

#[test]
fn counts_of_a_buffer_are_how_many_lights_are_shaded() {
    let Some(engine) = TestEngine::new() else { return };
    let floor = Floor::new(&engine, &lamps());
    let summary = floor.lights.packed.summary();
    assert_eq!([summary.light_count, summary.quad_count, summary.shape_count], [4, 4, 3]);
    let most = LightCounts { light_count: 4, shape_count: 3, quad_count: 4 };
    let options = ShadeOptions { light_counts: true, ..ShadeOptions::default() };
    for tiles in [false, true] {
        for (written, shaded) in [
            (LightCounts { light_count: 2, shape_count: 1, quad_count: 2 }, None),
            (LightCounts { light_count: 3, shape_count: 0, quad_count: 0 }, None),
            (LightCounts::default(), None),
            // More than there is room for is what there is
            (LightCounts { light_count: 900, shape_count: u32::MAX, quad_count: 70 }, Some(most)),
            // No more quads than lights
            (LightCounts { light_count: 1, shape_count: 3, quad_count: 4 }, None),
        ] {
            let buffer = engine.host().storage_buffer("counts", &[written]).unwrap();
            let light_counts = Some(Resource::buffer(buffer.handle()));
            let resources = ShadeResources { light_counts, ..floor.resources() };
            let found = floor.shade(options, tiles, (&resources, &floor.frame(), Descriptors::Sets));
            let worst_of = |counts| worst(&floor, counts, &found);
            let error = worst_of(shaded.unwrap_or(written));
            assert!(error < 1e-4, "{written:?}, tiles {tiles}: {error:e}");
            // The twin: another light fewer
            let fewer =
                LightCounts { light_count: written.light_count.clamp(1, 4) - 1, ..shaded.unwrap_or(written) };
            assert!(written.light_count == 0 || worst_of(fewer) > 1e-2);
        }
    }
}
