//! Names the shared library by the version of its ABI, so that the loader finds no other for a program that
//! was linked with it.

use std::env;

fn main() {
    const SOURCE: &str = "src/lib.rs";
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={SOURCE}");
    let source = std::fs::read_to_string(SOURCE).expect("the crate's source");
    let version = source
        .lines()
        .find_map(|line| line.strip_prefix("pub const AREALIGHT_ABI_VERSION: u32 = ")?.strip_suffix(';'))
        .expect("src/lib.rs has AREALIGHT_ABI_VERSION on a line of its own");
    let set = |name| env::var(name).unwrap_or_default();
    // ELF has such names; Apple's and Windows' linkers know no such argument
    if set("CARGO_CFG_TARGET_FAMILY") == "unix" && set("CARGO_CFG_TARGET_VENDOR") != "apple" {
        println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,libarealight_capi.so.{version}");
    }
}
