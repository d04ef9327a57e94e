//! `--lights studio`: models that bring no light.

use crate::common::{device, json_of, refuse, run, scene, text};
use std::path::{Path, PathBuf};

/// A pyramid on a floor, of one gray material, scaled by `scale`.
fn model(folder: &Path, name: &str, scale: &str) -> PathBuf {
    let corners: [[f32; 3]; 9] = [
        [-2.0, 0.0, -2.0],
        [-2.0, 0.0, 2.0],
        [2.0, 0.0, 2.0],
        [2.0, 0.0, -2.0],
        [0.0, 1.5, 0.0],
        [-0.8, 0.0, 0.8],
        [0.8, 0.0, 0.8],
        [0.8, 0.0, -0.8],
        [-0.8, 0.0, -0.8],
    ];
    let triangles: [[u16; 3]; 6] = [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7], [4, 7, 8], [4, 8, 5]];
    let mut bytes: Vec<u8> = corners.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend(triangles.iter().flatten().flat_map(|i| i.to_le_bytes()));
    std::fs::write(folder.join("model.bin"), &bytes).unwrap();
    let path = folder.join(name);
    let text = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
        "nodes":[{"mesh":0,"scale":[$,$,$]}],
        "materials":[{"pbrMetallicRoughness":
            {"baseColorFactor":[0.5,0.5,0.5,1],"metallicFactor":0,"roughnessFactor":0.6}}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":9,"type":"VEC3",
            "min":[-2,0,-2],"max":[2,1.5,2]},
            {"bufferView":1,"componentType":5123,"count":18,"type":"SCALAR"}],
        "bufferViews":[{"buffer":0,"byteLength":108},{"buffer":0,"byteOffset":108,"byteLength":36}],
        "buffers":[{"uri":"model.bin","byteLength":144}]}"#;
    std::fs::write(&path, text.replace('$', scale)).unwrap();
    path
}

/// What a successful run says: its JSON, and standard error.
fn said(folder: &Path, arguments: &[&str]) -> (serde_json::Value, String) {
    let output = run(folder, arguments);
    (json_of(&output), text(&output.stderr))
}

#[test]
fn a_model_without_lights_is_shown_by_the_studio() {
    let Some(()) = device() else { return };
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    model(folder, "model.gltf", "1");
    model(folder, "large.gltf", "1000");
    let render = |scene: &str, picture: &str, more: &[&str]| {
        let common = ["render", scene, "-o", picture, "--json", "--size", "48x27"];
        said(folder, &[&common, more].concat())
    };
    // As it is, and what to do
    let (summary, words) = render("model.gltf", "dark.png", &[]);
    assert_eq!(summary["lights"], 0);
    assert!(words.contains("surfaces are black (--lights studio adds softboxes)"), "{words}");
    // Lit, and nothing to say
    let (summary, words) = render("model.gltf", "lit.png", &["--lights", "studio"]);
    assert_eq!((&summary["lights"], &*words), (&6.into(), ""));
    let mean = |name: &str| {
        let picture = image::open(folder.join(name)).unwrap().to_luma8();
        picture.pixels().map(|p| f64::from(p.0[0])).sum::<f64>() / f64::from(48 * 27)
    };
    assert_eq!(mean("dark.png"), 0.0);
    let lit = mean("lit.png");
    assert!((20.0..200.0).contains(&lit), "neither dark nor white: {lit}");
    // Of any size, and by Monte Carlo
    render("large.gltf", "large.png", &["--lights", "studio"]);
    render("model.gltf", "truth.png", &["--lights", "studio", "--reference", "64"]);
    for name in ["large.png", "truth.png"] {
        assert!((mean(name) / lit - 1.0).abs() < 0.05, "{name}: {} for {lit}", mean(name));
    }
}

#[test]
fn softboxes_are_added_to_what_the_file_has() {
    let folder = tempfile::tempdir().unwrap();
    let screen = scene("screen.glb");
    let effects = |more: &[&str]| said(folder.path(), &[&["effects", &screen, "--json"], more].concat()).0;
    assert_eq!(effects(&["--lights", "studio"]), effects(&[]), "one-sided rectangles need nothing more");
    let Some(()) = device() else { return };
    let lights = |more: &[&str]| {
        let common = ["render", &screen, "-o", "a.png", "--json", "--size", "16x9"];
        said(folder.path(), &[&common, more].concat()).0["lights"].as_u64().unwrap()
    };
    assert_eq!(lights(&["--lights", "studio"]), lights(&["--lights", "file"]) + 6);
}

#[test]
fn what_cannot_be_lit_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    model(folder.path(), "model.gltf", "1");
    let words = ["--lights", "'sun'", "file", "studio"];
    refuse(folder.path(), &["render", "model.gltf", "--lights", "sun"], 2, &words);
}
