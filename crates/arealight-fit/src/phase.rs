//! The fit of [`PhaseFit`] to Henyey and Greenstein's phase function.
//!
//! All lobes are about one axis, so that the phase function and what stands for it are functions of one
//! cosine. The loss is the integral over the sphere of the squared error over the phase function, the sum of
//! a dozen g: its root bounds the error of any light. The weights of the lobes are linear, and solved for at
//! every step (variable projection); damped Gauss-Newton steps find what stretches them.
//!
//! One lobe forwards is enough to |g| = .6: a second one has no weight there even if it may. So it begins at
//! that knee, and lights in most fogs have a lobe less. Both pieces meet there.

use crate::linear::{LeastSquares, six_digits};
use crate::quadrature::gauss_legendre;
use crate::solve::{accumulate, minimise};
use arealight_oracle::phase::{MAX_ANISOTROPY, PhaseFit, PhasePiece, henyey_greenstein, stretched_cosine};
use std::f64::consts::PI;
use std::fmt::Write as _;

/// Where the second lobe forwards begins.
const KNEE: f64 = 0.6;

/// What is added to the phase function where errors are taken relative to it, 1/sr: behind a narrow one there
/// is little to be wrong about.
const OFFSET: f64 = 0.01;

/// How many g of a piece are fitted.
const COUNT: usize = 16;

/// Fits the lobes of Henyey and Greenstein's phase function. Coefficients have six digits, as [`rust`] and
/// [`glsl`] print them.
pub fn fit() -> PhaseFit {
    // Below the knee the narrower lobe has no weight
    let mut low = PhasePiece { stretch: [[0.0; 3]; 4], weight: [[0.0; 3]; 5] };
    low.stretch[0] = [1.0, 0.3, 1.0];
    let rows = |lobe: usize, rows: std::ops::Range<usize>| rows.map(move |row| (row, lobe));
    let stretch: [_; 8] = std::array::from_fn(|i| (i % 4, i / 4 * 2));
    let problem = Problem::new(0.0, KNEE, rows(0, 1..5).chain(rows(2, 1..5)).collect());
    let low = rounded(&problem.solved(low, &stretch));
    // Above it begins what is there already, and the narrower lobe without weight
    let fit = PhaseFit { knee: KNEE, pieces: [low, low] };
    let at_knee = fit.lobes(KNEE);
    let mut high = PhasePiece { stretch: [[0.0; 3]; 4], weight: [[0.0; 3]; 5] };
    high.stretch[0] = [at_knee.stretch[0], 0.4, at_knee.stretch[2]];
    high.stretch[1] = [-0.8, -0.9, 0.0];
    high.weight[0] = at_knee.weight;
    let high = rounded(&high);
    let stretch: [_; 10] = std::array::from_fn(|i| if i < 9 { (i % 3 + 1, i / 3) } else { (0, 1) });
    let problem = Problem::new(KNEE, MAX_ANISOTROPY, (0..3).flat_map(|lobe| rows(lobe, 1..5)).collect());
    let high = rounded(&problem.solved(high, &stretch));
    PhaseFit { knee: KNEE, pieces: [low, high] }
}

/// The integral over the sphere of the size of a fit's error at a g.
pub fn error(fit: &PhaseFit, g: f64) -> f64 {
    let lobes = fit.lobes(g);
    let size = |mu: f64| (lobes.density(mu) - henyey_greenstein(g, mu)).abs();
    // Evenly where the phase function is narrow, too
    let count = 20_000;
    let sum = |from: f64| -> f64 {
        (0..count)
            .map(|i| (f64::from(i) + 0.5) / f64::from(count))
            .map(|t| 4.0 * t.powi(3) * size(from * (1.0 - t.powi(4))))
            .sum()
    };
    2.0 * PI * (sum(1.0) + sum(-1.0)) / f64::from(count)
}

/// A piece to be fitted.
struct Problem {
    /// |g|, and the same from where the piece begins.
    places: Vec<[f64; 2]>,
    /// Cosines, and the solid angle of each.
    nodes: Vec<[f64; 2]>,
    /// The weights' coefficients that are not given, by power and lobe.
    weight: Vec<(usize, usize)>,
}

impl Problem {
    fn new(begin: f64, end: f64, weight: Vec<(usize, usize)>) -> Self {
        let place = |i: usize| (end - begin) * (i + 1) as f64 / COUNT as f64;
        let places = (0..COUNT).map(|i| [begin + place(i), place(i)]).collect();
        // Densely about the axis, and on either side of the horizon, where the lobes have a kink
        let node = |(t, w): (f64, f64)| {
            let forwards = [1.0 - t.powi(4), 8.0 * PI * w * t.powi(3)];
            [forwards, [t * t - 1.0, 4.0 * PI * w * t]]
        };
        Self { places, nodes: gauss_legendre::<32>().into_iter().flat_map(node).collect(), weight }
    }

    /// What is left between a piece and the phase function, at every node of every g.
    fn residuals(&self, piece: &PhasePiece) -> Vec<f64> {
        let mut residuals = Vec::with_capacity(self.places.len() * self.nodes.len());
        self.rows(piece, |factors, target| {
            let weights = self.weight.iter().map(|&(row, lobe)| piece.weight[row][lobe]);
            residuals.push(factors.iter().zip(weights).map(|(f, w)| f * w).sum::<f64>() - target);
        });
        residuals
    }

    /// Each node's factors of the free weights' coefficients, and what they should sum to.
    fn rows(&self, piece: &PhasePiece, mut take: impl FnMut(&[f64], f64)) {
        for &[g, x] in &self.places {
            // What is possible grows with g by orders of magnitude
            let importance = 1.0 / (0.002 + 0.05 * g.powi(6));
            let powers = powers(x);
            let stretch = |lobe: usize| stretch_at(piece, lobe, &powers);
            let stretches: [f64; 3] = std::array::from_fn(stretch);
            for &[mu, solid_angle] in &self.nodes {
                let truth = henyey_greenstein(g, mu);
                let scale = importance * (solid_angle / (truth + OFFSET)).sqrt();
                // What a lobe adds is taken from the uniform part
                let lobe = |k: usize| scale * (stretched_cosine(stretches[k], [mu, mu, -mu][k]) - 0.25 / PI);
                let lobes: [f64; 3] = std::array::from_fn(lobe);
                let given: f64 = (0..3).map(|k| piece.weight[0][k] * lobes[k]).sum();
                let factors: Vec<f64> = self.weight.iter().map(|&(row, k)| powers[row] * lobes[k]).collect();
                take(&factors, scale * (truth - 0.25 / PI) - given);
            }
        }
    }

    /// A piece with the best weights for what stretches its lobes.
    fn weighted(&self, mut piece: PhasePiece) -> PhasePiece {
        let mut problem = LeastSquares::new(self.weight.len());
        self.rows(&piece, |factors, target| problem.add(factors.iter().copied(), target));
        for (&(row, lobe), value) in self.weight.iter().zip(problem.solve()) {
            piece.weight[row][lobe] = value;
        }
        piece
    }

    /// The best piece from a start, over `N` coefficients of the stretches, by power and lobe.
    fn solved<const N: usize>(&self, start: PhasePiece, free: &[(usize, usize); N]) -> PhasePiece {
        const STEP: f64 = 1e-5;
        let moved = |piece: &PhasePiece, step: &[f64; N]| {
            let mut piece = *piece;
            for (&(row, lobe), step) in free.iter().zip(step) {
                piece.stretch[row][lobe] -= step;
            }
            self.weighted(piece)
        };
        let valid = |piece: &PhasePiece| {
            let narrow = |&[_, x]: &[f64; 2]| {
                (0..3)
                    .map(|lobe| stretch_at(piece, lobe, &powers(x)))
                    .any(|stretch| !(0.02..3.0).contains(&stretch))
            };
            !self.places.iter().any(narrow)
        };
        let loss = |piece: &PhasePiece| {
            if valid(piece) { self.residuals(piece).iter().map(|r| r * r).sum() } else { f64::INFINITY }
        };
        let equations = |piece: &PhasePiece| {
            let residuals = self.residuals(piece);
            let column = |i: usize| {
                let mut step = [0.0; N];
                step[i] = -STEP;
                self.residuals(&moved(piece, &step))
            };
            let columns: [Vec<f64>; N] = std::array::from_fn(column);
            let (mut normal, mut slope) = ([[0.0; N]; N], [0.0; N]);
            for (row, &residual) in residuals.iter().enumerate() {
                let gradient = std::array::from_fn(|i| (columns[i][row] - residual) / STEP);
                accumulate(&mut normal, &mut slope, residual, 1.0, &gradient);
            }
            (normal, slope)
        };
        minimise(self.weighted(start), loss, equations, moved)
    }
}

fn rounded(piece: &PhasePiece) -> PhasePiece {
    PhasePiece {
        stretch: piece.stretch.map(|row| row.map(six_digits)),
        weight: piece.weight.map(|row| row.map(six_digits)),
    }
}

/// A fit as the Rust text of a [`PhaseFit`].
pub fn rust(fit: &PhaseFit) -> String {
    let mut text = format!("PhaseFit {{\n    knee: {:?},\n    pieces: [\n", fit.knee);
    for piece in &fit.pieces {
        text.push_str("        PhasePiece {\n");
        for (name, rows) in [("stretch", &piece.stretch[..]), ("weight", &piece.weight)] {
            let _ = writeln!(text, "            {name}: [");
            for row in rows {
                let _ = writeln!(text, "                {row:?},");
            }
            text.push_str("            ],\n");
        }
        text.push_str("        },\n");
    }
    text.push_str("    ],\n}\n");
    text
}

/// A fit as the GLSL constants that `arealight_phase_lobes` evaluates.
pub fn glsl(fit: &PhaseFit) -> String {
    let mut text = format!("const float AREALIGHT_PHASE_KNEE = {:?};\n", fit.knee);
    for (side, piece) in ["LOW", "HIGH"].into_iter().zip(&fit.pieces) {
        for (name, rows) in [("STRETCH", &piece.stretch[..]), ("WEIGHT", &piece.weight)] {
            let count = rows.len();
            let vectors: Vec<String> =
                rows.iter().map(|[a, b, c]| format!("vec3({a:?}, {b:?}, {c:?})")).collect();
            let lines = vectors.join(",\n    ");
            let _ = writeln!(
                text,
                "const vec3 AREALIGHT_PHASE_{name}_{side}[{count}] = vec3[{count}](\n    {lines});"
            );
        }
    }
    text
}

/// The powers of a piece's variable.
fn powers(x: f64) -> [f64; 5] {
    [1.0, x, x * x, x * x * x, x * x * x * x]
}

/// A lobe's stretch by a piece's polynomial.
fn stretch_at(piece: &PhasePiece, lobe: usize, powers: &[f64; 5]) -> f64 {
    piece.stretch.iter().zip(powers).map(|(row, power)| row[lobe] * power).sum()
}
