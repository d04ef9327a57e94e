//! Light that facets reflect more than once, on the GPU: against the float64 twin, and where all of it has to
//! come back.

use arealight_oracle::material::{Anisotropy, Interface};
use arealight_tests::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// Metals and dielectrics, every third stretched along a tangent, every fourth with a coupled diffuse lobe.
fn surface(random: &mut Random, index: usize) -> Surface {
    let alpha = random.between(0.05, 1.0);
    let anisotropy = Anisotropy { tangent: random.direction(), alpha: random.between(0.05, 1.0) };
    Surface {
        diffuse_albedo: DVec3::new(0.3, 0.2, 0.1),
        f0: DVec3::new(random.unit(), random.unit(), 1.0),
        f90: 1.0,
        alpha,
        multiple_scattering: true,
        interface: (index.is_multiple_of(4)).then_some(Interface {
            f0: 0.04,
            f90: 1.0,
            by_albedo: index.is_multiple_of(8),
        }),
        anisotropy: (index.is_multiple_of(3)).then_some(anisotropy),
        ..Surface::default()
    }
}

fn points(seed: u64) -> Vec<EvalPoint> {
    let mut random = Random::new(seed);
    let one = |index| {
        let surface = surface(&mut random, index);
        let theta = random.between(0.0, FRAC_PI_2 - 0.02);
        under_polygon(&mut random, index, surface, DVec3::new(theta.sin(), 0.0, theta.cos()))
    };
    (0..2000).map(one).collect()
}

#[test]
fn light_reflected_more_than_once_follows_its_float64_twin() {
    let Some(engine) = TestEngine::new() else { return };
    let points = points(1);
    // As stretched lobes (anisotropy.rs), and twice that where a dark lobe's light is made up for
    let bound = |given: &EvalPoint| {
        let least =
            given.surface.anisotropy.map_or(given.surface.alpha, |a| a.alpha.min(given.surface.alpha));
        2.0 * (2.0 * rounding(least) / 0.6 + 2e-5)
    };
    for quality in lobe_qualities() {
        // The twin's twin: without it surfaces are darker
        engine.assert_follows_polygon_twin("rescattered", quality, &points, bound, |surface| Surface {
            multiple_scattering: false,
            ..*surface
        });
    }
}

#[test]
fn a_white_rough_metal_sends_all_that_it_gets() {
    let Some(engine) = TestEngine::new() else { return };
    let metal = |alpha: f64, theta: f64, multiple_scattering| {
        let white = Surface { f0: DVec3::ONE, f90: 1.0, alpha, multiple_scattering, ..Surface::default() };
        (white, DVec3::new(theta.sin(), 0.0, theta.cos()))
    };
    let all = |multiple_scattering| -> Vec<(Surface, DVec3)> {
        let alphas = [0.04, 0.16, 0.36, 0.64, 1.0];
        let angles = [0.0, 0.6, 1.1, 1.4];
        alphas.into_iter().flat_map(|a| angles.map(|theta| metal(a, theta, multiple_scattering))).collect()
    };
    for lobes in [Lobes::Table, Lobes::Formula] {
        let quality = Quality { lobes, ..Quality::default() };
        let with = engine.light_from_everywhere(&all(true), quality);
        // The lobe of a dark albedo is 4 % brighter, and the table's own rounding with it
        assert!(with.iter().all(|sum| *sum > 1.0 - 1e-4), "{lobes:?}: {with:?}");
        // The twin: a third of the light is lost of the roughest
        let without = engine.light_from_everywhere(&all(false), quality);
        let least = without.iter().fold(1.0_f32, |least, sum| least.min(*sum));
        assert!(least < 0.7, "{lobes:?}: {least}");
    }
}

#[test]
fn without_the_diffuse_lobe_there_is_none_of_it() {
    let Some(engine) = TestEngine::new() else { return };
    let shade = |surfaces, color: [f32; 4]| {
        let mut pixel = OnePixel::new(&engine, Vec4::new(0.1, 0.2, 0.0, 1.0), 0.5);
        pixel.set(Plane::BaseColor, vk::Format::R32G32B32A32_SFLOAT, color);
        let options = ShadeOptions { surfaces, ..ShadeOptions::default() };
        pixel.shade(options, &[lamp()], Vec3::new(0.0, -1.0, 1.0), None)
    };
    let [black, white] = [[0.0; 4], [1.0, 1.0, 1.0, 0.0]];
    let glossy = Effects::GLOSSY | Effects::MULTIPLE_SCATTERING;
    assert_eq!(shade(glossy, white), shade(glossy, black));
    // The twin: with it there is
    let both = glossy | Effects::DIFFUSE;
    assert!(shade(both, white).x > shade(both, black).x + 0.01);
}

#[test]
fn it_is_a_choice_of_model_with_a_name() {
    assert!(Effects::MODEL.contains(Effects::MULTIPLE_SCATTERING));
    assert_eq!(Effects::MULTIPLE_SCATTERING.to_string(), "multiple_scattering");
}
