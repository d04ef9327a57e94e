//! The transformed cosine and its derivatives.

use arealight::table::{mirror_frame, share_above_surface};
use arealight_fit::lobe::Lobe;
use arealight_oracle::cubature::{Region, Settings, angles};
use arealight_oracle::ltsd::{Original, TransformedDistribution};
use glam::DVec3;
use proptest::prelude::*;
use std::array::from_fn;

fn lobes() -> impl Strategy<Value = Lobe> {
    let texel = (0.2..2.0, -0.5..0.5, -0.5..0.5, 0.4..2.0);
    (texel, 0.1_f64..1.0)
        .prop_map(|((a, b, c, d), alpha)| Lobe { texel: [a, b, c, d], alpha })
        .prop_filter("a lobe", Lobe::is_valid)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(64) })]

    #[test]
    fn its_density_is_that_of_the_transformed_distribution(lobe in lobes(), u in [0.01..0.99, 0.01..0.99]) {
        let distribution =
            TransformedDistribution::from_inverse(Original::ClampedCosine, lobe.inverse()).unwrap();
        let direction = lobe.sample(u);
        let (ours, theirs) = (lobe.density(direction), distribution.evaluate(direction));
        // Two orders of the same float64 arithmetic
        prop_assert!((ours - theirs).abs() <= 1e-10 * theirs, "{} {}", ours, theirs);
        let sampled = distribution.sample(u);
        prop_assert!(sampled.distance(direction) < 1e-9, "{} {}", sampled, direction);
    }

    #[test]
    fn its_derivatives_are_those_of_the_density(lobe in lobes(), u in [0.01..0.9, 0.01..0.99]) {
        let direction = lobe.sample(u);
        let (density, gradient) = lobe.density_and_gradient(direction);
        prop_assert!((density - lobe.density(direction)).abs() <= 1e-12 * density);
        // Central differences: off by their step squared, as a part of how far the lobe is from none
        let step = 3e-6 * lobe.determinant().min(1.0);
        for i in 0..4 {
            let moved = |by: f64| {
                let texel = from_fn(|k| lobe.texel[k] + if k == i { by } else { 0.0 });
                Lobe { texel, ..lobe }.density(direction)
            };
            let difference = (moved(step) - moved(-step)) / (2.0 * step);
            let scale = density + gradient[i].abs();
            prop_assert!((difference - gradient[i]).abs() < 1e-5 * scale, "{} {} \
            {:?}", i, difference, gradient);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(64) })]

    #[test]
    fn its_share_above_the_surface_is_the_table_s_and_has_derivatives(
        lobe in lobes(), cos_view in 0.01..1.0,
    ) {
        let frame = mirror_frame(cos_view);
        let normal = frame.transpose() * DVec3::Z;
        let (share, gradient) = lobe.share_above(normal);
        let inverse = lobe.inverse() * frame.transpose();
        prop_assert!((share - share_above_surface(&inverse)).abs() < 1e-12);
        for i in 0..4 {
            const STEP: f64 = 1e-5;
            let moved = |by: f64| {
                let texel = from_fn(|k| lobe.texel[k] + if k == i { by } else { 0.0 });
                Lobe { texel, ..lobe }.share_above(normal).0
            };
            // Differences to the fourth order: of narrow lobes, third derivatives are beyond a thousand
            let near = moved(STEP) - moved(-STEP);
            let difference = (8.0 * near - (moved(2.0 * STEP) - moved(-2.0 * STEP))) / (12.0 * STEP);
            prop_assert!((difference - gradient[i]).abs() < 1e-7, "{} {} {:?}", i, difference, gradient);
        }
    }
}

#[test]
fn its_share_above_the_surface_is_its_integral_there() {
    for (texel, cos_view) in [([0.5, 0.2, 0.1, 1.0], 0.3), ([0.3, -0.1, 0.4, 0.8], 0.1)] {
        let lobe = Lobe { texel, alpha: 0.5 };
        let to_mirror = mirror_frame(cos_view).transpose();
        let settings = Settings { relative_tolerance: 1e-6, ..Settings::default() };
        let above = Region::sphere().clipped(DVec3::Z);
        let integral = above.integrate(&settings, angles, |light| [lobe.density(to_mirror * light)]).value[0];
        let (share, _) = lobe.share_above(to_mirror * DVec3::Z);
        // The kink at the lobe's own horizon limits the cubature
        assert!((share - integral).abs() < 1e-5 && share < 0.99, "{share} {integral}");
    }
}

#[test]
fn it_integrates_to_one() {
    for texel in [[1.0, 0.0, 0.0, 2.0], [0.3, -0.1, 0.4, 0.8], [1.2, 0.3, -0.3, 1.5]] {
        let lobe = Lobe { texel, alpha: 0.5 };
        let settings = Settings { relative_tolerance: 1e-6, ..Settings::default() };
        let integral =
            Region::sphere().integrate(&settings, angles, |direction| [lobe.density(direction)]).value[0];
        // The kink at its horizon limits the cubature
        assert!((integral - 1.0).abs() < 1e-5, "{texel:?}: {integral}");
    }
}

#[test]
fn what_cannot_be_inverted_is_no_lobe() {
    let is_valid = |texel| Lobe { texel, alpha: 0.5 }.is_valid();
    assert!(is_valid([1.0, 0.0, 0.0, 1.0]));
    for texel in
        [[1.0, 1.0, 1.0, 1.0], [-1.0, 0.0, 0.0, -1.0], [f64::NAN, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0]]
    {
        assert!(!is_valid(texel), "{texel:?}");
    }
}
