//! The table that is checked in, against the truth.

use arealight::{LightTable, TableDescription};
use arealight_fit::brdf::view_direction;
use arealight_fit::report::{
    COUNT, Case, Level, PUBLISHED, REFLECTANCES, SEED, cases, measure, measure_lookup,
};
use arealight_fit::{Brdf, GgxBrdf, Settings as FitSettings, fit};
use arealight_oracle::cubature::{Region, Settings};
use arealight_oracle::ggx::Ggx;
use arealight_oracle::polygon::transformed_form_factor;
use arealight_oracle::shading::lobe_integrals;
use arealight_table::{Precision, rounded};
use glam::DVec3;
use rayon::prelude::*;
use std::sync::LazyLock;

static CASES: LazyLock<Vec<Case>> = LazyLock::new(|| cases(COUNT, SEED, &|| {}));

#[test]
fn it_is_better_than_the_published_table_at_every_reflectance() {
    for ((ours, published), f0) in
        measure(&LightTable::ggx(), Level::default(), &CASES).iter().zip(&PUBLISHED).zip(REFLECTANCES)
    {
        assert_eq!((ours.f0, published.f0), (f0, f0));
        assert!(ours.mean < published.mean && ours.max < published.max, "{ours:?} {published:?}");
    }
}

#[test]
fn the_measure_sees_a_lobe_that_is_too_wide() {
    let table = LightTable::ggx();
    let widened = measure_lookup(
        |roughness, cos_view| table.lookup(1.1 * roughness, cos_view),
        Level::default(),
        &CASES,
    );
    assert!(widened.iter().zip(&PUBLISHED).any(|(ours, published)| ours.mean > published.mean));
}

#[test]
fn its_albedos_are_true_at_its_nodes() {
    let table = LightTable::ggx();
    let (size, albedos) = (table.size(), table.albedos());
    let region = Region::sphere().clipped(DVec3::Z);
    let settings = Settings { relative_tolerance: 1e-5, max_evaluations: 2_000_000 };
    for (x, y) in [(4, 5), (20, 20), (20, 62), (40, 0), (40, 50), (63, 30), (63, 62)] {
        let (roughness, cos_view) = LightTable::node(size, x, y);
        let lobe = Ggx { alpha: roughness * roughness };
        let truth = lobe_integrals(lobe, view_direction(cos_view), &region, &settings).value;
        let texel = albedos[(y * size + x) as usize].map(f64::from);
        for i in 0..2 {
            // Both integrals' errors, and float32; the last three rows are balanced between their nodes
            let most = if y + 3 < size { 1e-5 } else { 1e-3 };
            assert!((texel[i] - truth[i]).abs() < most, "({x}, {y}): {texel:?} {truth:?}");
        }
    }
}

/// The largest errors of a table's albedo and of that of Schlick's weight, at nodes and between them, over
/// every roughness and view.
fn largest_albedo_errors(table: &LightTable) -> [f64; 2] {
    let steps = |i: u32| f64::from(i) / 126.0;
    let mut roughnesses: Vec<f64> = (0..=126).map(|i| steps(i).max(0.01)).collect();
    // Halfway from the smallest to the second node, and thirds, in case of a beat with the halves above
    roughnesses.extend([0.013, 0.0212, 0.037, 0.0529, 0.0688, 0.1005, 0.1958]);
    let mut cosines: Vec<f64> = (0..=126).map(|j| 1.0 - steps(j).powi(2)).collect();
    // In the last rows, where the dip is narrower than any node: at every scale from 89.9995 to 86 degrees
    cosines.extend((0..60).map(|j| 0.07 * 10.0_f64.powf(-f64::from(j) / 15.0)));
    let errors = roughnesses.par_iter().map(|&roughness| {
        cosines.iter().fold([0.0_f64; 2], |worst, &cos_view| {
            let (ours, truth) =
                (table.lookup(roughness, cos_view), GgxBrdf.magnitude(roughness.powi(2), cos_view));
            let found = [ours.albedo - truth.albedo, ours.schlick - truth.schlick];
            std::array::from_fn(|i| worst[i].max(found[i].abs()))
        })
    });
    errors.reduce(|| [0.0; 2], |a, b| [a[0].max(b[0]), a[1].max(b[1])])
}

#[test]
fn its_albedos_are_near_between_nodes() {
    let table = LightTable::ggx();
    // What the dip's coefficients and the last rows were chosen for; to 89.9 degrees the first is 1.0e-3
    let errors = largest_albedo_errors(&table);
    println!("{errors:?}");
    assert!(errors[0] < 1.45e-3 && errors[1] < 1.65e-3, "{errors:?}");
    // Rounding to float16 adds up to 5e-4 to numbers up to 1, where it matters least
    let errors = largest_albedo_errors(&rounded(&table, Precision::Half).unwrap());
    assert!(errors[0] < 2e-3 && errors[1] < 2.2e-3, "{errors:?}");

    // The twin: the same albedos, interpolated as they are
    let description = TableDescription { ggx_dip: false, ..table.description().clone() };
    let in_range = |[albedo, schlick]: [f32; 2]| {
        let albedo = albedo.clamp(0.0, 1.0);
        [albedo, schlick.clamp(0.0, albedo)]
    };
    let albedos = table.albedos().into_iter().map(in_range).collect();
    let plain = LightTable::new(description, table.size(), table.matrix().to_vec(), albedos).unwrap();
    let errors = largest_albedo_errors(&plain);
    assert!(errors[0] > 0.1 && errors[1] > 0.09, "{errors:?}");
}

#[test]
fn its_lobes_integrate_to_one() {
    // Six faces of a box around the point hold every direction
    let table = LightTable::ggx();
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
    let (checked_in, fitted) =
        (LightTable::ggx(), fit(&GgxBrdf, &FitSettings::default(), &|_, _| {}).unwrap());
    assert_eq!(checked_in.description(), fitted.description());
    let matrices = |table: &LightTable| {
        let pairs = table.pairs().unwrap();
        let of_pairs = pairs.matrices.iter().flatten().copied();
        let shares = pairs.second_shares.iter().map(|shares| [shares[0], shares[1], 0.0, 0.0]);
        let one = [table.matrix(), table.schlick_matrix().unwrap()].concat();
        one.into_iter().chain(of_pairs).chain(shares).collect::<Vec<_>>()
    };
    let (ours, theirs) = (matrices(&checked_in).into_flattened(), matrices(&fitted).into_flattened());
    let difference = ours.iter().zip(&theirs).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    // Bit for bit on the machine that made it; another one's sines and powers may differ in their last bits,
    // which stops some texel's descent a step earlier
    assert!(difference < 1e-3, "{difference}");
    for (a, b) in checked_in.magnitude().iter().zip(fitted.magnitude()) {
        assert!((a[0] - b[0]).abs().max((a[1] - b[1]).abs()) < 1e-6, "{a:?} {b:?}");
    }
}
