//! Every bit pattern gives a finite answer: the eval kernel is given buffers that no host would write,
//! without the checks of the CPU side in between.

use arealight::gpu::GpuLight;
use arealight_engine::{SourceImage, SourceTexels};
use arealight_tests::prelude::*;
use arealight_tool_kernels::gpu::{EvalConstants, GpuCase};
use arealight_tool_kernels::kernels::EVAL;
use arealight_tool_kernels::plan;
use arealight_vk::ComputePass;

const COUNT: usize = 50_000;

/// Rows of an image's place, after the vertices of its light.
const IMAGE_ROWS: usize = 4;

/// Lights with their vertices, and a case for each.
struct Buffers {
    lights: Vec<GpuLight>,
    vertices: Vec<[f32; 4]>,
    cases: Vec<GpuCase>,
}

/// How wild a case's numbers are.
#[derive(Debug, Clone, Copy)]
enum Numbers {
    /// Any bits: mostly of extreme size, NaN or infinity one time in 256.
    Any,
    /// Of ordinary size, and any bits one time in eight.
    SomeAny,
    /// Of ordinary size times one power of two from 2^-149 to 2^127.
    Scaled(f32),
    /// Special numbers only: both zeros, the smallest and largest, infinities, NaN, one.
    Special,
}

const SPECIAL: [f32; 12] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    f32::MIN_POSITIVE,
    -1e-45,
    1e-45,
    f32::MAX,
    f32::MIN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
];

impl Numbers {
    fn choose(random: &mut Random) -> Self {
        match random.bits() % 4 {
            0 => Self::Any,
            1 => Self::SomeAny,
            2 => Self::Scaled(random.between(-149.0, 128.0).exp2() as f32),
            _ => Self::Special,
        }
    }

    fn number(self, random: &mut Random) -> f32 {
        match self {
            Self::Any => f32::from_bits(random.bits()),
            Self::SomeAny if random.bits().is_multiple_of(8) => f32::from_bits(random.bits()),
            Self::SomeAny => random.between(-1.0, 1.0) as f32,
            Self::Scaled(scale) => random.between(-1.0, 1.0) as f32 * scale,
            Self::Special => SPECIAL[random.bits() as usize % SPECIAL.len()],
        }
    }

    fn vector(self, random: &mut Random) -> [f32; 3] {
        std::array::from_fn(|_| self.number(random))
    }
}

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
fn buffers() -> Buffers {
    let mut random = Random::new(21);
    let mut buffers = Buffers { lights: Vec::new(), vertices: Vec::new(), cases: Vec::new() };
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
        let rows: Vec<[f32; 4]> = (0..vertex_count)
            .map(|_| {
                let [x, y, z] = outline.vector(&mut random);
                [x, y, z, outline.number(&mut random)]
            })
            .collect();
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
            // Charlie reflects more than it gets where it is seen at grazing angles
            sheen_color: [0.0; 3],
            sheen_roughness: surface.number(&mut random),
            interface_f0: 0.0,
            interface_f90: glossy,
            diffuse_roughness: surface.number(&mut random),
            reserved: 0.0,
            tangent: surface.vector(&mut random),
            tangent_roughness: surface.number(&mut random),
            film_weight: 0.5 * glossy,
            film_ior: surface.number(&mut random),
            film_thickness: surface.number(&mut random),
            reserved1: 0.0,
        });
    }
    buffers
}

/// The first three channels of each case's answer, as bits.
fn answers(engine: &TestEngine, given: &Buffers, effects: Effects, quality: Quality) -> Vec<[u32; 4]> {
    let host = engine.host();
    let dispatch = plan::eval(effects, quality, given.cases.len() as u32);
    let lights = host.storage_buffer("lights", &given.lights).unwrap();
    let vertices = host.storage_buffer("vertices", &given.vertices).unwrap();
    let cases = host.storage_buffer("cases", &given.cases).unwrap();
    // What is not written stays NaN
    let results = host.storage_buffer("results", &vec![[u32::MAX; 4]; given.cases.len()]).unwrap();
    let resources = [
        engine.table(),
        Resource::buffer(lights.handle()),
        Resource::buffer(vertices.handle()),
        Resource::buffer(cases.handle()),
        Resource::buffer(results.handle()),
        engine.light_textures(),
    ];
    let constants = EvalConstants { case_count: given.cases.len() as u32 };
    // SAFETY: Host::submit waits, and everything here is dropped before the engine.
    unsafe {
        let pass = ComputePass::new(engine.context(), &EVAL, &dispatch.specialization).unwrap();
        let pool = host.descriptor_pool(1, &pass.pool_sizes(1)).unwrap();
        let set = pool.allocate(pass.set_layout()).unwrap();
        pass.write_set(set, &resources).unwrap();
        let bytes = bytemuck::bytes_of(&constants);
        host.submit(|commands| pass.record(commands, set, bytes, dispatch.groups).unwrap()).unwrap();
    }
    results.download().unwrap()
}

/// The vertices of a light that are read with these effects.
fn outline(given: &Buffers, light: &GpuLight, effects: Effects) -> Vec<[f32; 4]> {
    let count =
        if effects.contains(Effects::POLYGON) { light.vertex_count } else { light.vertex_count.min(4) };
    let first = light.first_vertex as usize;
    given.vertices[first..first + count as usize].to_vec()
}

fn check(engine: &TestEngine, given: &Buffers, effects: Effects, quality: Quality) {
    let (mut wrong, mut dark, mut partial, mut infinite) = (Vec::new(), 0, 0, 0);
    for (index, answer) in answers(engine, given, effects, quality).iter().enumerate() {
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
            for form_factor in [FormFactor::Exact, FormFactor::Difference] {
                check(&engine, &given, effects, Quality { form_factor, horizon, ..Quality::default() });
            }
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
fn show_images(given: &mut Buffers) {
    let mut random = Random::new(22);
    for light in &mut given.lights {
        let numbers = Numbers::choose(&mut random);
        light.texture_layer = 0;
        let first = (light.first_vertex + light.vertex_count) as usize;
        for row in &mut given.vertices[first..first + IMAGE_ROWS] {
            let [x, y, z] = numbers.vector(&mut random);
            *row = [x, y, z, numbers.number(&mut random)];
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
