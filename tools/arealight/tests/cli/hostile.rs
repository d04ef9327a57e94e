//! Files of strangers: each is refused in words that a terminal may have, in little memory, or answered.

use crate::common::{printed, refuse, run, text};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Runs the program in `folder`, in less than a gigabyte of addresses: beyond it would be killed.
fn within_little(folder: &Path, arguments: &[&str]) -> Output {
    Command::new("sh")
        .args(["-c", "ulimit -v 900000; exec \"$@\"", "sh", env!("CARGO_BIN_EXE_arealight")])
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn case(more: &str, light: &str) -> String {
    format!(
        r#"{{"cases": [{{"name": "c", "position": [0, 0, 0], "normal": [0, 0, 1], "view": [0, 0, 1], {more},
            "bsdf": "diffuse", "albedo": [1, 1, 1],
            "light": {{"type": "polygon", "radiance": [1, 1, 1], {light}
            "vertices": [[-1, -1, 1], [-1, 1, 1], [1, 1, 1], [1, -1, 1]]}}}}]}}"#
    )
}

/// So many primitives of one accessor of 25 million zeros; the file holds no byte of them.
fn of_zeros(primitives: usize) -> String {
    let one = r#"{"attributes": {"POSITION": 0}, "material": 0}"#;
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
            "meshes": [{{"primitives": [{}]}}], "materials": [{{"emissiveFactor": [1, 1, 1]}}],
            "accessors": [{{"componentType": 5126, "count": 25000000, "type": "VEC3"}}]}}"#,
        vec![one; primitives].join(",")
    )
}

#[cfg(unix)]
#[test]
fn what_strangers_write_is_refused_in_plain_words_and_little_memory() {
    let uv = r#""texture": "TEXTURE", "uv": [[0, 0], [0, 1], [1, 1], [1, 0]],"#;
    let of_image = |path: &str| case(r#""tangent": [1, 0, 0]"#, &uv.replace("TEXTURE", path));
    let escape = r#"{"cases": [{"name": "b\u001b]0;title\u0007", "position": [0, 0, 0], "normal": "x"}]}"#;
    let required = r#"{"asset": {"version": "2.0"}, "extensionsUsed": ["\u001b[31mred"],
        "extensionsRequired": ["\u001b[31mred"]}"#;
    let long_key = case(&format!("\"{}\": 1", "k".repeat(1_000_000)), "");
    let folder = tempfile::tempdir().unwrap();
    assert!(Command::new("mkfifo").arg(folder.path().join("pipe")).status().unwrap().success());
    for (name, text, code, words) in [
        (
            "zeros.gltf",
            of_zeros(1),
            3,
            "accessors[0]: takes 1200000000 bytes of memory, more than is left of 26",
        ),
        ("zeros20.gltf", of_zeros(20), 3, "--memory allows others"),
        ("escape.json", escape.into(), 3, r"case 'b\u001b]0;title\u0007': "),
        ("required.gltf", required.into(), 3, r"\u001b[31mred is not supported"),
        ("key.json", long_key, 0, "... (1000002 bytes)"),
        ("twice.json", case(r#""albedo": [0, 0, 0]"#, ""), 3, "the key \"albedo\" is there twice at line 2"),
        ("pipe.json", of_image("pipe"), 0, "light.texture: pipe: not a plain file"),
        ("zero.json", of_image("/dev/zero"), 0, "not a plain file"),
        ("/dev/zero", String::new(), 3, "a stream of more than 67108864 bytes"),
    ] {
        if name != "/dev/zero" {
            fs::write(folder.path().join(name), &text).unwrap();
        }
        let is_scene = name.ends_with("gltf");
        let arguments: &[&str] = if is_scene {
            &["effects", name]
        } else {
            &["eval", name, "--on", "truth", "-o", "answers.json"]
        };
        let output = within_little(folder.path(), arguments);
        let said = [output.stdout, output.stderr].concat();
        let said = String::from_utf8(said).unwrap();
        assert_eq!(output.status.code(), Some(code), "{name}: {said}");
        assert!(said.contains(words), "{name}: {said}");
        assert!(said.len() < 2000 && !said.contains(['\u{1b}', '\u{7}']), "{name}: {said}");
    }
    // The twin: who wants it gives more
    let output = run(folder.path(), &["effects", "zeros.gltf", "--memory", "1100M"]);
    assert!(text(&output.stderr).contains("more than is left of 1153433600"));
}

/// They took 1.1 GB as a tree of JSON and copies of all.
#[cfg(unix)]
#[test]
fn many_cases_take_little_memory() {
    const COUNT: usize = 200_000;
    let folder = tempfile::tempdir().unwrap();
    let one = case(r#""tangent": [1, 0, 0]"#, "");
    let inner = one.trim_start_matches(r#"{"cases": ["#).strip_suffix("]}").unwrap();
    let each = (0..COUNT).map(|index| inner.replacen("\"c\"", &format!("\"{index}\""), 1));
    let text = format!(r#"{{"cases": [{}]}}"#, each.collect::<Vec<_>>().join(","));
    fs::write(folder.path().join("many.json"), text).unwrap();
    let output = within_little(folder.path(), &["eval", "many.json", "--on", "oracle", "-o", "out.json"]);
    let said = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
    assert!(said.contains("200000 cases on oracle") && said.contains(" 0 unanswered"), "{said}");
}

#[cfg(unix)]
#[test]
fn a_pipe_is_written_once_and_an_input_never() {
    let folder = tempfile::tempdir().unwrap();
    let cases = case(r#""tangent": [1, 0, 0]"#, "");
    fs::write(folder.path().join("in.json"), &cases).unwrap();
    let answered = run(folder.path(), &["eval", "in.json", "--on", "truth"]);
    assert!(Command::new("mkfifo").arg(folder.path().join("pipe")).status().unwrap().success());
    let reader = Command::new("cat")
        .arg(folder.path().join("pipe"))
        .stdout(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let written = run(folder.path(), &["eval", "in.json", "--on", "truth", "-o", "pipe"]);
    printed(&written);
    assert_eq!(reader.wait_with_output().unwrap().stdout, answered.stdout);
    // What is read stays
    for output in ["in.json", "./in.json"] {
        let arguments = ["eval", "in.json", "--on", "truth", "-o", output];
        refuse(folder.path(), &arguments, 2, &["is an input, which it would replace"]);
    }
    assert_eq!(fs::read_to_string(folder.path().join("in.json")).unwrap(), cases);
}
