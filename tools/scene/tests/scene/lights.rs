//! What becomes a light.

use crate::shapes::{floor, panel, polygon, rounded_box, sphere, star};
use crate::writer::Shape;
use crate::{emitter_with, load, notes, panel_with, warnings};
use arealight::{Effects, Light, LightShape};
use arealight_scene::{LUMENS_PER_WATT, Scene, required_effects};
use glam::{DVec3, Vec3};
use serde_json::{Value, json};

fn near(a: DVec3, b: DVec3) -> bool {
    // Positions are float32 numbers in the file: a few of their roundings
    (a - b).length() < 1e-6 * (1.0 + b.length())
}

#[test]
fn a_quad_is_one_light_of_four_vertices() {
    let scene = load(emitter_with(&panel(2.0, 1.0), json!({ "translation": [0, 5, 0] })));
    let [light] = &scene.lights[..] else { panic!("{} lights", scene.lights.len()) };
    assert_eq!((light.name.as_str(), light.shape.vertices().len(), light.two_sided), ("lamp", 4, false));
    assert_eq!(light.shape.area_vector(), DVec3::Z * 2.0);
    // emissiveFactor (1, 2/3, 1/3) times a strength of 3
    assert!((light.radiance - Vec3::new(3.0, 2.0, 1.0)).length() < 1e-6);
    assert!(light.shape.vertices().iter().all(|v| v.y > 4.0));
    assert_eq!(warnings(&scene), [""; 0]);
    // It is visible, too
    assert_eq!(scene.triangles.len(), 2);
    assert_eq!(scene.materials[0].emission, light.radiance);
}

#[test]
fn a_double_sided_material_makes_a_two_sided_light() {
    let mut writer = emitter_with(&panel(1.0, 1.0), json!({}));
    writer.root["materials"][0]["doubleSided"] = json!(true);
    assert!(load(writer).lights[0].two_sided);
}

#[test]
fn concave_outlines_are_one_light() {
    let corner = polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]]);
    for (shape, count) in [(corner, 6), (star(10, 1.0, 0.4), 10)] {
        let scene = load(emitter_with(&shape, json!({ "rotation": [0.6, 0, 0, 0.8] })));
        assert_eq!((scene.lights.len(), scene.lights[0].shape.vertices().len()), (1, count));
        assert_eq!(warnings(&scene), [""; 0]);
    }
}

/// How many vertices each face of a light has.
fn faces(light: &Light) -> Vec<usize> {
    light.shape.outlines().map(<[DVec3]>::len).collect()
}

#[test]
fn islands_are_faces_of_one_light() {
    let mut islands = panel(1.0, 1.0);
    let other = panel(1.0, 1.0);
    islands.positions.extend(other.positions.iter().map(|[x, y, z]| [x + 3.0, *y, *z]));
    islands.normals.extend(other.normals);
    islands.uvs.extend(other.uvs);
    islands.indices.extend(other.indices.iter().map(|i| i + 4));
    let scene = load(emitter_with(&islands, json!({})));
    let names: Vec<_> = scene.lights.iter().map(|l| l.name.as_str()).collect();
    assert_eq!((names, faces(&scene.lights[0])), (vec!["lamp"], vec![4, 4]));
    assert_eq!(warnings(&scene), [""; 0]);
    assert!(scene.effects().contains(Effects::MESH));
    let mesh = required_effects(&scene).into_iter().find(|one| one.effect == Effects::MESH).unwrap();
    assert_eq!(mesh.to_string(), "mesh: light 'lamp'");
    // The twin: one of them is a polygon without faces
    let scene = load(emitter_with(&panel(1.0, 1.0), json!({})));
    assert!(
        matches!(scene.lights[0].shape, LightShape::Polygon(_)) && !scene.effects().contains(Effects::MESH)
    );
}

#[test]
fn a_bent_emitter_is_one_light_of_its_flat_parts() {
    let scene = load(emitter_with(&rounded_box([1.0; 3], 1e-9, 1).plain(), json!({})));
    assert_eq!(scene.lights.len(), 1);
    assert_eq!(faces(&scene.lights[0]), [4; 6], "a box is six quads");
    assert_eq!(warnings(&scene), [""; 0]);

    let scene = load(emitter_with(&sphere(1.0, 12, 8), json!({})));
    // Quads but at the poles, most of them not quite flat
    let count = faces(&scene.lights[0]).len();
    assert!((96..=168).contains(&count) && scene.lights.len() == 1, "{count}");
    // A closed surface's areas add up to zero
    let sum = scene.lights[0].shape.area_vector();
    assert!(sum.length() < 1e-4, "{sum}");
}

#[test]
fn a_light_with_a_hole_is_one_light() {
    // A square ring of four trapezia
    let corner = |s: f32| [[-s, -s, 0.0], [s, -s, 0.0], [s, s, 0.0], [-s, s, 0.0]];
    let positions = [corner(2.0), corner(1.0)].concat();
    let side = |i: u32| [[i, (i + 1) % 4, (i + 1) % 4 + 4], [i, (i + 1) % 4 + 4, i + 4]].concat();
    let ring = Shape { positions, indices: (0..4).flat_map(side).collect(), ..Shape::default() };
    let scene = load(emitter_with(&ring, json!({})));
    assert_eq!((scene.lights.len(), scene.lights[0].shape.vertices().len()), (1, 4 + 4 + 2));
    assert_eq!(scene.lights[0].shape.area_vector(), DVec3::Z * 12.0);
    assert_eq!(warnings(&scene), [""; 0]);
}

#[test]
fn mirrors_keep_the_front_in_front() {
    // A panel faces +Z; the mirror image in x and y still does, that in z faces -Z
    for (scale, front) in
        [([-1.0, 1.0, 1.0], DVec3::Z), ([1.0, -2.0, 1.0], DVec3::Z * 2.0), ([1.0, 1.0, -1.0], DVec3::NEG_Z)]
    {
        let scene = load(emitter_with(&panel(1.0, 1.0), json!({ "scale": scale })));
        assert!(near(scene.lights[0].shape.area_vector(), front), "{scale:?}");
        for triangle in &scene.triangles {
            let [p, q, r] = triangle.positions;
            let normal = (q - p).cross(r - p);
            assert!(normal.dot(front) > 0.0 && triangle.normals[0].as_dvec3().dot(front) > 0.0, "{scale:?}");
        }
    }
}

#[test]
fn black_emission_and_masks() {
    let mut writer = emitter_with(&panel(1.0, 1.0), json!({}));
    writer.root["materials"][0]["emissiveFactor"] = json!([0, 0, 0]);
    let scene = load(writer);
    assert!(scene.lights.is_empty());
    assert!(scene.warnings.iter().any(|w| w.text.contains("has no area lights")));

    let mut writer = emitter_with(&panel(1.0, 1.0), json!({}));
    writer.root["materials"][0]["alphaMode"] = json!("MASK");
    assert!(warnings(&load(writer))[0].contains("the light shines where the mask is transparent, too"));
}

/// A scene of one `EXT_lights_area` light on a node.
fn area_light(light: &Value, node: &Value) -> Scene {
    let mut writer = emitter_with(&floor(1.0, 1.0, 1.0), json!({}));
    writer.root["materials"][0] = json!({});
    writer.root["extensions"] = json!({ "EXT_lights_area": { "lights": [light] } });
    writer.root["extensionsRequired"] = json!(["EXT_lights_area"]);
    let mut node = node.clone();
    node["extensions"] = json!({ "EXT_lights_area": { "light": 0 } });
    writer.node(node);
    load(writer)
}

#[test]
fn area_lights_have_the_extensions_defaults() {
    let scene = area_light(&json!({}), &json!({}));
    let [light] = &scene.lights[..] else { panic!("{} lights", scene.lights.len()) };
    assert_eq!((light.name.as_str(), light.two_sided), ("area light 0", false));
    assert_eq!(light.shape.area_vector(), DVec3::NEG_Z, "one by one, along -Z");
    assert!((light.radiance - Vec3::splat((1000.0 / LUMENS_PER_WATT) as f32)).length() < 1e-6);
    assert_eq!(scene.triangles.len(), 2, "it has no geometry of its own");
    assert_eq!(warnings(&scene), [""; 0]);
}

#[test]
fn what_a_light_has_of_a_draft_is_said() {
    let scene =
        area_light(&json!({ "width": 2, "luminance": 5, "size": 3, "extras": { "id": 1 } }), &json!({}));
    let said = ["luminance", "width"]
        .map(|field| format!("light 'area light 0': {field} is no field of EXT_lights_area: left out"));
    assert_eq!(warnings(&scene), said);
}

#[test]
fn nits_of_a_light_and_of_a_mesh_are_said_to_differ() {
    let lamp = || emitter_with(&panel(1.0, 1.0), json!({}));
    assert_eq!(notes(&load(lamp())), [""; 0]);
    let mut writer = lamp();
    writer.root["extensions"] = json!({ "EXT_lights_area": { "lights": [{}] } });
    writer.node(json!({ "extensions": { "EXT_lights_area": { "light": 0 } } }));
    let notes = notes(&load(writer));
    assert!(notes.len() == 1 && notes[0].contains("1000 nits of these are 1.46"), "{notes:?}");
}

#[test]
fn places_far_from_the_origin_have_all_of_their_digits() {
    let at =
        |x: f64| load(emitter_with(&panel(1.0, 1.0), json!({ "translation": [x, 0, 0] }))).lights[0].clone();
    let (near, far) = (at(0.3), at(10_000_000.3));
    for (a, b) in near.shape.vertices().iter().zip(far.shape.vertices()) {
        // Ten roundings of float64; float32 has steps of one there
        assert!((*b - *a - DVec3::X * 1e7).length() < 1e-8, "{a} {b}");
    }
}

#[test]
fn area_lights_scale_by_the_largest_component() {
    let light = json!({ "type": "rect", "color": [1.0, 0.5, 0.25], "intensity": 683, "size": 2,
                        "rect": { "aspect": 3 }, "name": "key" });
    let scene = area_light(&light, &json!({ "scale": [0.5, -1.5, 1.0], "translation": [7, 8, 9] }));
    let light = &scene.lights[0];
    assert_eq!(light.name, "key");
    assert_eq!(light.radiance, Vec3::new(1.0, 0.5, 0.25));
    // The largest is 1.5: width 1.5 × 2 × 3 along x, height 1.5 × 2 along y, still along -Z
    let extent = |axis: usize| {
        let along = || light.shape.vertices().iter().map(|v| v[axis]);
        (along().fold(f64::MAX, f64::min), along().fold(f64::MIN, f64::max))
    };
    assert_eq!((extent(0), extent(1), extent(2)), ((2.5, 11.5), (6.5, 9.5), (9.0, 9.0)));
    assert!(light.shape.area_vector().z < 0.0);
}

#[test]
fn area_lights_turn_with_their_node() {
    // A quarter turn about X takes -Z to +Y (then the width is along x, the height along z)
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let light = json!({ "size": 2, "rect": { "aspect": 0.5 } });
    let scene = area_light(&light, &json!({ "rotation": [half, 0, 0, half] }));
    assert!(
        near(scene.lights[0].shape.area_vector(), DVec3::Y * 2.0),
        "{}",
        scene.lights[0].shape.area_vector()
    );
    // A mirror in z turns the light around with the node
    let scene = area_light(&light, &json!({ "scale": [1, 1, -1] }));
    assert!(near(scene.lights[0].shape.area_vector(), DVec3::Z * 2.0));
}

#[test]
fn a_disk_is_an_ellipse_where_the_extras_say_so() {
    let axes = |extras: Value| {
        let scene = area_light(&json!({ "type": "disk", "size": 2, "extras": extras }), &json!({}));
        let LightShape::Disk { axis_u, axis_v, .. } = scene.lights[0].shape else { panic!("no disk") };
        assert!(scene.lights[0].shape.area_vector().z < 0.0);
        [axis_u.length(), axis_v.length()]
    };
    assert_eq!(axes(json!({ "arealight": { "aspect": 1.5 } })), [1.5, 1.0]);
    // Extras are whatever a file likes
    for extras in [json!({}), json!(null), json!("round"), json!({ "arealight": "sphere" })] {
        assert_eq!(axes(extras), [1.0, 1.0]);
    }
}

#[test]
fn area_lights_that_cannot_be_are_left_out() {
    for (light, node, text) in [
        (json!({ "type": "disk", "size": -1 }), json!({}), "a disk of the diameters -1 and -1: left out"),
        (json!({ "type": "disk" }), json!({ "scale": [1, 1, 0] }), "its node's scale is zero: left out"),
        (json!({ "type": "blob" }), json!({}), "type 'blob' is not known: left out"),
        (json!({ "size": 0 }), json!({}), "a rectangle of 0 by 0: left out"),
        (json!({ "rect": { "aspect": -1 } }), json!({}), "a rectangle of -1 by 1: left out"),
        (json!({}), json!({ "scale": [1, 1, 0] }), "its node's scale is zero: left out"),
        (json!({ "intensity": -1 }), json!({}), "must be finite and not negative: left out"),
    ] {
        let scene = area_light(&light, &node);
        assert!(scene.lights.is_empty());
        assert!(warnings(&scene)[0].ends_with(text), "{:?} should end with {text:?}", warnings(&scene));
    }
}

#[test]
fn an_emissive_factor_above_one_is_a_strength() {
    let scene = load(panel_with(json!({ "emissiveFactor": [6, 3, 0] })));
    assert_eq!(scene.lights[0].radiance.to_array(), [6.0, 3.0, 0.0]);
    assert_eq!(notes(&scene), ["material '#0': emissiveFactor [6.0, 3.0, 0.0] is above 1: a strength, too"]);
}
