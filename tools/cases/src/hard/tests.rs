use super::double::{Double, Number};
use super::edges::sum_edges;
use super::family::{FAMILIES, Family, Scope};
use super::judge::{Judged, Tally};
use super::promise::Promise;
use super::reference::Reference;
use super::*;
use arealight_oracle::polygon;
use glam::DVec3;
use std::f64::consts::TAU;

fn vertices(case: &HardCase) -> Vec<DVec3> {
    let anchor = DVec3::from_array(case.anchor.map(f64::from));
    case.offsets_exactly().into_iter().map(|o| anchor + DVec3::from_array(o)).collect()
}

fn cases(name: &str, count: u64) -> Vec<HardCase> {
    let table = arealight::LightTable::ggx();
    (0..count).map(|index| Family::find(name).unwrap().case(index, 0, &table)).collect()
}

fn sum(anchor: [f64; 3], offsets: &[[f64; 3]]) -> Double {
    sum_edges::<Double>(anchor, offsets).sum
}

/// How far two sums are apart, as form factors.
fn apart(a: Double, b: Double) -> f64 {
    ((a - b) / Double::exact(TAU)).round().abs()
}

#[test]
fn a_square_by_its_closed_form() {
    // A corner of the unit square above the point, one unit up: (atan(1/sqrt 2) / sqrt 2) / pi, by mpmath
    let square = [[0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 0.0, 1.0]];
    let expected = 0.138_531_605_994_892_997;
    let edges = sum_edges::<Double>([0.0; 3], &square);
    assert!((edges.signed_form_factor() - expected).abs() < 1e-16);
    assert!(sum([0.0; 3], &square) == sum([0.0, 0.0, 1.0], &square.map(|[x, y, _]| [x, y, 0.0])));
}

#[test]
fn a_box_around_the_point_is_one() {
    // Corners of a box that is nowhere symmetric; the faces' fronts are inside
    let corner = |i: usize| [[-0.75, 1.5][i & 1], [-2.25, 0.5][i >> 1 & 1], [-1.125, 3.0][i >> 2 & 1]];
    let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6]];
    let all = faces.iter().fold(Double::ZERO, |all, face| all + sum([0.0; 3], &face.map(corner)));
    let tau =
        Double::angle(Double::ZERO, Double::exact(-1.0)) + Double::angle(Double::ZERO, Double::exact(-1.0));
    assert!(apart(all, tau) < 1e-29, "{:e}", apart(all, tau));
}

#[test]
fn parts_add_up_to_the_whole() {
    let mut compared = 0;
    for name in ["crossing", "above", "huge-near", "contact-interior"] {
        for case in cases(name, 200) {
            // A quad is two triangles with a common diagonal: exactly, since nothing is rounded
            let offsets = case.offsets_exactly();
            let [a, b, c, d] = offsets[..] else { continue };
            let sum = |offsets: &[[f64; 3]]| sum(case.anchor.map(f64::from), offsets);
            let whole = sum(&offsets);
            let parts = sum(&[a, b, c]) + sum(&[a, c, d]);
            assert!(apart(parts, whole) < 1e-25, "{name}: {:e}", apart(parts, whole));
            compared += 1;
        }
    }
    assert!(compared > 300, "{compared}");
    // The twin: a corner that moved by a part in 10^20
    let square = [[0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 0.0, 1.0]];
    let offset = square.map(|[x, y, _]| [x, y, 0.0]);
    let moved = offset.map(|[x, y, _]| [x, y, if x * y == 1.0 { 1e-20 } else { 0.0 }]);
    let difference = apart(sum([0.0, 0.0, 1.0], &offset), sum([0.0, 0.0, 1.0], &moved));
    assert!(difference > 1e-22 && difference < 1e-20, "{difference:e}");
}

#[test]
fn the_edge_sum_agrees_with_the_oracle_in_float64() {
    for name in ["above", "crossing", "concave", "many-vertices", "huge-near", "scaled", "far"] {
        let mut largest = 0.0_f64;
        for case in cases(name, 300) {
            let reference = Reference::new(&case);
            let expected = polygon::form_factor(&vertices(&case)).abs();
            // Contact amplifies float64's rounding of the clipped points
            let bound = 4e-15 + 1e-15 / reference.rho;
            let error = (reference.form_factor - expected).abs();
            assert!(error < bound, "{name}: {error:e} at rho {:e}: {case:?}", reference.rho);
            largest = largest.max(error);
        }
        assert!(largest > 0.0, "{name}: float64 is not exact");
    }
}

#[test]
fn far_lights_have_the_form_factor_of_their_area() {
    for case in cases("far", 500) {
        let reference = Reference::new(&case);
        let unit = reference.area / (std::f64::consts::PI * reference.distance.powi(2));
        let origin = DVec3::from_array(case.anchor.map(f64::from));
        if origin.length() < 1e4 {
            continue;
        }
        // cos cos' A / (pi d^2), to the size over the distance
        let offsets: Vec<DVec3> = case.offsets_exactly().into_iter().map(DVec3::from_array).collect();
        let doubled: DVec3 =
            (0..offsets.len()).map(|i| offsets[i].cross(offsets[(i + 1) % offsets.len()])).sum();
        let way = origin.normalize_or(DVec3::Z);
        let expected = unit * way.z * way.dot(doubled.normalize_or(DVec3::Z)).abs();
        let error = (reference.form_factor - expected).abs();
        assert!(error < 10.0 * unit / origin.length(), "{error:e} of {unit:e}");
    }
}

#[test]
fn the_distance_is_that_to_the_inside_an_edge_or_a_vertex() {
    let rho = |x: f32, z: f32| {
        let offsets = vec![[x, 0.0, z], [x + 3.0, 0.0, z], [x + 3.0, 4.0, z], [x, 4.0, z]];
        let reference = Reference::new(&HardCase { anchor: [0.0, -1.0, 0.0], offsets, flat: true });
        (reference.distance, reference.area)
    };
    assert_eq!(rho(-1.0, 0.25), (0.25, 12.0), "inside");
    assert_eq!(rho(3.0, 4.0), (5.0, 12.0), "beside an edge");
    let far = HardCase {
        anchor: [2.0, 3.0, 6.0],
        offsets: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        flat: true,
    };
    assert_eq!(Reference::new(&far).distance, 7.0, "before a vertex");
}

#[test]
fn a_result_is_judged_by_its_bits_and_its_error() {
    let family = Family::find("above").unwrap();
    let case = &cases("above", 1)[0];
    let judged = Judged::new(family, case);
    let exact = judged.reference().unwrap().form_factor;
    let broken = |bits: u32| {
        let mut tally = Tally::default();
        tally.add(0, bits, Some(exact), &judged.judge(bits));
        tally.shortfalls.keys().copied().collect::<Vec<_>>()
    };
    let near = (exact as f32).to_bits();
    assert_eq!(broken(near), []);
    // 2e-6 off is no value of a polygon nearby, and beyond the bound of the error
    assert_eq!(broken((exact as f32 + 2e-6).to_bits()), [Promise::Backward, Promise::Forward]);
    let range = [Promise::Range, Promise::Backward, Promise::Forward];
    for number in [f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(broken(number.to_bits()), range, "{number}");
    }
    assert_eq!(broken((exact as f32).to_bits() | 0x8000_0000), range, "negative");
    assert_eq!(broken(1.000_000_1_f32.to_bits())[0], Promise::Range);
    assert_eq!(broken((-0.0_f32).to_bits())[0], Promise::Range, "the sign of zero");
}

#[test]
fn what_is_not_finite_must_be_zero() {
    let family = Family::find("not-finite").unwrap();
    assert_eq!(family.scope, Scope::Zero);
    for case in cases("not-finite", 50) {
        assert!(!case.is_finite());
        let judged = Judged::new(family, &case);
        let ratio = |value: f32| judged.judge(value.to_bits()).ratios[0].unwrap();
        assert_eq!(ratio(0.0), (Promise::Zero, 0.0));
        assert_eq!(ratio(1e-30), (Promise::Zero, f64::INFINITY));
        assert_eq!(ratio(f32::NAN), (Promise::Zero, f64::INFINITY));
    }
}

#[test]
fn a_small_light_is_held_to_its_own_size() {
    let family = Family::find("far").unwrap();
    let table = arealight::LightTable::ggx();
    let index = (0..1000).find(|i| {
        let reference = Reference::new(&family.case(*i, 0, &table));
        reference.small_light_unit.is_some_and(|unit| unit < 1e-9)
            && reference.form_factor > 1e-12
            && reference.extents_away < 1e5
    });
    let judged = Judged::new(family, &family.case(index.unwrap(), 0, &table));
    // Nothing at all is within every absolute bound, and wrong
    let finding = judged.judge(0);
    assert!(finding.ratios[..2].iter().flatten().all(|(_, ratio)| *ratio < 1.0), "{finding:?}");
    let small = finding.ratios[2];
    assert!(matches!(small, Some((Promise::SmallLight, ratio)) if ratio > 1.0), "{finding:?}");
}

#[test]
fn every_family_is_what_it_says() {
    let table = arealight::LightTable::ggx();
    for family in FAMILIES {
        let again = |index| family.case(index, 0, &table);
        assert!((0..20).any(|index| again(index) != family.case(index, 1, &table)), "{}: seeds", family.name);
        let mut visible = 0;
        for index in 0..300 {
            let case = again(index);
            assert!(case.offsets.len() >= 3, "{}", family.name);
            if family.scope == Scope::Accuracy {
                assert!(case.is_finite(), "{}: {index}: {case:?}", family.name);
                let reference = Reference::new(&case);
                assert!((0.0..=1.0).contains(&reference.form_factor), "{}: {index}", family.name);
                assert!((0.0..=1.0).contains(&reference.rho), "{}: {index}: {reference:?}", family.name);
                visible += usize::from(reference.form_factor > 0.0);
            }
        }
        // A family of dark polygons tests nothing
        assert!(
            family.scope != Scope::Accuracy || visible > 60,
            "{}: {visible} of 300 are visible",
            family.name
        );
    }
    let mut names: Vec<_> = FAMILIES.iter().map(|family| family.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), FAMILIES.len());
}

#[test]
fn a_family_gives_the_same_case_on_every_machine() {
    // The bits that this test was written with, but for the families that another table changes
    let of_lobes = ["low-alpha", "low-alpha-far", "grazing"];
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for family in FAMILIES.iter().filter(|family| !of_lobes.contains(&family.name)) {
        for case in cases(family.name, 20) {
            for component in case.offsets.iter().flatten().chain(&case.anchor) {
                hash = (hash ^ u64::from(component.to_bits())).wrapping_mul(0x0100_0000_01b3);
            }
        }
    }
    assert_eq!(format!("{hash:016x}"), "1da68a8da2f10b95");
}
