//! `EXT_meshopt_compression`: what was compressed is what was not, but for what its filters round.

use crate::writer::{Writer, container};
use crate::{shapes, warnings};
use arealight_scene::Scene;
use glam::{DQuat, DVec3};
use meshopt::{
    EncodeExpMode, encode_filter_color, encode_filter_exp, encode_filter_oct, encode_filter_quat,
    encode_index_buffer, encode_index_sequence, encode_vertex_buffer, encode_vertex_buffer_level,
};
use serde_json::{Value, json};

const NAME: &str = "EXT_meshopt_compression";
const TURN: DQuat = DQuat::from_xyzw(0.48, -0.6, 0.0, 0.64);

/// A file whose second buffer is not there: its views are compressed in the first.
struct File {
    root: Value,
    buffer: Vec<u8>,
    missing: usize,
}

impl File {
    /// Compressed elements, and an accessor of them.
    fn compressed(
        &mut self,
        encoded: &[u8],
        (stride, count): (usize, usize),
        how: &Value,
        mut accessor: Value,
    ) -> usize {
        let mut extension = json!({ "buffer": 0, "byteOffset": self.buffer.len(), "byteLength": encoded.len(),
            "byteStride": stride, "count": count });
        extension.as_object_mut().unwrap().extend(how.as_object().unwrap().clone());
        let mut view = json!({ "buffer": 1, "byteOffset": self.missing, "byteLength": stride * count,
            "extensions": { NAME: extension } });
        if accessor["type"] != "SCALAR" {
            view["byteStride"] = json!(stride);
        }
        self.buffer.extend(encoded);
        self.buffer.resize(self.buffer.len().next_multiple_of(4), 0);
        self.missing += stride * count;
        let views = self.root["bufferViews"].as_array_mut().unwrap();
        views.push(view);
        accessor["bufferView"] = json!(views.len() - 1);
        accessor["count"] = json!(count);
        let accessors = self.root["accessors"].as_array_mut().unwrap();
        accessors.push(accessor);
        accessors.len() - 1
    }

    fn vertices<T>(&mut self, vertices: &[T], filter: &str, accessor: Value) -> usize {
        let how = json!({ "mode": "ATTRIBUTES", "filter": filter });
        let encoded = encode_vertex_buffer(vertices).unwrap();
        self.compressed(&encoded, (size_of::<T>(), vertices.len()), &how, accessor)
    }

    fn glb(&self) -> Vec<u8> {
        let mut root = self.root.clone();
        root["buffers"] = json!([{ "byteLength": self.buffer.len() },
            { "byteLength": self.missing, "extensions": { NAME: { "fallback": true } } }]);
        let mut text = serde_json::to_vec(&root).unwrap();
        text.resize(text.len().next_multiple_of(4), b' ');
        container(&text, &self.buffer)
    }
}

/// A sphere with a colour for each vertex, on an instance that is turned: plain.
fn plain() -> Writer {
    let shape = shapes::sphere(1.5, 16, 8);
    let mut writer = Writer::new();
    let material = writer.push("materials", json!({}));
    writer.object("ball", &shape, material, json!({}));
    let colors: Vec<[f32; 4]> = shape.uvs.iter().map(|[u, v]| [*u, *v, 0.5, 1.0]).collect();
    let colors = writer.floats(&colors);
    writer.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
    let rotation = writer.floats(&[TURN.as_quat().to_array()]);
    writer.root["nodes"][0]["extensions"] =
        json!({ "EXT_mesh_gpu_instancing": { "attributes": { "ROTATION": rotation } } });
    writer
}

/// The same with each attribute by a filter, and indices of as many bytes, as triangles or as a sequence.
fn compressed(index_size: usize, mode: &str) -> File {
    let shape = shapes::sphere(1.5, 16, 8);
    let mut root = plain().root;
    (root["bufferViews"], root["accessors"]) = (json!([]), json!([]));
    root["extensionsRequired"] = json!([NAME, "KHR_mesh_quantization"]);
    let mut file = File { root, buffer: vec![], missing: 0 };
    let accessor = |component: u32, shape: &str, normalized: bool| {
        json!({
            "componentType": component, "type": shape, "normalized": normalized
        })
    };
    let positions = encode_filter_exp(&shape.positions, 16, EncodeExpMode::SharedVector);
    let position = file.vertices(&positions, "EXPONENTIAL", accessor(5126, "VEC3", false));
    let normals: Vec<[f32; 4]> = shape.normals.iter().map(|[x, y, z]| [*x, *y, *z, 0.0]).collect();
    let normal = if index_size == 2 {
        file.vertices(&encode_filter_oct::<i8>(&normals, 8), "OCTAHEDRAL", accessor(5120, "VEC3", true))
    } else {
        file.vertices(&encode_filter_oct::<i16>(&normals, 12), "OCTAHEDRAL", accessor(5122, "VEC3", true))
    };
    let uv = file.vertices(&shape.uvs, "NONE", accessor(5126, "VEC2", false));
    let colors: Vec<[f32; 4]> = shape.uvs.iter().map(|[u, v]| [*u, *v, 0.5, 1.0]).collect();
    let color = file.vertices(&encode_filter_color::<u8>(&colors, 8), "COLOR", accessor(5121, "VEC4", true));
    let turn = encode_filter_quat(&[TURN.as_quat().to_array()], 16);
    let rotation = file.vertices(&turn, "QUATERNION", accessor(5122, "VEC4", true));
    let encoded = match mode {
        "TRIANGLES" => encode_index_buffer(&shape.indices, shape.positions.len()).unwrap(),
        _ => encode_index_sequence(&shape.indices, shape.positions.len()).unwrap(),
    };
    let component = if index_size == 2 { 5123 } else { 5125 };
    let size = (index_size, shape.indices.len());
    let indices =
        file.compressed(&encoded, size, &json!({ "mode": mode }), accessor(component, "SCALAR", false));
    let primitive = &mut file.root["meshes"][0]["primitives"][0];
    primitive["attributes"] =
        json!({ "POSITION": position, "NORMAL": normal, "TEXCOORD_0": uv, "COLOR_0": color });
    primitive["indices"] = json!(indices);
    file.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] =
        json!(rotation);
    file
}

/// The largest differences of positions, normals, coordinates and colours between corners. The encoder begins
/// a triangle with any corner.
fn differences(a: &Scene, b: &Scene) -> [f64; 4] {
    assert_eq!(a.triangles.len(), b.triangles.len());
    let mut worst = [0.0_f64; 4];
    for (a, b) in a.triangles.iter().zip(&b.triangles) {
        let turn =
            (0..3).min_by_key(|turn| (a.positions[0].distance(b.positions[*turn]) * 1e9) as u64).unwrap();
        for (i, j) in (0..3).map(|i| (i, (i + turn) % 3)) {
            // Linear: they are held as square roots
            let color = |[red, green, blue, _]: [u8; 4]| {
                DVec3::from([red, green, blue].map(|part| (f64::from(part) / 255.0).powi(2)))
            };
            let apart = [
                a.positions[i].distance(b.positions[j]),
                a.normals[i].distance(b.normals[j]).into(),
                a.uvs[i].distance(b.uvs[j]).into(),
                color(a.colors[i]).distance(color(b.colors[j])),
            ];
            worst = std::array::from_fn(|k| worst[k].max(apart[k]));
        }
    }
    worst
}

#[test]
fn compressed_views_are_what_they_were() {
    let plain = crate::load(plain());
    for (index_size, mode) in [(2, "TRIANGLES"), (4, "TRIANGLES"), (2, "INDICES"), (4, "INDICES")] {
        let file = compressed(index_size, mode);
        let scene = Scene::from_bytes(&file.glb(), "test.glb").unwrap();
        let worst = differences(&scene, &plain);
        println!("{mode} of {index_size} bytes: {worst:?}");
        // 15 bits of 1.5 and a quaternion of 16; an octahedron of 8 bits; nothing; 8 bits of each of three
        // mixed colours
        let bounds = [2e-4, 0.02, 1e-9, 0.03];
        assert!(
            worst.iter().zip(bounds).all(|(worst, bound)| *worst < bound),
            "{mode} {index_size}: {worst:?}"
        );
        assert_eq!(warnings(&scene), [""; 0]);
        // The twin: each filter left out
        for view in [0, 1, 3, 4] {
            let mut file = compressed(index_size, mode);
            file.root["bufferViews"][view]["extensions"][NAME]["filter"] = json!("NONE");
            let scene = Scene::from_bytes(&file.glb(), "test.glb");
            let is_wrong = scene.is_err() || {
                let worst = differences(&scene.unwrap(), &plain);
                worst.iter().zip(bounds).any(|(worst, bound)| *worst > bound)
            };
            assert!(is_wrong, "view {view} of {mode}");
        }
    }
}

#[test]
fn the_other_name_is_the_same() {
    let bytes = compressed(2, "TRIANGLES").glb();
    let text = String::from_utf8_lossy(&bytes).matches(NAME).count();
    // Of as many letters
    let other: Vec<u8> = "KHR_meshopt_compression".into();
    let mut renamed = bytes.clone();
    for at in 0..bytes.len() - NAME.len() {
        if bytes[at..].starts_with(NAME.as_bytes()) {
            renamed[at..at + other.len()].copy_from_slice(&other);
        }
    }
    let [scene, renamed] = [bytes, renamed].map(|bytes| Scene::from_bytes(&bytes, "test.glb").unwrap());
    assert_eq!((text, &scene.triangles), (8, &renamed.triangles));
}

#[test]
fn data_beside_the_compressed_ones_are_read() {
    let mut writer = plain();
    writer.root["bufferViews"][0]["extensions"] = json!({ NAME: {} });
    assert_eq!(crate::load(writer).triangles, crate::load(plain()).triangles);
}

#[test]
fn what_cannot_be_decompressed_is_named() {
    type Change = (fn(&mut Value), &'static str);
    let changes: [Change; 9] = [
        (|said| drop(said.as_object_mut().unwrap().remove("byteStride")), "missing field `byteStride`"),
        (|said| said["mode"] = json!("POINTS"), "unknown variant `POINTS`"),
        (|said| said["buffer"] = json!(7), "its buffer does not exist"),
        (|said| said["byteLength"] = json!(1_u64 << 40), "reach beyond the buffer's"),
        (|said| said["byteLength"] = json!(3), "cannot be decoded: "),
        (|said| said["count"] = json!(u64::MAX), "and its view of"),
        (|said| said["filter"] = json!("OCTAHEDRAL"), "of 12 bytes with the filter Octahedral cannot be"),
        (
            |said| said["mode"] = json!("INDICES"),
            "Indices of 153 elements of 12 bytes with the filter Exponential",
        ),
        (|said| (said["byteStride"], said["count"]) = (json!(1), json!(153 * 12)), "1 bytes are no vertex"),
    ];
    for (change, text) in changes {
        let mut file = compressed(2, "TRIANGLES");
        change(&mut file.root["bufferViews"][0]["extensions"][NAME]);
        let error = Scene::from_bytes(&file.glb(), "test.glb").unwrap_err().to_string();
        assert!(error.contains(text) && error.contains("bufferViews[0].extensions"), "{error}");
    }
    // Triangles have three corners each
    let mut file = compressed(2, "TRIANGLES");
    let view = &mut file.root["bufferViews"][5];
    let count = view["extensions"][NAME]["count"].as_u64().unwrap() - 1;
    (view["extensions"][NAME]["count"], view["byteLength"]) = (json!(count), json!(2 * count));
    let error = Scene::from_bytes(&file.glb(), "test.glb").unwrap_err().to_string();
    assert!(error.contains("Triangles of 767 elements"), "{error}");
}

#[test]
fn vertices_that_are_all_alike_are_read_and_no_more_than_their_bytes_can_become() {
    let alike = |count: usize, said: usize| {
        let mut file = compressed(2, "TRIANGLES");
        let encoded = encode_vertex_buffer_level(&vec![[0_u32; 4]; count], 3, Some(1)).unwrap();
        let how = json!({ "mode": "ATTRIBUTES" });
        let accessor = json!({ "componentType": 5126, "type": "VEC4" });
        file.compressed(&encoded, (16, said), &how, accessor);
        (encoded.len(), Scene::from_bytes(&file.glb(), "test.glb").map_err(|error| error.to_string()))
    };
    let (bytes, scene) = alike(1 << 20, 1 << 20);
    assert!(scene.is_ok() && 16 << 20 > 900 * bytes, "{bytes} bytes: {scene:?}");
    let (bytes, scene) = alike(1 << 20, 1 << 25);
    assert!(scene.unwrap_err().contains(&format!("which {bytes} bytes cannot become")));
}

#[test]
fn a_file_is_decoded_to_no_more_than_it_may_take() {
    let mut file = compressed(2, "TRIANGLES");
    let view = &mut file.root["bufferViews"][0];
    let (count, length) = (1_u64 << 28, 1_u64 << 32);
    (view["extensions"][NAME]["count"], view["byteLength"]) = (json!(count), json!(12 * count));
    view["extensions"][NAME]["byteLength"] = json!(length);
    let error = Scene::from_bytes(&file.glb(), "test.glb").unwrap_err().to_string();
    assert!(error.contains("takes 3221225472 bytes of memory"), "{error}");
}

#[test]
fn no_byte_of_a_compressed_view_makes_a_panic() {
    for mode in ["TRIANGLES", "INDICES"] {
        let file = compressed(2, mode);
        let mut refused = 0;
        for index in 0..file.buffer.len() {
            for value in [0, 0xff, file.buffer[index] ^ 0x10] {
                let mut changed = File { root: file.root.clone(), buffer: file.buffer.clone(), ..file };
                changed.buffer[index] = value;
                refused += usize::from(Scene::from_bytes(&changed.glb(), "test.glb").is_err());
            }
        }
        assert!(refused > 10, "{refused} of {}", 3 * file.buffer.len());
    }
}
