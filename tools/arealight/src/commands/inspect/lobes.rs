//! Fitted lobes beside true ones, in the manner of figure 8 of Heitz et al. 2016.

#![expect(clippy::cast_possible_wrap, reason = "pictures are far smaller than 2^31 pixels")]

use super::colour::{FAINT, INK, PAPER, diverging, viridis};
use crate::canvas::{Align, Canvas, LINE};
use arealight::{LightTable, SpecularLobes, TableSample};
use arealight_oracle::ggx::Ggx;
use arealight_oracle::ltsd::{Original, TransformedDistribution};
use glam::{DMat3, DVec3};
use rayon::prelude::*;

const ROUGHNESSES: [f64; 4] = [0.25, 0.5, 0.75, 1.0];
const VIEWS: [f64; 5] = [0.0, 30.0, 60.0, 75.0, 85.0];

/// In pixels.
const RADIUS: i32 = 52;
const DISC: i32 = 2 * RADIUS + 6;
const CELL: (i32, i32) = (3 * DISC + 24, DISC + 14);
const MARGIN: (i32, i32) = (96, 84);
const FOOTER: i32 = 74;

/// A difference of this share of the true lobe's peak has the full colour.
const FULL_ERROR: f64 = 0.25;

/// A function on the hemisphere, sampled where the disc's pixels are; row after row from the top.
struct Lobe {
    values: Vec<f64>,
}

/// The three lobes of a cell.
struct Cell {
    truth: Lobe,
    fitted: Lobe,
    peak: f64,
}

/// What is drawn of a table: lobes of a reflectance at normal incidence (and 1 at grazing), as a level makes
/// them.
#[derive(Debug, Clone, Copy)]
pub struct Material {
    pub f0: f64,
    pub specular_lobes: SpecularLobes,
}

/// Draws the lobes of a table.
pub fn draw(table: &LightTable, material: Material) -> Canvas {
    let width = MARGIN.0 + CELL.0 * ROUGHNESSES.len() as i32;
    let height = MARGIN.1 + CELL.1 * VIEWS.len() as i32 + FOOTER;
    let mut canvas = Canvas::new(width as u32, height as u32, PAPER);
    let places: Vec<(usize, usize)> =
        (0..VIEWS.len()).flat_map(|row| (0..ROUGHNESSES.len()).map(move |column| (column, row))).collect();
    let cells: Vec<Cell> = places
        .par_iter()
        .map(|&(column, row)| Cell::new(table, ROUGHNESSES[column], VIEWS[row].to_radians().cos(), material))
        .collect();
    for (&(column, row), cell) in places.iter().zip(&cells) {
        let corner = (MARGIN.0 + CELL.0 * column as i32, MARGIN.1 + CELL.1 * row as i32);
        cell.draw(&mut canvas, corner);
    }
    draw_labels(&mut canvas, table, material);
    draw_legend(&mut canvas, height - FOOTER + 22);
    canvas
}

impl Cell {
    fn new(table: &LightTable, roughness: f64, cos_view: f64, material: Material) -> Self {
        let ggx = Ggx { alpha: (roughness * roughness).max(arealight::MIN_ALPHA) };
        let view = DVec3::new((1.0 - cos_view * cos_view).max(0.0).sqrt(), 0.0, cos_view);
        let truth = Lobe::sample(|light| {
            ggx.evaluate(view, light) * (material.f0 + (1.0 - material.f0) * Ggx::schlick_weight(view, light))
        });
        let fitted = material.fitted(&table.lookup(roughness, cos_view));
        let peak = truth.values.iter().fold(f64::MIN_POSITIVE, |peak, value| peak.max(*value));
        Self { truth, fitted, peak }
    }

    fn draw(&self, canvas: &mut Canvas, corner: (i32, i32)) {
        let centre = |i: i32| (corner.0 + DISC / 2 + i * DISC, corner.1 + DISC / 2);
        let brightness = |value: f64| viridis((value / self.peak).max(0.0).sqrt());
        canvas.disc(centre(0), RADIUS, FAINT, |x, y| brightness(self.truth.at(x, y)));
        canvas.disc(centre(1), RADIUS, FAINT, |x, y| brightness(self.fitted.at(x, y)));
        canvas.disc(centre(2), RADIUS, FAINT, |x, y| {
            diverging((self.fitted.at(x, y) - self.truth.at(x, y)) / (FULL_ERROR * self.peak))
        });
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

    fn at(&self, x: f64, y: f64) -> f64 {
        let place = |v: f64| (v * f64::from(RADIUS)).round() as i32 + RADIUS;
        self.values[(place(-y) * (2 * RADIUS + 1) + place(x)) as usize]
    }
}

/// The direction of a place in the disc, by Lambert's equal-area projection seen from above, so that areas
/// are solid angles. The mirror direction lies on the right.
fn direction(x: f64, y: f64) -> DVec3 {
    let square = (x * x + y * y).min(1.0);
    let sine = (2.0 - square).sqrt();
    DVec3::new(-x * sine, y * sine, 1.0 - square)
}

fn draw_labels(canvas: &mut Canvas, table: &LightTable, material: Material) {
    let size = table.size();
    let title = format!(
        "{}, {size} x {size} nodes: true lobes and their fit for {}",
        table.description().brdf,
        material.name()
    );
    canvas.text((MARGIN.0, 12), &title, Align::Left, INK);
    for (column, roughness) in ROUGHNESSES.iter().enumerate() {
        let left = MARGIN.0 + CELL.0 * column as i32;
        let centre = |i: i32| left + DISC / 2 + i * DISC;
        canvas.text((centre(1), 38), &format!("roughness {roughness}"), Align::Centre, INK);
        for (i, name) in ["true", "fitted", "error"].iter().enumerate() {
            canvas.text((centre(i as i32), 38 + LINE + 4), name, Align::Centre, FAINT);
        }
    }
    for (row, view) in VIEWS.iter().enumerate() {
        let middle = MARGIN.1 + CELL.1 * row as i32 + DISC / 2;
        canvas.text((MARGIN.0 - 14, middle - LINE), "view", Align::Right, FAINT);
        canvas.text((MARGIN.0 - 14, middle), &format!("{view}°"), Align::Right, INK);
    }
}

fn draw_legend(canvas: &mut Canvas, top: i32) {
    const BAR: (i32, i32) = (220, 12);
    let share = |x: i32| f64::from(x) / f64::from(BAR.0 - 1);
    let left = MARGIN.0;
    canvas.rectangle((left, top), BAR, |x, _| viridis(share(x).sqrt()));
    canvas.text((left, top + 16), "0", Align::Left, FAINT);
    canvas.text((left + BAR.0, top + 16), "peak", Align::Right, FAINT);

    let second = left + CELL.0;
    canvas.rectangle((second, top), BAR, |x, _| diverging(2.0 * share(x) - 1.0));
    canvas.text((second, top + 16), "-25 %", Align::Left, FAINT);
    canvas.text((second + BAR.0 / 2, top + 16), "0", Align::Centre, FAINT);
    canvas.text((second + BAR.0, top + 16), "+25 % of peak", Align::Right, FAINT);

    let third = left + 2 * CELL.0;
    canvas.text((third, top - 3), "the hemisphere from above, in equal areas;", Align::Left, FAINT);
    canvas.text((third, top + 16), "the view lies on the left of each disc", Align::Left, FAINT);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_disc_is_the_hemisphere_in_equal_areas() {
        // A cap of half the hemisphere's solid angle, to z = 1/2, fills half the disc
        let edge = direction(0.5_f64.sqrt(), 0.0);
        assert!((edge.z - 0.5).abs() < 1e-12 && (edge.length() - 1.0).abs() < 1e-12);
        assert!(direction(0.0, 0.0).z == 1.0 && direction(0.6, 0.8).z.abs() < 1e-12);
        assert!(direction(0.5, 0.0).x < 0.0, "the mirror direction of a view at x > 0 lies on the right");
    }

    #[test]
    fn lobes_are_read_where_they_were_sampled() {
        let lobe = Lobe::sample(|direction| direction.x + 10.0 * direction.y);
        for (x, y) in [(0.0, 0.0), (0.5, 0.25), (-0.75, 0.5)] {
            let expected = direction(x, y);
            assert!((lobe.at(x, y) - expected.x - 10.0 * expected.y).abs() < 1e-12, "{x} {y}");
        }
    }

    /// The largest error of a cell in shares of its peak.
    fn worst(table: &LightTable, (roughness, cos_view): (f64, f64), material: Material) -> f64 {
        let cell = Cell::new(table, roughness, cos_view, material);
        let pairs = cell.truth.values.iter().zip(&cell.fitted.values);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / cell.peak
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
