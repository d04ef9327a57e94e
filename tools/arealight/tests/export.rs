//! `arealight export` as a user meets it.

mod common;

use common::run;
use serde_json::Value;
use sha2::{Digest as _, Sha256};
use std::path::Path;

/// Exports to `DIR` in `folder`, and returns what is printed.
fn export(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, &[&["export", "DIR"], arguments].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Exports to `DIR`, which must fail with `words`.
fn refuse(folder: &Path, words: &str) {
    let output = run(folder, &["export", "DIR"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(5), "{said}");
    assert!(said.contains(words), "{said}");
}

fn manifest(folder: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(folder.join("DIR/manifest.json")).unwrap()).unwrap()
}

/// Compares each file of a folder, and of those in it, with that of the same name in another. How many there are.
fn compare_folders(folder: &Path, other: &Path) -> usize {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries
        .map(|path| {
            let twin = other.join(path.file_name().unwrap());
            if path.is_dir() {
                return compare_folders(&path, &twin);
            }
            assert_eq!(std::fs::read(&twin).unwrap(), std::fs::read(&path).unwrap(), "{}", path.display());
            1
        })
        .sum()
}

#[test]
fn everything_that_the_manifest_names_is_there() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let said: Value = serde_json::from_str(&export(folder, &["--json"])).unwrap();
    let manifest = manifest(folder);
    let files = manifest["files"].as_object().unwrap();
    assert_eq!(files.len() + 1, said["files"].as_array().unwrap().len());
    for (path, file) in files {
        let bytes = std::fs::read(folder.join("DIR").join(path)).unwrap();
        assert_eq!(file["bytes"], bytes.len(), "{path}");
    }
    // The library is that of the checkout, every file of it
    let library = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shaders/include/arealight");
    let compared = compare_folders(&library, &folder.join("DIR/include/arealight"));
    assert!(compared > 20, "{compared} files");
    // The tables are tables, of the sizes that are said
    for name in ["ggx.ktx2", "ggx.dds", "ggx.exr"] {
        let table = arealight_table::load(&folder.join("DIR/tables").join(name)).unwrap();
        assert_eq!(
            manifest["memory"]["table"]["rgba16f"],
            table.size().pow(2) * arealight::table::LAYERS * 8
        );
    }
}

#[test]
fn the_manifest_says_what_a_host_defines_and_binds() {
    let folder = tempfile::tempdir().unwrap();
    export(folder.path(), &[]);
    let manifest = manifest(folder.path());
    let bridge = |name: &str| {
        let bridges = manifest["bridges"].as_array().unwrap();
        bridges.iter().find(|bridge| bridge["name"] == name).unwrap_or_else(|| panic!("{name}")).clone()
    };
    let table = bridge("arealight_bridge_table");
    assert_eq!(table["prototype"], "vec4 arealight_bridge_table(int layer, ivec2 texel)");
    assert_eq!(table["needed_with"], "always");
    assert_eq!(bridge("arealight_bridge_light_texture")["needed_with"], "AREALIGHT_LIGHT_TEXTURES 1");
    let surface = bridge("arealight_bridge_surface");
    assert_eq!(
        (&surface["declared_in"], &surface["needed_with"]),
        (&Value::from("kernels/g_buffer.glsl"), &Value::from("AREALIGHT_HOST_G_BUFFER 1"),)
    );
    let needed = |header: &str| manifest["headers"][header].as_array().unwrap().len();
    // All but those of kernels
    let bridges = manifest["bridges"].as_array().unwrap();
    let of_kernels = bridges
        .iter()
        .filter(|bridge| bridge["declared_in"].as_str().unwrap().starts_with("kernels/"))
        .count();
    assert_eq!(of_kernels, 3, "a surface, what blocks, what arrives");
    assert_eq!(needed("arealight/arealight.glsl"), bridges.len() - of_kernels);
    assert_eq!(needed("arealight/surface.glsl"), 0);
    let shade = &manifest["kernels"]["shade"];
    assert_eq!(shade["bindings"][0]["name"], "table_image");
    assert_eq!(shade["specialization_constants"]["EFFECTS"], 0);
    assert_eq!(manifest["effects"]["diffuse"], 1);
    // Level 0 alone takes 8 bytes a texel
    let layer = manifest["memory"]["light_texture_layer"]["64 x 64"].as_u64().unwrap();
    assert!((64 * 64 * 8..64 * 64 * 11).contains(&layer), "{layer}");
}

#[test]
fn an_export_replaces_its_own_files_and_nobody_elses() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    export(folder, &[]);
    let first = std::fs::read(folder.join("DIR/manifest.json")).unwrap();
    export(folder, &[]);
    assert_eq!(std::fs::read(folder.join("DIR/manifest.json")).unwrap(), first, "the same each time");

    // One that was changed
    let quad = folder.join("DIR/include/arealight/lights/quad.glsl");
    let original = std::fs::read(&quad).unwrap();
    std::fs::write(&quad, "mine").unwrap();
    refuse(folder, "include/arealight/lights/quad.glsl");
    assert_eq!(std::fs::read(&quad).unwrap(), b"mine");
    let said = export(folder, &["--force", "--json"]);
    assert_eq!(std::fs::read(&quad).unwrap(), original);
    let said: Value = serde_json::from_str(&said).unwrap();
    assert_eq!(said["replaced"][0], "include/arealight/lights/quad.glsl");

    // One that an earlier version wrote is replaced, and one that is no longer a part is named
    std::fs::write(&quad, "earlier").unwrap();
    let mut earlier = manifest(folder);
    let hash: Vec<String> = Sha256::digest("earlier").iter().map(|byte| format!("{byte:02x}")).collect();
    earlier["files"]["include/arealight/lights/quad.glsl"]["sha256"] = hash.concat().into();
    earlier["files"]["include/arealight/gone.glsl"] =
        earlier["files"]["include/arealight/lights/quad.glsl"].clone();
    std::fs::write(folder.join("DIR/manifest.json"), earlier.to_string()).unwrap();
    let said = export(folder, &[]);
    assert_eq!(std::fs::read(&quad).unwrap(), original);
    assert!(said.contains("include/arealight/gone.glsl is of an earlier export"), "{said}");
}

#[test]
fn a_folder_that_is_somebody_elses_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::create_dir(folder.join("DIR")).unwrap();
    std::fs::write(folder.join("DIR/manifest.json"), "{\"name\": \"a game\"}").unwrap();
    refuse(folder, "manifest.json");
    assert_eq!(std::fs::read_dir(folder.join("DIR")).unwrap().count(), 1, "nothing was written");
    // A file where the folder should be
    std::fs::remove_dir_all(folder.join("DIR")).unwrap();
    std::fs::write(folder.join("DIR"), "").unwrap();
    refuse(folder, "DIR");
}
