//! Embeds the GLSL library, so that `arealight export` can write it: `library.rs` lists the files with their
//! texts.

use std::fmt::Write as _;
use std::path::Path;

/// What is embedded: folders of the checkout, and where their files go in an export.
const FOLDERS: [(&str, &str); 3] = [
    ("shaders/include/arealight", "include/arealight"),
    ("shaders/kernels", "kernels"),
    ("shaders/examples", "examples"),
];

fn main() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut list = String::from("&[\n");
    for (folder, destination) in FOLDERS {
        list_folder(&root.join(folder), destination, &mut list);
    }
    list += "]\n";
    let out = std::env::var_os("OUT_DIR").expect("cargo names a folder for what a build makes");
    let out = Path::new(&out).join("library.rs");
    std::fs::write(&out, list).unwrap_or_else(|error| panic!("{}: {error}", out.display()));
}

/// Lists the files of a folder, and of those in it.
fn list_folder(folder: &Path, destination: &str, list: &mut String) {
    println!("cargo::rerun-if-changed={}", folder.display());
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    for path in paths {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let destination = format!("{destination}/{name}");
        if path.is_dir() {
            list_folder(&path, &destination, list);
        } else {
            // Debug quotes a string as Rust does
            let _ = writeln!(list, "({destination:?}, include_str!({:?})),", path.display());
        }
    }
}
