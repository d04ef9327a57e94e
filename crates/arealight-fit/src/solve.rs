//! The fit of one texel: nonlinear least squares on the integrals over probes.

use glam::DVec3;

use crate::error::FitError;
use crate::linear::cholesky;
use crate::lobe::Lobe;
use crate::nodes::{Node, Nodes, Texel};
use crate::probes::probe_rows;
use arealight::table::mirror_frame;

/// Most steps that were ever of use are 20.
const MAX_STEPS: usize = 40;

/// A step that gains less than this share of the loss is the last.
const SMALLEST_GAIN: f64 = 1e-6;

/// How strongly a texel is held at its guess, against how strongly the probes determine it. Enough to decide
/// what they do not, so that the table is smooth; too little to move what they do.
const ANCHOR: f64 = 1e-3;

/// The least squares of one texel: the sum over probes of (integral of the lobe - integral aimed at)², once with
/// the lobe clipped by its own horizon only, once by the surface's as well and scaled to keep its energy. Both
/// ways are used for shading, and a table that is fitted for one of them alone does badly in the other.
pub struct Problem {
    /// Those above the surface come first.
    pub nodes: Vec<Node>,
    above: usize,
    /// The surface's normal, in the mirror frame.
    pub normal: DVec3,
    /// Probes by nodes: the solid angle of each node that lies in each probe.
    rows: Vec<f32>,
    /// The integrals aimed at, a probe: of the lobe, and of its part above the surface scaled to the same energy.
    /// A BRDF that reflects nothing below the surface has one and the same for both.
    targets: Vec<[f64; 2]>,
    /// The lobe that the nodes were laid out for.
    guess: Lobe,
    /// The weights of the squared distances of the texel's entries from the guess's.
    anchor: [f64; 4],
}

impl Problem {
    /// Prepares the problem of a texel, on nodes laid out for a lobe like `guess`. The lobe aimed at is
    /// `f * (shares[0] + shares[1] * schlick)`.
    ///
    /// # Errors
    /// [`FitError::NoNodes`] if the BRDF has no usable value.
    pub fn new(shares: [f64; 2], texel: &Texel, guess: &Lobe) -> Result<Self, FitError> {
        let Nodes { all: nodes, above } = texel.nodes(guess);
        if nodes.is_empty() {
            return Err(FitError::NoNodes { alpha: texel.alpha, cos_view: texel.cos_view });
        }
        let rows = probe_rows(guess, texel.cos_view, &nodes);
        let [of_lobe, of_schlick] = shares;
        let target: Vec<f32> =
            nodes.iter().map(|node| (of_lobe * node.value + of_schlick * node.schlick) as f32).collect();
        let normal = mirror_frame(texel.cos_view).transpose() * DVec3::Z;
        let mut problem =
            Self { nodes, above, normal, rows, targets: Vec::new(), guess: *guess, anchor: [0.0; 4] };
        let weights: Vec<f32> = problem.nodes.iter().map(|node| node.weight as f32).collect();
        let [all_above, all_below] = problem.sums(&weights, &target);
        let scale = if all_above > 0.0 { (all_above + all_below) / all_above } else { 1.0 };
        problem.targets = problem
            .rows
            .chunks_exact(target.len())
            .map(|row| {
                let [above, below] = problem.sums(row, &target);
                [above + below, scale * above]
            })
            .collect();
        let (matrix, _) = problem.normal_equations(guess, [true; 4]);
        problem.anchor = std::array::from_fn(|i| ANCHOR * matrix[i][i]);
        Ok(problem)
    }

    /// The loss of a lobe; infinite if it is not valid.
    pub fn loss(&self, lobe: &Lobe) -> f64 {
        if !lobe.is_valid() {
            return f64::INFINITY;
        }
        let densities: Vec<f32> = self.nodes.iter().map(|node| lobe.density(node.direction) as f32).collect();
        let (share, _) = lobe.share_above(self.normal);
        let misfit: f64 = self
            .probes()
            .map(|(row, target)| {
                let [above, below] = self.sums(row, &densities);
                (above + below - target[0]).powi(2) + (above / share - target[1]).powi(2)
            })
            .sum();
        let distance: f64 =
            (0..4).map(|i| self.anchor[i] * (lobe.texel[i] - self.guess.texel[i]).powi(2)).sum();
        misfit + distance
    }

    /// Half the loss's second derivatives by the entries of the texel about a lobe, in the manner of Gauss and Newton,
    /// with what holds it at the guess.
    pub fn curvature(&self, lobe: &Lobe) -> [[f64; 4]; 4] {
        self.normal_equations(lobe, [true; 4]).0
    }

    /// Minimises the loss from a starting lobe over the entries of the texel that are `free`.
    pub fn minimise(&self, start: Lobe, free: [bool; 4]) -> Lobe {
        minimise(
            start,
            |lobe| self.loss(lobe),
            |lobe| self.normal_equations(lobe, free),
            |lobe, step: &[f64; 4]| Lobe { texel: std::array::from_fn(|i| lobe.texel[i] - step[i]), ..*lobe },
        )
    }

    /// `JᵀJ` and `Jᵀr` of the residuals; entries that are not free get a unit diagonal and no slope.
    fn normal_equations(&self, lobe: &Lobe, free: [bool; 4]) -> ([[f64; 4]; 4], [f64; 4]) {
        // Evaluate the density and its derivatives at the nodes
        let mut densities = Vec::with_capacity(self.nodes.len());
        let mut derivatives: [Vec<f32>; 4] = std::array::from_fn(|_| Vec::with_capacity(self.nodes.len()));
        for node in &self.nodes {
            let (density, gradient) = lobe.density_and_gradient(node.direction);
            densities.push(density as f32);
            for (column, derivative) in derivatives.iter_mut().zip(gradient) {
                column.push(derivative as f32);
            }
        }
        // Sum them over each probe, and accumulate both residuals
        let (share, share_gradient) = lobe.share_above(self.normal);
        let mut normal = [[0.0; 4]; 4];
        let mut slope = [0.0; 4];
        let mut accumulate = |residual: f64, gradient: [f64; 4]| {
            for i in 0..4 {
                slope[i] += residual * gradient[i];
                for j in 0..4 {
                    normal[i][j] += gradient[i] * gradient[j];
                }
            }
        };
        for (row, target) in self.probes() {
            let [above, below] = self.sums(row, &densities);
            let by_entry: [[f64; 2]; 4] =
                std::array::from_fn(|k| if free[k] { self.sums(row, &derivatives[k]) } else { [0.0; 2] });
            accumulate(above + below - target[0], by_entry.map(|[above, below]| above + below));
            let scaled = above / share;
            let by_share = |k: usize| if free[k] { scaled * share_gradient[k] } else { 0.0 };
            let gradient = std::array::from_fn(|k| (by_entry[k][0] - by_share(k)) / share);
            accumulate(scaled - target[1], gradient);
        }
        for i in 0..4 {
            if free[i] {
                normal[i][i] += self.anchor[i];
                slope[i] += self.anchor[i] * (lobe.texel[i] - self.guess.texel[i]);
            } else {
                normal[i][i] = 1.0;
            }
        }
        (normal, slope)
    }

    /// Of each probe the solid angle of each node within it, and the integrals aimed at.
    pub fn probes(&self) -> impl Iterator<Item = (&[f32], [f64; 2])> {
        self.rows.chunks_exact(self.nodes.len()).zip(self.targets.iter().copied())
    }

    /// The integral over a probe of what has `values` at the nodes: its parts above and below the surface.
    pub fn sums(&self, row: &[f32], values: &[f32]) -> [f64; 2] {
        let (row_above, row_below) = row.split_at(self.above);
        let (above, below) = values.split_at(self.above);
        [dot(row_above, above), dot(row_below, below)]
    }
}

/// Minimises a loss of N parameters by Gauss-Newton steps, damped as Levenberg and Marquardt do; one is taken only if the loss falls.
/// `equations` gives `JᵀJ` and `Jᵀr`, `moved` what a step, which is to be taken away, leads to.
pub fn minimise<T: Copy, const N: usize>(
    start: T,
    loss: impl Fn(&T) -> f64,
    equations: impl Fn(&T) -> ([[f64; N]; N], [f64; N]),
    moved: impl Fn(&T, &[f64; N]) -> T,
) -> T {
    let mut best = start;
    let mut best_loss = loss(&start);
    let mut damping = 1e-3;
    for _ in 0..MAX_STEPS {
        let (normal, slope) = equations(&best);
        // Raise the damping until a step improves
        let mut improved = None;
        while improved.is_none() && damping < 1e9 {
            improved = damped_step(&normal, &slope, damping)
                .map(|step| moved(&best, &step))
                .map(|candidate| (candidate, loss(&candidate)))
                .filter(|(_, loss)| *loss < best_loss);
            damping *= if improved.is_some() { 0.2 } else { 4.0 };
        }
        let Some((candidate, loss)) = improved else { break };
        let gain = best_loss - loss;
        (best, best_loss) = (candidate, loss);
        damping = damping.max(1e-9);
        if gain < SMALLEST_GAIN * best_loss {
            break;
        }
    }
    best
}

/// Solves `(N + damping diag N) step = slope` by Cholesky's decomposition of the system scaled to a unit
/// diagonal; `None` if it is not positive definite.
fn damped_step<const N: usize>(normal: &[[f64; N]; N], slope: &[f64; N], damping: f64) -> Option<[f64; N]> {
    let scale: [f64; N] = std::array::from_fn(|i| 1.0 / normal[i][i].max(f64::MIN_POSITIVE).sqrt());
    let damped: [[f64; N]; N] = std::array::from_fn(|i| {
        std::array::from_fn(|j| normal[i][j] * scale[i] * scale[j] + if i == j { damping } else { 0.0 })
    });
    let lower = cholesky(&damped, 1e-14)?;
    // Substitute forwards, then backwards
    let mut step = [0.0; N];
    for i in 0..N {
        let sum: f64 = (0..i).map(|k| lower[i][k] * step[k]).sum();
        step[i] = (slope[i] * scale[i] - sum) / lower[i][i];
    }
    for i in (0..N).rev() {
        let sum: f64 = (i + 1..N).map(|k| lower[k][i] * step[k]).sum();
        step[i] = (step[i] - sum) / lower[i][i];
    }
    Some(std::array::from_fn(|i| step[i] * scale[i]))
}

/// The dot product in eight lanes of float32, in an order that does not depend on the machine. Residuals are
/// about 1e-2 of the integrals, so that its rounding, 1e-6, is far below them.
fn dot(a: &[f32], b: &[f32]) -> f64 {
    const LANES: usize = 8;
    let mut sums = [0.0_f32; LANES];
    let (a, b) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let tail: f32 = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a.zip(b) {
        for k in 0..LANES {
            sums[k] += a[k] * b[k];
        }
    }
    f64::from(sums.iter().sum::<f32>() + tail)
}
