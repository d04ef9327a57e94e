//! The command line as a user meets it: exit codes, messages, files.

use crate::common::{device, json_of, picture, printed, refuse, refused, run, scene, text};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

fn write(folder: &Path, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, bytes).expect("the test folder can be written");
    path
}

#[test]
fn help_and_version() {
    let folder = tempfile::tempdir().unwrap();
    let help = printed(&run(folder.path(), &["--help"]));
    for command in ["render", "eval", "effects", "fit", "inspect", "devices", "Exit codes", "--tolerance"] {
        assert!(help.contains(command), "{command}");
    }
    // A long list is in groups
    let render = text(&run(folder.path(), &["render", "--help"]).stdout);
    for group in ["Scene:", "Picture:", "Quality:", "Device:", "Options:"] {
        assert!(render.lines().any(|line| line == group), "{group}: {render}");
    }
    assert!(run(folder.path(), &["--version"]).status.success());
    // Without a command it says what there is
    refuse(folder.path(), &[], 2, &["Commands:"]);
}

#[test]
fn wrong_arguments_are_exit_code_2() {
    let folder = tempfile::tempdir().unwrap();
    let room = scene("room.glb");
    let screen = scene("screen.glb");
    for (arguments, words) in [
        (&["render", &room, "--size", "12"][..], &["--size", "1280x720"][..]),
        (&["render", &room, "--reference", "0"], &["--reference"]),
        (&["render", &room, "--surfaces", "shiny"], &["--surfaces", "'shiny' is no effect", "two_sided"]),
        (&["render", &screen, "--surfaces", "tube"], &["--surfaces", "tube depends on the lights"]),
        (&["render", &room, "--tiles", "--shadows", "rays:1"], &["--tiles", "without shadows"]),
        (&["effects"], &["SCENE"]),
        (&["render", &room, "--camera", "nobody"], &["--camera", "nobody"]),
        (&["paint"], &["paint"]),
        (&["-q", "-v", "devices"], &["--quiet", "--verbose"]),
        (&["inspect", "--f0", "2", "-o", "lobes.png"], &["--f0", "0 to 1"]),
        (&["inspect", "--specular-lobes", "none"], &["--specular-lobes", "one", "two"]),
        (&["inspect", "--entries"], &["--output"]),
        (&["inspect", "--entries", "-o", "a.png", "--errors"], &["--errors", "--entries"]),
        (&["inspect", "--quads", "9"], &["--errors"]),
        (&["inspect", "--errors", "--quads", "2"], &["--quads", "3..=3000"]),
        (&["inspect", "--layer", "1"], &["--pyramid"]),
        (&["inspect", "--pyramid", "a.png", "--entries", "-o", "b.png"], &["--entries"]),
        (&["inspect", "--pyramid", "a.png", "--layer", "1"], &["--layer", "one texture"]),
        (&["inspect", "--pyramid", &screen, "--layer", "2"], &["--layer", "from 0 to 1"]),
    ] {
        refuse(folder.path(), arguments, 2, words);
    }
}

#[test]
fn bad_scenes_are_exit_code_3_and_named() {
    let folder = tempfile::tempdir().unwrap();
    refuse(folder.path(), &["render", "missing.glb"], 3, &["missing.glb"]);
    write(folder.path(), "noise.glb", b"this is not a scene");
    refuse(folder.path(), &["render", "noise.glb"], 3, &["noise.glb"]);
    let room = std::fs::read(scene("room.glb")).unwrap();
    write(folder.path(), "cut.glb", &room[..room.len() / 2]);
    refuse(folder.path(), &["render", "cut.glb"], 3, &["cut.glb"]);
    // A triangle whose first coordinate is NaN
    let mut positions = vec![];
    for number in [f32::NAN, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        positions.extend(number.to_le_bytes());
    }
    write(folder.path(), "triangle.bin", positions);
    write(
        folder.path(),
        "nan.gltf",
        r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
            "meshes":[{"name":"shard","primitives":[{"attributes":{"POSITION":0}}]}],
            "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
                "min":[0,0,0],"max":[1,1,0]}],
            "bufferViews":[{"buffer":0,"byteLength":36}],
            "buffers":[{"uri":"triangle.bin","byteLength":36}]}"#,
    );
    refuse(folder.path(), &["render", "nan.gltf"], 3, &["nan.gltf", "NaN"]);
}

#[test]
fn bad_cases_are_exit_code_3_and_named() {
    let folder = tempfile::tempdir().unwrap();
    refuse(folder.path(), &["eval", "missing.json"], 3, &["missing.json"]);
    write(folder.path(), "noise.json", "{]");
    refuse(folder.path(), &["eval", "noise.json"], 3, &["noise.json"]);
    write(folder.path(), "short.json", r#"{"cases":[{"name":"one","position":[0,0,0]}]}"#);
    refuse(folder.path(), &["eval", "short.json", "--on", "oracle"], 3, &["short.json", "one"]);
    refuse(folder.path(), &["inspect", "missing.exr"], 3, &["missing.exr"]);
    write(folder.path(), "noise.exr", "not a table");
    refuse(folder.path(), &["inspect", "noise.exr"], 3, &["noise.exr"]);
    refuse(folder.path(), &["inspect", "--errors", "noise.exr"], 3, &["noise.exr"]);
}

#[test]
fn bad_pictures_are_exit_code_3_and_named() {
    let folder = tempfile::tempdir().unwrap();
    let refuse = |name: &str, words: &[&str]| {
        refuse(folder.path(), &["inspect", "--pyramid", name], 3, &[&[name], words].concat());
    };
    write(folder.path(), "noise.exr", "not a picture");
    write(folder.path(), "noise.png", "not a picture");
    for name in ["missing.exr", "missing.png", "missing.glb", "noise.exr", "noise.png"] {
        refuse(name, &[]);
    }
    refuse(&scene("room.glb"), &["no light shows a texture"]);
    image::RgbImage::new(5000, 1).save(folder.path().join("long.png")).unwrap();
    refuse("long.png", &["5000 x 1", "scale it down"]);
}

#[test]
fn inspect_draws_the_pyramid_of_a_scene_and_of_images() {
    let folder = tempfile::tempdir().unwrap();
    let Some(()) = device() else { return };
    let inspect = |arguments: &[&str]| {
        json_of(&run(folder.path(), &[&["inspect", "--json", "--pyramid"], arguments].concat()))
    };
    // The two textures of a scene
    let screen = scene("screen.glb");
    let card = inspect(&[&screen, "-o", "card.png"]);
    assert_eq!(
        (&card["size"], card["levels"].as_array().unwrap().len()),
        (&serde_json::json!([512, 512]), 11)
    );
    assert!(card["texture"].as_str().unwrap().ends_with("'test card', shown by 'television'"), "{card}");
    inspect(&[&screen, "--layer", "1", "-o", "sign.png"]);
    assert!(picture(folder.path(), "card.png") != picture(folder.path(), "sign.png"));

    // A constant stays what it is: sRGB 188 is 0.503 linear, which half precision holds to 2.5e-4
    image::RgbImage::from_pixel(50, 20, image::Rgb([188; 3])).save(folder.path().join("gray.png")).unwrap();
    exr::prelude::write_rgb_file(folder.path().join("bright.exr"), 70, 70, |_, _| {
        (300.0_f32, 0.5_f32, 0.0_f32)
    })
    .unwrap();
    for (name, content, expected) in
        [("gray.png", [64, 64], [0.502_886; 3]), ("bright.exr", [128, 128], [300.0, 0.5, 0.0])]
    {
        let summary = inspect(&[name, "-o", "constant.png"]);
        assert_eq!(summary["size"], serde_json::json!(content));
        for level in summary["levels"].as_array().unwrap() {
            for (channel, expected) in expected.into_iter().enumerate() {
                let mean = level["mean"][channel].as_f64().unwrap();
                // Each of a few levels rounds to half precision, relative 2^-11
                assert!((mean - expected).abs() <= 2.5e-3 * expected, "{name}: {mean} for {expected}");
            }
        }
    }
}

#[test]
fn inspect_draws_lobes_entries_and_errors() {
    let folder = tempfile::tempdir().unwrap();
    let inspect =
        |arguments: &[&str]| json_of(&run(folder.path(), &[&["inspect", "--json"], arguments].concat()));
    let picture = |name: &str| picture(folder.path(), name);

    // The lobes depend on the reflectance and the level
    let summary = inspect(&["-o", "metal.png"]);
    assert_eq!(summary["channels"].as_array().unwrap().len(), 10, "two matrices and the albedos");
    assert_eq!(summary["errors"], serde_json::Value::Null);
    inspect(&["-o", "one.png", "--f0", "0.04"]);
    inspect(&["-o", "two.png", "--f0", "0.04", "--specular-lobes", "two"]);
    let [metal, one, two] = ["metal.png", "one.png", "two.png"].map(picture);
    assert_eq!(metal.dimensions(), one.dimensions());
    assert!(metal != one && one != two);

    // A small table is worse than the one that is built in; it is drawn in a column more
    printed(&run(folder.path(), &["fit", "--size", "4", "--matrices", "1", "-o", "small.exr"]));
    inspect(&["small.exr", "--entries", "-o", "small.png"]);
    inspect(&["--entries", "-o", "large.png"]);
    assert!(picture("small.png").height() < picture("large.png").height(), "one matrix, a row less");
    let summary = inspect(&["--errors", "small.exr", "--quads", "3", "-o", "errors.png"]);
    let errors = summary["errors"].as_array().unwrap();
    let mean = |of: &str, level: &str, f0: f64| {
        let is_it = |e: &&serde_json::Value| e["of"] == of && e["specular_lobes"] == level && e["f0"] == f0;
        errors.iter().find(is_it).and_then(|e| e["mean"].as_f64()).unwrap()
    };
    for f0 in [0.04, 1.0] {
        assert!(mean("table", "two lobes", f0) < 0.9 * mean("table", "one lobe", f0));
        assert!(mean("table", "one lobe", f0) < mean("formula", "one lobe", f0));
        assert!(2.0 * mean("formula", "one lobe", f0) < mean("small", "one lobe", f0));
    }
    assert_eq!(errors.len(), 8);
    inspect(&["--errors", "--quads", "3", "-o", "ours.png"]);
    assert!(picture("ours.png").width() < picture("errors.png").width());
}

#[test]
fn devices_that_are_not_there_are_exit_code_4() {
    let folder = tempfile::tempdir().unwrap();
    if device().is_some() {
        let wanted = ["render", &scene("room.glb"), "--device", "abacus"];
        refuse(folder.path(), &wanted, 4, &["abacus"]);
    }
    // Without a driver: the loader is told to look nowhere
    let output = Command::new(env!("CARGO_BIN_EXE_arealight"))
        .args(["render", &scene("room.glb")])
        .env("VK_ICD_FILENAMES", "/nonexistent.json")
        .env("VK_DRIVER_FILES", "/nonexistent.json")
        .current_dir(folder.path())
        .output()
        .unwrap();
    // It says what to install
    refused(&output, 4, &["mesa-vulkan-drivers"]);
}

#[test]
fn a_scene_without_lights_or_triangles_is_rendered_with_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let Some(()) = device() else { return };
    write(folder.path(), "empty.gltf", r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[]}]}"#);
    let output = run(folder.path(), &["render", "empty.gltf", "--size", "16x8"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("no area lights"), "{}", text(&output.stderr));
    assert!(folder.path().join("out/empty.png").is_file());
}

#[test]
fn effects_are_listed_with_what_needs_them() {
    let folder = tempfile::tempdir().unwrap();
    let summary = json_of(&run(folder.path(), &["effects", &scene("screen.glb"), "--json"]));
    let effects = summary["effects"].as_array().unwrap();
    assert_eq!(effects.len(), arealight::Effects::all().iter().count());
    let effect = |name: &str| effects.iter().find(|e| e["effect"] == name).unwrap();
    assert!(effect("textured")["reason"].as_str().unwrap().starts_with("light '"), "{summary:#}");
    assert_eq!(effect("textured")["required"], true);
    assert_eq!(effect("tube")["required"], false);
    assert!(effect("tube")["reason"].is_null(), "{summary:#}");
    let told = printed(&run(folder.path(), &["effects", &scene("sweep.glb")]));
    for words in ["diffuse", "material '", "This scene's set: diffuse, glossy, coupled\n", "out: two_sided"] {
        assert!(told.contains(words), "{words}: {told}");
    }
    assert!(!told.contains("\ntube"), "{told}");
}

#[test]
fn a_stated_set_that_a_surface_needs_more_than_is_said() {
    let Some(()) = device() else { return };
    let folder = tempfile::tempdir().unwrap();
    let screen = scene("screen.glb");
    for (surfaces, warned) in [("diffuse,glossy", false), ("diffuse", true)] {
        let output = run(folder.path(), &["render", &screen, "--size", "16x9", "--surfaces", surfaces]);
        let (told, said) = (printed(&output), text(&output.stderr));
        assert_eq!(said.contains("--surfaces is without glossy: material '"), warned, "{said}");
        let expected = format!("surfaces {}", surfaces.replace(',', ", "));
        assert!(told.contains(&expected), "{told}");
    }
}

#[test]
fn render_makes_pictures_and_says_where() {
    let folder = tempfile::tempdir().unwrap();
    let Some(()) = device() else { return };
    let room = scene("room.glb");
    let summary = json_of(&run(folder.path(), &["render", &room, "--size", "64x36", "--json"]));
    assert_eq!(summary["picture"], "out/room.png");
    assert!(summary["effects"].as_array().is_some_and(|effects| !effects.is_empty()));
    let picture = picture(folder.path(), "out/room.png");
    assert_eq!(picture.dimensions(), (64, 36));
    assert!(picture.pixels().any(|p| p.0.iter().any(|&c| c > 100)), "something is lit");

    // The same radiance by Monte Carlo, as EXR
    let reference = ["render", &room, "--size", "32x18", "--reference", "8", "-o", "truth.exr"];
    assert!(run(folder.path(), &reference).status.success());
    assert!(std::fs::read(folder.path().join("truth.exr")).unwrap().starts_with(&[0x76, 0x2f, 0x31, 0x01]));
}

/// Of parts of 96 x 96 pixels, the noise of a picture by another with other random numbers, in levels of the
/// means of 4 x 4.
fn noise_of_parts([a, b]: [&image::RgbImage; 2]) -> Vec<f64> {
    let mut parts = BTreeMap::<_, (f64, f64)>::new();
    for (x, y) in (0..a.width()).step_by(4).flat_map(|x| (0..a.height()).step_by(4).map(move |y| (x, y))) {
        let pixels =
            (0..16).map(|i| (x + i % 4, y + i / 4)).map(|(x, y)| (a.get_pixel(x, y).0, b.get_pixel(x, y).0));
        let mut apart = [0.0; 3];
        pixels.for_each(|(a, b)| (0..3).for_each(|c| apart[c] += (f64::from(a[c]) - f64::from(b[c])) / 16.0));
        let (sum, count) = parts.entry((x / 96, y / 96)).or_default();
        *sum += apart.iter().map(|apart| apart * apart).sum::<f64>() / 2.0;
        *count += 3.0;
    }
    parts.into_values().map(|(sum, count)| (sum / count).sqrt()).collect()
}

#[test]
fn shadows_go_on_where_they_are_noisy() {
    let folder = tempfile::tempdir().unwrap();
    let Some(()) = device() else { return };
    let rendered = |seed: &str, more: &[&str]| {
        let demo = scene("demo.glb");
        let common = ["render", &demo, "--size", "288x160", "--supersample", "1", "--json", "-o", "seen.png"];
        let summary = json_of(&run(folder.path(), &[&common[..], &["--seed", seed], more].concat()));
        (picture(folder.path(), "seen.png"), summary)
    };
    let ([(a, summary), (b, _)], [(once, _), (other, _)]) = (
        ["1", "2"].map(|seed| rendered(seed, &["--shadow-noise", "0.3"])),
        ["1", "2"].map(|seed| rendered(seed, &[])),
    );
    let [converged, once] = [[&a, &b], [&once, &other]].map(noise_of_parts);
    // Few blocks have most of the noise, so that one pair of pictures tells it to a half
    assert!(converged.iter().all(|noise| *noise < 0.45), "{converged:.2?}");
    assert!(once.iter().any(|noise| *noise > 0.8) && once.iter().any(|noise| *noise < 0.1), "{once:.2?}");
    let rays = |name: &str| summary[name].as_f64().unwrap();
    assert!(rays("shadow_rays_most") > 1.5 * rays("shadow_rays"), "{summary}");
}

#[test]
fn shadows_go_on_until_their_noise_is_low() {
    let folder = tempfile::tempdir().unwrap();
    let Some(()) = device() else { return };
    let rendered = |name: &str, more: &[&str]| {
        let sweep = scene("sweep.glb");
        let common = ["render", &sweep, "--size", "48x32", "--supersample", "1", "--json", "-o", name];
        json_of(&run(folder.path(), &[&common, more].concat()))
    };
    let pixels = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    let one = ["--shadows", "rays:1"];
    let summary = rendered("once.png", &one);
    assert_eq!((&summary["shadow_rays"], &summary["shadow_noise"]), (&1.0.into(), &serde_json::Value::Null));
    // A second round, of four rays, tells what noise there is: half of it takes about four times the rays
    let two = rendered("two.png", &[&one[..], &["--shadow-noise", "100"]].concat());
    assert_eq!(two["shadow_rays"], 5.0);
    let noise = two["shadow_noise"].as_f64().unwrap();
    let half = (0.5 * noise).to_string();
    let more = rendered("more.png", &[&one[..], &["--shadow-noise", &half]].concat());
    assert!(more["shadow_noise"].as_f64().unwrap() <= 0.5 * noise && noise > 0.5, "{noise}: {more}");
    assert!((9.0..=45.0).contains(&more["shadow_rays"].as_f64().unwrap()), "{more}");
    // A seed is a picture of its own, the same one each time
    for name in ["a.png", "b.png"] {
        rendered(name, &[&one[..], &["--seed", "1"]].concat());
    }
    assert!(pixels("a.png") == pixels("b.png") && pixels("a.png") != pixels("once.png"));
    for wrong in ["0", "-1"] {
        refuse(folder.path(), &["render", "--shadow-noise", wrong], 2, &["--shadow-noise", "above 0"]);
    }
}

#[test]
fn bright_edges_are_drawn_by_more_lines_of_sight() {
    let Some(()) = device() else { return };
    let folder = tempfile::tempdir().unwrap();
    for name in ["gallery.glb", "neon.glb"] {
        let render = |samples: &str, exposure: &str, output: &str| {
            let common = ["render", &scene(name), "--size", "64x36", "--shadows", "off", "-o", output];
            let picture = ["--supersample", samples, "--exposure", exposure];
            printed(&run(folder.path(), &[&common[..], &picture].concat()));
        };
        render("8", "0", "truth.exr");
        // Radiance is the same at every exposure; the twin has as many lines everywhere, and the last one few
        let [few, dark, all, one] =
            [("2", "0"), ("2", "-30"), ("6", "0"), ("1", "0")].map(|(count, stops)| {
                render(count, stops, "few.exr");
                let compared = run(folder.path(), &["compare", "few.exr", "truth.exr", "--json"]);
                json_of(&compared)["rmse_over_mean"].as_f64().unwrap()
            });
        assert!(few == dark && few < 1.5 * all && one > 3.0 * all, "{name}: {few}, {dark}, {all}, {one}");
    }
}

#[test]
fn pictures_are_compared() {
    let folder = tempfile::tempdir().unwrap();
    let picture = |name: &str, size: usize, value: f32| {
        let path = folder.path().join(name);
        exr::prelude::write_rgb_file(&path, size, size, |x, _| (value, value, value + x as f32)).unwrap();
    };
    picture("a.exr", 8, 1.0);
    picture("b.exr", 8, 1.1);
    picture("small.exr", 4, 1.0);
    let same = printed(&run(folder.path(), &["compare", "a.exr", "a.exr", "--tolerance", "0"]));
    assert!(same.contains("RMSE / mean    0.000 %"), "{same}");
    let apart =
        run(folder.path(), &["compare", "b.exr", "a.exr", "--json", "-o", "map.png", "--tolerance", "0.01"]);
    assert_eq!(apart.status.code(), Some(1));
    let found: serde_json::Value = serde_json::from_slice(&apart.stdout).unwrap();
    // A tenth in every channel, over a mean of 1 + 3.5 / 3
    let error = found["rmse_over_mean"].as_f64().unwrap();
    assert!((error - 0.1 / (1.0 + 3.5 / 3.0)).abs() < 1e-6, "{found}");
    let map = image::open(folder.path().join("map.png")).unwrap();
    assert_eq!((map.width(), map.height()), (8, 8));
    refuse(folder.path(), &["compare", "a.exr", "small.exr"], 3, &["8 x 8", "4 x 4"]);
    refuse(folder.path(), &["compare", "a.exr", "missing.exr"], 3, &["missing.exr"]);
}

#[test]
fn shells_and_man_know_the_program() {
    let folder = tempfile::tempdir().unwrap();
    for shell in ["bash", "zsh", "fish"] {
        let script = printed(&run(folder.path(), &["completions", shell]));
        assert!(script.contains("inspect"), "{shell}");
    }
    printed(&run(folder.path(), &["man", "man/1"]));
    for page in ["arealight.1", "arealight-render.1", "arealight-bench-shadows.1"] {
        let text = std::fs::read_to_string(folder.path().join("man/1").join(page)).unwrap();
        assert!(text.contains(".SH"), "{page}");
    }
    refuse(folder.path(), &["man", "man/1/arealight.1"], 5, &["arealight.1"]);
}

#[test]
fn verdicts_have_colours_where_they_are_wanted_and_tables_with_verbose() {
    let Some(()) = device() else { return };
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str], environment: &[(&str, &str)]| {
        Command::new(env!("CARGO_BIN_EXE_arealight"))
            .args(["bench", "stability", "--samples", "4", "--family", "crossing"])
            .args(["--level", "polygon-exact"])
            .args(arguments)
            .env_remove("NO_COLOR")
            .envs(environment.iter().copied())
            .current_dir(folder.path())
            .output()
            .unwrap()
    };
    let plain = run(&[], &[]);
    let (said, green) = (printed(&plain), "\u{1b}[32mEvery promise of ours is kept\u{1b}[0m");
    assert!(said.contains("Every promise of ours is kept") && !said.contains('\u{1b}'), "{said}");
    assert!(!said.contains("  crossing ") && plain.stderr.is_empty(), "{said}");
    assert!(text(&run(&[], &[("CLICOLOR_FORCE", "1")]).stdout).contains(green));
    let without = run(&[], &[("CLICOLOR_FORCE", "1"), ("NO_COLOR", "1")]);
    assert_eq!(text(&without.stdout), said);
    // Every table, and on what it ran
    let verbose = run(&["--verbose"], &[]);
    assert!(text(&verbose.stdout).contains("  crossing "), "{}", text(&verbose.stdout));
    assert!(text(&verbose.stderr).contains("device: "), "{}", text(&verbose.stderr));
}
