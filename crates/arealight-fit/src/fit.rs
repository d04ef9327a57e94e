//! The fit of a whole table.

use arealight::{LightTable, MIN_ALPHA, TableDescription};
use rayon::prelude::*;

use crate::brdf::{Brdf, Magnitude};
use crate::error::FitError;
use crate::lobe::Lobe;
use crate::nodes::Texel;
use crate::solve::{Loss, Problem};

/// How a table is fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Nodes a side, 2 to [`arealight::table::MAX_SIZE`].
    pub size: u32,
    /// What is minimised at each node.
    pub loss: Loss,
    /// How often each texel is fitted again from the best of its neighbours.
    pub passes: u32,
}

impl Default for Settings {
    fn default() -> Self {
        Self { size: 64, loss: Loss::default(), passes: 1 }
    }
}

/// Fits a table to a BRDF.
///
/// The first pass runs each column (a roughness) from the normal to the horizon, each texel starting from
/// the one before. Later passes fit each texel again from the best of its neighbours of the pass before. No
/// texel depends on one of the same pass in another column, so the result is the same on any number of
/// threads.
///
/// `progress` is called from any thread after each texel with the number of texels done and the number to do.
///
/// # Errors
/// [`FitError`] if the settings are out of range, or the BRDF yields no lobe at some texel.
pub fn fit(
    brdf: &dyn Brdf,
    settings: &Settings,
    progress: &(dyn Fn(u64, u64) + Sync),
) -> Result<LightTable, FitError> {
    settings.check()?;
    let size = settings.size as usize;
    let done = std::sync::atomic::AtomicU64::new(0);
    let total = (size * size) as u64 * u64::from(settings.passes + 1);
    let report = || progress(done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1, total);

    // Integrate the albedos
    let magnitude: Vec<Magnitude> = (0..size * size)
        .into_par_iter()
        .map(|i| {
            let (alpha, cos_view) = node_of(settings.size, i);
            brdf.magnitude(alpha, cos_view)
        })
        .collect();
    let texel = |i: usize| {
        let (alpha, cos_view) = node_of(settings.size, i);
        Texel { brdf, alpha, cos_view, magnitude: magnitude[i] }
    };

    // Fit each column from the normal to the horizon
    let columns: Vec<Vec<Lobe>> = (0..size)
        .into_par_iter()
        .map(|x| {
            let mut lobe = start_at_normal(texel(x).alpha);
            (0..size)
                .map(|y| {
                    let texel = texel(y * size + x);
                    lobe = texel.fit(&settings.loss, lobe, &[lobe]);
                    report();
                    lobe
                })
                .collect()
        })
        .collect();
    let mut lobes: Vec<Lobe> = (0..size * size).map(|i| columns[i % size][i / size]).collect();

    // Fit again from the best of the neighbours
    for _ in 0..settings.passes {
        lobes = (0..size * size)
            .into_par_iter()
            .map(|i| {
                let candidates: Vec<Lobe> = neighbours(size, i).map(|n| lobes[n]).collect();
                let lobe = texel(i).fit(&settings.loss, lobes[i], &candidates);
                report();
                lobe
            })
            .collect();
    }
    into_table(brdf, settings, &lobes, &magnitude)
}

impl Texel<'_> {
    /// Fits from the best of the candidates, on nodes laid out by `guess`.
    fn fit(&self, loss: &Loss, guess: Lobe, candidates: &[Lobe]) -> Lobe {
        let guess = Lobe { alpha: self.alpha, ..guess };
        let nodes = self.nodes(&guess);
        let problem = Problem::new(loss, &nodes, self.magnitude);
        let start = candidates
            .iter()
            .map(|candidate| Lobe { alpha: self.alpha, ..*candidate })
            .map(|candidate| (candidate, problem.loss(&candidate)))
            .fold((guess, problem.loss(&guess)), |best, new| if new.1 < best.1 { new } else { best });
        problem.minimise(start.0).0
    }
}

/// The alpha and the view's cosine at which texel `i` is fitted.
///
/// The first column's alpha lies below the smallest that is shaded, so that a lookup there interpolates
/// towards a mirror. The last row stays off the horizon: exactly on it a lobe degenerates to a fan that is
/// `alpha²` wide, and interpolating towards that would narrow every lobe of the last cell.
fn node_of(size: u32, i: usize) -> (f64, f64) {
    let (roughness, cos_view) = LightTable::node(size, i as u32 % size, i as u32 / size);
    ((roughness * roughness).max(0.01 * MIN_ALPHA), cos_view.max(MIN_COS_VIEW))
}

/// Of the view 0.06 degrees above the horizon.
const MIN_COS_VIEW: f64 = 1e-3;

/// At the normal, GGX of a small alpha is a transformed cosine exactly: `tan theta_light = 2 alpha tan theta`.
fn start_at_normal(alpha: f64) -> Lobe {
    Lobe { texel: [1.0, 0.0, 0.0, 2.0 / (1.0 + alpha)], alpha }
}

/// A texel's four neighbours.
fn neighbours(size: usize, i: usize) -> impl Iterator<Item = usize> {
    let (x, y) = (i % size, i / size);
    let left = (x > 0).then(|| i - 1);
    let right = (x + 1 < size).then(|| i + 1);
    let up = (y > 0).then(|| i - size);
    let down = (y + 1 < size).then(|| i + size);
    [left, right, up, down].into_iter().flatten()
}

fn into_table(
    brdf: &dyn Brdf,
    settings: &Settings,
    lobes: &[Lobe],
    magnitude: &[Magnitude],
) -> Result<LightTable, FitError> {
    let description = TableDescription {
        brdf: brdf.name().to_owned(),
        made_by: format!("arealight-fit {} ({:?})", env!("CARGO_PKG_VERSION"), settings.loss),
    };
    let matrix = lobes.iter().map(|lobe| lobe.texel.map(|q| q as f32)).collect();
    let magnitude = magnitude.iter().map(|m| [m.albedo as f32, m.schlick as f32]).collect();
    Ok(LightTable::new(description, settings.size, matrix, magnitude)?)
}

impl Settings {
    fn check(&self) -> Result<(), FitError> {
        let loss = &self.loss;
        let out_of = |setting, value, range| Err(FitError::Setting { setting, value, range });
        if !(2..=arealight::table::MAX_SIZE).contains(&self.size) {
            return out_of("size", f64::from(self.size), "2 to 1024");
        }
        if !(1.0..=2.0).contains(&loss.exponent) {
            return out_of("exponent", loss.exponent, "1 to 2");
        }
        if loss.reflectances.is_empty() {
            return out_of("reflectances", 0.0, "at least one");
        }
        for &(f0, weight) in &loss.reflectances {
            if !(0.0..=1.0).contains(&f0) {
                return out_of("f0", f0, "0 to 1");
            }
            if !(weight.is_finite() && weight > 0.0) {
                return out_of("weight", weight, "above 0");
            }
        }
        Ok(())
    }
}
