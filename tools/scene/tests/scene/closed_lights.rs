//! Closed emissive meshes shine outwards only, whatever their material says of sides.

use crate::shapes::{capsule, cuboid, cylinder, panel, sphere};
use crate::writer::{Shape, Writer};
use crate::{emitter_with, load, notes, warnings};
use arealight::Light;
use arealight_oracle::polygon::form_factor;
use arealight_scene::{Scene, SceneBuffers};
use glam::DVec3;
use serde_json::{Value, json};
use std::f64::consts::TAU;

const NOTE: &str =
    "light 'lamp' (node 0): doubleSided, but closed up to small holes: it shines outwards only";

fn lamp(shape: &Shape, double_sided: bool) -> Scene {
    // Mirrored and turned, as artists do
    let mut writer = emitter_with(shape, json!({ "scale": [-1, 1, 1], "rotation": [0.6, 0, 0, 0.8] }));
    writer.root["materials"][0]["doubleSided"] = json!(double_sided);
    load(writer)
}

fn solids() -> [(&'static str, Shape); 4] {
    [
        ("cube", cuboid([1.0; 3])),
        ("sphere", sphere(0.6, 16, 8)),
        ("tube", cylinder(0.2, 2.0, 12)),
        ("capsule", capsule(0.3, 1.0, 12, 4)),
    ]
}

/// What the lights send to a surface, by the form factors of their faces: radiance's first channel times the
/// part of a half space.
fn analytic(lights: &[Light], position: DVec3, normal: DVec3) -> f64 {
    let (x, y) = normal.any_orthonormal_pair();
    let local = |vertex: &DVec3| {
        let offset = *vertex - position;
        DVec3::new(offset.dot(x), offset.dot(y), offset.dot(normal))
    };
    let of_light = |light: &Light| {
        let faces = light.shape.outlines().map(|face| {
            let signed = form_factor(&face.iter().map(local).collect::<Vec<_>>());
            if light.two_sided { signed.abs() } else { signed.max(0.0) }
        });
        faces.sum::<f64>() * f64::from(light.radiance.x)
    };
    lights.iter().map(of_light).sum()
}

/// The same by rays, which see the triangles of the file and know nothing of lights: as the cosine falls,
/// from a grid of 256 x 256.
fn by_rays(scene: &Scene, position: DVec3, normal: DVec3) -> f64 {
    const SIDE: u32 = 256;
    let buffers = SceneBuffers::new(scene, position).unwrap();
    let (x, y) = normal.any_orthonormal_pair();
    let ray = |i: u32| {
        let at = |i: u32| (f64::from(i) + 0.5) / f64::from(SIDE);
        let (radius, turn) = (at(i % SIDE).sqrt(), TAU * at(i / SIDE));
        let direction = x * (radius * turn.cos())
            + y * (radius * turn.sin())
            + normal * (1.0 - radius * radius).max(0.0).sqrt();
        let hit = buffers.closest_hit(position, direction)?;
        Some(f64::from(scene.materials[buffers.triangles[hit.triangle].material as usize].emission.x))
    };
    (0..SIDE * SIDE).filter_map(ray).sum::<f64>() / f64::from(SIDE * SIDE)
}

#[test]
fn closed_meshes_are_the_same_lights_whatever_the_material_says() {
    for (name, shape) in solids() {
        let (one, two) = (lamp(&shape, false), lamp(&shape, true));
        assert_eq!(one.lights, two.lights, "{name}");
        assert!(two.lights.iter().all(|light| !light.two_sided), "{name}");
        assert_eq!((notes(&two), one.notes.len()), (vec![NOTE.to_owned()], 0), "{name}");
        assert_eq!(warnings(&two), [""; 0], "{name}: nothing is lost");
        assert!(two.materials[0].double_sided, "{name} looks as the file says");
    }
}

#[test]
fn closed_meshes_send_what_rays_find() {
    for (name, shape) in solids() {
        let scene = lamp(&shape, true);
        for (position, normal) in [
            (DVec3::new(0.0, -1.5, 0.3), DVec3::Y),
            (DVec3::new(1.2, 0.4, -1.1), DVec3::new(-0.8, 0.0, 0.6)),
            (DVec3::new(-0.2, 1.6, 0.0), DVec3::new(0.0, -0.6, 0.8)),
        ] {
            let (closed, truth) =
                (analytic(&scene.lights, position, normal), by_rays(&scene, position, normal));
            // The bound; the grid of rays is within 0.5 % here
            assert!((closed / truth - 1.0).abs() < 0.02, "{name}: {closed} is not {truth}");
            // The twin: two-sided they would send twice as much
            let turned = |light: &Light| Light { two_sided: true, ..light.clone() };
            let lights: Vec<Light> = scene.lights.iter().map(turned).collect();
            let doubled = analytic(&lights, position, normal) / truth;
            assert!(doubled > 1.3, "{name}: {doubled}");
        }
    }
}

#[test]
fn open_sheets_stay_two_sided() {
    let mut lid_off = cuboid([1.0; 3]);
    lid_off.indices.truncate(30);
    for shape in [panel(1.0, 1.0), lid_off] {
        let scene = lamp(&shape, true);
        assert!(scene.lights.iter().all(|light| light.two_sided) && scene.notes.is_empty());
    }
}

#[test]
fn each_part_of_a_mesh_is_judged_by_itself() {
    let (mut both, sheet) = (cuboid([1.0; 3]), panel(1.0, 1.0));
    let first = both.positions.len() as u32;
    both.positions.extend(sheet.positions.iter().map(|[x, y, z]| [x + 3.0, *y, *z]));
    both.normals.extend(&sheet.normals);
    both.uvs.extend(&sheet.uvs);
    both.indices.extend(sheet.indices.iter().map(|index| first + index));
    let sides: Vec<(usize, bool)> =
        lamp(&both, true).lights.iter().map(|l| (l.shape.outlines().count(), l.two_sided)).collect();
    assert_eq!(sides, [(6, false), (1, true)]);
}

/// A doubly sided cube of two primitives: all but its last face, which emits, and a lid of another material.
/// Both have the corners of the cube.
fn with_lid(lid: Value) -> Writer {
    let cube = cuboid([1.0; 3]);
    let (sides, face) = cube.indices.split_at(30);
    let mut writer = emitter_with(&Shape { indices: sides.to_vec(), ..cube.clone() }, json!({}));
    writer.root["materials"][0]["doubleSided"] = json!(true);
    let material = writer.push("materials", lid);
    let mut primitive = writer.primitive(&Shape { indices: face.to_vec(), ..cube.clone() });
    primitive["material"] = json!(material);
    writer.root["meshes"][0]["primitives"].as_array_mut().unwrap().push(primitive);
    writer
}

#[test]
fn a_mesh_is_closed_by_what_does_not_shine() {
    let scene = load(with_lid(json!({})));
    let [light] = &scene.lights[..] else { panic!("{} lights", scene.lights.len()) };
    assert_eq!((light.shape.outlines().count(), light.two_sided), (5, false));
    assert_eq!((scene.notes[0].to_string().as_str(), scene.notes.len()), (NOTE, 1));
    assert_eq!((scene.lamps.len(), scene.lamps[0].triangles.len()), (1, 10));
    // The twins: the lid is away, looks inwards, is elsewhere, or has holes
    let mut away = with_lid(json!({}));
    away.root["meshes"][0]["primitives"].as_array_mut().unwrap().pop();
    let mut inwards = with_lid(json!({}));
    let turned = inwards.indices(&cuboid([1.0; 3]).indices[30..].iter().rev().copied().collect::<Vec<_>>());
    inwards.root["meshes"][0]["primitives"][1]["indices"] = json!(turned);
    let mut elsewhere = with_lid(json!({}));
    let moved: Vec<_> = cuboid([1.0; 3]).positions.iter().map(|[x, y, z]| [x + 0.01, *y, *z]).collect();
    elsewhere.root["meshes"][0]["primitives"][1]["attributes"]["POSITION"] = json!(elsewhere.floats(&moved));
    for (name, open) in [
        ("away", away),
        ("inwards", inwards),
        ("elsewhere", elsewhere),
        ("holes", with_lid(json!({ "alphaMode": "MASK" }))),
    ] {
        let scene = load(open);
        assert!(scene.lights.iter().all(|light| light.two_sided) && scene.notes.is_empty(), "{name}");
    }
}

#[test]
fn a_mesh_is_closed_by_several_that_shine() {
    let lid = json!({ "emissiveFactor": [0, 1, 0], "doubleSided": true });
    let scene = load(with_lid(lid));
    let sides: Vec<(usize, bool)> =
        scene.lights.iter().map(|light| (light.shape.outlines().count(), light.two_sided)).collect();
    assert_eq!(sides, [(5, false), (1, false)]);
}

#[test]
fn what_touches_a_closed_primitive_does_not_open_it() {
    // A fin at an edge of a cube that is closed by itself: three triangles meet there
    let mut writer = emitter_with(&cuboid([1.0; 3]), json!({}));
    writer.root["materials"][0]["doubleSided"] = json!(true);
    let corners = cuboid([1.0; 3]);
    let [a, b] = [corners.indices[0], corners.indices[1]].map(|index| corners.positions[index as usize]);
    let fin = Shape { positions: vec![a, b, [3.0; 3]], indices: vec![0, 1, 2], ..Shape::default() };
    let mut primitive = writer.primitive(&fin);
    primitive["material"] = json!(0);
    writer.root["meshes"][0]["primitives"].as_array_mut().unwrap().push(primitive);
    let scene = load(writer);
    let sides: Vec<bool> = scene.lights.iter().map(|light| light.two_sided).collect();
    assert_eq!(sides, [false, true]);
}

#[test]
fn where_alpha_makes_holes_there_is_no_inside() {
    let mut writer = emitter_with(&cuboid([1.0; 3]), json!({}));
    writer.root["materials"][0]["doubleSided"] = json!(true);
    writer.root["materials"][0]["alphaMode"] = json!("MASK");
    let scene = load(writer);
    assert!(scene.lights[0].two_sided && scene.notes.is_empty());
}

#[test]
fn a_long_tube_without_caps_shines_outwards_and_a_short_one_inwards_too() {
    for (height, closed) in [(8.0, true), (2.0, false)] {
        let mut tube = cylinder(0.2, height, 12);
        let side = |corners: &[u32]| corners.iter().any(|&i| tube.normals[i as usize][1].abs() < 0.5);
        tube.indices =
            tube.indices.chunks_exact(3).filter(|corners| side(corners)).flatten().copied().collect();
        let scene = lamp(&tube, true);
        assert!(!scene.lights.is_empty() && scene.lights.iter().all(|light| light.two_sided != closed));
        assert_eq!(scene.notes.iter().any(|note| note.to_string() == NOTE), closed);
        // Inside out it is no body
        for corners in tube.indices.chunks_exact_mut(3) {
            corners.swap(0, 1);
        }
        assert!(lamp(&tube, true).lights.iter().all(|light| light.two_sided));
    }
}
