//! Random shading points, the same in every run.

use arealight::{Light, LightShape};
use arealight_engine::EvalPoint;
use arealight_oracle::material::Surface;
use arealight_oracle::stream::Stream;
use glam::{DVec3, Vec3};

/// Random numbers, the same everywhere.
pub struct Random(Stream);

impl Random {
    /// A generator of its own sequence for each seed.
    pub fn new(seed: u64) -> Self {
        Self(Stream::from_seed(seed))
    }

    /// 32 random bits.
    pub fn bits(&mut self) -> u32 {
        self.0.bits()
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0.unit()
    }

    /// Uniform in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0.between(low, high)
    }

    /// A unit vector, uniform on the sphere.
    pub fn direction(&mut self) -> DVec3 {
        let z = self.between(-1.0, 1.0);
        let (sin, cos) = self.between(0.0, std::f64::consts::TAU).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * cos, radius * sin, z)
    }

    /// A star-shaped polygon of `count` vertices around `center`, with radii from `low` to `high`, whose
    /// front faces the origin.
    pub fn polygon(&mut self, center: DVec3, count: usize, low: f64, high: f64) -> Vec<DVec3> {
        let mut normal = self.direction();
        if normal.dot(center) > 0.0 {
            normal = -normal;
        }
        let (tangent, bitangent) = normal.any_orthonormal_pair();
        let turn = self.between(0.0, std::f64::consts::TAU);
        (0..count)
            .map(|i| {
                let (sin, cos) = (turn + std::f64::consts::TAU * i as f64 / count as f64).sin_cos();
                center + (tangent * cos + bitangent * sin) * self.between(low, high)
            })
            .collect()
    }
}

/// How wild the numbers of a fuzzed case are.
#[derive(Debug, Clone, Copy)]
pub enum Numbers {
    /// Any bits: mostly of extreme size, NaN or infinity one time in 256.
    Any,
    /// Of ordinary size, and any bits one time in eight.
    SomeAny,
    /// Of ordinary size times one power of two from 2^-149 to 2^127.
    Scaled(f64),
    /// Whole numbers up to four times such a power.
    Whole(f64),
    /// Special numbers only: both zeros, the smallest and largest, infinities, NaN, one.
    Special,
}

const SPECIAL: [f32; 12] = {
    let [least, most, infinity] = [f32::MIN_POSITIVE, f32::MAX, f32::INFINITY];
    [0.0, -0.0, 1.0, -1.0, least, -1e-45, 1e-45, most, f32::MIN, infinity, -infinity, f32::NAN]
};

impl Numbers {
    /// One of them.
    pub fn choose(random: &mut Random) -> Self {
        let scale = random.between(-149.0, 128.0).exp2();
        match random.bits() % 5 {
            0 => Self::Any,
            1 => Self::SomeAny,
            2 => Self::Scaled(scale),
            3 => Self::Whole(scale),
            _ => Self::Special,
        }
    }

    /// A number.
    pub fn number(self, random: &mut Random) -> f32 {
        match self {
            Self::Any => f32::from_bits(random.bits()),
            Self::SomeAny if random.bits().is_multiple_of(8) => f32::from_bits(random.bits()),
            Self::SomeAny => random.between(-1.0, 1.0) as f32,
            Self::Scaled(scale) => (random.between(-1.0, 1.0) * scale) as f32,
            Self::Whole(scale) => (random.between(-4.0, 4.0).round() * scale) as f32,
            Self::Special => SPECIAL[random.bits() as usize % SPECIAL.len()],
        }
    }

    /// So many.
    pub fn vector<const N: usize>(self, random: &mut Random) -> [f32; N] {
        std::array::from_fn(|_| self.number(random))
    }
}

/// A white Lambert surface: with a radiance of one, the answer is the form factor.
pub fn lambert_surface() -> Surface {
    Surface { diffuse_albedo: DVec3::ONE, ..Surface::default() }
}

/// A mirror-coloured GGX surface, without Fresnel's darkening.
pub fn glossy_surface(alpha: f64) -> Surface {
    Surface { f0: DVec3::ONE, f90: 1.0, alpha, ..Surface::default() }
}

/// A point at the world's origin, its normal along z, with a light of radiance one.
pub fn point(surface: Surface, view: DVec3, vertices: Vec<DVec3>, two_sided: bool) -> EvalPoint {
    EvalPoint {
        surface,
        position: DVec3::ZERO,
        normal: DVec3::Z,
        view,
        light: Light {
            name: "test".into(),
            shape: LightShape::Polygon(vertices),
            radiance: Vec3::ONE,
            two_sided,
            ..Light::default()
        },
    }
}
