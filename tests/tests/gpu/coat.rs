//! Clear coats on the GPU: against the float64 twin, against no coat, and where they are hard.

use arealight::MIN_ALPHA;
use arealight_oracle::frame::SurfaceFrame;
use arealight_tests::materials::{changed, points_of};
use arealight_tests::one_pixel::LAYOUTS;
use arealight_tests::prelude::*;
use arealight_vk::ash::vk::Format;

const COUNT: usize = 2000;

/// A metal or a dielectric below a coat whose normal is tilted by up to `tilt` from z.
fn coated(random: &mut Random, tilt: f64) -> Surface {
    let (sin, cos) = random.between(0.0, tilt).sin_cos();
    let (y, x) = random.between(0.0, TAU).sin_cos();
    let normal = DVec3::new(x * sin, y * sin, cos) * random.between(0.5, 2.0);
    Surface {
        diffuse_albedo: DVec3::new(0.8, 0.3, 0.1),
        f0: DVec3::new(0.04, 0.5, 0.9),
        f90: 1.0,
        alpha: random.between(0.2, 1.0),
        coat: Some(Coat {
            weight: random.between(0.2, 1.0),
            alpha: 10.0_f64.powf(random.between(-2.0, 0.0)),
            normal: (tilt > 0.0).then_some(normal),
            by_albedo: false,
        }),
        ..Surface::default()
    }
}

/// Coated points under polygons of 3 to 8 vertices anywhere, above, across and below their horizons.
fn points(seed: u64, tilt: f64) -> Vec<EvalPoint> {
    points_of(seed, COUNT, 0.02, |random, _| coated(random, tilt))
}

/// What float32 may lose of the three lobes, of the coat's by its share: with both horizons they are divided
/// by their parts above the surface, of which the base's is at least .6 and the coat's the larger of two.
fn bound(surface: &Surface, normal: DVec3, view: DVec3) -> f64 {
    let coat = surface.coat.map_or(0.0, |coat| {
        let cos_view = SurfaceFrame::new(coat.normal.unwrap_or(normal), view).cos_view();
        coat.share(cos_view) * rounding(coat.alpha)
    });
    (2.0 * rounding(surface.alpha) + coat) / 0.6
}

/// What float32 loses more over half vectors of a coat whose horizon the view is at or below: the half
/// vectors of light that passes straight on are differences of unit vectors there, 1e-3 long. 1.1e-4 of what
/// the coat reflects, by measurement.
fn along_the_coat(quality: Quality, surface: &Surface, normal: DVec3, view: DVec3) -> f64 {
    let of_coat = |coat: Coat| {
        let cos_view = SurfaceFrame::new(coat.normal.unwrap_or(normal), view).cos_view();
        if cos_view < 2e-3 { 2e-4 * coat.share(cos_view) } else { 0.0 }
    };
    let over_half_vectors = quality.specular_lobes == SpecularLobes::HalfVectors;
    if over_half_vectors { surface.coat.map_or(0.0, of_coat) } else { 0.0 }
}

#[test]
fn coats_follow_their_float64_twin() {
    let Some(engine) = TestEngine::new() else { return };
    // The surface's normal; one of its own; one that the view may be behind
    for (seed, tilt) in [(1, 0.0), (2, 0.6), (3, 2.5)] {
        let points = points(seed, tilt);
        for quality in lobe_qualities() {
            let bound = |given: &EvalPoint| {
                let EvalPoint { surface, normal, view, .. } = given;
                bound(surface, *normal, *view) + along_the_coat(quality, surface, *normal, *view)
            };
            // The twin's twin: a coat that is a little rougher is another
            engine.assert_follows_polygon_twin(
                &format!("tilts to {tilt}"),
                quality,
                &points,
                bound,
                |surface| {
                    let coat = surface.coat.map(|coat| Coat { alpha: coat.alpha * 1.1, ..coat });
                    Surface { coat, ..*surface }
                },
            );
        }
    }
}

#[test]
fn disks_spheres_and_tubes_light_coats_as_their_float64_twins() {
    let Some(engine) = TestEngine::new() else { return };
    let points = under_shapes(4, points(5, 1.0).into_iter().take(300));
    // A curved outline's ends on a horizon: 1e-5 of a form factor (docs/shapes.md)
    engine.assert_follows_shape_twin("coats under shapes", &points, |given| {
        bound(&given.surface, given.normal, given.view) + 1e-5
    });
}

#[test]
fn a_coat_of_no_weight_is_none_to_the_bit() {
    let Some(engine) = TestEngine::new() else { return };
    let with = points(6, 2.5);
    let of = |change: fn(Coat) -> Option<Coat>| {
        changed(&with, |surface| Surface { coat: surface.coat.and_then(change), ..*surface })
    };
    let weightless = of(|coat| Some(Coat { weight: 0.0, ..coat }));
    engine.assert_none_to_the_bit(&lobe_qualities(), [&weightless, &of(|_| None), &with]);
}

#[test]
fn a_white_surface_below_a_coat_sends_no_more_than_it_gets() {
    let Some(engine) = TestEngine::new() else { return };
    let mut surfaces = Vec::new();
    // Mirrors of roughness 0 too; grazing views; normals behind which the view is
    for alpha in [0.0, MIN_ALPHA, 0.01, 0.3, 1.0] {
        for tilt in [0.0_f64, 0.3, 1.2, 1.57, 2.5] {
            for theta in [0.0_f64, 0.7, 1.5, 1.569, 1.8] {
                let normal = Some(DVec3::new(-0.8 * tilt.sin(), 0.6 * tilt.sin(), tilt.cos()));
                let coat = Some(Coat { weight: 1.0, alpha, normal, by_albedo: false });
                let surface = Surface { coat, ..lambert_surface() };
                let view = DVec3::new(theta.sin(), 0.0, theta.cos());
                surfaces.push((surface, view));
            }
        }
    }
    for quality in lobe_qualities() {
        let sums = engine.light_from_everywhere(&surfaces, quality);
        assert_eq!(sums.len(), 5 * 5 * 5);
        // The twin: the box is lit from all sides, and coats of a view from above hardly lose light
        let bright = sums.iter().filter(|sum| **sum > 0.9).count();
        assert!(bright > 40, "{quality:?}: {bright}");
    }
}

/// A direction's place on an unfolded octahedron.
fn octahedron(direction: Vec3) -> [f32; 2] {
    let Vec3 { x, y, z } = direction / direction.abs().element_sum();
    if z >= 0.0 { [x, y] } else { [(1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y)] }
}

#[test]
fn every_layout_has_its_coats_in_an_image_of_their_own() {
    let Some(engine) = TestEngine::new() else { return };
    let material = Material { coat: 0.75, coat_roughness: 0.3, ..material() };
    let below = |normal: Option<Vec3>| {
        let surface = material.surface();
        let coat = surface.coat.map(|coat| Coat { normal: normal.map(Vec3::as_dvec3), ..coat });
        Surface { coat, ..surface }
    };
    // Down to the lower half of the octahedron
    for normal in [Vec3::new(0.3, -0.2, 0.9), Vec3::new(0.9, 0.3, -0.2)] {
        let [x, y] = octahedron(normal);
        let coats = Effects::COAT | Effects::COAT_NORMAL;
        // With a normal of its own, and without
        for (effects, normal) in [(coats, Some(normal)), (Effects::COAT, None)] {
            // Radiance of 3, three lobes, and a normal that is rounded on its way through the octahedron
            let (nones, texels) = ([[0.0, 0.3, x, y]], [[0.75, 0.3, x, y]]);
            engine.assert_plane((Plane::Coat, effects), &nones, &texels, (below(normal), 2e-5));
        }
        for layout in LAYOUTS {
            let mut pixel = OnePixel::new(&engine, Vec4::W, 1.0);
            pixel.set(Plane::Coat, Format::R32G32B32A32_SFLOAT, [0.75_f32, 0.3, x, y]);
            let [with, without] = [coats, Effects::COAT].map(|all| pixel.shade_under_lamp(layout, all));
            assert_ne!(with, without, "{layout:?}");
        }
    }
}
