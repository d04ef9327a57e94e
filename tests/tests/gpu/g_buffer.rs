//! G-buffers of other layouts: the same surface in, the same radiance out.

use arealight_tests::c_library::prelude::*;
use arealight_tests::kernel::shade_with_bridge;
use arealight_tests::prelude::*;
use ash::vk::Format;

const CAMERA: Vec3 = Vec3::new(0.0, -1.0, 1.0);
const FLOAT: Format = Format::R32G32B32A32_SFLOAT;

fn pixel(engine: &TestEngine) -> OnePixel<'_> {
    OnePixel::new(engine, Vec4::new(0.1, 0.2, 0.0, 1.0), 0.5)
}

fn options(g_buffer: GBufferLayout) -> ShadeOptions {
    let effects = Effects::DIFFUSE | Effects::GLOSSY | Effects::SPECULAR_INPUT;
    ShadeOptions { surfaces: effects, g_buffer, ..ShadeOptions::default() }
}

/// A surface as our own layout has it.
#[derive(Clone, Copy)]
struct Surface {
    normal: Vec3,
    roughness: f32,
    base_color: Vec3,
    metalness: f32,
    f0: f32,
}

impl Surface {
    /// What the default layout shades of it: radiance.
    fn shade(&self, engine: &TestEngine) -> Vec3 {
        let mut pixel = pixel(engine);
        pixel.set(Plane::Normal, FLOAT, self.normal.extend(self.roughness).to_array());
        pixel.set(Plane::BaseColor, FLOAT, self.base_color.extend(self.metalness).to_array());
        pixel.set(Plane::Specular, FLOAT, Vec3::splat(self.f0).extend(1.0).to_array());
        pixel.shade(options(GBufferLayout::Arealight), &[lamp()], CAMERA, None).truncate()
    }
}

/// A number of [0, 1] as `bits` hold it: the integer.
fn unorm(value: f32, bits: u32) -> u32 {
    (value * ((1u32 << bits) - 1) as f32).round() as u32
}

/// A number of [-1, 1], likewise.
fn snorm(value: f32, bits: u32) -> i32 {
    (value * ((1u32 << (bits - 1)) - 1) as f32).round() as i32
}

fn of_unorm(value: u32, bits: u32) -> f32 {
    value as f32 / ((1u32 << bits) - 1) as f32
}

fn of_snorm(value: i32, bits: u32) -> f32 {
    value as f32 / ((1u32 << (bits - 1)) - 1) as f32
}

fn bytes(values: [f32; 4]) -> [u8; 4] {
    values.map(|value| unorm(value, 8) as u8)
}

fn of_bytes(values: [u8; 4]) -> [f32; 4] {
    values.map(|value| of_unorm(value.into(), 8))
}

/// Radiances are the same but for rounding: 2^-22 of what is decoded, which the frame and the lobe multiply
/// by less than 100.
#[track_caller]
fn assert_same(layout: Vec3, ours: Vec3) {
    let apart = ((layout - ours) / ours).abs().max_element();
    assert!(apart < 100.0 * 2.0_f32.powi(-22), "{layout} {ours}: {apart:e} apart");
}

#[test]
fn any_layout_is_shaded_as_ours() {
    let Some(engine) = TestEngine::new() else { return };
    // On one device, because they have a pipeline in common, and each takes seconds to compile on the CPU
    surfaces_of_other_layouts_are_shaded_as_ours(&engine);
    a_bridge_of_the_host_reads_its_own_g_buffer(&engine);
}

fn surfaces_of_other_layouts_are_shaded_as_ours(engine: &TestEngine) {
    let normal = Vec3::new(0.2, -0.3, 0.8).normalize_or(Vec3::Z);
    let exact =
        Surface { normal, roughness: 0.4, base_color: Vec3::new(0.8, 0.6, 0.3), metalness: 0.25, f0: 0.04 };
    let color = bytes(exact.base_color.extend(1.0).to_array());
    let [red, green, blue, _] = of_bytes(color);
    // What the images hold, read back here by what each engine's documents say
    let stored = Surface { base_color: Vec3::new(red, green, blue), ..exact };
    let mut pixel = pixel(engine);
    pixel.set(Plane::BaseColor, Format::R8G8B8A8_UNORM, color);
    let mut layouts = vec![];

    // Unreal Engine: ten bits of (n + 1) / 2; metallic, specular, roughness
    let ten = exact.normal.to_array().map(|n| unorm(n * 0.5 + 0.5, 10));
    let word = ten[0] | ten[1] << 10 | ten[2] << 20;
    let material = bytes([exact.metalness, 0.75, exact.roughness, 1.0 / 255.0]);
    let [metalness, specular, roughness, _] = of_bytes(material);
    pixel.set(Plane::Normal, Format::A2B10G10R10_UNORM_PACK32, word);
    pixel.set(Plane::Specular, Format::R8G8B8A8_UNORM, material);
    let shaded = pixel.shade(options(GBufferLayout::Unreal), &[lamp()], CAMERA, None).truncate();
    let normal = Vec3::from_array(ten.map(|n| of_unorm(n, 10) * 2.0 - 1.0));
    let surface = Surface { normal, roughness, metalness, f0: 0.08 * specular, ..stored };
    assert_same(shaded, surface.shade(engine));
    layouts.push(shaded);

    // Unity: eight signed bits, smoothness; reflectivity
    let [x, y, z] = exact.normal.to_array().map(|n| snorm(n, 8));
    let smoothness = snorm(1.0 - exact.roughness, 8);
    let reflectivity = bytes([0.04 + 0.96 * exact.metalness, 0.0, 0.0, 1.0]);
    pixel.set(Plane::Normal, Format::R8G8B8A8_SNORM, [x as i8, y as i8, z as i8, smoothness as i8]);
    pixel.set(Plane::Specular, Format::R8G8B8A8_UNORM, reflectivity);
    let shaded = pixel.shade(options(GBufferLayout::Unity), &[lamp()], CAMERA, None).truncate();
    let surface = Surface {
        normal: Vec3::from_array([x, y, z].map(|n| of_snorm(n, 8))),
        roughness: 1.0 - of_snorm(smoothness, 8),
        metalness: (of_bytes(reflectivity)[0] - 0.04) / 0.96,
        ..stored
    };
    assert_same(shaded, surface.shade(engine));
    layouts.push(shaded);

    // An octahedron's place in 16 bits, on either half; occlusion, roughness, metalness
    for normal in [exact.normal, exact.normal * Vec3::new(1.0, -1.0, -0.1)] {
        let flat = normal / normal.abs().element_sum();
        let fold = |along: f32, across: f32| (1.0 - across.abs()) * along.signum();
        let place =
            if flat.z < 0.0 { [fold(flat.x, flat.y), fold(flat.y, flat.x)] } else { [flat.x, flat.y] };
        let place = place.map(|n| snorm(n, 16));
        let material = bytes([0.5, exact.roughness, exact.metalness, 0.0]);
        let [_, roughness, metalness, _] = of_bytes(material);
        pixel.set(Plane::Normal, Format::R16G16_SNORM, place.map(|n| n as i16));
        pixel.set(Plane::Specular, Format::R8G8B8A8_UNORM, material);
        let shaded = pixel.shade(options(GBufferLayout::Octahedral), &[lamp()], CAMERA, None).truncate();
        // The normal as it was: 16 bits move it by 1e-4 at most, and what is reflected by 1e-3
        let ours = Surface { normal, roughness, metalness, ..stored }.shade(engine);
        assert!(((shaded - ours) / ours).abs().max_element() < 1e-3, "{shaded} {ours}");
        layouts.push(shaded);
    }

    // What eight and ten bits cost: of the surface that was meant, a few hundredths. The first has another
    // reflectance
    let meant = exact.shade(engine);
    for shaded in &layouts[1..3] {
        let apart = ((shaded - meant) / meant).abs().max_element();
        assert!(apart < 0.05, "{apart}");
    }
    // The twin: one layout's images, read as another's
    let wrong = pixel.shade(options(GBufferLayout::Unreal), &[lamp()], CAMERA, None).truncate();
    assert!(((wrong - layouts[3]) / layouts[3]).abs().max_element() > 0.1, "{wrong}");
}

fn a_bridge_of_the_host_reads_its_own_g_buffer(engine: &TestEngine) {
    let mut pixel = pixel(engine);
    let normal = Vec3::new(0.2, -0.3, 0.8).normalize_or(Vec3::Z);
    let halves = [normal.x, normal.y, normal.z, 0.4].map(|n| snorm(n, 16));
    let half = |n: i32| u32::from(n as i16 as u16);
    let color = bytes([0.8, 0.6, 0.3, 0.25]);
    let words = [
        half(halves[0]) | half(halves[1]) << 16,
        half(halves[2]) | half(halves[3]) << 16,
        u32::from_le_bytes(color),
        0,
    ];
    pixel.set(Plane::Normal, Format::R32G32B32A32_UINT, words);
    pixel.module = Some(shade_with_bridge());
    let shaded = pixel.shade(options(GBufferLayout::Arealight), &[lamp()], CAMERA, None).truncate();
    let [red, green, blue, metalness] = of_bytes(color);
    let [x, y, z, roughness] = halves.map(|n| of_snorm(n, 16));
    let (normal, base_color) = (Vec3::new(x, y, z), Vec3::new(red, green, blue));
    assert_same(shaded, Surface { normal, roughness, base_color, metalness, f0: 0.04 }.shade(engine));

    // So it does through the C library, to the last bit
    let (library, light) = (CLibrary::with_table(engine), lamp());
    let surfaces = options(GBufferLayout::Arealight).surfaces.bits();
    let module = shade_with_bridge();
    let make = |words: &[u32], size| {
        let mut pass = null_mut();
        let module = ArealightModule { words: words.as_ptr(), size, host_set_layout: 0 };
        let options = ArealightPassOptions { surfaces, module, ..ArealightPassOptions::default() };
        // SAFETY: the pointers are valid, with so many bytes or more.
        let made = unsafe { arealight_pass_create(library.arealight, &raw const options, &raw mut pass) };
        (made, pass)
    };
    let (made, pass) = make(&module, size_of_val(module.as_slice()));
    good(made);
    let by_c = library.shade(pass, &pixel, &[c_lamp(&light)], ArealightImage::default(), CAMERA);
    assert_eq!(by_c.truncate(), shaded);
    // SAFETY: nothing is pending.
    good(unsafe { arealight_pass_destroy(pass) });

    // What is no SPIR-V is refused
    let argument = ArealightResult::ErrorArgument;
    refused(make(&[7], 4).0, argument, "module: does not begin as SPIR-V does");
    refused(make(&module, 7).0, argument, "module.size: 7 bytes are no whole words of SPIR-V");
    let info = ShadePassInfo { module: Some(vec![7]), ..options(GBufferLayout::Arealight).into() };
    assert_eq!(field(&engine.pass(info).unwrap_err()), "module");
}
