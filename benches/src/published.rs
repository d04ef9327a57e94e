//! A light table of the quality of the one that engines ship: the 64 x 64 table published with Heitz et al.
//! 2016, *Real-Time Polygonal-Light Shading with Linearly Transformed Cosines*, one matrix for every
//! reflectance.
//!
//! The published table itself isn't in this repository. This one is made by the method that its authors
//! describe, written anew: at each node a lobe with three free parameters, its axis fixed at the BRDF's mean
//! direction, which minimises the cube of the difference of densities by the simplex method of Nelder and
//! Mead 1965. Its errors are those of the published table within 10 % ([`arealight_fit::report::PUBLISHED`];
//! a test compares them). Its albedos are those of our own table: the two differ by their matrices alone.
//!
//! `cargo run --release -p arealight-benches --example published_table` makes it again.

use arealight::table::mirror_frame;
use arealight::{LightTable, MIN_ALPHA, TableDescription, TableError};
use arealight_fit::brdf::view_direction;
use arealight_fit::{Brdf, GgxBrdf};
use arealight_oracle::formula::MIN_COS_VIEW;
use arealight_oracle::ggx::Ggx;
use arealight_table::ReadError;
use glam::{DMat3, DVec3};
use rayon::prelude::*;
use std::f64::consts::{FRAC_1_PI, TAU};

/// The table.
///
/// # Panics
/// Never: the file is a part of the program, and a test reads it.
pub fn table() -> LightTable {
    read().expect("the table in the repository is valid")
}

fn read() -> Result<LightTable, ReadError> {
    arealight_table::read(include_bytes!("../tables/published-quality.exr"))
}

/// Samples a side of each of the two sets that a difference of densities is integrated with.
const SAMPLES: usize = 32;

/// The simplex method's first step, in each parameter.
const FIRST_STEP: f64 = 0.05;

/// It ends where its best and its worst vertex differ by this share, or after so many steps.
const TOLERANCE: f64 = 1e-5;
const MAX_STEPS: usize = 100;

/// Three parameters of a lobe about an axis: the scale in the plane of incidence, across it, and the shear.
type Parameters = [f64; 3];

/// Fits the table. `albedos` gives its size and its albedos, and what else it says of itself.
///
/// # Errors
/// [`TableError`] where a node has no valid lobe: no node of GGX.
pub fn fit(albedos: &LightTable) -> Result<LightTable, TableError> {
    let size = albedos.size();
    // Along the normal from rough to smooth, each lobe starting from the one before
    let mut start = [1.0, 1.0, 0.0];
    let mut at_normal = vec![start; size as usize];
    for x in (0..size).rev() {
        start = Node::new(size, x, 0).fit(start);
        at_normal[x as usize] = start;
    }
    // Then each roughness by itself, from the normal to the horizon
    let columns: Vec<Vec<[f32; 4]>> =
        (0..size).into_par_iter().map(|x| column(size, x, at_normal[x as usize])).collect();
    let texels = (0..size * size).map(|i| columns[(i % size) as usize][(i / size) as usize]).collect();
    let description = TableDescription {
        made_by: "arealight-benches, by the method of Heitz et al. 2016".to_owned(),
        ..albedos.description().clone()
    };
    LightTable::new(description, size, texels, albedos.magnitude().to_vec())
}

/// The texels of a roughness, from the normal to the horizon, each lobe starting from the one before.
fn column(size: u32, x: u32, at_normal: Parameters) -> Vec<[f32; 4]> {
    let mut parameters = at_normal;
    let texel = |y: u32| {
        let node = Node::new(size, x, y);
        if y > 0 {
            parameters = node.fit(parameters);
        }
        node.texel(parameters)
    };
    (0..size).map(texel).collect()
}

/// A node of the table: the BRDF at a roughness and a view, and samples of it.
struct Node {
    lobe: Ggx,
    cos_view: f64,
    albedo: f64,
    /// From the lobe's frame, whose z is the BRDF's mean direction, to the surface's.
    frame: DMat3,
    /// Directions drawn from the BRDF: with its value there, times the cosine, and its density.
    samples: Vec<(DVec3, f64, f64)>,
    is_isotropic: bool,
}

impl Node {
    fn new(size: u32, x: u32, y: u32) -> Self {
        let (roughness, cos_view) = LightTable::node(size, x, y);
        let (alpha, cos_view) = ((roughness * roughness).max(MIN_ALPHA), cos_view.max(MIN_COS_VIEW));
        let (lobe, view) = (Ggx { alpha }, view_direction(cos_view));
        let sample = |u| {
            let light = lobe.sample(view, u);
            (light, lobe.evaluate(view, light), lobe.density(view, light))
        };
        let samples: Vec<(DVec3, f64, f64)> =
            squares().map(sample).filter(|(_, _, density)| *density > 0.0).collect();
        let mean: DVec3 = samples.iter().map(|(light, value, density)| *light * (value / density)).sum();
        let axis = if y == 0 { DVec3::Z } else { mean.with_y(0.0).normalize_or(DVec3::Z) };
        Self {
            lobe,
            cos_view,
            albedo: GgxBrdf.magnitude(alpha, cos_view).albedo,
            frame: DMat3::from_cols(DVec3::new(axis.z, 0.0, -axis.x), DVec3::Y, axis),
            samples,
            is_isotropic: y == 0,
        }
    }

    /// The lobe's matrix, from cosine space to the surface's frame.
    fn matrix(&self, [along, across, shear]: Parameters) -> DMat3 {
        let along = along.max(1e-7);
        let (across, shear) = if self.is_isotropic { (along, 0.0) } else { (across.max(1e-7), shear) };
        self.frame * DMat3::from_cols(along * DVec3::X, across * DVec3::Y, DVec3::new(shear, 0.0, 1.0))
    }

    /// The integral of the cube of the difference of the lobe and the BRDF, by samples of both, weighted by
    /// the balance heuristic.
    fn loss(&self, parameters: Parameters) -> f64 {
        let matrix = self.matrix(parameters);
        let (inverse, determinant) = (matrix.inverse(), matrix.determinant());
        let view = view_direction(self.cos_view);
        let density_of_lobe = |light: DVec3| {
            let cosine = inverse * light;
            FRAC_1_PI * cosine.z.max(0.0) / (determinant * cosine.length_squared().powi(2))
        };
        let term = |light: DVec3, value: f64, density: f64| {
            let of_lobe = density_of_lobe(light);
            (value - self.albedo * of_lobe).abs().powi(3) / (of_lobe + density).max(f64::MIN_POSITIVE)
        };
        let of_brdf: f64 =
            self.samples.iter().map(|(light, value, density)| term(*light, *value, *density)).sum();
        let of_lobe: f64 = squares()
            .map(|u| {
                let light = (matrix * cosine_direction(u)).normalize_or(DVec3::Z);
                let (value, density) = (self.lobe.evaluate(view, light), self.lobe.density(view, light));
                term(light, value, density)
            })
            .sum();
        (of_brdf + of_lobe) / (SAMPLES * SAMPLES) as f64
    }

    fn fit(&self, start: Parameters) -> Parameters {
        let found = simplex(start, |parameters| self.loss(parameters));
        if self.is_isotropic { [found[0], found[0], 0.0] } else { found }
    }

    /// The table's texel of a lobe: see [`arealight::table`].
    fn texel(&self, parameters: Parameters) -> [f32; 4] {
        let inverse = self.matrix(parameters).inverse();
        let mirrored = inverse * mirror_frame(self.cos_view) * inverse.y_axis.y.recip();
        let alpha = self.lobe.alpha;
        let (x, z) = (mirrored.x_axis, mirrored.z_axis);
        [x.x, z.x, x.z / alpha, z.z / alpha].map(|entry| entry as f32)
    }
}

/// The middles of the cells of the unit square.
fn squares() -> impl Iterator<Item = [f64; 2]> {
    let place = |i: usize| (i as f64 + 0.5) / SAMPLES as f64;
    (0..SAMPLES * SAMPLES).map(move |i| [place(i / SAMPLES), place(i % SAMPLES)])
}

/// A direction drawn from the clamped cosine.
fn cosine_direction(u: [f64; 2]) -> DVec3 {
    let (radius, (sin, cos)) = (u[0].sqrt(), (TAU * u[1]).sin_cos());
    DVec3::new(radius * cos, radius * sin, (1.0 - u[0]).sqrt())
}

/// A minimum near a start, by the simplex method.
fn simplex(start: Parameters, value: impl Fn(Parameters) -> f64) -> Parameters {
    let along = |from: Parameters, to: Parameters, part: f64| -> Parameters {
        std::array::from_fn(|i| from[i] + part * (to[i] - from[i]))
    };
    let mut vertices: Vec<(f64, Parameters)> = (0..4)
        .map(|i| std::array::from_fn(|axis| start[axis] + if i == axis + 1 { FIRST_STEP } else { 0.0 }))
        .map(|vertex| (value(vertex), vertex))
        .collect();
    for _ in 0..MAX_STEPS {
        vertices.sort_by(|a, b| a.0.total_cmp(&b.0));
        let [best, _, second_worst, worst] = [0, 1, 2, 3].map(|i| vertices[i]);
        if 2.0 * (worst.0 - best.0) < TOLERANCE * (worst.0 + best.0) {
            break;
        }
        let others = &vertices[..3];
        let middle = std::array::from_fn(|i| others.iter().map(|(_, vertex)| vertex[i]).sum::<f64>() / 3.0);
        let tried = |part: f64| {
            let vertex = along(middle, worst.1, part);
            (value(vertex), vertex)
        };
        // Reflect the worst vertex; expand where that is the best, contract where it isn't better than the
        // others
        let reflected = tried(-1.0);
        if reflected.0 < best.0 {
            let expanded = tried(-2.0);
            vertices[3] = if expanded.0 < reflected.0 { expanded } else { reflected };
        } else if reflected.0 < second_worst.0 {
            vertices[3] = reflected;
        } else {
            let contracted = tried(if reflected.0 < worst.0 { -0.5 } else { 0.5 });
            if contracted.0 < worst.0.min(reflected.0) {
                vertices[3] = contracted;
            } else {
                for vertex in &mut vertices[1..] {
                    let shrunk = along(best.1, vertex.1, 0.5);
                    *vertex = (value(shrunk), shrunk);
                }
            }
        }
    }
    vertices.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).map_or(start, |(_, vertex)| vertex)
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight_fit::report::{COUNT, Errors, Level, PUBLISHED, SEED, cases, measure};

    /// The largest ratio of a table's errors to those of the published table, or the other way round.
    fn largest_ratio(errors: &[Errors]) -> f64 {
        let pairs = errors.iter().zip(&PUBLISHED);
        let ratios = pairs.flat_map(|(ours, published)| {
            assert_eq!(ours.f0, published.f0);
            [ours.mean / published.mean, ours.percentile_95 / published.percentile_95]
        });
        ratios.map(|ratio| ratio.max(1.0 / ratio)).fold(0.0, f64::max)
    }

    #[test]
    fn its_errors_are_those_of_the_published_table() {
        let cases = cases(COUNT, SEED, &|| {});
        let ratio = largest_ratio(&measure(&table(), Level::default(), &cases));
        // What a yardstick may be off without misleading anybody; it is 1.022
        assert!(ratio < 1.1, "{ratio}");
        // The twin: our own table, four times better for metals
        let ratio = largest_ratio(&measure(&LightTable::ggx(), Level::default(), &cases));
        assert!(ratio > 3.0, "{ratio}");
    }

    #[test]
    fn it_differs_from_ours_by_one_matrix_alone() {
        let (table, ours) = (table(), LightTable::ggx());
        assert!(table.schlick_matrix().is_none() && table.size() == 64);
        assert_eq!(table.description().ggx_dip, ours.description().ggx_dip);
        for (a, b) in table.magnitude().as_flattened().iter().zip(ours.magnitude().as_flattened()) {
            // Float16's rounding of numbers up to 2
            assert!((a - b).abs() < 1e-3, "{a} {b}");
        }
    }

    #[test]
    fn it_is_what_the_fit_makes() {
        let table = table();
        let (size, last) = (table.size(), table.size() - 1);
        let start = Node::new(size, last, 0).fit([1.0, 1.0, 0.0]);
        for (y, fitted) in column(size, last, start).into_iter().enumerate() {
            let stored = table.matrix()[y * size as usize + last as usize];
            for (a, b) in stored.into_iter().zip(fitted) {
                // Float16, and a step more or less of the simplex method where sines differ in their last
                // bits
                assert!((a - b).abs() < 2e-3 * b.abs().max(1.0), "{y}: {stored:?} {fitted:?}");
            }
        }
    }
}
