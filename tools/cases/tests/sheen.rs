//! Sheen: the truth against the reference, and the fitted lobe against both.

use arealight::LightTable;
use arealight_cases::answers::read_answers;
use arealight_cases::cases::{Case, CaseMaterial, read_cases};
use arealight_cases::measure::relative_error;
use arealight_oracle::cubature::{Region, Settings, angles};
use arealight_oracle::frame::SurfaceFrame;
use arealight_oracle::ggx::Ggx;
use arealight_oracle::material::{Sheen, Surface};
use arealight_oracle::shading::{RelativeLight, ltc, truth};
use arealight_oracle::sheen::Charlie;
use glam::DVec3;
use std::f64::consts::PI;
use std::sync::LazyLock;

static TABLE: LazyLock<LightTable> = LazyLock::new(arealight_table::ggx);

fn read(file: &str) -> String {
    let path = format!("{}/../../tests/data/reference/{file}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// A case of the reference with the radiance that is known of it.
struct Known {
    name: String,
    has_base: bool,
    surface: Surface,
    normal: DVec3,
    view: DVec3,
    light: RelativeLight,
    /// Of light of unit radiance: what glTF's coupling of the Lambert lobe to the Fresnel term takes away, below the sheen.
    coupling: DVec3,
    radiance: DVec3,
}

/// What glTF's Lambert lobe below a Fresnel term reflects less than the bare one, which these surfaces have, of a light of
/// unit radiance: albedo (F0 + (1 - F0) (1 - v.h)^5) / pi instead of nothing, times what sheen leaves.
fn coupling(surface: &Surface, normal: DVec3, view: DVec3, light: &RelativeLight) -> DVec3 {
    let frame = SurfaceFrame::new(normal, view);
    let vertices: Vec<DVec3> = light.vertices.iter().map(|v| frame.to_surface(*v)).collect();
    let region = Region::polygon(&vertices).clipped(DVec3::Z);
    let [cosine, weighted] = region
        .integrate(&Settings::default(), angles, |light| {
            let cosine = light.z.max(0.0) / PI;
            [cosine, cosine * Ggx::schlick_weight(frame.view(), light)]
        })
        .value;
    let sheen = surface.sheen.unwrap();
    let left = sheen.left_below(Charlie { roughness: sheen.roughness }.albedo(frame.cos_view()));
    surface.diffuse_albedo * (surface.f0 * cosine + (DVec3::ONE - surface.f0) * weighted) * left
}

fn known() -> Vec<Known> {
    let answers = read_answers(&read("sheen-truth.json")).unwrap();
    let cases = read_cases(&read("sheen.json")).unwrap();
    let one = |mut case: Case| {
        let has_base = match &mut case.material {
            CaseMaterial::Sheen(_) => false,
            // The library's Lambert lobe stands alone
            CaseMaterial::Ggx { coupled, sheen: Some(_), .. } => {
                *coupled = false;
                true
            }
            _ => panic!("{case:?}"),
        };
        let radiance = answers.iter().find(|answer| answer.name == case.name).unwrap().radiance.unwrap();
        let case = case.supported(|path| panic!("{path}")).unwrap();
        Known {
            has_base,
            coupling: coupling(&case.surface, case.normal, case.view, &case.light),
            name: case.name,
            surface: case.surface,
            normal: case.normal,
            view: case.view,
            light: case.light,
            radiance: radiance.into(),
        }
    };
    let known: Vec<Known> = cases.into_iter().map(one).collect();
    assert_eq!((known.len(), known.iter().filter(|case| case.has_base).count()), (12, 6));
    known
}

impl Known {
    /// An answer of the library, with glTF's base in place of its own.
    fn with_gltf_base(&self, answer: DVec3) -> DVec3 {
        answer - self.light.radiance * self.coupling
    }

    fn truth(&self, surface: &Surface) -> DVec3 {
        truth(surface, self.normal, self.view, &self.light, &Settings::default()).radiance
    }

    fn with_sheen(&self, change: impl Fn(Sheen) -> Sheen) -> Surface {
        Surface { sheen: self.surface.sheen.map(change), ..self.surface }
    }
}

#[test]
fn truth_agrees_with_the_reference() {
    let cases = known();
    let error = |case: &Known, surface: &Surface| {
        relative_error(case.with_gltf_base(case.truth(surface)).into(), case.radiance.into())
    };
    for case in &cases {
        let error = error(case, &case.surface);
        // The albedo's own rule, by which the base is weighed, is good to 1e-4
        assert!(error < if case.has_base { 1e-4 } else { 1e-6 }, "{}: {error:e}", case.name);
    }
    // The twin: with sheen a little rougher no case agrees
    let rougher = |sheen: Sheen| Sheen { roughness: sheen.roughness * 1.02, ..sheen };
    let noticed = cases.iter().filter(|case| error(case, &case.with_sheen(rougher)) > 1e-4).count();
    assert_eq!(noticed, 12);
}

#[test]
fn the_fitted_lobe_is_within_its_bounds() {
    // Mean error of a light of unit radiance
    let measure = |has_base: bool, answer: &dyn Fn(&Known) -> DVec3| -> f64 {
        let cases: Vec<Known> = known().into_iter().filter(|case| case.has_base == has_base).collect();
        let unit = |case: &Known| (case.with_gltf_base(answer(case)) - case.radiance) / case.light.radiance;
        cases.iter().map(|case| unit(case).abs().element_sum() / 3.0).sum::<f64>() / cases.len() as f64
    };
    // Twice what a lobe fitted at each point has: .65e-3 and 3.7e-3
    for (has_base, bound) in [(false, 1.3e-3), (true, 7.4e-3)] {
        let fitted =
            |surface: Surface, case: &Known| ltc(&TABLE, &surface, case.normal, case.view, &case.light);
        let error = measure(has_base, &|case| fitted(case.surface, case));
        println!("sheen, base {has_base}: mean unit error {error:.2e}");
        assert!(error < bound, "{has_base}: {error:e}");
        // The twin: without sheen, errors are larger
        let without = |sheen: Sheen| Sheen { color: DVec3::ZERO, ..sheen };
        let other = measure(has_base, &|case| fitted(case.with_sheen(without), case));
        assert!(other > 2.0 * error, "{has_base}: {other:e} against {error:e}");
    }
}
