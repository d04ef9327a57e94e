//! Steps that Heitz et al. 2016 and the article of docs/data/traceability.md derive on the way, and that no
//! function of its own implements.

use crate::common::{direction, matrix, star, view_angle, view_at};
use arealight::table::{inverse_from_texel, mirror_frame};
use arealight_oracle::ggx::Ggx;
use arealight_oracle::ltsd::{Original, TransformedDistribution};
use arealight_oracle::polygon::form_factor;
use glam::{DMat3, DVec3};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// The reflection in the plane of incidence, the xz plane.
const REFLECTION: DMat3 = DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::Z);

fn cosine(matrix: DMat3) -> TransformedDistribution {
    TransformedDistribution::new(Original::ClampedCosine, matrix).unwrap()
}

/// The solid angle of a triangle (Van Oosterom and Strackee 1983), and six times the volume below it.
fn solid_angle_and_volume([a, b, c]: [DVec3; 3]) -> (f64, f64) {
    let volume = a.dot(b.cross(c)).abs();
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let base = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    (2.0 * volume.atan2(base), volume)
}

/// Half the size of what stands for an infinitesimal piece of the sphere.
const SMALL: f64 = 1e-4;

/// How far ratios of such pieces lie from their limit: the pieces are symmetric about their direction, so the
/// second power of their size counts, which a matrix of stretch six enlarges to `36 SMALL²`, some ten times.
const LIMIT: f64 = 1e-5;

/// A small triangle that touches the unit sphere at its middle.
fn piece(middle: DVec3) -> [DVec3; 3] {
    let (u, v) = middle.any_orthonormal_pair();
    [0.0, 1.0, 2.0].map(|third| {
        let (sin, cos) = (third * TAU / 3.0_f64).sin_cos();
        middle + (u * cos + v * sin) * SMALL
    })
}

/// The angle of a cosine that rounding may have brought outside [-1, 1].
#[expect(clippy::disallowed_methods, reason = "the argument is clamped")]
fn arccosine(cosine: f64) -> f64 {
    cosine.clamp(-1.0, 1.0).acos()
}

/// A texel of a table that makes a lobe.
fn texel() -> impl Strategy<Value = [f64; 4]> {
    (0.3..3.0_f64, -0.4..0.4_f64, -0.4..0.4_f64, 0.6..3.0_f64).prop_map(|(a, b, c, d)| [a, b, c, d])
}

proptest! {
    #[test]
    fn a_piece_of_the_sphere_keeps_its_mass(matrix in matrix(), original in direction()) {
        let lobe = cosine(matrix);
        let (here, there) = (piece(original), piece(original).map(|p| matrix * p));
        let ratio = solid_angle_and_volume(there).0 / solid_angle_and_volume(here).0;
        let direction = lobe.transform(original);
        prop_assert!((lobe.jacobian(direction) * ratio - 1.0).abs() < LIMIT, "{ratio}");
        let (mass, kept) = (Original::ClampedCosine.evaluate(original), lobe.evaluate(direction) * ratio);
        prop_assert!((mass - kept).abs() < LIMIT, "{mass} and {kept}");
        // the twin: with the square of the distance instead of the cube
        let distance = (matrix * original).length();
        let wrong = lobe.jacobian(direction) / distance;
        prop_assert!((distance - 1.0).abs() < 1e-3 || (wrong * ratio - 1.0).abs() > LIMIT);
    }

    #[test]
    fn the_jacobian_is_the_parallelogram_seen_from_the_origin(matrix in matrix(), original in direction()) {
        // Transform two sides of a unit square that touches the sphere
        let (side1, side2) = original.any_orthonormal_pair();
        let normal = (matrix * side1).cross(matrix * side2);
        let to_middle = matrix * original;
        let (area, distance) = (normal.length(), to_middle.length());
        let cosine_of_tilt = (to_middle.dot(normal) / (distance * area)).abs();
        let ratio = area * cosine_of_tilt / (distance * distance);
        let jacobian = cosine(matrix).jacobian(cosine(matrix).transform(original));
        // roundings of a matrix of condition 6
        prop_assert!((ratio * jacobian - 1.0).abs() < 1e-12, "{ratio} and {jacobian}");
        // the twin: without the tilt
        let flat = area / (distance * distance);
        prop_assert!(cosine_of_tilt > 0.99 || (flat * jacobian - 1.0).abs() > 1e-3);
    }

    #[test]
    fn the_jacobian_is_the_ratio_of_the_cones(matrix in matrix(), original in direction()) {
        let distance = (matrix * original).length();
        let (angle, volume) = solid_angle_and_volume(piece(original));
        let (new_angle, new_volume) = solid_angle_and_volume(piece(original).map(|p| matrix * p));
        // A cone of solid angle w and height r holds w r³ / 3; a triangle's is a sixth of the determinant
        prop_assert!((0.5 * volume / angle - 1.0).abs() < LIMIT);
        prop_assert!((0.5 * new_volume / (new_angle * distance.powi(3)) - 1.0).abs() < LIMIT);
        // a volume of 1e-8 is what is left of products of order one: 1e-8, times a stretch of 36
        prop_assert!((new_volume / (matrix.determinant().abs() * volume) - 1.0).abs() < 1e-6);
        let back = matrix.inverse() * cosine(matrix).transform(original);
        prop_assert!((distance * back.length() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_negative_scale_turns_the_distribution_around(matrix in matrix(), direction in direction()) {
        let (lobe, negated) = (cosine(matrix), cosine(-matrix));
        let (a, b) = (lobe.evaluate(direction), negated.evaluate(-direction));
        prop_assert!((a - b).abs() <= 1e-14 * lobe.jacobian(direction), "{a} and {b}");
        // It is another distribution: where one shines the other is dark
        prop_assert!(lobe.evaluate(direction) == 0.0 || negated.evaluate(direction) == 0.0);
    }

    #[test]
    fn lobes_are_mirrored_by_the_plane_of_incidence(
        theta in view_angle(), light in direction(), alpha in 1e-3..1.0_f64, texel in texel(),
    ) {
        let (view, mirrored) = (view_at(theta), REFLECTION * light);
        let lobe = Ggx { alpha };
        prop_assert_eq!(lobe.evaluate(view, light), lobe.evaluate(view, mirrored));
        // the twin: forth and back are not alike
        let turned = lobe.evaluate(view, light.with_x(-light.x));
        let differ = (lobe.evaluate(view, light) - turned).abs() > 1e-6 * turned;
        prop_assert!(differ || view.x < 0.01 || light.x.abs() < 0.01 || light.z < 0.01);
        let fitted = TransformedDistribution::from_inverse(
            Original::ClampedCosine, inverse_from_texel(texel, alpha, view.z)).unwrap();
        let (a, b) = (fitted.evaluate(light), fitted.evaluate(mirrored));
        prop_assert!((a - b).abs() <= 1e-12 * fitted.jacobian(light), "{a} and {b}");
    }

    #[test]
    fn transforms_of_a_table_commute_with_the_reflection(
        texel in texel(), alpha in 1e-3..1.0_f64, cos_view in 0.0..1.0_f64,
    ) {
        let inverse = inverse_from_texel(texel, alpha, cos_view);
        prop_assert_eq!(inverse * REFLECTION, REFLECTION * inverse);
        let zeros = [inverse.y_axis.x, inverse.x_axis.y, inverse.z_axis.y, inverse.y_axis.z];
        prop_assert_eq!(zeros, [0.0; 4]);
        // the twin: a turn about the normal does not commute
        let turned = inverse * DMat3::from_rotation_z(0.1);
        prop_assert_ne!(turned * REFLECTION, REFLECTION * turned);
    }

    #[test]
    fn arccosines_over_unit_vectors_sum_to_the_form_factor(star in star(2.0)) {
        // Lift the polygon above the horizon
        let lowest = star.vertices.iter().map(|v| v.z).fold(f64::INFINITY, f64::min);
        let vertices: Vec<DVec3> = star.vertices.iter().map(|v| *v + DVec3::Z * (0.1 - lowest)).collect();
        let unit: Vec<DVec3> = vertices.iter().map(|v| v.normalize_or(DVec3::Z)).collect();
        let edges = unit.iter().zip(unit.iter().cycle().skip(1));
        let sum: f64 = edges.map(|(a, b)| arccosine(a.dot(*b)) * a.cross(*b).normalize_or_zero().z).sum();
        // Positive for a polygon seen from its back; an arccosine near zero keeps eight digits
        prop_assert!((-sum / TAU - form_factor(&vertices)).abs() < 1e-7, "{sum}");
        let first = vertices.iter().zip(vertices.iter().cycle().skip(1));
        let not_unit: f64 = first.map(|(a, b)| arccosine(a.dot(*b)) * a.cross(*b).z).sum();
        let seen = sum.abs() > 1e-3;
        prop_assert!(!seen || (not_unit - sum).abs() > 1e-9, "the twin: vertices must be brought to length \
        one");
    }
}

#[test]
fn at_grazing_the_last_entry_vanishes_and_the_middle_one_does_not() {
    // A lobe about the mirror direction, seen along the surface: M cannot be divided by its entry 33
    for alpha in [1e-3, 0.1, 1.0] {
        let matrix = inverse_from_texel([1.0, 0.0, 0.0, 2.0], alpha, 0.0).inverse();
        assert!(matrix.z_axis.z.abs() < 1e-15, "{matrix}");
        assert_eq!(matrix.y_axis.y, 1.0);
        // In the mirror frame the entry is there, and of the size of a narrow lobe's length over its width
        let in_mirror_frame = mirror_frame(0.0).transpose() * matrix;
        assert!((in_mirror_frame.z_axis.z - 0.5 / alpha).abs() < 1e-12 / alpha);
        // the twin: seen from above, both can be divided by
        assert!(inverse_from_texel([1.0, 0.0, 0.0, 2.0], alpha, 1.0).inverse().z_axis.z > 0.4);
    }
}

/// Equations 32 to 37: the clamped cosine on a plane parallel to the surface, as a density over the plane's
/// area.
#[test]
fn the_lobe_on_a_parallel_plane_is_a_bump() {
    let height = 0.7;
    let bump = |x: f64, y: f64| {
        let square = x * x + y * y + height * height;
        height * height / (PI * square * square)
    };
    // Its integral over a rectangle is the rectangle's form factor: the midpoint rule errs by the cell's
    // square
    let cells = 400;
    let side = |i: u32| (f64::from(i) + 0.5) / f64::from(cells);
    let mut sum = 0.0;
    for (i, j) in (0..cells).flat_map(|j| (0..cells).map(move |i| (i, j))) {
        sum += bump(0.2 + 1.3 * side(i), -0.4 + 0.9 * side(j)) * 1.3 * 0.9 / f64::from(cells * cells);
    }
    let corner = |x: f64, y: f64| DVec3::new(x, y, height);
    // The front faces down
    let rectangle = [corner(0.2, -0.4), corner(0.2, 0.5), corner(1.5, 0.5), corner(1.5, -0.4)];
    assert!((sum - form_factor(&rectangle)).abs() < 1e-6, "{sum} {}", form_factor(&rectangle));
    // The Gaussian of its peak has the variance r^2 / 2; the bump itself has heavier tails
    let variance = 0.5 * height * height;
    assert!((bump(0.0, 0.0) - 1.0 / (2.0 * PI * variance)).abs() < 1e-15);
    let gaussian = |x: f64| (-0.5 * x * x / variance).exp() / (2.0 * PI * variance);
    assert!(bump(3.0, 0.0) > 100.0 * gaussian(3.0));
}
