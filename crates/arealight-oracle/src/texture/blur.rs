//! A picture blurred with a Gaussian, exactly: what a pyramid approximates.

use super::{Texture, mirrored};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Where the Gaussian is cut off, in standard deviations: 1e-15 of it is beyond.
const REACH: f64 = 8.0;

/// The Gaussian blur of a bilinear texture that is mirrored at its edges without end, at a grid of
/// coordinates.
///
/// The weights of the texels are integrals of the Gaussian times a texel's tent, to 1e-12.
#[derive(Debug, Clone, PartialEq)]
pub struct Blur {
    us: usize,
    values: Vec<DVec3>,
}

impl Blur {
    /// The blur at each pair of `us` and `vs`, with standard deviations `sigma` in texture coordinates. Zero
    /// or less does not blur.
    pub fn new(texture: &Texture, us: &[f64], vs: &[f64], sigma: DVec2) -> Self {
        let columns: Vec<_> = us.iter().map(|u| Weights::new(*u, sigma.x, texture.width())).collect();
        // Along the rows first
        let narrowed: Vec<DVec3> = texture
            .texels()
            .chunks_exact(texture.width())
            .flat_map(|row| columns.iter().map(|weights| weights.apply(|column| row[column])))
            .collect();
        let values = vs
            .iter()
            .flat_map(|v| {
                let weights = Weights::new(*v, sigma.y, texture.height());
                let narrowed = &narrowed;
                (0..us.len()).map(move |column| weights.apply(|row| narrowed[row * us.len() + column]))
            })
            .collect();
        Self { us: us.len(), values }
    }

    /// The value at the coordinates of these indices.
    pub fn at(&self, u: usize, v: usize) -> DVec3 {
        self.values[v * self.us + u]
    }

    /// All values, those of the first of `vs` first.
    pub fn values(&self) -> &[DVec3] {
        &self.values
    }
}

/// Shares of texels.
struct Weights(Vec<f64>);

impl Weights {
    fn new(coordinate: f64, sigma: f64, count: usize) -> Self {
        let (center, sigma) = (coordinate * count as f64 - 0.5, (sigma * count as f64).max(0.0));
        let reach = REACH * sigma + 1.0;
        let mut shares = vec![0.0; count];
        // Beyond the edges the texels come again
        for index in (center - reach).floor() as isize..=(center + reach).ceil() as isize {
            shares[mirrored(index, count).cast_unsigned()] +=
                tent_under_gaussian(index as f64 - center, sigma);
        }
        let sum: f64 = shares.iter().sum();
        Self(shares.into_iter().map(|share| share / sum).collect())
    }

    fn apply(&self, texel: impl Fn(usize) -> DVec3) -> DVec3 {
        self.0.iter().enumerate().map(|(i, share)| texel(i) * *share).sum()
    }
}

/// The integral of the tent of radius 1 about `offset` times a Gaussian about 0.
fn tent_under_gaussian(offset: f64, sigma: f64) -> f64 {
    let tent = |x: f64| (1.0 - (x - offset).abs()).max(0.0);
    // Beyond this the Gaussian is a point to double precision's eye
    if sigma < 1e-9 {
        return tent(0.0);
    }
    let gaussian = |x: f64| (-0.5 * (x / sigma).powi(2)).exp() / (TAU.sqrt() * sigma);
    // Both slopes, each in pieces of at most one standard deviation, where the rule is exact to 1e-13
    let slope = |from: f64, to: f64| {
        let (from, to) = (from.max(-REACH * sigma), to.min(REACH * sigma));
        if from >= to {
            return 0.0;
        }
        let pieces = ((to - from) / sigma).ceil();
        let half = 0.5 * (to - from) / pieces;
        let piece = |i: u32| {
            let middle = from + f64::from(2 * i + 1) * half;
            let terms =
                GAUSS_7.map(|(x, weight)| weight * tent(middle + half * x) * gaussian(middle + half * x));
            terms.iter().sum::<f64>()
        };
        half * (0..pieces as u32).map(piece).sum::<f64>()
    };
    slope(offset - 1.0, offset) + slope(offset, offset + 1.0)
}

/// Gauss's rule of seven points on [-1, 1]: places and weights.
const GAUSS_7: [(f64, f64); 7] = [
    (-0.9491079123427585, 0.1294849661688697),
    (-0.7415311855993945, 0.2797053914892766),
    (-0.4058451513773972, 0.3818300505051189),
    (0.0, 0.4179591836734694),
    (0.4058451513773972, 0.3818300505051189),
    (0.7415311855993945, 0.2797053914892766),
    (0.9491079123427585, 0.1294849661688697),
];
