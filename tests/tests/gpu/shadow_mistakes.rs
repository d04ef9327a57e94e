//! What a host may get wrong about shadows: each is an error that names the field, and nothing is recorded.

use arealight_tests::prelude::*;
use arealight_vk::{
    BlockerResources, ShadowFrame, ShadowOptions, ShadowPass, ShadowPassInfo, ShadowResources,
};

fn with_rays(shadow_rays: u32) -> ShadeOptions {
    ShadeOptions { shadow_rays, ..ShadeOptions::default() }
}

fn info(options: ShadeOptions, shadows: ShadowOptions) -> ShadowPassInfo {
    ShadowPassInfo { options, shadows, ..ShadowPassInfo::default() }
}

#[test]
fn options_that_no_shadow_can_be_made_with_are_refused() {
    let Some(engine) = TestEngine::new() else { return };
    let refused = |options: ShadeOptions| engine.pass(options).err().map(|error| field(&error));
    assert_eq!(refused(with_rays(5)), Some("shadow_rays"));
    let adds = ShadeOptions { output: Output::Add, ..with_rays(1) };
    assert_eq!(refused(adds), Some("output"));
    let separate = ShadeOptions { separate_lobes: true, ..with_rays(1) };
    assert_eq!(refused(separate), Some("separate_lobes"));
    // The twins
    assert_eq!(refused(with_rays(4)), None);
    assert_eq!(refused(ShadeOptions { shadow_rays: 0, ..adds }), None);
    assert_eq!(refused(ShadeOptions { shadow_rays: 0, ..separate }), None);

    for (rays, is_refused) in [(0, true), (5, true), (1, false)] {
        let info = info(with_rays(rays), ShadowOptions::default());
        // SAFETY: A pass that is made is dropped unused.
        let made = unsafe { ShadowPass::new(engine.context(), info) };
        assert_eq!(made.err().map(|error| field(&error)), is_refused.then_some("shadow_rays"));
    }
}

#[test]
fn what_a_shadow_pass_reads_is_asked_for() {
    let Some(engine) = TestEngine::new() else { return };
    let options = with_rays(1);
    let history = ShadowOptions {
        filter: ShadowFilter::Gather,
        history: ShadowHistory::MotionVectors,
        output: Output::Overwrite,
    };
    // SAFETY: The passes are dropped unused; sets are null where an error comes first.
    unsafe {
        let shade = engine.pass(options).unwrap();
        let shadow = ShadowPass::new(engine.context(), info(options, ShadowOptions::default())).unwrap();
        let over_frames = ShadowPass::new(engine.context(), info(options, history)).unwrap();
        let scene = scene("sweep.glb");
        with_renderer(&engine, &scene, &scene.lights, [8, 8], |renderer| {
            let view = renderer.tiled(ShadeOptions::default(), TileOptions::default()).unwrap();
            let (resources, _) = renderer.tiled_run(&view);
            let none = vk::DescriptorSet::null();
            let is = |error: Result<(), Error>, name: &str| assert_eq!(field(&error.unwrap_err()), name);
            is(shade.write_set(none, &resources), "picks");
            let buffer = resources.lights;
            let mut of_shadows =
                ShadowResources { shadow: resources.radiance, radiance: None, history: None, blockers: None };
            is(shadow.write_set(none, &resources, &of_shadows), "picks");
            let planes = resources.planes.with(Plane::Motion, None);
            let resources = ShadeResources { picks: Some(buffer), planes, ..resources };
            is(shadow.write_set(none, &resources, &of_shadows), "blockers");
            is(over_frames.write_set(none, &resources, &of_shadows), "history");
            of_shadows.history = Some(buffer);
            is(over_frames.write_set(none, &resources, &of_shadows), "motion");
            of_shadows.blockers = Some(BlockerResources { nodes: buffer, triangles: buffer });
            // Lights that the set was written without
            let pool = engine.host().descriptor_pool(1, &shadow.pool_sizes(1)).unwrap();
            let set = pool.allocate(shadow.set_layout()).unwrap();
            shadow.write_set(set, &ShadeResources { shapes: None, ..resources }, &of_shadows).unwrap();
            let lights = LightSummary { light_count: 1, shape_count: 1, ..LightSummary::default() };
            let shade = &ShadeFrame { lights, size: [8, 8], ..ShadeFrame::default() };
            let frame = ShadowFrame { shade, origin_shift: Vec3::ZERO };
            is(shadow.record(vk::CommandBuffer::null(), set, &of_shadows, &frame), "shapes");
            of_shadows.shadow = Resource::buffer(vk::Buffer::null());
            let planes = resources.planes.with(Plane::Motion, resources.planes[Plane::Position]);
            let resources = ShadeResources { planes, ..resources };
            is(over_frames.write_set(none, &resources, &of_shadows), "shadow_image");
        });
    }
}
