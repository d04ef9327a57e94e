//! Triangles, nodes, cameras and containers.

use crate::shapes::{floor, panel, sphere};
use crate::writer::Writer;
use crate::{emitter_with, load, panel_with, warnings};
use arealight_scene::{Scene, SceneBuffers};
use glam::{DQuat, DVec3, Vec2, Vec3};
use serde_json::json;

#[test]
fn transforms_are_made_in_float64() {
    // A parent at 1e7, a child 1e-3 away: float32 positions would be off by 0.5
    let mut writer = panel_with(json!({}));
    writer.root["nodes"][0]["translation"] = json!([0.001, 0, 0]);
    writer.root["nodes"][0]["scale"] = json!([1e-3, 1e-3, 1e-3]);
    let parent = writer.push("nodes", json!({ "children": [0], "translation": [1e7, -1e7, 1e7] }));
    writer.root["scenes"][0]["nodes"] = json!([parent]);
    let scene = load(writer);
    let corner = scene.bounds.min - DVec3::new(1e7, -1e7, 1e7);
    // The file's numbers are float32; their sum in float64 is off by an ulp of 1e7, 2e-9
    assert!((corner - DVec3::new(0.0, -0.0005, 0.0)).length() < 1e-8, "{corner}");
}

#[test]
fn normals_go_by_the_inverse_transpose() {
    let mut writer = Writer::new();
    let material = writer.surface("white", [1.0; 3], 0.0, 1.0);
    let (scale, rotation) = (DVec3::new(3.0, -1.0, 0.2), DQuat::from_xyzw(0.48, 0.0, 0.36, 0.8));
    let node = json!({ "scale": scale.to_array(), "rotation": rotation.to_array() });
    writer.object("ball", &sphere(1.0, 48, 32), material, node);
    let scene = load(writer);
    for triangle in &scene.triangles {
        for (position, normal) in triangle.positions.iter().zip(triangle.normals) {
            // On the unit sphere the normal is the position
            let local = rotation.conjugate() * *position / scale;
            let expected = (rotation * (local / scale)).normalize_or_zero();
            // 1e-3: the shape's positions are rounded to 1.5e-5, which the scale stretches by up to 15
            assert!((normal.as_dvec3() - expected).length() < 1e-3, "{normal} {expected}");
        }
        let [p, q, r] = triangle.positions;
        assert!((q - p).cross(r - p).dot(triangle.normals[0].as_dvec3()) > 0.0);
    }
}

#[test]
fn missing_normals_are_flat_and_missing_coordinates_zero() {
    let mut shape = panel(1.0, 1.0);
    shape.normals.clear();
    shape.uvs.clear();
    let scene = load(emitter_with(&shape, json!({})));
    assert_eq!(scene.triangles[0].normals, [Vec3::Z; 3]);
    assert_eq!(scene.triangles[0].uvs, [Vec2::ZERO; 3]);
    // Normals of zero length count as missing
    let mut shape = panel(1.0, 1.0);
    shape.normals = vec![[0.0; 3]; 4];
    assert_eq!(load(emitter_with(&shape, json!({}))).triangles[0].normals, [Vec3::Z; 3]);
}

#[test]
fn degenerate_triangles_are_left_out() {
    let mut shape = panel(1.0, 1.0);
    shape.indices.extend([0, 0, 1]);
    assert_eq!(load(emitter_with(&shape, json!({}))).triangles.len(), 2);
}

#[test]
fn strips_and_fans_are_triangles_and_lines_are_not() {
    let mut strip = panel(1.0, 1.0);
    strip.indices = vec![0, 1, 3, 2];
    let mut fan = panel(1.0, 1.0);
    fan.indices = vec![0, 1, 2, 3];
    for (shape, mode) in [(strip, 5), (fan, 6)] {
        let mut writer = emitter_with(&shape, json!({}));
        writer.root["meshes"][0]["primitives"][0]["mode"] = json!(mode);
        let scene = load(writer);
        assert_eq!(scene.triangles.len(), 2);
        assert_eq!(scene.lights[0].shape.area_vector(), DVec3::Z, "mode {mode} keeps its orientation");
    }
    let mut writer = emitter_with(&panel(1.0, 1.0), json!({}));
    writer.root["meshes"][0]["primitives"][0]["mode"] = json!(1);
    let scene = load(writer);
    assert!(scene.triangles.is_empty() && scene.lights.is_empty());
    assert_eq!(warnings(&scene), ["meshes[0] 'lamp'.primitives[0]: Lines are not triangles: left out"]);
    // Both are said: there is nothing to light, and nothing to light it with
    assert_eq!(scene.warnings.iter().filter(|w| w.place == "scene").count(), 2);
    assert!(SceneBuffers::new(&scene, DVec3::ZERO).unwrap().triangles.is_empty());
}

#[test]
fn what_is_ignored_is_said() {
    let mut writer = panel_with(json!({}));
    let five = writer.indices(&[0, 1, 2, 0, 1]);
    writer.root["meshes"][0]["primitives"][0]["indices"] = json!(five);
    writer.root["skins"] = json!([{ "joints": [0] }]);
    writer.root["nodes"][0]["skin"] = json!(0);
    writer.root["extensionsUsed"] = json!(["EXT_lights_image_based"]);
    let expected = [
        "EXT_lights_image_based: light from all around is left out",
        "meshes[0] 'panel'.primitives[0]: 2 corners are no whole triangle: left out",
        "meshes[0] 'panel'.primitives[0]: has no JOINTS_0 and WEIGHTS_0: it is where its node is",
    ];
    assert_eq!(warnings(&load(writer)), expected);
}

#[test]
fn without_a_default_scene_the_first_or_everything_is_shown() {
    let mut writer = panel_with(json!({}));
    writer.root.as_object_mut().unwrap().remove("scene");
    let scene = load(writer);
    assert_eq!((scene.triangles.len(), scene.name.as_str()), (2, "test.glb"));
    assert!(scene.warnings.iter().any(|w| w.text == "there is no default scene: the first is shown"));

    let mut writer = panel_with(json!({}));
    writer.push("nodes", json!({ "children": [0], "translation": [1, 0, 0] }));
    let root = writer.root.as_object_mut().unwrap();
    root.remove("scene");
    root.remove("scenes");
    let scene = load(writer);
    assert_eq!(warnings(&scene), ["scenes: there is none: every node is shown"]);
    assert_eq!(scene.triangles.len(), 2, "a child is shown once, where its parent puts it");
    assert_eq!(scene.bounds.center(), DVec3::X);
}

#[test]
fn an_empty_file_is_a_scene() {
    let scene = Scene::from_bytes(br#"{"asset":{"version":"2.0"}}"#, "empty").unwrap();
    assert!(scene.triangles.is_empty() && scene.lights.is_empty() && scene.cameras.is_empty());
    assert!(scene.camera(None, 1.5).unwrap().position.is_finite());
    assert_eq!(scene.effects(), arealight::Effects::empty());
}

#[test]
fn cameras_look_along_minus_z() {
    let mut writer = panel_with(json!({}));
    writer.camera("front", [1.0, 2.0, 8.0], [1.0, 2.0, 0.0], 1.0, 1.5);
    let scene = load(writer);
    let camera = scene.camera(Some("front"), 1.0).unwrap();
    assert_eq!((camera.position, camera.forward), (DVec3::new(1.0, 2.0, 8.0), DVec3::NEG_Z));
    assert_eq!((camera.right, camera.up, camera.aspect), (DVec3::X, DVec3::Y, Some(1.5)));
    assert!((camera.half_height - 0.5_f64.tan()).abs() < 1e-7);
    assert_eq!(scene.camera(None, 1.0), Some(camera));
    assert_eq!(scene.camera(Some("back"), 1.0), None);
}

/// A panel, and an orthographic camera of this half width and half height.
fn orthographic(name: &str, eye: [f64; 3], target: [f64; 3], [x, y]: [f64; 2]) -> Writer {
    let mut writer = panel_with(json!({}));
    writer.camera(name, eye, target, 1.0, 1.0);
    writer.root["cameras"][0] = json!({ "type": "orthographic",
        "orthographic": { "xmag": x, "ymag": y, "znear": 0.0, "zfar": 100.0 } });
    writer
}

#[test]
fn orthographic_cameras_see_along_parallel_lines() {
    let mut writer = orthographic("side", [5.0, 0.0, 1.0], [0.0, 0.0, 1.0], [3.0, 1.5]);
    // A camera's scale does not matter
    writer.root["nodes"][1]["scale"] = json!([7, 7, 7]);
    let scene = load(writer);
    let camera = &scene.cameras[0];
    assert_eq!((camera.orthographic, camera.half_height, camera.aspect), (true, 1.5, Some(2.0)));
    let seen = |expected: [DVec3; 2], found: [DVec3; 2]| {
        expected.iter().zip(found).all(|(a, b)| a.distance(b) < 1e-5)
    };
    let corner = [DVec3::new(5.0, 1.5, -2.0), DVec3::NEG_X];
    assert!(seen(corner, camera.ray([1.0, 1.0], 2.0)), "{:?}", camera.ray([1.0, 1.0], 2.0));
    assert_eq!(warnings(&scene), [""; 0]);
    // The twin: a pinhole camera sees along others
    assert!(!seen(corner, camera.clone().pinhole(DVec3::ZERO).ray([1.0, 1.0], 2.0)));
}

#[test]
fn orthographic_cameras_without_a_size_are_left_out() {
    for size in [[0.0, 1.0], [1.0, 0.0], [1.0, -1.0], [1e16, 1.0], [1.0, 1e30]] {
        let scene = load(orthographic("bad", [0.0, 0.0, 1.0], [0.0; 3], size));
        assert!(scene.cameras.is_empty());
        assert_eq!(
            warnings(&scene),
            ["camera 'bad': xmag and ymag must be more than 0 and at most 1e15: left out"]
        );
    }
}

#[test]
fn cameras_that_cannot_be_are_left_out() {
    for (yfov, scale, text) in [
        (0.0, [1.0, 1.0, 1.0], "yfov must be between 0 and pi: left out"),
        (3.2, [1.0, 1.0, 1.0], "yfov must be between 0 and pi: left out"),
        (1.0, [1.0, 1.0, 0.0], "its node's scale is zero: left out"),
    ] {
        let mut writer = panel_with(json!({}));
        writer.camera("bad", [0.0, 0.0, 1.0], [0.0; 3], yfov, 1.0);
        writer.root["nodes"][1]["scale"] = json!(scale);
        let scene = load(writer);
        assert!(scene.cameras.is_empty());
        assert_eq!(warnings(&scene), [format!("camera 'bad': {text}")]);
    }
}

#[test]
fn gltf_files_read_the_files_beside_them() {
    let folder = tempfile::tempdir().unwrap();
    let mut writer = emitter_with(&panel(1.0, 1.0), json!({}));
    std::fs::write(folder.path().join("my mesh.bin"), &writer.buffer).unwrap();
    writer.root["buffers"] = json!([{ "uri": "my%20mesh.bin", "byteLength": writer.buffer.len() }]);
    writer.root["scenes"][0]["name"] = json!("main scene");
    let path = folder.path().join("scene.gltf");
    std::fs::write(&path, writer.root.to_string()).unwrap();
    let scene = Scene::load(&path).unwrap();
    assert_eq!((scene.lights.len(), scene.name.as_str()), (1, "main scene"));
    // From memory there are no files
    let error = Scene::from_bytes(writer.root.to_string().as_bytes(), "scene").unwrap_err();
    assert!(error.to_string().contains("a scene from memory has no files"), "{error}");
    // A file that is not there, or must not be
    std::fs::remove_file(folder.path().join("my mesh.bin")).unwrap();
    let error = Scene::load(&path).unwrap_err().to_string();
    assert!(error.contains("buffers[0]: cannot read 'my%20mesh.bin'"), "{error}");
    for uri in ["/dev/zero", "file:///dev/zero", "https://example.org/a.bin", "."] {
        writer.root["buffers"][0]["uri"] = json!(uri);
        std::fs::write(&path, writer.root.to_string()).unwrap();
        let error = Scene::load(&path).unwrap_err().to_string();
        assert!(error.contains(&format!("cannot read '{uri}'")), "{error}");
    }
}

#[test]
fn buffers_may_be_data_uris() {
    let mut writer = emitter_with(&panel(1.0, 1.0), json!({}));
    let uri = format!("data:application/octet-stream;base64,{}", base64(&writer.buffer));
    writer.root["buffers"] = json!([{ "uri": uri, "byteLength": writer.buffer.len() }]);
    let scene = Scene::from_bytes(writer.root.to_string().as_bytes(), "data").unwrap();
    assert_eq!(scene.lights[0].shape.vertices().len(), 4);
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let encode = |chunk: &[u8]| {
        let word =
            chunk.iter().fold(0_u32, |word, byte| word << 8 | u32::from(*byte)) << (8 * (3 - chunk.len()));
        (0..4)
            .map(|i| {
                let digit = DIGITS[(word >> (18 - 6 * i)) as usize & 63];
                if i <= chunk.len() { char::from(digit) } else { '=' }
            })
            .collect::<String>()
    };
    bytes.chunks(3).map(encode).collect()
}

#[test]
fn sparse_accessors_are_filled_in() {
    // Zeros but for three vertices
    let mut writer = emitter_with(&panel(1.0, 1.0), json!({}));
    let places = writer.view(&[1_u8, 2, 3]);
    let values: Vec<u8> = [[2.0_f32, 0.0, 0.0], [2.0, 3.0, 0.0], [0.0, 3.0, 0.0]]
        .iter()
        .flatten()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    let values = writer.view(&values);
    writer.root["accessors"][0] = json!({ "componentType": 5126, "count": 4, "type": "VEC3",
        "min": [0, 0, 0], "max": [2, 3, 0],
        "sparse": { "count": 3, "indices": { "bufferView": places, "componentType": 5121 },
                    "values": { "bufferView": values } } });
    assert_eq!(load(writer).lights[0].shape.area_vector(), DVec3::Z * 6.0);
}

#[test]
fn strides_and_normalised_coordinates_are_read() {
    let mut writer = emitter_with(&floor(1.0, 1.0, 1.0), json!({}));
    // Positions 20 bytes apart, with 16-bit texture coordinates between them
    let corners = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let bytes: Vec<u8> = corners
        .iter()
        .enumerate()
        .flat_map(|(i, corner)| {
            let mut vertex: Vec<u8> = corner.iter().flat_map(|x| x.to_le_bytes()).collect();
            vertex.extend([65535_u16, 13107 * i as u16, 0, 0].iter().flat_map(|x| x.to_le_bytes()));
            vertex
        })
        .collect();
    let view = writer.view(&bytes);
    writer.root["bufferViews"][view]["byteStride"] = json!(20);
    writer.root["accessors"][0]["bufferView"] = json!(view);
    writer.root["accessors"][2] = json!({ "bufferView": view, "byteOffset": 12, "componentType": 5123,
        "normalized": true, "count": 4, "type": "VEC2" });
    let scene = load(writer);
    assert_eq!(scene.lights[0].shape.area_vector(), DVec3::Z);
    assert_eq!(scene.triangles[0].uvs, [Vec2::new(1.0, 0.0), Vec2::new(1.0, 0.2), Vec2::new(1.0, 0.4)]);
}
