//! Where one form gives way to another: the light stays as it is, and only the sphere that is said to hold it grows, so
//! that all that can change is the form.

use crate::{COUNT, PATHS, lambert, outline};
use arealight::gpu::GpuLight;
use arealight::{FormFactor, Horizon};
use arealight_engine::EvalPoint;
use arealight_tests::{Comparison, Property, Random, Rung, TestEngine};
use glam::DVec3;

/// Pairs of a light with two radii, `inner` and `outer` times its distance, about which a form begins. The vertices fit
/// in the smaller one.
fn pairs(rung: Rung, seed: u64, size: f64, [inner, outer]: [f64; 2], lift: f64) -> Property<'static> {
    let mut random = Random::new(seed);
    let group = |index| -> Vec<EvalPoint> {
        let vertices = outline(&mut random, rung.path, index);
        // Bring the light to the size that is wanted at its distance
        let center = vertices.iter().sum::<DVec3>() / vertices.len() as f64;
        let away = center.with_z(center.z.abs() + lift * center.length());
        let scale = size * away.length() * random.between(0.2, 1.0) / 3.0;
        let moved: Vec<DVec3> = vertices.iter().map(|v| away + (*v - center) * scale).collect();
        vec![lambert(moved); 2]
    };
    let groups: Vec<Vec<EvalPoint>> = (0..2 * COUNT).map(group).collect();
    let mut property = Property::new("switch", None, &groups);
    for (index, light) in property.given().lights.iter_mut().enumerate() {
        light.flags = GpuLight::TWO_SIDED;
        let distance = DVec3::from_array(light.center.map(f64::from)).length();
        let radius = ([inner, outer][index % 2] * distance) as f32;
        assert!(radius > light.radius, "the vertices fit in");
        // The area is stored as a part of the radius squared
        light.area *= (light.radius / radius) * (light.radius / radius);
        light.radius = radius;
    }
    property
}

/// The two forms are the same but for what each may err, and are not the same.
fn assert_continuous(engine: &TestEngine, property: &Property<'_>, rung: Rung) {
    let mut comparison = Comparison::new(format!("switch, {rung}"));
    let mut changed = 0;
    for (index, (factors, bound)) in property.groups(engine, rung).iter().enumerate() {
        comparison.add(factors[0], factors[1], *bound, || format!("group {index}: {factors:?}"));
        changed += usize::from(factors[0].to_bits() != factors[1].to_bits());
    }
    comparison.assert_all();
    assert!(changed > COUNT / 2, "the twin: the form did change: {changed}");
}

/// `arealight_anchor` takes a light as distant whose sphere's radius is half its distance, at most.
pub fn the_difference_form_begins_without_a_jump(engine: &TestEngine) {
    for path in PATHS {
        for rung in Rung::of(&[path], &[Horizon::Cosine]) {
            if rung.quality.form_factor == FormFactor::Difference {
                assert_continuous(engine, &pairs(rung, 41, 0.6, [0.5 - 1e-6, 0.5 + 1e-6], 0.0), rung);
            }
        }
    }
}
