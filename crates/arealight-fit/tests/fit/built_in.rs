//! The table that is checked in, against the truth.

use arealight::LightTable;
use arealight_fit::brdf::view_direction;
use arealight_fit::report::{
    COUNT, Case, PUBLISHED, REFLECTANCES, Rung, SEED, cases, measure, measure_lookup,
};
use arealight_fit::{Brdf, GgxBrdf, Settings as FitSettings, fit};
use arealight_oracle::cubature::{Region, Settings};
use arealight_oracle::ggx::Ggx;
use arealight_oracle::polygon::transformed_form_factor;
use arealight_oracle::shading::lobe_integrals;
use arealight_table::ggx;
use glam::DVec3;
use std::sync::LazyLock;

static CASES: LazyLock<Vec<Case>> = LazyLock::new(|| cases(COUNT, SEED, &|| {}));

#[test]
fn it_is_better_than_the_published_table_at_every_reflectance() {
    for ((ours, published), f0) in
        measure(&ggx(), Rung::default(), &CASES).iter().zip(&PUBLISHED).zip(REFLECTANCES)
    {
        assert_eq!((ours.f0, published.f0), (f0, f0));
        assert!(ours.mean < published.mean && ours.max < published.max, "{ours:?} {published:?}");
    }
}

#[test]
fn the_measure_sees_a_lobe_that_is_too_wide() {
    let table = ggx();
    let widened = measure_lookup(
        |roughness, cos_view| table.lookup(1.1 * roughness, cos_view),
        Rung::default(),
        &CASES,
    );
    assert!(widened.iter().zip(&PUBLISHED).any(|(ours, published)| ours.mean > published.mean));
}

#[test]
fn its_albedos_are_true_at_its_nodes() {
    let table = ggx();
    let size = table.size();
    let region = Region::sphere().clipped(DVec3::Z);
    let settings = Settings { relative_tolerance: 1e-5, max_evaluations: 2_000_000 };
    for (x, y) in [(4, 5), (20, 20), (20, 62), (40, 0), (40, 50), (63, 30), (63, 62)] {
        let (roughness, cos_view) = LightTable::node(size, x, y);
        let lobe = Ggx { alpha: roughness * roughness };
        let truth = lobe_integrals(lobe, view_direction(cos_view), &region, &settings).value;
        let texel = table.magnitude()[(y * size + x) as usize].map(f64::from);
        for i in 0..2 {
            // Both integrals' errors, and float32
            assert!((texel[i] - truth[i]).abs() < 1e-5, "({x}, {y}): {texel:?} {truth:?}");
        }
    }
}

#[test]
fn its_albedos_are_near_between_nodes() {
    let table = ggx();
    let worst = |rows: &mut dyn Iterator<Item = f64>| {
        let mut worst = 0.0_f64;
        for y in rows {
            for x in 0..126 {
                let roughness = (0.5 + f64::from(x)) / 126.0;
                let cos_view = 1.0 - (y / 63.0).powi(2);
                let alpha = (roughness * roughness).max(arealight::MIN_ALPHA);
                let (ours, truth) = (table.lookup(roughness, cos_view), GgxBrdf.magnitude(alpha, cos_view));
                worst = worst.max((ours.albedo - truth.albedo).abs());
                worst = worst.max((ours.schlick - truth.schlick).abs());
            }
        }
        worst
    };
    let middles = |first: i32, last: i32| (first..last).map(|y| f64::from(y) + 0.5);
    // Up to a view of 85 degrees
    let steep = worst(&mut middles(0, 60));
    assert!(steep < 2e-3, "{steep}");
    // The albedo of a narrow lobe dips by a tenth where the cosine of the view is about alpha. The last rows hold
    // all of that for alpha below 0.1: no table of this size can follow
    let grazing = worst(&mut middles(60, 63));
    assert!((2e-3..0.09).contains(&grazing), "{grazing}");
}

#[test]
fn its_lobes_integrate_to_one() {
    // Six faces of a box around the point hold every direction
    let table = ggx();
    let corner = |i: usize, s: f64| {
        let axis = DVec3::AXES[i];
        let (u, v) = (DVec3::AXES[(i + 1) % 3], DVec3::AXES[(i + 2) % 3]);
        let face = [axis - u - v, axis + u - v, axis + u + v, axis - u + v].map(|p| p * s);
        // The front of each face towards the point: the order of those on the positive axes turns
        if s > 0.0 { [face[3], face[2], face[1], face[0]] } else { face }
    };
    for (roughness, cos_view) in [(0.02, 0.9), (0.1, 0.3), (0.5, 0.05), (0.8, 1.0), (1.0, 0.0)] {
        let sample = table.lookup(roughness, cos_view);
        let sum: f64 = (0..3)
            .flat_map(|i| [corner(i, 1.0), corner(i, -1.0)])
            .map(|face| transformed_form_factor(&sample.inverse, &face))
            .sum();
        assert!((sum.abs() - 1.0).abs() < 1e-9, "{roughness} {cos_view}: {sum}");
    }
}

#[test]
fn it_is_what_the_fitter_makes() {
    let (checked_in, fitted) = (ggx(), fit(&GgxBrdf, &FitSettings::default(), &|_, _| {}).unwrap());
    assert_eq!(checked_in.description(), fitted.description());
    let matrices = |table: &LightTable| [table.matrix(), table.schlick_matrix().unwrap()].concat();
    let (ours, theirs) = (matrices(&checked_in).into_flattened(), matrices(&fitted).into_flattened());
    let difference = ours.iter().zip(&theirs).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    // Bit for bit on the machine that made it; another one's sines and powers may differ in their last bits,
    // which stops some texel's descent a step earlier
    assert!(difference < 1e-3, "{difference}");
    for (a, b) in checked_in.magnitude().iter().zip(fitted.magnitude()) {
        assert!((a[0] - b[0]).abs().max((a[1] - b[1]).abs()) < 1e-6, "{a:?} {b:?}");
    }
}
