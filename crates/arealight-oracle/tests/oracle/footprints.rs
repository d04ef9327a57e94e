//! Every level of the footprint against the integral of image times lobe, by families of poses, all in
//! float64. `arealight bench textures` does the same on a device.
//!
//! `cargo test --release -p arealight-oracle --test oracle footprints -- --nocapture` prints them.

use arealight::{Footprint, PyramidSize};
use arealight_oracle::shading::footprint::{Filter, LobeSpaceLight, filtered};
use arealight_oracle::shading::poses::{Bar, Errors, Family, Summary, poses};
use arealight_oracle::shading::{RelativeLight, transformed_image_integral};
use arealight_oracle::texture::{Pyramid, Texture};
use glam::{DVec2, DVec3};
use std::sync::Arc;

const SIDE: usize = 256;

const FILTERS: [(&str, Filter); 4] = [
    ("article", Filter::Article),
    ("round", Filter::Level(Footprint::Round)),
    ("ellipse", Filter::Level(Footprint::Ellipse)),
    ("split", Filter::Level(Footprint::Split)),
];

/// Errors of each filter through the pyramid, for poses of a family that show each of `textures`.
fn measure(family: Family, textures: &[Arc<Texture>], count: usize) -> Vec<Summary> {
    let table = arealight::LightTable::ggx();
    let size = PyramidSize::new(SIDE as u32, SIDE as u32).unwrap();
    let pyramids: Vec<Pyramid> = textures.iter().map(|texture| Pyramid::new(texture, size)).collect();
    let mut errors: Vec<Errors> = FILTERS.iter().map(|_| Errors::default()).collect();
    for pose in poses(family, count, 0, &table) {
        let inverse = pose.inverse(&table);
        for (texture, pyramid) in textures.iter().zip(&pyramids) {
            let light = RelativeLight::textured(&pose.light(0), DVec3::ZERO, Arc::clone(texture)).unwrap();
            let image = light.image.as_ref().unwrap();
            let expected = transformed_image_integral(&inverse, &pose.vertices, image, false);
            let mut map = image.map;
            [map.corner, map.axis_u, map.axis_v] =
                [map.corner, map.axis_u, map.axis_v].map(|vector| inverse * vector);
            let seen = LobeSpaceLight {
                vertices: pose.vertices.iter().map(|vertex| inverse * *vertex).collect(),
                center: map.corner + 0.5 * (map.axis_u + map.axis_v),
                map,
                texels: DVec2::splat(SIDE as f64),
                horizons: Vec::new(),
                convex_quad: true,
            };
            for ((_, filter), errors) in FILTERS.iter().zip(&mut errors) {
                let found = filtered(*filter, &seen, |uv, sigma| pyramid.blurred(uv, sigma, DVec2::ONE));
                errors.add(found, expected);
            }
        }
    }
    errors.iter().map(Errors::summary).collect()
}

fn pictures() -> Vec<Arc<Texture>> {
    [Texture::checker(SIDE, SIDE, 8), Texture::gradient(SIDE, SIDE), Texture::noise(SIDE, SIDE, 1)]
        .map(Arc::new)
        .to_vec()
}

#[test]
fn every_level_is_within_its_bar_and_the_article_is_not() {
    let mut article_is_worse = 0;
    for family in Family::ALL {
        let rows = measure(family, &pictures(), 60);
        for ((name, filter), found) in FILTERS.iter().zip(&rows) {
            println!("{family:?} {name:8} {:6.2}; {:5.2}", found.rmse, found.median);
            if let Some(bar) = Bar::of(*filter, family) {
                assert!(bar.holds(found), "{family:?}, {name}: {found:?} over {bar:?}");
            }
        }
        // The twin: the article's filter against the first level's bars
        let bar = Bar::of(Filter::Level(Footprint::Round), family);
        article_is_worse += usize::from(bar.is_some_and(|bar| !bar.holds(&rows[0])));
    }
    assert!(article_is_worse >= 2, "the bars let the article's filter pass");
}
