//! Anisotropic GGX: the truth against the reference, and the fitted lobes against the truth.

use crate::read;
use arealight::{Horizon, LightTable, Quality, SpecularLobes};
use arealight_cases::answers::read_answers;
use arealight_cases::cases::{SupportedCase, read_cases};
use arealight_cases::measure::relative_error;
use arealight_oracle::cubature::Settings;
use arealight_oracle::material::{Anisotropy, Surface};
use arealight_oracle::shading::{ltc_on, truth};
use glam::DVec3;
use std::sync::LazyLock;

static TABLE: LazyLock<LightTable> = LazyLock::new(LightTable::ggx);

/// The cases of a family, each with the radiance that is known of it.
fn known(family: &str) -> Vec<(SupportedCase, DVec3)> {
    let answers = read_answers(&read("anisotropy-truth.json")).unwrap();
    let cases = read_cases(&read("anisotropy.json")).unwrap();
    let cases = cases.iter().filter(|case| case.name.contains(family));
    cases
        .map(|case| {
            let answer = answers.iter().find(|answer| answer.name == case.name).unwrap();
            (case.supported(|path| panic!("{path}")).unwrap(), answer.radiance.unwrap().into())
        })
        .collect()
}

/// A surface with its anisotropy changed.
fn changed(surface: &Surface, change: impl Fn(Anisotropy) -> Option<Anisotropy>) -> Surface {
    Surface { anisotropy: change(surface.anisotropy.unwrap()), ..*surface }
}

#[test]
fn truth_agrees_with_the_reference() {
    let cases = known("aniso");
    assert_eq!(cases.len(), 20);
    let error = |(case, known): &(SupportedCase, DVec3), surface: &Surface| {
        let found = truth(surface, case.normal, case.view, &case.light, &Settings::default());
        relative_error(found.radiance.into(), (*known).into())
    };
    for case in &cases {
        let error = error(case, &case.0.surface);
        // Both programs integrate adaptively; the reference's own estimates reach 7e-7
        assert!(error < 1e-5, "{}: {error:e}", case.0.name);
    }
    // The twin: with a hundredth more along the tangent no case agrees
    let stretched = |case: &&(SupportedCase, DVec3)| {
        let surface =
            changed(&case.0.surface, |given| Some(Anisotropy { alpha: 1.01 * given.alpha, ..given }));
        error(case, &surface) > 1e-5
    };
    assert_eq!(cases.iter().filter(stretched).count(), 20);
}

/// Mean error of a light of unit radiance, over cases and channels.
fn unit_error(family: &str, quality: Quality, change: impl Fn(Anisotropy) -> Option<Anisotropy>) -> f64 {
    let cases = known(family);
    let count = 3.0 * cases.len() as f64;
    let error = |(case, known): &(SupportedCase, DVec3)| {
        let surface = changed(&case.surface, &change);
        let answer = ltc_on(quality, &TABLE, &surface, case.normal, case.view, &case.light);
        ((answer - *known) / case.light.radiance).abs().element_sum()
    };
    cases.iter().map(error).sum::<f64>() / count
}

#[test]
fn the_fitted_lobes_are_near_the_truth() {
    for horizon in [Horizon::Cosine, Horizon::Both] {
        let quality = Quality { horizon, ..Quality::default() };
        // Twice what the closed form with exact albedos gives: 8.8e-3 and 1.2e-3
        for (family, bound) in [("aniso_metal", 17.6e-3), ("aniso_dielectric", 2.4e-3)] {
            let unit = unit_error(family, quality, Some);
            println!("{family}, {horizon:?}: mean unit error {unit:.2e}");
            assert!(unit < bound, "{family}: {unit:e}");
            // The twin: one alpha in the place of two
            let isotropic = unit_error(family, quality, |_| None);
            assert!(isotropic > 2.0 * unit, "{family}: {isotropic:e} against {unit:e}");
        }
    }
}

#[test]
fn half_vectors_are_nearer_by_far() {
    let quality = Quality { specular_lobes: SpecularLobes::HalfVectors, ..Quality::default() };
    // 1.2 times what was measured
    for (family, bound) in [("aniso_metal", 2.4e-3), ("aniso_dielectric", 0.4e-3)] {
        let unit = unit_error(family, quality, Some);
        println!("{family}: mean unit error {unit:.2e}");
        assert!(unit < bound, "{family}: {unit:e}");
        // The twins: the fitted lobes, and one alpha in the place of two
        assert!(unit_error(family, Quality::default(), Some) > 3.0 * bound, "{family}");
        assert!(unit_error(family, quality, |_| None) > 3.0 * bound, "{family}");
    }
}
