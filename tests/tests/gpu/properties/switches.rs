//! Where one form gives way to another: the light stays as it is, and only the center moves that its vertices
//! are offsets from, so that the form changes, and nothing else but rounding.

use super::{COUNT, PATHS, lambert, outline};
use arealight::gpu::GpuLight;
use arealight_tests::Property;
use arealight_tests::prelude::*;

/// How much farther a light's farthest vertex is from the second center than from the first.
const STEP: f64 = 8e-6;

/// Pairs of a light with two centers. From the first one its farthest vertex is `edge` times the center's
/// distance away, but for half of [`STEP`]; from the second one as much more.
fn pairs(level: Level, seed: u64, edge: f64) -> Property<'static> {
    let mut random = Random::new(seed);
    let group = |index| -> Vec<EvalPoint> {
        let vertices = outline(&mut random, level.path, index);
        let center = vertices.iter().sum::<DVec3>() / vertices.len() as f64;
        let away = center.with_z(center.z.abs());
        let moved: Vec<DVec3> = vertices.iter().map(|v| away + (*v - center)).collect();
        vec![lambert(moved); 2]
    };
    let groups: Vec<Vec<EvalPoint>> = (0..2 * COUNT).map(group).collect();
    let mut property = Property::new("switch", None, &groups);
    let given = property.given();
    for index in 0..given.lights.len() {
        let light = given.lights[index];
        let (first, count) = (light.first_vertex as usize, light.vertex_count as usize);
        let rows = &mut given.vertices[first..first + count];
        let center = DVec3::from_array(light.center.map(f64::from));
        let offset = |row: &[f32; 4]| DVec3::new(row[0].into(), row[1].into(), row[2].into());
        let far = rows.iter().map(offset).max_by(|a, b| a.length().total_cmp(&b.length())).expect("a vertex");
        // Scale the light to the size that is wanted, and move the center away from its farthest vertex
        let scale = edge * (1.0 - 0.5 * STEP) * center.length() / far.length();
        let step = if index % 2 == 0 { DVec3::ZERO } else { far * (STEP * scale) };
        for row in rows {
            let moved = (offset(row) * scale + step).as_vec3();
            *row = [moved.x, moved.y, moved.z, row[3]];
        }
        given.lights[index].center = (center - step).as_vec3().to_array();
        given.lights[index].flags = GpuLight::TWO_SIDED;
    }
    property
}

/// The two forms are the same but for what each may err, and are not the same.
fn assert_continuous(engine: &TestEngine, property: &Property<'_>, level: Level) {
    let mut comparison = Comparison::new(format!("switch, {level}"));
    let mut twin = Comparison::new("a thousandth brighter");
    let mut changed = 0;
    for (index, (factors, bound)) in property.groups(engine, level).iter().enumerate() {
        comparison.add(factors[0], factors[1], *bound, || format!("group {index}: {factors:?}"));
        twin.add(factors[0], 1.001 * factors[1], *bound, String::new);
        changed += usize::from(factors[0].to_bits() != factors[1].to_bits());
    }
    comparison.assert_all();
    assert!(twin.failures() > COUNT, "the twin: {} noticed", twin.failures());
    assert!(changed > COUNT / 2, "the form did change: {changed}");
}

/// `arealight_anchor` takes a light as distant whose vertices are within half of its distance.
pub fn the_difference_form_begins_without_a_jump(engine: &TestEngine) {
    for path in PATHS {
        for level in Level::of(&[path], &[Horizon::Cosine]) {
            if level.quality.form_factor == FormFactor::Difference {
                assert_continuous(engine, &pairs(level, 41, 0.5), level);
            }
        }
    }
}
