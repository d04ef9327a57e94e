//! Scenes made of a few triangles.

use arealight::{Light, LightShape};
use arealight_oracle::material::Material;
use arealight_scene::{Scene, SceneMaterial, Triangle};
use glam::{DVec3, Vec2, Vec3, Vec4};

/// Of Lambert's lobe alone.
pub fn lambert(albedo: f32) -> Material {
    Material {
        base_color: Vec3::splat(albedo),
        roughness: 0.6,
        dielectric_f0: Vec3::ZERO,
        dielectric_f90: 0.0,
        ..Material::default()
    }
}

/// A material seen from both sides, without any texture.
pub fn without_textures(material: Material) -> SceneMaterial {
    let name = "plain".into();
    SceneMaterial { name, material, base_alpha: 1.0, double_sided: true, ..SceneMaterial::default() }
}

/// Flat triangles of one material; their normals face where their vertices run counter-clockwise.
pub fn scene_of(triangles: &[[DVec3; 3]], material: SceneMaterial) -> Scene {
    let triangle = |positions: &[DVec3; 3]| {
        let [a, b, c] = *positions;
        let normal = (b - a).cross(c - a).normalize_or_zero().as_vec3();
        Triangle {
            positions: *positions,
            normals: [normal; 3],
            uvs: [Vec2::ZERO; 3],
            tangents: [Vec4::ZERO; 3],
            colors: [Triangle::WHITE; 3],
            material: 0,
            groups: 0,
        }
    };
    Scene {
        triangles: triangles.iter().map(triangle).collect(),
        materials: vec![material],
        bounds: triangles.iter().flatten().copied().collect(),
        ..Scene::default()
    }
}

/// A level square about a point on the axis, as two triangles that face up.
pub fn square(height: f64, half: f64) -> [[DVec3; 3]; 2] {
    let corner = |x: f64, z: f64| DVec3::new(x * half, height, z * half);
    let [a, b, c, d] = [corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0), corner(-1.0, -1.0)];
    [[a, b, c], [a, c, d]]
}

/// A quad of 1.6 by 0.9 about a place, which faces down.
pub fn quad_light(place: DVec3) -> Light {
    let outline = [(-0.8, -0.45), (0.8, -0.45), (0.8, 0.45), (-0.8, 0.45)];
    let corners = outline.map(|(x, z)| place + DVec3::new(x, 0.0, z));
    Light { radiance: Vec3::splat(5.0), shape: LightShape::Polygon(corners.to_vec()), ..Light::default() }
}

/// The 12 triangles of a box along the axes, facing outwards.
pub fn box_of(low: DVec3, high: DVec3) -> Vec<[DVec3; 3]> {
    let corner = |x: f64, y: f64, z: f64| low + (high - low) * DVec3::new(x, y, z);
    let face = |axis: usize, side: f64| {
        // Around the face counter-clockwise as seen from outside
        let at = |u: f64, v: f64| {
            let (u, v) = if side > 0.0 { (u, v) } else { (v, u) };
            let mut place = [side; 3];
            (place[(axis + 1) % 3], place[(axis + 2) % 3]) = (u, v);
            corner(place[0], place[1], place[2])
        };
        let [a, b, c, d] = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
        [[a, b, c], [a, c, d]]
    };
    (0..6).flat_map(|i| face(i % 3, if i < 3 { 0.0 } else { 1.0 })).collect()
}
