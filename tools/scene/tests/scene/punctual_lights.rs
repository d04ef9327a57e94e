//! `KHR_lights_punctual`: spheres and disks of the same intensity where a size is given, else left out with a
//! warning.

use crate::writer::Writer;
use crate::{notes, panel_with, warnings};
use arealight::{Effects, LightShape};
use arealight_scene::{LUMENS_PER_WATT, LoadOptions, Scene, SceneError};
use glam::{DVec3, Vec3};
use serde_json::{Value, json};
use std::f64::consts::{FRAC_1_SQRT_2, PI};

const RADIUS: f64 = 0.05;

/// A panel, and a light on a node.
fn file(light: &Value, node: Value) -> Writer {
    let mut writer = panel_with(json!({}));
    writer.root["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    writer.root["extensions"] = json!({ "KHR_lights_punctual": { "lights": [light] } });
    let mut node = node;
    node["extensions"] = json!({ "KHR_lights_punctual": { "light": 0 } });
    let index = writer.push("nodes", node);
    writer.root["scenes"][0]["nodes"].as_array_mut().unwrap().push(json!(index));
    writer
}

fn read(writer: Writer, light_size: Option<f64>) -> Result<Scene, SceneError> {
    Scene::from_bytes_with(&writer.glb(), "test.glb", LoadOptions { light_size, ..LoadOptions::default() })
}

fn with_size(light: &Value, node: Value) -> Scene {
    read(file(light, node), Some(RADIUS)).unwrap()
}

#[test]
fn a_point_is_a_sphere_of_its_intensity() {
    let light = json!({ "type": "point", "name": "bulb", "intensity": 683.0, "color": [1.0, 0.5, 0.0] });
    let scene = with_size(&light, json!({ "translation": [1.0, 2.0, 3.0], "scale": [4.0, 4.0, 4.0] }));
    let light = &scene.lights[0];
    assert_eq!(light.name, "bulb");
    assert_eq!(light.shape, LightShape::Sphere { center: DVec3::new(1.0, 2.0, 3.0), radius: RADIUS });
    // Radiance times the area that is seen: 683 candela are a watt a steradian
    let intensity = light.radiance * (PI * RADIUS * RADIUS) as f32;
    assert!((intensity - Vec3::new(1.0, 0.5, 0.0)).length() < 1e-6, "{intensity}");
    assert_eq!(notes(&scene), ["KHR_lights_punctual: points are spheres with a radius of 0.05 m"]);
    assert_eq!(warnings(&scene), [""; 0]);
    // It is a lamp without a mesh
    assert_eq!(scene.lamps.last().map(|lamp| (lamp.triangles.len(), lamp.lights.clone())), Some((0, 0..1)));
}

#[test]
fn a_spot_is_a_disk_that_shines_where_it_points() {
    // A quarter turn about x takes -z to +y
    let node = json!({ "rotation": [FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2] });
    let scene = with_size(&json!({ "type": "spot", "intensity": 683.0, "spot": {} }), node);
    let light = &scene.lights[0];
    let LightShape::Disk { axis_u, .. } = light.shape else { panic!("a disk") };
    assert!((axis_u.length() - RADIUS).abs() < 1e-9);
    let area = light.shape.area_vector();
    assert!((area.normalize_or_zero() - DVec3::Y).length() < 1e-6, "{area}");
    assert!((f64::from(light.radiance.x) * area.length() - 1.0).abs() < 1e-6);
    // Its cone ends at 45 degrees, where the file says nothing
    let profile = light.profile.as_ref().unwrap();
    assert!(profile.factor(1.0) == 1.0 && profile.factor(0.7) == 0.0 && profile.factor(0.72) > 0.0);
    assert_eq!(notes(&scene), ["KHR_lights_punctual: spots are disks with a radius of 0.05 m"]);
}

#[test]
fn what_a_light_is_seen_through_is_in_its_extras() {
    // The node is a tenth as large, and its lights point to +y
    let node = || json!({ "rotation": [FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2], "scale": [0.1, 0.1, 0.1] });
    let spot = |said: Value| {
        let extras = json!({ "arealight": said });
        with_size(&json!({ "type": "spot", "intensity": 683.0, "spot": {}, "extras": extras }), node())
    };
    let scene = spot(json!({ "doors": { "length": 3.0, "angle": 0.0 } }));
    let light = &scene.lights[0];
    let doors = light.opening.unwrap();
    let over = doors.center - light.shape.center();
    assert!((over - DVec3::Y * 0.3).length() < 1e-6 && doors.housed, "{over}");
    assert!((doors.axis_u.length() - RADIUS).abs() < 1e-6);
    // A window is in the node's space
    let window = json!({ "center": [0.0, 0.0, -20.0], "axis_u": [5.0, 0.0, 0.0], "axis_v": [0.0, 4.0, 0.0] });
    let opening = spot(json!({ "opening": window })).lights[0].opening.unwrap();
    assert!((opening.center - light.shape.center() - DVec3::Y * 2.0).length() < 1e-5, "{opening:?}");
    assert!((opening.axis_u - DVec3::X * 0.5).length() < 1e-6 && !opening.housed);
    // What can't be is named, and the light left out
    for (said, expected) in [
        (json!({ "doors": { "length": 3.0 } }), "extras.arealight: missing field `angle`"),
        (json!({ "doors": { "length": 0.0, "angle": 0.0 } }), "opening: doors of 0"),
        (json!({ "door": { "length": 3.0, "angle": 0.0 } }), "extras.arealight: unknown field `door`"),
        (json!({ "grid": { "columns": 2.5, "rows": 2.0, "depth": 0.1 } }), "2.5 is no whole number"),
        (json!({ "grid": { "columns": 2, "rows": 2, "depth": 0.1 } }), "opening: doors and grids are of"),
        (
            json!({ "opening": window, "doors": { "length": 3.0, "angle": 0.0 } }),
            "one of doors, grid and opening, not several",
        ),
    ] {
        let scene = spot(said);
        let warnings = warnings(&scene);
        assert!(scene.lights.is_empty() && warnings[0].contains(expected), "{warnings:?}");
    }
}

#[test]
fn what_lights_shine_on_is_in_their_nodes_extras() {
    let said = |links: Value, groups: Value| {
        let light = json!({ "type": "point", "intensity": 683.0 });
        let mut writer = file(&light, json!({ "extras": { "arealight": { "links": links } } }));
        writer.root["nodes"][0]["extras"] = json!({ "arealight": { "groups": groups } });
        read(writer, Some(RADIUS)).unwrap()
    };
    // Some writers know no whole numbers
    let scene = said(json!(4.0), json!(5));
    assert_eq!(scene.lights.iter().map(|light| light.links).collect::<Vec<_>>(), [4]);
    assert!(scene.triangles.iter().all(|triangle| triangle.groups == 5));
    assert!(scene.surfaces().contains(Effects::LINKED) && warnings(&scene).is_empty());
    // The twin, and what is none
    assert!(!said(json!(0), json!(5)).surfaces().contains(Effects::LINKED));
    let scene = said(json!(2.5), json!("all"));
    let text = |name, node| {
        format!("nodes[{node}]: extras.arealight.{name} must be a whole number from 0 to 255: left out")
    };
    assert_eq!(warnings(&scene), [text("groups", 0), text("links", 1)]);
}

#[test]
fn a_sun_lights_the_whole_scene_alike() {
    let sun = json!({ "type": "directional", "intensity": 2.0 * LUMENS_PER_WATT });
    let scene = read(file(&sun, json!({})), None).unwrap();
    assert_eq!(scene.lights, with_size(&sun, json!({})).lights, "its size is its own");
    let light = &scene.lights[0];
    let LightShape::Disk { center, axis_u, .. } = light.shape else { panic!("a disk") };
    // It shines along -z: it is where z is large
    let distance = (center - scene.bounds.center()).length();
    assert!(center.z > 100.0 * scene.bounds.diagonal() && distance > 0.99 * center.z);
    // Half a degree wide, and 2 W/m² where it arrives at right angles
    let sine = axis_u.length() / distance.hypot(axis_u.length());
    assert!((sine - 4.65e-3).abs() < 1e-5);
    assert!((f64::from(light.radiance.x) * PI * sine * sine - 2.0).abs() < 1e-4);
    assert_eq!(notes(&scene), ["KHR_lights_punctual: suns are disks of half a degree, far away"]);
}

#[test]
fn the_file_s_own_radius_counts_before_that_of_the_options() {
    let light = || json!({ "type": "point", "extras": { "arealight": { "radius": 0.2 } } });
    for size in [None, Some(RADIUS)] {
        let scene = read(file(&light(), json!({})), size).unwrap();
        assert_eq!(scene.lights[0].shape, LightShape::Sphere { center: DVec3::ZERO, radius: 0.2 });
    }
}

#[test]
fn what_has_no_size_or_no_sense_is_left_out_and_said() {
    let of = |light: &Value, size| {
        let scene = read(file(light, json!({})), size).unwrap();
        assert!(scene.lights.is_empty());
        warnings(&scene)
    };
    let point = || json!({ "type": "point" });
    assert_eq!(
        of(&point(), None),
        ["KHR_lights_punctual: points have no area: lights without a size are left out (--light-size \
            gives them one)"]
    );
    for (light, size, words) in [
        (json!({ "type": "lamp" }), RADIUS, "type 'lamp' is not known: left out"),
        (point(), 0.0, "a radius of 0 m: left out"),
        (point(), -1.0, "a radius of -1 m: left out"),
        (json!({ "type": "point", "intensity": -1.0 }), RADIUS, "radiance"),
        (json!({ "type": "point", "intensity": 1e300 }), RADIUS, "radiance"),
    ] {
        let said = of(&light, Some(size));
        assert!(said.iter().any(|line| line.contains(words)), "{said:?} without {words}");
    }
    // A file that contradicts itself is refused
    let mut writer = file(&point(), json!({}));
    writer.root["extensions"] = json!({});
    let error = read(writer, None).unwrap_err().to_string();
    assert!(error.contains("extensions.KHR_lights_punctual: is missing"), "{error}");
    let mut writer = file(&point(), json!({}));
    writer.root["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = json!(7);
    let error = read(writer, None).unwrap_err().to_string();
    assert!(error.contains("light 7 of 1"), "{error}");
}

#[test]
fn a_scene_s_fog_is_that_of_its_extras() {
    let fog = |said: Value| {
        let mut writer = file(&json!({ "type": "point" }), json!({}));
        writer.root["scenes"][0]["extras"] = json!({ "arealight": said });
        let scene = read(writer, Some(RADIUS)).unwrap();
        let is_warned = warnings(&scene)
            .iter()
            .any(|warning| warning.contains("extras.arealight.fog: must have a density above 0"));
        (scene.fog.map(|fog| [fog.density, fog.anisotropy, fog.albedo]), is_warned)
    };
    assert_eq!(fog(json!({ "fog": { "density": 0.5 } })), (Some([0.5, 0.0, 1.0]), false));
    let said = json!({ "fog": { "density": 2, "anisotropy": -0.5, "albedo": 0.9 } });
    assert_eq!(fog(said), (Some([2.0, -0.5, 0.9]), false));
    for none in [json!({}), json!("mist"), json!(null)] {
        assert_eq!(fog(none), (None, false));
    }
    for wrong in [
        json!({}),
        json!({ "density": 0 }),
        json!({ "density": "much" }),
        json!({ "density": 1e300 }),
        json!({ "density": 1, "anisotropy": 1 }),
        json!({ "density": 1, "albedo": -0.1 }),
        json!({ "density": 1, "albedo": [1, 1, 1] }),
    ] {
        assert_eq!(fog(json!({ "fog": wrong })), (None, true), "{wrong}");
    }
}
