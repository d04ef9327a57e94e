//! The fit of one texel: damped Gauss-Newton steps on a robust loss.

use crate::brdf::Magnitude;
use crate::lobe::Lobe;
use crate::nodes::Node;

/// What a fit minimises: the sum over reflectances of
/// `weight * integral |g - D|^exponent`, with `g` the BRDF's lobe at that reflectance, scaled to 1, and `D`
/// the transformed cosine.
#[derive(Debug, Clone, PartialEq)]
pub struct Loss {
    /// Pairs of a reflectance `f0` and its weight.
    pub reflectances: Vec<(f64, f64)>,
    /// Between 1 (indifferent to where energy is missing) and 2 (intent on the peak).
    pub exponent: f64,
}

impl Default for Loss {
    fn default() -> Self {
        Self { reflectances: vec![(0.04, 11.5), (1.0, 1.0)], exponent: 1.125 }
    }
}

/// The residuals' targets at the nodes, prepared once for many evaluations.
pub struct Problem<'a> {
    nodes: &'a [Node],
    exponent: f64,
    weights: Vec<f64>,
    /// `targets[node * reflectances + k]`
    targets: Vec<f64>,
}

const MAX_STEPS: usize = 40;

impl<'a> Problem<'a> {
    /// Prepares the loss at the nodes of a texel with these albedos.
    pub fn new(loss: &Loss, nodes: &'a [Node], magnitude: Magnitude) -> Self {
        let scale: Vec<(f64, f64)> =
            loss.reflectances.iter().map(|&(f0, _)| (f0, magnitude.at(f0))).collect();
        let targets = nodes
            .iter()
            .flat_map(|node| {
                scale.iter().map(|&(f0, albedo)| (f0 * node.value + (1.0 - f0) * node.schlick) / albedo)
            })
            .collect();
        // A term counts as much as the radiance that it gets wrong
        let weights = loss.reflectances.iter().map(|&(f0, weight)| weight * magnitude.at(f0)).collect();
        Self { nodes, exponent: loss.exponent, weights, targets }
    }

    /// The loss of a lobe; infinite if it is not valid.
    pub fn loss(&self, lobe: &Lobe) -> f64 {
        if !lobe.is_valid() {
            return f64::INFINITY;
        }
        let count = self.weights.len();
        let mut sum = 0.0;
        for (node, targets) in self.nodes.iter().zip(self.targets.chunks_exact(count)) {
            let density = lobe.density(node.direction);
            for (target, weight) in targets.iter().zip(&self.weights) {
                sum += node.weight * weight * (density - target).abs().powf(self.exponent);
            }
        }
        sum
    }

    /// Minimises the loss from a starting lobe; returns the best lobe found and its loss.
    ///
    /// Each step solves the weighted least squares that the loss is locally (weights `|residual|^(p - 2)`),
    /// damped as Levenberg and Marquardt do, and is taken only if the true loss falls.
    pub fn minimise(&self, start: Lobe) -> (Lobe, f64) {
        let mut best = start;
        let mut best_loss = self.loss(&start);
        let mut damping = 1e-3;
        for _ in 0..MAX_STEPS {
            let (normal, slope) = self.normal_equations(&best);
            // Raise the damping until a step improves
            let mut improved = None;
            while damping < 1e9 {
                if let Some(step) = damped_step(&normal, &slope, damping) {
                    let texel = std::array::from_fn(|i| best.texel[i] - step[i]);
                    let candidate = Lobe { texel, ..best };
                    let loss = self.loss(&candidate);
                    if loss < best_loss {
                        improved = Some((candidate, loss));
                        break;
                    }
                }
                damping *= 4.0;
            }
            let Some((candidate, loss)) = improved else { break };
            let gain = (best_loss - loss) / best_loss;
            (best, best_loss) = (candidate, loss);
            damping = (damping * 0.2).max(1e-9);
            if gain < 1e-6 {
                break;
            }
        }
        (best, best_loss)
    }

    /// JᵀWJ and JᵀWr of the residuals D - g.
    fn normal_equations(&self, lobe: &Lobe) -> ([[f64; 4]; 4], [f64; 4]) {
        let count = self.weights.len();
        let mut normal = [[0.0; 4]; 4];
        let mut slope = [0.0; 4];
        for (node, targets) in self.nodes.iter().zip(self.targets.chunks_exact(count)) {
            let (density, gradient) = lobe.density_and_gradient(node.direction);
            if density == 0.0 {
                continue;
            }
            let (mut weight, mut weighted_residual) = (0.0, 0.0);
            for (target, scale) in targets.iter().zip(&self.weights) {
                let residual = density - target;
                // The floor keeps a node that fits exactly from outweighing all others
                let floor = 1e-4 * (density + target);
                let w = node.weight * scale * residual.abs().max(floor).powf(self.exponent - 2.0);
                weight += w;
                weighted_residual += w * residual;
            }
            for i in 0..4 {
                slope[i] += weighted_residual * gradient[i];
                for j in 0..=i {
                    normal[i][j] += weight * gradient[i] * gradient[j];
                }
            }
        }
        for i in 0..4 {
            for j in i + 1..4 {
                normal[i][j] = normal[j][i];
            }
        }
        (normal, slope)
    }
}

/// Solves `(N + damping diag N) step = slope` by Cholesky's decomposition, on the system scaled to a unit
/// diagonal; `None` if the matrix is not positive definite.
fn damped_step(normal: &[[f64; 4]; 4], slope: &[f64; 4], damping: f64) -> Option<[f64; 4]> {
    let scale: [f64; 4] = std::array::from_fn(|i| 1.0 / normal[i][i].max(f64::MIN_POSITIVE).sqrt());
    let mut lower = [[0.0; 4]; 4];
    for i in 0..4 {
        for j in 0..=i {
            let mut value = normal[i][j] * scale[i] * scale[j];
            if i == j {
                value += damping;
            }
            for k in 0..j {
                value -= lower[i][k] * lower[j][k];
            }
            lower[i][j] = if i == j {
                if value.is_nan() || value <= 1e-14 {
                    return None;
                }
                value.sqrt()
            } else {
                value / lower[j][j]
            };
        }
    }
    // Substitute forwards, then backwards
    let mut step = [0.0; 4];
    for i in 0..4 {
        let sum: f64 = (0..i).map(|k| lower[i][k] * step[k]).sum();
        step[i] = (slope[i] * scale[i] - sum) / lower[i][i];
    }
    for i in (0..4).rev() {
        let sum: f64 = (i + 1..4).map(|k| lower[k][i] * step[k]).sum();
        step[i] = (step[i] - sum) / lower[i][i];
    }
    Some(std::array::from_fn(|i| step[i] * scale[i]))
}
