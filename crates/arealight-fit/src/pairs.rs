//! The fit of two lobes for one: columns of texels, ten numbers each.

use arealight::table::{DIELECTRIC_F0, LobePairs};
use rayon::prelude::*;

use crate::brdf::{Brdf, Magnitude};
use crate::error::FitError;
use crate::fit::node_of;
use crate::lobe::Lobe;
use crate::nodes::Texel;
use crate::solve::{Quadrature, accumulate, minimise};

/// The numbers of a pair: the four entries of either lobe, and the second one's share of the energy at a
/// reflectance of 1 and at [`DIELECTRIC_F0`].
const PARAMETERS: usize = 10;

/// How strongly a texel is held at its guess, as [`crate::solve`]'s: ten times as much, since two lobes leave
/// more to decide.
const ANCHOR: f64 = 1e-2;

/// Weight of the dielectric's squares; those of a reflectance of 1 have 1. A dielectric's lobe has a tenth of
/// a metal's energy or less: at equal weight metals would pay for differences that nobody sees.
const DIELECTRIC_WEIGHT: f64 = 0.1;

/// At the first node the first lobe is begun half as wide as one lobe, the second twice as wide, and with
/// this share. Any start like it leads to the same lobes, but for columns that would end in another minimum.
const SPREAD: f64 = 2.0;
const FIRST_SHARE: f64 = 0.3;

/// Two lobes and the share of the energy that the second one has.
#[derive(Debug, Clone, Copy)]
struct Pair {
    lobes: [Lobe; 2],
    /// At a reflectance of 1, and of [`DIELECTRIC_F0`].
    second_shares: [f64; 2],
}

/// What is fitted at the nodes of a table, in its order. `progress` is called after each texel.
///
/// # Errors
/// [`FitError`] if the BRDF has no usable value at some texel.
pub fn fit_pairs(
    brdf: &dyn Brdf,
    size: u32,
    magnitude: &[Magnitude],
    progress: &(dyn Fn() + Sync),
) -> Result<LobePairs, FitError> {
    let nodes = size as usize;
    let columns: Vec<Vec<Pair>> = (0..nodes)
        .into_par_iter()
        .map(|x| fit_column(brdf, size, x, magnitude, progress))
        .collect::<Result<_, FitError>>()?;
    // From columns to rows
    let at = |i: usize| &columns[i % nodes][i / nodes];
    let matrix =
        |lobe: usize| (0..nodes * nodes).map(|i| at(i).lobes[lobe].texel.map(|entry| entry as f32)).collect();
    Ok(LobePairs {
        matrices: [matrix(0), matrix(1)],
        second_shares: (0..nodes * nodes).map(|i| at(i).second_shares.map(|share| share as f32)).collect(),
    })
}

/// Fits the pair of one texel from a pair near it: the matrix texels of both lobes, and the second one's
/// shares.
///
/// # Errors
/// As [`fit_pairs`].
pub fn fit_pair_at(
    texel: &Texel,
    magnitude: Magnitude,
    near: [Lobe; 2],
    second_shares: [f64; 2],
) -> Result<([Lobe; 2], [f64; 2]), FitError> {
    let near = Pair { lobes: near, second_shares };
    let found = PairProblem::new(magnitude, texel, near)?.minimise(near, [true; PARAMETERS]);
    Ok((found.lobes, found.second_shares))
}

/// Fits the pairs of a roughness from the normal to the horizon, each starting from the one before.
fn fit_column(
    brdf: &dyn Brdf,
    size: u32,
    x: usize,
    magnitude: &[Magnitude],
    progress: &(dyn Fn() + Sync),
) -> Result<Vec<Pair>, FitError> {
    let mut pair = Pair::at_normal(node_of(size, x).0);
    let mut cos_before = 1.0;
    (0..size as usize)
        .map(|y| {
            let index = y * size as usize + x;
            let (alpha, cos_view) = node_of(size, index);
            let guess = pair.narrowed(cos_before, cos_view);
            let texel = Texel { brdf, alpha, cos_view };
            let problem = PairProblem::new(magnitude[index], &texel, guess)?;
            let start = if problem.loss(&pair) < problem.loss(&guess) { pair } else { guess };
            // Seen from the normal lobes are round, as one lobe is
            let is_free = |i: usize| i >= 8 || cos_view < 1.0 || i % 4 == 3;
            pair = problem.minimise(start, std::array::from_fn(is_free));
            cos_before = cos_view;
            progress();
            Ok(pair)
        })
        .collect()
}

impl Pair {
    fn at_normal(alpha: f64) -> Self {
        let of_one = 2.0 / (1.0 + alpha);
        let round = |height: f64| Lobe { texel: [1.0, 0.0, 0.0, height], alpha };
        Self { lobes: [round(of_one * SPREAD), round(of_one / SPREAD)], second_shares: [FIRST_SHARE; 2] }
    }

    fn narrowed(&self, cos_view: f64, new_cos_view: f64) -> Self {
        Self { lobes: self.lobes.map(|lobe| lobe.narrowed(cos_view, new_cos_view)), ..*self }
    }

    fn parameters(&self) -> [f64; PARAMETERS] {
        let [first, second] = self.lobes.map(|lobe| lobe.texel);
        std::array::from_fn(|i| match i {
            0..4 => first[i],
            4..8 => second[i - 4],
            _ => self.second_shares[i - 8],
        })
    }

    /// Without a step; shares stay in their range.
    fn moved(&self, step: &[f64; PARAMETERS]) -> Self {
        let lobe = |k: usize| {
            let texel = std::array::from_fn(|i| self.lobes[k].texel[i] - step[4 * k + i]);
            Lobe { texel, ..self.lobes[k] }
        };
        let share = |k: usize| (self.second_shares[k] - step[8 + k]).clamp(0.0, 1.0);
        Self { lobes: [lobe(0), lobe(1)], second_shares: [share(0), share(1)] }
    }
}

/// The least squares of a pair: those of one lobe ([`crate::solve::Problem`]) at both reflectances, of the
/// sum of both lobes. Clipped at the surface's horizon too, each is scaled to keep its energy.
struct PairProblem {
    quadrature: Quadrature,
    /// Of each probe, at either reflectance.
    targets: [Vec<[f64; 2]>; 2],
    guess: Pair,
    anchor: [f64; PARAMETERS],
}

/// What the squares count at either reflectance.
const WEIGHTS: [f64; 2] = [1.0, DIELECTRIC_WEIGHT];

impl PairProblem {
    /// Nodes are laid out for the wider of the guess's lobes, which the other lies in.
    fn new(magnitude: Magnitude, texel: &Texel, guess: Pair) -> Result<Self, FitError> {
        let [first, second] = guess.lobes;
        let wider = if first.texel[3] < second.texel[3] { first } else { second };
        let quadrature = Quadrature::new(texel, &wider)?;
        let targets = [1.0, DIELECTRIC_F0].map(|f0| {
            let energy = magnitude.at(f0);
            quadrature.targets([f0 / energy, (1.0 - f0) / energy])
        });
        let unanchored = Self { quadrature, targets, guess, anchor: [0.0; PARAMETERS] };
        let (matrix, _) = unanchored.normal_equations(&guess, [true; PARAMETERS]);
        Ok(Self { anchor: std::array::from_fn(|i| ANCHOR * matrix[i][i]), ..unanchored })
    }

    fn loss(&self, pair: &Pair) -> f64 {
        if !pair.lobes.iter().all(Lobe::is_valid) {
            return f64::INFINITY;
        }
        let [first, second] = pair.lobes.each_ref().map(|lobe| self.quadrature.integrals(lobe));
        let mut misfit = 0.0;
        for (probe, row) in self.quadrature.probes().enumerate() {
            let integrals = [first(row), second(row)];
            for ((targets, weight), share) in self.targets.iter().zip(WEIGHTS).zip(pair.second_shares) {
                for way in 0..2 {
                    let found = (1.0 - share) * integrals[0][way] + share * integrals[1][way];
                    misfit += weight * (found - targets[probe][way]).powi(2);
                }
            }
        }
        let distances = pair.parameters().into_iter().zip(self.guess.parameters()).zip(self.anchor);
        misfit + distances.map(|((found, guess), anchor)| anchor * (found - guess).powi(2)).sum::<f64>()
    }

    fn minimise(&self, start: Pair, free: [bool; PARAMETERS]) -> Pair {
        minimise(start, |pair| self.loss(pair), |pair| self.normal_equations(pair, free), Pair::moved)
    }

    /// `JᵀJ` and `Jᵀr` of the residuals; parameters that are not free get a unit diagonal and no slope.
    fn normal_equations(
        &self,
        pair: &Pair,
        free: [bool; PARAMETERS],
    ) -> ([[f64; PARAMETERS]; PARAMETERS], [f64; PARAMETERS]) {
        let gradients =
            |k: usize| self.quadrature.gradients(&pair.lobes[k], std::array::from_fn(|i| free[4 * k + i]));
        let (first, second) = (gradients(0), gradients(1));
        let mut normal = [[0.0; PARAMETERS]; PARAMETERS];
        let mut slope = [0.0; PARAMETERS];
        for (probe, row) in self.quadrature.probes().enumerate() {
            let lobes = [first(row), second(row)];
            for (at, (targets, weight)) in self.targets.iter().zip(WEIGHTS).enumerate() {
                let shares = [1.0 - pair.second_shares[at], pair.second_shares[at]];
                for way in 0..2 {
                    let mut residual = -targets[probe][way];
                    let mut gradient = [0.0; PARAMETERS];
                    for (k, (integrals, by_entry)) in lobes.iter().enumerate() {
                        residual += shares[k] * integrals[way];
                        for i in 0..4 {
                            gradient[4 * k + i] = shares[k] * by_entry[way][i];
                        }
                    }
                    // A larger share of the second takes from the first
                    gradient[8 + at] = lobes[1].0[way] - lobes[0].0[way];
                    accumulate(&mut normal, &mut slope, residual, weight, &gradient);
                }
            }
        }
        let (found, guess) = (pair.parameters(), self.guess.parameters());
        for i in 0..PARAMETERS {
            if free[i] {
                normal[i][i] += self.anchor[i];
                slope[i] += self.anchor[i] * (found[i] - guess[i]);
            } else {
                normal[i] = [0.0; PARAMETERS];
                for row in &mut normal {
                    row[i] = 0.0;
                }
                (normal[i][i], slope[i]) = (1.0, 0.0);
            }
        }
        (normal, slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::GgxBrdf;

    fn problem(alpha: f64, cos_view: f64) -> (PairProblem, Pair) {
        let texel = Texel { brdf: &GgxBrdf, alpha, cos_view };
        let guess = Pair::at_normal(alpha).narrowed(1.0, cos_view);
        (PairProblem::new(GgxBrdf.magnitude(alpha, cos_view), &texel, guess).unwrap(), guess)
    }

    #[test]
    fn the_slope_is_that_of_the_loss() {
        let (problem, guess) = problem(0.25, 0.4);
        let mut pair = guess.moved(&[0.02, -0.01, 0.03, 0.05, -0.02, 0.04, -0.03, 0.01, -0.05, 0.08]);
        pair.lobes[1].texel[3] *= 1.1;
        let (_, slope) = problem.normal_equations(&pair, [true; PARAMETERS]);
        for (i, slope) in slope.into_iter().enumerate() {
            let step: [f64; PARAMETERS] = std::array::from_fn(|k| if k == i { 1e-4 } else { 0.0 });
            let back = step.map(|part| -part);
            let by_difference = (problem.loss(&pair.moved(&back)) - problem.loss(&pair.moved(&step))) / 4e-4;
            // Float32's rounding of the sums, over the step
            let apart = (slope - by_difference).abs();
            assert!(apart < 2e-3 * slope.abs() + 2e-3, "{i}: {slope} {by_difference}");
        }
    }

    #[test]
    fn two_lobes_come_nearer_than_one() {
        for (alpha, cos_view) in [(0.09, 0.2), (0.25, 0.1), (0.5, 0.5)] {
            let (problem, guess) = problem(alpha, cos_view);
            let fitted = problem.minimise(guess, [true; PARAMETERS]);
            // The second lobe has no share, and stays where it is
            let one = Pair { second_shares: [0.0; 2], ..fitted };
            let of_one = problem.minimise(one, std::array::from_fn(|i| i < 4));
            assert!(problem.loss(&fitted) < 0.5 * problem.loss(&of_one), "{alpha} {cos_view}");
        }
    }
}
