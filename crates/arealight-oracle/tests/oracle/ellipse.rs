//! The closed form of an ellipse against quadrature of its contour, against polygons, and its properties.

use crate::common::{direction, matrix, rotation};
use arealight_oracle::ellipse::{Ellipse, contour_form_factor, form_factor, vector_form_factor};
use arealight_oracle::polygon;
use glam::{DMat3, DVec3};
use proptest::prelude::*;
use std::f64::consts::TAU;

/// Ellipses about as large as they are far, many of which cross the horizon.
fn ellipse() -> impl Strategy<Value = Ellipse> {
    (prop::array::uniform3(-2.0..2.0_f64), rotation(), 0.1..2.0_f64, -3.0..0.0_f64, 0.0..TAU).prop_map(
        |(center, rotation, size, thin, turn)| {
            let (sin, cos) = turn.sin_cos();
            let [u, v] = [DVec3::X * size, DVec3::Y * size * thin.exp()].map(|axis| rotation * axis);
            Ellipse {
                center: DVec3::from_array(center),
                axis_u: u * cos + v * sin,
                axis_v: v * cos - u * sin,
            }
        },
    )
}

/// How close the origin is to the ellipse's plane, and to its outline there: what magnifies rounding.
fn nearness(ellipse: &Ellipse) -> f64 {
    let nearest = (0..4000).map(|i| ellipse.point(TAU * f64::from(i) / 4000.0).length());
    nearest.fold(f64::INFINITY, f64::min)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn the_closed_form_is_the_contour_integral(ellipse in ellipse()) {
        prop_assume!(nearness(&ellipse) > 1e-2);
        let (closed, contour) = (form_factor(&ellipse), contour_form_factor(&ellipse));
        // The quadrature's own tolerance, times its pieces
        prop_assert!((closed - contour).abs() < 2e-11, "{closed:e} and {contour:e}");
        // The twin: an ellipse a hundred thousandth larger is noticed where there is any light to speak of
        let larger = Ellipse { axis_u: ellipse.axis_u * 1.00001, axis_v: ellipse.axis_v * 1.00001,
            ..ellipse };
        prop_assert!(closed.abs() < 1e-4 || (form_factor(&larger) - contour).abs() > 2e-11);
    }

    #[test]
    fn inscribed_polygons_tend_to_it(ellipse in ellipse()) {
        prop_assume!(nearness(&ellipse) > 0.05);
        let at = |count| polygon::form_factor(&ellipse.polygon(count));
        // An inscribed polygon lacks a part of 2 pi^2 / (3 n^2) of the area, so does one twice as fine a
        // quarter of that
        let (coarse, fine) = (at(512), at(1024));
        let limit = fine + (fine - coarse) / 3.0;
        let closed = form_factor(&ellipse);
        // The next order, n^-4, with what a light 0.05 away makes of it; where an edge meets the horizon it
        // is n^-3
        prop_assert!((closed - limit).abs() < 2e-6, "{closed:e} and {limit:e}");
        prop_assert!(closed.abs() >= fine.abs() - 1e-12, "an inscribed polygon sends no more");
    }

    #[test]
    fn turning_and_scaling_change_nothing(ellipse in ellipse(), angle in 0.0..TAU, log in -30.0..30.0_f64) {
        prop_assume!(nearness(&ellipse) > 1e-3);
        let value = form_factor(&ellipse);
        let turned = ellipse.transformed(&DMat3::from_rotation_z(angle));
        let scaled = ellipse.transformed(&DMat3::from_diagonal(DVec3::splat(log.exp())));
        let swapped = Ellipse { axis_u: ellipse.axis_v, axis_v: ellipse.axis_u, ..ellipse };
        let (sin, cos) = angle.sin_cos();
        let again = Ellipse {
            axis_u: ellipse.axis_u * cos + ellipse.axis_v * sin,
            axis_v: ellipse.axis_v * cos - ellipse.axis_u * sin,
            ..ellipse
        };
        for other in [form_factor(&turned), form_factor(&scaled), -form_factor(&swapped),
            form_factor(&again)] {
            // Roundings, which a rim 1e-3 away magnifies
            prop_assert!((value - other).abs() < 1e-11, "{value:e} and {other:e}");
        }
    }

    #[test]
    fn what_the_horizon_hides_is_the_mirror_image(ellipse in ellipse()) {
        prop_assume!(nearness(&ellipse) > 1e-3);
        let mirrored = ellipse.transformed(&DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0)));
        let whole = vector_form_factor(&ellipse).z;
        let difference = form_factor(&ellipse).abs() - form_factor(&mirrored).abs();
        prop_assert!((whole - difference).abs() < 1e-11, "{whole:e} and {difference:e}");
    }

    #[test]
    fn the_vector_is_the_sum_over_the_whole_outline(
        ellipse in ellipse(), matrix in matrix(), up in direction(),
    ) {
        let ellipse = ellipse.transformed(&matrix);
        prop_assume!(nearness(&ellipse) > 1e-2);
        // In a frame whose z axis is `up`, and lifted so far that nothing is below: the same component
        let (x, y) = up.any_orthonormal_pair();
        let turned = ellipse.transformed(&DMat3::from_cols(x, y, up).transpose());
        let mirrored = turned.transformed(&DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0)));
        let clipped = contour_form_factor(&turned).abs() - contour_form_factor(&mirrored).abs();
        let component = vector_form_factor(&ellipse).dot(up);
        prop_assert!((component - clipped).abs() < 4e-11, "{component:e} and {clipped:e}");
    }
}

/// Contact, where no quadrature with fixed nodes holds: the disk's known limits.
#[test]
fn contact_tends_to_what_it_must() {
    for exponent in 1..12 {
        let height = 0.1_f64.powi(exponent);
        // Under the middle of a disk parallel to the surface: r^2 / (r^2 + h^2)
        let disk = Ellipse::disk(DVec3::Z * height, -DVec3::Z, 1.0);
        let expected = 1.0 / (1.0 + height * height);
        assert!((form_factor(&disk) - expected).abs() < 1e-15, "{height}");
        // Off the axis, with R the rim's two distances
        let disk = Ellipse::disk(DVec3::new(0.6, 0.0, height), -DVec3::Z, 1.0);
        let (d2, h2) = (0.36, height * height);
        let expected = 0.5 * (1.0 - (d2 + h2 - 1.0) / ((d2 + h2 + 1.0).powi(2) - 4.0 * d2).sqrt());
        assert!((form_factor(&disk) - expected).abs() < 1e-14, "{height}: {}", form_factor(&disk));
        // An upright disk at whose middle the surface stands covers half of its sky, but for what is seen
        // beside it
        let disk = Ellipse::disk(DVec3::X * height, -DVec3::X, 1.0);
        assert!((form_factor(&disk) - 0.5).abs() < height, "{height}: {}", form_factor(&disk));
    }
}

#[test]
fn what_is_not_an_ellipse_gives_nothing() {
    let disk = Ellipse::disk(DVec3::Z, -DVec3::Z, 1.0);
    let nothing = [
        Ellipse { axis_u: DVec3::ZERO, ..disk },
        Ellipse { axis_u: disk.axis_v, ..disk },
        Ellipse { center: DVec3::NAN, ..disk },
        Ellipse { axis_v: DVec3::splat(f64::INFINITY), ..disk },
        Ellipse { center: -DVec3::Z, ..disk },
    ];
    for ellipse in nothing {
        assert_eq!(form_factor(&ellipse), 0.0, "{ellipse:?}");
    }
    assert!((form_factor(&disk) - 0.5).abs() < 1e-15);
}
