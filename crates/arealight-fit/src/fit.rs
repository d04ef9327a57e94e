//! The fit of a whole table.

use arealight::table::{LobePairs, mirror_frame};
use arealight::{LightTable, MIN_ALPHA, TableDescription};
use arealight_oracle::formula::MIN_COS_VIEW;
use glam::DMat3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::aim::Aim;
use crate::albedos;
use crate::brdf::{Brdf, Magnitude};
use crate::error::FitError;
use crate::lobe::Lobe;
use crate::nodes::Texel;
use crate::pairs::{fit_pair_at, fit_pairs};
use crate::solve::Problem;

/// How a table is fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Nodes a side, 2 to [`arealight::table::MAX_SIZE`].
    pub size: u32,
    /// The lobes that are fitted at each node.
    pub aim: Aim,
    /// Whether pairs of lobes are fitted too ([`arealight::table::LobePairs`]), which takes twice as long as
    /// the rest.
    pub pairs: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self { size: 64, aim: Aim::default(), pairs: true }
    }
}

/// Fits a table to a BRDF.
///
/// Each column (a roughness) of each matrix runs from the normal to the horizon, each texel starting from the
/// one before, so that neighbours settle alike. Columns do not depend on each other: the result is the same
/// on any number of threads.
///
/// `progress` is called from any thread with the number of steps done and the number to do,
/// [`Settings::steps`].
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
    let done = AtomicU64::new(0);
    let total = settings.steps();
    let add = |steps| progress(done.fetch_add(steps, Ordering::Relaxed) + steps, total);
    let report = || add(1);

    // Integrate the albedos of the lobes that are fitted
    let mut magnitude: Vec<Magnitude> = (0..size * size)
        .into_par_iter()
        .map(|i| {
            let (alpha, cos_view) = node_of(settings.size, i);
            let magnitude = magnitude_of_lobe(brdf, alpha, cos_view);
            report();
            magnitude
        })
        .collect::<Result<_, _>>()?;
    let texel = |i: usize| {
        let (alpha, cos_view) = node_of(settings.size, i);
        Texel { brdf, alpha, cos_view }
    };

    // And of the last row at the horizon itself, where they differ from its lobes' own
    let last_row = (size * (size - 1)..size * size)
        .map(|i| magnitude_of_lobe(brdf, node_of(settings.size, i).0, 0.0))
        .collect::<Result<Vec<_>, _>>()?;

    // Fit each column of each matrix from the normal to the horizon
    let shares: Vec<Vec<[f64; 2]>> = magnitude.iter().map(|m| settings.aim.shares(*m)).collect();
    let columns: Vec<Vec<Lobe>> = (0..settings.aim.matrices() * size)
        .into_par_iter()
        .map(|column| {
            let (layer, x) = (column / size, column % size);
            let mut lobe = start_at_normal(texel(x).alpha);
            let mut cos_before = 1.0;
            (0..size)
                .map(|y| {
                    let texel = texel(y * size + x);
                    let guess = lobe.narrowed(cos_before, texel.cos_view);
                    lobe = texel.fit(shares[y * size + x][layer], guess, lobe)?;
                    cos_before = texel.cos_view;
                    report();
                    Ok(lobe)
                })
                .collect()
        })
        .collect::<Result<_, FitError>>()?;
    let layers = columns.chunks_exact(size).map(|columns| {
        (0..size * size).map(|i| columns[i % size][i / size].texel.map(|q| q as f32)).collect()
    });

    let pairs = if settings.pairs {
        Some(fit_pairs(brdf, settings.size, &magnitude, &|| add(STEPS_A_PAIR))?)
    } else {
        None
    };

    magnitude.truncate(size * (size - 1));
    magnitude.extend(last_row);
    let table = into_table(brdf, settings, layers.collect(), &magnitude)?;
    Ok(match pairs {
        Some(pairs) => table.with_pairs(pairs)?,
        None => table,
    })
}

/// What the pair of a texel counts as steps of [`Settings::steps`]: it takes about as long.
const STEPS_A_PAIR: u64 = 4;

/// Fits the lobes of one roughness, from 0 to 1, and one view, starting from what `table` interpolates there:
/// a table that gives this fit, to be looked up at that place alone. So what the nodes of `table` between
/// them lose is known.
///
/// # Errors
/// As [`fit`], whose `settings.aim` this takes.
pub fn fit_at(
    brdf: &dyn Brdf,
    aim: &Aim,
    table: &LightTable,
    roughness: f64,
    cos_view: f64,
) -> Result<LightTable, FitError> {
    let alpha = (roughness * roughness).max(MIN_ALPHA);
    let cos_view = cos_view.clamp(MIN_COS_VIEW, 1.0);
    let magnitude = magnitude_of_lobe(brdf, alpha, cos_view)?;
    let texel = Texel { brdf, alpha, cos_view };
    // Undo what the lookup makes of a texel
    let sample = table.lookup(roughness, cos_view);
    let lobe_of = |inverse: DMat3| {
        let m = inverse * mirror_frame(cos_view);
        Lobe { texel: [m.x_axis.x, m.z_axis.x, m.x_axis.z / alpha, m.z_axis.z / alpha], alpha }
    };
    let starts = [lobe_of(sample.inverse), lobe_of(sample.schlick_inverse)];
    let fits = aim.shares(magnitude).into_iter().zip(starts).map(|(shares, start)| {
        let lobe = texel.fit(shares, start, start)?;
        Ok([lobe.texel.map(|q| q as f32); 4])
    });
    let layers = fits.collect::<Result<Vec<[[f32; 4]; 4]>, FitError>>()?;

    // The same at every node
    let mut layers = layers.into_iter().map(Vec::from);
    let description = TableDescription { brdf: brdf.name().to_owned(), ..TableDescription::default() };
    let albedos = vec![[magnitude.albedo as f32, magnitude.schlick as f32]; 4];
    let table = LightTable::new(description, 2, layers.next().unwrap_or_default(), albedos)?;
    let table = match layers.next() {
        Some(schlick) => table.with_schlick_matrix(schlick)?,
        None => table,
    };
    let Some((inverses, shares)) = sample.pairs else { return Ok(table) };
    let (lobes, shares) = fit_pair_at(&texel, magnitude, inverses.map(lobe_of), shares)?;
    Ok(table.with_pairs(LobePairs {
        matrices: lobes.map(|lobe| vec![lobe.texel.map(|q| q as f32); 4]),
        second_shares: vec![shares.map(|share| share as f32); 4],
    })?)
}

/// How far an albedo of 1 may be off by the numbers that it is integrated of; such a one counts as 1.
const ALBEDO_ROUNDING: f64 = 1e-5;

/// The albedos of a BRDF that has a lobe at an alpha and a view.
fn magnitude_of_lobe(brdf: &dyn Brdf, alpha: f64, cos_view: f64) -> Result<Magnitude, FitError> {
    let magnitude = brdf.magnitude(alpha, cos_view);
    let Magnitude { albedo, schlick } = magnitude;
    let is_lobe = albedo.is_finite() && albedo > 0.0 && schlick.is_finite() && schlick > 0.0;
    if !is_lobe {
        return Err(FitError::NoLobe { alpha, cos_view, albedo, schlick });
    }
    if albedo > 1.0 + ALBEDO_ROUNDING {
        return Err(FitError::MoreThanArrives { alpha, cos_view, albedo });
    }
    // A table has float32: what rounds to 1 there stays as it is
    let is_above = albedo as f32 > 1.0;
    Ok(if is_above { Magnitude { albedo: 1.0, schlick: schlick.min(1.0) } } else { magnitude })
}

impl Texel<'_> {
    /// Fits from the better of two lobes, on nodes laid out by the first.
    fn fit(&self, shares: [f64; 2], guess: Lobe, before: Lobe) -> Result<Lobe, FitError> {
        let problem = Problem::new(shares, self, &guess)?;
        let start = if problem.loss(&before) < problem.loss(&guess) { before } else { guess };
        // Seen from the normal, the lobe of an isotropic BRDF is round: there the tangent frame is arbitrary
        // and must not show
        let free = if self.cos_view == 1.0 { [false, false, false, true] } else { [true; 4] };
        Ok(problem.minimise(start, free))
    }
}

/// The alpha and the view's cosine at which the lobe of texel `i` is fitted.
///
/// The first column stands for the smallest alpha that is shaded. The last row stays off the horizon: exactly
/// on it a lobe degenerates to a fan that is `alpha²` wide, and interpolating towards that would narrow every
/// lobe of the last cell. See [`MIN_COS_VIEW`].
pub(crate) fn node_of(size: u32, i: usize) -> (f64, f64) {
    let (roughness, cos_view) = LightTable::node(size, i as u32 % size, i as u32 / size);
    ((roughness * roughness).max(MIN_ALPHA), cos_view.max(MIN_COS_VIEW))
}

/// At the normal, GGX of a small alpha is a transformed cosine exactly:
/// `tan theta_light = 2 alpha tan theta`.
fn start_at_normal(alpha: f64) -> Lobe {
    Lobe { texel: [1.0, 0.0, 0.0, 2.0 / (1.0 + alpha)], alpha }
}

/// Makes a table of one or two matrix layers.
fn into_table(
    brdf: &dyn Brdf,
    settings: &Settings,
    layers: Vec<Vec<[f32; 4]>>,
    magnitude: &[Magnitude],
) -> Result<LightTable, FitError> {
    let aim = match &settings.aim {
        Aim::ByF0 => "by F0".to_owned(),
        Aim::Blend(reflectances) => {
            let part = |(f0, weight): &(f64, f64)| format!("f0 {f0} by {weight}");
            format!("aimed at {}", reflectances.iter().map(part).collect::<Vec<_>>().join(", "))
        }
    };
    let description = TableDescription {
        brdf: brdf.name().to_owned(),
        made_by: format!("arealight-fit {}, {aim}", env!("CARGO_PKG_VERSION")),
        ggx_dip: brdf.has_ggx_dip(),
    };
    // Fill the dip at grazing views, that the albedos can be interpolated
    let stored = |(i, m): (usize, &Magnitude)| {
        let (roughness, cos_view) =
            LightTable::node(settings.size, i as u32 % settings.size, i as u32 / settings.size);
        let dip = description.dip(roughness, cos_view);
        [m.albedo + dip[0], m.schlick + dip[1]]
    };
    let mut stored: Vec<[f64; 2]> = magnitude.iter().enumerate().map(stored).collect();
    balance(brdf, &description, settings.size, &mut stored);
    let magnitude = stored.into_iter().map(|[albedo, schlick]| [albedo as f32, schlick as f32]).collect();
    let mut layers = layers.into_iter();
    let table = LightTable::new(description, settings.size, layers.next().unwrap_or_default(), magnitude)?;
    Ok(match layers.next() {
        Some(schlick) => table.with_schlick_matrix(schlick)?,
        None => table,
    })
}

/// Balances the last rows of a table's albedos, where all of the error is interpolation's.
fn balance(brdf: &dyn Brdf, description: &TableDescription, size: u32, stored: &mut [[f64; 2]]) {
    let side = size as usize;
    let columns: Vec<_> = (0..side)
        .into_par_iter()
        .map(|x| {
            let column: Vec<[f64; 2]> = (0..side).map(|y| stored[y * side + x]).collect();
            albedos::balanced(brdf, description, LightTable::node(size, x as u32, 0).0, &column)
        })
        .collect();
    for (x, last) in columns.into_iter().enumerate() {
        for (row, node) in last.into_iter().flatten().enumerate() {
            let [mut albedo, mut schlick] = node;
            if !description.ggx_dip {
                // In a coarse table of a lobe that dips the balance lies beyond what an albedo can be
                albedo = albedo.clamp(0.0, 1.0);
                schlick = schlick.clamp(0.0, albedo);
            }
            stored[(side - albedos::ROWS + row) * side + x] = [albedo, schlick];
        }
    }
}

impl Settings {
    /// How many steps a fit takes: the magnitude, each matrix, and some for the pair of every texel.
    pub fn steps(&self) -> u64 {
        let of_pairs = if self.pairs { STEPS_A_PAIR } else { 0 };
        (1 + self.aim.matrices() as u64 + of_pairs) * u64::from(self.size).pow(2)
    }

    fn check(&self) -> Result<(), FitError> {
        let out_of = |setting, value, range| Err(FitError::Setting { setting, value, range });
        if !(2..=arealight::table::MAX_SIZE).contains(&self.size) {
            return out_of("size", f64::from(self.size), "2 to 1024");
        }
        let Aim::Blend(reflectances) = &self.aim else { return Ok(()) };
        if reflectances.is_empty() {
            return out_of("number of reflectances", 0.0, "at least 1");
        }
        for &(f0, weight) in reflectances {
            if !(0.0..=1.0).contains(&f0) {
                return out_of("f0", f0, "0 to 1");
            }
            if !(weight.is_finite() && weight > 0.0) {
                return out_of("weight", weight, "finite and above 0");
            }
        }
        Ok(())
    }
}
