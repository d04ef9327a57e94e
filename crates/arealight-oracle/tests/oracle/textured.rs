//! Textured lights: the lobe's integral against cubature and closed forms, and the footprints against it.

use crate::common::{direction, lengths_through, matrix, star};
use arealight::{Light, LightShape, LightTexture};
use arealight_oracle::cubature::{Region, Settings};
use arealight_oracle::ltsd::{Original, TransformedDistribution};
use arealight_oracle::polygon::{above_horizon, transformed_form_factor};
use arealight_oracle::shading::{RelativeLight, ShownImage, transformed_image_integral};
use arealight_oracle::texture::Texture;
use glam::{DMat3, DVec2, DVec3, Vec3};
use proptest::prelude::*;
use std::sync::Arc;

/// A light of any outline that shows `texture`: its box holds the image between `low` and `low + size`.
fn showing(vertices: &[DVec3], texture: &Arc<Texture>, low: DVec2, size: DVec2) -> RelativeLight {
    let mut light =
        Light { shape: LightShape::Polygon(vertices.to_vec()), radiance: Vec3::ONE, ..Light::default() };
    let normal = light.shape.area_vector().normalize_or(DVec3::Z);
    let u = (vertices[1] - vertices[0]).normalize_or(DVec3::X);
    let v = normal.cross(u);
    let flat: Vec<DVec2> = vertices.iter().map(|p| DVec2::new(p.dot(u), p.dot(v))).collect();
    let least = flat.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let most = flat.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    let uvs = flat.iter().map(|p| low + size * (*p - least) / (most - least)).collect();
    light.texture = Some(LightTexture { layer: 0, uvs });
    RelativeLight::textured(&light, DVec3::ZERO, Arc::clone(texture)).unwrap()
}

fn image(light: &RelativeLight) -> &ShownImage {
    light.image.as_ref().unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn a_white_image_is_the_form_factor(
        star in star(1.5), inverse in matrix(), both: bool, closer in 0.0..6.0_f64,
    ) {
        prop_assume!(star.relative_distance() > 1e-2);
        let normal = LightShape::Polygon(star.vertices.clone()).area_vector().normalize_or(DVec3::Z);
        let shift = normal * (normal.dot(star.vertices[0]) * (0.1_f64.powf(closer) - 1.0));
        let vertices: Vec<DVec3> = star.vertices.iter().map(|vertex| *vertex + shift).collect();
        let white = Arc::new(Texture::from_fn(3, 5, |_, _| DVec3::new(1.0, 2.0, 4.0)));
        let light = showing(&vertices, &white, DVec2::new(0.1, 0.2), DVec2::new(0.7, 0.8));
        let found = transformed_image_integral(&inverse, &vertices, image(&light), both);
        let visible = if both { above_horizon(&vertices) } else { vertices.clone() };
        let expected = transformed_form_factor(&inverse, &visible);
        // The rule's error at pieces as large as are allowed
        let off = (found - expected * DVec3::new(1.0, 2.0, 4.0)).abs().max_element();
        prop_assert!(off < 1e-5, "{found} and {expected}");
    }

    #[test]
    fn an_image_is_integrated_like_any_function(
        star in star(1.0), inverse in matrix(), shift in direction(),
    ) {
        prop_assume!(star.relative_distance() > 1e-1);
        // A linear ramp has no bends within the box, so that cubature converges
        let ramp = Texture::from_fn(2, 2, |x, y| DVec3::new(x as f64, y as f64, (x + 2 * y) as f64));
        let (low, size) = (DVec2::splat(0.25), DVec2::new(0.5, 0.4));
        let vertices: Vec<DVec3> = star.vertices.iter().map(|v| *v + 0.1 * shift).collect();
        let light = showing(&vertices, &Arc::new(ramp), low, size);
        let (image, map) = (image(&light), image(&light).map);
        let found = transformed_image_integral(&inverse, &vertices, image, false);
        let lobe = TransformedDistribution::from_inverse(Original::ClampedCosine, inverse).unwrap();
        let region = Region::polygon(&vertices).clipped(inverse.row(2));
        let normal = map.axis_u.cross(map.axis_v);
        let to_box = DMat3::from_cols(map.axis_u, map.axis_v, normal).inverse();
        let expected = region.integrate(&Settings::default(), |t| lengths_through(&inverse, t), |w| {
            let point = w * (map.corner.dot(normal) / w.dot(normal));
            let place = (to_box * (point - map.corner)).truncate();
            (image.texture.sample(map.low + map.size * place) * lobe.evaluate(w)).to_array()
        });
        let off = (found - DVec3::from_array(expected.value)).abs().max_element();
        prop_assert!(off < 2e-5, "{found} and {expected:?}");
    }
}
