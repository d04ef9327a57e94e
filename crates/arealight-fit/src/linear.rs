//! Linear algebra of small systems.

/// The lower triangle `L` of a symmetric matrix `L Lᵀ`; `None` if a pivot is not above `smallest_pivot`.
pub fn cholesky<const N: usize>(matrix: &[[f64; N]; N], smallest_pivot: f64) -> Option<[[f64; N]; N]> {
    let mut lower = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..=i {
            let known: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
            let value = matrix[i][j] - known;
            lower[i][j] = if i == j {
                if value.is_nan() || value <= smallest_pivot {
                    return None;
                }
                value.sqrt()
            } else {
                value / lower[j][j]
            };
        }
    }
    Some(lower)
}

/// A linear least squares problem: the unknowns that make the sum of the squared residuals of all rows
/// smallest.
pub struct LeastSquares {
    unknowns: usize,
    /// Of `unknowns` factors and the right-hand side each.
    rows: Vec<f64>,
}

impl LeastSquares {
    /// A problem without rows.
    pub fn new(unknowns: usize) -> Self {
        Self { unknowns, rows: Vec::new() }
    }

    /// Adds the row `sum of factor * unknown = target`. Factors that are not given are 0, and there are no
    /// more of them than unknowns.
    pub fn add(&mut self, factors: impl Iterator<Item = f64>, target: f64) {
        let start = self.rows.len();
        self.rows.extend(factors.take(self.unknowns));
        self.rows.resize(start + self.unknowns, 0.0);
        self.rows.push(target);
    }

    /// Solves it by Householder's reflections; an unknown that the rows do not determine is 0.
    pub fn solve(mut self) -> Vec<f64> {
        let (width, count) = (self.unknowns + 1, self.rows.len() / (self.unknowns + 1));
        let mut diagonal = vec![0.0; self.unknowns];
        for k in 0..self.unknowns.min(count) {
            // Find the reflection that clears the column below the diagonal
            let norm = |rows: &[f64], from: usize| {
                (from..count).map(|i| rows[i * width + k].powi(2)).sum::<f64>().sqrt()
            };
            let (left, whole) = (norm(&self.rows, k), norm(&self.rows, 0));
            if left.is_nan() || left <= 1e-13 * whole {
                continue;
            }
            diagonal[k] = -left.copysign(self.rows[k * width + k]);
            self.rows[k * width + k] -= diagonal[k];
            let half_square = -diagonal[k] * self.rows[k * width + k];
            // Reflect the columns to its right, all at once
            let mut projections = vec![0.0; width];
            for row in self.rows[k * width..].chunks_exact(width) {
                for j in k + 1..width {
                    projections[j] += row[k] * row[j];
                }
            }
            for row in self.rows[k * width..].chunks_exact_mut(width) {
                for j in k + 1..width {
                    row[j] -= row[k] * projections[j] / half_square;
                }
            }
        }
        self.substitute_backwards(&diagonal)
    }

    fn substitute_backwards(&self, diagonal: &[f64]) -> Vec<f64> {
        let mut unknowns = vec![0.0; self.unknowns];
        for k in (0..self.unknowns).rev().filter(|&k| diagonal[k] != 0.0) {
            let row = &self.rows[k * (self.unknowns + 1)..][..=self.unknowns];
            let known: f64 = (k + 1..self.unknowns).map(|j| row[j] * unknowns[j]).sum();
            unknowns[k] = (row[self.unknowns] - known) / diagonal[k];
        }
        unknowns
    }
}

/// Rounds to six significant digits: what is printed is what was measured.
pub fn six_digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_gives_its_matrix_back() {
        let matrix =
            [[4.0, 2.0, 0.0, 1.0], [2.0, 5.0, 1.0, 0.5], [0.0, 1.0, 3.0, 0.25], [1.0, 0.5, 0.25, 2.0]];
        let lower = cholesky(&matrix, 0.0).unwrap();
        for i in 0..4 {
            for j in 0..4 {
                let product: f64 = (0..4).map(|k| lower[i][k] * lower[j][k]).sum();
                assert!((product - matrix[i][j]).abs() < 1e-14, "{i} {j}: {product}");
            }
        }
        let mut indefinite = matrix;
        indefinite[2][2] = 0.1;
        assert_eq!(cholesky(&indefinite, 0.0), None);
    }

    #[test]
    fn a_cubic_is_found_again() {
        let cubic = [0.3, -1.0, 2.0, 0.7];
        let solve = |error: f64| {
            let mut problem = LeastSquares::new(4);
            for i in 0..50 {
                let x = f64::from(i) / 49.0;
                let target: f64 = cubic.iter().rfold(0.0, |sum, coefficient| sum * x + coefficient);
                let error = if i % 2 == 0 { error } else { -error };
                problem.add((0..4).map(|k| x.powi(k)), target + error);
            }
            problem.solve()
        };
        let worst = |found: &[f64]| found.iter().zip(&cubic).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // The monomials' condition, 1e3, times float64's rounding
        assert!(worst(&solve(0.0)) < 1e-12, "{:?}", solve(0.0));
        // A comparison that can fail: an alternating error of 0.01 shows, and averages out for the most part
        assert!((1e-5..0.1).contains(&worst(&solve(0.01))), "{:?}", solve(0.01));
    }

    #[test]
    fn what_is_not_determined_is_zero() {
        let mut problem = LeastSquares::new(3);
        for i in 0..5 {
            let x = f64::from(i);
            problem.add([1.0, x, 2.0 * x].into_iter(), 1.0 + x);
        }
        let found = problem.solve();
        assert!((found[0] - 1.0).abs() < 1e-12 && (found[1] - 1.0).abs() < 1e-12, "{found:?}");
        assert_eq!(found[2], 0.0);
        assert_eq!(LeastSquares::new(2).solve(), [0.0, 0.0]);
    }
}
