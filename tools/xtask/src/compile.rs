//! From a kernel's GLSL to SPIR-V, with the list of every file that went in.

use crate::TaskError;
use shaderc::{CompileOptions, Compiler, IncludeType, OptimizationLevel, ResolvedInclude, ShaderKind};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

/// Folders that `#include` searches after the including file's own, from the checkout's root.
pub const INCLUDE_FOLDERS: [&str; 2] = ["shaders/include", "shaders/kernels"];

/// A compiled kernel.
#[derive(Debug)]
pub struct Compiled {
    /// What decides the SPIR-V beside the sources; a part of the hash of the sources.
    pub options: String,
    /// The SPIR-V module, little-endian.
    pub spirv: Vec<u8>,
    /// Path from the checkout's root, and text, of the kernel and of each file it includes.
    pub sources: BTreeMap<String, String>,
}

/// Compiles the kernel at `path` from the root. The inner error is the compiler's, one `path:line: message` a
/// line.
pub fn compile(root: &Path, path: &str) -> Result<Result<Compiled, String>, TaskError> {
    let compiler = Compiler::new().map_err(TaskError::Compiler)?;
    let text = read(&root.join(path)).map_err(TaskError::file(&root.join(path)))?;
    let included = RefCell::new(Included::default());
    let mut options = CompileOptions::new().map_err(TaskError::Compiler)?;

    // Names stay in the module and drivers optimise by themselves.
    options.set_target_env(shaderc::TargetEnv::Vulkan, shaderc::EnvVersion::Vulkan1_1 as u32);
    options.set_target_spirv(shaderc::SpirvVersion::V1_3);
    options.set_optimization_level(OptimizationLevel::Zero);
    options.set_warnings_as_errors();
    options.set_include_callback(|requested, kind, includer, _depth| {
        let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder);
        let (path, text) = find(root, requested, kind, (includer, folder))?;
        let mut included = included.borrow_mut();
        included.by.entry(path.clone()).or_insert_with(|| includer.to_owned());
        included.sources.insert(path.clone(), text.clone());
        // A kernel that is included has the version of its includer
        let content = text.replacen("#version 460\n", "\n", 1);
        Ok(ResolvedInclude { resolved_name: path, content })
    });

    let (kind, stage) = match Path::new(path).extension().and_then(std::ffi::OsStr::to_str) {
        Some("vert") => (ShaderKind::Vertex, "vertex"),
        Some("frag") => (ShaderKind::Fragment, "fragment"),
        _ => (ShaderKind::Compute, "compute"),
    };
    let result = compiler.compile_into_spirv(&text, kind, path, "main", Some(&options));
    let mut included = included.take();
    Ok(match result {
        Ok(artifact) => {
            included.sources.insert(path.to_owned(), text);
            let options = format!("glsl {stage}, vulkan 1.1, spirv 1.3, not optimised, warnings are errors");
            Ok(Compiled { options, spirv: artifact.as_binary_u8().to_vec(), sources: included.sources })
        }
        Err(shaderc::Error::CompilationError(_, messages)) => Err(included.explain(&messages)),
        Err(error) => Err(format!("{path}: error: {error}")),
    })
}

/// The files that the compiler asked for.
#[derive(Default)]
struct Included {
    sources: BTreeMap<String, String>,
    /// The file that first included a file.
    by: BTreeMap<String, String>,
}

impl Included {
    /// Adds to each message in an included file how the kernel came to include it.
    fn explain(&self, messages: &str) -> String {
        let mut explained = String::new();
        for line in messages.lines() {
            _ = writeln!(explained, "{line}");
            let mut file = line.split(':').next().unwrap_or_default();
            while let Some(includer) = self.by.get(file) {
                _ = writeln!(explained, "    included from {includer}");
                file = includer;
            }
        }
        explained
    }
}

/// Finds an included file: beside its includer, then in each of the include folders, then in the kernel's, as
/// hosts have files for ours to include.
fn find(
    root: &Path,
    requested: &str,
    kind: IncludeType,
    (includer, kernel_folder): (&str, &str),
) -> Result<(String, String), String> {
    let beside = includer.rsplit_once('/').map_or("", |(folder, _)| folder);
    let mut folders = vec![];
    if kind == IncludeType::Relative {
        folders.push(beside);
    }
    folders.extend(INCLUDE_FOLDERS);
    folders.push(kernel_folder);
    for folder in &folders {
        if let Some(path) = join(folder, requested)
            && let Ok(text) = read(&root.join(&path))
        {
            return Ok((path, text));
        }
    }
    Err(format!("cannot find \"{requested}\" in {}", folders.join(", ")))
}

/// Joins with `/` and resolves `.` and `..`, so that a file has one name however it is included.
fn join(folder: &str, file: &str) -> Option<String> {
    let mut parts: Vec<&str> = vec![];
    for part in folder.split('/').chain(file.split('/')) {
        match part {
            "" | "." => {}
            ".." => _ = parts.pop()?,
            part => parts.push(part),
        }
    }
    Some(parts.join("/"))
}

/// Reads a text with the line ends of the repository, so that a hash is the same on every system.
fn read(path: &Path) -> std::io::Result<String> {
    Ok(std::fs::read_to_string(path)?.replace("\r\n", "\n"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shaders::tests::checkout;

    #[test]
    fn a_path_has_one_name() {
        assert_eq!(join("a/b", "../c.glsl").as_deref(), Some("a/c.glsl"));
        assert_eq!(join("a", "./b//c.glsl").as_deref(), Some("a/b/c.glsl"));
        assert_eq!(join("a", "../../c.glsl"), None);
    }

    #[test]
    fn the_sources_are_the_kernel_and_what_it_includes() {
        let folder =
            checkout(&[("good", "#include \"arealight/one.glsl\"", "")], &[("one", "#define ONE 1\n")]);
        let compiled = compile(folder.path(), "shaders/kernels/good.comp").unwrap().unwrap();
        assert_eq!(compiled.spirv[..4], [0x03, 0x02, 0x23, 0x07]);
        let paths: Vec<_> = compiled.sources.keys().map(String::as_str).collect();
        assert_eq!(paths, ["shaders/include/arealight/one.glsl", "shaders/kernels/good.comp"]);
    }

    #[test]
    fn an_error_in_an_included_file_names_file_line_and_includer() {
        let folder = checkout(
            &[("bad", "#include \"arealight/one.glsl\"", "")],
            &[("one", "#include \"two.glsl\"\n"), ("two", "\n\nfloat f() { return g(); }\n")],
        );
        let messages = compile(folder.path(), "shaders/kernels/bad.comp").unwrap().unwrap_err();
        assert!(messages.contains("shaders/include/arealight/two.glsl:3: error: 'g'"), "{messages}");
        assert!(messages.contains("included from shaders/include/arealight/one.glsl\n"), "{messages}");
        assert!(messages.contains("included from shaders/kernels/bad.comp\n"), "{messages}");
    }

    #[test]
    fn a_missing_include_says_where_it_was_sought() {
        let folder = checkout(&[("bad", "#include \"arealight/none.glsl\"", "")], &[]);
        let messages = compile(folder.path(), "shaders/kernels/bad.comp").unwrap().unwrap_err();
        assert!(messages.contains("shaders/kernels/bad.comp:3"), "{messages}");
        assert!(messages.contains("cannot find \"arealight/none.glsl\" in"), "{messages}");
    }

    #[test]
    fn a_warning_is_an_error() {
        // An extension that the compiler does not know is a warning.
        let folder = checkout(&[("warns", "#extension GL_NOT_THERE : enable", "")], &[]);
        let messages = compile(folder.path(), "shaders/kernels/warns.comp").unwrap().unwrap_err();
        assert!(messages.contains("GL_NOT_THERE"), "{messages}");
    }
}
