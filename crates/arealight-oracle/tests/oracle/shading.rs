//! The truth against sampling and closed forms, and the table's answer against cubature of its own lobe.

use crate::common::{direction, from_everywhere, lengths_through, square_points, star, view_angle, view_at};
use arealight::{LightTable, MIN_ALPHA, TableDescription};
use arealight_oracle::cubature::{Region, Settings};
use arealight_oracle::frame::SurfaceFrame;
use arealight_oracle::ggx::Ggx;
use arealight_oracle::ltsd::{Original, TransformedDistribution};
use arealight_oracle::material::Surface;
use arealight_oracle::polygon::{emitted, form_factor};
use arealight_oracle::shading::{RelativeLight, lobe_integrals, ltc, truth};
use glam::DVec3;
use proptest::prelude::*;

fn glossy(alpha: f64, f0: f64) -> Surface {
    Surface { diffuse_albedo: DVec3::ZERO, f0: DVec3::splat(f0), f90: 1.0, alpha, ..Surface::default() }
}

fn diffuse() -> Surface {
    Surface {
        diffuse_albedo: DVec3::new(0.9, 0.5, 0.1),
        f0: DVec3::ZERO,
        f90: 0.0,
        alpha: 1.0,
        ..Surface::default()
    }
}

fn light(vertices: Vec<DVec3>, two_sided: bool) -> RelativeLight {
    RelativeLight { vertices, radiance: DVec3::new(1.0, 2.0, 4.0), two_sided, ..RelativeLight::default() }
}

/// A table whose lobes and magnitudes differ from node to node.
fn table() -> LightTable {
    let node = |i: u32| (f64::from(i % 4) as f32, f64::from(i / 4) as f32);
    let matrix = (0..16).map(node).map(|(x, y)| [1.0 + 0.3 * y, 0.1 * y, -0.05 * x, 0.5 + 0.2 * x]).collect();
    let magnitude = (0..16).map(node).map(|(x, y)| [1.0 - 0.1 * x, 0.05 + 0.2 * y]).collect();
    let description = TableDescription { brdf: "none".into(), ..TableDescription::default() };
    LightTable::new(description, 4, matrix, magnitude).unwrap()
}

/// The share of a GGX lobe's light that comes from a light around the mirror direction, by sampling the lobe:
/// it cannot miss what it draws from.
fn sampled(alpha: f64, view: DVec3, vertices: &[DVec3; 4]) -> f64 {
    let lobe = Ggx { alpha };
    let count = 1 << 15;
    let weight = |u: [f64; 2]| {
        let direction = lobe.sample(view, u);
        let inside = (0..4).all(|i| vertices[(i + 1) % 4].cross(vertices[i]).dot(direction) > 0.0);
        let value = lobe.evaluate(view, direction);
        if inside && value > 0.0 { value / lobe.density(view, direction) } else { 0.0 }
    };
    square_points(count).map(weight).sum::<f64>() / count as f64
}

/// A square of half width `size` at distance one around `axis`, facing the origin.
fn square_around(axis: DVec3, size: f64) -> [DVec3; 4] {
    let (u, v) = axis.any_orthonormal_pair();
    [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)].map(|(a, b)| axis + u * (a * size) + v * (b * size))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn narrow_lobes_are_not_missed(
        log_alpha in MIN_ALPHA.ln()..0.0, theta in view_angle(), log_size in -7.0..0.5_f64,
        aside in direction(),
        shift in -1.5..1.5_f64,
    ) {
        let (alpha, size) = (log_alpha.exp(), log_size.exp());
        let view = view_at(theta);
        // The light's edge may cut the lobe, and the light may be far larger or smaller than the lobe
        let mirror = DVec3::new(-view.x, 0.0, view.z);
        let axis = (mirror + aside * (shift * size)).normalize_or(DVec3::Z);
        let square = square_around(axis, size);
        let answer = truth(&glossy(alpha, 1.0), DVec3::Z, view, &light(square.to_vec(), false),
            &Settings::default());
        let expected = sampled(alpha, view, &square);
        // 32768 even points, of which a small light receives few: 5e-3 of the lobe
        prop_assert!((answer.radiance.x - expected).abs() < 5e-3, "{} and {expected}", answer.radiance.x);
        prop_assert!(answer.error.x <= 1e-5 * answer.radiance.x, "{answer:?}");
    }

    #[test]
    fn a_tighter_tolerance_finds_the_same(
        star in star(1.5), log_alpha in MIN_ALPHA.ln()..0.0, theta in view_angle(),
    ) {
        prop_assume!(star.relative_distance() > 1e-2);
        let (surface, view) = (glossy(log_alpha.exp(), 0.04), view_at(theta));
        let answer = |tolerance| {
            let settings = Settings { relative_tolerance: tolerance, ..Settings::default() };
            truth(&surface, DVec3::Z, view, &light(star.vertices.clone(), true), &settings)
        };
        let (usual, tight) = (answer(1e-6), answer(1e-9));
        // what the default settings promise; mostly it is a hundred times better
        let error = (usual.radiance - tight.radiance).abs().max_element();
        prop_assert!(error <= 1e-6 * tight.radiance.max_element(), "{usual:?} and {tight:?}");
    }

    #[test]
    fn a_lambert_lobe_is_the_form_factor(star in star(2.0), view in direction(), two_sided: bool) {
        prop_assume!(star.relative_distance() > 1e-3);
        let surface = diffuse();
        let light = light(star.vertices.clone(), two_sided);
        let exact = emitted(form_factor(&star.vertices), two_sided) * surface.diffuse_albedo * light.radiance;
        let by_cubature = truth(&surface, DVec3::Z, view, &light, &Settings::default()).radiance;
        prop_assert!((by_cubature - exact).abs().max_element() < 1e-7, "{by_cubature} and {exact}");
        // The frame turns the vertices, which costs a few roundings
        let by_table = ltc(&table(), &surface, DVec3::Z, view, &light);
        prop_assert!((by_table - exact).abs().max_element() < 1e-11, "{by_table} and {exact}");
    }

    #[test]
    fn the_tables_answer_is_the_integral_of_its_lobe(
        star in star(2.0), normal in direction(), view in direction(), roughness in 0.2..1.0_f64,
        f0 in 0.0..1.0_f64,
    ) {
        prop_assume!(star.relative_distance() > 1e-2);
        let (table, surface) = (table(), glossy(roughness * roughness, f0));
        let answer = ltc(&table, &surface, normal, view, &light(star.vertices.clone(), true));
        // The same by the general distribution and cubature, cut at the horizon of cosine space
        let frame = SurfaceFrame::new(normal, view);
        let sample = table.lookup(roughness, frame.cos_view());
        let lobe = TransformedDistribution::from_inverse(Original::ClampedCosine, sample.inverse).unwrap();
        let vertices: Vec<DVec3> = star.vertices.iter().map(|v| frame.to_surface(*v)).collect();
        let region = Region::polygon(&vertices).clipped(sample.inverse.row(2));
        let lengths = |t: &[DVec3; 3]| lengths_through(&sample.inverse, t);
        let share = region.integrate(&Settings::default(), lengths, |w| [lobe.evaluate(w)]).value[0].abs();
        let expected = (f0 * sample.albedo + (1.0 - f0) * sample.schlick) * share;
        prop_assert!((answer.x - expected).abs() < 1e-7, "{} and {expected}", answer.x);
    }
}

#[test]
fn light_from_everywhere_gives_the_albedo() {
    for (alpha, theta) in [(MIN_ALPHA, 0.4), (1e-3, 1.5), (0.05, 1.0), (0.5, 0.0), (1.0, 1.57)] {
        let view = view_at(theta);
        let hemisphere = Region::sphere().clipped(DVec3::Z);
        let albedo = lobe_integrals(Ggx { alpha }, view, &hemisphere, &Settings::default()).value;
        let surface = glossy(alpha, 0.04);
        let settings = Settings::default();
        let found = from_everywhere(|light| truth(&surface, DVec3::Z, view, light, &settings).radiance).x;
        let expected = 0.04 * albedo[0] + 0.96 * albedo[1];
        assert!((found - expected).abs() < 1e-7, "alpha {alpha}, theta {theta}: {found} and {expected}");
        // The table's lobes are normalised, so from everywhere it sends its magnitude
        let table = table();
        let sample = table.lookup(alpha.sqrt(), theta.cos());
        let found = from_everywhere(|light| ltc(&table, &surface, DVec3::Z, view, light)).x;
        let expected = 0.04 * sample.albedo + 0.96 * sample.schlick;
        assert!((found - expected).abs() < 1e-13, "alpha {alpha}, theta {theta}: {found} and {expected}");
    }
}

#[test]
fn only_the_front_shines_unless_both_sides_do() {
    let front = square_around(DVec3::new(0.3, 0.1, 0.9), 0.5).to_vec();
    let back: Vec<DVec3> = front.iter().rev().copied().collect();
    let (surface, view) = (glossy(0.4, 0.5), view_at(0.5));
    let answers = |vertices: &[DVec3], two_sided| {
        let light = light(vertices.to_vec(), two_sided);
        let by_cubature = truth(&surface, DVec3::Z, view, &light, &Settings::default()).radiance;
        [by_cubature, ltc(&table(), &surface, DVec3::Z, view, &light)]
    };
    for method in 0..2 {
        let lit = answers(&front, false)[method];
        assert!(lit.min_element() > 0.0);
        assert_eq!(answers(&back, false)[method], DVec3::ZERO);
        assert!((answers(&back, true)[method] - lit).length() < 1e-7);
        assert!((answers(&front, true)[method] - lit).length() < 1e-7);
    }
}

#[test]
fn a_light_below_the_surface_is_dark() {
    let below = square_around(DVec3::new(0.6, 0.0, -0.8), 0.4).to_vec();
    for surface in [glossy(0.3, 0.5), diffuse()] {
        let light = light(below.clone(), true);
        let answer = truth(&surface, DVec3::Z, view_at(0.3), &light, &Settings::default());
        assert_eq!(answer.radiance, DVec3::ZERO);
    }
    assert_eq!(ltc(&table(), &diffuse(), DVec3::Z, view_at(0.3), &light(below, true)), DVec3::ZERO);
}

#[test]
fn a_view_below_the_surface_counts_as_grazing() {
    let light = light(square_around(DVec3::new(-0.8, 0.0, 0.6), 0.4).to_vec(), false);
    let surface = glossy(0.3, 0.04);
    let answers = |view| {
        let by_cubature = truth(&surface, DVec3::Z, view, &light, &Settings::default()).radiance;
        [by_cubature, ltc(&table(), &surface, DVec3::Z, view, &light)]
    };
    assert_eq!(answers(DVec3::new(0.8, 0.0, -0.6)), answers(DVec3::X));
    assert!(answers(DVec3::X)[0].x > 0.0);
}

#[test]
fn bad_vertices_give_no_light() {
    let surface = Surface { diffuse_albedo: DVec3::ONE, ..glossy(0.1, 0.5) };
    for bad in [f64::NAN, f64::INFINITY] {
        let mut vertices = square_around(DVec3::Z, 1.0).to_vec();
        vertices[2].y = bad;
        let light = light(vertices, false);
        assert_eq!(truth(&surface, DVec3::Z, DVec3::Z, &light, &Settings::default()).radiance, DVec3::ZERO);
        assert_eq!(ltc(&table(), &surface, DVec3::Z, DVec3::Z, &light), DVec3::ZERO);
    }
    let line = light(vec![DVec3::X, DVec3::ONE, DVec3::new(1.0, 2.0, 2.0)], true);
    let none = light(Vec::new(), true);
    for light in [line, none] {
        assert_eq!(truth(&surface, DVec3::Z, DVec3::Z, &light, &Settings::default()).radiance, DVec3::ZERO);
    }
}
