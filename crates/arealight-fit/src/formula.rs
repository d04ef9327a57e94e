//! The fit of a table-free [`Formula`] to a fitted table.
//!
//! The table's entries are smooth, so that polynomials of a low order come near them, if they are off where
//! it does not matter. What matters, the loss of the table's own fit tells: about its smallest value it grows
//! by the square of the four entries' errors in a metric of their own, the curvature, which changes by orders
//! of magnitude over the table and in which some sums of entries count for nothing.

use arealight::{LightTable, MIN_ALPHA};
use arealight_oracle::formula::Formula;
use rayon::prelude::*;

use crate::brdf::{Brdf, Magnitude};
use crate::error::FitError;
use crate::fit::node_of;
use crate::linear::{LeastSquares, cholesky, six_digits};
use crate::lobe::Lobe;
use crate::nodes::Texel;
use crate::solve::Problem;

mod text;

pub use text::{glsl, rust};

/// The smallest table a formula is fitted to, in nodes a side.
const SMALLEST_SIZE: u32 = 8;

/// About how many nodes a side are fitted. A cubic has ten coefficients: more nodes change nothing but the
/// time.
const NODES: u32 = 22;

/// What is added to the albedo of Schlick's weight when its lobe's errors are weighed. Otherwise views near
/// the normal, where that albedo is 1e-9, would leave the cubic free to make no lobe at all there.
const SCHLICK_OFFSET: f64 = 0.03;

/// Fits a formula to a table of a BRDF. Its coefficients have six digits, as they are printed by [`rust`] and
/// [`glsl`].
///
/// # Errors
/// [`FitError`] if the table has less than 8 nodes a side, or the BRDF is not one that it can be of.
pub fn fit(brdf: &dyn Brdf, table: &LightTable) -> Result<Formula, FitError> {
    if table.size() < SMALLEST_SIZE {
        let value = f64::from(table.size());
        return Err(FitError::Setting { setting: "size", value, range: "at least 8 for a formula" });
    }
    let nodes = nodes(brdf, table);
    let lobe = fit_lobe(brdf, table.matrix(), &nodes, |node| node.albedo)?;
    let schlick = table.schlick_matrix().unwrap_or(table.matrix());
    let schlick_lobe = fit_lobe(brdf, schlick, &nodes, |node| node.schlick + SCHLICK_OFFSET)?;
    let mut formula = Formula {
        lobe,
        schlick_lobe,
        dip: fit_dip(brdf),
        albedo: [0.0; 10],
        albedo_denominator: [0.0; 6],
        schlick: [0.0; 6],
        schlick_denominator: [0.0; 6],
    };
    (formula.albedo, formula.albedo_denominator) = fit_albedo(&nodes, &formula);
    (formula.schlick, formula.schlick_denominator) = fit_schlick(&nodes);
    Ok(formula)
}

/// A node of the table that is fitted.
struct Node {
    index: usize,
    alpha: f64,
    cos_view: f64,
    albedo: f64,
    schlick: f64,
    /// The weight of its squared errors.
    weight: f64,
}

/// Every so manyth node of a table each way, from the first to the last.
fn nodes(brdf: &dyn Brdf, table: &LightTable) -> Vec<Node> {
    let size = table.size();
    let intervals = (size - 1).min(NODES - 1);
    let at = |i: u32| i * (size - 1) / intervals;
    let of_trapezoid = |i: u32| if i == 0 || i == size - 1 { 0.5 } else { 1.0 };
    let places = (0..=intervals).flat_map(|y| (0..=intervals).map(move |x| (at(x), at(y))));
    places
        .map(|(x, y)| {
            let index = (y * size + x) as usize;
            let (alpha, cos_view) = node_of(size, index);
            let Magnitude { albedo, schlick } = brdf.magnitude(alpha, cos_view);
            // Nodes are even in sqrt(1 - cos), views shall count evenly in their angle
            let angle_per_step = 2.0 / (1.0 + cos_view).sqrt();
            let weight = angle_per_step * of_trapezoid(x) * of_trapezoid(y);
            Node { index, alpha, cos_view, albedo, schlick, weight }
        })
        .collect()
}

/// Fits the four entries of a lobe, all in one least squares since the curvature ties them together. `albedo`
/// is what a node's lobe is multiplied by.
fn fit_lobe(
    brdf: &dyn Brdf,
    texels: &[[f32; 4]],
    nodes: &[Node],
    albedo: impl Fn(&Node) -> f64 + Sync,
) -> Result<[[f64; 4]; 10], FitError> {
    // Find the metric of each node's errors, as a triangle: its square is the curvature
    let metrics: Vec<[[f64; 4]; 4]> = nodes
        .par_iter()
        .map(|node| {
            let &Node { index, alpha, cos_view, .. } = node;
            let lobe = Lobe { texel: texels[index].map(f64::from), alpha };
            let curvature =
                Problem::new([1.0, 0.0], &Texel { brdf, alpha, cos_view }, &lobe)?.curvature(&lobe);
            cholesky(&curvature, 0.0).ok_or(FitError::NoNodes { alpha, cos_view })
        })
        .collect::<Result<_, _>>()?;

    // Solve for the coefficients of all entries, four for each monomial
    let mut problem = LeastSquares::new(40);
    for (node, metric) in nodes.iter().zip(&metrics) {
        let monomials = cubic_monomials(node.alpha, node.cos_view);
        let scale = node.weight.sqrt() * albedo(node);
        // The second entry's polynomial is multiplied by alpha
        let entries = [1.0, node.alpha, 1.0, 1.0];
        for i in 0..4 {
            let row = metric.map(|of_entry| scale * of_entry[i]);
            let target = (0..4).map(|k| row[k] * f64::from(texels[node.index][k])).sum();
            let factors = monomials.iter().flat_map(|m| (0..4).map(move |k| m * entries[k] * row[k]));
            problem.add(factors, target);
        }
    }
    let coefficients = problem.solve();
    Ok(std::array::from_fn(|i| std::array::from_fn(|k| six_digits(coefficients[4 * i + k]))))
}

/// Fits what the albedo of the narrowest lobes lacks towards the horizon, by the ratio of the view's cosine
/// and alpha.
fn fit_dip(brdf: &dyn Brdf) -> [f64; 4] {
    const ALPHA: f64 = MIN_ALPHA * 100.0;
    const SAMPLES: i32 = 121;
    // From a hundredth of alpha to the normal, evenly in the logarithm
    let samples: Vec<Sample> = (0..SAMPLES)
        .map(|i| {
            let x = 1e4_f64.powf(f64::from(i) / f64::from(SAMPLES - 1)) / 100.0;
            let target = 1.0 - brdf.magnitude(ALPHA, ALPHA * x).albedo;
            Sample { above: vec![x], below: vec![x, x * x, x * x * x], target, weight: 1.0 }
        })
        .collect();
    let (above, below) = fit_rational(&samples);
    [above[0], below[0], below[1], below[2]]
}

fn fit_albedo(nodes: &[Node], formula: &Formula) -> ([f64; 10], [f64; 6]) {
    let samples: Vec<Sample> = nodes
        .iter()
        .map(|node| {
            let &Node { alpha, cos_view, albedo, weight, .. } = node;
            let above = cubic_monomials(alpha, cos_view).to_vec();
            let below = quadratic_monomials(alpha, cos_view)[1..].to_vec();
            Sample { above, below, target: albedo + formula.albedo_dip(alpha, cos_view), weight }
        })
        .collect();
    let (above, below) = fit_rational(&samples);
    (std::array::from_fn(|i| above[i]), denominator(&below))
}

fn fit_schlick(nodes: &[Node]) -> ([f64; 6], [f64; 6]) {
    let samples: Vec<Sample> = nodes
        .iter()
        .map(|node| {
            let monomials = quadratic_monomials(node.alpha.sqrt(), node.cos_view);
            let scale = (1.0 - node.cos_view).powi(4);
            Sample {
                above: monomials.map(|m| scale * m).to_vec(),
                below: monomials[1..].to_vec(),
                target: node.schlick,
                weight: node.weight,
            }
        })
        .collect();
    let (above, below) = fit_rational(&samples);
    (std::array::from_fn(|i| above[i]), denominator(&below))
}

/// A value that a rational function `sum of p above / (1 + sum of q below)` should have.
struct Sample {
    above: Vec<f64>,
    below: Vec<f64>,
    target: f64,
    weight: f64,
}

/// Fits the coefficients above and below by Sanathanan and Koerner's method: a linear least squares of the
/// errors times the denominator, divided by the denominator of the step before. Answers the best step whose
/// denominator stays well above 0, rounded.
fn fit_rational(samples: &[Sample]) -> (Vec<f64>, Vec<f64>) {
    const STEPS: usize = 40;
    const SMALLEST_DENOMINATOR: f64 = 0.05;
    let (above, below) = (samples[0].above.len(), samples[0].below.len());
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let mut denominators = vec![1.0; samples.len()];
    let mut best = (f64::INFINITY, vec![0.0; above + below]);
    for _ in 0..STEPS {
        // Solve with the denominators as they are
        let mut problem = LeastSquares::new(above + below);
        for (sample, denominator) in samples.iter().zip(&denominators) {
            let scale = sample.weight.sqrt() / denominator;
            let of_below = sample.below.iter().map(|m| -m * sample.target);
            problem
                .add(sample.above.iter().copied().chain(of_below).map(|f| scale * f), scale * sample.target);
        }
        let coefficients: Vec<f64> = problem.solve().into_iter().map(six_digits).collect();
        // Measure what came of it
        let (p, q) = coefficients.split_at(above);
        let new: Vec<f64> = samples.iter().map(|sample| 1.0 + dot(q, &sample.below)).collect();
        let error: f64 = samples
            .iter()
            .zip(&new)
            .map(|(sample, below)| sample.weight * (dot(p, &sample.above) / below - sample.target).powi(2))
            .sum();
        if error < best.0 && new.iter().all(|&below| below > SMALLEST_DENOMINATOR) {
            best = (error, coefficients);
        }
        denominators = new.into_iter().map(|below| below.max(SMALLEST_DENOMINATOR)).collect();
    }
    let below = best.1.split_off(above);
    (best.1, below)
}

/// A denominator begins with 1.
fn denominator(rest: &[f64]) -> [f64; 6] {
    std::array::from_fn(|i| if i == 0 { 1.0 } else { rest[i - 1] })
}

fn cubic_monomials(x: f64, y: f64) -> [f64; 10] {
    [1.0, y, y * y, y * y * y, x, x * y, x * y * y, x * x, x * x * y, x * x * x]
}

fn quadratic_monomials(x: f64, y: f64) -> [f64; 6] {
    [1.0, y, y * y, x, x * y, x * x]
}
