//! `EXT_lights_ies`: flat lights of the file's size, candela and lumens.

use crate::writer::Writer;
use crate::{panel_with, warnings};
use arealight::{IesProfile, Light, LightShape};
use arealight_oracle::cubature::Settings;
use arealight_oracle::material::Surface;
use arealight_oracle::shading::{RelativeLight, truth};
use arealight_scene::{LUMENS_PER_WATT, LoadOptions, Scene, SceneError};
use glam::{DVec3, Vec3};
use serde_json::{Value, json};
use std::f64::consts::{FRAC_1_SQRT_2, PI};

fn ies(name: &str) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/ies/");
    std::fs::read_to_string(format!("{folder}{name}.ies")).unwrap()
}

/// A panel, and a luminaire that hangs at the origin: its node's -Z points to -y.
fn file(text: &str, instance: Value) -> Writer {
    let mut writer = panel_with(json!({}));
    let view = writer.view(text.as_bytes());
    writer.use_extension("EXT_lights_ies");
    writer.root["extensionsRequired"] = json!(["EXT_lights_ies"]);
    let light = json!({ "bufferView": view, "mimeType": "application/x-ies-lm-63", "name": "lamp" });
    writer.root["extensions"] = json!({ "EXT_lights_ies": { "lights": [light] } });
    let mut instance = instance;
    instance["light"] = json!(0);
    let rotation = [-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2];
    let extensions = json!({ "EXT_lights_ies": instance });
    writer.node(json!({ "rotation": rotation, "scale": [3.0, 3.0, 3.0], "extensions": extensions }));
    writer
}

fn read(text: &str, instance: Value, light_size: Option<f64>) -> Result<Scene, SceneError> {
    let options = LoadOptions { light_size, ..LoadOptions::default() };
    Scene::from_bytes_with(&file(text, instance).glb(), "test.glb", options)
}

/// What a white floor that faces the lamp reflects at a place.
fn seen_at(light: &Light, place: DVec3) -> f64 {
    let white = Surface { diffuse_albedo: DVec3::ONE, ..Surface::default() };
    let light = RelativeLight::new(light, place);
    truth(&white, DVec3::Y, DVec3::Y, &light, &Settings::default()).radiance.x
}

#[test]
fn a_luminaire_has_its_file_s_size_candela_and_lumens() {
    for (name, area) in [("round", PI * 0.08 * 0.08), ("batwing", 0.08 * 1.2), ("street", 0.24 * 0.45)] {
        let lamp = IesProfile::parse(&ies(name)).unwrap();
        let scene = read(&ies(name), json!({ "multiplier": 2.0, "color": [1.0, 0.5, 0.0] }), None).unwrap();
        assert_eq!(warnings(&scene), [""; 0], "{name}");
        let light = &scene.lights[0];
        assert_eq!(light.name, "lamp");
        let normal = light.shape.area_vector();
        assert!((normal.normalize_or_zero() + DVec3::Y).length() < 1e-6, "{name}: {normal}");
        // The scale of its node is none of the light's
        assert!((normal.length() / area - 1.0).abs() < 1e-6, "{name}: {}", normal.length());
        assert!((light.shape.first_edge() - DVec3::X).length() < 1e-6, "{name}");
        assert_eq!(light.radiance, Vec3::new(1.0, 0.5, 0.0) * light.radiance.x);
        let profile = light.profile.as_ref().unwrap();
        let flux = f64::from(light.radiance.x) * LUMENS_PER_WATT * area * PI * profile.power();
        assert!((flux / (2.0 * lamp.lumens()[0]) - 1.0).abs() < 5e-3, "{name}: {flux} lm");
        // Far below the candela over the squared distance; +X is azimuth 0, -Z a quarter turn on from it
        for (degrees, azimuth) in
            [(0.0_f64, 0.0_f64), (30.0, 0.0), (45.0, 90.0), (55.0, 160.0), (50.0, 270.0)]
        {
            let [(sin, cos), (side, ahead)] = [degrees, azimuth].map(|angle| angle.to_radians().sin_cos());
            let found = seen_at(light, 20.0 * DVec3::new(sin * ahead, -cos, -sin * side));
            let candela = 2.0 * lamp.candela_at(degrees, azimuth);
            let expected = candela * cos / (LUMENS_PER_WATT * 400.0 * PI);
            let most =
                2.0 * lamp.candela.iter().copied().fold(0.0, f64::max) / (LUMENS_PER_WATT * 400.0 * PI);
            // What goes along the light's plane goes elsewhere, and a pair of degrees is a line
            assert!((found - expected).abs() < 0.01 * most, "{name} {degrees} {azimuth}: {found} {expected}");
        }
    }
    // The twin: the street lamp shines to the front of its pole
    let scene = read(&ies("street"), json!({}), None).unwrap();
    let [front, back] = [-5.0, 5.0].map(|z| seen_at(&scene.lights[0], DVec3::new(0.0, -8.0, z)));
    assert!(front > 3.0 * back, "{front} {back}");
}

#[test]
fn round_openings_are_circles_or_ellipses() {
    for (sizes, axes) in
        [("-0.16 -0.16", [0.08, 0.08]), ("-0.16 0", [0.08, 0.08]), ("-0.16 -0.4", [0.2, 0.08])]
    {
        let text = ies("round").replace("-0.16 -0.16", sizes);
        let scene = read(&text, json!({}), None).unwrap();
        let LightShape::Disk { axis_u, axis_v, .. } = scene.lights[0].shape else { panic!("no disk") };
        let found = [axis_u, axis_v].map(DVec3::length);
        assert!(
            found.iter().zip(axes).all(|(found, axis)| (found - axis).abs() < 1e-9),
            "{sizes}: {found:?}"
        );
    }
}

#[test]
fn what_of_a_luminaire_cannot_be_is_said() {
    let round = ies("round");
    let point = round.replace("1 2 -0.16 -0.16 0", "1 2 0 0 0");
    let scene = read(&point, json!({}), None).unwrap();
    assert!(warnings(&scene)[0].contains("its file has no size (--light-size gives it one): left out"));
    assert!(scene.lights.is_empty());
    let LightShape::Disk { axis_u, .. } = read(&point, json!({}), Some(0.3)).unwrap().lights[0].shape else {
        panic!("a disk")
    };
    assert!((axis_u.length() - 0.3).abs() < 1e-9);
    let upward = "IESNA:LM-63-2002\nTILT=NONE\n1 1 1 3 1 1 2 0.1 0.1 0\n1 1 1\n0 90 180\n0\n10 10 10\n";
    let said = warnings(&read(upward, json!({}), None).unwrap());
    assert_eq!(said, ["light 'lamp': 50 % of its lumens go up: a flat light sends none there"]);
    let bad = warnings(&read(&round.replace("TILT=NONE", ""), json!({}), None).unwrap());
    assert!(bad[0].contains("EXT_lights_ies.lights[0]: TILT: there is no line"), "{bad:?}");
    let negative = warnings(&read(&round, json!({ "multiplier": -1.0 }), None).unwrap());
    assert!(negative[0].contains("multiplier: -1: left out"), "{negative:?}");
    let mut writer = file(&round, json!({}));
    writer.root["extensions"]["EXT_lights_ies"]["lights"][0] = json!({});
    let refused = Scene::from_bytes(&writer.glb(), "test.glb").unwrap_err().to_string();
    assert!(
        refused.contains("extensions.EXT_lights_ies.lights[0]: has neither uri nor bufferView"),
        "{refused}"
    );
}
