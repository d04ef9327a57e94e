//! The albedos, against a closed form and against adaptive cubature.

use arealight_fit::brdf::view_direction;
use arealight_fit::{Brdf, GgxBrdf, Magnitude};
use arealight_oracle::cubature::{Region, Settings};
use arealight_oracle::ggx::Ggx;
use arealight_oracle::shading::lobe_integrals;
use glam::DVec3;

/// Adaptive cubature in the light's solid angle: knows nothing of half vectors and of the horizon's shape.
fn independent(alpha: f64, cos_view: f64) -> Magnitude {
    let region = Region::sphere().clipped(DVec3::Z);
    let settings = Settings { relative_tolerance: 1e-6, max_evaluations: 2_000_000 };
    let [albedo, schlick] = lobe_integrals(Ggx { alpha }, view_direction(cos_view), &region, &settings).value;
    Magnitude { albedo, schlick }
}

#[test]
fn at_alpha_one_from_the_normal_it_is_one_minus_ln_two() {
    // float64's own accuracy, times the thousands of terms
    assert!((GgxBrdf.magnitude(1.0, 1.0).albedo - (1.0 - 2.0_f64.ln())).abs() < 1e-13);
}

#[test]
fn it_agrees_with_adaptive_cubature() {
    // Both have errors of up to about 4e-6 at small alpha, and 1e-8 elsewhere
    for (alpha, tolerance) in [(0.003, 1e-5), (0.05, 1e-6), (0.3, 1e-7), (1.0, 1e-7)] {
        for cos_view in [0.03, 0.2, 0.6, 1.0] {
            let (ours, theirs) = (GgxBrdf.magnitude(alpha, cos_view), independent(alpha, cos_view));
            let difference = (ours.albedo - theirs.albedo).abs().max((ours.schlick - theirs.schlick).abs());
            assert!(difference < tolerance, "{alpha} {cos_view}: {ours:?} {theirs:?}");
        }
    }
}

#[test]
fn the_comparison_sees_a_wrong_alpha() {
    let difference = GgxBrdf.magnitude(0.3, 0.2).albedo - independent(0.301, 0.2).albedo;
    assert!(difference.abs() > 1e-4, "{difference}");
}

#[test]
fn grazing_views_lose_nothing() {
    // At the horizon nothing is masked that is not shadowed too: the albedo is 1 at every alpha
    for alpha in [1e-4, 0.01, 0.5, 1.0] {
        let magnitude = GgxBrdf.magnitude(alpha, 0.0);
        assert!((magnitude.albedo - 1.0).abs() < 1e-6, "{alpha}: {magnitude:?}");
    }
}
