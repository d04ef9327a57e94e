//! Tangents: the file's, or those of the texture coordinates, through mirrors and transforms.

use crate::shapes::panel;
use crate::writer::Writer;
use crate::{error, load, panel_with, warnings};
use glam::{Vec3, Vec4};
use serde_json::{Value, json};

/// A panel in the plane of x and y, of a material that needs tangents; `change` of its texture coordinates.
fn brushed(change: fn([f32; 2]) -> [f32; 2], node: Value) -> Writer {
    let mut writer = Writer::new();
    let material = writer.surface("brushed", [1.0; 3], 1.0, 0.5);
    writer.root["materials"][material]["extensions"] =
        json!({ "KHR_materials_anisotropy": { "anisotropyStrength": 1.0 } });
    let mut shape = panel(2.0, 2.0);
    shape.uvs = shape.positions.iter().map(|[x, y, _]| change([0.5 + 0.5 * x, 0.5 - 0.5 * y])).collect();
    writer.object("panel", &shape, material, node);
    writer
}

/// The tangents of every corner, which are alike.
fn tangent(writer: Writer) -> Vec4 {
    let scene = load(writer);
    let tangents: Vec<Vec4> = scene.triangles.iter().flat_map(|triangle| triangle.tangents).collect();
    assert!(tangents.iter().all(|tangent| tangent.abs_diff_eq(tangents[0], 1e-6)), "{tangents:?}");
    tangents[0]
}

#[test]
fn tangents_are_where_u_grows() {
    assert_eq!(tangent(brushed(|uv| uv, json!({}))), Vec3::X.extend(1.0));
    assert_eq!(tangent(brushed(|[u, v]| [1.0 - u, v], json!({}))), (-Vec3::X).extend(-1.0), "mirrored");
    assert_eq!(tangent(brushed(|[u, v]| [v, u], json!({}))), (-Vec3::Y).extend(-1.0), "u downwards");
}

#[test]
fn tangents_go_with_the_node() {
    let node = json!({ "rotation": [0.0, 0.0, 0.5_f64.sqrt(), 0.5_f64.sqrt()], "scale": [3.0, 1.0, 1.0] });
    let turned = tangent(brushed(|uv| uv, node));
    assert!(turned.abs_diff_eq(Vec3::Y.extend(1.0), 1e-6), "{turned}");
    // A mirror turns the bitangent around, not what the file says of the tangent
    let mirrored = tangent(brushed(|uv| uv, json!({ "scale": [-1.0, 1.0, 1.0] })));
    assert_eq!(mirrored, (-Vec3::X).extend(-1.0));
}

#[test]
fn the_file_s_own_tangents_come_first() {
    let mut writer = brushed(|uv| uv, json!({}));
    let given = writer.floats(&[[0.0_f32, 0.6, 0.8, -1.0]; 4]);
    writer.root["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = json!(given);
    assert_eq!(tangent(writer), Vec4::new(0.0, 0.6, 0.8, -1.0));
    // Not as many as positions
    let mut writer = brushed(|uv| uv, json!({}));
    let given = writer.floats(&[[1.0_f32, 0.0, 0.0, 1.0]; 3]);
    writer.root["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = json!(given);
    let text = error(writer);
    assert!(text.contains("TANGENT: 3 for 4 positions"), "{text}");
}

#[test]
fn where_nothing_says_what_they_are_there_is_a_warning() {
    let mut writer = brushed(|uv| uv, json!({}));
    writer.root["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("TEXCOORD_0");
    let scene = load(writer);
    let text = warnings(&scene).join("; ");
    assert!(text.contains("has neither TANGENT nor TEXCOORD_0: its anisotropy has some direction"), "{text}");
    assert_eq!(scene.triangles[0].tangents, [Vec4::ZERO; 3]);
    // Materials that need none have none
    assert_eq!(load(panel_with(json!({}))).triangles[0].tangents, [Vec4::ZERO; 3]);
}
