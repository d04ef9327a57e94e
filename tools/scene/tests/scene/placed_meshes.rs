//! Meshes that are not where their node is: on the joints of a skin, or many times.

use crate::shapes::panel;
use crate::writer::{Writer, png};
use crate::{emitter_with, error, load, warnings};
use arealight::Profile;
use arealight_scene::Scene;
use glam::{DVec3, Vec3};
use serde_json::json;
use std::f64::consts::FRAC_1_SQRT_2;

/// A panel from (-1, -0.5) to (1, 0.5) on a node far away, whose left edge hangs on a joint that stays where
/// it was bound, and its right edge, by `right`, on that one and one that has moved by (0, 2, 1). The second
/// was bound at (1, 0, 0).
fn skinned(right: [f32; 2]) -> Writer {
    let mut writer = emitter_with(
        &panel(2.0, 1.0),
        json!({ "translation": [50, 0, 0], "scale": [0.1, 0.1, 0.1], "skin": 0 }),
    );
    writer.node(json!({}));
    writer.node(json!({ "translation": [1, 2, 1] }));
    let view = writer.view(&[0_u8, 1, 0, 0].repeat(4));
    let joints = json!({ "bufferView": view, "componentType": 5121, "count": 4, "type": "VEC4" });
    let joints = writer.push("accessors", joints);
    let right = [right[0], right[1], 0.0, 0.0];
    let left = [1.0, 0.0, 0.0, 0.0];
    let weights = writer.floats(&[left, right, right, left]);
    let attributes = &mut writer.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = json!(joints);
    attributes["WEIGHTS_0"] = json!(weights);
    let bind = |x: f32| [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -x, 0.0, 0.0, 1.0];
    let bytes: Vec<u8> =
        [bind(0.0), bind(1.0)].iter().flatten().flat_map(|x: &f32| x.to_le_bytes()).collect();
    let view = writer.view(&bytes);
    let inverses = json!({ "bufferView": view, "componentType": 5126, "count": 2, "type": "MAT4" });
    let inverses = writer.push("accessors", inverses);
    writer.root["skins"] = json!([{ "joints": [1, 2], "inverseBindMatrices": inverses }]);
    writer
}

fn corners(scene: &Scene) -> [DVec3; 2] {
    let all = || scene.triangles.iter().flat_map(|triangle| triangle.positions);
    let lowest = |sum: fn(DVec3) -> f64| all().min_by(|a, b| sum(*a).total_cmp(&sum(*b))).unwrap();
    [lowest(|p| p.x + p.y), lowest(|p| -p.x - p.y)]
}

#[test]
fn a_skinned_mesh_is_where_its_joints_are() {
    let scene = load(skinned([0.0, 1.0]));
    assert_eq!(corners(&scene), [DVec3::new(-1.0, -0.5, 0.0), DVec3::new(1.0, 2.5, 1.0)]);
    assert_eq!(warnings(&scene), [""; 0]);
    // Half of each joint, also where the weights are not of sum 1
    for weights in [[0.5, 0.5], [3.0, 3.0]] {
        let scene = load(skinned(weights));
        assert_eq!(corners(&scene)[1], DVec3::new(1.0, 1.5, 0.5));
        assert!((scene.lights[0].shape.area_vector().length() - scene_area(&scene)).abs() < 1e-9);
    }
    // The twin: without its skin it is at its node
    let mut writer = skinned([0.0, 1.0]);
    writer.root["nodes"][0].as_object_mut().unwrap().remove("skin");
    let [low, _] = corners(&load(writer));
    assert!((low - DVec3::new(49.9, -0.05, 0.0)).length() < 1e-6);
}

fn scene_area(scene: &Scene) -> f64 {
    let area = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a) * 0.5;
    scene.triangles.iter().map(|triangle| area(triangle.positions)).sum::<DVec3>().length()
}

#[test]
fn joints_that_mirror_turn_faces_and_normals() {
    let mut writer = skinned([0.0, 1.0]);
    for joint in [1, 2] {
        writer.root["nodes"][joint] = json!({ "scale": [1, 1, -1] });
    }
    let scene = load(writer);
    let [a, b, c] = scene.triangles[0].positions;
    // As a mirrored node would: the back is in front
    assert_eq!((b - a).cross(c - a).try_normalize(), Some(DVec3::NEG_Z));
    assert_eq!(scene.triangles[0].normals[0], Vec3::NEG_Z);
}

#[test]
fn skins_that_do_not_fit_are_said() {
    let mut writer = skinned([0.0, 1.0]);
    writer.root["skins"][0]["joints"] = json!([1]);
    assert!(error(writer).contains("JOINTS_0[1]: the skin of nodes[0] has 1 joints"));

    let mut writer = skinned([0.0, 1.0]);
    writer.root["scenes"][0]["nodes"] = json!([0, 1]);
    let scene = load(writer);
    assert_eq!(warnings(&scene), ["nodes[0]: its skin has a joint that is not in the scene: skin ignored"]);
    assert!(corners(&scene)[0].x > 49.0);

    let mut writer = skinned([0.0, 1.0]);
    let attributes = writer.root["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap();
    attributes.insert("JOINTS_1".into(), attributes["JOINTS_0"].clone());
    attributes.insert("WEIGHTS_1".into(), attributes["WEIGHTS_0"].clone());
    assert!(warnings(&load(writer))[0].ends_with("JOINTS_1 is not supported: four joints move a vertex"));

    let mut writer = skinned([0.0, 1.0]);
    writer.root["accessors"].as_array_mut().unwrap().last_mut().unwrap()["count"] = json!(1);
    assert!(error(writer).contains("inverseBindMatrices: 1 for 2 joints"));
}

fn instanced() -> Writer {
    let mut writer = emitter_with(&panel(2.0, 1.0), json!({ "translation": [0, 10, 0] }));
    let attributes = json!({
        "TRANSLATION": writer.floats(&[[0.0_f32, 0.0, 0.0], [5.0, 0.0, 0.0], [0.0, 0.0, 7.0]]),
        "ROTATION": writer.floats(&[
            [0.0, 0.0, 0.0, 1.0],
            [0.0, FRAC_1_SQRT_2 as f32, 0.0, FRAC_1_SQRT_2 as f32],
            [0.0, 0.0, 0.0, 1.0],
        ]),
        "SCALE": writer.floats(&[[1.0_f32; 3], [1.0; 3], [2.0; 3]]),
    });
    writer.root["nodes"][0]["extensions"] =
        json!({ "EXT_mesh_gpu_instancing": { "attributes": attributes } });
    writer.root["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    writer
}

#[test]
fn each_instance_of_a_mesh_is_there_and_shines() {
    let scene = load(instanced());
    assert_eq!(warnings(&scene), [""; 0]);
    assert_eq!((scene.triangles.len(), scene.lights.len()), (6, 3));
    let areas: Vec<DVec3> = scene.lights.iter().map(|light| light.shape.area_vector()).collect();
    for (area, expected) in areas.iter().zip([DVec3::Z * 2.0, DVec3::X * 2.0, DVec3::Z * 8.0]) {
        assert!((*area - expected).length() < 1e-5, "{area}");
    }
    assert_eq!((scene.bounds.min.y, scene.bounds.max.z), (9.0, 7.0));
    // The twin: without the extension there is one
    let mut writer = instanced();
    writer.root["nodes"][0].as_object_mut().unwrap().remove("extensions");
    assert_eq!(load(writer).lights.len(), 1);
}

#[test]
fn a_mesh_may_have_a_profile_and_doors_as_long_as_the_node_is_along_its_front() {
    // A panel that faces +Y
    let mut shape = panel(2.0, 1.0);
    for vector in shape.positions.iter_mut().chain(&mut shape.normals) {
        vector.rotate_left(1);
    }
    for (scale, length) in [([1, 2, 1], 0.6), ([1, 1, 2], 0.3)] {
        let said = json!({ "doors": { "length": 0.3, "angle": 0.0 }, "spread": 1.0 });
        let node = json!({ "scale": scale, "extras": { "arealight": said } });
        let scene = load(emitter_with(&shape, node));
        assert_eq!(scene.lights[0].profile, Profile::spread(1.0, 8).ok());
        let over = scene.lights[0].opening.unwrap().center - scene.lights[0].shape.center();
        assert!((over - DVec3::Y * length).length() < 1e-6, "{over}");
    }
}

#[test]
fn instances_of_a_shape_are_lights_of_their_own() {
    let mut writer = instanced();
    writer.root["nodes"][0]["extras"] = json!({ "arealight": { "shape": "sphere", "radius": 1 } });
    let scene = load(writer);
    assert_eq!((scene.lights.len(), warnings(&scene)), (3, Vec::new()));
}

#[test]
fn instances_that_do_not_fit_are_refused() {
    let mut writer = instanced();
    let attributes = &mut writer.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    let scale = attributes["SCALE"].as_u64().unwrap() as usize;
    writer.root["accessors"][scale]["count"] = json!(2);
    assert!(error(writer).contains("are of different counts"));

    // A count beside sixteen bytes of data
    let mut writer = instanced();
    let view = writer.view(&[0; 16]);
    let sparse = json!({ "count": 1, "indices": { "bufferView": view, "componentType": 5121 },
        "values": { "bufferView": view } });
    let many = json!({ "componentType": 5126, "count": (1 << 20) + 1, "type": "VEC3", "sparse": sparse });
    let many = writer.push("accessors", many);
    writer.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] =
        json!({ "TRANSLATION": many });
    let text = error(writer);
    assert!(text.contains("instances"), "{text}");

    let mut writer = instanced();
    writer.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] =
        json!({ "TRANSLATION": 999 });
    assert!(error(writer).contains("its accessor does not exist"));
}

#[test]
fn a_light_without_its_own_coordinates_is_said() {
    let png = png(image::RgbImage::from_pixel(2, 2, image::Rgb([255, 0, 0])));
    let lamp = |set: u32| {
        let mut writer = emitter_with(&panel(2.0, 1.0), json!({}));
        let texture = writer.texture("picture", &png);
        let material = &mut writer.root["materials"][0];
        material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": texture });
        material["emissiveTexture"] = json!({ "index": texture, "texCoord": set });
        warnings(&load(writer))
    };
    let said = |all: &[String]| {
        all.iter().any(|one| one.ends_with("has no TEXCOORD_1: its emissive texture is read at (0, 0)"))
    };
    assert!(said(&lamp(1)), "{:?}", lamp(1));
    assert!(!said(&lamp(0)), "the twin: with coordinates there is no word");
}
