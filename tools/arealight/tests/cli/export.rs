//! `arealight export` as a user meets it.

use crate::common::{self, printed, run};
use arealight::gpu::{GpuLight, GpuShape, ShadeConstants};
use arealight::kernels::Kernel;
use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};
use std::mem::offset_of;
use std::path::Path;
use std::process::Command;

/// Exports to `DIR` in `folder`, and returns what is printed.
fn export(folder: &Path, arguments: &[&str]) -> String {
    printed(&run(folder, &[&["export", "DIR"], arguments].concat()))
}

/// Exports to `DIR`, which must fail with `words`.
fn refuse(folder: &Path, words: &str) {
    common::refuse(folder, &["export", "DIR"], 5, &[words]);
}

fn manifest(folder: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(folder.join("DIR/manifest.json")).unwrap()).unwrap()
}

/// Compares each file of a folder, and of those in it, with that of the same name in another. How many there
/// are.
fn compare_folders(folder: &Path, other: &Path) -> usize {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries
        .map(|path| {
            let twin = other.join(path.file_name().unwrap());
            if path.is_dir() {
                return compare_folders(&path, &twin);
            }
            assert!(std::fs::read(&twin).unwrap() == std::fs::read(&path).unwrap(), "{}", path.display());
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
    let surface = bridge("arealight_bridge_surface");
    assert_eq!(
        (&surface["declared_in"], &surface["declared_with"]),
        (&Value::from("kernels/g_buffer.glsl"), &Value::from("AREALIGHT_HOST_G_BUFFER 1"),)
    );
    let needed = |header: &str| manifest["headers"][header].as_object().unwrap().len();
    let options = |bridge: &str| manifest["headers"]["arealight/arealight.glsl"][bridge].clone();
    assert_eq!(options("arealight_bridge_table"), json!(["always"]));
    assert_eq!(options("arealight_bridge_profile"), json!(["AREALIGHT_SHAPED 1"]));
    let outlines = ["AREALIGHT_MESHES 1", "AREALIGHT_POLYGONS 1", "AREALIGHT_SHAPED 1"];
    assert_eq!(options("arealight_bridge_vertex"), json!(outlines));
    // All but those of kernels
    let bridges = manifest["bridges"].as_array().unwrap();
    let of_kernels = bridges
        .iter()
        .filter(|bridge| bridge["declared_in"].as_str().unwrap().starts_with("kernels/"))
        .count();
    assert_eq!(of_kernels, 4, "a surface, what blocks, how much of it is there, what arrives");
    assert_eq!(needed("arealight/arealight.glsl"), bridges.len() - of_kernels);
    assert_eq!(needed("arealight/surface.glsl"), 0);
    let shade = &manifest["kernels"]["shade"];
    assert_eq!(shade["bindings"][0]["name"], "table_image");
    assert_eq!(shade["specialization_constants"]["EFFECTS"], 0);
    assert_eq!(manifest["effects"]["diffuse"], 1);
    // Level 0 alone takes 32 bytes a texel
    let layer = manifest["memory"]["light_texture_layer"]["64 x 64"].as_u64().unwrap();
    assert!((64 * 64 * 32..64 * 64 * 44).contains(&layer), "{layer}");
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

/// Exports in every language, and returns the manifest.
fn export_translated(folder: &Path, effects: &str) -> Value {
    export(folder, &["--target", "webgpu,hlsl,msl", "--effects", effects]);
    manifest(folder)
}

#[test]
fn a_target_says_what_its_kernel_binds_and_how_that_is_laid_out() {
    let folder = tempfile::tempdir().unwrap();
    let manifest = export_translated(folder.path(), "diffuse,glossy,polygon,textured,sphere");
    let target = &manifest["targets"]["webgpu"];
    let text =
        std::fs::read_to_string(folder.path().join("DIR").join(target["file"].as_str().unwrap())).unwrap();
    // Bindings are those of the text
    let bindings = target["bindings"].as_array().unwrap();
    for binding in bindings {
        let said = format!("@group({}) @binding({})", binding["group"], binding["binding"]);
        assert!(text.contains(&said), "{said}");
    }
    assert_eq!(text.matches("@binding(").count(), bindings.len());
    let names: Vec<&str> = bindings.iter().filter_map(|binding| binding["name"].as_str()).collect();
    assert!(names.contains(&"light_sampler") && names.contains(&"shapes"), "{names:?}");

    // Offsets are those that the packed lights and a frame's constants have in Rust
    let offset = |layout: &str, field: &str| {
        let fields = target["structs"][layout]["fields"].as_array().unwrap();
        let field = fields.iter().find(|one| one["name"] == field).unwrap_or_else(|| panic!("{field}"));
        field["offset"].as_u64().unwrap() as usize
    };
    assert_eq!(offset("ShadeConstants", "camera"), offset_of!(ShadeConstants, camera));
    assert_eq!(offset("ShadeConstants", "size"), offset_of!(ShadeConstants, size));
    assert_eq!(offset("ShadeConstants", "offset"), offset_of!(ShadeConstants, offset));
    assert_eq!(offset("ArealightGpuLight", "flags"), offset_of!(GpuLight, flags));
    assert_eq!(offset("ArealightGpuShape", "axis_v"), offset_of!(GpuShape, axis_v));
    assert_ne!(
        offset("ArealightGpuLight", "center"),
        offset_of!(GpuLight, radiance),
        "the comparison can fail"
    );
    assert_eq!(target["structs"]["ArealightGpuLight"]["size"], size_of::<GpuLight>());

    // Metal has tables of its own
    let slots = manifest["targets"]["msl"]["bindings"].as_array().unwrap();
    assert!(
        slots.iter().all(|slot| ["buffer", "texture", "sampler"].iter().any(|table| slot[table].is_u64()))
    );
}

#[test]
fn hlsl_is_what_another_compiler_takes() {
    let folder = tempfile::tempdir().unwrap();
    // Without sheen and anisotropy: glslang's HLSL has no functions that return arrays, of which naga makes
    // tables of constants
    let manifest = export_translated(folder.path(), "diffuse,glossy,polygon,two_sided,coat");
    let target = &manifest["targets"]["hlsl"];
    let path = folder.path().join("DIR").join(target["file"].as_str().unwrap());
    let compile = |path: &Path| {
        let compiler = Command::new("glslangValidator")
            .args(["-D", "-S", "comp", "--target-env", "vulkan1.1", "-V"])
            .args(["-e", target["entry_point"].as_str().unwrap()])
            .arg(path)
            .arg("-o")
            .arg(folder.path().join("shade.spv"))
            .output();
        compiler.expect("glslangValidator is installed: tools/setup.sh test").status.success()
    };
    assert!(compile(&path));
    let text = std::fs::read_to_string(&path).unwrap().replacen("void main(", "void main(missing ", 1);
    std::fs::write(&path, text).unwrap();
    assert!(!compile(&path), "the compiler can fail");
}

#[test]
fn a_target_needs_effects() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, words) in [
        (vec!["--target", "webgpu"], "--effects"),
        (vec!["--target", "webgpu", "--effects", "diffuse,shiny"], "there is no such effect"),
        (vec!["--target", "webgpu", "--effects", "diffuse,mesh"], "mesh needs polygon"),
    ] {
        common::refuse(folder.path(), &[vec!["export", "DIR"], arguments].concat(), 2, &[words]);
    }
    assert!(!folder.path().join("DIR").exists(), "nothing was written");
}

/// A compute shader with the exported library in one file, compiled: the module, or what the compiler says.
fn compile_single(folder: &Path, shader: &str) -> Result<Vec<u8>, String> {
    std::fs::write(folder.join("host.comp"), shader).unwrap();
    let compiler = Command::new("glslangValidator")
        .args(["--target-env", "vulkan1.1", "-IDIR/single", "host.comp", "-o", "host.spv"])
        .current_dir(folder)
        .output()
        .expect("glslangValidator: tools/setup.sh test installs it");
    let said = String::from_utf8_lossy(&compiler.stdout).into_owned();
    if compiler.status.success() { Ok(std::fs::read(folder.join("host.spv")).unwrap()) } else { Err(said) }
}

#[test]
fn the_library_in_one_file_passes_its_self_test_and_has_the_options_that_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let sphere = "#version 450\n#extension GL_GOOGLE_include_directive : require\n\
        #include \"arealight/arealight.glsl\"\nArealightSphereLight light;\nvoid main() {}\n";
    export(folder, &["--effects", "diffuse,glossy,sphere"]);
    compile_single(folder, sphere).unwrap();
    // The twin: without the effect
    export(folder, &[]);
    let said = compile_single(folder, sphere).unwrap_err();
    assert!(said.contains("host.comp:4"), "{said}");

    let Some(engine) = arealight_tests::TestEngine::new() else { return };
    let example = std::fs::read_to_string(folder.join("DIR/examples/self_test.comp")).unwrap();
    let wrong_points = |name, shader: &str| {
        let module = compile_single(folder, shader).unwrap();
        let kernel: &'static Kernel = Box::leak(Box::new(Kernel::new(name, module.leak())));
        engine.dispatch::<u32>(kernel, &[], &[engine.table()], 1)[0]
    };
    assert_eq!(wrong_points("right", &example), 0);
    // The twin: a bridge that reads rows for columns
    let swapped = example.replace("ivec3(texel, layer)", "ivec3(texel.yx, layer)");
    assert!(wrong_points("swapped", &swapped).count_ones() >= 5);
}
