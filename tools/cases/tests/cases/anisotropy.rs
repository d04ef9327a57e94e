//! Anisotropic GGX: the truth against the reference, and the fitted lobes against the truth.

use crate::materials::{Known, fitted_on, known_of, noticed, same};
use arealight::{Horizon, Quality, SpecularLobes};
use arealight_oracle::material::{Anisotropy, Surface};

/// The cases of a family, each with the radiance that is known of it.
fn known(family: &str) -> Vec<Known> {
    known_of("anisotropy", |case| case.name.contains(family))
}

/// A surface with its anisotropy changed.
fn changed(surface: &Surface, change: impl Fn(Anisotropy) -> Option<Anisotropy>) -> Surface {
    Surface { anisotropy: change(surface.anisotropy.unwrap()), ..*surface }
}

#[test]
fn truth_agrees_with_the_reference() {
    let cases = known("aniso");
    assert_eq!(cases.len(), 20);
    assert_eq!(noticed(&cases, same), 0);
    // The twin: with a hundredth more along the tangent no case agrees
    let stretched = |given: Anisotropy| Some(Anisotropy { alpha: 1.01 * given.alpha, ..given });
    assert_eq!(noticed(&cases, |surface| changed(surface, stretched)), 20);
}

/// Mean error of a light of unit radiance, over cases and channels.
fn unit_error(family: &str, quality: Quality, change: impl Fn(Anisotropy) -> Option<Anisotropy>) -> f64 {
    fitted_on(quality, &known(family), |surface| changed(surface, &change)).0
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
