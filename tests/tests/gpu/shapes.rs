//! Ellipses and spheres on the device against float64, over the families that are hard for float32.

use arealight_cases::hard::ellipse::Family;
use arealight_cases::hard::nearby_shape;
use arealight_cases::hard::promise::MOVE;
use arealight_oracle::ellipse::{Ellipse, form_factor};
use arealight_oracle::sphere::{self, Sphere};
use arealight_tests::prelude::*;
use arealight_tests::shapes::{ShapeFunction, ellipse_arguments, sphere_arguments};

const SAMPLES: u64 = 1000;

/// What [`arealight_ellipse_form_factor`](ShapeFunction::Ellipse) promises of its backward error.
const BACKWARD: f64 = 6e-7;

fn cases(family: &Family) -> Vec<Ellipse> {
    (0..SAMPLES).map(|index| family.case(index, 0)).collect()
}

/// The worst cases of long batteries: the point before a needle's tip, which the horizon cuts.
#[test]
fn before_a_needles_tip_no_digit_cancels() {
    let Some(engine) = TestEngine::new() else { return };
    let family = Family::find("needle-tip").unwrap();
    // With what a cone gave whose axes were taken from a difference: its entry along a needle is a difference
    // of squares
    let known = [(1, 3803, 1.208_563_9e-5), (2, 8754, 1.301_127_3e-4), (3, 3255, 1.911_504_3e-6)];
    let cases = known.map(|(seed, index, _)| family.case(index, seed));
    let mut comparison = Comparison::new("before a needle's tip");
    for (case, found) in cases.iter().zip(engine.ellipses(ShapeFunction::Ellipse, &cases)) {
        comparison.add(nearby_shape::distance(case, found, 1e-7), 0.0, BACKWARD, || format!("{case:?}"));
    }
    comparison.assert_all();
    // The twin: no needle nearby has what the difference gave
    for (case, (_, _, difference)) in cases.iter().zip(known) {
        let error = nearby_shape::distance(case, difference, 1e-7);
        assert!(error > 2.0 * BACKWARD, "{error:e}: {case:?}");
    }
}

/// What a light of this size sends from there at most: the area it shows, over pi times the squared distance,
/// and with the highest elevation of any of its points.
fn most(ellipse: &Ellipse) -> f64 {
    let area = ellipse.axis_u.cross(ellipse.axis_v).length();
    let square = ellipse.center.length_squared();
    let rise = ellipse.axis_u.z.hypot(ellipse.axis_v.z);
    area / square * (ellipse.center.z.abs() + rise) / square.sqrt()
}

#[test]
fn far_ellipses_keep_relative_precision() {
    let Some(engine) = TestEngine::new() else { return };
    // The height above the ellipse's plane is rounded in the distance, and so is the elevation
    for (name, bound) in [("far", 1e-6), ("far-crossing", 5e-6)] {
        let cases = cases(Family::find(name).unwrap());
        let mut comparison = Comparison::new(name);
        let mut twin = Comparison::new(format!("{name}: a result that is a thousandth too large"));
        for (case, found) in cases.iter().zip(engine.ellipses(ShapeFunction::Ellipse, &cases)) {
            let (truth, whole) = (form_factor(case).abs(), most(case));
            // The small form's own error
            let size =
                case.axis_u.length_squared().max(case.axis_v.length_squared()) / case.center.length_squared();
            let bound = bound + if name == "far" { 0.0 } else { 2.0 * size };
            comparison.add(found / whole, truth / whole, bound, || format!("{case:?}"));
            twin.add(1.001 * found / whole, truth / whole, bound, String::new);
        }
        comparison.assert_all();
        assert!(twin.failures() > 400, "{name}: {} noticed", twin.failures());
    }
}

#[test]
fn whole_ellipses_keep_relative_precision() {
    let Some(engine) = TestEngine::new() else { return };
    let cases = cases(Family::find("above").unwrap());
    let mut comparison = Comparison::new("above");
    let mut twin = Comparison::new("a result that is a ten-thousandth too large");
    for (case, found) in cases.iter().zip(engine.ellipses(ShapeFunction::Ellipse, &cases)) {
        let truth = form_factor(case).abs();
        comparison.add(found, truth, 4e-7, || format!("{case:?}"));
        comparison.add(found / truth, 1.0, 2e-5, || format!("{case:?}: {truth:e}"));
        twin.add(found * 1.0001 / truth, 1.0, 2e-5, String::new);
    }
    comparison.assert_all();
    assert!(twin.failures() > 900, "{} noticed", twin.failures());
}

#[test]
fn one_sided_ellipses_shine_from_their_front() {
    let Some(engine) = TestEngine::new() else { return };
    let cases = cases(Family::find("generic").unwrap());
    let mut arguments: Vec<_> = cases.iter().map(ellipse_arguments).collect();
    for arguments in &mut arguments {
        arguments[3][3] = 0.0;
    }
    let (mut dark, mut lit) = (0, 0);
    for (case, found) in cases.iter().zip(engine.shapes(ShapeFunction::Ellipse, &arguments)) {
        if case.shows_front() {
            lit += usize::from(found[0] > 0.0);
        } else {
            assert_eq!(found[0].to_bits(), 0, "{case:?}");
            dark += usize::from(form_factor(case) != 0.0);
        }
    }
    assert!(lit > 250 && dark > 250, "{lit} lit, {dark} dark");
}

#[test]
fn angles_are_what_they_say() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(71);
    let mut given = vec![[0.0_f32; 4]; 0];
    for _ in 0..20_000 {
        let size = random.between(-60.0, 60.0).exp2();
        let slope = random.between(-30.0, 30.0).exp2();
        let sign = [1.0, -1.0].map(|sign| if random.bits().is_multiple_of(2) { sign } else { -sign });
        given.push([(sign[0] * size) as f32, (sign[1] * size * slope) as f32, 0.0, 0.0]);
    }
    given.extend([[0.0; 4], [1.0, 0.0, 0.0, 0.0], [-1.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 0.0]]);
    let arguments: Vec<_> = given.iter().map(|a| [*a, [0.0; 4], [0.0; 4], [0.0; 4]]).collect();
    let mut comparison = Comparison::new("arctangent");
    let mut twin = Comparison::new("an angle a millionth too large");
    for (given, found) in given.iter().zip(engine.shapes(ShapeFunction::Arctangent, &arguments)) {
        let expected = f64::from(given[1]).atan2(given[0].into());
        let bound = (4e-7 * expected.abs()).min(4e-7);
        let found = f64::from(found[0]);
        comparison.add(found, expected, bound, || format!("{given:?}"));
        twin.add(found * 1.000_001, expected, bound, String::new);
    }
    comparison.assert_all();
    assert!(twin.failures() > 500, "{}", twin.failures());
}

/// Spheres of radius over distance from 2^`low` to 1 - 2^-20, any way.
fn spheres(seed: u64, low: f64) -> Vec<Sphere> {
    let mut random = Random::new(seed);
    let mut sphere = |index: u64| {
        let distance = random.between(-20.0, 20.0).exp2();
        let sine = if index.is_multiple_of(4) {
            1.0 - random.between(-20.0, -1.0).exp2()
        } else {
            random.between(low, 0.0).exp2().min(0.999)
        };
        let axis = random.direction();
        // Every other one about the horizon, and some of those touching it
        let height = match index % 4 {
            0 | 1 => axis.z,
            2 => sine * random.between(-1.0, 1.0),
            _ => sine * (1.0 - random.between(-20.0, -7.0).exp2()) * if axis.x < 0.0 { 1.0 } else { -1.0 },
        };
        let across = (1.0 - height * height).max(0.0).sqrt();
        let flat = axis.truncate().try_normalize().unwrap_or(DVec2::X) * across;
        let center = (flat.extend(height) * distance).as_vec3().as_dvec3();
        Sphere { center, radius: f64::from((sine * distance) as f32) }
    };
    (0..4000).map(&mut sphere).filter(|sphere| !sphere.is_inside()).collect()
}

/// The values of a sphere whose center and radius are moved by [`MOVE`]: the lowest and the highest.
fn sphere_interval(sphere: &Sphere, value: impl Fn(&Sphere) -> f64) -> [f64; 2] {
    let (length, mut interval) = (sphere.center.length() * MOVE, [f64::INFINITY, 0.0_f64]);
    for place in 0..81 {
        let move_of = |i: u32| f64::from(place / 3_i32.pow(i) % 3 - 1);
        let way = DVec3::new(move_of(0), move_of(1), move_of(2)).try_normalize().unwrap_or_default();
        let radius = sphere.radius * (1.0 + MOVE * move_of(3));
        let found = value(&Sphere { center: sphere.center + way * length, radius });
        interval = [interval[0].min(found), interval[1].max(found)];
    }
    interval
}

#[test]
fn spheres_are_as_good_as_their_rounding() {
    let Some(engine) = TestEngine::new() else { return };
    let cases = [spheres(72, -4.0), spheres(73, -30.0)].concat();
    let arguments: Vec<_> =
        cases.iter().map(|s| sphere_arguments(s.center, s.radius, &DMat3::IDENTITY)).collect();
    // Relative to the whole sphere's form factor where it faces the surface
    let bound = 1e-6;
    let mut comparison = Comparison::new("sphere over sine squared");
    let mut unguarded = 0;
    for (sphere, found) in cases.iter().zip(engine.shapes(ShapeFunction::Sphere, &arguments)) {
        assert!(found[0].to_bits() <= 1.0_f32.to_bits(), "{found:?}: {sphere:?}");
        let [low, high] = sphere_interval(sphere, sphere::form_factor);
        let whole = (sphere.radius / sphere.center.length()).powi(2);
        let found = f64::from(found[0]);
        let error = (low - found).max(found - high).max(0.0) / whole;
        comparison.add(error, 0.0, bound, || format!("{sphere:?}: {found}, {low}..{high}"));
        unguarded += usize::from(
            (unguarded_sphere(sphere) - high).max(low - unguarded_sphere(sphere)) / whole > bound,
        );
    }
    comparison.assert_all();
    // The twin: the closed form as it is usually written, in float32
    assert!(unguarded > 300, "{unguarded} noticed");
}

/// The closed form as it is usually written, in float32.
fn unguarded_sphere(sphere: &Sphere) -> f64 {
    let distance = sphere.center.length() as f32;
    let s = sphere.radius as f32 / distance;
    let z = sphere.center.z as f32 / distance;
    if z >= s {
        return f64::from(s * s * z);
    }
    if z <= -s {
        return 0.0;
    }
    let (q, c) = ((s * s - z * z).sqrt(), (1.0 - s * s).sqrt());
    f64::from((s * s * z * q.atan2(-c * z) - c * q + q.atan2(c)) / std::f32::consts::PI)
}

/// A lobe's cosine space: stretched across an axis that is inclined, by up to 3000.
fn transforms(count: usize) -> Vec<DMat3> {
    let mut random = Random::new(74);
    let mut transform = || {
        let alpha = random.between(-11.5, 0.0).exp2();
        let (axis, turn) = (random.direction(), random.between(0.0, 6.3));
        let rotation = DMat3::from_axis_angle(axis, turn);
        let stretch = DMat3::from_diagonal(DVec3::new(1.0, random.between(0.5, 1.0), alpha));
        (stretch * rotation).as_mat3().as_dmat3()
    };
    (0..count).map(|_| transform()).collect()
}

#[test]
fn spheres_in_cosine_space_are_their_silhouettes() {
    let Some(engine) = TestEngine::new() else { return };
    let cases = spheres(75, -8.0);
    let transforms = transforms(cases.len());
    let arguments: Vec<_> =
        cases.iter().zip(&transforms).map(|(s, m)| sphere_arguments(s.center, s.radius, m)).collect();
    let mut comparison = Comparison::new("silhouettes, backward");
    let mut forward = 0.0_f64;
    let mut twin = 0;
    for (((sphere, matrix), given), found) in cases
        .iter()
        .zip(&transforms)
        .zip(&arguments)
        .zip(engine.shapes(ShapeFunction::Silhouette, &arguments))
    {
        assert!(found[0].to_bits() <= 1.0_f32.to_bits() && given[3][3] == 1.0, "{found:?}: {sphere:?}");
        let found = f64::from(found[0]);
        let truth = sphere::transformed_form_factor(matrix, sphere);
        forward = forward.max((found - truth).abs());
        // The silhouette is rounded before it is transformed, and the result again: the transform's product
        // is as if each of its vectors had moved by 2^-22 of the product of lengths, the matrix's largest
        // entry being about one
        let disk = sphere.silhouette().unwrap();
        let ellipse = disk.transformed(matrix);
        let error = nearby_shape::distance(&ellipse, found, 1e-7);
        let [low, high] = sphere_interval(sphere, |s| sphere::transformed_form_factor(matrix, s));
        let error = error.min((low - found).max(found - high).max(0.0));
        let bound = 2e-6;
        comparison.add(error, 0.0, bound, || format!("{sphere:?}, {matrix:?}: {found}, {truth}"));
        twin += usize::from(nearby_shape::distance(&ellipse, found + 4.0 * bound, 1e-7) > bound);
    }
    println!("largest error {forward:.1e}");
    comparison.assert_all();
    assert!(twin > cases.len() / 2, "{twin} noticed");
}

#[test]
fn a_point_in_a_sphere_sees_its_inside() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(76);
    let mut arguments = Vec::new();
    for index in 0..200 {
        let center = random.direction() * random.between(0.0, 0.999);
        let mut given = sphere_arguments(center, 1.0, &DMat3::IDENTITY);
        given[3][3] = f32::from(index % 2 == 0);
        arguments.push(given);
    }
    for (given, found) in arguments.iter().zip(engine.shapes(ShapeFunction::Sphere, &arguments)) {
        assert_eq!(found[0], given[3][3]);
    }
    for found in engine.shapes(ShapeFunction::Silhouette, &arguments) {
        assert_eq!(found[0], 0.0);
    }
}
