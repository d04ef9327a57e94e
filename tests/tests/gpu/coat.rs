//! Clear coats on the GPU: against the float64 twin, against no coat, and where they are hard.

use arealight::plan::{GBufferLayout, ShadeOptions};
use arealight::{
    Effects, Fresnel, Horizon, Light, LightShape, LightTable, Lobes, MIN_ALPHA, Quality, TubeEnds,
};
use arealight_engine::EvalPoint;
use arealight_oracle::frame::SurfaceFrame;
use arealight_oracle::material::{Coat, Surface};
use arealight_oracle::shading::{RelativeLight, ltc_on, shape_ltc_on};
use arealight_tests::one_pixel::{OnePixel, lamp, sampled};
use arealight_tests::{Comparison, Random, TestEngine, lambert_surface, point, rounding};
use arealight_vk::ash::vk::Format;
use glam::{DVec3, Vec3, Vec4};
use std::sync::LazyLock;

const COUNT: usize = 2000;

static TABLE: LazyLock<LightTable> = LazyLock::new(arealight_table::ggx);

/// A metal or a dielectric below a coat whose normal is tilted by up to `tilt` from z.
fn coated(random: &mut Random, tilt: f64) -> Surface {
    let (sin, cos) = random.between(0.0, tilt).sin_cos();
    let (y, x) = random.between(0.0, std::f64::consts::TAU).sin_cos();
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
    let mut random = Random::new(seed);
    let one = |i| {
        let surface = coated(&mut random, tilt);
        let cos_view = random.between(0.02, 1.0);
        let view = DVec3::new((1.0 - cos_view * cos_view).sqrt(), 0.0, cos_view);
        let center = random.direction();
        let size = random.between(0.1, 1.5);
        let vertices = random.polygon(center, 3 + i % 6, size * 0.3, size);
        point(surface, view, vertices, i % 3 == 0)
    };
    (0..COUNT).map(one).collect()
}

fn qualities() -> impl Iterator<Item = Quality> {
    let (by_f0, cosine) = (Quality::default(), Horizon::Cosine);
    [
        by_f0,
        Quality { horizon: Horizon::Both, ..by_f0 },
        Quality { fresnel: Fresnel::Split, horizon: cosine, ..by_f0 },
        Quality { lobes: Lobes::Formula, horizon: cosine, ..by_f0 },
    ]
    .into_iter()
}

/// What float32 may lose of the three lobes, of the coat's by its share: with both horizons they are divided by their parts above the
/// surface, of which the base's is at least .6 and the coat's the larger of two.
fn bound(surface: &Surface, normal: DVec3, view: DVec3) -> f64 {
    let coat = surface.coat.map_or(0.0, |coat| {
        let cos_view = SurfaceFrame::new(coat.normal.unwrap_or(normal), view).cos_view();
        coat.share(cos_view) * rounding(coat.alpha)
    });
    (2.0 * rounding(surface.alpha) + coat) / 0.6
}

#[test]
fn coats_follow_their_float64_twin() {
    let Some(engine) = TestEngine::new() else { return };
    // The surface's normal; one of its own; one that the view may be behind
    for (seed, tilt) in [(1, 0.0), (2, 0.6), (3, 2.5)] {
        let points = points(seed, tilt);
        for quality in qualities() {
            let answers = engine.eval(&points, quality).unwrap();
            let mut comparison = Comparison::new(format!("tilts to {tilt}, {quality:?}"));
            let mut other = 0;
            for (index, (given, answer)) in points.iter().zip(&answers).enumerate() {
                let light = RelativeLight::new(&given.light, given.position);
                let twin =
                    |surface: &Surface| ltc_on(quality, &TABLE, surface, given.normal, given.view, &light);
                let (expected, bound) =
                    (twin(&given.surface), bound(&given.surface, given.normal, given.view));
                for channel in 0..3 {
                    let place = || format!("point {index}, channel {channel}: {given:?}");
                    comparison.add(answer[channel].into(), expected[channel], bound, place);
                }
                // The twin's twin: a coat that is a little rougher is another
                let rougher = given.surface.coat.map(|coat| Coat { alpha: coat.alpha * 1.1, ..coat });
                let rougher = twin(&Surface { coat: rougher, ..given.surface });
                other += usize::from((rougher - answer.as_dvec3()).abs().max_element() > bound);
            }
            comparison.assert_all();
            assert!(other > COUNT / 10, "{other} points notice another roughness");
        }
    }
}

/// Lights of each shape about as large as they are far.
fn shapes(random: &mut Random) -> [Light; 3] {
    let center = random.direction() * 2.0;
    let (axis_u, axis_v) = center.normalize_or(DVec3::Z).any_orthonormal_pair();
    let light = |shape| Light {
        name: "test".into(),
        shape,
        radiance: Vec3::ONE,
        two_sided: true,
        ..Light::default()
    };
    let ends = TubeEnds::Round;
    [
        light(LightShape::Disk { center, axis_u: axis_u * 0.7, axis_v }),
        light(LightShape::Sphere { center, radius: 0.6 }),
        light(LightShape::Tube { p0: center - axis_u, p1: center + axis_u, radius: 0.2, ends }),
    ]
}

#[test]
fn disks_spheres_and_tubes_light_coats_as_their_float64_twins() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(4);
    let points: Vec<EvalPoint> = points(5, 1.0)
        .into_iter()
        .take(300)
        .flat_map(|EvalPoint { surface, position, normal, view, .. }| {
            shapes(&mut random).map(|light| EvalPoint { surface, position, normal, view, light })
        })
        .collect();
    let quality = Quality::default();
    let answers = engine.eval_shapes(&points, quality).unwrap();
    let mut comparison = Comparison::new("coats under shapes");
    for (index, (given, answer)) in points.iter().zip(&answers).enumerate() {
        let EvalPoint { surface, normal, view, light, .. } = given;
        let expected = shape_ltc_on(quality, &TABLE, surface, *normal, *view, light).unwrap();
        for channel in 0..3 {
            // A curved outline's ends on a horizon: 1e-5 of a form factor (docs/shapes.md)
            let bound = bound(surface, *normal, *view) + 1e-5;
            let place = || format!("point {index}, channel {channel}: {given:?}");
            comparison.add(answer[channel].into(), expected[channel], bound, place);
        }
    }
    comparison.assert_all();
}

#[test]
fn a_coat_of_no_weight_is_none_to_the_bit() {
    let Some(engine) = TestEngine::new() else { return };
    let with = points(6, 2.5);
    let changed = |change: fn(Coat) -> Option<Coat>| -> Vec<EvalPoint> {
        let change = |point: &EvalPoint| {
            let coat = point.surface.coat.and_then(change);
            EvalPoint { surface: Surface { coat, ..point.surface }, ..point.clone() }
        };
        with.iter().map(change).collect()
    };
    let bits = |points: &[EvalPoint], quality| -> Vec<[u32; 3]> {
        let answers = engine.eval(points, quality).unwrap();
        answers.iter().map(|answer| answer.to_array().map(f32::to_bits)).collect()
    };
    let weightless = changed(|coat| Some(Coat { weight: 0.0, ..coat }));
    for quality in qualities() {
        let without = bits(&changed(|_| None), quality);
        assert_eq!(bits(&weightless, quality), without, "{quality:?}");
        // The twin: of any weight it is seen
        let same =
            bits(&with, quality).iter().zip(&without).filter(|(with, without)| with == without).count();
        assert!(same < COUNT / 2, "{same} points are the same");
    }
}

/// The inside of a box about the point.
fn box_faces() -> Vec<Vec<DVec3>> {
    let corner = |axis: usize, side: f64, u: f64, v: f64| {
        let mut corner = DVec3::splat(side);
        (corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (u, v * side);
        corner
    };
    let face = |axis, side| {
        [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)].map(|(u, v)| corner(axis, side, u, v)).to_vec()
    };
    (0..3).flat_map(|axis| [face(axis, 1.0), face(axis, -1.0)]).collect()
}

#[test]
fn a_white_surface_below_a_coat_sends_no_more_than_it_gets() {
    let Some(engine) = TestEngine::new() else { return };
    let mut points = Vec::new();
    // Mirrors of roughness 0 too; grazing views; normals behind which the view is
    for alpha in [0.0, MIN_ALPHA, 0.01, 0.3, 1.0] {
        for tilt in [0.0_f64, 0.3, 1.2, 1.57, 2.5] {
            for theta in [0.0_f64, 0.7, 1.5, 1.569, 1.8] {
                let normal = Some(DVec3::new(-0.8 * tilt.sin(), 0.6 * tilt.sin(), tilt.cos()));
                let coat = Some(Coat { weight: 1.0, alpha, normal, by_albedo: false });
                let surface = Surface { coat, ..lambert_surface() };
                let view = DVec3::new(theta.sin(), 0.0, theta.cos());
                points.extend(box_faces().into_iter().map(|face| point(surface, view, face, false)));
            }
        }
    }
    for quality in qualities() {
        let answers = engine.eval(&points, quality).unwrap();
        let sums: Vec<f32> =
            answers.chunks_exact(6).map(|faces| faces.iter().map(|face| face.x).sum()).collect();
        assert_eq!(sums.len(), 5 * 5 * 5);
        for (sum, faces) in sums.iter().zip(points.chunks_exact(6)) {
            // Six faces and a lobe of each, 1e-6 every one; and the lobe's gain
            assert!((0.0..=1.0 + 2e-5).contains(sum), "{quality:?}: {sum} of {:?}", faces[0]);
        }
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
    let camera = Vec3::new(1.0, 0.5, 2.0);
    let shade = |layout, effects, coat: [f32; 4]| {
        let mut pixel = OnePixel::new(&engine, Vec4::W, 1.0);
        pixel.coat = sampled(&engine, Format::R32G32B32A32_SFLOAT, coat);
        let surfaces = Effects::DIFFUSE | Effects::GLOSSY | Effects::SPECULAR_INPUT | effects;
        pixel
            .shade(
                ShadeOptions { surfaces, g_buffer: layout, ..ShadeOptions::default() },
                &[lamp()],
                camera,
                None,
            )
            .truncate()
    };
    let coats = Effects::COAT | Effects::COAT_NORMAL;
    // Down to the lower half of the octahedron
    for normal in [Vec3::new(0.3, -0.2, 0.9), Vec3::new(0.9, 0.3, -0.2)] {
        let [x, y] = octahedron(normal);
        let texel = [0.75, 0.3, x, y];
        for layout in
            [GBufferLayout::Arealight, GBufferLayout::Unreal, GBufferLayout::Unity, GBufferLayout::Octahedral]
        {
            let without = shade(layout, Effects::empty(), texel);
            assert_eq!(shade(layout, coats, [0.0, 0.3, x, y]), without, "{layout:?}: no weight, no coat");
            assert_ne!(shade(layout, coats, texel), without, "{layout:?}");
            assert_ne!(shade(layout, coats, texel), shade(layout, Effects::COAT, texel), "{layout:?}");
        }
        // Against a point without a G-buffer
        let material = arealight_oracle::material::Material {
            base_color: Vec3::new(0.8, 0.6, 0.4),
            metalness: 0.25,
            roughness: 0.5,
            dielectric_f0: Vec3::new(0.8, 0.6, 0.4),
            dielectric_f90: 0.25,
            coat: 0.75,
            coat_roughness: 0.3,
            ..arealight_oracle::material::Material::default()
        };
        let given = |normal: Option<Vec3>| {
            let surface = material.surface();
            let coat = surface.coat.map(|coat| Coat { normal: normal.map(Vec3::as_dvec3), ..coat });
            EvalPoint {
                surface: Surface { coat, ..surface },
                position: DVec3::ZERO,
                normal: DVec3::Z,
                view: camera.as_dvec3(),
                light: lamp(),
            }
        };
        for (effects, given) in [(coats, given(Some(normal))), (Effects::COAT, given(None))] {
            let expected = engine.eval(&[given], Quality::default()).unwrap()[0];
            let found = shade(GBufferLayout::Arealight, effects, texel);
            // Radiance of 3, three lobes, and a normal that is rounded on its way through the octahedron
            assert!((found - expected).abs().max_element() < 2e-5, "{effects}: {found} and {expected}");
        }
    }
}
