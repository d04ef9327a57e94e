//! Directions drawn over polygons: the areas are pi times the form factor, the directions are inside of the
//! polygon, and their density is the clamped cosine's.

use arealight_oracle::polygon::{above_horizon, form_factor};
use arealight_tests::kernel::POLYGON_SAMPLING;
use arealight_tests::prelude::*;
use std::f64::consts::PI;

/// Draws of a polygon.
const DRAWS: usize = 1024;

/// A convex polygon in float32, at or above the horizon.
type Polygon = Vec<DVec3>;

/// Quads of about `size` at a distance of 1 somewhere above the horizon, of any orientation, cut at the
/// horizon.
fn polygons(count: usize, size: f64) -> Vec<Polygon> {
    let mut random = Random::new(17);
    let mut all = Vec::new();
    while all.len() < count {
        let center = random.direction();
        let (u, v) = (random.direction() * size, random.direction() * size);
        let quad = [center - u - v, center + u - v, center + u + v, center - u + v];
        let cut = above_horizon(&quad.map(|vertex| vertex.as_vec3().as_dvec3()));
        let cut: Polygon = cut.iter().map(|vertex| vertex.as_vec3().as_dvec3()).collect();
        if cut.len() >= 3 && form_factor(&cut).abs() > 1e-4 * size * size {
            all.push(cut);
        }
    }
    all
}

/// The draws of each polygon: directions, with the area in w.
fn draws(engine: &TestEngine, polygons: &[Polygon]) -> Vec<Vec<(DVec3, f64)>> {
    let arguments: Vec<[[f32; 4]; 5]> = polygons
        .iter()
        .map(|polygon| {
            // The last vertex again for those that are not there
            [0, 1, 2, 3, 4].map(|i: usize| polygon[i.min(polygon.len() - 1)].as_vec3().extend(0.0).to_array())
        })
        .collect();
    let given = engine.host().storage_buffer("arguments", &arguments).unwrap();
    let count = polygons.len() * DRAWS;
    let inputs = [Resource::buffer(given.handle())];
    let found: Vec<[f32; 4]> = engine.dispatch(&POLYGON_SAMPLING, &[(0, DRAWS as u32)], &inputs, count);
    let one =
        |[x, y, z, area]: &[f32; 4]| (DVec3::new((*x).into(), (*y).into(), (*z).into()), f64::from(*area));
    found.chunks(DRAWS).map(|draws| draws.iter().map(one).collect()).collect()
}

/// How far a direction is outside of a polygon, as a sine.
fn outside(polygon: &Polygon, direction: DVec3) -> f64 {
    let middle: DVec3 = polygon.iter().map(|vertex| vertex.normalize_or_zero()).sum();
    let edge = |i: usize| {
        let normal = polygon[i].cross(polygon[(i + 1) % polygon.len()]).normalize_or_zero();
        -normal.dot(direction) * normal.dot(middle).signum()
    };
    (0..polygon.len()).map(edge).fold(0.0, f64::max)
}

/// What is left of a polygon on the side of a plane through the point that its normal points to.
fn cut(polygon: &Polygon, normal: DVec3) -> Polygon {
    let mut left = Vec::new();
    for (i, a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (from, to) = (normal.dot(*a), normal.dot(b));
        if from >= 0.0 {
            left.push(*a);
        }
        if (from >= 0.0) != (to >= 0.0) {
            left.push(a.lerp(b, from / (from - to)));
        }
    }
    left
}

#[test]
fn draws_are_inside_with_the_form_factor_as_area() {
    let Some(engine) = TestEngine::new() else { return };
    for size in [2.0, 1.0, 0.3, 0.1, 0.03] {
        let polygons = polygons(500, size);
        let mut worst = 0.0_f64;
        for (polygon, draws) in polygons.iter().zip(draws(&engine, &polygons)) {
            let exact = form_factor(polygon).abs() * PI;
            let area = draws[0].1;
            worst = worst.max((area - exact).abs());
            // Areas below two circles cancel, of up to pi / 2 each, and each rounded by two units in the last
            // place of it
            assert!((area - exact).abs() <= 5e-7, "{size}: {area}, {exact}: {polygon:?}");
            // The twin: the area of a polygon a hundredth larger
            assert!(exact < 1e-4 || (area * 1.01 - exact).abs() > 5e-7, "{size}: {area}");
            for (direction, _) in draws {
                assert!((direction.length() - 1.0).abs() < 6e-7 && direction.z >= 0.0, "{direction}");
                let out = outside(polygon, direction);
                assert!(out < 5e-7, "{size}: {direction} is outside by {out:e} of {polygon:?}");
            }
        }
        println!("{size}: areas err by {worst:.1e}");
    }
}

#[test]
fn the_density_is_the_clamped_cosine() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(23);
    for size in [2.0, 1.0, 0.3, 0.1] {
        let polygons = polygons(500, size);
        let (mut square, mut twin, mut worst) = (0.0, 0.0, 0.0_f64);
        for (polygon, draws) in polygons.iter().zip(draws(&engine, &polygons)) {
            // Cut the polygon by a plane through the point and its middle
            let middle: DVec3 = polygon.iter().map(|vertex| vertex.normalize_or_zero()).sum();
            let normal = middle.cross(random.direction()).normalize_or_zero();
            let expected = form_factor(&cut(polygon, normal)) / form_factor(polygon);
            let inside = draws.iter().filter(|(direction, _)| normal.dot(*direction) >= 0.0).count();
            let share = inside as f64 / draws.len() as f64;
            // The twin: were the density uniform in solid angle, that of draws times their z
            let weight = |(direction, _): &&(DVec3, f64)| direction.z;
            let part: f64 = draws.iter().filter(|(d, _)| normal.dot(*d) >= 0.0).map(|d| weight(&d)).sum();
            let whole: f64 = draws.iter().map(|d| weight(&d)).sum();
            square += (share - expected).powi(2);
            twin += (part / whole - expected).powi(2);
            worst = worst.max((share - expected).abs());
        }
        let [rms, twin] = [square, twin].map(|sum: f64| (sum / polygons.len() as f64).sqrt());
        println!("{size}: rms {rms:.5}, worst {worst:.5}, twin {twin:.5}");
        // What 1,024 points of the R2 sequence leave of an area with a straight edge is .0027; 20 steps of
        // Newton's method leave no less
        assert!(rms < 0.0035 && worst < 0.02, "{size}: {rms}, {worst}");
        assert!(twin > 0.03, "{size}: the twin is as good: {twin}");
    }
}
