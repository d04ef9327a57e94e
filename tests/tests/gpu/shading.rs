//! The GPU against the float64 oracle: the same table, the same integral, in another precision.

use arealight::table::{LAYERS, LobePairs};
use arealight_tests::prelude::*;

const COUNT: usize = 4000;

fn expected(point: &EvalPoint) -> DVec3 {
    polygon_twin(Quality::default(), point)
}

/// Polygons of 3 to 12 vertices, convex and concave, above, across and below the horizon.
fn lights(seed: u64, surface: impl Fn(&mut Random) -> Surface) -> Vec<EvalPoint> {
    let mut random = Random::new(seed);
    (0..COUNT)
        .map(|i| {
            let distance = 10.0_f64.powf(random.between(-1.0, 2.0));
            let center = random.direction() * distance;
            let size = distance * random.between(0.1, 1.5);
            let vertices = random.polygon(center, 3 + i % 10, size * 0.3, size);
            let cos_view = random.between(0.02, 1.0);
            let view = DVec3::new((1.0 - cos_view * cos_view).sqrt(), 0.0, cos_view);
            let mut given = point(surface(&mut random), view, vertices, i % 3 == 0);
            // Anywhere in the world, turned anyhow
            given.normal = random.direction() * random.between(0.5, 2.0);
            let frame = arealight_oracle::frame::SurfaceFrame::new(given.normal, random.direction());
            given.view = frame.from_surface(given.view);
            given.position = random.direction() * 1000.0;
            for vertex in given.light.shape.vertices_mut() {
                *vertex = frame.from_surface(*vertex) + given.position;
            }
            given
        })
        .collect()
}

/// Polygons of 1 to 30 lobe widths, at random in front of the mirror direction: random lights would rarely
/// hit so narrow a lobe. Alpha is `low` to `high`, evenly in its logarithm.
fn lights_at_the_mirror_direction(seed: u64, low: f64, high: f64) -> Vec<EvalPoint> {
    let mut random = Random::new(seed);
    (0..COUNT)
        .map(|i| {
            let alpha = low * (high / low).powf(random.unit());
            let cos_view = random.between(0.05, 1.0);
            let sin_view = (1.0 - cos_view * cos_view).sqrt();
            let view = DVec3::new(sin_view, 0.0, cos_view);
            let distance = 10.0_f64.powf(random.between(-1.0, 2.0));
            // A lobe as wide as the hemisphere sees no light of thirty widths
            let size = (alpha * 30.0_f64.powf(random.unit())).min(1.0) * distance;
            let aside = random.direction() * size * random.unit();
            let center = DVec3::new(-sin_view, 0.0, cos_view) * distance + aside;
            let vertices = random.polygon(center, 3 + i % 10, size * 0.3, size);
            point(glossy_surface(alpha), view, vertices, i % 3 == 0)
        })
        .collect()
}

#[test]
fn lambert_is_exact_to_float32() {
    let Some(engine) = TestEngine::new() else { return };
    let points = lights(1, |_| lambert_surface());
    engine.beside_polygon_twin("Lambert", Quality::default(), &points, |_| rounding(1.0)).assert_all();
}

#[test]
fn glossy_follows_the_table_to_float32() {
    let Some(engine) = TestEngine::new() else { return };
    let points = lights(2, |random| glossy_surface(10.0_f64.powf(random.between(-2.0, 0.0))));
    let bound = |point: &EvalPoint| rounding(point.surface.alpha);
    engine.beside_polygon_twin("GGX", Quality::default(), &points, bound).assert_all();
}

#[test]
fn glossy_follows_the_table_down_to_mirrors() {
    let Some(engine) = TestEngine::new() else { return };
    let points = lights_at_the_mirror_direction(7, arealight::MIN_ALPHA, 1e-2);
    let bound = |point: &EvalPoint| rounding(point.surface.alpha);
    engine.beside_polygon_twin("GGX, narrow", Quality::default(), &points, bound).assert_all();
    // The twin: the lights are seen, and seen in part
    let lit = points.iter().map(|point| expected(point).x);
    let edges = lit.filter(|factor| (0.1..0.9).contains(factor)).count();
    assert!(edges > COUNT / 4, "{edges} lobes have a light's edge in them");
}

#[test]
fn fresnel_and_both_lobes_add_up() {
    let Some(engine) = TestEngine::new() else { return };
    let points = lights(3, |random| Surface {
        diffuse_albedo: DVec3::new(0.8, 0.3, 0.1),
        f0: DVec3::new(0.04, 0.5, 0.9),
        f90: random.unit(),
        alpha: random.between(0.05, 1.0),
        ..Default::default()
    });
    let bound = |point: &EvalPoint| 2.0 * rounding(point.surface.alpha);
    engine.beside_polygon_twin("both lobes", Quality::default(), &points, bound).assert_all();
}

#[test]
fn every_way_to_the_glossy_lobe_follows_its_twin() {
    // Rough enough that the part of a lobe above the surface, which both horizons divide by, is not small
    let points = lights(9, |random| Surface {
        diffuse_albedo: DVec3::ZERO,
        f0: DVec3::new(0.04, 0.5, 0.9),
        f90: 1.0,
        alpha: random.between(0.05, 1.0),
        ..Default::default()
    });
    let Some(engine) = TestEngine::new() else { return };
    let mut answers: Vec<Vec<Vec3>> = Vec::new();
    for specular_lobes in [SpecularLobes::One, SpecularLobes::Two] {
        // Formulas make one lobe
        let sources = [Lobes::Table, Lobes::Formula];
        for lobes in sources
            .into_iter()
            .filter(|lobes| (specular_lobes, *lobes) != (SpecularLobes::Two, Lobes::Formula))
        {
            for horizon in [Horizon::Cosine, Horizon::Both] {
                let quality = Quality { specular_lobes, lobes, horizon, ..Quality::default() };
                // Two lobes; the part above the surface is at least .6 of each
                let bound = |point: &EvalPoint| 2.0 / 0.6 * rounding(point.surface.alpha);
                let what = format!("{specular_lobes:?}, {lobes:?}, {horizon:?}");
                engine.beside_polygon_twin(what, quality, &points, bound).assert_all();
                answers.push(engine.eval(&points, quality).unwrap());
            }
        }
    }
    // The twin: no two of them are the same by accident
    for (i, one) in answers.iter().enumerate() {
        for other in &answers[..i] {
            let apart = one.iter().zip(other).filter(|(a, b)| (**a - **b).abs().max_element() > 1e-4).count();
            assert!(apart > COUNT / 50, "{apart} points differ");
        }
    }
}

/// A ceiling of half the width `size`, one unit above the point.
fn ceiling(size: f64, height: f64) -> Vec<DVec3> {
    [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)]
        .map(|(x, y)| DVec3::new(x * size, y * size, height))
        .into()
}

#[test]
fn a_mirror_sees_a_ceiling_of_any_size() {
    let Some(engine) = TestEngine::new() else { return };
    // Heights of a narrow lobe's cosine space are alpha times as low: a vertex that is on the horizon there
    // by 1e-7 is not in the world
    let points: Vec<EvalPoint> = (0..64)
        .map(|i| {
            let size = 10.0_f64.powf(f64::from(i) / 10.0);
            let alpha = [1e-4, 1e-3, 1e-2, 0.5][i as usize % 4];
            point(glossy_surface(alpha), DVec3::new(0.3, 0.0, 0.954), ceiling(size, 1.0), false)
        })
        .collect();
    // Beyond a size of 1e4 / alpha the ceiling's own edges are in the rounding of its height
    let bound = |point: &EvalPoint| {
        let size = point.light.shape.vertices()[2].x - point.position.x;
        rounding(1.0) + 4e-7 * size.sqrt()
    };
    engine.beside_polygon_twin("ceilings", Quality::default(), &points, bound).assert_all();
    assert!(points.iter().all(|point| expected(point).x > 0.1), "the twin: they are all seen");
}

#[test]
fn a_far_light_below_the_surface_sends_nothing_with_both_horizons() {
    // Seen at a grazing angle a lobe reaches below the surface
    let points: Vec<EvalPoint> = (0..100)
        .map(|i| {
            let elevation = -0.001 * f64::from(1 + i);
            let at = DVec3::new(-1.0, 0.0, elevation) * 1e4;
            let vertices = ceiling(0.5, 0.0).into_iter().map(|v| at + DVec3::new(v.z, v.y, v.x)).collect();
            point(glossy_surface(0.3), DVec3::new(0.9987, 0.0, 0.05), vertices, true)
        })
        .collect();
    let Some(engine) = TestEngine::new() else { return };
    let quality = Quality::default();
    let answers = engine.eval(&points, Quality { horizon: Horizon::Both, ..quality }).unwrap();
    assert!(answers.iter().all(|answer| *answer == Vec3::ZERO), "{answers:?}");
    // The twin: clipped at the lobe's horizon alone, they do
    let answers = engine.eval(&points, quality).unwrap();
    assert!(answers.iter().filter(|answer| answer.x > 0.0).count() > 50);
}

/// The table as the GPU has it in float16.
fn table_in_float16() -> LightTable {
    let bytes = TableFormat::Rgba16Float.bytes(&TABLE);
    let values: Vec<f32> =
        bytes.chunks_exact(2).map(|b| half::f16::from_le_bytes([b[0], b[1]]).to_f32()).collect();
    let texels: Vec<[f32; 4]> = values.chunks_exact(4).map(|t| [t[0], t[1], t[2], t[3]]).collect();
    let length = texels.len() / LAYERS as usize;
    let layer = |layer: usize| texels[layer * length..][..length].to_vec();
    let magnitude = layer(1).iter().map(|t| [t[0], t[1]]).collect();
    let pairs = LobePairs {
        matrices: [layer(3), layer(4)],
        second_shares: layer(5).iter().map(|t| [t[0], t[1]]).collect(),
    };
    LightTable::new(TABLE.description().clone(), TABLE.size(), layer(0), magnitude)
        .and_then(|table| table.with_schlick_matrix(layer(2)))
        .and_then(|table| table.with_pairs(pairs))
        .expect("still a table")
}

#[test]
fn a_table_in_float16_is_that_table_and_changes_little() {
    let mut points = lights_at_the_mirror_direction(5, 2.5e-4, 1.0);
    points.extend(lights(8, |random| glossy_surface(random.between(0.01, 1.0))));
    let Some(engine) = TestEngine::new() else { return };
    let fine = engine.eval(&points, Quality::default()).unwrap();
    let Some(engine) = TestEngine::with_format(TableFormat::Rgba16Float) else { return };
    let coarse = engine.eval(&points, Quality::default()).unwrap();
    let table = table_in_float16();
    let mut exact = Comparison::new("float16 table against the oracle with it");
    let mut change = Comparison::new("float16 table against float32");
    let mut rough = Comparison::new("the same, rough");
    for (given, (coarse, fine)) in points.iter().zip(coarse.iter().zip(&fine)) {
        let (coarse, fine) = (f64::from(coarse.x), f64::from(fine.x));
        let (alpha, place) = (given.surface.alpha, || format!("{given:?}"));
        let light = RelativeLight::new(&given.light, given.position);
        let expected = ltc(&table, &given.surface, given.normal, given.view, &light);
        exact.add(coarse, expected.x, rounding(alpha), place);
        // An albedo from 0.5 to 1 is rounded by up to 2^-12; the rounded shape is allowed as much again. (By
        // measurement: the largest change over 2e5 such points is 3.3e-4.)
        change.add(coarse, fine, 2.0 * 2.0_f64.powi(-12), place);
        if alpha > 0.3 {
            rough.add(coarse, fine, 2.0 * rounding(0.3), place);
        }
    }
    exact.assert_all();
    change.assert_all();
    // The twin: with one table, two answers for a rough surface are within float32's rounding of each other
    assert!(rough.failures() > COUNT / 10, "the table was not rounded: {}", rough.failures());
}

#[test]
fn the_comparison_notices_a_wrong_light() {
    // The twin of the tests above: each point is compared with the answer for the next one
    let points = lights(1, |_| lambert_surface());
    let Some(engine) = TestEngine::new() else { return };
    let answers = engine.eval(&points[1..], Quality::default()).unwrap();
    let mut comparison = Comparison::new("shifted");
    for (given, answer) in points.iter().zip(&answers) {
        comparison.add(answer.x.into(), expected(given).x, rounding(1.0), String::new);
    }
    assert!(comparison.failures() > COUNT / 4, "{} noticed", comparison.failures());
}

#[test]
fn a_light_that_cannot_be_shaded_is_named() {
    let Some(engine) = TestEngine::new() else { return };
    let mut points = lights(6, |_| lambert_surface());
    points.truncate(3);
    points[2].light.shape.vertices_mut()[1].y = f64::NAN;
    let error = engine.eval(&points, Quality::default()).unwrap_err();
    assert!(error.to_string().starts_with("lights[0] 'test': vertices[1]"), "{error}");
    assert!(engine.eval(&[], Quality::default()).unwrap().is_empty());
}
