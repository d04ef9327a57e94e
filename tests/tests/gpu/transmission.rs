//! Light that thin surfaces let through: a pass over the other side of a G-buffer, against eval, against
//! none, by tiles, with shadows, and against Monte Carlo.

use arealight_engine::EngineError;
use arealight_oracle::material::Interface;
use arealight_oracle::thin_film::ThinFilm;
use arealight_tests::prelude::*;
use half::f16;

const SIZE: [u32; 2] = [96, 54];

/// What the pass needs of what is let through, as through paper and as through panes.
const THROUGH: Effects =
    Effects::DIFFUSE.union(Effects::GLOSSY).union(Effects::COUPLED).union(Effects::TRANSMISSION);

/// A scene with thin sheets, and the same with panes of rough, tinted glass in their place; every other pane
/// diffuses a third of the light.
fn thin_scenes() -> [(&'static str, Scene); 2] {
    let paper = scene("paper.glb");
    let mut panes = paper.clone();
    let thin = panes.materials.iter_mut().filter(|material| material.material.transmission > 0.0);
    for (at, material) in thin.enumerate() {
        material.material.glass = if at % 2 == 0 { 1.0 } else { 2.0 / 3.0 };
        material.material.roughness = 0.4;
        material.material.base_color = Vec3::new(0.9, 0.7, 0.5);
    }
    [("paper", paper), ("panes", panes)]
}

/// What `shade` adds to the emission that the camera sees of a scene.
fn reflected(
    engine: &TestEngine,
    scene: &Scene,
    shade: impl FnOnce(&mut SceneRenderer<'_>, &SceneBuffers) -> Result<(), EngineError>,
) -> Vec<Vec3> {
    let camera = scene.camera(None, f64::from(SIZE[0]) / f64::from(SIZE[1])).expect("a camera");
    let (emitted, shaded) = with_view(engine, scene, &scene.lights, (&camera, SIZE), |renderer, buffers| {
        let emitted = renderer.radiance().unwrap();
        shade(renderer, buffers).unwrap();
        (emitted, renderer.radiance().unwrap())
    });
    shaded.iter().zip(&emitted).map(|(shaded, emitted)| (*shaded - *emitted).truncate()).collect()
}

fn pass(surfaces: Effects) -> ShadeOptions {
    ShadeOptions { surfaces, output: Output::Add, ..ShadeOptions::default() }
}

/// What the pass over the other side adds.
fn let_through(engine: &TestEngine, scene: &Scene) -> Vec<Vec3> {
    reflected(engine, scene, |renderer, _| renderer.shade_as(pass(THROUGH)).map(|_| ()))
}

fn mean(picture: &[Vec3]) -> f64 {
    picture.iter().map(|pixel| f64::from(pixel.element_sum())).sum::<f64>() / picture.len() as f64
}

/// Pixels whose surface lets light through.
fn is_thin(engine: &TestEngine, scene: &Scene) -> Vec<bool> {
    let_through(engine, scene).into_iter().map(|through| through != Vec3::ZERO).collect()
}

#[test]
fn what_is_let_through_is_what_the_other_side_reflects() {
    let Some(engine) = TestEngine::new() else { return };
    for (name, scene) in thin_scenes() {
        compare_with_eval(&engine, name, &scene);
    }
}

fn compare_with_eval(engine: &TestEngine, name: &str, scene: &Scene) {
    // What the G-buffer says, as points that the other side's lobe is evaluated at
    let mut texels = vec![];
    let found = reflected(engine, scene, |renderer, _| {
        let g_buffer = renderer.g_buffer();
        let position: Vec<[f32; 4]> = g_buffer[Plane::Position].download(Usage::COMPUTE_READ).unwrap();
        let normal: Vec<[f32; 4]> = g_buffer[Plane::Normal].download(Usage::COMPUTE_READ).unwrap();
        let through: Vec<[u16; 4]> = g_buffer.transmitted.download(Usage::COMPUTE_READ).unwrap();
        let color = |texel: [u16; 4]| Vec4::from_array(texel.map(|bits| f16::from_bits(bits).to_f32()));
        texels = position
            .into_iter()
            .zip(normal)
            .zip(through)
            .map(|((position, normal), through)| (Vec4::from(position), Vec4::from(normal), color(through)))
            .collect();
        renderer.shade_as(pass(THROUGH)).map(|_| ())
    });
    let camera = scene.camera(None, f64::from(SIZE[0]) / f64::from(SIZE[1])).expect("a camera").position;
    let thin: Vec<usize> =
        (0..texels.len()).filter(|&pixel| texels[pixel].2.truncate() != Vec3::ZERO).collect();
    assert!(thin.len() > 500, "{} pixels let light through", thin.len());
    let expected = |side: f64| -> Vec<DVec3> {
        let mut sum = vec![DVec3::ZERO; thin.len()];
        for light in &scene.lights {
            let point = |&pixel: &usize| {
                let (position, normal_roughness, through) = texels[pixel];
                let position = position.truncate().as_dvec3();
                let normal = normal_roughness.truncate().as_dvec3().normalize_or(DVec3::Z);
                let (color, pane) = (through.truncate().as_dvec3(), f64::from(through.w));
                let roughness = f64::from(normal_roughness.w);
                // The viewer is as far on that side
                let mirrored = -position + 2.0 * normal * normal.dot(position);
                let view = if side < 0.0 { mirrored } else { -position };
                let surface = Surface {
                    diffuse_albedo: color * (1.0 - pane),
                    f0: color * (pane * 0.96),
                    alpha: (roughness * roughness).max(arealight::MIN_ALPHA),
                    interface: Some(Interface { f0: 0.04, f90: 1.0, by_albedo: false }),
                    ..Surface::default()
                };
                EvalPoint {
                    surface,
                    position: position + camera,
                    normal: side * normal,
                    view,
                    light: light.clone(),
                }
            };
            let points: Vec<EvalPoint> = thin.iter().map(point).collect();
            let answers = engine.eval(&points, Quality::default()).unwrap();
            sum.iter_mut().zip(answers).for_each(|(sum, answer)| *sum += answer.as_dvec3());
        }
        sum
    };
    let radiance = scene.lights.iter().map(|light| light.radiance.max_element()).fold(0.0, f32::max);
    let mut comparison = Comparison::new(format!("{name} against eval"));
    let other_side = expected(-1.0);
    for (&pixel, expected) in thin.iter().zip(&other_side) {
        // As for whole frames: both are rounded, and so is a light's position
        let bound = 5.0 * rounding(1.0) * f64::from(radiance);
        for channel in 0..3 {
            comparison
                .add(found[pixel][channel].into(), expected[channel], bound, || format!("pixel {pixel}"));
        }
    }
    comparison.assert_all();
    // The twin: this side reflects something else
    let different = other_side.iter().zip(expected(1.0)).filter(|(a, b)| a.distance(*b) > 1e-2).count();
    assert!(different > thin.len() / 2, "{name}: {different} of {}", thin.len());
}

#[test]
fn a_film_is_above_what_is_diffused_and_no_lobe_of_its_own() {
    let Some(engine) = TestEngine::new() else { return };
    let mut paper = scene("paper.glb");
    let with = |scene: &Scene, surfaces| {
        reflected(&engine, scene, |renderer, _| renderer.shade_as(pass(surfaces)).map(|_| ()))
    };
    let bare = mean(&with(&paper, THROUGH));
    for material in paper.materials.iter_mut().filter(|material| material.material.transmission > 0.0) {
        material.material.film = Some(ThinFilm { weight: 1.0, ior: 2.0, thickness: 120.0 });
    }
    // Whether something else in the scene is glass
    let [alone, beside_glass] =
        [THROUGH - Effects::GLOSSY, THROUGH].map(|surfaces| with(&paper, surfaces | Effects::THIN_FILM));
    assert!(alone == beside_glass, "{} {}", mean(&alone), mean(&beside_glass));
    assert!(mean(&alone) > 0.3 * bare && mean(&alone) < 0.9 * bare, "{} {bare}", mean(&alone));
}

#[test]
fn opaque_surfaces_let_nothing_through() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene("room.glb");
    assert!(!scene.effects().contains(Effects::TRANSMISSION));
    assert!(let_through(&engine, &scene).iter().all(|through| *through == Vec3::ZERO));
    // The twin: of paper some do
    assert!(mean(&let_through(&engine, &self::scene("paper.glb"))) > 0.01);
}

#[test]
fn tiles_leave_out_no_light_from_behind() {
    let Some(engine) = TestEngine::new() else { return };
    for (_, scene) in thin_scenes() {
        compare_with_tiles(&engine, &scene);
    }
}

fn compare_with_tiles(engine: &TestEngine, scene: &Scene) {
    let whole = let_through(engine, scene);
    let tiles = TileOptions { least_quads: 0, ..TileOptions::default() };
    let by_tiles = |surfaces: Effects| {
        reflected(engine, scene, |renderer, _| {
            let view = renderer.tiled(pass(surfaces), tiles)?;
            renderer.shade_tiled(&view).map(|_| ())
        })
    };
    // Pipelines of tiles round a light's sum in another order
    let radiance: f32 = scene.lights.iter().map(|light| light.radiance.max_element()).sum();
    let apart = |tiled: &[Vec3]| {
        let far = |(a, b): &(&Vec3, &Vec3)| (**a - **b).abs().max_element() > 1e-6 * radiance;
        whole.iter().zip(tiled).filter(far).count()
    };
    assert_eq!(apart(&by_tiles(THROUGH)), 0);
    // The twin: lists made for this side lack what lights the other
    assert!(apart(&by_tiles(THROUGH - Effects::TRANSMISSION)) > 500);
}

#[test]
fn the_reference_lets_as_much_through() {
    let Some(engine) = TestEngine::new() else { return };
    for (name, scene) in thin_scenes() {
        compare_with_reference(&engine, name, &scene);
    }
}

fn compare_with_reference(engine: &TestEngine, name: &str, scene: &Scene) {
    let thin = is_thin(engine, scene);
    let of_thin = |picture: Vec<Vec3>| -> f64 {
        mean(&picture.into_iter().zip(&thin).filter_map(|(p, thin)| thin.then_some(p)).collect::<Vec<_>>())
    };
    for shadows in [false, true] {
        let truth = of_thin(reflected(engine, scene, |renderer, _| {
            let reference = Reference { samples: 64, seed: 5, shadows, ..Reference::default() };
            renderer.reference(reference, |_| {}).map(|_| ())
        }));
        let ours = |surfaces: Effects| {
            of_thin(reflected(engine, scene, |renderer, buffers| {
                if !shadows {
                    return renderer.shade(surfaces, Quality::default()).map(|_| ());
                }
                let each = |renderer: &mut SceneRenderer<'_>, surfaces: Effects| {
                    let options = ShadeOptions { surfaces, shadow_rays: 4, ..ShadeOptions::default() };
                    let view =
                        renderer.shadowed(buffers, options, (ShadowFilter::Off, ShadowHistory::Off))?;
                    renderer.shade_shadowed(&view, 3)
                };
                renderer.each_pass(surfaces, each).map(|_| ())
            }))
        };
        // The coupled lobe errs by .2 % and reflections off paper are faint; the noise of both, over 2,000
        // pixels, is below 1 %
        let ratio = ours(scene.effects()) / truth;
        assert!((ratio - 1.0).abs() < 0.02, "{name}, shadows {shadows}: {ratio}");
        // The twin: without what is let through most is missing
        let without = ours(scene.effects() - (Effects::TRANSMISSION | Effects::GLASS)) / truth;
        assert!(without < 0.5, "{name}, shadows {shadows}: {without}");
    }
}
