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
