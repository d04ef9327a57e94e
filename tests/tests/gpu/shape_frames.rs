//! Disks, spheres and tubes in the shade pass: pixels of a G-buffer against the float64 oracle.

use arealight_benches::pictures;
use arealight_oracle::shading::{shape_ltc_on, shape_seen_from};
use arealight_tests::pass::run;
use arealight_tests::prelude::*;

const PIXELS: usize = 512;
const CAMERA: DVec3 = DVec3::new(0.5, -4.0, 3.0);

/// A pixel's surface.
struct Pixel {
    position: DVec3,
    normal: DVec3,
    material: Material,
}

fn pixels() -> Vec<Pixel> {
    let mut random = Random::new(301);
    let pixel = |_| Pixel {
        position: DVec3::new(random.between(-2.0, 2.0), random.between(-2.0, 2.0), 0.0).as_vec3().as_dvec3(),
        normal: (DVec3::Z + random.direction() * 0.7).as_vec3().as_dvec3(),
        material: Material {
            base_color: Vec3::splat(0.75),
            metalness: 0.5,
            roughness: random.between(0.4, 1.0) as f32,
            dielectric_f0: Vec3::splat(0.04),
            dielectric_f90: 1.0,
            ..Material::default()
        },
    };
    (0..PIXELS).map(pixel).collect()
}

/// Two of each kind: about the pixels' horizons, and one of them with two sides.
fn shapes() -> Vec<Light> {
    let light = |name: &str, radiance: Vec3, two_sided, shape| Light {
        name: name.into(),
        radiance,
        two_sided,
        shape,
        ..Light::default()
    };
    let tube = |p0: [f64; 3], p1: [f64; 3], radius, ends| LightShape::Tube {
        p0: p0.into(),
        p1: p1.into(),
        radius,
        ends,
    };
    vec![
        light(
            "disk",
            Vec3::new(1.0, 2.0, 3.0),
            false,
            LightShape::Disk { center: DVec3::Z * 2.0, axis_u: DVec3::Y * 0.5, axis_v: DVec3::X * 0.5 },
        ),
        light(
            "plate",
            Vec3::new(3.0, 1.0, 0.5),
            true,
            LightShape::Disk {
                center: DVec3::new(0.5, 1.0, 0.25),
                axis_u: DVec3::new(0.5, 0.0, 0.5),
                axis_v: DVec3::new(0.0, 0.25, 0.125),
            },
        ),
        light(
            "sun",
            Vec3::new(2.0, 1.0, 1.0),
            false,
            LightShape::Sphere { center: DVec3::new(-1.0, 0.0, 1.0), radius: 0.5 },
        ),
        light(
            "ball",
            Vec3::new(0.0, 2.0, 1.0),
            false,
            LightShape::Sphere { center: DVec3::new(1.0, -1.0, 0.0), radius: 0.25 },
        ),
        light(
            "lamp",
            Vec3::new(1.0, 1.0, 2.0),
            false,
            tube([-1.0, -1.5, 0.5], [1.0, -1.5, 1.0], 0.125, TubeEnds::Flat),
        ),
        light(
            "pill",
            Vec3::new(2.0, 2.0, 0.0),
            false,
            tube([1.5, 0.5, -0.25], [1.5, 1.5, 0.75], 0.25, TubeEnds::Round),
        ),
    ]
}

fn of_kinds(effects: Effects) -> Vec<Light> {
    let kind = |shape: &Light| shape.effects() - Effects::TWO_SIDED;
    shapes().into_iter().filter(|shape| effects.contains(kind(shape))).collect()
}

/// What float64 says that every pixel shows.
fn expected(shapes: &[Light]) -> Vec<DVec3> {
    let of_one = |pixel: &Pixel, shape: &Light| {
        let (surface, view) = (pixel.material.surface(), CAMERA - pixel.position);
        let shape = shape_seen_from(shape, pixel.position);
        shape_ltc_on(Quality::default(), &TABLE, &surface, pixel.normal, view, &shape).expect("a shape")
    };
    pixels().iter().map(|pixel| shapes.iter().map(|shape| of_one(pixel, shape)).sum()).collect()
}

/// What the shade pass makes of all pixels, with the code of `effects` beside what is needed.
fn shade(engine: &TestEngine, effects: Effects, lights: &[Light]) -> Vec<Vec4> {
    let (size, pixels) = ([PIXELS as u32, 1], pixels());
    let planes = planes(engine, size, &|plane, [x, _]| {
        let Pixel { position, normal, material } = &pixels[x as usize];
        match plane {
            Plane::Position => Some(position.as_vec3().extend(1.0)),
            Plane::Normal => Some(normal.as_vec3().extend(material.roughness)),
            Plane::BaseColor => Some(material.base_color.extend(material.metalness)),
            Plane::Specular => Some(material.dielectric_f0.extend(material.dielectric_f90)),
            Plane::Coat | Plane::Sheen | Plane::Anisotropy | Plane::Film => Some(Vec4::ZERO),
            _ => None,
        }
    });
    let radiance = radiance(engine, size, Vec4::NAN);
    let lights = LightBuffers::new(engine, lights, DVec3::ZERO);
    let resources = ShadeResources {
        planes: reads(&planes),
        radiance: store(&radiance),
        light_textures: Some(engine.light_textures()),
        ..lights.resources(engine)
    };
    let summary = lights.packed.summary();
    let frame = ShadeFrame {
        lights: LightSummary { effects: effects | summary.effects, ..summary },
        ..lights.frame(size, CAMERA.as_vec3())
    };
    let options = ShadeOptions { surfaces: effects, ..ShadeOptions::default() };
    let pass = engine.pass(options).expect("a pipeline");
    run(engine, &pass, &resources, size, &[frame], Descriptors::Sets);
    stored_in(&radiance)
}

#[test]
fn pixels_show_what_the_oracle_says_with_every_set_of_kinds() {
    let Some(engine) = TestEngine::new() else { return };
    let lobes = Effects::DIFFUSE | Effects::GLOSSY;
    let (disks, balls, tubes) = (Effects::ELLIPSE, Effects::SPHERE, Effects::TUBE);
    for kinds in [disks, disks | balls, tubes] {
        let shapes = of_kinds(kinds);
        let effects: Effects = shapes.iter().map(Light::effects).collect();
        let found = shade(&engine, lobes | effects, &shapes);
        let expected = expected(&shapes);
        let mut comparison = Comparison::new(format!("{kinds}"));
        let mut lit = 0;
        for (index, (found, expected)) in found.iter().zip(&expected).enumerate() {
            for (channel, expected) in expected.to_array().into_iter().enumerate() {
                // The narrowest lobe's rounding, for two lobes of each of the lights, of a radiance of 3 at
                // most
                let bound = 6.0 * shapes.len() as f64 * rounding(0.16);
                let place = || format!("pixel {index}, channel {channel}");
                comparison.add(found[channel].into(), expected, bound, place);
            }
            lit += usize::from(expected.max_element() > 0.05);
        }
        comparison.assert_all();
        assert!(lit > PIXELS / 4, "{kinds}: {lit} pixels are lit");
    }
}

#[test]
fn effects_that_no_shape_needs_change_nothing() {
    let Some(engine) = TestEngine::new() else { return };
    let shapes = of_kinds(Effects::SPHERE);
    let needed = Effects::DIFFUSE | Effects::GLOSSY | Effects::SPHERE;
    let (few, many) = (
        shade(&engine, needed, &shapes),
        shade(&engine, Effects::all() - Effects::MODEL - Effects::LINKED, &shapes),
    );
    let apart = few.iter().zip(&many).map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f32::max);
    // The compiler may fuse another multiplication and addition of another pipeline
    assert!(apart < 2e-6, "{apart}");
    // The twin: without its effect a shape is not there
    let none = shade(&engine, needed - Effects::SPHERE, &[]);
    assert!(none.iter().all(|pixel| pixel.truncate() == Vec3::ZERO));
    assert!(few.iter().any(|pixel| pixel.max_element() > 0.1));
}

/// A floor of two triangles at z = 0, of Lambert's lobe alone or of the GGX lobe alone.
fn floor(glossy: bool) -> Scene {
    let [a, b, c, d] =
        [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
    let material = Material {
        base_color: Vec3::splat(0.75),
        metalness: if glossy { 1.0 } else { 0.0 },
        ..lambert(0.75)
    };
    scene_of(&[[a, b, c], [a, c, d]], without_textures(material))
}

#[test]
fn the_reference_samples_shapes() {
    const SIZE: [u32; 2] = [24, 16];
    const SAMPLES: u32 = 256;
    let Some(mut engine) = TestEngine::new() else { return };
    pictures::load(&mut engine, &[Arc::new(Texture::gradient(64, 64))], |_| TexturePart::default())
        .expect("a picture");
    let mut kinds = shapes();
    kinds[4].shape = match kinds[4].shape.clone() {
        // What is open shines less than what has caps: seen from below, and nearly along the axis
        LightShape::Tube { p0, radius, .. } => LightShape::Tube {
            p0,
            p1: p0 + DVec3::new(0.25, 0.0, 0.5),
            radius: radius * 2.0,
            ends: TubeEnds::Open,
        },
        other => other,
    };
    kinds.push(shapes()[4].clone());
    kinds.push(Light { texture: Some(LightTexture { layer: 0, uvs: vec![] }), ..shapes()[0].clone() });
    for glossy in [false, true] {
        let scene = floor(glossy);
        let camera = scene.framing_camera(1.5);
        let buffers = SceneBuffers::new(&scene, camera.position).expect("buffers");
        let constants = buffers.constants(&camera, SIZE, Vec3::ZERO);
        let render = |shapes: &[Light], sampled: bool| -> (DVec3, Vec<Vec4>) {
            let renderer = SceneRenderer::new(&engine, &buffers, shapes, constants, SIZE);
            let mut renderer = renderer.expect("a renderer");
            if sampled {
                let reference =
                    Reference { samples: SAMPLES, seed: 10, coupled: false, ..Reference::default() };
                renderer.reference(reference, |_| {}).expect("a reference");
            } else {
                let lobe = if glossy { Effects::GLOSSY } else { Effects::DIFFUSE };
                renderer.shade(lobe | Effects::SPECULAR_INPUT, Quality::default()).expect("a frame");
            }
            let radiance = renderer.radiance().expect("a picture");
            (radiance.iter().map(|texel| texel.truncate().as_dvec3()).sum(), radiance)
        };
        // All shapes at once for the GGX lobe, which is a fit of a few per cent; Lambert's is exact, for each
        let groups: Vec<Vec<Light>> = if glossy {
            vec![kinds.clone()]
        } else {
            kinds.iter().map(|shape| vec![shape.clone()]).collect()
        };
        for group in groups {
            let ((shaded, _), (sampled, picture)) = (render(&group, false), render(&group, true));
            let ratio = sampled / shaded;
            // The noise of a light that some thirty of the pixels see is 1 % (half of that for four times the
            // samples): three of those. A part that is not sampled, or counted twice, is tens of per cent
            let bound = if glossy { 0.05 } else { 0.03 };
            // Blurs of an image are a few per cent off, and here of one sign: docs/textures.md
            let bound = if group.iter().any(|shape| shape.texture.is_some()) { 0.06 } else { bound };
            let off = (0..3).filter(|i| shaded[*i] > 0.0).map(|i| (ratio[i] - 1.0).abs()).fold(0.0, f64::max);
            let name = &group[0].name;
            assert!(off < bound, "{name}, glossy {glossy}: {ratio}");
            assert!(shaded.max_element() > 0.5, "{name}: {shaded}");
            assert!(picture.iter().all(|texel| texel.is_finite()), "{name}");
        }
    }
}
