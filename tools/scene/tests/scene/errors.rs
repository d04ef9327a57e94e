//! Bad files: each error names the file and the field.

use crate::allocations::most_of;
use crate::shapes::panel;
use crate::writer::{Writer, container, png};
use crate::{emitter_with, error};
use arealight_scene::{LoadOptions, Scene, SceneBuffers, SceneError};
use glam::DVec3;
use serde_json::{Value, json};

fn lamp() -> Writer {
    emitter_with(&panel(1.0, 1.0), json!({}))
}

#[test]
fn files_that_are_not_gltf() {
    let missing = Scene::load("/nowhere/scene.glb").unwrap_err();
    assert!(matches!(missing, SceneError::Read { .. }));
    assert!(missing.to_string().starts_with("/nowhere/scene.glb: "), "{missing}");
    let good = lamp().glb();
    let mut old = good.clone();
    old[4] = 1;
    let mut chunk = good.clone();
    chunk[16] = b'X';
    let mut long = good.clone();
    long[12..16].copy_from_slice(&u32::MAX.to_le_bytes());
    for (bytes, text) in [
        (&b""[..], "neither binary glTF nor"),
        (b"hello", "nor a JSON object"),
        (b"{}", "missing field `asset`"),
        (br#"{"asset":{"version":"1.0"}}"#, "asset.version is '1.0'"),
        (b"glTF", "cut short"),
        (&good[..good.len() - 1], "cut short"),
        (&old, "binary glTF of version 1"),
        (&chunk, "no JSO chunk at byte 12"),
        (&long, "the chunk at byte 12 reaches beyond the file"),
    ] {
        let error = Scene::from_bytes(bytes, "bad").unwrap_err();
        assert!(matches!(error, SceneError::NotGltf { .. }), "{error}");
        let error = error.to_string();
        assert!(error.starts_with("bad: not a glTF 2.0 file: ") && error.contains(text), "{error}");
    }
}

#[test]
fn fields_that_break_rules_are_named() {
    type Change = (fn(&mut Value), &'static str);
    let changes: &[Change] = &[
        (
            |r| r["extensionsRequired"] = json!(["KHR_texture_basisu"]),
            "extensionsRequired: KHR_texture_basisu is not supported",
        ),
        (|r| r["nodes"][0]["mesh"] = json!(7), "nodes[0].mesh: Index out of bounds"),
        (|r| r["scene"] = json!(3), "scene: Index out of bounds"),
        (|r| r["scenes"][0]["nodes"] = json!([9]), "scenes[0].nodes[0]: Index out of bounds"),
        (|r| r["nodes"][0]["children"] = json!([0]), "nodes[0]: is reached twice"),
        (|r| r["scenes"][0]["nodes"] = json!([0, 0]), "nodes[0]: is reached twice"),
        (|r| r["nodes"][0]["rotation"] = json!([0, 0, 0, 0]), "nodes[0]: rotation: [0.0, 0.0, 0.0, 0.0]"),
        (|r| r["nodes"][0]["translation"] = json!([1e20, 0, 0]), "nodes[0]: its world transform"),
        (|r| r["nodes"][0]["scale"] = json!([1e38, 1e38, 0]), "nodes[0]: its world transform"),
        (|r| r["nodes"][0]["scale"] = json!([1, 1e39, 0]), "not a glTF 2.0 file: number out of range"),
        (
            |r| r["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(99),
            "meshes[0].primitives[0].attributes: an accessor does not exist",
        ),
        (
            |r| r["meshes"][0]["primitives"][0]["attributes"] = json!({}),
            "meshes[0].primitives[0].attributes[\"POSITION\"]: Missing data",
        ),
        (|r| r["meshes"][0]["primitives"][0]["mode"] = json!(17), "mode: Invalid value"),
        (
            |r| r["accessors"][0]["count"] = json!(1000),
            "accessors[0]: 1000 elements from byte 0 on do not fit",
        ),
        (
            |r| r["accessors"][0]["count"] = json!(u64::MAX),
            "accessors[0].count: 18446744073709551615, at most",
        ),
        (|r| r["accessors"][0]["type"] = json!("VEC4"), "POSITION: accessors[0] is Vec4, should be Vec3"),
        (|r| r["accessors"][0]["componentType"] = json!(5125), "POSITION: components of type U32"),
        (|r| r["accessors"][0]["byteOffset"] = json!(u64::MAX), "do not fit bufferViews[0]"),
        (|r| r["accessors"][1]["count"] = json!(3), "NORMAL: 3 for 4 positions"),
        (|r| r["accessors"][3]["componentType"] = json!(5122), "indices: I16 cannot be an index"),
        (
            |r| r["bufferViews"][0]["byteStride"] = json!(4),
            "accessors[0]: a stride of 4 for elements of 12 bytes",
        ),
        (
            |r| r["bufferViews"][0]["byteLength"] = json!(1_u64 << 40),
            "bufferViews[0]: bytes 0 + 1099511627776 reach",
        ),
        (|r| r["bufferViews"][0]["buffer"] = json!(1), "bufferViews[0].buffer: Index out of bounds"),
        (
            |r| {
                r["accessors"][0]["sparse"] = json!({ "count": 5, "indices": { "bufferView": 0,
            "componentType": 5121 }, "values": { "bufferView": 0 } });
            },
            "sparse: has 5 values for 4",
        ),
        (
            |r| {
                r["accessors"][0]["sparse"] = json!({ "count": 1, "indices": { "bufferView": 0,
            "componentType": 5125, "byteOffset": 4 }, "values": { "bufferView": 0 } });
            },
            "sparse: index",
        ),
        (
            |r| {
                r["accessors"][0]["sparse"] = json!({ "count": 2, "indices": { "bufferView": 0,
            "componentType": 5121 }, "values": { "bufferView": 0 } });
            },
            "sparse: index 0 is not above the one before it",
        ),
        (
            |r| r["nodes"][0]["extensions"] = json!({ "EXT_lights_area": { "light": 0 } }),
            "extensions.EXT_lights_area: is missing",
        ),
        (
            |r| {
                r["extensions"] = json!({ "EXT_lights_area": { "lights": [] } });
                r["nodes"][0]["extensions"] = json!({ "EXT_lights_area": { "light": 2 } });
            },
            "nodes[0].extensions.EXT_lights_area: light 2 of 0",
        ),
        (
            |r| {
                r["extensions"] = json!({ "EXT_lights_area": { "lights": [{ "size": "big" }] } });
                r["nodes"][0]["extensions"] = json!({ "EXT_lights_area": { "light": 0 } });
            },
            "extensions.EXT_lights_area: invalid type: string",
        ),
    ];
    for (change, text) in changes {
        let mut writer = lamp();
        change(&mut writer.root);
        let error = error(writer);
        assert!(error.starts_with("test.glb: ") && error.contains(text), "{error:?} lacks {text:?}");
    }
    // The twin: unchanged, it loads
    assert!(Scene::from_bytes(&lamp().glb(), "good").is_ok());
}

#[test]
fn missing_bounds_of_positions_do_no_harm() {
    let mut writer = lamp();
    let accessor = writer.root["accessors"][0].as_object_mut().unwrap();
    accessor.remove("min");
    accessor.remove("max");
    assert!(Scene::from_bytes(&writer.glb(), "test").is_ok());
}

#[test]
fn vertices_that_are_not_finite_are_named() {
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut shape = panel(1.0, 1.0);
        shape.positions[2][1] = value;
        let error = error(emitter_with(&shape, json!({})));
        assert!(error.contains("meshes[0] 'lamp'.primitives[0].POSITION[2]: [0.5, "), "{error}");
        let mut shape = panel(1.0, 1.0);
        shape.normals[3][0] = value;
        let error = crate::error(emitter_with(&shape, json!({})));
        assert!(error.contains("NORMAL[3]"), "{error}");
    }
    let mut shape = panel(1.0, 1.0);
    shape.positions[1][0] = 3e38;
    let error = error(emitter_with(&shape, json!({})));
    assert!(error.contains("POSITION[1] in the world"), "{error}");
}

#[test]
fn indices_out_of_range_are_named() {
    let mut shape = panel(1.0, 1.0);
    shape.indices[4] = 4;
    let error = error(emitter_with(&shape, json!({})));
    assert!(error.contains("primitives[0].indices[4]: index 4, but there are 4 vertices"), "{error}");
}

#[test]
fn node_loops_and_deep_trees() {
    let mut writer = lamp();
    writer.root["nodes"] = json!([{ "children": [1] }, { "children": [2] }, { "children": [0] }]);
    assert!(error(writer).contains("nodes[0]: is reached twice"));
    // Two parents would mean exponential copies
    let mut writer = lamp();
    writer.root["nodes"] = json!([{ "children": [1, 2] }, { "children": [2] }, { "mesh": 0 }]);
    assert!(error(writer).contains("nodes[2]: is reached twice"));
    // A chain deeper than a thread's stack
    let mut writer = lamp();
    let count = 200_000;
    let mut nodes: Vec<Value> = (1..count).map(|i| json!({ "children": [i] })).collect();
    nodes.push(json!({ "mesh": 0 }));
    writer.root["nodes"] = json!(nodes);
    assert_eq!(crate::load(writer).lights.len(), 1);
}

#[test]
fn images_that_cannot_be_read_are_named() {
    let textured = |bytes: &[u8]| {
        let mut writer = lamp();
        writer.texture("broken", bytes);
        writer.root["materials"][0]["normalTexture"] = json!({ "index": 0 });
        writer
    };
    for (bytes, text) in [
        (&b"no image at all"[..], "images[0]: "),
        (b"GIF89a.........", "images[0]: is Gif, must be PNG, JPEG or WebP"),
        (b"\x89PNG\r\n\x1a\n....", "images[0]: "),
    ] {
        let error = error(textured(bytes));
        assert!(error.starts_with("test.glb: ") && error.contains(text), "{error}");
    }
    let mut writer = textured(b"");
    writer.root["images"][0] = json!({ "uri": "missing.png" });
    assert!(error(writer).contains("images[0]: cannot read 'missing.png'"));
    let mut writer = textured(b"");
    writer.root["images"][0] = json!({});
    assert!(error(writer).contains("images[0]: has neither a URI nor a buffer view"));
    // An image that nothing uses is not read
    let mut writer = lamp();
    writer.texture("broken", b"no image at all");
    assert!(Scene::from_bytes(&writer.glb(), "test").is_ok());
}

#[test]
fn buffers_that_are_missing_or_short_are_named() {
    let writer = lamp();
    let mut root = writer.root.clone();
    root["buffers"] = json!([{ "byteLength": writer.buffer.len() }]);
    let error = Scene::from_bytes(root.to_string().as_bytes(), "a.gltf").unwrap_err().to_string();
    assert_eq!(error, "a.gltf: buffers[0]: has neither a URI nor a binary chunk");
    root["buffers"] = json!([{ "byteLength": writer.buffer.len() + 4 }]);
    let mut text = root.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let error = Scene::from_bytes(&container(&text, &writer.buffer), "a.glb").unwrap_err().to_string();
    let (has, should) = (writer.buffer.len(), writer.buffer.len() + 4);
    assert_eq!(error, format!("a.glb: buffers[0]: has {has} bytes, should have {should}"));
    root["buffers"] = json!([{ "byteLength": 4, "uri": "data:;base64,*" }]);
    let error = Scene::from_bytes(root.to_string().as_bytes(), "a.gltf").unwrap_err();
    assert!(matches!(error, SceneError::Resource { .. }), "{error}");
}

#[test]
fn scenes_made_by_hand_are_checked_when_packed() {
    let good = crate::load(lamp());
    assert!(SceneBuffers::new(&good, DVec3::ZERO).is_ok());
    let pack = |change: fn(&mut Scene), origin: DVec3| {
        let mut scene = good.clone();
        change(&mut scene);
        SceneBuffers::new(&scene, origin).unwrap_err().to_string()
    };
    let text = pack(|scene| scene.triangles[1].material = 5, DVec3::ZERO);
    assert_eq!(text, "triangles[1].material: index 5, but there are 1");
    let text = pack(|scene| scene.materials[0].normal_texture = Some(0), DVec3::ZERO);
    assert_eq!(text, "materials[0].normal_texture: index 0, but there are 0");
    let text = pack(|scene| scene.triangles[1].positions[0].x = f64::NAN, DVec3::ZERO);
    assert!(text.starts_with("triangles[1][0]: [NaN"), "{text}");
    let text = pack(|_| {}, DVec3::splat(1e17));
    assert!(text.starts_with("triangles[0][0]: "), "{text}");
}

#[test]
fn what_lies_outside_of_the_scene_s_folder_is_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("scene");
    std::fs::create_dir(&inner).unwrap();
    std::fs::write(folder.path().join("secret"), "12345678").unwrap();
    std::fs::write(inner.join("beside.bin"), [0; 36]).unwrap();
    let load = |uri: &str| {
        let root = json!({ "asset": { "version": "2.0" }, "buffers": [{ "byteLength": 8, "uri": uri }] });
        let path = inner.join("scene.gltf");
        std::fs::write(&path, root.to_string()).unwrap();
        Scene::load(&path)
    };
    for uri in ["../secret", "a/../../secret", "%2e%2e/secret", "./../secret"] {
        let error = load(uri).unwrap_err().to_string();
        assert!(error.contains("outside of the scene's folder"), "{uri}: {error}");
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(folder.path().join("secret"), inner.join("link")).unwrap();
        let error = load("link").unwrap_err().to_string();
        assert!(error.contains("a link leads outside"), "{error}");
    }
    // The twin: what lies beside it is, by any way that stays inside
    for uri in ["beside.bin", "./beside.bin", "textures/../beside.bin"] {
        std::fs::create_dir_all(inner.join("textures")).unwrap();
        load(uri).unwrap();
    }
}

/// A file that holds no vertex, of `primitives` that share an accessor of `count` zeros.
fn of_zeros(count: usize, primitives: usize) -> Vec<u8> {
    let primitive = json!({ "attributes": { "POSITION": 0 } });
    let root = json!({ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }], "meshes": [{ "primitives": vec![primitive; primitives] }],
        "accessors": [{ "componentType": 5126, "count": count, "type": "VEC3" }] });
    root.to_string().into_bytes()
}

/// A file of many nodes with one mesh.
fn of_nodes(count: usize) -> Vec<u8> {
    let mut writer = emitter_with(&crate::shapes::sphere(1.0, 32, 32), json!({}));
    writer.root["materials"][0] = json!({});
    writer.root["nodes"] = vec![writer.root["nodes"][0].clone(); count].into();
    writer.root["scenes"][0]["nodes"] = (0..count).collect::<Vec<_>>().into();
    writer.glb()
}

/// A sphere in as many primitives as may be, which share its vertices.
fn of_parts(most: usize) -> Vec<u8> {
    let mut writer = emitter_with(&crate::shapes::sphere(1.0, 64, 64), json!({}));
    let sphere = crate::shapes::sphere(1.0, 64, 64);
    let whole = writer.root["meshes"][0]["primitives"][0].clone();
    let part = |corners: &[u32]| {
        let mut part = whole.clone();
        part["indices"] = json!(writer.indices(corners));
        part
    };
    let parts: Vec<Value> =
        sphere.indices.chunks(3 * (sphere.indices.len() / 3).div_ceil(most)).map(part).collect();
    writer.root["meshes"][0]["primitives"] = parts.into();
    writer.glb()
}

#[test]
fn primitives_that_share_vertices_take_those_that_they_use() {
    let load = |parts| {
        let options = LoadOptions { memory: Some(8 << 20), ..LoadOptions::default() };
        Scene::from_bytes_with(&of_parts(parts), "parts", options).unwrap()
    };
    let (whole, parts) = (load(1), load(100));
    assert_eq!(whole.triangles.len(), 8064);
    assert!(whole.triangles == parts.triangles);
}

#[test]
fn memory_follows_the_file() {
    const SMALL: Option<u64> = Some(8 << 20);
    let load = |bytes: &[u8], memory| {
        let options = LoadOptions { memory, ..LoadOptions::default() };
        most_of(|| Scene::from_bytes_with(bytes, "small", options).map(drop))
    };
    for (bytes, memory, field) in [
        (of_zeros(25_000_000, 1), None, "accessors[0]"),
        (of_zeros(3_000_000, 20), None, "accessors[0]"),
        (of_zeros(300_000, 1), SMALL, "accessors[0]"),
        (of_nodes(100), SMALL, "primitives[0]: its triangles"),
    ] {
        let (refused, taken) = load(&bytes, memory);
        let error = refused.unwrap_err();
        assert!(matches!(error, SceneError::TooMuch { .. }) && error.to_string().contains(field), "{error}");
        assert!(taken < memory.unwrap_or(300_000_000), "{field}: {taken} bytes");
    }
    // The twins: less of the same, and more memory
    for (bytes, memory) in
        [(of_zeros(30_000, 1), SMALL), (of_nodes(5), SMALL), (of_nodes(100), Some(1 << 28))]
    {
        let (loaded, taken) = load(&bytes, memory);
        assert!(loaded.is_ok() && (100_000..memory.unwrap_or_default()).contains(&taken), "{taken} bytes");
    }
}

#[test]
fn numbers_above_an_index_are_none() {
    let refused = |change: fn(&mut Value)| {
        let mut writer = lamp();
        change(&mut writer.root);
        error(writer)
    };
    let said = refused(|root| root["nodes"][0]["mesh"] = json!(1_u64 << 32));
    assert!(said.contains("mesh: 4294967296 is too large for an index at line 1"), "{said}");
    let said = refused(|root| root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(u64::MAX));
    assert!(said.contains("POSITION: 18446744073709551615 is too large"), "{said}");
    // The twin: sizes, and what is anybody's
    let mut writer = lamp();
    writer.root["extras"] = json!({ "id": u64::MAX });
    crate::load(writer);
}

/// The checksum of a PNG's chunk.
fn checksum(bytes: &[u8]) -> u32 {
    let step = |rest: u32, _| if rest & 1 == 0 { rest >> 1 } else { rest >> 1 ^ 0xedb8_8320 };
    !bytes.iter().fold(u32::MAX, |rest, byte| (0..8).fold(rest ^ u32::from(*byte), step))
}

/// The file of a small PNG whose header says that it has 16384 x 16384 texels.
fn promised(png: &[u8]) -> Vec<u8> {
    let mut png = png.to_vec();
    png[16..24].copy_from_slice(&[16384_u32.to_be_bytes(); 2].concat());
    let checksum = checksum(&png[12..29]);
    png[29..33].copy_from_slice(&checksum.to_be_bytes());
    png
}

#[test]
fn images_that_are_too_many_texels_together_are_refused_by_their_headers() {
    let small = png(image::RgbImage::new(4, 4));
    let with = |images: &[&[u8]], memory: Option<u64>| {
        let mut writer = lamp();
        for image in images {
            writer.texture("image", image);
        }
        // In the order in which they are read
        writer.root["materials"][0]["emissiveTexture"] = json!({ "index": 0 });
        writer.root["materials"][0]["normalTexture"] = json!({ "index": images.len() - 1 });
        let options = LoadOptions { memory, ..LoadOptions::default() };
        Scene::from_bytes_with(&writer.glb(), "test.glb", options).unwrap_err().to_string()
    };
    let promised = promised(&small);
    let together = with(&[&small, &promised], Some(1 << 32));
    assert!(together.contains("texels of all images: 268435472, at most 268435456"), "{together}");
    // The twin: alone it is not too large, and its texels are missing
    let alone = with(&[&promised], Some(1 << 32));
    assert!(alone.contains("images[0]: ") && !alone.contains("texels of all images"), "{alone}");
    // So small a file may not take so much, whatever its texels are
    let bomb = with(&[&promised], None);
    assert!(bomb.contains("images[0]: takes 2147483648 bytes of memory, more than is left of 26"), "{bomb}");
}
