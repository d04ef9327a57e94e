//! The six properties of linearly transformed spherical distributions (Heitz et al. 2016, section 3.1).

use crate::common::{direction, lengths_through, matrix, rotation, square_points, star};
use arealight_oracle::cubature::{Region, Settings};
use arealight_oracle::ltsd::{Original, TransformedDistribution};
use glam::{DMat3, DVec3};
use proptest::prelude::*;

const ORIGINALS: [Original; 3] =
    [Original::ClampedCosine, Original::UniformSphere, Original::UniformHemisphere];

fn original() -> impl Strategy<Value = Original> {
    prop::sample::select(ORIGINALS.to_vec())
}

fn distribution(original: Original, matrix: DMat3) -> TransformedDistribution {
    TransformedDistribution::new(original, matrix).unwrap()
}

/// The integral over a region of a density that is as narrow as M makes it, given M⁻¹. At the horizon of the
/// original it may have a jump or a kink: cut there, it is smooth on both sides.
fn integral(region: &Region, inverse: &DMat3, density: impl Fn(DVec3) -> f64) -> f64 {
    let side = |normal: DVec3| {
        let lengths = |triangle: &[DVec3; 3]| lengths_through(inverse, triangle);
        let region = region.clipped(normal);
        region.integrate(&Settings::default(), lengths, |direction| [density(direction)]).value[0]
    };
    side(inverse.row(2)) + side(-inverse.row(2))
}

/// How far such integrals may lie from the truth: the default settings' estimates.
const CUBATURE: f64 = 1e-6;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn shape_is_invariant_under_scaling(
        original in original(), matrix in matrix(), direction in direction(), log in -20.0..20.0_f64,
    ) {
        let (one, other) = (distribution(original, matrix), distribution(original, matrix * log.exp()));
        let (a, b) = (one.evaluate(direction), other.evaluate(direction));
        // roundings of an inverse of condition 6, in the cosine and in the Jacobian
        prop_assert!((a - b).abs() <= 1e-14 * one.jacobian(direction), "{a} and {b}");
        let turned = distribution(original, DMat3::from_rotation_x(0.1) * matrix);
        prop_assume!(original == Original::ClampedCosine && a > 1e-3);
        prop_assert!((a - turned.evaluate(direction)).abs() > 1e-9 * a, "the twin: the matrix does matter");
    }

    #[test]
    fn median_vector_is_transformed(matrix in matrix(), aside in direction()) {
        // z is the median vector of the clamped cosine: every plane that holds it halves the distribution
        let transformed = distribution(Original::ClampedCosine, matrix);
        let median = matrix * DVec3::Z;
        let half = |plane: DVec3| integral(&Region::sphere().clipped(plane), transformed.inverse(),
            |w| transformed.evaluate(w));
        let plane = median.cross(aside).normalize_or(DVec3::X);
        prop_assert!((half(plane) - 0.5).abs() < CUBATURE);
        // the twin: a plane that the vector lies off
        let tilted = (plane + 0.2 * median.normalize_or(DVec3::Z)).normalize_or(DVec3::X);
        prop_assert!(half(tilted) > 0.5 + CUBATURE);
    }

    #[test]
    fn integral_over_a_region_is_kept(original in original(), matrix in matrix(), star in star(1.5)) {
        prop_assume!(star.relative_distance() > 1e-2);
        let transformed = distribution(original, matrix);
        let back: Vec<DVec3> = star.vertices.iter().map(|v| *transformed.inverse() * *v).collect();
        let here = integral(&Region::polygon(&star.vertices), transformed.inverse(),
            |w| transformed.evaluate(w));
        // A transform that mirrors turns the polygon's front away
        let there = integral(&Region::polygon(&back), &DMat3::IDENTITY,
            |w| original.evaluate(w)) * matrix.determinant().signum();
        prop_assert!((here - there).abs() < CUBATURE, "{here} and {there}");
    }

    #[test]
    fn norm_is_kept(original in original(), matrix in matrix()) {
        let transformed = distribution(original, matrix);
        let norm = integral(&Region::sphere(), transformed.inverse(), |w| transformed.evaluate(w));
        prop_assert!((norm - 1.0).abs() < CUBATURE, "{norm}");
        // the twin: without the Jacobian it is not
        prop_assume!(original == Original::UniformSphere);
        let bare = integral(&Region::sphere(), transformed.inverse(),
            |w| transformed.evaluate(w) / transformed.jacobian(w).sqrt());
        let stretch = matrix * matrix.transpose() - DMat3::IDENTITY;
        prop_assume!(stretch.to_cols_array().iter().any(|e| e.abs() > 0.3));
        prop_assert!((bare - 1.0).abs() > CUBATURE, "{bare}");
    }

    #[test]
    fn rotations_compose(
        original in original(), matrix in matrix(), rotation in rotation(), direction in direction(),
        angle in 0.0..6.0_f64,
    ) {
        let plain = distribution(original, matrix);
        let close = |a: f64, b: f64| (a - b).abs() < 1e-12;
        // A rotation after M rotates the distribution
        let after = distribution(original, rotation * matrix);
        prop_assert!(close(after.evaluate(rotation * direction), plain.evaluate(direction)));
        // A rotation before M that leaves the original as it is leaves the distribution as it is
        let axis = if original == Original::UniformSphere { rotation } else { DMat3::from_rotation_z(angle) };
        let before = distribution(original, matrix * axis);
        prop_assert!(close(before.evaluate(direction), plain.evaluate(direction)));
    }

    #[test]
    fn samples_follow_the_density(original in original(), matrix in matrix(), cut in direction()) {
        let transformed = distribution(original, matrix);
        let density = integral(&Region::sphere().clipped(cut), transformed.inverse(),
            |w| transformed.evaluate(w));
        let count = 1 << 14;
        let inside = |u: &[f64; 2]| cut.dot(transformed.sample(*u)) > 0.0;
        let share = square_points(count).filter(inside).count() as f64 / count as f64;
        // counting 16384 even points along a border: below 2e-3
        prop_assert!((share - density).abs() < 4e-3, "{share} and {density}");
    }
}

#[test]
fn a_table_gives_the_inverse() {
    let inverse = DMat3::from_cols_array(&[1.5, 0.0, 0.3, 0.0, 1.0, 0.0, -0.4, 0.0, 0.2]);
    let one = TransformedDistribution::from_inverse(Original::ClampedCosine, inverse).unwrap();
    let other = distribution(Original::ClampedCosine, inverse.inverse());
    for w in [DVec3::Z, DVec3::new(0.6, 0.0, 0.8), DVec3::new(0.0, 0.8, 0.6)] {
        assert!((one.evaluate(w) - other.evaluate(w)).abs() < 1e-13);
        assert!((one.transform(one.transform_back(w)) - w).length() < 1e-14);
    }
}

#[test]
fn singular_matrices_are_refused() {
    for matrix in [DMat3::ZERO, DMat3::from_diagonal(DVec3::new(1.0, 1.0, 0.0)), DMat3::IDENTITY * f64::NAN] {
        let error = TransformedDistribution::new(Original::ClampedCosine, matrix).unwrap_err();
        assert!(error.to_string().contains("needs an invertible"), "{error}");
    }
}
