//! Every bit pattern gives a finite answer: the eval kernel is given buffers that no host would write,
//! without the checks of the CPU side in between.

use arealight::gpu::GpuLight;
use arealight_tests::Numbers;
use arealight_tests::prelude::*;
use arealight_tool_kernels::gpu::GpuCase;

const COUNT: usize = 50_000;

/// Rows of an image's place, after the vertices of its light.
const IMAGE_ROWS: usize = 4;

/// The direction from a light to the shading point, the origin, or its opposite, as the light's first
/// vertices run; what there is of it.
fn facing_normal(center: [f32; 3], vertices: [[f32; 4]; 3]) -> [f32; 3] {
    let [a, b, c] = vertices.map(|v| DVec3::new(v[0].into(), v[1].into(), v[2].into()));
    let normal = (b - a).cross(c - a);
    let center = DVec3::from_array(center.map(f64::from));
    (if normal.dot(center + a) > 0.0 { center } else { -center }).normalize_or_zero().as_vec3().to_array()
}

/// Albedo and radiance are one, so that the answer is a form factor: Lambert's, or the lobe's times its
/// albedo.
fn buffers() -> Cases {
    let mut random = Random::new(21);
    let mut buffers = Cases::default();
    for index in 0..COUNT {
        // Outline, bounding sphere and surface are wild in their own ways
        let outline = Numbers::choose(&mut random);
        let sphere = Numbers::choose(&mut random);
        let surface = Numbers::choose(&mut random);
        let vertex_count = 3 + random.bits() % 6;
        buffers.lights.push(GpuLight {
            radiance: [1.0; 3],
            first_vertex: buffers.vertices.len() as u32,
            center: sphere.vector(&mut random),
            radius: sphere.number(&mut random),
            normal: sphere.vector(&mut random),
            area: sphere.number(&mut random),
            vertex_count,
            flags: random.bits() & GpuLight::TWO_SIDED,
            texture_layer: GpuLight::NO_TEXTURE,
            ..bytemuck::Zeroable::zeroed()
        });
        let rows: Vec<[f32; 4]> = (0..vertex_count).map(|_| outline.vector(&mut random)).collect();
        if index % 4 != 0 {
            let light = buffers.lights.last_mut().expect("the light");
            light.normal = facing_normal(light.center, [rows[0], rows[1], rows[2]]);
        }
        buffers.vertices.extend(rows);
        // Where a light's image is, if it has one
        buffers.vertices.extend([[0.0; 4]; IMAGE_ROWS]);
        let glossy = (index % 2) as f32;
        buffers.cases.push(GpuCase {
            normal: surface.vector(&mut random),
            roughness: Numbers::choose(&mut random).number(&mut random),
            view: surface.vector(&mut random),
            f90: glossy,
            diffuse_albedo: [1.0 - glossy; 3],
            light: index as u32,
            f0: [glossy; 3],
            coat_weight: 0.5 * glossy,
            coat_normal: surface.vector(&mut random),
            coat_roughness: surface.number(&mut random),
            // Black: Charlie reflects more than it gets where it is seen at grazing angles
            sheen_roughness: surface.number(&mut random),
            interface_f90: glossy,
            diffuse_roughness: surface.number(&mut random),
            tangent: surface.vector(&mut random),
            tangent_roughness: surface.number(&mut random),
            film_weight: 0.5 * glossy,
            film_ior: surface.number(&mut random),
            film_thickness: surface.number(&mut random),
            ..bytemuck::Zeroable::zeroed()
        });
    }
    buffers
}

/// The vertices of a light that are read with these effects.
fn outline(given: &Cases, light: &GpuLight, effects: Effects) -> Vec<[f32; 4]> {
    let count =
        if effects.contains(Effects::POLYGON) { light.vertex_count } else { light.vertex_count.min(4) };
    let first = light.first_vertex as usize;
    given.vertices[first..first + count as usize].to_vec()
}

fn check(engine: &TestEngine, given: &Cases, effects: Effects, quality: Quality) {
    let (mut wrong, mut dark, mut partial, mut infinite) = (Vec::new(), 0, 0, 0);
    for (index, answer) in engine.run(given, effects, quality).iter().enumerate() {
        let factors = [answer[0], answer[1], answer[2]].map(f32::from_bits);
        let glossy = given.cases[index].f90 == 1.0;
        // An albedo may be rounded up
        let largest = if glossy { 1.0 + 1e-6 } else { 1.0 };
        let light = &given.lights[index];
        let outline = outline(given, light, effects);
        // A vertex that is not finite gives no light
        let no_light =
            outline.iter().any(|vertex| vertex[..3].iter().any(|coordinate| !coordinate.is_finite()));
        // A NaN is in no range
        let range = if no_light { 0.0..=0.0 } else { 0.0..=largest };
        if !factors.iter().all(|factor| range.contains(factor)) {
            wrong.push(format!("{factors:?}: {:?} {light:?} {outline:?}", given.cases[index]));
        }
        dark += usize::from(factors[0] == 0.0);
        partial += usize::from(factors[0] > 0.0 && factors[0] < 1.0);
        infinite += usize::from(no_light);
    }
    println!("{quality:?}, {effects}: {dark} dark, {partial} between 0 and 1, {} wrong", wrong.len());
    assert!(
        wrong.is_empty(),
        "{quality:?}, {effects}: {} are no form factors:\n{}",
        wrong.len(),
        wrong[..wrong.len().min(5)].join("\n")
    );
    // The twin: it is not that every odd number makes a light dark. Half of the exponents are beyond what
    // squares reach
    assert!(partial > COUNT / 25 && dark > COUNT / 10, "{partial} partial, {dark} dark");
    assert!(infinite > COUNT / 10, "{infinite} outlines that are not finite");
}

#[test]
fn every_bit_pattern_gives_a_form_factor() {
    let Some(engine) = TestEngine::new() else { return };
    let given = buffers();
    for effects in [Effects::all(), Effects::all() - Effects::POLYGON] {
        for horizon in [Horizon::Cosine, Horizon::Both] {
            check(&engine, &given, effects, Quality { horizon, ..Quality::default() });
        }
        let quality = Quality {
            specular_lobes: SpecularLobes::Two,
            horizon: Horizon::Both,
            lobes: Lobes::Formula,
            ..Quality::default()
        };
        check(&engine, &given, effects, quality);
        let quality = Quality { specular_lobes: SpecularLobes::HalfVectors, ..Quality::default() };
        check(&engine, &given, effects, quality);
    }
}

/// A light's image anywhere: its place, and the part of it.
fn show_images(given: &mut Cases) {
    let mut random = Random::new(22);
    for light in &mut given.lights {
        let numbers = Numbers::choose(&mut random);
        light.texture_layer = 0;
        let first = (light.first_vertex + light.vertex_count) as usize;
        for row in &mut given.vertices[first..first + IMAGE_ROWS] {
            *row = numbers.vector(&mut random);
        }
    }
}

#[test]
fn every_bit_pattern_of_an_image_gives_a_form_factor() {
    let Some(mut engine) = TestEngine::new() else { return };
    // White, so that the answer still is the form factor, wherever it is looked up
    let white = [[1.0; 4]];
    let image =
        SourceImage { texels: SourceTexels::Linear(&white), size: [1, 1], part: TexturePart::default() };
    engine.load_textures(PyramidSize::new(64).unwrap(), &[image]).unwrap();
    let mut given = buffers();
    show_images(&mut given);
    for effects in [Effects::all(), Effects::all() - Effects::POLYGON] {
        for footprint in [Footprint::Kernel, Footprint::Mips] {
            check(&engine, &given, effects, Quality { footprint, ..Quality::default() });
        }
    }
}
