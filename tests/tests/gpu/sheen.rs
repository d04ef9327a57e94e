//! Sheen on the GPU: against the float64 twin, against none, and in its image of a G-buffer.

use arealight::plan::GBufferLayout;
use arealight::{Effects, Plane, Quality};
use arealight_engine::EvalPoint;
use arealight_oracle::material::{Coat, Material, Sheen, Surface};
use arealight_tests::materials::{lobe_qualities, shape_lights, under_polygon};
use arealight_tests::one_pixel::{LAYOUTS, OnePixel, material, under_lamp};
use arealight_tests::{Random, TestEngine, point, rounding};
use arealight_vk::ash::vk::Format;
use glam::{DVec3, Vec3, Vec4};
use std::f64::consts::FRAC_PI_2;

const COUNT: usize = 2000;

/// A base below sheen, and every third below a coat above that.
fn with_sheen(random: &mut Random, index: usize) -> Surface {
    let coat = Coat { weight: 0.7, alpha: random.between(0.05, 1.0), normal: None, by_albedo: false };
    Surface {
        diffuse_albedo: DVec3::new(0.8, 0.3, 0.1),
        f0: DVec3::new(0.04, 0.5, 0.9),
        f90: 1.0,
        alpha: random.between(0.2, 1.0),
        coat: (index.is_multiple_of(3)).then_some(coat),
        sheen: Some(Sheen {
            color: DVec3::new(random.unit(), random.unit(), random.unit()),
            // Below the smallest and beyond the largest, too
            roughness: random.between(0.0, 1.1),
        }),
        ..Surface::default()
    }
}

/// Points under polygons of 3 to 8 vertices anywhere: views at the normal, near it, anywhere, and grazing to
/// 89.9 degrees and beyond.
fn points(seed: u64) -> Vec<EvalPoint> {
    let mut random = Random::new(seed);
    let one = |i: usize| {
        let surface = with_sheen(&mut random, i);
        let theta = match i % 8 {
            0 => 0.0,
            1 => random.between(0.0, 1e-3),
            2 => 89.9_f64.to_radians(),
            3 => FRAC_PI_2 - random.between(0.0, 0.05),
            _ => random.between(0.0, FRAC_PI_2),
        };
        let view = DVec3::new(theta.sin(), 0.0, theta.cos());
        under_polygon(&mut random, i, surface, view)
    };
    (0..COUNT).map(one).collect()
}

/// What float32 may lose of the lobes: of the base, of a coat, and of sheen. Its exponential multiplies an
/// exponent's rounding, which is that of sums of terms up to 120, and where the view grazes the albedo
/// follows its cosine.
fn bound(surface: &Surface) -> f64 {
    let coat = surface.coat.map_or(0.0, |coat| rounding(coat.alpha));
    (2.0 * rounding(surface.alpha) + coat + 1e-5) / 0.6
}

#[test]
fn sheen_follows_its_float64_twin() {
    let Some(engine) = TestEngine::new() else { return };
    let points = points(1);
    for quality in lobe_qualities() {
        // The twin's twin: sheen that is a little rougher is another
        engine.assert_follows_polygon_twin(
            "sheen",
            quality,
            &points,
            |given| bound(&given.surface),
            |surface| {
                let sheen = surface.sheen.map(|sheen| Sheen { roughness: sheen.roughness * 1.1, ..sheen });
                Surface { sheen, ..*surface }
            },
        );
    }
}

#[test]
fn disks_spheres_and_tubes_light_sheen_as_their_float64_twins() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(2);
    let points: Vec<EvalPoint> = points(3)
        .into_iter()
        .take(300)
        .flat_map(|EvalPoint { surface, position, normal, view, .. }| {
            // One kind of pipeline: no coats
            let surface = Surface { coat: None, ..surface };
            shape_lights(&mut random).map(|light| EvalPoint { surface, position, normal, view, light })
        })
        .collect();
    // A curved outline's ends on a horizon: 1e-5 of a form factor (docs/shapes.md), which albedos of up to
    // 2.9 multiply
    engine.assert_follows_shape_twin("sheen under shapes", &points, |given| bound(&given.surface) + 3e-5);
}

#[test]
fn black_sheen_is_none_to_the_bit() {
    let Some(engine) = TestEngine::new() else { return };
    let uncoated = |sheen: fn(Sheen) -> Option<Sheen>| -> Vec<EvalPoint> {
        let change = |point: &EvalPoint| {
            let sheen = point.surface.sheen.and_then(sheen);
            EvalPoint { surface: Surface { sheen, coat: None, ..point.surface }, ..point.clone() }
        };
        points(4).iter().map(change).collect()
    };
    let black = uncoated(|sheen| Some(Sheen { color: DVec3::ZERO, ..sheen }));
    for quality in lobe_qualities() {
        let without = engine.eval_bits(&uncoated(|_| None), quality);
        assert_eq!(engine.eval_bits(&black, quality), without, "{quality:?}");
        // The twin: of any colour it is seen
        let with = engine.eval_bits(&uncoated(Some), quality);
        let same = with.iter().zip(&without).filter(|(with, without)| with == without).count();
        assert!(same < COUNT / 2, "{same} points are the same");
    }
}

#[test]
fn at_the_normal_sheen_does_not_jump() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(5);
    let quality = Quality::default();
    for roughness in [0.0, 0.1, 0.3, 0.6, 1.0] {
        let sheen = Some(Sheen { color: DVec3::ONE, roughness });
        let surface = Surface { sheen, coat: None, ..with_sheen(&mut random, 1) };
        let vertices = random.polygon(DVec3::new(0.5, 0.2, 1.0), 5, 0.3, 0.8);
        // Views a hundred-thousandth away on all sides, and far away
        let at = |theta: f64| -> Vec<Vec3> {
            let points: Vec<EvalPoint> = (0..12)
                .map(|i| {
                    let (y, x) = (f64::from(i) / 12.0 * std::f64::consts::TAU).sin_cos();
                    let view = DVec3::new(theta.sin() * x, theta.sin() * y, theta.cos());
                    point(surface, view, vertices.clone(), true)
                })
                .collect();
            engine.eval(&points, quality).unwrap()
        };
        let spread = |answers: &[Vec3]| {
            let differences = answers.iter().map(|answer| (*answer - answers[0]).abs().max_element());
            differences.fold(0.0_f32, f32::max)
        };
        assert!(spread(&at(1e-5)) < 1e-4, "{roughness}: {}", spread(&at(1e-5)));
        assert!(spread(&at(0.5)) > 3e-4, "{roughness}: {}", spread(&at(0.5)));
    }
}

#[test]
fn every_layout_has_its_sheen_in_an_image_of_its_own() {
    let Some(engine) = TestEngine::new() else { return };
    let texel = [0.9_f32, 0.5, 0.2, 0.4];
    let shade = |layout, effects, sheen: [f32; 4]| {
        let mut pixel = OnePixel::new(&engine, Vec4::W, 1.0);
        pixel.set(Plane::Sheen, Format::R32G32B32A32_SFLOAT, sheen);
        pixel.shade_under_lamp(layout, effects)
    };
    for layout in LAYOUTS {
        let without = shade(layout, Effects::empty(), texel);
        assert_eq!(shade(layout, Effects::SHEEN, [0.0, 0.0, 0.0, 0.4]), without, "{layout:?}: black is none");
        assert_ne!(shade(layout, Effects::SHEEN, texel), without, "{layout:?}");
    }
    // Against a point without a G-buffer
    let material = Material { sheen_color: Vec3::new(0.9, 0.5, 0.2), sheen_roughness: 0.4, ..material() };
    let expected = engine.eval(&[under_lamp(material.surface())], Quality::default()).unwrap()[0];
    let found = shade(GBufferLayout::Arealight, Effects::SHEEN, texel);
    // Radiance of 3 and three lobes
    assert!((found - expected).abs().max_element() < 2e-5, "{found} and {expected}");
}
