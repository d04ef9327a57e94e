//! Anisotropic GGX on the GPU: against the float64 twin, against isotropic GGX, in its image of a G-buffer,
//! and where it is hard.

use arealight_oracle::material::Anisotropy;
use arealight_tests::prelude::*;

const COUNT: usize = 2000;

fn stretched(alpha: f64, along: f64, tangent: DVec3) -> Surface {
    Surface {
        f0: DVec3::new(0.04, 0.5, 0.9),
        f90: 1.0,
        alpha,
        anisotropy: Some(Anisotropy { tangent, alpha: along }),
        ..Surface::default()
    }
}

fn with_anisotropy(point: &EvalPoint, change: impl Fn(Anisotropy) -> Option<Anisotropy>) -> EvalPoint {
    let anisotropy = point.surface.anisotropy.and_then(change);
    EvalPoint { surface: Surface { anisotropy, ..point.surface }, ..point.clone() }
}

/// Metals under polygons of 3 to 8 vertices anywhere, above, across and below their horizons; tangents of any
/// direction.
fn points(seed: u64) -> Vec<EvalPoint> {
    let mut random = Random::new(seed);
    let one = |i| {
        let alphas = [(); 2].map(|()| 10.0_f64.powf(random.between(-2.0, 0.0)));
        let surface = stretched(alphas[0], alphas[1], random.direction());
        let cos_view = random.between(0.02, 1.0);
        let (sin, cos) = random.between(0.0, TAU).sin_cos();
        let view = (DVec3::new(cos, sin, 0.0) * (1.0 - cos_view * cos_view).sqrt()).with_z(cos_view);
        under_polygon(&mut random, i, surface, view)
    };
    (0..COUNT).map(one).collect()
}

#[test]
fn stretched_lobes_follow_their_float64_twin() {
    let Some(engine) = TestEngine::new() else { return };
    let points = points(1);
    // Two lobes, over their part above the surface; the least squares lose five bits of the matrices'
    // seventeen that count
    let bound = |given: &EvalPoint| {
        let least = given.surface.alpha.min(given.surface.anisotropy.unwrap().alpha);
        2.0 * rounding(least) / 0.6 + 2e-5
    };
    for quality in lobe_qualities() {
        // The twin's twin: a lobe that is a little longer is another
        engine.assert_follows_polygon_twin("stretched lobes", quality, &points, bound, |surface| {
            let anisotropy = surface.anisotropy.map(|a| Anisotropy { alpha: a.alpha * 1.1, ..a });
            Surface { anisotropy, ..*surface }
        });
    }
}

#[test]
fn of_equal_roughnesses_they_are_isotropic() {
    let Some(engine) = TestEngine::new() else { return };
    let points = points(2);
    let set = |factor: f64| -> Vec<EvalPoint> {
        let equal =
            |p: &EvalPoint| with_anisotropy(p, |a| Some(Anisotropy { alpha: p.surface.alpha * factor, ..a }));
        points.iter().map(equal).collect()
    };
    let isotropic: Vec<EvalPoint> = points.iter().map(|p| with_anisotropy(p, |_| None)).collect();
    for quality in lobe_qualities() {
        let expected = engine.eval(&isotropic, quality).unwrap();
        let differ = |points: &[EvalPoint]| {
            let answers = engine.eval(points, quality).unwrap();
            let pairs = answers.iter().zip(&expected).zip(points);
            let bound = |p: &EvalPoint| 2.0 * rounding(p.surface.alpha) / 0.6;
            pairs.filter(|((a, b), p)| f64::from((**a - **b).abs().max_element()) > bound(p)).count()
        };
        assert_eq!(differ(&set(1.0)), 0, "{quality:?}");
        // The twin: a little longer they are not
        assert!(differ(&set(0.9)) > COUNT / 10, "{quality:?}");
    }
}

/// Roughnesses from mirrors on, tangents that are none, views on all sides.
fn hard_surfaces() -> impl Iterator<Item = (Surface, DVec3)> {
    let alphas = [0.0, 1e-4, 1e-2, 0.3, 1.0];
    let tangents = [
        DVec3::X,
        DVec3::new(0.6, 0.8, 0.0),
        DVec3::new(1e-3, 1.0, 0.0),
        DVec3::Z,
        DVec3::ZERO,
        DVec3::new(1e-30, 0.0, 1.0),
        DVec3::NAN,
    ];
    let thetas = [0.0_f64, 1e-6, 0.7, 1.5, 1.569, std::f64::consts::FRAC_PI_2, 1.8];
    let surface = move |(along, across)| {
        tangents.into_iter().flat_map(move |tangent| {
            thetas.into_iter().map(move |theta| {
                let surface = Surface { f0: DVec3::ONE, ..stretched(across, along, tangent) };
                (surface, DVec3::new(theta.sin(), 0.0, theta.cos()))
            })
        })
    };
    let pairs =
        alphas.into_iter().flat_map(move |along| alphas.into_iter().map(move |across| (along, across)));
    pairs.flat_map(surface)
}

#[test]
fn a_stretched_lobe_sends_no_more_than_it_gets() {
    let Some(engine) = TestEngine::new() else { return };
    let surfaces: Vec<(Surface, DVec3)> = hard_surfaces().collect();
    for quality in lobe_qualities() {
        let sums = engine.light_from_everywhere(&surfaces, quality);
        // The twin: the box is lit from all sides, and only rough lobes lose much
        let bright = sums.iter().filter(|sum| **sum > 0.9).count();
        assert!(bright > sums.len() / 3, "{quality:?}: {bright} of {}", sums.len());
    }
}

#[test]
fn nothing_jumps_where_the_view_crosses_the_normal() {
    const AZIMUTHS: usize = 16;
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(3);
    let (mut points, tilts) = (Vec::new(), [2e-6, 0.2]);
    for _ in 0..100 {
        let alphas = [(); 2].map(|()| 10.0_f64.powf(random.between(-1.5, 0.0)));
        let surface = stretched(alphas[0], alphas[1], random.direction());
        let size = random.between(0.2, 1.0);
        let center = random.direction();
        let vertices = random.polygon(center.with_z(center.z.abs()), 4, size * 0.5, size);
        for tilt in tilts {
            points.extend((0..AZIMUTHS).map(|i| {
                let (sin, cos) = (TAU * i as f64 / AZIMUTHS as f64).sin_cos();
                point(surface, DVec3::new(cos * tilt, sin * tilt, 1.0), vertices.clone(), true)
            }));
        }
    }
    // The formula's isotropic lobes are not round at the normal themselves: entries are off by 1e-2 and more
    for quality in lobe_qualities().into_iter().filter(|quality| quality.lobes == Lobes::Table) {
        let answers = engine.eval(&points, quality).unwrap();
        let spreads: Vec<f32> = answers
            .chunks_exact(AZIMUTHS)
            .map(|turned| {
                let largest = turned.iter().fold(turned[0], |a, b| a.max(*b));
                let smallest = turned.iter().fold(turned[0], |a, b| a.min(*b));
                (largest - smallest).max_element()
            })
            .collect();
        let largest = |at: usize| spreads.iter().skip(at).step_by(2).fold(0.0_f32, |a, b| a.max(*b));
        println!("{quality:?}: {:.1e} at the normal, {:.1e} around it", largest(0), largest(1));
        // The nine normals turn with the azimuth, and are round to the eighth order alone: 7e-4 for alphas 30
        // times apart, where the lobe itself errs by 2e-2. Nine on a grid jump by 5e-2
        assert!(largest(0) < 1e-3, "{quality:?}: {}", largest(0));
        // The twin: a tenth of a radian away the view's azimuth counts
        assert!(largest(1) > 0.05, "{quality:?}: {}", largest(1));
    }
}

#[test]
fn every_layout_has_second_roughnesses_in_an_image_of_their_own() {
    let Some(engine) = TestEngine::new() else { return };
    let both = Effects::ANISOTROPY | Effects::DIFFUSE_ROUGHNESS;
    // Both; anisotropy; a rough diffuse lobe
    let texels = [[0.6, 0.4, 0.9, 0.8], [0.6, 0.4, 0.9, 0.0], [0.6, 0.4, 0.0, 0.8]];
    // On the octahedron's upper half: (0.6, 0.4, 0)
    let anisotropy = Some(Anisotropy { tangent: DVec3::new(0.6, 0.4, 0.0), alpha: 0.81 });
    let surface = Surface { anisotropy, diffuse_roughness: 0.8, ..material().surface() };
    // Radiance of 3, two lobes, and the least squares' rounding
    engine.assert_plane((Plane::Anisotropy, both), &[[0.6, 0.4, 0.0, 0.0]], &texels, (surface, 1e-4));
}
