//! A diffuse lobe, Lambert's or rough, below an interface, in float64: the truth, and its fitted lobe.

use super::rescattered::Rescattered;
use super::{hemisphere_albedo, surface_sample};
use crate::cubature::Settings;
use crate::frame::SurfaceFrame;
use crate::ggx::{AnisotropicGgx, Ggx};
use crate::material::{Interface, Surface};
use arealight::{LightTable, Quality};
use glam::{DMat3, DVec3};
use std::f64::consts::PI;

/// What the interface leaves of a diffuse lobe's light, from a direction of the surface frame: 1 without one.
/// `by_albedo` is what [`albedo_part`] says.
pub(super) fn part(surface: &Surface, by_albedo: f64, view: DVec3, direction: DVec3) -> f64 {
    match surface.interface {
        None => 1.0,
        Some(Interface { by_albedo: true, .. }) => by_albedo,
        Some(interface) => 1.0 - reflected(surface, interface, Ggx::half_cosine(view, direction)),
    }
}

/// What an interface reflects of light that comes in at a cosine, its largest channel below a film.
fn reflected(surface: &Surface, Interface { f0, f90, .. }: Interface, cosine: f64) -> f64 {
    match &surface.film {
        None => f0 + (f90 - f0) * (1.0 - cosine).powi(5),
        Some(film) => film.reflectance(DVec3::splat(f0), f90, cosine).max_element().min(1.0),
    }
}

/// What the true albedo of the surface's GGX lobe at a view leaves, where that is asked for; else 1.
pub(super) fn albedo_part(surface: &Surface, frame: &SurfaceFrame, settings: &Settings) -> f64 {
    match surface.interface {
        Some(interface) if interface.by_albedo => {
            let (view, isotropic) = (frame.view(), Ggx { alpha: surface.alpha });
            let fresnel = |cosine| reflected(surface, interface, cosine);
            1.0 - match AnisotropicGgx::of(surface, frame) {
                None => hemisphere_albedo(isotropic, view, settings, fresnel),
                Some(lobe) => hemisphere_albedo(lobe, view, settings, fresnel),
            }
        }
        _ => 1.0,
    }
}

/// The diffuse lobe of a surface, the twin of `arealight_surface_diffuse_lobe`: M⁻¹ of the surface frame, and
/// the albedo, a channel.
pub(super) fn lobe(
    quality: Quality,
    table: &LightTable,
    surface: &Surface,
    frame: &SurfaceFrame,
) -> (DMat3, DVec3) {
    let (inverse, albedo) = lobe_below_interface(quality, table, surface, frame);
    if !surface.multiple_scattering {
        return (inverse, albedo);
    }
    let sample = surface_sample(quality, table, surface, frame);
    (inverse, albedo + Rescattered::new(surface, &sample).diffuse)
}

fn lobe_below_interface(
    quality: Quality,
    table: &LightTable,
    surface: &Surface,
    frame: &SurfaceFrame,
) -> (DMat3, DVec3) {
    let cos_view = frame.cos_view();
    let roughness = surface.diffuse_roughness;
    let (inverse, albedo) = if roughness > 0.0 {
        (
            rough_space(surface.diffuse_albedo, roughness, cos_view),
            rough_albedo(surface.diffuse_albedo, roughness, cos_view),
        )
    } else {
        (DMat3::IDENTITY, surface.diffuse_albedo)
    };
    let Some(Interface { f0, f90, by_albedo }) = surface.interface else { return (inverse, albedo) };
    if by_albedo {
        let sample = surface_sample(quality, table, surface, frame);
        return (inverse, albedo * (1.0 - (f0 * sample.albedo + (f90 - f0) * sample.schlick)));
    }
    let x = 1.0 - cos_view;
    let schlick = 8.19e-5 + x * (2.0063e-3 + x * (9.3423e-3 + x * (7.707e-3 + x * 9.0207e-3)));
    let albedo = albedo * (1.0 - f0 - (f90 - f0) * schlick);
    let varies = ((f90 - f0) / (1.0 - f0).max(1e-3)).clamp(-1.0, 1.0);
    let stretch = 1.0 + varies * x * x * (0.028841 + 0.011653 * x * x);
    let shear = -varies * x * x * (0.012844 + 0.013407 * x * x);
    (inverse * DMat3::from_cols(DVec3::X * stretch, DVec3::Y, DVec3::new(shear, 0.0, 1.0)), albedo)
}

/// EON's constants.
const C1: f64 = 0.5 - 2.0 / (3.0 * PI);
const C2: f64 = 2.0 / 3.0 - 28.0 / (15.0 * PI);

/// What EON reflects of white light after one bounce, on average over the cosine.
fn mean_single(roughness: f64) -> f64 {
    (1.0 + C2 * roughness) / (1.0 + C1 * roughness)
}

/// A channel's factor of what bounces again.
fn more(albedo: f64, roughness: f64) -> f64 {
    let mean = mean_single(roughness);
    albedo * albedo * mean / (1.0 - albedo * (1.0 - mean)).max(1e-3)
}

/// What EON reflects of white light after one bounce, exactly.
fn exact_single(cosine: f64, roughness: f64) -> f64 {
    let cosine = cosine.clamp(1e-9, 1.0);
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let grazing = sine * (sine.atan2(cosine) - sine * cosine)
        + 2.0 / 3.0 * (sine / cosine * (1.0 - sine * sine * sine) - sine);
    (1.0 + roughness * grazing / PI) / (1.0 + C1 * roughness)
}

/// EON over a white Lambert lobe of the same cosine, a channel: directions of the surface frame. Source:
/// Portsmouth, Kutz, Hill 2025, equations 10 to 22.
pub(super) fn rough(albedo: DVec3, roughness: f64, view: DVec3, light: DVec3) -> DVec3 {
    if roughness == 0.0 {
        return albedo;
    }
    let s = view.dot(light) - view.z * light.z;
    let t = if s > 0.0 { s / view.z.max(light.z) } else { s };
    let once = (1.0 + roughness * t) / (1.0 + C1 * roughness);
    let lost = (1.0 - exact_single(view.z, roughness)) * (1.0 - exact_single(light.z, roughness));
    let again = lost / (1.0 - mean_single(roughness)).max(1e-12);
    albedo * once + DVec3::from(albedo.to_array().map(|channel| more(channel, roughness) * again))
}

/// The twins of `arealight_rough_diffuse_lobe`.
fn single(cosine: f64, roughness: f64) -> f64 {
    let x = 1.0 - cosine;
    let grazing = x * (0.0571085 + x * (0.4918819 + x * (0.0714430 * x - 0.3321814)));
    (1.0 + roughness * grazing) / (1.0 + C1 * roughness)
}

fn rough_parts(albedo: DVec3, roughness: f64, cosine: f64) -> [DVec3; 2] {
    let single = single(cosine, roughness);
    let more = albedo.to_array().map(|channel| more(channel, roughness) * (1.0 - single));
    [albedo * single, more.into()]
}

fn rough_albedo(albedo: DVec3, roughness: f64, cosine: f64) -> DVec3 {
    let [once, more] = rough_parts(albedo, roughness, cosine);
    once + more
}

fn rough_space(albedo: DVec3, roughness: f64, m: f64) -> DMat3 {
    let [once, more] = rough_parts(albedo, roughness, m);
    let part = more.element_sum() / (once + more).element_sum().max(1e-6);
    let (r, s) = (roughness, (1.0 - m * m).max(0.0).sqrt());
    let x = 1.0 + r * s * s * (-0.2409 + m * (0.3583 - 0.1340 * m) + 0.0999 * r);
    let x_of_z = r * s * (-0.7191 + m * (0.3185 - 0.0357 * m) - 0.0046 * r);
    let z_of_x = r * s * (0.4851 + m * (0.2321 * m - 0.5456) - 0.0134 * r);
    let z = 1.0 + r * s * s * (0.1475 + m * (0.0799 * m - 0.1680) - 0.1455 * r);
    let rest = 1.0 - part;
    DMat3::from_cols(
        DVec3::new(x * rest + part, 0.0, z_of_x * rest),
        DVec3::Y,
        DVec3::new(x_of_z * rest, 0.0, z * rest + 0.79 * part),
    )
}
