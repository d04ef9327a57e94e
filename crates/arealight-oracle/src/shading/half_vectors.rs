//! GGX integrated over half vectors, in float64: the twin of `lobes/half_vectors.glsl`.
//!
//! The visible normals of GGX are a clamped cosine about the stretched view (Heitz 2018), so that the normals
//! which mirror a light to the viewer are integrated in closed form once their outline is known. An edge of a
//! light is an arc of directions; its half vectors are an arc of a conic, which is drawn by chords. Masking
//! and the Fresnel term are taken at the mean of these normals.

use super::{faces_origin, fitted_sample};
use crate::frame::SurfaceFrame;
use crate::ggx::AnisotropicGgx;
use crate::material::Surface;
use crate::polygon::{above_horizon, vector_of_arc};
use crate::thin_film::ThinFilm;
use arealight::{LightTable, Quality, TableSample};
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::TAU;

/// An edge, or a part of one, is halved where the middle of its half vectors is farther from an end than this
/// cosine.
const BENT: f64 = 0.7;

/// How often, at most.
const MOST_HALVINGS: u32 = 5;

/// How many times the reflectance of the mean normal the mean reflectance may be: more than it is of any lobe
/// with an F0 from .04 on.
const MOST_OF_MEAN: f64 = 2.0;

/// What two chords of a conic lack, over the triangle that they make with the third.
const SEGMENT: f64 = 0.4;

/// The facets of a surface as a viewer sees them.
#[derive(Debug, Clone, Copy)]
pub(super) struct HalfVectors {
    /// From the surface frame into the axes of the distribution: x along the first alpha, z the normal.
    to_axes: DMat3,
    alpha: DVec2,
    /// The direction to the viewer, in these axes.
    view: DVec3,
    /// Reflectances at normal and at grazing incidence, below the film.
    f0: DVec3,
    f90: f64,
    film: Option<ThinFilm>,
    /// How much more a light counts than its mean normal says, over its share of the visible normals: of
    /// light from everywhere what makes the albedo.
    gain: DVec3,
    /// What is reflected of light from everywhere, at most.
    albedo: DVec3,
}

impl HalfVectors {
    /// Of a surface's specular lobe; `sample` has its albedos. Of a film each light sees what facets of one
    /// angle reflect, and light from everywhere what Schlick's term does that stands for it.
    pub fn of_surface(surface: &Surface, frame: &SurfaceFrame, sample: &TableSample) -> Self {
        let (axis, alpha) = match AnisotropicGgx::of(surface, frame) {
            None => (DVec2::X, DVec2::splat(surface.alpha)),
            Some(lobe) => (lobe.axis, lobe.alpha.max(DVec2::splat(lobe.alpha.max_element() / MOST_ASPECT))),
        };
        let to_axes = DMat3::from_cols(
            axis.with_y(-axis.y).extend(0.0),
            DVec2::new(axis.y, axis.x).extend(0.0),
            DVec3::Z,
        );
        let alpha = alpha.max(DVec2::splat(arealight::MIN_ALPHA));
        let stand_in = surface.without_film(frame.cos_view());
        let albedo = stand_in.f0.map(|f0| sample.specular_albedo(f0, stand_in.f90));
        Self { film: surface.film, ..Self::new(to_axes, alpha, frame.view(), (surface.f0, surface.f90)) }
            .with_albedo(albedo)
    }

    /// Of a coat: a surface of its own, of one alpha.
    pub fn of_coat(
        quality: Quality,
        table: &LightTable,
        alpha: f64,
        [f0, f90]: [f64; 2],
        (own, to_own): (&SurfaceFrame, DMat3),
    ) -> Self {
        let sample = fitted_sample(quality, table, alpha, own.cos_view());
        let alpha = DVec2::splat(alpha.max(arealight::MIN_ALPHA));
        let albedo = sample.specular_albedo(f0, f90);
        let facets = Self::new(DMat3::IDENTITY, alpha, own.view(), (DVec3::splat(f0), f90));
        Self { to_axes: to_own, ..facets.with_albedo(DVec3::splat(albedo)) }
    }

    fn new(to_axes: DMat3, alpha: DVec2, view: DVec3, (f0, f90): (DVec3, f64)) -> Self {
        // Along the surface the half vectors of light that passes straight on have no direction
        let least = (1e-5 / alpha.min_element()).clamp(1e-3, 1e-2);
        let view = to_axes * view.with_z(view.z.max(least)).normalize_or(DVec3::Z);
        Self { to_axes, alpha, view, f0, f90, film: None, gain: DVec3::ZERO, albedo: DVec3::ONE }
    }

    /// The same, reflecting so much of light from everywhere above the horizon.
    fn with_albedo(self, albedo: DVec3) -> Self {
        let sky = self.sky();
        let share = self.share(sky).max(1e-6);
        let mean = albedo / share / self.reflectance(sky).max(DVec3::splat(1e-30));
        Self { gain: (mean.min(DVec3::splat(MOST_OF_MEAN)) - DVec3::ONE) / share, albedo, ..self }
    }

    /// The middle of the visible normals where alpha is 1.
    fn pole(&self) -> DVec3 {
        (self.view * self.alpha.extend(1.0)).normalize_or(DVec3::Z)
    }

    /// What the facet of this normal, where alpha is 1, reflects to the viewer, with masking of the light: a
    /// channel.
    fn reflectance(&self, normal: DVec3) -> DVec3 {
        let stretch = self.alpha.extend(1.0);
        let half = (normal * stretch).normalize_or(DVec3::Z);
        let cosine = self.view.dot(half).clamp(0.0, 1.0);
        let light = 2.0 * cosine * half - self.view;
        let height = light.z.max(0.0);
        let (by_view, by_light) = ((self.view * stretch).length(), (light.with_z(height) * stretch).length());
        let shadowing =
            (by_view + self.view.z) * height / (by_view * height + by_light * self.view.z).max(1e-30);
        let fresnel = match &self.film {
            None => self.f0 + (DVec3::splat(self.f90) - self.f0) * (1.0 - cosine).powi(5),
            Some(film) => film.reflectance(self.f0, self.f90, cosine),
        };
        shadowing.min(1.0) * fresnel
    }

    /// What they reflect of a polygon of unit radiance in the surface frame, a channel; a polygon that is
    /// seen from its back counts if `two_sided`.
    pub fn reflected(&self, vertices: &[DVec3], two_sided: bool) -> DVec3 {
        let in_axes: Vec<DVec3> = vertices.iter().map(|vertex| self.to_axes * *vertex).collect();
        let outline: Vec<DVec3> =
            above_horizon(&in_axes).iter().map(|vertex| vertex.normalize_or(DVec3::Z)).collect();
        let vector = self.vector(&outline);
        let vector = if two_sided && !faces_origin(vertices) { -vector } else { vector };
        let share = self.share(vector);
        if share == 0.0 {
            return DVec3::ZERO;
        }
        (share * self.reflectance(vector) * (DVec3::ONE + self.gain * share)).min(self.albedo)
    }

    /// The vector form factor of an outline of directions in the axes, none below their horizon.
    fn vector(&self, outline: &[DVec3]) -> DVec3 {
        let next = outline.iter().cycle().skip(1);
        let arcs: DVec3 = outline.iter().zip(next).map(|(from, to)| self.edge(*from, *to)).sum();
        -arcs / TAU
    }

    /// That of light from everywhere above their horizon.
    fn sky(&self) -> DVec3 {
        self.vector(&[DVec3::X, DVec3::NEG_Y, DVec3::NEG_X, DVec3::Y])
    }

    /// The part of the visible normals that a vector form factor is of.
    fn share(&self, vector: DVec3) -> f64 {
        let pole = self.pole();
        (vector.dot(pole) * 2.0 / (1.0 + pole.z)).clamp(0.0, 1.0)
    }

    /// The arcs of the conic that the edge between two directions makes.
    fn edge(&self, from: DVec3, to: DVec3) -> DVec3 {
        let shrink = self.alpha.recip().extend(1.0);
        let chord = (from + to).length().max(1e-19);
        let conic = [from + self.view, (from + to) / chord + 0.5 * chord * self.view, to + self.view]
            .map(|half| half * shrink);
        arcs(conic, MOST_HALVINGS)
    }
}

/// How many times the smaller alpha the larger one may be: `LEAST_ROUGHNESS_RATIO` of the fitted lobes.
const MOST_ASPECT: f64 = 400.0;

/// The points between which a conic is halved where both halves are alike: those of its control polygon, and
/// the shoulder between them.
fn shoulder([first, control, last]: [DVec3; 3]) -> [DVec3; 3] {
    let ratio = (last.length() / first.length().max(1e-30)).sqrt();
    let part = 1.0 / (1.0 + ratio);
    let left = control + (first - control) * (1.0 - part);
    let right = last + (control - last) * (1.0 - part);
    [left, right + (left - right) * (1.0 - part), right]
}

/// The arcs of a conic by two chords, as arcs, and what they lack; of its halves where it bends far.
fn arcs(conic: [DVec3; 3], halvings: u32) -> DVec3 {
    let [left, shoulder, right] = shoulder(conic);
    let [from, middle, to] = [conic[0], shoulder, conic[2]].map(DVec3::normalize_or_zero);
    if halvings > 0 && from.dot(middle).min(to.dot(middle)) < BENT {
        let halves = [[conic[0], left, shoulder], [shoulder, right, conic[2]]];
        return halves.into_iter().map(|half| arcs(half, halvings - 1)).sum();
    }
    let lacking = middle.dot((middle - from).cross(to - from));
    vector_of_arc(from, middle) + vector_of_arc(middle, to) + SEGMENT * lacking * middle
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shading::surface_sample;

    /// The least and the most that light from everywhere counts over its mean normal, for every alpha and
    /// view.
    fn means(f0: f64) -> [f64; 2] {
        let table = LightTable::ggx();
        let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
        for (i, j) in (0..=30).flat_map(|i| (0..=30).map(move |j| (f64::from(i) / 30.0, f64::from(j) / 30.0)))
        {
            let surface =
                Surface { f0: DVec3::splat(f0), f90: 1.0, alpha: (i * i).max(1e-3), ..Surface::default() };
            let (sin, cos) = (1.56 * j).sin_cos();
            let frame = SurfaceFrame::new(DVec3::Z, DVec3::new(sin, 0.0, cos));
            let sample = surface_sample(Quality::default(), &table, &surface, &frame);
            let lobe = HalfVectors::of_surface(&surface, &frame, &sample);
            let mean = 1.0 + lobe.gain.x * lobe.share(lobe.sky());
            (least, most) = (least.min(mean), most.max(mean));
        }
        [least, most]
    }

    #[test]
    fn the_bound_to_the_mean_changes_no_lobe_of_a_metal_or_a_usual_dielectric() {
        for f0 in [0.04, 0.2, 1.0] {
            let [least, most] = means(f0);
            assert!(least > 0.5 && most < 0.99 * MOST_OF_MEAN, "{f0}: {least} {most}");
        }
        // The twin: without F0 it does
        assert!(means(0.0)[1] > 0.99 * MOST_OF_MEAN);
    }
}
