//! The prefilter's levels and its trilinear lookup against a direct Gaussian, and a chain of boxes beside
//! them.

use arealight::PyramidSize;
use arealight::pyramid::WIDEST_BLUR;
use arealight_oracle::texture::{Blur, Pyramid, Texture};
use glam::{DVec2, DVec3};

const SIDE: usize = 256;

/// The pictures with the most error, RMS over mean, that is allowed to lookups in the mean over all blurs,
/// and to any one level.
fn pictures() -> [(&'static str, Texture, [f64; 2]); 4] {
    [
        ("checker", Texture::checker(SIDE, SIDE, 4), [0.02, 0.02]),
        // Twice the edges: half of the error comes from between level 0 and level 1, where even the best
        // share of each leaves 2.2 % in the mean over all blurs
        ("fine checker", Texture::checker(SIDE, SIDE, 8), [0.025, 0.0225]),
        ("gradient", Texture::gradient(SIDE, SIDE), [0.01, 0.01]),
        ("noise", Texture::noise(SIDE, SIDE, 1), [0.035, 0.035]),
    ]
}

/// Coordinates of a grid that falls on the texels of all levels everywhere: fewer would miss edges.
fn coordinates() -> Vec<f64> {
    let count = 211;
    (0..count).map(|i| (f64::from(i) + 0.5) / f64::from(count)).collect()
}

/// The root of the mean square difference to a Gaussian blur of `sigma`, over the picture's mean.
fn error(texture: &Texture, sigma: f64, lookup: impl Fn(DVec2) -> DVec3) -> f64 {
    let places = coordinates();
    let exact = Blur::new(texture, &places, &places, DVec2::splat(sigma));
    let mut squares = 0.0;
    for (j, v) in places.iter().enumerate() {
        for (i, u) in places.iter().enumerate() {
            squares += (lookup(DVec2::new(*u, *v)) - exact.at(i, j)).length_squared();
        }
    }
    let count = 3 * places.len() * places.len();
    (squares / count as f64).sqrt() / (texture.mean().element_sum() / 3.0)
}

/// Blurs spread evenly over their logarithm, from sharp to the widest.
fn blurs() -> impl Iterator<Item = f64> {
    let (low, high, count) = (0.0005_f64.ln(), WIDEST_BLUR.ln(), 32);
    (0..count).map(move |i| (low + (high - low) * (f64::from(i) + 0.5) / f64::from(count)).exp())
}

fn size() -> PyramidSize {
    PyramidSize::new(SIDE as u32).unwrap()
}

/// The mean over all blurs, and the largest.
fn errors(texture: &Texture, lookup: impl Fn(DVec2, f64) -> DVec3) -> (f64, f64) {
    let errors: Vec<f64> = blurs().map(|sigma| error(texture, sigma, |uv| lookup(uv, sigma))).collect();
    (errors.iter().sum::<f64>() / errors.len() as f64, errors.into_iter().fold(0.0, f64::max))
}

#[test]
fn every_level_is_nearly_a_gaussian() {
    for (name, texture, [_, bar]) in pictures() {
        let pyramid = Pyramid::new(&texture, size());
        for level in 0..size().levels() {
            let sigma = size().blur(level) / SIDE as f64;
            let error = error(&texture, sigma, |uv| pyramid.lookup(uv, f64::from(level)));
            println!("{name}, level {level}: {:.2} %", 100.0 * error);
            assert!(error <= bar, "{name}, level {level}: {error}");
        }
    }
}

#[test]
fn a_trilinear_lookup_is_nearly_a_gaussian_and_a_chain_of_boxes_is_not() {
    for (name, texture, [bar, _]) in pictures() {
        let pyramid = Pyramid::new(&texture, size());
        let (mean, worst) = errors(&texture, |uv, sigma| pyramid.blurred(uv, sigma, DVec2::ONE));
        println!("{name}: {:.2} %, at worst {:.2} %", 100.0 * mean, 100.0 * worst);
        assert!(mean <= bar, "{name}: {mean}");
        // The twin: means of two by two texels, looked up where a texel is as large as the deviation
        let (boxes, worst) = errors(&texture, chain_of_boxes(&texture));
        println!("{name}, boxes: {:.2} %, at worst {:.2} %", 100.0 * boxes, 100.0 * worst);
        assert!(boxes > 3.0 * mean, "{name}: {boxes}");
    }
}

/// The lookup that most renderers have.
fn chain_of_boxes(texture: &Texture) -> impl Fn(DVec2, f64) -> DVec3 {
    let mut levels = vec![texture.clone()];
    while levels.last().is_some_and(|level| level.width() > 1) {
        let finer = &levels[levels.len() - 1];
        let mean = |x: usize, y: usize| {
            let (x, y) = (2 * x.cast_signed(), 2 * y.cast_signed());
            (finer.texel(x, y) + finer.texel(x + 1, y) + finer.texel(x, y + 1) + finer.texel(x + 1, y + 1))
                / 4.0
        };
        levels.push(Texture::from_fn(finer.width() / 2, finer.height() / 2, mean));
    }
    move |uv, sigma| {
        let level = (sigma * SIDE as f64).log2().clamp(0.0, 8.0);
        let sample = |level: usize| levels[level.min(8)].sample(uv);
        sample(level as usize).lerp(sample(level as usize + 1), level.fract())
    }
}
