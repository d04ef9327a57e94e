//! A light sweeps through a floor, through a point that is shaded, and past the horizon, through the whole
//! shade pass: each frame is what float64 says, and none jumps from the one before.

use arealight::gpu::GpuLight;
use arealight_tests::Path;
use arealight_tests::lobe::{Lobe, Seen};
use arealight_tests::pass::run;
use arealight_tests::prelude::*;
use arealight_tool_kernels::gpu::GpuCase;

const FRAMES: usize = 1000;

/// A row of pixels a frame.
const SIZE: [u32; 2] = [SURFACES.len() as u32, FRAMES as u32];

/// The surfaces of a frame: one that the light passes through, one beside it, and one that is seen at a
/// grazing angle with the light behind it; each nearly a mirror, and rough.
const SURFACES: [(Vec3, f32); 6] = [
    (Vec3::new(0.0, 0.0, 0.0), 0.05),
    (Vec3::new(0.0, 0.0, 0.0), 0.5),
    (Vec3::new(1.0, 0.25, 0.0), 0.05),
    (Vec3::new(1.0, 0.25, 0.0), 0.5),
    (Vec3::new(-3.0, 0.5, 0.0), 0.05),
    (Vec3::new(-3.0, 0.5, 0.0), 0.5),
];

/// Sees the far surface at 88 degrees, so that the light is in its mirror direction.
const CAMERA: Vec3 = Vec3::new(-24.0, 0.5, 0.75);

fn material(roughness: f32) -> Material {
    Material {
        base_color: Vec3::splat(0.5),
        metalness: 0.5,
        roughness,
        dielectric_f0: Vec3::splat(0.04),
        dielectric_f90: 1.0,
        ..Material::default()
    }
}

/// Where the light's middle is in a frame: from above the first surface through it, and down. On a grid, so
/// that float32 subtracts it without an error; the light stands still, and the surfaces move the other way.
fn place(frame: usize) -> Vec3 {
    let part = frame as f64 / (FRAMES - 1) as f64 * 2.0 - 1.0;
    let grid = |x: f64| ((x * 4096.0).round() / 4096.0) as f32;
    Vec3::new(grid(0.3 * part), grid(-0.2 * part), grid(-0.8 * part))
}

/// A tilted plate, or an arrow, about the origin.
fn light(concave: bool) -> Light {
    let flat: &[(f64, f64)] = if concave {
        &[(-0.5, -0.4), (0.6, 0.0), (-0.5, 0.5), (-0.1, 0.3), (-0.2, 0.0)]
    } else {
        &[(-0.5, -0.4), (0.5, -0.4), (0.5, 0.4), (-0.5, 0.4)]
    };
    // Its front looks down, and to the far surface
    let tilt = DQuat::from_rotation_y(0.5) * DQuat::from_rotation_x(0.3);
    let vertices = flat.iter().rev().map(|&(x, y)| tilt * DVec3::new(x, y, 0.0)).collect();
    Light {
        name: "sweeping".into(),
        shape: LightShape::Polygon(vertices),
        radiance: Vec3::ONE,
        two_sided: concave,
        ..Light::default()
    }
}

/// What the pass is given: a row of pixels a frame.
struct Sweep<'a> {
    engine: &'a TestEngine,
    lights: LightBuffers,
    positions: Vec<Vec3>,
    /// The same as cases, with the light as each pixel sees it.
    given: Cases,
    planes: Planes<Option<Image>>,
}

impl<'a> Sweep<'a> {
    fn new(engine: &'a TestEngine, light: &Light) -> Self {
        let lights = LightBuffers::new(engine, std::slice::from_ref(light), DVec3::ZERO);
        let packed = &lights.packed;
        let pixels: Vec<(Vec3, Material)> = (0..FRAMES)
            .flat_map(|frame| {
                SURFACES.map(|(surface, roughness)| (surface - place(frame), material(roughness)))
            })
            .collect();
        let mut given = Cases { vertices: packed.vertices.clone(), ..Cases::default() };
        for (index, (position, material)) in pixels.iter().enumerate() {
            let surface = material.surface();
            given.lights.push(GpuLight {
                center: (Vec3::from_array(packed.lights[0].center) - *position).to_array(),
                ..packed.lights[0]
            });
            given.cases.push(GpuCase {
                normal: [0.0, 0.0, 1.0],
                roughness: material.roughness,
                view: (CAMERA - *position).to_array(),
                f90: surface.f90 as f32,
                diffuse_albedo: surface.diffuse_albedo.as_vec3().to_array(),
                light: index as u32,
                f0: surface.f0.as_vec3().to_array(),
                tangent_roughness: material.roughness,
                film_ior: 1.0,
                ..bytemuck::Zeroable::zeroed()
            });
        }
        let planes = planes(engine, SIZE, &|plane, [x, y]| {
            let (position, material) = &pixels[y as usize * SURFACES.len() + x as usize];
            match plane {
                Plane::Position => Some(position.extend(1.0)),
                Plane::Normal => Some(Vec3::Z.extend(material.roughness)),
                Plane::BaseColor => Some(material.base_color.extend(material.metalness)),
                _ => None,
            }
        });
        let positions = pixels.iter().map(|(position, _)| *position).collect();
        Self { engine, lights, positions, given, planes }
    }

    /// The red channel of every pixel.
    fn shade(&self, level: Level) -> Vec<f32> {
        let surfaces = level.effects(Effects::DIFFUSE | Effects::GLOSSY);
        let options = ShadeOptions { surfaces, quality: level.quality, ..ShadeOptions::default() };
        let pass = self.engine.pass(options).unwrap();
        // What is not written stays NaN
        let radiance = radiance(self.engine, SIZE, Vec4::NAN);
        let planes = reads(&self.planes);
        let planes = planes.with(Plane::Specular, planes[Plane::BaseColor]);
        let resources =
            ShadeResources { planes, radiance: store(&radiance), ..self.lights.resources(self.engine) };
        run(self.engine, &pass, &resources, SIZE, &[self.lights.frame(SIZE, CAMERA)], Descriptors::Sets);
        stored_in(&radiance).into_iter().map(|texel| texel.x).collect()
    }
}

fn check(concave: bool) {
    let Some(engine) = TestEngine::new() else { return };
    let sweep = Sweep::new(&engine, &light(concave));
    let path = if concave { Path::Polygon } else { Path::Quad };
    for horizon in [Horizon::Cosine, Horizon::Both] {
        let judges: Vec<_> = (0..sweep.given.cases.len())
            .map(|pixel| {
                let case = &sweep.given.cases[pixel];
                let see = |lobe: Lobe, horizon| Seen::new(&sweep.given, pixel, lobe, horizon).judge();
                (see(Lobe::lambert(case), Horizon::Cosine), see(Lobe::glossy(&TABLE, case), horizon))
            })
            .collect();
        let expected: Vec<f64> = judges.iter().map(|(d, g)| d.expected() + g.expected()).collect();
        for level in Level::of(&[path], &[horizon]) {
            let found = sweep.shade(level);
            let bounds: Vec<f64> = judges.iter().map(|(d, g)| d.bound() + g.bound()).collect();
            let mut frames = Comparison::new(format!("frames, {level}"));
            let mut later = Comparison::new("a frame as the next one");
            let mut jumps = Comparison::new(format!("jumps, {level}"));
            for pixel in 0..found.len() {
                let place = || format!("pixel {pixel}: {:?}", sweep.positions[pixel]);
                frames.add(found[pixel].into(), expected[pixel], bounds[pixel], place);
                let next = pixel + SURFACES.len();
                if next >= found.len() {
                    continue;
                }
                later.add(found[pixel].into(), expected[next], bounds[pixel], String::new);
                let jump = f64::from(found[next]) - f64::from(found[pixel]);
                jumps.add(jump, expected[next] - expected[pixel], bounds[pixel] + bounds[next], place);
            }
            frames.assert_all();
            jumps.assert_all();
            assert!(later.failures() > FRAMES / 2, "the twin: {} noticed", later.failures());
        }
        // The light does pass through the first surface: from one frame to the next it is gone, or seen from
        // its back
        let jump = |surface: usize| {
            let column = expected.iter().skip(surface).step_by(SURFACES.len());
            column.clone().zip(column.skip(1)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        println!("{horizon:?}: largest steps of the truth {:?}", [0, 1, 2, 3, 4, 5].map(jump));
        assert!(jump(1) > 0.05, "contact: {}", jump(1));
        // Beside the light, a rough surface changes by a few times a step's part of the way
        assert!(jump(3) < 0.02, "no contact: {}", jump(3));
    }
}

#[test]
fn a_quad_sweeps_through_a_floor() {
    check(false);
}

#[test]
fn a_concave_light_of_two_sides_sweeps_through_a_floor() {
    check(true);
}
