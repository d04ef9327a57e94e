//! Clear coats: the truth against the reference, and the fitted lobe against the truth.

use arealight::LightTable;
use arealight_cases::answers::read_answers;
use arealight_cases::cases::{Case, CaseMaterial, read_cases};
use arealight_cases::measure::relative_error;
use arealight_oracle::cubature::{Region, Settings, angles};
use arealight_oracle::frame::SurfaceFrame;
use arealight_oracle::ggx::Ggx;
use arealight_oracle::material::{Coat, Surface};
use arealight_oracle::shading::{RelativeLight, ltc, truth};
use glam::DVec3;
use std::f64::consts::PI;
use std::sync::LazyLock;

static TABLE: LazyLock<LightTable> = LazyLock::new(arealight_table::ggx);

fn read(file: &str) -> String {
    let path = format!("{}/../../tests/data/reference/{file}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// A case of the reference whose layers are weighted as in glTF, with the radiance that is known of it.
struct Known {
    name: String,
    surface: Surface,
    normal: DVec3,
    view: DVec3,
    light: RelativeLight,
    /// Of light of unit radiance: what glTF's coupling of the Lambert lobe to the Fresnel term takes away.
    coupling: DVec3,
    radiance: DVec3,
}

/// What glTF's Lambert lobe below a Fresnel term reflects less than the bare one, which the library has, of a light of
/// unit radiance: albedo (F0 + (1 - F0) (1 - v.h)^5) / pi instead of nothing.
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
    surface.diffuse_albedo * (surface.f0 * cosine + (DVec3::ONE - surface.f0) * weighted)
}

/// The cases of glTF's layering. Others weight a coat by its albedo.
fn known() -> Vec<Known> {
    let answers = read_answers(&read("coat-truth.json")).unwrap();
    let cases = read_cases(&read("coat.json")).unwrap();
    assert_eq!(cases.len(), 14);
    let one = |mut case: Case| {
        let CaseMaterial::Ggx { coupled, coat: Some(coat), .. } = &mut case.material else {
            panic!("{case:?}")
        };
        if coat.by_albedo {
            return None;
        }
        // The library's Lambert lobe stands alone
        *coupled = false;
        let radiance = answers.iter().find(|answer| answer.name == case.name).unwrap().radiance.unwrap();
        let case = case.supported(|path| panic!("{path}")).unwrap();
        Some(Known {
            coupling: coupling(&case.surface, case.normal, case.view, &case.light),
            name: case.name,
            surface: case.surface,
            normal: case.normal,
            view: case.view,
            light: case.light,
            radiance: radiance.into(),
        })
    };
    let known: Vec<Known> = cases.into_iter().filter_map(one).collect();
    assert_eq!(known.len(), 9);
    known
}

impl Known {
    /// An answer of the library, with glTF's base in place of its own.
    fn with_gltf_base(&self, answer: DVec3) -> DVec3 {
        let cos_view = SurfaceFrame::new(self.normal, self.view).cos_view();
        let share = self.surface.coat.unwrap().share(cos_view);
        answer - self.light.radiance * (1.0 - share) * self.coupling
    }

    fn truth(&self, surface: &Surface) -> DVec3 {
        truth(surface, self.normal, self.view, &self.light, &Settings::default()).radiance
    }
}

#[test]
fn truth_agrees_with_the_reference() {
    let cases = known();
    for case in &cases {
        let error =
            relative_error(case.with_gltf_base(case.truth(&case.surface)).into(), case.radiance.into());
        // Both programs integrate adaptively; the reference's own estimates reach 7e-7
        assert!(error < 1e-5, "{}: {error:e}", case.name);
    }
    // The twin: without the coat, or with a little more of it, no case agrees
    let noticed = |by: f64| {
        let is_noticed = |case: &&Known| {
            let coat = case.surface.coat.map(|coat| Coat { weight: coat.weight * by, ..coat });
            let answer = case.truth(&Surface { coat, ..case.surface });
            relative_error(case.with_gltf_base(answer).into(), case.radiance.into()) > 1e-5
        };
        cases.iter().filter(is_noticed).count()
    };
    assert_eq!((noticed(0.0), noticed(1.01)), (9, 9));
}

#[test]
fn the_fitted_coat_is_as_near_to_the_truth_as_other_fitted_lobes() {
    // Mean error of a light of unit radiance, and RMSE over mean, over cases and channels
    let measure = |answer: &dyn Fn(&Known) -> DVec3| {
        let cases = known();
        let count = 3.0 * cases.len() as f64;
        let (mut unit, mut square, mut mean) = (0.0, 0.0, 0.0);
        for case in &cases {
            let difference = case.with_gltf_base(answer(case)) - case.radiance;
            unit += (difference / case.light.radiance).abs().element_sum() / count;
            square += difference.length_squared() / count;
            mean += case.radiance.element_sum() / count;
        }
        (unit, square.sqrt() / mean)
    };
    let (unit, relative) = measure(&|case| ltc(&TABLE, &case.surface, case.normal, case.view, &case.light));
    println!("coat: mean unit error {unit:.2e}, RMSE over mean {relative:.3}");
    // Twice what the same layers give with a lobe fitted at each point: 2.4e-3 and .12
    assert!(unit < 4.8e-3 && relative < 0.24, "{unit:e}, {relative}");
    // The twin: a coat of another roughness is farther away
    let (rough, _) = measure(&|case| {
        let coat = case.surface.coat.map(|coat| Coat { alpha: (3.0 * coat.alpha).min(1.0), ..coat });
        ltc(&TABLE, &Surface { coat, ..case.surface }, case.normal, case.view, &case.light)
    });
    assert!(rough > 2.0 * unit, "{rough:e} against {unit:e}");
}
