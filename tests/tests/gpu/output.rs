//! Where radiance goes: overwritten or added, in one image or apart, in 32 bits or 16.

use arealight::plan::RadianceFormat;
use arealight_tests::prelude::*;
use ash::vk::{self, Handle as _};
use half::f16;

const CAMERA: Vec3 = Vec3::new(0.0, -1.0, 1.0);

fn surface(engine: &TestEngine) -> OnePixel<'_> {
    OnePixel::new(engine, Vec4::new(0.1, 0.2, 0.0, 1.0), 0.5)
}

fn no_surface(engine: &TestEngine) -> OnePixel<'_> {
    OnePixel::new(engine, Vec4::ZERO, 1.0)
}

#[test]
fn radiance_is_stored_as_was_asked_for() {
    let Some(engine) = TestEngine::new() else { return };
    // On one device, because they have pipelines in common, and each takes seconds to compile on the CPU
    output_overwrites_or_adds(&engine);
    lobes_apart_are_those_of_one_image(&engine);
    sixteen_bits_are_the_nearest_to_thirty_two_and_saturate(&engine);
}

fn output_overwrites_or_adds(engine: &TestEngine) {
    let add = ShadeOptions { output: Output::Add, ..ShadeOptions::default() };
    let over = surface(engine).shade(ShadeOptions::default(), &[lamp()], CAMERA, None);
    assert!(over.min_element() > 0.05 && over.w == 1.0, "{over}");
    let added = surface(engine).shade(add, &[lamp()], CAMERA, None);
    assert_eq!(added.truncate(), over.truncate() + BEFORE.truncate());

    // Without a surface: overwriting clears, adding leaves alone
    assert_eq!(no_surface(engine).shade(ShadeOptions::default(), &[lamp()], CAMERA, None), Vec4::ZERO);
    assert_eq!(no_surface(engine).shade(add, &[lamp()], CAMERA, None), BEFORE);
}

fn lobes_apart_are_those_of_one_image(engine: &TestEngine) {
    let lights = [lamp(), Light { radiance: Vec3::new(0.5, 0.25, 7.0), ..lamp() }];
    let shade = |options| surface(engine).shade_images(options, &lights, CAMERA, None);
    let only = |effects| shade(ShadeOptions { surfaces: effects, ..ShadeOptions::default() })[0];
    let apart = ShadeOptions { separate_lobes: true, ..ShadeOptions::default() };

    // Each is to the bit what a pass of that lobe alone gives
    let [diffuse, glossy] = shade(apart);
    assert_eq!([diffuse, glossy], [only(Effects::DIFFUSE), only(Effects::GLOSSY)]);
    assert!(diffuse.min_element() > 0.0 && glossy.min_element() > 0.0 && diffuse != glossy);
    let [both, untouched] = shade(ShadeOptions::default());
    assert_eq!(untouched, BEFORE);
    // Three sums of two lights or lobes, each rounded by 2^-24 of up to the whole
    let error = ((diffuse + glossy - both).truncate() / both.truncate()).abs().max_element();
    assert!(error <= 3.0 * 2.0_f32.powi(-24), "{diffuse} + {glossy} = {both}: {error}");

    // Added, and left where there is no surface
    let add = ShadeOptions { output: Output::Add, ..apart };
    let added = shade(add);
    assert_eq!(added.map(Vec4::truncate), [diffuse, glossy].map(|lobe| BEFORE.truncate() + lobe.truncate()));
    let nothing = |options| no_surface(engine).shade_images(options, &lights, CAMERA, None);
    assert_eq!(nothing(add), [BEFORE; 2]);
    // A lobe that the pass was made without reflects nothing
    let without = shade(ShadeOptions { surfaces: Effects::DIFFUSE, ..apart });
    assert_eq!(without, [diffuse, Vec4::W]);
}

fn sixteen_bits_are_the_nearest_to_thirty_two_and_saturate(engine: &TestEngine) {
    let nearest = |value: Vec4| Vec4::from_array(value.to_array().map(|v| f16::from_f32(v).to_f32()));
    // The one is beyond the largest number of sixteen bits in two channels, and near the smallest in the
    // third
    let bright = Light { radiance: Vec3::new(1e7, 2e38, 1e-4), ..lamp() };
    for (output, separate_lobes) in [(Output::Overwrite, false), (Output::Add, true)] {
        let single = ShadeOptions { output, separate_lobes, ..ShadeOptions::default() };
        let half = ShadeOptions { format: RadianceFormat::Rgba16Float, ..single };
        let shade = |options, light: &Light| {
            surface(engine).shade_images(options, std::slice::from_ref(light), CAMERA, None)
        };
        let exact = shade(single, &lamp());
        let expected = exact.map(nearest);
        assert_eq!(shade(half, &lamp()), expected, "{output:?} {separate_lobes}");
        assert_ne!(exact, expected, "sixteen bits do not hold what thirty-two do");

        for (half, single) in shade(half, &bright).into_iter().zip(shade(single, &bright)) {
            if single == BEFORE {
                continue;
            }
            // What is finite in 32 bits stays so
            assert!(single.x > 65_504.0 && single.y > 65_504.0 && single.is_finite(), "{single}");
            assert_eq!((half.x, half.y), (65_504.0, 65_504.0));
            assert_eq!(half.z, f16::from_f32(single.z).to_f32());
        }
    }
}

#[test]
fn the_glossy_image_is_asked_for_where_lobes_are_apart() {
    let Some(engine) = TestEngine::new() else { return };
    let view = |number| Resource::StorageImage { view: vk::ImageView::from_raw(number) };
    let image = Resource::SampledImage { view: vk::ImageView::from_raw(1), layout: vk::ImageLayout::GENERAL };
    let buffer = Resource::buffer(vk::Buffer::from_raw(1));
    let resources = ShadeResources {
        table: image,
        lights: buffer,
        light_vertices: buffer,
        planes: [(Plane::Position, image), (Plane::Normal, image), (Plane::BaseColor, image)].into(),
        radiance: view(7),
        ..ShadeResources::default()
    };
    let apart = ShadeOptions { separate_lobes: true, ..ShadeOptions::default() };
    let pass = engine.pass(apart).unwrap();
    for (glossy, words) in [
        (None, "glossy: is missing"),
        (Some(view(7)), "glossy: is the image of `radiance`"),
        (Some(view(0)), "glossy_image: is a null handle"),
        (Some(buffer), "glossy_image: is a StorageBuffer"),
    ] {
        let resources = ShadeResources { glossy, ..resources };
        // SAFETY: nothing is written where an error is returned.
        let error = unsafe { pass.write_set(vk::DescriptorSet::null(), &resources) }.unwrap_err();
        assert!(matches!(error, Error::InvalidArgument { .. }), "{error:?}");
        assert!(error.to_string().starts_with(words), "{error}");
    }
    // Nor is there a coat without its image
    let surfaces = Effects::DIFFUSE | Effects::COAT;
    let pass = engine.pass(ShadeOptions { surfaces, ..ShadeOptions::default() }).unwrap();
    // SAFETY: as above.
    let error = unsafe { pass.write_set(vk::DescriptorSet::null(), &resources) }.unwrap_err();
    assert!(error.to_string().starts_with("coat: is missing"), "{error}");
}
