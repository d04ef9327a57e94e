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

/// The least squares of one texel: the sum over probes of (integral of the lobe - integral aimed at)², once
/// with the lobe clipped by its own horizon only, once by the surface's as well and scaled to keep its
/// energy. Both ways are used for shading, and a table that is fitted for one of them alone does badly in the
/// other.
pub struct Problem {
    quadrature: Quadrature,
    /// Those of the lobe aimed at, a probe.
    targets: Vec<[f64; 2]>,
    /// The lobe that the nodes were laid out for.
    guess: Lobe,
    /// The weights of the squared distances of the texel's entries from the guess's.
    anchor: [f64; 4],
}

/// The nodes and the probes of a texel, laid out for some lobe: what every aim there is fitted on.
pub struct Quadrature {
    /// Those above the surface come first.
    nodes: Vec<Node>,
    above: usize,
    /// The surface's normal, in the mirror frame.
    normal: DVec3,
    /// Probes by nodes: the solid angle of each node that lies in each probe.
    rows: Vec<f32>,
}

impl Quadrature {
    /// That of a texel, for lobes like `guess`.
    ///
    /// # Errors
    /// [`FitError::NoNodes`] if the BRDF has no usable value.
    pub fn new(texel: &Texel, guess: &Lobe) -> Result<Self, FitError> {
        let Nodes { all: nodes, above } = texel.nodes(guess);
        if nodes.is_empty() {
            return Err(FitError::NoNodes { alpha: texel.alpha, cos_view: texel.cos_view });
        }
        let rows = probe_rows(guess, texel.cos_view, &nodes);
        let normal = mirror_frame(texel.cos_view).transpose() * DVec3::Z;
        Ok(Self { nodes, above, normal, rows })
    }

    /// The integrals of the lobe `f * (shares[0] + shares[1] * schlick)`, a probe: of the lobe, and of its
    /// part above the surface scaled to the same energy. A BRDF that reflects nothing below the surface has
    /// one and the same for both.
    pub fn targets(&self, [of_lobe, of_schlick]: [f64; 2]) -> Vec<[f64; 2]> {
        let value = |node: &Node| (of_lobe * node.value + of_schlick * node.schlick) as f32;
        let target: Vec<f32> = self.nodes.iter().map(value).collect();
        let weights: Vec<f32> = self.nodes.iter().map(|node| node.weight as f32).collect();
        let [all_above, all_below] = self.sums(&weights, &target);
        let scale = if all_above > 0.0 { (all_above + all_below) / all_above } else { 1.0 };
        let integrals = |row| {
            let [above, below] = self.sums(row, &target);
            [above + below, scale * above]
        };
        self.probes().map(integrals).collect()
    }

    /// Of each probe the solid angle of each node within it.
    pub fn probes(&self) -> impl Iterator<Item = &[f32]> {
        self.rows.chunks_exact(self.nodes.len())
    }

    /// The integral over a probe of what has `values` at the nodes: its parts above and below the surface.
    fn sums(&self, row: &[f32], values: &[f32]) -> [f64; 2] {
        let (row_above, row_below) = row.split_at(self.above);
        let (above, below) = values.split_at(self.above);
        [dot(row_above, above), dot(row_below, below)]
    }

    /// A lobe's integrals over probes: with either way to clip, as [`Quadrature::targets`].
    pub fn integrals(&self, lobe: &Lobe) -> impl Fn(&[f32]) -> [f64; 2] {
        let densities: Vec<f32> = self.nodes.iter().map(|node| lobe.density(node.direction) as f32).collect();
        let (share, _) = lobe.share_above(self.normal);
        move |row| {
            let [above, below] = self.sums(row, &densities);
            [above + below, above / share]
        }
    }

    /// The same, and their derivatives by the entries of the lobe that are `free`; by the others 0.
    pub fn gradients(&self, lobe: &Lobe, free: [bool; 4]) -> impl Fn(&[f32]) -> ([f64; 2], [[f64; 4]; 2]) {
        let mut densities = Vec::with_capacity(self.nodes.len());
        let mut derivatives: [Vec<f32>; 4] = std::array::from_fn(|_| Vec::with_capacity(self.nodes.len()));
        for node in &self.nodes {
            let (density, gradient) = lobe.density_and_gradient(node.direction);
            densities.push(density as f32);
            for (column, derivative) in derivatives.iter_mut().zip(gradient) {
                column.push(derivative as f32);
            }
        }
        let (share, by_entry) = lobe.share_above(self.normal);
        move |row| {
            let [above, below] = self.sums(row, &densities);
            let scaled = above / share;
            let mut gradients = [[0.0; 4]; 2];
            for i in (0..4).filter(|&i| free[i]) {
                let [above, below] = self.sums(row, &derivatives[i]);
                gradients[0][i] = above + below;
                gradients[1][i] = (above - scaled * by_entry[i]) / share;
            }
            ([above + below, scaled], gradients)
        }
    }
}

impl Problem {
    /// Prepares the problem of a texel, on nodes laid out for a lobe like `guess`. The lobe aimed at is
    /// `f * (shares[0] + shares[1] * schlick)`.
    ///
    /// # Errors
    /// [`FitError::NoNodes`] if the BRDF has no usable value.
    pub fn new(shares: [f64; 2], texel: &Texel, guess: &Lobe) -> Result<Self, FitError> {
        let quadrature = Quadrature::new(texel, guess)?;
        let targets = quadrature.targets(shares);
        let mut problem = Self { quadrature, targets, guess: *guess, anchor: [0.0; 4] };
        let (matrix, _) = problem.normal_equations(guess, [true; 4]);
        problem.anchor = std::array::from_fn(|i| ANCHOR * matrix[i][i]);
        Ok(problem)
    }

    /// The loss of a lobe; infinite if it is not valid.
    pub fn loss(&self, lobe: &Lobe) -> f64 {
        if !lobe.is_valid() {
            return f64::INFINITY;
        }
        let integrals = self.quadrature.integrals(lobe);
        let misfit: f64 = self
            .quadrature
            .probes()
            .zip(&self.targets)
            .map(|(row, target)| {
                let [whole, above] = integrals(row);
                (whole - target[0]).powi(2) + (above - target[1]).powi(2)
            })
            .sum();
        let distance: f64 =
            (0..4).map(|i| self.anchor[i] * (lobe.texel[i] - self.guess.texel[i]).powi(2)).sum();
        misfit + distance
    }

    /// Half the loss's second derivatives by the entries of the texel about a lobe, in the manner of Gauss
    /// and Newton, with what holds it at the guess.
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
        let gradients = self.quadrature.gradients(lobe, free);
        let mut normal = [[0.0; 4]; 4];
        let mut slope = [0.0; 4];
        for (row, target) in self.quadrature.probes().zip(&self.targets) {
            let (integrals, gradients) = gradients(row);
            for (way, gradient) in gradients.iter().enumerate() {
                accumulate(&mut normal, &mut slope, integrals[way] - target[way], 1.0, gradient);
            }
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
}

/// Adds a residual, whose square counts `weight`, and its derivatives by N parameters to `JᵀJ` and `Jᵀr`.
pub fn accumulate<const N: usize>(
    normal: &mut [[f64; N]; N],
    slope: &mut [f64; N],
    residual: f64,
    weight: f64,
    gradient: &[f64; N],
) {
    for i in 0..N {
        slope[i] += weight * residual * gradient[i];
        for j in 0..N {
            normal[i][j] += weight * gradient[i] * gradient[j];
        }
    }
}

/// Minimises a loss of N parameters by Gauss-Newton steps, damped as Levenberg and Marquardt do; one is taken
/// only if the loss falls. `equations` gives `JᵀJ` and `Jᵀr`, `moved` what a step, which is to be taken away,
/// leads to.
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
