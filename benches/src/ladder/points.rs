//! The shading points that accuracy and cost are measured at, and the lights about them.
//!
//! Points lie before the lights, at .5 to 8 times their size; half of them look at a light's mirror image,
//! the others anywhere, so that lights stand high, low and across the horizon. Roughness runs from .05 to 1.

use arealight::{Light, LightShape, LightTexture};
use arealight_oracle::material::{Material, Surface};
use arealight_oracle::stream::Stream;
use glam::{DVec2, DVec3, Vec3};
use half::f16;
use std::f64::consts::TAU;

/// A shading point as a G-buffer holds it: to the bit what the device reads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// From the camera, which is the origin.
    pub position: Vec3,
    /// Unit normal.
    pub normal: Vec3,
    /// What it is made of.
    pub material: Material,
}

impl Point {
    /// The lobes.
    pub fn surface(&self) -> Surface {
        self.material.surface()
    }

    /// The direction to the camera.
    pub fn view(&self) -> DVec3 {
        -self.position.as_dvec3()
    }
}

/// What kind of lights there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LightKind {
    /// Convex quads of one colour.
    Quads,
    /// The same, seen from thirty to a thousand times their size.
    Far,
    /// The same, lighting both sides.
    TwoSided,
    /// Stars of ten vertices.
    Stars,
    /// Textured quads.
    Textured,
}

/// How many lights there are.
pub const LIGHTS: usize = 4;

/// Centre, normal, half width and half height of each light, as seen from the camera.
const FRAMES: [(DVec3, DVec3, f64, f64); LIGHTS] = [
    (DVec3::new(0.0, 2.0, -4.0), DVec3::new(0.1, -1.0, 0.2), 1.0, 0.6),
    (DVec3::new(-2.2, 0.3, -5.0), DVec3::new(1.0, 0.0, 0.3), 0.3, 0.9),
    (DVec3::new(2.0, 0.0, -3.5), DVec3::new(-1.0, -0.2, 0.1), 0.5, 0.5),
    (DVec3::new(0.5, -0.6, -6.0), DVec3::new(0.0, 0.4, 1.0), 0.8, 0.25),
];

/// The lights of a kind.
pub fn lights(kind: LightKind) -> Vec<Light> {
    let light = |(index, (center, normal, half_width, half_height)): (usize, &(DVec3, DVec3, f64, f64))| {
        let (u, v) = normal.normalize_or(DVec3::Y).any_orthonormal_pair();
        let (u, v) = (u * *half_width, v * *half_height);
        let quad = [-u - v, u - v, u * 0.8 + v, v - u].map(|corner| *center + corner);
        let ray = |ray: u32| {
            let (sin, cos) = (TAU * f64::from(ray) / 10.0).sin_cos();
            *center + (u * cos + v * sin) * if ray.is_multiple_of(2) { 1.0 } else { 0.45 }
        };
        let vertices = if kind == LightKind::Stars { (0..10).map(ray).collect() } else { quad.to_vec() };
        // The trapezoid's third corner is where a straight mapping has it
        let corners = [DVec2::new(0.0, 1.0), DVec2::ONE, DVec2::new(0.9, 0.0), DVec2::ZERO];
        Light {
            name: format!("light {index}"),
            radiance: Vec3::ONE,
            shape: LightShape::Polygon(vertices),
            two_sided: kind == LightKind::TwoSided,
            texture: (kind == LightKind::Textured)
                .then(|| LightTexture { layer: index as u32, uvs: corners.to_vec() }),
            ..Light::default()
        }
    };
    FRAMES.iter().enumerate().map(light).collect()
}

/// `count` points about the lights of a kind. Another seed makes others.
pub fn points(kind: LightKind, count: usize, seed: u64) -> Vec<Point> {
    (0..count).map(|index| point(kind, index, &mut Stream::new("points", index as u64, seed))).collect()
}

fn point(kind: LightKind, index: usize, random: &mut Stream) -> Point {
    let (center, normal, half_width, half_height) = FRAMES[index % LIGHTS];
    let front = normal.normalize_or(DVec3::Y);
    loop {
        // Somewhere before the light
        let size = half_width.max(half_height);
        let (nearest, farthest): (f64, f64) =
            if kind == LightKind::Far { (30.0, 1000.0) } else { (0.5, 8.0) };
        let distance = size * random.between(nearest.ln(), farthest.ln()).exp();
        let mut away = random.direction();
        if kind != LightKind::TwoSided {
            away *= away.dot(front).signum();
        }
        let position = (center + away * distance).as_vec3();
        let (to_light, to_camera) = (center - position.as_dvec3(), -position.as_dvec3());
        let view = to_camera.normalize_or(DVec3::Z);

        // Facing halfway between light and camera, or anywhere
        let half = to_light.normalize_or(DVec3::Z) + view;
        let spread = random.unit() * if index.is_multiple_of(2) { 0.3 } else { 3.0 };
        let normal = (half.normalize_or(DVec3::Z) + random.direction() * spread).normalize_or(DVec3::Z);
        let normal = normal.as_vec3();
        let lit = normal.as_dvec3().dot(to_light) > -size;
        if normal.as_dvec3().dot(view) < 0.02 || !lit {
            continue;
        }
        let mut channel = || f16::from_f64(random.between(0.05, 0.95)).to_f32();
        let base_color = Vec3::new(channel(), channel(), channel());
        let metalness = if random.unit() < 0.5 { 0.0 } else { 1.0 };
        let roughness = random.between(0.05, 1.0) as f32;
        let material = Material { base_color, metalness, roughness, ..Material::default() };
        return Point { position, normal, material };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lights_are_valid_and_need_what_their_kind_says() {
        use arealight::Effects;
        for (kind, effects) in [
            (LightKind::Quads, Effects::empty()),
            (LightKind::Far, Effects::empty()),
            (LightKind::TwoSided, Effects::TWO_SIDED),
            (LightKind::Stars, Effects::POLYGON),
            (LightKind::Textured, Effects::TEXTURED),
        ] {
            for light in lights(kind) {
                light.validate().unwrap();
                assert_eq!(light.effects(), effects, "{kind:?} {}", light.name);
            }
        }
    }

    #[test]
    fn points_see_the_camera_and_are_the_same_every_time() {
        let (some, again) = (points(LightKind::Quads, 200, 1), points(LightKind::Quads, 200, 1));
        assert_eq!(some, again);
        assert_ne!(some, points(LightKind::Quads, 200, 2));
        assert!(some.iter().all(|point| point.normal.as_dvec3().dot(point.view()) > 0.0));
    }
}
