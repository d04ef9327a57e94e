//! Animations, and meshes that are morphed.

use crate::shapes::panel;
use crate::writer::Writer;
use crate::{emitter_with, load, notes, warnings};
use arealight_scene::{LoadOptions, Scene, SceneError};
use glam::{DQuat, DVec3};
use serde_json::{Value, json};

/// A channel of node 0 whose keys are at 1, 2 and 4 seconds.
fn animated<const N: usize>(path: &str, interpolation: &str, values: &[[f32; N]]) -> Writer {
    let mut writer = emitter_with(
        &panel(2.0, 1.0),
        json!({ "matrix": [
        2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 5, 6, 7, 1] }),
    );
    add(&mut writer, path, interpolation, values);
    writer
}

fn add<const N: usize>(writer: &mut Writer, path: &str, interpolation: &str, values: &[[f32; N]]) {
    let (input, output) = (writer.floats(&[[1.0_f32], [2.0], [4.0]]), writer.floats(values));
    writer.push(
        "animations",
        json!({ "channels": [{ "sampler": 0, "target": { "node": 0, "path": path } }],
                "samplers": [{ "input": input, "output": output, "interpolation": interpolation }] }),
    );
}

fn at(writer: &Writer, time: f64) -> Result<Scene, SceneError> {
    let options = LoadOptions { time: Some(time), ..LoadOptions::default() };
    Scene::from_bytes_with(&writer.clone().glb(), "test.glb", options)
}

/// The light's center and its area vector.
fn light_at(writer: &Writer, time: f64) -> [DVec3; 2] {
    let scene = at(writer, time).unwrap();
    assert_eq!(warnings(&scene), [""; 0]);
    [scene.lights[0].shape.center(), scene.lights[0].shape.area_vector()]
}

#[test]
fn nodes_are_where_they_are_at_a_time() {
    let line = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 4.0, 0.0]];
    let linear = animated("translation", "LINEAR", &line);
    for (time, x, y) in
        [(-9.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.25, 0.25, 0.0), (3.0, 1.0, 2.0), (9.0, 1.0, 4.0)]
    {
        let [center, area] = light_at(&linear, time);
        assert!(center.distance(DVec3::new(x, y, 0.0)) < 1e-6, "{time}: {center}");
        assert!(area.distance(DVec3::Z * 8.0) < 1e-5, "its scale stays: {area}");
    }
    let step = animated("translation", "STEP", &line);
    assert_eq!(light_at(&step, 1.9)[0], DVec3::ZERO);
    assert_eq!(light_at(&step, 2.0)[0], DVec3::X);
    // The twin: at rest it is elsewhere, and that is said
    let scene = load(linear);
    assert_eq!(scene.lights[0].shape.center(), DVec3::new(5.0, 6.0, 7.0));
    assert_eq!(warnings(&scene), ["animations: the scene is shown at rest, not at a time (--time)"]);
}

#[test]
fn rotations_go_the_short_way_and_splines_bend() {
    // A quarter turn about x, then on by a quarter in the quaternion's other sign
    let turned = |angle: f64, sign: f64| (DQuat::from_rotation_x(angle) * sign).as_quat().to_array();
    let quarter = std::f64::consts::FRAC_PI_2;
    let rotation = animated(
        "rotation",
        "LINEAR",
        &[turned(0.0, 1.0), turned(quarter, 1.0), turned(2.0 * quarter, -1.0)],
    );
    for (time, angle) in [(1.5, 0.5 * quarter), (3.0, 1.5 * quarter)] {
        let [_, area] = light_at(&rotation, time);
        assert!(area.distance(DQuat::from_rotation_x(angle) * DVec3::Z * 8.0) < 1e-5, "{time}: {area}");
    }
    // Tangents in, value, tangents out: a parabola, y = x^2, which the spline has exactly
    let key = |x: f32| [[0.0, 2.0 * x, 0.0], [x, x * x, 0.0], [0.0, 2.0 * x, 0.0]];
    let mut keys = [key(1.0), key(2.0), key(4.0)].concat();
    keys.iter_mut().step_by(3).for_each(|into| into[0] = 1.0);
    keys.iter_mut().skip(2).step_by(3).for_each(|out| out[0] = 1.0);
    let spline = animated("translation", "CUBICSPLINE", &keys);
    for time in [1.0, 1.3, 2.0, 3.5, 4.0] {
        let [center, _] = light_at(&spline, time);
        assert!(center.distance(DVec3::new(time, time * time, 0.0)) < 1e-5, "{time}: {center}");
    }
}

#[test]
fn meshes_are_morphed_at_rest_and_in_time() {
    // Node 0 has one target a metre up, another that is twice as wide
    let morphed = |weights: Value| {
        let mut writer = emitter_with(&panel(2.0, 1.0), json!({}));
        let up = writer.floats(&[[0.0, 0.0, 1.0]; 4]);
        let wide = panel(2.0, 1.0).positions.iter().map(|[x, ..]| [*x, 0.0, 0.0]).collect::<Vec<_>>();
        let wide = writer.floats(&wide);
        let primitive = &mut writer.root["meshes"][0]["primitives"][0];
        primitive["targets"] = json!([{ "POSITION": up }, { "POSITION": wide }]);
        writer.root["meshes"][0]["weights"] = weights;
        writer
    };
    let expect = |scene: Scene, height: f64, width: f64| {
        let shape = &scene.lights[0].shape;
        assert!(shape.center().distance(DVec3::Z * height) < 1e-6, "{}", shape.center());
        assert!((shape.area_vector().z - width).abs() < 1e-6, "{}", shape.area_vector());
    };
    expect(load(morphed(json!([0, 0]))), 0.0, 2.0);
    expect(load(morphed(json!([0.5, 1]))), 0.5, 4.0);
    let mut node = morphed(json!([0.5, 1]));
    node.root["nodes"][0]["weights"] = json!([0.25, 0]);
    expect(load(node), 0.25, 2.0);
    // Two numbers a key
    let mut moving = morphed(json!([0.5, 1]));
    add(&mut moving, "weights", "LINEAR", &[[0.0], [0.0], [1.0], [0.5], [1.0], [1.0]]);
    expect(at(&moving, 1.5).unwrap(), 0.5, 2.5);
    // Not as many as vertices
    let mut short = morphed(json!([1, 0]));
    let three = short.floats(&[[0.0, 0.0, 1.0]; 3]);
    short.root["meshes"][0]["primitives"][0]["targets"][0]["NORMAL"] = json!(three);
    let message = crate::error(short);
    assert!(message.contains("targets[0].NORMAL: 3 for 4 positions"), "{message}");
}

#[test]
fn the_first_animation_that_moves_something_moves_it() {
    let place = |x: f32| [[x, 0.0, 0.0]; 3];
    let mut writer = animated("translation", "LINEAR", &place(1.0));
    add(&mut writer, "translation", "LINEAR", &place(2.0));
    add(&mut writer, "scale", "STEP", &[[3.0, 3.0, 3.0]; 3]);
    let scene = at(&writer, 2.0).unwrap();
    assert_eq!(scene.lights[0].shape.center(), DVec3::X);
    assert!((scene.lights[0].shape.area_vector().z - 18.0).abs() < 1e-5, "the third one scales it");
    assert_eq!(notes(&scene), ["animations: 1 channels move what an earlier animation moves: left out"]);
}

#[test]
fn channels_of_extensions_are_passed_over_and_bad_ones_named() {
    let good = || animated("translation", "LINEAR", &[[1.0_f32, 0.0, 0.0]; 3]);
    let mut pointer = good();
    let channels = pointer.root["animations"][0]["channels"].as_array_mut().unwrap();
    channels.push(json!({ "sampler": 0, "target": { "path": "pointer" } }));
    assert_eq!(light_at(&pointer, 1.0)[0], DVec3::X);
    for (change, text) in [
        ((|it| it["channels"][0]["sampler"] = json!(7)) as fn(&mut Value), "sampler"),
        (|it| it["channels"][0]["target"]["node"] = json!(9), "node"),
        (|it| it["samplers"][0]["input"] = json!(99), "input"),
        (|it| it["samplers"][0]["interpolation"] = json!("CUBICSPLINE"), "9 numbers for 3 times"),
        (|it| it["channels"][0]["target"]["path"] = json!("rotation"), "is Vec3, should be Vec4"),
    ] {
        let mut bad = good();
        change(&mut bad.root["animations"][0]);
        let message = at(&bad, 1.0).unwrap_err().to_string();
        assert!(message.contains(text), "{message}");
    }
    let mut back = good();
    let times = back.floats(&[[1.0_f32], [3.0], [2.0]]);
    back.root["animations"][0]["samplers"][0]["input"] = json!(times);
    let message = at(&back, 1.0).unwrap_err().to_string();
    assert!(message.contains("animations[0].channels[0]: its times do not ascend"), "{message}");
    // Nothing in it
    let mut empty = good();
    for name in ["input", "output"] {
        let accessor = empty.root["animations"][0]["samplers"][0][name].as_u64().unwrap() as usize;
        empty.root["accessors"][accessor]["count"] = json!(0);
    }
    assert!(at(&empty, 1.0).is_ok_and(|scene| scene.lights[0].shape.center().x == 5.0));
}
