//! The GGX lobe against integrals of it.

use crate::common::{direction, square_points, view_angle, view_at};
use arealight_oracle::cubature::{Region, Settings, angles};
use arealight_oracle::ggx::Ggx;
use arealight_oracle::shading::lobe_integrals;
use glam::DVec3;
use proptest::prelude::*;
use std::f64::consts::LN_2;

fn albedo(alpha: f64, view: DVec3) -> f64 {
    let hemisphere = Region::sphere().clipped(DVec3::Z);
    lobe_integrals(Ggx { alpha }, view, &hemisphere, &Settings::default()).value[0]
}

/// The albedo by sampling: the mean of `f cos / density`.
fn sampled_albedo(alpha: f64, view: DVec3, density: impl Fn(DVec3) -> f64) -> f64 {
    let lobe = Ggx { alpha };
    let count = 1 << 15;
    let weight = |u| {
        let light = lobe.sample(view, u);
        let value = lobe.evaluate(view, light);
        if value == 0.0 { 0.0 } else { value / density(light) }
    };
    square_points(count).map(weight).sum::<f64>() / count as f64
}

#[test]
fn the_roughest_lobe_reflects_one_minus_ln_2_straight_up() {
    // the closed form; the cubature's estimates of 1e-6 stand for errors of 1e-8
    assert!((albedo(1.0, DVec3::Z) - (1.0 - LN_2)).abs() < 1e-8);
    // the twin: another lobe reflects something else
    assert!((albedo(0.9, DVec3::Z) - (1.0 - LN_2)).abs() > 1e-2);
}

#[test]
fn sampling_and_cubature_find_the_same_albedo() {
    for alpha in [1e-3, 0.01, 0.1, 0.4, 1.0] {
        for theta in [0.0_f64, 0.5, 1.0, 1.4, 1.55] {
            let (view, lobe) = (view_at(theta), Ggx { alpha });
            let exact = albedo(alpha, view);
            // 32768 even points in the square: 3e-4 measured, for the weights jump at the horizon
            let right = sampled_albedo(alpha, view, |light| lobe.density(view, light));
            assert!(
                (right - exact).abs() < 1e-3 * exact,
                "alpha {alpha}, theta {theta}: {right} and {exact}"
            );
            // the twin: the density of half vectors, as if the reflection did not stretch solid angle
            let wrong = sampled_albedo(alpha, view, |light| {
                let half = (view + light).normalize_or_zero();
                lobe.density(view, light) * 4.0 * view.dot(half)
            });
            assert!((wrong - exact).abs() > 0.1 * exact, "alpha {alpha}, theta {theta}: {wrong} and {exact}");
        }
    }
}

#[test]
fn the_density_and_the_samples_agree_on_a_region() {
    let cut = DVec3::new(0.3, -0.5, 0.4);
    for (alpha, theta) in [(0.05, 0.3), (0.3, 1.2), (0.8, 0.7), (1.0, 1.5)] {
        let (view, lobe) = (view_at(theta), Ggx { alpha });
        let density = |region: &Region| {
            // The density varies as the lobe does
            let lengths = |t: &[DVec3; 3]| angles(t).map(|angle| angle / alpha);
            region.integrate(&Settings::default(), lengths, |light| [lobe.density(view, light)]).value[0]
        };
        let count = 1 << 15;
        let share = |inside: &dyn Fn(DVec3) -> bool| {
            square_points(count).filter(|u| inside(lobe.sample(view, *u))).count() as f64 / count as f64
        };
        let hemisphere = Region::sphere().clipped(DVec3::Z);
        let above = density(&hemisphere);
        assert!(above <= 1.0 + 1e-6, "{above}");
        // counting 32768 even points along a border: 1e-3
        assert!((above - share(&|light| light.z > 0.0)).abs() < 1e-3);
        let beyond = density(&hemisphere.clipped(cut));
        assert!((beyond - share(&|light| light.z > 0.0 && cut.dot(light) > 0.0)).abs() < 1e-3);
        assert!((beyond - share(&|light| light.z > 0.0 && cut.dot(light) < 0.0)).abs() > 1e-2, "the twin");
    }
}

proptest! {
    #[test]
    fn the_lobe_is_reciprocal(theta in view_angle(), other in direction(), alpha in 1e-3..1.0_f64) {
        let (lobe, view, light) = (Ggx { alpha }, view_at(theta), other.abs());
        let (there, back) = (lobe.evaluate(view, light) / light.z, lobe.evaluate(light, view) / view.z);
        // a dozen roundings
        prop_assert!((there - back).abs() <= 1e-14 * there, "{there} and {back}");
    }

    #[test]
    fn the_lobe_never_reflects_more_than_it_receives(theta in view_angle(), log in -8.0..0.0_f64) {
        let albedo = albedo(log.exp(), view_at(theta));
        prop_assert!(albedo > 0.1 && albedo <= 1.0 + 1e-6, "{albedo}");
    }
}
