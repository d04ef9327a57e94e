//! Points in a medium: the truth against the reference.

use arealight_cases::answers::read_answers;
use arealight_cases::cases::read_cases;
use arealight_cases::measure::relative_error;
use arealight_oracle::cubature::Settings;
use arealight_oracle::shading::{in_scattered_truth, shape_in_scattered_truth};

#[test]
fn the_truth_of_media_agrees_with_the_reference() {
    let read = |file: &str| {
        let path = format!("{}/../../tests/data/reference/{file}", env!("CARGO_MANIFEST_DIR"));
        std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
    };
    let known = read_answers(&read("media-truth.json")).unwrap();
    let cases = read_cases(&read("media.json")).unwrap();
    assert_eq!(cases.len(), 59);
    let settings = Settings { relative_tolerance: 1e-4, ..Settings::default() };
    // How many are off by more than the reference says of itself
    let differing = |grown: f64| {
        let differs = |(case, known): (&_, &arealight_cases::answers::Answer)| {
            let case: &arealight_cases::cases::Case = case;
            let found = case.supported(|path| panic!("{path}")).unwrap();
            let (g, view, light) = (found.medium.unwrap() * grown, found.view, &found.light);
            let truth = found.polygon().map(|light| in_scattered_truth(g, view, &light, &settings));
            let truth = truth.or_else(|| shape_in_scattered_truth(g, view, light, &settings)).unwrap();
            assert_eq!(case.name, known.name);
            relative_error(truth.radiance.into(), known.radiance.unwrap()) > 1e-3
        };
        cases.iter().zip(&known).filter(|pair| differs(*pair)).count()
    };
    assert_eq!(differing(1.0), 0);
    // The twin: a hundredth more of g
    assert!(differing(1.01) > 30);
}
