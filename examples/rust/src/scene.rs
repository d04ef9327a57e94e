//! What both engines draw: three boxes on a floor, and two panels that shine on them, one of which swings.

use arealight::{Light, LightShape};
use bytemuck::{Pod, Zeroable};
use glam::camera::rh::{proj::vulkan, view};
use glam::{DVec3, Mat4, Vec3};

/// A corner of a triangle; `scene.vert` reads it.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct Vertex {
    /// In the world.
    pub position: Vec3,
    /// Of its triangle.
    pub normal: Vec3,
    /// Linear Rec. 709; multiples of 1/255 here, which eight bits hold as they are.
    pub base_color: Vec3,
    /// 0 or 1.
    pub metalness: f32,
    /// Radiance, W/(m² sr).
    pub emission: Vec3,
    /// Perceptual.
    pub roughness: f32,
}

/// Where the picture is taken from.
#[derive(Debug, Clone, Copy)]
pub struct Camera {
    /// From positions relative to the camera to clip space. Depth is reversed: 1 is near, 0 infinitely far.
    pub clip_from_view: Mat4,
    /// In the world.
    pub position: Vec3,
}

impl Camera {
    /// The push constants of `scene.vert`.
    pub fn constants(&self) -> [f32; 19] {
        let mut constants = [0.0; 19];
        self.clip_from_view.write_cols_to_slice(&mut constants);
        self.position.write_to_slice(&mut constants[16..]);
        constants
    }
}

/// The camera for an image of `size` pixels.
pub fn camera(size: [u32; 2]) -> Camera {
    let (position, target) = (Vec3::new(0.4, 2.1, 5.6), Vec3::new(0.0, 0.6, 0.0));
    let projection = vulkan::perspective_infinite_reverse(0.8, size[0] as f32 / size[1] as f32, 0.1);
    let forward = (target - position).normalize_or(Vec3::NEG_Z);
    Camera { clip_from_view: projection * view::look_to_mat4(Vec3::ZERO, forward, Vec3::Y), position }
}

/// The lights as they are after `seconds`.
pub fn lights(seconds: f64) -> Vec<Light> {
    // Seen from where they shine, vertices run counter-clockwise
    let swing = DVec3::X * (seconds * 2.0).sin();
    let panel = |name: &str, corner: DVec3, u: DVec3, v: DVec3, radiance| Light {
        name: name.into(),
        radiance,
        shape: LightShape::Polygon(vec![corner, corner + u, corner + u + v, corner + v]),
        ..Light::default()
    };
    let ceiling = DVec3::new(-1.0, 2.6, -0.8) + swing;
    let wall = DVec3::new(-2.6, 0.3, 1.2);
    vec![
        panel("ceiling", ceiling, DVec3::X * 2.0, DVec3::Z * 0.8, Vec3::new(6.0, 5.4, 4.8)),
        panel("wall", wall, DVec3::Z * -2.4, DVec3::Y * 1.2, Vec3::new(0.6, 1.6, 4.0)),
    ]
}

/// Every triangle, three vertices each, counter-clockwise from outside.
pub fn vertices(seconds: f64) -> Vec<Vertex> {
    let mut mesh = vec![];
    let white =
        Surface { base_color: Vec3::splat(0.6), metalness: 0.0, roughness: 0.25, emission: Vec3::ZERO };
    quad(&mut mesh, Vec3::new(-4.0, 0.0, 4.0), Vec3::X * 8.0, Vec3::Z * -8.0, white);
    let gold = Surface { base_color: Vec3::new(1.0, 0.8, 0.4), metalness: 1.0, ..white };
    block(&mut mesh, Vec3::new(-0.4, 0.0, -0.4), Vec3::splat(0.8), gold);
    let red = Surface { base_color: Vec3::new(0.8, 0.2, 0.2), roughness: 0.5, ..white };
    block(&mut mesh, Vec3::new(-1.9, 0.0, -0.9), Vec3::new(0.7, 1.2, 0.7), red);
    let dull = Surface { roughness: 0.75, ..white };
    block(&mut mesh, Vec3::new(1.2, 0.0, -0.6), Vec3::new(0.9, 0.5, 0.9), dull);
    for light in lights(seconds) {
        let black = Surface { base_color: Vec3::ZERO, metalness: 1.0, emission: light.radiance, ..white };
        // A panel lies a centimetre behind its light: in the light's own plane, the last bit would say
        // whether it is lit
        let back = -0.01 * light.shape.area_vector().normalize_or_zero();
        let corners =
            light.shape.vertices().iter().map(|vertex| (*vertex + back).as_vec3()).collect::<Vec<_>>();
        quad(&mut mesh, corners[0], corners[1] - corners[0], corners[3] - corners[0], black);
    }
    mesh
}

#[derive(Clone, Copy)]
struct Surface {
    base_color: Vec3,
    metalness: f32,
    roughness: f32,
    emission: Vec3,
}

/// A parallelogram whose front is on the right-hand side of u, then v.
fn quad(mesh: &mut Vec<Vertex>, corner: Vec3, u: Vec3, v: Vec3, surface: Surface) {
    let Surface { base_color, metalness, roughness, emission } = surface;
    let normal = u.cross(v).normalize_or_zero();
    for offset in [Vec3::ZERO, u, u + v, Vec3::ZERO, u + v, v] {
        let position = corner + offset;
        mesh.push(Vertex { position, normal, base_color, metalness, emission, roughness });
    }
}

/// A box.
fn block(mesh: &mut Vec<Vertex>, low: Vec3, size: Vec3, surface: Surface) {
    let [x, y, z] = [Vec3::X * size.x, Vec3::Y * size.y, Vec3::Z * size.z];
    for (u, v, w) in [(x, y, z), (y, z, x), (z, x, y)] {
        quad(mesh, low + w, u, v, surface);
        quad(mesh, low, v, u, surface);
    }
}
