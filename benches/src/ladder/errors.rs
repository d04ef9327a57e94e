//! How far a frame is from the truth, and which part of it is whose: the fit's, the table's, the integral's.

use super::methods::{Method, Workload};
use super::points::{Point, lights, points};
use crate::footprints;
use crate::school::YardstickTable;
use arealight::{Horizon, Light, LightTable, Lobes, Quality, SpecularLobes};
use arealight_fit::{Aim, GgxBrdf, fit_at};
use arealight_oracle::cubature::Settings;
use arealight_oracle::frame::SurfaceFrame;
use arealight_oracle::shading::{RelativeLight, ltc_on, truth};
use arealight_oracle::texture::Texture;
use glam::DVec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Errors over the mean of the truth, all channels alike.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Points judged.
    pub points: usize,
    /// Root of the mean square.
    pub rmse: f64,
    /// Quantile of .99 of the largest channel's.
    pub p99: f64,
    /// The largest.
    pub worst: f64,
    /// The mean: how much too bright.
    pub bias: f64,
    /// How many answers are NaN or infinite; they are left out of the others.
    pub not_finite: usize,
}

impl Errors {
    /// Of answers beside what they should be.
    pub fn of<'a>(pairs: impl Iterator<Item = (&'a DVec3, &'a DVec3)>) -> Self {
        let (mut finite, mut not_finite) = (vec![], 0);
        for (found, expected) in pairs {
            if found.is_finite() { finite.push((*found, *expected)) } else { not_finite += 1 }
        }
        let count = finite.len().max(1) as f64 * 3.0;
        let truth = finite.iter().map(|(_, expected)| expected.element_sum()).sum::<f64>();
        // Of nothing there is no mean
        let mean = if finite.is_empty() { 1.0 } else { truth / count };
        let square: f64 = finite.iter().map(|(found, expected)| (*found - *expected).length_squared()).sum();
        let sum: f64 = finite.iter().map(|(found, expected)| (*found - *expected).element_sum()).sum();
        let mut largest: Vec<f64> =
            finite.iter().map(|(found, expected)| (*found - *expected).abs().max_element()).collect();
        largest.sort_by(f64::total_cmp);
        let last = largest.len().saturating_sub(1);
        let quantile = |part: f64| largest.get((part * last as f64).round() as usize).copied().unwrap_or(0.0);
        Self {
            points: finite.len() + not_finite,
            rmse: (square / count).sqrt() / mean,
            p99: quantile(0.99) / mean,
            worst: quantile(1.0) / mean,
            bias: sum / count / mean,
            not_finite,
        }
    }
}

/// Errors with their parts, each as the root of its mean square over the mean of the truth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SplitErrors {
    /// All of it: the device's answer against the integral of the true BRDF.
    pub all: Errors,
    /// What the lobes cannot follow: those fitted to just this roughness and view, integrated in float64,
    /// against the truth.
    pub fit: f64,
    /// What the table's nodes, or the formula, lose between them: integrals of their lobes against those of
    /// the fit. None of a yardstick with a table of its own, to which no lobes are fitted point by point:
    /// then `fit` holds both.
    pub table: Option<f64>,
    /// What the device's integral loses: its answer against the table's lobes integrated in float64.
    pub integral: f64,
}

/// The points of a workload, with what is known of them.
pub struct Known {
    /// The points.
    pub points: Vec<Point>,
    /// The lights.
    pub lights: Vec<Light>,
    /// Integral of the true BRDF at each point.
    pub truths: Vec<DVec3>,
    relative: Vec<Vec<RelativeLight>>,
    fits: Vec<LightTable>,
    /// The yardsticks' table.
    published: LightTable,
    /// What was integrated of the lobes so far.
    integrals: Vec<(Integrand, Vec<DVec3>)>,
}

/// What the integrals of lobes depend on.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Integrand {
    both_horizons: bool,
    specular_lobes: SpecularLobes,
    lobes: LobesFrom,
}

/// Where a lobe comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
enum LobesFrom {
    /// Fitted to each point.
    Fit,
    /// Our table, or the formula.
    Ours(Lobes),
    /// The yardsticks' table.
    Published,
}

/// Estimates of 1e-4 of the integral: errors of about 1e-6, a hundredth of the smallest that is looked for.
const CUBATURE: Settings = Settings { relative_tolerance: 1e-4, max_evaluations: 400_000 };

impl Known {
    /// Integrates `count` points of a workload. `progress` is called for each from any thread.
    pub fn new(
        workload: &Workload,
        count: usize,
        seed: u64,
        table: &LightTable,
        pictures: &[Arc<Texture>],
        progress: &(dyn Fn(u64) + Sync),
    ) -> Self {
        let (points, lights) = (points(workload.lights, count, seed), lights(workload.lights));
        let relative = |point: &Point| -> Vec<RelativeLight> {
            let position = point.position.as_dvec3();
            let relative = |light: &Light| match &light.texture {
                None => RelativeLight::new(light, position),
                Some(texture) => {
                    let picture = Arc::clone(&pictures[texture.layer as usize]);
                    RelativeLight::textured(light, position, picture).expect("our own lights map")
                }
            };
            lights.iter().map(relative).collect()
        };
        let relative: Vec<Vec<RelativeLight>> = points.iter().map(relative).collect();
        let known = points.par_iter().zip(&relative).map(|(point, lights)| {
            let (surface, normal, view) = (point.surface(), point.normal.as_dvec3(), point.view());
            let integral: DVec3 =
                lights.iter().map(|light| truth(&surface, normal, view, light, &CUBATURE).radiance).sum();
            let cos_view = SurfaceFrame::new(normal, view).cos_view();
            // Where no lobe can be fitted, the table's is as good as any
            let fit = fit_at(&GgxBrdf, &Aim::ByF0, table, surface.alpha.sqrt(), cos_view)
                .unwrap_or_else(|_| table.clone());
            progress(1);
            (integral, fit)
        });
        let (truths, fits) = known.unzip();
        let published = crate::published::table();
        Self { points, lights, truths, relative, fits, published, integrals: vec![] }
    }

    /// Judges what a method made of the points.
    pub fn judge(&mut self, method: Method, table: &LightTable, found: &[DVec3]) -> SplitErrors {
        let quality = match method {
            Method::Level { quality, .. } => quality,
            Method::Yardstick { .. } | Method::Samples { .. } => Quality::default(),
        };
        let has_published =
            matches!(method, Method::Yardstick { table: YardstickTable::PublishedQuality, .. });
        let integrand = Integrand {
            both_horizons: quality.horizon == Horizon::Both,
            specular_lobes: quality.specular_lobes,
            lobes: if has_published { LobesFrom::Published } else { LobesFrom::Ours(quality.lobes) },
        };
        let of_table = self.integrals(integrand, table).to_vec();
        let of_fit = if has_published {
            of_table.clone()
        } else {
            self.integrals(Integrand { lobes: LobesFrom::Fit, ..integrand }, table).to_vec()
        };
        let truths = &self.truths;

        let all = Errors::of(found.iter().zip(truths));
        // Parts are over the mean of the truth as the whole is
        let mean: f64 = truths.iter().map(|truth| truth.element_sum()).sum();
        let part = |found: &[DVec3], expected: &[DVec3]| {
            let finite = found.iter().zip(expected).filter(|(found, _)| found.is_finite());
            let count = truths.len().max(1) as f64 * 3.0;
            let square: f64 = finite.map(|(found, expected)| (*found - *expected).length_squared()).sum();
            (square / count).sqrt() / (mean / count)
        };
        SplitErrors {
            all,
            fit: part(&of_fit, truths),
            table: (!has_published).then(|| part(&of_table, &of_fit)),
            integral: part(found, &of_table),
        }
    }

    /// What lobes give at every point, integrated in float64. Once for all methods: of textured lights it
    /// takes long.
    fn integrals(&mut self, of: Integrand, table: &LightTable) -> &[DVec3] {
        let done = self.integrals.iter().position(|(done, _)| *done == of);
        let index = done.unwrap_or_else(|| {
            let integrals = self.integrate(of, table);
            self.integrals.push((of, integrals));
            self.integrals.len() - 1
        });
        &self.integrals[index].1
    }

    fn integrate(&self, of: Integrand, table: &LightTable) -> Vec<DVec3> {
        let Integrand { both_horizons, specular_lobes, lobes } = of;
        let horizon = if both_horizons { Horizon::Both } else { Horizon::Cosine };
        let kind = if let LobesFrom::Ours(kind) = lobes { kind } else { Lobes::Table };
        let quality = Quality { horizon, specular_lobes, lobes: kind, ..Quality::default() };
        let points = self.points.par_iter().zip(&self.relative).zip(&self.fits);
        let integral = |((point, lights), fit): ((&Point, &Vec<RelativeLight>), &LightTable)| {
            let (surface, normal, view) = (point.surface(), point.normal.as_dvec3(), point.view());
            let table = match lobes {
                LobesFrom::Fit => fit,
                LobesFrom::Ours(_) => table,
                LobesFrom::Published => &self.published,
            };
            lights.iter().map(|light| ltc_on(quality, table, &surface, normal, view, light)).sum()
        };
        points.map(integral).collect()
    }

    /// What Monte Carlo's answers err by.
    pub fn noise(&self, answers: &[Vec<DVec3>]) -> Errors {
        Errors::of(answers.iter().flat_map(|found| found.iter().zip(&self.truths)))
    }
}

/// The images that the textured lights show: those that [lookups are judged by](crate::footprints), and noise
/// again.
pub fn pictures() -> Vec<Arc<Texture>> {
    let mut pictures = footprints::judged_pictures();
    pictures.push(footprints::noise(2));
    pictures
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_over_the_mean_and_leave_out_what_is_no_number() {
        let truth = [DVec3::splat(1.0), DVec3::splat(3.0), DVec3::splat(2.0)];
        let found = [DVec3::splat(1.2), DVec3::splat(3.0), DVec3::splat(f64::NAN)];
        let errors = Errors::of(found.iter().zip(&truth));
        assert_eq!((errors.points, errors.not_finite), (3, 1));
        assert!((errors.bias - 0.05).abs() < 1e-12 && (errors.worst - 0.1).abs() < 1e-12, "{errors:?}");
        assert!((errors.rmse - 0.02_f64.sqrt() / 2.0).abs() < 1e-12, "{errors:?}");
        let exact = Errors::of(truth.iter().zip(&truth));
        assert_eq!((exact.rmse, exact.worst, exact.bias), (0.0, 0.0, 0.0));
    }

    #[test]
    fn the_parts_of_an_error_are_told_apart() {
        let table = LightTable::ggx();
        let workload = &super::super::methods::workloads()[0];
        let mut known = Known::new(workload, 24, 5, &table, &pictures(), &|_| {});
        let exact = workload.methods.iter().find(|method| method.name == "exact").unwrap().method;
        // The table's lobes in float64: all that is left is the fit's and the table's
        let of_table = Integrand {
            both_horizons: false,
            specular_lobes: SpecularLobes::One,
            lobes: LobesFrom::Ours(Lobes::Table),
        };
        let of_table = known.integrate(of_table, &table);
        let errors = known.judge(exact, &table, &of_table);
        assert_eq!(errors.integral, 0.0);
        assert!(
            errors.fit > 1e-3 && errors.fit < 0.1 && errors.table.unwrap() < 0.5 * errors.fit,
            "{errors:?}"
        );
        // Twice the light is an error of the integral alone
        let twice: Vec<DVec3> = of_table.iter().map(|radiance| *radiance * 2.0).collect();
        let wrong = known.judge(exact, &table, &twice);
        assert!(wrong.integral > 0.5 && wrong.fit == errors.fit, "{wrong:?}");
        // Of the truth itself nothing is left
        let truths = known.truths.clone();
        assert!(known.judge(exact, &table, &truths).all.rmse < 1e-12);
    }
}
