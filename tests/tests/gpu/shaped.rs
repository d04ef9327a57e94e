//! Lights with a profile on the GPU: known radiance, the float64 twin, and where they are hard.

use arealight::Profile;
use arealight_cases::answers::read_answers;
use arealight_cases::cases::{SupportedCase, read_cases};
use arealight_oracle::shading::ltc_on;
use arealight_tests::prelude::*;

fn read(name: &str) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/data/reference/");
    std::fs::read_to_string(format!("{folder}{name}")).unwrap()
}

/// The profile of a case on other levels.
fn on_levels(profile: &Profile, levels: u32) -> Profile {
    Profile::new(profile.pairs(), levels).unwrap()
}

fn case_point(case: &SupportedCase, profile: Option<Profile>) -> EvalPoint {
    let light = Light {
        shape: LightShape::Polygon(case.light.vertices.clone()),
        radiance: case.light.radiance.as_vec3(),
        profile,
        ..Light::default()
    };
    EvalPoint { surface: case.surface, position: DVec3::ZERO, normal: case.normal, view: case.view, light }
}

fn twin(quality: Quality, given: &EvalPoint) -> DVec3 {
    let light = RelativeLight::new(&given.light, given.position);
    ltc_on(quality, &LightTable::ggx(), &given.surface, given.normal, given.view, &light)
}

/// The root of the mean squared difference of the first channels, in parts of the mean truth.
fn error(answers: &[f64], exact: &[f64], truth: &[f64]) -> f64 {
    let squares: f64 = answers.iter().zip(exact).map(|(a, b)| (a - b) * (a - b)).sum();
    (squares / answers.len() as f64).sqrt() / (truth.iter().sum::<f64>() / truth.len() as f64)
}

#[test]
fn known_radiance_is_met_by_few_levels() {
    let Some(engine) = TestEngine::new() else { return };
    let truths = read_answers(&read("emission-truth.json")).unwrap();
    let cases = read_cases(&read("emission.json")).unwrap();
    // Of GGX one case is nearly all of it: a batwing's ring twice as wide as the lobe, near and bright
    for (material, bounds) in [("diffuse", [0.016, 0.01, 0.006]), ("ggx", [0.25, 0.18, 0.11])] {
        let cases: Vec<(SupportedCase, f64)> = cases
            .iter()
            .zip(&truths)
            .filter(|(case, _)| case.name.ends_with(material))
            .map(|(case, truth)| (case.supported(|_| unreachable!()).unwrap(), truth.radiance.unwrap()[0]))
            .collect();
        let truth: Vec<f64> = cases.iter().map(|(_, truth)| *truth).collect();
        // The lobes' own answers: what the fit makes of it is not the profile's error
        let exact: Vec<f64> = cases
            .iter()
            .map(|(case, _)| {
                let profile = on_levels(case.light.profile.as_ref().unwrap(), Profile::MAX_LEVELS);
                twin(Quality::default(), &case_point(case, Some(profile))).x
            })
            .collect();
        if material == "diffuse" {
            let fit = error(&exact, &truth, &truth);
            assert!(fit < 2e-3, "Lambert's lobe is exact: {fit}");
        }
        let by = |levels| {
            let points: Vec<EvalPoint> = cases
                .iter()
                .map(|(case, _)| {
                    case_point(case, Some(on_levels(case.light.profile.as_ref().unwrap(), levels)))
                })
                .collect();
            let answers = engine.eval(&points, Quality::default()).unwrap();
            answers.iter().map(|answer| f64::from(answer.x)).collect::<Vec<f64>>()
        };
        for (levels, bound) in [4, 6, 8].into_iter().zip(bounds) {
            let found = error(&by(levels), &exact, &truth);
            println!("{material}, {levels} levels: {found:.5}");
            assert!(found < bound, "{material}, {levels} levels: {found}");
        }
        // The twin: the profile at one direction, that of the light's middle
        let plain: Vec<EvalPoint> = cases.iter().map(|(case, _)| case_point(case, None)).collect();
        let answers = engine.eval(&plain, Quality::default()).unwrap();
        let one: Vec<f64> = answers
            .iter()
            .zip(&plain)
            .zip(&cases)
            .map(|((answer, given), (case, _))| {
                let [center, normal] = [given.light.shape.center(), given.light.shape.area_vector()];
                let cosine = -center.dot(normal) / (center.length() * normal.length());
                f64::from(answer.x) * case.light.profile.as_ref().unwrap().factor(cosine)
            })
            .collect();
        let found = error(&one, &exact, &truth);
        println!("{material}, one direction: {found:.3}");
        assert!(found > 0.2, "{material}, one direction: {found}");
    }
}

/// A spot, a flood, a batwing, and a profile that ends at once.
fn profiles(levels: u32) -> [Profile; 4] {
    let profile = |pairs: &[[f64; 2]]| Profile::new(pairs, levels).unwrap();
    [
        profile(&[[0.0, 1.0], [18.0, 1.0], [32.0, 0.0]]),
        profile(&[[0.0, 1.0], [37.0, 1.0], [60.0, 0.0]]),
        profile(&[[0.0, 0.5], [20.0, 0.7], [40.0, 1.0], [70.0, 0.1], [90.0, 0.0]]),
        profile(&[[0.0, 1.0], [45.0, 1.0]]),
    ]
}

/// Points under convex outlines of 3 to 8 vertices about as large as they are far: above, across and below
/// the horizons, every third with two sides.
fn points(seed: u64, surface: &Surface, count: usize) -> Vec<EvalPoint> {
    let mut random = Random::new(seed);
    let profiles = profiles(4);
    let one = |index: usize| {
        let cos_view = random.between(0.0, 1.0);
        let view = DVec3::new((1.0 - cos_view * cos_view).sqrt(), 0.0, cos_view);
        let size = random.between(0.1, 2.0);
        // Of one radius, so that it is convex
        let center = random.direction();
        let vertices = random.polygon(center, 3 + index % 6, size, size * (1.0 + 1e-12));
        let mut given = point(*surface, view, vertices, index.is_multiple_of(3));
        given.light.profile = Some(profiles[index % 4].clone());
        given
    };
    (0..count).map(one).collect()
}

#[test]
fn rings_follow_their_float64_twin() {
    let Some(engine) = TestEngine::new() else { return };
    for (surface, bound) in [(lambert_surface(), 2e-3), (glossy_surface(0.2), 1.5e-2)] {
        for quality in [Quality::default(), Quality { horizon: Horizon::Both, ..Quality::default() }] {
            let points = points(1, &surface, 2000);
            let answers = engine.eval(&points, quality).unwrap();
            let mut comparison = Comparison::new(format!("{quality:?}, {}", surface.alpha));
            for (index, (given, answer)) in points.iter().zip(&answers).enumerate() {
                let expected = twin(quality, given);
                // Chords of a rim have its area, not its place: Lambert's lobe sees little of that
                comparison.add_color(*answer, expected, bound, || format!("point {index}: {given:?}"));
            }
            comparison.assert_all();
        }
    }
}
