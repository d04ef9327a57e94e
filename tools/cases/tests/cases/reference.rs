//! The oracle against the reference: shading points whose radiance another program found by cubature.

use crate::read;
use arealight::LightShape;
use arealight_cases::answers::read_answers;
use arealight_cases::cases::{Case, SupportedCase, read_cases};
use arealight_cases::images::Images;
use arealight_cases::measure::{Family, relative_error};
use arealight_oracle::cubature::Settings;
use arealight_oracle::shading::{shape_truth, truth};
use arealight_oracle::texture::Texture;
use std::path::Path;
use std::sync::{Arc, LazyLock};

fn cases() -> Vec<Case> {
    read_cases(&read("cases.json")).unwrap()
}

fn supported() -> Vec<(Family, SupportedCase)> {
    let supported = |case: &Case| Some((Family::of(case), case.supported(|path| Ok(image(path))).ok()?));
    cases().iter().filter_map(supported).collect()
}

/// The reference's one image.
fn image(path: &str) -> Arc<Texture> {
    static IMAGE: LazyLock<Arc<Texture>> = LazyLock::new(|| {
        let cases = format!("{}/../../tests/data/reference/cases.json", env!("CARGO_MANIFEST_DIR"));
        Images::beside(Path::new(&cases), |_| 1 << 30)
            .load("light.exr")
            .unwrap_or_else(|error| panic!("{error}"))
    });
    assert_eq!(path, "light.exr");
    Arc::clone(&IMAGE)
}

fn known(name: &str) -> [f64; 3] {
    let answers = read_answers(&read("truth.json")).unwrap();
    answers.into_iter().find(|answer| answer.name == name).and_then(|answer| answer.radiance).unwrap()
}

fn answer(case: &SupportedCase) -> [f64; 3] {
    let SupportedCase { surface, normal, view, light, .. } = case;
    let settings = &Settings::default();
    let found = case.polygon().map(|light| truth(surface, *normal, *view, &light, settings));
    let found = found.or_else(|| shape_truth(surface, *normal, *view, light, settings));
    found.unwrap().radiance.to_array()
}

#[test]
fn every_case_is_supported() {
    let mut counts = std::collections::BTreeMap::new();
    for case in cases() {
        let (yes, no) = counts.entry(Family::of(&case).to_string()).or_insert((0, 0));
        *if case.supported(|path| Ok(image(path))).is_ok() { yes } else { no } += 1;
    }
    assert_eq!(counts.values().map(|(yes, no)| yes + no).sum::<i32>(), 176);
    assert_eq!(counts["polygon, ggx"], (50, 0));
    assert_eq!(counts["polygon, ggx + diffuse"], (10, 0));
    assert_eq!(counts["polygon, diffuse"], (10, 0));
    assert_eq!(counts["textured polygon, ggx"], (10, 0));
    assert_eq!(counts.values().map(|(yes, _)| yes).sum::<i32>(), 176);
}

#[test]
fn truth_agrees_with_the_reference() {
    let errors = supported()
        .into_iter()
        .map(|(_, case)| (relative_error(answer(&case), known(&case.name)), case.name));
    let mut errors: Vec<(f64, String)> = errors.collect();
    errors.sort_by(|a, b| b.0.total_cmp(&a.0));
    println!("{} cases, worst: {:.2e} in {}", errors.len(), errors[0].0, errors[0].1);
    // Both programs integrate adaptively; the reference's own estimates reach 1e-5
    assert!(errors[0].0 < 1e-4, "{:?}", errors[0]);
}

#[test]
fn truth_of_shapes_agrees_with_the_reference() {
    let shapes = supported().into_iter().map(|(_, case)| case).filter(|case| case.polygon().is_none());
    let cases: Vec<SupportedCase> = shapes.collect();
    assert_eq!(cases.len(), 80);
    let error = |case: &SupportedCase| relative_error(answer(case), known(&case.name));
    let worst =
        cases.iter().map(|case| (error(case), &case.name)).max_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
    println!("{} cases, worst: {:.2e} in {}", cases.len(), worst.0, worst.1);
    // As polygons: both programs integrate adaptively
    assert!(worst.0 < 1e-4, "{worst:?}");
    // The twin: a shape that is larger by a thousandth is noticed where it is seen whole
    let grown = cases.into_iter().map(|mut case| {
        case.light.shape = match case.light.shape.clone() {
            LightShape::Disk { center, axis_u, axis_v } => {
                LightShape::Disk { center, axis_u: axis_u * 1.001, axis_v: axis_v * 1.001 }
            }
            LightShape::Sphere { center, radius } => LightShape::Sphere { center, radius: radius * 1.001 },
            LightShape::Tube { p0, p1, radius, ends } => {
                LightShape::Tube { p0, p1, radius: radius * 1.001, ends }
            }
            polygonal => polygonal,
        };
        case
    });
    let noticed = grown.filter(|case| error(case) > 1e-4).count();
    assert!(noticed > 60, "only {noticed} of 70 cases notice");
}

#[test]
fn a_slightly_wrong_lobe_does_not_agree() {
    // The twin: one percent of alpha is a hundred times the bound
    let changed =
        supported().into_iter().filter(|(family, _)| family.material == "ggx").map(|(_, mut case)| {
            case.surface.alpha *= 0.99;
            relative_error(answer(&case), known(&case.name))
        });
    let wrong = changed.filter(|error| *error > 1e-4).count();
    assert!(wrong > 45, "only {wrong} of 50 cases notice");
}

#[test]
fn an_image_upside_down_does_not_agree() {
    // The twin for textured lights
    let turned = supported().into_iter().filter(|(family, _)| family.textured).map(|(_, mut case)| {
        if let Some(texture) = &mut case.image {
            let (width, height) = (texture.width(), texture.height());
            let flipped = Texture::from_fn(width, height, |column, row| {
                texture.texels()[(height - 1 - row) * width + column]
            });
            *texture = Arc::new(flipped);
        }
        relative_error(answer(&case), known(&case.name))
    });
    assert!(turned.clone().count() > 12);
    assert!(turned.min_by(f64::total_cmp).unwrap() > 1e-3, "a case does not notice");
}
