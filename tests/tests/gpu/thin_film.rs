//! Thin films that a pass knows: against the float64 twin, against films that a host put into reflectances,
//! and in their image of a G-buffer.

use arealight_oracle::material::Interface;
use arealight_oracle::thin_film::ThinFilm;
use arealight_tests::materials::points_of;
use arealight_tests::one_pixel::CAMERA;
use arealight_tests::prelude::*;
use arealight_vk::ash::vk::Format;

const COUNT: usize = 1500;
const FLOAT: Format = Format::R32G32B32A32_SFLOAT;

fn by(specular_lobes: SpecularLobes) -> Quality {
    Quality { specular_lobes, ..Quality::default() }
}

/// A metal or a coupled dielectric below a film that covers it wholly or in part; every fourth below a coat,
/// and every third metal reflecting more than once.
fn with_film(random: &mut Random, index: usize) -> Surface {
    let is_metal = index.is_multiple_of(2);
    let mut draw = |from: f64, to: f64| random.between(from, to);
    let f0 = if is_metal {
        DVec3::new(draw(0.3, 1.0), draw(0.3, 1.0), draw(0.3, 1.0))
    } else {
        DVec3::splat(draw(0.02, 0.08))
    };
    let f90 = if is_metal { 1.0 } else { draw(0.5, 1.0) };
    let coat = Coat { weight: 0.7, alpha: draw(0.05, 1.0), normal: None, by_albedo: false };
    Surface {
        diffuse_albedo: if is_metal { DVec3::ZERO } else { DVec3::new(0.8, 0.3, 0.1) },
        f0,
        f90,
        alpha: draw(0.05, 1.0),
        interface: (!is_metal).then_some(Interface { f0: f0.x, f90, by_albedo: index.is_multiple_of(3) }),
        multiple_scattering: is_metal && index.is_multiple_of(3),
        coat: index.is_multiple_of(4).then_some(coat),
        film: Some(ThinFilm {
            weight: draw(0.3, 1.2).min(1.0),
            ior: draw(1.1, 2.2),
            thickness: draw(50.0, 900.0),
        }),
        ..Surface::default()
    }
}

fn points(seed: u64) -> Vec<EvalPoint> {
    points_of(seed, COUNT, 0.02, with_film)
}

/// Of both lobes and a coat; and of a film, whose phases are up to 60 radians of a cosine that is rounded.
fn bound(given: &EvalPoint) -> f64 {
    let coat = given.surface.coat.map_or(0.0, |coat| rounding(coat.alpha));
    4.0 * rounding(given.surface.alpha) + coat + 3e-4
}

#[test]
fn films_follow_their_float64_twin_on_every_level() {
    let Some(engine) = TestEngine::new() else { return };
    let points = points(1);
    for specular_lobes in [SpecularLobes::One, SpecularLobes::Two, SpecularLobes::HalfVectors] {
        // The twin's twin: a film that is a tenth thicker is another
        engine.assert_follows_polygon_twin("films", by(specular_lobes), &points, bound, |surface| {
            let film = surface.film.map(|film| ThinFilm { thickness: 1.1 * film.thickness, ..film });
            Surface { film, ..*surface }
        });
    }
}

#[test]
fn half_vectors_know_the_facets_angle_and_fitted_lobes_do_not() {
    let Some(engine) = TestEngine::new() else { return };
    let points = points(2);
    let baked: Vec<EvalPoint> = points
        .iter()
        .map(|point| {
            let cos_view = point.view.normalize_or_zero().dot(point.normal.normalize_or_zero()).max(0.0);
            EvalPoint { surface: point.surface.without_film(cos_view), ..point.clone() }
        })
        .collect();
    let apart = |specular_lobes| {
        let [with, without] =
            [&points, &baked].map(|points| engine.eval(points, by(specular_lobes)).unwrap());
        let apart = |(a, b): (&Vec3, &Vec3)| f64::from((*a - *b).abs().max_element());
        with.iter().zip(&without).map(apart).collect::<Vec<_>>()
    };
    for specular_lobes in [SpecularLobes::One, SpecularLobes::Two] {
        for (point, apart) in points.iter().zip(apart(specular_lobes)) {
            assert!(apart < bound(point), "{specular_lobes:?}: {apart} of {point:?}");
        }
    }
    // The twin: over half vectors they differ, where a metal's lobe sees the light
    let other = apart(SpecularLobes::HalfVectors).into_iter().filter(|apart| *apart > 2e-3).count();
    assert!(other > 40, "{other}");
}

/// A film, and what its image of a G-buffer holds.
fn film(weight: f64) -> (ThinFilm, [f32; 4]) {
    let film = ThinFilm { weight, ior: 1.75, thickness: 320.0 };
    (film, [film.weight, film.ior, film.thickness, 0.0].map(|value| value as f32))
}

#[test]
fn every_layout_has_its_film_in_an_image_of_its_own() {
    let Some(engine) = TestEngine::new() else { return };
    let (film, texel) = film(0.8);
    let nones = [[0.0, 1.75, 320.0, 0.0], [0.8, 1.75, 0.0, 0.0], [f32::NAN; 4]];
    let surface = Material { film: Some(film), ..material() }.surface();
    // Radiance of 3, and a film's own rounding
    engine.assert_plane((Plane::Film, Effects::THIN_FILM), &nones, &[texel], (surface, 5e-4));
}

#[test]
fn by_fitted_lobes_a_pass_shows_a_film_as_reflectances_that_hold_it_do() {
    let Some(engine) = TestEngine::new() else { return };
    let cos_view = f64::from(CAMERA.normalize_or_zero().z);
    let (roughness, f0, f90) = (0.5_f32, DVec3::new(0.4, 0.3, 0.2), 0.9);
    let shade = |effects, specular_lobes, (f0, f90): (DVec3, f64), film: [f32; 4]| {
        let mut pixel = OnePixel::new(&engine, Vec4::W, 1.0);
        pixel.set(Plane::Normal, FLOAT, [0.0, 0.0, 1.0, roughness]);
        pixel.set(Plane::BaseColor, FLOAT, [0.0_f32; 4]);
        pixel.set(Plane::Specular, FLOAT, f0.extend(f90).as_vec4().to_array());
        pixel.set(Plane::Film, FLOAT, film);
        let surfaces = Effects::GLOSSY | Effects::SPECULAR_INPUT | effects;
        let options = ShadeOptions { surfaces, quality: by(specular_lobes), ..ShadeOptions::default() };
        pixel.shade(options, &[lamp()], CAMERA, None).truncate()
    };
    for weight in [0.3, 1.0] {
        let (film, texel) = film(weight);
        let baked = film.as_schlick(f0, f90, cos_view, roughness.into());
        let apart = |specular_lobes| {
            let known = shade(Effects::THIN_FILM, specular_lobes, (f0, f90), texel);
            (known - shade(Effects::empty(), specular_lobes, baked, [0.0; 4])).abs().max_element()
        };
        for specular_lobes in [SpecularLobes::One, SpecularLobes::Two] {
            assert!(apart(specular_lobes) < 3e-4, "{specular_lobes:?}, {weight}: {}", apart(specular_lobes));
        }
        // The twins: over half vectors a lamp has an angle; and without the film
        assert!(apart(SpecularLobes::HalfVectors) > 2e-3, "{}", apart(SpecularLobes::HalfVectors));
        let none = shade(Effects::empty(), SpecularLobes::One, (f0, f90), texel);
        assert!(
            (none - shade(Effects::empty(), SpecularLobes::One, baked, texel)).abs().max_element() > 1e-2
        );
    }
}
