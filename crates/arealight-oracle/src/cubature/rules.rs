//! Cubature rules on a triangle.
//!
//! Degree 8: Dunavant 1985, *High degree efficient symmetrical Gaussian quadrature rules for the triangle*,
//! 16 points, polished to float64. Degree 5: Radon 1948, seven points. Both have positive weights and points
//! inside the triangle, and share the centroid.

use glam::DVec3;

/// A point of a rule: barycentric coordinates, and the weight as a share of the area.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TrianglePoint {
    barycentric: [f64; 3],
    /// Share of the area.
    pub weight: f64,
}

impl TrianglePoint {
    /// The point in a triangle.
    pub fn interpolate(&self, [a, b, c]: &[DVec3; 3]) -> DVec3 {
        *a * self.barycentric[0] + *b * self.barycentric[1] + *c * self.barycentric[2]
    }
}

const fn point(weight: f64, x: f64, y: f64, z: f64) -> TrianglePoint {
    TrianglePoint { barycentric: [x, y, z], weight }
}

const THIRD: f64 = 1.0 / 3.0;
// Each orbit: the weight, then the barycentric coordinates that are permuted
const A: [f64; 3] = [0.0950916342672846248, 0.0814148234145536879, 0.459292588292723156];
const B: [f64; 3] = [0.10321737053471825, 0.658861384496479587, 0.170569307751760207];
const C: [f64; 3] = [0.0324584976231980803, 0.898905543365938049, 0.0505472283170309755];
const D: [f64; 4] =
    [0.0272303141744349943, 0.00839477740995760534, 0.263112829634638113, 0.728492392955404281];

/// The rule of degree 8; its first point is the centroid.
pub(crate) const DEGREE_8: [TrianglePoint; 16] = [
    point(0.144315607677787168, THIRD, THIRD, THIRD),
    point(A[0], A[1], A[2], A[2]),
    point(A[0], A[2], A[1], A[2]),
    point(A[0], A[2], A[2], A[1]),
    point(B[0], B[1], B[2], B[2]),
    point(B[0], B[2], B[1], B[2]),
    point(B[0], B[2], B[2], B[1]),
    point(C[0], C[1], C[2], C[2]),
    point(C[0], C[2], C[1], C[2]),
    point(C[0], C[2], C[2], C[1]),
    point(D[0], D[1], D[2], D[3]),
    point(D[0], D[2], D[3], D[1]),
    point(D[0], D[3], D[1], D[2]),
    point(D[0], D[1], D[3], D[2]),
    point(D[0], D[3], D[2], D[1]),
    point(D[0], D[2], D[1], D[3]),
];

const E: [f64; 3] = [0.125939180544827153, 0.797426985353087322, 0.101286507323456339];
const F: [f64; 3] = [0.132394152788506181, 0.0597158717897698205, 0.47014206410511509];

/// The weight of the centroid in the rule of degree 5.
pub(crate) const DEGREE_5_CENTER: f64 = 0.225;

/// The rule of degree 5 without its centroid.
pub(crate) const DEGREE_5: [TrianglePoint; 6] = [
    point(E[0], E[1], E[2], E[2]),
    point(E[0], E[2], E[1], E[2]),
    point(E[0], E[2], E[2], E[1]),
    point(F[0], F[1], F[2], F[2]),
    point(F[0], F[2], F[1], F[2]),
    point(F[0], F[2], F[2], F[1]),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest error of a rule over the monomials `x^i y^j` of one degree.
    fn error_at(points: &[TrianglePoint], degree: i32) -> f64 {
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        let error = |i: i32| {
            let j = degree - i;
            let exact = 2.0 * factorial(i) * factorial(j) / factorial(degree + 2);
            let monomial = |p: &TrianglePoint| p.weight * p.barycentric[0].powi(i) * p.barycentric[1].powi(j);
            (points.iter().map(monomial).sum::<f64>() - exact).abs()
        };
        (0..=degree).map(error).fold(0.0, f64::max)
    }

    #[test]
    fn each_rule_is_exact_to_its_degree_and_no_further() {
        let mut degree_5 = DEGREE_5.to_vec();
        degree_5.push(point(DEGREE_5_CENTER, THIRD, THIRD, THIRD));
        for (points, degree) in [(&DEGREE_8[..], 8), (&degree_5[..], 5)] {
            for d in 0..=degree {
                // sixteen terms, each rounded to 1.1e-16
                assert!(error_at(points, d) < 1e-15, "degree {d} of {degree}");
            }
            assert!(error_at(points, degree + 1) > 1e-6, "degree {degree} and one");
        }
    }
}
