//! A diffuse lobe below an interface, and a rough one: albedos, errors, and limits.

use crate::common::{from_everywhere, view_at};
use arealight::LightTable;
use arealight_oracle::cubature::Settings;
use arealight_oracle::frame::SurfaceFrame;
use arealight_oracle::material::{Interface, Surface};
use arealight_oracle::shading::{RelativeLight, ltc, truth};
use arealight_oracle::stream::Stream;
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

static TABLE: LazyLock<LightTable> = LazyLock::new(LightTable::ggx);

/// A white Lambert lobe alone, below an interface that itself reflects nothing to the viewer.
fn below(f0: f64, f90: f64) -> Surface {
    let interface = Some(Interface { f0, f90, by_albedo: false });
    Surface { diffuse_albedo: DVec3::ONE, interface, ..Surface::default() }
}

fn light(vertices: Vec<DVec3>) -> RelativeLight {
    RelativeLight { vertices, radiance: DVec3::ONE, two_sided: true, ..RelativeLight::default() }
}

/// What a surface reflects of light from everywhere: the fitted lobes, and the truth.
fn albedos(surface: &Surface, view: DVec3) -> [f64; 2] {
    let fitted = from_everywhere(|light| ltc(&TABLE, surface, DVec3::Z, view, light));
    let settings = Settings::default();
    let exact = from_everywhere(|light| truth(surface, DVec3::Z, view, light, &settings).radiance);
    [fitted.x, exact.x]
}

#[test]
fn its_albedo_is_what_the_fresnel_term_leaves() {
    for theta in [0.0, 0.3, 0.9, 1.3, 1.5, FRAC_PI_2 - 1e-4] {
        for (f0, f90) in [(0.04, 1.0), (0.0, 1.0), (0.5, 0.5), (0.2, 0.05), (1.0, 1.0), (0.0, 0.0)] {
            let surface = below(f0, f90);
            let [fitted, exact] = albedos(&surface, view_at(theta));
            // The polynomial's own error, 1.2e-5, times f90 - f0
            assert!((fitted - exact).abs() < 2e-5, "{theta}, {f0}, {f90}: {fitted} {exact}");
            assert!((-1e-9..=1.0 + 1e-9).contains(&fitted));
        }
    }
}

/// Quads in front of the surface, some of them across its horizon, and views of them.
fn quads(count: usize) -> impl Iterator<Item = (DVec3, RelativeLight)> {
    let mut random = Stream::from_seed(7);
    (0..count).map(move |_| {
        let mut unit = || random.unit();
        let theta = unit() * 89.0_f64.to_radians();
        let (phi, z) = (unit() * std::f64::consts::TAU, unit());
        let radius = (1.0 - z * z).sqrt();
        let center = DVec3::new(radius * phi.cos(), radius * phi.sin(), z);
        let (u, v) = center.any_orthonormal_pair();
        let size = 0.1 * 20.0_f64.powf(unit());
        let (u, v) = (u * size, v * size * (0.3 + 0.7 * unit()));
        (view_at(theta), light(vec![center - u - v, center + u - v, center + u + v, center - u + v]))
    })
}

#[test]
fn its_error_is_the_stated_one() {
    // Mean and 99th percentile over quads of unit radiance, f0 = 0.04
    let measure = |answer: &dyn Fn(DVec3, &RelativeLight) -> f64| {
        let mut errors: Vec<f64> = quads(1000)
            .map(|(view, light)| {
                let settings = Settings { relative_tolerance: 1e-6, ..Settings::default() };
                let exact = truth(&below(0.04, 1.0), DVec3::Z, view, &light, &settings).radiance.x;
                (answer(view, &light) - exact).abs()
            })
            .collect();
        errors.sort_by(f64::total_cmp);
        (errors.iter().sum::<f64>() / errors.len() as f64, errors[errors.len() * 99 / 100])
    };
    let coupled = |view, light: &RelativeLight| ltc(&TABLE, &below(0.04, 1.0), DVec3::Z, view, light).x;
    let (mean, worst) = measure(&coupled);
    println!("coupled: mean {mean:.2e}, 99 % {worst:.2e}");
    assert!(mean < 0.35e-3 && worst < 4e-3, "{mean:e} {worst:e}");
    // The twins: the same albedo in Lambert's own lobe, and no coupling
    let scaled = |view, light: &RelativeLight| {
        let part = from_albedo(view);
        part * ltc(&TABLE, &below(0.0, 0.0), DVec3::Z, view, light).x
    };
    let (mean, _) = measure(&scaled);
    println!("scaled: mean {mean:.2e}");
    assert!(mean > 0.5e-3, "{mean:e}");
    let added = |view, light: &RelativeLight| ltc(&TABLE, &below(0.0, 0.0), DVec3::Z, view, light).x;
    let (mean, _) = measure(&added);
    println!("added: mean {mean:.2e}");
    assert!(mean > 4e-3, "{mean:e}");
}

/// The albedo at a view, by light from everywhere above.
fn from_albedo(view: DVec3) -> f64 {
    let sky = [
        DVec3::new(-1e6, -1e6, 1.0),
        DVec3::new(1e6, -1e6, 1.0),
        DVec3::new(1e6, 1e6, 1.0),
        DVec3::new(-1e6, 1e6, 1.0),
    ];
    ltc(&TABLE, &below(0.04, 1.0), DVec3::Z, view, &light(sky.to_vec())).x
}

#[test]
fn without_reflectance_it_is_lambert_s_to_the_bit_and_by_albedo_it_is_scaled() {
    let surface = Surface { f0: DVec3::splat(0.04), f90: 1.0, alpha: 0.3, ..below(0.04, 1.0) };
    let by_albedo = surface.interface.map(|interface| Interface { by_albedo: true, ..interface });
    for (view, light) in quads(50) {
        let answer = |surface: &Surface| ltc(&TABLE, surface, DVec3::Z, view, &light).x;
        assert_eq!(answer(&below(0.0, 0.0)), answer(&Surface { interface: None, ..below(0.0, 0.0) }));
        // What is left of the Lambert lobe is the table's albedo less
        let of_lobe = |interface| {
            answer(&Surface { interface, ..surface })
                - answer(&Surface { diffuse_albedo: DVec3::ZERO, interface, ..surface })
        };
        let cos_view = SurfaceFrame::new(DVec3::Z, view).cos_view();
        let sample = TABLE.lookup(surface.alpha.sqrt(), cos_view);
        let part = 1.0 - (0.04 * sample.albedo + 0.96 * sample.schlick);
        assert!((of_lobe(by_albedo) - part * of_lobe(None)).abs() < 1e-12);
        // The truth's albedo is the table's to its error: 1.5e-3 of F0 and 2e-3 of the rest (docs/fit.md)
        let exact = |interface| {
            let surface = Surface { interface, ..surface };
            truth(&surface, DVec3::Z, view, &light, &Settings::default()).radiance.x
        };
        let taken = exact(None) - exact(by_albedo);
        assert!((taken - (1.0 - part) * of_lobe(None)).abs() < 2.1e-3 * of_lobe(None) + 1e-6, "{view}");
    }
}

fn rough(albedo: f64, diffuse_roughness: f64) -> Surface {
    Surface { diffuse_albedo: DVec3::splat(albedo), diffuse_roughness, ..Surface::default() }
}

#[test]
fn a_rough_lobe_of_white_reflects_all_and_its_albedo_is_the_truth_s() {
    for theta in [0.0, 0.3, 0.9, 1.3, 1.5] {
        for (albedo, roughness) in [(1.0, 1.0), (1.0, 0.3), (0.8, 0.5), (0.2, 1.0), (0.2, 0.05), (0.0, 1.0)] {
            let surface = rough(albedo, roughness);
            let [fitted, exact] = albedos(&surface, view_at(theta));
            // The single bounce's polynomial: 4e-4
            assert!((fitted - exact).abs() < 5e-4, "{theta}, {albedo}, {roughness}: {fitted} {exact}");
            if albedo == 1.0 {
                assert!((exact - 1.0).abs() < 1e-6, "{theta}, {roughness}: {exact}");
            }
        }
    }
}

#[test]
fn the_error_of_a_rough_lobe_is_the_stated_one() {
    // The last below an interface, whose shear and lean are one after the other
    for (albedo, f0, bound, lambert_errs) in
        [(0.8, None, 1.2e-3, 5e-3), (0.18, None, 0.25e-3, 1.5e-3), (0.8, Some(0.04), 1.4e-3, 5e-3)]
    {
        let interface = f0.map(|f0| Interface { f0, f90: 1.0, by_albedo: false });
        let mut roughness = Stream::from_seed(5);
        let (mut fitted, mut lambert) = (0.0, 0.0);
        for (view, light) in quads(500) {
            let surface = Surface { interface, ..rough(albedo, roughness.unit()) };
            let settings = Settings { relative_tolerance: 1e-6, ..Settings::default() };
            let exact = truth(&surface, DVec3::Z, view, &light, &settings).radiance.x;
            fitted += (ltc(&TABLE, &surface, DVec3::Z, view, &light).x - exact).abs() / 500.0;
            lambert += (ltc(&TABLE, &Surface { diffuse_roughness: 0.0, ..surface }, DVec3::Z, view, &light)
                .x
                - exact)
                .abs()
                / 500.0;
        }
        println!("rough diffuse, albedo {albedo}, {f0:?}: mean {fitted:.2e}, Lambert's lobe {lambert:.2e}");
        assert!(fitted < bound && lambert > lambert_errs, "{albedo}: {fitted:e}, {lambert:e}");
    }
}
