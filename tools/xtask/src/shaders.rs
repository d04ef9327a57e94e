//! `shaders`: compiles the kernels, or checks that the embedded SPIR-V is what they compile to.

use crate::TaskError;
use crate::compile::{Compiled, KERNEL_FOLDER, compile};
use crate::manifest::{Entry, Manifest, hash};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const REMEDY: &str = "run: SHADERC_LIB_DIR=\"$(tools/shaderc.sh)\" cargo run -p xtask -- shaders";

/// Compile the kernels to the SPIR-V that the crate `arealight` embeds.
///
/// Each of shaders/kernels/*.comp becomes crates/arealight/spirv/*.spv, and manifest.json beside them records
/// the sources' hash, the module's hash and the compiler.
#[derive(clap::Args)]
pub struct Arguments {
    /// Kernels, by file name without its ending; all when none is named.
    names: Vec<String>,
    /// Write nothing; fail when a module is not what its sources compile to.
    ///
    /// Fails when sources have changed since the module was made, or the module is not the one recorded.
    /// When only this compiler's output differs, another version of the compiler made the module: that is
    /// said, and fails with --strict alone.
    #[arg(long, conflicts_with = "names")]
    check: bool,
    /// With --check: fail too when the module is what another version of the compiler makes.
    #[arg(long, requires = "check")]
    strict: bool,
}

/// Whether every kernel compiled, or passed the check.
pub fn run(root: &Path, arguments: &Arguments) -> Result<bool, TaskError> {
    let available = kernels(root)?;
    if let Some(name) = arguments.names.iter().find(|name| !available.contains(name)) {
        return Err(TaskError::NoSuchKernel { name: name.clone(), available: available.join(", ") });
    }
    if arguments.check {
        let findings = check(root, &available)?;
        for finding in &findings {
            println!("{}: {}", finding.severity(arguments.strict), finding.text());
        }
        let fresh = !findings.iter().any(|finding| finding.is_error(arguments.strict));
        println!("{} kernels checked: {}", available.len(), if fresh { "fresh" } else { REMEDY });
        Ok(fresh)
    } else {
        let names = if arguments.names.is_empty() { &available } else { &arguments.names };
        write(root, names, &available)
    }
}

/// Compiles `names`, writes each module that differs, and brings the manifest up to date.
fn write(root: &Path, names: &[String], available: &[String]) -> Result<bool, TaskError> {
    let mut manifest = Manifest::read(root)?;
    manifest.kernels.retain(|name, _| available.contains(name));
    let mut all_compiled = true;
    for name in names {
        match compile_and_validate(root, name)? {
            Ok(compiled) => {
                let changed = write_if_changed(&spirv_path(root, name), &compiled.spirv)?;
                let state = if changed { "written" } else { "unchanged" };
                println!("{name}: {} bytes, {state}", compiled.spirv.len());
                manifest.kernels.insert(name.clone(), Entry::of(&compiled));
            }
            Err(messages) => {
                eprint!("{messages}");
                all_compiled = false;
            }
        }
    }
    write_if_changed(&Manifest::path(root), manifest.to_text().as_bytes())?;
    Ok(all_compiled)
}

/// What the check found wrong with a kernel's module.
#[derive(Debug, PartialEq, Eq)]
enum Finding {
    /// The sources do not compile.
    Broken { messages: String },
    /// The sources have changed since the module was made, or it was never made.
    Stale { name: String },
    /// The module is not the one that the manifest records.
    Replaced { name: String },
    /// This compiler makes another module of the same sources.
    OtherCompiler { name: String, theirs: String, ours: String },
    /// A module or record whose kernel is gone.
    Orphan { path: String },
}

impl Finding {
    fn is_error(&self, strict: bool) -> bool {
        strict || !matches!(self, Self::OtherCompiler { .. })
    }

    fn severity(&self, strict: bool) -> &'static str {
        if self.is_error(strict) { "error" } else { "note" }
    }

    fn text(&self) -> String {
        match self {
            Self::Broken { messages } => format!("does not compile:\n{}", messages.trim_end()),
            Self::Stale { name } => format!("{name}.spv is older than its sources"),
            Self::Replaced { name } => format!("{name}.spv is not the module that manifest.json records"),
            Self::OtherCompiler { name, theirs, ours } => format!(
                "{name}.spv was made by another version of the compiler ({theirs}; here: {ours}) from the same \
                 sources"
            ),
            Self::Orphan { path } => {
                format!("{path} has no source in {KERNEL_FOLDER}: delete it, or restore the source")
            }
        }
    }
}

/// Compares what is embedded with what the sources compile to.
fn check(root: &Path, available: &[String]) -> Result<Vec<Finding>, TaskError> {
    let manifest = Manifest::read(root)?;
    let mut findings = vec![];
    for name in available {
        let compiled = match compile_and_validate(root, name)? {
            Ok(compiled) => compiled,
            Err(messages) => {
                findings.push(Finding::Broken { messages });
                continue;
            }
        };
        let embedded = std::fs::read(spirv_path(root, name)).ok();
        findings.extend(compare(
            name,
            &Entry::of(&compiled),
            manifest.kernels.get(name),
            embedded.as_deref(),
        ));
    }
    for name in stems(&root.join("crates/arealight/spirv"), "spv")? {
        if !available.contains(&name) {
            findings.push(Finding::Orphan { path: format!("crates/arealight/spirv/{name}.spv") });
        }
    }
    for name in manifest.kernels.keys().filter(|name| !available.contains(name)) {
        findings.push(Finding::Orphan { path: format!("{name} in crates/arealight/spirv/manifest.json") });
    }
    Ok(findings)
}

/// Compares one kernel: `here` as compiled now, `recorded` by the manifest, `embedded` in the crate.
fn compare(name: &str, here: &Entry, recorded: Option<&Entry>, embedded: Option<&[u8]>) -> Option<Finding> {
    let name = name.to_owned();
    let (Some(recorded), Some(embedded)) = (recorded, embedded) else {
        return Some(Finding::Stale { name });
    };
    if recorded.source_sha256 != here.source_sha256 {
        return Some(Finding::Stale { name });
    }
    if recorded.spirv_sha256 != hash(embedded) {
        return Some(Finding::Replaced { name });
    }
    if recorded.spirv_sha256 != here.spirv_sha256 {
        let (theirs, ours) = (recorded.compiler.clone(), here.compiler.clone());
        return Some(Finding::OtherCompiler { name, theirs, ours });
    }
    None
}

/// Compiles a kernel and has spirv-val look at the module, where that tool is installed.
fn compile_and_validate(root: &Path, name: &str) -> Result<Result<Compiled, String>, TaskError> {
    let compiled = match compile(root, name)? {
        Ok(compiled) => compiled,
        Err(messages) => return Ok(Err(messages)),
    };
    Ok(match validate(&compiled.spirv)? {
        None => Ok(compiled),
        Some(messages) => Err(format!("{KERNEL_FOLDER}/{name}.comp: error: invalid SPIR-V: {messages}\n")),
    })
}

/// What spirv-val says against a module; nothing where it is not installed.
fn validate(spirv: &[u8]) -> Result<Option<String>, TaskError> {
    let tool = Command::new("spirv-val")
        .args(["--target-env", "vulkan1.1", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let failed = |source| TaskError::Program { program: "spirv-val", package: "spirv-tools", source };
    let mut tool = match tool {
        Ok(tool) => tool,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(failed(error)),
    };
    if let Some(mut input) = tool.stdin.take() {
        input.write_all(spirv).map_err(failed)?;
    }
    let output = tool.wait_with_output().map_err(failed)?;
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    Ok((!output.status.success()).then(|| said.trim().to_owned()))
}

fn spirv_path(root: &Path, name: &str) -> PathBuf {
    root.join(format!("crates/arealight/spirv/{name}.spv"))
}

/// The kernels' names, sorted.
fn kernels(root: &Path) -> Result<Vec<String>, TaskError> {
    stems(&root.join(KERNEL_FOLDER), "comp")
}

/// The names without ending of the files in a folder that have this ending, sorted.
pub fn stems(folder: &Path, ending: &str) -> Result<Vec<String>, TaskError> {
    let mut stems = vec![];
    for entry in std::fs::read_dir(folder).map_err(TaskError::file(folder))? {
        let path = entry.map_err(TaskError::file(folder))?.path();
        if path.extension().is_some_and(|found| found == ending) {
            stems.extend(path.file_stem().map(|stem| stem.to_string_lossy().into_owned()));
        }
    }
    stems.sort();
    Ok(stems)
}

/// Leaves a file alone that is right already, so that nothing is built anew for it.
fn write_if_changed(path: &Path, bytes: &[u8]) -> Result<bool, TaskError> {
    if std::fs::read(path).is_ok_and(|there| there == bytes) {
        return Ok(false);
    }
    std::fs::write(path, bytes).map_err(TaskError::file(path))?;
    Ok(true)
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// A checkout with kernels (name, text before `main`, body of `main`) and library files (name, text).
    pub fn checkout(kernels: &[(&str, &str, &str)], library: &[(&str, &str)]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        let file = |path: String, text: String| {
            let path = folder.path().join(path);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        };
        file("crates/arealight/spirv/README".to_owned(), String::new());
        file("shaders/include/arealight/README".to_owned(), String::new());
        for (name, before, body) in kernels {
            let head = "#version 450\n#extension GL_GOOGLE_include_directive : require\n";
            let text = format!("{head}{before}\nlayout(local_size_x = 1) in;\nvoid main() {{ {body} }}\n");
            file(format!("shaders/kernels/{name}.comp"), text);
        }
        for (name, text) in library {
            file(format!("shaders/include/arealight/{name}.glsl"), (*text).to_owned());
        }
        folder
    }

    fn compiled_checkout() -> (tempfile::TempDir, Vec<String>) {
        let folder = checkout(
            &[("one", "#include \"arealight/part.glsl\"", "float x = PART;"), ("two", "", "")],
            &[("part", "#define PART 1.0\n")],
        );
        let names = kernels(folder.path()).unwrap();
        assert!(write(folder.path(), &names, &names).unwrap());
        (folder, names)
    }

    #[test]
    fn what_was_just_written_is_fresh() {
        let (folder, names) = compiled_checkout();
        assert_eq!(check(folder.path(), &names).unwrap(), []);
    }

    #[test]
    fn a_changed_include_makes_its_kernel_stale_and_no_other() {
        let (folder, names) = compiled_checkout();
        // The same SPIR-V would come of it: the sources count.
        let part = folder.path().join("shaders/include/arealight/part.glsl");
        std::fs::write(part, "#define PART 1.0 // one\n").unwrap();
        assert_eq!(check(folder.path(), &names).unwrap(), [Finding::Stale { name: "one".to_owned() }]);
    }

    #[test]
    fn a_module_from_elsewhere_is_found_out() {
        let (folder, names) = compiled_checkout();
        std::fs::copy(spirv_path(folder.path(), "one"), spirv_path(folder.path(), "two")).unwrap();
        assert_eq!(check(folder.path(), &names).unwrap(), [Finding::Replaced { name: "two".to_owned() }]);
    }

    #[test]
    fn a_missing_module_is_stale_and_one_without_a_source_an_orphan() {
        let (folder, names) = compiled_checkout();
        let from = spirv_path(folder.path(), "one");
        std::fs::rename(from, spirv_path(folder.path(), "three")).unwrap();
        let path = "crates/arealight/spirv/three.spv".to_owned();
        assert_eq!(
            check(folder.path(), &names).unwrap(),
            [Finding::Stale { name: "one".to_owned() }, Finding::Orphan { path }]
        );
    }

    #[test]
    fn another_compiler_is_a_note_unless_strict() {
        let (folder, names) = compiled_checkout();
        // Another compiler's module: one that the manifest records, of the same sources.
        let mut other = std::fs::read(spirv_path(folder.path(), "one")).unwrap();
        other[8] ^= 1;
        std::fs::write(spirv_path(folder.path(), "one"), &other).unwrap();
        let mut manifest = Manifest::read(folder.path()).unwrap();
        manifest.kernels.get_mut("one").unwrap().spirv_sha256 = hash(&other);
        std::fs::write(Manifest::path(folder.path()), manifest.to_text()).unwrap();

        let findings = check(folder.path(), &names).unwrap();
        assert!(
            matches!(&findings[..], [Finding::OtherCompiler { name, .. }] if name == "one"),
            "{findings:?}"
        );
        assert!(!findings[0].is_error(false));
        assert!(findings[0].is_error(true));
    }

    #[test]
    fn a_kernel_that_does_not_compile_keeps_the_others_from_nothing() {
        let folder = checkout(&[("bad", "", "x"), ("good", "", "")], &[]);
        let names = kernels(folder.path()).unwrap();
        assert!(!write(folder.path(), &names, &names).unwrap());
        let manifest = Manifest::read(folder.path()).unwrap();
        assert_eq!(manifest.kernels.keys().collect::<Vec<_>>(), ["good"]);
        let findings = check(folder.path(), &names).unwrap();
        assert!(matches!(&findings[..], [Finding::Broken { .. }]), "{findings:?}");
    }
}
