//! Disks, spheres and cylinders through the whole chain, from a light in the world to radiance: against the
//! reference, and against the oracle's fitted lobes.

use arealight::gpu::GpuShape;
use arealight_cases::answers::read_answers;
use arealight_cases::cases::{CaseMaterial, SupportedCase, read_cases};
use arealight_cases::measure::relative_error;
use arealight_oracle::shading::shape_ltc_on;
use arealight_tests::prelude::*;
use glam::DAffine3;
use std::collections::HashMap;

const CASES: &str = include_str!("../../data/reference/cases.json");
/// What `tube.glsl` and `tube_horizons.glsl` allow, which is more than the others do.
const ROUNDING: f64 = 3e-6;

const TRUTH: &str = include_str!("../../data/reference/truth.json");

/// The reference's shapes, and whether their surfaces are diffuse.
fn cases() -> Vec<(SupportedCase, bool)> {
    let cases = read_cases(CASES).expect("the reference reads");
    let diffuse = |material: &CaseMaterial| matches!(material, CaseMaterial::Diffuse { .. });
    cases
        .iter()
        .filter_map(|case| {
            let supported = case.supported(|path| Err(path.to_owned())).ok();
            let supported = supported.filter(|case| !case.light.shape.is_polygonal());
            Some((supported?, diffuse(&case.material)))
        })
        .collect()
}

fn known() -> HashMap<String, [f64; 3]> {
    let answers = read_answers(TRUTH).expect("the truth reads");
    answers.into_iter().filter_map(|answer| Some((answer.name, answer.radiance?))).collect()
}

fn point(case: &SupportedCase) -> EvalPoint {
    let SupportedCase { surface, normal, view, light, .. } = case.clone();
    EvalPoint { surface, position: DVec3::ZERO, normal, view, light }
}

fn points(cases: &[(SupportedCase, bool)]) -> Vec<EvalPoint> {
    cases.iter().map(|(case, _)| point(case)).collect()
}

/// The shape, with its size changed.
fn grown(shape: &LightShape, by: f64) -> LightShape {
    match *shape {
        LightShape::Disk { center, axis_u, axis_v } => {
            LightShape::Disk { center, axis_u: axis_u * by, axis_v: axis_v * by }
        }
        LightShape::Sphere { center, radius } => LightShape::Sphere { center, radius: radius * by },
        LightShape::Tube { p0, p1, radius, ends } => LightShape::Tube { p0, p1, radius: radius * by, ends },
        LightShape::Polygon(_) | LightShape::Mesh { .. } => panic!("{shape:?} is no case"),
    }
}

fn precise() -> Quality {
    Quality { specular_lobes: SpecularLobes::Two, ..Quality::default() }
}

fn widened(radiance: Vec3) -> [f64; 3] {
    radiance.as_dvec3().to_array()
}

/// Compares answers with the oracle's, and returns how many a lobe of another roughness would have noticed.
fn compare_with_oracle(
    cases: &[(SupportedCase, bool)],
    found: &[Vec3],
    quality: Quality,
    bound: f64,
) -> usize {
    let table = LightTable::ggx();
    let mut comparison = Comparison::new(format!("shapes, {quality:?}"));
    let mut twin = 0;
    for ((case, diffuse), found) in cases.iter().zip(found) {
        let SupportedCase { name, surface, normal, view, light, .. } = case;
        let by = |alpha: f64| {
            let surface = Surface { alpha: surface.alpha * alpha, ..*surface };
            shape_ltc_on(quality, &table, &surface, *normal, *view, light).unwrap()
        };
        // Relative to what the light sends when it fills the sky
        let whole = light.radiance.as_dvec3().max_element();
        let error = |alpha: f64| (found.as_dvec3() - by(alpha)).abs().max_element() / whole;
        comparison.add(error(1.0), 0.0, bound, || name.clone());
        twin += usize::from(!diffuse && error(0.99) > bound);
    }
    comparison.assert_all();
    twin
}

#[test]
fn shapes_agree_with_the_reference_and_with_the_oracle() {
    let Some(engine) = TestEngine::new() else { return };
    let (cases, known) = (cases(), known());
    let points = points(&cases);
    let found = engine.eval(&points, precise()).unwrap();

    // Diffuse surfaces have a closed form: float32, and the reference's own cubature of 1e-5
    let diffuse = || cases.iter().zip(&found).filter(|((_, diffuse), _)| *diffuse);
    let mut comparison = Comparison::new("diffuse shapes against the reference");
    for ((case, _), found) in diffuse() {
        comparison.add(relative_error(widened(*found), known[&case.name]), 0.0, 1e-4, || case.name.clone());
    }
    assert_eq!(diffuse().count(), 10);
    comparison.assert_all();
    // The twin: lights a thousandth larger
    let mut larger: Vec<EvalPoint> = diffuse().map(|((case, _), _)| point(case)).collect();
    for point in &mut larger {
        point.light.shape = grown(&point.light.shape, 1.001);
    }
    let found_larger = engine.eval(&larger, precise()).unwrap();
    let noticed = larger
        .iter()
        .zip(found_larger)
        .filter(|(point, found)| relative_error(widened(*found), known[&point.light.name]) > 1e-4);
    assert!(noticed.count() > 8);

    // And lobes, with the oracle
    let noticed = compare_with_oracle(&cases, &found, precise(), ROUNDING);
    assert!(noticed > 20, "{noticed} of {} noticed", cases.len());

    // Far from the world's origin the answers are the same: float32 positions would have no digits there
    let offset = DVec3::new(3e6, -5e6, 1e6);
    let errors = |slip: DVec3| -> Vec<f64> {
        let mut far = points.clone();
        for point in &mut far {
            point.position += offset;
            point.light.shape = point.light.shape.moved(&DAffine3::from_translation(offset + slip));
        }
        let far = engine.eval(&far, precise()).unwrap();
        let errors = far.iter().zip(&found).zip(&points);
        errors.map(|((far, near), p)| ((far - near).abs() / p.light.radiance).max_element().into()).collect()
    };
    let mut comparison = Comparison::new("far from the origin");
    for (error, point) in errors(DVec3::ZERO).into_iter().zip(&points) {
        // float64 positions there are 1e-9 off, and round to another float32 now and then
        comparison.add(error, 0.0, 1e-6, || point.light.name.clone());
    }
    comparison.assert_all();
    // The twin: float32's step there
    let noticed = errors(DVec3::splat(0.25)).iter().filter(|error| **error > 1e-6).count();
    assert!(noticed > 40, "{noticed} noticed");
}

#[test]
fn shapes_are_cut_at_both_horizons() {
    let Some(engine) = TestEngine::new() else { return };
    let cases = cases();
    let quality = Quality { horizon: Horizon::Both, ..Quality::default() };
    let found = engine.eval(&points(&cases), quality).unwrap();
    compare_with_oracle(&cases, &found, quality, ROUNDING);
    // The twin: one horizon is another answer
    let table = LightTable::ggx();
    let noticed = cases.iter().zip(&found).filter(|((case, _), found)| {
        let SupportedCase { surface, normal, view, light, .. } = case;
        let one = shape_ltc_on(Quality::default(), &table, surface, *normal, *view, light).unwrap();
        (found.as_dvec3() - one).abs().max_element()
            > 3.0 * ROUNDING * light.radiance.as_dvec3().max_element()
    });
    let noticed = noticed.count();
    assert!(noticed > 10, "{noticed} noticed");
}

#[test]
fn one_pipeline_takes_any_kind() {
    let Some(engine) = TestEngine::new() else { return };
    let cases = cases();
    let points = points(&cases);
    let found = engine.eval_shapes_as(GpuShape::ANY, &points.iter().collect::<Vec<_>>(), Quality::default());
    let noticed = compare_with_oracle(&cases, &found.unwrap(), Quality::default(), ROUNDING);
    assert!(noticed > 20, "{noticed} noticed");
    // The twin: a pipeline of one kind takes a disk for a sphere
    let disk = points.iter().find(|point| point.light.effects().contains(Effects::ELLIPSE)).unwrap();
    let as_any = engine.eval_shapes_as(GpuShape::ANY, &[disk], Quality::default()).unwrap();
    let as_sphere = engine.eval_shapes_as(GpuShape::SPHERE, &[disk], Quality::default()).unwrap();
    assert_ne!(as_any, as_sphere);
}
