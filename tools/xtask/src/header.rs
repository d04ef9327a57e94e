//! `header`: the header of the C library, made from the crate's source by cbindgen, with the layout of each
//! struct as assertions of the C compiler.

use crate::TaskError;
use arealight_capi as capi;
use std::fmt::Write as _;
use std::mem::offset_of;
use std::path::Path;

/// The crate, from the checkout's root.
const CRATE: &str = "crates/arealight-capi";

/// Make the C library's header, crates/arealight-capi/include/arealight.h.
#[derive(clap::Args)]
pub struct Arguments {
    /// Write nothing; fail when the header is not what the crate makes.
    #[arg(long)]
    check: bool,
}

/// Whether the header was written, or passed the check.
pub fn run(root: &Path, arguments: &Arguments) -> Result<bool, TaskError> {
    let path = root.join(CRATE).join("include/arealight.h");
    let header = header(root)?;
    let there = std::fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n");
    let same = there == header;
    if arguments.check {
        println!(
            "{}: {}",
            path.display(),
            if same { "fresh" } else { "stale; run: cargo run -p xtask -- header" }
        );
        return Ok(same);
    }
    if !same {
        std::fs::write(&path, header).map_err(TaskError::file(&path))?;
        println!("wrote {}", path.display());
    }
    Ok(true)
}

/// The header's text.
pub fn header(root: &Path) -> Result<String, TaskError> {
    let folder = root.join(CRATE);
    let failed = |message: String| TaskError::Header { message };
    let config = cbindgen::Config::from_file(folder.join("cbindgen.toml")).map_err(failed)?;
    // Its modules are followed from there
    let builder = cbindgen::Builder::new().with_config(config).with_src(folder.join("src/lib.rs"));
    let bindings = builder.generate().map_err(|error| failed(error.to_string()))?;
    let mut bytes = vec![];
    bindings.write(&mut bytes);
    let text = String::from_utf8(bytes).map_err(|error| failed(error.to_string()))?;

    // Rust's heading, in words; and the assertions before the guard ends
    let text = text.replace("// # Safety\n", "// The host sees to it:\n");
    let end = text.rfind("#endif").ok_or_else(|| failed("the header has no guard".into()))?;
    Ok(format!("{}{}\n{}", &text[..end], assertions(), &text[end..]))
}

/// What is asserted of structs, whose fields must all be given.
macro_rules! layouts {
    ($($name:ident { $($field:ident),* })*) => {{
        // Does not compile where a field is left out
        $(let _ = |capi::$name { $($field: _),* }| ();)*
        [$(
            (concat!("sizeof(", stringify!($name), ")"), size_of::<capi::$name>()),
            $((
                concat!("offsetof(", stringify!($name), ", ", stringify!($field), ")"),
                offset_of!(capi::$name, $field),
            ),)*
        )*]
    }};
}

/// Assertions that a C or C++ compiler lays structs out as Rust did, on machines of 64 bits, as this one.
fn assertions() -> String {
    let mut text = String::from(
        "// Structs are laid out as the library's.\n\
         #if UINTPTR_MAX == UINT64_MAX\n\
         #ifdef __cplusplus\n\
         #define AREALIGHT_ASSERT(condition) static_assert(condition, #condition)\n\
         #else\n\
         #define AREALIGHT_ASSERT(condition) _Static_assert(condition, #condition)\n\
         #endif\n",
    );
    // Of every struct, by the build script
    for (what, bytes) in include!(concat!(env!("OUT_DIR"), "/layouts.rs")) {
        let _ = writeln!(text, "AREALIGHT_ASSERT({what} == {bytes});");
    }
    text + "#undef AREALIGHT_ASSERT\n#endif\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::Command;

    fn root() -> std::path::PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
    }

    #[test]
    fn the_header_is_fresh() {
        assert!(run(&root(), &Arguments { check: true }).unwrap(), "run: cargo run -p xtask -- header");
    }

    /// What a host was compiled with, beside comments: a change of it is another version of the ABI.
    const ABI: (u32, &str) = (2, "8cc9e14c36cc9f60");

    #[test]
    fn another_abi_has_another_version() {
        let text = header(&root()).unwrap();
        let code: Vec<&str> = text
            .lines()
            .filter_map(|line| line.split("//").next().map(str::trim_end))
            .filter(|line| !line.is_empty() && !line.starts_with("#define AREALIGHT_ABI_VERSION"))
            .collect();
        let digest = crate::manifest::hash(code.join("\n").as_bytes());
        assert_eq!(
            (capi::AREALIGHT_ABI_VERSION, &digest[..16]),
            ABI,
            "the header has changed: raise AREALIGHT_ABI_VERSION, if a release has it, and write both here"
        );
    }

    /// Whether a header compiles, and what the compiler says.
    fn compiles(compiler: &str, arguments: &[&str], header: &str) -> Result<(), String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("arealight.h");
        std::fs::write(&path, header).unwrap();
        let output =
            Command::new(compiler).args(arguments).arg(&path).output().expect("a C and a C++ compiler");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        if output.status.success() { Ok(()) } else { Err(said) }
    }

    #[test]
    fn c_and_cpp_take_it_and_its_assertions_hold() {
        let header = header(&root()).unwrap();
        let strict = ["-Wall", "-Wextra", "-Wpedantic", "-Wredundant-decls", "-Werror", "-fsyntax-only"];
        let c = [&["-x", "c", "-std=c11"], &strict[..]].concat();
        let cpp = [&["-x", "c++", "-std=c++11"], &strict[..]].concat();
        assert_eq!(compiles("cc", &c, &header), Ok(()));
        assert_eq!(compiles("c++", &cpp, &header), Ok(()));
        // A field that moved is found
        let moved = header.replace("    uint32_t abi_version;\n", "    uint64_t abi_version;\n");
        assert_ne!(moved, header);
        assert!(compiles("cc", &c, &moved).unwrap_err().contains("ArealightHost"));
        assert!(compiles("c++", &cpp, &moved).unwrap_err().contains("ArealightHost"));
    }
}
