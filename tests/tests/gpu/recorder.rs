//! A host's mistakes have typed answers that name the field; and what the recorder publishes is what it does.

use arealight::kernels::{self, SHADE, TILE_BINDINGS, constant};
use arealight::table::LAYERS;
use arealight_tests::prelude::*;
use arealight_tool_kernels::kernels::EVAL;
use arealight_vk::{ComputePass, TableImage};
use glam::Mat4;

fn frame() -> ShadeFrame {
    ShadeFrame { size: [8, 8], lights: LightSummary::default(), ..ShadeFrame::default() }
}

fn lights(light_count: u32, quad_count: u32, shape_count: u32, effects: Effects) -> ShadeFrame {
    ShadeFrame { lights: LightSummary { light_count, quad_count, shape_count, effects }, ..frame() }
}

/// Runs `check` with a pass and a command buffer that is being recorded.
fn recording(
    engine: &TestEngine,
    options: ShadeOptions,
    check: impl FnOnce(&ShadePass, vk::CommandBuffer, vk::DescriptorSet),
) {
    let pass = engine.pass(options).unwrap();
    let pool = engine.host().descriptor_pool(1, &pass.pool_sizes(1)).unwrap();
    // SAFETY: The layout is the pass's.
    let set = unsafe { pool.allocate(pass.set_layout()) }.unwrap();
    engine.host().submit(|commands| check(&pass, commands, set)).unwrap();
}

#[test]
fn frames_that_cannot_be_shaded_are_refused_by_field() {
    let Some(engine) = TestEngine::new() else { return };
    recording(&engine, ShadeOptions::default(), |pass, commands, set| {
        for (wrong, expected) in [
            (ShadeFrame { size: [8, 0], ..frame() }, "size"),
            (lights(2, 3, 0, Effects::empty()), "lights"),
            (lights(3, 2, 0, Effects::SPHERE), "lights"),
            (lights(2, 2, 1, Effects::POLYGON), "lights"),
            (ShadeFrame { camera: Vec3::new(0.0, f32::NAN, 0.0), ..frame() }, "camera"),
            (
                ShadeFrame { position_from_clip: Some(Mat4::IDENTITY * f32::INFINITY), ..frame() },
                "position_from_clip",
            ),
            (ShadeFrame { size: [8, u32::MAX], ..frame() }, "groups"),
        ] {
            // SAFETY: Nothing is recorded where an error is returned, so the set need not be written.
            let error = unsafe { pass.record(commands, set, &wrong) }.unwrap_err();
            assert_eq!(field(&error), expected, "{error}");
        }
    });
    // The twins of the lights
    recording(&engine, ShadeOptions::default(), |pass, _, _| {
        pass.prepare(&lights(3, 2, 0, Effects::POLYGON)).unwrap();
        pass.prepare(&lights(2, 2, 1, Effects::SPHERE)).unwrap();
    });
    let from_depth = ShadeOptions { from_depth: true, ..ShadeOptions::default() };
    recording(&engine, from_depth, |pass, commands, set| {
        // SAFETY: As above.
        let error = unsafe { pass.record(commands, set, &frame()) }.unwrap_err();
        assert_eq!(field(&error), "position_from_clip");
    });
}

#[test]
fn resources_that_do_not_fit_are_refused_by_name() {
    let Some(engine) = TestEngine::new() else { return };
    let buffer = engine.host().storage_buffer("numbers", &[0.0_f32; 64]).unwrap();
    let whole = Resource::buffer(buffer.handle());
    // SAFETY: No submission uses the pass.
    let pass = unsafe { ComputePass::new(engine.context(), &EVAL, &[]) }.unwrap();
    let pool = engine.host().descriptor_pool(1, &pass.pool_sizes(1)).unwrap();
    // SAFETY: The layout is the pass's; for the writes, the set is new and unused.
    unsafe {
        let set = pool.allocate(pass.set_layout()).unwrap();
        let write = |resources: &[Resource]| pass.write_set(set, resources);
        assert_eq!(field(&write(&[]).unwrap_err()), "resources");
        let right = [engine.table(), whole, whole, whole, whole, engine.light_textures()];
        write(&right).unwrap();
        let mut wrong = right;
        wrong[0] = whole;
        assert_eq!(field(&write(&wrong).unwrap_err()), "table_image");
        wrong = right;
        wrong[1] = Resource::buffer(vk::Buffer::null());
        let error = write(&wrong).unwrap_err();
        assert_eq!(field(&error), "lights");
        assert!(error.to_string().contains("must hold GpuLight[]"), "says what it must hold: {error}");
    }
}

#[test]
fn constants_are_checked_against_the_manifest() {
    let Some(engine) = TestEngine::new() else { return };
    // SAFETY: No submission uses a pass.
    let error = unsafe { ComputePass::new(engine.context(), &EVAL, &[(constant::OUTPUT, 1)]) }.unwrap_err();
    assert_eq!(field(&error), "specialization");
    // SAFETY: As above.
    let pass = unsafe { ComputePass::new(engine.context(), &EVAL, &[(constant::HORIZON, 1)]) }.unwrap();
    engine
        .host()
        .submit(|commands| {
            // SAFETY: Nothing is recorded where an error is returned.
            let error = unsafe { pass.record(commands, vk::DescriptorSet::null(), &[0; 3], [1; 3]) };
            assert_eq!(field(&error.unwrap_err()), "constants");
        })
        .unwrap();
}

#[test]
fn accesses_and_pool_sizes_say_what_the_manifest_says() {
    let Some(engine) = TestEngine::new() else { return };
    recording(&engine, ShadeOptions::default(), |pass, _, _| {
        let accesses = pass.accesses();
        // All but the stencil and the counts of lights
        let of_frames = SHADE.bindings().len() - TILE_BINDINGS.len() - 1;
        assert_eq!(accesses.len(), of_frames - 1);
        for access in &accesses {
            assert_eq!(access.stage, vk::PipelineStageFlags::COMPUTE_SHADER);
            let written = access.access.contains(vk::AccessFlags::SHADER_WRITE);
            let is_stored = ["radiance_image", "glossy_image"].contains(&access.name);
            assert_eq!(written, is_stored || access.name == "shadow_picks", "{access:?}");
            assert_eq!(access.layout == vk::ImageLayout::GENERAL, is_stored);
        }
        let descriptors: u32 = pass.pool_sizes(3).iter().map(|size| size.descriptor_count).sum();
        assert_eq!(descriptors as usize, 3 * of_frames);
    });
}

#[test]
fn a_table_image_without_memory_is_refused() {
    let Some(engine) = TestEngine::new() else { return };
    let table = LightTable::ggx();
    // SAFETY: No submission uses it.
    let image = unsafe { TableImage::new(engine.context(), &table, TableFormat::Rgba16Float) }.unwrap();
    let size = u64::from(table.size());
    assert_eq!(TableFormat::Rgba16Float.bytes(&table).len() as u64, size * size * u64::from(LAYERS) * 8);
    assert!(image.memory_requirements().size >= size * size * u64::from(LAYERS) * 8);
    let buffer = engine.host().storage_buffer("numbers", &[0.0_f32; 64]).unwrap();
    let whole = Resource::buffer(buffer.handle());
    // SAFETY: No submission uses the pass; the set is new.
    unsafe {
        let pass = ComputePass::new(engine.context(), &EVAL, &[]).unwrap();
        let pool = engine.host().descriptor_pool(1, &pass.pool_sizes(1)).unwrap();
        let set = pool.allocate(pass.set_layout()).unwrap();
        let error = pass
            .write_set(set, &[image.resource(), whole, whole, whole, whole, engine.light_textures()])
            .unwrap_err();
        assert_eq!(field(&error), "table_image");
    }
}

#[test]
fn every_kernel_makes_a_pipeline_with_every_constant() {
    let Some(engine) = TestEngine::new() else { return };
    for kernel in kernels::ALL.into_iter().chain(arealight_tool_kernels::kernels::ALL) {
        for value in [0, 1] {
            let constants: Vec<_> = kernel.constants().iter().map(|&id| (id, value)).collect();
            // SAFETY: No submission uses it.
            unsafe { ComputePass::new(engine.context(), kernel, &constants) }.unwrap();
        }
    }
}
