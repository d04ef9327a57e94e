//! How well a table does: its polygon integrals against the true BRDF's on random quads.

use arealight::table::share_above_surface;
use arealight::{Horizon, LightTable, SpecularLobes, TableSample};
use arealight_oracle::cubature::{Region, Settings};
use arealight_oracle::ggx::Ggx;
use arealight_oracle::polygon::{above_horizon, transformed_form_factor};
use arealight_oracle::shading::lobe_integrals;
use glam::{DMat3, DVec3};
use rayon::prelude::*;

use crate::brdf::view_direction;

mod quads;

pub use quads::{Family, Quad, near_mirror_quads, random_quads};

/// How a table is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Level {
    /// One integral or two.
    pub specular_lobes: SpecularLobes,
    /// Where quads are clipped. With [`Horizon::Both`] what is left of the lobe is scaled to keep its energy
    /// ([`share_above_surface`]).
    pub horizon: Horizon,
}

/// The reflectances at normal incidence at which a table is judged: dielectrics to metals.
pub const REFLECTANCES: [f64; 7] = [0.02, 0.04, 0.1, 0.2, 0.4, 0.7, 1.0];

/// Metals whose reflectance has a colour.
pub const METALS: [(&str, DVec3); 2] =
    [("gold", DVec3::new(1.0, 0.766, 0.336)), ("copper", DVec3::new(0.955, 0.638, 0.538))];

/// How many quads a report is drawn up on, and the seed that draws them.
pub const COUNT: usize = 3000;
/// See [`COUNT`].
pub const SEED: u64 = 1;

/// The errors on the same quads of the 64² table published with Heitz et al. 2016, *Real-Time Polygonal-Light
/// Shading with Linearly Transformed Cosines*, evaluated in float64 with exact clipping.
pub const PUBLISHED: [Errors; 7] = [
    Errors { f0: 0.02, mean: 0.00140, percentile_95: 0.0088, max: 0.040 },
    Errors { f0: 0.04, mean: 0.00131, percentile_95: 0.0085, max: 0.039 },
    Errors { f0: 0.1, mean: 0.00123, percentile_95: 0.0067, max: 0.045 },
    Errors { f0: 0.2, mean: 0.00159, percentile_95: 0.0077, max: 0.065 },
    Errors { f0: 0.4, mean: 0.00312, percentile_95: 0.0155, max: 0.104 },
    Errors { f0: 0.7, mean: 0.00588, percentile_95: 0.0310, max: 0.163 },
    Errors { f0: 1.0, mean: 0.00881, percentile_95: 0.0468, max: 0.234 },
];

/// A quad with the true integrals of GGX over it.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// The quad, the view and the roughness.
    pub quad: Quad,
    /// Integral of `f cos` over the part above the surface.
    pub lobe: f64,
    /// Integral of `f cos (1 - cos theta_vh)^5` over the same.
    pub schlick: f64,
}

/// The absolute errors of the integral of a lobe over many quads of unit radiance, at one reflectance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// The reflectance at normal incidence.
    pub f0: f64,
    /// Their mean.
    pub mean: f64,
    /// Below which 95 % of them lie.
    pub percentile_95: f64,
    /// The largest.
    pub max: f64,
}

/// Draws quads and integrates GGX over them. `progress` is called from any thread after each.
pub fn cases(count: usize, seed: u64, progress: &(dyn Fn() + Sync)) -> Vec<Case> {
    integrate(random_quads(count, seed), progress)
}

/// Integrates GGX over quads. `progress` is called from any thread after each.
pub fn integrate(quads: Vec<Quad>, progress: &(dyn Fn() + Sync)) -> Vec<Case> {
    // An estimate of 1e-4 stands for an error of about 1e-6, a thousandth of what is measured
    let settings = Settings { relative_tolerance: 1e-4, max_evaluations: 1_000_000 };
    quads
        .into_par_iter()
        .map(|quad| {
            let lobe = Ggx { alpha: quad.roughness * quad.roughness };
            let region = Region::polygon(&quad.vertices).clipped(DVec3::Z);
            let estimate = lobe_integrals(lobe, view_direction(quad.cos_view), &region, &settings);
            progress();
            let [lobe, schlick] = estimate.value;
            Case { quad, lobe, schlick }
        })
        .collect()
}

/// Measures a table at each of [`REFLECTANCES`].
pub fn measure(table: &LightTable, level: Level, cases: &[Case]) -> Vec<Errors> {
    measure_lookup(|roughness, cos_view| table.lookup(roughness, cos_view), level, cases)
}

/// Measures anything that answers a roughness and a view's cosine with a lobe: tables stored in other ways,
/// or formulas.
pub fn measure_lookup(
    lookup: impl Fn(f64, f64) -> TableSample + Sync,
    level: Level,
    cases: &[Case],
) -> Vec<Errors> {
    REFLECTANCES
        .iter()
        .map(|&f0| Errors { f0, ..measure_f0(&lookup, level, DVec3::splat(f0), cases) })
        .collect()
}

/// Measures a table for a reflectance that has a colour. The errors of all channels count alike; `f0` of the
/// result is their mean.
pub fn measure_colour(table: &LightTable, level: Level, f0: DVec3, cases: &[Case]) -> Errors {
    measure_lookup_colour(|roughness, cos_view| table.lookup(roughness, cos_view), level, f0, cases)
}

/// Measures what [`measure_lookup`] does, for a reflectance that has a colour.
pub fn measure_lookup_colour(
    lookup: impl Fn(f64, f64) -> TableSample + Sync,
    level: Level,
    f0: DVec3,
    cases: &[Case],
) -> Errors {
    measure_f0(&lookup, level, f0, cases)
}

fn measure_f0(
    lookup: &(impl Fn(f64, f64) -> TableSample + Sync),
    level: Level,
    f0: DVec3,
    cases: &[Case],
) -> Errors {
    let errors: Vec<[f64; 3]> = cases
        .par_iter()
        .map(|case| {
            let sample = lookup(case.quad.roughness, case.quad.cos_view);
            let truth = f0 * case.lobe + (1.0 - f0) * case.schlick;
            (radiance(&sample, level, f0, &case.quad.vertices) - truth).abs().to_array()
        })
        .collect();
    summarise(f0.element_sum() / 3.0, errors.into_flattened())
}

/// What a table makes of a quad of unit radiance, with F90 = 1.
fn radiance(sample: &TableSample, level: Level, f0: DVec3, quad: &[DVec3; 4]) -> DVec3 {
    let integral = |inverse: &DMat3| integral(inverse, level.horizon, quad);
    let lobes = sample.lobes(level.specular_lobes, f0, 1.0);
    let parts = lobes.iter().filter(|(_, albedo)| *albedo != DVec3::ZERO);
    parts.map(|(inverse, albedo)| albedo * integral(inverse)).sum()
}

/// The integral of a lobe over a quad, seen from its front.
fn integral(inverse: &DMat3, horizon: Horizon, quad: &[DVec3; 4]) -> f64 {
    match horizon {
        Horizon::Cosine => transformed_form_factor(inverse, quad).max(0.0),
        Horizon::Both => {
            let form_factor = transformed_form_factor(inverse, &above_horizon(quad)).max(0.0);
            form_factor / share_above_surface(inverse)
        }
    }
}

/// Mean, 95th percentile and maximum; zero for no errors at all.
fn summarise(f0: f64, mut errors: Vec<f64>) -> Errors {
    errors.sort_by(f64::total_cmp);
    let mean = errors.iter().sum::<f64>() / errors.len().max(1) as f64;
    let percentile_95 = errors.get(errors.len() * 95 / 100).copied().unwrap_or(0.0);
    Errors { f0, mean, percentile_95, max: errors.last().copied().unwrap_or(0.0) }
}
