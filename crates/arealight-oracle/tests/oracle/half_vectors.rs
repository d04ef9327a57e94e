//! GGX over half vectors: how near it is to the true BRDF under lamps, beside the fitted lobes, and what it
//! promises beside.

use crate::common::{from_everywhere, view_at};
use arealight::{LightTable, Quality, SpecularLobes};
use arealight_oracle::cubature::Settings;
use arealight_oracle::material::{Anisotropy, Coat, Surface};
use arealight_oracle::shading::{RelativeLight, ltc_on, truth};
use arealight_oracle::stream::Stream;
use glam::{DMat3, DVec3};
use std::f64::consts::TAU;
use std::sync::LazyLock;

static TABLE: LazyLock<LightTable> = LazyLock::new(LightTable::ggx);

const LAMPS: usize = 150;

fn on(specular_lobes: SpecularLobes) -> Quality {
    Quality { specular_lobes, ..Quality::default() }
}

/// A lamp, and a surface that reflects it.
struct Shown {
    surface: Surface,
    view: DVec3,
    light: RelativeLight,
}

impl Shown {
    fn truth(&self) -> DVec3 {
        truth(&self.surface, DVec3::Z, self.view, &self.light, &Settings::default()).radiance
    }

    fn by(&self, specular_lobes: SpecularLobes) -> DVec3 {
        ltc_on(on(specular_lobes), &TABLE, &self.surface, DVec3::Z, self.view, &self.light)
    }
}

/// Rectangles 5 to 40 degrees wide that a facet near the normal mirrors, as softboxes are lit and seen.
fn lamps(seed: u64, surface: impl Fn(&mut dyn FnMut(f64, f64) -> f64) -> Surface) -> Vec<Shown> {
    (0..LAMPS)
        .map(|index| {
            let mut stream = Stream::new("lamps", index as u64, seed);
            let mut draw = |low: f64, high: f64| low + (high - low) * stream.unit();
            let surface = surface(&mut draw);
            let view = view_at(draw(0.0, 1.45));
            // A facet of the lobe, as the light's middle is mirrored by it
            let (radius, angle) = (draw(0.0, 1.5), draw(0.0, TAU));
            let along = surface.anisotropy.map_or(surface.alpha, |a| a.alpha);
            let facet = DVec3::new(along * radius * angle.cos(), surface.alpha * radius * angle.sin(), 1.0)
                .normalize_or(DVec3::Z);
            let middle = 2.0 * facet.dot(view) * facet - view;
            let middle = middle.with_z(middle.z.abs().max(0.05)).normalize_or(DVec3::Z);
            let frame = DMat3::from_axis_angle(middle, draw(0.0, TAU));
            let (u, v) = middle.any_orthonormal_pair();
            let (u, v) = (frame * u * draw(0.05, 0.35), frame * v * draw(0.05, 0.35));
            let vertices = [u + v, v - u, -u - v, u - v].map(|corner| middle + corner).to_vec();
            let light =
                RelativeLight { vertices, radiance: DVec3::ONE, two_sided: true, ..RelativeLight::default() };
            Shown { surface, view, light }
        })
        .collect()
}

/// Root of the mean square of the error over the mean of the truth, of one specular lobe, of two, and over
/// half vectors.
fn errors(shown: &[Shown]) -> [f64; 3] {
    let truths: Vec<DVec3> = shown.iter().map(Shown::truth).collect();
    let mean = truths.iter().map(|t| t.element_sum()).sum::<f64>() / (3 * truths.len()) as f64;
    [SpecularLobes::One, SpecularLobes::Two, SpecularLobes::HalfVectors].map(|lobes| {
        let square = |(shown, truth): (&Shown, &DVec3)| (shown.by(lobes) - *truth).length_squared() / 3.0;
        let squares: f64 = shown.iter().zip(&truths).map(square).sum();
        (squares / truths.len() as f64).sqrt() / mean
    })
}

fn metal(alpha: f64) -> Surface {
    Surface { f0: DVec3::new(1.0, 0.8, 0.4), f90: 1.0, alpha, ..Surface::default() }
}

#[test]
fn lamps_err_a_fraction_of_what_fitted_lobes_err() {
    let brushed = |draw: &mut dyn FnMut(f64, f64) -> f64| Surface {
        anisotropy: Some(Anisotropy { tangent: DVec3::X, alpha: draw(0.2, 0.8) }),
        ..metal(draw(0.03, 0.15))
    };
    let coated = |draw: &mut dyn FnMut(f64, f64) -> f64| Surface {
        coat: Some(Coat { weight: 1.0, alpha: draw(0.02, 0.3), normal: None, by_albedo: false }),
        ..metal(draw(0.1, 1.0))
    };
    let dielectric =
        |draw: &mut dyn FnMut(f64, f64) -> f64| Surface { f0: DVec3::splat(0.04), ..metal(draw(0.03, 1.0)) };
    for (name, shown, [bound, fitted]) in [
        // Bounds are 1.2 times what was measured. Of dielectrics a few rough ones that graze make all of the
        // error
        ("metals", lamps(1, |draw| metal(draw(0.03, 1.0))), [0.026, 0.02]),
        ("brushed metals", lamps(2, brushed), [0.029, 0.15]),
        ("dielectrics", lamps(3, dielectric), [0.158, 0.1]),
        ("coated metals", lamps(4, coated), [0.035, 0.025]),
    ] {
        let [one, two, half_vectors] = errors(&shown);
        println!("{name}: one lobe {one:.4}, two {two:.4}, half vectors {half_vectors:.4}");
        assert!(half_vectors < bound, "{name}: {half_vectors}");
        // The twin: the same comparison of fitted lobes
        assert!(two > fitted && one > bound, "{name}: {one} {two}");
    }
}

#[test]
fn light_from_everywhere_has_the_lobe_s_albedo() {
    let [mut worst, mut apart, mut most, mut without] = [0.0_f64; 4];
    for alpha in [1e-3, 0.04, 0.25, 0.6, 1.0] {
        for theta in [0.0, 0.5, 1.0, 1.3, 1.5] {
            let (surface, view) = (metal(alpha), view_at(theta));
            // One light that is nearly everywhere
            let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
            let vertices = corners.map(|(x, y)| DVec3::new(1e6 * x, 1e6 * y, 1.0)).to_vec();
            let light = RelativeLight {
                vertices,
                radiance: DVec3::ONE,
                two_sided: false,
                ..RelativeLight::default()
            };
            let sample = TABLE.lookup(alpha.sqrt(), view.z);
            let albedo = surface.f0 * sample.albedo + (DVec3::ONE - surface.f0) * sample.schlick;
            let found = ltc_on(on(SpecularLobes::HalfVectors), &TABLE, &surface, DVec3::Z, view, &light);
            worst = worst.max((found - albedo).abs().max_element());
            // Of many lights each has masking of its own: never more than there is
            let parts = from_everywhere(|light| {
                ltc_on(on(SpecularLobes::HalfVectors), &TABLE, &surface, DVec3::Z, view, light)
            });
            apart = apart.max((parts - albedo).abs().max_element());
            most = most.max(parts.max_element());
            without = without.max((DVec3::ONE - albedo).max_element());
        }
    }
    println!("{worst:.1e} of one light; {apart:.3} of six, {most:.4} at most; {without:.2} is lost");
    // The chords of the light's edges are not those of the sky's
    assert!(worst < 2e-3, "{worst}");
    assert!(apart < 0.1 && most < 1.005, "{apart}, {most}");
    // The twin: the albedo is not 1
    assert!(without > 0.3);
}

#[test]
fn smooth_metal_shows_lights_to_views_along_it() {
    let wall = [[-3.0, -3.0], [3.0, -3.0], [3.0, 3.0], [-3.0, 3.0]].map(|[x, z]| DVec3::new(x, 1.0, z));
    let light = RelativeLight {
        vertices: wall.to_vec(),
        radiance: DVec3::ONE,
        two_sided: true,
        ..RelativeLight::default()
    };
    for (alpha, cosine) in [(1e-4, 0.0), (1e-4, 1e-3), (1e-3, 1e-3), (1e-3, 2e-3)] {
        // The wall is mirrored, and passed by
        for view in [DVec3::new(0.3, -1.0, 0.0), DVec3::new(0.3, 1.0, 0.0)] {
            let view = view.normalize_or(DVec3::X).with_z(cosine);
            let shown = Shown { surface: metal(alpha), view, light: light.clone() };
            let (found, truth) = (shown.by(SpecularLobes::HalfVectors).x, shown.truth().x);
            // Views up to .6 degrees over the surface count as one there; a tenth of it lost .1 to 1
            assert!((found - truth).abs() < 0.01, "{alpha} {cosine}: {found} {truth}");
        }
    }
}

#[test]
fn a_mirror_shows_a_lamp_as_far_as_it_is_there() {
    // The facets are the normal alone: all of what a lamp's image covers, and nothing beside it
    let view = view_at(0.6);
    let mirror = view.with_x(-view.x);
    let rectangle = |middle: DVec3| {
        let (u, v) = mirror.any_orthonormal_pair();
        let vertices = [u + v, v - u, -u - v, u - v].map(|corner| middle + 0.1 * corner).to_vec();
        RelativeLight { vertices, radiance: DVec3::ONE, two_sided: true, ..RelativeLight::default() }
    };
    let sent = |middle| {
        ltc_on(on(SpecularLobes::HalfVectors), &TABLE, &metal(1e-3), DVec3::Z, view, &rectangle(middle)).x
    };
    assert!((sent(mirror) - 1.0).abs() < 1e-3, "{}", sent(mirror));
    assert!(sent(mirror + DVec3::Y * 0.3) < 1e-3);
}
