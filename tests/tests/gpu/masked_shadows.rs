//! Shadows of what is cut out or blended: by a texture, a factor and vertex colours, against Monte Carlo.

use arealight_scene::{Image, Texture, Wrap};
use arealight_tests::prelude::*;
use arealight_tool_kernels::gpu::GpuMaterial;
use glam::Vec2;

const SIZE: [u32; 2] = [48, 48];

/// A floor, and above it squares of a material of their own, whose coordinates run from 0 to `repeats`.
fn scene(heights: &[f64], repeats: f32) -> Scene {
    let mut triangles = square(0.0, 1.0).to_vec();
    triangles.extend(heights.iter().flat_map(|height| square(*height, 0.8)));
    let mut scene = scene_of(&triangles, without_textures(lambert(0.8)));
    scene.materials.push(without_textures(lambert(0.3)));
    for triangle in &mut scene.triangles[2..] {
        triangle.material = 1;
        let at = |p: DVec3| (p.as_vec3() / 1.6 + 0.5) * repeats;
        triangle.uvs = triangle.positions.map(|p| Vec2::new(at(p).x, at(p).z));
    }
    scene
}

/// Gives the squares a texture whose alpha is that.
fn textured(scene: &mut Scene, size: u32, alpha: impl Fn(u32, u32) -> bool) {
    let texel = |i: u32| if alpha(i % size, i / size) { 0xffff_ffff } else { 0x00ff_ffff };
    let texels = (0..size * size).map(texel).collect();
    scene.images.push(Image { width: size, height: size, texels, ..Image::default() });
    scene.textures.push(Texture { image: 0, srgb: true, wrap_u: Wrap::Repeat, wrap_v: Wrap::Repeat });
    scene.materials[1].base_color_texture = Some(0);
}

fn light() -> Light {
    let corners = square(1.6, 0.5);
    let shape = LightShape::Polygon(vec![corners[0][2], corners[0][1], corners[0][0], corners[1][2]]);
    Light { radiance: Vec3::splat(5.0), shape, two_sided: true, ..Light::default() }
}

/// From just above the floor straight down: none of the squares is seen.
fn camera() -> Camera {
    let look = Camera::framing("", [DVec3::ZERO].into_iter().collect(), DVec3::NEG_Y, DVec3::Z, 1.0);
    Camera { position: DVec3::Y * 0.3, half_height: 3.0, ..look }
}

/// What the camera sees of a scene below the light, shaded once or more.
fn mean(
    engine: &TestEngine,
    buffers: &SceneBuffers,
    mut shade: impl FnMut(&mut SceneRenderer<'_>, u32),
    times: u32,
) -> f64 {
    let constants = buffers.constants(&camera(), SIZE, Vec3::ZERO);
    let renderer = SceneRenderer::new(engine, buffers, &[light()], constants, SIZE);
    let mut renderer = renderer.unwrap();
    (0..times).for_each(|seed| shade(&mut renderer, seed));
    let radiance = renderer.radiance().unwrap();
    assert!(radiance.iter().all(|pixel| pixel.w == 1.0), "the floor is everywhere");
    let sum: f64 = radiance.iter().map(|pixel| f64::from(pixel.x)).sum();
    sum / radiance.len() as f64 / f64::from(times)
}

/// By shadow rays, of as many as there are here; and what was found of the last ones. `blockers` may be those
/// of another scene.
fn by_rays(
    engine: &TestEngine,
    buffers: &SceneBuffers,
    blockers: &SceneBuffers,
    filter: ShadowFilter,
) -> (f64, Vec<Vec4>) {
    let options = ShadeOptions { surfaces: Effects::DIFFUSE, shadow_rays: 4, ..ShadeOptions::default() };
    let (mut view, mut found) = (None, vec![]);
    let shade = |renderer: &mut SceneRenderer<'_>, seed| {
        let with = (filter, ShadowHistory::Off);
        let view = view.get_or_insert_with(|| renderer.shadowed(blockers, options, with).unwrap());
        renderer.shade_shadowed(view, seed).unwrap();
        found = view.shadows().unwrap();
    };
    (mean(engine, buffers, shade, 8), found)
}

fn by_reference(engine: &TestEngine, buffers: &SceneBuffers) -> f64 {
    let reference =
        Reference { samples: 128, seed: 3, shadows: true, coupled: false, ..Reference::default() };
    mean(engine, buffers, |renderer, _| _ = renderer.reference(reference, |_| {}).unwrap(), 1)
}

/// What is cut out or blended, by name, and of how many squares.
fn scenes() -> Vec<(&'static str, Scene)> {
    let mut clear = scene(&[0.8], 1.0);
    clear.materials[1].alpha_cutoff = Some(0.5);
    clear.materials[1].base_alpha = 0.0;

    let mut leaf = scene(&[0.8], 1.0);
    textured(&mut leaf, 32, |x, y| DVec3::new(f64::from(x) - 16.0, f64::from(y) - 16.0, 0.0).length() < 12.0);
    leaf.materials[1].alpha_cutoff = Some(0.5);

    let mut fence = scene(&[0.5], 5.0);
    textured(&mut fence, 2, |x, _| x == 0);
    fence.materials[1].alpha_cutoff = Some(0.5);

    // Half of it: alpha is from 0 on one side to .9 on the other
    let mut lace = scene(&[0.6], 1.0);
    for triangle in &mut lace.triangles[2..] {
        triangle.colors = triangle.positions.map(|p| [255, 255, 255, if p.x < 0.0 { 0 } else { 255 }]);
    }
    lace.materials[1].base_alpha = 0.9;
    lace.materials[1].alpha_cutoff = Some(0.45);

    let mut veils = scene(&[0.5, 0.8, 1.1], 3.0);
    textured(&mut veils, 8, |x, _| x < 6);
    veils.materials[1].base_alpha = 0.4;
    veils.materials[1].blended = true;
    vec![("clear", clear), ("leaf", leaf), ("fence", fence), ("lace", lace), ("veils", veils)]
}

#[test]
fn they_are_as_dark_as_by_monte_carlo() {
    let Some(engine) = TestEngine::new() else { return };
    let unblocked = by_reference(&engine, &SceneBuffers::new(&scene(&[], 1.0), DVec3::ZERO).unwrap());
    for (name, scene) in scenes() {
        let buffers = SceneBuffers::new(&scene, DVec3::ZERO).unwrap();
        let truth = by_reference(&engine, &buffers);
        println!("{name}: {:.3} of the light arrives", truth / unblocked);
        let is_clear = name == "clear";
        assert!(truth < if is_clear { 1.001 } else { 0.9 } * unblocked, "{name}: {truth} of {unblocked}");
        for filter in [ShadowFilter::Off, ShadowFilter::Gather] {
            let (found, shadows) = by_rays(&engine, &buffers, &buffers, filter);
            // 74,000 rays, and 295,000 samples: .4 % at one standard deviation
            let ratio = found / truth;
            println!("    {ratio:.4}");
            assert!((ratio - 1.0).abs() < 0.02, "{name}: {ratio}");
            // What is not there makes no penumbra
            assert!(!is_clear || shadows.iter().all(|pixel| pixel.x == 1.0 && pixel.y == 0.0));
        }
        // The twin: without the bits that say that there is something to ask
        let mut opaque = buffers.clone();
        for material in &mut opaque.materials {
            material.flags &= GpuMaterial::DOUBLE_SIDED;
        }
        let (found, _) = by_rays(&engine, &buffers, &opaque, ShadowFilter::Off);
        assert!(found < 0.9 * truth, "{name}: {found} of {truth}");
    }
}

#[test]
fn a_camera_sees_through_what_is_cut_out_of_layers_in_one_plane() {
    let Some(engine) = TestEngine::new() else { return };
    let above = Camera { position: DVec3::Y * 2.0, half_height: 0.35, ..camera() };
    let is_met = |first: usize, kept: u32| {
        // Two sheets in the floor's own plane and one above it; of each some quarters are there
        let mut scene = scene(&[0.0, 0.0, 0.2], 6.0);
        textured(&mut scene, 2, |x, y| x + 2 * y < kept);
        scene.materials[1].alpha_cutoff = Some(0.5);
        scene.triangles.drain(..first);
        let buffers = SceneBuffers::new(&scene, DVec3::ZERO).unwrap();
        let constants = buffers.constants(&above, SIZE, Vec3::ZERO);
        let renderer = SceneRenderer::new(&engine, &buffers, &[light()], constants, SIZE);
        let met = renderer.unwrap().radiance().unwrap().iter().map(|pixel| pixel.w).sum::<f32>();
        met / (SIZE[0] * SIZE[1]) as f32
    };
    for kept in [0, 1, 2] {
        assert_eq!(is_met(0, kept), 1.0, "the floor is lost");
        // The twin: without the floor they leave holes; the edges of what is kept are smooth
        let part = is_met(2, kept);
        assert!((0.2 * kept as f32..=0.5 * kept as f32).contains(&part), "{kept}: {part}");
    }
}
