//! Properties of the closed form, and the closed form against cubature and against other closed forms.

use crate::common::{Star, box_around, lengths_through, matrix, star};
use arealight_oracle::cubature::{Region, Settings, angles};
use arealight_oracle::ltsd::{Original, TransformedDistribution};
use arealight_oracle::polygon::{emitted, form_factor, transformed_form_factor};
use glam::{DMat3, DVec3};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// What two sums over the same polygon may differ by: a few roundings, which contact magnifies.
fn slack(star: &Star) -> f64 {
    4e-15 + 4e-15 / star.relative_distance().max(1e-12)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn splitting_changes_nothing(star in star(2.0), at in 1..9_usize) {
        let at = at.min(star.vertices.len() - 1);
        let mut first = star.vertices[..=at].to_vec();
        let mut second = star.vertices[at..].to_vec();
        second.push(star.vertices[0]);
        first.push(star.center);
        second.push(star.center);
        let (whole, parts) = (form_factor(&star.vertices), form_factor(&first) + form_factor(&second));
        prop_assert!((whole - parts).abs() < slack(&star), "{whole} and {parts}");
    }

    #[test]
    fn the_first_vertex_does_not_matter(star in star(2.0), by in 0..10_usize) {
        let mut rotated = star.vertices.clone();
        rotated.rotate_left(by % star.vertices.len());
        let (a, b) = (form_factor(&star.vertices), form_factor(&rotated));
        prop_assert!((a - b).abs() < slack(&star), "{a} and {b}");
    }

    #[test]
    fn reversal_negates(star in star(2.0)) {
        let reversed: Vec<DVec3> = star.vertices.iter().rev().copied().collect();
        let (front, back) = (form_factor(&star.vertices), form_factor(&reversed));
        prop_assert!((front + back).abs() < slack(&star), "{front} and {back}");
    }

    #[test]
    fn powers_of_two_scale_to_the_bit(star in star(2.0), exponent in -500..500_i32) {
        let scaled: Vec<DVec3> = star.vertices.iter().map(|v| *v * 2_f64.powi(exponent)).collect();
        prop_assert_eq!(form_factor(&star.vertices), form_factor(&scaled));
    }

    #[test]
    fn scale_does_not_matter(star in star(2.0), log in -50.0..50.0_f64) {
        let scaled: Vec<DVec3> = star.vertices.iter().map(|v| *v * log.exp()).collect();
        let (a, b) = (form_factor(&star.vertices), form_factor(&scaled));
        prop_assert!((a - b).abs() < slack(&star), "{a} and {b}");
    }

    #[test]
    fn rotation_about_the_normal_changes_nothing(star in star(2.0), angle in 0.0..TAU) {
        let rotation = DMat3::from_rotation_z(angle);
        let rotated: Vec<DVec3> = star.vertices.iter().map(|v| rotation * *v).collect();
        let (a, b) = (form_factor(&star.vertices), form_factor(&rotated));
        prop_assert!((a - b).abs() < slack(&star), "{a} and {b}");
    }

    #[test]
    fn a_vertex_on_an_edge_changes_nothing(star in star(2.0), share in 0.0..1.0_f64) {
        let mut more = star.vertices.clone();
        more.insert(1, star.vertices[0].lerp(star.vertices[1], share));
        let (a, b) = (form_factor(&star.vertices), form_factor(&more));
        prop_assert!((a - b).abs() < slack(&star), "{a} and {b}");
    }

    #[test]
    fn a_vertex_given_twice_changes_nothing(star in star(2.0), at in 0..10_usize) {
        let mut more = star.vertices.clone();
        let at = at % more.len();
        more.insert(at, more[at]);
        prop_assert_eq!(form_factor(&star.vertices), form_factor(&more));
    }

    #[test]
    fn a_box_around_the_point_sums_to_one_for_any_matrix(
        low in prop::array::uniform3(0.05..3.0_f64), high in prop::array::uniform3(0.05..3.0_f64),
        matrix in matrix(),
    ) {
        let faces = box_around(-DVec3::from_array(low), DVec3::from_array(high));
        let sum: f64 = faces.iter().map(|face| transformed_form_factor(&matrix, face)).sum();
        // 24 edges
        prop_assert!((sum - 1.0).abs() < 1e-14, "{sum}");
        let five: f64 = faces[..5].iter().map(|face| transformed_form_factor(&matrix, face)).sum();
        let sixth = transformed_form_factor(&matrix, &faces[5]);
        // (a face below the horizon sends nothing but rounding)
        prop_assert!(sixth < 1e-12 || (five - 1.0).abs() > 0.5 * sixth, "the twin: five faces leave a gap");
    }

    #[test]
    fn a_part_sends_no_more_than_the_whole(
        star in star(2.0), factors in prop::collection::vec(0.0..1.0_f64, 10),
    ) {
        let (whole, part) = (form_factor(&star.vertices), form_factor(&star.shrunk(&factors)));
        prop_assert!(part * whole.signum() <= whole.abs() + slack(&star), "{part} and {whole}");
    }

    #[test]
    fn any_bits_give_a_finite_share(
        bits in prop::collection::vec(any::<[u64; 3]>(), 0..6), entries in any::<[u64; 9]>(),
    ) {
        let vertices: Vec<DVec3> = bits.iter().map(|b| DVec3::from_array(b.map(f64::from_bits))).collect();
        let matrix = DMat3::from_cols_array(&entries.map(f64::from_bits));
        for factor in [form_factor(&vertices), transformed_form_factor(&matrix, &vertices)] {
            prop_assert!((-1.0..=1.0).contains(&factor), "{factor}");
            prop_assert!((0.0..=1.0).contains(&emitted(factor, false))
                && (0.0..=1.0).contains(&emitted(factor, true)));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn cubature_finds_the_same(star in star(2.0)) {
        prop_assume!(star.relative_distance() > 1e-3);
        let settings = Settings { relative_tolerance: 1e-8, ..Settings::default() };
        let region = Region::polygon(&star.vertices).clipped(DVec3::Z);
        let integral = region.integrate(&settings, angles, |w| [w.z / PI]).value[0];
        let closed = form_factor(&star.vertices);
        prop_assert!((integral - closed).abs() < 1e-9, "{integral} and {closed}");
        // the twin: without the horizon they differ, if the polygon reaches below it
        let unclipped = Region::polygon(&star.vertices).integrate(&settings, angles, |w| [w.z / PI]).value[0];
        let below = star.vertices.iter().any(|v| v.z < -0.1);
        prop_assert!(!below || (unclipped - closed).abs() > 1e-8, "{unclipped} and {closed}");
    }

    #[test]
    fn cubature_of_the_transformed_cosine_finds_the_same(star in star(2.0), matrix in matrix()) {
        prop_assume!(star.relative_distance() > 1e-2 && matrix.determinant() > 0.0);
        let lobe = TransformedDistribution::from_inverse(Original::ClampedCosine, matrix).unwrap();
        // Cut at the horizon of cosine space, where the transformed cosine has a kink
        let region = Region::polygon(&star.vertices).clipped(matrix.row(2));
        let integral = region.integrate(&Settings::default(), |t| lengths_through(&matrix, t),
            |w| [lobe.evaluate(w)]).value[0];
        let closed = transformed_form_factor(&matrix, &star.vertices);
        prop_assert!((integral - closed).abs() < 1e-7, "{integral} and {closed}");
    }

    #[test]
    fn far_polygons_keep_their_digits(star in star(0.5), log in 1.0..12.0_f64, matrix in matrix()) {
        let offset = DVec3::new(0.48, -0.36, 0.8) * 10_f64.powf(log);
        let far: Vec<DVec3> = star.vertices.iter().map(|v| *v + offset).collect();
        let lobe = TransformedDistribution::from_inverse(Original::ClampedCosine, matrix).unwrap();
        let region = Region::polygon(&far).clipped(matrix.row(2));
        let settings = Settings { relative_tolerance: 1e-12, max_evaluations: 100_000 };
        let integral = region.integrate(&settings, angles, |w| [lobe.evaluate(w)]).value[0];
        let closed = transformed_form_factor(&matrix, &far) * matrix.determinant().signum();
        let mirrored = integral * matrix.determinant().signum();
        // 1e-12 of what a disk of the extent would send, which the transform enlarges at most sixfold
        let disk = 6.0 * form_factor_of_disk(1.0, offset.length());
        prop_assert!((mirrored - closed).abs() <= 1e-12 * disk, "{mirrored} and {closed}");
    }
}

/// A disk of radius `r` at distance `d`, facing the point.
fn form_factor_of_disk(r: f64, d: f64) -> f64 {
    r * r / (r * r + d * d)
}

/// A rectangle `a × b` parallel to the surface at height one, a corner above the point, facing it: a sum of
/// positive terms, accurate at any size (Howell, configuration B-3).
fn parallel_corner(a: f64, b: f64) -> f64 {
    let (ra, rb) = (a.hypot(1.0), b.hypot(1.0));
    (a / ra * (b / ra).atan() + b / rb * (a / rb).atan()) / TAU
}

fn rectangle(a: f64, b: f64, z: f64) -> [DVec3; 4] {
    [DVec3::new(0.0, 0.0, z), DVec3::new(0.0, b, z), DVec3::new(a, b, z), DVec3::new(a, 0.0, z)]
}

#[test]
fn rectangles_of_any_size_match_their_closed_form() {
    for exponent in -18..=18 {
        for shape in [1.0, 0.7, 1e-3] {
            let (a, b) = (10_f64.powi(exponent), shape * 10_f64.powi(exponent));
            let (found, exact) = (form_factor(&rectangle(a, b, 1.0)), parallel_corner(a, b));
            // the bound of the module's text
            assert!((found - exact).abs() <= 1e-12 * exact, "{a} x {b}: {found:e} and {exact:e}");
        }
    }
}

#[test]
fn contact_is_exact_on_both_sides() {
    // A corner of the light above the point sends a quarter, however near it is
    for exponent in 0..=300 {
        let height = 10_f64.powi(-exponent);
        let found = form_factor(&rectangle(1.0, 1.0, height));
        let exact = parallel_corner(1.0 / height, 1.0 / height);
        assert!((found - exact).abs() < 1e-15, "height {height}: {found} and {exact}");
        assert_eq!(form_factor(&rectangle(1.0, 1.0, -height)), 0.0);
    }
    assert_eq!(form_factor(&rectangle(1.0, 1.0, 0.0)), 0.0, "in the surface's plane");
}

#[test]
fn a_wall_is_clipped_where_it_meets_the_floor() {
    // A wall at distance c, up to height a, from the point's foot to b (Howell, configuration B-4)
    let wall = |a: f64, b: f64, c: f64, below: f64| {
        [DVec3::new(c, 0.0, -below), DVec3::new(c, b, -below), DVec3::new(c, b, a), DVec3::new(c, 0.0, a)]
    };
    for (a, b, c) in [(1.0_f64, 1.0_f64, 1.0_f64), (3.0, 0.2, 0.1), (1e-2, 5.0, 1.0), (1.0, 1.0, 1e-8)] {
        let r = a.hypot(c);
        let exact = ((b / c).atan() - c / r * (b / r).atan()) / TAU;
        for below in [0.0, 1e-9, 0.3, 7.0, 1e6] {
            let mut vertices = wall(a, b, c, below);
            vertices.reverse();
            let found = form_factor(&vertices);
            assert!((found - exact).abs() < 4e-15, "{a} {b} {c}, {below} below: {found} and {exact}");
        }
    }
}

#[test]
fn a_concave_polygon_may_cross_the_horizon_several_times() {
    // A comb whose teeth dip below the floor, against its parts
    let at = |y: f64, z: f64| DVec3::new(1.0, y, z);
    let comb = [
        at(0.0, 1.0),
        at(0.0, -1.0),
        at(1.0, -1.0),
        at(1.0, 0.5),
        at(2.0, 0.5),
        at(2.0, -1.0),
        at(3.0, -1.0),
        at(3.0, 1.0),
    ];
    let quad = |y: [f64; 2], z: [f64; 2]| {
        form_factor(&[at(y[0], z[1]), at(y[0], z[0]), at(y[1], z[0]), at(y[1], z[1])])
    };
    let parts = quad([0.0, 1.0], [-1.0, 1.0]) + quad([1.0, 2.0], [0.5, 1.0]) + quad([2.0, 3.0], [-1.0, 1.0]);
    let whole = form_factor(&comb);
    assert!((whole - parts).abs() < 1e-15 && whole < -0.05, "{whole} and {parts}");
}

#[test]
fn the_front_is_the_right_hand_side() {
    // Seen from the point, a light overhead runs counter-clockwise: clockwise from above
    let facing = rectangle(1.0, 1.0, 1.0);
    assert!((facing[1] - facing[0]).cross(facing[2] - facing[0]).z < 0.0);
    assert!(form_factor(&facing) > 0.0);
    assert_eq!(emitted(-0.25, false), 0.0);
    assert_eq!(emitted(-0.25, true), 0.25);
}
