//! Modules as words, and the programs of the package spirv-tools.

use std::io::Write;
use std::process::{Command, Output, Stdio};

/// The words of a module's bytes.
pub fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
}

/// What a program makes of a module that it reads; `None` where the program is missing.
pub fn tool(name: &str, arguments: &[&str], module: &[u8]) -> Option<Output> {
    let started = Command::new(name)
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut tool = match started {
        Ok(tool) => tool,
        Err(error) => {
            let required = std::env::var("AREALIGHT_REQUIRE_GPU").is_ok_and(|value| value == "1");
            assert!(!required, "AREALIGHT_REQUIRE_GPU=1, and {name}: {error}: run tools/setup.sh test");
            println!("skipped: no {name} ({error})");
            return None;
        }
    };
    // These programs read all before they say anything
    tool.stdin.take().expect("a pipe").write_all(module).expect("the program reads");
    Some(tool.wait_with_output().expect("the program ends"))
}
