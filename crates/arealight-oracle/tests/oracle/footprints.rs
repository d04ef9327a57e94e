//! Every rung of the footprint against the integral of image times lobe, by families of poses: `docs/textures.md`'s tables.
//!
//! `cargo test --release -p arealight-oracle --test oracle footprints -- --nocapture` prints them for a few poses,
//! with `--ignored` for many, with ideal taps beside those in the pyramid.

use crate::textured::showing;
use arealight::{Footprint, PyramidSize};
use arealight_oracle::polygon::transformed_form_factor;
use arealight_oracle::shading::footprint::{Filter, SeenLight, filtered};
use arealight_oracle::shading::transformed_image_integral;
use arealight_oracle::texture::{Pyramid, Texture};
use glam::{DMat3, DVec2, DVec3};
use std::sync::Arc;

const SIDE: usize = 256;

const FILTERS: [(&str, Filter); 5] = [
    ("article", Filter::Article),
    ("R1", Filter::Rung(Footprint::Round)),
    ("R2", Filter::Rung(Footprint::Ellipse)),
    ("R3", Filter::Rung(Footprint::SplitTwo)),
    ("R4", Filter::Rung(Footprint::SplitFour)),
];

/// Where a family's lights and lobes are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Family {
    /// About the mirror direction, roughness up to .2.
    Sharp,
    /// The same, rougher.
    Rough,
    /// Lights through the surface's plane.
    Horizon,
    /// Anywhere, under Lambert's lobe.
    Diffuse,
}

impl Family {
    const ALL: [Self; 4] = [Self::Sharp, Self::Rough, Self::Horizon, Self::Diffuse];
}

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        // SplitMix64
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn direction(&mut self) -> DVec3 {
        let (z, phi) = (self.between(-1.0, 1.0), self.between(0.0, std::f64::consts::TAU));
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * phi.cos(), r * phi.sin(), z)
    }
}

/// A rectangle in the surface frame, and M⁻¹ of a lobe.
struct Pose {
    vertices: Vec<DVec3>,
    inverse: DMat3,
}

fn pose(random: &mut Random, family: Family) -> Pose {
    let table = arealight_table::ggx();
    let theta = random.between(0.0, 85.0_f64.to_radians());
    let roughness = match family {
        Family::Sharp => random.between(0.05, 0.2),
        Family::Rough => random.between(0.2, 1.0),
        Family::Horizon | Family::Diffuse => random.between(0.05, 1.0),
    };
    let inverse = if family == Family::Diffuse {
        DMat3::IDENTITY
    } else {
        table.lookup(roughness, theta.cos()).inverse
    };
    // As large as screens are, as far as they are
    let width = random.between(0.3_f64.ln(), 2.0_f64.ln()).exp();
    let height = width * random.between(0.4, 1.0);
    let distance = random.between(0.4, 2.5);
    let mirror = DVec3::new(-theta.sin(), 0.0, theta.cos());
    let center = match family {
        Family::Sharp | Family::Rough => {
            let aside = random.direction() * (0.5 * width * random.unit());
            mirror * distance + aside
        }
        Family::Horizon => {
            let phi = random.between(0.5, 1.5) * std::f64::consts::PI;
            DVec3::new(phi.cos(), phi.sin(), 0.0) * distance
                + DVec3::Z * (0.25 * height * random.between(-1.0, 1.0))
        }
        Family::Diffuse => {
            let direction = random.direction();
            direction.with_z(direction.z.abs()) * distance
        }
    };
    let normal =
        (-center.normalize_or(DVec3::Z) + 0.9 * random.direction() * random.unit()).normalize_or(DVec3::Z);
    let tangent = normal.cross(random.direction()).normalize_or(normal.any_orthonormal_vector());
    let (u, v) = (tangent * (0.5 * width), normal.cross(tangent) * (0.5 * height));
    Pose { vertices: vec![center - u - v, center + u - v, center + u + v, center - u + v], inverse }
}

/// Poses of which a lobe sees a light's front well enough for an error to be seen: a thousandth of its energy.
fn poses(family: Family, count: usize) -> Vec<Pose> {
    let mut random = Random(family as u64 + 1);
    let mut poses = Vec::new();
    while poses.len() < count {
        let pose = pose(&mut random, family);
        let above = pose.vertices.iter().all(|vertex| vertex.z > 0.0);
        if above != (family == Family::Horizon)
            && transformed_form_factor(&pose.inverse, &pose.vertices) > 1e-3
        {
            poses.push(pose);
        }
    }
    poses
}

/// Errors of one filter over poses: root of the mean square over the mean, and the median of the relative ones.
struct Errors {
    squares: f64,
    sum: f64,
    relative: Vec<f64>,
}

impl Errors {
    fn add(&mut self, found: DVec3, expected: DVec3) {
        self.squares += (found - expected).length_squared() / 3.0;
        self.sum += expected.element_sum() / 3.0;
        self.relative.push((found - expected).abs().max_element() / expected.max_element());
    }

    /// In percent.
    fn summary(&mut self) -> [f64; 2] {
        self.relative.sort_by(f64::total_cmp);
        let count = self.relative.len() as f64;
        [
            100.0 * (self.squares / count).sqrt() / (self.sum / count),
            100.0 * self.relative[self.relative.len() / 2],
        ]
    }
}

fn none() -> Errors {
    Errors { squares: 0.0, sum: 0.0, relative: Vec::new() }
}

/// Errors of each filter in percent, through the pyramid and with ideal Gaussian taps (zero unless `ideal`).
fn measure(family: Family, textures: &[Arc<Texture>], count: usize, ideal: bool) -> Vec<[[f64; 2]; 2]> {
    let size = PyramidSize::new(SIDE as u32, SIDE as u32).unwrap();
    let pyramids: Vec<Pyramid> = textures.iter().map(|texture| Pyramid::new(texture, size)).collect();
    let mut errors: Vec<[Errors; 2]> = FILTERS.iter().map(|_| [none(), none()]).collect();
    for pose in poses(family, count) {
        for (texture, pyramid) in textures.iter().zip(&pyramids) {
            let light = showing(&pose.vertices, texture, DVec2::ZERO, DVec2::ONE);
            let image = light.image.as_ref().unwrap();
            let expected = transformed_image_integral(&pose.inverse, &pose.vertices, image, false);
            let mut map = image.map;
            [map.corner, map.axis_u, map.axis_v] =
                [map.corner, map.axis_u, map.axis_v].map(|vector| pose.inverse * vector);
            let seen = SeenLight {
                vertices: pose.vertices.iter().map(|vertex| pose.inverse * *vertex).collect(),
                center: map.corner + 0.5 * (map.axis_u + map.axis_v),
                map,
                texels: DVec2::splat(SIDE as f64),
                horizons: Vec::new(),
                convex_quad: true,
            };
            for ((_, filter), errors) in FILTERS.iter().zip(&mut errors) {
                let found = filtered(*filter, &seen, |uv, sigma| pyramid.blurred(uv, sigma, DVec2::ONE));
                errors[0].add(found, expected);
                if ideal {
                    let found =
                        filtered(*filter, &seen, |uv, sigma| texture.blurred(uv, DVec2::splat(sigma)));
                    errors[1].add(found, expected);
                }
            }
        }
    }
    errors
        .iter_mut()
        .map(|both| [both[0].summary(), if ideal { both[1].summary() } else { [0.0; 2] }])
        .collect()
}

fn pictures() -> Vec<Arc<Texture>> {
    [Texture::checker(SIDE, SIDE, 8), Texture::gradient(SIDE, SIDE), Texture::noise(SIDE, SIDE, 1)]
        .map(Arc::new)
        .to_vec()
}

/// The most error of each filter after the article's, in each of [`Family::ALL`]: nRMSE and median, in percent. The horizon
/// has no bar: what of a light is seen there changes within a footprint.
const BARS: [[[f64; 2]; 4]; 4] = [
    [[12.0, 6.0], [7.5, 5.5], [f64::INFINITY; 2], [9.0, 6.0]],
    [[7.0, 4.5], [6.5, 4.5], [f64::INFINITY; 2], [9.0, 6.0]],
    [[7.0, 3.5], [4.0, 2.0], [f64::INFINITY; 2], [5.0, 2.5]],
    [[6.5, 2.2], [2.2, 1.0], [f64::INFINITY; 2], [3.0, 1.0]],
];

#[test]
fn every_rung_is_within_its_bar_and_the_article_is_not() {
    let mut article_is_worse = 0;
    for (f, family) in Family::ALL.into_iter().enumerate() {
        let rows = measure(family, &pictures(), 60, false);
        for ((name, _), [[rmse, median], _]) in FILTERS.iter().zip(&rows) {
            println!("{family:?} {name:8} {rmse:6.2}; {median:5.2}");
        }
        for (bars, [[rmse, median], _]) in BARS.iter().zip(&rows[1..]) {
            let [most_rmse, most_median] = bars[f];
            assert!(
                *rmse <= most_rmse && *median <= most_median,
                "{family:?}: {rmse}; {median} over {bars:?}"
            );
        }
        // The twin: the article's filter against the first rung's bars
        let [[rmse, median], _] = rows[0];
        article_is_worse += usize::from(rmse > BARS[0][f][0] || median > BARS[0][f][1]);
    }
    assert!(article_is_worse >= 2, "the bars let the article's filter pass");
}

fn print(title: &str, textures: &[Arc<Texture>], count: usize) {
    println!("{title}: nRMSE %; median %, through the pyramid | with ideal taps");
    for family in Family::ALL {
        let rows = measure(family, textures, count, true);
        for ((name, _), [[rmse, median], [ideal_rmse, ideal_median]]) in FILTERS.iter().zip(rows) {
            println!("{family:?} {name:8} {rmse:6.2}; {median:5.2} | {ideal_rmse:6.2}; {ideal_median:5.2}");
        }
    }
}

#[test]
#[ignore = "prints tables: minutes in a release build"]
fn all_footprints() {
    print("checker, gradient and noise", &pictures(), 100);
    print("spot", &[Arc::new(Texture::spot(SIDE, SIDE))], 100);
}
