//! Slim tubes that the horizon cuts, and the worst tubes of long batteries.

use super::tubes::{COUNT, ENDS, distance, found, is_thin, round};
use arealight_cases::hard::nearby_shape;
use arealight_oracle::tube::{Ends, Tube, form_factor};
use arealight_tests::prelude::*;

/// Slim tubes that lie nearly level and pass through the horizon between their ends.
fn slanting_tubes(ends: Ends) -> Vec<Tube> {
    let mut random = Random::new(89);
    let mut tube = || {
        let (away, turn) = (random.between(-3.0, 12.0).exp2(), random.between(0.0, 6.3));
        let length = away * random.between(0.15, 0.3);
        let radius = f64::from((away * random.between(-11.5, -9.0).exp2()) as f32);
        // The ends stay clear of the horizon
        let rise = radius * random.between(2.0, 5.0);
        let height = (rise - 1.1 * radius) * random.between(-1.0, 1.0);
        let (center, half) = (DVec3::new(away, 0.0, height), DVec3::new(0.0, 0.5 * length, rise));
        let rotation = DMat3::from_rotation_z(turn);
        let (center, half) = (round(rotation * center), round(rotation * half));
        Tube { start: center - half, end: center + half, radius, ends }
    };
    (0..COUNT).map(|_| tube()).collect()
}

/// What a tube's axis sends, of the tube's width: it ends at the horizon, across.
fn line(tube: &Tube) -> f64 {
    const STEPS: usize = 10_000;
    let step = (tube.end - tube.start) / STEPS as f64;
    let at = |i: usize| tube.start + step * (i as f64 + 0.5);
    let sum: f64 = (0..STEPS).map(|i| at(i).z.max(0.0) / at(i).length_squared().powi(2)).sum();
    2.0 * tube.radius * distance(tube) * step.length() * sum / std::f64::consts::PI
}

#[test]
fn a_slim_tube_is_cut_at_a_slant() {
    let Some(engine) = TestEngine::new() else { return };
    let mut across = 0;
    for ends in ENDS {
        let tubes = slanting_tubes(ends);
        let mut comparison = Comparison::new(format!("{ends:?}, slanting"));
        let found = found(&engine, &tubes, &[DMat3::IDENTITY; COUNT]);
        for (tube, found) in tubes.iter().zip(found) {
            assert!(is_thin(tube, &DMat3::IDENTITY) && tube.start.z * tube.end.z < 0.0, "{tube:?}");
            let truth = form_factor(tube);
            let shown = tube.radius * 2.0 * tube.start.distance(tube.end) / std::f64::consts::PI;
            let whole = shown / distance(tube).powi(2);
            // What is promised of a slim tube
            comparison.add(found / whole, truth / whole, 1e-5, || format!("{tube:?}"));
            across += usize::from(ends == Ends::Open && (line(tube) - truth).abs() > 1e-5 * whole);
        }
        comparison.assert_all();
    }
    // The twin: a line that ends across
    assert!(across > COUNT / 2, "{across} noticed");
}

/// Cases of long batteries, with what they gave before: a foot taken from the nearer end, which is far off; a
/// horizon between the ends of a line that was cut across; a polygon in the place of a line whose end is cut,
/// 44 away.
#[test]
fn the_worst_tubes_of_long_batteries_are_as_promised() {
    let Some(engine) = TestEngine::new() else { return };
    let near = Tube {
        start: DVec3::new(0.526_246_569_119_393_8, 0.646_867_044_270_038_8, -1.624_060_656_875_372),
        end: DVec3::new(-0.515_278_317_965_567_1, -0.503_296_248_614_788, 1.625_421_021_133_661_3),
        radius: 0.062_505_446_374_416_35,
        ends: Ends::Flat,
    };
    let between = Tube {
        start: DVec3::new(1.136_188_338_976_353_4, -1.245_236_039_161_682_1, 0.028_471_508_994_698_524),
        end: DVec3::new(1.149_321_485_776_454_2, -0.776_034_712_791_442_9, -0.004_158_331_081_271_172),
        radius: 0.002_859_681_844_711_303_7,
        ends: Ends::Open,
    };
    let end = Tube {
        start: DVec3::new(43.978_396_177_291_87, 7.804_111_448_116_600_5, 0.000_129_043_597_553_391),
        end: DVec3::new(43.192_242_860_794_07, 7.815_724_405_460_06, -2.397_862_408_543_005_6e-5),
        radius: 0.000_128_151_106_764_562_43,
        ends: Ends::Round,
    };
    let backward = |found| nearby_shape::distance(&near, found, 1e-7);
    let relative = |tube: &Tube, found: f64| {
        let center = (tube.start + tube.end) * 0.5;
        let shown = tube.radius * 2.0 * tube.start.distance(tube.end) / std::f64::consts::PI;
        (found - form_factor(tube)).abs() * center.length_squared() / shown
    };
    let exact = found(&engine, &[near], &[DMat3::IDENTITY])[0];
    assert!(backward(exact) < 1e-6 && backward(0.524_428_84) > 1e-6, "{exact}");
    let found = found(&engine, &[between, end], &[DMat3::IDENTITY; 2]);
    for ((tube, found), before) in [between, end].iter().zip(found).zip([1.991_996_1e-6, 5.875_368e-13]) {
        assert!(relative(tube, found) < 1e-5 && relative(tube, before) > 1e-5, "{tube:?}: {found:e}");
    }
}
