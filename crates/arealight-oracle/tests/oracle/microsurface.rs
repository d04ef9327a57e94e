//! Light that facets reflect more than once: random walks against known albedos, and what is added for it
//! against random walks.

use arealight::{LightTable, Quality};
use arealight_oracle::ggx::Ggx;
use arealight_oracle::material::Surface;
use arealight_oracle::microsurface::{Microsurface, Walk};
use arealight_oracle::shading::{RelativeLight, ltc_on};
use arealight_oracle::stream::Stream;
use glam::DVec3;
use std::sync::LazyLock;

static TABLE: LazyLock<LightTable> = LazyLock::new(LightTable::ggx);

fn view_at(theta: f64) -> DVec3 {
    DVec3::new(theta.sin(), 0.0, theta.cos())
}

fn walks(surface: Microsurface, view: DVec3, count: usize, random: &mut Stream) -> Vec<Walk> {
    (0..count).filter_map(|_| surface.walk(view, || random.unit())).collect()
}

#[test]
fn a_white_microsurface_sends_all_that_it_gets_and_once_what_ggx_does() {
    const COUNT: usize = 40_000;
    let mut random = Stream::from_seed(11);
    for roughness in [0.2, 0.5, 0.8, 1.0_f64] {
        for theta in [0.0, 0.7, 1.2, 1.5] {
            let white = Microsurface { ggx: Ggx { alpha: roughness * roughness }, f0: DVec3::ONE, f90: 1.0 };
            let found = walks(white, view_at(theta), COUNT, &mut random);
            let all = found.len() as f64 / COUNT as f64;
            let once = found.iter().filter(|walk| walk.reflections == 1).count() as f64 / COUNT as f64;
            let albedo = TABLE.lookup(roughness, theta.cos()).albedo;
            // Four deviations of a share of so many walks, and what a table's lookup errs
            assert!(all > 0.9999, "{roughness}, {theta}: {all}");
            assert!((once - albedo).abs() < 0.012, "{roughness}, {theta}: {once} and {albedo}");
        }
    }
}

/// Mean error, over quads of unit radiance, of what is added to GGX's lobe, and of adding nothing.
fn errors(f0: f64, random: &mut Stream) -> [f64; 2] {
    const WALKS: usize = 20_000;
    const QUADS: usize = 12;
    let [mut error, mut without, mut count] = [0.0; 3];
    for step in 0..24 {
        let roughness = 0.3 + 0.7 * random.unit();
        let view = view_at((0.5 + f64::from(step)) / 24.0 * 1.45);
        let alpha = roughness * roughness;
        let surface = Microsurface { ggx: Ggx { alpha }, f0: DVec3::splat(f0), f90: 1.0 };
        let found = walks(surface, view, WALKS, random);
        let one = |multiple_scattering| Surface {
            f0: DVec3::splat(f0),
            f90: 1.0,
            alpha,
            multiple_scattering,
            ..Surface::default()
        };
        for _ in 0..QUADS {
            // A rectangle about a direction above the surface, as wide as it is far
            let z = random.unit();
            let (y, x) = (std::f64::consts::TAU * random.unit()).sin_cos();
            let center = DVec3::new(x * (1.0 - z * z).sqrt(), y * (1.0 - z * z).sqrt(), z);
            let (u, v) = center.any_orthonormal_pair();
            let [u, v] = [u, v].map(|axis| axis * (0.2 + 0.6 * random.unit()));
            let corners = [center - u - v, center - u + v, center + u + v, center + u - v];
            let light = RelativeLight {
                vertices: corners.to_vec(),
                radiance: DVec3::ONE,
                two_sided: true,
                ..RelativeLight::default()
            };
            let shade =
                |surface: &Surface| ltc_on(Quality::default(), &TABLE, surface, DVec3::Z, view, &light).x;
            let added = shade(&one(true)) - shade(&one(false));
            let hits = |walk: &&Walk| {
                let at = walk.direction / walk.direction.dot(center);
                let offset = at - center;
                walk.reflections > 1
                    && walk.direction.dot(center) > 0.0
                    && offset.dot(u).abs() <= u.length_squared()
                    && offset.dot(v).abs() <= v.length_squared()
            };
            let truth = found.iter().filter(hits).map(|walk| walk.weight.x).sum::<f64>() / WALKS as f64;
            error += (added - truth).abs();
            without += truth;
            count += 1.0;
        }
    }
    [error / count, without / count]
}

#[test]
fn what_is_added_is_near_to_random_walks() {
    let mut random = Stream::from_seed(12);
    for (f0, most) in [(1.0, 7e-3), (0.9, 5.6e-3), (0.5, 2.4e-3)] {
        let [error, without] = errors(f0, &mut random);
        println!("F0 = {f0}: {:.2}e-3, without {:.2}e-3", 1e3 * error, 1e3 * without);
        // Twice the means that the models were chosen by; the walks' own noise is below 1e-3
        assert!(error < most, "{f0}: {error}");
        // The twin: adding nothing is farther away
        assert!(without > 3.0 * error, "{f0}: {without} and {error}");
    }
}
