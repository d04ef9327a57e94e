//! The self-test that hosts run: its answers are the oracle's, the right table passes it, and tables as hosts
//! load them wrongly fail.

use arealight::kernels::Kernel;
use arealight::table::LAYERS;
use arealight_tests::kernel::{SELF_TEST, SELF_TEST_OF_TWO};
use arealight_tests::prelude::*;

const SOURCE: &str = include_str!("../../../shaders/include/arealight/self_test.glsl");

/// The numbers of an array of the file, `N` to an element.
fn array<const N: usize>(name: &str) -> Vec<[f64; N]> {
    let (_, rest) = SOURCE.split_once(&format!("AREALIGHT_SELF_TEST_{name}[10] = ")).expect("the array");
    let (body, _) = rest.split_once(");\n").expect("its end");
    let constructor = format!("vec{N}(");
    let elements = body.split(&constructor).skip(1);
    elements
        .map(|element| {
            let (inside, _) = element.split_once(')').unwrap_or((element, ""));
            let numbers: Vec<f64> = inside.split(',').map(|number| number.trim().parse().unwrap()).collect();
            numbers.try_into().unwrap()
        })
        .collect()
}

#[test]
fn answers_are_those_of_float64() {
    let table = LightTable::ggx();
    let views = array::<4>("VIEWS");
    let [f0, centers, halves_u, halves_v, of_one, of_two] =
        ["F0", "CENTERS", "HALVES_U", "HALVES_V", "ANSWERS", "ANSWERS_OF_TWO"]
            .map(|name| array::<3>(name).into_iter().map(DVec3::from_array).collect::<Vec<_>>());
    assert_eq!([views.len(), f0.len(), of_one.len(), of_two.len()], [10; 4]);
    let radiance = |index: usize, f0: DVec3, specular_lobes| {
        let [x, y, z, roughness] = views[index];
        let (center, u, v) = (centers[index], halves_u[index], halves_v[index]);
        let vertices = [-u - v, u - v, u + v, v - u].map(|offset| center + offset);
        let surface = Surface { f0, f90: 1.0, alpha: roughness * roughness, ..Surface::default() };
        let given = point(surface, DVec3::new(x, y, z), vertices.into(), false);
        let light = RelativeLight::new(&given.light, given.position);
        let quality = Quality { specular_lobes, ..Quality::default() };
        ltc_on(quality, &table, &given.surface, given.normal, given.view, &light)
    };
    for (lobes, answers) in [(SpecularLobes::One, &of_one), (SpecularLobes::Two, &of_two)] {
        for index in 0..10 {
            let found = radiance(index, f0[index], lobes);
            let apart = (found - answers[index]).abs().max_element();
            // Answers have nine decimals; the table's floats are 32 bits
            assert!(apart <= 1e-8, "{lobes:?}, point {index}: {found:.9}");
            // The twin: a surface that reflects a little more
            let other = radiance(index, f0[index] + 0.01, lobes);
            assert!((other - answers[index]).abs().max_element() > 1e-6, "{lobes:?}, point {index}");
        }
    }
}

/// Which points are wrong with a table.
fn run(engine: &TestEngine, kernel: &'static Kernel, table: Resource) -> u32 {
    // The buffer is longer than the one word that is written
    engine.dispatch::<u32>(kernel, &[], &[table], 1)[0]
}

/// Likewise, of a table of these texels.
fn wrong_points(engine: &TestEngine, kernel: &'static Kernel, texels: &[[f32; 4]]) -> u32 {
    let size = LightTable::ggx().size();
    let description = ImageDescription {
        name: "table",
        extent: [size, size],
        layers: LAYERS,
        format: vk::Format::R32G32B32A32_SFLOAT,
        usage: vk::ImageUsageFlags::SAMPLED,
    };
    let image = engine.host().image(&description).unwrap();
    image.upload(texels, Usage::COMPUTE_READ).unwrap();
    let layout = vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL;
    let resource = Resource::SampledImage { view: image.array_view(), layout };
    run(engine, kernel, resource)
}

/// A value as it is read where a format is said to be sRGB.
fn as_srgb(value: f32) -> f32 {
    let linear = |x: f32| if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) };
    linear(value.abs()).copysign(value)
}

#[test]
fn the_right_table_passes_and_wrong_ones_fail() {
    let Some(engine) = TestEngine::new() else { return };
    let table = LightTable::ggx();
    let (texels, size) = (table.texels(), table.size() as usize);
    let layer = size * size;
    for kernel in [&SELF_TEST, &SELF_TEST_OF_TWO] {
        assert_eq!(wrong_points(&engine, kernel, &texels), 0, "{}", kernel.name);
        assert_eq!(run(&engine, kernel, engine.table()), 0, "{}, in half floats", kernel.name);
    }
    // Layers of two lobes are read where there are two alone
    let first_three: Vec<_> =
        texels.iter().enumerate().map(|(at, texel)| if at < 3 * layer { *texel } else { [0.0; 4] }).collect();
    assert_eq!(wrong_points(&engine, &SELF_TEST, &first_three), 0);
    assert!(wrong_points(&engine, &SELF_TEST_OF_TWO, &first_three).count_ones() >= 5);

    // What hosts do to a table: they copy the first layer alone, take rows for columns, or call its format
    // sRGB
    let first_layer: Vec<_> =
        texels.iter().enumerate().map(|(at, texel)| if at < layer { *texel } else { [0.0; 4] }).collect();
    let swapped: Vec<_> = (0..texels.len())
        .map(|at| texels[at / layer * layer + at % size * size + at % layer / size])
        .collect();
    let srgb: Vec<_> = texels.iter().map(|texel| texel.map(as_srgb)).collect();
    // Rows turned over, as by an image library that has y up
    let turned: Vec<_> = (0..texels.len())
        .map(|at| texels[at / layer * layer + (size - 1 - at % layer / size) * size + at % size])
        .collect();
    for (what, wrong) in
        [("first layer", first_layer), ("swapped", swapped), ("sRGB", srgb), ("turned", turned)]
    {
        let found = wrong_points(&engine, &SELF_TEST, &wrong);
        println!("{what}: {} of 10 points are wrong", found.count_ones());
        assert!(found.count_ones() >= 5, "{what}: {found:#012b}");
    }
}
