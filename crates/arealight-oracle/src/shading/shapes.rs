//! Disks, spheres and tubes on a surface, by the fitted table in float64.

use super::coat::{self, CoatLobe};
use super::{RelativeLight, ShownImage, Truth, diffuse, glossy_part, layered, reflected};
use crate::cubature::{Region, Settings};
use crate::ellipse::{self, Ellipse};
use crate::frame::SurfaceFrame;
use crate::material::Surface;
use crate::polygon;
use crate::polygon::{above_horizon, emitted};
use crate::sphere::{self, Sphere};
use crate::texture::Texture;
use crate::tube::{self, Ends, Tube};
use arealight::table::share_above_surface;
use arealight::{Horizon, Light, LightShape, LightTable, LightTexture, Quality, TubeEnds};
use glam::{DAffine3, DMat3, DVec3};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Outgoing radiance by the fitted table, with Lambert's lobe exact: the float64 twin of
/// `arealight_radiance`, as [`super::ltc_on`] is of polygons. `light` is relative to the shading point. With
/// [`Horizon::Both`] outlines are polygons of many sides, which are off by 1e-6. None for polygons and
/// meshes.
///
/// `normal` and `view` have any length above zero; a view below the surface counts as grazing.
pub fn shape_ltc_on(
    quality: Quality,
    table: &LightTable,
    surface: &Surface,
    normal: DVec3,
    view: DVec3,
    light: &Light,
) -> Option<DVec3> {
    let frame = SurfaceFrame::new(normal, view);
    let surface = &surface.without_film(frame.cos_view());
    let seen = LocalShape::new(light, &frame)?;
    let both_horizons = quality.horizon == Horizon::Both;
    // Integrate the transformed cosine
    let lobe = |inverse: &DMat3, above_surface: f64| {
        let form_factor = if both_horizons {
            // What is clipped at the surface's horizon is made up for, so that the albedo stays
            seen.cut_form_factor(inverse) / above_surface
        } else {
            seen.form_factor(inverse)
        };
        DVec3::splat(form_factor.min(1.0))
    };
    let glossy = glossy_part(quality, table, surface, &frame, lobe);
    let (inverse, albedo) = diffuse::lobe(quality, table, surface, &frame);
    let diffuse = if inverse == DMat3::IDENTITY {
        DVec3::splat(seen.lambert_form_factor())
    } else {
        lobe(&inverse, share_above_surface(&inverse))
    };
    let parts = [albedo * diffuse, glossy];
    let of_coat = |coat: &CoatLobe| coat.albedo * lobe(&coat.inverse, coat.above_surface);
    Some(light.radiance.as_dvec3() * layered(quality, table, surface, &frame, parts, (lobe, of_coat)))
}

/// Outgoing radiance of a shape by adaptive cubature of the true BRDF, as [`super::truth`] is of polygons.
/// `light` is relative to the shading point.
///
/// A silhouette is drawn as polygons of 48, 96 and 192 sides a rim, and what they lack is extrapolated away;
/// [`Truth::error`] has what the last step changed, too. None for polygons and meshes.
///
/// `normal` and `view` have any length above zero; a view below the surface counts as grazing.
pub fn shape_truth(
    surface: &Surface,
    normal: DVec3,
    view: DVec3,
    light: &Light,
    settings: &Settings,
) -> Option<Truth> {
    let truth = coat::layered(surface, normal, view, settings, |surface, normal, view| {
        uncoated_truth(surface, normal, view, light, settings).ok_or(())
    });
    truth.ok()
}

fn uncoated_truth(
    surface: &Surface,
    normal: DVec3,
    view: DVec3,
    light: &Light,
    settings: &Settings,
) -> Option<Truth> {
    let frame = SurfaceFrame::new(normal, view);
    let seen = LocalShape::new(light, &frame)?;
    let radiance = light.radiance.as_dvec3();
    Some(seen.refined_truth(radiance, |region| reflected(surface, &frame, region, settings, |_| DVec3::ONE)))
}

/// The light with its disk, sphere or tube relative to a shading point, as [`shape_ltc_on`] and
/// [`shape_truth`] take it. Polygons and meshes stay as they are: [`RelativeLight`](super::RelativeLight) is
/// theirs.
pub fn shape_seen_from(light: &Light, point: DVec3) -> Light {
    let shape = match &light.shape {
        polygonal @ (LightShape::Polygon(_) | LightShape::Mesh { .. }) => polygonal.clone(),
        round => round.moved(&DAffine3::from_translation(-point)),
    };
    Light { shape, ..light.clone() }
}

/// A shape in the surface's frame.
pub(super) enum LocalShape {
    Ellipse { ellipse: Ellipse, two_sided: bool },
    Sphere { sphere: Sphere, two_sided: bool },
    Tube(Tube),
}

impl LocalShape {
    /// None for a polygon or mesh.
    pub(super) fn new(light: &Light, frame: &SurfaceFrame) -> Option<Self> {
        let two_sided = light.two_sided;
        Some(match light.shape {
            LightShape::Polygon(_) | LightShape::Mesh { .. } => return None,
            LightShape::Disk { center, axis_u, axis_v } => {
                let [center, axis_u, axis_v] = [center, axis_u, axis_v].map(|v| frame.to_surface(v));
                Self::Ellipse { ellipse: Ellipse { center, axis_u, axis_v }, two_sided }
            }
            LightShape::Sphere { center, radius } => {
                Self::Sphere { sphere: Sphere { center: frame.to_surface(center), radius }, two_sided }
            }
            LightShape::Tube { p0, p1, radius, ends } => {
                let ends = match ends {
                    TubeEnds::Open => Ends::Open,
                    TubeEnds::Flat => Ends::Flat,
                    TubeEnds::Round => Ends::Round,
                };
                let [start, end] = [p0, p1].map(|v| frame.to_surface(v));
                Self::Tube(Tube { start, end, radius, ends })
            }
        })
    }

    /// What is sent of a light of this radiance, `of` saying it of regions: of silhouettes as polygons of 48,
    /// 96 and 192 sides a rim, whose lack is extrapolated away.
    pub(super) fn refined_truth(&self, radiance: DVec3, of: impl Fn(&Region) -> Truth) -> Truth {
        let at = |count| {
            let signed = of(&self.region(count));
            Truth { radiance: radiance * signed.radiance.abs(), error: radiance * signed.error, ..signed }
        };
        let truths = [48, 96, 192].map(at);
        let (value, step) = refined(truths.map(|truth| truth.radiance));
        Truth {
            radiance: value,
            error: truths[2].error + step.abs(),
            evaluations: truths.iter().map(|truth| truth.evaluations).sum(),
        }
    }

    /// The solid angle that it covers where it shines to the point, in [0, 4 pi]. Error 1e-9 where the point
    /// is not nearer than a tenth of the radius.
    pub(super) fn solid_angle(&self) -> f64 {
        match self {
            Self::Sphere { sphere, two_sided } if sphere.is_inside() => {
                if *two_sided {
                    2.0 * TAU
                } else {
                    0.0
                }
            }
            _ => {
                let at = |count| DVec3::splat(polygon::solid_angle(&self.outline(count)).abs());
                refined([100, 200, 400].map(at)).0.x
            }
        }
    }

    /// The directions that it covers where it shines to the point, by a polygon of `count` sides a rim.
    fn region(&self, count: usize) -> Region {
        match self {
            Self::Sphere { sphere, two_sided: true } if sphere.is_inside() => Region::sphere(),
            _ => Region::polygon(&self.outline(count)),
        }
    }

    /// The outline of what shines to the point from outside of it, by a polygon of `count` sides a rim.
    fn outline(&self, count: usize) -> Vec<DVec3> {
        match self {
            Self::Ellipse { ellipse, two_sided } if *two_sided || ellipse.shows_front() => {
                ellipse.polygon(count)
            }
            Self::Ellipse { .. } => Vec::new(),
            Self::Sphere { sphere, .. } => {
                sphere.silhouette().map_or_else(Vec::new, |disk| disk.polygon(count))
            }
            Self::Tube(tube) => tube.outline(count),
        }
    }

    /// The form factor in the Lambert lobe's space.
    fn lambert_form_factor(&self) -> f64 {
        match self {
            Self::Sphere { sphere, .. } if !sphere.is_inside() => sphere::form_factor(sphere),
            _ => self.form_factor(&DMat3::IDENTITY),
        }
    }

    /// The form factor in a lobe's cosine space, whose horizon alone clips.
    pub(super) fn form_factor(&self, inverse: &DMat3) -> f64 {
        match self {
            Self::Ellipse { ellipse, two_sided } => {
                // A transform that mirrors turns front to back
                let signed = ellipse::form_factor(&ellipse.transformed(inverse));
                emitted(signed * inverse.determinant().signum(), *two_sided)
            }
            Self::Sphere { sphere, two_sided } if sphere.is_inside() => f64::from(u8::from(*two_sided)),
            Self::Sphere { sphere, .. } => sphere::transformed_form_factor(inverse, sphere),
            Self::Tube(tube) => tube::transformed_form_factor(inverse, tube),
        }
    }

    /// The form factor of what is above the surface, in a lobe's cosine space.
    fn cut_form_factor(&self, inverse: &DMat3) -> f64 {
        let cut =
            |outline: &[DVec3]| polygon::transformed_form_factor(inverse, &above_horizon(outline)).abs();
        match self {
            Self::Ellipse { ellipse, two_sided } if *two_sided || ellipse.shows_front() => {
                cut(&outline_of_its_area(ellipse, 1024))
            }
            Self::Ellipse { .. } => 0.0,
            Self::Sphere { sphere, .. } => match sphere.silhouette() {
                Some(disk) => cut(&outline_of_its_area(&disk, 1024)),
                None => self.form_factor(inverse),
            },
            Self::Tube(tube) => {
                let (coarse, fine) = (cut(&tube.outline(250)), cut(&tube.outline(500)));
                fine + (fine - coarse) / 3.0
            }
        }
    }
}

/// What values of inscribed polygons whose sides are halved twice tend to, and the last step there: what such
/// a polygon lacks shrinks by four when its sides are halved, and what is left by sixteen.
fn refined([coarse, middle, fine]: [DVec3; 3]) -> (DVec3, DVec3) {
    let first = middle + (middle - coarse) / 3.0;
    let second = fine + (fine - middle) / 3.0;
    let step = (second - first) / 15.0;
    (second + step, step)
}

/// A polygon of `count` sides that has the area of an ellipse.
fn outline_of_its_area(ellipse: &Ellipse, count: usize) -> Vec<DVec3> {
    let angle = TAU / count as f64;
    let growth = (angle / angle.sin()).sqrt();
    let grown = Ellipse { axis_u: ellipse.axis_u * growth, axis_v: ellipse.axis_v * growth, ..*ellipse };
    grown.polygon(count)
}

/// A disk textured with `texture`, as a polygon of its area; what they differ in is 1e-5 of what it sends.
/// None for other shapes.
pub fn textured_ellipse(light: &Light, texture: Arc<Texture>) -> Option<RelativeLight> {
    const COUNT: usize = 64;
    let LightShape::Disk { center, axis_u, axis_v } = light.shape else { return None };
    // Turned by half a side, the polygon stays within the image
    let (sin, cos) = (0.5 * TAU / COUNT as f64).sin_cos();
    let turned = Ellipse { center, axis_u: axis_u * cos + axis_v * sin, axis_v: axis_v * cos - axis_u * sin };
    let map = LightTexture { layer: 0, uvs: vec![] }.map(&light.shape).ok()?;
    Some(RelativeLight {
        vertices: outline_of_its_area(&turned, COUNT),
        radiance: light.radiance.as_dvec3(),
        two_sided: light.two_sided,
        image: Some(ShownImage { texture, map }),
        ..RelativeLight::default()
    })
}
