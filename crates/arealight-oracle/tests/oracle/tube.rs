//! Tubes' silhouettes against rays, and against spheres and disks in the limit.

use crate::common::{matrix, square_points};
use arealight_oracle::sphere::{self, Sphere};
use arealight_oracle::tube::{Ends, Tube, form_factor, transformed_form_factor};
use glam::{DMat3, DVec3};
use proptest::prelude::*;
use proptest::strategy::ValueTree as _;
use std::f64::consts::TAU;

fn tube(ends: Ends) -> impl Strategy<Value = Tube> {
    let point = || prop::array::uniform3(-2.0..2.0_f64).prop_map(DVec3::from_array);
    (point(), point(), 0.05..1.0_f64).prop_map(move |(start, end, radius)| Tube { start, end, radius, ends })
}

#[test]
fn rays_hit_as_often() {
    const RAYS: usize = 40_000;
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    for ends in [Ends::Open, Ends::Flat, Ends::Round] {
        let mut light = 0.0;
        for _ in 0..20 {
            let tube = tube(ends).new_tree(&mut runner).unwrap().current();
            let inverse = matrix().new_tree(&mut runner).unwrap().current();
            let forward = inverse.inverse();
            let hits = square_points(RAYS).filter(|[u, v]| {
                let (sin, cos) = (TAU * v).sin_cos();
                tube.is_hit(forward * DVec3::new(u.sqrt() * cos, u.sqrt() * sin, (1.0 - u).sqrt()))
            });
            let expected = hits.count() as f64 / RAYS as f64;
            let found = transformed_form_factor(&inverse, &tube);
            // An evenly spread set's error is about the outline's length times n^(-3/4): 4e-4
            assert!((found - expected).abs() < 1.5e-3, "{tube:?}: {found} and {expected}");
            light += expected;
        }
        assert!(light > 0.5, "{ends:?}: there was little to see");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn a_capsule_of_no_length_is_a_sphere(mut tube in tube(Ends::Round)) {
        let sphere = Sphere { center: tube.start, radius: tube.radius };
        prop_assume!(tube.start.length() > 1.1 * tube.radius);
        tube.end = tube.start + (tube.end - tube.start) * 1e-9;
        let (capsule, sphere) = (form_factor(&tube), sphere::form_factor(&sphere));
        prop_assert!((capsule - sphere).abs() < 1e-7, "{capsule} and {sphere}");
    }

    #[test]
    fn finer_outlines_tend_to_it(tube in tube(Ends::Flat), more in tube(Ends::Round)) {
        for tube in [tube, more] {
            let near = (0..100).any(|i| {
                let p = tube.start.lerp(tube.end, f64::from(i) / 99.0);
                p.length() < 1.2 * tube.radius
            });
            if near {
                continue;
            }
            let limit = form_factor(&tube);
            let error = |count| arealight_oracle::polygon::form_factor(&tube.outline(count)).abs() - limit;
            // Inscribed outlines send less, by 1 / count^2
            prop_assert!(error(8) <= 1e-9 && error(8).abs() < 0.05, "{tube:?}: {}", error(8));
            prop_assert!(error(64).abs() <= error(8).abs() / 30.0 + 1e-6, "{tube:?}: {} of \
            {}", error(64), error(8));
        }
    }

    #[test]
    fn caps_add_and_round_ends_add_more(tube in tube(Ends::Open), turn in 0.0..TAU) {
        let of = |ends| form_factor(&Tube { ends, ..tube });
        prop_assert!(of(Ends::Open) <= of(Ends::Flat) + 1e-6);
        // A capsule holds the cylinder of the same axis
        prop_assume!(tube.start.length() > 1.01 * tube.radius && tube.end.length() > 1.01 * tube.radius);
        prop_assert!(of(Ends::Flat) <= of(Ends::Round) + 1e-6);
        let rotation = DMat3::from_rotation_z(turn);
        let turned = Tube { start: rotation * tube.start, end: rotation * tube.end, ..tube };
        prop_assert!((form_factor(&turned) - form_factor(&tube)).abs() < 1e-7);
    }
}
