//! Properties of the polygon integral and of the frame, on the GPU: no oracle, only the maths.

use arealight::Quality;
use arealight_engine::EvalPoint;
use arealight_tests::{Comparison, Random, TestEngine, glossy_surface, lambert_surface, point, rounding};
use glam::{DQuat, DVec3};

/// What the walk may lose: see `form_factor.glsl`. Sums of several polygons may lose it several times.
const WALK: f64 = 1e-6;

fn form_factors(engine: &TestEngine, points: &[EvalPoint]) -> Vec<f64> {
    let answers = engine.eval(points, Quality::default()).unwrap();
    for answer in &answers {
        assert!(answer.is_finite() && answer.min_element() >= 0.0, "{answer}");
    }
    answers.iter().map(|answer| answer.x.into()).collect()
}

fn lambert(vertices: Vec<DVec3>) -> EvalPoint {
    point(lambert_surface(), DVec3::Z, vertices, false)
}

fn random_polygons(seed: u64, count: usize) -> Vec<Vec<DVec3>> {
    let mut random = Random::new(seed);
    let polygon = |i: usize| {
        let center = random.direction() * random.between(0.5, 3.0);
        random.polygon(center, 3 + i % 6, 0.2, 1.5)
    };
    (0..count).map(polygon).collect()
}

/// The faces of a box around the origin, fronts inwards.
fn faces_of_a_box(low: DVec3, high: DVec3) -> Vec<Vec<DVec3>> {
    let corner =
        |x: usize, y: usize, z: usize| DVec3::new([low.x, high.x][x], [low.y, high.y][y], [low.z, high.z][z]);
    vec![
        vec![corner(0, 0, 0), corner(1, 0, 0), corner(1, 1, 0), corner(0, 1, 0)],
        vec![corner(0, 0, 1), corner(0, 1, 1), corner(1, 1, 1), corner(1, 0, 1)],
        vec![corner(0, 0, 0), corner(0, 0, 1), corner(1, 0, 1), corner(1, 0, 0)],
        vec![corner(0, 1, 0), corner(1, 1, 0), corner(1, 1, 1), corner(0, 1, 1)],
        vec![corner(0, 0, 0), corner(0, 1, 0), corner(0, 1, 1), corner(0, 0, 1)],
        vec![corner(1, 0, 0), corner(1, 0, 1), corner(1, 1, 1), corner(1, 1, 0)],
    ]
}

#[test]
fn a_box_of_lights_around_the_point_sums_to_one() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(11);
    let mut points = Vec::new();
    let count = 500;
    for i in 0..count {
        let low =
            DVec3::new(random.between(-3.0, -0.1), random.between(-3.0, -0.1), random.between(-3.0, -0.1));
        let high = DVec3::new(random.between(0.1, 3.0), random.between(0.1, 3.0), random.between(0.1, 3.0));
        let view = random.direction();
        // Any lobe of the table integrates to one in cosine space, times its albedo
        let surface = if i % 2 == 0 { lambert_surface() } else { glossy_surface(random.between(0.05, 1.0)) };
        for face in faces_of_a_box(low, high) {
            points.push(point(surface, view.with_z(view.z.abs()), face, false));
        }
    }
    let factors = form_factors(&engine, &points);
    let table = arealight_table::ggx();
    let mut comparison = Comparison::new("box of lights");
    let mut open = Comparison::new("box without a ceiling");
    for (faces, points) in factors.chunks_exact(6).zip(points.chunks_exact(6)) {
        let expected = if points[0].surface.f90 == 0.0 {
            1.0
        } else {
            table.lookup(points[0].surface.alpha.sqrt(), points[0].view.z).albedo
        };
        let (sum, place) = (faces.iter().sum::<f64>(), || format!("{:?}", points[0]));
        comparison.add(sum, expected, 6.0 * WALK, place);
        open.add(sum - faces[1], expected, 6.0 * WALK, place);
    }
    comparison.assert_all();
    // The twin: without its ceiling the box is open, wherever the lobe reaches the ceiling
    assert!(open.failures() > count * 3 / 4, "{} of {count} noticed", open.failures());
}

#[test]
fn splitting_a_polygon_changes_nothing() {
    let Some(engine) = TestEngine::new() else { return };
    let mut points = Vec::new();
    for polygon in random_polygons(12, 1000).into_iter().filter(|polygon| polygon.len() >= 4) {
        // Along a diagonal: the parts overlap with opposite signs where the outline is concave, and then
        // one of them may face away, so convex outlines only: a fan around the first vertex
        let convex = convex_hull_order(&polygon);
        points.push(lambert(convex.clone()));
        points.push(lambert(convex[..3].to_vec()));
        points.push(lambert([&convex[..1], &convex[2..]].concat()));
    }
    let factors = form_factors(&engine, &points);
    let mut comparison = Comparison::new("split");
    for parts in factors.chunks_exact(3) {
        comparison.add(parts[1] + parts[2], parts[0], 3.0 * WALK, || format!("{parts:?}"));
    }
    comparison.assert_all();
}

/// The polygon's vertices moved onto a circle: convex, in the same plane and order.
fn convex_hull_order(polygon: &[DVec3]) -> Vec<DVec3> {
    let center = polygon.iter().sum::<DVec3>() / polygon.len() as f64;
    let radius = polygon.iter().map(|v| v.distance(center)).fold(f64::INFINITY, f64::min);
    polygon.iter().map(|v| center + (*v - center).normalize_or_zero() * radius).collect()
}

#[test]
fn where_the_outline_begins_does_not_matter() {
    let Some(engine) = TestEngine::new() else { return };
    let mut points = Vec::new();
    for polygon in random_polygons(13, 1000) {
        let mut turned = polygon.clone();
        turned.rotate_left(1);
        points.extend([lambert(polygon), lambert(turned)]);
    }
    let factors = form_factors(&engine, &points);
    let mut comparison = Comparison::new("rotated outline");
    for pair in factors.chunks_exact(2) {
        comparison.add(pair[1], pair[0], WALK, || format!("{pair:?}"));
    }
    comparison.assert_all();
}

#[test]
fn a_reversed_outline_is_seen_from_its_back() {
    let Some(engine) = TestEngine::new() else { return };
    let mut points = Vec::new();
    for polygon in random_polygons(14, 1000) {
        let reversed: Vec<_> = polygon.iter().rev().copied().collect();
        let mut both_sides = lambert(reversed.clone());
        both_sides.light.two_sided = true;
        points.extend([lambert(polygon), lambert(reversed), both_sides]);
    }
    let factors = form_factors(&engine, &points);
    let mut comparison = Comparison::new("reversed outline");
    for trio in factors.chunks_exact(3) {
        comparison.add(trio[1], 0.0, WALK, || format!("{trio:?}"));
        comparison.add(trio[2], trio[0], WALK, || format!("{trio:?}"));
    }
    assert!(factors.iter().any(|f| *f > 0.1), "the twin: fronts are not dark");
    comparison.assert_all();
}

#[test]
fn scaling_by_a_power_of_two_changes_no_bit() {
    let Some(engine) = TestEngine::new() else { return };
    let polygons = random_polygons(15, 300);
    for exponent in [-40, -7, 1, 40] {
        let scale = 2.0_f64.powi(exponent);
        let scaled = |polygon: &Vec<DVec3>| lambert(polygon.iter().map(|v| *v * scale).collect());
        let before =
            engine.eval(&polygons.iter().cloned().map(lambert).collect::<Vec<_>>(), Quality::default());
        let after = engine.eval(&polygons.iter().map(scaled).collect::<Vec<_>>(), Quality::default());
        assert_eq!(before.unwrap(), after.unwrap(), "2^{exponent}");
    }
}

#[test]
fn rotating_everything_changes_nothing() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(16);
    let mut points = Vec::new();
    for polygon in random_polygons(16, 1000) {
        let alpha = random.between(0.05, 1.0);
        let direction = random.direction();
        let given = point(glossy_surface(alpha), direction.with_z(direction.z.abs()), polygon, false);
        let turn = DQuat::from_axis_angle(random.direction(), random.between(0.0, 6.0));
        let mut turned = given.clone();
        turned.normal = turn * given.normal;
        turned.view = turn * given.view;
        for vertex in &mut turned.light.vertices {
            *vertex = turn * *vertex;
        }
        points.extend([given, turned]);
    }
    let factors = form_factors(&engine, &points);
    let mut comparison = Comparison::new("rotation");
    for (pair, given) in factors.chunks_exact(2).zip(points.chunks_exact(2)) {
        // Both are rounded
        let bound = 2.0 * rounding(given[0].surface.alpha);
        comparison.add(pair[1], pair[0], bound, || format!("{:?}", given[0]));
    }
    comparison.assert_all();
}

#[test]
fn a_midpoint_or_a_duplicate_vertex_changes_nothing() {
    let Some(engine) = TestEngine::new() else { return };
    let mut points = Vec::new();
    for polygon in random_polygons(17, 1000) {
        let mut halved = polygon.clone();
        halved.insert(1, (polygon[0] + polygon[1]) * 0.5);
        let mut doubled = polygon.clone();
        doubled.insert(1, polygon[0]);
        points.extend([lambert(polygon), lambert(halved), lambert(doubled)]);
    }
    let factors = form_factors(&engine, &points);
    let mut comparison = Comparison::new("midpoint and duplicate");
    for trio in factors.chunks_exact(3) {
        comparison.add(trio[1], trio[0], WALK, || format!("midpoint {trio:?}"));
        comparison.add(trio[2], trio[0], 0.5 * WALK, || format!("duplicate {trio:?}"));
    }
    comparison.assert_all();
}

#[test]
fn degenerate_lights_are_dark() {
    let Some(engine) = TestEngine::new() else { return };
    let points = [
        lambert(vec![DVec3::new(0.3, 0.2, 1.0); 4]),
        lambert(vec![DVec3::ZERO; 3]),
        lambert(vec![DVec3::Z, DVec3::new(0.5, 0.0, 1.0), DVec3::new(1.0, 0.0, 1.0)]),
        lambert(vec![DVec3::X, DVec3::Y, -DVec3::X]),
    ];
    for (factor, given) in form_factors(&engine, &points).into_iter().zip(&points) {
        assert!(factor <= WALK, "{factor}: {:?}", given.light.vertices);
    }
}

#[test]
fn the_frame_holds_for_every_view_and_normal() {
    let Some(engine) = TestEngine::new() else { return };
    // A light far above in a wide lobe: whatever the frame, the answer is near the albedo's share of it
    let light = vec![
        DVec3::new(-50.0, -50.0, 1.0),
        DVec3::new(-50.0, 50.0, 1.0),
        DVec3::new(50.0, 50.0, 1.0),
        DVec3::new(50.0, -50.0, 1.0),
    ];
    let tilts = [0.0, 1e-30, 1e-12, 1e-7, 1e-5, 1e-3];
    let normals = [DVec3::Z, DVec3::Z * 1e-30, DVec3::Z * 1e30, DVec3::Z * 0.37];
    let mut points = Vec::new();
    for normal in normals {
        for tilt in tilts {
            let mut given = point(glossy_surface(0.25), DVec3::new(tilt, 0.0, 1.0), light.clone(), false);
            given.normal = normal;
            points.push(given);
        }
    }
    let factors = form_factors(&engine, &points);
    let mut comparison = Comparison::new("view along the normal");
    for (factor, given) in factors.iter().zip(&points) {
        // A tilt of 1e-3 moves the lobe by as much; all others by less than float32 sees
        let bound = 1e-5 + 2.0 * given.view.x;
        comparison.add(*factor, factors[0], bound, || format!("{:?} {:?}", given.normal, given.view));
    }
    assert!(factors[0] > 0.8, "nearly the whole lobe sees the light: {}", factors[0]);
    comparison.assert_all();

    // Zero vectors, and views on and below the surface, give finite answers
    let odd = [
        (DVec3::ZERO, DVec3::Z),
        (DVec3::Z, DVec3::ZERO),
        (DVec3::Z, DVec3::X),
        (DVec3::Z, -DVec3::Z),
        (DVec3::Z, DVec3::new(1.0, 0.0, -1.0)),
        (DVec3::new(1e-40, 0.0, 0.0), DVec3::X),
    ];
    let points: Vec<_> = odd
        .into_iter()
        .map(|(normal, view)| {
            let mut given = point(glossy_surface(0.25), view, light.clone(), false);
            given.normal = normal;
            given
        })
        .collect();
    for factor in form_factors(&engine, &points) {
        assert!(factor <= 1.0 + WALK);
    }
}
