//! The oracle against the reference: shading points whose radiance another program found by cubature.

use arealight_oracle::answers::read_answers;
use arealight_oracle::cases::{Case, SupportedCase, read_cases};
use arealight_oracle::cubature::Settings;
use arealight_oracle::measure::{Family, relative_error};
use arealight_oracle::shading::truth;

fn read(file: &str) -> String {
    let path = format!("{}/../../tests/data/reference/{file}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn cases() -> Vec<Case> {
    read_cases(&read("cases.json")).unwrap()
}

fn supported() -> Vec<(Family, SupportedCase)> {
    cases().iter().filter_map(|case| Some((Family::of(case), case.supported().ok()?))).collect()
}

fn known(name: &str) -> [f64; 3] {
    let answers = read_answers(&read("truth.json")).unwrap();
    answers.into_iter().find(|answer| answer.name == name).and_then(|answer| answer.radiance).unwrap()
}

fn answer(case: &SupportedCase) -> [f64; 3] {
    truth(&case.surface, case.normal, case.view, &case.light, &Settings::default()).radiance.to_array()
}

#[test]
fn every_untextured_polygon_case_with_an_isotropic_lobe_is_supported() {
    let mut counts = std::collections::BTreeMap::new();
    for case in cases() {
        let (yes, no) = counts.entry(Family::of(&case).to_string()).or_insert((0, 0));
        *if case.supported().is_ok() { yes } else { no } += 1;
    }
    assert_eq!(counts.values().map(|(yes, no)| yes + no).sum::<i32>(), 176);
    assert_eq!(counts["polygon, ggx"], (50, 0));
    assert_eq!(counts["polygon, ggx + diffuse"], (10, 0));
    assert_eq!(counts["polygon, diffuse"], (10, 0));
    assert_eq!(counts["textured polygon, ggx"].0, 0);
    assert_eq!(counts.values().map(|(yes, _)| yes).sum::<i32>(), 70);
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
