//! Properties of the polygon integral on the GPU, for every level and both ways around an outline: no oracle,
//! only the maths. Each relation holds but for the sum of what its form factors may err (see
//! `arealight_tests::lobe`), and each has a twin that the same comparison notices.
//!
//! A test takes many properties: with a software driver a pipeline costs more than all that it computes here.

use arealight_tests::prelude::*;
use arealight_tests::{Path, Property};
use relations::{HOLE, RELATIONS};

mod boxes;
mod horizons;
mod relations;

/// Groups of each property.
const COUNT: usize = 300;

const PATHS: [Path; 2] = [Path::Quad, Path::Polygon];

/// A polygon for a path: convex with three or four vertices, or a star of three to eight. Its front faces the
/// point, from anywhere around it; some come near to it.
fn outline(random: &mut Random, path: Path, index: usize) -> Vec<DVec3> {
    let center = random.direction() * random.between(0.5, 3.0);
    match path {
        Path::Quad => on_a_circle(&random.polygon(center, 3 + index % 2, 0.3, 1.5), center),
        Path::Polygon | Path::Mesh => random.polygon(center, 3 + index % 6, 0.2, 1.5),
    }
}

/// The polygon's vertices moved onto a circle: convex, in the same plane and order.
pub fn on_a_circle(polygon: &[DVec3], center: DVec3) -> Vec<DVec3> {
    let radius = polygon.iter().map(|v| v.distance(center)).fold(f64::INFINITY, f64::min);
    polygon.iter().map(|v| center + (*v - center).normalize_or_zero() * radius).collect()
}

fn with_outline(given: &EvalPoint, vertices: Vec<DVec3>) -> EvalPoint {
    let mut other = given.clone();
    other.light.shape = LightShape::Polygon(vertices);
    other
}

/// A random view above the surface.
fn view(random: &mut Random) -> DVec3 {
    let view = random.direction();
    view.with_z(view.z.abs())
}

fn lambert(vertices: Vec<DVec3>) -> EvalPoint {
    point(lambert_surface(), DVec3::Z, vertices, false)
}

/// Every relation, for every level of a path that clips at `horizon`.
fn assert_relations(engine: &TestEngine, path: Path, table: Option<&LightTable>, horizon: Horizon) {
    let levels = Level::of(&[path], &[horizon]);
    for relation in RELATIONS.iter().chain((path == Path::Polygon).then_some(&HOLE)) {
        let groups = relation.groups(path, table.is_some(), COUNT);
        let property = Property::new(relation.what, table, &groups);
        property.assert(engine, &levels, relation.sides);
        property.assert_fails(engine, levels[0], 0.25, relation.twin);
    }
}

/// What every kind of lobe keeps; the levels that kept it.
fn assert_all_relations(engine: &TestEngine, table: Option<&LightTable>, horizon: Horizon) -> Vec<Level> {
    for path in PATHS {
        assert_relations(engine, path, table, horizon);
    }
    let levels = Level::of(&PATHS, &[horizon]);
    boxes::a_box_of_lights_around_the_point_sums_to_one(engine, table, &levels);
    scaling_by_a_power_of_two_changes_no_bit(engine, table, &levels);
    quads_are_as_polygons(engine, table, horizon);
    levels
}

#[test]
fn lambert_lobes_keep_every_property() {
    let Some(engine) = TestEngine::new() else { return };
    let levels = assert_all_relations(&engine, None, Horizon::Cosine);
    degenerate_lights_are_dark(&engine, &levels);
    horizons::a_light_rises_without_a_jump(&engine, &levels);
}

#[test]
fn glossy_lobes_clipped_once_keep_every_property() {
    let Some(engine) = TestEngine::new() else { return };
    assert_all_relations(&engine, Some(&TABLE), Horizon::Cosine);
    the_frame_holds_for_every_view_and_normal(&engine);
}

#[test]
fn glossy_lobes_clipped_twice_keep_every_property() {
    let Some(engine) = TestEngine::new() else { return };
    let levels = assert_all_relations(&engine, Some(&TABLE), Horizon::Both);
    horizons::nothing_leaks_from_below_the_surface(&engine, &levels);
    horizons::clipping_twice_is_no_brighter(&engine);
}

/// Lambert's, or the table's with a random roughness.
fn random_point(random: &mut Random, table: Option<&LightTable>, vertices: Vec<DVec3>) -> EvalPoint {
    let surface = match table {
        Some(_) => glossy_surface(random.between(0.01, 1.0)),
        None => lambert_surface(),
    };
    point(surface, view(random), vertices, false)
}

fn scaling_by_a_power_of_two_changes_no_bit(
    engine: &TestEngine,
    table: Option<&LightTable>,
    levels: &[Level],
) {
    let lobes = if table.is_some() { Effects::GLOSSY } else { Effects::DIFFUSE };
    for &level in levels {
        let mut random = Random::new(15);
        let points: Vec<EvalPoint> = (0..COUNT)
            .map(|index| {
                let mut vertices = outline(&mut random, level.path, index);
                // Some are small and far
                let far = DVec3::Z * 10.0_f64.powf(random.between(-2.0, 4.0));
                for vertex in &mut vertices {
                    *vertex += if index % 3 == 0 { far } else { DVec3::ZERO };
                }
                random_point(&mut random, table, vertices)
            })
            .collect();
        let scaled = |scale: f64| {
            let mut points = points.clone();
            for vertex in points.iter_mut().flat_map(|point| point.light.shape.vertices_mut()) {
                *vertex *= scale;
            }
            engine.run(&Cases::new(&points), level.effects(lobes), level.quality)
        };
        let before = scaled(1.0);
        for exponent in [-40, -7, 1, 40] {
            assert_eq!(before, scaled(2.0_f64.powi(exponent)), "{level}, 2^{exponent}");
        }
        assert_ne!(before, scaled(1.0 / 3.0), "the twin: by no power of two, bits change");
    }
}

fn quads_are_as_polygons(engine: &TestEngine, table: Option<&LightTable>, horizon: Horizon) {
    let mut random = Random::new(19);
    let groups: Vec<Vec<EvalPoint>> = (0..4 * COUNT)
        .map(|index| {
            let vertices = outline(&mut random, Path::Quad, index);
            vec![random_point(&mut random, table, vertices)]
        })
        .collect();
    let property = Property::new("quad and polygon", table, &groups);
    for level in Level::of(&[Path::Quad], &[horizon]) {
        let polygon = Level { path: Path::Polygon, ..level };
        let (quads, polygons) = (property.groups(engine, level), property.groups(engine, polygon));
        let mut comparison = Comparison::new(format!("quad as polygon, {level}"));
        let mut shifted = Comparison::new("a quad as the next one's polygon");
        for (index, ((quad, bound), (polygon, other))) in quads.iter().zip(&polygons).enumerate() {
            comparison.add(quad[0], polygon[0], bound + other, || format!("{:?}", groups[index]));
            shifted.add(quad[0], polygons[(index + 1) % polygons.len()].0[0], bound + other, String::new);
        }
        comparison.assert_all();
        assert!(shifted.failures() > COUNT, "the twin: {} noticed", shifted.failures());
    }
}

fn degenerate_lights_are_dark(engine: &TestEngine, levels: &[Level]) {
    let points = [
        lambert(vec![DVec3::new(0.3, 0.2, 1.0); 4]),
        lambert(vec![DVec3::ZERO; 3]),
        lambert(vec![DVec3::Z, DVec3::new(0.5, 0.0, 1.0), DVec3::new(1.0, 0.0, 1.0)]),
        lambert(vec![DVec3::X, DVec3::Y, -DVec3::X]),
    ];
    for &level in levels {
        let factors = engine.factors(&Cases::new(&points), Effects::DIFFUSE, level);
        // What an outline without area has is rounding: the form factor's own 6e-7
        assert!(factors.iter().all(|factor| *factor <= 6e-7), "{level}: {factors:?}");
    }
}

fn the_frame_holds_for_every_view_and_normal(engine: &TestEngine) {
    // A light far above in a wide lobe: whatever the frame, the answer is near the albedo's share of it
    let square = [(-50.0, -50.0), (-50.0, 50.0), (50.0, 50.0), (50.0, -50.0)];
    let light: Vec<DVec3> = square.iter().map(|&(x, y)| DVec3::new(x, y, 1.0)).collect();
    let case = |normal: [f32; 3], view: [f32; 3]| {
        let mut given = Cases::new(&[point(glossy_surface(0.25), DVec3::Z, light.clone(), false)]);
        given.cases[0].normal = normal;
        given.cases[0].view = view;
        given
    };
    let level = Level::of(&[Path::Quad], &[Horizon::Cosine])[0];
    let factor = |normal, view| engine.factors(&case(normal, view), Effects::GLOSSY, level)[0];
    let straight = factor([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]);
    assert!(straight > 0.8, "nearly the whole lobe sees the light: {straight}");
    let mut comparison = Comparison::new("view along the normal");
    for length in [1.0, 1e-30, 1e30, 0.37_f32] {
        for tilt in [0.0, 1e-30, 1e-12, 1e-7, 1e-5, 1e-3_f32] {
            let tilted = factor([0.0, 0.0, length], [tilt, 0.0, 1.0]);
            // A tilt of 1e-3 moves the lobe by as much; all others by less than float32 sees
            comparison.add(tilted, straight, 1e-5 + 2.0 * f64::from(tilt), || format!("{length} {tilt}"));
        }
    }
    comparison.assert_all();

    // Zero vectors, and views on and below the surface, give form factors: `factors` looks at the bits
    for (normal, view) in [
        ([0.0; 3], [0.0, 0.0, 1.0]),
        ([0.0, 0.0, 1.0], [0.0; 3]),
        ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]),
        ([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]),
        ([0.0, 0.0, 1.0], [1.0, 0.0, -1.0]),
        ([1e-40, 0.0, 0.0], [1.0, 0.0, 0.0]),
        ([f32::NAN; 3], [f32::INFINITY; 3]),
    ] {
        factor(normal, view);
    }
}
