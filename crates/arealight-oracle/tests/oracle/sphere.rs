//! The sphere's closed form against its silhouette's, which is checked by itself, and against rays.

use crate::common::{direction, matrix, square_points};
use arealight_oracle::ellipse;
use arealight_oracle::sphere::{Sphere, form_factor, transformed_form_factor};
use glam::{DMat3, DVec3};
use proptest::prelude::*;
use proptest::strategy::ValueTree as _;
use std::f64::consts::TAU;

fn sphere() -> impl Strategy<Value = Sphere> {
    (direction(), 1e-3..0.999_f64).prop_map(|(axis, radius)| Sphere { center: axis, radius })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn a_sphere_looks_like_its_silhouette(sphere in sphere()) {
        let (closed, disk) = (form_factor(&sphere), transformed_form_factor(&DMat3::IDENTITY, &sphere));
        // Both are of relative precision but for the disk's clipped form, whose terms are of the order of its
        // size
        prop_assert!((closed - disk).abs() < 1e-14, "{closed:e} and {disk:e}");
        let silhouette = sphere.silhouette().expect("outside");
        let contour = ellipse::contour_form_factor(&silhouette);
        prop_assert!((closed - contour).abs() < 2e-11, "{closed:e} and {contour:e}");
        // The twin: the disk through the center, which is smaller in the sky
        let flat = ellipse::Ellipse::disk(sphere.center, -sphere.center, sphere.radius);
        prop_assert!(sphere.radius < 0.1 || closed < 1e-3
            || (ellipse::form_factor(&flat) - closed).abs() > 1e-6);
    }

    #[test]
    fn far_spheres_keep_relative_precision(
        angle in 0.0..TAU, height in -0.9..0.9_f64, log in -30.0..-3.0_f64,
    ) {
        let radius = log.exp();
        let center = DVec3::new(angle.cos(), angle.sin(), height * radius);
        let sphere = Sphere { center, radius };
        // A small sphere on the horizon is a segment of a disk: F = r^3 (M1 - z M0) / pi with z its height
        // over r
        let z = center.z / radius;
        let (sine, angle) = ((1.0 - z * z).sqrt(), (1.0 - z * z).sqrt().atan2(-z));
        let solid = 2.0 / 3.0 * sine.powi(3) + z * (angle + z * sine);
        let expected = radius.powi(3) * solid / std::f64::consts::PI;
        // The sky's curvature
        let bound = 4.0 * radius * radius + 1e-13;
        prop_assert!((form_factor(&sphere) / expected - 1.0).abs() < bound, "{:e}, \
        {expected:e}", form_factor(&sphere));
    }
}

/// Rays of the transformed cosine against the sphere itself: independent of silhouettes.
#[test]
fn rays_hit_as_often() {
    const RAYS: usize = 40_000;
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    for _ in 0..20 {
        let sphere = sphere().new_tree(&mut runner).unwrap().current();
        let inverse = matrix().new_tree(&mut runner).unwrap().current();
        let forward = inverse.inverse();
        let hits = square_points(RAYS).filter(|[u, v]| {
            let (sin, cos) = (TAU * v).sin_cos();
            let cosine = DVec3::new(u.sqrt() * cos, u.sqrt() * sin, (1.0 - u).sqrt());
            let ray = (forward * cosine).try_normalize().expect("invertible");
            let along = sphere.center.dot(ray);
            along > 0.0 && (sphere.center - ray * along).length() < sphere.radius
        });
        let expected = hits.count() as f64 / RAYS as f64;
        // An evenly spread set's error is about its outline's length times n^(-3/4): 4e-4
        let found = transformed_form_factor(&inverse, &sphere);
        assert!((found - expected).abs() < 1.5e-3, "{found} and {expected}");
    }
}

#[test]
fn from_inside_there_is_nothing() {
    for center in [DVec3::ZERO, DVec3::X * 0.99, DVec3::Z] {
        let sphere = Sphere { center, radius: 1.0 };
        assert_eq!(form_factor(&sphere), 0.0);
        assert_eq!(transformed_form_factor(&DMat3::IDENTITY, &sphere), 0.0);
    }
}
