//! Lists the structs of the C library with their fields: `header` asserts how they are laid out.

use std::path::Path;

fn main() {
    let folder = Path::new("../../crates/arealight-capi/src");
    println!("cargo::rerun-if-changed={}", folder.display());
    let files = folder.read_dir().expect("the crate");
    let mut paths: Vec<_> = files.map(|file| file.expect("a file").path()).collect();
    paths.sort();
    let mut list = String::new();
    for path in paths {
        let source = std::fs::read_to_string(path).expect("source").replace("\r\n", "\n");
        let items = source.split("#[repr(C)]\n").skip(1).filter_map(|rest| rest.split("\n}").next());
        for item in items.filter_map(|item| Some(item.split_once("pub struct ")?.1)) {
            let name = item.split(' ').next().unwrap_or_default();
            let fields = item.lines().filter_map(|line| line.strip_prefix("    pub ")?.split(':').next());
            list += &[name, " { ", &fields.collect::<Vec<_>>().join(", "), " }\n"].concat();
        }
    }
    let out = std::env::var("OUT_DIR").expect("Cargo says where");
    std::fs::write(Path::new(&out).join("layouts.rs"), format!("layouts! {{\n{list}}}")).expect("a file");
}
