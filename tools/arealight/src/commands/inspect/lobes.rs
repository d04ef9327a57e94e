//! Fitted lobes beside true ones, in the manner of figure 8 of Heitz et al. 2016.

use crate::plots::floats;
use arealight::{LightTable, SpecularLobes, TableSample};
use arealight_oracle::ggx::Ggx;
use arealight_oracle::ltsd::{Original, TransformedDistribution};
use glam::{DMat3, DVec3};
use rayon::prelude::*;
use serde_json::{Value, json};

const ROUGHNESSES: [f64; 4] = [0.25, 0.5, 0.75, 1.0];
const VIEWS: [f64; 5] = [0.0, 30.0, 60.0, 75.0, 85.0];

/// Pixels from a disc's middle to its rim.
const RADIUS: i32 = 52;

/// A function on the hemisphere, sampled where the disc's pixels are; row after row from the top.
struct Lobe {
    values: Vec<f64>,
}

/// The lobes of a cell.
struct Cell {
    truth: Lobe,
    fitted: Lobe,
}

/// What is drawn of a table: lobes of a reflectance at normal incidence (and 1 at grazing), as a level makes
/// them.
#[derive(Debug, Clone, Copy)]
pub struct Material {
    pub f0: f64,
    pub specular_lobes: SpecularLobes,
}

/// The lobes of a table, for a picture.
pub fn found(table: &LightTable, material: Material) -> Value {
    let places: Vec<(f64, f64)> =
        VIEWS.into_iter().flat_map(|view| ROUGHNESSES.map(|roughness| (roughness, view))).collect();
    let cell = |&(roughness, view): &(f64, f64)| {
        let Cell { truth, fitted } = Cell::new(table, roughness, view.to_radians().cos(), material);
        let values = |lobe: Lobe| floats(lobe.values.into_iter().map(|value| value as f32));
        json!({ "true": values(truth), "fitted": values(fitted) })
    };
    let cells: Vec<Value> = places.par_iter().map(cell).collect();
    let (brdf, size) = (&table.description().brdf, table.size());
    json!({
        "title": format!("{brdf}, {size} x {size} nodes: true lobes and their fit for {}", material.name()),
        "roughness": ROUGHNESSES,
        "view": VIEWS,
        "pixels": 2 * RADIUS + 1,
        "cells": cells,
    })
}

impl Cell {
    fn new(table: &LightTable, roughness: f64, cos_view: f64, material: Material) -> Self {
        let ggx = Ggx { alpha: (roughness * roughness).max(arealight::MIN_ALPHA) };
        let view = DVec3::new((1.0 - cos_view * cos_view).max(0.0).sqrt(), 0.0, cos_view);
        let truth = Lobe::sample(|light| {
            ggx.evaluate(view, light) * (material.f0 + (1.0 - material.f0) * Ggx::schlick_weight(view, light))
        });
        Self { truth, fitted: material.fitted(&table.lookup(roughness, cos_view)) }
    }
}

impl Material {
    /// The lobe that a table's sample makes, of one transformed cosine or of two.
    fn fitted(self, sample: &TableSample) -> Lobe {
        let Self { f0, specular_lobes } = self;
        let mut sum = Lobe::sample(|_| 0.0);
        for (inverse, albedo) in sample.lobes(specular_lobes, DVec3::splat(f0), 1.0) {
            let part = Lobe::transformed(inverse).scaled(albedo.x);
            for (value, more) in sum.values.iter_mut().zip(part.values) {
                *value += more;
            }
        }
        sum
    }

    /// For people.
    fn name(self) -> String {
        let specular_lobes = match self.specular_lobes {
            SpecularLobes::One => "one lobe",
            SpecularLobes::Two => "two lobes",
            SpecularLobes::HalfVectors => "half vectors",
        };
        format!("F0 = {}, {specular_lobes}", self.f0)
    }
}

impl Lobe {
    /// A transformed cosine that integrates to 1, from its M⁻¹; 0 if that cannot be inverted, for a table's
    /// transforms can, but interpolated ones need not be.
    fn transformed(inverse: DMat3) -> Self {
        TransformedDistribution::from_inverse(Original::ClampedCosine, inverse)
            .map_or(Self::sample(|_| 0.0), |lobe| Self::sample(|light| lobe.evaluate(light)))
    }

    fn scaled(mut self, factor: f64) -> Self {
        for value in &mut self.values {
            *value *= factor;
        }
        self
    }

    fn sample(value: impl Fn(DVec3) -> f64) -> Self {
        let values = (-RADIUS..=RADIUS)
            .flat_map(|row| (-RADIUS..=RADIUS).map(move |column| (column, row)))
            .map(|(column, row)| {
                let scale = f64::from(RADIUS);
                value(direction(f64::from(column) / scale, -f64::from(row) / scale))
            })
            .collect();
        Self { values }
    }
}

/// The direction of a place in the disc, by Lambert's equal-area projection seen from above, so that areas
/// are solid angles. The mirror direction lies on the right.
fn direction(x: f64, y: f64) -> DVec3 {
    let square = (x * x + y * y).min(1.0);
    let sine = (2.0 - square).sqrt();
    DVec3::new(-x * sine, y * sine, 1.0 - square)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A difference of this share of the true lobe's peak has the full colour.
    const FULL_ERROR: f64 = 0.25;

    #[test]
    fn the_disc_is_the_hemisphere_in_equal_areas() {
        // A cap of half the hemisphere's solid angle, to z = 1/2, fills half the disc
        let edge = direction(0.5_f64.sqrt(), 0.0);
        assert!((edge.z - 0.5).abs() < 1e-12 && (edge.length() - 1.0).abs() < 1e-12);
        assert!(direction(0.0, 0.0).z == 1.0 && direction(0.6, 0.8).z.abs() < 1e-12);
        assert!(direction(0.5, 0.0).x < 0.0, "the mirror direction of a view at x > 0 lies on the right");
    }

    /// The largest error of a cell in shares of its peak.
    fn worst(table: &LightTable, (roughness, cos_view): (f64, f64), material: Material) -> f64 {
        let cell = Cell::new(table, roughness, cos_view, material);
        let pairs = cell.truth.values.iter().zip(&cell.fitted.values);
        let peak = cell.truth.values.iter().fold(0.0, |peak: f64, value| peak.max(*value));
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / peak
    }

    #[test]
    fn a_fit_looks_like_its_brdf() {
        let table = LightTable::ggx();
        let metal = Material { f0: 1.0, specular_lobes: SpecularLobes::One };
        // The colours' whole range
        assert!(worst(&table, (0.75, 0.8), metal) < FULL_ERROR);
        // And a table that is wrong does not
        let mut texels = table.matrix().to_vec();
        for texel in &mut texels {
            texel[3] *= 2.0;
        }
        let wrong =
            LightTable::new(table.description().clone(), table.size(), texels, table.magnitude().to_vec());
        assert!(worst(&wrong.unwrap(), (0.75, 0.8), metal) > FULL_ERROR);
    }

    #[test]
    fn every_matrix_is_drawn() {
        let table = LightTable::ggx();
        let (matrix, magnitude) = (table.matrix().to_vec(), table.magnitude().to_vec());
        let first_only =
            LightTable::new(table.description().clone(), table.size(), matrix, magnitude).unwrap();
        let worst = |table, f0, specular_lobes| worst(table, (0.75, 0.5), Material { f0, specular_lobes });
        let [one, two] = [SpecularLobes::One, SpecularLobes::Two];
        // One lobe of a metal is the first matrix; of a dielectric it is not, and better
        assert_eq!(worst(&table, 1.0, one), worst(&first_only, 1.0, one));
        assert!(worst(&table, 0.02, one) < worst(&first_only, 0.02, one));
        // Two are better than one, of either
        assert!(worst(&table, 1.0, two) < worst(&table, 1.0, one));
        assert!(worst(&table, 0.02, two) < worst(&table, 0.02, one));
    }
}
