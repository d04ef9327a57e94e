//! Sheen on the GPU: against the float64 twin, against none, and in its image of a G-buffer.

use arealight_oracle::material::Sheen;
use arealight_tests::materials::changed;
use arealight_tests::prelude::*;
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
    // One kind of pipeline: no coats
    let points = changed(&points(3)[..300], |surface| Surface { coat: None, ..*surface });
    let points = under_shapes(2, points);
    // A curved outline's ends on a horizon: 1e-5 of a form factor (docs/shapes.md), which albedos of up to
    // 2.9 multiply
    engine.assert_follows_shape_twin("sheen under shapes", &points, |given| bound(&given.surface) + 3e-5);
}

#[test]
fn black_sheen_is_none_to_the_bit() {
    let Some(engine) = TestEngine::new() else { return };
    let with = points(4);
    let of = |change: fn(Sheen) -> Option<Sheen>| {
        changed(&with, |surface| Surface { sheen: surface.sheen.and_then(change), coat: None, ..*surface })
    };
    let black = of(|sheen| Some(Sheen { color: DVec3::ZERO, ..sheen }));
    engine.assert_none_to_the_bit(&lobe_qualities(), [&black, &of(|_| None), &of(Some)]);
}

#[test]
fn at_the_normal_sheen_does_not_jump() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(5);
    for roughness in [0.0, 0.1, 0.3, 0.6, 1.0] {
        let sheen = Some(Sheen { color: DVec3::ONE, roughness });
        let surface = Surface { sheen, coat: None, ..with_sheen(&mut random, 1) };
        let vertices = random.polygon(DVec3::new(0.5, 0.2, 1.0), 5, 0.3, 0.8);
        // Views a hundred-thousandth away on all sides, and far away
        let spread = |tilt| engine.spread_about_the_normal(surface, &vertices, tilt);
        assert!(spread(1e-5) < 1e-4, "{roughness}: {}", spread(1e-5));
        assert!(spread(0.5) > 3e-4, "{roughness}: {}", spread(0.5));
    }
}

#[test]
fn every_layout_has_its_sheen_in_an_image_of_its_own() {
    let Some(engine) = TestEngine::new() else { return };
    let material = Material { sheen_color: Vec3::new(0.9, 0.5, 0.2), sheen_roughness: 0.4, ..material() };
    let (black, texels) = ([[0.0, 0.0, 0.0, 0.4]], [[0.9, 0.5, 0.2, 0.4]]);
    // Radiance of 3 and three lobes
    engine.assert_plane((Plane::Sheen, Effects::SHEEN), &black, &texels, (material.surface(), 2e-5));
}
