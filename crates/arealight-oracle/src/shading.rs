//! A polygon light on a surface: the truth by cubature of the true BRDF, and the answer of the fitted table
//! in float64, the twin of the GLSL.

mod anisotropy;
mod coat;
mod density;
mod diffuse;
pub mod footprint;
mod half_vectors;
mod medium;
mod opened;
pub mod poses;
mod profiled;
mod rescattered;
mod shapes;
mod sheen;
mod shown;
mod textured;

pub use density::{Directions, density_truth, shape_density_truth};
pub use medium::{in_scattered, in_scattered_truth, shape_in_scattered, shape_in_scattered_truth};
pub use shapes::{shape_ltc_on, shape_seen_from, shape_truth, textured_ellipse};
pub use shown::ShownImage;
pub use textured::transformed_image_integral;

use crate::cubature::{Estimate, Region, Settings, angles, distance_to_origin, edges};
use crate::formula::ggx_formula;
use crate::frame::SurfaceFrame;
use crate::ggx::{AnisotropicGgx, Ggx};
use crate::material::Surface;
use crate::polygon::{above_horizon, emitted, form_factor, transformed_form_factor};
use crate::texture::Texture;
use arealight::table::share_above_surface;
use arealight::{
    Horizon, Light, LightFault, LightTable, Lobes, Opening, Profile, Quality, SpecularLobes, TableSample,
};
use coat::CoatLobe;
use glam::{DAffine3, DMat3, DVec3};
use half_vectors::HalfVectors;
use rescattered::Rescattered;
use sheen::{sheen_truth, with_sheen};
use std::convert::Infallible;
use std::f64::consts::PI;
use std::sync::Arc;

/// A polygon light relative to a shading point, in float64 throughout.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RelativeLight {
    /// Vertices minus the shading point's position.
    pub vertices: Vec<DVec3>,
    /// Radiance, W/(m² sr).
    pub radiance: DVec3,
    /// Whether the back emits too.
    pub two_sided: bool,
    /// What multiplies the radiance.
    pub image: Option<ShownImage>,
    /// How it changes with the angle from the front.
    pub profile: Option<Profile>,
    /// Where the profile's azimuth is 0, a direction in the light's plane.
    pub azimuth: DVec3,
    /// What it is seen through, its center minus the shading point's position.
    pub opening: Option<Opening>,
}

impl RelativeLight {
    /// A polygon as seen from `position`, of one colour: see [`RelativeLight::textured`].
    pub fn new(light: &Light, position: DVec3) -> Self {
        let light = light.outlined();
        Self {
            vertices: light.shape.vertices().iter().map(|v| *v - position).collect(),
            radiance: light.radiance.as_dvec3(),
            two_sided: light.two_sided,
            image: None,
            profile: light.profile.clone(),
            azimuth: light.shape.first_edge(),
            opening: light.opening.map(|it| it.moved(&DAffine3::from_translation(-position))),
        }
    }

    /// The light as seen from `position`, showing `texture` where the light has a texture of its own.
    ///
    /// # Errors
    /// [`LightFault`] where its texture coordinates do not map onto it.
    pub fn textured(light: &Light, position: DVec3, texture: Arc<Texture>) -> Result<Self, LightFault> {
        let mut relative = Self::new(light, position);
        if let Some(mapped) = &light.texture {
            let mut map = mapped.map(&light.shape)?;
            map.corner -= position;
            relative.image = Some(ShownImage { texture, map });
        }
        Ok(relative)
    }
}

/// The light of a surface, and how well it is known.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Truth {
    /// Outgoing radiance, W/(m² sr).
    pub radiance: DVec3,
    /// The cubature's error estimate of it, far above the true error.
    pub error: DVec3,
    /// How often the BRDF was evaluated.
    pub evaluations: usize,
}

/// Outgoing radiance by adaptive cubature of the true BRDF: Lambert plus GGX with Schlick's Fresnel term,
/// below sheen and a coat where the surface has them, times what the light shows.
///
/// An image is cut where it bends, at its texels' centres, as long as a two-hundredth of the evaluations
/// reach for that: up to 141 by 141 texels with the default settings. A larger one converges more slowly.
///
/// `normal` and `view`, the direction to the viewer, have any length above zero; a view below the surface
/// counts as grazing.
pub fn truth(
    surface: &Surface,
    normal: DVec3,
    view: DVec3,
    light: &RelativeLight,
    settings: &Settings,
) -> Truth {
    let Ok(truth) = coat::layered::<Infallible>(surface, normal, view, settings, |surface, normal, view| {
        Ok(uncoated_truth(surface, normal, view, light, settings))
    });
    truth
}

fn uncoated_truth(
    surface: &Surface,
    normal: DVec3,
    view: DVec3,
    light: &RelativeLight,
    settings: &Settings,
) -> Truth {
    let frame = SurfaceFrame::new(normal, view);
    let vertices: Vec<DVec3> = light.vertices.iter().map(|v| frame.to_surface(*v)).collect();
    let image = light.image.as_ref().map(|image| image.in_frame(&frame));
    let bounds = light.limits().filter(|_| light.two_sided || faces_origin(&vertices));
    let region = bounds.map_or_else(Region::default, |bounds| {
        let most_texels = settings.max_evaluations / EVALUATIONS_PER_TEXEL;
        let region = match &image {
            None => Region::polygon(&vertices),
            Some(image) => image.region(&vertices, most_texels),
        };
        bounds.iter().fold(region, |region, normal| region.clipped(frame.to_surface(*normal)))
    });
    let azimuth = frame.to_surface(light.azimuth);
    let shown = |direction| {
        let color = image.as_ref().map_or(DVec3::ONE, |image| image.color(direction));
        let factor = light.profile.as_ref().map(|it| profiled::factor_in(it, azimuth, &vertices, direction));
        color * factor.unwrap_or(1.0)
    };
    let signed = reflected(surface, &frame, &region, settings, shown);
    // A two-sided light seen from behind has a negative solid angle
    Truth {
        radiance: light.radiance
            * if light.two_sided { signed.radiance.abs() } else { signed.radiance.max(DVec3::ZERO) },
        error: light.radiance * signed.error,
        evaluations: signed.evaluations,
    }
}

/// What a surface reflects of a region of its frame that shines as `shown` says, by direction; of a region
/// that counts negatively with the other sign.
fn reflected(
    surface: &Surface,
    frame: &SurfaceFrame,
    region: &Region,
    settings: &Settings,
    shown: impl Fn(DVec3) -> DVec3,
) -> Truth {
    let (region, view) = (region.clipped(DVec3::Z), frame.view());
    // Integrate each lobe over the light
    let diffuse = if surface.diffuse_albedo == DVec3::ZERO {
        Estimate::default()
    } else {
        let by_albedo = diffuse::albedo_part(surface, frame, settings);
        region.integrate(settings, angles, |direction| {
            let part = diffuse::part(surface, by_albedo, view, direction);
            let albedo = diffuse::rough(surface.diffuse_albedo, surface.diffuse_roughness, view, direction);
            (albedo * shown(direction) * (part * direction.z.max(0.0) / PI)).to_array()
        })
    };
    let glossy = if surface.f0 == DVec3::ZERO && surface.f90 == 0.0 {
        Estimate::default()
    } else {
        let weigh = |direction: DVec3, value: f64| {
            let fresnel = surface.fresnel(Ggx::half_cosine(view, direction));
            (shown(direction) * fresnel * value).to_array()
        };
        match AnisotropicGgx::of(surface, frame) {
            None => integrate_lobe(Ggx { alpha: surface.alpha }, view, &region, settings, weigh),
            Some(lobe) => integrate_lobe(lobe, view, &region, settings, weigh),
        }
    };
    // Add them
    let sum = |diffuse: [f64; 3], glossy: [f64; 3]| DVec3::from_array(diffuse) + DVec3::from_array(glossy);
    let base = Truth {
        radiance: sum(diffuse.value, glossy.value),
        error: sum(diffuse.error, glossy.error),
        evaluations: diffuse.evaluations + glossy.evaluations,
    };
    match &surface.sheen {
        None => base,
        Some(sheen) => sheen_truth(sheen, view, &region, settings, shown, base),
    }
}

/// A texel is two triangles of 22 evaluations each, or more where a horizon or the lobe's ridge cuts it; as
/// many again are for refinement.
const EVALUATIONS_PER_TEXEL: usize = 200;

/// Whether the front of a polygon is on the origin's side of its plane.
fn faces_origin(vertices: &[DVec3]) -> bool {
    let Some(&anchor) = vertices.first() else { return false };
    let pairs = vertices[1..].windows(2);
    let area: DVec3 = pairs.map(|pair| (pair[0] - anchor).cross(pair[1] - anchor)).sum();
    area.dot(anchor) < 0.0
}

/// The integrals of `f cos` and of `f cos (1 - cos theta_vh)^5` over a region of the surface frame, for a GGX
/// lobe without Fresnel term. Over the hemisphere they are the lobe's albedo and its Schlick part.
///
/// `view` is a unit vector in the surface frame. The lobe is found however narrow it is, down to
/// [`arealight::MIN_ALPHA`].
pub fn lobe_integrals(lobe: Ggx, view: DVec3, region: &Region, settings: &Settings) -> Estimate<2> {
    integrals_of(lobe, view, region, settings)
}

fn integrals_of(lobe: impl Microfacets, view: DVec3, region: &Region, settings: &Settings) -> Estimate<2> {
    integrate_lobe(lobe, view, region, settings, |direction, value| {
        [value, value * Ggx::schlick_weight(view, direction)]
    })
}

/// What a GGX lobe with a Fresnel term of the half vector's cosine reflects of light from everywhere.
fn hemisphere_albedo(
    lobe: impl Microfacets,
    view: DVec3,
    settings: &Settings,
    fresnel: impl Fn(f64) -> f64,
) -> f64 {
    let hemisphere = Region::sphere().clipped(DVec3::Z);
    let weigh = |direction, value| [value * fresnel(Ggx::half_cosine(view, direction))];
    let [albedo] = integrate_lobe(lobe, view, &hemisphere, settings, weigh).value;
    albedo
}

/// A lobe as its integration needs it.
trait Microfacets: Copy {
    /// `f cos` without Fresnel term.
    fn evaluate(&self, view: DVec3, light: DVec3) -> f64;
    /// The tangent of a half vector from the normal, in units of alpha, times its cosine.
    fn slope(&self, half: DVec3) -> DVec3;
    /// The smaller alpha.
    fn smallest_alpha(&self) -> f64;
}

impl Microfacets for Ggx {
    fn evaluate(&self, view: DVec3, light: DVec3) -> f64 {
        self.evaluate(view, light)
    }
    fn slope(&self, half: DVec3) -> DVec3 {
        half.with_z(0.0) / self.alpha
    }
    fn smallest_alpha(&self) -> f64 {
        self.alpha
    }
}

impl Microfacets for AnisotropicGgx {
    fn evaluate(&self, view: DVec3, light: DVec3) -> f64 {
        self.evaluate(view, light)
    }
    fn slope(&self, half: DVec3) -> DVec3 {
        (self.to_axis(half).truncate() / self.alpha).extend(0.0)
    }
    fn smallest_alpha(&self) -> f64 {
        self.alpha.min_element()
    }
}

/// Integrates what `weigh` makes of a direction and of `f cos` there.
fn integrate_lobe<const N: usize>(
    lobe: impl Microfacets,
    view: DVec3,
    region: &Region,
    settings: &Settings,
    weigh: impl Fn(DVec3, f64) -> [f64; N],
) -> Estimate<N> {
    let lengths = |triangle: &[DVec3; 3]| lengths_on_lobe(lobe, view, triangle);
    // At grazing angles the lobe is a narrow ridge along the plane of incidence
    region
        .cut(DVec3::Y)
        .integrate(settings, lengths, |direction| weigh(direction, lobe.evaluate(view, direction)))
}

/// The edges of a triangle in units of the scale on which the GGX lobe varies: that of D over the half
/// vectors, `alpha + sin theta_h`; that of masking over the light's height, which goes from none to full
/// within the smaller of alpha and `cos theta_view`; and half a radian.
fn lengths_on_lobe(lobe: impl Microfacets, view: DVec3, triangle: &[DVec3; 3]) -> [f64; 3] {
    let directions = triangle.map(DVec3::normalize_or_zero);
    // Project the half vectors onto the surface: D is a function of their distance from the normal
    let halves = directions.map(|light| lobe.slope((view + light).normalize_or_zero()));
    let half_scale = 1.0 + distance_to_origin(&halves);
    let alpha = lobe.smallest_alpha();
    let lowest = directions[0].z.min(directions[1].z).min(directions[2].z).max(0.0);
    let height_scale = lowest + view.z.min(alpha) + FINEST_HEIGHT;
    let (steps, angles) = (edges(&halves), edges(&directions));
    let finest = 1e-2 * alpha * alpha;
    std::array::from_fn(|i| {
        // Near grazing the lobe narrows to a fan: the error estimate sees to what is finer than this
        let step = if angles[i] > finest { steps[i] / half_scale } else { 0.0 };
        let rise = (directions[i].z - directions[(i + 1) % 3].z).abs() / height_scale;
        step.max(rise).max(2.0 * angles[i])
    })
}

/// Masking that changes over less height than this is left to the error estimate: its share is as small.
const FINEST_HEIGHT: f64 = 1e-6;

/// Outgoing radiance by the fitted table (Heitz et al. 2016) on the default levels: [`ltc_on`] with
/// [`Quality::default`].
pub fn ltc(
    table: &LightTable,
    surface: &Surface,
    normal: DVec3,
    view: DVec3,
    light: &RelativeLight,
) -> DVec3 {
    ltc_on(Quality::default(), table, surface, normal, view, light)
}

/// Outgoing radiance by the fitted table, with Lambert's lobe exact: the float64 twin of
/// `arealight_radiance`. Of `quality` it takes the horizon, how the Fresnel term enters, and where the lobes
/// come from; it integrates exactly.
///
/// `normal` and `view` have any length above zero; a view below the surface counts as grazing.
pub fn ltc_on(
    quality: Quality,
    table: &LightTable,
    surface: &Surface,
    normal: DVec3,
    view: DVec3,
    light: &RelativeLight,
) -> DVec3 {
    let frame = SurfaceFrame::new(normal, view);
    let with_film = surface;
    let surface = &surface.without_film(frame.cos_view());
    let seen = light.seen(&frame);
    // Integrate the transformed cosine
    let both_horizons = quality.horizon == Horizon::Both;
    let visible = if both_horizons { above_horizon(&seen) } else { seen.clone() };
    let image = light.image.as_ref().map(|image| image.in_frame(&frame));
    let azimuth = frame.to_surface(light.azimuth);
    let lobe = |inverse: &DMat3, above_surface: f64| {
        // What is clipped at the surface's horizon is made up for, so that the albedo stays
        let share = if both_horizons { above_surface } else { 1.0 };
        match &image {
            None => {
                let signed = match &light.profile {
                    None => transformed_form_factor(inverse, &visible),
                    Some(profile) => profiled::profiled((profile, azimuth), &seen, &visible, inverse),
                };
                // A profile may be brighter than 1
                let most = light.profile.as_ref().map_or(1.0, Profile::greatest);
                DVec3::splat((emitted(signed, light.two_sided) / share).min(most))
            }
            Some(image) => {
                let mut signed = transformed_image_integral(inverse, &seen, image, both_horizons);
                if let Some(profile) = &light.profile {
                    // The profile's mean over the light, as without the image
                    let all = transformed_form_factor(inverse, &visible);
                    let shaped = profiled::profiled((profile, azimuth), &seen, &visible, inverse);
                    signed *= if all == 0.0 { 0.0 } else { shaped / all };
                }
                signed.to_array().map(|channel| emitted(channel, light.two_sided) / share).into()
            }
        }
    };
    let is_shaped = light.profile.is_some() || light.opening.is_some();
    let over_half_vectors =
        quality.specular_lobes == SpecularLobes::HalfVectors && image.is_none() && !is_shaped;
    let glossy = if over_half_vectors {
        half_vector_part(quality, table, with_film, &frame, &visible, light.two_sided)
    } else {
        glossy_part(quality, table, surface, &frame, lobe)
    };
    // Integrate the cosine, or the diffuse lobe's transformed one
    let (inverse, albedo) = diffuse::lobe(quality, table, surface, &frame);
    let shown = match &image {
        _ if albedo == DVec3::ZERO => DVec3::ZERO,
        None if inverse == DMat3::IDENTITY && light.profile.is_none() => {
            DVec3::splat(emitted(form_factor(&seen), light.two_sided))
        }
        Some(image) if inverse == DMat3::IDENTITY && light.profile.is_none() => {
            let signed = transformed_image_integral(&inverse, &seen, image, false);
            signed.to_array().map(|channel| emitted(channel, light.two_sided)).into()
        }
        _ => lobe(&inverse, share_above_surface(&inverse)),
    };
    let diffuse = albedo * shown;
    let of_coat = |coat: &CoatLobe| match &coat.half_vectors {
        Some(facets) if over_half_vectors => facets.reflected(&visible, light.two_sided),
        _ => coat.albedo * lobe(&coat.inverse, coat.above_surface),
    };
    light.radiance * layered(quality, table, surface, &frame, [diffuse, glossy], (lobe, of_coat))
}

/// What is left of what the diffuse lobe and the specular ones reflect, with what sheen and the coat do,
/// `lobe` being as for [`glossy_part`], and `of_coat` what a coat reflects.
fn layered(
    quality: Quality,
    table: &LightTable,
    surface: &Surface,
    frame: &SurfaceFrame,
    [diffuse, glossy]: [DVec3; 2],
    (lobe, of_coat): (impl Fn(&DMat3, f64) -> DVec3, impl Fn(&CoatLobe) -> DVec3),
) -> DVec3 {
    let [mut diffuse, mut specular] = [diffuse, glossy];
    if let Some(sheen) = &surface.sheen {
        let sheen = with_sheen(sheen, quality.specular_lobes, frame, &lobe);
        diffuse *= sheen.left_below;
        specular = specular * sheen.left_below + sheen.radiance;
    }
    if let Some(coat) = &surface.coat {
        let coat = CoatLobe::new(quality, table, coat, frame);
        diffuse *= 1.0 - coat.share;
        specular = specular * (1.0 - coat.share) + of_coat(&coat);
    }
    // Sheen's second lobe may take more away than there is
    diffuse + specular.max(DVec3::ZERO)
}

/// What the table or the formula holds for a lobe.
fn fitted_sample(quality: Quality, table: &LightTable, alpha: f64, cos_view: f64) -> TableSample {
    match quality.lobes {
        Lobes::Table => table.lookup(alpha.sqrt(), cos_view),
        Lobes::Formula => ggx_formula(alpha.sqrt(), cos_view),
    }
}

/// Likewise, for the specular lobe of a surface.
fn surface_sample(
    quality: Quality,
    table: &LightTable,
    surface: &Surface,
    frame: &SurfaceFrame,
) -> TableSample {
    match AnisotropicGgx::of(surface, frame) {
        None => fitted_sample(quality, table, surface.alpha, frame.cos_view()),
        Some(lobe) => anisotropy::sample(quality, table, &lobe, frame.view()),
    }
}

/// What the specular lobe reflects of a polygon of unit radiance by [`SpecularLobes::HalfVectors`], a
/// channel.
fn half_vector_part(
    quality: Quality,
    table: &LightTable,
    surface: &Surface,
    frame: &SurfaceFrame,
    vertices: &[DVec3],
    two_sided: bool,
) -> DVec3 {
    let stand_in = surface.without_film(frame.cos_view());
    if stand_in.f0 == DVec3::ZERO && stand_in.f90 == 0.0 {
        return DVec3::ZERO;
    }
    let sample = surface_sample(quality, table, surface, frame);
    let scale = Rescattered::new(&stand_in, &sample).scale;
    scale * HalfVectors::of_surface(surface, frame, &sample).reflected(vertices, two_sided)
}

/// The radiance that the fitted lobes reflect. `lobe` is a light's form factor, per channel, in a lobe's
/// cosine space; a part of the lobe lies above the surface.
fn glossy_part(
    quality: Quality,
    table: &LightTable,
    surface: &Surface,
    frame: &SurfaceFrame,
    lobe: impl Fn(&DMat3, f64) -> DVec3,
) -> DVec3 {
    if surface.f0 == DVec3::ZERO && surface.f90 == 0.0 {
        return DVec3::ZERO;
    }
    let sample = surface_sample(quality, table, surface, frame);
    let scale = Rescattered::new(surface, &sample).scale;
    // Below sheen there is one lobe: the second place is that of sheen's own, as in material.glsl
    let has_sheen = surface.sheen.is_some_and(|sheen| sheen.color != DVec3::ZERO);
    let lobes = if has_sheen { SpecularLobes::One } else { quality.specular_lobes };
    let lobes = sample.lobes(lobes, surface.f0, surface.f90).into_iter();
    let parts = lobes.filter(|(_, albedo)| *albedo != DVec3::ZERO);
    let shown = parts.map(|(inverse, albedo)| albedo * lobe(&inverse, share_above_surface(&inverse)));
    scale * shown.sum::<DVec3>()
}
