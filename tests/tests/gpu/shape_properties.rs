//! What must hold of ellipses and spheres whatever they are: invariances, inclusion, continuity, and any
//! bits.

use arealight_cases::hard::ellipse::{FAMILIES, Family, rounded};
use arealight_oracle::ellipse::{Ellipse, form_factor, vector_form_factor};
use arealight_oracle::polygon;
use arealight_tests::Numbers;
use arealight_tests::prelude::*;
use arealight_tests::shapes::{ShapeArguments, ShapeFunction, ellipse_arguments};

fn generic(count: u64) -> Vec<Ellipse> {
    let families = ["generic", "crossing"].map(|name| Family::find(name).unwrap());
    (0..count).map(|index| families[index as usize % 2].case(index, 0)).collect()
}

/// Form factors of both rounded ellipses of each pair.
fn pairs(engine: &TestEngine, pairs: &[[Ellipse; 2]]) -> Vec<[f64; 2]> {
    let flat: Vec<Ellipse> = pairs.iter().flatten().map(rounded).collect();
    let found = engine.ellipses(ShapeFunction::Ellipse, &flat);
    found.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect()
}

#[test]
fn names_of_the_axes_and_powers_of_two_change_no_bit() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(81);
    let cases = generic(1000);
    let relate = |change: &mut dyn FnMut(&Ellipse) -> Ellipse| {
        let related: Vec<_> = cases.iter().map(|case| [*case, change(case)]).collect();
        pairs(&engine, &related).into_iter().filter(|[a, b]| a != b).count()
    };
    assert_eq!(relate(&mut |e| Ellipse { axis_u: e.axis_v, axis_v: e.axis_u, ..*e }), 0);
    assert_eq!(relate(&mut |e| Ellipse { axis_u: -e.axis_u, ..*e }), 0);
    assert_eq!(relate(&mut |e| Ellipse { axis_v: -e.axis_v, ..*e }), 0);
    let mut scale = |e: &Ellipse| {
        e.transformed(&DMat3::from_diagonal(DVec3::splat(random.between(-60.0, 60.0).floor().exp2())))
    };
    assert_eq!(relate(&mut scale), 0);
    // The twin: other sizes round otherwise
    assert!(relate(&mut |e| e.transformed(&DMat3::from_diagonal(DVec3::splat(3.0)))) > 100);
}

#[test]
fn turning_scaling_and_other_axes_change_nothing() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(82);
    let cases = generic(2000);
    let mut comparison = Comparison::new("turned, scaled, other axes");
    let mut twin = 0;
    for kind in 0..4 {
        let related: Vec<_> = cases
            .iter()
            .map(|e| {
                let (sin, cos) = random.between(0.0, 6.3).sin_cos();
                let other = match kind {
                    0 => e.transformed(&DMat3::from_rotation_z(sin)),
                    1 => e.transformed(&DMat3::from_diagonal(DVec3::splat(std::f64::consts::PI * 1e3))),
                    2 => Ellipse {
                        axis_u: e.axis_u * cos + e.axis_v * sin,
                        axis_v: e.axis_v * cos - e.axis_u * sin,
                        ..*e
                    },
                    // The twin: a turn about another axis
                    _ => e.transformed(&DMat3::from_rotation_x(0.01)),
                };
                [*e, other]
            })
            .collect();
        for (index, [a, b]) in pairs(&engine, &related).into_iter().enumerate() {
            // Both are rounded, by up to 2^-24 of each component, which a near rim magnifies: the backward
            // bound of each, and what that moves the value
            let bound = 2.0 * 6e-7 + 2.0 * sensitivity(&cases[index]) * 2.0_f64.powi(-24);
            if kind == 3 {
                twin += usize::from((a - b).abs() > bound);
            } else {
                comparison.add(a, b, bound, || format!("{kind}: {:?}", cases[index]));
            }
        }
    }
    comparison.assert_all();
    assert!(twin > 800, "{twin} noticed");
}

/// The largest change of the form factor over that of the ellipse relative to its distances, about.
fn sensitivity(ellipse: &Ellipse) -> f64 {
    const STEP: f64 = 1e-6;
    let at = |center: DVec3, u: DVec3, v: DVec3| form_factor(&Ellipse { center, axis_u: u, axis_v: v });
    let Ellipse { center, axis_u, axis_v } = *ellipse;
    let mut sum = 0.0;
    for way in [DVec3::X, DVec3::Y, DVec3::Z] {
        let moves = [center, axis_u, axis_v].map(|v| way * (v.length() * STEP));
        sum += (at(center + moves[0], axis_u, axis_v) - at(center - moves[0], axis_u, axis_v)).abs();
        sum += (at(center, axis_u + moves[1], axis_v) - at(center, axis_u - moves[1], axis_v)).abs();
        sum += (at(center, axis_u, axis_v + moves[2]) - at(center, axis_u, axis_v - moves[2])).abs();
    }
    0.5 * sum / STEP
}

#[test]
fn what_lies_inside_sends_no_more() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(83);
    let mut comparison = Comparison::new("the inner one's excess");
    let mut twin = 0;
    let related: Vec<_> = generic(2000)
        .iter()
        .map(|e| {
            let part = random.between(0.3, 1.0);
            [*e, Ellipse { axis_u: e.axis_u * part, axis_v: e.axis_v * part, ..*e }]
        })
        .collect();
    for ([outer, inner], case) in pairs(&engine, &related).into_iter().zip(&related) {
        let bound = 2.0 * 6e-7 + sensitivity(&case[1]) * 2.0_f64.powi(-24);
        comparison.add((inner - outer).max(0.0), 0.0, bound, || format!("{case:?}"));
        twin += usize::from(outer - inner > bound);
    }
    comparison.assert_all();
    assert!(twin > 1000, "{twin} noticed");
}

#[test]
fn what_the_horizon_hides_is_the_mirror_image() {
    let Some(engine) = TestEngine::new() else { return };
    let cases = generic(2000);
    let mirror = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
    let related: Vec<_> = cases.iter().map(|e| [*e, e.transformed(&mirror)]).collect();
    let mut comparison = Comparison::new("F - F of the mirror image = the whole's");
    let mut twin = 0;
    for ([up, down], case) in pairs(&engine, &related).into_iter().zip(&cases) {
        let whole = vector_form_factor(case).z;
        // No rounding between them but the functions' own
        let bound = 1e-6 + sensitivity(case) * 2.0_f64.powi(-22);
        comparison.add(up - down, whole, bound, || format!("{case:?}"));
        twin += usize::from((up - whole.max(0.0)).abs() > bound);
    }
    comparison.assert_all();
    assert!(twin > 500, "{twin} noticed");
}

#[test]
fn nothing_jumps_past_the_horizon() {
    const STEPS: usize = 20_000;
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(84);
    let mut sweeps = Vec::new();
    for _ in 0..6 {
        let (x, y) = random.direction().any_orthonormal_pair();
        let base = Ellipse { center: DVec3::new(0.9, 0.5, 0.0), axis_u: x * 0.8, axis_v: y * 0.3 };
        let rise = base.axis_u.z.hypot(base.axis_v.z);
        // From wholly below to wholly above
        for step in 0..=STEPS {
            let height = 1.1 * rise * (2.0 * step as f64 / STEPS as f64 - 1.0);
            sweeps.push(rounded(&Ellipse { center: base.center.with_z(height), ..base }));
        }
    }
    let truth: Vec<f64> = sweeps.iter().map(|case| form_factor(case).abs()).collect();
    let found = engine.ellipses(ShapeFunction::Ellipse, &sweeps);
    let errors: Vec<f64> = found.iter().zip(&truth).map(|(f, t)| f - t).collect();
    for (sweep, errors) in sweeps.chunks_exact(STEPS + 1).zip(errors.chunks_exact(STEPS + 1)) {
        // Beyond what float64 changes by
        let jump = errors.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        assert!(jump < 6e-7, "{jump:e} of {:?}", sweep[0]);
    }
    // The twin: the published disk errs by much more on the way
    let arguments: Vec<_> = sweeps.iter().map(ellipse_arguments).collect();
    let found = engine.shapes(ShapeFunction::Published, &arguments);
    let errors: Vec<f64> = found.iter().zip(&truth).map(|(f, t)| (f64::from(f[0]) - t).abs()).collect();
    for errors in errors.chunks_exact(STEPS + 1) {
        assert!(errors.iter().fold(0.0_f64, |a, b| a.max(*b)) > 1e-4);
    }
}

/// Where one formula gives way to another, nothing is seen of that: the small form begins where the longer
/// axis is a fiftieth of the distance, and its series where half the arc is one radian.
#[test]
fn nothing_jumps_where_formulas_change() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(85);
    let (mut cases, mut scales) = (Vec::new(), Vec::new());
    for _ in 0..100 {
        let (x, y) = random.direction().any_orthonormal_pair();
        let thin = random.between(0.1, 1.0);
        let direction = random.direction().with_z(0.0).try_normalize().unwrap_or(DVec3::X);
        let share = random.between(-0.95, 0.95);
        let at = |size: f64, share: f64| {
            let (axis_u, axis_v) = (x * size, y * (size * thin));
            let height = share * axis_u.z.hypot(axis_v.z);
            let distance = (1.0 - height * height).sqrt();
            rounded(&Ellipse { center: (direction * distance).with_z(height), axis_u, axis_v })
        };
        cases.extend([at(0.02 * (1.0 - 1e-5), share), at(0.02 * (1.0 + 1e-5), share)]);
        // -cos(1) of the rise, for an ellipse of 1e-4: relative to what it sends when wholly above
        cases.extend([at(1e-4, -1.0_f64.cos() - 1e-5), at(1e-4, -1.0_f64.cos() + 1e-5)]);
        scales.extend([1.0, 1e-12 * thin]);
    }
    let found = engine.ellipses(ShapeFunction::Ellipse, &cases);
    let errors: Vec<_> = found.iter().zip(&cases).map(|(f, e)| f - form_factor(e).abs()).collect();
    let jumps: Vec<_> =
        errors.chunks_exact(2).zip(&scales).map(|(pair, scale)| (pair[1] - pair[0]).abs() / scale).collect();
    let largest = |first: usize| jumps.iter().skip(first).step_by(2).fold(0.0_f64, |a, b| a.max(*b));
    let (by_size, by_arc) = (largest(0), largest(1));
    println!("by size {by_size:.1e}, by arc {by_arc:.1e}");
    // The small form's 2 (1 / 50)^2 of the ellipse's 1e-5, with the clipped form's rounding
    assert!(by_size < 4e-8, "{by_size:e}");
    // The series' and the closed form's precision of the distance's cube, of which half a millionth is
    // rounding
    assert!(by_arc < 5e-6, "{by_arc:e}");
}

#[test]
fn inscribed_polygons_tend_to_it() {
    let Some(engine) = TestEngine::new() else { return };
    let cases: Vec<_> = generic(300)
        .into_iter()
        .filter(|e| (0..64).all(|i| e.point(f64::from(i) * 0.1).length() > 0.1))
        .collect();
    let found = engine.ellipses(ShapeFunction::Ellipse, &cases);
    let mut errors: [Vec<f64>; 2] = [vec![], vec![]];
    for (case, found) in cases.iter().zip(found) {
        for (errors, count) in errors.iter_mut().zip([64, 512]) {
            errors.push((polygon::form_factor(&case.polygon(count)).abs() - found).abs());
        }
    }
    let median = errors.map(|mut errors| {
        errors.sort_by(f64::total_cmp);
        errors[errors.len() / 2]
    });
    println!("medians {median:?} of {}", cases.len());
    // An inscribed polygon lacks 2 pi^2 / (3 n^2) of the area: 1.6e-3 and 2.5e-5 of form factors of some
    // hundredths
    assert!(median[0] > 3e-6 && median[0] < 1e-3, "{median:?}");
    assert!(median[1] < median[0] / 40.0, "{median:?}");
    in_contact_it_is_all_there_is(&engine);
}

/// A disk of radius 1 at the height h over a point that is x from its axis leaves open no more than the
/// directions below h / (1 - x), which have its square of the cosine; from beyond its rim it covers no more
/// than those below h / (x - 1).
fn in_contact_it_is_all_there_is(engine: &TestEngine) {
    let mut random = Random::new(83);
    let mut cases = Vec::new();
    for exponent in 1..24 {
        for _ in 0..20 {
            let (place, height) = (random.between(0.0, 2.0), f64::from(-exponent).exp2());
            let (sin, cos) = random.between(0.0, 6.3).sin_cos();
            let center = DVec3::new(place * cos, place * sin, height);
            cases.push(rounded(&Ellipse { center, axis_u: DVec3::X, axis_v: DVec3::Y }));
        }
    }
    let mut comparison = Comparison::new("contact");
    let mut twin = 0;
    for (case, found) in cases.iter().zip(engine.ellipses(ShapeFunction::Ellipse, &cases)) {
        let place = case.center.truncate().length();
        let slope = case.center.z / (1.0 - place).abs();
        let [inside, outside] = [1.0, 0.0];
        let (limit, other) = if place < 1.0 { (inside, outside) } else { (outside, inside) };
        comparison.add(found, limit, slope * slope + 2e-6, || format!("{case:?}"));
        twin += usize::from((found - other).abs() > slope * slope + 2e-6);
    }
    comparison.assert_all();
    assert!(twin > 300, "{twin} noticed");
}

#[test]
fn any_bits_give_a_form_factor() {
    use ShapeFunction::{Ellipse, Silhouette, Sphere};
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(86);
    let mut case = || -> ShapeArguments {
        let [center, others] = [0; 2].map(|_| Numbers::choose(&mut random));
        [center, others, others, others].map(|numbers| numbers.vector(&mut random))
    };
    let mut arguments: Vec<_> = (0..100_000).map(|_| case()).collect();
    // Hard cases of ordinary size, and those with one bad number each
    for family in FAMILIES {
        for index in 0..1000 {
            let mut given = ellipse_arguments(&family.case(index, 0));
            arguments.push(given);
            given[index as usize % 3][index as usize / 3 % 3] = [f32::NAN, f32::INFINITY][index as usize % 2];
            arguments.push(given);
        }
    }
    let bad_input = |given: &ShapeArguments| given[..3].iter().any(|v| v[..3].iter().any(|c| !c.is_finite()));
    for function in [Ellipse, Sphere, Silhouette] {
        let found = engine.shapes(function, &arguments);
        let (mut wrong, mut partial) = (Vec::new(), 0);
        for (given, found) in arguments.iter().zip(&found) {
            let must_be_dark = function == Ellipse && bad_input(given);
            let largest = if must_be_dark { 0.0_f32 } else { 1.0 };
            if found[0].to_bits() > largest.to_bits() {
                wrong.push((given, found[0]));
            }
            partial += usize::from(found[0] > 0.0 && found[0] < 1.0);
        }
        println!("{function:?}: {partial} between 0 and 1");
        let some = &wrong[..wrong.len().min(3)];
        assert!(wrong.is_empty(), "{function:?}: {} of them: {some:?}", wrong.len());
        // The twin: it is not that all are dark
        assert!(partial > 2000, "{partial}");
    }
    // The twin: the published disk is no form factor for many of the same
    let found = engine.shapes(ShapeFunction::Published, &arguments);
    assert!(found.iter().filter(|found| found[0].to_bits() > 1.0_f32.to_bits()).count() > 10_000);
}
