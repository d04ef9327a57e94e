//! Diffuse lobes below a Fresnel term on the GPU, rough ones, and layers by albedo: against the float64 twin,
//! and where they are hard.

use arealight_oracle::material::Interface;
use arealight_tests::materials::{changed, points_of};
use arealight_tests::prelude::*;

const COUNT: usize = 2000;

/// How layers share light.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// A dielectric, coupled by the Fresnel term.
    Coupled,
    /// The same with a rough diffuse lobe.
    Rough,
    /// With a coat, all layers by albedo.
    ByAlbedo,
}

const KINDS: [Kind; 3] = [Kind::Coupled, Kind::Rough, Kind::ByAlbedo];

fn layered(random: &mut Random, kind: Kind) -> Surface {
    let by_albedo = kind == Kind::ByAlbedo;
    let f0 = random.between(0.0, 0.5);
    Surface {
        diffuse_albedo: DVec3::new(0.8, 0.3, 0.1),
        f0: DVec3::splat(f0),
        f90: 1.0,
        alpha: random.between(0.05, 1.0),
        diffuse_roughness: if kind == Kind::Rough { random.between(0.0, 1.0) } else { 0.0 },
        interface: Some(Interface { f0, f90: random.between(0.0, 1.0), by_albedo }),
        coat: by_albedo.then(|| Coat {
            weight: random.between(0.2, 1.0),
            alpha: random.between(0.05, 1.0),
            normal: None,
            by_albedo: true,
        }),
        ..Surface::default()
    }
}

/// Points under polygons of 3 to 8 vertices anywhere, above, across and below their horizons.
fn points(seed: u64, kind: Kind) -> Vec<EvalPoint> {
    points_of(seed, COUNT, 0.0, |random, _| layered(random, kind))
}

/// Three lobes, divided by their parts above the surface where both horizons clip, of which the least is .6.
/// The view's cosine, whose rounding the albedos follow within alpha of the horizon (table.glsl), counts once
/// more for what the interface takes.
fn bound(surface: &Surface) -> f64 {
    let coat = surface.coat.map_or(0.0, |coat| 2.0 * rounding(coat.alpha));
    (3.0 * rounding(surface.alpha) + coat) / 0.6
}

#[test]
fn layers_follow_their_float64_twin() {
    let Some(engine) = TestEngine::new() else { return };
    for kind in KINDS {
        let points = points(1, kind);
        for quality in lobe_qualities() {
            let bound = |given: &EvalPoint| bound(&given.surface);
            // The twin's twin: an interface that reflects a little more is another
            engine.assert_follows_polygon_twin(&format!("{kind:?}"), quality, &points, bound, |surface| {
                let interface = surface.interface.map(|i| Interface { f90: i.f90 + 0.1, ..i });
                Surface { interface, ..*surface }
            });
        }
    }
}

#[test]
fn disks_spheres_and_tubes_light_layers_as_their_float64_twins() {
    let Some(engine) = TestEngine::new() else { return };
    // Surfaces of every kind in one list, each by what it asks for
    let points = under_shapes(4, KINDS.into_iter().flat_map(|kind| points(5, kind).into_iter().take(70)));
    // A curved outline's ends on a horizon: 1e-5 of a form factor (docs/shapes.md)
    engine.assert_follows_shape_twin("layers under shapes", &points, |given| bound(&given.surface) + 1e-5);
}

#[test]
fn an_interface_that_reflects_nothing_is_none_to_the_bit() {
    let Some(engine) = TestEngine::new() else { return };
    let with = points(7, Kind::Coupled);
    let of = |change: fn(Interface) -> Option<Interface>| {
        changed(&with, |surface| Surface { interface: surface.interface.and_then(change), ..*surface })
    };
    let dark = of(|interface| Some(Interface { f0: 0.0, f90: 0.0, ..interface }));
    engine.assert_none_to_the_bit(&[Quality::default()], [&dark, &of(|_| None), &with]);
}

#[test]
fn radiance_is_continuous_where_the_view_passes_the_normal() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(8);
    let vertices = random.polygon(DVec3::new(0.5, 0.2, 0.8), 5, 0.2, 0.6);
    for kind in KINDS {
        let surface = layered(&mut random, kind);
        let spread = |tilt| engine.spread_about_the_normal(surface, &vertices, tilt);
        // Next to the normal all are alike to rounding; the twin: at an angle they are not
        assert!(spread(1e-6) < 1e-5, "{}", spread(1e-6));
        assert!(spread(1.5) > 1e-3);
    }
}

#[test]
fn hard_surfaces_give_finite_radiance_and_no_more_than_they_get() {
    let Some(engine) = TestEngine::new() else { return };
    let mut points: Vec<EvalPoint> = KINDS.into_iter().flat_map(|kind| points(9, kind)).collect();
    let hard = [0.0, 1.0, -1.0, 2.0, f64::NAN, f64::INFINITY];
    let mut random = Random::new(11);
    let mut choose = || hard[(random.unit() * hard.len() as f64) as usize % hard.len()];
    for given in &mut points {
        let interface = given.surface.interface.as_mut().unwrap();
        (interface.f0, interface.f90) = (choose(), choose());
        given.surface.f0 = DVec3::splat(0.04);
        if given.surface.diffuse_roughness > 0.0 {
            given.surface.diffuse_roughness = choose();
        }
    }
    // What is within its range is bounded by the light, of radiance 1: two lobes and a coat
    for (given, answer) in points.iter().zip(engine.eval(&points, Quality::default()).unwrap()) {
        let interface = given.surface.interface.unwrap();
        if (0.0..=1.0).contains(&interface.f0) && (0.0..=1.0).contains(&interface.f90) {
            assert!(
                answer.is_finite() && answer.min_element() >= 0.0 && answer.max_element() < 1.3,
                "{given:?}"
            );
        }
    }
}

#[test]
fn effects_of_layers_are_of_surfaces() {
    assert!(Effects::SURFACES.contains(Effects::MODEL | Effects::DIFFUSE_ROUGHNESS));
}

#[test]
fn a_floor_by_albedo_is_its_reference_and_darker_than_gltfs() {
    let Some(engine) = TestEngine::new() else { return };
    // Varnish at grazing views, under a coat on every other run
    for coat in [0.0, 1.0] {
        let material = Material { dielectric_f90: 1.0, roughness: 0.4, coat, ..lambert(0.5) };
        let material = Material { dielectric_f0: Vec3::splat(0.04), coat_roughness: 0.2, ..material };
        let scene = scene_of(&square(0.0, 3.0), without_textures(material));
        let bounds = [DVec3::new(-1.5, 0.0, -1.5), DVec3::new(1.5, 0.0, 1.5)].into_iter().collect();
        let camera = Camera::framing("", bounds, DVec3::new(0.0, -0.12, -1.0), DVec3::Y, 4.0 / 3.0);
        let size = [64, 48];
        let buffers = SceneBuffers::new(&scene, DVec3::ZERO).unwrap();
        let lights = [quad_light(DVec3::new(0.0, 2.0, -0.5))];
        let mean = |shade: &dyn Fn(&mut SceneRenderer<'_>)| -> f64 {
            let constants = buffers.constants(&camera, size, Vec3::ZERO);
            let mut renderer = SceneRenderer::new(&engine, &buffers, &lights, constants, size).unwrap();
            renderer.visibility().unwrap();
            shade(&mut renderer);
            renderer.radiance().unwrap().iter().map(|texel| f64::from(texel.y)).sum()
        };
        // GGX itself: a fitted lobe errs by two percent at grazing views
        let quality = arealight::Level::HalfVectors.quality();
        let layers = Effects::COUPLED_BY_ALBEDO | Effects::COAT_BY_ALBEDO;
        let by_albedo = scene.surfaces() | if coat > 0.0 { layers } else { Effects::COUPLED_BY_ALBEDO };
        let ours = |surfaces| mean(&|renderer| _ = renderer.shade(surfaces, quality).unwrap());
        let truth = mean(&|renderer| {
            let reference = Reference { samples: 128, seed: 7, by_albedo: true, ..Reference::default() };
            renderer.reference(reference, |_| {}).unwrap();
        });
        let [albedo, gltf] = [by_albedo, scene.surfaces()].map(|surfaces| ours(surfaces) / truth);
        // The reference has half a percent of noise; the twin is the other model
        assert!((albedo - 1.0).abs() < 0.01, "coat {coat}: {albedo}");
        assert!((gltf - 1.0).abs() > 0.05, "coat {coat}: {gltf}");
    }
}
