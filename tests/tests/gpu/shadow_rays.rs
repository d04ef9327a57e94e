//! Shadow rays drawn by the GLSL library, for the reference's shading points behind triangles: their mean
//! visibility is the exact one's.

use arealight_cases::answers::read_answers;
use arealight_cases::cases::{SupportedCase, read_cases};
use arealight_oracle::visibility::is_hidden;
use arealight_tests::kernel::SHADOW_RAYS;
use arealight_tests::prelude::*;
use arealight_tool_kernels::light_sampling::triangles_of;
use std::collections::HashMap;

const CASES: &str = include_str!("../../data/reference/shadows.json");
const TRUTH: &str = include_str!("../../data/reference/shadows-truth.json");

/// A ray as the kernel writes it.
type Ray = [[f32; 4]; 2];

fn cases() -> Vec<SupportedCase> {
    let cases = read_cases(CASES).expect("the reference reads");
    cases.iter().map(|case| case.supported(|path| Err(path.to_owned())).expect("it is supported")).collect()
}

/// Each case's rays.
fn rays(engine: &TestEngine, cases: &[SupportedCase], count: usize) -> Vec<Vec<Ray>> {
    let (mut points, mut corners) = (Vec::<[f32; 20]>::new(), Vec::<[f32; 4]>::new());
    for case in cases {
        let vertices = case.light.shape.vertices();
        let indices = triangles_of(vertices);
        let first = f32::from_bits(corners.len() as u32 / 3);
        let number = f32::from_bits(indices.len() as u32 / 3);
        corners.extend(indices.iter().map(|i| vertices[*i as usize].as_vec3().extend(0.0).to_array()));
        let surface = &case.surface;
        let [n, v] = [case.normal, case.view].map(|direction| direction.normalize_or_zero().as_vec3());
        let [d, f] = [surface.diffuse_albedo, surface.f0].map(DVec3::as_vec3);
        let (l, roughness) = (case.light.radiance, surface.alpha.sqrt() as f32);
        points.push([
            n.x,
            n.y,
            n.z,
            roughness,
            v.x,
            v.y,
            v.z,
            surface.f90 as f32,
            d.x,
            d.y,
            d.z,
            first,
            f.x,
            f.y,
            f.z,
            number,
            l.x,
            l.y,
            l.z,
            0.0,
        ]);
    }
    let points = engine.host().storage_buffer("points", &points).unwrap();
    let corners = engine.host().storage_buffer("corners", &corners).unwrap();
    let inputs = [engine.table(), Resource::buffer(points.handle()), Resource::buffer(corners.handle())];
    let found: Vec<Ray> = engine.dispatch(&SHADOW_RAYS, &[(0, count as u32)], &inputs, cases.len() * count);
    found.chunks(count).map(<[Ray]>::to_vec).collect()
}

/// The part of the unshadowed light that arrives by these rays, per channel. `blocks` says what of a ray's
/// way to the light is blocked.
fn shadow(case: &SupportedCase, rays: &[Ray], blocks: impl Fn(DVec3) -> bool) -> DVec3 {
    let vertices = case.light.shape.vertices();
    let normal = (vertices[1] - vertices[0]).cross(vertices[2] - vertices[0]);
    let (mut arrives, mut all) = (DVec3::ZERO, DVec3::ZERO);
    for [direction, color] in rays {
        let direction = DVec3::from_slice(&direction.map(f64::from)[..3]);
        let color = DVec3::from_slice(&color.map(f64::from)[..3]);
        let target = direction * (normal.dot(vertices[0]) / normal.dot(direction));
        all += color;
        arrives += if blocks(target) { DVec3::ZERO } else { color };
    }
    arrives / all.max(DVec3::splat(f64::MIN_POSITIVE))
}

fn unshadowed(table: &LightTable, case: &SupportedCase) -> DVec3 {
    let light = case.polygon().unwrap();
    ltc_on(Quality::default(), table, &case.surface, case.normal, case.view, &light)
}

/// Of each family (diffuse, GGX, GGX over Lambert) the root mean square error over the mean.
fn errors(cases: &[SupportedCase], answers: impl Fn(usize, &SupportedCase) -> DVec3) -> Vec<f64> {
    let known = read_answers(TRUTH).expect("the truth reads");
    let known: HashMap<_, _> = known
        .into_iter()
        .filter_map(|answer| Some((answer.name, DVec3::from_array(answer.radiance?))))
        .collect();
    (0..3)
        .map(|family| {
            let (mut square, mut sum) = (0.0, 0.0);
            for (index, case) in cases.iter().enumerate().skip(10 * family).take(10) {
                let truth = known[&case.name];
                square += (answers(index, case) - truth).length_squared();
                sum += truth.element_sum();
            }
            (square / 30.0).sqrt() / (sum / 30.0)
        })
        .collect()
}

#[test]
fn shadows_by_256_rays_are_those_of_the_reference() {
    let Some(engine) = TestEngine::new() else { return };
    let (cases, table) = (cases(), LightTable::ggx());
    let rays = rays(&engine, &cases, 256);
    let by_rays = |index: usize, case: &SupportedCase| {
        unshadowed(&table, case) * shadow(case, &rays[index], |target| is_hidden(target, &case.blockers))
    };
    let found = errors(&cases, by_rays);
    // What the reference's own 256 rays give, unstratified; of the lobes' own error .014 and .12 are in the
    // last two
    println!("by rays: {found:?}");
    assert!(found.iter().zip([0.025, 0.018, 0.15]).all(|(found, bound)| *found <= bound), "{found:?}");
    // The twin: without shadows
    let found = errors(&cases, |_, case| unshadowed(&table, case));
    assert!(found.iter().all(|error| *error > 0.3), "{found:?}");
}

#[test]
fn where_nothing_blocks_one_ray_is_exact() {
    let Some(engine) = TestEngine::new() else { return };
    let cases = cases();
    for (case, rays) in cases.iter().zip(rays(&engine, &cases, 1)) {
        let lit = shadow(case, &rays, |_| false);
        assert!(lit == DVec3::ONE || rays[0][0][3] == 0.0, "{}: {lit}", case.name);
        // The twin: where all is blocked nothing arrives
        assert_eq!(shadow(case, &rays, |_| true), DVec3::ZERO);
        assert!(rays.iter().flatten().flatten().all(|number| number.is_finite()));
    }
}
