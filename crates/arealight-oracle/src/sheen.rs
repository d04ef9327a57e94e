//! Sheen: the Charlie BRDF of `KHR_materials_sheen`, and the transformed cosine by formulas that stands for
//! it.
//!
//! Sources: Estevez and Kulla 2017, *Production Friendly Microfacet Sheen BRDF*; the text of the extension.

use crate::formula::MIN_COS_VIEW;
use arealight::table::clamped_cosine;
use glam::{DMat3, DVec3};
use std::f64::consts::TAU;

/// The smallest sheen roughness that is shaded; a smaller one counts as this.
pub const MIN_ROUGHNESS: f64 = 0.07;

/// The Charlie BRDF of a sheen roughness, for a colour of 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Charlie {
    /// Perceptual roughness in (0, 1].
    pub roughness: f64,
}

/// Coefficients `a, b, c, d, e` of the masking's exponent, at `(1 - alpha)² = 0` and 1.
const MASKING: [[f64; 5]; 2] =
    [[21.5473, 3.82987, 0.19823, -1.9776, -4.32054], [25.3245, 3.32435, 0.16801, -1.27393, -4.85967]];

impl Charlie {
    fn alpha(self) -> f64 {
        self.roughness * self.roughness
    }

    /// `f cos theta_light`, 1/sr, of unit directions of the surface frame. Zero where the light is below the
    /// surface; the view is above it.
    pub fn evaluate(self, view: DVec3, light: DVec3) -> f64 {
        if light.z <= 0.0 || view.z <= 0.0 {
            return 0.0;
        }
        let half = (view + light).normalize_or_zero();
        let exponent = 1.0 / self.alpha();
        let sine_squared = half.x * half.x + half.y * half.y;
        let distribution = (2.0 + exponent) * sine_squared.powf(0.5 * exponent) / TAU;
        // f = D / ((1 + Lambda_v + Lambda_l) 4 cos_v cos_l)
        distribution / (4.0 * view.z * (1.0 + self.masking(view.z) + self.masking(light.z)))
    }

    /// Lambda of a cosine in (0, 1].
    pub fn masking(self, cosine: f64) -> f64 {
        let p = (1.0 - self.alpha()).powi(2);
        let [a, b, c, d, e]: [f64; 5] =
            std::array::from_fn(|i| MASKING[0][i] * (1.0 - p) + MASKING[1][i] * p);
        let exponent = |x: f64| a / (1.0 + b * x.powf(c)) + d * x + e;
        if cosine < 0.5 {
            exponent(cosine).exp()
        } else {
            (2.0 * exponent(0.5) - exponent(1.0 - cosine)).exp()
        }
    }

    /// The integral of [`Charlie::evaluate`] over the hemisphere, by a product of midpoint rules: to 1e-4.
    /// For narrow lobes and grazing views it is above 1.
    pub fn albedo(self, cos_view: f64) -> f64 {
        const HEIGHTS: u32 = 400;
        const AZIMUTHS: u32 = 200;
        let view = DVec3::new((1.0 - cos_view * cos_view).max(0.0).sqrt(), 0.0, cos_view);
        let mut sum = 0.0;
        for i in 0..HEIGHTS {
            // Low light weighs most: z = t³
            let t = (f64::from(i) + 0.5) / f64::from(HEIGHTS);
            let (z, per_t) = (t.powi(3), 3.0 * t * t);
            let radius = (1.0 - z * z).sqrt();
            for j in 0..AZIMUTHS {
                let (sin, cos) = (0.5 * TAU * (f64::from(j) + 0.5) / f64::from(AZIMUTHS)).sin_cos();
                sum += per_t * self.evaluate(view, DVec3::new(radius * cos, radius * sin, z));
            }
        }
        sum * TAU / f64::from(HEIGHTS * AZIMUTHS)
    }
}

/// One of the transformed cosines that stand for Charlie at a view: a lobe of `arealight_sheen_layer`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SheenLobe {
    /// M⁻¹ from the surface frame into cosine space.
    pub inverse: DMat3,
    /// What a colour of 1 reflects of light from everywhere; below 0 for a lobe that takes light away.
    pub albedo: f64,
}

/// What the second of two lobes has of Charlie's albedo, and takes away.
pub const HOLE_SHARE: f64 = 0.25;

/// `(q00 - 1) / sin²`, `q02 / sin`, `q20 / sin` and `q22`: a row for each monomial
/// `1, y, y², y³, x, xy, xy², x², x²y, x³` of `x = MIN_ROUGHNESS / roughness` and the view's cosine `y`.
const LOBE: [[f64; 4]; 10] = [
    [-0.0267666, 0.293183, 0.0270966, 1.45411],
    [0.0837258, -1.53275, -0.521527, -1.00096],
    [-1.93149, 2.76252, 2.16498, 1.33838],
    [2.69006, -1.52679, -2.40386, -0.692998],
    [2.40305, -6.30596, 0.584988, 3.75839],
    [7.7175, 20.6398, 3.45546, -12.1357],
    [-1.80104, -22.1208, 0.380597, 14.7094],
    [-2.85413, -8.55474, -3.64936, 24.8031],
    [0.275537, -118.524, -2.21212, -12.7155],
    [1.08156, 6.405, 2.79909, -15.2336],
];

/// Likewise of the first of two lobes, and of the second.
const FIRST_LOBE: [[f64; 4]; 10] = [
    [-0.13149, 0.361569, 0.0752426, 1.31949],
    [0.0795685, -0.750933, -0.507509, -1.0286],
    [-0.797448, 1.23546, 1.07581, 1.66252],
    [0.822861, -0.777411, -1.23096, -0.977043],
    [1.15234, -2.78307, -0.922504, 3.82266],
    [3.37522, 4.03748, 3.75964, -8.12919],
    [-0.434047, -3.39555, 2.05407, 9.60216],
    [-1.44889, -3.17878, 0.119249, 19.0531],
    [0.757793, -67.8161, -2.09296, -12.5886],
    [0.51529, 2.82687, 0.574435, -12.1523],
];
const HOLE: [[f64; 4]; 10] = [
    [0.278544, 1.59541, 0.20479, 1.31666],
    [-1.72316, -3.21944, -1.83265, -1.42049],
    [1.86359, 3.12397, 4.81223, 2.68942],
    [-1.25023, -0.213376, -3.4335, -1.23521],
    [-2.70468, -4.03953, -2.25019, -3.96172],
    [2.36349, 7.43148, 9.86338, -1.06574],
    [2.96525, 1.01746, -12.8099, -5.95062],
    [3.645, 11.4033, 2.76699, 15.824],
    [1.70914, -48.2181, -5.23448, 29.5173],
    [-1.60811, -5.13065, -1.12835, -9.8566],
];

/// The exponent of what is left of the albedo: a row for each power of `x`, of the powers of `sqrt(y)`.
const ALBEDO: [&[f64]; 6] = [
    &[0.474986, -0.81853, 3.2161, -8.37422, 9.68834, -3.20163],
    &[7.47217, 2.63793, -47.5624, 74.5765, -55.2354],
    &[-10.4407, -6.65814, 31.3788, -39.6479],
    &[7.45288, 4.95557, -6.39439],
    &[-0.7258, -1.88308],
    &[-1.06969],
];

impl SheenLobe {
    /// The one lobe of a roughness and a view's cosine, clamped to their ranges.
    pub fn one(roughness: f64, cos_view: f64) -> Self {
        Self::of(&LOBE, 1.0, roughness, cos_view)
    }

    /// Likewise, of two: what Charlie has and more, and what it lacks about the mirror direction.
    pub fn two(roughness: f64, cos_view: f64) -> [Self; 2] {
        [(&FIRST_LOBE, 1.0 + HOLE_SHARE), (&HOLE, -HOLE_SHARE)]
            .map(|(lobe, share)| Self::of(lobe, share, roughness, cos_view))
    }

    /// That of these coefficients, with a share of Charlie's albedo.
    fn of(coefficients: &[[f64; 4]; 10], share: f64, roughness: f64, cos_view: f64) -> Self {
        let roughness = if roughness > MIN_ROUGHNESS { roughness.min(1.0) } else { MIN_ROUGHNESS };
        let cos_view = clamped_cosine(cos_view);
        let sin_view = (1.0 - cos_view * cos_view).sqrt();
        let (x, y) = (MIN_ROUGHNESS / roughness, cos_view.max(MIN_COS_VIEW));
        // Entries
        let monomials = [1.0, y, y * y, y * y * y, x, x * y, x * y * y, x * x, x * x * y, x * x * x];
        let entry = |k: usize| -> f64 { monomials.iter().zip(coefficients).map(|(m, row)| m * row[k]).sum() };
        let inverse = DMat3::from_cols(
            DVec3::new(1.0 + sin_view * sin_view * entry(0), 0.0, sin_view * entry(2)),
            DVec3::Y,
            DVec3::new(sin_view * entry(1), 0.0, entry(3)),
        );
        // Albedo
        let polynomial =
            |coefficients: &[f64], at: f64| coefficients.iter().rev().fold(0.0, |sum, c| sum * at + c);
        let rows = ALBEDO.map(|row| polynomial(row, y.sqrt()));
        let masking = Charlie { roughness }.masking(y);
        Self { inverse, albedo: share * polynomial(&rows, x).exp() / (4.0 * y * (1.0 + masking)) }
    }
}
