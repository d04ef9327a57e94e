//! A medium before pictures: froxels against Monte Carlo.

use arealight::plan::MediumOptions;
use arealight::{Opening, Profile};
use arealight_engine::Fog;
use arealight_tests::prelude::*;

const SIZE: [u32; 2] = [64, 36];
const FROXELS: [u32; 3] = [32, 18, 64];

const FOG: Fog =
    Fog { density: 0.15, albedo: Vec3::ONE, anisotropy: 0.5, farthest: 14.0, cull_radiance: 0.0 };

/// The picture of a scene's lamps, with what `act` adds before.
fn picture(
    engine: &TestEngine,
    scene: &Scene,
    act: impl FnOnce(&mut SceneRenderer<'_>, &SceneBuffers),
) -> Vec<Vec4> {
    seen_from(engine, scene, 0.0, act)
}

/// The same by a camera that went so far ahead.
fn seen_from(
    engine: &TestEngine,
    scene: &Scene,
    ahead: f64,
    act: impl FnOnce(&mut SceneRenderer<'_>, &SceneBuffers),
) -> Vec<Vec4> {
    let mut camera = scene.camera(None, 16.0 / 9.0).unwrap();
    camera.position += ahead * camera.forward;
    with_view(engine, scene, &scene.lights, (&camera, SIZE), |renderer, buffers| {
        renderer.shade_as(ShadeOptions { output: Output::Add, ..ShadeOptions::default() }).unwrap();
        act(renderer, buffers);
        renderer.radiance().unwrap()
    })
}

/// Puts a fog before the picture.
fn add_fog(
    renderer: &mut SceneRenderer<'_>,
    buffers: &SceneBuffers,
    fog: &Fog,
    froxels: [u32; 3],
    (samples, shadows, seed): (u32, bool, u32),
) {
    let options = MediumOptions { samples, shadow_rays: shadows, ..MediumOptions::default() };
    let view = renderer.fog_view(&renderer.blockers(buffers).unwrap(), froxels, (options, None)).unwrap();
    renderer.add_fog(&view, fog, seed).unwrap();
}

/// Averages of 4 x 4 pixels of a picture so wide.
fn blocks(picture: &[Vec4], width: usize) -> Vec<Vec3> {
    let columns = width / 4;
    let block = |index: usize| {
        let corner = index / columns * 4 * width + index % columns * 4;
        (0..16).map(|i| picture[corner + i / 4 * width + i % 4].truncate()).sum::<Vec3>() / 16.0
    };
    (0..picture.len() / 16).map(block).collect()
}

/// RMSE over mean of the blocks that are kept.
fn error(found: &[Vec3], truth: &[Vec3], keep: impl Fn(usize) -> bool) -> f32 {
    let kept = || found.iter().zip(truth).enumerate().filter(|(block, _)| keep(*block));
    let square: f32 = kept().map(|(_, (found, truth))| (*found - *truth).length_squared()).sum();
    let sum: f32 = kept().map(|(_, (_, truth))| truth.element_sum()).sum();
    (square * 3.0 * kept().count() as f32).sqrt() / sum
}

/// RMSE over mean of averages of 4 x 4 pixels, without those that show a lamp: averaging divides the
/// reference's noise by four.
fn difference(clear: &[Vec4], found: &[Vec4], truth: &[Vec4]) -> f32 {
    let without_lamps: Vec<Vec4> =
        clear.iter().map(|texel| Vec4::splat(if texel.x < 4.0 { 0.0 } else { 1.0 })).collect();
    let [lamps, found, truth] =
        [&without_lamps[..], found, truth].map(|picture| blocks(picture, SIZE[0] as usize));
    error(&found, &truth, |block| lamps[block] == Vec3::ZERO)
}

/// What docs/media.md says of three scenes' fog alone, on black surfaces: off the edges of shafts, which are
/// where blocks differ by a quarter from a neighbour. Noise is what is between two halves of the truth.
#[test]
#[ignore = "takes minutes"]
fn shafts_are_near_to_monte_carlo() {
    let Some(engine) = TestEngine::new() else { return };
    let size @ [width, height] = [320, 180];
    for (name, samples) in [("slats.glb", 96), ("stage.glb", 384), ("street.glb", 128)] {
        let scene = scene(name);
        let camera = scene.camera(None, 16.0 / 9.0).unwrap();
        let fog = Fog::of_scene(&scene, &camera, scene.fog.unwrap());
        let buffers = SceneBuffers::new(&scene, camera.position).unwrap();
        let constants = buffers.constants(&camera, size, Vec3::ZERO);
        let mut renderer = SceneRenderer::new(&engine, &buffers, &scene.lights, constants, size).unwrap();
        let mut fogged = |act: &dyn Fn(&mut SceneRenderer<'_>)| {
            renderer.show(&vec![Vec3::ZERO; (width * height) as usize]).unwrap();
            act(&mut renderer);
            blocks(&renderer.radiance().unwrap(), width as usize)
        };
        let [one, two] =
            [1, 2].map(|seed| fogged(&|r| _ = r.fog_reference(&fog, samples, (true, seed), |_| ()).unwrap()));
        let truth: Vec<Vec3> = one.iter().zip(&two).map(|(one, two)| 0.5 * (*one + *two)).collect();
        let (columns, rows) = (width as usize / 4, height as usize / 4);
        let is_even = |block: usize| {
            let sum = |block: usize| truth[block].element_sum();
            let (x, y) = (block % columns, block / columns);
            let near = [(x > 0, block.wrapping_sub(1)), (x + 1 < columns, block + 1)];
            let above = [(y > 0, block.wrapping_sub(columns)), (y + 1 < rows, block + columns)];
            let mut neighbours = near.into_iter().chain(above).filter(|(is_there, _)| *is_there);
            neighbours.all(|(_, other)| (sum(other) - sum(block)).abs() <= 0.25 * sum(block).max(sum(other)))
        };
        let noise = 0.5 * error(&one, &two, is_even);
        for samples in [4, 16] {
            let found = fogged(&|r| add_fog(r, &buffers, &fog, [160, 90, 64], (samples, true, 0)));
            let error = error(&found, &truth, is_even);
            let apart = (error * error - noise * noise).max(0.0).sqrt();
            println!("{name}, {samples} samples: {apart:.3}, and the truth's noise {noise:.3}");
            // Four rays a light leave noise of their own
            assert!(apart < if samples == 4 { 0.07 } else { 0.05 }, "{apart}");
        }
    }
}

#[test]
fn froxels_are_near_to_monte_carlo() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene("slats.glb");
    let clear = picture(&engine, &scene, |_, _| ());
    let fogged = |fog: Fog, shadows: bool| {
        picture(&engine, &scene, |r, s| add_fog(r, s, &fog, FROXELS, (4, shadows, 1)))
    };
    // The reference's noise at 256 samples is .013 and .02; a grid twice as fine still errs by .018 and .03
    for (shadows, bound) in [(false, 0.03), (true, 0.06)] {
        let truth =
            picture(&engine, &scene, |r, _| _ = r.fog_reference(&FOG, 256, (shadows, 0), |_| ()).unwrap());
        let error = difference(&clear, &fogged(FOG, shadows), &truth);
        // The twins: light that goes on the other way, and the other kind of shadows
        let turned = difference(&clear, &fogged(Fog { anisotropy: -0.5, ..FOG }, shadows), &truth);
        let other = difference(&clear, &fogged(FOG, !shadows), &truth);
        println!("shadows {shadows}: {error:.3}; turned {turned:.3}, other shadows {other:.3}");
        assert!(error < bound, "{error}");
        assert!(turned > 2.0 * bound && other > 2.0 * bound, "{turned}, {other}");
    }
}

#[test]
fn spheres_shine_from_their_near_side() {
    let Some(engine) = TestEngine::new() else { return };
    let mut scene = scene("slats.glb");
    let camera = scene.camera(None, 16.0 / 9.0).unwrap();
    let shape = LightShape::Sphere { center: camera.position + 5.0 * camera.forward, radius: 0.5 };
    scene.lights = vec![Light { radiance: Vec3::splat(5.0), shape, ..Light::default() }];
    scene.lamps.clear();
    let fog = Fog { density: 0.6, ..FOG };
    let clear = picture(&engine, &scene, |_, _| ());
    let found = picture(&engine, &scene, |r, s| add_fog(r, s, &fog, [64, 36, 128], (4, false, 1)));
    let truth = picture(&engine, &scene, |r, _| _ = r.fog_reference(&fog, 1024, (false, 0), |_| ()).unwrap());
    let error = difference(&clear, &found, &truth);
    // The twin: dimmed as from the center
    let dim: Vec<Vec4> = found.iter().map(|texel| *texel * (-0.6 * 0.5 * 2.0 / 3.0_f32).exp()).collect();
    let dimmed = difference(&clear, &dim, &truth);
    println!("{error:.3}; from the center {dimmed:.3}");
    // Of a froxel a pixel, beside the sphere too
    assert!(error < 0.08 && dimmed > 0.2, "{error} {dimmed}");
}

#[test]
fn no_fog_changes_nothing_and_much_of_it_gives_numbers() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene("slats.glb");
    let clear = picture(&engine, &scene, |_, _| ());
    let with = |fog: Fog| picture(&engine, &scene, |r, s| add_fog(r, s, &fog, [5, 3, 7], (1, true, 0)));
    assert_eq!(with(Fog { density: 0.0, ..FOG }), clear);
    for density in [1e-6, 1e3, 1e30] {
        for anisotropy in [0.0, 0.99, -0.99] {
            let found = with(Fog { density, anisotropy, ..FOG });
            assert!(found.iter().all(|texel| texel.is_finite() && texel.min_element() >= 0.0), "{density}");
        }
    }
}

/// slats.glb with small lights of every kind: some are two-sided, some shine in a cone.
fn crowded(count: usize) -> Scene {
    let mut scene = scene("slats.glb");
    let mut random = Random::new(5);
    let (low, high) = (scene.bounds.min, scene.bounds.max);
    for index in 0..count {
        let place = DVec3::from_array(std::array::from_fn(|_| random.unit()));
        let center = low + (high - low) * place;
        let (axis_u, axis_v) = random.direction().any_orthonormal_pair();
        let (axis_u, axis_v) = (0.1 * axis_u, 0.05 * axis_v);
        let shape = match index % 4 {
            0 => LightShape::Disk { center, axis_u, axis_v },
            1 => LightShape::Sphere { center, radius: 0.05 },
            2 => {
                let (p0, p1) = (center - axis_u, center + axis_u);
                LightShape::Tube { p0, p1, radius: 0.02, ends: TubeEnds::Round }
            }
            _ => LightShape::Polygon(random.polygon(center, 3 + index % 3, 0.05, 0.1)),
        };
        let profile = matches!(shape, LightShape::Polygon(_)).then(|| Profile::cone(0.3, 0.6, 4).unwrap());
        let profile = profile.filter(|_| index % 8 == 3);
        let opening = matches!(shape, LightShape::Polygon(_)).then(|| {
            let normal = shape.area_vector().normalize_or_zero();
            let (u, v) = normal.any_orthonormal_pair();
            let center = shape.center() + 0.2 * normal;
            Opening { center, axis_u: 0.1 * u, axis_v: 0.1 * v, housed: index % 16 == 7 }
        });
        let opening = opening.filter(|_| index % 8 == 7);
        let two_sided = index % 3 == 0 && profile.is_none();
        let radiance = Vec3::splat(random.between(1.0, 20.0) as f32);
        scene.lights.push(Light { shape, radiance, two_sided, profile, opening, ..Light::default() });
    }
    scene
}

#[test]
fn lists_and_hidden_froxels_change_no_pixel_beyond_what_it_may_lose() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = crowded(50);
    let froxels = [32, 18, 16];
    for anisotropy in [0.0, -0.8] {
        let fog = Fog { anisotropy, ..FOG };
        let with = |fog: Fog, options: MediumOptions| {
            picture(&engine, &scene, |renderer, buffers| {
                let view = renderer
                    .fog_view(&renderer.blockers(buffers).unwrap(), froxels, (options, None))
                    .unwrap();
                renderer.add_fog(&view, &fog, 0).unwrap();
            })
        };
        let all = MediumOptions { fill_hidden: true, least_lights: u32::MAX, ..MediumOptions::default() };
        let (all, listed) = (with(fog, all), MediumOptions::default());
        // A light's share is summed in the same order: what is left out is zero
        assert_eq!(with(fog, listed), all);
        let lost = |cull_radiance: f32| {
            let found = with(Fog { cull_radiance, ..fog }, listed);
            let pairs = found.iter().zip(&all);
            pairs.map(|(found, all)| (*all - *found).truncate().element_sum()).fold(0.0, f32::max)
        };
        let [little, much] = [0.02, 1.0].map(lost);
        println!("g {anisotropy}: {little:.1e} of .02, {much:.1e} of 1");
        // Something is, and no more than promised; froxels are rounded to eleven bits
        assert!(little > 6e-5 && little <= 0.02002, "{little}");
        assert!(much > 5.0 * little && much <= 1.001, "{much}");
        // The twin: of a larger promise more is used than the smaller allows
        assert!(much > 0.02002 || anisotropy != 0.0, "{much}");
    }
}

#[test]
fn an_image_of_an_even_medium_is_that_medium() {
    let Some(engine) = TestEngine::new() else { return };
    let (host, scene) = (engine.host(), crowded(40)); // enough for lists
    let (format, usage) = (vk::Format::R32G32B32A32_SFLOAT, vk::ImageUsageFlags::SAMPLED);
    let [width, height, depth] = FROXELS;
    let description = ImageDescription { name: "medium", extent: [width, height], layers: 1, format, usage };
    let medium = host.volume(&description, depth).unwrap();
    let fill = |scattering: f32, extinction: f32| {
        let color = vk::ClearColorValue { float32: [scattering, scattering, scattering, extinction] };
        host.submit(|commands| {
            medium.transition(commands, Usage::UNDEFINED, Usage::COPY_DESTINATION);
            let layout = Usage::COPY_DESTINATION.layout;
            let all = vk::ImageSubresourceRange {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                level_count: 1,
                layer_count: 1,
                ..Default::default()
            };
            // SAFETY: the image is of this device, in that layout, and outlives the submission.
            unsafe { host.device().cmd_clear_color_image(commands, medium.handle(), layout, &color, &[all]) };
            medium.transition(commands, Usage::COPY_DESTINATION, Usage::COMPUTE_READ);
        })
        .unwrap();
    };
    let with = |fog: Fog, by_image: bool| {
        let options = MediumOptions { by_image, ..MediumOptions::default() };
        let image = by_image.then(|| Resource::sampled(medium.view()));
        picture(&engine, &scene, |renderer, buffers| {
            let view =
                renderer.fog_view(&renderer.blockers(buffers).unwrap(), FROXELS, (options, image)).unwrap();
            renderer.add_fog(&view, &fog, 0).unwrap();
        })
    };
    let fog = Fog { cull_radiance: 0.01, ..FOG };
    let even = with(fog, false);
    fill(fog.density, fog.density);
    let other = Fog { density: 9.0, ..fog };
    assert_eq!(with(other, true), even);
    // The twin: the image is what is read
    fill(fog.density, 2.0 * fog.density);
    assert_ne!(with(other, true), even);
}

#[test]
fn slices_do_not_show_while_the_camera_moves() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene("slats.glb");
    // A slice about the lamps is .3 long: steps through one
    for ahead in [0.0, 0.06, 0.12, 0.18, 0.24] {
        let with = |slices: u32| {
            let fog = |r: &mut SceneRenderer<'_>, s: &SceneBuffers| {
                add_fog(r, s, &FOG, [FROXELS[0], FROXELS[1], slices], (1, false, 0));
            };
            seen_from(&engine, &scene, ahead, fog)
        };
        let clear = seen_from(&engine, &scene, ahead, |_, _| ());
        let fine = with(512);
        let [found, coarse] = [64, 8].map(|slices| difference(&clear, &with(slices), &fine));
        println!("{ahead}: {found:.4}; 8 slices {coarse:.4}");
        // Half a level of 255 where the mean is a level of 50; the twin, slices that do show
        assert!(found < 0.01 && coarse > 0.03, "{found}, {coarse}");
    }
}
