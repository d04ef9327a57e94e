//! Files with random damage: whatever they hold, loading gives a scene or an error, and never a panic.

use crate::allocations::most_of;
use crate::shapes::{panel, sphere, star};
use crate::writer::{Writer, container, png};
use arealight_scene::{Scene, SceneBuffers, memory_of, required_effects};
use glam::DVec3;
use proptest::prelude::*;
use serde_json::{Value, json};

/// A small file with something of everything: textures, sparse data, cameras, both kinds of lights.
fn rich() -> Writer {
    let mut writer = Writer::new();
    let glow = writer.emitter("glow", [3.0, 2.0, 1.0], true);
    writer.object("star", &star(10, 1.0, 0.4), glow, json!({ "scale": [-1, 2, 1] }));
    let image = image::RgbImage::from_fn(4, 4, |x, y| image::Rgb([(x * 60) as u8, (y * 60) as u8, 90]));
    let texture = json!({ "index": writer.texture("texture", &png(image)), "texCoord": 0 });
    writer.push("samplers", json!({ "wrapS": 33071, "wrapT": 33648 }));
    writer.root["textures"][0]["sampler"] = json!(0);
    let material = json!({ "alphaMode": "MASK", "alphaCutoff": 0.3,
        "pbrMetallicRoughness": { "baseColorTexture": texture, "metallicRoughnessTexture": texture },
        "normalTexture": texture, "emissiveTexture": texture, "emissiveFactor": [0.5, 0.5, 0.5],
        "extensions": { "KHR_materials_ior": { "ior": 1.4 },
                        "KHR_materials_specular": { "specularFactor": 0.7 } } });
    let painted = writer.push("materials", material);
    writer.object("ball", &sphere(0.5, 5, 3), painted, json!({ "rotation": [0, 0.6, 0, 0.8] }));
    writer.object(
        "wall",
        &panel(3.0, 2.0),
        painted,
        json!({ "matrix":
        [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -2, 1] }),
    );
    let places = writer.view(&[1, 0, 2, 0]);
    let values: Vec<u8> = [0.1_f32; 6].iter().flat_map(|x| x.to_le_bytes()).collect();
    let values = writer.view(&values);
    writer.root["accessors"][0]["sparse"] = json!({ "count": 2,
        "indices": { "bufferView": places, "componentType": 5123 }, "values": { "bufferView": values } });
    writer.camera("eye", [0.0, 1.0, 5.0], [0.0; 3], 0.7, 1.5);
    writer.root["extensions"] = json!({ "EXT_lights_area": { "lights": [{ "size": 2 }] } });
    writer.node(json!({ "extensions": { "EXT_lights_area": { "light": 0 } }, "translation": [0, 3, 0] }));
    writer
}

/// What is held for a moment only is not asked for: so many times the budget may be taken.
const MOMENTS: u64 = 2;

/// Loads, within what the file may take, and packs what was loaded. True if it loaded.
fn survives(bytes: &[u8]) -> bool {
    let (scene, taken) = most_of(|| Scene::from_bytes(bytes, "hostile"));
    assert!(taken <= MOMENTS * memory_of(bytes.len() as u64), "{taken} bytes for {}", bytes.len());
    let Ok(scene) = scene else { return false };
    for light in &scene.lights {
        light.validate().unwrap();
    }
    arealight::PackedLights::new(&scene.lights, DVec3::ZERO).unwrap();
    let buffers = SceneBuffers::new(&scene, DVec3::ZERO).unwrap();
    let camera = scene.camera(None, 1.5).unwrap();
    assert!(camera.position.is_finite() && camera.forward.is_finite());
    let _ = required_effects(&scene);
    let _ = buffers.closest_hit(camera.position, camera.forward);
    true
}

#[test]
fn the_file_is_good_to_begin_with() {
    let scene = crate::load(rich());
    let counts = (scene.triangles.len(), scene.lights.len(), scene.cameras.len());
    assert_eq!(counts, (29, 18, 1));
    assert!(survives(&rich().glb()));
}

/// Every number, string and array of a JSON value, by its path.
fn places(value: &Value, path: &str, found: &mut Vec<String>) {
    match value {
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(i, item)| places(item, &format!("{path}/{i}"), found));
        }
        Value::Object(fields) => {
            fields.iter().for_each(|(key, field)| places(field, &format!("{path}/{key}"), found));
        }
        _ => {}
    }
    found.push(path.to_owned());
}

/// What a hostile author would write.
fn poison() -> impl Strategy<Value = Value> {
    prop_oneof![
        (0..40_u64).prop_map(|i| json!(i)),
        Just(json!(u32::MAX)),
        Just(json!(u64::MAX)),
        Just(json!(-1)),
        Just(json!(0.5)),
        Just(json!(1e38)),
        Just(json!(-1e300)),
        Just(json!(null)),
        Just(json!([])),
        Just(json!({})),
        Just(json!("")),
        Just(json!("data:;base64,AAAA")),
        Just(json!("SCALAR")),
        (5120..5127_u32).prop_map(|i| json!(i)),
        (0..12_u32).prop_map(|i| json!([i])),
    ]
}

/// Coordinates that make vertices coincide, line up, overlap, and leave the world.
fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        6 => (-4..5_i32).prop_map(|i| i as f32 * 0.5),
        3 => -2.0..2.0_f32,
        1 => prop::sample::select(vec![1e-20_f32, 1e-6, 1e6, 1e12, -1e12]),
        1 => (0..0x3a00_0000_u32).prop_map(f32::from_bits),
    ]
}

/// Where the buffer has float32 numbers.
fn float_words(writer: &Writer) -> Vec<usize> {
    let accessors = writer.root["accessors"].as_array().into_iter().flatten();
    let floats = accessors.filter(|accessor| accessor["componentType"] == 5126);
    let number = |value: &Value| value.as_u64().unwrap() as usize;
    let ranges = floats.map(|accessor| {
        let view = &writer.root["bufferViews"][number(&accessor["bufferView"])];
        number(&view["byteOffset"])..number(&view["byteOffset"]) + number(&view["byteLength"])
    });
    ranges.flat_map(|range| range.step_by(4)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 3000, failure_persistence: None, ..ProptestConfig::default()
    })]

    #[test]
    fn bytes_may_be_anything(
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..12),
    ) {
        let mut bytes = rich().glb();
        for (place, value) in damage {
            let place = place.index(bytes.len());
            bytes[place] = value;
        }
        survives(&bytes);
    }

    #[test]
    fn vertices_may_be_anywhere(
        damage in prop::collection::vec((any::<prop::sample::Index>(), coordinate()), 1..60),
    ) {
        let mut writer = rich();
        // Every shape emits, so that every one is merged
        writer.root["materials"][1] = json!({ "emissiveFactor": [1, 1, 1], "doubleSided": true });
        let words = float_words(&writer);
        for (place, value) in damage {
            let place = words[place.index(words.len())];
            writer.buffer[place..place + 4].copy_from_slice(&value.to_le_bytes());
        }
        let finite = words.iter().all(|&at| {
            let bytes = [0, 1, 2, 3].map(|i| writer.buffer[at + i]);
            f32::from_le_bytes(bytes).abs() < 1e14
        });
        prop_assert!(survives(&writer.glb()) || !finite, "finite vertices are no error");
    }

    #[test]
    fn fields_may_be_anything(
        damage in prop::collection::vec((any::<prop::sample::Index>(), poison()), 1..4),
    ) {
        let mut writer = rich();
        writer.root["buffers"] = json!([{ "byteLength": writer.buffer.len() }]);
        let mut found = Vec::new();
        places(&writer.root, "", &mut found);
        for (place, value) in damage {
            if let Some(field) = writer.root.pointer_mut(&found[place.index(found.len())]) {
                *field = value;
            }
        }
        let mut text = writer.root.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        survives(&container(&text, &writer.buffer));
    }

    #[test]
    fn files_may_end_anywhere(length in any::<prop::sample::Index>()) {
        let bytes = rich().glb();
        prop_assert!(!survives(&bytes[..length.index(bytes.len())]));
    }
}
