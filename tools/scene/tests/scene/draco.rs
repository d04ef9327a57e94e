//! `KHR_draco_mesh_compression`: what was compressed is what was not, but for the quantisation.

use crate::writer::{Shape, Writer};
use crate::{load, panel_with, shapes, warnings};
use arealight_scene::{Scene, Triangle};
use draco_core::{
    DataType, EncoderBuffer, EncoderOptions, FaceIndex, GeometryAttributeType, Mesh, MeshEncoder,
    PointAttribute,
};
use glam::{DVec3, Vec3};
use serde_json::{Value, json};

fn attribute<const N: usize>(kind: GeometryAttributeType, vectors: &[[f32; N]]) -> PointAttribute {
    let mut attribute = PointAttribute::new();
    attribute.init(kind, N as u8, DataType::Float32, false, vectors.len());
    let values: Vec<f32> = vectors.iter().flatten().copied().collect();
    attribute.buffer_mut().update_f32s_le(0, &values);
    attribute
}

/// A shape in Draco's form, with the ids of its positions, normals and texture coordinates.
fn compressed(shape: &Shape, level: i32) -> (Vec<u8>, [u32; 3]) {
    let mut mesh = Mesh::new();
    let ids = [
        mesh.add_attribute(attribute(GeometryAttributeType::Position, &shape.positions)),
        mesh.add_attribute(attribute(GeometryAttributeType::Normal, &shape.normals)),
        mesh.add_attribute(attribute(GeometryAttributeType::TexCoord, &shape.uvs)),
    ];
    let unique = ids.map(|id| mesh.attribute(id).unique_id());
    mesh.set_num_faces(shape.indices.len() / 3);
    for (face, corners) in (0..).zip(shape.indices.chunks_exact(3)) {
        mesh.set_face(FaceIndex(face), [corners[0].into(), corners[1].into(), corners[2].into()]);
    }
    let mut options = EncoderOptions::new();
    options.set_compression_level(level);
    for (id, bits) in ids.into_iter().zip([14, 10, 12]) {
        options.set_attribute_quantization(id, bits);
    }
    let mut encoder = MeshEncoder::new();
    encoder.set_mesh(mesh);
    let mut out = EncoderBuffer::new();
    encoder.encode(&options, &mut out).unwrap();
    (out.data().to_vec(), unique)
}

/// A sphere on a node, as it is or as [`KHR_draco_mesh_compression`] alone has it.
fn file(level: Option<i32>) -> Writer {
    let shape = shapes::sphere(1.5, 16, 8);
    let mut writer = Writer::new();
    let material = writer.push("materials", json!({}));
    writer.object("ball", &shape, material, json!({}));
    if let Some(level) = level {
        let (bytes, [position, normal, uv]) = compressed(&shape, level);
        let view = writer.view(&bytes);
        writer.root["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
        let primitive = &mut writer.root["meshes"][0]["primitives"][0];
        primitive["extensions"] = json!({ "KHR_draco_mesh_compression": {
            "bufferView": view, "attributes": { "POSITION": position, "NORMAL": normal,
                "TEXCOORD_0": uv } } });
        let accessors = writer.root["accessors"].as_array_mut().unwrap();
        for accessor in accessors {
            accessor.as_object_mut().unwrap().remove("bufferView");
        }
    }
    writer
}

/// Corners in an order of their own: Draco has others.
fn corners(triangles: &[Triangle]) -> Vec<Vec3> {
    let mut corners: Vec<Vec3> =
        triangles.iter().flat_map(|triangle| triangle.positions).map(DVec3::as_vec3).collect();
    let rounded = |v: &Vec3| (*v * 500.0).round().to_array().map(|x| x as i32);
    corners.sort_by_key(rounded);
    corners
}

#[test]
fn compressed_meshes_are_what_they_were() {
    let plain = load(file(None));
    let expected = corners(&plain.triangles);
    // Sequential, and by edges of two kinds
    for level in [0, 3, 7, 10] {
        let scene = load(file(Some(level)));
        assert_eq!(scene.triangles.len(), plain.triangles.len(), "level {level}");
        let found = corners(&scene.triangles);
        let worst = found.iter().zip(&expected).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        // 14 bits of a box of 3
        assert!(worst < 3.0 / 16384.0, "level {level}: {worst}");
        assert_eq!(warnings(&scene), [""; 0]);
        // Outside is outside, and normals and coordinates are those of the place
        for triangle in &scene.triangles {
            for (position, normal) in triangle.positions.iter().zip(triangle.normals) {
                assert!(position.as_vec3().normalize_or_zero().dot(normal) > 0.999, "{position} {normal}");
            }
            assert!(
                triangle
                    .uvs
                    .iter()
                    .all(|uv| (uv.clamp(glam::Vec2::ZERO, glam::Vec2::ONE) - *uv).length() < 1e-3)
            );
        }
    }
    // The twin: a coarser one is not
    let coarse = shapes::sphere(1.5, 15, 8);
    assert_ne!(coarse.indices.len() / 3, plain.triangles.len());
}

fn error(change: impl Fn(&mut Value)) -> String {
    let mut writer = file(Some(7));
    change(&mut writer.root);
    Scene::from_bytes(&writer.glb(), "test.glb").unwrap_err().to_string()
}

#[test]
fn what_cannot_be_decompressed_is_named() {
    type Change = (fn(&mut Value), &'static str);
    fn extension(root: &mut Value) -> &mut Value {
        &mut root["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]
    }
    let place = "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression";
    let changes: [Change; 6] = [
        (|root| drop(extension(root).as_object_mut().unwrap().remove("bufferView")), "has no bufferView"),
        (|root| extension(root)["bufferView"] = json!(99), "bufferViews[99]: does not exist"),
        (|root| extension(root)["bufferView"] = json!(-1), "has no bufferView"),
        (
            |root| extension(root)["attributes"]["NORMAL"] = json!(77),
            "attributes.NORMAL: Draco has no attribute 77",
        ),
        (
            |root| {
                extension(root)["attributes"]["NORMAL"] = extension(root)["attributes"]["TEXCOORD_0"].clone();
            },
            "attributes.NORMAL: Draco has 2 components, the accessor 3",
        ),
        (|root| extension(root)["bufferView"] = json!(0), "cannot be decoded"),
    ];
    for (change, text) in changes {
        let error = error(change);
        assert!(error.contains(text) && (error.contains(place) || error.contains("bufferViews")), "{error}");
    }
}

#[test]
fn no_byte_of_a_compressed_mesh_makes_a_panic() {
    let writer = file(Some(7));
    let view = writer.root["bufferViews"].as_array().unwrap().last().unwrap().clone();
    let (start, length) =
        (view["byteOffset"].as_u64().unwrap() as usize, view["byteLength"].as_u64().unwrap() as usize);
    let mut refused = 0;
    for index in 0..length {
        for value in [0, 0xff, writer.buffer[start + index] ^ 0x10] {
            let mut changed = Writer { root: writer.root.clone(), buffer: writer.buffer.clone() };
            changed.buffer[start + index] = value;
            refused += usize::from(Scene::from_bytes(&changed.glb(), "test.glb").is_err());
        }
        // And cut off
        let mut cut = Writer { root: writer.root.clone(), buffer: writer.buffer.clone() };
        let last = cut.root["bufferViews"].as_array_mut().unwrap().last_mut().unwrap();
        last["byteLength"] = json!(index);
        assert!(Scene::from_bytes(&cut.glb(), "test.glb").is_err(), "{index} of {length} bytes");
    }
    assert!(refused > length / 10, "{refused} of {}", 3 * length);
}

#[test]
fn data_beside_the_compressed_ones_are_read() {
    let mut writer = panel_with(json!({}));
    writer.root["meshes"][0]["primitives"][0]["extensions"] = json!({ "KHR_draco_mesh_compression": {} });
    writer.root["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    let scene = load(writer);
    assert_eq!((scene.triangles.len(), warnings(&scene)), (2, vec![]));
}
