//! Extensions that a file uses or requires: read, left out with a warning, or refused by name.

use crate::shapes::panel;
use crate::writer::{Writer, png};
use crate::{emitter_with, error, load, panel_with, warnings};
use arealight::Effects;
use arealight_scene::{Scene, SceneBuffers, SceneMaterial, Warning};
use arealight_tool_kernels::gpu::GpuMaterial;
use glam::{DVec3, Vec3};
use serde_json::{Value, json};

fn requiring(names: &[&str]) -> Writer {
    let mut writer = panel_with(json!({}));
    writer.root["extensionsRequired"] = json!(names);
    writer.root["extensionsUsed"] = json!(names);
    writer
}

#[test]
fn what_costs_looks_alone_is_a_warning_also_where_it_is_required() {
    let mut writer = requiring(&["KHR_audio_emitter", "KHR_materials_variants", "KHR_materials_dispersion"]);
    writer.root["materials"][0]["extensions"] = json!({ "KHR_materials_dispersion": {} });
    let expected = [
        "KHR_audio_emitter: is not supported: ignored",
        "KHR_materials_variants: the default materials are shown",
        "material '#0': KHR_materials_dispersion is not supported: ignored",
    ];
    assert_eq!(warnings(&load(writer)), expected);
    // The twin: what the shape of things depends on is refused
    for name in ["KHR_texture_basisu", "ACME_surfaces"] {
        let expected =
            format!("test.glb: extensionsRequired: {name} is not supported; export the scene without it");
        assert_eq!(error(requiring(&[name])), expected);
    }
}

#[test]
fn what_is_read_may_be_required() {
    let writer = requiring(&["KHR_texture_transform", "KHR_mesh_quantization", "KHR_node_visibility"]);
    assert_eq!(warnings(&load(writer)), [""; 0]);
}

#[test]
fn unknown_extensions_are_said_once_each() {
    let mut writer = panel_with(json!({}));
    writer.root["extensions"] = json!({ "ACME_weather": {} });
    writer.root["nodes"][0]["extensions"] = json!({ "ACME_sound": {} });
    writer.node(json!({ "extensions": { "ACME_sound": {} } }));
    let expected = ["ACME_sound: is not supported: ignored", "ACME_weather: is not supported: ignored"];
    assert_eq!(warnings(&load(writer)), expected);
}

#[test]
fn data_that_are_only_in_an_extension_are_refused_by_its_name() {
    let mut writer = panel_with(json!({}));
    writer.root["textures"] = json!([{ "extensions": { "KHR_texture_basisu": { "source": 0 } } }]);
    let error = error(writer);
    let text = "textures[0]: is only there in KHR_texture_basisu, which is not supported; export the scene \
    without it";
    assert!(error.contains(text), "{error}");
}

#[test]
fn textures_with_another_image_are_shown_by_that() {
    let mut writer = panel_with(json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }));
    writer.picture("png", &image::RgbImage::from_pixel(2, 3, image::Rgb([9, 80, 200])));
    writer.use_extension("KHR_texture_basisu");
    writer.root["textures"][0]["extensions"] = json!({ "KHR_texture_basisu": { "source": 7 } });
    let scene = load(writer);
    assert_eq!((scene.images.len(), scene.images[0].height), (1, 3));
    let text = "KHR_texture_basisu: is not supported: the textures' other images are shown";
    assert_eq!(warnings(&scene), [text]);
}

#[test]
fn textures_may_be_webp_alone() {
    let mut bytes = Vec::new();
    let picture = image::RgbImage::from_pixel(2, 3, image::Rgb([9, 80, 200]));
    image::codecs::webp::WebPEncoder::new_lossless(&mut bytes)
        .encode(&picture, 2, 3, image::ExtendedColorType::Rgb8)
        .unwrap();
    let mut writer = panel_with(json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }));
    writer.texture("webp", &bytes);
    writer.root["textures"] = json!([{ "extensions": { "EXT_texture_webp": { "source": 0 } } }]);
    let scene = load(writer);
    let image = &scene.images[0];
    assert_eq!((image.width, image.height, image.texels[5].to_le_bytes()), (2, 3, [9, 80, 200, 255]));
    assert_eq!(warnings(&scene), [""; 0]);
}

#[test]
fn hidden_nodes_and_what_is_below_them_are_left_out() {
    let mut writer = emitter_with(&panel(1.0, 1.0), json!({}));
    writer.root["scenes"][0]["nodes"] = json!([1]);
    let parent = |visible: bool| {
        let visibility = json!({ "visible": visible });
        json!({ "children": [0], "extensions": { "KHR_node_visibility": visibility } })
    };
    writer.push("nodes", parent(false));
    let bytes =
        |root: &Value, writer: &Writer| Writer { root: root.clone(), buffer: writer.buffer.clone() }.glb();
    let scene = Scene::from_bytes(&bytes(&writer.root, &writer), "hidden").unwrap();
    assert_eq!((scene.lights.len(), scene.triangles.len(), scene.notes.len()), (0, 0, 1));
    assert!(scene.notes[0].text.contains("hidden nodes, and what is below them, are left out"));
    writer.root["nodes"][1] = parent(true);
    let scene = load(writer);
    assert_eq!((scene.lights.len(), scene.notes.len()), (1, 0));
}

#[test]
fn scenes_may_be_without_nodes() {
    let scene = Scene::from_bytes(br#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"name":"bare"}]}"#, "");
    let scene = scene.unwrap();
    assert_eq!((scene.name.as_str(), scene.triangles.len()), ("bare", 0));
}

#[test]
fn quantized_meshes_are_read() {
    // A square of bytes as they are, normals of normalised bytes, coordinates of 16 bits with a sign
    let mut writer = emitter_with(&panel(1.0, 1.0), json!({ "scale": [0.01, 0.01, 0.01] }));
    let positions: Vec<u8> = [[-100_i8, 0, 0], [100, 0, 0], [100, 50, 0], [-100, 50, 0]]
        .iter()
        .flatten()
        .map(|x| *x as u8)
        .collect();
    let normals: Vec<u8> = [[0_i8, 0, 127]; 4].iter().flatten().map(|x| *x as u8).collect();
    let uvs: Vec<u8> = [[0_i16, -32768], [32767, 0], [16384, 0], [0, 0]]
        .iter()
        .flatten()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    for (accessor, bytes, component, kind, normalized) in
        [(0, positions, 5120, "VEC3", false), (1, normals, 5120, "VEC3", true), (2, uvs, 5122, "VEC2", true)]
    {
        let view = writer.view(&bytes);
        writer.root["accessors"][accessor] = json!({ "bufferView": view, "componentType": component,
            "count": 4, "type": kind, "normalized": normalized });
    }
    writer.root["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let scene = load(writer);
    assert!((scene.lights[0].shape.area_vector() - DVec3::Z).length() < 1e-7);
    assert_eq!(scene.triangles[0].normals[0], Vec3::Z);
    let uvs: Vec<_> = scene.triangles.iter().flat_map(|triangle| triangle.uvs).collect();
    let lowest = uvs.iter().fold(0.0_f32, |lowest, uv| lowest.min(uv.y));
    assert_eq!(lowest, -1.0, "the lowest number is -1, not less");
    assert!(uvs.iter().any(|uv| uv.x == 1.0));
}

#[test]
fn warnings_of_one_kind_are_one_line() {
    let warning = |place: &str, text: &str| Warning { place: place.into(), text: text.into() };
    let all =
        [warning("a", "is odd"), warning("b", "is even"), warning("c", "is odd"), warning("d", "is odd")];
    assert_eq!(Warning::grouped(&all), ["a and 2 more: is odd", "b: is even"]);
}

/// Coordinates of a panel's upper left corner, (-1, 0.5) in the file, and of the lower right one, (1, -0.5).
fn corners_of(info: &Value) -> [[f32; 2]; 2] {
    let mut writer = panel_with(json!({ "pbrMetallicRoughness": { "baseColorTexture": info } }));
    let second = writer.floats(&[[0.5_f32, 0.25]; 4]);
    writer.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = json!(second);
    writer.texture("picture", &png(image::RgbImage::new(2, 2)));
    let scene = load(writer);
    assert_eq!(warnings(&scene), [""; 0]);
    let at = |x: f32, y: f32| {
        let mut corners = scene.triangles.iter().flat_map(|t| t.positions.iter().zip(t.uvs));
        let corner = corners.find(|(p, _)| p.x as f32 == x && p.y as f32 == y).unwrap();
        corner.1.to_array().map(|x| (x * 1e5).round() / 1e5)
    };
    [at(-1.0, 0.5), at(1.0, -0.5)]
}

#[test]
fn textures_are_scaled_turned_and_moved() {
    let transform =
        |values: Value| corners_of(&json!({ "index": 0, "extensions": { "KHR_texture_transform": values } }));
    // The twin: as they are
    assert_eq!(corners_of(&json!({ "index": 0 })), [[-1.0, 0.5], [1.0, -0.5]]);
    let moved = json!({ "offset": [0.25, 0.5], "scale": [2, 3] });
    assert_eq!(transform(moved), [[-1.75, 2.0], [2.25, -1.0]]);
    // A quarter turn takes (u, v) to (v, -u): after the scale, before the offset
    let turned = json!({ "offset": [0, 1], "rotation": std::f64::consts::FRAC_PI_2, "scale": [2, 3] });
    assert_eq!(transform(turned), [[1.5, 3.0], [-1.5, -1.0]]);
    // Other coordinates
    assert_eq!(corners_of(&json!({ "index": 0, "texCoord": 1 })), [[0.5, 0.25]; 2]);
    assert_eq!(transform(json!({ "texCoord": 1, "scale": [2, 2] })), [[1.0, 0.5]; 2]);
}

/// A source whose texts go on in the next line, each text in one.
fn one_line(source: &str) -> String {
    source.split("\\\n").map(str::trim_start).collect()
}

/// The rows of docs/gltf.md whose words no source of the program has or their test does not expect, or that
/// say nothing of what is lost.
fn wrong_rows(document: &str) -> Vec<String> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let sources = std::fs::read_dir(folder.join("src")).unwrap();
    let program: String =
        sources.map(|file| one_line(&std::fs::read_to_string(file.unwrap().path()).unwrap())).collect();
    let rows = document.lines().filter(|line| line.starts_with("| ")).skip(1);
    let is_wrong = |row: &&str| {
        let columns: Vec<&str> = row.split('|').map(str::trim).collect();
        let [_, _, result, words, test, _] = columns[..] else { return true };
        let is_silent = words.is_empty() && !result.starts_with("handled");
        is_silent
            || !program.contains(words.trim_matches('`'))
            || !std::fs::read_to_string(folder.join("tests/scene").join(test))
                .is_ok_and(|test| one_line(&test).contains(words.trim_matches('`')))
    };
    rows.filter(is_wrong).map(str::to_owned).collect()
}

#[test]
fn the_document_has_the_programs_words() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/gltf.md");
    assert_eq!(wrong_rows(&std::fs::read_to_string(path).unwrap()), [""; 0]);
    // The twin: other words, a test that is not there, one that does not expect them, and silence
    let head = "| a | b | c | d |\n";
    let bad = [
        "| x | warned | `is a pity` | lights.rs |",
        "| x | handled | | nowhere.rs |",
        "| x | warned | `are not triangles: left out` | lights.rs |",
        "| x | warned | | lights.rs |",
    ];
    assert_eq!(wrong_rows(&format!("{head}{}", bad.join("\n"))), bad);
}

#[test]
fn unlit_materials_are_their_base_color_and_light_nothing() {
    let fields = |extensions: Value| {
        json!({ "emissiveFactor": [1, 1, 1], "doubleSided": true, "extensions": extensions,
            "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.25, 0.125, 1], "metallicFactor": 0 } })
    };
    let scene = load(panel_with(fields(json!({ "KHR_materials_unlit": {} }))));
    let SceneMaterial { material, emission, unlit, double_sided, .. } = &scene.materials[0];
    assert_eq!(material.base_color, Vec3::new(0.5, 0.25, 0.125));
    assert_eq!(
        (*emission, material.dielectric_f0, *unlit, *double_sided),
        (Vec3::ZERO, Vec3::ZERO, true, true)
    );
    assert!(scene.lights.is_empty());
    assert_eq!(scene.effects(), Effects::empty());
    // Beside what reflects it has to say that it doesn't
    let mut beside = scene.clone();
    beside.materials.push(SceneMaterial::default());
    assert!(beside.effects().contains(Effects::GLOSSY | Effects::SPECULAR_INPUT));
    let gpu = SceneBuffers::new(&scene, DVec3::ZERO).unwrap().materials[0];
    assert_eq!(gpu.flags, GpuMaterial::UNLIT | GpuMaterial::DOUBLE_SIDED);
    // The twin: without the extension it is a light, and has lobes
    let lit = load(panel_with(fields(json!({}))));
    assert!(!lit.lights.is_empty() && lit.effects().contains(Effects::DIFFUSE));
}
