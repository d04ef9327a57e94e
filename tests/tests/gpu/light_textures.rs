//! A host's mistakes with light textures have typed answers that name the field, and then nothing is
//! recorded.

use arealight_engine::{Passes, TextureArray};
use arealight_tests::prelude::*;
use arealight_vk::{LightTextures, TextureUpdate};

fn small() -> PyramidSize {
    PyramidSize::new(64).unwrap()
}

#[test]
fn an_array_that_no_device_has_is_refused() {
    let Some(engine) = TestEngine::new() else { return };
    for layers in [0, u32::MAX] {
        // SAFETY: Nothing is made where an error is returned.
        let error = unsafe { LightTextures::new(engine.context(), small(), layers) }.unwrap_err();
        assert_eq!(field(&error), "layers", "{error}");
    }
}

#[test]
fn textures_without_memory_are_refused() {
    let Some(engine) = TestEngine::new() else { return };
    // SAFETY: No submission uses them.
    let textures = unsafe { LightTextures::new(engine.context(), small(), 2) }.unwrap();
    assert!(textures.memory_requirements().size >= 2 * small().texels() * 8);
    let count = textures.level_sets();
    let pool = engine.host().descriptor_pool(count, &textures.level_pool_sizes()).unwrap();
    // SAFETY: The layout is the textures'; for the writes, the sets are new.
    unsafe {
        let sets: Vec<_> = (0..count).map(|_| pool.allocate(textures.level_set_layout()).unwrap()).collect();
        let error = textures.write_level_sets(&sets).unwrap_err();
        assert_eq!(field(&error), "finer_level", "{error}");
        let error = textures.write_level_sets(&sets[1..]).unwrap_err();
        assert_eq!(field(&error), "level_sets", "{error}");
    }
}

#[test]
fn sources_that_are_no_images_are_refused() {
    let Some(engine) = TestEngine::new() else { return };
    let array = TextureArray::new(&Passes::new(engine.host().clone()).unwrap(), small(), 1).unwrap();
    let pool = engine.host().descriptor_pool(1, &array.image().source_pool_sizes(1)).unwrap();
    let layout = vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL;
    let null = Resource::SampledImage { view: vk::ImageView::null(), layout };
    // SAFETY: The layout is the textures', and the set new.
    unsafe {
        let set = pool.allocate(array.image().source_set_layout()).unwrap();
        for source in [null, array.image().resource()] {
            let error = array.image().write_source_set(set, source).unwrap_err();
            assert_eq!(field(&error), "source", "{error}");
        }
    }
}

#[test]
fn updates_that_cannot_be_recorded_are_refused() {
    let Some(engine) = TestEngine::new() else { return };
    let array = TextureArray::new(&Passes::new(engine.host().clone()).unwrap(), small(), 3).unwrap();
    let update = |layer| TextureUpdate {
        layer,
        source_set: vk::DescriptorSet::null(),
        source_size: [4, 4],
        part: TexturePart::default(),
        decode_srgb: false,
    };
    let sets = vec![vk::DescriptorSet::null(); array.image().level_sets() as usize];
    engine
        .host()
        .submit(|commands| {
            // SAFETY: Nothing is recorded where an error is returned, nor without updates, so that no set is
            // used.
            let record =
                |sets: &[_], updates: &[_]| unsafe { array.image().record_update(commands, sets, updates) };
            let error = record(&sets[1..], &[update(0)]).unwrap_err();
            assert_eq!(field(&error), "level_sets", "{error}");
            let error = record(&sets, &[update(0), update(3)]).unwrap_err();
            assert_eq!(error.to_string(), "layer: 3 is not there: the light textures have 3");
            let error = record(&sets, &[update(2), update(1), update(2)]).unwrap_err();
            assert_eq!(error.to_string(), "layer: 2 is given twice; give it once a recording");
            let huge = TextureUpdate { source_size: [4, 5000], ..update(1) };
            let error = record(&sets, &[update(0), huge]).unwrap_err();
            assert!(matches!(error, Error::TexturePart { layer: 1, .. }), "{error}");
            record(&sets, &[]).unwrap();
        })
        .unwrap();
}
