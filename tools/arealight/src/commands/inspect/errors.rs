//! How far the integrals of tables are from the truth, over roughness and view angle.

use crate::plots::floats;
use arealight::table::mirror_frame;
use arealight::{Horizon, LightTable, SpecularLobes, TableSample};
use arealight_fit::report::{Case, Family, Level, Quad, integrate, measure_lookup, random_quads};
use arealight_oracle::formula::ggx_formula;
use glam::{DQuat, DVec3};
use rayon::prelude::*;
use serde_json::{Value, json};

/// Cells a side of a map.
pub const CELLS: usize = 32;

/// The reflectances that are measured, two of [`arealight_fit::report::REFLECTANCES`].
pub const REFLECTANCES: [f64; 2] = [0.04, 1.0];

/// The ranges of [`random_quads`], so that the mean of a map is near that of a report.
pub const ROUGHNESS: [f64; 2] = [0.1, 1.0];
/// In degrees.
pub const VIEW: [f64; 2] = [0.0, 89.0];

/// The seed of the quads that each cell is measured on.
const SEED: u64 = 2;

/// Where lobes come from.
pub enum Source<'a> {
    Table(&'a LightTable),
    /// [`ggx_formula`].
    Formula,
}

/// What is measured: lobes, and how they are used.
pub struct Subject<'a> {
    pub name: String,
    pub lobes: Source<'a>,
    pub specular_lobes: SpecularLobes,
}

/// Mean absolute errors over [`CELLS`] × [`CELLS`] roughnesses and view angles.
pub struct ErrorMap {
    pub name: String,
    pub specular_lobes: SpecularLobes,
    pub f0: f64,
    /// Row after row from the normal, from the least roughness.
    pub cells: Vec<f64>,
}

impl Source<'_> {
    fn lookup(&self, roughness: f64, cos_view: f64) -> TableSample {
        match self {
            Self::Table(table) => table.lookup(roughness, cos_view),
            Self::Formula => ggx_formula(roughness, cos_view),
        }
    }
}

impl ErrorMap {
    /// How the lobes were used, for people.
    pub fn level(&self) -> &'static str {
        match self.specular_lobes {
            SpecularLobes::One => "one lobe",
            SpecularLobes::Two => "two lobes",
            SpecularLobes::HalfVectors => "half vectors",
        }
    }

    pub fn mean(&self) -> f64 {
        self.cells.iter().sum::<f64>() / self.cells.len().max(1) as f64
    }

    /// The largest of the cells' means, and the cell.
    pub fn worst(&self) -> (usize, f64) {
        self.cells.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default()
    }
}

/// The maps, for a picture.
pub fn found(maps: &[ErrorMap], quads: u16) -> Value {
    let map = |map: &ErrorMap| {
        json!({
            "of": map.name,
            "specular_lobes": map.level(),
            "f0": map.f0,
            "mean": map.mean(),
            "most": map.worst().1,
            "cells": floats(map.cells.iter().map(|error| *error as f32)),
        })
    };
    json!({
        "title": format!(
            "mean absolute error over {quads} quads of unit radiance in each cell, clipped in cosine space"
        ),
        "note": "of the reflected radiance; a third of the lights about the mirror direction, a third anywhere, \
                 a third across the horizon",
        "cells_a_side": CELLS,
        "roughness": ROUGHNESS,
        "view": VIEW,
        "maps": maps.iter().map(map).collect::<Value>(),
    })
}

/// The roughness and the view angle in degrees at the middle of a cell.
pub fn middle(cell: usize) -> (f64, f64) {
    let at = |[from, to]: [f64; 2], i: usize| from + (to - from) * (i as f64 + 0.5) / CELLS as f64;
    (at(ROUGHNESS, cell % CELLS), at(VIEW, cell / CELLS))
}

/// Measures all subjects on the same `quads` quads a cell; maps of the first subject at each of
/// [`REFLECTANCES`], then of the next. `progress` is called from any thread after each cell.
pub fn measure(subjects: &[Subject], quads: usize, progress: &(dyn Fn() + Sync)) -> Vec<ErrorMap> {
    let quads = random_quads(quads, SEED);
    let cells: Vec<Vec<f64>> = (0..CELLS * CELLS)
        .into_par_iter()
        .map(|cell| {
            let errors = measure_cell(subjects, &quads, cell);
            progress();
            errors
        })
        .collect();
    let labels = subjects.iter().flat_map(|subject| REFLECTANCES.map(|f0| (subject, f0)));
    labels
        .enumerate()
        .map(|(map, (Subject { name, specular_lobes, .. }, f0))| {
            let cells = cells.iter().map(|errors| errors[map]).collect();
            ErrorMap { name: name.clone(), specular_lobes: *specular_lobes, f0, cells }
        })
        .collect()
}

/// A number for each map.
fn measure_cell(subjects: &[Subject], quads: &[Quad], cell: usize) -> Vec<f64> {
    let (roughness, view) = middle(cell);
    let cos_view = view.to_radians().cos();
    let aimed = quads.iter().map(|quad| aimed(quad, roughness, cos_view)).collect();
    let cases: Vec<Case> = integrate(aimed, &|| ());
    let mut means = Vec::with_capacity(subjects.len() * REFLECTANCES.len());
    for Subject { lobes, specular_lobes, .. } in subjects {
        let level = Level { specular_lobes: *specular_lobes, horizon: Horizon::Cosine };
        let sample = lobes.lookup(roughness, cos_view);
        let errors = measure_lookup(|_, _| sample, level, &cases);
        means.extend(
            REFLECTANCES.map(|f0| errors.iter().find(|e| e.f0 == f0).map_or(f64::NAN, |errors| errors.mean)),
        );
    }
    means
}

/// A quad of a report as it would have been drawn for another roughness and view: those about the mirror
/// direction move with it, and their distance from it grows with alpha.
fn aimed(quad: &Quad, roughness: f64, cos_view: f64) -> Quad {
    let mut quad = quad.clone();
    if quad.family == Family::Mirror {
        let centre = quad.vertices.iter().sum::<DVec3>().normalize_or(DVec3::Z);
        let offset = mirror_frame(quad.cos_view).transpose() * centre;
        let growth = (roughness / quad.roughness).powi(2);
        let scaled = DVec3::new(offset.x * growth, offset.y * growth, offset.z);
        let target = (mirror_frame(cos_view) * scaled).normalize_or(DVec3::Z);
        let turn = DQuat::from_rotation_arc(centre, target.with_z(target.z.abs()));
        quad.vertices = quad.vertices.map(|vertex| turn * vertex);
    }
    Quad { roughness, cos_view, ..quad }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quads_about_the_mirror_direction_follow_it() {
        let from_mirror = |quad: &Quad| {
            let centre = quad.vertices.iter().sum::<DVec3>().normalize_or(DVec3::Z);
            let mirror = mirror_frame(quad.cos_view).z_axis;
            mirror.angle_between(centre)
        };
        let quads: Vec<Quad> =
            random_quads(300, 7).into_iter().filter(|quad| quad.family == Family::Mirror).collect();
        assert_eq!(quads.len(), 100);
        for quad in &quads {
            // At its own roughness and view a quad stays, but for rounding
            let same = aimed(quad, quad.roughness, quad.cos_view);
            let moved = same.vertices.iter().zip(&quad.vertices).map(|(a, b)| a.distance(*b));
            assert!(moved.fold(0.0, f64::max) < 1e-12);
            // At another it is as near in alphas: an offset of at most one, and asin(x) <= pi/2 x
            let other = aimed(quad, 0.2, 0.7);
            assert!(from_mirror(&other) < 0.04 * std::f64::consts::FRAC_PI_2 + 1e-12, "{other:?}");
        }
        // Those that are left as they are, are not
        let left = quads.iter().map(|quad| Quad { roughness: 0.2, cos_view: 0.7, ..quad.clone() });
        assert!(left.filter(|quad| from_mirror(quad) > 0.2).count() > 50);
    }

    #[test]
    fn maps_agree_with_the_report() {
        let table = LightTable::ggx();
        let levels = [SpecularLobes::One, SpecularLobes::Two];
        let subjects = levels.map(|specular_lobes| Subject {
            name: String::new(),
            lobes: Source::Table(&table),
            specular_lobes,
        });
        let maps = measure(&subjects, 6, &|| ());
        let cases = arealight_fit::report::cases(3000, 1, &|| ());
        for (map, specular_lobes) in maps.iter().zip(levels.into_iter().flat_map(|level| [level; 2])) {
            assert_eq!((map.specular_lobes, map.cells.len()), (specular_lobes, CELLS * CELLS));
            let report = arealight_fit::report::measure(
                &table,
                Level { specular_lobes, horizon: Horizon::Cosine },
                &cases,
            );
            let expected = report.iter().find(|errors| errors.f0 == map.f0).unwrap().mean;
            // Six quads stand for all: within a factor of three. A wrong view or roughness errs a hundredfold
            let ratio = map.mean() / expected;
            assert!((1.0 / 3.0..3.0).contains(&ratio), "{specular_lobes:?} {}: {ratio}", map.f0);
            assert!(map.worst().1 > map.mean() && map.cells[map.worst().0] == map.worst().1);
        }
        // Two lobes are better than one, for a dielectric and for a metal
        assert!(maps[2].mean() < maps[0].mean() && maps[3].mean() < maps[1].mean());
    }
}
