//! The phase function's lobes that are built in, against the fitter and the truth.

use arealight_fit::phase;
use arealight_oracle::phase::{MAX_ANISOTROPY, PhaseFit, henyey_greenstein};
use std::f64::consts::PI;
use std::path::Path;

/// |g|, and the error that the documents state.
const ERRORS: [(f64, f64); 7] =
    [(0.1, 0.0009), (0.3, 0.0062), (0.5, 0.0091), (0.7, 0.006), (0.8, 0.0053), (0.9, 0.0106), (0.95, 0.0295)];

fn difference(a: &PhaseFit, b: &PhaseFit) -> f64 {
    let numbers = |fit: &PhaseFit| -> Vec<f64> {
        fit.pieces.iter().flat_map(|p| [p.stretch.concat(), p.weight.concat()].concat()).collect()
    };
    numbers(a).iter().zip(numbers(b)).map(|(a, b)| (a - b).abs() / b.abs().max(1.0)).fold(0.0, f64::max)
}

#[test]
fn it_is_what_the_fitter_makes_and_what_is_printed() {
    let fitted = phase::fit();
    // Another machine's powers may differ in the last bit, which the steps' ends amplify
    assert!(difference(&fitted, &PhaseFit::HG) < 1e-3, "{}{}", phase::rust(&fitted), phase::glsl(&fitted));
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let holds = |file: &str, text: &str| {
        words(&std::fs::read_to_string(root.join(file)).unwrap()).contains(&words(text))
    };
    let glsl = "shaders/include/arealight/lobes/phase.glsl";
    assert!(holds("crates/arealight-oracle/src/phase.rs", &phase::rust(&PhaseFit::HG)));
    assert!(holds(glsl, &phase::glsl(&PhaseFit::HG)));
    // The twin: one digit of one coefficient
    let mut other = PhaseFit::HG;
    other.pieces[1].weight[2][0] += 1e-4;
    assert!(!holds(glsl, &phase::glsl(&other)) && difference(&other, &PhaseFit::HG) > 1e-6);
}

#[test]
fn rayleighs_is_half_of_each_of_two() {
    let error = |g: f64| {
        let halves = [g, -g].map(|g| PhaseFit::HG.lobes(g));
        let at = |k: i32| (f64::from(k) + 0.5) / 1000.0 - 1.0;
        let rayleigh = |mu: f64| 3.0 / (16.0 * PI) * (1.0 + mu * mu);
        let off = |mu: f64| 0.5 * (halves[0].density(mu) + halves[1].density(mu)) - rayleigh(mu);
        (0..2000).map(|k| off(at(k)).abs()).sum::<f64>() * 2.0 * PI / 1000.0
    };
    // docs/media.md; the twins, other g
    assert!((error(0.32) - 0.0274).abs() < 2e-4 && error(0.3) > error(0.32) && error(0.35) > error(0.32));
}

#[test]
fn its_error_is_as_stated_and_it_is_nowhere_negative() {
    for (g, stated) in ERRORS {
        let error = phase::error(&PhaseFit::HG, g);
        assert!(error <= stated && error > 0.8 * stated, "{g}: {error}");
    }
    for i in 0..=190 {
        let g = MAX_ANISOTROPY * f64::from(i) / 190.0;
        let lobes = PhaseFit::HG.lobes(g);
        assert!(lobes.stretch.iter().all(|stretch| *stretch > 0.05), "{g}: {lobes:?}");
        assert!(phase::error(&PhaseFit::HG, g) < 0.03, "{g}");
        // The backward lobe takes away, but not more than there is
        let least = (0..=400).map(|k| lobes.density(f64::from(k) / 200.0 - 1.0)).fold(1.0, f64::min);
        assert!(least > 0.001, "{g}: {least}");
        // PHASE_EXCESS of cell_lights.glsl, which it needs at the largest g
        let excess = |mu: f64| lobes.density(mu) / henyey_greenstein(g, mu);
        let most = (0..=400).map(|k| excess(f64::from(k) / 200.0 - 1.0)).fold(0.0, f64::max);
        assert!(most <= 1.16 && (g < MAX_ANISOTROPY || most > 1.1), "{g}: {most}");
    }
    assert_eq!(PhaseFit::HG.lobes(0.0).uniform, 1.0);
    assert_eq!(PhaseFit::HG.lobes(f64::NAN), PhaseFit::HG.lobes(0.0));
    // Both pieces meet
    let [below, above] = [0.0, 1e-9].map(|more| PhaseFit::HG.lobes(PhaseFit::HG.knee + more));
    let kept =
        |i: usize| (below.weight[i] - above.weight[i]).abs() + (below.stretch[i] - above.stretch[i]).abs();
    assert!(kept(0) < 1e-5 && kept(2) < 1e-5 && above.weight[1] < 1e-5, "{below:?}, {above:?}");
}
