//! Disks, spheres and tubes: of `EXT_lights_area`, and emissive meshes that stand for them.

use crate::shapes::{disk, floor, sphere};
use crate::writer::Writer;
use crate::{emitter_with, load, warnings};
use arealight::{Effects, LightShape, TubeEnds};
use arealight_scene::{Scene, required_effects};
use glam::{DVec2, DVec3, Vec3};
use image::{Rgb, RgbImage};
use serde_json::{Value, json};

#[test]
fn area_lights_may_be_disks() {
    let mut writer = Writer::new();
    let material = writer.surface("floor", [0.5; 3], 0.0, 0.5);
    writer.object("floor", &floor(1.0, 1.0, 1.0), material, json!({}));
    let light = json!({ "type": "disk", "intensity": 683, "size": 3, "name": "round" });
    writer.root["extensions"] = json!({ "EXT_lights_area": { "lights": [light] } });
    // The largest scale is 2, and a mirror in x leaves the front where it is
    writer.node(json!({ "translation": [7, 8, 9], "scale": [-2, 1, 1],
                        "extensions": { "EXT_lights_area": { "light": 0 } } }));
    let scene = load(writer);
    assert_eq!(warnings(&scene), [""; 0]);
    assert!(scene.lamps[0].triangles.is_empty(), "the floor is none");
    let [light] = &scene.lights[..] else { panic!("{} lights", scene.lights.len()) };
    assert_eq!((light.name.as_str(), light.radiance, light.two_sided), ("round", Vec3::ONE, false));
    let LightShape::Disk { center, axis_u, axis_v } = light.shape else { panic!("{light:?}") };
    assert_eq!(center, DVec3::new(7.0, 8.0, 9.0));
    assert_eq!((axis_u.length(), axis_v.length(), axis_u.dot(axis_v)), (3.0, 3.0, 0.0));
    assert_eq!(axis_u.cross(axis_v), DVec3::NEG_Z * 9.0);
    let lobes = Effects::DIFFUSE | Effects::GLOSSY | Effects::COUPLED;
    assert_eq!(scene.effects(), lobes | Effects::ELLIPSE);
    let reasons: Vec<String> = required_effects(&scene).iter().map(ToString::to_string).collect();
    assert!(reasons.contains(&"ellipse: light 'round'".to_owned()), "{reasons:?}");
}

/// An emissive ball, or a disk, whose node says what it is.
fn emitter(said: &Value, mut node: Value, double_sided: bool) -> Scene {
    node["extras"] = json!({ "arealight": said, "else": 1 });
    let mesh = if said["shape"] == "disk" { disk(2.0, 24) } else { sphere(0.25, 8, 4) };
    let mut writer = emitter_with(&mesh, node);
    writer.root["materials"][0]["doubleSided"] = json!(double_sided);
    load(writer)
}

#[test]
fn emissive_meshes_may_stand_for_shapes() {
    // A quarter turn about X takes Y to Z
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let node = || json!({ "translation": [1, 2, 3], "rotation": [half, 0, 0, half], "scale": [2, 2, 2] });
    let tube = |ends| LightShape::Tube {
        p0: DVec3::new(1.0, 2.0, 1.0),
        p1: DVec3::new(1.0, 2.0, 5.0),
        radius: 0.5,
        ends,
    };
    let center = DVec3::new(1.0, 2.0, 3.0);
    for (said, expected) in [
        (json!({ "shape": "sphere", "radius": 0.5 }), LightShape::Sphere { center, radius: 1.0 }),
        (json!({ "shape": "cylinder", "radius": 0.25, "height": 2 }), tube(TubeEnds::Flat)),
        (json!({ "shape": "pipe", "radius": 0.25, "height": 2 }), tube(TubeEnds::Open)),
        (json!({ "shape": "capsule", "radius": 0.25, "height": 2 }), tube(TubeEnds::Round)),
    ] {
        let scene = emitter(&said, node(), true);
        assert_eq!(warnings(&scene), [""; 0], "{said}");
        let [light] = &scene.lights[..] else { panic!("{} lights", scene.lights.len()) };
        assert_eq!(light.radiance, Vec3::new(3.0, 2.0, 1.0));
        assert!(!light.two_sided, "solids shine outwards");
        let [found, expected] = [light.shape.clone(), expected].map(|shape| shape.bounds());
        assert!((found[0] - expected[0]).length() < 1e-6 && (found[1] - expected[1]).length() < 1e-6);
        // The mesh is drawn, and is no light besides
        assert!(scene.triangles.len() > 32);
        assert_eq!(scene.lamps[0].triangles, 0..scene.triangles.len());
    }
}

#[test]
fn a_mesh_of_two_materials_is_one_shape() {
    let two = |strength: f32| {
        let said = json!({ "arealight": { "shape": "sphere", "radius": 1 } });
        let mut writer = emitter_with(&sphere(1.0, 8, 4), json!({ "extras": said }));
        let other = writer.emitter("caps", [3.0 * strength, 2.0 * strength, strength], false);
        let mut caps = writer.root["meshes"][0]["primitives"][0].clone();
        caps["material"] = json!(other);
        writer.root["meshes"][0]["primitives"].as_array_mut().unwrap().push(caps);
        load(writer)
    };
    let scene = two(1.0);
    assert_eq!((scene.lights.len(), warnings(&scene).len()), (1, 0));
    assert_eq!(scene.lamps[0].triangles, 0..scene.triangles.len());
    let scene = two(0.5);
    assert_eq!((scene.lights.len(), scene.lights[0].radiance), (1, Vec3::new(3.0, 2.0, 1.0)));
    assert!(warnings(&scene)[0].contains("shines with the emission of its first primitive"));
}

#[test]
fn disks_face_up_and_take_any_scale() {
    let said = json!({ "shape": "disk", "radius": 2 });
    for (scale, front) in
        [([1.0, 5.0, 3.0], DVec3::Y), ([-1.0, 5.0, 3.0], DVec3::Y), ([1.0, -5.0, 3.0], DVec3::NEG_Y)]
    {
        let scene = emitter(&said, json!({ "scale": scale }), true);
        let LightShape::Disk { axis_u, axis_v, .. } = scene.lights[0].shape else { panic!("no disk") };
        assert_eq!(axis_u.cross(axis_v), front * 12.0, "{scale:?}");
        assert!(scene.lights[0].two_sided);
    }
}

#[test]
fn words_that_do_not_hold_leave_the_mesh_as_it_is() {
    let plain = json!({});
    for (said, node, text) in [
        (json!({ "shape": "cube" }), &plain, "unknown variant `cube`"),
        (json!({ "shape": "sphere" }), &plain, "missing field `radius`"),
        (json!({ "shape": "sphere", "radius": -1 }), &plain, "radius: -1 must be above zero"),
        (json!({ "shape": "capsule", "radius": 1, "height": 0 }), &plain, "both ends of the axis"),
        (json!({ "shape": "sphere", "radius": 1 }), &json!({ "scale": [1, 2, 1] }), "scale is not uniform"),
        (
            json!({ "shape": "cylinder", "radius": 1, "height": 1 }),
            &json!({ "scale": [1, 1, 2] }),
            "does not leave it round",
        ),
        (json!({ "shape": "sphere", "radius": 0.22 }), &plain, "its mesh is elsewhere"),
        (json!({ "shape": "pipe", "radius": 0.2, "height": 2 }), &plain, "its mesh is elsewhere"),
        (json!(7), &plain, "invalid type"),
    ] {
        let scene = emitter(&said, node.clone(), false);
        assert!(is_of_polygons(&scene), "{said}");
        let warnings = warnings(&scene);
        assert!(
            warnings[0].contains("extras.arealight: ") && warnings[0].contains(text),
            "{warnings:?}: {text}"
        );
    }
    // The twins: a cylinder may be longer, and facets a little outside
    let longer = json!({ "scale": [1, 2, 1] });
    let said = json!({ "shape": "cylinder", "radius": 1, "height": 1 });
    assert!(!is_of_polygons(&emitter(&said, longer, false)));
    assert!(!is_of_polygons(&emitter(&json!({ "shape": "sphere", "radius": 0.223 }), plain, false)));
}

/// A disk of radius 1 whose uv is this function of its place in x and z.
fn disk_showing(uv: impl Fn(f32, f32) -> [f32; 2], node: Value) -> Scene {
    let mut node = node;
    node["extras"] = json!({ "arealight": { "shape": "disk", "radius": 1 } });
    let mut shape = disk(1.0, 24);
    shape.uvs = shape.positions.iter().map(|[x, _, z]| uv(*x, *z)).collect();
    let mut writer = Writer::new();
    let picture = RgbImage::from_fn(16, 8, |x, y| Rgb([x as u8 * 9, y as u8 * 20, 200]));
    let texture = writer.picture("picture", &picture);
    let material = writer.emitter_of_image("glow", [3.0, 2.0, 1.0], texture, false);
    writer.object("disk", &shape, material, node);
    load(writer)
}

#[test]
fn disks_show_what_their_meshes_show() {
    // A quarter of the image, which is turned by 30 degrees; the node stretches it
    let (sin, cos) = (30_f32).to_radians().sin_cos();
    let uv = |x: f32, z: f32| [0.25 + 0.25 * (cos * x + sin * z), 0.75 + 0.25 * (cos * z - sin * x)];
    let scene = disk_showing(uv, json!({ "scale": [2, 1, 1] }));
    assert_eq!(warnings(&scene), [""; 0]);
    let [light] = &scene.lights[..] else { panic!("{} lights", scene.lights.len()) };
    let texture = light.texture.as_ref().unwrap();
    assert_eq!((texture.layer, texture.uvs.len(), light.radiance), (0, 0, Vec3::new(3.0, 2.0, 1.0)));
    let LightShape::Disk { center, axis_u, axis_v } = light.shape else { panic!("{light:?}") };
    // What is at the ends of the axes is at the middles of the box's edges
    let (sin, cos) = (f64::from(sin), f64::from(cos));
    let near = |a: DVec3, b: DVec3| (a - b).length() < 1e-4;
    assert!(near(axis_u, DVec3::new(2.0 * cos, 0.0, sin)), "{axis_u}");
    assert!(near(axis_v, DVec3::new(2.0 * sin, 0.0, -cos)), "{axis_v}");
    assert!(near(center, DVec3::ZERO) && axis_u.cross(axis_v).y > 0.0);
    let layer = scene.light_textures[0];
    assert!((layer.low - DVec2::new(0.0, 0.5)).length() < 1e-4, "{layer:?}");
    assert!((layer.size - DVec2::splat(0.5)).length() < 1e-4, "{layer:?}");
    assert!(scene.effects().contains(Effects::ELLIPSE | Effects::TEXTURED_ELLIPSE));
}

#[test]
fn what_a_disk_cannot_show_its_mesh_does() {
    let place = |x: f32, z: f32| [0.5 + 0.5 * x, 0.5 + 0.5 * z];
    for (uv, text) in [
        (Box::new(|x: f32, z: f32| [0.5 - 0.5 * x, 0.5 + 0.5 * z]) as Box<dyn Fn(f32, f32) -> _>, "mirrored"),
        (Box::new(|x, z| [0.5 + 0.3 * x + 0.2 * z, 0.5 + 0.5 * z]), "sheared"),
        (Box::new(|x, z| [0.5 + 0.5 * x * x, 0.5 + 0.5 * z]), "not laid flat"),
        (Box::new(|_, _| [0.5, 0.5]), "a line"),
    ] {
        let scene = disk_showing(uv, json!({}));
        assert!(is_of_polygons(&scene), "{text}");
        let warnings = warnings(&scene);
        assert!(
            warnings[0].contains("the mesh's own polygons shine") && warnings[0].contains(text),
            "{warnings:?}"
        );
    }
    // The twin
    assert_eq!(disk_showing(place, json!({})).lights.len(), 1);
    // Spheres have one colour
    let said = json!({ "arealight": { "shape": "sphere", "radius": 1 } });
    let mut writer = Writer::new();
    let texture = writer.picture("picture", &RgbImage::new(2, 2));
    let material = writer.emitter_of_image("glow", [3.0, 2.0, 1.0], texture, false);
    writer.object("ball", &sphere(1.0, 8, 4), material, json!({ "extras": said }));
    let scene = load(writer);
    assert_eq!(scene.lights[0].texture, None);
    assert!(warnings(&scene)[0].contains("only disks are textured"));
}

/// Whether a scene has lights, all of them polygons or meshes.
fn is_of_polygons(scene: &Scene) -> bool {
    !scene.lights.is_empty() && scene.lights.iter().all(|light| light.shape.is_polygonal())
}
