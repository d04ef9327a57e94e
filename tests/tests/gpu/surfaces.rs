//! Surfaces that are hard on float32: nearly mirrors, grazing views, views along the normal, far from the
//! world's origin, under lights of many vertices; against float64, with bounds by backward error (see
//! `arealight_tests::lobe`).

use arealight_tests::Path;
use arealight_tests::lobe::{Judge, Lobe, Seen};
use arealight_tests::prelude::*;
use half::f16;

/// Points of each family.
const COUNT: usize = 2000;

fn view_at(cos_view: f64) -> DVec3 {
    DVec3::new(((1.0 - cos_view) * (1.0 + cos_view)).max(0.0).sqrt(), 0.0, cos_view)
}

/// A light of 1 to 30 lobe widths, at random in front of the mirror direction: its edges are in the lobe.
fn in_the_lobe(random: &mut Random, alpha: f64, view: DVec3, count: usize) -> Vec<DVec3> {
    let distance = 10.0_f64.powf(random.between(-1.0, 2.0));
    let size = (alpha * 30.0_f64.powf(random.unit())).min(1.0) * distance;
    let aside = random.direction() * size * random.unit();
    random.polygon(DVec3::new(-view.x, -view.y, view.z) * distance + aside, count, size * 0.3, size)
}

fn alpha(random: &mut Random, low: f64, high: f64) -> f64 {
    low * (high / low).powf(random.unit())
}

type Make = fn(&mut Random, usize) -> EvalPoint;

const FAMILIES: [(&str, Make); 6] = [
    ("nearly a mirror", |random, index| {
        let (alpha, view) = (alpha(random, 1e-4, 1e-2), view_at(random.between(0.02, 1.0)));
        point(glossy_surface(alpha), view, in_the_lobe(random, alpha, view, 3 + index % 6), index % 3 == 0)
    }),
    ("grazing", |random, index| {
        let alpha = alpha(random, 1e-4, 1.0);
        let cos_view = if index % 8 == 0 { 0.0 } else { 10.0_f64.powf(random.between(-6.0, -1.0)) };
        let view = view_at(cos_view);
        point(glossy_surface(alpha), view, in_the_lobe(random, alpha, view, 3 + index % 4), index % 3 == 0)
    }),
    ("along the normal", |random, index| {
        let alpha = alpha(random, 1e-3, 1.0);
        let tilt = if index % 4 == 0 { 0.0 } else { 10.0_f64.powf(random.between(-9.0, -3.0)) };
        let around = random.between(0.0, TAU);
        let view = DVec3::new(tilt * around.cos(), tilt * around.sin(), 1.0);
        let vertices = in_the_lobe(random, alpha, view, 3 + index % 4);
        let mut given = point(glossy_surface(alpha), view, vertices, index % 3 == 0);
        // Not along an axis
        let turn = DQuat::from_axis_angle(random.direction(), random.between(0.0, 3.0));
        given.normal = turn * given.normal;
        given.view = turn * given.view;
        given.light.shape.vertices_mut().iter_mut().for_each(|vertex| *vertex = turn * *vertex);
        given
    }),
    ("a million units off", |random, index| {
        let (alpha, view) = (alpha(random, 1e-3, 1.0), view_at(random.between(0.05, 1.0)));
        let vertices = in_the_lobe(random, alpha, view, 3 + index % 6);
        let mut given = point(glossy_surface(alpha), view, vertices, index % 3 == 0);
        given.position = random.direction() * 1e6;
        given.light.shape.vertices_mut().iter_mut().for_each(|vertex| *vertex += given.position);
        given
    }),
    ("concave", |random, index| {
        let alpha = alpha(random, 1e-3, 1.0);
        let center = random.direction() * random.between(0.5, 3.0);
        let vertices = random.polygon(center, 5 + index % 8, 0.1, 2.0);
        point(glossy_surface(alpha), view_at(random.between(0.0, 1.0)), vertices, index % 3 == 0)
    }),
    ("64 vertices", |random, index| {
        let alpha = alpha(random, 1e-2, 1.0);
        let center = random.direction() * random.between(0.5, 3.0);
        let low = if index % 2 == 0 { 1.0 } else { 0.3 };
        let vertices = random.polygon(center, 64, low, 1.000_001);
        point(glossy_surface(alpha), view_at(random.between(0.0, 1.0)), vertices, index % 3 == 0)
    }),
];

/// Judges of all points with a table. The light is where the world says it is, in float64: packing is a part
/// of it.
fn judges(table: &LightTable, points: &[EvalPoint], given: &Cases, horizon: Horizon) -> Vec<Judge> {
    let judge = |(index, point): (usize, &EvalPoint)| {
        let lobe = Lobe::glossy(table, &given.cases[index]);
        let vertices = point.light.shape.vertices().iter().map(|v| *v - point.position).collect();
        Seen::with_vertices(given, index, vertices, lobe, horizon).judge()
    };
    points.iter().enumerate().map(judge).collect()
}

fn check(engine: &TestEngine, table: &LightTable, what: &str, points: &[EvalPoint], horizon: Horizon) {
    let given = Cases::new(points);
    let judges = judges(table, points, &given, horizon);
    for level in Level::of(&[Path::Polygon], &[horizon]) {
        let found = engine.factors(&given, Effects::GLOSSY, level);
        let mut comparison = Comparison::new(format!("{what}, {level}"));
        let mut shifted = Comparison::new("a point as the next one");
        for (index, (found, judge)) in found.iter().zip(&judges).enumerate() {
            let place = || format!("point {index}, {judge:?}: {:?}", points[index]);
            comparison.add(*found, judge.expected(), judge.bound(), place);
            shifted.add(*found, judges[(index + 1) % judges.len()].expected(), judge.bound(), String::new);
        }
        comparison.assert_all();
        assert!(shifted.failures() > points.len() / 3, "the twin: {} noticed", shifted.failures());
    }
    // Most bounds are tight: what is loose hangs on the last bits of the given numbers
    let mut reach: Vec<f64> = judges.iter().map(|judge| judge.reach).collect();
    reach.sort_unstable_by(f64::total_cmp);
    println!(
        "{what}: roundings reach {:.1e} in the middle, {:.1e} at most",
        reach[reach.len() / 2],
        reach[reach.len() - 1]
    );
}

fn family(seed: usize) -> Vec<EvalPoint> {
    let mut random = Random::new(60 + seed as u64);
    (0..COUNT).map(|index| FAMILIES[seed].1(&mut random, index)).collect()
}

#[test]
fn hard_surfaces_are_as_in_float64_clipped_once() {
    let Some(engine) = TestEngine::new() else { return };
    // The last one takes its time, and is below
    for (seed, (what, _)) in FAMILIES[..5].iter().enumerate() {
        check(&engine, &TABLE, what, &family(seed), Horizon::Cosine);
    }
}

#[test]
fn hard_surfaces_are_as_in_float64_clipped_twice() {
    let Some(engine) = TestEngine::new() else { return };
    for (seed, (what, _)) in FAMILIES.iter().enumerate() {
        check(&engine, &TABLE, what, &family(seed), Horizon::Both);
    }
}

/// The table as the GPU has it in float16.
fn in_float16(table: &LightTable) -> LightTable {
    fn round<const N: usize>(texels: &[[f32; N]]) -> Vec<[f32; N]> {
        texels.iter().map(|texel| texel.map(|value| f16::from_f32(value).to_f32())).collect()
    }
    let description = table.description().clone();
    let rounded = LightTable::new(description, table.size(), round(table.matrix()), round(table.magnitude()));
    let rounded = rounded.expect("still a table");
    match table.schlick_matrix() {
        Some(matrix) => rounded.with_schlick_matrix(round(matrix)).expect("still a table"),
        None => rounded,
    }
}

#[test]
fn hard_surfaces_of_a_table_in_float16_are_that_tables() {
    let Some(engine) = TestEngine::with_format(TableFormat::Rgba16Float) else { return };
    let points = family(0);
    check(&engine, &in_float16(&TABLE), "float16", &points, Horizon::Cosine);
    // The twin: it is not the other table
    let given = Cases::new(&points);
    let level = Level::of(&[Path::Polygon], &[Horizon::Cosine])[0];
    let found = engine.factors(&given, Effects::GLOSSY, level);
    let judges = judges(&TABLE, &points, &given, Horizon::Cosine);
    let apart = found.iter().zip(&judges).filter(|(f, j)| (**f - j.expected()).abs() > j.bound()).count();
    assert!(apart > COUNT / 10, "{apart} differ");
}
