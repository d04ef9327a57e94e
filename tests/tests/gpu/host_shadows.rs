//! Hosts that have shadows of their own: a function of theirs says what part of a light arrives, or what
//! blocks a ray, and reads a set of theirs.

use crate::shadows::{flat, options, surfaces, symmetric_lights};
use arealight::plan::ShadeOptions;
use arealight_engine::host::{DescriptorPool, ImageDescription, Usage};
use arealight_tests::TestEngine;
use arealight_tests::kernel::{shade_with_visibility, shadow_rays_with_bridge};
use arealight_tests::shadow_patch::{PatchPasses, SIDE, ShadowPatch};
use ash::vk;

/// A descriptor set of a host with one binding.
struct HostSet<'a> {
    engine: &'a TestEngine,
    layout: vk::DescriptorSetLayout,
    set: vk::DescriptorSet,
    _pool: DescriptorPool,
}

impl<'a> HostSet<'a> {
    fn new(
        engine: &'a TestEngine,
        kind: vk::DescriptorType,
        write: impl FnOnce(vk::WriteDescriptorSet<'_>),
    ) -> Self {
        let host = engine.host();
        let binding = [vk::DescriptorSetLayoutBinding::default()
            .descriptor_type(kind)
            .descriptor_count(1)
            .stage_flags(vk::ShaderStageFlags::COMPUTE)];
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&binding);
        let pool =
            host.descriptor_pool(1, &[vk::DescriptorPoolSize { ty: kind, descriptor_count: 1 }]).unwrap();
        // SAFETY: The device is alive; what is made is dropped after the last submission was waited for.
        unsafe {
            let layout = host.device().create_descriptor_set_layout(&info, None).unwrap();
            let set = pool.allocate(layout).unwrap();
            write(vk::WriteDescriptorSet::default().dst_set(set).descriptor_type(kind));
            Self { engine, layout, set, _pool: pool }
        }
    }
}

impl Drop for HostSet<'_> {
    fn drop(&mut self) {
        // SAFETY: Nothing that uses it is pending.
        unsafe { self.engine.host().device().destroy_descriptor_set_layout(self.layout, None) };
    }
}

#[test]
fn a_host_says_itself_what_blocks() {
    let Some(engine) = TestEngine::new() else { return };
    let host = engine.host();
    let half = [[-100.0_f32, 0.0, 0.01, 0.0], [100.0, 100.0, 0.0, 0.0]];
    let rectangle = host.storage_buffer("rectangle", &half).unwrap();
    let own = HostSet::new(&engine, vk::DescriptorType::STORAGE_BUFFER, |write| {
        let buffer = [vk::DescriptorBufferInfo::default().buffer(rectangle.handle()).range(vk::WHOLE_SIZE)];
        // SAFETY: The set is new, and the buffer outlives it.
        unsafe { host.device().update_descriptor_sets(&[write.buffer_info(&buffer)], &[]) };
    });
    let mut passes = PatchPasses::with_blocker(&engine, options(), shadow_rays_with_bridge(), own.layout);
    passes.blocker_set = Some(own.set);
    let (_, material, view) = surfaces().remove(0);
    let (_, light) = symmetric_lights().remove(0);
    let patch = ShadowPatch { material, view, lights: vec![light], blockers: Vec::new() };
    let found = patch.run(&passes).mean();
    assert!((found - 0.5).abs() < 4e-3, "{found}");
    // The twin: its rectangle elsewhere
    rectangle.upload(&[[0.0_f32, 0.0, -1.0, 0.0], [0.0; 4]]).unwrap();
    assert!((patch.run(&passes).mean() - 1.0).abs() < 1e-6);
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
    let own = HostSet::new(&engine, vk::DescriptorType::SAMPLED_IMAGE, |write| {
        let image = [vk::DescriptorImageInfo::default()
            .image_view(masks.array_view())
            .image_layout(Usage::COMPUTE_READ.layout)];
        // SAFETY: The set is new, and the image outlives it.
        unsafe { host.device().update_descriptor_sets(&[write.image_info(&image)], &[]) };
    });
    let options = ShadeOptions { shadow_rays: 1, ..options() };
    let lights = [
        flat(1.5, &[[0.2, -0.6], [0.2, 0.6], [1.5, 0.6], [1.5, -0.6]]),
        flat(2.0, &[[-1.5, -0.6], [-1.5, 0.6], [-0.2, 0.6], [-0.2, -0.6]]),
    ];
    for (surface, material, view) in surfaces() {
        let patch = ShadowPatch { material, view, lights: lights.to_vec(), blockers: Vec::new() };
        let plain = PatchPasses::new(&engine, options, arealight::plan::ShadowFilter::Off);
        let alone = lights
            .clone()
            .map(|light| ShadowPatch { lights: vec![light], ..patch.clone() }.run(&plain).unshadowed[0]);
        let mut passes = PatchPasses::with_visibility(&engine, options, shade_with_visibility(), own.layout);
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
}
